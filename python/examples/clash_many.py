#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which of very many parts clash? Like clash_check.py, over a Dask cluster.

Every mesh file of FOLDER is a part, in the coordinates of the assembly. A sweep over their boxes finds the pairs that may
touch, the workers test them. RESULT gets a line for each pair that touches: a, b, relation, face pairs in contact; as
Parquet if its name ends in .parquet and pyarrow is there, as CSV otherwise. SCHEDULER is the address of a Dask
scheduler; without it two workers are started here. Needs collisionchip, distributed and trimesh (which reads the files).
Exit codes: 0 no two parts cross, 1 some do, 2 wrong arguments, fewer than two mesh files, no scheduler or no place for RESULT, 3 some files cannot be
used and were left out."""
import argparse
import csv
import pathlib
import sys

import numpy as np
import trimesh
from distributed import Client, LocalCluster

from collisionchip.distributed import collide_pairs


def box_pairs(least, greatest):
    """Pairs of boxes that overlap or touch, by a sweep along x; least, greatest: (n, 3) corners."""
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
            parquet.write_table(pyarrow.table(dict(zip(("a", "b", "relation", "contacts"), zip(*lines)))), path)
            return
    with open(path, "w", newline="") as file:
        csv.writer(file, lineterminator="\n").writerows([("a", "b", "relation", "contacts"), *lines])


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
    options = parser.parse_args()
    folder, scheduler = options.folder, options.scheduler
    if not folder.is_dir():
        parser.error(f"{folder}: no such folder")
    found = sorted(path for path in folder.iterdir() if path.suffix.lower() in (".obj", ".off", ".ply", ".stl"))
    files, parts = load(found)
    if len(files) < 2:
        print(f"{folder}: fewer than two mesh files that can be used", file=sys.stderr)
        return 2
    bounds = np.array([part.bounds for part in parts])
    pairs = [(int(a), int(b)) for a, b in box_pairs(bounds[:, 0], bounds[:, 1])]
    touching = []
    with (Client(scheduler) if scheduler else Client(LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None))) as client:
        done = 0
        for a, b, relation, contacts in collide_pairs(client, parts, pairs, contacts="all", relation=True):
            done += 1
            if sys.stderr.isatty() or done % 1000 == 0 or done == len(pairs):
                print(f"\r{done} of {len(pairs)} pairs", end="" if done < len(pairs) else "\n", file=sys.stderr, flush=True)
            if relation != "apart":
                touching.append((files[a].name, files[b].name, relation, contacts))
        if not scheduler:
            client.cluster.close()
    write(options.result, sorted(touching))
    crossing = sum(line[2] == "crossing" for line in touching)
    print(f"parts={len(parts)} box_pairs={len(pairs)} touching={len(touching)} crossing={crossing}")
    if len(files) < len(found):
        return 3
    return 1 if crossing else 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except OSError as error:  # no scheduler at that address, no folder for the result
        print(f"clash_many.py: {error}", file=sys.stderr)
        sys.exit(2)
