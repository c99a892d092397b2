#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The table "A robot cell" of docs/cpp/speed.md from the CSV file that robot_speed writes (scripts/run bench-robot).

usage: robot_table.py [--csv PATH | --check]
  --csv PATH    take this run: copy it to docs/figures/robot_speed.csv and rewrite the table
  --check       write nothing: compare the table with the checked-in CSV

Without an option the table is rewritten from the checked-in CSV.
Exit codes: 0 done or up to date, 1 stale or no such file, 2 bad arguments."""
import sys

from generated_page import ROOT, notes_and_rows, page_and_plots

PAGE = ROOT / "docs" / "cpp" / "speed.md"
RUN = ROOT / "docs" / "figures" / "robot_speed.csv"
# one that is not in the run has no row
VARIANTS = ("single", "batch", "FCL Debian", "FCL native", "Coal", "CGAL", "ODE")
ARMS = {"panda": "Panda", "ur3": "UR3", "ur5": "UR5", "ur10": "UR10"}


def table(text):
    notes, rows = notes_and_rows(text)
    cells = {(row["arm"], row["mode"], row["variant"]): row for row in rows}
    arms = list(dict.fromkeys(arm for arm, _, _ in cells))
    out = [f"- {key}: {notes[key]}" for key in ("machine", "load before the run", "run", *arms) if key in notes]
    out += ["", "| | " + " | ".join(f"{ARMS[arm]}: checks/s | pair queries/s" for arm in arms) + " | not exact |",
            "|---" * (2 * len(arms) + 2) + "|"]
    for variant in VARIANTS:
        columns = []
        wrong = 0
        for arm in arms:
            for mode in ("check", "all pairs"):
                row = cells.get((arm, mode, variant))
                if row is None:
                    columns.append("-")
                    continue
                each = float(row["seconds_each"])
                count = 1 if mode == "check" else int(row["asked"]) / int(row["configurations"])
                ahead = each / float(cells[arm, mode, "single"]["seconds_each"])
                columns.append(f"{count / each:,.0f}" + ("" if variant == "single" else f" ({ahead:.1f})"))
                wrong += int(row["differ"]) if mode == "all pairs" else 0
        if set(columns) != {"-"}:
            out.append(f"| {variant} | " + " | ".join(columns) + f" | {wrong:,} |")
    return "\n".join(out) + "\n"


if __name__ == "__main__":
    sys.exit(page_and_plots(__doc__, PAGE, RUN, {}, "scripts/run bench-robot writes build/bench/robot.csv", str,
                            table, "robot"))
