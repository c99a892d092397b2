# SPDX-License-Identifier: Apache-2.0
"""A generator of committed files in a copy of its own: what makes its files stale is noticed, and mended by a run."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]


class GeneratorCopy(unittest.TestCase):
    """Derived classes name the generator, its source, other files that it reads, and the files that it writes."""
    generator = ""
    source = ""
    more = []
    generated = []

    @classmethod
    def generate(cls, root, *options):
        """Exit code of the generator and the lines it printed."""
        result = subprocess.run([sys.executable, root / cls.generator, *options], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, timeout=60)
        return result.returncode, result.stdout.splitlines()

    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="cchip_generator_"))
        self.addCleanup(shutil.rmtree, self.root)
        for name in [self.generator, "scripts/generated.py", self.source, *self.more]:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "build").mkdir()
        if (ROOT / "build/venv").exists():
            (self.root / "build/venv").symlink_to(ROOT / "build/venv")
        self.assertEqual(self.generate(self.root)[0], 0)
        self.assertEqual(self.generate(self.root, "--check"), (0, []))

    def change(self, old, new, name=None):
        source = self.root / (name or self.source)
        text = source.read_text()
        self.assertIn(old, text)
        source.write_text(text.replace(old, new, 1))

    def assert_stale(self, names):
        code, lines = self.generate(self.root, "--check")
        self.assertEqual(code, 1)
        self.assertEqual([line.split(" is stale")[0] for line in lines], names)
        self.generate(self.root)
        self.assertEqual(self.generate(self.root, "--check"), (0, []))


class StalenessTests:
    """Tests of every generator; to be mixed into a GeneratorCopy."""

    def test_committed_files_agree_with_their_source(self):
        self.assertEqual(self.generate(ROOT, "--check"), (0, []))

    def test_edited_by_hand(self):
        for name in self.generated:
            with self.subTest(name):
                with open(self.root / name, "a", encoding="utf-8") as file:
                    file.write("\n")
                self.assert_stale([name])

    def test_missing_file(self):
        for name in self.generated:
            with self.subTest(name):
                (self.root / name).unlink()
                self.assert_stale([name])
