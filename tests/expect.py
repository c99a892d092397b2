#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs a command whose exit code and output must both be right.

usage: expect.py CODE REGEX COMMAND [ARGUMENT...]

CODE is the exit code that is expected, REGEX (Python, multi-line: ^ and $ match at lines) must be found in what the
command prints on both outputs. Exit code: 0 both are right, 1 otherwise."""
import re
import subprocess
import sys

code, regex, *command = sys.argv[1:]
result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
print(result.stdout, end="")
if result.returncode != int(code):
    sys.exit(f"expect.py: exit code {result.returncode}, expected {code}: {' '.join(command)}")
if not re.search(regex, result.stdout, re.MULTILINE):
    sys.exit(f"expect.py: the output does not match: {regex}")
