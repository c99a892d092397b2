#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The LiteX core of the chip, in a system with its bus, memory and interrupt: what LiteX writes elaborates with the
RTL. Its registers behind LiteX's converter from a bus of 128 bit, in Verilator: a write to any of the four words of a
line arrives and is answered, words that are no register leave the others readable.

Runs in the Python of build/venv, where `make venv` installs LiteX; without it ends with code 77 (skipped).
Environment: VERILATOR = command (default: found on PATH)."""
import os
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = ROOT / "build/venv/bin/python"
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "scripts/litex")]
from tools import run, tool  # noqa: E402


def system(parameters, standard="axi", width=128):
    """A system of a bus master with no program, the chip and a memory."""
    from collisionchip import CollisionChip
    from litex.build.generic_platform import Pins
    from litex.build.io import CRG
    from litex.build.sim import SimPlatform
    from litex.soc.integration.soc_core import SoCMini

    class System(SoCMini):
        def __init__(self, platform):
            SoCMini.__init__(self, platform, clk_freq=100e6, bus_standard=standard, bus_data_width=width,
                             bus_address_width=64 if standard == "axi" else 32, cpu_type=None, ident="chip")
            self.chip = CollisionChip(platform, **parameters)
            self.chip.add_to(self, origin=0x9000_0000)
            self.add_ram("memory", origin=0x4000_0000, size=0x10000)
            self.comb += platform.request("irq").eq(self.chip.ev.irq)

    platform = SimPlatform("SIM", [("sys_clk", 0, Pins(1)), ("sys_rst", 0, Pins(1)), ("irq", 0, Pins(1))])
    made = System(platform)
    made.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
    return platform, made


# fields and their widths
CHANNELS = {"aw": {"addr": 32}, "w": {"data": 128, "strb": 16}, "b": {}, "ar": {"addr": 32},
            "r": {"data": 128, "resp": 2}}


def registers():
    """The chip with LiteX's converter, whose side of 128 bit is at the pins `wide`."""
    from collisionchip import CollisionChip
    from litex.build.generic_platform import Pins, Subsignal
    from litex.build.io import CRG
    from litex.build.sim import SimPlatform
    from litex.gen import LiteXModule
    from litex.soc.interconnect.axi import AXILiteConverter, AXILiteInterface

    fields = {channel: {**widths, "valid": 1, "ready": 1} for channel, widths in CHANNELS.items()}
    platform = SimPlatform("SIM", [("sys_clk", 0, Pins(1)), ("sys_rst", 0, Pins(1)),
                                   ("wide", 0, *(Subsignal(f"{channel}_{field}", Pins(width))
                                                 for channel, widths in fields.items()
                                                 for field, width in widths.items()))])
    made = LiteXModule()
    made.chip = CollisionChip(platform)
    wide = AXILiteInterface(data_width=128, address_width=32)
    made.converter = AXILiteConverter(wide, made.chip.bus)
    pins = platform.request("wide")
    for channel, widths in fields.items():
        for field in widths:
            pin, signal = getattr(pins, f"{channel}_{field}"), getattr(getattr(wide, channel), field)
            made.comb += pin.eq(signal) if (field == "ready") == (channel in ("aw", "w", "ar")) else signal.eq(pin)
    made.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
    return platform, made


# Writes each word of the line of record_base_low alone, reads the line. Then that of invalidate_first, whose last word
# is no register.
REGISTERS_BENCH = """`default_nettype none
module bench;
  reg clk = 0, rst = 1, write = 0, read = 0;
  reg [31:0] address = 0;
  reg [15:0] strb = 0;
  wire aw_ready, w_ready, b_valid, ar_ready, r_valid;
  wire [1:0] r_resp;
  wire [127:0] r_data;
  registers dut (
      .sys_clk(clk), .sys_rst(rst), .wide_aw_valid(write), .wide_aw_ready(aw_ready), .wide_aw_addr(address),
      .wide_w_valid(write),
      .wide_w_ready(w_ready), .wide_w_data({32'h3, 32'h5, 32'h12, 32'h34567000}), .wide_w_strb(strb),
      .wide_b_valid(b_valid), .wide_b_ready(1'b1),
      .wide_ar_valid(read), .wide_ar_ready(ar_ready), .wide_ar_addr(address),
      .wide_r_valid(r_valid), .wide_r_ready(1'b1), .wide_r_data(r_data),
      .wide_r_resp(r_resp)
  );
  always #5 clk = !clk;
  task write_word(input integer word);
    begin
      strb = 16'hF << 4 * word;
      write = 1;
      while (!(aw_ready && w_ready)) @(negedge clk);  // LiteX's converter takes both at once
      @(posedge clk) #1 write = 0;
      while (!b_valid) @(negedge clk);
      $display("word %0d", word);
      repeat (2) @(negedge clk);
    end
  endtask
  task read_line;
    begin
      read = 1;
      while (!ar_ready) @(negedge clk);
      @(posedge clk) #1 read = 0;
      while (!r_valid) @(negedge clk);
      $display("line %h response %0d", r_data, r_resp);
      repeat (2) @(negedge clk);
    end
  endtask
  initial begin
    repeat (8) @(negedge clk);
    rst = 0;
    address = 32'h060;
    write_word(0);
    write_word(1);
    write_word(2);
    write_word(3);
    read_line;
    address = 32'h0A0;
    write_word(0);
    write_word(1);
    read_line;
    $finish;
  end
  initial begin
    repeat (500) @(posedge clk);
    $display("no answer");
    $finish;
  end
endmodule
"""


class Registers(unittest.TestCase):
    def test_words_of_a_wide_bus(self):
        platform, made = registers()
        text = platform.get_verilog(made, name="registers").main_source
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            (folder / "registers.v").write_text(text)
            (folder / "bench.v").write_text(REGISTERS_BENCH)
            # of the chip its registers alone: the whole takes a minute to compile
            top = re.search(r"(?s)^module cchip_chip .*?^\);\n", (ROOT / "rtl/chip/cchip_chip.v").read_text(), re.M)[0]
            ports = ["clk", "rst", *re.findall(r"^    (?:in|out)put +wire .*\b(s_axil_\w+)", top, re.M)]
            connections = ", ".join(f".{port}({port})" for port in ports)
            (folder / "chip.v").write_text(f'`include "cchip_defs.vh"\n{top}  cchip_chip_regs u_regs ({connections});\n'
                                           'endmodule\n')
            code, log = run(tool("verilator"), "--cc", "--exe", "--main", "--timing", "-Wno-fatal", "-Wno-lint",
                            "-Wno-style",
                            f"-I{ROOT}/rtl/include", "--top-module", "bench", "--Mdir", folder / "obj",
                            *(folder / f"{name}.v" for name in ("bench", "registers", "chip")),
                            ROOT / "rtl/regs/cchip_chip_regs.v")
            self.assertEqual(code, 0, log)
            code, log = run("make", "-C", folder / "obj", "-f", "Vbench.mk", "OPT_FAST=-O0", "OPT_SLOW=-O0",
                            "OPT_GLOBAL=-O0", "CFG_CXXFLAGS_COROUTINES=-fcoroutines")
            self.assertEqual(code, 0, log)
            code, log = run(folder / "obj/Vbench")
        self.assertEqual(code, 0, log)
        self.assertEqual([line for line in log.splitlines() if not line.startswith("- ")],
                         [*(f"word {i}" for i in range(4)), "line 00000003000000050000001234567000 response 0",
                          "word 0", "word 1", "line 00000000000000000000001234567000 response 0"])


class Elaboration(unittest.TestCase):
    def check(self, standard="axi", **parameters):
        platform, made = system(parameters, standard)
        text = platform.get_verilog(made, name="system").main_source
        instance = re.search(r"^cchip_chip .*?^\);", text, re.M | re.S)[0]
        connected = set(re.findall(r"\.(\w+)\s*\(", instance))
        inputs = re.findall(r"(?m)^    input +wire +(?:\[.*?\])? *(\w+)", (ROOT / "rtl/chip/cchip_chip.v").read_text())
        self.assertEqual(set(inputs) - connected, set())
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "system.v"
            path.write_text(text)
            sources = [source[0] for source in platform.sources]
            self.assertEqual(len(sources), len(set(sources)))
            includes = [f"-I{name}" for name in platform.verilog_include_paths]
            # outputs are left open on purpose, and other style of LiteX's own Verilog is not ours
            code, log = run(tool("verilator"), "--lint-only", "-Wno-fatal", *includes, *sources, path,
                            "--top-module", "system")
            self.assertEqual(code, 0, log)
            self.assertNotRegex(log, "port connection|Parameter not found|%Error")

    def test_default(self):
        self.check()

    def test_parameters(self):
        self.check(QUERIES=8, MISSES=16)

    def test_other_buses(self):
        for standard in ("wishbone", "axi-lite"):
            with self.subTest(standard=standard):
                self.check(standard)

    def test_bus_on_which_records_arrive_in_parts(self):
        for standard in ("axi", "axi-lite", "wishbone"):
            for width in (32, 64):
                said = rf"^chip: the SoC's bus \({standard}\) has {width} bit, .*bus_data_width=128$"
                with self.subTest(standard=standard, width=width), self.assertRaisesRegex(ValueError, said):
                    system({}, standard, width)


if __name__ == "__main__":
    if not list(ROOT.glob("build/venv/lib/python3*/site-packages/litex/__init__.py")):
        print("skipped: no LiteX in build/venv; run: make venv")
        sys.exit(77)
    if pathlib.Path(sys.prefix) != ROOT / "build/venv":
        os.execv(PYTHON, [str(PYTHON), "-B", *sys.argv])
    unittest.main(verbosity=2)
