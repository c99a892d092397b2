#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# trimesh 5.2.0: a PLY of triangles that has an `element edge`, too, is not read unless scipy is installed.
#
# scipy is optional for trimesh, and the same triangles without the edges need none. The edges are of no use for the answer:
# with scipy the result is a Trimesh with the same faces and without the edges. MeshLab and Blender write such elements for
# loose or marked edges, so a program that was tested on files of faces stops on a user's file with ModuleNotFoundError, which
# names neither the file nor the element.
# Seen: "faces: Trimesh 1", "edges: ModuleNotFoundError scipy", with scipy "edges: Trimesh 1".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check trimesh==5.2.0 numpy==2.2.6
cd "$folder"
cat > probe.py << 'END'
import trimesh

HEAD = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" \
       "element face 1\nproperty list uchar int vertex_indices\n"
EDGES = "element edge 1\nproperty int vertex1\nproperty int vertex2\n"
BODY = "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
for name, text in (("faces", HEAD + BODY), ("edges", HEAD + EDGES + BODY + "0 1\n")):
    with open(name + ".ply", "w") as out:
        out.write(text)
    try:
        mesh = trimesh.load(name + ".ply", process=False)
        print(f"{name}: {type(mesh).__name__} {len(mesh.faces)}")
    except ModuleNotFoundError as error:
        print(f"{name}: ModuleNotFoundError {error.name}")
END
venv/bin/python probe.py | tee seen
venv/bin/pip install --quiet --disable-pip-version-check scipy==1.15.3
venv/bin/python probe.py | tee -a seen
diff seen - << 'END'
faces: Trimesh 1
edges: ModuleNotFoundError scipy
faces: Trimesh 1
edges: Trimesh 1
END
