#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Assembly.check() beside trimesh's CollisionManager over python-fcl, and MeshLib. CCHIP_SEED repeats a run.

usage: bench_clash.py [PARTS [CASES]]        1000 tori, 200 pairs of each class

Wrong verdicts: pairs of cubes whose places say whether they clash, that is share volume deeper than 1e-4. First look:
tori of 576 triangles, built and judged once, all cores; of MeshLib, which has no broad phase in Python, pairs whose
boxes overlap. Medians of three alternating passes, wall-clock time. Exit code 1 if a verdict of ours is wrong, or if
the pairs of ours and of FCL differ."""
import os
import statistics
import sys
import time

import meshlib.mrmeshnumpy as mrn
import meshlib.mrmeshpy as mr
import numpy as np
import trimesh

import collisionchip
from shapes import SEED, cube, poses, torus


def moved(x=0.0, y=0.0, z=0.0, scale=1.0):
    pose = np.diag([scale, scale, scale, 1.0])
    pose[:3, 3] = x, y, z
    return pose


def classes(random, count):
    """For each class whether its pairs clash, and poses of both cubes."""
    turned = poses(random, count, 3)
    whole = np.stack([moved(*random.integers(-4, 5, 3)) for _ in range(count)])
    return {
        "apart": (False, [(p, p @ moved(1.001, 0.25)) for p in turned]),
        "flush": (False, [(p, p @ moved(1)) for p in whole]),
        "flush, tilted": (False, [(p, p @ moved(1, 0.25)) for p in turned]),
        "0.01 deep, tilted": (True, [(p, p @ moved(0.99, 0.25)) for p in turned]),
        "aligned, half": (True, [(p, p @ moved(0.5)) for p in whole]),
        "equal": (True, [(p, p) for p in whole]),
        "contained": (True, [(p, p @ moved(scale=0.5)) for p in turned]),
    }


def ours(block, pose_a, pose_b):
    assembly = collisionchip.Assembly()
    assembly.add_rule("overlap", limit=1e-4)
    assembly.add("a", block, pose_a)
    assembly.add("b", block, pose_b)
    return assembly.check(threads=1).violations > 0


def over_fcl(mesh, pose_a, pose_b):
    manager = trimesh.collision.CollisionManager()
    manager.add_object("a", mesh, pose_a)
    manager.add_object("b", mesh, pose_b)
    return manager.in_collision_internal()


def affine(pose):
    rows = [mr.Vector3f(*map(float, row[:3])) for row in pose[:3]]
    return mr.AffineXf3f(mr.Matrix3f(*rows), mr.Vector3f(*map(float, pose[:3, 3])))


def by_meshlib(mesh, pose_a, pose_b):
    return mr.findCollidingTriangles(mr.MeshPart(mesh), mr.MeshPart(mesh), affine(np.linalg.inv(pose_a) @ pose_b),
                                     True).size() > 0


def look_of_ours(mesh, places):
    assembly = collisionchip.Assembly()
    block = collisionchip.Object(*mesh)
    for i, place in enumerate(places):
        assembly.add(str(i), block, place)
    return {tuple(sorted((int(p.a), int(p.b)))) for p in assembly.check().pairs}


def look_of_fcl(mesh, places):
    manager = trimesh.collision.CollisionManager()
    shape = trimesh.Trimesh(*mesh, process=False)
    for i, place in enumerate(places):
        manager.add_object(str(i), shape, place)
    return {tuple(sorted(map(int, names))) for names in manager.in_collision_internal(return_names=True)[1]}


def look_of_meshlib(mesh, places):
    shape = mrn.meshFromFacesVerts(np.asarray(mesh[1], np.int32), mesh[0])
    corners = np.einsum("nij,vj->nvi", places[:, :3, :3], mesh[0]) + places[:, None, :3, 3]
    low, high = corners.min(axis=1), corners.max(axis=1)
    found = set()
    for i in range(len(places)):
        near = np.all((low[i] <= high[i + 1:]) & (high[i] >= low[i + 1:]), axis=1)
        found |= {(i, i + 1 + int(k)) for k in np.flatnonzero(near) if by_meshlib(shape, places[i], places[i + 1 + k])}
    return found


def main():
    parts, count = (int(x) for x in (sys.argv[1:] + ["1000", "200"][len(sys.argv) - 1:]))
    random = np.random.default_rng(SEED)
    load = os.getloadavg()[0]
    print(f"CCHIP_SEED={SEED} load={load:.1f}\n\n{'class':20}{'clash':8}wrong: ours  over FCL  MeshLib")
    vertices, faces = cube()
    judges = [(ours, collisionchip.Object(vertices, faces)),
              (over_fcl, trimesh.Trimesh(vertices, faces, process=False)),
              (by_meshlib, mrn.meshFromFacesVerts(np.asarray(faces, np.int32), vertices))]
    total = np.zeros(3, int)
    for name, (clash, pairs) in classes(random, count).items():
        wrong = [sum(judge(mesh, a, b) != clash for a, b in pairs) for judge, mesh in judges]
        total += wrong
        print(f"{name:20}{'yes' if clash else 'no':8}{wrong[0]:11}{wrong[1]:10}{wrong[2]:9}")
    places = poses(random, parts, 1.6 * parts ** (1 / 3))
    looks, times, found = [look_of_ours, look_of_fcl, look_of_meshlib], [[], [], []], [None] * 3
    for _ in range(3):
        for i, look in enumerate(looks):
            start = time.perf_counter()
            found[i] = look(torus(), places)
            times[i].append(time.perf_counter() - start)
    seconds = [statistics.median(x) for x in times]
    print(f"\nfirst look: parts={parts} pairs={len(found[0])} differ: over FCL {len(found[0] ^ found[1])}, MeshLib "
          f"{len(found[0] ^ found[2])}\nseconds: ours {seconds[0]:.3f}, over FCL {seconds[1]:.3f}, MeshLib "
          f"{seconds[2]:.3f}\nclash ours_wrong={total[0]} fcl_over_ours={seconds[1] / seconds[0]:.1f} "
          f"meshlib_over_ours={seconds[2] / seconds[0]:.1f}")
    return int(total[0] > 0 or found[0] != found[1])


if __name__ == "__main__":
    sys.exit(main())
