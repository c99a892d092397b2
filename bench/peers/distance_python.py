#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Answers and times of Python's libraries to the queries that distance_speed writes. For each library a line with its
name, its version and the error of a distance that it allows; then for each query a line

    distance, nearest points of A and of B, 1 or 0 for "at most half the distance?", "at most twice the distance?" and
    "do they meet?", microseconds of these four calls

with numbers as float.hex() writes them. Only the call is timed, the shorter of two. Runs in build/touching, which
`scripts/run peers` makes.

usage: distance_python.py QUERIES"""
import importlib.metadata
import math
import sys
import time

import numpy as np


def timed(call):
    """The answer, and microseconds."""
    least = math.inf
    for _ in range(2):
        start = time.perf_counter()
        answer = call()
        least = min(least, time.perf_counter() - start)
    return answer, 1e6 * least


class Trueform:
    """Doubles; searches that use all cores. Its pages state no error: a millionth of the size."""
    package = "trueform"

    def __init__(self, meshes):
        import trueform
        self.module = trueform
        self.meshes = [trueform.Mesh(faces, vertices) for vertices, faces in meshes]

    def place(self, poses):
        for mesh, pose in zip(self.meshes, poses):
            mesh.transformation = pose

    def distance(self):
        return self.module.distance(*self.meshes)

    def points(self):
        return [np.asarray(point) for point in self.module.neighbor_search(*self.meshes)[1][1:]]

    def within(self, d):
        return self.module.neighbor_search(*self.meshes, radius=d) is not None

    def meets(self):
        return bool(self.module.intersects(*self.meshes))


class MeshLib:
    """Single precision: vertices and poses are rounded to 24 bits. Everything is in the frame of A."""
    package = "meshlib"

    def __init__(self, meshes):
        from meshlib import mrmeshnumpy, mrmeshpy
        self.module = mrmeshpy
        self.meshes = [mrmeshnumpy.meshFromFacesVerts(faces, vertices) for vertices, faces in meshes]
        self.parts = [mrmeshpy.MeshPart(mesh) for mesh in self.meshes]

    def place(self, poses):
        self.pose = poses[0]
        relative = np.linalg.inv(poses[0]) @ poses[1]
        rows = [self.module.Vector3f(*(float(x) for x in row[:3])) for row in relative[:3]]
        self.b_to_a = self.module.AffineXf3f(self.module.Matrix3f(*rows),
                                             self.module.Vector3f(*(float(x) for x in relative[:3, 3])))

    def distance(self):
        self.found = self.module.findDistance(*self.parts, self.b_to_a)
        return math.sqrt(self.found.distSq)

    def points(self):
        a, b = self.found.a.point, self.b_to_a(self.found.b.point)
        return [(self.pose @ [p.x, p.y, p.z, 1])[:3] for p in (a, b)]

    def within(self, d):
        return self.module.findDistance(*self.parts, self.b_to_a, max(d * d, 1e-37)).a.face.valid()  # 0 finds nothing

    def meets(self):
        return self.module.findCollidingTriangles(*self.parts, self.b_to_a, True).size() > 0


def numbers(line):
    return np.array([float.fromhex(word) for word in line.split()])


def main():
    with open(sys.argv[1], encoding="ascii") as file:
        meshes = []
        for _ in "ab":
            vertices = numbers(file.readline()).reshape(-1, 3)
            meshes.append((vertices, np.array(file.readline().split(), dtype=np.int32).reshape(-1, 3)))
        queries = [numbers(line) for line in file]
    for library in (Trueform, MeshLib):
        try:
            version = importlib.metadata.version(library.package)
        except importlib.metadata.PackageNotFoundError:
            continue
        print(library.__name__, version, (1e-6).hex())
        asked = library(meshes)
        for number, query in enumerate(queries):
            asked.place([np.vstack([query[i:i + 12].reshape(3, 4), [0, 0, 0, 1]]) for i in (0, 12)])
            if number == 0:
                asked.distance(), asked.meets()  # trees are built at the first call
            distance, distance_time = timed(asked.distance)
            points = np.concatenate(asked.points())
            half, half_time = timed(lambda: asked.within(query[24]))
            twice, twice_time = timed(lambda: asked.within(query[25]))
            meets, meets_time = timed(asked.meets)
            print(float(distance).hex(), *(float(x).hex() for x in points), int(half), int(twice), int(meets),
                  *(x.hex() for x in (distance_time, half_time, twice_time, meets_time)))


if __name__ == "__main__":
    main()
