#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the meshes of a PLY that `cchip ... --ply` wrote, as PNG on a transparent ground. The camera stands back until
all is in the picture. Needs Python's standard library only; some seconds for each 10,000 faces.
Exit codes: 0 done, 1 the picture is stale or missing, 2 wrong command line or a file that is not such a PLY."""
import argparse
import math
import struct
import sys
import zlib

WIDTH, HEIGHT = 880, 600
SAMPLES = 2           # of a pixel's side
VIEW = (1.0, -1.6, 1.1)      # from the target to the camera
MARGIN = 0.04                # of the picture's width and height, on each side
ANGLE = 26.0                 # degrees that the picture's width takes
KEY_LIGHT = (-0.35, 0.5, 0.8)   # to the right, up, to the camera
FILL_LIGHT = (0.5, -0.8, 0.5)
CREASE = math.cos(math.radians(40))  # faces that meet at less look smooth
LINE = 3.0            # half width of a line of the PLY, samples
ABOVE = 1.004         # lines are this much nearer than they lie, so that the faces they lie on do not cover them
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


def normalised(faces, edges):
    """The same about the origin, the faces with a box of side 1: lengths of any unit can be multiplied then."""
    corners = [corner for corners, _ in faces for corner in corners]
    least, greatest = (tuple(f(axis) for axis in zip(*corners)) for f in (min, max))
    size = max(g / 2 - s / 2 for g, s in zip(greatest, least)) or 1.0   # of half the box: the whole may overflow
    return tuple([([tuple((x / 2 - g / 4 - s / 4) / size for x, s, g in zip(corner, least, greatest))
                    for corner in corners], colour)
                  for corners, colour in part] for part in (faces, edges))


class NotOurs(Exception):
    """A file that is not a PLY of cchip."""


def read_ply(path):
    """Faces and edges as (corners, colour) of the one layout that cchip writes."""
    with open(path, "rb") as file:
        content = file.read()
    head, _, body = content.partition(b"end_header\n")
    lines = head.decode("latin-1").splitlines()
    names = [line.split()[1:] for line in lines if line.startswith("element")]
    properties = [line.split()[-1] for line in lines if line.startswith("property")]
    colours = ["red", "green", "blue"]
    has_edges = len(names) == 3
    if ("format binary_little_endian 1.0" not in lines
        or [name[0] for name in names] != ["vertex", "face", "edge"][:2 + has_edges]
            or properties != ["x", "y", "z", *colours, "vertex_indices"] + has_edges * ["vertex1", "vertex2"]):
        raise NotOurs
    counts = [int(name[1]) for name in names]
    vertex = struct.Struct("<3d3B")
    vertices = [vertex.unpack_from(body, i * vertex.size) for i in range(counts[0])]
    at = counts[0] * vertex.size
    outlines = []
    for _ in range(counts[1]):
        corners = body[at]
        numbers = struct.unpack_from(f"<{corners}i", body, at + 1)
        at += 1 + 4 * corners
        # the second half of a quad: faces share no vertices
        if outlines and numbers[:2] == (outlines[-1][0], outlines[-1][-1]):
            outlines[-1] += numbers[2:]
        else:
            outlines.append(numbers)
    if not outlines:
        raise NotOurs
    edges = [struct.unpack_from("<2i", body, at + 8 * i) for i in range(counts[2] if has_edges else 0)]
    return tuple([([vertices[i][:3] for i in numbers], vertices[numbers[0]][3:]) for numbers in part]
                 for part in (outlines, edges))


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
        # A face without area has no normal: it keeps the zero that unit() gives, and is not drawn.
        near = [[n for n in around[c] if dot(n, own) > CREASE] or [own] for c in corners]
        result.append([unit(tuple(map(sum, zip(*normals_near)))) for normals_near in near])
    return result


def triangles_of(faces):
    """(three corners, three normals, colour, whether the side opposite to each corner is a side of the face)"""
    for (corners, colour), normals in zip(faces, corner_normals(faces)):
        last = len(corners) - 1
        for k in range(1, last):
            pick = (0, k, k + 1)
            yield [corners[i] for i in pick], [normals[i] for i in pick], colour, (True, k + 1 == last, k == 1)


def shade(normal, colour, edge, camera):
    """Colour of a point: two lights and a highlight."""
    key = max(0.0, dot(normal, camera.lights[0]))
    fill = max(0.0, dot(normal, camera.lights[1]))
    light = (0.45 + 0.50 * key + 0.30 * fill) * (1 - edge)
    shine = 30 * max(0.0, dot(normal, camera.half)) ** 40
    return [min(255.0, c * light + shine) for c in colour]


class Camera:
    """Looks at a target from a distance. All lengths are in the meshes' unit."""

    def __init__(self, view, target=None, distance=None, span=None):
        """view: from the target to the camera; span: width of the picture at the target. The last three: see fit()."""
        self.back = unit(view)
        upright = abs(self.back[2]) < 0.999
        self.right = unit(cross((0, 0, 1) if upright else (0, 1, 0), self.back))
        self.up = cross(self.back, self.right)
        self.lights = [
            unit([sum(x * axis[i] for x, axis in zip(light, (self.right, self.up, self.back))) for i in range(3)])
                       for light in (KEY_LIGHT, FILL_LIGHT)]
        self.half = unit(tuple(a + b for a, b in zip(self.lights[0], self.back)))
        self.target, self.distance, self.span = target, distance, span

    def fit(self, points):
        """Goes to where all points are in the picture, each side of it as near as the others allow."""
        half_width = math.tan(math.radians(ANGLE / 2))
        axes = [(self.right, half_width * (1 - 2 * MARGIN)), (self.up, half_width * HEIGHT / WIDTH * (1 - 2 * MARGIN))]
        depths = [dot(p, self.back) for p in points]
        # A point at depth z is in the picture if |place - middle| <= slope * (eye - z), for the eye's place along
        # `back`.
        eye, middles = max(depths), []
        for axis, slope in axes:
            most = max(dot(p, axis) + slope * z for p, z in zip(points, depths))
            least = min(dot(p, axis) - slope * z for p, z in zip(points, depths))
            middles.append((most + least) / 2)
            eye = max(eye, (most - least) / 2 / slope)
        size = max(max(depths) - min(depths), *(max(c) - min(c) for c in zip(*points)))
        eye = max(eye, max(depths) + 0.01 * size) if size > 0 else eye + 1   # no point in the eye
        nearest = max(depths)
        self.distance = eye - nearest
        self.target = tuple(middles[0] * r + middles[1] * u + nearest * b
                            for r, u, b in zip(self.right, self.up, self.back))
        self.span = 2 * half_width * self.distance

    def project(self, point):
        """Column, row and 1 / depth of a point."""
        p = sub(point, self.target)
        depth = self.distance - dot(p, self.back)
        scale = WIDTH * SAMPLES / self.span * self.distance / depth
        return (WIDTH * SAMPLES / 2 + scale * dot(p, self.right),
                HEIGHT * SAMPLES / 2 - scale * dot(p, self.up), 1 / depth)


# The demo's pose deep from below, where the gear cuts through the tube.
DEMO = Camera((2.0, -3.0, -1.5), (0.55, 0.23, 0.02), 9.0, 4.15)


def span(start, slope, least, greatest):
    """The part of least..greatest where start + slope * x is not negative."""
    if slope > 0:
        return max(least, -start / slope), greatest
    if slope < 0:
        return least, min(greatest, -start / slope)
    return (least, greatest) if start >= 0 else (1, 0)


def draw_line(ends, colour, camera, nearest, image):
    """A line of the PLY with round ends over what is drawn, where nothing lies in front of it."""
    width, height = WIDTH * SAMPLES, HEIGHT * SAMPLES
    (x0, y0, z0), (x1, y1, z1) = map(camera.project, ends)
    length = (x1 - x0) ** 2 + (y1 - y0) ** 2
    if not math.isfinite(length):
        return
    for y in range(max(0, math.ceil(min(y0, y1) - LINE)), min(height - 1, math.floor(max(y0, y1) + LINE)) + 1):
        for x in range(max(0, math.ceil(min(x0, x1) - LINE)), min(width - 1, math.floor(max(x0, x1) + LINE)) + 1):
            t = min(1.0, max(0.0, ((x - x0) * (x1 - x0) + (y - y0) * (y1 - y0)) / length)) if length > 0 else 0.0
            beside = math.hypot(x - x0 - t * (x1 - x0), y - y0 - t * (y1 - y0))
            if beside <= LINE and (z0 + t * (z1 - z0)) * ABOVE >= nearest[y * width + x]:
                image[y * width + x] = list(map(float, colour))


def draw(faces, edges, camera):
    """Samples row by row, each None or a colour; the nearest surface wins."""
    width, height = WIDTH * SAMPLES, HEIGHT * SAMPLES
    nearest = [0.0] * (width * height)
    owner = [None] * (width * height)
    for triangle in triangles_of(faces):
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = map(camera.project, triangle[0])
        area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0)
        if area == 0 or not math.isfinite(area):
            continue
        if area > 0:   # seen from behind, because rows count downwards; faces have two sides
            corners, (n0, n1, n2), colour, (s0, s1, s2) = triangle
            triangle = corners, [tuple(-c for c in n) for n in (n0, n2, n1)], colour, (s0, s2, s1)
            (x1, y1, z1), (x2, y2, z2), area = (x2, y2, z2), (x1, y1, z1), -area
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
    image = [sample and shade_sample(*sample, camera) for sample in owner]
    for ends, colour in edges:
        draw_line(ends, colour, camera, nearest, image)
    return image


def shade_sample(triangle, heights, a, b, camera):
    _, (n0, n1, n2), colour, sides = triangle
    c = 1 - a - b
    near = min([w * h for w, h, side in zip((a, b, c), heights, sides) if side], default=9)
    normal = unit((a * n0[0] + b * n1[0] + c * n2[0], a * n0[1] + b * n1[1] + c * n2[1],
                   a * n0[2] + b * n1[2] + c * n2[2]))
    return shade(normal, colour, EDGE * max(0.0, 1.6 - near), camera)


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
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", metavar="MESHES.ply")
    parser.add_argument("picture", metavar="PICTURE.png")
    parser.add_argument("--check", action="store_true",
                        help="compare: exit code 1 if the picture is not of these meshes")
    parser.add_argument("--view", metavar=("X", "Y", "Z"), type=float, nargs=3, default=VIEW,
                        help="direction from the meshes to the camera (default: %s %s %s)" % VIEW)
    parser.add_argument("--demo", action="store_true", help="the camera of the documents' picture of cchip demo")
    options = parser.parse_args()
    if not 0 < math.hypot(*options.view) < math.inf:
        parser.error("--view: the direction has no length; write one like 1 -1.6 1.1")
    try:
        faces, edges = read_ply(options.meshes)
    except OSError as error:
        parser.error(f"{options.meshes}: cannot be read ({error.strerror}); check its name and permissions")
    except (NotOurs, struct.error, IndexError, ValueError):
        parser.error(f"{options.meshes}: not written by cchip; make it with the option --ply of cchip collide, "
                     "meshpairs or demo")
    camera = DEMO
    if not options.demo:
        camera = Camera(options.view)
        faces, edges = normalised(faces, edges)
        camera.fit([corner for corners, _ in faces for corner in corners])
    rows = to_pixels(draw(faces, edges, camera))
    if not options.check:
        try:
            write_png(options.picture, rows)
        except OSError as error:
            parser.error(f"{options.picture}: cannot be written ({error.strerror}); check the folder")
        return
    try:
        old = read_png(options.picture)
    except (OSError, zlib.error, struct.error) as error:
        sys.exit(f"picture.py: {options.picture}: cannot be read ({error}); draw it with scripts/run picture")
    pairs = [pair for new_row, old_row in zip(rows, old) for pair in zip(new_row, old_row)]
    different = sum(abs(a - b) > TOLERANCE for a, b in pairs)
    print(f"{different} of {len(pairs)} bytes differ")
    if not pairs or different > MOST_DIFFERENT * len(pairs):
        sys.exit(f"picture.py: {options.picture} is not of these meshes; draw it with scripts/run picture")


if __name__ == "__main__":
    main()
