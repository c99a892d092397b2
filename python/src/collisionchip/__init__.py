# SPDX-License-Identifier: Apache-2.0
"""Exact collision detection for triangle and quad meshes.

Object holds a mesh, collide() answers whether two placed objects touch, distance() how far they are apart, solids() whether one is inside the other,
collide_many() asks collide() for many poses, Scene for many objects. CollisionManager has the methods of trimesh.collision.CollisionManager. Objects are surfaces, not volumes.
"""
from ._core import (Certificate, Device, Distance, Object, Result, Scene, collide, collide_many, cpu_targets, device_names, distance,
                    open_device, solids)
from ._core import version as __version__
from .manager import CollisionManager, ContactData, DistanceData, scene_to_collision

__all__ = ["Certificate", "CollisionManager", "ContactData", "Device", "Distance", "DistanceData", "Object", "Result", "Scene",
           "__version__", "collide", "collide_many", "cpu_targets", "device_names", "distance", "open_device", "scene_to_collision",
           "solids"]
