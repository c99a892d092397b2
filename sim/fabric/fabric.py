#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Exchanges modules in a region of an open FPGA fabric, in simulation down to the configuration latches: generates the
fabric, places and routes each module inside its region, packs the frames for cchip_config_controller, and simulates.

usage: fabric.py [--set small|point|tests] [--seed N] [--without-decoupler | --without-roc] [--keep] [--wave]
                 [--picture FILE]

--set      small (the default): two small modules and a blank on 10 x 8 tiles, with faulty bitstreams, three minutes.
           point: the test of points against triangles and a blank, 28 x 26 tiles, 2.1 GB, twenty minutes of CPU.
           tests: this test, then that of two triangles in its place, 31 x 30 tiles, 2.7 GB, forty minutes of CPU
--seed     of the traffic (default 1)
--keep     takes the fabric and the bitstreams of an earlier run as they are
--wave     writes swap.vcd beside the bitstreams: bench, slot, controller and the writer of frames
--picture  draws the fabric of an earlier run, with the neighbour and the last module of the set, as SVG; runs nothing
--without-decoupler, --without-roc   leave this part out, to see that its absence is found: the run must then fail

Needs Python 3.12 or newer for FABulous (installed from PyPI below build/fabric), and Debian's yosys, nextpnr-generic
and iverilog. Last line: fabric swaps=N pairs=N differences=0 static_wrong=0 leaked=0. Exit codes: 0 right, 1 wrong,
2 bad arguments, 77 a tool is missing."""
import argparse
import collections
import dataclasses
import os
import pathlib
import re
import resource
import shutil
import struct
import subprocess
import sys
import time
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BUILD = ROOT / "build" / "fabric"
sys.path.insert(0, str(ROOT / "scripts"))
import bitstream  # noqa: E402  (a script beside this one's folder)

SYNC = 0xFAB0FAB1
END = 1 << 20
FRAMES = 20  # of a column
PINS_IN, PINS_OUT, PINS_NEIGHBOUR = 42, 36, (8, 16)
RTL = ROOT / "rtl"
ZERO = "1'b0"
LATCH = r"\.D\(FrameData\[(\d+)\]\),\s*\.E\(FrameStrobe\[(\d+)\]\),\s*"


@dataclasses.dataclass(frozen=True)
class Set:
    """A fabric (a letter a column: W edge of the neighbour, L logic, I edge of the region) and what runs in it."""
    columns: str
    rows: int
    first: int  # column of the region
    modules: tuple  # numbers, the blank first
    top: str  # module whose RM_ID is the number
    parameters: str  # further ones of it
    period: int  # ns
    pairs: int  # after each swap
    seconds: int  # bound of the simulation


SETS = {"small": Set("W" + 8 * "L" + "I", 8, 5, (0, 1, 2), "small_region", "", 400, 20, 1200),
        "point": Set("W" + 26 * "L" + "I", 26, 3, (0, 4), "cchip_pr_region", "", 800, 24, 7200),
        # the shortest stages have the least flip-flops
        "tests": Set("W" + 29 * "L" + "I", 30, 2, (0, 4, 1), "cchip_pr_region", ", .EXHAUSTIVE(0), .SUBSTAGES(6)", 1600,
                     12, 14400)}
TILES = {"W": ("NULL", "W_IO", "NULL"), "L": ("N_term_single", "LUT4AB", "S_term_single"),
         "I": ("N_term_RAM_IO", "RAM_IO", "S_term_RAM_IO")}


class Failed(Exception):
    pass


def run(words, log, bound, **more):
    """One tool, with its output in a file, a bound in seconds, and a line of what it took."""
    start, before = time.monotonic(), resource.getrusage(resource.RUSAGE_CHILDREN)
    with open(log, "w") as out:
        try:
            code = subprocess.run([*map(str, words)], stdout=out, stderr=subprocess.STDOUT,
                                  stdin=subprocess.DEVNULL, timeout=bound, **more).returncode
        except subprocess.TimeoutExpired:
            raise Failed(f"{words[0]} was ended after {bound} s; see {log}") from None
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    print(f"  {pathlib.Path(str(words[0])).name:16} {pathlib.Path(log).stem:22} {time.monotonic() - start:6.1f} s, "
          f"{after.ru_utime - before.ru_utime:6.1f} s of user time", flush=True)
    if code:
        tail = "\n".join(pathlib.Path(log).read_text(errors="replace").splitlines()[-8:])
        raise Failed(f"{words[0]} ended with {code}; the end of {log}:\n{tail}")


# ---- tools

def python312():
    names = [sys.executable, *(f"python3.{minor}" for minor in (12, 13, 14))]
    homes = sorted(pathlib.Path.home().glob(".pyenv/versions/3.1[2-9]*/bin/python3"))
    for name in [*names, *map(str, homes)]:
        check = "import sys, ensurepip; sys.exit(sys.version_info < (3, 12))"
        if shutil.which(name) and subprocess.run([name, "-c", check], stderr=subprocess.DEVNULL).returncode == 0:
            return name
    raise Failed("FABulous needs Python 3.12 or newer, Debian 12 has 3.11; install one beside it, as with "
                 "`pyenv install 3.12` or `uv python install 3.12`, so that python3.12 is on PATH")


def tools():
    for name, package in (("yosys", "yosys"), ("nextpnr-generic", "nextpnr-generic"), ("iverilog", "iverilog")):
        if not shutil.which(name):
            raise Failed(f"no {name}: apt-get install {package}")
    venv, pins = BUILD / "venv", HERE / "requirements.txt"
    stamp = venv / "requirements.txt"
    if not stamp.exists() or stamp.read_text() != pins.read_text():
        BUILD.mkdir(parents=True, exist_ok=True)
        run([python312(), "-m", "venv", venv], BUILD / "venv.log", 300)
        run([venv / "bin" / "pip", "install", "--quiet", "--disable-pip-version-check", "--requirement", pins],
            BUILD / "pip.log", 1800)
        shutil.copy(pins, stamp)
    return venv / "bin"


# ---- the fabric

def generate(kind, work, tools_at):
    project = work / "project"
    shutil.rmtree(project, ignore_errors=True)
    run([tools_at / "FABulous", "create-project", project], work / "create.log", 120)
    table = project / "fabric.csv"
    grid = [",".join(TILES[column][part] for column in kind.columns) + "," for part in range(3)]
    text = "\n".join(["FabricBegin,", grid[0], *[grid[1]] * kind.rows, grid[2], "FabricEnd,"])
    text, count = re.subn(r"FabricBegin.*FabricEnd[^\n]*", text, table.read_text(), flags=re.S)
    # tiles that are listed and not used would be missed later
    text = re.sub(r"^(Supert|T)ile,\S*(DSP|RegFile|single2)\S*\n", "", text, flags=re.M)
    text = text.replace("SuperTileEnable,TRUE", "SuperTileEnable,FALSE")
    if count != 1 or "DSP" in text or "SuperTileEnable,FALSE" not in text:
        raise Failed(f"{table} has another form than that of FABulous 2.2.0")
    table.write_text(text)
    settings = project / ".FABulous" / ".env"
    settings.write_text("".join(line + "\n" for line in settings.read_text().splitlines() if "FAB_PDK" not in line))
    script = work / "generate.tcl"
    script.write_text("load_fabric\nrun_FABulous_fabric\nexit\n")
    run([tools_at / "FABulous", "-p", project, "script", script, "--type", "tcl"], work / "generate.log", 3600)
    lighten(project, work / "fabric")
    return project


def light_memory(text):
    """One register a frame in place of a module for each latch. The data must not change while the strobe is high,
    which cchip_fabric_frames promises and the bench checks: sensitive to data, each word would wake every frame."""
    name = re.search(r"^module (\w+)", text, re.M).group(1)
    latches = re.findall(LATCH + r"\.Q\(ConfigBits\[(\d+)\]\)", text)
    bits = int(re.search(r"NoConfigBits=(\d+)", text).group(1))
    place = {int(q): (int(frame), int(bit)) for bit, frame, q in latches}
    if sorted(place) != list(range(bits)):
        raise Failed(f"{name}: {len(place)} latches for {bits} bits")
    lines = [f"module {name} #(parameter MaxFramesPerCol = 20, FrameBitsPerRow = 32, NoConfigBits = {bits}) (",
             "  input [31:0] FrameData, input [19:0] FrameStrobe,",
             f"  output [{bits - 1}:0] ConfigBits, ConfigBits_N);"]
    for frame in sorted({frame for frame, _ in place.values()}):
        lines.append(f"  reg [31:0] f{frame}; always @(FrameStrobe[{frame}]) "
                     f"if (FrameStrobe[{frame}]) f{frame} = FrameData;")
    lines.append("  assign ConfigBits = {" + ", ".join(f"f{place[q][0]}[{place[q][1]}]"
                                                       for q in reversed(range(bits))) + "};")
    return "\n".join([*lines, "endmodule", ""])


def light_matrix(text):
    """Each multiplexer of a switch matrix as one expression, with a delay: half-written wires form rings, too."""
    inputs = {name: [one.strip() for one in names.split(",")][::-1]
              for name, names in re.findall(r"assign (\w+)_input = \{([^}]*)\};", text)}

    def chosen(data, select):
        if not select:
            return data[0]
        half = len(data) // 2
        return f"({select[-1]} ? {chosen(data[half:], select[:-1])} : {chosen(data[:half], select[:-1])})"

    def one(match):
        pins = dict(re.findall(r"\.(\w+)\(([^()]*)\)", match.group(1)))
        select = [pins[name] for name in ("S", "S0", "S1", "S2", "S3") if name in pins]
        data = []
        for number in range(1 << len(select)):
            wire = re.match(r"(\w+)_input\[(\d+)\]", pins[f"A{number}"])
            data.append(inputs[wire.group(1)][int(wire.group(2))] if wire else pins[f"A{number}"])
        return f"assign #1 {pins['X']} = {chosen(data, select)};"

    text = re.sub(r"cus_mux\d+ \w+\s*\((.*?)\n\s*\);", one, text, flags=re.S)
    return re.sub(r"(assign|wire\s*\[[^\]]*\])\s*\w+_input\b[^;]*;", "", text)


def lighten(project, folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for path in sorted((project / "Tile").rglob("*.v")):
        # twice in the project, for another process, or in fabric_models.v
        if path.name in ("gf180mcuD_latchmap.v", "LUT4c_frame_config_dffesr.v", "RegFile_32x4.v"):
            continue
        text = path.read_text()
        if path.name.endswith("_ConfigMem.v"):
            text = light_memory(text)
        elif path.name.endswith("_switch_matrix.v"):
            text = light_matrix(text)
        (folder / path.name).write_text("`timescale 1ns / 1ps\n" + text.replace("parameter reg ", "parameter "))
    shutil.copy(project / "Fabric" / "eFPGA.v", folder)


# ---- pins

@dataclasses.dataclass
class Pins:
    """Cells at the edges, in the order in which pins are numbered: (tile, letter, prefix)."""
    into: list
    out: list
    edge: list


def pins_of(project):
    found = Pins([], [], [])
    kinds = {"InPass4_frame_config_mux": found.into, "OutPass4_frame_config_mux": found.out,
             "IO_1_bidirectional_frame_config_pass": found.edge}
    for line in (project / ".FABulous" / "bel.v2.txt").read_text().splitlines():
        if line.startswith("BelBegin"):
            _, tile, letter, cell, prefix = line.split(",")
            if cell in kinds:
                kinds[cell].append((tile, letter, prefix))
    return found


def write_core(kind, pins, path):
    """The fabric with vectors as ports."""
    wires, tied = [], []
    for cells, letter, count, vector in ((pins.into, "I", PINS_IN, "fin"), (pins.out, "O", PINS_OUT, "fout")):
        for number, (tile, _, prefix) in enumerate(cells):
            for bit in range(4):
                pin = 4 * number + bit
                if pin < count:
                    wires.append(f".Tile_{tile}_{prefix}{letter}{bit}({vector}[{pin}])")
                elif letter == "I":
                    tied.append(f".Tile_{tile}_{prefix}I{bit}(1'b0)")
    for number, (tile, _, prefix) in enumerate(pins.edge):
        wires.append(f".Tile_{tile}_{prefix}O_top({f'win[{number}]' if number < PINS_NEIGHBOUR[0] else ZERO})")
        if number < PINS_NEIGHBOUR[1]:
            wires.append(f".Tile_{tile}_{prefix}I_top(wout[{number}])")
    path.write_text("`timescale 1ns / 1ps\nmodule fabric_core (input wire clk,\n"
                    f"  input wire [{32 * kind.rows - 1}:0] frame,\n"
                    f"  input wire [{FRAMES * len(kind.columns) - 1}:0] strobe,\n"
                    f"  input wire [{PINS_IN - 1}:0] fin, output wire [{PINS_OUT - 1}:0] fout,\n"
                    f"  input wire [{PINS_NEIGHBOUR[0] - 1}:0] win, output wire [{PINS_NEIGHBOUR[1] - 1}:0] wout);\n"
                    "  eFPGA u_fabric (\n    " + ",\n    ".join(wires + tied) +
                    ",\n    .UserCLK(clk), .FrameData({32'd0, frame, 32'd0}), .FrameStrobe(strobe));\nendmodule\n")


def write_top(pins, path, region):
    """The design of one region, with the cells of its pins."""
    lines = ["module fabric_top;", "wire clk; (* keep *) Global_Clock u_clock (.CLK(clk));",
             f"wire [{PINS_IN + 3}:0] fin; wire [{PINS_OUT + 3}:0] fout; wire [31:0] win, wout;"]
    if region:
        for cells, cell, letter, count, vector in ((pins.into, "InPass4_frame_config_mux", "O", PINS_IN, "fin"),
                                                   (pins.out, "OutPass4_frame_config_mux", "I", PINS_OUT, "fout")):
            for number, (tile, name, _) in enumerate(cells[:(count + 3) // 4]):
                wires = ", ".join(f".{letter}{bit}({vector}[{4 * number + bit}])" for bit in range(4))
                lines.append(f'(* keep, BEL="{tile}.{name}" *) {cell} u_{vector}{number} ({wires});')
        lines.append(f"{region} u_module (.clk(clk), .rst(fin[0]), .s_vertex_valid(fin[1]), "
                     ".s_vertex_data(fin[41:2]), .m_result_valid(fout[0]), .m_result_data(fout[26:1]), "
                     ".rm_id(fout[34:27]), .idle(fout[35]));")
    else:
        for number, (tile, name, _) in enumerate(pins.edge[:max(PINS_NEIGHBOUR)]):
            lines.append(f'(* keep, BEL="{tile}.{name}" *) IO_1_bidirectional_frame_config_pass u_edge{number} '
                         f"(.O(win[{number}]), .I(wout[{number}]));")
        lines.append("neighbour u_module (.clk(clk), .rst(win[0]), .data(win[7:1]), .signature(wout[15:0]));")
    path.write_text("\n".join([*lines, "endmodule", ""]))


# ---- modules

def rtl_files():
    lines = (RTL / "cchip.f").read_text().splitlines()
    names = [line.split()[0] for line in lines if line.strip().endswith(".v")]
    return [ROOT / name if (ROOT / name).exists() else RTL / name for name in names]


def part_of_fabric(project, folder, inside):
    """The project as nextpnr sees it, without the tiles for which `inside` does not hold."""
    (folder / ".FABulous").mkdir(parents=True, exist_ok=True)

    def column(tile):
        return int(re.match(r"X(\d+)Y", tile).group(1))

    kept, keep = [], False
    for line in (project / ".FABulous" / "bel.v2.txt").read_text().splitlines():
        if line.startswith("BelBegin"):
            keep = inside(column(line.split(",")[1]))
        if keep and not line.startswith("#"):
            kept.append(line)
    (folder / ".FABulous" / "bel.v2.txt").write_text("\n".join(kept) + "\n")
    kept = []
    for line in (project / ".FABulous" / "pips.txt").read_text().splitlines():
        words = line.split(",")
        if len(words) > 3 and not line.startswith("#") and inside(column(words[0])) and inside(column(words[2])):
            kept.append(line)
    (folder / ".FABulous" / "pips.txt").write_text("\n".join(kept) + "\n")


# bit_gen, whose parser needs minutes for a big module, with one for the lines that nextpnr writes: a feature, or the
# bits of a LUT from the first on
BIT_GEN = r"""
import re
import fabulous_bit_gen.bit_gen as tool
from fasm import FasmLine, SetFasmFeature


def features(path):
    for line in open(path):
        line = line.partition("#")[0].strip()
        lut = re.fullmatch(r"([\w.]+)\[(\d+):0\] = \d+'b([01]+)", line)
        if not lut and line and not re.fullmatch(r"[\w.]+", line):
            raise ValueError("not a line of nextpnr: " + line)
        places = [at for at, bit in enumerate(reversed(lut[3])) if bit == "1"] if lut else [0] if line else []
        for at in places:
            yield FasmLine(SetFasmFeature(lut[1] if lut else line, at or None, None, 1, None), None, None)


tool._parse_fasm_to_canon_list = features
tool.bit_gen()
"""


def implement(kind, work, project, pins, name, module, tools_at):
    """Synthesis, place and route, bits: the frames of all columns, {(column, frame): words}."""
    folder = work / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    if module is None:
        region, sources = None, [HERE / "neighbour.v"]
        part_of_fabric(project, folder, lambda column: column < kind.first)
    else:
        region = kind.top
        sources = [HERE / "small_region.v"] if region == "small_region" else rtl_files()
        region += f" #(.RM_ID({module}), .COORD_W(4), .CONTEXTS(1){kind.parameters})"
        part_of_fabric(project, folder, lambda column: column >= kind.first)
    write_top(pins, folder / "top.v", region)
    read = " ".join(str(path) for path in sources)
    synthesis = (f"read_verilog -lib {HERE}/cells.v; "
                 f"read_verilog -DSYNTHESIS -DCCHIP_DELAY_CHAINS -I{RTL}/include -defer {read}; "
                 f"read_verilog {folder}/top.v; hierarchy -check -top fabric_top; "
                 "synth -flatten -run begin:fine; memory_map; opt -full; techmap; opt; "
                 "setattr -unset init w:*; "  # the fabric sets no flip-flop; none of ours needs it
                 r"dfflegalize -cell $_DFF_P_ x; abc -lut 4; opt_clean -purge; "
                 f"techmap -map {HERE}/maps.v; opt_clean -purge; hilomap -singleton -hicell FABRIC_ONE O "
                 f"-locell FABRIC_ZERO O; techmap -map {HERE}/maps.v; stat; write_json {folder}/net.json")
    run(["yosys", "-p", synthesis], folder / f"{name}-yosys.log", 900)
    run(["nextpnr-generic", "--uarch", "fabulous", "--router", "router2", "--seed", "1", "--json", folder / "net.json",
         "-o", f"fasm={folder}/net.fasm"], folder / f"{name}-nextpnr.log", 900, env={**os.environ, "FAB_ROOT": folder})
    run([tools_at / "python3", "-c", BIT_GEN, "-genBitstream", folder / "net.fasm",
         project / ".FABulous" / "bitStreamSpec.bin", folder / "net.bin"], folder / f"{name}-bit_gen.log", 900)
    used = re.findall(r"FABULOUS_LC: +(\d+)/ *(\d+)", (folder / f"{name}-nextpnr.log").read_text())
    cells = re.findall(r"^ +(LUT\w+) +(\d+)$", (folder / f"{name}-yosys.log").read_text(), re.M)
    flops = sum(int(count) for cell, count in cells if cell.startswith("LUTFF"))
    print(f"  {name}: {used[-1][0]} of {used[-1][1]} logic cells, "
          f"{sum(int(count) for cell, count in cells) - flops} LUTs, {flops} flip-flops", flush=True)
    return frames_of((folder / "net.bin").read_bytes(), kind)


# ---- bitstreams

def frames_of(data, kind):
    words = struct.unpack(f">{len(data) // 4}I", data)
    at, frames = words.index(SYNC) + 1, {}
    while not words[at] & END:
        frames[words[at] >> 27, words[at] & (END - 1)] = words[at + 1:at + 1 + kind.rows]
        at += 1 + kind.rows
    if set(frames) != {(column, 1 << frame) for column in range(len(kind.columns)) for frame in range(FRAMES)}:
        raise Failed(f"the bitstream has {len(frames)} frames, not {FRAMES} for each of {len(kind.columns)} columns")
    return frames


def stream(frames, columns):
    """Sync word, frames of these columns, end: the bytes as bit_gen orders them, high byte first."""
    words = [SYNC]
    for (column, select), data in frames.items():
        if column in columns:
            words += [column << 27 | select, *data]
    return struct.pack(f">{len(words) + 1}I", *words, END)


def bit_of_lut(project):
    """Frame and bit of the first entry of a logic tile's first LUT."""
    text = (project / "Tile" / "LUT4AB" / "LUT4AB_ConfigMem.v").read_text()
    match = re.search(LATCH + r"\.Q\(ConfigBits\[0\]\)", text)
    return int(match.group(2)), int(match.group(1))


def faulty(images, kind, project):
    """Bitstreams of module 1 that end badly, each in its own way. The wrong bit is one of a LUT."""
    good, payload = images["MODULE_1"], bytearray(images["MODULE_1"][bitstream.HEADER:])
    words = 1 + kind.rows  # of a frame
    images["TRUNCATED"] = good[:len(good) // 2 & ~3]
    frame, bit = bit_of_lut(project)
    at = bitstream.HEADER + 4 * (1 + (FRAMES + frame) * words + 1 + kind.rows // 2) + 3 - bit // 8
    images["FLIPPED"] = good[:at] + bytes([good[at] ^ 1 << bit % 8]) + good[at + 1:]
    at = 4 * (1 + 40 * words)
    address = struct.unpack(">I", payload[at:at + 4])[0]
    payload[at:at + 4] = struct.pack(">I", 1 << 27 | address & (1 << 27) - 1)
    images["STRAY"] = bitstream.make(bytes(payload), 0, 1, 32, "none")
    if zlib.crc32(bytes(payload)) == zlib.crc32(good[bitstream.HEADER:]):
        raise Failed("the stray frame changed nothing")


def write_images(work, images, boot):
    words, places, at = [], [], 0
    for name, data in images.items():
        data += bytes(-len(data) % 64)
        places.append(f"localparam [31:0] {name}_AT = {at}, {name}_SIZE = {len(images[name])};")
        words += [f"{word:08x}" for word in struct.unpack(f"<{len(data) // 4}I", data)]
        at += len(data)
    boot_words = [f"{word:08x}" for word in struct.unpack(f"<{len(boot) // 4}I", boot)]
    places.append(f"localparam integer MEMORY_WORDS = {len(words)}, BOOT_WORDS = {len(boot_words)};")
    (work / "memory.hex").write_text("\n".join(words) + "\n")
    (work / "boot.hex").write_text("\n".join(boot_words) + "\n")
    (work / "images.vh").write_text("\n".join(places) + "\n")


def build(kind, work, tools_at):
    work.mkdir(parents=True, exist_ok=True)
    project = generate(kind, work, tools_at)
    pins = pins_of(project)
    write_core(kind, pins, work / "fabric" / "fabric_core.v")
    neighbour = implement(kind, work, project, pins, "neighbour", None, tools_at)
    region = range(kind.first, len(kind.columns))
    images, boot = {}, b""
    for module in kind.modules:
        frames = implement(kind, work, project, pins, f"module_{module}", module, tools_at)
        payload = stream(frames, region)
        images[f"MODULE_{module}"] = bitstream.make(payload, 0, module, 32, "none")
        print(f"  module {module}: {8 * len(payload)} bits, {len(payload) // 4} words", flush=True)
        if module == 0:
            boot = stream({place: data if place[0] in region else neighbour[place] for place, data in frames.items()},
                          range(len(kind.columns)))
    if kind.top == "small_region":
        faulty(images, kind, project)
    write_images(work, images, boot)


# ---- simulation

def simulate(name, kind, work, options):
    defines = [f"-DFABRIC_ROWS={kind.rows}", f"-DFABRIC_COLUMNS={len(kind.columns)}", f"-DFABRIC_FIRST={kind.first}",
               f"-DPERIOD={kind.period}", f"-DLUT_DELAY={kind.period * 3 // 10}", f"-DPAIRS={kind.pairs}",
               f"-DGOLD={kind.top}", f"-DGOLD_MORE={kind.parameters}", f"-DSET_{name.upper()}"]
    own = [HERE / file for file in ("bench.v", "cchip_pr_virtual.v", "cchip_fabric_frames.v", "fabric_models.v",
                                    "small_region.v")]
    run(["iverilog", "-g2005", "-o", work / "bench.vvp", "-s", "bench", "-s", "fabric_state", *defines,
         f"-I{RTL}/include", f"-I{work}", *own, *rtl_files(), *sorted((work / "fabric").glob("*.v"))],
        work / "iverilog.log", 1800)
    extra = [f"+{option}" for option in ("without_decoupler", "without_roc", "wave") if getattr(options, option)]
    run(["vvp", "-n", work / "bench.vvp", f"+seed={options.seed}", *extra], work / "vvp.log", kind.seconds, cwd=work)
    text = (work / "vvp.log").read_text()
    print(text, end="")
    match = re.search(r"fabric swaps=(\d+) pairs=(\d+) differences=(\d+) static_wrong=(\d+) leaked=(\d+)\n\Z", text)
    if not match:
        raise Failed(f"the simulation did not come to its last line; see {work / 'vvp.log'}")
    swaps, pairs, *bad = map(int, match.groups())
    return swaps > 0 and pairs > 0 and not any(bad) and "FAILED" not in text


# ---- picture

def logic_cells(folder):
    """How many logic cells of each tile are in use, {(x, y): count}."""
    found = collections.Counter()
    for x, y in re.findall(r"^X(\d+)Y(\d+)\.[A-H]\.INIT\[15:0\] =", (folder / "net.fasm").read_text(), re.M):
        found[int(x), int(y)] += 1
    return found


def picture(name, kind, work):
    if not (work / "images.vh").exists():
        raise Failed(f"{work} has no bitstreams: run --set {name} first")
    module = kind.modules[-1]
    cells = [logic_cells(work / "neighbour"), logic_cells(work / f"module_{module}")]
    size, left, top = 18, 12, 34
    tiles = collections.defaultdict(str)  # outlines by colour and how dark
    for x, letter in enumerate(kind.columns):
        for y in range(kind.rows):
            part = x >= kind.first
            look = (("#2f7fbc", "#d9731a")[part], cells[part][x, y + 1]) if letter == "L" else ("#666", 2)
            tiles[look] += f"M{left + size * x} {top + size * y}h{size - 2}v{size - 2}h{2 - size}z"
    edge, bottom = left + size * kind.first, top + size * kind.rows
    text = lambda x, y, words: f'<text x="{x}" y="{y}" font-family="sans-serif" font-size="11">{words}</text>'
    width, height = 2 * left + size * len(kind.columns), bottom + 46
    lines = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
             f'viewBox="0 0 {width} {height}">',
             "<!-- SPDX-License-Identifier: Apache-2.0. Generated by sim/fabric/fabric.py. Do not edit. -->",
             '<rect width="100%" height="100%" fill="#fff"/>', text(left, 22, "neighbour"),
             text(edge + 6, 22, f"region with module {module}; darker: more of a tile's 8 logic cells are used"),
             *(f'<path d="{path}" fill="{colour}" fill-opacity="{0.08 + 0.115 * used:.2f}"/>'
               for (colour, used), path in sorted(tiles.items())),
             f'<path d="M{edge - 1} {top - 6}V{bottom + 4}" stroke="#222" stroke-dasharray="4 3"/>',
             f'<rect x="{edge + 4 * size - 1}" y="{top - 1}" width="{size}" height="{size * kind.rows}" fill="none" '
             'stroke="#222"/>',
             text(left, bottom + 18, f"Framed: a column, {FRAMES} frames; each is an address and 32 bits for each of "
                                     f"{kind.rows} rows."),
             text(left, bottom + 34, "Grey: pins, the neighbour's at the left edge, the region's at the right one."),
             "</svg>"]
    return "\n".join(lines) + "\n"


def main():
    if {"-h", "--help"} & set(sys.argv[1:]):
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n")[1], add_help=False)
    parser.add_argument("--set", choices=SETS, default="small")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--keep", action="store_true")
    parser.add_argument("--wave", action="store_true")
    parser.add_argument("--picture", type=pathlib.Path)
    leave_out = parser.add_mutually_exclusive_group()
    leave_out.add_argument("--without-decoupler", action="store_true")
    leave_out.add_argument("--without-roc", action="store_true")
    options = parser.parse_args()
    kind, work = SETS[options.set], BUILD / options.set
    try:
        if options.picture:
            options.picture.write_text(picture(options.set, kind, work))
            return 0
        tools_at = tools()
        if not (options.keep and (work / "images.vh").exists()):
            build(kind, work, tools_at)
        right = simulate(options.set, kind, work, options)
    except Failed as error:
        print(f"fabric.py: {error}", file=sys.stderr)
        return 77 if str(error).startswith(("no ", "FABulous needs")) else 1
    return 0 if right else 1


if __name__ == "__main__":
    sys.exit(main())
