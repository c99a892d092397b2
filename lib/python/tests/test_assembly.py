# SPDX-License-Identifier: Apache-2.0
"""Assembly: parts, rules, verdicts, motion, receipts."""
import copy

import numpy as np
import pytest
from shapes import cube

from collisionchip import Assembly, Object


def moved(x, y=0.0, z=0.0):
    pose = np.eye(4)
    pose[:3, 3] = x, y, z
    return pose


def two(x, **keywords):
    assembly = Assembly(unit="mm", **keywords)
    block = Object(*cube())
    assembly.add("a", block)
    assembly.add("b", block, moved(x), groups=["b's"])
    return assembly


def test_verdicts_and_rules():
    assembly = two(0.75)
    report = assembly.check()
    assert not report and report.violations == 1 and report.judged == 1
    pair = report.pairs[0]
    assert (pair.a, pair.b, pair.verdict, pair.is_violation, pair.is_judged, pair.rule) == ("a", "b", "overlap", True,
                                                                                          True, None)
    assert pair.depth == pytest.approx(0.25) and abs(pair.direction[0]) == 1 and pair.distance is None
    assert "overlap" in pair.text and "overlap" in repr(pair) and "1 violations" in repr(report)
    assembly.add_rule("overlap", parts=["a", "b"], limit=0.26)
    assert assembly.check()
    assembly.add_rule("overlap", parts=["a", "b"], limit=0.24)  # the last of equally special ones
    report = assembly.check()
    assert not report and report.pairs[0].rule == "rule 2" and len(report.unused_rules) == 1
    assert 'allow = "overlap"' in report.accepting_rules() or "a" in report.accepting_rules()
    with pytest.raises(ValueError, match="kind is 'none'; give one of nothing, "):
        assembly.add_rule("none")
    assembly.add_rule("touching", parts=["a", "c"])
    assert len(assembly.check().unused_rules) == 2


def test_clearance_and_poses():
    assembly = two(1.5, clearance=0.5)
    assert assembly.check() and assembly.clearance == 0.5 and assembly.unit == "mm"
    assembly.set_pose("b", moved(1.25))
    pair = assembly.check().pairs[0]
    assert pair.verdict == "too_near" and pair.distance == (0.25, 0.25)
    assert pair.nearest[1][0] - pair.nearest[0][0] == 0.25
    assert assembly.pose("b")[0, 3] == 1.25 and assembly.parts == ["a", "b"] and len(assembly) == 2
    assert assembly.check().size.tolist() == [2.25, 1, 1]
    other = copy.deepcopy(assembly)
    other.set_pose("b", moved(9))
    assert other.check() and not assembly.check()
    with pytest.raises(KeyError):
        assembly.pose("c")
    with pytest.raises(ValueError, match="there is a part 'a' already"):
        assembly.add("a", assembly.object("b"))


def test_motion():
    assembly = two(2.0)
    way = np.stack([moved(0), moved(-0.75)])
    report = assembly.check_motion(parts={"b": way})
    assert report["violations"] == 0 and report["unproved"] == 0
    assert report["pairs"][0]["clearance"][0] <= 0.25 <= report["pairs"][0]["clearance"][1] * 1.0001
    report = assembly.check_motion(parts={"b": np.stack([moved(0), moved(-2)])})
    assert report["violations"] == 1 and 0.49 < report["pairs"][0]["time"] < 0.6
    with pytest.raises(ValueError, match="give as many for each"):
        assembly.check_motion(parts={"b": way, "a": way[:1]})


def test_receipts(tmp_path):
    assembly = two(1.0)
    assembly.add_rule("touching")
    report = assembly.check()
    assert report and report.accepted == 1
    report.write_receipts(tmp_path / "proofs")
    verified = assembly.verify_receipts(tmp_path / "proofs")
    assert [pair[:3] for pair in verified["pairs"]] == [("a", "b", "proved")] and verified["by_boxes"] == 0
    assembly.set_pose("b", moved(1.0, 0.5))
    assert assembly.verify_receipts(tmp_path / "proofs")["pairs"][0][2] == "stale"
    with pytest.raises(RuntimeError, match="receipts.json"):
        assembly.verify_receipts(tmp_path)


def test_files(tmp_path):
    (tmp_path / "box.off").write_text("OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n")
    path = tmp_path / "x.toml"
    path.write_text('unit = "mm"\n[[part]]\nfile = "box.off"\n[[part]]\nfile = "box.off"\nxyz = [0.25, 0.25, 0]\n')
    report = Assembly.load(path).check(threads=1)
    assert report.violations == 1 and report.pairs[0].a == "box" and report.pairs[0].b == "box#2"
    path.write_text('unit = "mm"\n[[part]]\nfile = "none.off"\n')
    with pytest.raises(ValueError, match="none.off"):
        Assembly.load(path)
    with pytest.raises(ValueError, match="is no assembly"):
        Assembly.load(tmp_path / "box.off")
