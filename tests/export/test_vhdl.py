#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The VHDL packages of the tops: GHDL analyses each, and an entity that instantiates it, as VHDL-93 and VHDL-2008.

Environment: GHDL = command (default: found on PATH). Exit code 77 without GHDL."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "scripts")]
import datasheet  # noqa: E402
import export  # noqa: E402
import vhdl  # noqa: E402
from tools import run, tool  # noqa: E402

TOPS = [*export.KINDS, export.BLANK, export.CHIP, export.CDC]


def user(top, generics=""):
    """An entity with the ports of a component, as they are with its defaults, which instantiates it."""
    text = vhdl.package(top)
    values = dict(re.findall(r"^      (\w+) : integer := (-?\d+)", text, re.M))
    ports = re.search(r"^    port \(\n(.*?)^    \);", text, re.M | re.S)[1]
    names = re.findall(r"^      (\w+) :", ports, re.M)
    for name, value in values.items():
        ports = re.sub(rf"\b{name}\b", value, ports)
    maps = ",\n".join(f"    {name} => {name}" for name in names)
    return (f"library ieee;\nuse ieee.std_logic_1164.all;\nuse work.{top}_package.all;\n"
            f"entity user is port (\n{ports}); end entity;\narchitecture a of user is\n"
            f"begin\n  u_top : {top}{generics} port map (\n{maps});\n"
            "  assert CCHIP_RM_TRI_TRI = 1 and CCHIP_BITSTREAM_SYNC = x\"AA995566\" and cchip_clog2(33) = 6\n"
            "    report \"constants\" severity failure;\nend architecture;\n")


class Vhdl(unittest.TestCase):
    def ghdl(self, standard, *sources):
        with tempfile.TemporaryDirectory() as folder:
            for i, text in enumerate(sources):
                pathlib.Path(folder, f"{i}.vhd").write_text(text)
                code, said = run(tool("ghdl"), "-a", f"--std={standard}", f"{i}.vhd", cwd=folder)
                if code or said:
                    return said or "failed"
            # binds nothing, but elaborates ranges, port maps and the assertion
            code, said = run(tool("ghdl"), "--elab-run", f"--std={standard}", "--warn-no-binding", "user",
                             "--stop-time=1ns", cwd=folder)
            return said + ("failed" if code else "")

    def test_ghdl_takes_every_top(self):
        for top in TOPS:
            for standard in ("93", "08"):
                with self.subTest(top=top, standard=standard):
                    self.assertEqual(self.ghdl(standard, vhdl.package(top), user(top)), "")

    def test_a_wrong_width_is_seen(self):
        for standard in ("93", "08"):
            said = self.ghdl(standard, vhdl.package(export.CHIP), user(export.CHIP, " generic map (DATA_W => 256)"))
            self.assertIn("failed", said)

    def test_every_port_and_parameter_is_there(self):
        for top in TOPS:
            text = vhdl.package(top)
            parameters, ports = datasheet.declared(top)
            for name in [*(row[0] for row in parameters), *(row[2] for row in ports)]:
                self.assertRegex(text, rf"(?m)^      {name} : ")

    def test_numbers(self):
        self.assertEqual(vhdl.number((1 << 31) - 1), ("integer", "2147483647"))
        self.assertEqual(vhdl.number(0xAA995566), ("std_logic_vector(31 downto 0)", 'x"AA995566"'))
        self.assertEqual(vhdl.number(1 << 40), ("std_logic_vector(43 downto 0)", 'x"10000000000"'))
        with self.assertRaises(vhdl.VhdlError):
            vhdl.number(-(1 << 40))

    def test_command(self):
        call = [sys.executable, "-B", str(ROOT / "scripts/vhdl.py")]
        result = subprocess.run([*call, export.CHIP], stdout=subprocess.PIPE, text=True)
        self.assertEqual((result.returncode, result.stdout), (0, vhdl.package(export.CHIP)))
        self.assertEqual(subprocess.run([*call, "nothing"], stderr=subprocess.DEVNULL).returncode, 2)


if __name__ == "__main__":
    if not shutil.which(tool("ghdl")):
        print("test_vhdl.py: ghdl is not installed: apt-get install ghdl")
        sys.exit(77)
    sys.exit(unittest.main(verbosity=2))
