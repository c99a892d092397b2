# SPDX-License-Identifier: Apache-2.0
"""The examples run, and docs/cpp/python.md shows them as they are."""
import contextlib
import io
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[2]
EXAMPLES = ROOT / "python/examples"


def run(*command):
    done = subprocess.run([sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60)
    return done.returncode, done.stdout


def write_box(path, x):
    corners = [(x + i, j, k) for i in (0, 1) for j in (0, 1) for k in (0, 1)]
    faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
    path.write_text("".join(f"v {a} {b} {c}\n" for a, b, c in corners) + "".join("f %d %d %d %d\n" % face for face in faces))


def test_clash_check(tmp_path):
    for name, x in (("a", 0), ("b", 1), ("c", 5)):
        write_box(tmp_path / f"{name}.obj", x)
    (tmp_path / "notes.txt").write_text("no part\n")
    code, text = run(EXAMPLES / "clash_check.py", tmp_path)
    assert code == 0 and re.fullmatch(r"a\.obj b\.obj touching \d+\nparts=3 crossing=0\n", text)
    (tmp_path / "d.obj").write_text("v 0.5 0.5 -1\nv 0.5 0.6 -1\nv 0.5 0.5 2\nf 1 2 3\n")
    code, text = run(EXAMPLES / "clash_check.py", tmp_path)
    assert code == 1 and "a.obj d.obj crossing" in text
    (tmp_path / "e.obj").write_text("v 0 0 0\nf 1 2 3\n")
    code, text = run(EXAMPLES / "clash_check.py", tmp_path)
    assert code == 3 and f"left out: {tmp_path / 'e.obj'}:2: " in text and "parts=4 crossing=1\n" in text
    assert run(EXAMPLES / "clash_check.py", tmp_path / "..")[0] == 2


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
