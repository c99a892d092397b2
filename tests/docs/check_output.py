#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A page shows what a program prints: the text block behind the line `<!-- output of NAME -->`.

usage: check_output.py [--write] PAGE PROGRAM    (NAME is the program's file name)"""
import pathlib
import re
import subprocess
import sys

page, program = (pathlib.Path(argument) for argument in [a for a in sys.argv[1:] if a != "--write"])
text = page.read_text()
block = re.compile(rf"(<!-- output of {re.escape(program.name)} -->\n```text\n).*?(```\n)", re.S)
printed = subprocess.run([program], stdout=subprocess.PIPE, text=True, check=True).stdout
fresh, found = block.subn(lambda match: match[1] + printed + match[2], text)
if "--write" in sys.argv:
    page.write_text(fresh)
    text = fresh
if found != 1 or text != fresh:
    sys.exit(f"{page}: the output of {program.name} is {'missing' if found != 1 else 'stale'}; run {sys.argv[0]} --write {page} {program}")
print(f"{page.name}: as {program.name} prints it")
