#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/cpp/touching.md: its table is what touching_table prints, every row is a test of test_touching and every test a
row; its code is part of examples/touching.cpp, whose output it shows. docs/cpp/touching_stays.md: its table is what
touching_table --far prints, in the columns of the libraries that this build has.

usage: check_touching.py [--write] ROOT TOUCHING_TABLE TEST_TOUCHING EXAMPLE

With --write the table and the output are written into the page first."""
import pathlib
import re
import subprocess
import sys

FAR_TEST = "the same parts at the origin and far away"  # every row of the other page at once
TABLE = re.compile(r"(<!-- generated: begin -->\n).*?(<!-- generated: end -->)", re.S)
OUTPUT = re.compile(r"(```text\n).*?(```\n)", re.S)


def output(*command, check=True):
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=check).stdout


def columns(table, names):
    """Rows of a table as lists of the cells of these columns."""
    rows = [[cell.strip() for cell in line.strip("|").split("|")]
            for line in table.splitlines() if line.startswith("| ")]
    return [[row[rows[0].index(name)] for name in names] for row in rows]


def with_python(root, table_program, table, last):
    """The table and its last line with the columns of Python's libraries, if `scripts/run peers` has installed
    these."""
    python = root / "build" / "touching" / "bin" / "python"
    if not (root / "build" / "touching" / "touching_requirements.txt").exists():
        return table, last
    cases = output(table_program, "--far-cases")
    answers = subprocess.run([python, root / "bench" / "peers" / "touching_python.py"], input=cases,
                             stdout=subprocess.PIPE, text=True,
                             check=True).stdout.splitlines()
    names = answers[0].split("\t")
    lines = table.splitlines()
    lines[0] += "".join(f" {name} |" for name in names)
    lines[1] += "---|" * len(names)
    wrong = [0] * len(names)
    for i, (case, line) in enumerate(zip(cases.splitlines(), answers[1:], strict=True), start=2):
        right = "yes" if case[0] == "1" else "no"
        for k, answer in enumerate(line.split("\t")):
            wrong[k] += answer != right
            lines[i] += f" {answer} |" if answer == right else f" **{answer}** |"
    return "\n".join(lines), last + "".join(f" {name}_wrong={count}" for name, count in zip(names, wrong))


def check_far(root, table_program, write):
    """What is wrong with docs/cpp/touching_stays.md."""
    page = root / "docs" / "cpp" / "touching_stays.md"
    printed = output(table_program, "--far")
    table, last = with_python(root, table_program, *printed.rstrip("\n").rsplit("\n", 1))
    if write:
        page.write_text(TABLE.sub(lambda found: f"{found[1]}{table}\n\n    {last}\n{found[2]}",
                                  page.read_text(), count=1))
    shown = TABLE.search(page.read_text())
    names = [cell.strip() for cell in table.splitlines()[0].strip("|").split("|")]
    if not shown:
        return ["docs/cpp/touching_stays.md has no table"]
    head = [cell.strip()
            for cell in next(line for line in shown[0].splitlines() if line.startswith("| ")).strip("|").split("|")]
    both = [name for name in names if name in head]
    if len(both) < 7 or columns(shown[0], both) != columns(table, both):
        return ["docs/cpp/touching_stays.md: the table is stale, run this script with --write after scripts/run peers"]
    return []


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
        wrong.append(f"the table or the output is stale, run: {pathlib.Path(__file__).name} --write "
                     f"{' '.join(arguments)}")

    rows = re.findall(r"^\| ([^|]+) \| (?:apart|touching|crossing) \|", table, re.M)
    listed = output(test_program, "--list-test-names-only", check=False)  # its exit code is the number of tests
    tests = [name.strip() for name in listed.splitlines() if name.strip() and not name.startswith(FAR_TEST)]
    if len(rows) < 10 or len(set(rows)) != len(rows):
        wrong.append(f"{len(rows)} rows, {len(set(rows))} names; there should be many, each once")
    wrong += [f"no test of the row '{name}'" for name in sorted(set(rows) - set(tests))]
    wrong += [f"no row of the test '{name}'" for name in sorted(set(tests) - set(rows))]

    wrong += check_far(pathlib.Path(root), table_program, "--write" in sys.argv)

    source = (pathlib.Path(root) / "examples" / "touching.cpp").read_text()
    blocks = re.findall(r"^```cpp\n(.*?)^```$", text, re.S | re.M)
    if not blocks or not all(block in source for block in blocks):
        wrong.append("the C++ in it is not in examples/touching.cpp")

    print("\n".join(f"docs/cpp/touching.md: {line}" for line in wrong) if wrong
          else f"{len(rows)} rows, each with its test")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
