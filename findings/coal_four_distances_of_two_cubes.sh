#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Coal 3.0.3 (PyPI): two cubes, one wholly inside the other: distance 0.4, -0.4 or -0.6, by how each of them is stored.
#
# A Box or Convex is a solid, a triangle mesh (BVHModel) only a skin; which of the two is the mesh decides. Outer mesh, inner
# anything: a gap of 0.4, no contact. Outer solid, inner mesh: a contact, -0.4, the deepest single triangle. Both solid: -0.6,
# the way out. So exchanging the mesh of one part for its exact box or hull turns "free, 0.4 apart" into "deep inside", and
# exchanging the other part does not. Equal cubes, in one place: 0 as soon as one is a mesh, and -1 if neither is.
# Seen (with the contact): "0.2 in mesh: mesh 0.4 False, box 0.4 False ...", "0.2 in box: mesh -0.4 True, box -0.6 True ...".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check coal==3.0.3 numpy==2.4.6
cd "$folder"
cat > probe.py << 'END'
import itertools

import coal
import numpy

CORNERS = list(itertools.product((-0.5, 0.5), repeat=3))
FACES = [(0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)]


def cube(kind, size):
    if kind == "box":
        return coal.Box(size, size, size)
    points, faces = coal.StdVec_Vec3s(), coal.StdVec_Triangle()
    for corner in CORNERS:
        points.append(size * numpy.array(corner))
    if kind == "hull":
        return coal.Convex.convexHull(points, True, "Qt")
    for face in FACES:
        faces.append(coal.Triangle(*face))
    mesh = coal.BVHModelOBBRSS()
    mesh.beginModel(len(FACES), len(CORNERS))
    mesh.addSubModel(points, faces)
    mesh.endModel()
    return mesh


place = coal.Transform3s()
for size, outer in itertools.product((0.2, 1.0), ("mesh", "box", "hull")):
    line = []
    for inner in ("mesh", "box", "hull"):
        pair = cube(outer, 1.0), place, cube(inner, size), place
        distance = coal.distance(*pair, coal.DistanceRequest(), coal.DistanceResult())
        contact = coal.collide(*pair, coal.CollisionRequest(), coal.CollisionResult()) > 0
        line.append(f"{inner} {round(distance, 3) + 0.0} {contact}")
    print(f"{size} in {outer}:", ", ".join(line))
END
venv/bin/python probe.py | tee seen
diff seen - << 'END'
0.2 in mesh: mesh 0.4 False, box 0.4 False, hull 0.4 False
0.2 in box: mesh -0.4 True, box -0.6 True, hull -0.6 True
0.2 in hull: mesh -0.4 True, box -0.6 True, hull -0.6 True
1.0 in mesh: mesh 0.0 True, box 0.0 True, hull 0.0 True
1.0 in box: mesh 0.0 True, box -1.0 True, hull -1.0 True
1.0 in hull: mesh 0.0 True, box -1.0 True, hull -1.0 True
END
