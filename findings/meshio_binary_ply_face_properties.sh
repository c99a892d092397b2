#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# meshio 5.3.5: a binary PLY whose faces have a number beside their list of vertices cannot be read; the same file as text
# can.
#
# Scanners and MeshLab write a quality, a colour or a part number to each face: `property list uchar int vertex_indices`,
# then `property int part`. The reader takes the lists of all faces first and the numbers of all faces behind them, but in
# the file they alternate. What it then finds in the place of a count differs, and so does the exception: TypeError for one
# number, ValueError for three bytes of colour, IndexError for other values. plyfile 1.1.2 and trimesh 5.2.0 read all of them.
# Seen: "text: 2 faces", "part: IndexError", "colour: ValueError", "quality: TypeError", plyfile and trimesh "2 faces" each.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check meshio==5.3.5 plyfile==1.1.2 trimesh==5.2.0 numpy==2.2.6
cd "$folder"
cat > probe.py << 'END'
import struct

import meshio
import plyfile
import trimesh

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
FACES = [(0, 1, 2), (0, 2, 3)]


def write(name, binary, properties, pack, values):
    header = ["ply", "format " + ("binary_little_endian" if binary else "ascii") + " 1.0", "element vertex 4"]
    header += [f"property float {axis}" for axis in "xyz"] + ["element face 2", "property list uchar int vertex_indices"]
    header += [f"property {text}" for text in properties] + ["end_header", ""]
    with open(name, "wb") as out:
        out.write("\n".join(header).encode())
        for corner in CORNERS:
            out.write(struct.pack("<3f", *corner) if binary else ("%d %d %d\n" % corner).encode())
        for face, value in zip(FACES, values):
            out.write(struct.pack("<B3i" + pack, 3, *face, *value) if binary
                      else " ".join(map(str, (3, *face, *value))).encode() + b"\n")


write("text.ply", False, ["int part"], "i", [(5,), (6,)])
write("part.ply", True, ["int part"], "i", [(5,), (6,)])
write("colour.ply", True, ["uchar red", "uchar green", "uchar blue"], "3B", [(10, 20, 30)] * 2)
write("quality.ply", True, ["float quality"], "f", [(0.25,), (0.75,)])
for name in ("text", "part", "colour", "quality"):
    try:
        print(f"{name}: {len(meshio.read(name + '.ply').cells[0].data)} faces")
    except Exception as error:
        print(f"{name}: {type(error).__name__}")
    print(" plyfile", len(plyfile.PlyData.read(name + ".ply")["face"].data), "faces")
    print(" trimesh", len(trimesh.load(name + ".ply", process=False).faces), "faces")
END
venv/bin/python probe.py | tee seen
diff seen - << 'END'
text: 2 faces
 plyfile 2 faces
 trimesh 2 faces
part: IndexError
 plyfile 2 faces
 trimesh 2 faces
colour: ValueError
 plyfile 2 faces
 trimesh 2 faces
quality: TypeError
 plyfile 2 faces
 trimesh 2 faces
END
