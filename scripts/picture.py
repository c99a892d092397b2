#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the meshes of a PLY that `cchip demo --ply` or `cchip meshpairs --ply` wrote, as PNG on a transparent ground.

usage: scripts/picture.py MESHES.ply PICTURE.png          draw
       scripts/picture.py MESHES.ply PICTURE.png --check  compare: exit 1 if the picture is not of these meshes

Needs Python's standard library only. Exit codes: 0 done, 1 the picture is stale or missing, 2 wrong command line.
"""
import argparse
import math
import struct
import sys
import zlib

WIDTH, HEIGHT = 880, 600
SAMPLES = 2           # of a pixel's side
# The demo's pose deep from below, where the gear cuts through the tube. Lengths are in the meshes' unit.
VIEW = (2.0, -3.0, -1.5)     # from the target to the camera
TARGET = (0.55, 0.23, 0.02)
DISTANCE = 9.0               # of the camera
SPAN = 4.15                  # width of the picture at the target
KEY_LIGHT = (-0.35, 0.5, 0.8)   # to the right, up, to the camera
FILL_LIGHT = (0.5, -0.8, 0.5)
CREASE = math.cos(math.radians(40))  # faces that meet at less look smooth
EDGE = 0.05           # darkening of the faces' edges
# --check: share of the bytes that may differ by more than this, because sines differ in the last bit between machines
MOST_DIFFERENT, TOLERANCE = 0.00005, 12


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(dot(a, a)) or 1.0
    return (a[0] / length, a[1] / length, a[2] / length)


def read_ply(path):
    """Faces as (corners, colour) of the one layout that cchip writes."""
    with open(path, "rb") as file:
        content = file.read()
    head, _, body = content.partition(b"end_header\n")
    counts = [int(line.split()[2]) for line in head.decode().splitlines() if line.startswith("element")]
    if b"binary_little_endian" not in head or len(counts) != 2:
        sys.exit(f"picture.py: {path}: not written by cchip; make it with cchip demo --ply")
    vertex = struct.Struct("<3d3B")
    points = [vertex.unpack_from(body, i * vertex.size)[:3] for i in range(counts[0])]
    at = counts[0] * vertex.size
    faces = []
    for _ in range(counts[1]):
        corners = body[at]
        numbers = struct.unpack_from(f"<{corners}I", body, at + 1)
        at += 1 + 4 * corners
        faces.append(([points[i] for i in numbers], tuple(body[at:at + 3])))
        at += 3
    return faces


def corner_normals(faces):
    """For each face one normal a corner: the mean over the faces around it that are not beyond a crease."""
    normals = [unit(cross(sub(c[1], c[0]), sub(c[2], c[0]))) for c, _ in faces]
    around = {}
    for i, (corners, _) in enumerate(faces):
        for corner in corners:
            around.setdefault(corner, []).append(normals[i])
    result = []
    for i, (corners, _) in enumerate(faces):
        own = normals[i]
        result.append([unit(tuple(map(sum, zip(*[n for n in around[c] if dot(n, own) > CREASE])))) for c in corners])
    return result


def triangles_of(faces):
    """(three corners, three normals, colour, whether the side opposite to each corner is a side of the face)"""
    for (corners, colour), normals in zip(faces, corner_normals(faces)):
        last = len(corners) - 1
        for k in range(1, last):
            pick = (0, k, k + 1)
            yield [corners[i] for i in pick], [normals[i] for i in pick], colour, (True, k + 1 == last, k == 1)


def shade(normal, colour, edge):
    """Colour of a point: two lights and a highlight."""
    key = max(0.0, dot(normal, LIGHTS[0]))
    fill = max(0.0, dot(normal, LIGHTS[1]))
    light = (0.45 + 0.50 * key + 0.30 * fill) * (1 - edge)
    shine = 30 * max(0.0, dot(normal, HALF)) ** 40
    return [min(255.0, c * light + shine) for c in colour]


BACK = unit(VIEW)
RIGHT = unit(cross((0, 0, 1), BACK))
UP = cross(BACK, RIGHT)
LIGHTS = [unit([sum(l * axis[i] for l, axis in zip(light, (RIGHT, UP, BACK))) for i in range(3)])
          for light in (KEY_LIGHT, FILL_LIGHT)]
HALF = unit(tuple(a + b for a, b in zip(LIGHTS[0], BACK)))


def project(point):
    """Column, row and 1 / depth of a point."""
    p = sub(point, TARGET)
    depth = DISTANCE - dot(p, BACK)
    scale = WIDTH * SAMPLES / SPAN * DISTANCE / depth
    return (WIDTH * SAMPLES / 2 + scale * dot(p, RIGHT), HEIGHT * SAMPLES / 2 - scale * dot(p, UP), 1 / depth)


def span(start, slope, least, greatest):
    """The part of least..greatest where start + slope * x is not negative."""
    if slope > 0:
        return max(least, -start / slope), greatest
    if slope < 0:
        return least, min(greatest, -start / slope)
    return (least, greatest) if start >= 0 else (1, 0)


def draw(faces):
    """Samples row by row, each None or a colour; the nearest surface wins."""
    width, height = WIDTH * SAMPLES, HEIGHT * SAMPLES
    nearest = [0.0] * (width * height)
    owner = [None] * (width * height)
    for triangle in triangles_of(faces):
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = map(project, triangle[0])
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if area >= 0:   # seen from behind, because rows count downwards
            continue
        heights = [-area / math.dist(a, b) for a, b in
                   (((x1, y1), (x2, y2)), ((x2, y2), (x0, y0)), ((x0, y0), (x1, y1)))]
        step0, step1 = (y1 - y2) / area, (y2 - y0) / area
        for y in range(max(0, math.ceil(min(y0, y1, y2))), min(height - 1, math.floor(max(y0, y1, y2))) + 1):
            # the weights of the corners are linear along the row
            start0 = (x1 * y2 - x2 * y1 + y * (x2 - x1)) / area
            start1 = (x2 * y0 - x0 * y2 + y * (x0 - x2)) / area
            least, greatest = span(start0, step0, 0, width - 1)
            least, greatest = span(start1, step1, least, greatest)
            least, greatest = span(1 - start0 - start1, -step0 - step1, least, greatest)
            for x in range(math.ceil(least), math.floor(greatest) + 1):
                a = start0 + step0 * x
                b = start1 + step1 * x
                z = z2 + a * (z0 - z2) + b * (z1 - z2)
                if z > nearest[y * width + x]:
                    nearest[y * width + x] = z
                    owner[y * width + x] = (triangle, heights, a, b)
    return [sample and shade_sample(*sample) for sample in owner]


def shade_sample(triangle, heights, a, b):
    _, (n0, n1, n2), colour, sides = triangle
    c = 1 - a - b
    near = min([w * h for w, h, side in zip((a, b, c), heights, sides) if side], default=9)
    normal = unit((a * n0[0] + b * n1[0] + c * n2[0], a * n0[1] + b * n1[1] + c * n2[1],
                   a * n0[2] + b * n1[2] + c * n2[2]))
    return shade(normal, colour, EDGE * max(0.0, 1.6 - near))


def to_pixels(image):
    """Mean colour of the samples of each pixel; alpha is their share. Colours in steps of 4 keep the file small."""
    rows = []
    for y in range(HEIGHT):
        row = bytearray()
        for x in range(WIDTH):
            samples = [image[(y * SAMPLES + j) * WIDTH * SAMPLES + x * SAMPLES + i]
                       for j in range(SAMPLES) for i in range(SAMPLES)]
            seen = [s for s in samples if s]
            if seen:
                row += bytes(int(sum(channel) / len(seen)) & 0xFC for channel in zip(*seen))
                row.append(255 * len(seen) // len(samples))
            else:
                row += b"\0\0\0\0"
        rows.append(bytes(row))
    return rows


def write_png(path, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    filtered = bytearray()
    above = bytes(4 * WIDTH)
    for row in rows:
        left = bytes(4) + row[:-4]
        choices = [(0, row), (1, bytes((a - b) & 255 for a, b in zip(row, left))),
                   (2, bytes((a - b) & 255 for a, b in zip(row, above)))]
        kind, data = min(choices, key=lambda c: sum(min(v, 256 - v) for v in c[1]))
        filtered += bytes([kind]) + data
        above = row
    header = struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 6, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(filtered), 9)) +
                   chunk(b"IEND", b""))


def read_png(path):
    """Rows of a PNG that write_png() wrote."""
    with open(path, "rb") as file:
        content = file.read()
    at, data = 8, b""
    while at < len(content):
        length, kind = struct.unpack_from(">I4s", content, at)
        if kind == b"IHDR" and struct.unpack_from(">II", content, at + 8) != (WIDTH, HEIGHT):
            return []
        if kind == b"IDAT":
            data += content[at + 8:at + 8 + length]
        at += 12 + length
    data = zlib.decompress(data)
    rows = []
    above = bytes(4 * WIDTH)
    for y in range(HEIGHT):
        begin = y * (4 * WIDTH + 1)
        row = bytearray(data[begin + 1:begin + 1 + 4 * WIDTH])
        if data[begin] == 1:
            for i in range(4, len(row)):
                row[i] = (row[i] + row[i - 4]) & 255
        elif data[begin] == 2:
            row = bytearray((a + b) & 255 for a, b in zip(row, above))
        rows.append(bytes(row))
        above = row
    return rows


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("meshes")
    parser.add_argument("picture")
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    rows = to_pixels(draw(read_ply(options.meshes)))
    if not options.check:
        write_png(options.picture, rows)
        return
    try:
        old = read_png(options.picture)
    except (OSError, zlib.error, struct.error) as error:
        sys.exit(f"picture.py: {options.picture}: cannot be read ({error}); draw it with make picture")
    pairs = [pair for new_row, old_row in zip(rows, old) for pair in zip(new_row, old_row)]
    different = sum(abs(a - b) > TOLERANCE for a, b in pairs)
    print(f"{different} of {len(pairs)} bytes differ")
    if not pairs or different > MOST_DIFFERENT * len(pairs):
        sys.exit(f"picture.py: {options.picture} is not of these meshes; draw it with make picture")


if __name__ == "__main__":
    main()
