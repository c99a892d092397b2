#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compares the rules of docs/paper/reconfiguration-library.md with the test cases of test_rc, both ways.

usage: check_rules.py PAGE TEST_PROGRAM
"""
import re
import subprocess
import sys


def names_in(page):
    """Test names in the last column of the tables between the markers."""
    with open(page, encoding="utf-8") as file:
        text = file.read()
    names = []
    for part in re.findall(r"<!-- tests: begin -->(.*?)<!-- tests: end -->", text, re.S):
        for row in part.splitlines():
            if row.startswith("|"):
                names += re.findall(r"`([^`]*)`", row.rstrip(" |").rsplit("|", 1)[1])
    return set(names)


def names_of(program):
    listed = subprocess.run([program, "--list-test-names-only"], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            text=True, check=False)  # its exit code is the number of tests
    return set(filter(None, map(str.strip, listed.stdout.splitlines())))


def main():
    page, program = sys.argv[1:]
    written, tested = names_in(page), names_of(program)
    if not written or not tested:
        sys.exit(f"{page} names {len(written)} tests, {program} has {len(tested)}; both should be many")
    for name in sorted(written - tested):
        print(f"{page}: no test '{name}' in {program}")
    for name in sorted(tested - written):
        print(f"{page}: does not mention the test '{name}' of {program}")
    if written != tested:
        sys.exit(1)
    print(f"{len(tested)} tests, all of them in {page}")


if __name__ == "__main__":
    main()
