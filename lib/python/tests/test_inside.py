# SPDX-License-Identifier: Apache-2.0
"""inside() beside arithmetic, and beside rays in floating point; distances() beside those of a torus."""
import numpy as np
import pytest

from collisionchip import Object, distances, inside
from shapes import SEED, cube, poses, torus


def test_cube():
    block = Object(*cube())
    points = np.array([[0, 0, 0], [0.5, 0, 0], [np.nextafter(0.5, 0), 0.5 - 2**-30, 0], [np.nextafter(0.5, 1), 0, 0]])
    found = inside(block, None, points)
    assert found.tolist() == [1, 0, 1, -1] and found.dtype == np.int8
    pose = np.eye(4)
    pose[0, 3] = 0.5
    assert inside(block, pose, points).tolist() == [0, 1, 1, 1]
    assert inside(block, None, np.empty((0, 3))).shape == (0,)
    vertices, faces = cube()
    with pytest.raises(ValueError, match="surface of the object is open"):
        inside(Object(vertices, faces[1:]), None, points)
    with pytest.raises(ValueError, match="points"):
        inside(block, None, [1, 2])


def crossings(vertices, faces, points):
    """How often a ray from each point along z crosses the triangles."""
    a, b, c = (vertices[faces[:, i]][None] for i in range(3))
    p = points[:, None]
    flat = lambda u, v: u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    turns = np.stack([flat(b - a, p - a), flat(c - b, p - b), flat(a - c, p - c)])
    normal = np.cross(b - a, c - a)
    height = np.sum(normal * (a - p), axis=2) / normal[..., 2]
    return np.sum((np.all(turns > 0, axis=0) | np.all(turns < 0, axis=0)) & (height > 0), axis=1)


def test_torus():
    random = np.random.default_rng(SEED)
    (vertices, faces), pose = torus(), poses(random, 1, 0.5)[0]
    points = random.uniform(-2, 2, (3000, 3))
    found = inside(Object(vertices, faces), pose, points, threads=2)
    placed = vertices @ pose[:3, :3].T + pose[:3, 3]
    assert (found > 0).sum() > 30 and not (found == 0).any()
    assert np.array_equal(crossings(placed, faces, points) % 2 == 1, found > 0)


def test_distances():
    block = Object(*cube())
    found, nearest, faces = distances(block, None, [[2, 0, 0], [0.25, 0.125, 0], [0.5, 0, 0]], signed=True)
    assert found.tolist() == [1.5, -0.25, 0]
    assert nearest.tolist() == [[0.5, 0, 0], [0.5, 0.125, 0], [0.5, 0, 0]]
    assert faces.dtype == np.uint32 and faces.shape == (3,)
    assert distances(block, None, [[0.25, 0.125, 0]])[0].tolist() == [0.25]
    assert [x.shape for x in distances(block, None, np.empty((0, 3)))] == [(0,), (0, 3), (0,)]
    vertices, triangles = cube()
    opened = Object(vertices, triangles[1:])
    assert distances(opened, None, [[2, 0, 0]])[0].tolist() == [1.5]
    with pytest.raises(ValueError, match="open"):
        distances(opened, None, [[2, 0, 0]], signed=True)
    with pytest.raises(ValueError, match="point 1"):
        distances(block, None, [[2, 0, 0], [np.inf, 0, 0]])


def test_distances_of_a_torus():
    random = np.random.default_rng(SEED)
    vertices, triangles = torus()
    points = random.uniform(-2, 2, (2000, 3))
    found, nearest, _ = distances(Object(vertices, triangles), None, points, signed=True, threads=0)
    assert np.allclose(np.linalg.norm(points - nearest, axis=1), abs(found), atol=1e-12)
    assert (np.sign(found) == -inside(Object(vertices, triangles), None, points)).all()
    to_vertices = np.linalg.norm(points[:, None] - np.asarray(vertices)[None], axis=2).min(axis=1)
    assert (abs(found) <= to_vertices + 1e-12).all() and (abs(found) >= to_vertices - 0.3).all()
