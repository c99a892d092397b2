#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A C program on a soft processor asks the chip one query, in a LiteX system that Verilator simulates: it prints the
answer of the model.

Runs in the Python of build/venv (make venv); without LiteX, VexRiscv or a C compiler for RISC-V ends with code 77
(skipped)."""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = ROOT / "build/venv/bin/python"
VECTORS = ROOT / "tests/fusesoc"  # of cchip_query_vectors; test_fusesoc.py compares them with the model


class Query(unittest.TestCase):
    def test_answer_is_that_of_the_model(self):
        done = int((VECTORS / "records_chip.hex").read_text().split()[-1], 16)
        flags, pairs = done >> 32 & 0xFFFFFFFF, done >> 96
        self.assertEqual(flags & 1, 1)
        with tempfile.TemporaryDirectory() as folder:
            result = subprocess.run([PYTHON, "-B", ROOT / "scripts/litex/query_soc.py",
                                     VECTORS / "memory_chip.hex", folder],
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(result.returncode, 0, result.stdout)
        self.assertRegex(result.stdout, re.compile(
            rf"^answer {flags >> 1 & 3:02x} code {flags >> 8 & 255:02x} pairs {pairs:02x}\nclocks \d+\n\Z", re.M))


if __name__ == "__main__":
    if any(not list(ROOT.glob(f"build/venv/lib/python3*/site-packages/{name}/__init__.py"))
           for name in ("litex", "pythondata_cpu_vexriscv")):
        print("skipped: no LiteX or no VexRiscv in build/venv; run: make venv")
        sys.exit(77)
    if not shutil.which(os.environ.get("RISCV_GCC", "riscv64-unknown-elf-gcc")):
        print("skipped: no C compiler for RISC-V; install Debian's gcc-riscv64-unknown-elf")
        sys.exit(77)
    unittest.main(verbosity=2)
