#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/paper/table1.md from the program cchip_table1: its output, the overhead curves as CSV, and their plot.

usage: plot_table1.py [--program PATH] [--check | --check-plot]
  --program PATH  cchip_table1 (default build/release/bin/cchip_table1, built by `scripts/run table1`)
  --check         write nothing: compare page and CSV with a fresh run of the program
  --check-plot    write nothing: compare the plot with one drawn from the checked-in CSV and page

Without an option docs/paper/table1.md (between its `generated` lines), docs/figures/table1_overhead.csv and
docs/figures/table1_overhead.svg are rewritten. Drawing needs matplotlib, installed by `make venv`.
Exit codes: 0 done or up to date, 1 stale or the program failed, 2 bad arguments, 77 no matplotlib."""
import argparse
import csv
import io
import pathlib
import re
import subprocess
import sys
import tempfile

from generated_page import ROOT, compare, fail, page_with, plain_number, start_plot, svg_text, write

PAGE = ROOT / "docs" / "paper" / "table1.md"
CURVES = ROOT / "docs" / "figures" / "table1_overhead.csv"
PLOT = CURVES.with_suffix(".svg")
COMMAND = "scripts/run table1-plot"


def run(program):
    """What the program prints, and its curves."""
    with tempfile.TemporaryDirectory() as folder:
        curves = pathlib.Path(folder, "curves.csv")
        try:
            result = subprocess.run([program, "--csv", curves], capture_output=True,
                                    text=True)
        except OSError as error:
            fail(f"{program} cannot be run ({error.strerror}); build it with: scripts/run table1")
        if result.returncode:
            fail(f"{program} failed (exit code {result.returncode}): {result.stderr.strip()}")
        return result.stdout, curves.read_text()


def page(output):
    return page_with(PAGE, f"```text\n{output}```\n")


def summary(text):
    """The keys of the last line that the program prints."""
    line = re.search(r"^static_ns=.*$", text, re.M)[0]
    return {key: float(value) for key, value in re.findall(r"(\w+)=([\d.]+)", line)}


def draw(curves, table):
    """The plot as SVG text, the same bytes for the same figures. Dark to light and solid or dashed: readable in
    grey."""
    plt = start_plot("cchip_table1")
    from matplotlib.lines import Line2D
    from matplotlib.ticker import FuncFormatter
    bottom, top = 0.005, 30000
    figure, axes = plt.subplots(figsize=(7.2, 4.6))
    series = {}
    for row in csv.DictReader(io.StringIO(curves)):
        key = int(row["slots"]), int(row["port_bits"]), int(row["port_hz"])
        series.setdefault(key, []).append((float(row["work_per_swap_ns"]) / 1e6, float(row["overhead_percent"])))
    shades = dict(zip(sorted({key[1:] for key in series}), ("#08306b", "#2f7fbc", "#8fc1e3")))
    for (slots, bits, hertz), points in sorted(series.items()):
        seen = [point for point in points if point[1] > 0]
        if len(seen) < len(points):  # from there on nothing: down to the axis
            seen.append((points[len(seen)][0], bottom / 10))
        axes.plot(*zip(*seen), color=shades[bits, hertz], linewidth=1.8, linestyle="-" if slots == 1 else (0, (4, 2)))
        if slots == 1:
            axes.annotate(f"{bits} bit, {hertz / 1e6:g} MHz", seen[-1], xytext=(5, 0), textcoords="offset points",
                          va="center", fontsize=8, annotation_clip=False)
    axes.axhline(0.1, color="0.45", linewidth=0.9, linestyle=":")
    axes.annotate("the paper's text: < 0.1 %", (20, 0.1), xytext=(0, 3), textcoords="offset points", fontsize=8,
                  color="0.3")
    work, overhead = table["static_ns"] / 2e6, table["overhead_percent"]
    axes.plot(work, overhead, "o", markersize=6, markerfacecolor="white", markeredgecolor="black", zorder=3)
    axes.annotate(f"parameters of Table 1:\n{work:.1f} ms, {overhead:.2f} %", (work, overhead), xytext=(10, 10),
                  textcoords="offset points", fontsize=8)
    axes.set(xscale="log", yscale="log", xlim=(0.1, 10000), ylim=(bottom, top), xlabel="work per swap (ms)",
             ylabel="overhead (% of the run time without swaps)")
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(FuncFormatter(plain_number))
    axes.minorticks_off()
    axes.grid(color="0.9", linewidth=0.6)
    axes.legend(handles=[Line2D([], [], color="0.2", linewidth=1.8, label="one slot"),
                         Line2D([], [], color="0.2", linewidth=1.8, linestyle=(0, (4, 2)), label="two slots")],
                loc="upper right", frameon=False, handlelength=2.6)
    figure.subplots_adjust(left=0.105, right=0.85, bottom=0.11, top=0.98)
    return svg_text(figure)


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("--program", default=ROOT / "build" / "release" / "bin" / "cchip_table1")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--check", action="store_true")
    what.add_argument("--check-plot", action="store_true")
    parser.add_argument("-h", "--help", action="store_true")
    arguments = parser.parse_args()
    if arguments.help:
        print(__doc__)
        return 0
    if arguments.check_plot:
        return compare(PLOT, draw(CURVES.read_text(), summary(PAGE.read_text())), COMMAND)
    output, curves = run(arguments.program)
    if arguments.check:
        return compare(PAGE, page(output), COMMAND) | compare(CURVES, curves, COMMAND)
    write({PAGE: page(output), CURVES: curves, PLOT: draw(curves, summary(output))})
    return 0


if __name__ == "__main__":
    sys.exit(main())
