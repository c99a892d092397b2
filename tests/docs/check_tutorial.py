#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the program of a tutorial; program and output must stand in the page as they are, the program in 60 lines.

usage: check_tutorial.py PAGE SOURCE PROGRAM
"""
import re
import subprocess
import sys


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def main():
    page_path, source_path, program = sys.argv[1:]
    blocks = re.findall(r"^```\w*\n(.*?)^```$", read(page_path), re.S | re.M)
    source = read(source_path)
    lines = source.count("\n")
    if lines > 60:
        sys.exit(f"{source_path}: {lines} lines; the tutorial promises at most 60")
    if source.split("\n", 1)[1] not in blocks:  # without the licence line
        sys.exit(f"{page_path}: the program in it is not {source_path}; copy it again")
    output = subprocess.run([program], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=True).stdout
    if not output or output not in blocks:
        sys.exit(f"{page_path}: the output in it is not what {program} prints:\n{output}")
    print(output, end="")


if __name__ == "__main__":
    main()
