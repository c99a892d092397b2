#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs the examples of a Markdown text and compares what they print with what the text shows.

usage: doc_examples.py [--update] <program> <text.md>
An example is an indented line "$ command" and the indented lines below it: standard output and standard error.
Examples run in the root of the repository, which holds the folder docs/ of <text.md>; --update writes the real output
into the text.
"""
import os
import subprocess
import sys

INDENT = "    "
PROMPT = INDENT + "$ "


def run(command, program, folder):
    path = os.path.dirname(os.path.abspath(program)) + os.pathsep + os.environ["PATH"]
    done = subprocess.run(["bash", "-c", command], cwd=folder, env={**os.environ, "PATH": path}, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=120)
    return [(INDENT + line).rstrip() for line in done.stdout.splitlines()]


def main():
    update = "--update" in sys.argv
    program, text = [a for a in sys.argv[1:] if a != "--update"]
    folder = os.path.abspath(text).rsplit(f"{os.sep}docs{os.sep}", 1)[0]
    with open(text, encoding="utf-8") as f:
        lines = f.read().splitlines()
    result, examples, stale = [], 0, 0
    i = 0
    while i < len(lines):
        result.append(lines[i])
        i += 1
        if not result[-1].startswith(PROMPT):
            continue
        examples += 1
        shown = []
        while i < len(lines) and lines[i].startswith(INDENT) and not lines[i].startswith(PROMPT):
            shown.append(lines[i])
            i += 1
        real = run(result[-1][len(PROMPT):], program, folder)
        result += real
        if shown != real:
            stale += 1
            if not update:
                print("\n".join(["differs: " + result[-len(real) - 1], "shown:", *shown, "real:", *real]))
    if update:
        with open(text, "w", encoding="utf-8") as f:
            f.write("\n".join(result) + "\n")
    print(f"{examples} examples, {stale} {'updated' if update else 'stale'}")
    return 1 if examples == 0 or (stale and not update) else 0


if __name__ == "__main__":
    sys.exit(main())
