#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/bitstream.py: known files, what it refuses, its exit codes."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "scripts" / "bitstream.py"
# The start of a .bin of Vivado, as UG470 lists it: dummy words, sync word, two NOOPs.
RAW = bytes.fromhex("FFFFFFFF" "AA995566" "20000000" "20000000")
# Written out by the contract of cchip_bitstream_header: word 0 is 0x43434250, word 1 module and slot << 8, word 2 the
# length, word 3 the CRC-32, each with its lowest byte first. make_bitstream() of C++ made the same 16 bytes.
HEADER = bytes.fromhex("50424343" "01020000" "10000000" "1D1464E6")


def crc(data):
    """As cchip_crc32 does it, a bit at a time."""
    value = 0xFFFFFFFF
    for byte in data:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ (0xEDB88320 if value & 1 else 0)
    return value ^ 0xFFFFFFFF


class Bitstream(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.raw, self.out = (pathlib.Path(folder.name) / name for name in ("raw.bin", "out.cchip"))

    def call(self, *arguments):
        result = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, arguments)], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True)
        return result.returncode, result.stdout

    def make(self, raw, *more):
        self.raw.write_bytes(raw)
        return self.call("make", self.raw, "--slot", 2, "--module", 1, "-o", self.out, *more)

    def refuse(self, data, text, *more):
        self.out.write_bytes(data)
        code, said = self.call("check", self.out, *more)
        self.assertEqual((code, said.count("\n")), (1, 1), said)
        self.assertIn(text, said)

    def test_known_file(self):
        self.assertEqual(crc(b"123456789"), 0xCBF43926)
        self.assertEqual(HEADER[12:], crc(RAW).to_bytes(4, "little"))
        code, said = self.make(RAW)
        self.assertEqual(code, 0, said)
        self.assertEqual(self.out.read_bytes(), HEADER + RAW)
        self.assertEqual(said, f"slot=2 module=1 (tri_tri) length=16 crc=0x{crc(RAW):08x}\n")
        self.assertEqual(self.call("check", self.out, "--slot", 2, "--module", 1), (0, said))

    def test_whole_words(self):
        for port, zeros in ((8, 0), (32, 3)):
            self.assertEqual(self.make(RAW + b"\7", "--port", port)[0], 0)
            self.assertEqual(self.out.read_bytes()[16:], RAW + b"\7" + bytes(zeros))

    def test_raw_files_that_are_refused(self):
        swap = bytes(int(f"{byte:08b}"[::-1], 2) for byte in RAW)
        turn = b"".join(RAW[i:i + 4][::-1] for i in range(0, 16, 4))
        for raw, text in ((swap, "bits of each byte swapped"), (turn, "bytes of each word in reverse"),
                          (bytes(2000), "no sync word"), (RAW[:8], "16 at least"), (RAW[1:] + b"0", "at byte 3"),
                          (bytes.fromhex("00090FF0") + RAW, "a .bit file"), (HEADER + RAW, "has the header already")):
            with self.subTest(text):
                code, said = self.make(raw)
                self.assertEqual((code, said.count("\n")), (1, 1), said)
                self.assertIn(text, said)
                self.assertFalse(self.out.exists())
        self.assertEqual(self.make(bytes(2000), "--vendor", "none")[0], 0)

    def test_files_that_a_swap_would_refuse(self):
        good = HEADER + RAW
        self.refuse(good[:15], "MAGIC")
        for at, text in ((0, "MAGIC"), (6, "MAGIC"), (5, "SLOT"), (4, "MODULE"), (8, "LENGTH"), (12, "CRC"),
                         (20, "CRC")):
            self.refuse(good[:at] + bytes([good[at] ^ 0x10]) + good[at + 1:], text)
        self.refuse(good + b"0000", "LENGTH")
        self.refuse(good, "SLOT", "--slot", 0)
        self.refuse(good, "MODULE", "--module", 3)

    def test_arguments(self):
        self.raw.write_bytes(RAW)
        for arguments in ((), ("make", self.raw), ("check", self.raw, "--slot", 4), ("check", self.raw, "--port", 16)):
            self.assertEqual(self.call(*arguments)[0], 2)
        self.assertEqual(self.call("check", self.out)[0], 1)
        self.assertEqual(self.call("--help")[0], 0)


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
