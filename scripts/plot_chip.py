#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/hardware/chip-speed.md and its plot from the CSV file that chip_speed writes (scripts/run bench-chip).

usage: plot_chip.py [--csv PATH | --check | --check-plot]
  --csv PATH    take this run: copy it to docs/figures/chip_speed.csv, rewrite page and plot
  --check       write nothing: compare the tables of the page with the checked-in CSV
  --check-plot  write nothing: compare the plot with one drawn from the checked-in CSV

Without an option page and plot are rewritten from the checked-in CSV. Drawing needs matplotlib, installed by `make
venv`.
Exit codes: 0 done or up to date, 1 stale or no such file, 2 bad arguments, 77 no matplotlib."""
import math
import sys

from generated_page import ROOT, notes_and_rows, page_and_plots, plain_number, start_plot, svg_text

PAGE = ROOT / "docs" / "hardware" / "chip-speed.md"
RUN = ROOT / "docs" / "figures" / "chip_speed.csv"
PLOT = ROOT / "docs" / "pictures" / "chip_speed.svg"
OUTSIDE = ("body-tiny",)  # pairs of meshes outside the means
SHARES = ("box", "bus", "transform", "lane", "memory_wait", "inside")
FAST = "128 bit, 60 clocks"
LIBRARIES = ("FCL Debian", "FCL native", "Coal", "CGAL", "ODE")  # one that is not in the run has no column


def mean(values):
    values = list(values)
    return math.exp(sum(map(math.log, values)) / len(values)) if values and min(values) > 0 else 0


class Run:
    """The notes and rows of one run, and the means of a class."""

    def __init__(self, text):
        self.notes, self.rows = notes_and_rows(text)
        self.classes = list(dict.fromkeys(row["class"] for row in self.rows))
        self.memories = list(dict.fromkeys(row["memory"] for row in self.rows))
        self.libraries = [name for name in LIBRARIES if name in self.rows[0]]
        self.reference = "FCL native" if "FCL native" in self.libraries else "FCL Debian"

    def of(self, name, memory):
        return [row for row in self.rows if (row["class"], row["memory"]) == (name, memory)
                and row["meshes"] not in OUTSIDE]

    def rate(self, name, memory, column):
        """0: the column has no answers of this class."""
        return mean(float(row[column] or 0) for row in self.of(name, memory))

    def share(self, name, memory, column):
        found = [float(row[column]) for row in self.of(name, memory)]
        return sum(found) / len(found)


def tables(run):
    out = [f"- {key}: {value}" for key, value in run.notes.items()]
    ways = run.libraries + ["single", "batch"]
    first = run.memories[0]
    out += ["", f"Queries per second, geometric means of the pairs of meshes; in brackets times {run.reference}.", "",
            "| class | " + " | ".join(run.libraries + ["CPU single", "CPU batch"]
                                      + [f"chip, {m}" for m in run.memories]) + " |",
            "|---" * (1 + len(ways) + len(run.memories)) + "|"]
    for name in run.classes:
        reference = run.rate(name, first, run.reference)
        shown = lambda rate: f"{rate:,.0f} ({rate / reference:.2g})" if rate else "-"
        cells = [name] + [shown(run.rate(name, first, way)) for way in ways]
        out.append("| " + " | ".join(cells + [shown(run.rate(name, memory, "chip")) for memory in run.memories]) + " |")
    out += ["", "Clocks that the chip needs for a query, geometric means of the pairs of meshes.", "",
            "| memory | " + " | ".join(run.classes) + " |", "|---" * (1 + len(run.classes)) + "|"]
    for memory in run.memories:
        out.append(f"| {memory} | " + " | ".join(f"{run.rate(name, memory, 'clocks'):,.0f}"
                                                 for name in run.classes) + " |")
    out += ["", "What the chip's blocks do, % of its clocks, means of the pairs of meshes, memory of " + FAST + ".", "",
            "| class | box test | bus | transform | lane | idle: a line outstanding | idle: work in flight |",
            "|---" * 7 + "|"]
    out += ["| " + " | ".join([name] + [f"{run.share(name, FAST, column):.0f}" for column in SHARES]) + " |"
            for name in run.classes]
    return "\n".join(out) + "\n"


def draw(run):
    """The plot as SVG text: what each way answers, times FCL; a dot for each pair of meshes. Readable in grey."""
    plt = start_plot("chip_speed")
    from matplotlib.ticker import FuncFormatter
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    ways = {"Coal": ("Coal", FAST, "0.55", "x", -0.3), "CPU device, one core": ("single", FAST, "#2f7fbc", "o", -0.1),
            "chip, " + FAST: ("chip", FAST, "#08306b", "s", 0.1),
            "chip, 64 bit, 100 clocks": ("chip", "64 bit, 100 clocks", "#a63603", "^", 0.3)}
    ways = {label: way for label, way in ways.items() if way[0] in run.rows[0]}
    for label, (column, memory, colour, marker, shift) in ways.items():
        for i, name in enumerate(run.classes):
            values = [float(row[column]) / float(row[run.reference]) for row in run.of(name, memory)]
            axes.plot([i + shift] * len(values), values, marker, color=colour, markersize=4, markerfacecolor="none",
                      label=label if i == 0 else None)
            axes.plot([i + shift - 0.1, i + shift + 0.1], [mean(values)] * 2, color=colour, linewidth=2.2)
    axes.axhline(1, color="0.45", linewidth=0.9, linestyle=":")
    axes.set_yscale("log")
    axes.set_xticks(range(len(run.classes)), [name.replace(" all", ",\nall") for name in run.classes])
    axes.set_xlim(-0.5, len(run.classes) - 0.5)
    axes.yaxis.set_major_formatter(FuncFormatter(plain_number))
    axes.set_ylabel(f"queries per second, times {run.reference}")
    axes.grid(axis="y", color="0.9", linewidth=0.6, which="both")
    axes.legend(loc="lower left", frameon=False)
    figure.subplots_adjust(left=0.09, right=0.99, bottom=0.12, top=0.97)
    return svg_text(figure)


if __name__ == "__main__":
    sys.exit(page_and_plots(__doc__, PAGE, RUN, {PLOT: draw}, "scripts/run bench-chip writes build/bench/chip.csv",
                            Run, tables))
