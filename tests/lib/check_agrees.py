#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The checkers of certificates in C++ and in Python accept and refuse the same: cases from test_certificate."""
import json
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "lib/python/src/collisionchip"))
import check  # noqa: E402

output = subprocess.run([sys.argv[1], "[.cases]"], stdout=subprocess.PIPE, text=True, check=True).stdout
verdicts = []
for line in output.split("\n"):  # U+2028 ends no line
    if not line.startswith("{"):
        continue
    case = json.loads(line)
    poses = [float(x) for x in case["poses"]]
    meshes = [([[float(x) for x in v] for v in vertices], faces, numbers)
              for vertices, faces, numbers in case["meshes"]]
    try:
        certificates = check.split(case["file"]) if "file" in case else [case["lines"]]
        for lines in certificates:
            check.check(meshes, poses, lines, [(check.hash_mesh(*m), t) for m, t in zip(meshes, case["trees"])])
        accepted = bool(certificates)
    except check.Refused as refused:
        accepted, reason = False, refused
    if accepted != case["accepted"]:
        sys.exit(f"C++ says {case['accepted']}, Python {accepted} {'' if accepted else reason}:\n{line}")
    verdicts.append(accepted)
print(f"accepted={sum(verdicts)} refused={len(verdicts) - sum(verdicts)}")
sys.exit(0 if any(verdicts) and not all(verdicts) else 1)
