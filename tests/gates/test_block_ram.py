#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The leaf rtl/vendor/ecp5/cchip_block_ram.v does what the portable one does, with the cells that it should take.

usage: test_block_ram.py Shapes|Netlists|Changes

Shapes: those of the chip and the corners of the leaf, random accesses in Icarus on the model DP16KD.v. Netlists: what
Yosys makes of some of them, its cells counted and run with the same accesses. Changes: a leaf made wrong is reported.
CCHIP_SEED chooses the accesses (default 1). Environment: IVERILOG, YOSYS = commands (default: found on PATH)."""
import os
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/gates")]
import gates  # noqa: E402
from tools import run, tool  # noqa: E402

PORTABLE = ROOT / "rtl/common/cchip_block_ram.v"
LEAF = ROOT / "rtl/vendor/ecp5/cchip_block_ram.v"
BLOCK = ROOT / "rtl/vendor/ecp5/cchip_dp16kd.v"
BENCH = gates.HERE / "bench_block_ram.v"
MODEL = gates.HERE / "DP16KD.v"
SEED = int(os.environ.get("CCHIP_SEED") or 1) % 2**31

# WIDTH, WORDS, ADDR_W: blocks; none in distributed RAM, or where memory is left to inference
SHAPES = {
    # the chip with default parameters
    (128, 1, 5): 4,  # cchip_cache_fill
    (30, 1, 10): 2,  # cchip_cache: entries
    (107, 4, 6): 12,  # cchip_bv_feed
    (10, 1, 4): 0,
    (97, 4, 6): 11,  # cchip_bv_pose
    (171, 1, 4): 0,
    (36, 1, 4): 0,
    (15, 1, 4): 0,
    (512, 1, 6): 15,  # cchip_get_data
    (141, 1, 10): 8,  # cchip_traversal: stack
    (96, 1, 10): 6,  # cchip_chip_core: operands
    (64, 1, 8): 2,  # cchip_calc_result: faces
    (22, 1, 8): 1,  # cchip_descriptor_queues
    # the subsystem
    (22, 1, 9): 1,
    (96, 4, 11): 11,  # cchip_operand_memory
    # corners of the leaf
    (1, 1, 3): 0,
    (1, 1, 5): 1,
    (1, 4, 3): 1,
    (10, 4, 4): 2,
    (36, 1, 9): 1,
    (37, 1, 9): 2,
    (18, 1, 10): 1,
    (19, 1, 10): 2,
    # left to inference
    (5, 1, 11): 0,
    (5, 4, 12): 0,
}
# shape: cells of the netlist
NETLISTS = {
    (10, 1, 4): {"TRELLIS_DPR16X4": 3},
    (36, 1, 4): {"TRELLIS_DPR16X4": 9},
    (5, 1, 3): {"TRELLIS_DPR16X4": 2},
    (40, 1, 9): {"DP16KD": 2},
    (10, 4, 6): {"DP16KD": 2},
}
# a file, what is changed in it, and a shape in which that shows
CHANGES = [
    ("halves swapped", LEAF, "found[36*b+:36] = q;", "found[36*b+:36] = {q[17:0], q[35:18]};", (36, 1, 9)),
    ("lowest byte not enabled", LEAF, "5'b01111", "5'b01110", (64, 1, 8)),
    ("highest byte not enabled", LEAF, "5'b01111", "5'b00111", (36, 1, 8)),
    ("third word not enabled", LEAF, "5'b01111", "5'b01011", (9, 4, 6)),
    ("upper byte of two not enabled", LEAF, "4'b0011", "4'b0001", (18, 1, 10)),
    ("words in reverse", LEAF, "d[BITS*w+:BITS]", "d[BITS*(WORDS-1-w)+:BITS]", (9, 4, 6)),
    ("blocks in reverse", LEAF, "BITS*w+BITS*b+:", "BITS*w+BITS*(BLOCKS-1-b)+:", (72, 1, 6)),
    ("other word read", LEAF, "read_addr, {14 - FITS{1'b0}}", "read_addr ^ 1'b1, {14 - FITS{1'b0}}", (36, 1, 6)),
    ("port A for port B", LEAF, "= q[18+:BITS];", "= q[0+:BITS];", (18, 1, 10)),
    ("block without output registers", BLOCK, '"OUTREG"', '"NOREG"', (36, 1, 6)),
    ("LUTs read a clock earlier", LEAF, "mem[read_addr_q]", "mem[read_addr]", (36, 1, 4)),
    ("LUTs lose an address bit", LEAF, "read_addr_q <= read_addr;", "read_addr_q <= read_addr & 4'd7;", (36, 1, 4)),
    ("LUTs always written", LEAF, "if (write) mem[write_addr] <= write_data;\n      always",
     "mem[write_addr] <= write_data;\n      always", (36, 1, 4)),
]


def clocks(shape):
    """Fewer for wide words, which Icarus takes long for."""
    width, words, _ = shape
    return 1000 if words * width > 256 else 3000


def bench(folder, shape, sources, *options):
    """What the bench prints of a leaf with its models."""
    portable = folder / "portable_block_ram.v"
    portable.write_text(PORTABLE.read_text().replace("module cchip_block_ram", "module portable_block_ram"))
    program = folder / "bench.vvp"
    parameters = (f"-Pbench_block_ram.{name}={value}" for name, value in zip(("WIDTH", "WORDS", "ADDR_W"), shape))
    code, text = run(tool("iverilog"), "-g2005", f"-I{ROOT}/rtl/include", *options, *parameters, "-s",
                     "bench_block_ram", "-o", program, BENCH,
                     portable, *sources)
    return text if code else run("vvp", "-n", program, f"+seed={SEED}", f"+clocks={clocks(shape)}")[1]


class Case(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def assert_passes(self, shape, *arguments):
        text = bench(self.folder, shape, *arguments)
        passed = re.fullmatch(r"PASS compared=(\d+)\n", text)
        self.assertTrue(passed, text)
        self.assertGreater(int(passed[1]), clocks(shape) // 2)


class Shapes(Case):
    def test_reads_what_the_portable_one_reads(self):
        for shape in SHAPES:
            with self.subTest(shape=shape):
                self.assert_passes(shape, [LEAF, BLOCK, MODEL])

    def test_reads_what_four_portable_banks_read(self):
        for shape in ((1, 4, 3), (10, 4, 4), (30, 4, 6)):
            with self.subTest(shape=shape):
                self.assert_passes(shape, [LEAF, BLOCK, MODEL], "-Pbench_block_ram.MIXED_WIDTH=0")

    def test_takes_as_many_blocks_as_it_should(self):
        for shape, blocks in SHAPES.items():
            width, words, addr_w = shape
            with self.subTest(shape=shape):
                code, text = run(tool("yosys"), "-q", "-p",
                                 f"read_verilog -I{ROOT}/rtl/include {LEAF} {BLOCK}; read_verilog -lib "
                                 f"+/ecp5/cells_bb.v; hierarchy -top cchip_block_ram -chparam WIDTH {width} "
                                 f"-chparam WORDS {words} -chparam ADDR_W {addr_w}; proc; flatten; "
                                 f"select -assert-count {blocks} t:DP16KD")
                self.assertEqual(code, 0, text)


class Netlists(Case):
    def test_do_what_the_portable_one_does(self):
        ecp5 = gates.TECHNOLOGIES["ecp5"]
        ecp5.write_cells(self.folder)
        for shape, cells in NETLISTS.items():
            with self.subTest(shape=shape):
                width, words, addr_w = shape
                gates.synthesise(ecp5, self.folder, "cchip_block_ram", f"WIDTH={width} WORDS={words} ADDR_W={addr_w}")
                netlist = self.folder / "netlist.v"
                memories = re.findall(r"^  (DP16KD|TRELLIS_DPR16X4)\b", netlist.read_text(), re.M)
                self.assertEqual({name: memories.count(name) for name in memories}, cells)
                self.assert_passes(shape, [netlist, *ecp5.models(self.folder)], "-DCCHIP_BENCH_NETLIST")


class Changes(Case):
    def test_are_reported(self):
        for name, path, old, new, shape in CHANGES:
            with self.subTest(name):
                self.assert_passes(shape, [LEAF, BLOCK, MODEL])
                text = path.read_text()
                self.assertIn(old, text)
                changed = self.folder / path.name
                changed.write_text(text.replace(old, new))
                sources = [changed if file == path else file for file in (LEAF, BLOCK)]
                self.assertRegex(bench(self.folder, shape, [*sources, MODEL]), r"^FAIL clock=")


if __name__ == "__main__":
    unittest.main()
