# SPDX-License-Identifier: Apache-2.0
"""clash_many.py on boxes, whose relations are known. `scripts/run test-dask` runs it; skipped where distributed is not
installed."""
import csv
import pathlib
import re
import subprocess
import sys

import pytest

pytest.importorskip("distributed")
pytest.importorskip("trimesh")

EXAMPLE = pathlib.Path(__file__).parents[1] / "examples/clash_many.py"


def write_box(path, least, greatest, faces=6):
    """A box of quads; of fewer than six faces it is open."""
    corners = [[(greatest if bit else least)[axis] for axis, bit in enumerate((i >> 2 & 1, i >> 1 & 1, i & 1))]
               for i in range(8)]
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)][:faces]
    path.write_text("".join("v %r %r %r\n" % tuple(c) for c in corners)
                    + "".join("f %d %d %d %d\n" % tuple(1 + v for v in q) for q in quads))


def run(*arguments):
    return subprocess.run([sys.executable, EXAMPLE, *arguments], capture_output=True, text=True, timeout=120)


def test_what_pairs_are(tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    write_box(folder / "base.obj", (0, 0, 0), (4, 4, 4))
    write_box(folder / "copy.obj", (0, 0, 0), (4, 4, 4))
    write_box(folder / "inside.obj", (1, 1, 1), (2, 2, 2))
    write_box(folder / "near.obj", (4.25, 0, 0), (5, 4, 4))
    write_box(folder / "open.obj", (20, 0, 0), (21, 1, 1), faces=5)
    write_box(folder / "on_open.obj", (21, 0, 0), (22, 1, 1))
    write_box(folder / "shifted.obj", (30, 0, 0), (32, 2, 2))
    write_box(folder / "shifted2.obj", (31, 1, 1), (33, 3, 3))
    write_box(folder / "shifted3.obj", (33, 1, 1), (34, 3, 3))
    page = tmp_path / "clashes.html"
    done = run(folder, tmp_path / "clashes.csv", "--clearance", "0.5", "--report", page)
    assert done.returncode == 1, done.stderr
    assert "open.obj: not closed" in done.stderr and "on_open.obj: not closed" not in done.stderr
    with open(tmp_path / "clashes.csv", newline="") as file:
        found = {(line["a"][:-4], line["b"][:-4]): (line["relation"], line["solids"], line["distance"])
                 for line in csv.DictReader(file)}
    assert found.pop(("base", "copy"))[1] == "equal"
    assert found == {
        ("base", "inside"): ("apart", "b_in_a", ""),
        ("copy", "inside"): ("apart", "b_in_a", ""),
        ("base", "near"): ("apart", "disjoint", "0.25"),
        ("copy", "near"): ("apart", "disjoint", "0.25"),
        ("on_open", "open"): ("touching", "", "0.0"),
        ("shifted", "shifted2"): ("crossing", "overlapping", "0.0"),
        ("shifted2", "shifted3"): ("touching", "touching", "0.0"),
    }
    text = page.read_text()
    for words in ("duplicate", "b inside a", "0.25 apart", "surfaces touch, not both closed: no solids",
                  ">overlap<", ">touch<"):
        assert words in text, words
    links = re.findall(r'href="(.*?)"', text)
    assert len(links) == 4 and all("three" in (tmp_path / link).read_text().lower() for link in links)


def test_clearance_and_exit_code(tmp_path):
    write_box(tmp_path / "a.obj", (0, 0, 0), (1, 1, 1))
    write_box(tmp_path / "b.obj", (1.5, 0, 0), (2, 1, 1))
    done = run(tmp_path, tmp_path / "clashes.csv")
    assert done.returncode == 0 and (tmp_path / "clashes.csv").read_text() == "a,b,relation,contacts,solids,distance\n"
    assert run(tmp_path, tmp_path / "clashes.csv", "--clearance", "0.5").returncode == 0
    assert (tmp_path / "clashes.csv").read_text().splitlines()[1:] == ["a.obj,b.obj,apart,0,disjoint,0.5"]
    assert run(tmp_path, tmp_path / "clashes.csv", "--clearance", "nan").returncode == 2


def test_shells_that_overlap(tmp_path):
    folder = tmp_path / "parts"
    folder.mkdir()
    write_box(folder / "a.obj", (0, 0, 0), (4, 4, 4))
    write_box(folder / "b.obj", (1, 1, 1), (2, 2, 2))
    box = (folder / "a.obj").read_text()  # its faces twice
    (folder / "a.obj").write_text(box + "".join(line + "\n" for line in box.splitlines() if line.startswith("f")))
    page = tmp_path / "clashes.html"
    done = run(folder, tmp_path / "clashes.csv", "--report", page)
    assert (done.returncode == 3 and "a.obj: faces 0 and 6 cross or lie on each other" in done.stderr
            and "b.obj: faces" not in done.stderr)
    assert "<li>a.obj: faces 0 and 6<" in page.read_text()
    done = run(folder, tmp_path / "clashes.csv", "--inside", "nonzero")
    assert done.returncode == 1 and "faces 0" not in done.stderr
    assert (tmp_path / "clashes.csv").read_text().splitlines()[1:] == ["a.obj,b.obj,apart,0,b_in_a,"]
