# SPDX-License-Identifier: Apache-2.0
"""Poses by angles and quaternions, with quarter turns that have no rounding error."""
from __future__ import annotations

import math
from typing import Any

import numpy as np

from ._core import _rotation

_NEAR = 2.0**-48  # 3.6e-15: what rounding leaves of a quarter turn


def _numbers(values: Any, count: int, name: str) -> Any:
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise ValueError(f"{name} is {values!r}; give {count} finite numbers")
    return array


def _snapped(matrix: Any) -> Any:
    """Exactly the quarter turns that a matrix is within rounding of, or else the matrix."""
    near = np.rint(matrix)
    if (np.abs(matrix - near) <= _NEAR).all() and (np.abs(near).sum(axis=0) == 1).all() and (
        np.abs(near).sum(axis=1) == 1).all():
        return near + 0.0
    return matrix


def _of_quaternion(x: float, y: float, z: float, w: float, name: str) -> Any:
    greatest = max(map(abs, (x, y, z, w)))
    if greatest == 0:
        raise ValueError(f"{name} is 0; give a quaternion that is not, of any length")
    x, y, z, w = (math.ldexp(v, -math.frexp(greatest)[1]) for v in (x, y, z, w))  # no square over- or underflows
    length = x * x + y * y + z * z + w * w
    # divided by the length's square at the end: equal components give exact zeros and ones
    return np.array([[w * w + x * x - (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), w * w + y * y - (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), w * w + z * z - (x * x + y * y)]]) / length


def _degrees(radian: float) -> float:
    quarters = round(radian / (math.pi / 2))
    if abs(radian - quarters * (math.pi / 2)) <= _NEAR * abs(radian):
        return 90.0 * quarters
    return math.degrees(radian)


def _of_rotation(rotation: Any) -> Any:
    if hasattr(rotation, "as_quat"):  # scipy's
        return _of_quaternion(*_numbers(rotation.as_quat(), 4, "rotation.as_quat()"), "rotation")
    matrix = np.array(rotation, dtype=np.float64)
    if matrix.shape != (3, 3) or not np.isfinite(matrix).all():
        raise ValueError(f"rotation has the shape {matrix.shape}; give (3, 3) finite numbers or scipy's Rotation")
    return matrix


def make_pose(translation: Any = (0, 0, 0), degrees: Any = None, *, rpy: Any = None, xyzw: Any = None, wxyz: Any = None,
              rotation: Any = None) -> Any:
    """A pose, (4, 4) float64: a rotation, then a translation. Quarter turns are exact: their matrix has only 0, 1 and
    -1.

    translation: (3,), in the unit of the meshes. At most one of:
    degrees: (3,), angles about the fixed axes x, then y, then z.
    rpy: (3,), the same in radians, as in URDF: roll, pitch, yaw.
    xyzw, wxyz: (4,), a quaternion of any length, its real part last (ROS, scipy) or first (Eigen's constructor,
    trimesh, MuJoCo). rotation: scipy's Rotation, or a matrix (3, 3), which is taken as it is.

    All but degrees are rounded themselves: a rotation whose matrix is within 3.6e-15 of one of quarter turns becomes
    exactly that. Angles with few digits, such as 1.5708, are what they say.

    Raises ValueError: another shape, numbers that are not finite, a quaternion of 0. Raises TypeError: two rotations.
    """
    given = [name for name, value in (("degrees", degrees), ("rpy", rpy), ("xyzw", xyzw), ("wxyz", wxyz),
                                      ("rotation", rotation))
             if value is not None]
    if len(given) > 1:
        raise TypeError(f"{' and '.join(given)} are given; give one rotation")
    pose = np.eye(4)
    if degrees is not None:
        pose[:3, :3] = _rotation(*_numbers(degrees, 3, "degrees"))
    elif rpy is not None:
        pose[:3, :3] = _snapped(_rotation(*map(_degrees, _numbers(rpy, 3, "rpy").tolist())))
    elif xyzw is not None:
        pose[:3, :3] = _snapped(_of_quaternion(*_numbers(xyzw, 4, "xyzw").tolist(), "xyzw"))
    elif wxyz is not None:
        w, x, y, z = _numbers(wxyz, 4, "wxyz").tolist()
        pose[:3, :3] = _snapped(_of_quaternion(x, y, z, w, "wxyz"))
    elif rotation is not None:
        pose[:3, :3] = _snapped(_of_rotation(rotation))
    pose[:3, 3] = _numbers(translation, 3, "translation")
    return pose
