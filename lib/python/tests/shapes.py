# SPDX-License-Identifier: Apache-2.0
"""Meshes and poses for the tests and the benchmark."""
import os

import numpy as np

SEED = int(os.environ.get("CCHIP_SEED") or 1)


def cube(side=1.0):
    """Twelve triangles around the origin."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * (side / 2)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))])


def joined(*meshes):
    """One mesh of several, whose surfaces are its shells; each is (vertices, faces)."""
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in meshes])
    return np.concatenate([vertices for vertices, _ in meshes]), np.concatenate(
        [faces + start for (_, faces), start in zip(meshes, starts)])


def torus(major=1.0, minor=0.3, around=24, across=12):
    """2 x around x across triangles around the z axis."""
    u = np.repeat(np.arange(around), across) * (2 * np.pi / around)
    v = np.tile(np.arange(across), around) * (2 * np.pi / across)
    radius = major + minor * np.cos(v)
    vertices = np.stack([radius * np.cos(u), radius * np.sin(u), minor * np.sin(v)], axis=1)
    i, j = np.divmod(np.arange(around * across), across)
    a, b = i * across + j, (i + 1) % around * across + j
    c, d = (i + 1) % around * across + (j + 1) % across, i * across + (j + 1) % across
    return vertices, np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])


def poses(random, count, reach):
    """Random rotations, and translations of up to `reach` in each coordinate; all numbers fit single precision."""
    q = random.normal(size=(count, 4))
    w, x, y, z = (q / np.linalg.norm(q, axis=1, keepdims=True)).T
    result = np.zeros((count, 4, 4))
    result[:, :3, :3] = np.stack([1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
                                  2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                                  2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
                                 axis=1).reshape(count, 3, 3)
    result[:, :3, 3] = random.uniform(-reach, reach, size=(count, 3))
    result[:, 3, 3] = 1
    return result.astype(np.float32).astype(np.float64)


def shift(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose
