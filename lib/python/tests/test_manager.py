# SPDX-License-Identifier: Apache-2.0
"""CollisionManager: names, arguments and return values of trimesh's."""
import copy
import inspect
import pickle
import subprocess
import sys
import time

import numpy as np
import pytest

import collisionchip
from collisionchip import CollisionManager, Object, distance
from shapes import SEED, cube, poses, shift, torus


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
        _ = contact.depth


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


def test_least_distances_against_all_pairs():
    random = np.random.default_rng(SEED)
    parts = [Object(*torus(1, 0.3, 12, 8)), Object(*cube(0.5)), Object(*cube(3))]
    for reach in (1, 4, 20):
        managers, placed = [CollisionManager(), CollisionManager()], [{}, {}]
        for which, count in ((0, 14), (1, 5)):
            for i, pose in enumerate(poses(random, count, reach)):
                managers[which].add_object(f"{which}.{i:02}", parts[i % 3], pose)
                placed[which][f"{which}.{i:02}"] = (parts[i % 3], pose)
        managers[0].remove_object("0.03")
        del placed[0]["0.03"]
        managers[0].set_pair_ignored("0.00", "0.01")
        names = sorted(placed[0])
        inside = {(a, b): distance(*placed[0][a], *placed[0][b]).upper for i, a in enumerate(names)
                  for b in names[i + 1:] if (a, b) != ("0.00", "0.01")}
        found, pair, data = managers[0].min_distance_internal(return_names=True, return_data=True)
        assert found == min(inside.values()) == inside[pair] and data.names == set(pair)
        for name in names:
            of_one = {pair: far for pair, far in inside.items() if name in pair}
            found, pair = managers[0].min_distance_internal(name=name, return_names=True)
            assert found == min(of_one.values()) == of_one[pair]
        across = {(a, b): distance(*placed[0][a], *placed[1][b]).upper for a in placed[0] for b in placed[1]}
        found, pair, data = managers[0].min_distance_other(managers[1], return_names=True, return_data=True)
        assert found == min(across.values()) == across[pair]
        for name, part in zip(pair, (placed[0][pair[0]], placed[1][pair[1]])):
            assert distance(Object([data.point(name)] * 3, [(0, 1, 2)]), None, *part).upper < 1e-12
        mesh, pose = parts[0], poses(random, 1, reach)[0]
        single = {a: distance(mesh, pose, *place).upper for a, place in placed[0].items()}
        found, name = managers[0].min_distance_single(mesh, pose, return_name=True)
        assert found == min(single.values()) == single[name]
        assert managers[0].min_distance_other(managers[0]) == 0 and managers[0].in_collision_other(managers[0])


def test_least_distance_of_many_asks_about_few():
    """A thousand parts in a grid: all pairs are half a million."""
    part, manager = Object(*torus(1, 0.3, 12, 8)), CollisionManager()
    for i, pose in enumerate(poses(np.random.default_rng(SEED), 1000, 0)):
        pose[:3, 3] = 4 * (i % 10), 4 * (i // 10 % 10), 4 * (i // 100)
        manager.add_object(i, part, pose)
    start = time.process_time()
    for _ in range(1, 1000):
        distance(part, None, part, shift(60), stop_above=1)
    one = (time.process_time() - start) / 999
    start = time.process_time()
    assert 1 < manager.min_distance_internal() < 2
    assert time.process_time() - start < 499500 * one  # what asking about each pair takes, even if each is far


def test_names_of_many_take_little_memory():
    code = """
import resource, sys
from collisionchip import CollisionManager, Object
part = Object([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
managers = CollisionManager(), CollisionManager()
for manager in managers:
    for i in range(700):
        manager.add_object(i, part)
before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
assert len(managers[0].in_collision_internal(return_names=True)[1]) == 700 * 699 // 2
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / (700 * 699 // 2))
assert len(managers[0].in_collision_other(managers[1], return_names=True)[1]) == 700 * 700
print((resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) * 1024 / (700 * 700))
assert len(managers[0].in_collision_single(part, return_names=True)[1]) == 700
"""
    done = subprocess.run([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, check=True)
    assert all(float(bytes_a_pair) < 400 for bytes_a_pair in done.stdout.split()), done.stdout


def test_pickle_and_copies():
    manager = row(4)
    manager.set_pair_ignored("a", "b")
    manager.remove_object("c")
    for made in (pickle.loads(pickle.dumps(manager)), copy.deepcopy(manager), copy.copy(manager)):
        assert made.in_collision_internal(return_names=True) == (False, set())
        made.set_pair_ignored("a", "b", False)
        assert made.in_collision_internal(return_names=True) == (True, {("a", "b")})
        made.set_transform("d", shift(0.5))
        made.remove_object("a")
        assert made.in_collision_internal(return_names=True) == (True, {("b", "d")})
        assert manager.in_collision_internal(return_names=True) == (False, set())  # as it was
    own = CollisionManager(collisionchip.open_device("cpu", threads=1))
    own.add_object("a", Mesh)
    assert copy.deepcopy(own).in_collision_single(Mesh)
    with pytest.raises(TypeError, match="device"):
        pickle.dumps(own)
