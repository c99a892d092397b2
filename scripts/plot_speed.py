#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/cpp/speed.md, its plot and the small one of README.md from the CSV file that collide_speed writes (scripts/run
bench-collide).

usage: plot_speed.py [--csv PATH | --check | --check-plot]
  --csv PATH    take this run: copy it to docs/figures/collide_speed.csv, rewrite page and plots
  --check       write nothing: compare the tables of the page with the checked-in CSV
  --check-plot  write nothing: compare the plots with those drawn from the checked-in CSV

Without an option page and plots are rewritten from the checked-in CSV. Drawing needs matplotlib, installed by `make
venv`.
Exit codes: 0 done or up to date, 1 stale or no such file, 2 bad arguments, 77 no matplotlib."""
import math
import statistics
import sys

from generated_page import ROOT, notes_and_rows, page_and_plots, plain_number, start_plot, svg_text

PAGE = ROOT / "docs" / "cpp" / "speed.md"
RUN = ROOT / "docs" / "figures" / "collide_speed.csv"
PLOT = ROOT / "docs" / "pictures" / "collide_speed.svg"
SMALL = ROOT / "docs" / "pictures" / "collide_speed_small.svg"  # for README.md
ASSUMED_GAIN = 2.3  # collide_speed.cpp has the same
# ratios that the project aims at, of the means that count: classes -> variant -> ratio
AIMS = {("touch", "near", "deep"): {"single": 10, "batch": 15}, ("touch all", "deep all"): {"single": 8},
        ("lone",): {"single": 5}, ("far",): {"single": 4}}
BOOLEAN = ("touch", "near", "deep", "far", "graze")
# rows of the tables of means: classes, title
MEANS = [((name,), name) for name in BOOLEAN] + [
    (("touch", "near", "deep"), "**touch, near and deep**"), (("touch all",), "touch, all contacts"),
    (("deep all",), "deep, all contacts"), (("touch all", "deep all"), "**all contacts**"),
    (("coherent",), "coherent"), (("lone",), "lone"), (("touch warm",), "touch, warm"),
    (("touch cold",), "touch, cold")]
LIBRARIES = ("FCL Debian", "FCL native", "Coal", "CGAL", "ODE")  # one that is not in the run has no column


class Run:
    """The notes and rows of one run."""

    def __init__(self, text):
        self.notes, self.rows = notes_and_rows(text)
        self.cells = {}  # (meshes, class): {variant: row}
        for row in self.rows:
            if row["table"] == "query":
                self.cells.setdefault((row["meshes"], row["class"]), {})[row["variant"]] = row
        self.meshes = list(dict.fromkeys(meshes for meshes, _ in self.cells))
        self.variants = list(dict.fromkeys(row["variant"] for row in self.rows if row["table"] == "query"))
        self.has_native = "FCL native" in self.variants

    def seconds(self, cell, variant):
        """Seconds a query; "native": measured or assumed."""
        if variant == "native" and not self.has_native:
            return float(cell["FCL Debian"]["seconds_each"]) / ASSUMED_GAIN
        return float(cell["FCL native" if variant == "native" else variant]["seconds_each"])

    def ratio(self, cell, variant):
        return self.seconds(cell, "native") / self.seconds(cell, variant)

    def differ(self, names, variant):
        """Answers that are not ours, over all meshes; None if the variant gave none."""
        counts = [int(cell[variant]["differ"]) for (_, name), cell in self.cells.items() if name in names
                  and variant in cell]
        return sum(counts) if counts else None

    def answers(self, names):
        return sum(int(cell["single"]["queries"]) for (_, name), cell in self.cells.items() if name in names)

    def counts_in_means(self, meshes):
        return meshes not in ("body-tiny", "scene")

    def mean(self, classes, variant):
        """Geometric mean over these classes and the meshes; None if there are none."""
        logs = [math.log(self.ratio(cell, variant)) for (meshes, name), cell in self.cells.items()
                if name in classes and self.counts_in_means(meshes) and variant in cell]
        return math.exp(sum(logs) / len(logs)) if logs else None


def times(value):
    return "-" if value is None else f"{value:.1f}"


def tables(run):
    """The generated part of the page."""
    out = []
    means_of_run = [(names, title) for names, title in MEANS if run.answers(names)]
    for key, value in run.notes.items():
        out.append(f"- {key}: {value}")
    out += ["", "The rows of every pair of meshes, with counts of nodes, boxes and pairs of faces, are in",
            "[collide_speed.csv](../figures/collide_speed.csv)."]
    out += ["", "### Geometric means of the six pairs", "",
            "Times FCL built natively; in brackets what this project aims at.", "",
            "| class | single | batch | all cores |", "|---|---|---|---|"]
    for names, title in means_of_run:
        aims = AIMS.get(names, {})
        cells = [times(run.mean(names, variant)) + (f" (aim {aims[variant]})" if variant in aims else "")
                 for variant in ("single", "batch", "cores")]
        out.append(f"| {title} | " + " | ".join(cells) + " |")
    libraries = [name for name in LIBRARIES if name in run.variants]
    out += ["", "### Other libraries", "",
            "How many times faster our single query is, geometric means of the six pairs; in brackets how many of the "
            "answers, which",
            "include those about *body-tiny*, are not the exact ones.", "",
            "| class | answers | " + " | ".join(libraries) + " |", "|---" * (len(libraries) + 2) + "|"]
    for names, title in means_of_run:
        ours = run.mean(names, "single")
        means = [(run.mean(names, library), run.differ(names, library)) for library in libraries]
        cells = [f"{times(ours / mean)} ({differ:,})" if mean else "-" for mean, differ in means]
        out.append(f"| {title} | {run.answers(names):,} | " + " | ".join(cells) + " |")
    if "relation" in run.variants:
        out += ["", "### Touching or crossing", "",
                "What it costs to ask for the [relation](touching.md), too: seconds of a single query, times those "
                "without.", "",
                "| " + " | ".join(title for _, title in MEANS[:9]) + " |", "|---" * 9 + "|"]
        costs = [run.mean(names, "single") / run.mean(names, "relation") if run.mean(names, "relation") else None
                 for names, _ in MEANS[:9]]
        out.append("| " + " | ".join("-" if cost is None else f"{cost:.2f}" for cost in costs) + " |")
    out += ["", "### Instruction sets", "",
            "Single query, batch on one thread; times FCL built natively, geometric means.", "",
            "| | " + " | ".join(BOOLEAN) + " |", "|---" * (len(BOOLEAN) + 1) + "|"]
    for i, target in enumerate(run.notes["instruction sets"].split(", ")):
        suffix = "" if i == 0 else f" {target}"
        cells = [f"{times(run.mean((name,), 'single' + suffix))}, {times(run.mean((name,), 'batch' + suffix))}"
                 for name in BOOLEAN]
        out.append(f"| {target} | " + " | ".join(cells) + " |")
    out += ["", "### Objects", "", "Memory and build time, mesh and what the device derives from it included; least, "
                                   "median and greatest object.", "",
            "| | bytes a face | microseconds a face |", "|---|---|---|"]
    for variant in ("ours", "FCL Debian"):
        rows = [row for row in run.rows if row["table"] == "object" and row["variant"] == variant]
        spread = lambda values: " / ".join(f"{value:.{0 if value >= 100 else 2}f}" for value in
                                           (min(values), statistics.median(values), max(values)))
        out.append(f"| {variant} | {spread([float(row['bytes']) for row in rows])} | "
                   f"{spread([1e6 * float(row['seconds_each']) / int(row['class'].split()[1]) for row in rows])} |")
    return "\n".join(out) + "\n"


def draw(run):
    """The plot as SVG text, the same bytes for the same figures: a dot for each pair of meshes. Readable in grey."""
    plt = start_plot("collide_speed")
    from matplotlib.ticker import FuncFormatter
    classes = [name for name in BOOLEAN + ("touch all", "deep all", "coherent", "lone")
               if any(cell == name for _, cell in run.cells)]
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    styles = {"single": ("#2f7fbc", "o", -0.17), "batch": ("#08306b", "s", 0.17)}
    for variant, (colour, marker, shift) in styles.items():
        for i, name in enumerate(classes):
            values = [run.ratio(cell, variant) for (meshes, c), cell in run.cells.items()
                      if c == name and variant in cell and run.counts_in_means(meshes)]
            if not values:
                continue
            axes.plot([i + shift] * len(values), values, marker, color=colour, markersize=4.5, markerfacecolor="none",
                      label=variant if i == 0 else None)
            mean = math.exp(sum(map(math.log, values)) / len(values))
            axes.plot([i + shift - 0.1, i + shift + 0.1], [mean, mean], color=colour, linewidth=2.2)
            axes.annotate(f"{mean:.1f}", (i + shift, max(values)), xytext=(0, 5), textcoords="offset points",
                          ha="center",
                          fontsize=8, color=colour)
    axes.axhline(1, color="0.45", linewidth=0.9, linestyle=":")
    axes.annotate("FCL", (len(classes) - 0.55, 1), xytext=(0, 3), textcoords="offset points", ha="right", fontsize=8,
                  color="0.3")
    axes.set_yscale("log")
    axes.set_xticks(range(len(classes)), [name.replace(" all", ",\nall") for name in classes])
    axes.set_xlim(-0.5, len(classes) - 0.5)
    axes.yaxis.set_major_formatter(FuncFormatter(plain_number))
    axes.yaxis.set_minor_formatter(FuncFormatter(lambda value, _: f"{value:g}" if f"{value:e}"[0] in "25" else ""))
    axes.set_ylabel("queries per second, times FCL built natively")
    axes.grid(axis="y", color="0.9", linewidth=0.6, which="both")
    axes.legend(loc="upper right", frameon=False)
    figure.subplots_adjust(left=0.09, right=0.99, bottom=0.12, top=0.97)
    return svg_text(figure)


def draw_small(run):
    """The plot of README.md: single queries of four classes, a dot for each pair of meshes, a bar for their mean."""
    plt = start_plot("collide_speed_small")
    classes = {"touch": ("touch",), "near": ("near",), "deep": ("deep",), "all contacts": ("touch all", "deep all")}
    figure, axes = plt.subplots(figsize=(4.6, 3.4))
    for i, names in enumerate(classes.values()):
        values = [run.ratio(cell, "single") for (meshes, name), cell in run.cells.items()
                  if name in names and run.counts_in_means(meshes)]
        mean = run.mean(names, "single")
        axes.bar(i, mean, width=0.62, color="#9cc4e4")
        axes.plot([i] * len(values), values, "o", color="#08306b", markersize=4, markerfacecolor="none")
        axes.annotate(f"{mean:.1f}", (i, 1), xytext=(0, 14), textcoords="offset points", ha="center", fontsize=15,
                      fontweight="bold", color="#08306b")
    axes.axhline(1, color="0.3", linewidth=1.1, linestyle="--")
    axes.annotate("FCL = 1", (len(classes) + 0.03, 1), xytext=(0, 4), textcoords="offset points",
                  ha="right", fontsize=9,
                  color="0.2")
    axes.set_xticks(range(len(classes)), list(classes))
    axes.set_xlim(-0.5, len(classes) + 0.05)
    axes.set_ylim(0, None)
    axes.set_ylabel("queries per second, times FCL")
    figure.subplots_adjust(left=0.12, right=0.99, bottom=0.09, top=0.97)
    return svg_text(figure)


if __name__ == "__main__":
    sys.exit(page_and_plots(__doc__, PAGE, RUN, {PLOT: draw, SMALL: draw_small},
                            "scripts/run bench-collide writes build/bench/collide.csv", Run, tables))
