# SPDX-License-Identifier: Apache-2.0
"""Answers with their proof, checked by collisionchip.check."""
import json
import subprocess
import sys

import numpy as np
import pytest

import collisionchip
from collisionchip import Object, Scene, check, collide, collide_many

VERTICES = [[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def moved(x, y=0.25, z=0.5):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


@pytest.fixture
def cube():
    return Object(VERTICES, QUADS)


@pytest.mark.parametrize("contacts", ["first", "all"])
@pytest.mark.parametrize("relation", [False, True])
@pytest.mark.parametrize("device", [None, "cpu", "model"])
def test_single(cube, contacts, relation, device):
    opened = device and collisionchip.open_device(device)
    for x in (0.5, 1, 1 + 2**-52, 7):
        result = collide(cube, None, cube, moved(x), contacts=contacts, relation=relation, device=opened,
                         certificate=True)
        claim = result.certificate.check()
        assert bool(claim["contacts"]) == result.hit
        if relation:
            assert claim["relation"] == result.relation
        if contacts == "all":
            assert [c[:2] for c in claim["contacts"]] == result.contacts.tolist()
        assert collide(cube, None, cube, moved(x), contacts=contacts, relation=relation,
                       device=opened).certificate is None


def test_of_a_file_with_polygons(tmp_path):
    (tmp_path / "a.off").write_text("OFF\n5 1 0\n0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 0 1 2 3 4\n")
    polygon = Object.load(tmp_path / "a.off")
    result = collide(polygon, None, polygon, moved(0.5, 0.5, 0), contacts="all", relation=True, certificate=True)
    assert result.certificate.check()["contacts"] == [[0, 0, "touching"]]


def test_lines_and_files(cube, tmp_path):
    pose = moved(0.5)
    certificate = collide(cube, None, cube, pose, contacts="all", certificate=True).certificate
    certificate.save(tmp_path / "proof.jsonl")
    lines = (tmp_path / "proof.jsonl").read_text().splitlines()
    assert lines == certificate.lines
    assert json.loads(lines[0])["collisionchip_certificate"] == 1
    mesh = (VERTICES, QUADS, list(range(6)))
    poses = [*np.eye(4)[:3].ravel(), *pose[:3].ravel()]
    assert check.check([mesh, mesh], poses, lines)["all"]
    poses[15] = 2.0
    with pytest.raises(check.Refused, match="other meshes or poses"):
        check.check([mesh, mesh], poses, lines)
    with pytest.raises(OSError):
        certificate.save(tmp_path / "none" / "proof.jsonl")
    assert "contacts" in repr(certificate)


def test_many(cube):
    poses = np.array([moved(x) for x in (0, 0.5, 1, 1.5, 2)] * 20)
    hits, certificates = collide_many(cube, None, cube, poses, certificate=True)
    assert len(certificates) == 100
    assert [bool(c.check()["contacts"]) for c in certificates] == hits.tolist()
    hits, contacts, relations, crossing, certificates = collide_many(
        cube, None, cube, poses, contacts=True, relation=True, certificate=True)
    for i, certificate in enumerate(certificates[:5]):
        claim = certificate.check()
        assert claim["relation"] == relations[i]
        assert [c[:2] for c in claim["contacts"]] == contacts[contacts[:, 0] == i, 1:].tolist()
        assert [c[2] == "crossing" for c in claim["contacts"]] == crossing[contacts[:, 0] == i].tolist()
    assert collide_many(cube, None, cube, poses).shape == (100,)


def test_scene(cube):
    scene = Scene()
    ids = [scene.add(cube, moved(x)) for x in (0, 0.5, 2)]
    (a, b, result), = scene.contacts(contacts="all", certificate=True)
    assert (a, b) == (ids[0], ids[1])
    assert len(result.certificate.check()["contacts"]) == len(result.contacts)
    assert scene.contacts()[0][2].certificate is None
    assert scene.find_contact(ids[1], certificate=True)[1].certificate.check()["contacts"]
    assert scene.contacts(cube, moved(2.5), certificate=True)[0][1].certificate.check()["contacts"]


def test_a_file_of_several(cube, tmp_path):
    (tmp_path / "cube.off").write_text("OFF\n8 6 0\n" + "".join("%g %g %g\n" % tuple(v) for v in VERTICES)
                                       + "".join("4 %d %d %d %d\n" % tuple(q) for q in QUADS))
    lines, poses = "", ""
    for x in (0.5, 7):
        lines += "\n".join(collide(cube, None, cube, moved(x), contacts="all",
                                   certificate=True).certificate.lines) + "\n"
        poses += " ".join(str(v) for pose in (np.eye(4), moved(x)) for v in pose[:3].ravel()) + "\n"

    def run(poses, lines):
        (tmp_path / "poses").write_text(poses)
        (tmp_path / "proofs").write_text(lines, newline="")
        done = subprocess.run([sys.executable, check.__file__,
                               *(tmp_path / name for name in ("cube.off", "cube.off", "poses", "proofs"))],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
        return done.returncode, done.stdout

    code, text = run(poses, lines)
    assert code == 0 and text.count("accepted: ") == 2 and "accepted: 0 contacts" in text
    assert run(poses, lines.replace("\n", "\r"))[0] != 0
    assert run(poses.replace("7", "8"), lines)[0] == 1
    code, text = run(poses.splitlines()[0], lines)
    assert code == 2 and "24 numbers in POSES, but 2 certificates" in text
