#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which parts in a folder clash? Every mesh file is a part, in the coordinates of the assembly.

Prints a line for each pair of parts that touch: their files, touching or crossing, the number of face pairs in contact.
Exit codes: 0 no two parts cross, 1 some do, 2 wrong arguments or fewer than two mesh files, 3 some files cannot be used and
were left out."""
import argparse
import pathlib
import sys

from collisionchip import Object, Scene


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    folder = parser.parse_args().folder
    if not folder.is_dir():
        parser.error(f"{folder}: no such folder")
    files = sorted(path for path in folder.iterdir() if path.suffix.lower() in (".obj", ".off", ".ply", ".stl"))
    if len(files) < 2:
        print(f"{folder}: fewer than two mesh files", file=sys.stderr)
        return 2
    scene = Scene()
    parts = {}
    for path in files:
        try:
            parts[scene.add(Object.load(path))] = path.name
        except (OSError, ValueError) as error:
            print(f"left out: {error}", file=sys.stderr)
    crossing = 0
    for a, b, result in scene.contacts(contacts="all", relation=True):
        print(f"{parts[a]} {parts[b]} {result.relation} {len(result.contacts)}")
        crossing += result.relation == "crossing"
    print(f"parts={len(parts)} crossing={crossing}")
    if len(parts) < len(files):
        return 3
    return 1 if crossing else 0


if __name__ == "__main__":
    sys.exit(main())
