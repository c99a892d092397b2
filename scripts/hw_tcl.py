# SPDX-License-Identifier: Apache-2.0
"""The component of an exported top for Intel's Platform Designer, TOP_hw.tcl: made of the ports and parameters of the
RTL. Written from Intel's manual (683609, "Component Interface Tcl Reference"); Quartus has never read one.

Words of Tcl 8.0 alone, so that an older interpreter than tclsh reads it, too."""
import re

import datasheet
import interfaces
import vhdl

KINDS = {"AXI4": "axi4", "AXI4LITE": "axi4lite"}
SIDES = {"master": "start", "slave": "end"}
# accesses of a bus that may be outstanding, (reads, writes): of cchip_axi_read, cchip_axi_write, cchip_bitstream_fetch
MEMORY, BITSTREAMS = ("2*$MISSES", "16"), ("2", "")
ISSUED = {("cchip_primtest_subsystem", "m_axi"): BITSTREAMS, ("cchip_chip", "m_axi"): MEMORY,
          ("cchip_chip_cdc", "m_axi"): MEMORY, ("cchip_chip", "m_axi_cfg"): BITSTREAMS,
          ("cchip_chip_cdc", "m_axi_cfg"): BITSTREAMS}
OF_SWAPS = ("m_axi_cfg", "cfg")  # interfaces that a top with the parameter SWAPS has only with SWAPS = 1
MOST = 2**31 - 1
# legal values that follow other parameters; the RTL refuses the others
FREE = r"any|see \w+|PAIRS \+ LEAVES is .*|over PAIRS, to \d+|CCHIP_\w+\(\w+\)\.\.\d+|0\.\.KINDS"


class HwTclError(Exception):
    """A form of the RTL that this script does not know."""


def allowed(meaning):
    """ALLOWED_RANGES of the legal values that a parameter's meaning ends with, None where they are free."""
    text = meaning.partition("; legal: ")[2]
    if not text or re.fullmatch(FREE, text):
        return None
    if re.fullmatch(r"(-?\d+)(, -?\d+)*", text):
        return text.replace(",", "")
    if found := re.fullmatch(r"(\d+), (\d+)(?:, \d+)* \.\.\. (\d+)|a power of two, (\d+)\.\.(\d+)", text):
        first, last = (int(n) for n in (found[1] or found[4], found[3] or found[5]))
        if found[2] is None or int(found[2]) == 2 * first:
            return " ".join(str(first << i) for i in range((last // first).bit_length()))
    if found := re.fullmatch(r"(-?\d+)\.\.(-?\d+)", text):
        return f"{found[1]}:{found[2]}"
    if found := re.fullmatch(r"from (\d+) on|>= (\d+)", text):
        return f"{found[1] or found[2]}:{MOST}"
    if found := re.fullmatch(r"(\d+(?:, \d+)*), with SWAPS (\d+), too", text):
        return f"{found[2]} {found[1].replace(',', '')}"
    raise HwTclError(f"legal values '{text}': not a list nor a range; teach scripts/hw_tcl.py this form")


def quoted(text):
    """A word of Tcl that stands for the text."""
    return '"' + re.sub(r'([\\"$\[\]{}])', r"\\\1", text) + '"'


def width(upper, names):
    """Tcl expression of the width of a range [upper:0]; None if it follows no parameter."""
    text = upper
    text = re.sub(r"\$clog2\((\w+)\)", r"[cchip_clog2 \1]", datasheet.plain(datasheet.squeeze(text)))
    used = set(re.findall(r"[A-Za-z_]\w*", text)) - {"cchip_clog2"}
    if used - set(names) or "`" in text or "?" in text:
        raise HwTclError(f"range {text}: {min(used - set(names) or {text})} is no parameter; teach scripts/hw_tcl.py "
                         "this form")
    for name in used:
        text = re.sub(rf"\b{name}\b", f"${name}", text)
    text = text[:-2] if text.endswith("-1") else f"{text}+1"
    return text if used else None


def computed(text):
    """An expression as a word of Tcl."""
    return text if text.isdigit() else f"[expr {{{text}}}]"


def grouped(ports):
    """{interface: [(port, role, direction, upper end of the range)]}, the role "" of a clock, reset or interrupt."""
    found = {}
    for direction, top, name, _, _ in ports:
        bus, signal = interfaces.member(name)
        if bus:
            interface, role = bus, signal.lower()
        elif re.fullmatch(r"(\w+_)?(clk|rst)|irq", name):
            interface, role = name, ""
        else:  # of no standard: a conduit
            interface, _, role = name.rpartition("_")
        found.setdefault(interface, []).append((name, role, "Input" if direction == "input" else "Output", top))
    return found


def interface(name, ports, names):
    """Lines that declare an interface; names of all ports of the top."""
    clock = "clk"
    if name in interfaces.BUSES or name == "irq":
        clock = interfaces.clock_of("s_axil" if name == "irq" else name, names)
    clocked = {"associatedClock": clock, "associatedReset": clock[:-3] + "rst"}
    if name in interfaces.BUSES:
        side, protocol = interfaces.BUSES[name]
        kind, end, properties = KINDS[protocol], SIDES[side], clocked
    elif name.endswith("clk"):
        kind, end, properties = "clock", "end", {}
    elif name.endswith("rst"):
        kind, end, properties = "reset", "end", {"associatedClock": name[:-3] + "clk", "synchronousEdges": "BOTH"}
    elif name == "irq":
        kind, end, properties = "interrupt", "end", {"associatedAddressablePoint": "s_axil", **clocked}
    else:
        kind, end, properties = "conduit", "end", clocked
    yield f"\nadd_interface {name} {kind} {end}"
    for key, value in properties.items():
        yield f"set_interface_property {name} {key} {value}"
    plain = {"clock": "clk", "reset": "reset", "interrupt": "irq"}
    for port, role, direction, bits in ports:
        yield f"add_interface_port {name} {port} {role or plain[kind]} {direction} {bits}"


def component(top, version, files):
    """The text of TOP_hw.tcl. files: of the folder, [(name, type, for simulation only)]."""
    parameters, ports = datasheet.declared(top)
    names = [port[2] for port in ports]
    settings, lines, elaborate = {}, [], []
    for name, value, meaning in parameters:
        settings[name] = vhdl.default(value, settings)
        follows = [other for other in settings if other != name and re.search(rf"\b{other}\b", value)]
        text = meaning + "".join(f"; this default is that of the default of {other}" for other in follows)
        lines += [f"add_parameter {name} INTEGER {settings[name]} {quoted(text)}",
                  f"set_parameter_property {name} HDL_PARAMETER true"]
        if settings[name] > MOST:
            raise HwTclError(f"{name} = {settings[name]}: an INTEGER of Platform Designer has 32 bit")
        if allowed(meaning):
            lines.append(f"set_parameter_property {name} ALLOWED_RANGES {{{allowed(meaning)}}}")
    groups = grouped(ports)
    for name, members in groups.items():
        declared = []
        for port, role, direction, upper in members:
            bits = vhdl.default(f"{upper or 0}".replace("$clog2", "CLOG2"),
                                {**settings, "CLOG2": lambda n: (n - 1).bit_length()}) + 1
            declared.append((port, role, direction, bits))
            follows = width(upper, settings) if upper else None
            if follows:
                elaborate.append(f"  set_port_property {port} WIDTH_EXPR {computed(follows)}")
        lines += interface(name, declared, names)
        reads, writes = ISSUED.get((top, name), ("", ""))
        for what, count in (("read", reads), ("write", writes), ("combined", "+".join(filter(None, (reads, writes))))):
            if count:
                elaborate.append(f"  set_interface_property {name} {what}IssuingCapability {computed(count)}")
    if "SWAPS" in settings:
        of_swaps = [port for name in OF_SWAPS for port in groups[name]]
        listed = lambda ports: "{" + " ".join(port[0] for port in ports) + "}"
        elaborate += [f"  foreach name {{{' '.join(OF_SWAPS)}}} {{set_interface_property $name ENABLED "
                      "[expr {$SWAPS != 0}]}",
                      f"  foreach port {listed(of_swaps)} {{",
                      "    set_port_property $port TERMINATION [expr {$SWAPS == 0}]", "  }",
                      f"  foreach port {listed(port for port in of_swaps if port[2] == 'Input')} {{",
                      "    set_port_property $port TERMINATION_VALUE 0", "  }"]
    used = [name for name in settings if re.search(rf"\${name}\b", "\n".join(elaborate))]
    filesets = []
    for fileset, kind, simulated in (("synthesis", "QUARTUS_SYNTH", False), ("simulation", "SIM_VERILOG", True)):
        filesets += [f"\nadd_fileset {fileset} {kind}", f"set_fileset_property {fileset} TOP_LEVEL {top}"]
        filesets += [f"add_fileset_file {name.split('/')[-1]} {of} PATH {name}" for name, of, only in files
                     if simulated >= only and (of != "SDC" or not simulated)]
    title = top.replace("cchip_", "").replace("_", " ")
    return "\n".join([f"""# SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
# {top} for Platform Designer of Quartus. Written by scripts/export.py, from the manual: no Quartus has run it.
package require qsys 14.0

set_module_property NAME {top}
set_module_property DISPLAY_NAME {quoted('collisionchip: ' + title)}
set_module_property DESCRIPTION {quoted('collision detection in hardware, datasheet docs/modules/' + top + '.md')}
set_module_property VERSION {version}
set_module_property GROUP collisionchip
set_module_property AUTHOR collisionchip
set_module_property EDITABLE false
set_module_property ELABORATION_CALLBACK elaborate
""", *lines, *filesets, """
# smallest n with 2^n >= value
proc cchip_clog2 {value} {
  set n 0
  while {(1 << $n) < $value} {incr n}
  return $n
}
""", "proc elaborate {} {", *(f"  set {name} [get_parameter_value {name}]" for name in used), *elaborate, "}\n"])
