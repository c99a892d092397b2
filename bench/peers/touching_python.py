#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Answers of Python's libraries to the cases of docs/cpp/touching_stays.md: a line of their names, then "yes" or "no"
of each for every line that touching_table --far-cases printed to standard input. Runs in build/touching, which
`scripts/run peers` makes."""
import sys

import numpy as np
import trimesh
import trueform


def read_mesh(words):
    count = int(next(words))
    vertices = np.array([float.fromhex(next(words)) for _ in range(3 * count)]).reshape(count, 3)
    count = int(next(words))
    return vertices, np.array([int(next(words)) for _ in range(3 * count)], dtype=np.int32).reshape(count, 3)


def by_trimesh(meshes, pose):
    manager = trimesh.collision.CollisionManager()
    for name, (vertices, faces) in zip("ab", meshes):
        manager.add_object(name, trimesh.Trimesh(vertices, faces, process=False), transform=pose)
    return manager.in_collision_internal()


def by_trueform(meshes, pose):
    a, b = (trueform.Mesh(faces, vertices, transformation=pose) for vertices, faces in meshes)
    return trueform.intersects(a, b)


def main():
    print("trimesh\ttrueform")
    for line in sys.stdin:
        words = iter(line.split()[1:])  # the first says whether they meet
        pose = np.eye(4)
        pose[:3] = np.array([float.fromhex(next(words)) for _ in range(12)]).reshape(3, 4)
        meshes = [read_mesh(words), read_mesh(words)]
        print("\t".join("yes" if answer(meshes, pose) else "no" for answer in (by_trimesh, by_trueform)))


if __name__ == "__main__":
    main()
