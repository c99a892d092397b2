#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/asic.py: reading of libraries, netlists and reports; the multiplier leaf through the whole flow; the leaf of
rtl/cchip_asic.f beside the portable one.

Wires: the reports of place and route, without these tools. Leaf needs yosys, sta and the default library, else it ends
with exit code 77 and says what is missing.
Environment: IVERILOG, YOSYS, VERILATOR, CCHIP_SEED."""
import collections
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]
import asic  # noqa: E402
import datasheet  # noqa: E402
from tools import run, tool  # noqa: E402

CELLS = {
    "INVp5": ("1", {"A": 0.5}, "!A", ""), "INV_1": ("1", {"A": 1.0}, "(!A)", ""),
    "INV_2": ("1.5", {"A": 2.0}, "A'", ""),
    "BUF_2": ("2", {"A": 1.0}, "A", ""), "AND2_1": ("2", {"A": 1.0, "B": 1.0}, "(A B)", ""),
    "NAND2_1": ("1.25", {"A": 1.0, "B": 1.25}, "(!A) | (!B)", ""), "NAND2_2": ("3", {"A": 2.0, "B": 2.0}, "!(A&B)", ""),
    "TIE": ("1", {"A": 1.0}, "", ""), "DFF_1": ("6", {"D": 1.0, "CLK": 1.0}, "IQ",
                                                'ff (IQ, IQN) { clocked_on : "CLK"; next_state : "D"; }'),
}


def liberty(time="1ns", load='1, "pf"'):
    text = (f"library (small) {{\n  time_unit : \"{time}\";\n  capacitive_load_unit ({load});\n  "
            "slew_lower_threshold_pct_rise : 20;\n")
    for name, (area, inputs, function, more) in CELLS.items():
        text += f'  cell ("{name}") {{\n    area : {area};\n    pg_pin (VDD) {{ direction : input; }}\n    {more}\n'
        text += "".join(f"    pin ({pin}) {{ direction : input; capacitance : {c}; }}\n" for pin, c in inputs.items())
        text += f'    pin ("Y") {{ direction : "output"; function : "{function}"; }}\n  }}\n'
    return text + "}\n"


NETLIST = r"""module top(clk, a, y);
  input [3:0] a;
  wire [3:0] a;
  output [1:0] y;
  wire [1:0] y;
  wire [2:1] \u_x.v[0] ;
  INV_1 _1_ (
    .A(a[0]),
    .Y(y[0])
  );
  DFF_1 \u_x.q[1]$_DFF_P_  (
    .CLK(clk)
  );
  mem_16x8_abc \u_f.mem  (
    .RD_CLK(clk)
  );
  \$paramod\cchip_mul18\SIGNED=s32'0 u_m (
    .clk(clk)
  );
  \$paramod\cchip_mul18\SIGNED=s32'0  \u_n.u  (
    .clk(clk)
  );
  assign { y[1], \u_x.v[0] [1] } = { 1'h0, a[3] };
  assign \u_x.v[0]  = a[1:0];
endmodule

module \$paramod\cchip_mul18\SIGNED=s32'0 (clk);
  DFF_1 \p[0]$_DFF_P_  (
    .CLK(clk)
  );
  NAND2_1 _2_ (
    .A(clk)
  );
endmodule
"""

PATH = r"""Startpoint: u_a.gen_x[0].u_mul/b_q[0]$_DFF_P_
            (rising edge-triggered flip-flop clocked by clk)
Endpoint: u_a.sum_q2[31]$_DFF_P_
          (rising edge-triggered flip-flop clocked by clk)
     Delay       Time   Description
   0.00000    0.00000 ^ u_a.gen_x[0].u_mul/b_q[0]$_DFF_P_/CLK (DFF_1)
   0.18391    0.18391 v u_a.gen_x[0].u_mul/b_q[0]$_DFF_P_/Q (DFF_1)
   0.15350    0.33741 v u_a.gen_x[0].u_mul/_2097_/Y (INV_1)
   0.00000    0.33741 ^ u_a.sum_q2[31]$_DFF_P_/D (DFF_1)
             35.32319   slack (MET)
"""

POWER = """Group                    Internal    Switching      Leakage        Total
Sequential           7.0e-02 4.0e-03 1.0e-06 7.4e-02  32.2%
Total                1.5e-01 6.0e-02 7.0e-06 2.1e-01 100.0%
                            74.1%        25.9%         0.0%
"""


class Reading(unittest.TestCase):
    def test_functions_in_every_notation(self):
        nand = [True, True, True, False]
        for function in ("!(A&B)", "(!(A B))", "(!A) | (!B)", "!A+!B", "!(A * B)"):
            self.assertEqual(asic.truth(function, ["A", "B"]), nand, function)
        self.assertEqual(asic.truth("(A^B)", ["A", "B"]), [False, True, True, False])
        self.assertEqual(asic.truth("(A ^ !B)", ["A", "B"]), [True, False, False, True])
        self.assertIsNone(asic.truth("IQ", ["A", "B"]))

    def test_library(self):
        lib = asic.Library(liberty())
        self.assertEqual((lib.name, lib.ns, lib.pf), ("small", 1, 1))
        self.assertEqual((lib.nand2, lib.buffer), ("NAND2_1", "BUF_2"))
        self.assertEqual({name for name, cell in lib.cells.items() if cell.register}, {"DFF_1"})
        self.assertEqual(lib.cells["NAND2_1"].area, 1.25)
        self.assertEqual(lib.cells["NAND2_1"].inputs, {"A": 1.0, "B": 1.25})
        other = asic.Library(liberty("1ps", "1,ff"))
        self.assertAlmostEqual(other.ns, 1e-3)
        self.assertAlmostEqual(other.pf, 1e-3)

    def test_the_unit_inverter_is_the_one_of_strength_1(self):
        self.assertEqual(asic.Library(liberty()).inverter, "INV_1")

    def test_a_part_of_a_library_is_a_library(self):
        part = asic.Library(liberty()).only({"INV_1", "DFF_1", "BUF_2", "NAND2_1"})
        self.assertEqual(set(asic.Library(part).cells), {"INV_1", "DFF_1", "BUF_2", "NAND2_1"})
        self.assertEqual(part.count("{"), part.count("}"))

    def test_assignments_bit_by_bit_and_plain_names(self):
        text, names = asic.plain(NETLIST)
        assigned = [line.strip() for line in text.splitlines() if "assign" in line]
        # a blank ends an escaped name: without it another net is meant
        self.assertEqual(assigned, ["assign y[1] = 1'b0;", r"assign \u_x.v[0] [1] = a[3];",
                                    r"assign \u_x.v[0] [2] = a[1];", r"assign \u_x.v[0] [1] = a[0];"])
        self.assertEqual(names, {r"$paramod\cchip_mul18\SIGNED=s32'0": "cchip_mul18__0"})
        self.assertNotIn("$paramod", text)
        self.assertEqual(asic.bits("10'h2a1", {}), [f"1'b{bit}" for bit in "1010100001"])
        self.assertEqual(asic.bits("4'd5", {}), ["1'b0", "1'b1", "1'b0", "1'b1"])
        self.assertEqual(asic.bits("3'b1x0", {}), ["1'b1", "1'b0", "1'b0"])

    def test_totals_go_down_into_modules(self):
        inside = asic.modules(asic.plain(NETLIST)[0])
        box = {"module": "top", "words": 16, "bits": 128}
        sums = asic.totals(inside, "top", asic.Library(liberty()), [box, {**box, "words": 512, "bits": 4096}])
        self.assertEqual(sums, {"um2": 1 + 6 + 2 * (6 + 1.25), "ff": 3, "leaves": 2, "small": 128, "sram": 4096})

    def test_a_cell_that_the_library_does_not_have_is_an_error(self):
        with self.assertRaisesRegex(asic.fpga.ToolError, "NOR7 in top"):
            asic.totals({"top": collections.Counter({"NOR7": 1})}, "top", asic.Library(liberty()), [])

    def test_memories(self):
        cell = {"type": "$mem_v2", "connections": {"RD_ADDR": [2, 3], "RD_DATA": [4] * 8, "WR_CLK": [5]},
                "parameters": {"SIZE": "100", "WIDTH": 8, "RD_PORTS": "1", "WR_PORTS": "1", "RD_CLK_ENABLE": "01",
                               "INIT": "xx", "MEMID": "m"}}
        other = {**cell, "connections": {**cell["connections"], "WR_CLK": [5, 6]}}
        found = asic.memories(
            json.dumps({"modules": {"top": {"cells": {"a": cell, "b": {"type": "$add"}, "c": other}}}}))
        self.assertEqual([(m["cell"], m["words"], m["width"], m["bits"], m["clocked"]) for m in found],
                         [("a", 4, 8, 32, True), ("c", 4, 8, 32, True)])
        self.assertNotEqual(found[0]["kind"], found[1]["kind"])  # other ports are another cell
        self.assertTrue(found[0]["kind"].startswith("mem_4x8_"))

    def test_library_of_boxes(self):
        ports = {"RD_CLK": 1, "RD_EN": 1, "RD_ADDR": 9, "RD_DATA": 8, "WR_CLK": 1, "WR_EN": 8, "WR_ADDR": 9,
                 "WR_DATA": 8}
        box = {"words": 512, "bits": 4096, "clocked": True, "ports": ports}
        text = asic.box_library(asic.Library(liberty()), 0.1, {"mem_a": box, "mem_b": {**box, "clocked": False}})
        self.assertEqual(text.count("{"), text.count("}"))
        cells = dict(re.findall(r"^cell \((\w+)\) \{(.*?)^\}", text, re.M | re.S))
        self.assertIn('values("1.40000")', cells["mem_a"])  # 14 FO4 from its clock
        self.assertIn('values("0.80000")', cells["mem_b"])  # 8 from its address
        self.assertNotIn("RD_CLK", cells["mem_b"])
        self.assertIn("slew_lower_threshold_pct_rise : 20;", text)

    def test_slowest_path(self):
        self.assertEqual(asic.path_of(PATH), ("u_a.gen_x[0].u_mul/b_q", "u_a.sum_q2", 35.32319, 3))
        with self.assertRaises(asic.fpga.ToolError):
            asic.path_of("No paths found.\n")

    def test_power(self):
        clocked, leakage = asic.power_of(POWER)
        self.assertAlmostEqual(clocked, 0.21)
        self.assertAlmostEqual(leakage, 7e-6)

    def test_tables_and_last_line(self):
        row = {"um2": 3308194.0, "nand2": 137841, "ff": 9288, "leaves": 24, "small_bits": 22297, "sram_bits": 0,
               "ns": 4.349,
               "fo4": 43.8, "mhz": 229.9, "start": "a", "end": "b", "cells": 26}
        test = {**row, "mw": {"0.1": 805.1, "0.5": 2134.0}, "mpairs": 94.0, "pj": {"0.1": 8569.0, "0.5": 22710.0}}
        found = {"tri_tri": test, "chip": row, "chip.cache": {**row, "mw": test["mw"]}}
        self.assertEqual(asic.tests_table(found).count("\n"), 2 + 1)
        self.assertEqual(asic.chip_table(found).count("\n"), 2 + 2)
        for table in (asic.tests_table(found), asic.chip_table(found)):
            self.assertEqual(len({line.count("|") for line in table.splitlines()}), 1, table)
        self.assertEqual(asic.last_line("tri_tri", test),
                         "tri_tri um2=3308194 nand2=137841 ff=9288 bits=22297 ns=4.349 fo4=43.8 "
                         "mhz=229.9 mw=805.1/2134 mpairs=94.0 pj=8569/2.271e+04")
        self.assertTrue(asic.last_line("chip", row).endswith("mhz=229.9"))

    def test_rows_of_the_page_stay_if_the_rtl_is_the_same(self):
        table = lambda *names: datasheet.table(["row", "ns"], [[f"`{name}`", 1] for name in names])
        block = f"RTL: a.\n\n{table('mul18', 'quad_quad')}"
        names = lambda text: re.findall(r"`(\w+)`", text)
        self.assertEqual(names(asic.with_others(block, "RTL: a.", table("tri_tri"))), ["mul18", "tri_tri", "quad_quad"])
        self.assertEqual(names(asic.with_others(block, "RTL: b.", table("tri_tri"))), ["tri_tri"])
        self.assertEqual(names(asic.with_others(block, "RTL: a.", table("mul18"))), ["mul18", "quad_quad"])

    def test_page_has_a_place_for_every_table(self):
        text = asic.PAGE.read_text()
        for name in asic.TABLES:
            self.assertTrue(re.search(datasheet.BLOCK.format(f" osu018_stdcells {name}"), text, re.S), name)

    def test_every_row_is_a_module(self):
        for row in asic.rows().values():
            for top in (row.top, *row.blocks):
                self.assertTrue(list(ROOT.glob(f"rtl/*/{top}.v")), top)


LEF = """LAYER cc
  TYPE	CUT ;
END cc
LAYER metal1
  TYPE		ROUTING ;
  WIDTH		0.5 ;
  CAPACITANCE	CPERSQDIST 4e-05 ;
  EDGECAPACITANCE 8e-05 ;
END metal1
LAYER metal2
  TYPE		ROUTING ;
  WIDTH		1 ;
  CAPACITANCE	CPERSQDIST 2e-05 ;
  EDGECAPACITANCE 6e-05 ;
END metal2
"""

DEF = """UNITS DISTANCE MICRONS 100 ;
DIEAREA ( -320 -300 ) ( 680 1700 ) ;
NETS 2 ;
- n1
  ( INV_1_1 A )
  ( PIN a )
+ ROUTED metal1 ( 100 200 ) ( 300 * ) M2_M1
  NEW metal2 ( 300 200 ) ( * 700 0 ) ( * 900 ) M2_M1
;
- n2
+ ROUTED metal2 ( 0 0 ) M2_M1 ;
END NETS
SPECIALNETS 1 ;
- n1
+ ROUTED metal1 40 ( 12305 23700 ) ( 12370 * )
;
END SPECIALNETS
"""

DELAYS = "n1 1 PIN/a 3 ( 2 0.004 ( 1 0.002 INV_1_1/A , ( 3 0.002 INV_2_7/A ) ) , ( 0.5 0 PIN/y ) ) "


class Wires(unittest.TestCase):
    """What --wires reads of graywolf's and qrouter's files."""

    def test_length_of_wires_and_die(self):
        area, lengths = asic.wires_of(DEF)
        self.assertEqual(area, 10 * 20)
        self.assertEqual(lengths, {"n1": {"metal1": 2.0, "metal2": 7.0}, "n2": {}})

    def test_capacitance_counts_both_edges(self):
        metal = asic.layers(LEF)
        self.assertEqual(metal, {"metal1": (0.5, 4e-5, 8e-5), "metal2": (1, 2e-5, 6e-5)})
        self.assertAlmostEqual(asic.capacitance({"metal1": 2, "metal2": 7}, metal), 2 * 18e-5 + 7 * 14e-5)

    def test_tree_of_a_net(self):
        self.assertEqual(asic.tree_of(DELAYS), ("n1", "PIN/a", [
            (2, 0.004, -1, []), (1, 0.002, 0, ["INV_1_1/A"]), (3, 0.002, 1, ["INV_2_7/A"]), (0.5, 0, 0, ["PIN/y"])]))
        for wrong in (DELAYS.replace(" 3 (", " 4 ("), DELAYS.replace("n1 1", "n1 2"), DELAYS.rstrip(" )")):
            with self.assertRaises(asic.fpga.ToolError, msg=wrong):
                asic.tree_of(wrong)

    def test_parasitics_have_the_wanted_capacitance(self):
        for total, want in ((None, 0.008), ({"n1": 0.1}, 0.1)):
            text = asic.spef([asic.tree_of(DELAYS)], total)
            self.assertIn(f"*D_NET n1 {want:g}\n", text)
            caps = re.search(r"\*CAP\n(.*?)\*RES", text, re.S)[1]
            self.assertAlmostEqual(sum(float(line.split()[2]) for line in caps.splitlines()), want)
            ohms = re.search(r"\*RES\n(.*?)\*END", text, re.S)[1]
            self.assertIn("1 a n1:0 2\n", ohms)
            self.assertIn(" n1:2 INV_2_7:A 0.001\n", ohms)
            self.assertEqual(re.findall(r"^\*[PI] (.*)", text, re.M), ["a I", "INV_1_1:A I", "INV_2_7:A I", "y O"])
            self.assertIn("*C_UNIT 1 PF", text)

    def test_what_stopped_a_tool(self):
        log = "Nets remaining: 200\nNets remaining: 30\n"
        self.assertEqual(asic.stopped(log, 30.0, 30), "not done after 30 minutes, 30 nets to go")
        self.assertEqual(asic.stopped("", 30.0, 30), "not done after 30 minutes")
        passes = "Yale University\n  0 \n  1   2  15 \n 16  17 "
        self.assertEqual(asic.stopped(passes, 30.0, 30), "not done after 30 minutes, in pass 17 of 150")
        self.assertEqual(asic.stopped(log, 3.0, 30), "")  # another fault: an error
        self.assertEqual(asic.stopped(log, 30.0, None), "")

    def test_unrouted_nets(self):
        log = "Progress: Stage 1\nFailed net routes: 17\n"
        self.assertEqual(asic.unrouted(log), 17)
        self.assertEqual(asic.unrouted(f"{log}Final: No failed routes!\n"), 0)
        with self.assertRaises(asic.fpga.ToolError):
            asic.unrouted("Nets remaining: 3\n")

    def test_a_stop_is_kept_for_the_same_limit_or_less(self):
        with tempfile.TemporaryDirectory(dir=ROOT / "build") as folder, \
                unittest.mock.patch.object(asic, "BUILD", pathlib.Path(folder)):
            fails = {"command": ["false"], "files": {"a": "b"}, "depends": [], "product": "c", "tool": "qrouter"}
            for _ in range(2):  # the second time from what was kept
                with self.assertRaisesRegex(asic.Stopped, "qrouter: not done after 0 minutes"):
                    asic.measured("x", **fails, limit=1e-6)
                fails["command"] = ["no such program"]
            fails["command"] = ["false"]
            with self.assertRaises(asic.fpga.ToolError):  # a larger limit tries again
                asic.measured("x", **fails, limit=3)

    def test_a_missing_tool_is_named(self):
        with unittest.mock.patch.dict(os.environ, PATH="/nowhere"), self.assertRaises(SystemExit) as caught:
            asic.package.__wrapped__("graywolf")
        self.assertEqual(str(caught.exception), "asic.py: no graywolf of qflow; run: scripts/bootstrap --dev")

    def test_lines_and_table(self):
        done = {"cells": 2184, "gates_um2": 81625, "die_um2": 90112.0, "wire_mm": 77.97, "unrouted": 0, "nets": 2221,
                "mhz": 233.74, "wires_mhz": 216.26, "qrouter_mhz": 222.6, "place_minutes": 0.3, "route_minutes": 0.44}
        found = {"mul18": done, "axis": {"cells": 16300, "gates_um2": 677776, "stopped": "graywolf: not done"}}
        self.assertEqual(asic.wires_line("mul18", done), "mul18 cells=2184 die_um2=90112 wire_mm=78.0 mhz=233.7 "
                         "wires_mhz=216.3 unrouted=0 minutes=0.7")
        self.assertEqual(asic.wires_line("axis", found["axis"]), "axis cells=16300 stopped: graywolf: not done")
        table = asic.wires_table(found)
        self.assertEqual(len({line.count("|") for line in table.splitlines()}), 1, table)
        self.assertIn("| 91 % | 78 | 35 | 234 | 216 | 223 | -7 % |", table)
        self.assertTrue(re.search(datasheet.BLOCK.format(" osu018_stdcells wires"), asic.PAGE.read_text(), re.S))


BENCH = """
module bench;
  reg clk = 0;
  reg [17:0] a, b, a1, b1;
  reg [35:0] want;
  wire [35:0] p;
  integer n, wrong = 0;
  cchip_mul18 dut (.clk(clk), .a(a), .b(b), .p(p));
  initial begin
    for (n = 0; n < 2000; n = n + 1) begin
      a = n % 7 == 0 ? 18'h20000 : $random;
      b = n % 5 == 0 ? 18'h20000 : $random;
      want = $signed(a) * $signed(b);
      repeat (2) begin #50 clk = 1; #50 clk = 0; end
      if (p !== want) wrong = wrong + 1;
    end
    $display("wrong %0d of %0d", wrong, n);
  end
endmodule
"""


class Leaf(unittest.TestCase):
    def test_netlist_multiplies_and_has_a_clock(self):
        asic.BUILD = ROOT / "build" / f"asic-test.{os.getpid()}"
        self.addCleanup(shutil.rmtree, asic.BUILD)
        row = asic.rows()["mul18"]
        figures = asic.analyse(row, asic.LIBERTY, 0, row.top, row.name)
        self.assertEqual(figures["ff"], 18 + 18 + 36)
        self.assertLess(figures["start"], figures["end"])  # a_q or b_q to p
        self.assertTrue(30 < figures["fo4"] < 60, figures)
        self.assertTrue(2000 < figures["nand2"] < 5000, figures)
        self.assertLess(figures["mw"]["0.1"], figures["mw"]["0.5"])
        folder, _ = asic.mapped(row, asic.LIBERTY)
        blif, cells = asic.flat(row, asic.LIBERTY)  # for place and route
        self.assertEqual(cells, asic.instances((folder / "netlist.v").read_text()).total())
        self.assertEqual(blif.count("CLK=clk"), figures["ff"])
        (folder / "bench.v").write_text(BENCH)
        models = pathlib.Path(asic.LIBERTY).with_suffix(".v")
        self.assertEqual(run(tool("iverilog"), "-g2005", "-s", "bench", "-o", folder / "bench.vvp", folder / "bench.v",
                             folder / "netlist.v", models)[0], 0)
        self.assertIn("wrong 0 of 2000", run("vvp", "-n", folder / "bench.vvp")[1])


class Products(unittest.TestCase):
    """The leaf for standard cells against the portable one: the same bench, the same products."""

    LEAVES = {"portable": ["arith/cchip_mul18.v"], "asic": ["vendor/asic/cchip_mul18.v"]}
    CASES = {("portable", 2): 20000, ("asic", 3): 20000, ("asic", 2): 20000, ("asic", 4): 20000}  # random products

    def elaborate(self, leaf, latency, signed, output):
        return run(tool("iverilog"), "-g2005", "-Wall", "-I", ROOT / "rtl/include", f"-DCCHIP_MUL18_LATENCY={latency}",
                   f"-DBENCH_SIGNED={signed}", "-s", "bench_mul18", "-o", output, ROOT / "tests/asic/bench_mul18.v",
                   *(ROOT / "rtl" / name for name in self.LEAVES[leaf]))

    def test_both_leaves_multiply_alike(self):
        seed = int(os.environ.get("CCHIP_SEED", "1"))
        print(f"CCHIP_SEED={seed}")
        with tempfile.TemporaryDirectory() as folder:
            for signed in (1, 0):
                for (leaf, latency), products in self.CASES.items():
                    with self.subTest(leaf=leaf, latency=latency, signed=signed):
                        program = pathlib.Path(folder) / "bench.vvp"
                        self.assertEqual(self.elaborate(leaf, latency, signed, program), (0, ""))
                        code, text = run("vvp", "-n", program, f"+products={products}", f"+seed={seed}")
                        self.assertEqual((code, text),
                                         (0, f"PASS products={products + 12 * 12 - latency} latency={latency}\n"))

    def test_bench_sees_another_latency_and_another_sign(self):
        with tempfile.TemporaryDirectory() as folder:
            program = pathlib.Path(folder) / "bench.vvp"
            text = (ROOT / "rtl/vendor/asic/cchip_mul18.v").read_text()
            for right, wrong in (("STAGES >= 3", "STAGES >= 4"), ("i == 0 || i == 17", "i == 17"),
                                 ("18'h1ffff :", "18'h3ffff :")):
                with self.subTest(wrong=wrong):
                    changed = pathlib.Path(folder) / "cchip_mul18.v"
                    changed.write_text(text.replace(right, wrong))
                    self.assertNotEqual(changed.read_text(), text)
                    with unittest.mock.patch.dict(self.LEAVES, asic=[changed]):
                        self.assertEqual(self.elaborate("asic", 3, 1, program), (0, ""))
                    self.assertIn("FAIL", run("vvp", "-n", program)[1])

    def test_other_latencies_and_signs_are_refused(self):
        for latency, signed, name in ((1, 1, "for_standard_cells_has_CCHIP_MUL18_LATENCY_2_to_4"),
                                      (3, 2, "SIGNED_must_be_0_or_1"),
                                      (5, 1, "for_standard_cells_has_CCHIP_MUL18_LATENCY_2_to_4")):
            with self.subTest(latency=latency, signed=signed):
                code, text = self.elaborate("asic", latency, signed, os.devnull)
                self.assertNotEqual(code, 0)
                self.assertIn(f"cchip_error_mul18_{name}", text)

    def test_tools_accept_the_leaf(self):
        files = [ROOT / "rtl" / name for name in self.LEAVES["asic"]]
        for latency in (2, 3, 4):
            macro = f"-DCCHIP_MUL18_LATENCY={latency}"
            for signed in (0, 1):
                with self.subTest(latency=latency, signed=signed):
                    self.assertEqual(run(tool("verilator"), "--lint-only", "-Wall", f"-I{ROOT}/rtl/include", macro,
                                         ROOT / "rtl/lint/verilator_waiver.vlt", f"-GSIGNED={signed}", "--top-module",
                                         "cchip_mul18", *files), (0, ""))
                    self.assertEqual(run(tool("yosys"), "-q", "-p",
                                         f"read_verilog -DSYNTHESIS {macro} -I{ROOT}/rtl/include "
                                         f"{' '.join(map(str, files))}; hierarchy -check -top cchip_mul18 -chparam "
                                         f"SIGNED {signed}; "
                                         "proc; check -assert; select -assert-none t:$dlatch"), (0, ""))


if __name__ == "__main__":
    missing = [name for name in ("yosys", "sta") if not shutil.which(name)]
    missing += [] if os.path.exists(asic.LIBERTY) else [asic.LIBERTY]
    if sys.argv[1:] == ["Leaf"] and missing:
        print(f"skipped: no {', '.join(missing)}; scripts/bootstrap --dev installs them")
        sys.exit(77)
    unittest.main()
