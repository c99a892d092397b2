# SPDX-License-Identifier: Apache-2.0
"""CollisionManager: names, arguments and return values of trimesh's."""
import inspect

import numpy as np
import pytest

import collisionchip
from collisionchip import CollisionManager, Object
from shapes import cube, shift, torus


class Mesh:
    """Not trimesh: vertices and faces are enough."""
    vertices, faces = cube()


def row(count, first="a"):
    manager = CollisionManager()
    for i in range(count):
        manager.add_object(chr(ord(first) + i), Mesh, shift(i))
    return manager


def test_internal():
    manager = row(3)
    assert manager.in_collision_internal() is True
    hit, names = manager.in_collision_internal(return_names=True)
    assert hit is True and names == {("a", "b"), ("b", "c")}
    hit, data = manager.in_collision_internal(return_data=True)
    assert hit is True and {frozenset(x.names) for x in data} == {frozenset("ab"), frozenset("bc")}
    hit, names, data = manager.in_collision_internal(return_names=True, return_data=True)
    assert all(type(x.index("b")) is int and 0 <= x.index("b") < 12 for x in data)
    manager.set_transform("b", shift(10))
    assert manager.in_collision_internal(True, True) == (False, set(), [])


def test_single_and_other():
    manager = row(3)
    assert manager.in_collision_single(Mesh, shift(3)) is True
    assert manager.in_collision_single(Mesh, shift(3), return_names=True) == (True, {"c"})
    hit, data = manager.in_collision_single(Object(*torus()), return_data=True)
    assert hit and data[0].names <= {"__external", "a", "b"} and data[0].index("__external") >= 0
    assert manager.in_collision_single(Mesh, shift(9), True, True) == (False, set(), [])
    other = row(2, "x")
    other.set_transform("y", shift(3))
    assert manager.in_collision_other(other) is True
    hit, names, data = manager.in_collision_other(other, return_names=True, return_data=True)
    assert names == {("a", "x"), ("b", "x"), ("c", "y")} and len(data) >= 3
    assert manager.in_collision_other(CollisionManager()) is False


def test_replace_and_remove():
    manager = row(2)
    assert isinstance(manager.add_object("b", Mesh, shift(5)), Object)
    assert not manager.in_collision_internal()
    manager.remove_object("a")
    for call in (manager.remove_object, lambda name: manager.set_transform(name, None)):
        with pytest.raises(ValueError, match="a not in collision manager!"):
            call("a")
    with pytest.raises(ValueError):
        manager.add_object("b", Mesh, np.eye(2))
    assert manager.in_collision_single(Mesh, shift(5))  # b is still there


def test_distances():
    manager = row(2)  # unit cubes that touch
    assert manager.min_distance_internal() == 0
    manager.set_transform("b", shift(2.5))
    manager.add_object("c", Mesh, shift(10))
    assert manager.min_distance_internal() == 1.5
    distance, names, data = manager.min_distance_internal(return_names=True, return_data=True)
    assert (distance, names, data.names, data.distance) == (1.5, ("a", "b"), {"a", "b"}, 1.5)
    assert data.point("a")[0] == 0.5 and data.point("b")[0] == 2
    assert np.array_equal(data.point("a")[1:], data.point("b")[1:]) and 0 <= data.index("b") < 12
    assert manager.min_distance_internal(name="c", return_names=True) == (6.5, ("b", "c"))
    manager.set_pair_ignored("a", "b")
    assert manager.min_distance_internal() == 6.5
    with pytest.raises(ValueError, match="d not in collision manager!"):
        manager.min_distance_internal(name="d")

    distance, name, data = manager.min_distance_single(Mesh, shift(5), return_name=True, return_data=True)
    assert (distance, name, data.names) == (1.5, "b", {"__external", "b"}) and data.point("__external")[0] == 4.5
    assert manager.min_distance_single(Mesh, shift(2)) == 0
    other = row(2, "x")
    other.set_transform("x", shift(4.25))
    other.set_transform("y", shift(20))
    assert manager.min_distance_other(other, return_names=True) == (0.75, ("b", "x"))
    assert CollisionManager().min_distance_single(Mesh, return_name=True, return_data=True) == (np.inf, None, None)


def test_what_is_not_offered():
    manager = row(1)
    contact = manager.in_collision_single(Mesh, return_data=True)[1][0]
    with pytest.raises(NotImplementedError):
        contact.depth


def test_contact_data_has_a_common_point_and_a_normal():
    # unit cubes: the second one begins at x = 0.5, where the first one ends
    manager = CollisionManager()
    manager.add_object("first", Mesh)
    manager.add_object("second", Mesh, shift(1, 0.5))
    contacts = manager.in_collision_internal(return_data=True)[1]
    assert contacts
    for contact in contacts:
        x, y, z = contact.point
        assert x == 0.5 and 0 <= y <= 0.5 and -0.5 <= z <= 0.5
        assert contact.point.shape == contact.normal.shape == (3,)
        assert np.abs(contact.normal).sum() == np.abs(contact.normal).max() == 1  # along an axis
    flush = [c for c in contacts if abs(c.normal[0]) == 1]
    assert flush and all(c.normal[0] == 1 for c in flush)  # outwards from the one that was added first


def test_the_methods_are_those_of_trimesh():
    theirs = pytest.importorskip("trimesh").collision.CollisionManager
    for name, method in inspect.getmembers(theirs, inspect.isfunction):
        if not name.startswith("_"):
            ours = inspect.signature(getattr(collisionchip.CollisionManager, name)).parameters.values()
            assert [(p.name, p.default) for p in ours] == [
                (p.name, p.default) for p in inspect.signature(method).parameters.values()], name


def test_names_that_cannot_be_ordered():
    manager = CollisionManager()
    manager.add_object(1, Mesh)
    manager.add_object("b", Mesh, shift(0.25))
    manager.add_object(None, Mesh, shift(9))
    assert manager.in_collision_internal(return_names=True) == (True, {(1, "b")})
    assert manager.in_collision_internal(return_data=True)[1][0].names == {1, "b"}
    assert manager.in_collision_single(Mesh, shift(9), return_names=True) == (True, {None})


def test_ignored_pairs():
    manager = row(3)
    manager.set_pair_ignored("b", "a")
    assert manager.in_collision_internal(return_names=True)[1] == {("b", "c")}
    manager.add_object("a", Mesh, shift(0))  # replaced: still ignored
    assert manager.in_collision_internal(return_names=True)[1] == {("b", "c")}
    manager.set_pair_ignored("a", "b", False)
    assert manager.in_collision_internal(return_names=True)[1] == {("a", "b"), ("b", "c")}
    manager.set_pair_ignored("b", "c")
    manager.remove_object("c")
    manager.add_object("c", Mesh, shift(2))  # another one of this name
    assert manager.in_collision_internal(return_names=True)[1] == {("a", "b"), ("b", "c")}
    with pytest.raises(ValueError, match="x not in collision manager!"):
        manager.set_pair_ignored("a", "x")
    with pytest.raises(ValueError):
        manager.set_pair_ignored("a", "a")


def test_a_scene_of_trimesh():
    trimesh = pytest.importorskip("trimesh")
    box = trimesh.creation.box()
    scene = trimesh.Scene()
    for i in range(3):
        scene.add_geometry(box, node_name=f"box {i}", geom_name="box", transform=shift(i))
    scene.add_geometry(trimesh.creation.icosphere(radius=0.25), node_name="ball", geom_name="ball", transform=shift(9))
    manager, objects = collisionchip.scene_to_collision(scene)
    assert set(objects) == set(scene.graph.nodes_geometry)
    touching = {("box 0", "box 1"), ("box 1", "box 2")}
    assert manager.in_collision_internal(return_names=True) == (True, touching)
