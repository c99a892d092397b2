# SPDX-License-Identifier: Apache-2.0
"""make_pose(): quarter turns are exact, whoever gave the numbers."""
import itertools
import math

import numpy as np
import pytest

from collisionchip import Object, collide, make_pose
from shapes import SEED, cube

QUARTERS = list(itertools.product((-270, -90, 0, 90, 180, 450), repeat=3))


def turns(x, y, z):
    """By repeated quarter turns of integers."""
    def turn(count, i, j):
        matrix = np.eye(3)
        for _ in range(count // 90 % 4):
            step = np.eye(3)
            step[i, i] = step[j, j] = 0
            step[j, i], step[i, j] = 1, -1
            matrix = step @ matrix
        return matrix
    return turn(z, 0, 1) @ turn(y, 2, 0) @ turn(x, 1, 2)


def test_quarter_turns_are_exact():
    for degrees in QUARTERS:
        expected = turns(*degrees)
        for pose in (make_pose((1, 2, 3), degrees), make_pose((1, 2, 3), rpy=np.radians(degrees)),
                     make_pose((1, 2, 3), rpy=[d / 90 * math.pi / 2 for d in degrees]),
                     make_pose((1, 2, 3), rotation=make_pose(degrees=degrees)[:3, :3] + 1e-16)):
            assert pose[:3, :3].tolist() == expected.tolist() and pose[:3, 3].tolist() == [1, 2, 3] and pose[
                3].tolist() == [0, 0, 0, 1]


def test_quaternions():
    half = math.sqrt(0.5)
    below = np.nextafter(half, 0)
    for z in (half, below):
        for w in (half, below, -half):
            pose = make_pose(xyzw=(0, 0, z, w))
            assert pose.tolist() == make_pose(degrees=(0, 0, 90 if w > 0 else -90)).tolist()
            assert make_pose(wxyz=(w, 0, 0, z)).tolist() == pose.tolist()
    assert make_pose(wxyz=(5, 5, 5, 5))[:3, :3].tolist() == [[0, 0, 1], [1, 0, 0], [0, 1, 0]]
    assert make_pose(wxyz=(1e-200, 0, 0, 1e-200)).tolist() == make_pose(
        wxyz=(1e200, 0, 0, 1e200)).tolist() == make_pose(degrees=(0, 0, 90)).tolist()
    random = np.random.default_rng(SEED)
    for q in random.normal(size=(100, 4)):
        r = make_pose(wxyz=q)[:3, :3]
        assert np.allclose(r @ r.T, np.eye(3), atol=1e-14) and np.linalg.det(r) > 0
        assert np.allclose(r @ q[1:], q[1:], atol=1e-13)  # the axis stays
        angle = 2 * math.atan2(np.linalg.norm(q[1:]), q[0])
        assert math.isclose(np.trace(r), 1 + 2 * math.cos(angle), abs_tol=1e-13)
    about_z = make_pose(wxyz=(math.cos(0.3), 0, 0, math.sin(0.3)))
    assert about_z[2].tolist() == [0, 0, 1, 0]  # so that flush stays flush


def test_scipy():
    Rotation = pytest.importorskip("scipy.spatial.transform").Rotation
    for degrees in QUARTERS:
        rotation = Rotation.from_euler("xyz", degrees, degrees=True)
        expected = turns(*degrees).tolist()
        for pose in (make_pose(rotation=rotation), make_pose(xyzw=rotation.as_quat()),
                     make_pose(rotation=rotation.as_matrix())):
            assert pose[:3, :3].tolist() == expected
    for angles in np.random.default_rng(SEED).uniform(-180, 180, size=(100, 3)):
        rotation = Rotation.from_euler("xyz", angles, degrees=True)
        for pose in (make_pose(degrees=angles), make_pose(rpy=np.radians(angles)), make_pose(rotation=rotation)):
            assert np.allclose(pose[:3, :3], rotation.as_matrix(), atol=1e-14)


def test_flush_stays_flush():
    part = Object(*cube())
    for degrees in QUARTERS:
        assert collide(part, None, part, make_pose((1, 0, 0), degrees), relation=True).relation == "touching"
        assert not collide(part, None, part, make_pose((1 + 2**-52, 0, 0), degrees))


def test_small_angles_are_kept():
    for pose in (make_pose(degrees=(0, 0, 1e-10)), make_pose(rpy=(0, 0, 1e-12)), make_pose(wxyz=(1, 0, 0, 1e-13))):
        assert pose[1, 0] > 0
    assert make_pose(rpy=(0, 0, 1.5708))[0, 0] != 0


def test_errors():
    for arguments in ({"degrees": (0, 0)}, {"rpy": 3}, {"xyzw": (0, 0, 0, 0)}, {"wxyz": (1, 0, 0)},
                      {"xyzw": (0, 0, 0, np.nan)},
                      {"rotation": np.eye(4)}, {"translation": (1, 2)}, {"translation": (1, 2, np.inf)},
                      {"rotation": np.full((3, 3), np.nan)}):
        with pytest.raises(ValueError, match=f"{next(iter(arguments))} .*(give|; )"):
            make_pose(**arguments)
    with pytest.raises(TypeError, match="degrees and wxyz"):
        make_pose(degrees=(0, 0, 0), wxyz=(1, 0, 0, 0))
