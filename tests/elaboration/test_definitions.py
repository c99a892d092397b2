#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The generated definitions are up to date, and gen_definitions.py --check notices when they are not.

usage: test_definitions.py [UpToDate | Staleness]"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
GENERATED = ["rtl/include/cchip_defs.vh", "cpp_ref/include/cchip/wire/definitions.hpp", "docs/definitions.md"]


def generate(root, *options):
    """Exit code of the generator and the lines it printed."""
    result = subprocess.run([sys.executable, root / "scripts/gen_definitions.py", *options], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, timeout=60)
    return result.returncode, result.stdout.splitlines()


class UpToDate(unittest.TestCase):
    def test_generated_files_agree_with_their_source(self):
        self.assertEqual(generate(ROOT, "--check"), (0, []))


class Staleness(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="cchip_definitions_"))
        self.addCleanup(shutil.rmtree, self.root)
        for name in ["scripts/gen_definitions.py", "scripts/definitions.json"]:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        self.assertEqual(generate(self.root)[0], 0)
        self.assertEqual(generate(self.root, "--check"), (0, []))

    def assert_stale(self, names):
        code, lines = generate(self.root, "--check")
        self.assertEqual(code, 1)
        self.assertEqual([line.split(" is stale")[0] for line in lines], names)
        generate(self.root)
        self.assertEqual(generate(self.root, "--check"), (0, []))

    def test_changed_constant(self):
        source = self.root / "scripts/definitions.json"
        data = json.loads(source.read_text())
        data["constants"][0]["value"] += 1
        source.write_text(json.dumps(data))
        self.assert_stale(GENERATED)

    def test_changed_formula(self):
        source = self.root / "scripts/definitions.json"
        data = json.loads(source.read_text())
        data["functions"][0]["expr"] += " + 1"
        source.write_text(json.dumps(data))
        self.assert_stale(GENERATED)

    def test_edited_by_hand(self):
        for name in GENERATED:
            with self.subTest(name):
                with open(self.root / name, "a", encoding="utf-8") as file:
                    file.write("\n")
                self.assert_stale([name])

    def test_missing_file(self):
        for name in GENERATED:
            with self.subTest(name):
                (self.root / name).unlink()
                self.assert_stale([name])


if __name__ == "__main__":
    unittest.main(verbosity=2)
