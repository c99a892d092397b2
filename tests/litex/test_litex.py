#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The LiteX core of the chip, in a system with its bus, memory and interrupt: what LiteX writes elaborates with the RTL.

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


def system(parameters):
    """A system of a bus master with no program, the chip and a memory."""
    from collisionchip import CollisionChip
    from litex.build.generic_platform import Pins
    from litex.build.io import CRG
    from litex.build.sim import SimPlatform
    from litex.soc.integration.soc import SoCRegion
    from litex.soc.integration.soc_core import SoCMini

    class System(SoCMini):
        def __init__(self, platform):
            SoCMini.__init__(self, platform, clk_freq=100e6, bus_standard="axi", bus_data_width=128,
                             bus_address_width=64, cpu_type=None, ident="chip")
            self.chip = CollisionChip(platform, **parameters)
            self.bus.add_slave("chip", self.chip.bus, SoCRegion(origin=0x9000_0000, size=0x1000, cached=False))
            self.bus.add_master("chip", self.chip.memory)
            self.add_ram("memory", origin=0x4000_0000, size=0x10000)
            self.comb += platform.request("irq").eq(self.chip.ev.irq)

    platform = SimPlatform("SIM", [("sys_clk", 0, Pins(1)), ("sys_rst", 0, Pins(1)), ("irq", 0, Pins(1))])
    made = System(platform)
    made.crg = CRG(platform.request("sys_clk"), platform.request("sys_rst"))
    return platform, made


class Elaboration(unittest.TestCase):
    def check(self, **parameters):
        platform, made = system(parameters)
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
            code, log = run(tool("verilator"), "--lint-only", "-Wno-fatal", *includes, *sources, path, "--top-module", "system")
            self.assertEqual(code, 0, log)
            self.assertNotRegex(log, "port connection|Parameter not found|%Error")

    def test_default(self):
        self.check()

    def test_parameters(self):
        self.check(QUERIES=8, MISSES=16)


if __name__ == "__main__":
    if not list(ROOT.glob("build/venv/lib/python3*/site-packages/litex/__init__.py")):
        print("skipped: no LiteX in build/venv; run: make venv")
        sys.exit(77)
    if pathlib.Path(sys.prefix) != ROOT / "build/venv":
        os.execv(PYTHON, [str(PYTHON), "-B", *sys.argv])
    unittest.main(verbosity=2)
