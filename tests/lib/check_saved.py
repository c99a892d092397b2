#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Certificates that bench_certificate --save FOLDER wrote, checked by check.py alone.

    check_saved.py FOLDER [EVERY]     every EVERY-th, 1 if it is not given

Last line: checked=N refused=R; exit code 1 if one is refused or there is none."""
import pathlib
import subprocess
import sys

CHECK = pathlib.Path(__file__).resolve().parents[2] / "lib/python/src/collisionchip/check.py"
FILES = ("a.off", "b.off", "poses", "certificate.jsonl")

folders = sorted(p.parent for p in pathlib.Path(sys.argv[1]).glob("*/certificate.jsonl"))
folders = folders[:: int(sys.argv[2]) if len(sys.argv) > 2 else 1]
refused = 0
for folder in folders:
    trees = [folder / f for f in ("a.tree", "b.tree") if (folder / f).exists()]
    run = subprocess.run([sys.executable, CHECK, *(folder / f for f in FILES), *trees], capture_output=True, text=True)
    if run.returncode != 0:
        refused += 1
        print(f"{folder}: {(run.stdout + run.stderr).strip()}")
print(f"checked={len(folders)} refused={refused}")
sys.exit(1 if refused or not folders else 0)
