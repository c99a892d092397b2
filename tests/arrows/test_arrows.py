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

# Room of C++: the rooms that it may include from. <cchip/<room>/...> and <cchip/internal/<room>/...> of cpp_ref and
# <cchip/<room>/...> of sim share one list of names.
CORE = ["geometry", "wire", "grid", "mesh", "exact", "bvh", "collide"]  # each may use those before it
ROOMS = {room: set(CORE[:i]) for i, room in enumerate(CORE)}
ROOMS["mesh"] = {"geometry"}  # nothing of the hardware
ROOMS["mesh_io"] = {"geometry", "mesh"}
ROOMS["certificate"] = set(CORE)
ROOMS["reference"] = set(CORE)
ROOMS["model"] = {"geometry", "wire", "grid", "mesh", "bvh"}
ROOMS["cpu"] = set(CORE) | {"certificate"}  # the CPU's searches
ROOMS["driver"] = set(CORE) | {"certificate", "cpu"}  # what speaks to hardware; its host gives the CPU what the chip leaves
ROOMS["device"] = set(CORE) | {"cpu", "driver", "model"}  # what users open: any of the three by its name
CPP_REF = set(ROOMS)
ROOMS["cchip.hpp"] = CPP_REF  # the one header for users
ROOMS["sim"] = set()  # sim/harness
ROOMS["rc"] = set()  # sim/reconfig
ROOMS["waves"] = {"geometry", "wire", "sim"}
ROOMS["stimulus"] = CPP_REF - {"cpu", "driver", "device", "reference", "mesh_io"} | {"sim"}
ROOMS["models"] = ROOMS["model"] | {"model"}  # the RTL's blocks clock by clock, for tests
ROOMS["machines"] = CPP_REF | {"sim", "waves"}
ROOMS["levels"] = CPP_REF | {"sim", "rc", "stimulus", "waves", "machines"}  # sim/systemc
ROOMS["app"] = CPP_REF | {"sim", "stimulus", "waves", "machines"}
FOLDERS = {"sim/harness": "sim", "sim/reconfig": "rc", "sim/waves": "waves", "sim/stimulus": "stimulus",
           "sim/models": "models", "sim/machines": "machines", "sim/systemc": "levels", "sim/app": "app"}

# CMake target: the targets of this project that it may link, directly.
LINKS = {
    "cchip_core": set(), "cchip_mesh_io": {"core"}, "cchip_reference": {"core"}, "cchip_certificate": {"core"}, "cchip_model": {"core"},
    "cchip_device": {"certificate", "core", "model"}, "cchip_harness": {"verilated"}, "cchip_reconfig": set(), "cchip_waves": {"core"},
    "cchip_models": {"core", "model"},
    "cchip_stimulus": {"core", "model"}, "cchip_pair_vectors": {"stimulus"}, "cchip_query_vectors": {"stimulus"}, "cchip_rtl_ports": {"core", "harness"},
    "cchip_rtl_receiver": {"rtl_ports", "model"},
    "cchip_rtl_models": {"swap_models"}, "cchip_rtl": {"device", "rtl_ports", "rtl_models", "waves"}, "cchip_app": {"certificate", "device", "mesh_io", "stimulus",
                                                                               "reference", "rtl", "waves"},
    "cchip": {"app"}, "cchip_without_hardware": {"app"}, "cchip_levels_core": {"reconfig", "core", "stimulus"},
    "cchip_levels_lib": {"levels_core", "reference", "rtl", "rtl_models", "waves", "levels_models"},
    "cchip_levels": {"levels_lib"}, "cchip_table1_lib": {"reconfig"}, "cchip_table1": {"table1_lib", "stimulus"},
    "cchip_rc_bench": {"reconfig"}, "cchip_rtl_bench": {"levels_lib", "rtl", "rtl_models"}}

# Folders of rtl/: each may instantiate from those before it in its line.
RTL = [["common", "arith", "sat", "primtest", "regs", "reconfig", "dispatch", "subsystem"],
       ["common", "arith", "sat", "primtest", "regs", "reconfig", "dispatch", "chip"],
       ["common", "arith", "memory", "bvtest", "traversal", "transform", "chip"],
       ["common", "memory", "refit"]]


def files(pattern):
    names = subprocess.run(["git", "-C", ROOT, "ls-files", "-z", "--cached", "--others", "--exclude-standard"], check=True,
                           stdout=subprocess.PIPE, text=True).stdout.split("\0")
    return [name for name in sorted(names) if re.search(pattern, name) and (ROOT / name).is_file()]


def room_of(name):
    """Room of a C++ file, None if it has none."""
    found = re.match(r"cpp_ref/(?:include/cchip(?:/internal)?|src)/(?:(\w+)/|cchip\.hpp$)", name)
    if found:
        return found.group(1) or "cchip.hpp"
    return next((room for folder, room in FOLDERS.items() if name.startswith(folder + "/")), None)


class Arrows(unittest.TestCase):
    def test_every_file_has_a_room(self):
        homeless = [name for name in files(r"^(cpp_ref|sim)/.*\.(cpp|hpp)$") if room_of(name) not in ROOMS]
        self.assertEqual(homeless, [])
        self.assertEqual([folder for folder in FOLDERS if not (ROOT / folder).is_dir()], [])

    def test_includes(self):
        wrong = []
        for name in files(r"^(cpp_ref|sim)/.*\.(cpp|hpp)$"):
            room = room_of(name)
            for include in re.findall(r'^#include [<"]([^>"]+)[>"]', (ROOT / name).read_text(), re.M):
                if include.startswith("..") or "tests/" in include:
                    wrong.append(f"{name} includes {include}")
                found = re.match(r"cchip/(?:internal/)?(\w+)/", include)
                if found and found.group(1) != room and found.group(1) not in ROOMS[room]:
                    wrong.append(f"{name} includes {include}: {room} may not use {found.group(1)}")
        self.assertEqual(wrong, [])

    def test_links(self):
        wrong = []
        for name in files(r"^(cpp_ref|sim)/.*CMakeLists\.txt$"):
            for target, libraries in re.findall(r"target_link_libraries\(\s*(\w+)\s([^)]*)\)", (ROOT / name).read_text()):
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
