#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Blender, trimesh, cadquery, lib3mf and IfcOpenShell write one assembly; `cchip clash` must find all that is wrong.

usage: assemblies.py CCHIP [WRITER ...]      (from `scripts/run test-assemblies`, whose Python has the programs)

The assembly, in millimetres: flush lugs, a pin with 0.25 of clearance in its bush, blocks 0.5 deep in each other, a
part placed twice, a mirrored bracket with one part flush on it and one inside, a core in a house, a part scaled by its
placement, and a tilted group with flush lugs and one 0.01 too deep. Each file has a line; the last is
`files=N verdicts=N wrong=N skipped=N`; skipped is a program that this Python has not. Exit code 1: a wrong verdict."""
import contextlib
import json
import logging
import math
import os
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
SIDES = 32


def rectangle(x, y):
    return [(0, 0), (x, 0), (x, y), (0, y)]


# Prisms along z from 0: outline or radius, radius of the hole, height.
SHAPES = {
    "lug": (rectangle(20, 10), 0, 5),
    "bush": (10, 5, 10),
    "pin": (4.75, 0, 12),
    "bracket": ([(0, 0), (30, 0), (30, 5), (5, 5), (5, 20), (0, 20)], 0, 10),
    "house": (rectangle(12, 12), 0, 12),
    "core": (rectangle(2, 2), 0, 2),
}


def place(x, y, z, scale=(1, 1, 1)):
    pose = np.diag([*scale, 1.0])
    pose[:3, 3] = x, y, z
    return pose


def tilt():
    """About x, y and z by 10, 20 and 30 degrees, then moved."""
    pose = place(100, 50, 0)
    for axis, degrees in ((2, 30), (1, 20), (0, 10)):
        turn, i, j = np.eye(4), (axis + 1) % 3, (axis + 2) % 3
        turn[i, i] = turn[j, j] = math.cos(math.radians(degrees))
        turn[j, i] = math.sin(math.radians(degrees))
        turn[i, j] = -turn[j, i]
        pose = pose @ turn
    return pose


GROUP, GROUP_POSE = "tilted", tilt()
# Name, shape, pose, in the tilted group?
PARTS = [
    ("lug_a", "lug", place(0, 0, 0), False), ("lug_b", "lug", place(20, 0, 0), False),
    ("bush_a", "bush", place(60, 0, 0), False), ("pin_a", "pin", place(60, 0, -1), False),
    ("block_a", "lug", place(100, 0, 0), False), ("block_b", "lug", place(119.5, 2, 1), False),
    ("once", "lug", place(150, 0, 0), False), ("again", "lug", place(150, 0, 0), False),
    ("mirrored", "bracket", place(0, 50, 0, (-1, 1, 1)), False),
    ("inlay", "core", place(-7, 60, 4), False), ("seed", "core", place(-4, 65, 4), False),
    ("house_a", "house", place(60, 50, 0), False), ("core_a", "core", place(65, 55, 5), False),
    ("doubled", "core", place(170, 50, 0, (2, 2, 2)), False), ("small", "core", place(173.5, 51, 1), False),
    ("tilt_a", "lug", place(0, 0, 0), True), ("tilt_b", "lug", place(20, 3, 0), True),
    ("tilt_c", "lug", place(0, 9.99, 0), True),
]
# Verdict and, where it has one, depth or distance.
EXPECTED = {
    ("lug_a", "lug_b"): ("touching", None), ("bush_a", "pin_a"): ("too_near", (0.22, 0.26)),
    ("block_a", "block_b"): ("overlap", (0.4999, 0.5001)), ("once", "again"): ("duplicate", None),
    ("mirrored", "inlay"): ("touching", None), ("mirrored", "seed"): ("inside", None),
    ("house_a", "core_a"): ("inside", None), ("doubled", "small"): ("overlap", (0.4999, 0.5001)),
    ("tilt_a", "tilt_b"): ("flush", None), ("tilt_b", "tilt_c"): ("flush", None),
    ("tilt_a", "tilt_c"): ("overlap", (0.0099, 0.0101)),
}
ACCEPTED = [pair for pair, (verdict, _) in EXPECTED.items() if verdict in ("flush", "touching")]   # by a rule with EPS
EPS = 1e-4
CLEARANCE = 0.5


def mesh(shape):
    """Corners, and faces of any number of corners."""
    outline, hole, height = SHAPES[shape]

    def circle(radius):
        return [(radius * math.cos(2 * math.pi * i / SIDES), radius * math.sin(2 * math.pi * i / SIDES))
                for i in range(SIDES)]

    rings = [outline if isinstance(outline, list) else circle(outline)] + ([circle(hole)] if hole else [])
    n = len(rings[0])
    corners = [(x, y, z) for ring in rings for z in (0, height) for x, y in ring]
    following = [(i, (i + 1) % n) for i in range(n)]
    faces = [(i, j, n + j, n + i) for i, j in following]
    if hole:
        faces += [(2 * n + j, 2 * n + i, 3 * n + i, 3 * n + j) for i, j in following]
        faces += [(i, 2 * n + i, 2 * n + j, j) for i, j in following]
        faces += [(n + i, n + j, 3 * n + j, 3 * n + i) for i, j in following]
    elif shape == "bracket":
        faces += [(0, 3, 2, 1), (0, 5, 4, 3), (6, 7, 8, 9), (6, 9, 10, 11)]
    else:
        faces += [tuple(range(n - 1, -1, -1)), tuple(range(n, 2 * n))]
    return corners, faces


def triangles(faces):
    return [(face[0], face[i], face[i + 1]) for face in faces for i in range(1, len(face) - 1)]


def by_blender(folder):
    import bpy
    logging.disable(logging.INFO)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    from mathutils import Matrix
    group = bpy.data.objects.new(GROUP, None)
    bpy.context.collection.objects.link(group)
    group.matrix_world = Matrix(GROUP_POSE.tolist())
    data = {}
    for name in SHAPES:
        data[name] = bpy.data.meshes.new(name)
        corners, faces = mesh(name)
        data[name].from_pydata(corners, [], faces)
    for name, shape, pose, tilted in PARTS:
        part = bpy.data.objects.new(name, data[shape])
        bpy.context.collection.objects.link(part)
        if tilted:
            part.parent = group
        part.matrix_local = Matrix(pose.tolist())
    for ending, form in (("glb", "GLB"), ("gltf", "GLTF_SEPARATE")):
        path = folder / f"blender.{ending}"
        bpy.ops.export_scene.gltf(filepath=str(path), export_format=form)
        yield path, 1


def by_trimesh(folder):
    import trimesh

    def scene(own):
        result = trimesh.Scene()
        result.graph.update(frame_from=result.graph.base_frame, frame_to=GROUP, matrix=GROUP_POSE)
        for name, shape, pose, tilted in PARTS:
            corners, faces = mesh(shape)
            result.add_geometry(trimesh.Trimesh(corners, triangles(faces)), node_name=name,
                                geom_name=name if own else shape, transform=pose,
                                parent_node_name=GROUP if tilted else None)
        return result

    for ending in ("glb", "3mf"):   # 3MF has no names of placements
        path = folder / f"trimesh.{ending}"
        scene(own=ending == "3mf").export(path)
        yield path, 1


def by_cadquery(folder):
    import cadquery

    def solid(shape, pose):
        outline, hole, height = SHAPES[shape]
        plane = cadquery.Workplane("XY")
        plane = plane.polyline(outline).close() if isinstance(outline, list) else plane.circle(outline)
        plane = (plane.circle(hole) if hole else plane).extrude(height)
        scale = pose.diagonal()[:3]
        return plane.mirror("YZ") if scale[0] < 0 else plane.newObject([plane.val().scale(scale[0])])

    assembly, group = cadquery.Assembly(name="assembly"), cadquery.Assembly(name=GROUP)
    for name, shape, pose, tilted in PARTS:
        (group if tilted else assembly).add(solid(shape, pose), name=name,
                                            loc=cadquery.Location(cadquery.Vector(*pose[:3, 3])))
    plane = cadquery.Plane(origin=tuple(GROUP_POSE[:3, 3]), xDir=tuple(GROUP_POSE[:3, 0]),
                           normal=tuple(GROUP_POSE[:3, 2]))
    assembly.add(group, loc=cadquery.Location(plane))
    for ending in ("glb", "gltf"):
        path = folder / f"cadquery.{ending}"
        assembly.export(str(path))
        yield path, 1


def by_lib3mf(folder):
    import lib3mf
    model = lib3mf.get_wrapper().CreateModel()

    def transform(pose):
        result = lib3mf.Transform()
        for i in range(4):
            for j in range(3):
                result.Fields[i][j] = float(pose[j, i])
        return result

    def position(corner):
        result = lib3mf.Position()
        result.Coordinates[:] = [float(x) for x in corner]
        return result

    def triangle(face):
        result = lib3mf.Triangle()
        result.Indices[:] = face
        return result

    data = {}
    for name in SHAPES:
        corners, faces = mesh(name)
        data[name] = model.AddMeshObject()
        data[name].SetName(name)
        data[name].SetGeometry([position(c) for c in corners], [triangle(f) for f in triangles(faces)])
    group = model.AddComponentsObject()
    group.SetName(GROUP)
    for name, shape, pose, tilted in PARTS:
        part = model.AddComponentsObject()
        part.SetName(name)
        part.AddComponent(data[shape], transform(np.eye(4)))
        if tilted:
            group.AddComponent(part, transform(pose))
        else:
            model.AddBuildItem(part, transform(pose))
    model.AddBuildItem(group, transform(GROUP_POSE))
    path = folder / "lib3mf.3mf"
    model.QueryWriter("3mf").WriteToFile(str(path))
    yield path, 1


def ifc_model():
    import ifcopenshell
    import ifcopenshell.api.context
    import ifcopenshell.api.geometry
    import ifcopenshell.api.root
    import ifcopenshell.api.unit
    model = ifcopenshell.file(schema="IFC4")
    ifcopenshell.api.root.create_entity(model, ifc_class="IfcProject", name="assembly")
    ifcopenshell.api.unit.assign_unit(model)   # millimetres
    whole = ifcopenshell.api.context.add_context(model, context_type="Model")
    body = ifcopenshell.api.context.add_context(model, context_type="Model", context_identifier="Body",
                                                target_view="MODEL_VIEW", parent=whole)

    def point(*numbers):
        return model.createIfcCartesianPoint([float(x) for x in numbers])

    def way(numbers):
        return model.createIfcDirection([float(x) for x in numbers])

    def axes(pose):
        return model.createIfcAxis2Placement3D(point(*pose[:3, 3]), way(pose[:3, 2]), way(pose[:3, 0]))

    def solid(shape):
        outline, hole, height = SHAPES[shape]
        if isinstance(outline, list):
            line = model.createIfcPolyline([point(*p) for p in [*outline, outline[0]]])
            profile = model.createIfcArbitraryClosedProfileDef("AREA", shape, line)
        elif hole:
            profile = model.createIfcCircleHollowProfileDef("AREA", shape, None, outline, outline - hole)
        else:
            profile = model.createIfcCircleProfileDef("AREA", shape, None, outline)
        solid = model.createIfcExtrudedAreaSolid(profile, axes(np.eye(4)), way((0, 0, 1)), height)
        return model.createIfcRepresentationMap(
            axes(np.eye(4)), model.createIfcShapeRepresentation(body, "Body", "SweptSolid", [solid]))

    maps = {name: solid(name) for name in SHAPES}
    group = ifcopenshell.api.root.create_entity(model, ifc_class="IfcElementAssembly", name=GROUP)
    group.ObjectPlacement = model.createIfcLocalPlacement(None, axes(GROUP_POSE))
    for name, shape, pose, tilted in PARTS:
        scale = pose.diagonal()[:3]
        mapped = model.createIfcMappedItem(maps[shape], model.createIfcCartesianTransformationOperator3D(
            way((math.copysign(1, scale[0]), 0, 0)), way((0, 1, 0)), point(0, 0, 0), abs(scale[0]), way((0, 0, 1))))
        part = ifcopenshell.api.root.create_entity(model, ifc_class="IfcBuildingElementProxy", name=name)
        part.ObjectPlacement = model.createIfcLocalPlacement(group.ObjectPlacement if tilted else None,
                                                             axes(place(*pose[:3, 3])))
        part.Representation = model.createIfcProductDefinitionShape(None, None, [
            model.createIfcShapeRepresentation(body, "Body", "MappedRepresentation", [mapped])])
    return model


def by_ifcopenshell(folder):
    import ifcopenshell.geom
    model = ifc_model()
    model.write(str(folder / "model.ifc"))
    settings = ifcopenshell.geom.settings()
    settings.set("mesher-angular-deflection", 0.1)
    settings.set("use-element-names", True)
    path = folder / "ifcopenshell.glb"
    writer = ifcopenshell.geom.serializers.glb(str(path), settings)
    writer.setFile(model)
    writer.setUnitNameAndMagnitude("METER", 1.0)
    writer.writeHeader()
    for element in ifcopenshell.geom.iterator(settings, model):
        writer.write(element)
    writer.finalize()
    yield path, 0.001
    subprocess.run([sys.executable, ROOT / "lib/python/examples/ifc_to_assembly.py", folder / "model.ifc",
                    folder / "ifc"], check=True, stdout=subprocess.DEVNULL)
    yield folder / "ifc/assembly.toml", 0.001


WRITERS = {"bpy": by_blender, "trimesh": by_trimesh, "cadquery": by_cadquery, "lib3mf": by_lib3mf,
           "ifcopenshell": by_ifcopenshell}


def clash(cchip, path, scale, *options):
    """Exit code and report of `cchip clash`."""
    run = subprocess.run([cchip, "clash", path, "--unit", "mm" if scale == 1 else "m", "--clearance",
                          str(CLEARANCE * scale), "--json", "-", *options], capture_output=True, text=True, timeout=300)
    if run.returncode not in (0, 1):
        raise RuntimeError(f"exit code {run.returncode}: {run.stderr.strip()}")
    return run.returncode, json.loads(run.stdout)


def called(name):
    """The part of PARTS in a path of names."""
    return next((word for word in name.split("/") if any(word == part[0] for part in PARTS)), name)


def relation(pair, scale):
    """Verdict, and depth or distance in millimetres."""
    depth = pair["depth"] if pair["depth"] is not None else (pair["distance"] or [None])[-1]
    a, b, verdict = called(pair["a"]), called(pair["b"]), pair["verdict"]
    if verdict in ("a_in_b", "b_in_a"):
        return ((b, a) if verdict == "a_in_b" else (a, b)), "inside", None
    return ((a, b) if (a, b) in EXPECTED else (b, a)), verdict, None if depth is None else depth / scale


def wrong_verdicts(cchip, path, scale):
    """Sentences, one for each pair that is not as EXPECTED."""
    found = {}
    for pair in clash(cchip, path, scale)[1]["pairs"]:
        key, verdict, depth = relation(pair, scale)
        found[key] = (pair["a"], pair["b"]), verdict, depth, pair["text"]
    rules = path.parent / "rules.toml"
    rules.write_text("".join(f'[[rule]]\nparts = {json.dumps(found[pair][0])}\nallow = "overlap"\n'
                             f"eps = {EPS * scale}\n" for pair in ACCEPTED if pair in found))
    code, report = clash(cchip, path, scale, "--rules", rules)
    violations = {relation(pair, scale)[0] for pair in report["pairs"] if pair["violation"]}
    wrong = []
    for key in {**EXPECTED, **found}:
        wanted, limits = EXPECTED.get(key, ("nothing", None))
        _, verdict, depth, text = found.get(key, (None, "no line", None, ""))
        if wanted == "flush" or (wanted == "touching" and scale != 1):   # rounded, they touch no more
            right = verdict in ("touching", "overlap") or (verdict == "too_near" and depth < EPS)
        else:
            right = verdict == wanted and (limits is None or (depth is not None and limits[0] < depth < limits[1]))
        if not right or (key in violations) != (key not in ACCEPTED):
            wrong.append(f"{' and '.join(key)}, wanted {wanted}: {verdict}: {text}"
                         + ("; the rule does not accept it" if right else ""))
    if code != 1 or len(report["parts"]) != len(PARTS):
        wrong.append(f"exit code {code}, {len(report['parts'])} parts")
    return wrong


def main(cchip, chosen):
    files = wrong = skipped = 0
    with tempfile.TemporaryDirectory() as name:
        for module in chosen or WRITERS:
            try:
                with open(os.devnull, "w") as quiet, contextlib.redirect_stdout(quiet):
                    paths = list(WRITERS[module](pathlib.Path(name)))
            except ModuleNotFoundError as error:
                skipped += 1
                print(f"{module}: skipped: {error}")
                continue
            for path, scale in paths:
                found = wrong_verdicts(cchip, path, scale)
                files, wrong = files + 1, wrong + len(found)
                print("\n  ".join([f"{path.relative_to(name)}: {len(EXPECTED)} verdicts, {len(found)} wrong", *found]))
    print(f"files={files} verdicts={files * len(EXPECTED)} wrong={wrong} skipped={skipped}")
    return int(wrong > 0 or files == 0)


if __name__ == "__main__":
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= set(WRITERS):
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve(), sys.argv[2:]))
