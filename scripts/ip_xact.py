#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the IP-XACT component (IEEE 1685-2014) of the exported chip: buses, registers, ports, parameters, files.

usage: ip_xact.py FOLDER        FOLDER: what export.py wrote, with cchip_chip.v; FOLDER/cchip_chip.xml is written

Registers come from rtl/regs by systemrdl-compiler and PeakRDL-ipxact, all else from the ports and parameters of the
Verilog. `make venv` installs both packages; without them the exit code is 77."""
import os
import pathlib
import re
import sys
import xml.etree.ElementTree as xml

import datasheet
import interfaces

ROOT = pathlib.Path(__file__).resolve().parent.parent
try:
    import systemrdl
    from peakrdl_ipxact.exporter import IPXACTExporter, Standard
except ImportError:
    python = ROOT / "build/venv/bin/python"
    if list((ROOT / "build/venv").glob(
        "lib/python3*/site-packages/peakrdl_ipxact/__init__.py")) and sys.executable != str(python):
        os.execv(python, [python, *sys.argv])
    print("ip_xact.py: PeakRDL-ipxact is not installed: make venv")
    sys.exit(77)

TOP = "cchip_chip"
NAMESPACE = "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"
# IP-XACT bus definitions of ARM; what a master reaches, log2 of bytes
AMBA = {"AXI4": "AXI4", "AXI4LITE": "AXI4-Lite"}
REACH = {"m_axi": 38, "m_axi_cfg": 32}


def element(tag, *content, **attributes):
    """Element with text or children; what is None is left out."""
    made = xml.Element(f"{{{NAMESPACE}}}{tag}", attributes)
    for part in content:
        if isinstance(part, xml.Element):
            made.append(part)
        elif part is not None:
            made.text = str(part)
    return made


def parameters(text):
    """[(name, value, meaning)]; macros become their numbers."""
    result = []
    for name, value, meaning in datasheet.head(text, TOP)[0]:
        if value.startswith("`"):
            value = re.search(rf"^`define {value[1:]} (\d+)", text, re.M)[1]
        result.append((name, int(value), meaning))
    return result


def bus_interface(bus, names):
    """A bus with the names of AXI for its ports; its clock is among them."""
    mode, protocol = interfaces.BUSES[bus]
    mapped = [(signal, name) for name in names for owner, signal in [interfaces.member(name)] if owner == bus]
    maps = [element("portMap", element("logicalPort", element("name", logical)),
                    element("physicalPort", element("name", physical)))
            for logical, physical in [("ACLK", "clk"), *mapped]]
    vlnv = {"vendor": "amba.com", "library": "AMBA4", "version": "r0p0_0"}
    reference = (element("memoryMapRef", memoryMapRef=bus) if mode == "slave"
                 else element("addressSpaceRef", addressSpaceRef=bus))
    return element(
        "busInterface", element("name", bus), element("busType", name=AMBA[protocol], **vlnv),
        element("abstractionTypes", element("abstractionType",
                                            element("abstractionRef", name=f"{AMBA[protocol]}_rtl", **vlnv),
                                            element("portMaps", *maps))),
        element(mode, reference))


def port(name, direction, left):
    vector = element("vectors", element("vector", element("left", left), element("right", 0))) if left else None
    return element("port", element("name", name), element("wire", element("direction", direction[:-3]), vector))


def component(folder):
    text = (folder / f"{TOP}.v").read_text()
    ports, values = interfaces.ports(text, TOP), parameters(text)
    names = [name for name, _, _ in ports]
    compiler, path = systemrdl.RDLCompiler(), folder / f"{TOP}.xml"
    compiler.compile_file(str(ROOT / "rtl" / "regs" / f"{TOP}.rdl"))
    version = re.search(r"project\(collisionchip VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
    xml.register_namespace("ipxact", NAMESPACE)
    IPXACTExporter(standard=Standard.IEEE_1685_2014, vendor="collisionchip", library="ip", version=version).export(
        compiler.elaborate().top, str(path), component_name=TOP)
    # the registers are ours: the whole 4 KiB that the bus decodes, under the name of the bus
    whole = xml.parse(path).getroot()
    memory = whole.find(f"{{{NAMESPACE}}}memoryMaps")
    for tag, value in ((".//{*}memoryMap/{*}name", "s_axil"), (".//{*}addressBlock/{*}name", "registers"),
                       (".//{*}addressBlock/{*}range", "'h1000")):
        memory.find(tag).text = value
    # IEEE 1685 orders the children
    at = list(whole).index(memory)
    buses = interfaces.buses(names)
    spaces = [element("addressSpace", element("name", bus), element("range", f"'h{1 << REACH[bus]:x}"),
                      element("width", 64 if REACH[bus] > 32 else 32))
              for bus in buses if interfaces.BUSES[bus][0] == "master"]
    whole.insert(at, element("busInterfaces", *(bus_interface(bus, names) for bus in buses)))
    whole.insert(at + 1, element("addressSpaces", *spaces))
    whole.append(element(
        "model",
        element("views", element("view", element("name", "rtl"), element("envIdentifier", "verilogSource::"),
                                 element("componentInstantiationRef", "verilog"))),
        element("instantiations", element(
            "componentInstantiation", element("name", "verilog"), element("language", "Verilog"),
            element("moduleName", TOP),
            element("moduleParameters",
                    *(element("moduleParameter", element("name", name), element("value", name), dataType="integer")
                      for name, _, _ in values)),
            element("fileSetRef", element("localName", "rtl")))),
        element("ports", *(port(*one) for one in ports))))
    whole.append(element("fileSets", element("fileSet", element("name", "rtl"), element(
        "file", element("name", f"{TOP}.v"), element("fileType", "verilogSource-2001")))))
    whole.append(element("description", "Collision detection as a device"))
    whole.append(element("parameters", *(
        element("parameter", element("name", name), element("description", meaning), element("value", value),
                parameterId=name,
                resolve="user", type="longint") for name, value, meaning in values)))
    for one in whole.iter():
        one.tail = None if one.tail is None or not one.tail.strip() else one.tail
        one.text = one.text if one.text and one.text.strip() else None
    xml.indent(whole)
    body = xml.tostring(whole, encoding="unicode")
    path.write_text('<?xml version="1.0" encoding="UTF-8"?>\n<!-- SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1 '
                    '-->\n'
                    f"<!-- Written by scripts/ip_xact.py. Do not edit. -->\n{body}\n")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print(__doc__)
        sys.exit(2)
    component(pathlib.Path(sys.argv[1]))
