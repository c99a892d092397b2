# SPDX-License-Identifier: Apache-2.0
"""Scenes, clouds and answers through pickle, copy and deepcopy."""
import copy
import pickle

import numpy as np
import pytest

import collisionchip
from collisionchip import Object, PointCloud, Scene, collide
from shapes import cube, shift, torus

CUBE, TORUS = Object(*cube()), Object(*torus())


def ways(x):
    return [*(pickle.loads(pickle.dumps(x, protocol)) for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1)),
            copy.deepcopy(x), copy.copy(x)]


def test_results():
    for options in ({}, {"contacts": "all", "relation": True}, {"relation": True, "certificate": True},
                    {"within": 3.0, "contacts": "all"}):
        for pose in (shift(0.5), shift(2.5)):
            result = collide(CUBE, None, TORUS, pose, **options)
            for made in ways(result):
                assert made.hit == result.hit and made.relation == result.relation and made.stats == result.stats
                assert np.array_equal(made.contacts, result.contacts) and repr(made) == repr(result)
                assert (made.crossing is None) == (result.crossing is None) and (
                    made.crossing is None or made.crossing.tolist() == result.crossing.tolist())
                assert np.array_equal(made.normals(), result.normals()) and len(made.curves()) == len(result.curves())
                assert (made.certificate is None) == (result.certificate is None)
                assert made.certificate is None or made.certificate.lines == result.certificate.lines
                assert bool(collide(CUBE, None, TORUS, pose, hint=made)) == collide(CUBE, None, TORUS, pose).hit
    proof = collide(CUBE, None, CUBE, shift(0.5), certificate=True).certificate
    assert pickle.loads(pickle.dumps(proof)).check() == proof.check()


def test_other_answers():
    far = collisionchip.distance(CUBE, None, TORUS, shift(4))
    beyond = collisionchip.distance(CUBE, None, TORUS, shift(4), stop_above=0.5)
    for x in (far, beyond):
        for made in ways(x):
            assert (made.lower, made.upper) == (x.lower,
                                                x.upper) and np.array_equal(made.points, x.points, equal_nan=True)
            assert np.array_equal(made.faces, x.faces)
    for along in (collisionchip.first_contact(CUBE, None, TORUS, shift(4), (-1, 0, 0)),
                  collisionchip.clear_along(CUBE, None, TORUS, None, (1, 0, 0))):
        for made in ways(along):
            assert (made.touches, made.factor, made.lower, made.upper) == (along.touches, along.factor, along.lower,
                                                                           along.upper)
            assert np.array_equal(made.faces, along.faces)


def test_clouds():
    points = np.random.default_rng(1).uniform(-1, 1, size=(100, 3))
    for cloud in (PointCloud(points, 0.1), PointCloud(points, np.linspace(0, 0.5, 100)),
                  PointCloud(points, 0.25, np.arange(100) * 7), PointCloud([], 1)):
        result = collide(cloud, None, CUBE, None, contacts="all")
        for made in ways(cloud):
            again = collide(made, None, CUBE, None, contacts="all")
            assert len(made) == len(cloud) and again.contacts.tolist() == result.contacts.tolist()
        for made in ways(result):
            assert (made.hit == result.hit and made.contacts.tolist() == result.contacts.tolist()
                    and made.stats == result.stats)


def lower_only(a, b):
    return a < 3


def test_scenes():
    scene = Scene()
    ids = [scene.add(CUBE if i % 2 else TORUS, shift(i * 0.5), groups=1 << i % 3) for i in range(8)]
    scene.set_ignored(ids[1], ids[0])
    scene.set_ignored(ids[3], ids[4])
    for gone in (ids[2], ids[4], ids[7]):
        scene.remove(gone)
    scene.set_filter(lower_only)
    expected = [(a, b) for a, b, _ in scene.contacts()]
    assert expected
    for made in ways(scene):
        assert made.ids() == scene.ids() and [(a, b) for a, b, _ in made.contacts()] == expected
        for id in made.ids():
            assert np.array_equal(made.pose(id), scene.pose(id)) and made.groups(id) == scene.groups(id)
            assert made.object(id).vertices.tolist() == scene.object(id).vertices.tolist()
        made.set_filter(None)
        assert (ids[0], ids[1]) not in [(a, b) for a, b, _ in made.contacts()] and len(made.contacts()) > len(expected)
        assert made.add(CUBE) == ids[7] + 1  # no id is given twice
        assert len(scene) == 5 and [(a, b) for a, b, _ in scene.contacts()] == expected  # as it was
    many = Scene()
    for i in range(1000):
        many.add(TORUS, shift(i))
    assert len(pickle.dumps(many)) < 200000 + len(pickle.dumps(TORUS))  # the object once
    assert len(pickle.loads(pickle.dumps(Scene()))) == 0
    scene.set_filter(lambda a, b: True)
    with pytest.raises((pickle.PicklingError, AttributeError)):
        pickle.dumps(scene)


def test_what_pickle_did_not_make():
    for kind in (Scene, PointCloud, collisionchip.Result, collisionchip.Distance, collisionchip.Along,
                 collisionchip.CloudResult, collisionchip.Certificate):
        with pytest.raises((ValueError, TypeError)):
            kind.__new__(kind).__setstate__((99,))
