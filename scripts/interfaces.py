# SPDX-License-Identifier: Apache-2.0
"""Ports of a top module, and the buses, clock, reset and interrupt that they form."""
import re

# of each prefix: whose side, protocol
BUSES = {"s_axil": ("slave", "AXI4LITE"), "m_axi": ("master", "AXI4"), "m_axi_cfg": ("master", "AXI4")}
PORT = re.compile(r"^ *(input|output) +wire +(?:\[(.*):0\])? *(\w+)")


def head(text, top):
    """(start, end) of the ports in the text of a module."""
    start = re.search(rf"^module {top}\b.*?^\)? *\($", text, re.M | re.S).end()
    return start, start + re.search(r"^\)\s*;", text[start:], re.M).start()


def ports(text, top):
    """[(name, direction, left index as it is written, or "")] of a module, in order."""
    start, end = head(text, top)
    matches = [PORT.match(line) for line in text[start:end].splitlines()]
    return [(match[3], match[1], " ".join((match[2] or "").split())) for match in matches if match]


def member(name):
    """(bus, signal in capitals) of a port, or (None, ...) of one of no bus."""
    bus, _, signal = name.rpartition("_")
    return (bus, signal.upper()) if bus in BUSES else (None, name)


def buses(names):
    """The buses of a module, in the order of its ports."""
    return list(dict.fromkeys(member(name)[0] for name in names if member(name)[0]))


def channels(signals):
    """"READ_ONLY" or "READ_WRITE" of a bus with these signals."""
    return "READ_WRITE" if "AWVALID" in signals else "READ_ONLY"


def clock_of(bus, names):
    """The clock of a bus: one of its own where the module has it."""
    own = "axil_clk" if bus == "s_axil" else "mem_clk"
    return own if own in names else "clk"


def attribute(name, names, first):
    """Vivado's attributes of a port, or nothing. `first`: of its bus."""
    bus, signal = member(name)
    if bus:
        signals = [member(other)[1] for other in names if member(other)[0] == bus]
        info = f"xilinx.com:interface:aximm:1.0 {bus} {signal}"
        more = (f"PROTOCOL {BUSES[bus][1]}, READ_WRITE_MODE {channels(signals)}, SUPPORTS_NARROW_BURST 0"
                if first else "")
    elif re.fullmatch(r"(\w+_)?clk", name):
        info = f"xilinx.com:signal:clock:1.0 {name} CLK"
        found = [bus for bus in buses(names) if clock_of(bus, names) == name]
        more = (f"ASSOCIATED_BUSIF {':'.join(found)}, " if found else "") + f"ASSOCIATED_RESET {name[:-3]}rst"
    elif re.fullmatch(r"(\w+_)?rst", name):
        info, more = f"xilinx.com:signal:reset:1.0 {name} RST", "POLARITY ACTIVE_HIGH"
    elif name == "irq":
        info, more = "xilinx.com:signal:interrupt:1.0 irq INTERRUPT", "SENSITIVITY LEVEL_HIGH"
    else:
        return ""
    parameter = f', X_INTERFACE_PARAMETER = "XIL_INTERFACENAME {bus or name}, {more}"' if more else ""
    return f'(* X_INTERFACE_INFO = "{info}"{parameter} *)'


def with_attributes(text, top):
    """The text of a module with Vivado's attributes above its ports; all other tools ignore them."""
    start, end = head(text, top)
    names, seen, lines = [name for name, _, _ in ports(text, top)], set(), []
    for line in text[start:end].splitlines(keepends=True):
        match = PORT.match(line)
        if match:
            bus = member(match[3])[0]
            found = attribute(match[3], names, bus not in seen)
            seen.add(bus)
            lines += [f"    {found}\n"] if found else []
        lines.append(line)
    return text[:start] + "".join(lines) + text[end:]
