#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Speed of collisionchip beside python-fcl and beside trimesh over it. CCHIP_SEED repeats a run.

usage: bench.py

Batches: two tori of 3,072 triangles in 10,000 pairs of poses, collide_many() against a loop over fcl.collide(), each
with the first contact; with one thread and with all cores. Scenes: frames of 100 tori of 192 triangles,
CollisionManager against trimesh's. Medians of five alternating passes, wall-clock time. Exit code 1 if an answer
differs."""
import os
import statistics
import sys
import time

import fcl
import numpy as np
import trimesh

import collisionchip
from shapes import SEED, poses, torus

PASSES = 5


def timed(function):
    start = time.perf_counter()
    result = function()
    return time.perf_counter() - start, result


def in_turns(*functions):
    """Median seconds of each function, and what each returned last."""
    times = [[] for _ in functions]
    results = [None for _ in functions]
    for _ in range(PASSES):
        for i, function in enumerate(functions):
            seconds, results[i] = timed(function)
            times[i].append(seconds)
    return [statistics.median(x) for x in times], results


def batches(random, count, reach):
    vertices, faces = torus(1, 0.3, 64, 24)
    mine = collisionchip.Object(vertices, faces)
    model = fcl.BVHModel()
    model.beginModel(len(vertices), len(faces))
    model.addSubModel(vertices, faces)
    model.endModel()
    a, b = fcl.CollisionObject(model), fcl.CollisionObject(model)
    where_a, where_b = poses(random, count, reach), poses(random, count, reach)

    def loop():
        hits = np.zeros(count, bool)
        request = fcl.CollisionRequest()
        for i in range(count):
            a.setTransform(fcl.Transform(where_a[i, :3, :3], where_a[i, :3, 3]))
            b.setTransform(fcl.Transform(where_b[i, :3, :3], where_b[i, :3, 3]))
            hits[i] = fcl.collide(a, b, request, fcl.CollisionResult()) > 0
        return hits

    one, every = collisionchip.open_device("cpu", threads=1), collisionchip.open_device("cpu")
    (theirs, ours, ours_all), (expected, hits, hits_all) = in_turns(
        loop, lambda: collisionchip.collide_many(mine, where_a, mine, where_b, device=one),
        lambda: collisionchip.collide_many(mine, where_a, mine, where_b, device=every))
    wrong = int((hits != expected).sum() + (hits_all != expected).sum())
    print(f"batch reach={reach} queries={count} hits={expected.sum()} python-fcl={theirs / count * 1e6:.1f}us "
          f"one_thread={ours / count * 1e6:.2f}us times={theirs / ours:.1f} all_cores={ours_all / count * 1e6:.2f}us "
          f"times={theirs / ours_all:.1f}")
    return wrong


def scenes(random, count, frames):
    mesh = trimesh.Trimesh(*torus(1, 0.3, 16, 6), process=False)
    ours, theirs = collisionchip.CollisionManager(), trimesh.collision.CollisionManager()
    for i in range(count):
        ours.add_object(str(i), mesh)
        theirs.add_object(str(i), mesh)
    where = poses(random, count * frames, 6).reshape(frames, count, 4, 4)

    def run(manager):
        found = []
        for frame in where:
            for i, pose in enumerate(frame):
                manager.set_transform(str(i), pose)
            found.append(manager.in_collision_internal(return_names=True)[1])
        return found

    (slow, fast), (expected, found) = in_turns(lambda: run(theirs), lambda: run(ours))
    print(f"scene objects={count} frames={frames} pairs={sum(map(len, expected))} trimesh={slow / frames * 1e3:.2f}ms "
          f"collisionchip={fast / frames * 1e3:.2f}ms times={slow / fast:.1f}")
    return sum(len(x ^ y) for x, y in zip(expected, found))


def main():
    random = np.random.default_rng(SEED)
    print(f"cores={os.cpu_count()} load={os.getloadavg()[0]:.1f} target={collisionchip.cpu_targets()[0]} seed={SEED}")
    differences = sum(batches(random, 10000, reach) for reach in (0.5, 1, 3))
    differences += scenes(random, 100, 20)
    print(f"differences={differences}")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
