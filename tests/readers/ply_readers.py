#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Other programs read the PLY files that cchip writes, and the remedies in its error messages are run.

usage: ply_readers.py CCHIP      (from `scripts/run test-ply`, whose Python has the programs)

Each program must see the vertices, faces and colours that are in the file: to the last bit where it keeps doubles, else
rounded to single precision. The last line is `readings=N remedies=N failures=N`. Exit code 1 if one failed."""
import json
import pathlib
import re
import struct
import subprocess
import sys
import tempfile

CUBE = """v 0.1 0 0\nv 1.1 0 0\nv 1.1 1 0\nv 0.1 1 0\nv 0.1 0 1\nv 1.1 0 1\nv 1.1 1 1\nv 0.1 1 1
f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 3 4 8 7\nf 2 3 7 6\nf 4 1 5 8\n"""
TRIANGLES = "v 0.3 0.3 -5\nv 0.7 0.3 5\nv 0.3 0.7 5\nv 9 9 9\nf 1 2 3\nf 2 3 4\n"
FAR = "v 7 0 0\nv 8 0 0\nv 7 1 0\nf 1 2 3\n"

# Each prints vertices, lists of corners, colours of vertices (or null) and the count of edges (or null) as JSON.
OUT = ("; import json, numpy as np; print('\\n' + json.dumps([np.asarray(v, dtype=float).tolist(), [[int(i) for i in "
       "f] for f in faces], c, e]))")
EXACT = {
    "trimesh": "import trimesh; m = trimesh.load(P, process=False); v, faces, c, e = m.vertices, m.faces, "
               "m.visual.vertex_colors[:, :3].tolist(), None",
    "meshio": "import meshio; m = meshio.read(P); v, faces = m.points, [f for b in m.cells for f in b.data]; "
              "c = [[int(m.point_data[k][i]) % 256 for k in ('red', 'green', 'blue')] for i in range(len(v))]; "
              "e = None",
    "plyfile": "import plyfile; m = plyfile.PlyData.read(P); a = m['vertex']; v = [[a[k][i] for k in 'xyz'] for i in "
               "range(len(a.data))]; "
               "faces = m['face']['vertex_indices']; c = [[int(a[k][i]) for k in ('red', 'green', 'blue')] for i in "
               "range(len(v))]; "
               "e = len(m['edge'].data) if 'edge' in m else 0",
    "pymeshlab": "import pymeshlab; s = pymeshlab.MeshSet(); s.load_new_mesh(P); m = s.current_mesh(); v, faces = "
                 "m.vertex_matrix(), m.face_matrix(); "
                 "c = [[round(255 * x) for x in r[:3]] for r in m.vertex_color_matrix().tolist()]; e = m.edge_number()",
    "open3d": "import ctypes, libusb_package; ctypes.CDLL(str(libusb_package.get_library_path()), "
              "mode=ctypes.RTLD_GLOBAL); import open3d, numpy; "
              "m = open3d.io.read_triangle_mesh(P); v, faces = numpy.asarray(m.vertices), numpy.asarray(m.triangles); "
              "c = [[round(255 * x) for x in r] for r in numpy.asarray(m.vertex_colors).tolist()]; e = None",
}
SINGLE = {
    "vtk": "from vtkmodules.vtkIOPLY import vtkPLYReader; r = vtkPLYReader(); r.SetFileName(P); r.Update(); o = "
           "r.GetOutput(); "
           "v = [o.GetPoint(i) for i in range(o.GetNumberOfPoints())]; "
           "faces = [[o.GetCell(i).GetPointId(k) for k in range(o.GetCell(i).GetNumberOfPoints())] for i in "
           "range(o.GetNumberOfCells())]; "
           "a = o.GetPointData().GetScalars(); c = [[int(x) for x in a.GetTuple(i)[:3]] for i in range(len(v))]; e = "
           "None",
    "bpy": "import bpy; bpy.ops.wm.ply_import(filepath=P); m = bpy.context.object.data; v = [list(x.co) for x in "
           "m.vertices]; "
           "faces = [list(p.vertices) for p in m.polygons]; c = None; e = sum(x.is_loose for x in m.edges)",
}


def our_ply(path):
    """Vertices, faces, colours and count of edges of a PLY of cchip."""
    head, _, body = path.read_bytes().partition(b"end_header\n")
    counts = {line.split()[1]: int(line.split()[2])
              for line in head.decode().splitlines() if line.startswith("element")}
    points = [struct.unpack_from("<3d3B", body, 27 * i) for i in range(counts["vertex"])]
    at = 27 * len(points)
    faces = []
    for _ in range(counts["face"]):
        faces.append(list(struct.unpack_from(f"<{body[at]}i", body, at + 1)))
        at += 1 + 4 * body[at]
    return [list(p[:3]) for p in points], faces, [list(p[3:]) for p in points], counts.get("edge", 0)


def single(points):
    return [list(struct.unpack("<3f", struct.pack("<3f", *p))) for p in points]


def same(read, expected, exact):
    points, faces, colours, edges = read
    if points != (expected[0] if exact else single(expected[0])):
        return "other vertices"
    if faces != expected[1] and not (any(len(f) == 4 for f in expected[1]) and len(faces) == 2 * len(expected[1])):
        return "other faces"
    if colours is not None and colours != expected[2]:
        return "other colours"
    return "other edges" if edges is not None and edges != expected[3] else ""


def read_by(code, path):
    made = subprocess.run([sys.executable, "-c", f"P = {str(path)!r}; {code}{OUT}"], capture_output=True, text=True)
    if made.returncode != 0:
        raise RuntimeError((made.stderr.strip() or made.stdout.strip() or "no output").splitlines()[-1])
    return json.loads(next(line for line in reversed(made.stdout.splitlines()) if line.startswith("[[[")))


def pictures(cchip, folder):
    """Files of cchip: names and paths."""
    for name, text in (("cube.obj", CUBE), ("triangles.obj", TRIANGLES), ("far.obj", FAR)):
        (folder / name).write_text(text)
    commands = {
        "quads and triangles, curves": "collide cube.obj triangles.obj",
        "quads, curves": "collide cube.obj cube.obj --pose 0.5,0.25,0.125",
        "quads": "collide cube.obj cube.obj --pose 3,0,0",
        "triangles": "collide triangles.obj far.obj",
        "triangles, curves": "collide triangles.obj triangles.obj --pose 0.05,0.02,0.5,0,30,0",
        "distance": "distance cube.obj far.obj",
        "candidate pairs": "meshpairs cube.obj triangles.obj --engine exact",
    }
    for i, (name, command) in enumerate(commands.items()):
        path = folder / f"{i}.ply"
        subprocess.run([cchip, *command.split(), "--ply", path], cwd=folder, check=True, capture_output=True)
        yield name, path


def check_readers(cchip, folder):
    readings = failures = 0
    for name, path in pictures(cchip, folder):
        expected = our_ply(path)
        if ("curves" in name or name == "distance") != (expected[3] > 0):
            raise RuntimeError(f"{name}: {expected[3]} edges")
        for program, code in {**EXACT, **SINGLE}.items():
            if program == "meshio" and expected[3] > 0:
                continue   # it ends the process at any element besides vertex and face
            readings += 1
            try:
                what = same(read_by(code, path), expected, program in EXACT)
            except RuntimeError as error:
                what = str(error)
            if what:
                failures += 1
                print(f"{program}, {name}: {what}")
    return readings, failures


# Files in formats that cchip does not read, made by other programs: a box from 0.1 0 0 to 1.1 1 1 (or its corners).
BOX = "import pyvista; b = pyvista.Box((0.1, 1.1, 0, 1, 0, 1)); b.points = b.points.astype(float).round(6); "
MAKE = {
    "box.glb": "import trimesh; s = trimesh.Scene(); b = trimesh.creation.box(); t = [[1, 0, 0, 0.5], [0, 1, 0, 0.5], "
               "[0, 0, 1, 0.5], [0, 0, 0, 1]]; "
               "s.add_geometry(b, transform=t); s.export('box.glb')",
    "box.3mf": "import trimesh; trimesh.Scene(trimesh.creation.box(bounds=[[0.1, 0, 0], [1.1, 1, "
               "1]])).export('box.3mf')",
    "box.vtp": BOX + "b.save('box.vtp')",
    "box.vtk": BOX + "b.cast_to_unstructured_grid().save('box.vtk')",
    "box.msh": "import meshio, trimesh; b = trimesh.creation.box(bounds=[[0.1, 0, 0], [1.1, 1, 1]]); "
               "meshio.Mesh(b.vertices, [('triangle', b.faces)]).write('box.msh', file_format='gmsh')",
    "box.step": "import gmsh; gmsh.initialize(); gmsh.model.occ.addBox(0.1, 0, 0, 1, 1, 1); "
                "gmsh.model.occ.synchronize(); gmsh.write('box.step')",
    "scan.laz": "import laspy, numpy; l = laspy.LasData(laspy.LasHeader(point_format=3, version='1.2')); "
                "l.header.scales = [0.001] * 3; "
                "l.x, l.y, l.z = numpy.array([0.1, 1.1]), numpy.array([0., 1.]), numpy.array([0., 1.]); "
                "l.write('scan.laz')",
    "scan.las": "import laspy, numpy; l = laspy.LasData(laspy.LasHeader(point_format=3, version='1.2')); "
                "l.header.scales = [0.001] * 3; "
                "l.x, l.y, l.z = numpy.array([0.1, 1.1]), numpy.array([0., 1.]), numpy.array([0., 1.]); "
                "l.write('scan.las')",
}


def bounds(lines):
    points = [[float(x) for x in line] for line in lines]
    return [[f(axis) for axis in zip(*points)] for f in (min, max)]


def check_remedy(cchip, folder, name):
    """Runs the command between backticks of the message about a file; what is wrong, or nothing."""
    subprocess.run([sys.executable, "-c", MAKE[name]], cwd=folder, check=True, capture_output=True)
    refused = subprocess.run([cchip, "collide", name, "cube.obj"], cwd=folder, capture_output=True, text=True)
    commands = re.findall("`([^`]+)`", refused.stderr)
    if refused.returncode != 2 or len(commands) != 1:
        return f"exit code {refused.returncode}: {refused.stderr}"
    programs = pathlib.Path(sys.executable).parent
    made = subprocess.run(f"PATH={programs}:$PATH; {commands[0]}", shell=True, cwd=folder,
                          capture_output=True, text=True)
    results = [folder / n for n in ("part.obj", "part.stl", "scan.xyz") if (folder / n).exists()]
    if made.returncode != 0 or len(results) != 1:
        return made.stderr[-300:]
    words = [line.split() for line in results[0].read_text().splitlines()]
    points = words if results[0].suffix == ".xyz" else [w[1:4] for w in words if w and w[0] in ("v", "vertex")]
    options = ["--points"] if results[0].suffix == ".xyz" else []
    answer = subprocess.run([cchip, "collide", results[0], "cube.obj", *options], cwd=folder,
                            capture_output=True, text=True)
    results[0].unlink()
    if answer.returncode != 0 or not answer.stdout.startswith("touch"):
        return answer.stderr + answer.stdout
    low = 0.0 if name == "box.glb" else 0.1
    expected = [[low, 0, 0], [low + 1, 1, 1]]
    return "" if bounds(points) == expected else f"box {bounds(points)}"


MESHLAB = """import sys, pymeshlab
s = pymeshlab.MeshSet(); s.load_new_mesh("cube.obj"); s.save_current_mesh(sys.argv[1])
s = pymeshlab.MeshSet(); s.load_new_mesh(sys.argv[1]); s.save_current_mesh("part.ply")
v = s.current_mesh().vertex_matrix(); print(v.min(0).round(6).tolist(), v.max(0).round(6).tolist())"""


def check_meshlab(folder, name):
    """MeshLab keeps the axes and the unit of a file that it wrote and reads."""
    made = subprocess.run([sys.executable, "-c", MESHLAB, name], cwd=folder, capture_output=True, text=True)
    return "" if made.stdout.splitlines()[-1:] == [
        "[0.1, 0.0, 0.0] [1.1, 1.0, 1.0]"] else made.stdout + made.stderr[-300:]


def main(cchip):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        readings, failures = check_readers(cchip, folder)
        remedies = [(file, check_remedy(cchip, folder, file)) for file in MAKE]
        remedies += [(file, check_meshlab(folder, file)) for file in ("box.dae", "box.3ds", "box.wrl")]
        for file, what in remedies:
            if what:
                failures += 1
                print(f"remedy for {file}: {what}")
    print(f"readings={readings} remedies={len(remedies)} failures={failures}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]).resolve()))
