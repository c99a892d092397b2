#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The benchmark of triangle tests in hardware: makes the sets, simulates every core on them, judges the answers,
measures area and clock of the cores, prints the tables of docs/hardware/sat-benchmark.md.

usage: run.py [options]
  --pairs N         pairs a set, four times as many in `mesh` (default 2000, at most 16000)
  --seed N          of the sets (default 1)
  --core NAME=FILE[,FILE...]   a further core: top module NAME with the ports of bench/sat/plain_sat.v, in NAME.v and
                    other files named like their modules; those of rtl/ are there, too
  --only NAME       only this core, and those of further --only
  --simulator NAME  verilator (default; builds each core once) or icarus (builds nothing, slower with many pairs)
  --area N          synthesise, place and route every core with the seeds 1..N, as scripts/fpga.py; 0: synthesise only
                    (default: nothing of this)
  --committed       area and clock of tri_tri from docs/hardware/fpga.md, which has five seeds, instead
  --nextpnr PATH    as in scripts/fpga.py
  --fault N         a fault in plain_sat, to see that the judge finds it: 1 calls touching apart, 2 trusts flat axes
  --write           rewrite the tables in docs/hardware/sat-benchmark.md

Sets, their answers and the simulations are in build/bench/sat. The truth, and whether an answer is right, are from
check.py alone. Last line of each core: `NAME pairs=N undecided=N wrong=N missing=N`.
Exit codes: 0 done, 1 an answer is wrong or missing, or a tool failed, 2 bad arguments."""
import argparse
import concurrent.futures
import hashlib
import os
import pathlib
import re
import statistics
import subprocess
import sys

import check

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import datasheet  # noqa: E402
import fpga  # noqa: E402

HERE = ROOT / "bench" / "sat"
BUILD = ROOT / "build" / "bench" / "sat"
PAGE = ROOT / "docs" / "hardware" / "sat-benchmark.md"
BENCH = HERE / "pairs_bench.v"
CORES = {"tri_tri": ("cchip_primtest_tri_tri", []), "plain_sat": ("plain_sat", ["bench/sat/plain_sat.v"])}
SPEED = "mesh"  # the set that the pairs per second of the first table are of


def tool(*words):
    try:
        result = subprocess.run([str(word) for word in words], cwd=ROOT, stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)
    except OSError as error:
        raise fpga.ToolError(f"{words[0]} cannot be run: {error.strerror}") from error
    if result.returncode:
        raise fpga.ToolError(f"{words[0]} failed (exit code {result.returncode}):\n{result.stdout[-2000:]}")
    return result.stdout


def make_sets(options):
    """Files of the sets with their truth, by name; made anew unless they are there."""
    text = b"".join((HERE / name).read_bytes() for name in ("make_sets.py", "check.py"))
    folder = BUILD / f"sets-{options.pairs}-{options.seed}-{hashlib.sha256(text).hexdigest()[:8]}"
    if not (folder / "done").exists():
        tool(sys.executable, "-B", HERE / "make_sets.py", folder, "--pairs", options.pairs, "--seed", options.seed)
        tool(sys.executable, "-B", HERE / "check.py", "truth", *sorted(folder.glob("*.txt")))
        (folder / "done").touch()
    # the order in which make_sets.py lists them, on the grid first
    order = re.findall(r"(?m)^  (\w+) {2,}\S", (HERE / "make_sets.py").read_text())
    return {name: folder / f"{name}.txt" for name in order}


def as_the_bench_reads(path):
    """The set rounded to the grid, in hexadecimal: B, A, error. Rounding to nearest moves a coordinate by at most half
    a step, so the difference of two vertices by at most one."""
    scale, pairs = check.read_set(path)
    packed = lambda points: sum(((2 * x + scale) // (2 * scale) & 0xFFFF) << (48 * i + 16 * k)
                                for i, point in enumerate(points) for k, x in enumerate(point))
    made = path.with_suffix(".hex")
    made.write_text("".join(f"{packed(b):036x} {packed(a):036x} {int(scale > 1):x}\n" for a, b, _ in pairs))
    return made


def modules_of(files):
    """(module, file) of files that are named like their module."""
    return tuple((pathlib.Path(file).stem, file) for file in files)


def build(name, top, files, options):
    """The simulation of a core, as the words of a command."""
    macros = [f"-DSAT_CORE={top}"] + ([f"-DPLAIN_SAT_FAULT={options.fault}"] if name == "plain_sat" else [])
    rtl = [path for path in fpga.needed(top, "cchip.f", dict(modules_of(files))) if path.endswith(".v")]
    sources = [*dict.fromkeys([*rtl, *files, str(BENCH.relative_to(ROOT))])]
    key = hashlib.sha256("".join([options.simulator, *macros, *((ROOT / s).read_text() for s in sources)]).encode())
    folder = BUILD / f"{name}-{key.hexdigest()[:12]}"
    if options.simulator == "icarus":
        folder.mkdir(parents=True, exist_ok=True)
        tool("iverilog", "-g2005", "-I", "rtl/include", *macros, "-s", "pairs_bench", "-o", folder / "sim", *sources)
        return ["vvp", "-n", folder / "sim"]
    if not (folder / "sim").exists():
        verilator = os.environ.get("VERILATOR") or "verilator"
        tool(verilator, "--binary", "--timing", "-Wno-fatal", "-Wno-lint", "-CFLAGS", "-O0", "-Irtl/include", *macros,
             "--top-module", "pairs_bench", "--Mdir", folder, "-o", "sim", *sources)
    return [folder / "sim"]


def simulate(core, command, path, sets):
    """What check.py counts, with the clocks and the latency of a lone pair."""
    answers = path.parent / f"{path.stem}.{core}.answers"
    said = tool(*command, f"+pairs={sets[path]}", f"+answers={answers}")
    found = re.search(r"pairs=(\d+) clocks=(\d+) lone=(\d+)", said)
    if not found:
        raise fpga.ToolError(f"{core} on {path.stem}: {said.strip()}")
    counts = check.judge(path, answers)
    # the first pair was alone
    return counts | dict(clocks=int(found[2]) / max(1, counts["pairs"] - 1), lone=int(found[3]))


def measure(name, top, files, options):
    """Area and clocks of a core by the flow of scripts/fpga.py."""
    flow = fpga.arguments(["--nextpnr", str(options.nextpnr)] if options.nextpnr else [])
    row = fpga.Row(name, top, shape="", more=modules_of(files))
    synthesis = fpga.synthesise(row, flow)
    reports = {seed: fpga.place(row, synthesis, seed, flow) for seed in range(1, options.area + 1)}
    module, _, _ = fpga.module_cells(fpga.cells((synthesis / "stat.json").read_text()))
    clocks = [fpga.fmax(report) for report in reports.values()]
    return {"lut4": module["LUT4"], "carry": module["CCU2C"], "ff": module["TRELLIS_FF"], "dsp": module["MULT18X18D"],
            "mhz": statistics.median(clocks) if clocks else None, "seeds": len(clocks)}


def committed():
    """The row tri_tri of docs/hardware/fpga.md."""
    line = re.search(r"^\| `tri_tri` \|(.*)\|$", (ROOT / "docs/hardware/fpga.md").read_text(), re.M)[1].split("|")
    lut4, comb, ff, dsp, _, ram, clocks = (cell.strip() for cell in line[2:9])
    # sites: logic, two for each carry, six for each distributed RAM
    carry = (int(comb) - int(lut4) - 6 * int(ram)) // 2
    return {"lut4": int(lut4), "carry": carry, "ff": int(ff), "dsp": int(dsp),
            "mhz": float(clocks.split(" / ")[1]), "seeds": int(re.search(r"(\d+) seed", clocks)[1])}


def percent(part, whole):
    return f"{100 * part / whole:.3g} %" if part else "0"


def cores_table(found, areas):
    head = ["core", "18x18 multipliers", "LUT4, logic", "carry", "FF", "Fmax, MHz", "latency, clocks",
            f"clocks a pair, `{SPEED}`", f"10^6 pairs/s, `{SPEED}`", "undecided: sets on the grid",
            f"undecided: `{SPEED}`", "wrong"]
    body = []
    for name, sets in found.items():
        area = areas.get(name)
        placed = area and area["mhz"]
        rate = f"{area['mhz'] / sets[SPEED]['clocks']:.1f}" if placed else "-"
        clock = f"{area['mhz']:.1f}, {area['seeds']} seed{'s' if area['seeds'] > 1 else ''}" if placed else "-"
        on_grid = [counts for counts in sets.values() if not counts["rounded"]]
        open_of = lambda some: percent(*(sum(counts[key] for counts in some) for key in ("undecided", "pairs")))
        lone = sorted({counts["lone"] for counts in sets.values()})
        body.append([f"`{name}`", *(area[key] if area else "-" for key in ("dsp", "lut4", "carry", "ff")), clock,
                     f"{lone[0]} to {lone[-1]}" if lone[1:] else lone[0],
                     f"{sets[SPEED]['clocks']:.2f}", rate, open_of(on_grid), open_of([sets[SPEED]]),
                     sum(counts["wrong_no"] + counts["wrong_yes"] for counts in sets.values())])
    return datasheet.table(head, body)


def sets_table(found):
    cores = [*found]
    head = ["set", "pairs", "meet", *(f"`{core}`: {what}" for core in cores for what in ("clocks a pair", "undecided"))]
    body = []
    for name, counts in found[cores[0]].items():
        cells = [f"`{name}`", counts["pairs"], f"{100 * counts['meet'] / counts['pairs']:.1f} %"]
        for core in cores:
            of = found[core][name]
            cells += [f"{of['clocks']:.2f}", percent(of["undecided"], of["pairs"])]
        body.append(cells)
    return datasheet.table(head, body)


def arguments():
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("--pairs", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--core", action="append", default=[])
    parser.add_argument("--simulator", choices=("verilator", "icarus"), default="verilator")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--area", type=int)
    parser.add_argument("--nextpnr", type=os.path.abspath)
    parser.add_argument("--fault", type=int, choices=(0, 1, 2), default=0)
    parser.add_argument("--committed", action="store_true")
    parser.add_argument("--write", action="store_true")
    options = parser.parse_args()
    options.cores = dict(CORES)
    for core in options.core:
        name, _, files = core.partition("=")
        if not re.fullmatch(r"[A-Za-z]\w*", name) or not all((ROOT / file).is_file() for file in files.split(",")):
            parser.error(f"--core {core}: needs NAME=FILE[,FILE...], files from the root of the repository")
        options.cores[name] = (name, files.split(","))
    if not set(options.only) <= set(options.cores):
        parser.error(f"--only: one of {' '.join(options.cores)}")
    if options.only:
        options.cores = {name: core for name, core in options.cores.items() if name in options.only}
    if not 1 <= options.pairs <= 16000 or (options.area or 0) < 0:
        parser.error("--pairs is 1 to 16000 (a tag has 16 bits), --area at least 0")
    return options


def main():
    if set(sys.argv) & {"-h", "--help"}:
        print(__doc__)
        return 0
    options = arguments()
    BUILD.mkdir(parents=True, exist_ok=True)
    try:
        print(tool(sys.executable, "-B", HERE / "check.py", "self-test").strip(), flush=True)
        paths = make_sets(options)
        sets = {path: as_the_bench_reads(path) for path in paths.values()}
        print(f"sets={len(sets)} seed={options.seed} folder={next(iter(sets)).parent.relative_to(ROOT)}", flush=True)
        found = {}
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            for name, (top, files) in options.cores.items():
                command = build(name, top, files, options)
                run = lambda path: simulate(name, command, path, sets)
                found[name] = dict(zip(paths, pool.map(run, paths.values())))
                for set_name, counts in found[name].items():
                    counts["rounded"] = check.read_set(paths[set_name])[0] > 1
        areas = {}
        for name, (top, files) in options.cores.items():
            if name == "tri_tri" and options.committed:
                areas[name] = committed()
            elif options.area is not None:
                areas[name] = measure(name, top, files, options)
    except (fpga.ToolError, check.BadFileError, OSError) as error:
        print(f"run.py: {error}", file=sys.stderr)
        return 1
    tables = {"cores": cores_table(found, areas), "sets": sets_table(found)}
    print("\n".join(tables.values()))
    total = lambda sets, *keys: sum(counts[key] for counts in sets.values() for key in keys)
    bad = 0
    for name, of in found.items():
        wrong, missing = total(of, "wrong_no", "wrong_yes"), total(of, "missing")
        bad += wrong + missing
        for set_name, counts in of.items():
            if counts["wrong_no"] or counts["wrong_yes"] or counts["missing"]:
                print(f"{name} on {set_name}: says no for {counts['wrong_no']} pairs that meet, yes for "
                      f"{counts['wrong_yes']} that do not, nothing for {counts['missing']}")
        print(f"{name} pairs={total(of, 'pairs')} undecided={total(of, 'undecided')} wrong={wrong} missing={missing}")
    if options.write and not bad:
        for name, table in tables.items():
            datasheet.rewrite(PAGE, name, table)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
