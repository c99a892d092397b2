#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Every list of RTL files from rtl/cchip.f: rtl/cchip_DEVICE.f for each folder rtl/vendor/DEVICE, whose files take the
place of those of the same name, and the file sets of collisionchip.core.

usage: gen_lists.py [--check]     --check writes nothing; exit code 1 if a list is stale"""
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from generated import ROOT, finish  # noqa: E402

RTL = ROOT / "rtl"
CORE = ROOT / "collisionchip.core"
FIRST_LINE, *NAMES = (RTL / "cchip.f").read_text().splitlines()


def base(name):
    return name.rsplit("/", 1)[-1]


def vendor(device):
    """A device's files, those that others use first."""
    paths = {path.name: path.read_text() for path in (RTL / "vendor" / device).glob("*.v")}
    used = {name: {other for other in paths if other != name and re.search(rf"^\s*{other[:-2]}\b", text, re.M)}
            for name, text in paths.items()}
    order = []

    def add(name):
        for other in sorted(used[name]):
            add(other)
        if name not in order:
            order.append(name)

    for name in sorted(paths):
        add(name)
    return [f"vendor/{device}/{name}" for name in order]


def of_device(device):
    """The portable list with the device's files at the place of the last one that they replace."""
    own = vendor(device)
    replaced = [name for name in NAMES if base(name) in {base(other) for other in own}]
    result = []
    for name in NAMES:
        if name == replaced[-1]:
            result += own
        if name not in replaced:
            result.append(name)
    return result


def core():
    """collisionchip.core with its file sets made anew."""
    own = vendor("ecp5")
    leaves = [name for name in NAMES if base(name) in {base(other) for other in own}]
    headers = [f"      - rtl/include/{path.name}: {{is_include_file: true}}"
               for path in sorted((RTL / "include").glob("*.vh"))]
    sets = {"rtl": headers + [f"      - rtl/{name}" for name in NAMES if name not in leaves],
            "leaf": [f"      - rtl/{name}" for name in leaves], "leaf_ecp5": [f"      - rtl/{name}" for name in own]}
    text = "\n".join(f"  {name}:\n    files:\n" + "\n".join(lines) + "\n    file_type: verilogSource\n"
                     for name, lines in sets.items())
    begin, end = "  # generated: begin lists (scripts/gen_lists.py)\n", "  # generated: end\n"
    before, rest = CORE.read_text().split(begin)
    return before + begin + text + end + rest.split(end, 1)[1]


def main():
    if set(sys.argv[1:]) - {"--check"}:
        print(__doc__)
        return 0
    outputs = {f"rtl/cchip_{path.name}.f": "\n".join([FIRST_LINE, *of_device(path.name)]) + "\n"
               for path in sorted((RTL / "vendor").iterdir())}
    outputs["collisionchip.core"] = core()
    return finish(outputs, "gen_lists.py")


if __name__ == "__main__":
    sys.exit(main())
