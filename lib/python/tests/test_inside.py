# SPDX-License-Identifier: Apache-2.0
"""inside() beside arithmetic and trimesh."""
import numpy as np
import pytest
import trimesh

from collisionchip import Object, inside
from shapes import SEED, cube, poses, torus


def test_cube():
    points = np.array([[0, 0, 0], [0.5, 0, 0], [np.nextafter(0.5, 0), 0.5 - 2**-30, 0], [np.nextafter(0.5, 1), 0, 0]])
    assert inside(Object(*cube()), None, points).tolist() == [1, 0, 1, -1] and inside(Object(*cube()), None, points).dtype == np.int8
    pose = np.eye(4)
    pose[0, 3] = 0.5
    assert inside(Object(*cube()), pose, points).tolist() == [0, 1, 1, 1]
    assert inside(Object(*cube()), None, np.empty((0, 3))).shape == (0,)
    vertices, faces = cube()
    with pytest.raises(ValueError, match="surface of the object is open"):
        inside(Object(vertices, faces[1:]), None, points)
    with pytest.raises(ValueError, match="points"):
        inside(Object(*cube()), None, [1, 2])


def test_beside_trimesh():
    random = np.random.default_rng(SEED)
    mesh, pose = torus(), poses(random, 1, 0.5)[0]
    points = random.uniform(-2, 2, (3000, 3))
    found = inside(Object(*mesh), pose, points, threads=2)
    peer = trimesh.Trimesh(*mesh, process=False)
    peer.apply_transform(pose)
    differ = np.flatnonzero(peer.contains(points) != (found > 0))
    assert (found > 0).sum() > 30
    assert len(differ) == 0
