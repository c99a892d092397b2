#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""README.md fits on two screens, and what it claims is said elsewhere: figures on the pages that measure them, the
Verilog in examples/, the make targets in the Makefile, the CMake lines in tests/install.

usage: check_readme.py ROOT"""
import pathlib
import re
import sys

MOST_LINES = 95
MOST_COLUMNS = 80  # of code: more scrolls in the 830 pixels of a README
root = pathlib.Path(sys.argv[1])
readme = (root / "README.md").read_text()
wrong = []


def expect(found, what):
    if not found:
        wrong.append(what)


def squeezed(text):
    return " ".join(text.split())


expect(readme.count("\n") <= MOST_LINES, f"{readme.count(chr(10))} lines; at most {MOST_LINES}")

code = [line for block in re.findall(r"^```\w*\n(.*?)^```$", readme, re.S | re.M) for line in block.splitlines()]
code += [line[4:] for line in re.findall(r"^    .*$",
                                         re.sub(r"^```\w*\n.*?^```$", "", readme, flags=re.S | re.M), re.M)]
for line in code:
    expect(len(line) <= MOST_COLUMNS, f"{len(line)} columns, at most {MOST_COLUMNS}: {line.strip()}")

# Rows "[..](docs/modules/cchip_primtest_<row>.md) | MHz | LUT4 logic | LUT4 sites | DSP | pairs" against
# docs/hardware/fpga.md.
rows = re.findall(r"cchip_primtest_(\w+)\.md\) \| ([\d.]+) \| (\d+) \| (\d+) \| (\d+) \| ([\d.]+) \|$", readme, re.M)
expect(len(rows) == 3, f"{len(rows)} rows of primitive tests; there should be 3")
fpga = (root / "docs/hardware/fpga.md").read_text()
for name, *figures in rows:
    cells = re.search(rf"^\| `{name}` \| 16 \|(.*)$", fpga, re.M)
    expect(cells, f"docs/hardware/fpga.md has no row {name}")
    if cells:
        _, logic, sites, _, dsp, _, _, clock, _, pairs = [cell.strip() for cell in cells[1].split("|")][:10]
        median = clock.split(" / ")[1]
        expect(figures == [median, logic, sites, dsp, pairs],
               f"{name}: {figures}, docs/hardware/fpga.md has {[median, logic, sites, dsp, pairs]}")

# The ratio to FCL and the number of answers compared, against docs/cpp/speed.md.
speed = (root / "docs/cpp/speed.md").read_text()
mean = re.search(r"^\| \*\*touch, near and deep\*\* \| ([\d.]+)", speed, re.M)
expect(mean and f": {mean[1]} times FCL" in readme, "not the mean of docs/cpp/speed.md")
far = re.search(r"^\| far \| ([\d.]+)", speed, re.M)
expect(far and f"far apart: {far[1]};" in readme, "far apart: not the ratio of docs/cpp/speed.md")
robot = re.search(r"^\| FCL native \|(.*)$", speed.split("begin robot")[1], re.M)
ratios = sorted(re.findall(r"\(([\d.]+)\)", robot[1]), key=float) if robot else []
expect(ratios and f": {ratios[0]} to {ratios[-1]}. " in readme,
       f"robot cell: not {' '.join(ratios)}, as docs/cpp/speed.md has it")
compared = re.search(r"answers compared with FCL's: (\d+), FCL errs in: \d+, differences: 0$", speed, re.M)
expect(compared and f"{int(compared[1]):,} answers compared, none of ours wrong" in readme,
       "not the answers of docs/cpp/speed.md")

# The two cases in which FCL errs, and the number of all, against docs/cpp/touching.md.
cases = re.findall(r"^\| (.*?) \| (apart|touching|crossing) \|.*\| (no hit|hit) \|$",
                   (root / "docs/cpp/touching.md").read_text(), re.M)
expect(f"[{len(cases)} cases](" in readme, f"docs/cpp/touching.md has {len(cases)} cases")
for case in (("peg in its hole, thinner by 2^-53", "apart", "hit"),
             ("vertex on a face, both turned and far from the origin", "touching", "no hit")):
    expect(case in cases, f"docs/cpp/touching.md has no case {case}")

verilog = re.findall(r"^```verilog\n(.*?)^```$", readme, re.S | re.M)
example = squeezed((root / "examples/tri_tri_instance.v").read_text())
expect(len(verilog) == 1, "there should be one block of Verilog")
for block in verilog:
    # ports by name, in any order
    ports = re.findall(r"\.\w+\((?:[^()]*)\)", block)
    others = re.sub(r"\.\w+\([^()]*\),?|//.*", "", block)
    expect(len(ports) > 5 and all(port in example for port in ports)
           and squeezed(others) == "cchip_primtest_tri_tri u_tri_tri (" in example,
           "the Verilog is not that of examples/tri_tri_instance.v")

targets = set(re.findall(r"^([a-z][a-z0-9-]*):.*##", (root / "Makefile").read_text(), re.M))
named = set(re.findall(r"\bmake ([a-z][a-z0-9-]*)(?=`|\s{2}| #)", readme))
expect({"sim", "test"} <= named, "make sim and make test are the two commands that it promises")
expect(named <= targets, f"no targets of the Makefile: {', '.join(sorted(named - targets))}")
cmake = re.search(r"^```cmake\n(.*?)^```$", readme, re.S | re.M)
lines = re.sub(r" *#.*", "", cmake[1]).splitlines() if cmake else []
project = (root / "tests/install/subdirectory/CMakeLists.txt").read_text().replace(
    "(../../.. collisionchip)", "(collisionchip)")
expect(lines and all(line in project.splitlines() for line in lines),
       "the CMake lines are not those of tests/install/subdirectory")

print("\n".join(f"README.md: {line}" for line in wrong) if wrong else f"{len(rows)} rows, {len(named)} make targets")
sys.exit(1 if wrong else 0)
