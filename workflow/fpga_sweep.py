#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Fmax of rows of scripts/fpga.py over seeds of place and route. workflow/fpga.smk calls this.

usage: fpga_sweep.py synth ROW FILE [OPTION...]               synthesises a row; FILE names the folder with the netlist
       fpga_sweep.py place ROW SEED SYNTH FILE [OPTION...]    places and routes it once; SYNTH: the FILE of synth;
                                                              OPTION: of scripts/fpga.py, as --freq=125
       fpga_sweep.py merge CSV SHARD... --seeds N [--parameter NAME]  a line for each row: best, median and worst of all
       seeds fpga_sweep.py plot CSV SVG                             Fmax against the parameter, or row by row
                                                                    (matplotlib)

The outputs of the tools are kept in build/fpga as scripts/fpga.py does, which is the one that runs them; a file is
written under a temporary name and renamed. Exit codes: 0 done, 1 a tool failed or a seed is missing."""
import argparse
import csv
import io
import json
import pathlib
import statistics
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "workflow")]
import campaign  # noqa: E402
import fpga  # noqa: E402


def options(o):
    """Those of scripts/fpga.py."""
    return fpga.arguments(o.options)


def value_of(row, parameter):
    """Value of a parameter in a row; None without a parameter, or for a block, which has others."""
    if not parameter or row.block:
        return None
    return dict(row.parameters).get(parameter, fpga.definition(f"{parameter}_DEFAULT"))


def synth(o, row, file):
    folder = fpga.synthesise(fpga.rows()[row], options(o))
    campaign.write(file, json.dumps({"row": row, "synthesis": folder.name}) + "\n")


def place(o, row, seed, made, file):
    synthesis = json.loads(pathlib.Path(made).read_text())
    report = fpga.place(fpga.rows()[row], fpga.BUILD / synthesis["synthesis"], int(seed), options(o))
    campaign.write(file, json.dumps({**synthesis, "seed": int(seed), "fmax_mhz": round(fpga.fmax(report), 2)}) + "\n")


def merge(o, table, *files):
    found = {}
    for file in files:
        shard = json.loads(pathlib.Path(file).read_text())
        if shard["seed"] in found.setdefault(shard["row"], {}):
            raise campaign.Refused(f"{file}: seed {shard['seed']} of {shard['row']} is there twice")
        found[shard["row"]][shard["seed"]] = shard["fmax_mhz"]
    lines = [["row", "parameter", "value", "seeds", "best_mhz", "median_mhz", "worst_mhz"]]
    for row, clocks in found.items():
        missing = set(range(1, o.seeds + 1)) ^ set(clocks)
        if missing:
            raise campaign.Refused(f"{row}: not one result for each of the seeds 1 to {o.seeds}: {sorted(missing)}")
        value = value_of(fpga.rows()[row], o.parameter)
        lines.append([row, o.parameter if value is not None else "", "" if value is None else value, len(clocks),
                      max(clocks.values()), round(statistics.median(clocks.values()), 2), min(clocks.values())])
        print(f"{row} {f'{o.parameter}={value} ' if value is not None else ''}best={lines[-1][4]} "
              f"median={lines[-1][5]} "
              f"worst={lines[-1][6]} seeds={len(clocks)}")
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(lines)
    campaign.write(table, text.getvalue())


def plot(o, table, picture):
    import matplotlib
    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "collisionchip"  # the same file from the same numbers
    from matplotlib import pyplot
    with open(table, newline="") as file:
        lines = list(csv.DictReader(file))
    numeric = all(line["value"] for line in lines) and len({line["value"] for line in lines}) == len(lines)
    lines.sort(key=lambda line: int(line["value"]) if numeric else 0)
    x = [int(line["value"]) if numeric else line["row"] for line in lines]
    figure, axes = pyplot.subplots(figsize=(6, 4), layout="constrained")
    median, best, worst = ([float(line[f"{name}_mhz"]) for line in lines] for name in ("median", "best", "worst"))
    axes.vlines(x, worst, best, color="lightgrey", linewidth=6, label="worst to best")
    axes.plot(x, best, "o", color="tab:blue", label="best")
    axes.plot(x, median, "o-" if numeric else "o", color="tab:orange", label=f"median of {lines[0]['seeds']} seeds")
    axes.set(xlabel=lines[0]["parameter"] if numeric else "row", ylabel="Fmax, MHz", ylim=(0, None))
    axes.set_xticks(x)
    axes.legend()
    partial = pathlib.Path(picture).with_suffix(".part.svg")
    figure.savefig(partial, metadata={"Date": None})
    partial.replace(picture)


def main():
    if len(sys.argv) < 2 or {"-h", "--help"} & set(sys.argv):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 1
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("action", choices=("synth", "place", "merge", "plot"))
    parser.add_argument("arguments", nargs="+")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--parameter", default="")
    o, words = parser.parse_known_intermixed_args()
    o.options = [word for word in words if word.startswith("--")]
    try:
        {"synth": synth, "place": place, "merge": merge, "plot": plot}[o.action](o, *o.arguments)
    except (campaign.Refused, fpga.ToolError, OSError) as error:
        print(f"fpga_sweep.py: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
