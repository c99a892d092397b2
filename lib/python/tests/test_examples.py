# SPDX-License-Identifier: Apache-2.0
"""The examples run, and docs/cpp/python.md shows them as they are."""
import contextlib
import io
import pathlib
import re
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parents[3]
EXAMPLES = ROOT / "lib/python/examples"


def run(*command):
    done = subprocess.run([sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=60)
    return done.returncode, done.stdout


def write_box(path, least, greatest=None, faces=6):
    """A box, of fewer than six faces open; by default with sides of 1."""
    greatest = greatest or [x + 1 for x in least]
    corners = [(x, y, z) for x in (least[0], greatest[0]) for y in (least[1], greatest[1])
               for z in (least[2], greatest[2])]
    quads = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)][:faces]
    path.write_text("".join(f"v {a} {b} {c}\n" for a, b, c in corners)
                    + "".join("f %d %d %d %d\n" % quad for quad in quads))


def check(folder, *options):
    return run(EXAMPLES / "clash_check.py", folder, *options)


def test_clash_check(tmp_path):
    for name, x in (("a", 0), ("b", 1), ("c", 5)):
        write_box(tmp_path / f"{name}.obj", (x, 0, 0))
    (tmp_path / "notes.txt").write_text("no part\n")
    assert check(tmp_path) == (0, "a.obj b.obj touching\nparts=3 clashes=0\n")
    (tmp_path / "d.obj").write_text("v 0.5 0.5 -1\nv 0.5 0.6 -1\nv 0.5 0.5 2\nf 1 2 3\n")
    code, text = check(tmp_path)
    assert code == 1 and "a.obj d.obj crossing" in text
    (tmp_path / "e.obj").write_text("v 0 0 0\nf 1 2 3\n")
    code, text = check(tmp_path)
    assert code == 3 and f"left out: {tmp_path / 'e.obj'}:2: " in text and "parts=4 clashes=1\n" in text
    assert check(tmp_path / "..")[0] == 2


@pytest.mark.parametrize("word, box", [
    ("b_in_a", ((1, 1, 1), (2, 2, 2))),       # wholly inside
    ("b_in_a", ((0, 0, 0), (2, 2, 2))),       # inside, flush in a corner
    ("equal", ((0, 0, 0), (4, 4, 4))),        # the same part twice
    ("overlapping", ((2, 0, 0), (6, 4, 4))),  # bars of one section pushed into each other
    ("a_in_b", ((-1, 0, 0), (5, 4, 4))),
])
def test_clash_check_judges_solids(tmp_path, word, box):
    write_box(tmp_path / "a.obj", (0, 0, 0), (4, 4, 4))
    write_box(tmp_path / "b.obj", *box)
    assert check(tmp_path) == (1, f"a.obj b.obj {word}\nparts=2 clashes=1\n")


def test_clash_check_says_what_it_cannot_judge(tmp_path):
    write_box(tmp_path / "a.obj", (0, 0, 0), (4, 4, 4))
    write_box(tmp_path / "b.obj", (1, 1, 1), faces=5)
    code, text = check(tmp_path)
    assert code == 3 and "a.obj b.obj cannot be judged: one is not closed" in text and "clashes=0" in text
    write_box(tmp_path / "b.obj", (9, 1, 1), faces=5)
    assert check(tmp_path) == (0, "parts=2 clashes=0\n")
    write_box(tmp_path / "b.obj", (1, 1, 1))
    box = (tmp_path / "a.obj").read_text()  # twice in one file: the shells leave no volume
    (tmp_path / "a.obj").write_text(box + "".join(line + "\n" for line in box.splitlines() if line.startswith("f")))
    code, text = check(tmp_path)
    assert code != 0 and "a.obj b.obj" in text


def test_clash_check_of_shells_that_overlap(tmp_path):
    write_box(tmp_path / "a.obj", (0, 0, 0), (4, 4, 4))
    write_box(tmp_path / "more.obj", (2, 1, 1), (6, 5, 5))
    more = re.sub(r"(?<= )\d+(?= |$)", lambda number: str(int(number[0]) + 8),
                  "".join((tmp_path / "more.obj").read_text().partition("f ")[1:]), flags=re.M)
    vertices = (tmp_path / "more.obj").read_text().partition("f ")[0]
    (tmp_path / "more.obj").unlink()
    (tmp_path / "a.obj").write_text((tmp_path / "a.obj").read_text() + vertices + more)
    write_box(tmp_path / "b.obj", (2.5, 2, 2), (3.5, 3, 3))  # in the space that both shells of a share
    code, text = check(tmp_path)
    assert code == 3 and "a.obj b.obj cannot be judged: faces " in text and "clashes=0" in text
    assert "a.obj cross or lie on each other; try --inside nonzero\n" in text and "Warning" not in text
    assert check(tmp_path, "--inside", "nonzero") == (1, "a.obj b.obj b_in_a\nparts=2 clashes=1\n")
    lines = (tmp_path / "b.obj").read_text().splitlines()
    # one face the other way round
    (tmp_path / "b.obj").write_text("\n".join(lines[:-1] + ["f " + " ".join(lines[-1].split()[:0:-1])]) + "\n")
    code, text = check(tmp_path, "--inside", "nonzero")
    assert (code == 3 and "a.obj b.obj cannot be judged: faces of " in text and "b.obj are not all" in text
            and "clashes=0" in text)


def test_clash_check_command_line(tmp_path):
    code, text = run(EXAMPLES / "clash_check.py", "--help")
    assert code == 0 and "FOLDER" in text and "Exit codes" in text
    code, text = run(EXAMPLES / "clash_check.py", tmp_path / "none")
    assert code == 2 and "no such folder" in text and "Traceback" not in text


def test_robot():
    code, text = run(EXAMPLES / "robot.py")
    assert code == 0 and text in (ROOT / "docs/cpp/python.md").read_text()


def test_the_code_of_the_page():
    """Blocks of the page run one after the other in one namespace, and print the block that follows."""
    page = (ROOT / "docs/cpp/python.md").read_text()
    names = {}
    blocks = re.findall(r"^```python\n(.*?)^```\n(?:\n?```\n(.*?)^```$)?", page, re.S | re.M)
    assert len(blocks) > 3
    for code, output in blocks:
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            exec(compile(code, "docs/cpp/python.md", "exec"), names)
        assert printed.getvalue() == output, code
