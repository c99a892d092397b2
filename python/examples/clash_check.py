#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which parts in a folder clash? Every mesh file is a part, in the coordinates of the assembly.

usage: clash_check.py FOLDER

Prints a line for each pair of parts that touch: their files, touching or crossing, the number of face pairs in contact.
Exit codes: 0 no two parts cross, 1 some do, 2 fewer than two mesh files."""
import pathlib
import sys

from collisionchip import Object, Scene


def main(folder):
    files = sorted(path for path in pathlib.Path(folder).iterdir() if path.suffix.lower() in (".obj", ".off", ".ply", ".stl"))
    if len(files) < 2:
        print(f"{folder}: fewer than two mesh files", file=sys.stderr)
        return 2
    scene = Scene()
    parts = {scene.add(Object.load(path)): path.name for path in files}
    crossing = 0
    for a, b, result in scene.touching(contacts="all", relation=True):
        print(f"{parts[a]} {parts[b]} {result.relation} {len(result.contacts)}")
        crossing += result.relation == "crossing"
    print(f"parts={len(parts)} crossing={crossing}")
    return 1 if crossing else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1]))
