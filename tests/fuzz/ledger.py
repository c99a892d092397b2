#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""All inputs that fuzzers have tried so far: docs/figures/fuzz.csv, a row for each run of a target, and the table of
docs/develop/verification.md.

usage: ledger.py --add LINES   append the lines `target=...` that run.sh printed, with HEAD; then as --table
       ledger.py --table       write the table from the rows
       ledger.py --check       exit code 1 unless the table is that of the rows

The last line is `executions=N findings=F`. Exit codes: 0 done, 1 the table is stale or a line is not understood, 2 bad
arguments."""
import collections
import csv
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "scripts"))
import datasheet  # noqa: E402

RECORD = ROOT / "docs" / "figures" / "fuzz.csv"
PAGE = ROOT / "docs" / "develop" / "verification.md"
COUNTS = ("runs", "crashes", "hangs", "leaks", "seconds")
COLUMNS = ("target", "build", *COUNTS, "commit")
TEXTS = ("target", "build", "commit")


def rows():
    with RECORD.open() as file:
        return [{column: row[column] if column in TEXTS else int(row[column]) for column in COLUMNS}
                for row in csv.DictReader(file)]


def add(path):
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=7", "HEAD"], stdout=subprocess.PIPE,
                            text=True, check=True).stdout.strip()
    lines = [dict(re.findall(r"(\w+)=(\S+)", line))
             for line in pathlib.Path(path).read_text().splitlines() if line.startswith("target=")]
    if not lines or any(not set(line) >= {"target", "build", *COUNTS} for line in lines):
        print(f"ledger.py: {path}: no lines `target=...` as run.sh prints them", file=sys.stderr)
        return 1
    new = not RECORD.exists()
    with RECORD.open("a", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n", extrasaction="ignore")
        if new:
            writer.writeheader()
        writer.writerows({**line, "commit": commit} for line in lines)
    return 0


def table():
    sums = collections.defaultdict(lambda: [0, 0, 0, 0, ""])
    for row in rows():
        for name in (row["target"], "all"):
            found = sums[name]
            found[0] += row["runs"]
            found[1] += row["runs"] * (not row["build"].startswith("fuzz-fast"))
            found[2] += row["crashes"] + row["hangs"] + row["leaks"]
            found[3] += row["seconds"]
            found[4] = row["commit"]
    names = sorted(set(sums) - {"all"}) + ["all"]
    lines = ["| target | inputs tried | of them with AddressSanitizer | findings | hours of one core | last at |",
             "|---|---|---|---|---|---|"]
    lines += [f"| {f'`{name}`' if name != 'all' else name} | {sums[name][0]:,} | {sums[name][1]:,} | {sums[name][2]} | "
              f"{sums[name][3] / 3600:.1f} | {sums[name][4]} |" for name in names]
    return "\n".join(lines) + "\n", sums["all"]


def main():
    if len(sys.argv) == 3 and sys.argv[1] == "--add":
        if add(sys.argv[2]):
            return 1
    elif sys.argv[1:] not in (["--table"], ["--check"]):
        print(__doc__, file=sys.stdout if sys.argv[1:] == ["--help"] else sys.stderr)
        return 0 if sys.argv[1:] == ["--help"] else 2
    text, total = table()
    if sys.argv[1] == "--check":
        if text not in PAGE.read_text():
            print("ledger.py: the table of docs/develop/verification.md is not that of docs/figures/fuzz.csv; run: "
                  "tests/fuzz/ledger.py --table", file=sys.stderr)
            return 1
    else:
        datasheet.rewrite(PAGE, "fuzz", text)
    print(f"executions={total[0]} findings={total[2]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
