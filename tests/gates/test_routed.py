#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""routed.py writes each kind of cell as the device has it: in Icarus beside tables and additions that are computed
here.

Environment: IVERILOG, VVP = commands (default: found on PATH)."""
import pathlib
import random
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests/gates")]
import routed  # noqa: E402
from tools import run, tool  # noqa: E402


def netlist(**cells):
    """A netlist of cells (type, parameters, {pin: net})."""
    return routed.Netlist({"netnames": {},
                           "cells": {name: {"type": kind, "parameters": parameters,
                                            "connections": {pin: [net] for pin, net in pins.items()}}
                                     for name, (kind, parameters, pins) in cells.items()}})


def simulated(body):
    """What a Verilog module of this body prints."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "t.v"
        path.write_text(f"module t;\n{body}\nendmodule\n")
        code, text = run(tool("iverilog"), "-g2005", "-o", f"{folder}/t.vvp", path)
        assert code == 0, text
        code, text = run(tool("vvp"), "-n", f"{folder}/t.vvp")
        assert code == 0, text
        return text.split()


class Cells(unittest.TestCase):
    def test_tables(self):
        """LUTs of any contents, constant ones and those of fewer inputs among them, and an input that is not connected,
        which is 1."""
        draw = random.Random(1)
        tables = [0, 0xFFFF, 0xAAAA, 0x6666, 0x8000, *(draw.randrange(1 << 16) for _ in range(60))]
        body = "reg [4:0] i; wire n1 = i[0], n2 = i[1], n3 = i[2], n4 = i[3];\n"
        for at, table in enumerate(tables):
            pins = {"A": 1, "B": 2, "C": 3, "D": 4, "F": 100 + at}
            if at % 7 == 6:
                del pins["C"]
            body += "wire n%d; %s\n" % (100 + at,
                                        *netlist(a=("TRELLIS_COMB", {"INITVAL": f"{table:016b}"}, pins)).lines("n9"))
        values = ", ".join(f"n{100 + at}" for at in range(len(tables)))
        found = simulated(body + f'initial for (i = 0; i < 16; i = i + 1) begin #1 $display("%b", {{{values}}}); end')
        for i, bits in enumerate(found):
            wanted = "".join(str(table >> (i | 4 if at % 7 == 6 else i) & 1) for at, table in enumerate(tables))
            self.assertEqual(bits, wanted)

    def test_carry(self):
        """Three bits of a sum, each in a half of CCU2C: A ^ B with C and D at 1, the carry begins at B."""
        adds = {"MODE": "CCU2", "INITVAL": "0110011010101010", "CCU2_INJECT1": "NO"}
        begins = {"MODE": "CCU2", "INITVAL": "0000000000001010", "CCU2_INJECT1": "NO"}
        cells = netlist(c=("TRELLIS_COMB", begins, {"A": 7, "FCO": 20}),
                        **{f"s{i}": ("TRELLIS_COMB", adds, {"A": 1 + i, "B": 4 + i, "FCI": 20 + i, "FCO": 21 + i,
                                                            "F": 10 + i}) for i in range(3)})
        body = ("reg [7:0] i; wire n1 = i[0], n2 = i[1], n3 = i[2], n4 = i[3], n5 = i[4], n6 = i[5], n7 = i[6];\n"
                + "\n".join(cells.lines("n9")))
        found = simulated(body + '\ninitial for (i = 0; i < 128; i = i + 1) begin #1 $display("%d", {n23, n12, n11, '
                                 'n10}); end')
        self.assertEqual([int(word) for word in found], [(i & 7) + (i >> 3 & 7) + (i >> 6) for i in range(128)])

    def test_distributed_ram(self):
        """Written at an address, it is read at the same one: the pins of both ports are those of Yosys' TRELLIS_DPR16X4
        as nextpnr moves them."""
        write = {"D0": 11, "B0": 12, "C0": 13, "A0": 14, "C1": 15, "WDO0": 30, "WADO0": 31, "WADO1": 32, "WADO2": 33,
                 "WADO3": 34}
        read = {"D": 21, "B": 22, "C": 23, "A": 24, "WRE": 16, "WD": 30, "WAD0": 31, "WAD1": 32, "WAD2": 33, "WAD3": 34,
                "WCK": 9, "F": 40}
        cells = netlist(w=("TRELLIS_RAMW", {}, write), r=("TRELLIS_COMB", {"MODE": "DPRAM", "INITVAL": "0" * 16}, read))
        body = ("reg clk = 0, n16 = 1, n15; reg [4:0] w, i; wire n11 = w[0], n12 = w[1], n13 = w[2], n14 = w[3], n21 = "
                "i[0], n22 = i[1], n23 = i[2], n24 = i[3];\n"
                "localparam [15:0] CONTENTS = 16'hB36A;\n"
                + "\n".join(sorted(cells.lines("n9"), key=lambda line: not line.startswith("assign"))))
        found = simulated(body + "\ninitial begin for (w = 0; w < 16; w = w + 1) begin n15 = CONTENTS[w[3:0]]; #1 clk "
                                 "= 1; #1 clk = 0; end n16 = 0; n15 = 1;\n"
                          'w = 3; #1 clk = 1; #1 clk = 0; for (i = 0; i < 16; i = i + 1) begin #1 $display("%b", n40); '
                          'end end')
        self.assertEqual(found, [str(0xB36A >> i & 1) for i in range(16)])

    def test_flip_flops(self):
        """Which input, when, and what after configuration."""
        base = {"REGSET": "SET", "SD": "0 ", "CEMUX": "INV", "LSRMUX": "LSR", "SRMODE": "LSR_OVER_CE"}
        line, = netlist(f=("TRELLIS_FF", base, {"M": 1, "DI": 2, "CE": 3, "LSR": 4, "CLK": 9, "Q": 5})).lines("n9")
        self.assertEqual(line, "reg n5 = 1'b1; always @(posedge clk) n5 <= n4 ? 1'b1 : !n3 ? n1 : n5;")
        line, = netlist(f=("TRELLIS_FF", {"REGSET": "RESET", "SD": "1 ", "CEMUX": "1 "},
                           {"DI": 2, "CLK": 9, "Q": 5})).lines("n9")
        self.assertEqual(line, "reg n5 = 1'b0; always @(posedge clk) n5 <= n2;")

    def test_what_is_connected_to_nothing_is_left_out(self):
        cells = netlist(lut=("TRELLIS_COMB", {"INITVAL": "0" * 16, "MODE": "LOGIC"}, {}),
                        ff=("TRELLIS_FF", {"CEMUX": "1"}, {}))
        self.assertEqual(list(cells.lines("n1")), [])

    def test_what_no_model_has_is_refused(self):
        for cell, message in ((("EHXPLLL", {}, {}), "no model of the cell EHXPLLL"),
                              (("TRELLIS_COMB", {"MODE": "LOGIC", "INITVAL": "0" * 16}, {"F": 1, "OFX": 2}),
                               "wide multiplexer"),
                              (("TRELLIS_FF", {"REGSET": "SET", "SD": "1 ", "CEMUX": "1 "},
                                {"DI": 2, "CLK": 8, "Q": 5}), "another clock")):
            with self.assertRaisesRegex(routed.Failure, message):
                list(netlist(x=cell).lines("n9"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
