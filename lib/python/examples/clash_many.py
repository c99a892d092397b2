#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which of very many parts clash? Like cchip clash, over a Dask cluster.

Every mesh file of FOLDER is a part, in the coordinates of the assembly. A sweep over their boxes finds the pairs that
may touch, the workers test them. RESULT gets a line for each pair that touches, lies one inside the other or is at most
the clearance apart: a, b, relation and face pairs in contact of the surfaces, solids (how they lie to each other as
solids; empty if one of them is not closed), distance of the surfaces (empty above the clearance). It is Parquet if its
name ends in .parquet and pyarrow is there, CSV otherwise. SCHEDULER is the address of a Dask scheduler; without it two
workers are started here. Needs collide_dask.py beside it, collisionchip, distributed and trimesh (which reads the
files).
Exit codes: 0 no two parts cross or share volume, 1 some do, 2 wrong arguments, fewer than two mesh files, no scheduler
or no place for RESULT, 3 some files cannot be used and were left out, or no two parts clash but shells of one overlap,
so that its solid may not be the one that was meant."""
import argparse
import csv
import html
import math
import pathlib
import sys

import numpy as np
import trimesh
from distributed import Client, LocalCluster

from collisionchip import Object, collide
from collide_dask import relate_pairs

COLUMNS = ("a", "b", "relation", "contacts", "solids", "distance")


def box_pairs(least, greatest, clearance=0.0):
    """Pairs of boxes that overlap, touch or are at most so far apart along each axis, by a sweep along x; least,
    greatest: (n, 3) corners."""
    greatest = np.nextafter(greatest + clearance, math.inf) if clearance else greatest
    order = np.argsort(least[:, 0], kind="stable")
    starts = least[order, 0]
    for k, i in enumerate(order):
        # those that begin at or behind the start of i and not behind its end
        others = order[k + 1:np.searchsorted(starts, greatest[i, 0], side="right")]
        meet = np.all((least[others] <= greatest[i]) & (greatest[others] >= least[i]), axis=1)
        yield from ((min(i, j), max(i, j)) for j in others[meet].tolist())


def write(path, lines):
    if path.suffix == ".parquet":
        try:
            import pyarrow
            from pyarrow import parquet
        except ImportError:
            path = path.with_suffix(".csv")
            print(f"no pyarrow, so the result is {path}", file=sys.stderr)
        else:
            parquet.write_table(pyarrow.table(dict(zip(COLUMNS, zip(*lines)))), path)
            return
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([COLUMNS, *lines])


def in_words(relation, solids, distance):
    """What a pair is, for people."""
    if solids in ("a_in_b", "b_in_a"):
        return "a inside b" if solids == "a_in_b" else "b inside a"
    if solids == "equal":
        return "duplicate"
    if relation == "apart":
        return f"{distance:g} apart"
    if not solids:
        return f"surfaces {relation.replace('ing', '')}, not both closed: no solids"
    return "overlap" if solids == "overlapping" else "touch"


def report(path, lines, files, open_parts, overlaps):
    """A page with a table of the pairs; those whose faces meet lead to a page of their own, on which both parts can be
    turned and cut."""
    pages = path.with_name(path.stem + "_pairs")
    by_name = {file.name: file for file in files}
    rows = []
    for number, (a, b, relation, contacts, solids, distance) in enumerate(lines):
        words = html.escape(in_words(relation, solids, distance))
        if contacts:
            pages.mkdir(exist_ok=True)
            loaded = [trimesh.load_mesh(by_name[name], process=False) for name in (a, b)]
            parts = [Object(part.vertices, part.faces) for part in loaded]
            collide(parts[0], None, parts[1], None, contacts="all", relation=True).show(pages / f"{number}.html")
            words = f'<a href="{html.escape(pages.name)}/{number}.html">{words}</a>'
        far = "" if distance is None else f"{distance:g}"
        rows.append(f"<tr><td>{html.escape(a)}<td>{html.escape(b)}<td>{words}<td>{contacts}<td>{far}")
    notes = "".join(f"<li>{html.escape(name)}" for name in open_parts)
    doubts = "".join(f"<li>{html.escape(name)}: faces {i} and {j}" for name, (i, j) in overlaps.items())
    path.write_text('<!DOCTYPE html><html lang="en"><meta charset="utf-8"><title>Clashes</title>'
                    f"<h1>{len(files)} parts, {len(lines)} pairs</h1>"
                    "<table border><tr><th>a<th>b<th>what<th>face pairs<th>distance" + "".join(rows) + "</table>"
                    + (f"<h2>Not closed: surfaces, not solids</h2><ul>{notes}</ul>" if notes else "")
                    + (f"<h2>Shells overlap: try --inside nonzero</h2><ul>{doubts}</ul>" if doubts else "")
                    + "</html>\n", encoding="utf-8")


def load(files):
    """Those that can be used, and their meshes; the others are named."""
    loaded = []
    for path in files:
        try:
            part = trimesh.load_mesh(path, process=False)
            if len(part.faces) == 0:
                raise ValueError("no faces")
            loaded.append((path, part))
        except Exception as error:  # trimesh raises what its readers happen to meet
            print(f"left out: {path}: {error or type(error).__name__}", file=sys.stderr)
    return [path for path, _ in loaded], [part for _, part in loaded]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=pathlib.Path)
    parser.add_argument("result", metavar="RESULT", type=pathlib.Path)
    parser.add_argument("scheduler", metavar="SCHEDULER", nargs="?")
    parser.add_argument("--clearance", type=float, default=0.0, help="list pairs at most so far apart, too (default 0)")
    parser.add_argument("--inside", choices=("odd", "nonzero"), default="odd",
                        help="inside is what a part encloses an odd number of times (default), or winds around")
    parser.add_argument("--report", metavar="PAGE.html", type=pathlib.Path,
                        help="write a page with the pairs, too; beside it a folder with a page for each pair whose "
                             "faces meet")
    options = parser.parse_args()
    folder, scheduler = options.folder, options.scheduler
    if not (0 <= options.clearance < math.inf):
        parser.error("--clearance: give a number that is at least 0")
    if not folder.is_dir():
        parser.error(f"{folder}: no such folder")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() in (".obj", ".off", ".ply", ".stl"))
    files, parts = load(found)
    if len(files) < 2:
        print(f"{folder}: fewer than two mesh files that can be used", file=sys.stderr)
        return 2
    open_parts = [path.name for path, part in zip(files, parts) if not Object(part.vertices, part.faces).is_closed]
    for name in open_parts:
        print(f"{name}: not closed, so it is a surface and no solid: nothing is inside it", file=sys.stderr)
    bounds = np.array([part.bounds for part in parts])
    pairs = [(int(a), int(b)) for a, b in box_pairs(bounds[:, 0], bounds[:, 1], options.clearance)]
    listed, overlaps = [], {}
    with (Client(scheduler) if scheduler
          else Client(LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None))) as client:
        related = relate_pairs(client, parts, pairs, clearance=options.clearance, inside=options.inside)
        for done, (a, b, relation, contacts, solids, distance, found) in enumerate(related, 1):
            overlaps.update((files[part].name, overlap) for part, overlap in zip((a, b), found) if overlap)
            if sys.stderr.isatty() or done % 1000 == 0 or done == len(pairs):
                print(f"\r{done} of {len(pairs)} pairs", end="" if done < len(pairs) else "\n",
                      file=sys.stderr, flush=True)
            if relation != "apart" or solids not in (None, "disjoint") or distance <= options.clearance:
                listed.append((files[a].name, files[b].name, relation, contacts, solids or "",
                               distance if distance <= options.clearance else None))
        if not scheduler:
            client.cluster.close()
    for name, (i, j) in sorted(overlaps.items()):
        print(f"{name}: faces {i} and {j} cross or lie on each other, so its shells overlap: try --inside nonzero",
              file=sys.stderr)
    listed.sort()
    write(options.result, listed)
    if options.report:
        report(options.report, listed, files, open_parts, dict(sorted(overlaps.items())))
    touching = [line for line in listed if line[2] != "apart"]
    crossing = sum(line[2] == "crossing" for line in touching)
    print(f"parts={len(parts)} box_pairs={len(pairs)} touching={len(touching)} crossing={crossing}")
    if len(files) < len(found):
        return 3
    clash = any(line[2] == "crossing" or line[4] in ("overlapping", "a_in_b", "b_in_a", "equal") for line in listed)
    return 1 if clash else 3 if overlaps else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as error:  # no scheduler at that address, no folder for the result
        print(f"clash_many.py: {error}", file=sys.stderr)
        sys.exit(2)
