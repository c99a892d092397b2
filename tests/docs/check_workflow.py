#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The commands of the hosted runs exist: each target of make and of scripts/run, each script in the repository; .ci/run
and make wheel are among them, so that what is checked is said in one place.

usage: check_workflow.py ROOT"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1])
targets = {command: set(re.findall(r"^([a-z][a-z0-9-]*):", (root / file).read_text(), re.M))
           for command, file in (("make", "Makefile"), ("scripts/run", "scripts/run.mk"))}
commands, wrong = [], []
for path in [*sorted((root / ".github/workflows").glob("*.yml")), root / ".ci/run"]:
    text = path.read_text()
    found = re.findall(r"^ *(?:- run:|part \w+) (.*)$", text, re.M)
    commands += found
    for command in found:
        words = command.split()
        if words[0] in targets:
            wrong += [f"{path.relative_to(root)}: {words[0]} {word}: no such target" for word in words[1:]
                      if re.fullmatch(r"[a-z][a-z0-9-]*", word) and word not in targets[words[0]]]
        wrong += [f"{path.relative_to(root)}: {word} does not exist" for word in words
                  if re.match(r"(\.ci|scripts|tests)/", word) and not (root / word).exists()]
for needed in (".ci/run", "make wheel", "make build/docs-venv/docs_requirements.txt", "make build", "make test"):
    if needed not in commands:
        wrong.append(f"no hosted or local run calls {needed}")
print("\n".join(wrong) if wrong else f"{len(commands)} commands")
sys.exit(bool(wrong))
