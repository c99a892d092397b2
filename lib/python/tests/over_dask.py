#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""examples/collide_dask.py over a scheduler and two worker processes on loopback, workers killed in the middle.

usage: over_dask.py [QUERIES] [--speed]      (default 200000; CCHIP_SEED repeats a run)

Compares collide_many() over Dask with collide_many() here: hits, and every contact of a quarter of the queries, twice,
while workers are killed; then clash_many.py with all pairs here. --speed only measures, with all contacts: one thread
here, one worker and two in turns. The last line is `queries=N differing=N lost=N`. Exit code 1 if an answer differs or
is missing, or no worker was killed."""
import csv
import importlib.util
import os
import pathlib
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time

import numpy as np
import trimesh
from distributed import Client, LocalCluster

import collisionchip
from shapes import SEED, poses, torus

EXAMPLES = pathlib.Path(__file__).parents[1] / "examples"


def load_example():
    """collide_dask.py, without its folder in sys.path: workers have the same path, and would find the file though
    nobody sent it."""
    spec = importlib.util.spec_from_file_location("collide_dask", EXAMPLES / "collide_dask.py")
    sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(sys.modules[spec.name])
    return sys.modules[spec.name]


def cluster(workers):
    return LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, host="127.0.0.1",
                        dashboard_address=None)


def kill(client, running, count):
    """Kills worker processes once they have some of the results; their nannies start others, without the meshes."""
    def busy(dask_scheduler):
        return sum(ts.state == "memory" and "_many" in key for key, ts in dask_scheduler.tasks.items())
    while running.is_set():
        if client.run_on_scheduler(busy) >= 3:
            pids = sorted(client.run(os.getpid).values())[:count]
            for pid in pids:
                os.kill(pid, signal.SIGKILL)
            return pids
        time.sleep(0.01)
    return []


def over_dask(client, count, *arguments, **options):
    """The answer, and the processes that were killed meanwhile, `count` of them."""
    client.wait_for_workers(2)  # nannies may not have started those that were killed before
    running, killed = threading.Event(), []
    running.set()
    killer = threading.Thread(target=lambda: killed.append(kill(client, running, count)))
    killer.start()
    found = collide_dask.collide_many(client, *arguments, **options)
    running.clear()
    killer.join()
    return found, killed[0]


def clashes(client, random):
    """Differences between clash_many.py and all pairs here, and the number of pairs."""
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        mesh = trimesh.Trimesh(*torus(1, 0.3, 16, 6), process=False)
        for i, pose in enumerate(poses(random, 30, 3)):
            mesh.copy().apply_transform(pose).export(folder / f"part{i:02}.stl")
        done = subprocess.run([sys.executable, EXAMPLES / "clash_many.py", folder, folder / "clashes.csv",
                               client.scheduler.address],
                              stdout=subprocess.PIPE, text=True)
        print(done.stdout, end="")
        with open(folder / "clashes.csv", newline="") as file:
            found = {(line["a"], line["b"]): (line["relation"], int(line["contacts"])) for line in csv.DictReader(file)}
        parts = {path.name: collisionchip.Object.load(path) for path in sorted(folder.glob("*.stl"))}
        names, expected = list(parts), {}
        for i, a in enumerate(names):
            for b in names[i + 1:]:
                result = collisionchip.collide(parts[a], None, parts[b], None, contacts="all", relation=True)
                if result.relation != "apart":
                    expected[a, b] = result.relation, len(result.contacts)
        assert expected
        return len(found.items() ^ expected.items()), len(names) * (len(names) - 1) // 2


def speed(mesh, where_a, where_b):
    """One thread here, one worker and two in turns; then what a task costs beside its queries."""
    here, device = collisionchip.Object(*mesh), collisionchip.open_device("cpu", threads=1)
    times = {0: [], 1: [], 2: []}

    def run(workers, client):
        start = time.perf_counter()
        if client is None:
            collisionchip.collide_many(here, where_a, here, where_b, contacts=True, device=device)
        else:
            collide_dask.collide_many(client, mesh, where_a, mesh, where_b, contacts=True, chunk=-(-len(where_a) // 20))
        times[workers].append(time.perf_counter() - start)

    with cluster(1) as one, cluster(2) as two, Client(one) as client1, Client(two) as client2:
        for _ in range(4):
            for workers, client in ((0, None), (1, client1), (2, client2)):
                run(workers, client)
        start = time.perf_counter()
        collide_dask.collide_many(client2, mesh, None, mesh, where_b[:2000], chunk=1)
        tasks = 2000 / (time.perf_counter() - start)
    none, one, two = (statistics.median(times[workers][1:]) for workers in (0, 1, 2))  # the first builds the objects
    print(f"queries={len(where_a)} us_per_query={none / len(where_a) * 1e6:.1f} one_thread={none:.2f}s "
          f"one_worker={one:.2f}s two_workers={two:.2f}s "
          f"one_worker/one_thread={one / none:.2f} one_worker/two_workers={one / two:.2f} tasks_per_s={tasks:.0f} "
          f"load={os.getloadavg()[0]:.1f}")


def memory():
    """What an object takes, from the growth of this process."""
    def resident():
        lines = pathlib.Path("/proc/self/status").read_text().splitlines()
        return 1024 * int(next(line.split()[1] for line in lines if line.startswith("VmRSS:")))
    vertices, faces = torus(1, 0.3, 1000, 500)
    before = resident()
    kept = collisionchip.Object(vertices, faces)
    print(f"triangles={kept.face_count} arrays={(vertices.nbytes + faces.nbytes) / len(faces):.0f} "
          f"object={(resident() - before) / len(faces):.0f} "
          "bytes per triangle")


def main():
    words = [word for word in sys.argv[1:] if word != "--speed"]
    count = int(words[0]) if words else 200000
    random = np.random.default_rng(SEED)
    mesh = torus(1, 0.3, 64, 24)
    where_a, where_b = poses(random, count, 1), poses(random, count, 1)
    if "--speed" in sys.argv:
        memory()
        speed(mesh, where_a, where_b)
        return 0
    here = collisionchip.Object(*mesh)
    expected = collisionchip.collide_many(here, where_a, here, where_b)
    # all contacts: a batch that lasts long enough to lose workers in its middle
    part = slice(0, count // 4)
    expected_part = collisionchip.collide_many(here, where_a[part], here, where_b[part], contacts=True)
    chunk = max(1, count // 400)
    with cluster(2) as workers, Client(workers) as client:
        found, killed = over_dask(client, 1, mesh, where_a[part], mesh, where_b[part], contacts=True, chunk=chunk)
        print(f"seed={SEED} hits={int(found[0].sum())} killed_workers={len(killed)}", flush=True)
        # both: the meshes are nowhere any more and are sent again
        again, all_killed = over_dask(client, 2, mesh, where_a[part], mesh, where_b[part], contacts=True, chunk=chunk)
        print(f"seed={SEED} hits={int(again[0].sum())} killed_workers={len(all_killed)}", flush=True)
        hits = collide_dask.collide_many(client, mesh, where_a, mesh, where_b)
        one = collide_dask.collide_many(client, mesh, None, mesh, where_b[:10], chunk=3)
        unlike, pairs = clashes(client, random)
    lost = abs(len(hits) - count) + sum(abs(len(x[0]) - count // 4) for x in (found, again))
    differing = unlike
    if not lost:
        differing += int((hits != expected).sum())
        for x in (found, again):
            differing += int((x[0] != expected_part[0]).sum()) + (not np.array_equal(x[1], expected_part[1]))
    differing += not np.array_equal(one, collisionchip.collide_many(here, None, here, where_b[:10]))
    print(f"queries={count + 2 * (count // 4) + pairs + 10} differing={differing} lost={lost}")
    if (len(killed), len(all_killed)) != (1, 2):
        print("too few workers were killed: try more queries", file=sys.stderr)
        return 1
    return 1 if differing or lost else 0


if __name__ == "__main__":
    collide_dask = load_example()  # here: what is above is run on the workers, too
    sys.exit(main())
