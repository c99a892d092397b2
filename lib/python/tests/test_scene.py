# SPDX-License-Identifier: Apache-2.0
"""Scenes."""
import gc
import threading
import warnings
import weakref

import numpy as np
import pytest

from collisionchip import Object, Scene, collide, open_device
from shapes import SEED, cube, joined, poses, shift, torus

CUBE = Object(*cube())
TORUS = Object(*torus())


def row_of_cubes(count):
    scene = Scene()
    return scene, [scene.add(CUBE, shift(i)) for i in range(count)]


def test_a_scene_answers_as_all_pairs_in_order():
    placed = [(CUBE, TORUS)[i % 2] for i in range(40)]
    where = poses(np.random.default_rng(SEED), 40, 4)
    scene = Scene()
    ids = [scene.add(made, pose) for made, pose in zip(placed, where)]
    assert ids == list(range(1, 41)) == scene.ids() and len(scene) == 40
    expected = [(ids[i], ids[j]) for i in range(40) for j in range(i + 1, 40)
                if collide(placed[i], where[i], placed[j], where[j])]
    assert len(expected) > 10
    for device in (None, open_device("cpu", threads=3), open_device("model")):
        assert [(a, b) for a, b, _ in scene.contacts(device=device)] == expected
    assert set(expected) <= {tuple(row) for row in scene.candidates().tolist()}
    assert scene.find_contact()[:2] in expected
    for a, b, result in scene.contacts(contacts="all"):
        single = collide(placed[a - 1], where[a - 1], placed[b - 1], where[b - 1], contacts="all")
        assert result.contacts.tolist() == single.contacts.tolist()
    one = [b if a == 7 else a for a, b in expected if 7 in (a, b)]
    assert [other for other, _ in scene.contacts(7)] == one
    scene.remove(7)
    assert [other for other, _ in scene.contacts(placed[6], where[6])] == one
    assert 7 not in scene and 8 in scene and scene.add(CUBE) == 41


def test_poses_and_objects():
    scene, ids = row_of_cubes(3)
    assert [(a, b) for a, b, _ in scene.contacts()] == [(1, 2), (2, 3)]
    scene.set_pose(ids[1], shift(10))
    assert scene.pose(ids[1]).tolist() == shift(10).tolist()
    assert scene.find_contact() is None and scene.find_contact(1) is None
    scene.set_pose(ids[1], None)
    assert collide(scene.object(1), None, TORUS, shift(1))
    assert scene.contacts(relation=True)[0][2].relation == "touching"  # the same cube twice: no faces that cross


def test_ignored_groups_filter():
    scene, _ = row_of_cubes(4)
    scene.set_ignored(1, 2)
    assert [(a, b) for a, b, _ in scene.contacts()] == [(2, 3), (3, 4)]
    scene.set_ignored(1, 2, False)
    scene.set_groups(3, 2, 2)
    assert scene.groups(3) == (2, 2) and scene.groups(1) == (1, 2**64 - 1)
    assert [(a, b) for a, b, _ in scene.contacts()] == [(1, 2)]
    assert [other for other, _ in scene.contacts(CUBE, shift(2), groups=2)] == [2, 3, 4]
    asked = []
    scene.set_filter(lambda a, b: asked.append((a, b)))  # None is false
    assert scene.contacts() == [] and asked == [(1, 2)]
    scene.set_filter(None)
    assert len(scene.contacts()) == 1


def test_errors():
    scene, _ = row_of_cubes(3)
    for call in (scene.remove, scene.pose, scene.contacts, scene.object, lambda i: scene.set_pose(i, None),
                 lambda i: scene.set_ignored(i, 1), scene.set_groups):
        with pytest.raises(ValueError, match="9"):
            call(9)
    with pytest.raises(ValueError, match="0 0 0 1"):
        scene.add(CUBE, np.ones((4, 4)))
    with pytest.raises(ValueError):
        scene.contacts(contacts="some")
    with pytest.raises(TypeError):
        scene.set_filter(1)
    assert len(scene) == 3


def test_exceptions_of_the_filter_and_changes_in_it():
    scene, _ = row_of_cubes(3)

    def refuse(a, b):
        raise KeyError(a, b)

    scene.set_filter(refuse)
    with pytest.raises(KeyError):
        scene.contacts()
    scene.set_filter(lambda a, b: scene.remove(a))
    with pytest.raises(RuntimeError, match="in use"):
        scene.contacts()
    scene.set_filter(lambda a, b: scene.set_filter(None))
    with pytest.raises(RuntimeError, match="in use"):
        scene.find_contact()
    scene.set_filter(None)
    assert len(scene.contacts()) == 2


def test_a_change_during_a_query_of_another_thread():
    scene, _ = row_of_cubes(3)
    inside, go_on = threading.Event(), threading.Event()

    def wait(a, b):
        inside.set()
        return go_on.wait(10)

    scene.set_filter(wait)
    found = []
    thread = threading.Thread(target=lambda: found.extend(scene.contacts()))
    thread.start()
    assert inside.wait(10)
    with pytest.raises(RuntimeError, match="in use"):
        scene.set_pose(1, shift(5))
    assert len(scene) == 3  # reading is allowed
    go_on.set()
    thread.join()
    assert len(found) == 2
    scene.set_pose(1, shift(5))


def test_a_filter_that_refers_to_its_scene_is_collected():
    class Filter:
        def __call__(self, a, b):
            return a in self.scene

    scene, _ = row_of_cubes(2)
    function = Filter()
    function.scene = scene
    scene.set_filter(function)
    assert len(scene.contacts()) == 1
    alive = weakref.ref(function)
    del scene, function
    gc.collect()
    assert alive() is None


def test_solids():
    scene = Scene()
    big, inside, flush, across, copy = (scene.add(Object(*cube(side)), shift(x))
                                        for side, x in ((4, 0), (1, 0), (1, 1.5), (1, 2), (4, 0)))
    found = dict(((a, b), word) for a, b, word in scene.solids())
    assert found[big, inside] == "b_in_a" and found[big, flush] == "b_in_a" and found[big, across] == "overlapping"
    assert found[big, copy] == "equal" and found[inside, copy] == "a_in_b" and (inside, across) not in found
    scene.set_ignored(big, copy)
    scene.set_filter(lambda a, b: across not in (a, b))
    assert {(a, b) for a, b, _ in scene.solids(device=open_device("cpu", threads=1))} == {
        (big, inside), (big, flush), (inside, copy),
        (flush, copy)} | ({(inside, flush)} if (inside, flush) in found else set())
    scene.add(Object([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    with pytest.raises(ValueError, match="closed|open"):
        scene.solids()


def test_solids_of_shells_that_overlap():
    corners, faces = cube()
    two = Object(*joined((corners, faces), (corners + (0.5, 0.125, 0.0625), faces)))
    scene = Scene()
    part, one, other = scene.add(two), scene.add(Object(*cube(0.25)),
                                                 shift(0.25)), scene.add(Object(*cube(0.25)), shift(-0.25))
    with pytest.warns(UserWarning) as said:
        assert scene.solids() == [(part, other, "b_in_a")]
    assert len(said) == 1 and f"of object {part} cross" in str(said[0].message)  # not once for each pair
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert scene.solids(inside="nonzero") == [(part, one, "b_in_a"), (part, other, "b_in_a")]
    with pytest.raises(ValueError, match="inside is 'even'"):
        scene.solids(inside="even")
