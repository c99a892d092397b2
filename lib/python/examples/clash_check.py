#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which parts in a folder clash? Every mesh file is a part, a solid in the coordinates of the assembly.

Prints a line for each pair of parts that meet: their files, and touching, overlapping, a_in_b, b_in_a or equal. A part
that is not closed is a surface: touching or crossing. All but touching are clashes.
Exit codes: 0 no two parts clash, 1 some do, 2 wrong arguments or fewer than two mesh files, 3 not all could be judged:
a file cannot be used and was left out, or two parts show no clash though one may lie inside the other: one is not
closed, or faces of one cross or lie on each other, so that its shells overlap and its solid may not be the one that was
meant. With --inside nonzero space that two shells of a part share is inside, and that judges it."""
import argparse
import pathlib
import sys
import warnings

from collisionchip import Object, Scene, collide, solids


def within(a, b):
    """Is the box of a inside that of b?"""
    return (b.vertices.min(0) <= a.vertices.min(0)).all() and (a.vertices.max(0) <= b.vertices.max(0)).all()


def relate(a, b, inside):
    """How two parts lie to each other, and why that may not be all, or ""."""
    surfaces = collide(a, None, b, None, contacts="all", relation=True).relation
    if not (a.is_closed and b.is_closed):
        may_be_inside = surfaces != "crossing" and ((b.is_closed and within(a, b)) or (a.is_closed and within(b, a)))
        return surfaces, "one is not closed, and one may lie inside the other" if may_be_inside else ""
    twisted = [x.name for x in (a, b) if inside == "nonzero" and x.twisted_edge]
    if twisted:
        return surfaces, f"faces of {twisted[0]} are not all the same way round" if surfaces != "crossing" else ""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that shells overlap: said below, if it matters
        word = solids(a, None, b, None, inside=inside)
    if word not in ("disjoint", "touching"):
        return word, ""
    overlaps = [(x.name, x.shell_overlap) for x in (a, b) if inside == "odd" and x.shell_overlap]
    doubt = "".join(f"faces {i} and {j} of {name} cross or lie on each other; " for name, (i, j) in overlaps)
    return "crossing" if surfaces == "crossing" else word, doubt and doubt + "try --inside nonzero"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("--inside", choices=("odd", "nonzero"), default="odd",
                        help="inside is what a part encloses an odd number of times (default), or winds around")
    options = parser.parse_args()
    folder = options.folder
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
    clashes, judged = 0, len(parts) == len(files)
    for a, b in scene.candidates().tolist():  # boxes overlap
        word, doubt = relate(scene.object(a), scene.object(b), options.inside)
        if doubt:
            print(f"{parts[a]} {parts[b]} cannot be judged: {doubt}", file=sys.stderr)
            judged = False
        if word not in ("disjoint", "apart"):
            print(f"{parts[a]} {parts[b]} {word}")
            clashes += word != "touching"
    print(f"parts={len(parts)} clashes={clashes}")
    if len(parts) < len(files):
        return 3
    return 1 if clashes else 0 if judged else 3


if __name__ == "__main__":
    sys.exit(main())
