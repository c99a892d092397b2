#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The version is in one place, project(collisionchip VERSION ...) of CMakeLists.txt; what cannot read it there says the
same, and the last release of CHANGELOG.md has this version and the date of CITATION.cff.

usage: check_version.py ROOT [--tag TAG] [--notes FILE]
  --tag    a tag that is to be released: must be v and the version
  --notes  writes what CHANGELOG.md says of the version
Exit codes: 0 all the same, 1 not."""
import argparse
import pathlib
import re
import sys

parser = argparse.ArgumentParser()
parser.add_argument("root", type=pathlib.Path)
parser.add_argument("--tag")
parser.add_argument("--notes", type=pathlib.Path)
options = parser.parse_args()
root = options.root
wrong = []


def read(name, pattern):
    found = re.search(pattern, (root / name).read_text(), re.M)
    if not found:
        sys.exit(f"{name}: nothing like {pattern}")
    return found[1]


def expect(name, pattern, value):
    if read(name, pattern) != value:
        wrong.append(f"{name}: {read(name, pattern)} instead of {value}")


version = read("CMakeLists.txt", r"^project\(collisionchip VERSION ([\d.]+)")
expect("CITATION.cff", r"^version: (.*)$", version)
expect("collisionchip.core", r"^name: ::collisionchip:(.*)$", version)
expect("CHANGELOG.md", r"^## \[(\d[^\]]*)\]", version)
expect("CHANGELOG.md", r"^## \[\d[^\]]*\] - (.*)$", read("CITATION.cff", r"^date-released: (.*)$"))
# The Python package reads CMakeLists.txt by a pattern of its own.
python = (root / "pyproject.toml").read_text()
pattern = read("pyproject.toml", r"^regex = '(.*)'$")
if not re.search(r'^dynamic = \["version"\]$', python, re.M) or 'input = "CMakeLists.txt"' not in python:
    wrong.append("pyproject.toml: does not read the version from CMakeLists.txt")
else:
    expect("CMakeLists.txt", pattern.replace("?P<value>", ""), version)
if options.tag and options.tag != f"v{version}":
    wrong.append(f"tag {options.tag}: the version is {version}, so it must be v{version}")
if options.notes:
    options.notes.write_text(read("CHANGELOG.md",
                                  rf"^## \[{re.escape(version)}\].*\n((?:(?!## ).*\n?)*)").strip() + "\n")
print("\n".join(wrong) if wrong else version)
sys.exit(bool(wrong))
