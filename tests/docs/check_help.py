#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""make help shows every target of the Makefile that has a text, once, with that text, and scripts/run those of
scripts/run.mk; at most 20 are of the Makefile; the scripts that they start are executable; make install builds all that
CMake installs.

usage: check_help.py ROOT"""
import collections
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
# Without an environment of a make above this one.
times = r"(?:\d+ (?:s|min)|hours)"
wrong, numbers = [], []
for command, words, name_of_list in (("make", ["make", "--no-print-directory", "-C", root, "help"], None),
                                     ("scripts/run", [root / "scripts/run"], "list")):
    shown = subprocess.run(["env", "-u", "MAKEFLAGS", "-u", "MAKELEVEL", *words], check=True, stdout=subprocess.PIPE,
                           text=True).stdout
    listed = re.findall(rf"^  {command} (\S+) +(?:{times} +)?(.*)$", shown, re.M)
    file = "Makefile" if command == "make" else "scripts/run.mk"
    targets = dict(re.findall(r"^([a-z][a-z0-9-]*):.*?## (.*)$", (root / file).read_text(), re.M))
    targets.pop(name_of_list, None)
    count = collections.Counter(name for name, _ in listed)
    wrong += [f"{command} shows {name} {count[name]} times" for name in targets if count[name] != 1]
    wrong += [f"{command} shows {name}, which is no target with a text" for name in count if name not in targets]
    wrong += [f"{command}, {name}: '{text}'" for name, text in listed if name in targets and text != targets[name]]
    numbers.append(len(targets))
installed = re.findall(r"install\(TARGETS ((?:cchip\w* )+)", (root / "cmake/CchipInstall.cmake").read_text())
built = re.search(r"^install:.*\n\tcmake --build .* --target (.*)$", (root / "Makefile").read_text(), re.M)[1].split()
wrong += [f"make install does not build {name}, which CMake installs" for names in installed
          for name in names.split() if name not in built]
wrong += [f"{name}, which make starts, is not executable"
          for name in set(re.findall(r"^\t([\w/]+\.(?:py|sh)) ",
                                     "".join((root / file).read_text() for file in ("Makefile", "scripts/run.mk")),
                                     re.M))
          if not (root / name).stat().st_mode & 0o100]
if numbers[0] > 20:
    wrong.append(f"{numbers[0]} targets of the Makefile have a text; at most 20, others belong into scripts/run.mk")
print("\n".join(wrong) if wrong else f"{numbers[0]} targets of make, {numbers[1]} of scripts/run")
sys.exit(bool(wrong) or numbers[1] < 40)
