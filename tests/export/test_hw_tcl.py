#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""TOP_hw.tcl of the tops with buses, run in tclsh with stand-ins for the commands of Platform Designer, which refuse
what the manual does not name. What the script declares is what Yosys says of the RTL, for several parameters.

Environment: TCLSH, YOSYS = commands (default: found on PATH)."""
import json
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "scripts")]
import datasheet  # noqa: E402
import export  # noqa: E402
import hw_tcl  # noqa: E402
from tools import run, tool  # noqa: E402

# parameters of each top: widths at both ends, with and without swaps
SETTINGS = {export.CHIP: ({}, {"MISSES": 16, "DATA_W": 512, "LOCKS": 1}, {"SWAPS": 1, "CFG_W": 32, "MISSES": 8}),
            export.CDC: ({}, {"MISSES": 16, "DATA_W": 256}, {"SWAPS": 1, "CFG_W": 32, "CDC_DEPTH": 4}),
            export.SUBSYSTEM: ({}, {"COORD_W": 4, "CFG_W": 32}, {"COORD_W": 20, "SUBSTAGES": 12})}
# bits of the signals of AMBA AXI4 (IHI 0022) that a manager drives, and that it is driven by; 0: any
ADDRESS = {"valid": 1, "addr": 0, "prot": 3}
FULL = {**ADDRESS, "id": 0, "len": 8, "size": 3, "burst": 2, "lock": 1, "cache": 4, "qos": 4, "region": 4, "user": 0}
DATA = {"wvalid": 1, "wdata": 0, "wstrb": 0, "bready": 1, "rready": 1}
BACK = {"awready": 1, "wready": 1, "bvalid": 1, "bresp": 2, "arready": 1, "rvalid": 1, "rdata": 0, "rresp": 2}
ROLES = {
    "axi4lite": ({f"a{c}{name}": n for c in "rw" for name, n in ADDRESS.items()} | DATA, BACK),
    "axi4": ({f"a{c}{name}": n for c in "rw" for name, n in FULL.items()} | DATA | {"wlast": 1, "wuser": 0},
             BACK | {"rid": 0, "bid": 0, "rlast": 1, "ruser": 0, "buser": 0}),
    # Avalon interface specifications (683091); direction at the sink, but of the interrupt at its sender
    "clock": ({}, {"clk": 1}), "reset": ({}, {"reset": 1, "reset_n": 1}), "interrupt": ({"irq": 1, "irq_n": 1}, {})}


def tables():
    """The roles as a Tcl array: (kind,side,role) -> direction and bits."""
    lines = []
    for kind, (out, back) in ROLES.items():
        for side, first, second in (("start", "Output", "Input"), ("end", "Input", "Output")):
            if not kind.startswith("axi"):
                first, second = "Output", "Input"
            for roles, direction in ((out, first), (back, second)):
                lines += [f"set role({kind},{side},{name}) {{{direction} {bits}}}" for name, bits in roles.items()]
    return "\n".join(lines)


# Stand-ins. A command that is not here is an error of Tcl. The properties are those of the manual (683609).
STUB = r"""
package provide qsys 14.0
proc refuse {text} {error "platform designer: $text"}
proc one_of {what name names} {if {[lsearch -exact $names $name] < 0} {refuse "$what $name"}}
proc set_module_property {name value} {
  one_of "module property" $name {NAME DISPLAY_NAME DESCRIPTION VERSION GROUP AUTHOR EDITABLE ELABORATION_CALLBACK}
  set ::module($name) $value
}
proc add_parameter {name type value {description ""}} {
  if {[info exists ::value($name)]} {refuse "parameter $name twice"}
  one_of "type" $type {INTEGER}
  if {![string is integer -strict $value]} {refuse "$name is $value"}
  set ::value($name) $value
  set ::range($name) {}
  puts "parameter|$name|$value"
}
proc set_parameter_property {name property value} {
  if {![info exists ::value($name)]} {refuse "no parameter $name"}
  one_of "parameter property" $property {HDL_PARAMETER ALLOWED_RANGES}
  if {$property eq "HDL_PARAMETER"} {puts "hdl|$name|$value"; return}
  set ::range($name) $value
  check_range $name
}
proc check_range {name} {
  foreach part $::range($name) {
    set ends [split $part :]
    if {$::value($name) >= [lindex $ends 0] && $::value($name) <= [lindex $ends end]} {return}
  }
  if {$::range($name) ne {}} {refuse "$name = $::value($name) is not in $::range($name)"}
}
proc get_parameter_value {name} {
  if {![info exists ::value($name)]} {refuse "no parameter $name"}
  return $::value($name)
}
proc add_interface {name kind side} {
  if {[info exists ::kind($name)]} {refuse "interface $name twice"}
  one_of "kind" $kind {clock reset interrupt axi4 axi4lite conduit}
  one_of "side" $side {start end}
  set ::kind($name) $kind
  set ::side($name) $side
}
proc set_interface_property {name property value} {
  if {![info exists ::kind($name)]} {refuse "no interface $name"}
  switch $::kind($name) {
    clock {set known {ENABLED clockRate}}
    reset {set known {ENABLED associatedClock synchronousEdges}}
    interrupt {set known {ENABLED associatedClock associatedReset associatedAddressablePoint}}
    conduit {set known {ENABLED associatedClock associatedReset}}
    default {set known {ENABLED associatedClock associatedReset}}
  }
  if {$::side($name) eq "start"} {lappend known readIssuingCapability writeIssuingCapability combinedIssuingCapability}
  one_of "property of $name" $property $known
  set ::property($name,$property) $value
}
proc add_interface_port {name port role direction width} {
  if {![info exists ::kind($name)]} {refuse "no interface $name"}
  if {[info exists ::width($port)]} {refuse "port $port twice"}
  if {[info exists ::taken($name,$role)]} {refuse "role $role of $name twice"}
  one_of "direction" $direction {Input Output}
  set ::taken($name,$role) $port
  set ::width($port) $width
  set ::of($port) [list $name $role $direction]
  set ::terminated($port) 0
}
proc set_port_property {port property value} {
  if {![info exists ::width($port)]} {refuse "no port $port"}
  one_of "port property" $property {WIDTH_EXPR TERMINATION TERMINATION_VALUE}
  if {$property eq "WIDTH_EXPR"} {set ::width($port) $value}
  if {$property eq "TERMINATION"} {set ::terminated($port) $value}
  if {$property eq "TERMINATION_VALUE" && [lindex $::of($port) 2] ne "Input"} {refuse "value of the output $port"}
}
proc add_fileset {name kind} {
  one_of "fileset" $kind {QUARTUS_SYNTH SIM_VERILOG SIM_VHDL}
  set ::fileset $name
}
proc set_fileset_property {name property value} {
  if {$name ne $::fileset} {refuse "fileset $name"}
  one_of "fileset property" $property {TOP_LEVEL}
  puts "top|$value"
}
proc add_fileset_file {name type from path} {
  one_of "type of file" $type {VERILOG SDC}
  one_of "source" $from {PATH}
  puts "file|$::fileset|$path"
}
# each role is one of its interface, all that an interface names is there
proc check_all {} {
  foreach port [array names ::of] {
    foreach {name role direction} $::of($port) {}
    set kind $::kind($name)
    if {$kind ne "conduit"} {
      set key $kind,$::side($name),$role
      if {![info exists ::role($key)]} {refuse "$port: role $role at the $::side($name) of $kind"}
      foreach {want bits} $::role($key) {}
      if {$direction ne $want} {refuse "$port: role $role is $direction"}
      if {$bits && $bits != $::width($port)} {refuse "$port: role $role has $::width($port) bit"}
    }
    puts "port|$port|$direction|$::width($port)|$name|$::terminated($port)"
  }
  foreach name [array names ::kind] {
    set kind $::kind($name)
    puts "interface|$name|$kind|$::side($name)"
    if {$kind ne "clock" && ![info exists ::property($name,associatedClock)]} {refuse "$name without clock"}
    if {$kind eq "interrupt" && ![info exists ::property($name,associatedAddressablePoint)]} {refuse "$name: no point"}
    if {[string match axi* $kind] && ![info exists ::property($name,associatedReset)]} {refuse "$name without reset"}
  }
  foreach {key value} [array get ::property] {
    foreach {name property} [split $key ,] {}
    puts "property|$name|$property|$value"
    switch $property {associatedClock {set kind clock} associatedReset {set kind reset} \
      associatedAddressablePoint {set kind axi4lite} default {continue}}
    if {![info exists ::kind($value)] || $::kind($value) ne $kind} {refuse "$name: $property $value is no $kind"}
  }
}
"""


def notes(text, settings):
    """What a script declares with these parameters, [[word, ...]]; a ValueError with what was refused."""
    values = "\n".join(f"set value({name}) {value}; check_range {name}" for name, value in settings.items())
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder)
        (path / "top_hw.tcl").write_text(text)
        (path / "run.tcl").write_text(f"{tables()}\n{STUB}\nsource {path}/top_hw.tcl\n{values}\n"
                                      "$module(ELABORATION_CALLBACK)\ncheck_all\n")
        code, said = run(tool("tclsh"), path / "run.tcl")
    if code:
        raise ValueError("\n".join(line for line in said.splitlines() if "|" not in line))
    return [line.split("|") for line in said.splitlines()]


class PlatformDesigner(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.text = {top: export.platform_designer(top, True) for top in SETTINGS}
        cls.rtl = {}
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder)
            for top, several in SETTINGS.items():
                # its head alone matters: the modules below stay black boxes
                script = [f"read_verilog -DSYNTHESIS -I{ROOT}/rtl/include {ROOT}/{datasheet.rtl_files()[top]}",
                          "design -save read"]
                for i, settings in enumerate(several):
                    values = "".join(f" -chparam {name} {value}" for name, value in settings.items())
                    script += ["design -load read", f"hierarchy -top {top}{values}", "delete =*/p:*",
                               f"write_json {out}/{i}.json"]
                code, said = run(tool("yosys"), "-q", "-p", "; ".join(script))
                assert code == 0, said
                for i in range(len(several)):
                    ports = json.loads((out / f"{i}.json").read_text())["modules"][top]["ports"]
                    cls.rtl[top, i] = {name: (port["direction"], len(port["bits"])) for name, port in ports.items()}

    def declared(self, text, settings):
        """{port: (direction, bits)} of a script."""
        found = {}
        for word in notes(text, settings):
            if word[0] == "port":
                found[word[1]] = (word[2].lower(), int(word[3]))
        return found

    def test_ports_are_those_of_the_rtl(self):
        for top, several in SETTINGS.items():
            for i, settings in enumerate(several):
                with self.subTest(top=top, **settings):
                    self.assertGreater(len(self.rtl[top, i]), 50)
                    self.assertEqual(self.declared(self.text[top], settings), self.rtl[top, i])

    def test_parameters(self):
        for top, text in self.text.items():
            found = {word[1]: word[2] for word in notes(text, {}) if word[0] == "parameter"}
            hdl = [word[1] for word in notes(text, {}) if word[0] == "hdl" and word[2] == "true"]
            rows = re.findall(r"^\| `(\w+)` \| `?([^|`]+)`? \|", datasheet.parameter_table(top), re.M)
            self.assertEqual(list(found), [name for name, _ in rows])
            self.assertEqual(hdl, list(found))
            numbers = {name: value for name, value in rows if value.isdigit()}
            self.assertEqual({name: found[name] for name in numbers}, numbers)

    def test_interfaces(self):
        both = {"s_axil": "axi4lite", "m_axi": "axi4", "irq": "interrupt", "clk": "clock", "rst": "reset",
                "cfg": "conduit"}
        chip = {**both, "m_axi_cfg": "axi4"}
        of = {export.CHIP: chip, export.SUBSYSTEM: {**both, "s_pair": "conduit", "m_result": "conduit"},
              export.CDC: {**chip, "axil_clk": "clock", "axil_rst": "reset", "mem_clk": "clock", "mem_rst": "reset"}}
        for top, text in self.text.items():
            said = notes(text, {})
            self.assertEqual({word[1]: word[2] for word in said if word[0] == "interface"}, of[top])
            self.assertEqual({word[1] for word in said if word[0] == "interface" and word[3] == "start"},
                             {"m_axi", "m_axi_cfg"} & set(of[top]))
            properties = {(word[1], word[2]): word[3] for word in said if word[0] == "property"}
            clock = {"s_axil": "axil_clk", "irq": "axil_clk", "m_axi": "mem_clk", "m_axi_cfg": "mem_clk"}
            for name in set(of[top]) - {n for n, kind in of[top].items() if kind in ("clock", "reset")}:
                want = clock.get(name, "clk") if top == export.CDC else "clk"
                self.assertEqual(properties[name, "associatedClock"], want, f"{top} {name}")
                self.assertEqual(properties[name, "associatedReset"], want.replace("clk", "rst"))
            self.assertEqual(properties["irq", "associatedAddressablePoint"], "s_axil")
            if top != export.SUBSYSTEM:
                self.assertEqual(properties["m_axi", "readIssuingCapability"], "64")

    def test_ports_of_swaps(self):
        for top in (export.CHIP, export.CDC):
            for swaps in (0, 1):
                said = notes(self.text[top], {"SWAPS": swaps})
                ends = {word[1] for word in said if word[0] == "port" and word[5] == "1"}
                of_swaps = {name for name in self.rtl[top, 0] if name.startswith(("cfg_", "m_axi_cfg_"))}
                self.assertEqual(ends, set() if swaps else of_swaps)
                enabled = {word[1]: word[3] for word in said if word[:1] + word[2:3] == ["property", "ENABLED"]}
                self.assertEqual(enabled, {"cfg": str(swaps), "m_axi_cfg": str(swaps)})

    def test_files_exist(self):
        for top, text in self.text.items():
            said = notes(text, {})
            self.assertEqual({word[1] for word in said if word[0] == "top"}, {top})
            files = {tuple(word[1:]) for word in said if word[0] == "file"}
            self.assertEqual(files, {("synthesis", f"{top}.v"), ("simulation", f"{top}.v"),
                                     ("simulation", "simulation_models.v"),
                                     *([("synthesis", "constraints/cdc.sdc")] if top == export.CDC else [])})

    def test_faults_are_found(self):
        """Each fault in the script of the chip, by what is said of it."""
        text = self.text[export.CHIP]
        for old, new, said in (
                ("add_interface_port m_axi m_axi_arid arid Output 6\n", "", "no port m_axi_arid"),
                ("m_axi_arlen arlen Output", "m_axi_arlen arlan Output", "m_axi_arlen: role arlan"),
                ("m_axi_arlen arlen Output", "m_axi_arlen arlen Input", "m_axi_arlen: role arlen is Input"),
                ("m_axi_arlen arlen Output 8", "m_axi_arlen arlen Output 4", "m_axi_arlen: role arlen has 4 bit"),
                ("m_axi_arlen arlen", "m_axi_arsize arlen", "port m_axi_arsize twice"),
                ("s_axil axi4lite end", "s_axil axi4lite start", "role .* is"),
                ("s_axil axi4lite", "s_axil axi5lite", "kind axi5lite"),
                ("set_interface_property m_axi associatedClock clk\n", "", "m_axi without clock"),
                ("irq associatedAddressablePoint s_axil", "irq associatedAddressablePoint m_axi", "is no axi4lite"),
                ("m_axi associatedReset rst", "m_axi associatedReset clk", "is no reset"),
                ("set_module_property GROUP", "set_module_propertee GROUP", "set_module_propertee"),
                ("set_module_property GROUP", "set_module_property GROOP", "module property GROOP"),
                ("PAIRS INTEGER 48", "PAIRS FLOAT 48", "type FLOAT"),
                ("MISSES INTEGER 32", "MISSES INTEGER 33", "MISSES = 33 is not in")):
            with self.subTest(old=old, new=new):
                self.assertEqual(text.count(old), 1)
                with self.assertRaisesRegex(ValueError, said):
                    notes(text.replace(old, new), {})
        for old, new in (("add_interface_port m_axi m_axi_rlast rlast Input 1\n", ""),
                         ("$DATA_W/8", "$DATA_W/4"), ("[cchip_clog2 $MISSES]+1", "[cchip_clog2 $MISSES]"),
                         ("cfg_valid valid Output", "cfg_valid valid Input")):
            with self.subTest(old=old, new=new):
                self.assertGreaterEqual(text.count(old), 1)
                self.assertNotEqual(self.declared(text.replace(old, new), {}), self.rtl[export.CHIP, 0])
        with self.assertRaisesRegex(ValueError, "DATA_W = 64 is not in 128 256 512"):
            notes(text, {"DATA_W": 64})

    def test_words_of_tcl_8_0(self):
        for text in self.text.values():
            self.assertEqual(re.findall(r"\{\*\}|\*\*|\bdict\b|\blassign\b|mathfunc|\beq\b|\bne\b", re.sub(
                r'".*?(?<!\\)"', "", text)), [])

    def test_legal_values(self):
        for text, want in (("a; legal: 2, 4, 8", "2 4 8"), ("; legal: 4, 8 ... 64", "4 8 16 32 64"),
                           ("; legal: 16, 32 ... 256", "16 32 64 128 256"), ("; legal: 1..4", "1:4"),
                           ("; legal: a power of two, 16..64", "16 32 64"), ("; legal: from 1 on", "1:2147483647"),
                           ("; legal: 1, 2, with SWAPS 0, too", "0 1 2"), ("; legal: any", None), ("nothing", None)):
            self.assertEqual(hw_tcl.allowed(text), want)
        with self.assertRaises(hw_tcl.HwTclError):
            hw_tcl.allowed("; legal: odd")
        with self.assertRaises(hw_tcl.HwTclError):
            hw_tcl.width("OTHER-1", {"WIDTH": 1})


if __name__ == "__main__":
    sys.exit(unittest.main(verbosity=2))
