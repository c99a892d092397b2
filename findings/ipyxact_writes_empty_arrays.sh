#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# ipyxact 0.3.2 (PyPI): an IP-XACT component that is loaded and saved unchanged comes back with other registers.
#
# A register without `dim` gets `<dim>0</dim>`: an array of none. Of a grid, two `dim` (2 and 3), the first alone is left: 2
# registers for 6. A memory map that leaves addressUnitBits to its standard value, 8, gets 0, and a reset without a mask, which
# means all bits, gets mask 0, which means none. The API cannot tell those from the numbers of a file: it shows 0 for absent.
# Nothing is raised or warned of.
# Seen: "before: dim 2 3, unit -, mask -" and "after: dim 0 2, unit 0, mask 0 0".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ipyxact==0.3.2
cd "$folder"
cat > probe.py << 'END'
import xml.etree.ElementTree as xml

from ipyxact.ipyxact import Component

SPACE = "http://www.accellera.org/XMLSchema/IPXACT/1685-2014"
FIELD = """<ipxact:size>32</ipxact:size><ipxact:field><ipxact:name>all</ipxact:name><ipxact:bitOffset>0</ipxact:bitOffset>
<ipxact:resets><ipxact:reset><ipxact:value>7</ipxact:value></ipxact:reset></ipxact:resets>
<ipxact:bitWidth>32</ipxact:bitWidth></ipxact:field>"""
TEXT = f"""<?xml version="1.0"?><ipxact:component xmlns:ipxact="{SPACE}"><ipxact:vendor>example.org</ipxact:vendor>
<ipxact:library>test</ipxact:library><ipxact:name>part</ipxact:name><ipxact:version>1</ipxact:version>
<ipxact:memoryMaps><ipxact:memoryMap><ipxact:name>map</ipxact:name><ipxact:addressBlock><ipxact:name>block</ipxact:name>
<ipxact:baseAddress>0</ipxact:baseAddress><ipxact:range>64</ipxact:range><ipxact:width>32</ipxact:width>
<ipxact:register><ipxact:name>one</ipxact:name><ipxact:addressOffset>0</ipxact:addressOffset>{FIELD}</ipxact:register>
<ipxact:register><ipxact:name>grid</ipxact:name><ipxact:dim>2</ipxact:dim><ipxact:dim>3</ipxact:dim>
<ipxact:addressOffset>16</ipxact:addressOffset>{FIELD}</ipxact:register>
</ipxact:addressBlock></ipxact:memoryMap></ipxact:memoryMaps></ipxact:component>"""


def show(when, name):
    tree = xml.parse(name)
    found = [" ".join(item.text for item in tree.iter(f"{{{SPACE}}}{tag}")) or "-" for tag in ("dim", "addressUnitBits", "mask")]
    print(f"{when}: dim {found[0]}, unit {found[1]}, mask {found[2]}")


with open("in.xml", "w") as out:
    out.write(TEXT)
component = Component()
component.load("in.xml")
component.write("out.xml")
show("before", "in.xml")
show("after", "out.xml")
END
venv/bin/python probe.py | tee seen
diff seen - << 'END'
before: dim 2 3, unit -, mask -
after: dim 0 2, unit 0, mask 0 0
END
