#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/cpp/touching.md: its table is what touching_table prints, every row is a test of test_touching and every test a row;
its code is part of examples/touching.cpp, whose output it shows.

usage: check_touching.py [--write] ROOT TOUCHING_TABLE TEST_TOUCHING EXAMPLE

With --write the table and the output are written into the page first."""
import pathlib
import re
import subprocess
import sys

TABLE = re.compile(r"(<!-- generated: begin -->\n).*?(<!-- generated: end -->)", re.S)
OUTPUT = re.compile(r"(```text\n).*?(```\n)", re.S)


def output(*command, check=True):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=check).stdout


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--write"]
    root, table_program, test_program, example = arguments
    page = pathlib.Path(root) / "docs" / "cpp" / "touching.md"
    text = page.read_text()
    table = output(table_program)
    fresh = TABLE.sub(lambda found: found[1] + table + found[2], text, count=1)
    fresh = OUTPUT.sub(lambda found: found[1] + output(example) + found[2], fresh, count=1)
    if "--write" in sys.argv:
        page.write_text(fresh)
        text = fresh
    wrong = []
    if not TABLE.search(text) or not OUTPUT.search(text) or text != fresh:
        wrong.append(f"the table or the output is stale, run: {pathlib.Path(__file__).name} --write {' '.join(arguments)}")

    rows = re.findall(r"^\| ([^|]+) \| (?:apart|touching|crossing) \|", table, re.M)
    listed = output(test_program, "--list-test-names-only", check=False)  # its exit code is the number of tests
    tests = [name.strip() for name in listed.splitlines() if name.strip()]
    if len(rows) < 10 or len(set(rows)) != len(rows):
        wrong.append(f"{len(rows)} rows, {len(set(rows))} names; there should be many, each once")
    wrong += [f"no test of the row '{name}'" for name in sorted(set(rows) - set(tests))]
    wrong += [f"no row of the test '{name}'" for name in sorted(set(tests) - set(rows))]

    source = (pathlib.Path(root) / "examples" / "touching.cpp").read_text()
    blocks = re.findall(r"^```cpp\n(.*?)^```$", text, re.S | re.M)
    if not blocks or not all(block in source for block in blocks):
        wrong.append("the C++ in it is not in examples/touching.cpp")

    print("\n".join(f"docs/cpp/touching.md: {line}" for line in wrong) if wrong else f"{len(rows)} rows, each with its test")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
