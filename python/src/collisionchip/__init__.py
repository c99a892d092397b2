# SPDX-License-Identifier: Apache-2.0
"""Exact collision detection for triangle and quad meshes.

Object holds a mesh, collide() answers whether two placed objects touch, collide_many() does so for many poses, Scene for
many objects. CollisionManager has the methods of trimesh.collision.CollisionManager. Objects are surfaces, not volumes.
"""
from ._core import Certificate, Device, Object, Result, Scene, collide, collide_many, cpu_targets, device_names, open_device
from ._core import version as __version__
from .manager import CollisionManager, ContactData, scene_to_collision

__all__ = ["Certificate", "CollisionManager", "ContactData", "Device", "Object", "Result", "Scene", "__version__", "collide",
           "collide_many", "cpu_targets", "device_names", "open_device", "scene_to_collision"]
