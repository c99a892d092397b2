# SPDX-License-Identifier: Apache-2.0
"""Exact collision detection for triangle and quad meshes.

Object holds a mesh, collide() answers whether two placed objects touch, distance() how far they are apart, solids()
whether one is inside the other, clear_along() and first_contact() how far one must move along a direction until it is
clear of the other or touches it, collide_many() asks collide() for many poses, Scene for many objects, Assembly whether
parts are as rules want them. PointCloud holds points with a radius each, which collide() takes, too. CollisionManager
has the methods of trimesh.collision.CollisionManager. make_pose() makes poses of angles and quaternions. Objects are
surfaces, not volumes.
"""
from ._core import (Along, Assembly, AssemblyPair, AssemblyReport, Certificate, CloudResult, Device, Distance, Object,
                    PointCloud, Result, Scene, clear_along, collide, collide_many,
                    cpu_targets, device_names, distance, distances, first_contact, first_met, inside,
                    load_points, open_device, solids)
from ._core import version as __version__
from .manager import CollisionManager, ContactData, DistanceData, scene_to_collision
from .poses import make_pose

__all__ = ["Along", "Assembly", "AssemblyPair", "AssemblyReport", "Certificate", "CloudResult", "CollisionManager",
           "ContactData", "Device", "Distance", "DistanceData", "Object", "PointCloud", "Result", "Scene",
           "__version__", "clear_along", "collide", "collide_many", "cpu_targets", "device_names", "distance",
           "distances", "first_contact", "first_met", "inside",
           "load_points", "make_pose", "open_device", "scene_to_collision", "solids"]
