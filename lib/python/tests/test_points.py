# SPDX-License-Identifier: Apache-2.0
"""Point clouds: the expected answers are distances worked out by hand."""
import gzip
import math
import struct

import numpy as np
import pytest

from collisionchip import CloudResult, Object, PointCloud, collide, first_met, load_points
from shapes import cube, shift

# from -0.5 to 0.5, six quads: x, y, z below and above
CUBE = Object([(x, y, z) for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)],
              [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])


def met(cloud, *arguments, **options):
    return collide(cloud, None, CUBE, *arguments, contacts="all", **options).contacts.tolist()


def test_a_sphere_that_touches_meets():
    points = [[0.75, 0, 0], [0, 0.5, 0], [0, 0, 0], [9, 9, 9]]
    assert met(PointCloud(points), None) == [[1, 3]]
    assert met(PointCloud(points, 0.25), None) == [[0, 1], [1, 3]]
    assert met(PointCloud(points, math.nextafter(0.25, 0)), None) == [[1, 3]]
    assert met(PointCloud(points, 0.5), None) == [[0, 1], *([1, face] for face in (0, 1, 3, 4, 5)),
                                                  *([2, face] for face in range(6))]


def test_a_radius_for_each_point():
    points = np.array([[0.75, 0, 0], [1, 0, 0], [1.5, 0, 0]])
    assert met(PointCloud(points, [0.125, 0.5, 0.5]), None) == [[1, 1]]
    assert met(PointCloud(points, np.array([1, 1, 1])), None)[-1] == [2, 1]
    assert met(PointCloud(points[::-1], np.float32(0.5)), None)[0] == [1, 1]


def test_poses_move_points_and_leave_the_radius():
    cloud = PointCloud([[0.5, 0, 0]], 0.25)
    twice = np.diag([2.0, 2, 2, 1])
    assert not collide(cloud, twice, CUBE, shift(-0.5))  # the point at 1, the face at 0
    assert collide(cloud, twice, CUBE, shift(0.25))      # the face at 0.75
    assert not collide(cloud, twice, CUBE, shift(math.nextafter(0.25, 0)))


def test_result():
    found = collide(PointCloud([[0.5, 0, 0]]), None, CUBE, None)
    assert isinstance(found, CloudResult) and found and found.hit
    assert found.contacts.dtype == np.uint32 and found.contacts.tolist() == [[0, 1]] and found.stats["pairs"] >= 1
    assert repr(found) == "<collisionchip.CloudResult: hit, 1 contacts>"
    none = collide(PointCloud([[7, 0, 0]]), None, CUBE, None, contacts="all")
    assert not none and none.contacts.shape == (0, 2)
    assert len(collide(PointCloud([[0, 0, 0]], 1), None, CUBE, None, contacts="all", max_contacts=4).contacts) == 4
    cloud = PointCloud([[0, 0, 0]] * 3, 1)
    assert len(cloud) == 3 and repr(cloud) == "<collisionchip.PointCloud: 3 points>"


@pytest.mark.parametrize("empty", [[], np.zeros((0, 3))])
def test_a_cloud_without_points_meets_nothing(empty):
    assert len(PointCloud(empty)) == 0 and not collide(PointCloud(empty, 1), None, CUBE, None)


def test_first_met():
    cloud = PointCloud([[0, 0, 0]], 0.5)
    assert first_met(cloud, None, [(CUBE, shift(5)), (CUBE, None), (CUBE, shift(0.5))]) == 1
    assert first_met(cloud, shift(-5), [(CUBE, shift(5)), (CUBE, None)]) is None
    assert first_met(cloud, None, []) is None
    with pytest.raises(ValueError, match=r"objects\[1\] is no tuple of an Object and its pose"):
        first_met(cloud, None, [(CUBE, None), CUBE])
    with pytest.raises(ValueError, match=r"objects\[0\] has the shape \(3, 3\)"):
        first_met(cloud, None, [(CUBE, np.eye(3))])


@pytest.mark.parametrize("points, radius, message", [
    (np.zeros((4, 2)), 0, r"points have the shape \(4, 2\); give \(n, 3\)"),
    (np.zeros(3), 0, r"points have the shape \(3,\)"),
    ([[0, 0, math.nan]], 0, "point 0"),
    ([[0, 0, 0]], -1, "radius"),
    ([[0, 0, 0]], math.inf, "radius"),
    ([[0, 0, 0]], [1, 1], "radii"),
    ([[0, 0, 0]], [[1]], r"radius has the shape \(1, 1\)"),
    ([[0, 0, 1j]], 0, "complex"),
    (np.ma.masked_array(np.zeros((1, 3))), 0, "masked"),
])
def test_what_is_refused(points, radius, message):
    with pytest.raises(ValueError, match=message):
        PointCloud(points, radius)


def test_words_and_poses_as_for_two_objects():
    cloud = PointCloud([[0, 0, 0]])
    with pytest.raises(ValueError, match="many"):
        collide(cloud, None, CUBE, None, contacts="many")
    with pytest.raises(ValueError, match="max_contacts"):
        collide(cloud, None, CUBE, None, contacts="all", max_contacts=0)
    with pytest.raises(ValueError, match=r"pose_object has the shape \(3, 3\)"):
        collide(cloud, None, CUBE, np.eye(3))
    with pytest.raises(TypeError):
        collide(CUBE, None, cloud, None)


def test_files(tmp_path):
    points = [[0.75, 0, 0], [0, 0.1, -2e-9]]
    xyz = tmp_path / "scan.xyz"
    xyz.write_text("# a scan\n0.75 0 0\nnan nan nan\n0 0.1 -2e-9 255 0 0\n")
    assert load_points(xyz).tolist() == points
    with pytest.raises(ValueError, match=r"scan\.xyz:3: "):
        load_points(xyz, leave_out_nan=False)
    packed = tmp_path / "scan.xyz.gz"
    packed.write_bytes(gzip.compress(xyz.read_bytes()))
    assert load_points(str(packed)).tolist() == points
    ply = tmp_path / "scan.ply"
    ply.write_bytes(b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
                    b"property double z\nend_header\n"
                    + struct.pack("<6d", *points[0], *points[1]))
    assert load_points(bytes(ply)).tolist() == points
    pcd = tmp_path / "scan.pcd"
    pcd.write_text("VERSION .7\nFIELDS x y z\nSIZE 8 8 8\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 "
                   "1 0 0 0\nPOINTS 2\nDATA ascii\n"
                   "0.75 0 0\n0 0.1 -2e-9\n")
    found = load_points(pcd)
    assert found.tolist() == points and found.dtype == np.float64
    assert met(PointCloud(found, 0.25), None) == [[0, 1]]
    with pytest.raises(FileNotFoundError):
        load_points(tmp_path / "none.xyz")
    with pytest.raises(IsADirectoryError):
        load_points(tmp_path)
    (tmp_path / "text.xyz").write_text("no points\n")
    with pytest.raises(ValueError, match=r"text\.xyz:1: "):
        load_points(tmp_path / "text.xyz")


def test_against_distances_in_numpy():
    """Points on a grid of 1/8 around the cube from -1/2 to 1/2: the distance from its surface is a matter of squares,
    which are exact."""
    side = np.arange(-8, 9) / 8
    points = np.array([(x, y, z) for x in side for y in side for z in side])
    outside = np.maximum(np.abs(points) - 0.5, 0)
    inside = np.maximum(0.5 - np.abs(points).max(axis=1), 0)
    squared = (outside**2).sum(axis=1) + inside**2
    vertices, faces = cube()
    for radius in (0, 0.125, 0.25):
        found = collide(PointCloud(points, radius), None, Object(vertices, faces), None, contacts="all").contacts
        assert np.unique(found[:, 0]).tolist() == np.flatnonzero(squared <= radius**2).tolist()


def test_numbers_of_points_are_those_of_the_file(tmp_path):
    path = tmp_path / "scan.xyz"
    rows = [(0.5, 0, 0), (np.nan, 0, 0), (9, 9, 9), (0, np.inf, 0), (0, 0.5, 0), (np.nan,) * 3, (-0.5, 0, 0)]
    path.write_text("".join(" ".join(map(repr, map(float, row))) + "\n" for row in rows))
    points, numbers = load_points(path, numbers=True)
    assert numbers.dtype == np.uint32 and numbers.tolist() == [0, 2, 4,
                                                               6] and points.tolist() == [list(rows[i])
                                                                                          for i in numbers]
    assert load_points(path).tolist() == points.tolist()
    for cloud in (PointCloud.load(path), PointCloud(points, 0, numbers), PointCloud(points, [0] * 4, numbers.tolist())):
        assert len(cloud) == 4
        assert np.unique(collide(cloud, None, CUBE, None, contacts="all").contacts[:, 0]).tolist() == [0, 4, 6]
        assert collide(cloud, None, CUBE, shift(8.5, 9, 9)).contacts[0, 0] == 2
    assert np.unique(collide(PointCloud(points), None, CUBE, None, contacts="all").contacts[:, 0]).tolist() == [0, 2, 3]
    turned = collide(PointCloud(points, 0, numbers[::-1]), None, CUBE, None, contacts="all").contacts.tolist()
    assert turned == sorted(turned) and {row[0] for row in turned} == {0, 2, 6}
    assert len(collide(PointCloud.load(path, 100), None, CUBE, None, contacts="all").contacts) == 4 * 6
    for wrong in ([0, 1, 2], [0, 1, 2, -1], [0, 1, 2, 0.5], [0, 1, 2, 2**32], [[0, 1, 2, 3]]):
        with pytest.raises(ValueError, match="numbers"):
            PointCloud(points, 0, wrong)
    with pytest.raises(ValueError, match="radius"):
        PointCloud.load(path, -1)


def test_first_met_takes_any_iterable():
    cloud = PointCloud([(0.5, 0, 0)])
    pairs = [(CUBE, shift(5)), (CUBE, None)]
    for objects in (pairs, tuple(pairs), iter(pairs), (pair for pair in pairs), dict(enumerate(pairs)).values(),
                    [list(pair) for pair in pairs]):
        assert first_met(cloud, None, objects) == 1
    for wrong in (None, 3, CUBE):
        with pytest.raises(TypeError, match="objects cannot be iterated over"):
            first_met(cloud, None, wrong)
    with pytest.raises(ValueError, match=r"objects\[0\] is no tuple"):
        first_met(cloud, None, (CUBE, None))
