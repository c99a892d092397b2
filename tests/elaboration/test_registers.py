#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The generated register block, header and page are up to date, gen_registers.py --check notices when they are not, and what
is no SystemRDL, or cannot be built, is refused.

usage: test_registers.py [UpToDate | Staleness | Errors]
Exit code 77, skipped, where systemrdl-compiler is missing (make venv)."""
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = "rtl/regs/cchip_subsystem.rdl"
GENERATED = ["rtl/regs/cchip_subsystem_regs.v", "cpp_ref/include/cchip/wire/registers.hpp", "docs/registers.md"]


def generate(root, *options):
    """Exit code of the generator and the lines it printed."""
    result = subprocess.run([sys.executable, root / "scripts/gen_registers.py", *options], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, text=True, timeout=60)
    return result.returncode, result.stdout.splitlines()


class UpToDate(unittest.TestCase):
    def test_generated_files_agree_with_their_source(self):
        self.assertEqual(generate(ROOT, "--check"), (0, []))


class Copy(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="cchip_registers_"))
        self.addCleanup(shutil.rmtree, self.root)
        for name in ["scripts/gen_registers.py", SOURCE]:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, self.root / name)
        (self.root / "build").mkdir()
        if (ROOT / "build/venv").exists():
            (self.root / "build/venv").symlink_to(ROOT / "build/venv")
        self.assertEqual(generate(self.root)[0], 0)

    def change(self, old, new):
        source = self.root / SOURCE
        text = source.read_text()
        self.assertIn(old, text)
        source.write_text(text.replace(old, new, 1))


class Staleness(Copy):
    def assert_stale(self, names):
        code, lines = generate(self.root, "--check")
        self.assertEqual(code, 1)
        self.assertEqual([line.split(" is stale")[0] for line in lines], names)
        generate(self.root)
        self.assertEqual(generate(self.root, "--check"), (0, []))

    def test_changed_address(self):
        self.change("@ 0x084", "@ 0x094")
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


class Errors(Copy):
    def refused(self, old, new, message):
        self.change(old, new)
        code, lines = generate(self.root)
        self.assertEqual(code, 1)
        self.assertIn(message, "\n".join(lines))

    def test_two_registers_at_one_address(self):
        self.refused("@ 0x084", "@ 0x080", "overlaps with")

    def test_overlapping_fields(self):
        self.refused("slots[7:0]", "slots[8:0]", "overlaps with")

    def test_property_that_is_not_built(self):
        self.refused("singlepulse", "swmod", "swmod is not built here")

    def test_combination(self):
        self.refused("sw = r; hw = na;", "sw = w; hw = na;", "not built here")

    def test_reset_value_too_large(self):
        self.refused("minor_number[7:0] = 0", "minor_number[7:0] = 256", "reset value")

    def test_no_reset_value(self):
        self.refused("scheduler_enable[0:0] = 0", "scheduler_enable[0:0]", "needs a reset value")

    def test_array_of_two_dimensions(self):
        self.refused("slot_status[2] @ 0x040 += 0x4", "slot_status[2][2] @ 0x040 += 0x4", "one dimension")

    def test_broken_syntax(self):
        self.refused("addrmap cchip_subsystem {", "addrmap cchip_subsystem (", "not SystemRDL")


if __name__ == "__main__":
    if generate(ROOT, "--check")[0] == 77:
        print("skipped: systemrdl-compiler is not installed (make venv)")
        sys.exit(77)
    unittest.main(verbosity=2)
