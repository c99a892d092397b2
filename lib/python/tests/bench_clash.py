#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Assembly.check() beside trimesh's CollisionManager over python-fcl, MeshLib and ifcclash. CCHIP_SEED repeats a run.

usage: bench_clash.py [PARTS [CASES [POSES]]]        1000 tori, 200 pairs of each class, 100 poses

Wrong verdicts: pairs of cubes whose places say whether they clash, that is share volume deeper than 1e-4; of ifcclash
in its mode "intersection", with that as tolerance, and in its mode "collision". First look: tori of 576 triangles,
built and judged once, all cores; of MeshLib, which has no broad phase in Python, pairs whose boxes overlap; of
ifcclash, mode "collision", from a model in memory. Cell: an arm of 6 tori among 60 that rest, built once and looked at
in each pose; FCL has a manager for the arm and one for the rest. ifcclash builds anew, and sees every tenth pose only;
its time is scaled up. Medians of three alternating passes (of ifcclash one), wall-clock time. Exit code 1 if a verdict
of ours is wrong, or if the pairs of ours and of FCL differ."""
import logging
import os
import statistics
import sys
import time

import ifcclash.ifcclash
import ifcopenshell
import ifcopenshell.guid
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


def ifc_model(elements):
    """A model in metres: elements are a name, the number of a mesh, and a rigid pose; meshes are vertices and faces."""
    model = ifcopenshell.file(schema="IFC4")

    def point(numbers):
        return model.createIfcCartesianPoint([float(x) for x in numbers])

    def axes(pose):
        return model.createIfcAxis2Placement3D(point(pose[:3, 3]), *(
            model.createIfcDirection([float(x) for x in pose[:3, axis]]) for axis in (2, 0)))

    world = axes(np.eye(4))
    context = model.createIfcGeometricRepresentationContext(None, "Model", 3, 1e-9, world)
    model.createIfcProject(ifcopenshell.guid.new(), None, "bench", None, None, None, None, [context],
                           model.createIfcUnitAssignment([model.createIfcSIUnit(None, "LENGTHUNIT", None, "METRE")]))
    maps = {}
    for name, mesh, pose in elements:
        if id(mesh) not in maps:
            faces = model.createIfcTriangulatedFaceSet(
                model.createIfcCartesianPointList3D([[float(x) for x in v] for v in mesh[0]]), None, True,
                [[int(i) + 1 for i in face] for face in mesh[1]])
            maps[id(mesh)] = model.createIfcRepresentationMap(world, model.createIfcShapeRepresentation(
                context, "Body", "Tessellation", [faces]))
        item = model.createIfcMappedItem(maps[id(mesh)], model.createIfcCartesianTransformationOperator3D(
            None, None, point((0, 0, 0)), 1.0, None))
        shape = model.createIfcShapeRepresentation(context, "Body", "MappedRepresentation", [item])
        model.createIfcBuildingElementProxy(
            ifcopenshell.guid.new(), None, name, None, None, model.createIfcLocalPlacement(None, axes(pose)),
            model.createIfcProductDefinitionShape(None, None, [shape]))
    return model


def by_ifcclash(model, **options):
    """Pairs of names."""
    settings = ifcclash.ifcclash.ClashSettings()
    settings.logger = logging.getLogger("ifcclash")
    clasher = ifcclash.ifcclash.Clasher(settings)
    clasher.ifcs["model"] = model
    clasher.clash_sets = [{"name": "", "a": [{"file": "model"}], **options}]
    clasher.clash()
    return {tuple(sorted((x["a_name"], x["b_name"]))) for x in clasher.clash_sets[0]["clashes"].values()}


def wrong_of_ifcclash(block, clash, pairs):
    """Wrong verdicts by intersection, and by collision; a pair is far from the others."""
    half = (block[0] * 0.5, block[1])
    elements = []
    for i, (a, b) in enumerate(pairs):
        small = np.linalg.det(b[:3, :3]) < 0.5
        for name, mesh, pose in (("a", block, a), ("b", half if small else block, b)):
            elements.append((f"{i}{name}", mesh, moved(64.0 * i) @ pose))
    model = ifc_model(elements)
    for options in ({"mode": "intersection", "tolerance": 1e-4, "check_all": True},
                    {"mode": "collision", "allow_touching": False}):
        found = by_ifcclash(model, **options)
        yield sum(((f"{i}a", f"{i}b") in found) != clash for i in range(len(pairs)))


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


def look_of_ifcclash(model):
    return {tuple(sorted(map(int, pair))) for pair in by_ifcclash(model, mode="collision", allow_touching=False)}


def arm(random):
    """Poses of six tori that turn round each other's centres, 3 apart."""
    result, at = [], moved()
    for i in range(6):
        cos, sin = np.cos(angle := random.uniform(-2, 2)), np.sin(angle)
        turn = np.eye(4)
        turn[np.ix_((0, 1), (0, 1)) if i % 2 else np.ix_((0, 2), (0, 2))] = [[cos, -sin], [sin, cos]]
        at = at @ turn @ moved(3)
        result.append(at)
    return result


def cells(mesh, rest, ways):
    """Functions that look at all ways, and return the pairs of each: ours, over FCL, MeshLib."""
    links = range(len(ways[0]))

    def of_ours():
        assembly = collisionchip.Assembly()
        block = collisionchip.Object(*mesh)
        for i in links:
            assembly.add(str(i), block)
        for i, place in enumerate(rest, len(links)):
            assembly.add(str(i), block, place)
        found = []
        for way in ways:
            for i in links:
                assembly.set_pose(str(i), way[i])
            found.append({tuple(sorted((int(p.a), int(p.b)))) for p in assembly.check().pairs})
        return found

    def of_fcl():
        shape = trimesh.Trimesh(*mesh, process=False)
        moving, resting = trimesh.collision.CollisionManager(), trimesh.collision.CollisionManager()
        for i in links:
            moving.add_object(str(i), shape)
        for i, place in enumerate(rest, len(links)):
            resting.add_object(str(i), shape, place)
        found = []
        for way in ways:
            for i in links:
                moving.set_transform(str(i), way[i])
            names = (moving.in_collision_internal(return_names=True)[1]
                     | moving.in_collision_other(resting, return_names=True)[1])
            found.append({tuple(sorted(map(int, x))) for x in names})
        return found

    def of_meshlib():
        return [look_of_meshlib(mesh, np.stack(way + list(rest))) for way in ways]

    return of_ours, of_fcl, of_meshlib


def medians(functions):
    """Seconds of each function, and what each returned."""
    times, found = [[] for _ in functions], [None for _ in functions]
    for _ in range(3):
        for i, function in enumerate(functions):
            start = time.perf_counter()
            found[i] = function()
            times[i].append(time.perf_counter() - start)
    return [statistics.median(x) for x in times], found


def once(function):
    start = time.perf_counter()
    found = function()
    return time.perf_counter() - start, found


def report(what, names, seconds, found):
    """Prints a line for each peer; returns the ratio of the fastest to ours."""
    print(f"\n{what}")
    for name, took, pairs in zip(names, seconds, found):
        print(f"{name:10}{took:9.3f} s{took / seconds[0]:8.1f} times ours, {pairs} pairs other than ours")
    return min(seconds[1:]) / seconds[0]


def main():
    parts, count, steps = (int(x) for x in (sys.argv[1:] + ["1000", "200", "100"][len(sys.argv) - 1:]))
    random = np.random.default_rng(SEED)
    names = ["ours", "over FCL", "MeshLib", "ifcclash"]
    columns = names[:3] + ["ifc-inter", "ifc-coll"]
    print(f"CCHIP_SEED={SEED} load={os.getloadavg()[0]:.1f}\n\nwrong verdicts of {count}\n{'class':19}{'clash':6}"
          + "".join(f"{x:>10}" for x in columns))
    vertices, faces = cube()
    judges = [(ours, collisionchip.Object(vertices, faces)),
              (over_fcl, trimesh.Trimesh(vertices, faces, process=False)),
              (by_meshlib, mrn.meshFromFacesVerts(np.asarray(faces, np.int32), vertices))]
    total = np.zeros(len(columns), int)
    for name, (clash, pairs) in classes(random, count).items():
        wrong = [sum(judge(mesh, a, b) != clash for a, b in pairs) for judge, mesh in judges]
        wrong += wrong_of_ifcclash((vertices, faces), clash, pairs)
        total += wrong
        print(f"{name:19}{'yes' if clash else 'no':6}" + "".join(f"{x:10}" for x in wrong), flush=True)
    mesh = torus()
    places = poses(random, parts, 1.6 * parts ** (1 / 3))
    seconds, found = medians([lambda: look_of_ours(mesh, places), lambda: look_of_fcl(mesh, places),
                              lambda: look_of_meshlib(mesh, places)])
    model = ifc_model([(str(i), mesh, place) for i, place in enumerate(places)])
    more, pairs = once(lambda: look_of_ifcclash(model))
    first = report(f"first look: parts={parts} pairs={len(found[0])}", names, seconds + [more],
                   [len(found[0] ^ x) for x in found + [pairs]])
    rest = [p @ moved() for p in poses(random, 60, 0)]
    for i, p in enumerate(rest):
        p[:3, 3] = 2.7 * np.array([i % 5, i // 5 % 4, i // 20]) - (2.7 * 2 + 0.1, 2.7 * 1.5, -3)
    ways = [arm(random) for _ in range(steps)]
    seconds, looks = medians(cells(mesh, rest, ways))
    more, pairs = once(lambda: [look_of_ifcclash(ifc_model([(str(i), mesh, p) for i, p in enumerate(way + rest)]))
                                for way in ways[::10]])
    other = [sum(len(a ^ b) for a, b in zip(looks[0], x)) for x in looks]
    other.append(sum(len(a ^ b) for a, b in zip(looks[0][::10], pairs)))
    cell = report(f"cell: parts={len(rest) + 6} poses={steps} pairs={sum(map(len, looks[0]))}", names,
                  seconds + [more * len(ways) / len(pairs)], other)
    print(f"clash ours_wrong={total[0]} first_look_ratio={first:.1f} cell_ratio={cell:.1f}")
    return int(total[0] > 0 or found[0] != found[1] or looks[0] != looks[1])


if __name__ == "__main__":
    sys.exit(main())
