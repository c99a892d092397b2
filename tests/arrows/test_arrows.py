#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Arrows between the rooms of the house: which folder may use which. A folder that is not in the tables, an include, a
link or an instance against the arrows fails."""
import pathlib
import re
import subprocess
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# Rooms of the library, lib/src/<room> and <cchip/internal/<room>/...>; each may use those before it. Headers for users
# are flat and use each other; any room may use them, too.
LIB = ["geometry", "mesh", "exact", "tree", "judge", "certificate", "search", "query"]
ROOMS = {room: set(LIB[:i]) for i, room in enumerate(LIB)}
ROOMS["mesh"] = {"geometry"}
ROOMS["mesh_io"] = {"geometry", "mesh"}
ROOMS["assembly"] = set(LIB) | {"mesh_io"}  # behind query
ROOMS["users"] = {"exact", "certificate"}  # of these only what headers for users bring in: tests/install/headers.py
LIBRARY = set(ROOMS)
# Of cpp_ref, what the RTL is held to and its host.
ROOMS["wire"] = {"geometry"}
ROOMS["grid"] = {"geometry", "mesh", "exact", "wire"}
ROOMS["image"] = {"geometry", "mesh", "exact", "tree", "wire"}
ROOMS["reference"] = {"geometry", "mesh", "exact", "wire", "grid"}
# no arithmetic in common with exact or reference
ROOMS["model"] = {"geometry", "mesh", "tree", "wire", "grid", "image"}
ROOMS["blocks"] = ROOMS["model"] | {"model"}  # the RTL's blocks clock by clock, for tests
# what speaks to hardware; its host gives the CPU what a chip leaves
ROOMS["driver"] = LIBRARY | {"wire", "grid", "image", "model"}
CPP_REF = {"wire", "grid", "image", "reference", "model", "driver"}
# Programs, and the simulation.
ROOMS["program"] = {"geometry"}
ROOMS["app"] = LIBRARY | {"program"}  # lib/app: cchip, without any hardware
ROOMS["sim"] = {"geometry", "program"}  # sim/harness
ROOMS["rc"] = set()  # sim/reconfig
ROOMS["waves"] = {"geometry", "wire", "sim", "program"}
ROOMS["stimulus"] = {"geometry", "mesh", "tree", "exact", "wire", "grid", "image", "model", "sim", "program"}
ROOMS["machines"] = LIBRARY | CPP_REF | {"sim", "waves", "program"}
ROOMS["levels"] = LIBRARY | CPP_REF | {"sim", "rc", "stimulus", "waves", "machines", "program"}  # sim/systemc
ROOMS["commands"] = LIBRARY | CPP_REF | {"sim", "stimulus", "waves", "machines", "program", "app"}
FOLDERS = {"lib/program": "program", "lib/app": "app", "cpp_ref/blocks": "blocks", "sim/harness": "sim",
           "sim/reconfig": "rc", "sim/waves": "waves", "sim/stimulus": "stimulus", "sim/machines": "machines",
           "sim/systemc": "levels", "sim/commands": "commands"}

# CMake target: the targets of this project that it may link, directly.
LINKS = {
    "cchip_core": set(), "cchip_mesh_io": {"core"}, "cchip_certificate": {"core"},
    "cchip_device": {"certificate", "core"},
    "cchip_assembly": {"device", "mesh_io"}, "cchip_program": {"core"},
    "cchip_app": {"assembly", "certificate", "device", "mesh_io", "program"}, "cchip": {"app", "commands"},
    "cchip_without_hardware": {"app"},
    "cchip_wire": {"core"}, "cchip_reference": {"wire"}, "cchip_model": {"wire"}, "cchip_blocks": {"core", "model"},
    "cchip_driver": {"certificate", "device", "model", "wire"},
    "cchip_harness": {"verilated"}, "cchip_reconfig": set(), "cchip_waves": {"wire"},
    "cchip_stimulus": {"core", "model", "program"}, "cchip_pair_vectors": {"stimulus"},
    "cchip_query_vectors": {"stimulus"},
    "cchip_rtl_ports": {"wire", "harness"}, "cchip_rtl_receiver": {"rtl_ports", "model"},
    "cchip_rtl_models": {"swap_models"},
    "cchip_rtl": {"driver", "rtl_ports", "rtl_models", "waves"},
    "cchip_commands": {"app", "driver", "stimulus", "reference", "rtl", "waves"},
    "cchip_levels_core": {"reconfig", "core", "stimulus"},
    "cchip_levels_lib": {"levels_core", "reference", "rtl", "rtl_models", "waves", "levels_models"},
    "_core": {"certificate", "driver", "mesh_io"}, "cchip_levels": {"levels_lib"}, "cchip_table1_lib": {"reconfig"},
    "cchip_table1": {"table1_lib", "stimulus"},
    "cchip_rc_bench": {"reconfig"}, "cchip_rtl_bench": {"levels_lib", "rtl", "rtl_models"}}

# Folders of rtl/: each may instantiate from those before it in its line.
RTL = [["common", "arith", "sat", "primtest", "regs", "reconfig", "dispatch", "subsystem"],
       ["common", "arith", "sat", "primtest", "regs", "reconfig", "dispatch", "chip"],
       ["common", "arith", "memory", "bvtest", "traversal", "transform", "chip"],
       ["common", "memory", "refit"]]


def files(pattern):
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                           check=True,
                           stdout=subprocess.PIPE, text=True).stdout.split("\0")
    return [name for name in sorted(names) if re.search(pattern, name) and (ROOT / name).is_file()]


def room_of(name):
    """Room of a C++ file, None if it has none."""
    folder = next((room for folder, room in FOLDERS.items() if name.startswith(folder + "/")), None)
    if folder:
        return folder
    if re.match(r"lib/include/cchip/\w+\.hpp$", name):
        return "users"
    found = re.match(r"(?:lib|cpp_ref)/(?:include/cchip/internal|src)/(\w+)/", name) or \
        re.match(r"cpp_ref/include/cchip/(?!internal/)(\w+)/", name)
    return found.group(1) if found else None


def room_of_include(name, include):
    """Room of what a file of that name includes, None if it is not of this project or lies beside the file."""
    if re.match(r"cchip/\w+\.hpp$", include):
        return "users"
    found = re.match(r"cchip/(?:internal/)?(\w+)/", include)
    if found or "/" not in include or not re.match(r"lib/src/|cpp_ref/src/", name):
        return found.group(1) if found else None
    return include.split("/")[0] if include.split("/")[0] in ROOMS else None


class Arrows(unittest.TestCase):
    def test_every_file_has_a_room(self):
        homeless = [name for name in files(r"^(lib|cpp_ref|sim)/.*\.(cpp|hpp)$")
                    if not name.startswith("lib/python/") and room_of(name) not in ROOMS]
        self.assertEqual(homeless, [])
        self.assertEqual([folder for folder in FOLDERS if not (ROOT / folder).is_dir()], [])

    def test_includes(self):
        wrong = []
        for name in files(r"^(lib|cpp_ref|sim)/.*\.(cpp|hpp)$"):
            if name.startswith("lib/python/"):  # over everything
                continue
            room = room_of(name)
            for include in re.findall(r'^#include [<"]([^>"]+)[>"]', (ROOT / name).read_text(), re.M):
                if include.startswith("..") or "tests/" in include:
                    wrong.append(f"{name} includes {include}")
                used = room_of_include(name, include)
                if used not in (None, room) and used not in ROOMS[room] | {"users"}:
                    wrong.append(f"{name} includes {include}: {room} may not use {used}")
        self.assertEqual(wrong, [])

    def test_library_knows_no_hardware(self):
        named = [name for name in files(r"^lib/(include|src|app|program)/|^lib/CMakeLists.txt$")
                 if re.search(r"cpp_ref|cchip_(wire|model|driver)\b", (ROOT / name).read_text(errors="replace"))]
        self.assertEqual(named, [])

    def test_links(self):
        wrong = []
        for name in files(r"^(lib|cpp_ref|sim)/.*CMakeLists\.txt$"):
            for target, libraries in re.findall(r"target_link_libraries\(\s*(\w+)\s([^)]*)\)",
                                                (ROOT / name).read_text()):
                linked = set(re.findall(r"\bcchip_(\w+)", libraries)) - {"warnings"}
                if target not in LINKS:
                    wrong.append(f"{name}: {target} is not in the table of links")
                elif linked - LINKS[target]:
                    wrong.append(f"{name}: {target} may not link {', '.join(sorted(linked - LINKS[target]))}")
        self.assertEqual(wrong, [])

    def test_signals_inside_the_rtl_are_named_in_one_file(self):
        naming = [name for name in files(r"\.(cpp|hpp)$") if "rootp" in (ROOT / name).read_text()]
        self.assertEqual(naming, ["sim/machines/include/cchip/machines/probes.hpp"])

    def test_instances(self):
        folder = {pathlib.Path(name).stem: name.split("/")[1] for name in files(r"^rtl/\w+/\w+\.v$")}
        allowed = {}
        for line in RTL:
            for i, room in enumerate(line):
                allowed.setdefault(room, {room}).update(line[:i])
        wrong = []
        for name in files(r"^rtl/\w+/\w+\.v$"):
            here = name.split("/")[1]
            self.assertIn(here, allowed, f"{name}: its folder is not in the order of rtl/")
            text = re.sub(r"//.*", "", (ROOT / name).read_text())
            for module in re.findall(r"^\s*(cchip_\w+)\s+(?:#\(|u_\w+)", text, re.M):
                if module in folder and folder[module] not in allowed[here]:
                    wrong.append(f"{name} instantiates {module} of {folder[module]}")
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
