#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The routed chip answers a query: what nextpnr wrote after routing, cell by cell as Verilog, in the place of the RTL.

usage: routed.py ROW SYNTHESIS ROUTED --queries PROGRAM [--build FOLDER]
  ROW                one of the chip in scripts/fpga.py: chip_tri, chip, chip_small, chip_small_quad
  SYNTHESIS, ROUTED  folders below build/fpga: with netlist.json of Yosys, with routed.json of nextpnr
  --queries PROGRAM  cchip_query_vectors, a target of CMake
  --build FOLDER     for outputs (default build/gates)
  --jobs N           tools at the same time (default 2)

The registers of the harness around the chip (scripts/fpga.py) are left out, so that the chip's ports are those of the
RTL; tests/icarus/bench_chip.v asks one query, and compares the records with the model's. Block RAM and multipliers are
the models of this folder, flip-flops begin as the device configures them. The RTL goes first, with the same parameters
and the same bench, in Icarus; the netlist in Verilator 5.
Lines: `ROW rtl query=1 records=N wrong=0 clocks=C`, `ROW routed cells=M query=1 records=N wrong=0 clocks=C`.
Exit codes: 0 as many clocks and records in both, none wrong; 1 not so, or a tool failed; 2 bad arguments."""
import argparse
import json
import pathlib
import re
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT / "scripts"), str(HERE)]
import datasheet  # noqa: E402
import fpga  # noqa: E402
from gates import Failure, run  # noqa: E402

BENCH = ROOT / "tests/icarus/bench_chip.v"
ZERO, ONE = "1'b0", "1'b1"
# inputs of a block RAM that are 1 if nothing is connected
CONTROL = re.compile(r"(?:CLK|RST|WE|CE|OCE)[AB]|CS[AB][0-2]")


def choose(bits, inputs):
    """The value that the inputs, the lowest bit of the number first, choose of bits: nested conditions, as few as it
    takes."""
    if len(set(bits)) == 1:
        return f"1'b{bits[0]}"
    half = len(bits) // 2
    low, high = choose(bits[:half], inputs[:-1]), choose(bits[half:], inputs[:-1])
    if low == high:
        return low
    if (low, high) == (ZERO, ONE):
        return inputs[-1]
    return f"({inputs[-1]} ? {high} : {low})"


class Netlist:
    """The cells of nextpnr's JSON as lines of Verilog; a net is n and its number."""

    def __init__(self, module):
        self.cells = module["cells"]
        self.numbers = {name: net["bits"][0] for name, net in module["netnames"].items()}
        self.models = {kind: (HERE / f"{kind}.v").read_text() for kind in ("DP16KD", "MULT18X18D")}

    def lines(self, clock):
        """clock: net of the clock behind its buffer."""
        for name, cell in self.cells.items():
            kind, pins = cell["type"], {pin: f"n{bits[0]}" for pin, bits in cell["connections"].items() if bits}
            parameters = {key: value.strip() for key, value in cell["parameters"].items()}
            if kind in ("TRELLIS_IO", "DCCA"):
                continue
            if not hasattr(self, kind.lower()) and kind not in self.models:
                raise Failure(f"no model of the cell {kind}, {name}")
            if not pins:  # it keeps a place empty
                continue
            if any(pins.get(pin, clock) != clock for pin in ("CLK", "WCK", "CLKA", "CLKB", "CLK0")):
                raise Failure(f"{name} has another clock")
            yield from getattr(self, kind.lower())(pins, parameters) if kind not in self.models else [
                self.block(kind, pins, parameters)]

    def trellis_ff(self, pins, parameters):
        data = pins["DI" if parameters["SD"] == "1" else "M"]
        start = int(parameters["REGSET"] == "SET")
        enable = {"1": ONE, "CE": pins.get("CE", ONE), "INV": "!" + pins.get("CE", ZERO)}[parameters["CEMUX"]]
        value = data if enable == ONE else f"{enable} ? {data} : {pins['Q']}"
        if "LSR" in pins:
            if parameters["LSRMUX"] != "LSR" or parameters.get("SRMODE", "LSR_OVER_CE") != "LSR_OVER_CE":
                raise Failure("a flip-flop with a reset that no model has")
            value = f"{pins['LSR']} ? 1'b{start} : {value}"
        yield f"reg {pins['Q']} = 1'b{start}; always @(posedge clk) {pins['Q']} <= {value};"

    def trellis_comb(self, pins, parameters):
        mode = parameters.get("MODE", "LOGIC")
        if mode == "RAMW_BLOCK":
            return
        inputs = [pins.get(pin, ONE) for pin in "ABCD"]
        table = parameters["INITVAL"][::-1]
        if mode == "LOGIC":
            if set(pins) - set("ABCDF"):
                raise Failure("a LUT with a wide multiplexer: synthesise with -nowidelut")
            yield f"assign {pins['F']} = {choose(table, inputs)};"
        elif mode == "CCU2":
            takes = parameters["CCU2_INJECT1"] == "NO"
            sum_, carry = choose(table, inputs), pins.get("FCI", ZERO)
            if "F" in pins:
                yield f"assign {pins['F']} = {sum_}{' ^ ' + carry if takes else ''};"
            if "FCO" in pins:
                yield f"assign {pins['FCO']} = {sum_} ? {carry} : {choose(table[:4], inputs[:2]) if takes else ZERO};"
        elif mode == "DPRAM":
            ram = pins["F"].replace("n", "ram")
            address = ", ".join(pins[f"WAD{i}"] for i in (3, 2, 1, 0))
            a, b, c, d = inputs  # bits 3, 1, 2 and 0 of the address, as those of the port for writing: see trellis_ramw
            if "1" in parameters["INITVAL"]:
                raise Failure("a distributed RAM with initial contents")
            yield (f"reg [15:0] {ram} = 16'd0; assign {pins['F']} = {ram}[{{{a}, {c}, {b}, {d}}}];"
                   f" always @(posedge clk) if ({pins.get('WRE', ONE)}) {ram}[{{{address}}}] <= {pins['WD']};")
        else:
            raise Failure(f"no model of the mode {mode}")

    def trellis_ramw(self, pins, _):
        for output, pin in (("WDO0", "C1"), ("WDO1", "A1"), ("WDO2", "D1"), ("WDO3", "B1"), ("WADO0", "D0"),
                            ("WADO1", "B0"), ("WADO2", "C0"), ("WADO3", "A0")):
            if output in pins:
                yield f"assign {pins[output]} = {pins.get(pin, ONE)};"

    def block(self, kind, pins, parameters):
        text = self.models[kind]
        known = set(re.findall(r"^ *parameter (?:\[\d+:0\] |integer )?(\w+) =", text, re.M))
        given = {}
        for name, value in parameters.items():
            if name in known and not name.startswith("INITVAL"):
                given[name] = str(int(value, 2)) if re.fullmatch("[01]+", value) else f'"{value}"'
            elif name.startswith("INITVAL") and "1" in value:
                raise Failure("a block RAM with initial contents")
        for pin in re.findall(r"\w+", " ".join(
            re.findall(r"^ *input +wire ([\w, \n]+?)(?=,\n *output|,\n *input|\n\))", text, re.M))):
            choice = parameters.get(pin + "MUX", "")
            if pin in pins:
                pins[pin] = "!" * (choice == "INV") + pins[pin]
            else:
                one = choice != "INV" if kind == "DP16KD" and CONTROL.fullmatch(pin) else choice == "1"
                pins[pin] = ONE if one else ZERO
        return (f"{kind} #({', '.join(f'.{name}({value})' for name, value in sorted(given.items()))}) "
                f"u{pins.get('DOB0', pins.get('P0', 'none'))} "
                f"({', '.join(f'.{pin}({net})' for pin, net in sorted(pins.items()))});")


def chip(row, before, after):
    """Module cchip_chip around the netlist. before: of Yosys, whose nets `in` and `out` are the chip's ports; after: of
    nextpnr."""
    netlist = Netlist(after)
    names = {}
    for name, net in before["netnames"].items():
        for i, bit in enumerate(net["bits"]):
            names.setdefault(bit, []).append(name if len(net["bits"]) == 1 else f"{name}[{i + net.get('offset', 0)}]")

    def number(bit):
        return next((netlist.numbers[name] for name in names.get(bit, ()) if name in netlist.numbers), None)
    for name in list(netlist.cells):
        if name.startswith(("in_TRELLIS_FF", "shift", "out_r", "fold", "q_TRELLIS", "q$", "d$", "clk$")):
            del netlist.cells[name]
    clock = next(cell["connections"]["CLKO"][0] for cell in netlist.cells.values() if cell["type"] == "DCCA")
    lines = list(netlist.lines(f"n{clock}"))
    driven, used = set(re.findall(r"(?:assign|reg) (n\d+)\b", "\n".join(lines))), set(
        re.findall(r"\bn\d+\b", "\n".join(lines)))
    parameters, ports = datasheet.parse(row.top)
    settings = ",\n".join(f"    parameter integer {name} = {fpga.macro(dict(row.parameters).get(name, default))}"
                          for name, default in parameters)
    body, at = [], {"input": [], "output": []}
    for name, direction, width in ports:
        if name != "clk":
            at[direction].append((name, width))
    vectors = {"input": "in", "output": "out"}
    for direction, found in at.items():
        total = " + ".join(width for _, width in found)
        body.append(f"  wire [{total} - 1:0] port_{vectors[direction]};")
        joined = ", ".join(name for name, _ in reversed(found))
        body.append(f"  assign port_in = {{{joined}}};" if direction == "input"
                    else f"  assign {{{joined}}} = port_out;")
    for direction, vector in vectors.items():
        for i, bit in enumerate(before["netnames"][vector]["bits"]):
            net = number(bit)
            if direction == "input" and net is not None and f"n{net}" in used - driven:
                body.append(f"  wire n{net} = port_in[{i}];")
            elif direction == "output":
                body.append(f"  assign port_out[{i}] = {f'n{net}' if net is not None else {'0': ZERO, '1': ONE}[bit]};")
    declared = "\n".join(f"    {direction} wire [{width} - 1:0] {name}," for name, direction, width in ports)
    return (f'`include "cchip_defs.vh"\nmodule cchip_chip #(\n{settings}\n) (\n{declared[:-1]}\n);\n' + "\n".join(body)
            + f"\n  wire n{clock} = clk;\n"
            + "\n".join(sorted(lines, key=lambda line: not line.startswith("reg"))) + "\nendmodule\n",
            len(netlist.cells))


def icarus(sources, folder):
    run(folder / "rtl.iverilog.log", "iverilog", "-g2005", f"-I{ROOT / 'rtl/include'}", "-s", "bench_chip", "-o",
        folder / "rtl.vvp", BENCH, *sources)
    return ["vvp", "-n", folder / "rtl.vvp"]


def verilator(sources, folder, jobs):
    """Without optimisation of C++: compiling would cost more than it saves."""
    out = folder / "routed.dir"
    run(folder / "routed.verilator.log", "verilator", "--cc", "--exe", "--main", "--timing", "-Wno-fatal", "-Wno-lint",
        "-Wno-style", "-O3",
        "-fno-const-bit-op-tree", "--x-assign", "unique", "--x-initial", "unique", "--output-split", "20000",
        "--output-split-cfuncs", "2000",
        "--top-module", "bench_chip", "--Mdir", out, f"-I{ROOT / 'rtl/include'}", BENCH, *sources)
    run(folder / "routed.make.log", "make", "-C", out, "-j", jobs, "-f", "Vbench_chip.mk", "OPT_FAST=-O0",
        "OPT_SLOW=-O0", "VM_PARALLEL_BUILDS=1")
    return [out / "Vbench_chip"]


def ask(name, program, folder):
    """The last line of the bench: no mistake of it is hidden, the exit code of Verilator's is 0 always."""
    return re.findall(r"^query=.*$", run(folder / f"{name}.log", *program, f"+memory={folder}/memory.hex",
                                         f"+records={folder}/records.hex"), re.M)[-1]


def main():
    if {"-h", "--help"} & set(sys.argv):
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=__doc__, add_help=False)
    parser.add_argument("row")
    parser.add_argument("synthesis", type=pathlib.Path)
    parser.add_argument("routed", type=pathlib.Path)
    parser.add_argument("--queries", type=pathlib.Path, required=True)
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build/gates")
    parser.add_argument("--jobs", default="2")
    options = parser.parse_args()
    row = fpga.rows().get(options.row)
    if not row or row.top != "cchip_chip":
        parser.error(f"unknown row {options.row}")
    folder = options.build / f"routed_{row.name}"
    folder.mkdir(parents=True, exist_ok=True)
    try:
        run(folder / "vectors.log", options.queries, folder / "memory.hex", folder / "records.hex",
            *(() if dict(row.parameters)["RM_ID"] == 3 else ("triangle",)))
        sources = [ROOT / "rtl" / name for name in (ROOT / "rtl/cchip.f").read_text().split() if name.endswith(".v")]
        chip_file = next(path for path in sources if path.name == "cchip_chip.v")
        text = chip_file.read_text()
        for name, value in row.parameters:
            text = re.sub(rf"(parameter integer {name} = )[^,\n]+", rf"\g<1>{value}", text, count=1)
        (folder / "rtl_chip.v").write_text(text)
        rtl = ask("rtl", icarus([folder / "rtl_chip.v", *(path for path in sources if path != chip_file)], folder),
                  folder)
        print(f"{row.name} rtl {rtl}", flush=True)
        before = json.loads((options.synthesis / "netlist.json").read_text())["modules"]["fpga_harness"]
        after = json.loads((options.routed / "routed.json").read_text())["modules"]["top"]
        text, cells = chip(row, before, after)
        (folder / "routed_chip.v").write_text(text)
        routed = ask("routed", verilator([folder / "routed_chip.v", HERE / "DP16KD.v", HERE / "MULT18X18D.v"], folder,
                                         options.jobs), folder)
        print(f"{row.name} routed cells={cells} {routed}", flush=True)
    except (Failure, OSError) as failure:
        print(f"routed.py: {failure}", file=sys.stderr)
        return 1
    return 0 if routed == rtl and "wrong=0" in rtl else 1


if __name__ == "__main__":
    sys.exit(main())
