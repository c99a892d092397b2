#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""run.py --carry: which changes of the RTL's text are changes of what a proof reads.

usage: test_carry.py      needs yosys; exit codes: 0 passed, 1 failed, 77 skipped"""
import pathlib
import shutil
import sys
import tempfile
import unittest

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import run  # noqa: E402

FIFO = "rtl/common/cchip_fifo.v"


class Carry(unittest.TestCase):
    """A tree whose FIFO has another text."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        for part in ("rtl", "tests/formal"):
            shutil.copytree(run.ROOT / part, self.root / part)
        self.text = (self.root / FIFO).read_text()

    def is_same(self, text):
        (self.root / FIFO).write_text(text)
        self.assertNotEqual(run.sources("cchip_fifo", self.root), run.sources("cchip_fifo"))
        netlists = [run.netlist("cchip_fifo", "prove", root) for root in (run.ROOT, self.root)]
        self.assertIsNotNone(netlists[0])
        return netlists[0] == netlists[1]

    def replaced(self, old, new):
        self.assertEqual(self.text.count(old), 1, old)
        return self.text.replace(old, new)

    def test_text(self):
        """Lines more, a declaration that nobody reads: the same netlist."""
        self.assertTrue(self.is_same(self.replaced("  localparam [31:0] TWO = 2;\n",
                                                   "\n\n  localparam [31:0] TWO = 1 + 1;\n  localparam integer UNREAD "
                                                   "= 3;\n")))

    def test_logic(self):
        for old, new in (("  localparam [31:0] TWO = 2;\n", "  localparam [31:0] TWO = 3;\n"),):
            self.assertFalse(self.is_same(self.replaced(old, new)))

    def test_refused(self):
        """What Yosys does not read is no netlist, so no row is taken over."""
        (self.root / FIFO).write_text(self.replaced("endmodule", ""))
        self.assertIsNone(run.netlist("cchip_fifo", "prove", self.root))

    def test_tags(self):
        """Lines of a task, of its group, of all."""
        text = ("[tasks]\na\nb group\n\n[options]\nmode: x\na: depth 3\ngroup: depth 4\n\n[script]\nb: one\ntwo\n\n"
                "[files]\n")
        self.assertEqual(run.of_task(text, "options", "a"), ["mode: x", "depth 3"])
        self.assertEqual(run.of_task(text, "options", "b"), ["mode: x", "depth 4"])
        self.assertEqual(run.of_task(text, "script", "b"), ["one", "two"])


if __name__ == "__main__":
    if not shutil.which("yosys"):
        print("skipped: no yosys")
        sys.exit(77)
    unittest.main()
