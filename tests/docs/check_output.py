#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A page shows what a program prints: the text block behind the line `<!-- output of NAME -->`.

usage: check_output.py [--write] [--but REGEX] PAGE PROGRAM    (NAME is the program's file name)
  --write      put the output into the page
  --but REGEX  what depends on the machine, such as times, and may differ"""
import argparse
import pathlib
import re
import subprocess
import sys

parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
parser.add_argument("--write", action="store_true")
parser.add_argument("--but", default="(?!)")
parser.add_argument("page", type=pathlib.Path)
parser.add_argument("program", type=pathlib.Path)
options = parser.parse_args()
page, program = options.page, options.program
text = page.read_text()
block = re.compile(rf"(<!-- output of {re.escape(program.name)} -->\n```text\n).*?(```\n)", re.S)
printed = subprocess.run([program], stdout=subprocess.PIPE, text=True, check=True).stdout
fresh, found = block.subn(lambda match: match[1] + printed + match[2], text)
same = lambda either: re.sub(options.but, "", either)
if options.write:
    page.write_text(fresh)
    text = fresh
if found != 1 or same(text) != same(fresh):
    sys.exit(f"{page}: the output of {program.name} is {'missing' if found != 1 else 'stale'}; run {sys.argv[0]} "
             f"--write {page} {program}")
print(f"{page.name}: as {program.name} prints it")
