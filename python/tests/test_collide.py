# SPDX-License-Identifier: Apache-2.0
"""Objects, single queries and batches."""
import os
import pathlib
import threading
import time

import numpy as np
import pytest

import collisionchip
from collisionchip import Object, collide, collide_many, open_device
from collisionchip._core import _exact
from shapes import SEED, cube, poses, shift, torus

CUBE = Object(*cube())
TORUS = Object(*torus())


def test_touching_counts_and_one_last_bit_does_not():
    assert collide(CUBE, None, CUBE, shift(1)).hit
    assert not collide(CUBE, None, CUBE, shift(1 + 2**-52))


def test_an_object_inside_another_does_not_touch_it():
    assert not collide(Object(*cube(4)), None, CUBE, None)


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4", ">u8"])
def test_faces_of_any_integers(dtype):
    vertices, faces = cube()
    assert Object(vertices, faces.astype(dtype)).face_count == 12


@pytest.mark.parametrize("dtype", ["f2", "f4", ">f8", "i4"])
def test_vertices_of_other_numbers_are_converted(dtype):
    vertices, faces = cube(2)
    made = Object(vertices.astype(dtype), faces)
    assert collide(made, None, made, shift(2)) and not collide(made, None, made, shift(2.0001))


def test_arrays_that_are_not_contiguous():
    vertices, faces = torus()
    wide = np.zeros((len(vertices), 7))
    wide[:, ::3] = vertices
    made = Object(wide[:, ::3], np.asfortranarray(faces))
    batch = poses(np.random.default_rng(SEED), 50, 1.5)
    strided = np.zeros((100, 4, 4))
    strided[::2] = batch
    expected = collide_many(TORUS, None, TORUS, batch)
    assert (collide_many(made, None, TORUS, strided[::2]) == expected).all()
    assert (collide_many(made, None, TORUS, np.asfortranarray(batch)) == expected).all()
    assert [bool(collide(made, None, TORUS, np.asfortranarray(pose))) for pose in batch] == list(expected)


def test_arrays_are_copied():
    vertices, faces = cube()
    made = Object(vertices, faces)
    vertices += 10
    assert collide(made, None, CUBE, None)


def test_lists_and_quads():
    quad = Object([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2, 3]])
    assert collide(quad, None, CUBE, shift(1.5, 0, 0)).contacts.tolist()[0][0] == 0
    assert (quad.vertex_count, quad.face_count, quad.name) == (4, 1, "")


@pytest.mark.parametrize("vertices, faces, message", [
    (np.zeros((3, 2)), [[0, 1, 2]], "columns"),
    (np.zeros(3), [[0, 1, 2]], "dimensions"),
    (np.zeros((3, 3)), [0, 1, 2], "dimensions"),
    (np.zeros((3, 3)), [[0, 1]], "columns"),
    (np.zeros((3, 3)), [[0, 1, 3]], "face 0: vertex index 3 is out of range"),
    (np.zeros((3, 3)), [[0, 1, -1]], "face 0: vertex index -1"),
    (np.zeros((3, 3)), np.zeros((0, 3), int), "face"),
    (np.zeros((3, 3)), [[0.0, 1.0, 2.0]], "integers"),
    (np.zeros((3, 3)), [[True, False, True]], "integers"),
    (np.full((3, 3), np.nan), [[0, 1, 2]], "finite"),
    (np.full((3, 3), np.inf), [[0, 1, 2]], "finite"),
    ([["a", "b", "c"]], [[0, 0, 0]], "convert"),
])
def test_meshes_that_are_refused(vertices, faces, message):
    with pytest.raises(ValueError, match=message):
        Object(vertices, faces)


def test_files(tmp_path):
    path = tmp_path / "square.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n")
    assert Object.load(path).face_count == 2
    assert Object.load(str(path), quads=True).face_count == 1
    assert Object.load(path).name == str(path)
    with pytest.raises(FileNotFoundError):
        Object.load(tmp_path / "none.obj")
    path.write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match="square.obj:2"):
        Object.load(path)


@pytest.mark.parametrize("pose, message", [
    (np.eye(3), "shape"),
    (np.zeros(16), r"\(16,\)"),
    (np.zeros((1, 4, 4)), "shape"),
    (np.diag([1.0, 1, 1, 2]), "0 0 0 1"),
    (np.eye(4)[::-1], "0 0 0 1"),
    (np.diag([1.0, 1, np.nan, 1]), "finite"),
    (np.diag([1.0, 1, 1e200, 1]), "2\\^500"),
])
def test_poses_that_are_refused(pose, message):
    with pytest.raises(ValueError, match=message):
        collide(CUBE, None, CUBE, pose)


def test_poses_of_three_rows():
    assert collide(CUBE, np.eye(4)[:3], CUBE, shift(1)[:3].tolist())
    batch = poses(np.random.default_rng(SEED), 20, 1.5)
    assert (collide_many(CUBE, None, TORUS, batch[:, :3]) == collide_many(CUBE, None, TORUS, batch)).all()


def test_words_that_are_refused():
    for arguments in ({"contacts": "some"}, {"counts": "near"}, {"contacts": "all", "max_contacts": 0}):
        with pytest.raises(ValueError):
            collide(CUBE, None, CUBE, None, **arguments)
    with pytest.raises(ValueError, match="cpu"):
        open_device("gpu")
    with pytest.raises(ValueError, match="threads"):
        open_device("model", threads=2)
    with pytest.raises(TypeError):
        collide("cube", None, CUBE, None)


def test_contacts_relation_and_counts():
    first = collide(TORUS, None, TORUS, shift(0.5))
    assert first.hit and first.relation is None and first.crossing is None and len(first.contacts) == 1
    everything = collide(TORUS, None, TORUS, shift(0.5), contacts="all", relation=True)
    assert everything.relation == "crossing" and everything.contacts.dtype == np.uint32
    assert everything.contacts.shape == (len(everything.crossing), 2) and everything.crossing.dtype == bool
    exact = _exact(TORUS, None, TORUS, shift(0.5))
    assert everything.contacts.tolist() == exact.contacts.tolist() == sorted(exact.contacts.tolist())
    assert everything.crossing.tolist() == exact.crossing.tolist()
    assert everything.counts["pairs"] >= len(everything.contacts)
    assert len(collide(TORUS, None, TORUS, shift(0.5), contacts="all", max_contacts=3).contacts) == 3
    flush = collide(CUBE, None, CUBE, shift(1), relation=True)
    assert flush.relation == "touching" and flush.crossing.tolist() == [False]
    assert not collide(CUBE, None, CUBE, shift(1), counts="crossing")
    apart = collide(CUBE, None, CUBE, shift(3), contacts="all", relation=True)
    assert apart.relation == "apart" and apart.contacts.shape == (0, 2)


def test_contacts_stay_valid_without_their_result():
    contacts = collide(TORUS, None, TORUS, shift(0.5), contacts="all").contacts
    assert contacts.max() < TORUS.face_count and not contacts.flags.writeable


def test_a_batch_answers_as_single_queries():
    random = np.random.default_rng(SEED)
    poses_a, poses_b = poses(random, 300, 1), poses(random, 300, 1)
    for device in (None, open_device("cpu", threads=1), open_device("cpu", threads=3), open_device("model"),
                   *(open_device("cpu", target=name) for name in collisionchip.cpu_targets())):
        hits, contacts = collide_many(TORUS, poses_a, CUBE, poses_b, contacts=True, device=device)
        assert hits.dtype == bool and contacts.dtype == np.uint32 and contacts.shape[1] == 3
        assert (collide_many(TORUS, poses_a, CUBE, poses_b, device=device) == hits).all()
        rows = []
        for i, (a, b) in enumerate(zip(poses_a, poses_b)):
            single = collide(TORUS, a, CUBE, b, contacts="all")
            assert single.hit == hits[i]
            rows += [[i, *row] for row in single.contacts.tolist()]
        assert contacts.tolist() == rows
    assert 0 < hits.sum() < 300


def test_batches_of_other_sizes():
    assert collide_many(CUBE, None, CUBE, np.zeros((0, 4, 4))).shape == (0,)
    assert collide_many(CUBE, None, CUBE, None).tolist() == [True]
    batch = poses(np.random.default_rng(SEED), 10, 1)
    assert (collide_many(CUBE, batch, TORUS, None) == collide_many(CUBE, batch, TORUS, np.stack([np.eye(4)] * 10))).all()
    with pytest.raises(ValueError, match="poses_a are 10, poses_b 9"):
        collide_many(CUBE, batch, CUBE, batch[1:])
    batch[7, 3, 3] = 2
    with pytest.raises(ValueError, match="0 0 0 1"):
        collide_many(CUBE, batch, CUBE, None)


def test_threads_at_once_and_the_gil_is_released():
    batch = poses(np.random.default_rng(SEED), 2000, 1)
    expected = collide_many(TORUS, None, TORUS, batch)
    answers = []

    def work():
        answers.extend(collide_many(TORUS, None, TORUS, batch) for _ in range(5))
        answers.append(np.array([collide(TORUS, None, TORUS, pose).hit for pose in batch]))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(answers) == 24 and all((answer == expected).all() for answer in answers)

    # One long call: this thread must get on meanwhile.
    many = np.tile(batch, (50, 1, 1))
    device = open_device("cpu", threads=1)
    thread = threading.Thread(target=lambda: collide_many(TORUS, None, TORUS, many, contacts=True, device=device))
    thread.start()
    refused = ticks = 0
    while thread.is_alive():
        ticks += 1
        try:
            collide(CUBE, None, CUBE, None, device=device)
        except RuntimeError as error:
            refused += "in use" in str(error)
        time.sleep(0.001)
    thread.join()
    assert ticks > 20 and refused > 0


def test_a_child_process_continues_with_the_objects_of_its_parent():
    batch = poses(np.random.default_rng(SEED), 500, 1)
    expected = collide_many(TORUS, None, TORUS, batch)  # starts threads, which the child does not have
    child = os.fork()
    if child == 0:
        os._exit(0 if (collide_many(TORUS, None, TORUS, batch) == expected).all() else 1)
    assert os.waitpid(child, 0)[1] == 0


def test_names():
    assert open_device().name == "cpu" and collisionchip.device_names()[0] == "cpu"
    assert collisionchip.__version__ in (pathlib.Path(__file__).parents[2] / "CMakeLists.txt").read_text()
    assert "12 faces" in repr(CUBE) and "no hit" in repr(collide(CUBE, None, CUBE, shift(2)))


def test_an_object_with_other_vertices():
    vertices, faces = torus()
    made = Object(vertices, faces)
    grown = made.moved(2 * vertices)
    assert made.vertex_count == grown.vertex_count
    batch = poses(np.random.default_rng(SEED), 50, 2)
    assert (collide_many(grown, None, CUBE, batch) == collide_many(Object(2 * vertices, faces), None, CUBE, batch)).all()
    with pytest.raises(ValueError, match="vertices, the object has"):
        made.moved(vertices[1:])
    with pytest.raises(ValueError, match=r"give \(n, 3\)"):
        made.moved(vertices[:, :2])


def test_faces_of_one_object_that_touch():
    assert TORUS.self_contacts().shape == (0, 2)
    vertices, faces = cube()
    both = Object(np.concatenate([vertices, vertices + 0.25]), np.concatenate([faces, faces + len(vertices)]))
    found = both.self_contacts()
    assert len(found) > 0 and (found[:, 0] < 12).all() and (found[:, 1] >= 12).all()
    assert len(both.self_contacts(max_contacts=1)) == 1
