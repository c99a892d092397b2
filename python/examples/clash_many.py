#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Which of very many parts clash? Like clash_check.py, over a Dask cluster.

usage: clash_many.py FOLDER RESULT [SCHEDULER]

Every mesh file of FOLDER is a part, in the coordinates of the assembly. A sweep over their boxes finds the pairs that may
touch, the workers test them. RESULT gets a line for each pair that touches: a, b, relation, face pairs in contact; as
Parquet if its name ends in .parquet and pyarrow is there, as CSV otherwise. SCHEDULER is the address of a Dask
scheduler; without it two workers are started here. Needs collisionchip, distributed and trimesh (which reads the files).
Exit codes: 0 no two parts cross, 1 some do, 2 fewer than two mesh files."""
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


def main(folder, result, scheduler=None):
    files = sorted(path for path in pathlib.Path(folder).iterdir() if path.suffix.lower() in (".obj", ".off", ".ply", ".stl"))
    if len(files) < 2:
        print(f"{folder}: fewer than two mesh files", file=sys.stderr)
        return 2
    parts = [trimesh.load_mesh(path, process=False) for path in files]
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
    write(pathlib.Path(result), sorted(touching))
    crossing = sum(line[2] == "crossing" for line in touching)
    print(f"parts={len(parts)} box_pairs={len(pairs)} touching={len(touching)} crossing={crossing}")
    return 1 if crossing else 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
