# SPDX-License-Identifier: Apache-2.0
"""Objects, single queries and batches."""
import copy
import gc
import os
import pathlib
import pickle
import platform
import subprocess
import sys
import threading
import time
import warnings
import weakref

import numpy as np
import pytest

import collisionchip
from collisionchip import Object, collide, collide_many, open_device
from collisionchip._core import _exact
from shapes import SEED, cube, joined, poses, shift, torus

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
    (np.zeros((3, 3)), np.zeros((0, 3), int), "no faces"),
    (np.zeros((3, 3)), [], "no faces"),
    (np.zeros((3, 3)), np.array([[0, 1, 2**64 - 1]], np.uint64), "vertex index 18446744073709551615 is out of range"),
    (np.zeros((3, 3)), np.array([[0, 1, 2**63]], np.uint64), "vertex index 9223372036854775808 is out of range"),
    (np.ma.masked_array(np.zeros((3, 3)), mask=np.eye(3)), [[0, 1, 2]], "vertices is a masked array"),
    (np.zeros((3, 3)), np.ma.masked_array([[0, 1, 2]], mask=[[0, 0, 1]]), "faces is a masked array"),
    (np.full((3, 3), 1j), [[0, 1, 2]], "vertices has complex numbers"),
    ([[0, 0, 1j]] * 3, [[0, 1, 2]], "vertices has complex numbers"),
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
    with pytest.raises(IsADirectoryError):
        Object.load(tmp_path)
    path.write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(ValueError, match="square.obj:2"):
        Object.load(path)


def test_files_with_faces_that_cannot_be_used(tmp_path):
    path = tmp_path / "damaged.obj"
    square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv nan 0 0\n"
    path.write_text(square + "f 1 2 9\nf 1 2 3\nf 1 2 5\nf 1 3 4\n")
    with pytest.raises(ValueError, match="damaged.obj:6"):
        Object.load(path)
    with pytest.raises(TypeError):
        Object.load(path, False, True)
    for quads in (False, True):
        left = Object.load(path, quads, lenient=True)
        assert left.faces.tolist() == [[0, 1, 2], [0, 2, 3]]
        assert left.face_numbers.tolist() == [1, 3]
        assert isinstance(left.notes, tuple) and len(left.notes) == 3
        assert left.notes[0].startswith("line 6: face 0") and "face 2 uses it" in left.notes[1]
        assert left.notes[2] == "2 faces were left out because they cannot be used"
    path.write_text(square + 120 * "f 1 2 9\n" + "f 1 2 3\n")
    many = Object.load(path, lenient=True)
    assert len(many.notes) == 101 and many.notes[-1].startswith("120 faces")
    path.write_text(square + "f 1 2 3\n")
    assert Object.load(path, lenient=True).notes == ()
    assert Object([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]).notes == ()
    path.write_text(square + "f 1 2 9\n")  # no face is left
    with pytest.raises(ValueError, match="damaged.obj"):
        Object.load(path, lenient=True)


def test_names_of_files_that_are_any_bytes(tmp_path):
    text = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    for name in (b"plain.off", b"\xc3\xa4.off", b"\xff\xfe.off"):
        path = os.path.join(os.fsencode(tmp_path), name)
        with open(path, "w") as file:
            file.write(text)
        for given in (path, os.fsdecode(path), pathlib.Path(os.fsdecode(path))):
            made = Object.load(given)
            assert made.face_count == 1
            assert os.fsencode(made.name) == path
            assert os.fsdecode(path) in repr(made)
            assert pickle.loads(pickle.dumps(made)).name == made.name
        with open(path, "w") as file:
            file.write("no mesh")
        with pytest.raises(ValueError) as raised:
            Object.load(path)
        assert os.fsdecode(path) in str(raised.value)
        with pytest.raises(FileNotFoundError) as raised:
            Object.load(path + b".none")
        assert raised.value.filename == path + b".none"
    with pytest.raises(TypeError):
        Object.load(3.5)


def test_vertices_that_no_face_uses_may_be_anything():
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (np.nan,) * 3]
    made = Object(vertices, [(0, 1, 2)])
    assert made.face_count == 1 and len(made.self_contacts()) == 0
    with pytest.raises(ValueError, match="not finite"):
        Object(vertices, [(0, 1, 3)])


@pytest.mark.parametrize("pose, message", [
    (np.eye(3), "shape"),
    (np.zeros(16), r"\(16,\)"),
    (np.zeros((1, 4, 4)), "shape"),
    (np.diag([1.0, 1, 1, 2]), "0 0 0 1"),
    (np.eye(4)[::-1], "0 0 0 1"),
    (np.diag([1.0, 1, np.nan, 1]), "pose_b: row 2, column 2 is not finite"),
    (np.full((4, 4), np.nan), "pose_b: row 0, column 0 is not finite"),
    (np.diag([1.0, 1, 1, np.nan]), "pose_b: row 3, column 3 is not finite"),
    (np.ma.masked_array(np.eye(4), mask=np.eye(4)), "pose_b is a masked array"),
    (np.eye(4) * 1j, "pose_b has complex numbers"),
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
    for arguments in ({"contacts": "some"}, {"least": "near"}, {"contacts": "all", "max_contacts": 0},
                      {"max_contacts": 0}):
        with pytest.raises(ValueError):
            collide(CUBE, None, CUBE, None, **arguments)
    with pytest.raises(ValueError, match="cpu"):
        open_device("gpu")
    with pytest.raises(ValueError, match="threads"):
        open_device("model", threads=2)
    with pytest.raises(TypeError):
        collide("cube", None, CUBE, None)


def test_contacts_relation_and_stats():
    first = collide(TORUS, None, TORUS, shift(0.5))
    assert first.hit and first.relation is None and first.crossing is None and len(first.contacts) == 1
    everything = collide(TORUS, None, TORUS, shift(0.5), contacts="all", relation=True)
    assert everything.relation == "crossing" and everything.contacts.dtype == np.uint32
    assert everything.contacts.shape == (len(everything.crossing), 2) and everything.crossing.dtype == bool
    exact = _exact(TORUS, None, TORUS, shift(0.5))
    assert everything.contacts.tolist() == exact.contacts.tolist() == sorted(exact.contacts.tolist())
    assert everything.crossing.tolist() == exact.crossing.tolist()
    assert everything.stats["pairs"] >= len(everything.contacts)
    assert len(collide(TORUS, None, TORUS, shift(0.5), contacts="all", max_contacts=3).contacts) == 3
    flush = collide(CUBE, None, CUBE, shift(1), relation=True)
    assert flush.relation == "touching" and flush.crossing.tolist() == [False]
    assert not collide(CUBE, None, CUBE, shift(1), least="crossing")
    apart = collide(CUBE, None, CUBE, shift(3), contacts="all", relation=True)
    assert apart.relation == "apart" and apart.contacts.shape == (0, 2)


def test_a_hint_is_tested_first_and_changes_no_answer():
    every = collide(TORUS, None, TORUS, shift(1), contacts="all")
    last = None
    for step in np.linspace(0.9, 2.9, 41):
        plain = collide(TORUS, None, TORUS, shift(step))
        result = collide(TORUS, None, TORUS, shift(step), hint=last)
        assert result.hit == plain.hit
        last = result
    assert not last.hit and collide(TORUS, None, TORUS, shift(1), hint=last).hit
    again = collide(TORUS, None, TORUS, shift(1), hint=every)
    assert again.contacts[0].tolist() == every.contacts[0].tolist() and again.stats["steps"] == 0
    with pytest.raises(TypeError):
        collide(TORUS, None, TORUS, shift(1), hint=(0, 0))


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
    assert (collide_many(CUBE, batch, TORUS, None) == collide_many(CUBE, batch, TORUS,
                                                                   np.stack([np.eye(4)] * 10))).all()
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
    assert collisionchip.__version__ in (pathlib.Path(__file__).parents[3] / "CMakeLists.txt").read_text()
    assert "12 faces" in repr(CUBE) and "no hit" in repr(collide(CUBE, None, CUBE, shift(2)))


def test_an_object_with_other_vertices():
    vertices, faces = torus()
    made = Object(vertices, faces)
    grown = made.moved(2 * vertices)
    assert made.vertex_count == grown.vertex_count
    batch = poses(np.random.default_rng(SEED), 50, 2)
    assert (collide_many(grown, None, CUBE, batch) == collide_many(Object(2 * vertices, faces), None, CUBE,
                                                                   batch)).all()
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
    pairs, crossing = both.self_contacts(relation=True)
    assert (pairs == found).all() and crossing.shape == (len(found),) and crossing.dtype == bool and crossing.any()
    with pytest.raises(ValueError, match="max_contacts"):
        both.self_contacts(max_contacts=0)


def test_neighbours_that_pierce_or_fold():
    pierce = Object([(0, 0, 0), (2, 0, 0), (0, 2, 0), (1, 1, -1), (1, 1, 1)], [(0, 1, 2), (0, 3, 4)])
    pairs, crossing = pierce.self_contacts(relation=True)
    assert pairs.tolist() == [[0, 1]] and crossing.tolist() == [True]
    fold = Object([(0, 0, 0), (2, 0, 0), (0, 2, 0), (1, 1, 0)], [(0, 1, 2), (0, 1, 3)])
    pairs, crossing = fold.self_contacts(relation=True)
    assert pairs.tolist() == [[0, 1]] and crossing.tolist() == [False]
    for made in (pierce, fold):
        assert made.self_contacts(neighbours=False).tolist() == []


def test_vertices_and_faces_of_an_object(tmp_path):
    vertices, faces = cube()
    made = Object(vertices, faces)
    assert (made.vertices == vertices).all() and made.vertices.dtype == np.float64
    assert (made.faces == faces).all() and made.faces.dtype == np.uint32
    assert made.face_numbers.tolist() == list(range(len(faces)))
    with pytest.raises(ValueError):
        made.vertices[0, 0] = 1
    kept = made.vertices
    del made
    gc.collect()
    assert (kept == vertices).all()
    path = tmp_path / "mixed.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 .5 0\nf 1 2 3 4\nf 1 2 5\nf 1 2 3 4 5\n")
    mixed = Object.load(path, quads=True)
    assert mixed.faces[:2].tolist() == [[0, 1, 2, 3], [0, 1, 4, 4]]
    assert mixed.face_numbers.tolist() == [0, 1, 2, 2, 2] and len(mixed.faces) == 5


def test_pickle_and_copies(tmp_path):
    path = tmp_path / "mixed.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 .5 0\nf 1 2 3 4\nf 1 2 5\nf 1 2 3 4 5\n")
    for made in (CUBE, TORUS, Object.load(path, quads=True), TORUS.moved(TORUS.vertices * [1, 2, 1])):
        for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
            again = pickle.loads(pickle.dumps(made, protocol))
            assert again.name == made.name and (again.vertices == made.vertices).all()
            assert (again.faces == made.faces).all() and (again.face_numbers == made.face_numbers).all()
            place = shift(0.3, 0.1)
            found, expected = (collide(x, None, CUBE, place, contacts="all") for x in (again, made))
            assert found.contacts.tolist() == expected.contacts.tolist()
        assert copy.copy(made) is made and copy.deepcopy([made])[0] is made
    with pytest.raises(ValueError):
        Object.__new__(Object).__setstate__((1, b"", b"1", b"", b"", 0))
    with pytest.raises(ValueError, match="version 2"):
        Object.__new__(Object).__setstate__((2, b"", b"", b"", b"", 0))


def test_weak_references():
    made = Object(*cube())
    device, result = open_device("cpu", threads=1), collide(made, None, made, None)
    references = [weakref.ref(x) for x in (made, device, result)]
    assert [x() is not None for x in references] == [True] * 3
    del made, device, result
    gc.collect()
    assert [x() for x in references] == [None] * 3


def test_relations_of_a_batch():
    batch = np.tile(shift(0, 0.25, 0.5), (4, 1, 1))
    batch[:, 0, 3] = [0.5, 1, 1 + 2**-52, 3]
    hits, relations = collide_many(CUBE, None, CUBE, batch, relation=True)
    assert hits.tolist() == [True, True, False, False]
    assert relations.tolist() == ["crossing", "touching", "apart", "apart"]
    hits, contacts, relations, crossing = collide_many(CUBE, None, CUBE, batch, contacts=True, relation=True)
    assert relations.tolist() == ["crossing", "touching", "apart", "apart"]
    for i, pose in enumerate(batch):
        one = collide(CUBE, None, CUBE, pose, contacts="all", relation=True)
        mine = contacts[:, 0] == i
        assert contacts[mine, 1:].tolist() == one.contacts.tolist() and (crossing[mine] == one.crossing).all()
    relations = collide_many(CUBE, None, CUBE, batch[1], contacts=True, relation=True, max_contacts=1)[2]
    assert relations.tolist() == [""]


def test_batches_without_poses():
    for none in ([], np.zeros((0, 4, 4)), np.zeros((0, 3, 4)), np.zeros(0)):
        assert collide_many(CUBE, None, CUBE, none).shape == (0,)
        assert collide_many(CUBE, none, CUBE, None).shape == (0,)
        hits, contacts = collide_many(CUBE, None, CUBE, none, contacts=True)
        assert hits.shape == (0,) and contacts.shape == (0, 3)
        assert [len(x) for x in collide_many(CUBE, None, CUBE, none, contacts=True, relation=True)] == [0] * 4
    with pytest.raises(ValueError, match="max_contacts"):
        collide_many(CUBE, None, CUBE, [], max_contacts=0)
    with pytest.raises(ValueError, match="shape"):
        collide(CUBE, None, CUBE, [])
    with pytest.raises(ValueError, match=r"poses_b\[1\]: row 0, column 3 is not finite"):
        collide_many(CUBE, None, CUBE, [np.eye(4), shift(np.nan)])


def test_all_stats():
    stats = collide(CUBE, None, CUBE, None).stats
    assert {"steps", "box_tests", "pairs", "open", "clocks", "fallbacks", "swaps", "swap_clocks"} == set(stats)


@pytest.mark.skipif(not os.path.isdir("/proc/self/task"), reason="counts threads as Linux shows them")
def test_threads_share_the_device_of_all_cores():
    program = f"""
import os, sys, threading
sys.path[:0] = {sys.path!r}
import numpy as np
from collisionchip import Object, collide_many
cube = Object([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)],
              [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]])
poses = np.tile(np.eye(4), (1000, 1, 1))
before, ready, wrong = len(os.listdir("/proc/self/task")), threading.Barrier(9), []
def work():
    for _ in range(20):
        if not collide_many(cube, None, cube, poses).all(): wrong.append(1)
    ready.wait()
    ready.wait()
threads = [threading.Thread(target=work) for _ in range(8)]
for thread in threads: thread.start()
ready.wait()
print(len(os.listdir("/proc/self/task")) - before - 8 < (os.cpu_count() or 1), wrong)
ready.wait()
for thread in threads: thread.join()
"""
    assert subprocess.run([sys.executable, "-c", program], capture_output=True, text=True,
                          check=True).stdout == "True []\n"


@pytest.mark.skipif(platform.machine() != "x86_64", reason="switches the mode of x86")
def test_threads_that_flush_small_numbers_to_zero(tmp_path):
    # the constructor of a library that was linked with -ffast-math does this
    code = "#include <xmmintrin.h>\nvoid flush(void) {{ _mm_setcsr(_mm_getcsr() | 0x8040u); }}\n"
    code += "unsigned flushes(void) {{ return _mm_getcsr() & 0x8040u; }}\n"
    (tmp_path / "flush.c").write_text(code.format())
    library = tmp_path / "flush.so"
    if subprocess.run(["cc", "-shared", "-fPIC", "-o", library, tmp_path / "flush.c"], check=False).returncode:
        pytest.skip("no C compiler")
    program = f"""
import ctypes, sys
sys.path[:0] = {sys.path!r}
import numpy as np
from collisionchip import CollisionManager, Object, Scene, collide, collide_many, open_device
vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * 2.0**-400
faces = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
library = ctypes.CDLL({str(library)!r})
library.flush()
cube = Object(vertices, faces)
scene = Scene()
ids = [scene.add(cube), scene.add(cube)]
scene.set_pose(ids[0], None)
print(collide(cube, None, cube, None).hit, collide_many(cube, None, cube, [np.eye(4)] * 100).all(),
      len(scene.contacts()), len(cube.self_contacts()), cube.moved(vertices).face_count,
      collide(cube, None, cube, None, device=open_device("cpu", threads=2)).hit, library.flushes() == 0x8040)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert (done.stdout, done.stderr) == ("True True 1 0 6 True True\n", "")


def test_within_and_distance():
    box = Object(*cube())
    for shape in (np.array([0.1, 0.25, 3.0]), np.array([1e-9, 7.0])):
        for gap in shape:
            place = shift(1 + gap)
            real = place[0, 3] - 1  # exact: Sterbenz, or the gap is far above an ulp of 1
            found = collisionchip.distance(box, None, box, place)
            assert found.lower <= real <= found.upper and found.upper - found.lower <= np.spacing(real)
            assert collide(box, None, box, place, within=found.upper).hit
            assert not collide(box, None, box, place, within=np.nextafter(found.lower, 0)).hit
    assert not collide(box, None, box, shift(1.5)).hit
    corners, faces = cube()
    alone = [Object(corners, faces[i:i + 1]) for i in range(len(faces))]
    near = [[i, j] for i, a in enumerate(alone) for j, b in enumerate(alone)
            if collisionchip.distance(a, None, b, shift(1.5)).upper <= 0.5]
    assert collide(box, None, box, shift(1.5), contacts="all", within=0.5).contacts.tolist() == near and len(near) > 4
    poses = np.array([shift(1.25), shift(1.5), shift(1.75)])
    assert collide_many(box, None, box, poses, within=0.5).tolist() == [True, True, False]
    scene = collisionchip.Scene()
    scene.add(box)
    scene.add(box, shift(1.5))
    assert not scene.contacts() and len(scene.contacts(within=0.5)) == 1
    far = collisionchip.distance(box, None, box, shift(9), stop_above=2)
    assert (far.lower, far.upper) == (2, np.inf) and np.isnan(far.points).all()
    near = collisionchip.distance(box, None, box, shift(4), rel_error=0.5)
    assert near.lower <= 3 <= near.upper <= 2 * near.lower and near.faces.shape == (2,)
    for wrong in ({"rel_error": 1.0}, {"rel_error": -0.1}, {"stop_above": -1.0}, {"stop_above": np.nan}):
        with pytest.raises(ValueError):
            collisionchip.distance(box, None, box, None, **wrong)
    for d in (-1.0, np.inf, np.nan):
        with pytest.raises(ValueError):
            collide(box, None, box, None, within=d)


def test_intersections_curves_and_normals():
    result = collide(CUBE, None, CUBE, shift(0.5, 0.5, 0.5), contacts="all")
    parts = result.intersections()
    assert len(parts) == len(result.contacts) > 0
    for (kind, points), in parts:
        assert kind in ("point", "segment") and points.shape == ({"point": 1, "segment": 2}[kind], 3)
        assert points.dtype == np.float64 and (points >= 0).all() and (points <= 0.5).all()
    (points, closed), = result.curves()
    assert closed
    assert {(0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0), (0, 0.5, 0.5), (0, 0, 0.5),
            (0.5, 0, 0.5)} <= set(map(tuple, points))
    normals = result.normals()
    assert normals.shape == (len(result.contacts), 2, 3)
    assert (np.abs(normals).sum(axis=2) == 1).all()
    flush = collide(CUBE, None, CUBE, shift(1), contacts="all")
    assert {kind for part in flush.intersections() for kind, _ in part} >= {"segment", "polygon"}
    apart = collide(CUBE, None, CUBE, shift(2), contacts="all")
    assert apart.intersections() == [] and apart.curves() == [] and apart.normals().shape == (0, 2, 3)
    near = collide(CUBE, None, CUBE, shift(2), contacts="all", within=1)
    assert near.hit and set(map(len, near.intersections())) == {0}


def test_solids():
    box = Object(*cube())
    small = np.diag([0.5, 0.5, 0.5, 1])
    for pose, relation in ((shift(2), "disjoint"), (shift(1), "touching"), (shift(0.5), "overlapping"), (None, "equal"),
                           (small, "b_in_a")):
        assert collisionchip.solids(box, None, box, pose) == relation
    assert collisionchip.solids(box, small, box, None) == "a_in_b"
    corners, faces = cube()
    lid = Object(corners, faces[1:])
    assert box.is_closed and not lid.is_closed
    with pytest.raises(ValueError, match="the surface of A is open at the edge from"):
        collisionchip.solids(lid, None, box, None)
    with pytest.raises(ValueError, match="flattens space"):
        collisionchip.solids(box, None, box, np.diag([1.0, 1, 0, 1]))


def bar(x=0.0):
    corners, faces = cube()
    return corners + (x, x / 4, x / 8), faces


def test_shells_that_overlap():
    two = Object(*joined(bar(), bar(0.5)))  # share x from 0 to 0.5
    twice = Object(*joined(bar(), bar()))
    assert two.is_closed and two.twisted_edge is None
    a, b = two.shell_overlap
    assert a < 12 <= b and type(a) is int
    assert twice.shell_overlap is not None
    assert Object(*joined(bar(), bar(2))).shell_overlap is None and Object(
        *joined(bar(), bar(1.25))).shell_overlap is None
    assert Object(*cube()).shell_overlap is None and Object(*cube()).twisted_edge is None
    corners, faces = cube()
    twisted = Object(corners, np.concatenate([faces[:1, ::-1], faces[1:]]))
    start, end, face = twisted.twisted_edge
    assert twisted.is_closed and face in (0, 1) and {start, end} <= {tuple(x) for x in corners.tolist()}


def test_solids_of_shells_that_overlap_warn():
    two, small = Object(*joined(bar(), bar(0.5))), Object(*cube(0.25))
    inside = shift(0.25)  # in the space that both share
    a, b = two.shell_overlap
    with pytest.warns(UserWarning) as said:
        assert collisionchip.solids(two, None, small, inside) == "disjoint"
    assert len(said) == 1 and said[0].filename == __file__
    text = str(said[0].message)
    assert f"faces {a} and {b} of A cross" in text and "inside='nonzero'" in text and "\n" not in text
    with pytest.warns(UserWarning, match="of B cross"):
        assert collisionchip.solids(small, inside, two, None, inside="odd") == "disjoint"
    with pytest.warns(UserWarning, match="of A lie on each other"):
        collisionchip.solids(Object(*joined(bar(), bar())), None, small, None)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert collisionchip.solids(two, None, small, inside, inside="nonzero") == "b_in_a"
        assert collisionchip.solids(two, None, small, shift(9)) == "disjoint"  # boxes tell that, whatever is inside
        with pytest.raises(UserWarning):
            collisionchip.solids(two, None, small, inside)
    with pytest.raises(ValueError, match="inside is 'even'; give 'odd' or 'nonzero'"):
        collisionchip.solids(two, None, small, None, inside="even")
    corners, faces = cube()
    with pytest.raises(ValueError, match="B"):
        collisionchip.solids(small, None, Object(corners, np.concatenate([faces[:1, ::-1], faces[1:]])), None,
                             inside="nonzero")


def test_along():
    box = Object(*cube())
    for pose, direction, factor in ((shift(0.5), (1, 0, 0), 0.5), (shift(0.5), [-1, 0, 0], 1.5),
                                    (None, np.array([0, 0, 2]), 0.5),
                                    (shift(1), (1, 0, 0), 0), (shift(1), (0, 1, 0), 1),
                                    (shift(0.75, 0.5), (1, 1, 0), 0.25)):
        clear = collisionchip.clear_along(box, None, box, pose, direction)
        assert (clear.touches, clear.factor, clear.lower, clear.upper) == (True, factor, factor, factor)
        assert clear.faces.shape == (2,) and clear.faces.dtype == np.uint32
        back = collisionchip.clear_along(box, pose, box, None, -np.array(direction))
        assert back.factor == factor
    third = collisionchip.clear_along(box, None, box, shift(0.5), (1.5, 0, 0))
    assert (third.factor, third.lower, third.upper) == (1 / 3, 1 / 3, np.nextafter(1 / 3, 1))
    apart = collisionchip.clear_along(box, None, box, shift(3), (1, 0, 0))
    assert (apart.touches, apart.factor) == (False, 0) and "touches" not in repr(apart) and "touches" in repr(third)
    contact = collisionchip.first_contact(box, None, box, shift(3), (-1, 0, 0))
    assert (contact.touches, contact.factor) == (True, 2)
    never = collisionchip.first_contact(box, None, box, shift(3), (1, 0, 0))
    assert (never.touches, never.factor) == (False, np.inf)
    for query in (collisionchip.clear_along, collisionchip.first_contact):
        for wrong in ((0, 0, 0), (0, np.nan, 0), (1, 0), [[1, 0, 0]], 1.0):
            with pytest.raises(ValueError, match="direction"):
                query(box, None, box, None, wrong)
