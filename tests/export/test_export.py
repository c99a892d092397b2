#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""An exported folder alone, far from the repository: its files are clean for three tools, its README's commands work.

usage: test_export.py TOP SCRATCH

Environment: VERILATOR, IVERILOG, YOSYS = commands (default: found on PATH)."""
import json
import pathlib
import re
import shutil
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from tools import run, tool  # noqa: E402

TOP, SCRATCH = "", ""
BLANK = "cchip_primtest_blank"
SUBSYSTEM = "cchip_primtest_subsystem"
CHIP = "cchip_chip"
CDC = "cchip_chip_cdc"
# What a bench prints if all is well, and nothing else; how it names the first fault.
PASS = r"\APASS [^\n]*\n\Z"
PASS_CHIP = r"\Aquery=1 records=[1-9]\d* wrong=0 clocks=[1-9]\d*\n\Z"
FAIL = r"(?m)^FAIL "
FAIL_CHIP = (r"(?m)^CCHIP_ASSERT failed: |^clock \d+: a record that is not expected$(.*\n)*^query=1 records=\d+ "
             r"wrong=[1-9]\d* clocks=\d+$")
# Parameters of more elaborations: together they use every module below the top.
MORE = {SUBSYSTEM: ("-chparam SIMULATION 1", "-chparam SIMULATION 1 -chparam KINDS 4"),
        CHIP: ("-chparam SWAPS 1", "-chparam SWAPS 1 -chparam SIMULATION 1")}
MORE[CDC] = MORE[CHIP]


def export(top, out):
    code, text = run(sys.executable, "-B", str(ROOT / "scripts" / "export.py"), "--out", out, top, cwd=out)
    assert code == 0, text


class Export(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        pathlib.Path(SCRATCH).mkdir(parents=True, exist_ok=True)
        export(TOP, SCRATCH)
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = pathlib.Path(cls.temporary.name) / "alone"
        shutil.copytree(pathlib.Path(SCRATCH) / TOP, cls.folder)
        cls.file = f"{TOP}.v"
        cls.passes = PASS_CHIP if TOP == CHIP else PASS
        cls.verilator = (tool("verilator"), "--lint-only", "-Wall", "--top-module", TOP)
        cls.icarus = (tool("iverilog"), "-g2005", "-Wall", "-t", "null", "-s", TOP)

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def clean(self, *command):
        """The command succeeds and says nothing."""
        self.assertEqual(run(*command, cwd=self.folder), (0, ""), " ".join(command))

    def sections(self, name):
        """Text of an exported Verilog file by the source it comes from."""
        parts = re.split(r"^// ---- (\S+)$", (self.folder / name).read_text(), flags=re.M)
        return dict(zip(parts[1::2], parts[2::2]))

    def yosys(self, file, *more):
        checks = f"hierarchy -check -top {TOP}; proc; check -assert; select -assert-none t:$dlatch"
        self.clean(tool("yosys"), "-q", "-p", "; ".join([f"read_verilog {file}", checks, *more]))

    def test_one_file_is_self_contained(self):
        for path in self.folder.glob("*.v"):
            text = path.read_text()
            self.assertNotIn("`include", re.sub(r"//.*", "", text), path.name)
            self.assertIn("SPDX-License-Identifier: Apache-2.0", text.splitlines()[0])
        version = re.search(r"^project\(\S+ VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text(), re.M).group(1)
        self.assertIn(f"{TOP}, collisionchip {version}", (self.folder / self.file).read_text().splitlines()[1])

    def test_verilator(self):
        self.clean(*self.verilator, self.file)

    def test_icarus(self):
        self.clean(*self.icarus, self.file)

    def test_yosys(self):
        self.yosys(self.file)

    def test_interfaces_for_vivado(self):
        """What Yosys reads of the attributes: every port of a bus is in it, under the name that AXI has for it."""
        for file in self.folder.glob(f"{TOP}*.v"):
            self.clean(tool("yosys"), "-q", "-p",
                       f"read_verilog -lib +/ecp5/cells_bb.v +/ecp5/cells_sim.v; read_verilog {file.name}; "
                       f"hierarchy -check -top {TOP}; delete =*/p:*; write_json {file.stem}.json")
        # names and directions at a master, of AMBA AXI and ACE (IHI 0022), those that a read and a write need
        address, masters = {"VALID", "ADDR", "PROT"}, {}
        full = address | {"LEN", "SIZE", "BURST", "CACHE"}
        lite = {*(f"AR{s}" for s in address), *(f"AW{s}" for s in address), "WVALID", "WDATA", "WSTRB",
                "BREADY", "RREADY",
                "-ARREADY", "-AWREADY", "-WREADY", "-BVALID", "-BRESP", "-RVALID", "-RDATA", "-RRESP"}
        read = {*(f"AR{s}" for s in full), "RREADY", "-ARREADY", "-RVALID", "-RDATA", "-RRESP", "-RLAST"}
        whole = read | lite | {*(f"AW{s}" for s in full), "WLAST", "ARID", "AWID", "-RID", "-BID"}
        if TOP in (CHIP, CDC):
            masters = {"s_axil": lite, "m_axi": whole, "m_axi_cfg": read}
        elif TOP == SUBSYSTEM:
            masters = {"s_axil": lite, "m_axi": read}
        modes = {"s_axil": "PROTOCOL AXI4LITE, READ_WRITE_MODE READ_WRITE",
                 "m_axi": f"PROTOCOL AXI4, READ_WRITE_MODE READ_{'ONLY' if TOP == SUBSYSTEM else 'WRITE'}",
                 "m_axi_cfg": "PROTOCOL AXI4, READ_WRITE_MODE READ_ONLY"}
        for path in self.folder.glob(f"{TOP}*.json"):
            module = json.loads(path.read_text())["modules"][TOP]
            path.unlink()
            found, parameters = {}, {}
            for name, port in module["ports"].items():
                attributes = module["netnames"][name]["attributes"]
                if "X_INTERFACE_INFO" not in attributes:
                    continue
                vlnv, interface, signal = attributes["X_INTERFACE_INFO"].split()
                if vlnv == "xilinx.com:interface:aximm:1.0":
                    self.assertEqual(name, f"{interface}_{signal.lower()}")
                    reads = (port["direction"] == "input") != (interface == "s_axil")
                    found.setdefault(interface, set()).add(("-" if reads else "") + signal)
                else:
                    self.assertEqual((vlnv, interface, signal), {
                        "clk": ("xilinx.com:signal:clock:1.0", "clk", "CLK"),
                        "rst": ("xilinx.com:signal:reset:1.0", "rst", "RST"),
                        "irq": ("xilinx.com:signal:interrupt:1.0", "irq", "INTERRUPT"),
                        **{f"{side}_{name}": (f"xilinx.com:signal:{kind}:1.0", f"{side}_{name}", name.upper())
                           for side in ("axil", "mem") for name, kind in (("clk", "clock"), ("rst", "reset"))}}[name])
                if "X_INTERFACE_PARAMETER" in attributes:
                    own, _, rest = attributes["X_INTERFACE_PARAMETER"].partition(", ")
                    self.assertEqual(own, f"XIL_INTERFACENAME {interface}")
                    self.assertNotIn(interface, parameters)
                    parameters[interface] = rest
            self.assertEqual(found, masters)
            clocks = {"": list(masters)} if TOP != CDC else {"": [], "axil_": ["s_axil"],
                                                              "mem_": ["m_axi", "m_axi_cfg"]}
            for side, buses in clocks.items():
                associated = f"ASSOCIATED_BUSIF {':'.join(buses)}, " if buses else ""
                self.assertEqual(parameters.pop(f"{side}clk"), f"{associated}ASSOCIATED_RESET {side}rst")
                self.assertEqual(parameters.pop(f"{side}rst"), "POLARITY ACTIVE_HIGH")
            self.assertEqual(parameters, {**{bus: f"{modes[bus]}, SUPPORTS_NARROW_BURST 0" for bus in masters},
                                          **({"irq": "SENSITIVITY LEVEL_HIGH"} if masters else {})})

    def test_only_what_the_top_needs(self):
        files = [self.file, *(["simulation_models.v"] if TOP in MORE else [])]
        modules = [name for file in files for name in re.findall(r"^module (\w+)",
                                                                 (self.folder / file).read_text(), re.M)]
        self.assertEqual(len(modules), len(set(modules)))
        self.assertIn(TOP, modules)
        used = set()
        for parameters in ("", *MORE.get(TOP, ())):
            code, text = run(tool("yosys"), "-p", f"read_verilog {' '.join(files)}; "
                             f"hierarchy -check -top {TOP} {parameters}", cwd=self.folder)
            self.assertEqual(code, 0, text)
            # yosys names the modules that stay: as they are, or derived from one with parameters
            used |= set(re.findall(r"(?:Top|Used) module: +\\?(?:\$paramod(?:\$[0-9a-f]+)?\\)?(\w+)", text))
        self.assertEqual(set(modules), used)

    def test_device_variants_differ_in_their_leaf_only(self):
        self.assertEqual((self.folder / f"{TOP}_ecp5.v").exists(), TOP != BLANK)
        if TOP == BLANK:
            return
        portable, device = self.sections(self.file), self.sections(f"{TOP}_ecp5.v")
        leaves = {"arith/cchip_mul18.v": "MULT18X18D",
                  **({"common/cchip_block_ram.v": "DP16KD"} if TOP in MORE else {})}
        expected = set()
        for leaf in leaves:
            expected |= {f"rtl/{leaf}", f"rtl/vendor/ecp5/{pathlib.Path(leaf).name}"}
        if TOP in MORE:
            expected.add("rtl/vendor/ecp5/cchip_dp16kd.v")  # the block under the leaf
        if TOP in (CHIP, CDC):
            expected |= {"rtl/common/cchip_dual_ram.v", "rtl/vendor/ecp5/cchip_dual_ram.v"}
        self.assertEqual(set(portable) ^ set(device), expected)
        self.assertEqual([name for name in set(portable) & set(device) if portable[name] != device[name]], [])
        blocks = [f"{block}.v" for block in leaves.values()]
        self.yosys(f"-lib +/ecp5/cells_bb.v +/ecp5/cells_sim.v; read_verilog {TOP}_ecp5.v",
                   *(f"select -assert-any t:{block}" for block in leaves.values()))
        self.clean(*self.icarus, f"{TOP}_ecp5.v", *blocks)
        commands = [line.replace(self.file, " ".join([f"{TOP}_ecp5.v", *blocks])) for line in self.commands()]
        self.assertRegex(self.bench(commands[0], re.sub(r"\+pairs=\d+", "+pairs=100", commands[1])), self.passes)

    def test_file_lists(self):
        lists = sorted(self.folder.glob("*.f"))
        self.assertEqual([path.stem for path in lists], sorted(path.stem for path in self.folder.glob(f"{TOP}*.v")))
        for path in lists:
            for line in path.read_text().splitlines()[1:]:
                self.assertTrue((self.folder / line).is_file(), line)

    def test_constraints(self):
        """The Tcl ones run and set the clocks on their ports, no faster than what was measured; all three agree.
        False is the path from the port that is of no clock, and no other."""
        found = {"lpf": re.findall(r'^FREQUENCY PORT "(\w+)" ([\d.]+) MHZ;$', self.constraints("lpf"), re.M)}
        false_paths = [["cfg_error"]] if TOP in (CHIP, CDC, SUBSYSTEM) else []
        for kind in ("xdc", "sdc"):
            commands = ("proc get_ports {name} {return $name}\n"
                        "proc set_false_path {from name} {puts \"$from $name\"}\n"
                        "proc create_clock {args} {puts \"[lindex $args end] [dict get [lrange $args 0 end-1] "
                        "-period]\"}\n")
            code, text = run("tclsh", self.written("run.tcl", commands + self.constraints(kind)), cwd=self.folder)
            self.assertEqual(code, 0, text)
            lines = [line.split() for line in text.splitlines()]
            self.assertEqual([line[1:] for line in lines if line[0] == "-from"], false_paths)
            found[kind] = [(line[0], f"{1000 / float(line[1]):.0f}") for line in lines if line[0] != "-from"]
        mhz = found["lpf"][0][1]
        ports = ("clk", "axil_clk", "mem_clk") if TOP == CDC else ("clk",)
        self.assertEqual(list(found.values()), [[(port, mhz) for port in ports]] * 3)
        crossings = ("vivado/cdc.xdc", "quartus/cdc.sdc") if TOP == CDC else ()
        self.assertEqual(len(list((self.folder / "constraints").iterdir())), 3 + len(crossings))
        for name in crossings:
            copied = self.folder / "constraints" / pathlib.Path(name).name
            self.assertEqual(copied.read_text(), (ROOT / "scripts" / name).read_text())
            self.assertIn(f"constraints/{copied.name}", (self.folder / "README.md").read_text())
        page = (ROOT / "docs/hardware/fpga.md").read_text()
        row = {CHIP: "chip_tri", CDC: "chip_tri", SUBSYSTEM: "subsystem1", BLANK: "tri_tri",
               "cchip_primtest_array": "array6"}.get(TOP, TOP[len("cchip_primtest_"):])
        measured = re.search(rf"^\| `{row}` \|.*?\| [\d.]+ / ([\d.]+) / [\d.]+, \d+ seed", page, re.M)[1]
        self.assertLessEqual(float(mhz), float(measured))

    def test_what_an_integrator_must_know(self):
        if TOP != CHIP:
            return
        text = (self.folder / "README.md").read_text()
        bill = re.search(r"^\| all \|.* (\d+) \| (\d+) \| (\d+) \| (\d+) \|$",
                         (ROOT / "docs/hardware/fpga.md").read_text(), re.M)
        self.assertIn("{} sites of LUT4, {} flip-flops, {} multiplier blocks, {} block RAMs".format(*bill.groups()),
                      text)
        for name in ("AXI_ARCACHE", "AXI_AWCACHE", "AXI_PROT"):
            value = re.search(rf"parameter integer {name} = (\d+)", (ROOT / "rtl/chip/cchip_chip.v").read_text())[1]
            self.assertIn(f"`{name}` = {value}", text)
        for name in set(re.findall(r"`(?:control|status)\.(\w+)`", text)):
            self.assertIn(f"| `{name}` |", (self.folder / "docs/hardware/chip-registers.md").read_text())
        self.assertIn("docs/hardware/chip-registers.md", text)
        self.clean(tool("iverilog"), "-g2005", "-Wall", "-t", "null", "-s", "chip_instance",
                   "chip_instance.v", self.file)

    def constraints(self, kind):
        return (self.folder / "constraints" / f"{TOP}.{kind}").read_text()

    def written(self, name, text):
        path = pathlib.Path(self.temporary.name) / name
        path.write_text(text)
        return str(path)

    def test_files_of_platform_designer(self):
        path = self.folder / f"{TOP}_hw.tcl"
        self.assertEqual(path.exists(), TOP in (SUBSYSTEM, CHIP, CDC))
        if path.exists():
            names = re.findall(r"^add_fileset_file \S+ \w+ PATH (\S+)$", path.read_text(), re.M)
            self.assertEqual(len(names), 3 + (TOP == CDC))
            for name in names:
                self.assertTrue((self.folder / name).is_file(), name)

    def test_links_of_the_pages(self):
        pages = list(self.folder.rglob("*.md"))
        self.assertIn(self.folder / "docs" / "modules" / f"{TOP}.md", pages)
        for path in pages:
            for link in re.findall(r"\]\(([^)#]+)", path.read_text()):
                self.assertTrue((path.parent / link).exists(), f"{path.relative_to(self.folder)}: {link}")

    def commands(self):
        """Of README.md."""
        found = re.findall(r"^ {6}(\S.*)$", (self.folder / "README.md").read_text(), re.M)
        self.assertEqual(len(found), 2)
        return found

    def bench(self, *commands, expected=0):
        """Output of the two commands, which end with that code."""
        code, text = run("sh", "-e", "-c", "\n".join(commands), cwd=self.folder)
        self.assertEqual(code, expected, text)
        return text

    def test_readme_is_short(self):
        lines = (self.folder / "README.md").read_text().splitlines()
        self.assertLessEqual(len(lines), 30 if TOP in (CHIP, CDC) else 14)

    def test_bench_passes(self):
        self.assertRegex(self.bench(*self.commands()), self.passes)

    def test_bench_can_fail(self):
        """A multiplier, the blank module's constant, or the word of a crossing, is wrong in one bit."""
        path = self.folder / self.file
        text = path.read_text()
        old, new = (r"(idle *=) 1'b1", r"\1 1'b0") if TOP == BLANK else (r"(a_q \* b_q)", r"\1 ^ 36'd1")
        if TOP == CDC:
            old, new = r"(data_q *<= mem\[\w+[^;]*);", r"\1 ^ 1'b1;"
        broken, count = re.subn(old, new, text)
        self.assertEqual(count, 1)
        path.write_text(broken)
        try:
            self.assertRegex(self.bench(*self.commands(), expected=1),
                             FAIL_CHIP if TOP == CHIP else FAIL)
        finally:
            path.write_text(text)


class TwoTops(unittest.TestCase):
    def test_two_exported_files_in_one_project(self):
        """Both hold the same modules below their tops."""
        other = "cchip_primtest_tri_quad"
        with tempfile.TemporaryDirectory() as folder:
            for top in (TOP, other):
                export(top, folder)
            files = [f"{top}/{top}.v" for top in (TOP, other)]
            self.assertEqual(run(tool("iverilog"), "-g2005", "-Wall", "-t", "null", "-s", TOP, "-s", other,
                                 *files, cwd=folder), (0, ""))


if __name__ == "__main__":
    TOP, SCRATCH = sys.argv[1:3]
    if TOP != "cchip_primtest_tri_tri":  # once is enough
        del TwoTops
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
