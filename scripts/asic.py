#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Area, clock and power of the primitive tests, of the chip and of its blocks in standard cells with open tools, by
synthesis; of the smaller ones placed and routed.

usage: asic.py [ROW]... [options]     without ROW all rows; `asic.py --list` names them
  --liberty PATH    cell library, .lib or .lib.gz, typical corner (default: OSU 0.18 um of Debian's qflow-tech-osu018)
  --campaign PATH   cchip_campaign, which counts the mean beats (default build/release/bin/cchip_campaign, built by
                    `make campaign-build`); without it there are no pairs per second and no energy of a pair
  --pairs N         pairs of each class for the mean beats (default 20000)
  --write           rewrite the rows of this run in the tables of this library in docs/hardware/asic.md; other rows stay
                    if they were measured on the same rtl/. docs/figures/asic.csv has the critical paths with their
                    instances
  --wires           only place and route the rows (without ROW multipliers and parts of the triangle test, to larger
                    ones), in the default library, rows without memories. The last lines are `ROW cells=N die_um2=N
                    wire_mm=X mhz=X wires_mhz=X unrouted=0 minutes=X`, MHz without and with wires
  --limit MINUTES   with --wires: processor time of each tool at most. If one does not end within it, or leaves nets
                    unrouted, the line is `ROW cells=N stopped: REASON`: a result
  --list            print the rows

Tools: Debian's Yosys 0.23 with its ABC, OpenSTA; for --wires Debian's qflow, with its graywolf and qrouter. Ideal
clock, no clock tree, no scan, no clock gating; paths from register to register; no wires but with --wires. Memories are
boxes: their bits are counted, apart from the logic, and their delay is assumed (docs/hardware/asic.md). Power is that
of the cells at the clock of the row, with 0.1 and with 0.5 transitions a clock at every cell. Outputs are kept below
build/asic by the hash of what they depend on: a second run repeats only what changed. build/asic/LIBRARY.json and
LIBRARY.wires.json hold the figures of all rows run so far. The last lines are `ROW um2=X nand2=N ff=N bits=N ns=X
fo4=X mhz=X [mw=X/X] [mpairs=X pj=X/X]`. The row chip prints a line for each of its blocks besides.
Exit codes: 0 done, 1 a tool failed, 2 bad arguments."""
import argparse
import collections
import csv
import dataclasses
import functools
import gzip
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys

import datasheet
import fpga
import progress

ROOT = fpga.ROOT
BUILD = ROOT / "build" / "asic"
PAGE = ROOT / "docs" / "hardware" / "asic.md"
CSV = ROOT / "docs" / "figures" / "asic.csv"
TECH = "/usr/share/qflow/tech/osu018"
LIBERTY = f"{TECH}/osu018_stdcells.lib"
QFLOW = "/usr/lib/qflow"
LEAF = "cchip_mul18"
# memories of fewer bits become flip-flops
BOX_BITS = 64
# memories of at least this number of words and bits count as SRAM
SRAM_WORDS, SRAM_BITS = 64, 4096
# transitions of a cell in a clock, for power
ACTIVITIES = 0.1, 0.5


@dataclasses.dataclass(frozen=True)
class Row:
    name: str
    top: str
    shape: str = ""  # of a primitive test, as cchip_campaign names it
    blocks: tuple = ()  # modules that are not flattened and have a line of their own
    boxes: bool = True  # memories are boxes, or else flip-flops
    files: str = "cchip.f"
    macros: tuple = ()
    wires: bool = False  # --wires without ROW takes it
    alone: bool = False  # a part of a primitive test, for --wires only


def rows():
    tests = [Row(name, f"cchip_primtest_{name}", name.replace("_", "-"))
             for name in ("tri_tri", "tri_quad", "quad_quad")]
    blocks = ("bv_unit", "cache", "traversal", "get_data", "transform", "leaf_feed", "axi_read", "axi_write",
              "calc_result",
              "query_ring", "record_ring", "descriptor_queues", "dispatcher", "primtest", "chip_regs")
    leaf3 = {"files": "cchip_asic.f", "macros": ("-DCCHIP_MUL18_LATENCY=3",)}
    return {row.name: row for row in (
        Row("mul18", LEAF, wires=True), Row("mul18_leaf3", LEAF, wires=True, **leaf3),
        *(Row(name, f"cchip_{top}", boxes=False, wires=True, alone=True)
          for name, top in (("mul_wide", "mul_wide"), ("dot3", "dot3"), ("axis", "sat_axis"),
                            ("project", "sat_project"), ("pipeline", "sat_pipeline"))), *tests,
        Row("tri_tri_leaf3", "cchip_primtest_tri_tri", "tri-tri", **leaf3),
        Row("tri_tri_registers", "cchip_primtest_tri_tri", "tri-tri", boxes=False),
        Row("chip", "cchip_chip", blocks=tuple(f"cchip_{block}" for block in blocks)))}


# ---- cell library


@dataclasses.dataclass(frozen=True)
class Cell:
    text: str
    area: float
    inputs: dict  # capacitance by pin
    output: str  # the only one, or empty
    function: str  # of that output
    register: bool


def truth(function, pins):
    """Values of a function of a Liberty file for all values of the pins, or None if it has other variables."""
    tokens = re.findall(r"\w+|[()!&*|+^']", function)
    words = {"!": "~", "&": "&", "*": "&", "|": "|", "+": "|", "^": "^"}
    if set(tokens) - {*words, "(", ")", *pins}:
        return None
    text = ""
    for before, token in zip(["", *tokens], tokens):
        both = re.fullmatch(r"\w+|\)", before) and re.fullmatch(r"\w+|\(|!", token)  # `A B` is A and B
        text += ("&" if both else "") + words.get(token, token)
    return [bool(eval(text, {}, {pin: i >> k & 1 for k, pin in enumerate(pins)}) & 1) for i in range(1 << len(pins))]


def cell(text):
    pins = re.split(r"(?<!\w)pin\s*\(\s*\"?(\w+)\"?\s*\)", text)[1:]
    number = lambda name, body: float((re.search(rf"(?<!\w){name}\s*:\s*\"?([-+.\deE]+)", body) or [0, 0])[1])
    inputs, outputs = {}, {}
    for pin, body in zip(pins[::2], pins[1::2]):
        direction = re.search(r"(?<!\w)direction\s*:\s*\"?(\w+)", body)
        if direction and direction[1] == "input":
            inputs[pin] = number("capacitance", body)
        elif direction and direction[1] == "output":
            outputs[pin] = (re.search(r"(?<!\w)function\s*:\s*\"([^\"]*)\"", body) or ["", ""])[1]
    [(output, function)] = outputs.items() if len(outputs) == 1 else [("", "")]
    return Cell(text, number("area", text), inputs, output, function, bool(re.search(r"(?<!\w)ff\s*\(", text)))


class Library:
    """A Liberty file, read as far as this flow needs it."""

    def __init__(self, text):
        starts = [found.start() for found in re.finditer(r"^[ \t]*cell[ \t]*\(", text, re.M)]
        self.head = text[:starts[0]]
        self.name = re.search(r"^\s*library\s*\(\s*\"?(\w+)", self.head, re.M)[1]
        bodies = [text[a:b] for a, b in zip(starts, [*starts[1:], text.rstrip().rfind("}")])]
        self.cells = {re.match(r"\s*cell\s*\(\s*\"?([\w$]+)", body)[1]: cell(body) for body in bodies}
        of = lambda pattern: re.search(pattern, self.head)
        time = of(r"time_unit\s*:\s*\"?([\d.]+)\s*(ps|ns)")
        self.ns = float(time[1]) * {"ps": 1e-3, "ns": 1}[time[2]]  # unit of time
        load = of(r"(?i)capacitive_load_unit\s*\(\s*([\d.]+)\s*,\s*\"?(ff|pf)")
        self.pf = float(load[1]) * {"ff": 1e-3, "pf": 1}[load[2].lower()]  # unit of capacitance
        self.inverter = self.smallest(1, [True, False], r"(?i)(x|_)1(_|$)")  # of the unit strength
        self.buffer = self.smallest(1, [False, True])
        self.nand2 = self.smallest(2, [True, True, True, False])

    def smallest(self, inputs, values, pattern=""):
        """Cell with this function and the least area, one whose name has the pattern if there is one."""
        # of cells alike, the plain one has the shortest name: inv_1, not clkinv_1
        fitting = [(not re.search(pattern, name), cell.area, len(name), name) for name, cell in self.cells.items()
                   if len(cell.inputs) == inputs and cell.function
                   and truth(cell.function, list(cell.inputs)) == values]
        if not fitting:
            raise fpga.ToolError(f"library {self.name}: no cell with {inputs} inputs and function {values}")
        return min(fitting)[-1]

    def only(self, names):
        """The file with these cells alone, which OpenSTA reads in a fraction of the time."""
        return self.head + "".join(self.cells[name].text for name in sorted(names)) + "\n}\n"

    def units(self):
        """Lines of the head with units and thresholds."""
        return "".join(re.findall(r"^[ \t]*(?:\w+_unit|\w+threshold_pct\w*)\s*[:(].*\n", self.head, re.M))


@functools.lru_cache(None)
def library(path):
    """(library, name of its uncompressed file as Yosys gets it)"""
    data = pathlib.Path(path).read_bytes()
    text = (gzip.decompress(data) if path.endswith(".gz") else data).decode()
    BUILD.mkdir(parents=True, exist_ok=True)
    copy = BUILD / f"{hashlib.sha256(text.encode()).hexdigest()[:12]}.lib"
    if not copy.exists():
        copy.write_text(text)
    return Library(text), str(copy.relative_to(ROOT))


# ---- tools

bar = progress.Progress(0, "rows")


def say(text):
    bar.say(text, sys.stderr)


def run(name, tool, files, depends, product):
    command, option = {"yosys": (["yosys", "-q", "-T", "-s", "{}/run.ys"], "-V"),
                       "sta": (["sta", "-no_splash", "-exit", "{}/run.tcl"], "-version")}[tool]
    if not shutil.which(tool):
        sys.exit(f"asic.py: no {tool}; run: scripts/bootstrap --dev")
    return fpga.step(name, command, files, [depends, fpga.version(tool, option)], product, BUILD)


def memories(netlist):
    """Memories of the JSON of Yosys, [{module, cell, words, width, ports..}]; kind: name of the box."""
    number = lambda value: int(value, 2) if isinstance(value, str) else value
    found = []
    for module, body in json.loads(netlist)["modules"].items():
        for name, cell in body["cells"].items():
            if cell["type"] != "$mem_v2":
                continue
            value = {key: number(cell["parameters"][key]) for key in ("SIZE", "WIDTH", "RD_PORTS", "WR_PORTS")}
            clocked = cell["parameters"]["RD_CLK_ENABLE"][-1] == "1"  # a digit for each port
            ports = {port: len(bits) for port, bits in cell["connections"].items()}
            one = {"module": module, "cell": name, "words": value["SIZE"], "width": value["WIDTH"],
                   "bits": value["SIZE"] * value["WIDTH"], "reads": value["RD_PORTS"], "writes": value["WR_PORTS"],
                   "clocked": clocked, "ports": ports, "parameters": sorted(cell["parameters"])}
            shape = json.dumps([one["clocked"], ports], sort_keys=True)
            one["kind"] = f"mem_{one['words']}x{one['width']}_{hashlib.sha256(shape.encode()).hexdigest()[:6]}"
            found.append(one)
    return found


def is_sram(memory):
    return memory["words"] >= SRAM_WORDS and memory["bits"] >= SRAM_BITS


def generic(row):
    """(folder with generic.il, the boxes): synthesis that does not depend on the library."""
    text = fpga.needed(row.top, row.files)
    keep = [f"*{LEAF}*"] if row.top != LEAF else []
    keep += [f"*{block}{rest}" for block in row.blocks for rest in ("", "?[A-Z]*")]
    script = fpga.read_verilog(text, *row.macros) + f"hierarchy -check -top {row.top}\nrename -top {row.top}\n" + (
        "setattr -mod -unset keep_hierarchy *\n" + "".join(f"setattr -mod -set keep_hierarchy 1 {k}\n" for k in keep) +
        f"synth -top {row.top} -flatten -run begin:fine\nwrite_json {{}}/coarse.json\nwrite_ilang {{}}/coarse.il\n")
    coarse = run(f"{row.name}.coarse", "yosys", {"run.ys": script}, text, "coarse.il")
    boxes = [memory for memory in memories((coarse / "coarse.json").read_text())
             if row.boxes and memory["bits"] >= BOX_BITS and memory["writes"]]
    # brackets in names are patterns
    script = f"read_ilang {coarse.relative_to(ROOT)}/coarse.il\nhierarchy -top {row.top}\n" + "".join(
        f"cd {box['module']}\nchtype -set {box['kind']} c:{re.sub(r'[][]', '?', box['cell'])}\ncd\n" for box in boxes)
    script += "".join(f"setparam -unset {name} t:mem_*\n"
                      for name in sorted({p for box in boxes for p in box["parameters"]}))
    script += ("opt -fast -full\nmemory_map\nopt -full\ntechmap\nopt -fast\nabc -fast\nopt -fast\n"
               # cchip_delay has initial values, which cells do not have
               "setattr -unset init\nopt_clean -purge\nwrite_ilang {}/generic.il\n")
    return run(f"{row.name}.generic", "yosys", {"run.ys": script}, [], "generic.il"), boxes


# The script that Yosys gives ABC undoes fast adders.
ABC = "strash\n&get -n\n&st\n&dch\n&nf\n&put\nbuffer -c\ntopo\nupsize {D}\ndnsize {D}\n"


def mapped(row, path):
    """(folder with netlist.v, the boxes): cells of the library."""
    lib, file = library(path)
    folder, boxes = generic(row)
    fo4_ns = fo4(path)
    inverter = lib.cells[lib.inverter]
    load = 4 * sum(inverter.inputs.values()) * lib.pf * 1000
    script = (f"read_ilang {folder.relative_to(ROOT)}/generic.il\n"
              # registers keep their names, for the critical path
              "dfflegalize -cell $_DFF_P_ x\nsimplemap\nopt_clean\nrename -wire t:$_DFF_*\n"
              f"dfflibmap -liberty {file}\n"
              f"abc -liberty {file} -constr {{}}/constraints -D {10000 * fo4_ns:.0f} -script {{}}/abc.script\n"
              "setundef -zero\nopt_clean -purge\nwrite_verilog -noattr -noexpr -simple-lhs {}/raw.v\n")
    files = {"run.ys": script, "abc.script": ABC,
             "constraints": f"set_driving_cell {lib.buffer}\nset_load {load:.3g}\n"}
    folder = run(f"{row.name}.{lib.name}", "yosys", files, file, "raw.v")
    if not (folder / "netlist.v").exists():
        text, names = plain((folder / "raw.v").read_text())
        (folder / "names.json").write_text(json.dumps(names))
        (folder / "cells.lib").write_text(lib.only(set(instances(text)) & set(lib.cells)))
        (folder / "boxes.lib").write_text(box_library(lib, fo4_ns, {box["kind"]: box for box in boxes}))
        (folder / "netlist.v").write_text(text)
    names = json.loads((folder / "names.json").read_text())
    return folder, [{**box, "module": names.get(box["module"], box["module"])} for box in boxes]


# ---- netlists


def bits(expression, wide):
    """Every bit of an expression of a netlist; wide: (high, low) of the vectors."""
    expression = expression.strip()
    escaped = lambda name: name + " " if name.startswith("\\") else name
    if expression.startswith("{"):
        return [bit for part in expression[1:-1].split(",") for bit in bits(part, wide)]
    if (found := re.fullmatch(r"(\S+?)\s*\[(\d+):(\d+)\]", expression)) and found[1] in wide:
        return [f"{escaped(found[1])}[{i}]" for i in range(int(found[2]), int(found[3]) - 1, -1)]
    if found := re.fullmatch(r"(\d+)'h([0-9a-fx]+)", expression):
        value = int(found[2].replace("x", "0"), 16)
        return [f"1'b{value >> i & 1}" for i in range(int(found[1]) - 1, -1, -1)]
    if found := re.fullmatch(r"(\d+)'d(\d+)", expression):
        return [f"1'b{int(found[2]) >> i & 1}" for i in range(int(found[1]) - 1, -1, -1)]
    if found := re.fullmatch(r"(\d+)'b([01xz]+)", expression):
        return [f"1'b{int(c == '1')}" for c in found[2].rjust(int(found[1]), "0")]
    if expression in wide:
        return [f"{escaped(expression)}[{i}]" for i in range(wide[expression][0], wide[expression][1] - 1, -1)]
    if (found := re.fullmatch(r"(\S+?)\s*\[(\d+)\]", expression)) and found[1] in wide:
        return [f"{escaped(found[1])}[{found[2]}]"]
    return [escaped(expression)]


def plain(text):
    """(netlist as OpenSTA of 2019 reads it, new names of the modules): assignments bit by bit, names without
    parameters."""
    made = []
    for module in re.split(r"(?<=^endmodule\n)", text, flags=re.M):
        declared = re.finditer(r"^\s*(?:input|output|wire|reg)\s+(?:signed\s+)?\[(\d+):(\d+)\]\s+(\S+?)\s*;",
                               module, re.M)
        wide = {found[3]: (int(found[1]), int(found[2])) for found in declared}

        def single(found):
            left, right = bits(found[1], wide), bits(found[2], wide)
            if len(left) != len(right):
                raise fpga.ToolError(f"netlist: {len(left)} and {len(right)} bits in '{found[0].strip()[:100]}'")
            return "".join(f"  assign {a} = {b};\n" for a, b in zip(left, right))
        made.append(re.sub(r"^  assign (.*?) = (.*?);\n", single, module, flags=re.M))
    names, used = {}, collections.Counter()

    def short(found):
        old = found[0].strip()[1:]
        if old not in names:
            names[old] = f"{found[1]}__{used[found[1]]}"
            used[found[1]] += 1
        return names[old] + " "
    return re.sub(r"\\\$paramod\S*\\(cchip_\w+?)(?:\\\S*)? ", short, "".join(made)), names


def modules(text):
    """Cells and modules inside every module, {module: {type: count}}."""
    return {re.match(r"\s*([^\s(]+)", module)[1]: instances(module)
            for module in re.split(r"^module ", text, flags=re.M)[1:]}


def instances(text):
    kinds = re.findall(r"^  (\w+) +(?:\\\S+|\w+) +\($", text, re.M)
    return collections.Counter(kind for kind in kinds if kind not in ("assign", "input", "output", "wire", "module"))


def totals(inside, top, lib, boxes):
    """Area, flip-flops, multiplier leaves and memory bits below a module."""
    sums = collections.Counter()
    for box in boxes:
        if box["module"] == top:
            sums["sram" if is_sram(box) else "small"] += box["bits"]
    for kind, count in inside[top].items():
        if kind in lib.cells:
            sums["um2"] += count * lib.cells[kind].area
            sums["ff"] += count * lib.cells[kind].register
        elif kind in inside:
            for key, value in totals(inside, kind, lib, boxes).items():
                sums[key] += count * value
            sums["leaves"] += count * kind.startswith(LEAF)
        elif not kind.startswith("mem_"):
            raise fpga.ToolError(f"netlist: cell {kind} in {top}, which library {lib.name} does not have")
    return sums


# ---- timing


def box_library(lib, fo4_ns, kinds):
    """Liberty file of the memories with the delays that docs/hardware/asic.md assumes, in FO4."""
    delay = lambda n: f"{n * fo4_ns / lib.ns:.5f}"

    def arc(related, kind, n):
        tables = ("rise_constraint", "fall_constraint") if "setup" in kind else (
            "cell_rise", "cell_fall", "rise_transition", "fall_transition")
        kind = f"timing_type : {kind};" if kind else "timing_sense : non_unate;"
        return f'timing() {{ related_pin : "{related}"; {kind} ' + " ".join(
            f'{table}(scalar) {{ values("{delay(n)}"); }}' for table in tables) + " }"

    widths = sorted({width for box in kinds.values() for width in box["ports"].values() if width > 1})
    out = ["library (boxes) {", "delay_model : table_lookup;", lib.units()]
    out += [f"type (b{w}) {{ base_type : array; data_type : bit; bit_width : {w}; bit_from : {w - 1}; bit_to : 0; "
            "downto : true; }" for w in widths]
    for kind, box in kinds.items():
        out.append(f"cell ({kind}) {{ area : 0; is_macro_cell : true; interface_timing : true;")
        clock = lambda port: port if box["ports"][port] == 1 else f"{port}[0]"
        for port, width in box["ports"].items():
            if port == "RD_CLK" and not box["clocked"]:
                continue
            head, arcs = f"direction : input; capacitance : {0.002 / lib.pf:g};", []
            if port == "RD_DATA":
                head = "direction : output;"
                if box["clocked"]:
                    arcs = [arc(clock("RD_CLK"), "rising_edge", 14 if is_sram(box) else 4)]
                else:
                    arcs = [arc("RD_ADDR", "", 8), arc(clock("WR_CLK"), "rising_edge", 11)]
            elif port.endswith("CLK"):
                head = "direction : input; capacitance : 0;" + (" clock : true;" if width == 1 else "")
            elif port.startswith("WR"):
                arcs = [arc(clock("WR_CLK"), "setup_rising", 3 if port == "WR_DATA" else 5)]
                if port == "WR_EN":  # a pin a bit in Yosys, a pin a word in silicon
                    head = f"direction : input; capacitance : {0.002 / lib.pf / width:g};"
            elif box["clocked"] and port in ("RD_ADDR", "RD_EN"):
                arcs = [arc(clock("RD_CLK"), "setup_rising", 5 if is_sram(box) else 11)]
            bus = f"bus ({port}) {{ bus_type : b{width};" if width > 1 else f"pin ({port}) {{"
            out.append(f"  {bus} {head} {' '.join(arcs)} }}")
        out.append("}")
    return "\n".join([*out, "}"]) + "\n"


@functools.lru_cache(None)
def fo4(path):
    """ns of an inverter of the least size that drives four like it, mean of both edges."""
    lib, file = library(path)
    name, stages = lib.inverter, 24
    [pin], out = lib.cells[name].inputs, lib.cells[name].output
    lines = [f"module chain(input i, output o); wire [{stages}:0] w; assign w[0] = i; assign o = w[{stages}];"]
    for k in range(stages):
        lines.append(f"{name} s{k} (.{pin}(w[{k}]), .{out}(w[{k + 1}]));")
        lines += [f"wire d{k}_{j}; {name} l{k}_{j} (.{pin}(w[{k}]), .{out}(d{k}_{j}));" for j in range(3)]
    script = ("read_liberty {}/cells.lib\nread_verilog {}/chain.v\nlink_design chain\n"
              "set_max_delay 100000 -from [get_ports i] -to [get_ports o]\nset_input_delay 0 [get_ports i]\n"
              "report_checks -digits 6 > {}/report\n")
    files = {"run.tcl": script, "chain.v": "\n".join([*lines, "endmodule\n"]), "cells.lib": lib.only({name})}
    report = (run(f"fo4.{lib.name}", "sta", files, [], "report") / "report").read_text()
    at = {found[2]: float(found[1]) for found in re.finditer(rf"([\d.]+) [v^] (s\d+)/{out}", report)}
    return (at["s22"] - at["s6"]) / 16 * lib.ns


def signal(pin):
    """What OpenSTA's start or end of a path is called in the RTL: the bits of a register have one name."""
    return re.sub(r"\[\d+\]$", "", re.sub(r"\$?_\$?_?S?DFF\w*$", "", pin.replace("\\", ""))).rstrip("$")


def path_of(report):
    """(start, end, slack, cells) of a report of OpenSTA's slowest path."""
    ends = [re.search(rf"^{what}: (\S+)", report, re.M) for what in ("Startpoint", "Endpoint")]
    slack = re.search(r"^\s+([-\d.]+)\s+slack", report, re.M)
    if not (slack and all(ends)):
        raise fpga.ToolError("OpenSTA: no path from register to register in its report")
    pins = re.findall(r"^\s+[-\d.]+\s+[-\d.]+ [v^] (\S+)/\S+ \(", report, re.M)
    return signal(ends[0][1]), signal(ends[1][1]), float(slack[1]), len(dict.fromkeys(pins))


def power_of(report):
    """(watts that follow the clock, watts of leakage) of a report of OpenSTA."""
    internal, switching, leakage, _ = map(float, re.search(r"^Total((?:\s+[-+.\deE]+){4})", report, re.M)[1].split())
    return internal + switching, leakage


def sta(name, folder, top, period, ask, boxes):
    here = folder.relative_to(ROOT)
    script = (f"read_liberty {here}/cells.lib\n" + (f"read_liberty {here}/boxes.lib\n" if boxes else "") +
              f"read_verilog {here}/netlist.v\nlink_design {top}\ncreate_clock -name clk -period {period:g} [get_ports "
              "clk]\n"
              f"{ask}")
    return run(name, "sta", {"run.tcl": script}, folder.name, "report")


def analyse(row, path, beats, top, name):
    """Figures of one module of a mapped row."""
    lib, _ = library(path)
    folder, boxes = mapped(row, path)
    inside = modules((folder / "netlist.v").read_text())
    sums = totals(inside, top, lib, boxes)
    period = 400 * fo4(path) / lib.ns
    label = f"{name}.{lib.name}"
    report = sta(f"{label}.sta", folder, top, period,
                 "report_checks -path_delay max -format full -digits 5 > {}/report\n", boxes)
    start, end, slack, cells = path_of((report / "report").read_text())
    ns = (period - slack) * lib.ns
    mhz = 1000 / ns
    made = {"library": lib.name, "top": row.top, "module": top, "um2": round(sums["um2"], 1),
            "nand2": round(sums["um2"] / lib.cells[lib.nand2].area), "ff": sums["ff"], "leaves": sums["leaves"],
            "small_bits": sums["small"], "sram_bits": sums["sram"], "ns": round(ns, 4), "fo4": round(ns / fo4(path), 1),
            "fo4_ps": round(1000 * fo4(path), 1), "mhz": round(mhz, 1), "start": start, "end": end, "cells": cells}
    if not row.blocks or top != row.top:  # OpenSTA of 2019 dies in a design of three levels
        ask = "".join(f"set_power_activity -global -activity {a}\nreport_power -digits 6 > {{}}/power{a}\n"
                      for a in ACTIVITIES)
        report = sta(f"{label}.power", folder, top, period, ask + "report_checks > {}/report\n", boxes)
        made["mw"] = {}
        for a in ACTIVITIES:
            clocked, leakage = power_of((report / f"power{a}").read_text())
            made["mw"][str(a)] = 1000 * (clocked * period * lib.ns / ns + leakage)
    if beats:
        rate = mhz / beats
        made.update(beats=beats, mpairs=rate, pj={a: 1000 * mw / rate for a, mw in made["mw"].items()})
    return made


def measure(row, options):
    """Figures by line of the table."""
    beats = 0
    if row.shape:
        beats = fpga.mean_beats(row.shape, options).get(fpga.TYPICAL, {}).get("directed", 0)
    found = {row.name: analyse(row, options.liberty, beats, row.top, row.name)}
    say(last_line(row.name, found[row.name]))
    folder, _ = mapped(row, options.liberty)
    kept = modules((folder / "netlist.v").read_text())
    for block in row.blocks:
        for top in sorted(module for module in kept if re.fullmatch(rf"{block}(__\d+)?", module)):
            name = f"{row.name}.{top.replace('cchip_', '').replace('__0', '')}"
            found[name] = analyse(row, options.liberty, 0, top, name)
            say(last_line(name, found[name]))
    return found


# ---- place and route


def layers(lef):
    """Routing layers of a LEF file: {name: (um of a wire's width, pF of a um2, pF of a um of its edge)}."""
    number = lambda pattern, body: float(re.search(rf"^\s*{pattern}\s+(\S+)", body, re.M)[1])
    return {found[1]: tuple(number(name, found[2]) for name in ("WIDTH", "CAPACITANCE CPERSQDIST", "EDGECAPACITANCE"))
            for found in re.finditer(r"^LAYER (\w+)\s+TYPE\s+ROUTING ;(.*?)^END \1", re.sub(r"[ \t]+", " ", lef),
                                     re.M | re.S)}


def wires_of(placed):
    """(um2 of the die, {net: {layer: um}}) of a routed DEF file."""
    units = float(re.search(r"^UNITS DISTANCE MICRONS (\d+)", placed, re.M)[1])
    corners = [int(value) / units for value in re.search(
        r"^DIEAREA \( (\S+) (\S+) \) \( (\S+) (\S+) \)", placed, re.M).groups()]
    nets = re.search(r"^NETS \d+ ;\n(.*?)^END NETS", placed, re.M | re.S)[1]
    found = {}
    for body in re.split(r"^- ", nets, flags=re.M)[1:]:
        length = found[body.split()[0]] = collections.Counter()
        for layer, points in re.findall(r"(?:ROUTED|NEW) (\w+)((?: \( \S+ \S+ (?:\S+ )?\))+)", body):
            at = None
            for pair in re.findall(r"\( (\S+) (\S+)", points):
                here = [at[k] if value == "*" else int(value) for k, value in enumerate(pair)]
                if at:
                    length[layer] += sum(abs(a - b) for a, b in zip(here, at)) / units
                at = here
    return (corners[2] - corners[0]) * (corners[3] - corners[1]), found


def capacitance(length, metal):
    """pF of a net by the rule of LEF: its area and both of its edges."""
    return sum(um * (metal[layer][0] * metal[layer][1] + 2 * metal[layer][2]) for layer, um in length.items())


def tree_of(line):
    """(net, driver, [(ohm, pF, index of the parent or -1, pins)]) of a line of qrouter's delay file."""
    net, drivers, driver, sinks, *words = line.split()
    if drivers != "1":
        raise fpga.ToolError(f"qrouter: net {net} has {drivers} drivers")
    segments, path, at = [], [], 0
    while at < len(words):
        if words[at] == "(":
            segments.append((float(words[at + 1]), float(words[at + 2]), path[-1] if path else -1, []))
            path.append(len(segments) - 1)
            at += 2
        elif words[at] == ")" and path:
            path.pop()
        elif words[at] != ",":
            segments[path[-1]][3].append(words[at])
        at += 1
    if path or sum(len(pins) for *_, pins in segments) != int(sinks):
        raise fpga.ToolError(f"qrouter: net {net} does not reach its {sinks} sinks in the delay file")
    return net, driver, segments


def spef(trees, total):
    """SPEF file of the trees of qrouter's delay file; total: pF of a net, or None for those of the delay file."""
    out = ['*SPEF "IEEE 1481-1998"', '*DESIGN "design"', '*DATE "-"', '*VENDOR "-"', '*PROGRAM "asic.py"',
           '*VERSION "1"', '*DESIGN_FLOW "-"', "*DIVIDER /", "*DELIMITER :", "*BUS_DELIMITER []", "*T_UNIT 1 NS",
           "*C_UNIT 1 PF", "*R_UNIT 1 OHM", "*L_UNIT 1 HENRY", ""]
    name = lambda pin: pin[4:] if pin.startswith("PIN/") else pin.replace("/", ":")
    for net, driver, segments in trees:
        all_pf = sum(pf for _, pf, *_ in segments)
        scale = 1 if total is None or not all_pf else total[net] / all_pf
        out += [f"*D_NET {net} {scale * all_pf:.6g}", "*CONN"]
        for pin, way in [(driver, "O"), *((pin, "I") for *_, pins in segments for pin in pins)]:
            port = pin.startswith("PIN/")
            out.append(f"*P {name(pin)} {'I' if way == 'O' else 'O'}" if port else f"*I {name(pin)} {way}")
        caps, resistors = collections.Counter(), []
        for k, (ohm, pf, parent, pins) in enumerate(segments):
            ends = name(driver) if parent < 0 else f"{net}:{parent}", f"{net}:{k}"
            for end in ends:
                caps[end] += scale * pf / 2
            resistors.append((*ends, ohm))
            resistors += [(ends[1], name(pin), 0.001) for pin in pins]
        out.append("*CAP")
        out += [f"{i} {node} {pf:.6g}" for i, (node, pf) in enumerate(caps.items(), 1)]
        out.append("*RES")
        out += [f"{i} {a} {b} {ohm:.6g}" for i, (a, b, ohm) in enumerate(resistors, 1)]
        out += ["*END", ""]
    return "\n".join(out)


def unrouted(log):
    """Nets that qrouter says it has not routed. The script of qflow looks for another file than qrouter writes."""
    found = re.findall(r"(No failed routes!)|Failed net routes: (\d+)", log)
    if not found:
        raise fpga.ToolError("qrouter: its log does not say whether all nets are routed")
    return int(found[-1][1] or 0)


def stopped(log, minutes, limit):
    """Why a tool gave no result, if --limit is the reason."""
    if not limit or minutes < 0.99 * limit:
        return ""
    left = re.findall(r"^Nets remaining: (\d+)", log, re.M)
    passes = re.search(r"( +\d+)+\s*\Z", log)  # graywolf anneals in 150
    where = f", {left[-1]} nets to go" if left else f", in pass {passes[0].split()[-1]} of 150" if passes else ""
    return f"not done after {minutes:.0f} minutes{where}"


class Stopped(Exception):
    """A tool has reached --limit: a result, not an error."""


def measured(name, command, files, depends, product, tool, limit):
    """(folder, minutes) of a step of place and route; what stopped it is kept, too."""
    key = hashlib.sha256(json.dumps([files, depends]).encode()).hexdigest()[:12]
    note = BUILD / f"{name}-{key}.stopped.json"
    if note.exists() and (kept := json.loads(note.read_text()))["limit"] >= (limit or 1e9):
        raise Stopped(kept["reason"])
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    spent = lambda: sum(b - a for a, b in zip(before[:2], resource.getrusage(resource.RUSAGE_CHILDREN)[:2])) / 60
    try:
        folder = fpga.step(name, command, files, depends, product, BUILD)
    except fpga.ToolError:
        log = "".join(path.read_text(errors="replace") for path in (BUILD / f"{name}.failed/logs").glob("*.log"))
        if not (reason := stopped(log, spent(), limit)):
            raise
        reason = f"{tool}: {reason}"
        note.write_text(json.dumps({"limit": limit or 1e9, "reason": reason}))
        raise Stopped(reason) from None
    if not (folder / "minutes").exists():
        (folder / "minutes").write_text(f"{spent():.3f}")
    return folder, float((folder / "minutes").read_text())


def project():
    """Files that the scripts of qflow want; {} is the folder."""
    here = f"{ROOT}/{{}}"
    names = {"projectpath": here, "sourcedir": here, "synthdir": here, "layoutdir": here, "logdir": f"{here}/logs",
             "techdir": TECH, "techname": "osu018", "scriptdir": f"{QFLOW}/scripts", "bindir": f"{QFLOW}/bin"}
    return {"qflow_vars.sh": "".join(f"set {name}={value}\n" for name, value in names.items()),
            "project_vars.sh": 'set vddnet="vdd"\nset gndnet="gnd"\n'}


def flat(row, path):
    """Netlist without hierarchy, in BLIF; names are numbers."""
    lib, _ = library(path)
    folder, boxes = mapped(row, path)
    if boxes:
        raise fpga.ToolError("has memories, which have no layout")
    [pin], buffer = lib.cells[lib.buffer].inputs, lib.buffer
    here = folder.relative_to(ROOT)
    script = (f"read_liberty -lib {here}/cells.lib\nread_verilog {here}/netlist.v\nhierarchy -top {row.top}\nflatten\n"
              "opt_clean -purge\nsplitnets -ports -format __\nopt_clean -purge\nrename -hide w:* c:*\n"
              "rename -enumerate\n"
              # the library has no cell for a constant: they are ports
              "write_blif -gates -true - one_ -false - zero_ -undef - zero_ "
              f"-buf {buffer} {pin} {lib.cells[buffer].output} {{}}/design.blif\n")
    made = run(f"{row.name}.flat", "yosys", {"run.ys": script}, folder.name, "design.blif")
    text = (made / "design.blif").read_text()
    gates = [line for line in text.splitlines() if line.startswith(".gate")]
    head = [line for line in text.splitlines() if line.startswith((".model", ".inputs", ".outputs"))]
    # one line of inputs: qflow loses ports that a second one names
    ports = "".join(f" {name}" for name in ("zero_", "one_") if any(f"={name}" in line for line in gates))
    head = [line + ports if line.startswith(".inputs") else line for line in head]
    return "\n".join([*head, *gates, ".end"]) + "\n", len(gates)


def lay_out(row, options):
    """Figures with wires, or why there are none."""
    lib, _ = library(options.liberty)
    blif, cells = flat(row, options.liberty)
    area = sum(lib.cells[kind].area for kind in re.findall(r"^\.gate (\w+)", blif, re.M))
    made = {"cells": cells, "gates_um2": round(area)}
    try:
        files = {**project(), "design.blif": blif, "design.par": pathlib.Path(TECH, "osu018.par").read_text(),
                 "design_powerground": "", **{f"design.{rest}": "" for rest in ("rtl.v", "rtlnopwr.v", "rtlbb.v")}}
        script = lambda name, *more: [f"{QFLOW}/scripts/{name}.sh", *more, f"{ROOT}/{{}}", "design"]
        place, minutes = measured(f"{row.name}.place", script("placement", "-d"), files, package("graywolf"),
                                  "design_unroute.def", "graywolf", options.limit)
        say(f"{row.name}: {cells} cells placed in {minutes:.1f} minutes")
        files = {**project(), **{name: (place / name).read_text()
                                 for name in ("design.cfg", "design_unroute.def", "design.rtlnopwr.v")}}
        made["place_minutes"] = minutes
        route, made["route_minutes"] = measured(f"{row.name}.route", script("router"), files, package("qrouter"),
                                                "design.rc", "qrouter", options.limit)
    except Stopped as error:
        return {**made, "stopped": str(error)}
    if missing := unrouted((route / "logs/route.log").read_text(errors="replace")):
        return {**made, "stopped": f"qrouter: {missing} nets unrouted after {made['route_minutes']:.0f} minutes"}
    metal = layers(pathlib.Path(TECH, "osu018_stdcells.lef").read_text())
    made["die_um2"], lengths = wires_of((route / "design.def").read_text())
    trees = [tree_of(line) for line in (route / "design.rc").read_text().splitlines() if line.strip()]
    made.update(wire_mm=sum(sum(length.values()) for length in lengths.values()) / 1000, unrouted=0,
                nets=len(trees))
    pf = {net: capacitance(length, metal) for net, length in lengths.items()}
    made["wire_pf"] = sum(pf.values())
    netlist = (route / "design.rtlnopwr.v").read_text()
    for key, wires in (("", ""), ("wires_", spef(trees, pf)), ("qrouter_", spef(trees, None))):
        made.update(timed(f"{row.name}.{key}layout", row.top, netlist, wires, key, options))
    return made


def timed(name, top, netlist, wires, key, options):
    """ns and MHz of a placed netlist, with the wires of a SPEF file if there are some."""
    lib, _ = library(options.liberty)
    period = 400 * fo4(options.liberty) / lib.ns
    files = {"run.tcl": ("read_liberty {}/cells.lib\nread_verilog {}/netlist.v\n"
                         f"link_design {top}\ncreate_clock -name clk -period {period:g} [get_ports clk]\n"
                         + ("read_spef {}/wires.spef\n" if wires else "") +
                         "report_checks -path_delay max -format full -digits 5 > {}/report\n"),
             "cells.lib": lib.only(set(re.findall(r"^(\w+) \w+ \( \.", netlist, re.M)) & set(lib.cells)),
             "netlist.v": netlist, **({"wires.spef": wires} if wires else {})}
    folder = run(name, "sta", files, [], "report")
    if problem := re.search(r"^(?:Error|Warning).*", (folder / "log").read_text(), re.M):
        raise fpga.ToolError(f"OpenSTA: {problem[0]}")
    start, end, slack, cells = path_of((folder / "report").read_text())
    ns = (period - slack) * lib.ns
    return {f"{key}ns": ns, f"{key}mhz": 1000 / ns, f"{key}path": cells}


@functools.lru_cache(None)
def package(tool):
    """Version of a tool of qflow, or the end with what installs it."""
    if not (shutil.which(tool) and os.path.exists(f"{QFLOW}/scripts/placement.sh")):
        sys.exit(f"asic.py: no {tool} of qflow; run: scripts/bootstrap --dev")
    return [subprocess.run(["dpkg-query", "-W", tool, "qflow"], stdout=subprocess.PIPE, text=True).stdout]


def wires_line(name, r):
    if "stopped" in r:
        return f"{name} cells={r['cells']} stopped: {r['stopped']}"
    return (f"{name} cells={r['cells']} die_um2={r['die_um2']:.0f} wire_mm={r['wire_mm']:.1f} mhz={r['mhz']:.1f} "
            f"wires_mhz={r['wires_mhz']:.1f} unrouted={r['unrouted']} "
            f"minutes={r['place_minutes'] + r['route_minutes']:.1f}")


def wired(row, options):
    found = lay_out(row, options)
    say(wires_line(row.name, found))
    return {row.name: found}


def wires_table(found):
    body = []
    for name, r in found.items():
        line = [f"`{name}`", f"{r['cells']:,}", f"{r['gates_um2']:,}"]
        minutes = [f"{r[key]:.1f}" if key in r else "-" for key in ("place_minutes", "route_minutes")]
        if "stopped" in r:
            line += [*["-"] * 8, minutes[0], r["stopped"]]
        else:
            line += [f"{r['die_um2']:,.0f}", f"{100 * r['gates_um2'] / r['die_um2']:.0f} %", f"{r['wire_mm']:,.0f}",
                     f"{1000 * r['wire_mm'] / r['nets']:.0f}",
                     *(f"{r[key]:.0f}" for key in ("mhz", "wires_mhz", "qrouter_mhz")),
                     f"{100 * r['wires_mhz'] / r['mhz'] - 100:.0f} %", *minutes]
        body.append(line)
    return datasheet.table(["row", "cells", "um2 of cells", "um2 of the die", "full", "mm of wire", "um a net", "MHz",
                            "MHz with wires", "MHz, one edge", "change", "minutes to place", "minutes to route"], body)


# ---- output


def last_line(name, r):
    watts = "/".join(f"{mw:.4g}" for mw in r.get("mw", {}).values())
    energy = "/".join(f"{pj:.4g}" for pj in r.get("pj", {}).values())
    return (f"{name} um2={r['um2']:.0f} nand2={r['nand2']} ff={r['ff']} bits={r['small_bits'] + r['sram_bits']} "
            f"ns={r['ns']:.3f} "
            f"fo4={r['fo4']:.1f} mhz={r['mhz']:.1f}" + (f" mw={watts}" if watts else "") +
            (f" mpairs={r['mpairs']:.1f} pj={energy}" if energy else ""))


def cells_of(name, r):
    return [f"`{name}`", r["leaves"], r["ff"], r["small_bits"], r["sram_bits"], f"{r['um2']:,.0f}", f"{r['nand2']:,}",
            f"{r['ns']:.2f}" if r["ns"] >= 1 else f"{r['ns']:.3f}", f"{r['fo4']:.1f}", f"{r['mhz']:.0f}"]


HEAD = ["row", "leaves", "FF", "small memories, bit", "large memories, bit", "um2", "NAND2", "ns", "FO4", "MHz"]
WATTS = " / ".join(f"{a}" for a in ACTIVITIES)


def several(figures):
    return " / ".join(f"{value:,.0f}" if value >= 100 else f"{value:.3g}" for value in figures.values()) or "-"


def critical(r):
    """The registers of the path; their instances are in the CSV file."""
    short = lambda name: name.split(".")[-1]
    return f"`{short(r['start'])}` -> `{short(r['end'])}`: {r['cells']} cells"


def tests_table(found):
    body = [[*cells_of(name, r), f"{r['mpairs']:.1f}" if "mpairs" in r else "-", several(r.get("mw", {})),
             several(r.get("pj", {})),
             critical(r)] for name, r in found.items() if not name.startswith("chip")]
    return datasheet.table([*HEAD, "10^6 pairs/s", f"mW at {WATTS}", f"pJ a pair at {WATTS}", "critical path"], body)


def chip_table(found):
    body = [[*cells_of(name, r), several(r.get("mw", {})), critical(r)]
            for name, r in found.items() if name.startswith("chip")]
    return datasheet.table([*HEAD, f"mW at {WATTS}", "critical path"], body)


TABLES = {"tests": tests_table, "chip": chip_table}


def arguments():
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("rows", nargs="*")
    parser.add_argument("--liberty", type=os.path.abspath, default=LIBERTY)
    parser.add_argument("--campaign", type=os.path.abspath, default=ROOT / "build/release/bin/cchip_campaign")
    parser.add_argument("--pairs", type=int, default=20000)
    parser.add_argument("--limit", type=float)
    for flag in ("--write", "--list", "--wires"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args()
    unknown = sorted(set(options.rows) - set(rows()))
    if unknown:
        parser.error(f"no row {unknown[0]}, one of: {' '.join(rows())}")
    if options.wires and options.liberty != LIBERTY:
        parser.error(f"--wires has layouts of the cells of {LIBERTY} alone")
    if not options.list and not os.path.exists(options.liberty):
        parser.error(f"no {options.liberty}; Debian's qflow-tech-osu018 has the default: scripts/bootstrap --dev")
    return options


def save(name, found):
    path = BUILD / f"{name}.json"
    kept = json.loads(path.read_text()) if path.exists() else {}
    path.write_text(json.dumps({**kept, **found}, indent=2) + "\n")


def tree():
    """What was measured, for the page."""
    git = lambda *command: subprocess.run(["git", "-C", str(ROOT), *command], check=True, stdout=subprocess.PIPE,
                                          text=True).stdout.strip()
    changed = " with changes" if git("status", "--porcelain", "rtl") else ""
    return (f"git tree `{git('rev-parse', 'HEAD:rtl')}` of `rtl/` (commit "
            f"{git('log', '-1', '--format=%h', '--', 'rtl')}){changed}")


def with_others(block, head, made):
    """The block with the rows of the page that are not in the table made, if they have the same head."""
    row = lambda line: line.split("`")[1].split(".")[0]
    title, lines = made.splitlines()[:2], made.splitlines()[2:]
    new = {row(line) for line in lines}
    others = [line for line in block.splitlines() if line.startswith("| `") and row(line) not in new]
    if others and (head not in block or title[0] not in block):
        say(f"asic.py: dropped from the page, measured on another rtl/: {' '.join(map(row, others))}")
        others = []
    order = list(rows())
    return "\n".join([head, "", *title, *sorted(others + lines, key=lambda line: order.index(row(line)))]) + "\n"


def write_csv(name, found):
    """All figures of all libraries with the critical paths by their instances; rows of this run replace older ones."""
    columns = ["library", "row", "rtl", "leaves", "ff", "small_bits", "sram_bits", "um2", "nand2", "ns", "fo4",
               "fo4_ps", "mhz", "start", "end",
               "cells"]
    kept, rtl = {}, tree().split("`")[1]
    if CSV.exists():
        with open(CSV, newline="") as file:
            kept = {(line["library"], line["row"]): line for line in csv.DictReader(file)}
    for row, r in found.items():
        kept[name, row] = {"rtl": rtl, **r, "library": name, "row": row}
    order = list(rows())
    with open(CSV, "w", newline="") as file:
        lines = csv.DictWriter(file, columns, extrasaction="ignore", lineterminator="\n")
        lines.writeheader()
        lines.writerows(line for _, line in sorted(kept.items(),
                                                   key=lambda one: (one[0][0], order.index(one[0][1].split(".")[0]))))


def write(name, found):
    """Rewrites the tables of the library; rows of the page that are not in found stay if the RTL is the same."""
    head = f"RTL: {tree()}. FO4: {next(iter(found.values()))['fo4_ps']} ps."
    for table, make in TABLES.items():
        write_table(f"{name} {table}", head, make(found))


def write_table(name, head, made):
    if made.count("\n") <= 2:
        return
    block = re.search(datasheet.BLOCK.format(f" {name}"), PAGE.read_text(), re.S)
    if block:
        datasheet.rewrite(PAGE, name, with_others(block[0], head, made))
    else:
        say(f"asic.py: docs/hardware/asic.md has no table {name}; it is as it was")


def main():
    options = fpga.command_line(__doc__, arguments, rows)
    if not options:
        return 0
    chosen = [row for name, row in rows().items()
              if (name in options.rows if options.rows else row.wires if options.wires else not row.alone)]
    if options.limit:  # children have it, too
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        resource.setrlimit(resource.RLIMIT_CPU, (round(60 * options.limit), hard))
    if options.wires:
        for tool in ("graywolf", "qrouter"):
            package(tool)
    elif not pathlib.Path(options.campaign).exists():
        say(f"asic.py: no {options.campaign}, so no pairs per second; run: make campaign-build")
    found, failures = {}, []
    bar.total = len(chosen)
    with bar:
        for row in chosen:
            try:
                found |= bar.counted(wired if options.wires else measure)(row, options)
            except fpga.ToolError as error:
                failures.append(f"{row.name}: {error}")
                say(f"asic.py: {failures[-1]}")
    name = library(options.liberty)[0].name
    save(f"{name}.wires" if options.wires else name, found)
    if options.write and not failures and options.wires:
        write_table(f"{name} wires", f"RTL: {tree()}.", wires_table(found))
    elif options.write and not failures:
        write(name, found)
        write_csv(name, found)
    for failure in failures:
        print(f"asic.py: {failure}", file=sys.stderr)
    for line, figures in found.items():
        print((wires_line if options.wires else last_line)(line, figures))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
