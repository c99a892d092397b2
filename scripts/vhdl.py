#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A VHDL package for a top module of the RTL: its component, and the constants of scripts/definitions.json.

usage: vhdl.py TOP [-o FILE]     TOP: a module of rtl/cchip.f; FILE: default standard output

The package is TOP_package, VHDL-93 and newer. Ports are std_logic and std_logic_vector, ranges follow the generics as
in the RTL. Generics are integers with the RTL's defaults; one that follows another generic in the RTL has the value for
the defaults, so set both. A number of more than 31 bit, which a VHDL integer does not hold, is a std_logic_vector.
Exit codes: 0 done, 1 something cannot be said in VHDL, 2 bad arguments."""
import json
import pathlib
import re
import sys

import datasheet

ROOT = pathlib.Path(__file__).resolve().parent.parent
DEFINITIONS = json.loads((ROOT / "scripts" / "definitions.json").read_text())
MOST = (1 << 31) - 1
WRAP = 110


class VhdlError(Exception):
    pass


def number(value):
    """(type, literal) of a number."""
    if -MOST <= value <= MOST:
        return "integer", str(value)
    digits = max(8, -(-value.bit_length() // 4)) if value > 0 else 0
    if not digits:
        raise VhdlError(f"{value}: negative numbers below -2^31 are not supported; split it")
    return f"std_logic_vector({4 * digits - 1} downto 0)", f'x"{value:0{digits}X}"'


def default(value, settings):
    """The number that a default of the RTL is, other parameters having their defaults."""
    names = {name: int(str(number), 0) for name, number in datasheet.definitions()[0].items()}

    def function(row):
        expression = row["expr"].replace("/", "//")
        return lambda *given: eval(expression, {"__builtins__": {}}, {**names, **dict(zip(row["args"], given))})

    names.update({row["name"]: function(row) for row in DEFINITIONS["functions"] if row["args"]})
    text = value.replace("`CCHIP_", "")
    try:
        return int(eval(text, {"__builtins__": {}}, {**names, **settings}))
    except (NameError, SyntaxError, TypeError):
        raise VhdlError(f"default {value}: not a number; teach scripts/vhdl.py this form") from None


def vector(top, settings):
    """The type of a port whose range is [top:0]."""
    if not top:
        return "std_logic"
    text = datasheet.plain(datasheet.squeeze(top))
    text = re.sub(r"\$clog2\(", "cchip_clog2(", text)
    unknown = set(re.findall(r"[A-Za-z_]\w*", text)) - set(settings) - {"cchip_clog2"}
    if unknown or "`" in text or "?" in text:
        raise VhdlError(f"range [{top.strip()}:0]: {min(unknown or {text})} is no generic; teach scripts/vhdl.py this "
                        "form")
    text = re.sub(r"([-+*/])", r" \1 ", text)
    return f"std_logic_vector({text} downto 0)"


def comment(meaning, indent):
    """A meaning as comment lines."""
    words, lines, line = (meaning or "").split(), [], ""
    for word in words:
        if line and len(line) + len(word) + len(indent) + 4 > WRAP:
            lines.append(line)
            line = ""
        line += (" " if line else "") + word
    return [f"{indent}-- {text}" for text in [*lines, line] if text]


def constants():
    """(name, number) of every constant that the languages share, codes included."""
    found = {f"CCHIP_{name}": value for name, value in datasheet.definitions()[0].items()}
    for enum in DEFINITIONS["enums"]:
        found.update({f"CCHIP_{enum['prefix']}_{row['name']}": row["value"] for row in enum["values"]})
    return {name: int(str(value), 0) for name, value in found.items()}


def component(top):
    parameters, ports = datasheet.declared(top)
    settings, lines = {}, [f"  component {top}"]
    if parameters:
        lines.append("    generic (")
    for name, value, meaning in parameters:
        settings[name] = default(value, settings)
        kind, literal = number(settings[name])
        lines += comment(meaning, "      ")
        lines.append(f"      {name} : {kind} := {literal}{';' * (name != parameters[-1][0])}")
    lines += ["    );"] if parameters else []
    lines.append("    port (")
    group = None
    for direction, width, name, _, of in ports:
        if of != group:
            group = of
            lines += comment(f"---- {re.split('[:;]', of)[0]}" if of else "", "      ")
        lines.append(f"      {name} : {'in ' if direction == 'input' else 'out'} {vector(width, settings)}"
                     f"{';' * (name != ports[-1][2])}")
    return lines + ["    );", "  end component;"]


def package(top):
    """The text of TOP.vhd."""
    lines = [f"""-- SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
-- {top} for VHDL: read this file and the Verilog into one project; the tool binds the component to the module by its
-- name. Written by scripts/vhdl.py. Do not edit.
library ieee;
use ieee.std_logic_1164.all;

package {top}_package is

  -- smallest n with 2**n >= value
  function cchip_clog2(value : positive) return natural;
"""]
    for name, value in constants().items():
        kind, literal = number(value)
        lines.append(f"  constant {name} : {kind} := {literal};")
    lines += ["", *component(top), f"""
end package;

package body {top}_package is

  function cchip_clog2(value : positive) return natural is
    variable rest : natural := value - 1;
    variable bits : natural := 0;
  begin
    while rest > 0 loop
      rest := rest / 2;
      bits := bits + 1;
    end loop;
    return bits;
  end function;

end package body;"""]
    return "\n".join(lines) + "\n"


def main():
    arguments = sys.argv[1:]
    if {"-h", "--help"} & set(arguments):
        print(__doc__)
        return 0
    if len(arguments) not in (1, 3) or (len(arguments) == 3 and arguments[1] != "-o") or \
            arguments[0] not in datasheet.rtl_files():
        print(__doc__, file=sys.stderr)
        return 2
    try:
        text = package(arguments[0])
    except VhdlError as error:
        print(f"vhdl.py: {arguments[0]}: {error}", file=sys.stderr)
        return 1
    if len(arguments) == 3:
        pathlib.Path(arguments[2]).write_text(text)
    else:
        print(text, end="")
    return 0


if __name__ == "__main__":
    sys.exit(main())
