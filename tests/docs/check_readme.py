#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""README.md fits on two screens, and what it claims is said elsewhere: figures on the pages that measure them, the Verilog
in examples/, the make targets in the Makefile, the CMake lines in tests/install.

usage: check_readme.py ROOT"""
import pathlib
import re
import sys

MOST_LINES = 80
root = pathlib.Path(sys.argv[1])
readme = (root / "README.md").read_text()
wrong = []


def expect(found, what):
    if not found:
        wrong.append(what)


def squeezed(text):
    return " ".join(text.split())


expect(readme.count("\n") <= MOST_LINES, f"{readme.count(chr(10))} lines; at most {MOST_LINES}")

# Rows "[..](docs/modules/cchip_primtest_<row>.md) | MHz | LUT4 | DSP | pairs" against docs/hardware/fpga.md.
rows = re.findall(r"cchip_primtest_(\w+)\.md\) \| ([\d.]+) \| (\d+) \| (\d+) \| ([\d.]+) \|$", readme, re.M)
expect(len(rows) == 3, f"{len(rows)} rows of primitive tests; there should be 3")
fpga = (root / "docs/hardware/fpga.md").read_text()
for name, *figures in rows:
    cells = re.search(rf"^\| `{name}` \| 16 \|(.*)$", fpga, re.M)
    expect(cells, f"docs/hardware/fpga.md has no row {name}")
    if cells:
        _, lut, _, _, dsp, _, _, clock, _, pairs = [cell.strip() for cell in cells[1].split("|")][:10]
        median = clock.split(" / ")[1]
        expect(figures == [median, lut, dsp, pairs], f"{name}: {figures}, docs/hardware/fpga.md has {[median, lut, dsp, pairs]}")

# The ratio to FCL and the number of answers compared, against docs/cpp/speed.md.
speed = (root / "docs/cpp/speed.md").read_text()
mean = re.search(r"^\| \*\*touch, near and deep\*\* \| ([\d.]+)", speed, re.M)
expect(mean and f": {mean[1]} times as fast for touch, near and deep" in readme, "not the mean of docs/cpp/speed.md")
compared = re.search(r"answers compared with FCL's: (\d+), FCL errs in: 0, differences: 0$", speed, re.M)
expect(compared and f"{int(compared[1]):,} answers compared, no difference" in readme, "not the answers of docs/cpp/speed.md")

verilog = re.findall(r"^```verilog\n(.*?)^```$", readme, re.S | re.M)
example = squeezed((root / "examples/tri_tri_instance.v").read_text())
expect(len(verilog) == 1, "there should be one block of Verilog")
for block in verilog:
    code = re.sub(r"  // the rest: .*", "", block)
    expect(squeezed(code) in example, "the Verilog is not that of examples/tri_tri_instance.v")

targets = set(re.findall(r"^([a-z][a-z0-9-]*):.*##", (root / "Makefile").read_text(), re.M))
named = set(re.findall(r"\bmake ([a-z][a-z0-9-]*)(?=`|\s{2}| #)", readme))
expect({"sim", "test"} <= named, "make sim and make test are the two commands that it promises")
expect(named <= targets, f"no targets of the Makefile: {', '.join(sorted(named - targets))}")
cmake = re.search(r"^```cmake\n(.*?)^```$", readme, re.S | re.M)
lines = re.sub(r" *#.*", "", cmake[1]).splitlines() if cmake else []
project = (root / "tests/install/subdirectory/CMakeLists.txt").read_text().replace("(../../.. collisionchip)", "(collisionchip)")
expect(lines and all(line in project.splitlines() for line in lines), "the CMake lines are not those of tests/install/subdirectory")

print("\n".join(f"README.md: {line}" for line in wrong) if wrong else f"{len(rows)} rows, {len(named)} make targets")
sys.exit(1 if wrong else 0)
