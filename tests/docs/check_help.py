#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""make help shows every target of the Makefile that has a text, once, with that text; the scripts that it starts are executable; make install builds all that CMake installs.

usage: check_help.py ROOT"""
import collections
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
# Without an environment of a make above this one.
shown = subprocess.run(["env", "-u", "MAKEFLAGS", "-u", "MAKELEVEL", "make", "--no-print-directory", "-C", root, "help"], check=True,
                       stdout=subprocess.PIPE, text=True).stdout
times = r"(?:\d+ (?:s|min)|hours)"
listed = re.findall(rf"^  make (\S+) +(?:{times} +)?(.*)$", shown, re.M)
targets = dict(re.findall(r"^([a-z][a-z0-9-]*):.*?## (.*)$", (root / "Makefile").read_text(), re.M))
count = collections.Counter(name for name, _ in listed)
wrong = [f"make help shows {name} {count[name]} times" for name in targets if count[name] != 1]
wrong += [f"make help shows {name}, which is no target with a text" for name in count if name not in targets]
wrong += [f"make help, {name}: '{text}'" for name, text in listed if name in targets and text != targets[name]]
installed = re.findall(r"install\(TARGETS ((?:cchip\w* )+)", (root / "cmake/CchipInstall.cmake").read_text())
built = re.search(r"^install:.*\n\tcmake --build .* --target (.*)$", (root / "Makefile").read_text(), re.M)[1].split()
wrong += [f"make install does not build {name}, which CMake installs" for names in installed for name in names.split() if name not in built]
wrong += [f"{name}, which the Makefile starts, is not executable" for name in set(re.findall(r"^\t([\w/]+\.(?:py|sh)) ", (root / "Makefile").read_text(), re.M))
          if not (root / name).stat().st_mode & 0o100]
print("\n".join(wrong) if wrong else f"{len(targets)} targets")
sys.exit(bool(wrong) or len(targets) < 40)
