#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks a certificate (docs/cpp/certificates.md) with exact arithmetic and nothing of the library.

    python check.py A B POSES CERTIFICATE [TREE_A TREE_B]

A, B: OFF or OBJ files of triangles and quads. POSES: for each certificate of the file 24 numbers, the matrix [R | t] of
A row by row, then that of B. TREE_A, TREE_B: the trees that certificates of version 3 cite.
Exit code 0: accepted, and the claim is printed; 1: refused, with the first cell that fails; 2: a file cannot be
read."""
import json
import math
import re
import struct
import sys
from fractions import Fraction

getattr(sys, "set_int_max_str_digits", int)(20001)
dot = lambda d, p: sum(x * y for x, y in zip(d, p))
RANK = {"apart": 0, "touching": 1, "crossing": 2}
MEASURES = {"within", "below", "along"}


class Refused(Exception): ...


def require(holds, otherwise):
    if not holds:
        raise Refused(otherwise)


def finite(text):
    require(math.isfinite(float(text)), "not a number that a double can hold")
    return text


def check_depth(value, depth=0):
    require(depth <= 4, "too deep")
    if isinstance(value, str):
        value.encode()  # raises for half a surrogate pair
    elif isinstance(value, (list, dict)):
        for x in [*value, *value.values()] if isinstance(value, dict) else value:
            check_depth(x, depth + 1)


def parse(line):
    """A line of JSON, without what Python takes beyond it; -0 is no integer."""
    whole = lambda text: -0.0 if text == "-0" else int(finite(text))
    value = json.loads(line, parse_constant=finite, parse_float=lambda text: float(finite(text)), parse_int=whole)
    check_depth(value)
    return value


def split(text):
    """The lines of each certificate of a file. Only a line feed ends a line, unlike in str.splitlines()."""
    lines, certificates = text.split("\n"), []
    for line in lines[:-1] if lines[-1] == "" else lines:
        if not certificates or begins(line):
            certificates.append([])
        certificates[-1].append(line)
    return certificates


def begins(line):
    if "\\" not in line and "collisionchip_certificate" not in line:
        return False
    try:
        value = json.loads(line)
    except (ValueError, RecursionError):
        return False  # check() refuses it
    return isinstance(value, dict) and "collisionchip_certificate" in value


def hash_words(data, value=0xcbf29ce484222325):
    for (word,) in struct.iter_unpack("<Q", data):
        value = (value ^ word) * 0x100000001b3 & 0xffffffffffffffff
        value ^= value >> 32
    return format(value, "016x")


def hash_mesh(vertices, faces, numbers):
    pack = lambda v: struct.pack("<3d", *(x + 0.0 for x in vertices[v]))
    return hash_words(b"".join(struct.pack("<II", n, len(f)) + b"".join(map(pack, f)) for f, n in zip(faces, numbers)))


class Posed(dict):
    """The vertices of a mesh in its pose, by numbers, made when they are asked for."""

    def __init__(self, vertices, pose):
        self.vertices, self.rows = vertices, [[Fraction(x) for x in pose[4 * r:4 * r + 4]] for r in range(3)]

    def at(self, p):
        return [sum((r[i] * Fraction(p[i]) for i in range(3)), r[3]) for r in self.rows]

    def __missing__(self, number):
        self[number] = self.at(self.vertices[number])
        return self[number]


def hash_tree(mesh, order):
    return hash_words(struct.pack(f"<{len(order) + 1}Q", int(mesh, 16), *order))


def read_tree(text):
    """The order of a tree and the hash of its mesh."""
    require(text.count("\n") == text.endswith("\n"), "a tree is one line")
    tree = parse(text)
    require(type(tree["collisionchip_tree"]) is int and tree["collisionchip_tree"] == 1, "no tree of this version")
    return tree["mesh"], expanded(tree["order"])


def hull(order, mesh, posed, halvings=3):
    """Points whose hull holds the faces: of each part of the set after so many halvings the vertices, if it has at most
    four faces, or else the corners of its box in the mesh."""
    if len(order) > 4 and halvings > 0:
        return [p for half in (order[:len(order) // 2], order[len(order) // 2:])
                for p in hull(half, mesh, posed, halvings - 1)]
    used = {v for f in order for v in mesh[1][f]}
    if len(order) <= 4:
        return [posed[v] for v in used]
    low, high = ([end(axis) for axis in zip(*(mesh[0][v] for v in used))] for end in (min, max))
    return [posed.at([(low, high)[n >> i & 1][i] for i in range(3)]) for n in range(8)]


def integers(texts, count):
    require(isinstance(texts, list) and len(texts) == count, "wrong number of weights or components")
    require(all(isinstance(t, str) and len(t) <= 20000 and re.fullmatch("0|-?[1-9][0-9]*", t) for t in texts),
            "not an integer of at most 20000 digits")
    return [int(t) for t in texts]


def expanded(order):
    """Numbers, and runs [first, last] of numbers that ascend by one."""
    require(isinstance(order, list), "not a list")
    result = []
    for first, last in (x if isinstance(x, list) else (x, x) for x in order):
        require(type(first) is type(last) is int and first <= last and last - first + len(result) < 2**24,
                "not an order of faces")
        result += range(first, last + 1)
    return result


def overlap(direction, points):
    """The greatest value of A minus the least of B."""
    d = integers(direction, 3)
    require(any(d), "the direction is 0")
    return max(dot(d, p) for p in points[0]) - min(dot(d, p) for p in points[1])


def reach(c):
    """The distance up to which faces are contacts, 0 if they must share a point; and whether it is none itself."""
    require(not ("within" in c and "below" in c), "two distances")
    if "within" not in c and "below" not in c:
        return Fraction(0), False
    value = c["below"] if "below" in c else c["within"]
    require(type(value) in (int, float) and value > 0, "no distance")
    require(c["least"] == "touching", "an unknown claim")
    return Fraction(float(value)), "below" in c


def translation(c):
    """That of `along`, or nothing."""
    if "along" not in c:
        return None
    require(c["all"] and not c["contacts"] and c["relation"] is None and c["least"] == "touching" and not reach(c)[0],
            "no claim of a translation")
    require(isinstance(c["along"], list) and len(c["along"]) == 3 and
            all(type(x) in (int, float) for x in c["along"]) and any(c["along"]), "no translation")
    return [Fraction(float(x)) for x in c["along"]]


def separates(direction, points, within, below, along):
    """Does the direction keep the points of A below those of B, as the claim wants it?"""
    gap = -overlap(direction, points)
    if along:
        rise = dot(integers(direction, 3), along)
        return rise >= 0 if gap > 0 else gap == 0 and rise > 0
    least = within * within * dot(integers(direction, 3), integers(direction, 3))
    return gap > 0 and (gap * gap > least or (below and gap * gap == least))


def check_point(cell, corners, within, below):
    kind, place = cell["cell"], []
    for points, texts in zip(corners, (cell["a"], cell["b"])):
        weights = integers(texts, len(points))
        require(min(weights) >= (kind == "cross") and sum(weights) > 0, "a weight is too small")
        place.append([Fraction(1, sum(weights)) * dot(weights, axis) for axis in zip(*points)])
    difference = [x - y for x, y in zip(*place)]
    if kind == "near":
        square = dot(difference, difference)
        require(square < within * within or (not below and square == within * within), "the points are too far apart")
        return
    require(not any(difference), "the points differ")
    if kind == "touch":
        require(overlap(cell["direction"], corners) <= 0, "A is not below B")
    if kind == "cross":
        edges = {s + str(k): [p - q for p, q in zip(f[k], f[0])] for s, f in zip("ab", corners)
                 for k in range(1, len(f))}
        require(isinstance(cell["span"], list), "a span is three edges")
        x, y, z = (edges[name] for name in cell["span"])
        normal = [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]
        require(dot(normal, z) != 0, "the edges do not span space")


def check_claim(c, found):
    """found: of two faces of the files, the set of kinds of the cells that name points of them."""
    strongest, all_told, contacts = 0, c["all"] and not MEASURES & c.keys(), []
    for faces, kinds in sorted(found.items()):
        told = "near" not in kinds and ("cross" in kinds or (c["all"] and "meet" not in kinds))
        rank = 2 if "cross" in kinds else 1
        strongest, all_told = max(strongest, rank), all_told and told
        require(told or c["least"] != "crossing", "not told whether two faces cross")
        contacts += [(list(faces), rank if told else None)] if rank >= RANK[c["least"]] else []
    require([x[:2] for x in c["contacts"]] == [x[0] for x in contacts], "other contacts than claimed")
    for (_, _, claimed), (_, rank) in zip(c["contacts"], contacts):
        require(claimed is None or RANK[claimed] == rank, "two faces are not so related")
    proved = strongest if all_told or strongest == 2 else None
    require(c["relation"] is None or RANK[c["relation"]] == proved, "another relation than claimed")


def check(meshes, poses, lines, trees=None):
    """meshes: of A and B (vertices, faces, number in the file of each face). trees: of A and B, as read_tree() returns
    them. Returns the claim or raises Refused."""
    number = "claim"
    try:
        c, cells = parse(lines[0]), lines[1:]
        version, claimed = c["collisionchip_certificate"], c["contacts"]
        cites = type(version) is int and version == 3
        require(c["all"] is True if cites else type(version) is int and version == (2 if MEASURES & c.keys() else 1),
                "no certificate of this version")
        require(isinstance(claimed, list) and all(type(f) is int for x in claimed for f in x[:2]),
                "no list of contacts")
        require(type(c["all"]) is bool and c["least"] in ("touching", "crossing"), "an unknown claim")
        within, below = reach(c)
        along = translation(c)
        hashes = [hash_mesh(*m) for m in meshes] + [hash_words(struct.pack("<24d", *(x + 0.0 for x in poses)))]
        require([c["mesh_a"], c["mesh_b"], c["poses"]] == hashes, "the certificate is of other meshes or poses")
        points = [Posed(m[0], p) for m, p in zip(meshes, (poses[:12], poses[12:]))]
        if cites:
            require(trees and not {"order_a", "order_b"} & c.keys(), "it cites trees, and none are given")
            require([t[0] for t in trees] == hashes[:2], "a tree of another mesh")
            require([c["tree_a"], c["tree_b"]] == [hash_tree(*t) for t in trees], "it cites other trees")
        found, orders = {}, [t[1] for t in trees] if cites else (expanded(c["order_a"]), expanded(c["order_b"]))
        once = [sorted(o) == [*range(c["all"] * len(m[1]))] for o, m in zip(orders, meshes)]
        require(all(once), "an order does not hold each face once")
        require(all(orders) if c["all"] else len(cells) == 1, "no faces, or other than one cell for one contact")
        todo = [[(0, len(order)) for order in orders]]
        corners = lambda side, face: [points[side][v] for v in meshes[side][1][face]]
        for line in cells:
            cell = parse(line)
            require(todo and "collisionchip_certificate" not in cell, "a cell too many")
            sets, kind = todo.pop(), cell["cell"]
            if kind in ("split_a", "split_b"):
                side = kind == "split_b"
                begin, end = sets[side]
                at = begin + (end - begin) // 2 if cites else cell["at"]
                require(type(at) is int and begin < at < end, "a split leaves one half empty")
                todo += [[sets[0], half] if side else [half, sets[1]] for half in ((at, end), (begin, at))]
            elif kind == "separated":
                if cites:
                    sides = [hull(orders[s][slice(*sets[s])], meshes[s], points[s]) for s in (0, 1)]
                else:
                    sides = [[p for f in orders[s][slice(*sets[s])] for p in corners(s, f)] for s in (0, 1)]
                require(separates(cell["direction"], sides, within, below, along), "A is not far enough below B")
            else:
                kinds = ("near",) if within else () if along else ("meet", "touch", "cross")
                require(kind in kinds, "unknown kind of cell")
                require(len(cell["faces"]) == 2, "a point needs two faces")
                require(all(type(f) is int and 0 <= f < len(m[1]) for f, m in zip(cell["faces"], meshes)),
                        "no such face")
                require(not c["all"] or all([f] == o[slice(*x)] for f, o, x in zip(cell["faces"], orders, sets)),
                        "other faces")
                check_point(cell, [corners(s, cell["faces"][s]) for s in (0, 1)], within, below)
                found.setdefault(tuple(m[2][f] for f, m in zip(cell["faces"], meshes)), set()).add(kind)
        number = "claim"
        require(not c["all"] or not todo, "cells are missing")
        check_claim(c, found)
        return c
    except (Refused, ValueError, KeyError, TypeError, IndexError, RecursionError, OverflowError, struct.error) as error:
        raise Refused(f"cell {number}: {error}") from None


def read_mesh(text):
    lines = [words for words in (line.split("#")[0].split() for line in text.splitlines()) if words]
    if lines[0] == ["OFF"]:
        n, m = int(lines[1][0]), int(lines[1][1])
        vertices, faces = lines[2:2 + n], [[int(x) for x in line[1:1 + int(line[0])]]
                                           for line in lines[2 + n:2 + n + m]]
    else:
        vertices = [line[1:] for line in lines if line[0] == "v"]
        faces = [[int(x.split("/")[0]) - 1 for x in line[1:]] for line in lines if line[0] == "f"]
    if not all(len(f) in (3, 4) and min(f) >= 0 and max(f) < len(vertices) for f in faces):
        raise ValueError("faces must be triangles and quads of vertices that the file has")
    return [[float(x) for x in v[:3]] for v in vertices], faces, list(range(len(faces)))


def main(arguments):
    try:
        require(len(arguments) in (4, 6), "usage:" + __doc__)
        texts = []
        for n, path in enumerate(arguments):
            with open(path, encoding="utf-8", newline="\n" if n >= 3 else None) as file:
                texts.append(file.read())
        meshes, poses = [read_mesh(text) for text in texts[:2]], [float(x) for x in texts[2].split()]
        certificates = split(texts[3])
        if not certificates or len(poses) != 24 * len(certificates):
            raise ValueError(f"{len(poses)} numbers in POSES, but {len(certificates)} certificates; give 24 for each")
        try:
            trees = [read_tree(text) for text in texts[4:]]
        except (KeyError, TypeError, RecursionError, OverflowError) as error:
            raise ValueError(f"no tree: {error}") from None
        claims = [check(meshes, poses[24 * n:24 * n + 24], lines, trees) for n, lines in enumerate(certificates)]
    except Refused as error:
        sys.exit(print(f"refused, {error}") or 1)
    except (OSError, ValueError, IndexError) as error:
        sys.exit(print(f"check.py: {error}", file=sys.stderr) or 2)
    for c in claims:
        print("accepted:", f"{len(c['contacts'])} contacts" if c["all"] else "a contact",
              "and no others" if c["all"] else "", *(f"{k} {c[k]}" for k in ("within", "below", "along") if k in c))


if __name__ == "__main__":
    main(sys.argv[1:])
