#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Netlists against the RTL: what synthesis made computes what simulation did.

usage: gates.py simulate [KIND...] [options]    netlists of cchip_primtest_KIND (tri_tri, tri_quad, quad_quad) on the
                                                vectors and the bench of tests/icarus, one netlist with changed LUTs
       gates.py prove [MODULE...] [options]     modules without multipliers, equivalent on every clock for ever
  --technology T    ecp5 or xc7 (Lattice ECP5, Xilinx 7 series); default both
  --vectors PATH    the program cchip_pair_vectors, a target of CMake; simulate needs it
  --verilator PATH  Verilator 5 (default verilator)
  --pairs N         pairs of every netlist with pairs always offered (default 10000)
  --stall-pairs N   pairs of every netlist with idle clocks, back-pressure and resets (default 2000)
  --changed N       LUTs to change, one at a time (default 20)
  --quick           prove: three small modules on ECP5 only
  --build DIR       folder for outputs (default build/gates)
  --jobs N          tools at the same time (default: JOBS of the environment, or 2)
CCHIP_SEED chooses vectors, stalls and changed LUTs (default 1).

simulate: Yosys writes the netlist, Verilator 5 runs it. Cells are Yosys' own models; MULT18X18D and DP16KD, of which
Yosys has only the ports, are those of this folder. The netlist is simulated with short names and one wire per bit,
nothing else is done to it. Lines: `KIND TECHNOLOGY pairs=N mismatches=0 clocks=C`.

prove: RTL and netlist are read back into Yosys, the cells replaced by their models. Both start with every flip-flop
and memory 0 where the netlist does not say otherwise, get 8 clocks (of reset, where there is one) with all other inputs
0 (unknown ones would reach some registers of the RTL and not those of the netlist, or the other way round), and from
there their outputs are proved equal on every clock for all inputs (yosys-abc: scorr, dprove; induction, no bound on the
clocks). A netlist with one LUT changed must not be proved.
Lines: `MODULE PARAMETERS TECHNOLOGY equivalent flipflops=N changed=reported`.

Exit codes: 0 all well, 1 a mismatch or a tool failed, 2 bad arguments."""
import argparse
import concurrent.futures
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import progress  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
HERE = ROOT / "tests" / "gates"
SETTLE = 8  # clocks before a comparison
KINDS = ("tri_tri", "tri_quad", "quad_quad")
YOSYS_CELLS = pathlib.Path(shutil.which("yosys") or "/usr/bin/yosys").resolve().parent.parent / "share" / "yosys"

# without multipliers; widths as used with COORD_W = 16, memories small where a proof does not depend on their size
MODULES = [
    ("cchip_skid_buffer", "WIDTH=8"),
    ("cchip_fifo", "WIDTH=8 DEPTH=5"),
    ("cchip_fifo", "WIDTH=8 DEPTH=16"),
    ("cchip_ram", "WIDTH=8 DEPTH=16 ADDR_W=4"),
    ("cchip_ram", "WIDTH=36 DEPTH=64 ADDR_W=6"),
    ("cchip_delay", "WIDTH=3 DEPTH=5 RESET=1 MEMORY=0"),
    ("cchip_delay", "WIDTH=9 DEPTH=24 RESET=0 MEMORY=1"),
    ("cchip_norm1", "V_W=17"),
    ("cchip_norm1", "V_W=34"),
    ("cchip_sat_select", "COORD_W=16 VERTS_A=3 VERTS_B=3"),
    ("cchip_sat_select", "COORD_W=8 VERTS_A=3 VERTS_B=4"),
    ("cchip_sat_select", "COORD_W=8 VERTS_A=4 VERTS_B=4"),
    ("cchip_sat_compare", "PROJ_W=51 BOUND_W=43 POINTS=3 OWN=1"),
    ("cchip_sat_compare", "PROJ_W=27 BOUND_W=27 POINTS=5 OWN=2"),
    ("cchip_sat_bound", "COORD_W=4 SUBSTAGES=6"),
    ("cchip_sat_bound", "COORD_W=8 SUBSTAGES=10"),
    ("cchip_box_compare", "COORD_W=16 VERTS_A=3 VERTS_B=3"),
    ("cchip_box_compare", "COORD_W=8 VERTS_A=4 VERTS_B=4"),
    ("cchip_axis_programme", "VERTS_A=3 VERTS_B=3 WARPED_EXACT=1"),
    ("cchip_axis_programme", "VERTS_A=3 VERTS_B=4 WARPED_EXACT=1"),
    ("cchip_axis_programme", "VERTS_A=4 VERTS_B=4 WARPED_EXACT=1"),
    # a power of two: the verdict's context is an input, and what a number beyond CONTEXTS does is not defined
    ("cchip_axis_controller", "CONTEXTS=8 CONTEXT_W=3 VERTS_A=3 VERTS_B=3 WARPED_EXACT=1"),
    ("cchip_axis_controller", "CONTEXTS=8 CONTEXT_W=3 VERTS_A=4 VERTS_B=4 WARPED_EXACT=1"),
]
QUICK = [MODULES[0], MODULES[1], ("cchip_axis_controller", "CONTEXTS=4 CONTEXT_W=2 VERTS_A=3 VERTS_B=3 WARPED_EXACT=1")]


class Technology:
    """How to synthesise, and the models of what comes out."""

    def __init__(self, name, file_list, synth, lut, cells, own_models, without_model):
        self.name = name
        self.file_list = file_list
        self.synth = synth
        self.lut = lut  # the LUT that is changed: cell, inputs, output
        self.cells = cells
        self.own_models = [HERE / model for model in own_models]
        self.without_model = without_model  # cells of which Yosys has ports only: using one must be an error

    def sources(self):
        lines = (ROOT / "rtl" / self.file_list).read_text().splitlines()
        return [str(ROOT / "rtl" / line.strip()) for line in lines if line.strip().endswith(".v")]

    def write_cells(self, build):
        text = self.cells.read_text()
        for cell in self.without_model:
            text, found = re.subn(rf"(\(\* blackbox \*\)\s*)?^module {cell}\s*\(.*?^endmodule", "", text,
                                  flags=re.S | re.M)
            if found != 1:
                sys.exit(f"gates.py: {self.cells} has no module {cell}, this Yosys is not the 0.23 it was written for")
        (build / f"cells_{self.name}.v").write_text(text)

    def models(self, build):
        return [f"-I{self.cells.parent}", build / f"cells_{self.name}.v", *self.own_models]


TECHNOLOGIES = {
    "ecp5": Technology("ecp5", "cchip_ecp5.f", "synth_ecp5 -abc9", ("LUT4", "ABCD", "Z"),
                       YOSYS_CELLS / "ecp5" / "cells_sim.v", ["MULT18X18D.v", "DP16KD.v"], ["DP16KD"]),
    # Without keep_hierarchy xilinx_dsp of Yosys 0.23 packs registers of products wrongly whose width it had reduced.
    "xc7": Technology("xc7", "cchip.f",
                      "setattr -mod -set keep_hierarchy 1 cchip_mul18\nsynth_xilinx -family xc7 -flatten",
                      ("LUT4", ["I0", "I1", "I2", "I3"], "O"),
                      YOSYS_CELLS / "xilinx" / "cells_sim.v", [], ["RAMB18E1", "RAMB36E1"]),
}


class Failure(Exception):
    """One line: what failed, and where to look."""


def run(log, *command):
    """Output of a command, which is kept in the file log."""
    result = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                            text=True)
    log.write_text(result.stdout)
    if result.returncode:
        errors = re.findall(r"^.*(?:ERROR|Error|FAIL).*$", result.stdout, re.M)
        raise Failure(f"{pathlib.Path(str(command[0])).name} failed (exit code {result.returncode}), see {log}"
                      f"{': ' + errors[0].strip() if errors else ''}")
    return result.stdout


def yosys(log, script):
    path = log.with_suffix(".ys")
    path.write_text(script)
    return run(log, "yosys", "-s", path)


def files(paths):
    return " ".join(str(path) for path in paths)


def synthesise(technology, folder, top, parameters=""):
    """Writes netlist.v, with the module called gate."""
    settings = " ".join(f"-chparam {name} {value}" for name, value in
                        (parameter.split("=") for parameter in parameters.split()))
    yosys(folder / "synth.log",
          f"read_verilog -DSYNTHESIS -I{ROOT / 'rtl' / 'include'} {files(technology.sources())}\n"
          f"hierarchy -top {top} {settings}\nrename -top gate\n{technology.synth} -top gate\n"
          f"stat\nwrite_verilog -noattr {folder}/netlist.v\n")


# ---- simulation


def changed_luts(technology, folder, count, seed):
    """Copies simulated.v to changed.v with `count` LUTs whose outputs +changed=NUMBER inverts, one at a time."""
    cell, inputs, output = technology.lut
    text = (folder / "simulated.v").read_text()
    starts = [match.start(1) for match in re.finditer(rf"^  ({cell}) #\(", text, re.M)]
    chosen = random.Random(seed).sample(starts, count)
    for number, start in sorted(zip(range(1, count + 1), chosen), key=lambda pair: -pair[1]):
        text = f"{text[:start]}changed_lut #(\n    .NUMBER({number}),{text[start + len(cell) + 3:]}"
    ports = ", ".join(inputs)
    text += (f"\nmodule changed_lut #(parameter INIT = 0, parameter NUMBER = 0) (input {ports}, output {output});\n"
             f"  integer changed;\n  wire kept;\n"
             f'  initial if (!$value$plusargs("changed=%d", changed)) changed = 0;\n'
             f"  {cell} #(.INIT(INIT)) u_lut ({', '.join(f'.{port}({port})' for port in inputs)}, .{output}(kept));\n"
             f"  assign {output} = kept ^ (changed == NUMBER);\nendmodule\n")
    (folder / "changed.v").write_text(text)


def verilate(technology, build, folder, netlist, verilator):
    """The bench with a netlist as a program. Without optimisation: compiling would cost more than it saves."""
    out = folder / f"{netlist}.dir"
    run(folder / f"{netlist}.verilator.log", verilator, "--cc", "--exe", "--main", "--timing",
        "-Wno-fatal", "-Wno-lint", "-Wno-style", "-O3", "-fno-const-bit-op-tree",
        "--x-assign", "unique", "--x-initial", "unique", "--output-split", "0", "--output-split-cfuncs", "0",
        "-DCCHIP_BENCH_TOP=gate", "--top-module", "bench_primtest", "--Mdir", out, *technology.models(build),
        ROOT / "tests/icarus/bench_primtest.v", folder / f"{netlist}.v")
    run(folder / f"{netlist}.make.log", "make", "-C", out, "-f", "Vbench_primtest.mk", "OPT_FAST=-O0", "OPT_SLOW=-O0",
        "VM_PARALLEL_BUILDS=0")
    return out / "Vbench_primtest"


def bench(program, log, vectors, pairs, seed, *arguments):
    """What the bench counted, or None if it reported a failure."""
    start = seed % 1000003 + 1
    result = subprocess.run([program, f"+vectors={vectors}", f"+pairs={pairs}", f"+start={start}",
                             f"+verilator+seed+{seed % 2147483647 + 1}", *arguments],
                            stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    log.write_text(result.stdout)
    passed = re.search(r"^PASS pairs=(\d+) results=(\d+) clocks=(\d+)$", result.stdout, re.M)
    return tuple(map(int, passed.groups())) if passed and not result.returncode else None


def simulate(technology, kind, build, options):
    folder = build / f"{kind}_{technology.name}"
    folder.mkdir(parents=True, exist_ok=True)
    most = max(options.pairs, options.stall_pairs)
    vectors = folder / "vectors.hex"
    run(folder / "vectors.log", options.vectors, kind, vectors, most, options.seed)
    synthesise(technology, folder, f"cchip_primtest_{kind}")
    yosys(folder / "simulated.log", f"read_verilog {folder}/netlist.v\nsplitnets\nopt_clean -purge\nrename -hide\n"
          f"rename -enumerate -pattern n%\nwrite_verilog -noattr {folder}/simulated.v\n")
    program = verilate(technology, build, folder, "simulated", options.verilator)
    for name, pairs, arguments in (("steady", options.pairs, ["+steady"]), ("stalls", options.stall_pairs, [])):
        log = folder / f"{name}.log"
        counted = bench(program, log, vectors, pairs, options.seed, *arguments)
        if not counted or (name == "steady" and counted[1] != pairs):
            raise Failure(f"{name}: mismatch or no end, see {log}: {log.read_text().strip().splitlines()[:1]}")
        say(f"{kind} {technology.name} pairs={counted[1]} mismatches=0 clocks={counted[2]}"
            f"{'' if name == 'steady' else f' (of {counted[0]} offered, with stalls and resets)'}")


def simulate_changed(technology, kind, build, options):
    """One of the netlists again, with LUTs changed: the bench must say so."""
    folder = build / f"{kind}_{technology.name}"
    changed_luts(technology, folder, options.changed, options.seed)
    program = verilate(technology, build, folder, "changed", options.verilator)
    reported = []
    for number in range(options.changed + 1):
        log = folder / f"changed_{number}.log"
        if not bench(program, log, folder / "vectors.hex", min(options.pairs, 1000), options.seed, "+steady",
                     f"+changed={number}"):
            reported.append(number)
    if 0 in reported:
        raise Failure(f"the copy without change fails, see {folder}/changed_0.log")
    say(f"{kind} {technology.name} changed LUTs: {len(reported)} of {options.changed} reported")
    # low bits of an error bound, or states that do not come, may go unnoticed in so few pairs
    if 4 * len(reported) < 3 * options.changed:
        silent = sorted(set(range(1, options.changed + 1)) - set(reported))
        raise Failure(f"too few changed LUTs reported, not those with the numbers {silent} in {folder}/changed.v")


# ---- proofs


def settle(gold, folder):
    """Commands that run module `both` for the clocks before the comparison, of reset if the module `gold` (a file of
    Yosys) has one, and keep what its flip-flops and memories hold then."""
    inputs = re.findall(r"^  wire (?:width (\d+) )?input \d+ \\(\w+)$", gold.read_text(), re.M)
    driven = [name for _, name in inputs if name in ("clk", "rst")]
    connections = ", ".join(f".in_{name}({f'in_{name}' if name in driven else f'{width or 1}' + chr(39) + 'd0'})"
                            for width, name in inputs)
    bench = folder / "settle.v"
    bench.write_text(f"module settle ({', '.join(f'input in_{name}' for name in driven)});\n"
                     f"  both u_both ({connections});\nendmodule\n")
    reset = f"-reset in_rst -rstlen {SETTLE}" if "rst" in driven else ""
    return (f"read_verilog {bench}\nhierarchy -top settle\nasync2sync\n"
            f"sim -clock in_clk {reset} -n {SETTLE} -zinit -w settle\nhierarchy -top both\n")


def equivalent(technology, build, folder, module, parameters, netlist):
    """Whether netlist.v in folder does what the RTL does, and flip-flops of both together."""
    settings = " ".join(f"-chparam {name} {value}" for name, value in (p.split("=") for p in parameters.split()))
    models = technology.models(build)
    low = "proc; flatten; memory -nomap; memory_map; opt -full"
    miter = folder / f"{netlist}.aig"
    yosys(folder / f"{netlist}.proof.log",
          f"read_verilog -DSYNTHESIS -I{ROOT / 'rtl' / 'include'} {files(technology.sources())}\n"
          f"hierarchy -check -top {module} {settings}\nrename -top gold\n{low}\nwrite_rtlil {folder}/gold.il\n"
          f"design -reset\nread_verilog -defer {files(models)}\nread_verilog {folder}/{netlist}.v\n"
          f"hierarchy -check -top gate\n{low}\nwrite_rtlil {folder}/gate.il\n")
    yosys(folder / f"{netlist}.miter.log",
          f"read_rtlil {folder}/gold.il\nread_rtlil {folder}/gate.il\n"
          f"miter -equiv -flatten gold gate both\n{settle(folder / 'gold.il', folder)}"
          "techmap; opt_expr; opt_clean; dffunmap\nsetundef -init -zero\nsetundef -undriven -zero\naigmap\nstat\n"
          f"write_aiger -zinit {miter}\n")
    log = folder / f"{netlist}.abc.log"
    verdict = run(log, "yosys-abc", "-c", f"read {miter}; print_stats; strash; scorr; dprove")
    flipflops = int(re.search(r"lat = *(\d+)", verdict).group(1))
    # dprove spells its verdict by the engine that found it
    proved = re.search(r"^Networks are equivalent|^UNSATISFIABLE", verdict, re.M | re.I)
    refuted = re.search(r"^Networks are not equivalent|^SATISFIABLE", verdict, re.M | re.I)
    if bool(proved) == bool(refuted):
        raise Failure(f"neither proved nor refuted, see {log}")
    return bool(proved), flipflops


def change_lut(folder, seed):
    """netlist.v with one LUT inverted as changed_N.v, for some N; every LUT comes in a random order."""
    text = (folder / "netlist.v").read_text()
    luts = list(re.finditer(r"^  LUT\d #\(\s*\.INIT\((\d+)'h([0-9a-f]+)\)", text, re.M))
    random.Random(seed).shuffle(luts)
    for number, lut in enumerate(luts):
        width = int(lut.group(1))
        value = int(lut.group(2), 16) ^ ((1 << width) - 1)
        (folder / f"changed_{number}.v").write_text(f"{text[:lut.start(2)]}{value:x}{text[lut.end(2):]}")
        yield f"changed_{number}"


def prove(technology, module, parameters, build, options):
    folder = build / re.sub(r"[ =]", "_", f"{module}_{parameters}_{technology.name}")
    folder.mkdir(parents=True, exist_ok=True)
    synthesise(technology, folder, module, parameters)
    proved, flipflops = equivalent(technology, build, folder, module, parameters, "netlist")
    if not proved:
        raise Failure(f"netlist and RTL differ, see {folder}")
    changed = "none to change"
    # a LUT may serve only states that never come: a few may go unnoticed
    for _, netlist in zip(range(5), change_lut(folder, options.seed)):
        changed = "not reported"
        if not equivalent(technology, build, folder, module, parameters, netlist)[0]:
            changed = "reported"
            break
    say(f"{module} {parameters} {technology.name} equivalent flipflops={flipflops} changed={changed}")
    if changed == "not reported":
        raise Failure(f"five netlists with a LUT changed are called equivalent, see {folder}")


# ----


bar = progress.Progress(0, "netlists")
say = bar.say


def parse(arguments):
    if {"-h", "--help"} & set(arguments):
        print(__doc__)
        sys.exit(0)
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("command", choices=("simulate", "prove"))
    parser.add_argument("names", nargs="*")
    parser.add_argument("--technology", choices=TECHNOLOGIES)
    parser.add_argument("--vectors", type=pathlib.Path)
    parser.add_argument("--verilator", default="verilator")
    parser.add_argument("--pairs", type=int, default=10000)
    parser.add_argument("--stall-pairs", type=int, default=2000)
    parser.add_argument("--changed", type=int, default=20)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "gates")
    parser.add_argument("--jobs", type=int, default=int(os.environ.get("JOBS") or 2))
    options = parser.parse_args(arguments)
    options.seed = int(os.environ.get("CCHIP_SEED") or 1)
    options.build = options.build.resolve()
    known = KINDS if options.command == "simulate" else {module for module, _ in MODULES}
    unknown = [name for name in options.names if name not in known]
    if unknown:
        parser.error(f"unknown {unknown[0]}, one of: {' '.join(sorted(known))}")
    if options.command == "simulate" and not (options.vectors and options.vectors.exists()):
        parser.error("simulate needs --vectors PATH of the program cchip_pair_vectors")
    return options


def tasks(options):
    """Functions to call at the same time, each with a name."""
    technologies = [TECHNOLOGIES[options.technology]] if options.technology else list(TECHNOLOGIES.values())
    if options.command == "simulate":
        for technology in technologies:
            for kind in KINDS:
                if not options.names or kind in options.names:
                    yield f"{kind} {technology.name}", simulate, (technology, kind, options.build, options)
        return
    for technology in technologies[:1] if options.quick else technologies:
        for module, parameters in QUICK if options.quick else MODULES:
            if not options.names or module in options.names:
                name = f"{module} {parameters} {technology.name}"
                yield name, prove, (technology, module, parameters, options.build, options)


def main(arguments):
    options = parse(arguments)
    options.build.mkdir(parents=True, exist_ok=True)
    for technology in TECHNOLOGIES.values():
        technology.write_cells(options.build)
    say(f"CCHIP_SEED={options.seed}")
    failed = 0
    with bar, concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        bar.total = len(list(tasks(options)))
        running = [(name, pool.submit(bar.counted(function), *parameters))
                   for name, function, parameters in tasks(options)]
        if options.command == "simulate" and options.changed > 0:
            _, _, (technology, kind, build, _) = next(tasks(options))
            first = running[0][1]
            after = lambda: first.exception() or simulate_changed(technology, kind, build, options)
            running.append((f"{kind} {technology.name} changed", pool.submit(after)))
        for name, task in running:
            try:
                task.result()
            except Failure as failure:
                say(f"FAILED {name}: {failure}")
                failed += 1
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
