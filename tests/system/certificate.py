#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Certificates that `cchip collide --certificate` writes are accepted by the checker in Python, which shares no code
with the program, and tell what the program tells; with another pose they are refused.

usage: certificate.py CCHIP FOLDER_OF_MESHES"""
import pathlib
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "lib/python/src/collisionchip"))
import check  # noqa: E402

cchip, models = sys.argv[1:]
cube = str(pathlib.Path(models) / "OFF/Cube.off")
identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]
mesh = check.read_mesh(pathlib.Path(cube).read_text())
checked = 0
with tempfile.TemporaryDirectory() as folder:
    proof = pathlib.Path(folder) / "proof.jsonl"
    for options in ([], ["--contacts", "first"], ["--counts", "crossing"], ["--contacts", "first", "--relation"]):
        for move in ([0.5, 0.25, 0.125], [1, 0.75, 0.75], [1.0000000000000002, 0, 0], [0, 0, 0], [5, 0, 0]):
            command = [cchip, "collide", cube, cube, "--pose", ",".join(map(str, move)), "--format", "csv", *options]
            answer = subprocess.run([*command, "--certificate", proof], check=True, capture_output=True,
                                    text=True)
            pose = identity[:]
            pose[3::4] = move
            lines = proof.read_text().splitlines()
            claim = check.check([mesh, mesh], [float(x) for x in identity + pose], lines)
            rows = [row.split(",") for row in answer.stdout.splitlines()[1:]]
            told = [[int(x) for x in row[:2]] for row in rows]
            claimed = [c[:2] for c in claim["contacts"]]
            # the first contact that only touches is proved with all others
            assert claimed == told if "first" not in options else (not told
                                                                   and not claimed) or told[0] in claimed, (
                                                                       command, claim)
            pose[3] += 1
            try:
                check.check([mesh, mesh], [float(x) for x in identity + pose], lines)
                sys.exit(f"another pose is accepted: {command}")
            except check.Refused:
                checked += 1
print(f"certificates={checked}")
sys.exit(0 if checked == 20 else 1)
