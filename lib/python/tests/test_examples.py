# SPDX-License-Identifier: Apache-2.0
"""The examples run, and docs/cpp/python.md shows them as they are."""
import contextlib
import io
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).parents[3]
EXAMPLES = ROOT / "lib/python/examples"


def run(*command):
    done = subprocess.run([sys.executable, *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, timeout=60)
    return done.returncode, done.stdout


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
