#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Bounds of every sum, difference, product, negation and shift of the arithmetic RTL, from the ranges of its inputs.

usage: widths.py [--check | --write] [--module MODULE]... [--one-bit-less]
  --check         compare with docs/develop/widths.md and fail at a place without a proof or a reason (the lint check
                  `narrowing`)
  --write         write that page
  --module        only this module, with a table on standard output
  --one-bit-less  how many words the bound would refuse with one bit less than they have

Yosys elaborates a module with its parameters into words; this script carries an interval through them, every corner of
every product. A place is where bits could be lost: a result that is stored in fewer bits than its operands could need,
or a slice that leaves out high bits of a result. It is proved if the interval fits. Where it is not, REASONS below says
why no bit that counts is lost and what shows it; a reason that is not needed any more is an error, too.

Inputs have their legal range, both ends included (docs/hardware/image.md, docs/hardware/definitions.md); a register
holds what was written to it; what a loop of registers holds is any number of its width. Exit codes: 0 all proved or
with a reason, 1 not, 2 wrong arguments."""
import argparse
import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs/develop/widths.md"

sys.setrecursionlimit(100000)


# A delay line changes no number; its memory would hide that.
DELAY = """module cchip_delay #(parameter WIDTH = 1, DEPTH = 1, RESET = 0, MEMORY = 0)
  (input wire clk, rst, input wire [WIDTH-1:0] d, output wire [WIDTH-1:0] q); assign q = d; endmodule
"""


def signed(width):
    return -(1 << (width - 1)), (1 << (width - 1)) - 1


def unsigned(width):
    return 0, (1 << width) - 1


def row(port, width, count, interval, first=0):
    """Fields of a port: `count` of them, `width` bits each, from bit `first` on."""
    return [(port, first + width * i, width, interval) for i in range(count)]


DEFAULTS = {"PASSES": 1, "COORD_W": 16, "ABSOLUTE_PROJECTION": 0, "PROJ_W": 51, "BOUND_W": 43, "VERTS_A": 3,
            "VERTS_B": 3}
BOX = signed(7)
ONE17 = (-(1 << 17), 1 << 17)
ONE30 = (-(1 << 30), 1 << 30)


def edge(w):
    """Greatest difference of two coordinates of w bits."""
    return (1 << w) - 1


def children(port):
    return row(port, 7, 6, BOX) + row(port, 3, 20, unsigned(3), 42)


# Module, parameters, and fields of ports with their legal ranges; a port that is not named holds any number of its
# width, without a sign.
TARGETS = [
    ("cchip_bv_lane_a", {}, children("child") + row("pose_m", 19, 9, ONE17) + row("pose_magnitude", 10, 39, (0, 1023))
     + row("offset", 17, 3, signed(17))),
    ("cchip_bv_lane_b", {}, children("child") + [("scale", 0, 3, (0, 7))]),
    ("cchip_bv_offset", {}, row("a_origin", 18, 3, signed(18)) + row("b_origin", 18, 3, signed(18))
     + row("row_m", 19, 3, ONE17) + [("row_t", 0, 29, (-(1 << 27), 1 << 27)), ("a_step", 0, 5, (0, 18)),
                                     ("b_step", 0, 5, (0, 18))]),
    ("cchip_bv_compare", {}, [(p, 24 * d + 12 * s, 12, signed(12)) for p in "ab" for d in range(3) for s in range(2)]
     + [(p, 72 + 26 * d + 13 * s, 13, signed(13)) for p in "ab" for d in range(10) for s in range(2)]),
    ("cchip_pose_setup", {}, row("s_m", 32, 9, ONE30) + row("s_t", 36, 3, signed(36))),
]
# The error of a vertex of A is at most 2^15 + 66 units (docs/hardware/image.md, "How great eta is").
NORMALISER = row("s_a", 45, 3, signed(45)) + row("s_b", 25, 3, signed(25)) + [("s_error_a", 0, 16, (0, (1 << 15) + 66))]
for passes in (1, 2):
    lines = [field for base in (0, 512)
             for field in row("s_lines", 24, 3, signed(24), base) + [("s_lines", base + 72, 5, (0, 24))]]
    TARGETS.append(("cchip_vertex_transform", {"PASSES": passes},
                    row("s_m", 32, 9, ONE30) + row("s_t", 36, 3, signed(36)) + lines))
    TARGETS.append(("cchip_normaliser", {"PASSES": passes}, NORMALISER))
for w in (4, 20):
    TARGETS.append(("cchip_normaliser", {"COORD_W": w}, NORMALISER))
for w in (4, 16, 17, 18, 20):
    axis = [("s_axis", (2 * w + 2) * d, 2 * w + 2, (-2 * edge(w) ** 2, 2 * edge(w) ** 2)) for d in range(3)]
    norm = [("s_edge_norm", 0, w + 3, (0, 6 * edge(w))), ("s_error_shift", 0, 3, (0, 4))]
    TARGETS.append(("cchip_sat_axis", {"COORD_W": w},
                    [f for port in ("s_e_from", "s_e_to", "s_f_from", "s_f_to") for f in row(port, w, 3, signed(w))]))
    for absolute in (0, 1):
        TARGETS.append(("cchip_sat_project", {"COORD_W": w, "ABSOLUTE_PROJECTION": absolute},
                        axis + norm + row("s_reference", w, 3, signed(w)) + row("s_points", w, 9, signed(w))))
    TARGETS.append(("cchip_sat_compare", {"PROJ_W": 3 * w + 3, "BOUND_W": 2 * w + 11},
                    row("s_projection", 3 * w + 3, 3, (-4 * edge(w) ** 3, 4 * edge(w) ** 3))))
    for a, b in ((3, 3), (3, 4), (4, 4)):
        TARGETS.append(("cchip_box_compare", {"COORD_W": w, "VERTS_A": a, "VERTS_B": b},
                        row("s_a", w, 3 * a, signed(w)) + row("s_b", w, 3 * b, signed(w))
                        + [("s_error_shift", 0, 3, (0, 4))]))

# (module, word) -> least and greatest number that the legal inputs leave of a word, where each input by itself would
# leave more, and why. A word is named by its net or the register that takes it, else by its expression.
LIMITS = {
    ("cchip_bv_lane_a", "gen_box[].size"): lambda p: (0, 127, "cchip_node_check refuses a node with an inverted box"),
    ("cchip_pose_setup", "gen_component[].size"): lambda p: (
        0, (1 << 18) - (1 << 9) + 2, "a legal map has |m_j| < 2 - 2^-8; each of its three entries is rounded"),
    ("cchip_pose_setup", "difference"): lambda p: (0, (1 << 18) - 1, "b >= c: they are sorted"),
    ("cchip_bv_offset", "step_q3"): lambda p: (
        -1, 18, "the grid's step is at least that of B less one, at most that of A or B"),
    ("cchip_bv_offset", "error_q3"): lambda p: (0, (1 << 17) - 1, "epsilon is at least 1: t is rounded"),
    ("cchip_bv_offset", "least_1"): lambda p: (0, 8, "step_q3 + 1 where step_q3 is below 7"),
    ("cchip_vertex_transform", "gen_row[].gen_whole.u_dot.xy_q"): lambda p: (
        -(1 << 54), 1 << 54, "two terms of at most 2^30 2^23"),
    ("cchip_vertex_transform", "gen_axis[].u_a.d"): lambda p: (-3 << 53, 3 << 53, "three terms of at most 2^30 2^23"),
    ("cchip_vertex_transform", "gen_row[].gen_halves.u_dot.xy_q"): lambda p: (
        -(1 << 41), 1 << 41, "two terms of at most 2^17 2^23"),
    ("cchip_vertex_transform", "gen_row[].gen_halves.sum"): lambda p: (-3 << 40, 3 << 40,
                                                                       "three terms of at most 2^17 2^23"),
    ("cchip_vertex_transform", "u_unit.below_a3"): lambda p: (0, 39, "x is at least the extent of A's leaf"),
    ("cchip_vertex_transform", "cut_b4"): lambda p: (0, 24, "x is at least the extent of B's leaf"),
    ("cchip_vertex_transform", "u_unit.fine3"): lambda p: (0, 16, "x is at least 8"),
    ("cchip_vertex_transform", "gen_axis[].u_b.q"): lambda p: (
        -(1 << 24), (1 << 24) - 1, "without a shift nothing is rounded up, and a shift halves"),
    ("cchip_vertex_transform", "u_origin.origin12"): lambda p: (
        -(1 << 44), (1 << 44) - 1,
        "|t| <= 8, rows of |M| add up to less than 2: below 2^3.1 of B's unit, 2^(48 - 8) to one"),
    ("cchip_vertex_transform", "a_q"): lambda p: (
        -(1 << 44), (1 << 44) - 1, "the origin is below 2^43.1 and an offset below 2^27"),
    ("cchip_vertex_transform", "cut_b"): lambda p: (0, 24, "x is at least the extent of B's leaf"),
    ("cchip_normaliser", "x_q4"): lambda p: (0, (1 << 45) - 1, "the greatest less the least"),
    ("cchip_normaliser", "y_q4"): lambda p: (0, (1 << 45) - 1, "the greatest less the least"),
    ("cchip_normaliser", "z_q4"): lambda p: (0, (1 << 45) - 1, "the greatest less the least"),
    ("cchip_normaliser", "gen_out[].from_least_q"): lambda p: (0, (1 << 45) - 1,
                                                               "a coordinate of the pair less the least"),
    ("cchip_normaliser", "gen_out[].rounded"): lambda p: (
        0, (1 << p["COORD_W"]) - 1, "n is the least shift for which the span fits, rounding included"),
    ("cchip_sat_axis", "m_axis"): lambda p: (-2 * edge(p["COORD_W"]) ** 2, 2 * edge(p["COORD_W"]) ** 2,
                                             "two products of two edges"),
    ("cchip_sat_project", "m_sign_bound"): lambda p: (
        0, (1 << (2 * p["COORD_W"] + 11)) - 1, "E (|a| + |b| + 2 E) 2^n and 16 |L|_1: below 2^(2 W + 9.3) together"),
    ("cchip_sat_compare", "gen_value[].gen_used.v"): lambda p: (
        -4 * edge(p["PROJ_W"] // 3 - 1) ** 3, 4 * edge(p["PROJ_W"] // 3 - 1) ** 3,
        "a difference of two projections is a determinant of three edges"),
}
# Dot products of an axis and an edge: a sum of two terms, too, is the determinant of three edges (one of them with a
# component of 0), and |det| <= 4 (2^W - 1)^3 for components of at most 2^W - 1 (Hadamard's bound for the cube).
for name in ("xy_q", "sum_q", "q"):
    LIMITS["cchip_sat_project", f"gen_relative.gen_point[].u_dot.{name}"] = lambda p: (
        -4 * edge(p["COORD_W"]) ** 3, 4 * edge(p["COORD_W"]) ** 3, "a determinant of three edges")
for name in ("gen_dot[].u_dot.xy_q", "dot"):
    LIMITS["cchip_sat_project", f"gen_absolute.{name}"] = lambda p: (
        -2 * edge(p["COORD_W"]) ** 2 << p["COORD_W"], 2 * edge(p["COORD_W"]) ** 2 << p["COORD_W"],
        "a determinant of two edges and a point")

# (module, word) -> why a place needs no bound: its number is used modulo its width, or what it leaves out is looked at.
REASONS = [
    ("", r".*gen_sum\[\]\.sum_q", "limbs of a product add up modulo the width of the product, which fits"),
    ("cchip_bv_lane_a", r"(face|corner)\d_q\d|.*plane_q[89]|bits 16:5 of .*plane_q9",
     "planes are numbers modulo their width: those of volumes that overlap fit, and others are apart however "
     "they wrap"),
    ("cchip_bv_lane_a", r"bits 21:11 of .*\.p",
     "two products in one: f face + c corner is at most 14 (f + c) < 2^11, because b + c <= 2 + 2^-5; f corner < 2^11 "
     "is below it"),
    ("cchip_bv_lane_b", r"exponent_q1", "at scales of 3 and more the cuts are 0"),
    ("cchip_bv_offset", r"e_q1\[3:0\] - 4'd6|over_b\[3:0\] - 4'd6", "read only where it is 0..4 and 0..2"),
    ("cchip_bv_offset", r"over_b\[2:0\] \+ 3'd1", "over_b is -1..5 where it is read: over_b + 1 modulo 8"),
    ("cchip_bv_offset", r"bits \d+:\d of shifted",
     "narrow_q8 says whether the bits above are copies; if not, the pair is far"),
    ("cchip_bv_offset", r"bits 4:0 of step_1|bits 3:0 of (step_1|over_7)",
     "step_q3 + 1 is 0..19; least_1 and high are read where they are 0..11"),
    ("", r"~\(15'h7FFF << .*|15'h7FFF << .*", "a mask"),
    ("", r".*1'b1\} << log\[4:2\].*|u_bound.u_shift.d", "one bit of a group: log is below 4 GROUPS"),
    ("cchip_normaliser", r"steps\[3:0\] \+ 4'd1", "read where steps is at most 14"),
    ("cchip_box_compare", r"error_q6|[ab]_left", "COORD_W = 4: an eta of 2^4 and more exceeds every gap"),
]


class Netlist:
    """A flat module of words."""

    def __init__(self, module, parameters, fields):
        self.module = module
        self.parameters = {**DEFAULTS, **parameters}
        self.data = self.elaborate(module, parameters)
        self.cells = self.data["cells"]
        self.driver = {}   # bit -> (word, index)
        self.words = []    # {"bits", "kind", "cell", "range", "arith", "name"}
        self.names = {}
        for name, net in self.data["netnames"].items():
            if not net["hide_name"]:
                for index, bit in enumerate(net["bits"]):
                    if isinstance(bit, int):
                        self.names.setdefault(bit, (name, index))
        taken = set()
        for port, lsb, width, interval in fields:
            bits = self.data["ports"][port]["bits"][lsb:lsb + width]
            if len(bits) != width:
                sys.exit(f"widths: {module} has no {port}[{lsb + width - 1}:{lsb}]")
            self.add(bits, "input", None, interval, f"{port}[{lsb}+:{width}]")
            taken |= set(bits)
        for port, about in self.data["ports"].items():
            if about["direction"] == "input":
                rest = [bit for bit in about["bits"] if bit not in taken]
                if rest:
                    self.add(rest, "input", None, unsigned(len(rest)), port)
        for name, cell in self.cells.items():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] == "output" and any(isinstance(bit, int) for bit in bits):
                    self.add(bits, cell["type"], name, None, port)
        self.registers_as_wires()
        self.used = {}  # bit -> number of cells and ports that read it
        for cell in self.cells.values():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] == "input" and cell["type"] not in ("$dff", "$dffe"):
                    for bit in set(bits):
                        self.used[bit] = self.used.get(bit, 0) + 1
        for about in self.data["ports"].values():
            if about["direction"] == "output":
                for bit in set(about["bits"]):
                    self.used[bit] = self.used.get(bit, 0) + 1
        self.limits = {}
        self.active = set()
        self.places = {}

    @staticmethod
    def elaborate(module, parameters):
        files = [f"rtl/{line.strip()}" for line in (ROOT / "rtl/cchip.f").read_text().splitlines()
                 if line.strip().endswith(".v") and not line.strip().endswith("/cchip_delay.v")]
        with tempfile.TemporaryDirectory() as folder:
            delay = pathlib.Path(folder) / "delay.v"
            delay.write_text(DELAY)
            files.append(str(delay))
            out = pathlib.Path(folder) / "words.json"
            script = (f"read_verilog -DSYNTHESIS -Irtl/include {' '.join(files)}; "
                      + "".join(f"chparam -set {name} {value} {module}; " for name, value in parameters.items())
                      + f"hierarchy -check -top {module}; proc; flatten; opt_expr -mux_undef; opt_clean; write_json "
                        f"{out}")
            subprocess.run(["yosys", "-q", "-p", script], cwd=ROOT, check=True)
            for about in json.loads(out.read_text())["modules"].values():
                if int(about["attributes"].get("top", "0"), 2):
                    return about
        sys.exit(f"widths: no module {module}")

    def registers_as_wires(self):
        """A register without reset holds what was written to it: its bits become those of its input, field by field."""
        through = {}
        for cell in self.cells.values():
            if cell["type"] in ("$dff", "$dffe"):
                through.update(zip(cell["connections"]["Q"], cell["connections"]["D"]))

        def root(bit):
            while bit in through:
                bit = through[bit]
            return bit
        for cell in self.cells.values():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] == "input" and cell["type"] not in ("$dff", "$dffe"):
                    cell["connections"][port] = [root(bit) for bit in bits]
        for about in self.data["ports"].values():
            if about["direction"] == "output":
                about["bits"] = [root(bit) for bit in about["bits"]]
        for bit in through:
            self.driver.pop(bit, None)
        self.words = [word for word in self.words if word["kind"] not in ("$dff", "$dffe")]
        self.taken = {}  # bit -> bit of the register that takes it
        for q, d in through.items():
            self.taken.setdefault(d, q)

    def add(self, bits, kind, cell, interval, port):
        word = {"bits": bits, "kind": kind, "cell": cell, "range": interval, "port": port, "arith": False}
        self.words.append(word)
        for index, bit in enumerate(bits):
            if isinstance(bit, int):
                self.driver[bit] = (word, index)

    # ---- ranges
    def word_range(self, word):
        """Interval of a word's number, exact: its bits are that number's lowest."""
        if word["range"] is None:
            key = id(word)
            if key in self.active:  # a loop of registers
                word["loop"] = True
                return unsigned(len(word["bits"]))
            self.active.add(key)
            interval = self.evaluate(word)
            self.active.discard(key)
            interval = self.limited(word, interval)
            word["range"] = unsigned(len(word["bits"])) if word.get("loop") else interval
        return word["range"]

    def limited(self, word, interval):
        limit = LIMITS.get((self.module, self.title(word)))
        if not limit:
            return interval
        low, high, why = limit(self.parameters)
        if interval[0] < low or interval[1] > high:
            self.limits[self.title(word)] = (low, high, why)
        return max(interval[0], low), min(interval[1], high)

    @staticmethod
    def fits(interval, width):
        low, high = interval
        return (low >= 0 and high < 1 << width) or (low >= -(1 << (width - 1)) and high < 1 << (width - 1))

    def run(self, word, low, count, as_signed):
        """Interval of bits low .. low + count - 1 of a word."""
        interval = self.word_range(word)
        top = low + count
        if interval[0] >= 0 and interval[1] < 1 << (top - 1 if as_signed else top):
            return interval[0] >> low, interval[1] >> low
        if interval[0] >= -(1 << (top - 1)) and interval[1] < 1 << (top - 1) and (as_signed or interval[0] >= 0):
            return interval[0] >> low, interval[1] >> low
        return signed(count) if as_signed else unsigned(count)

    def lost(self, word, low, count):
        """A slice leaves out high bits that count and that nothing else reads."""
        top = low + count
        if top == len(word["bits"]) or self.fits(self.word_range(word), top):
            return False
        return not all(bit in self.used for bit in word["bits"][top:needed(self.word_range(word))])

    def bits_range(self, bits, declared_signed, consumer=None):
        """Interval of a vector of bits: a word, a slice, a number with its sign extended, or several of these
        joined."""
        bits = list(bits)
        extended = False
        while len(bits) > 1 and bits[-1] == bits[-2] and isinstance(bits[-1], int):
            bits.pop()
            extended = True
        while len(bits) > 1 and bits[-1] in ("0", "x"):
            bits.pop()
            declared_signed = extended = False
        if all(isinstance(bit, str) for bit in bits):
            value = sum(1 << i for i, bit in enumerate(bits) if bit == "1")
            if (declared_signed or extended) and bits[-1] == "1":
                value -= 1 << len(bits)
            return value, value
        parts = []  # (word or None, low, count, least bit)
        for at, bit in enumerate(bits):
            word, index = self.driver.get(bit, (None, 0)) if isinstance(bit, int) else (None, 0)
            if parts and parts[-1][0] is word and word is not None and parts[-1][1] + parts[-1][2] == index:
                parts[-1][2] += 1
            elif parts and word is None and parts[-1][0] is None and not isinstance(bit, int):
                parts[-1][2] += 1
            else:
                parts.append([word, index, 1, at])
        total_low = total_high = 0
        for number, (word, low, count, at) in enumerate(parts):
            last = number == len(parts) - 1
            if word is None:
                value = sum(1 << i for i in range(count) if bits[at + i] == "1")
                if last and (declared_signed or extended) and bits[-1] == "1":
                    value -= 1 << count
                interval = (value, value)
            else:
                as_signed = last and (declared_signed or extended or self.word_range(word)[0] < 0)
                interval = self.run(word, low, count, as_signed)
                if last and count > 1 and consumer and low + count < len(word["bits"]) and self.is_number(word):
                    self.note(word, low, count)
            total_low += interval[0] << at
            total_high += interval[1] << at
        return total_low, total_high

    def is_number(self, word, depth=0):
        """A result of arithmetic, or a copy of one in a register or behind a multiplexer."""
        kind = word["kind"]
        if kind in ("$add", "$sub", "$mul", "$neg", "$shl", "$sshl", "$shr", "$sshr"):
            return True
        if depth > 20 or word["cell"] is None:
            return False
        inputs = {"$sdff": "D", "$sdffe": "D", "$sdffce": "D", "$mux": "A"}
        if kind not in inputs:
            return False
        bits = self.cells[word["cell"]]["connections"][inputs[kind]]
        top = next((bit for bit in reversed(bits) if isinstance(bit, int)), None)
        return top in self.driver and self.is_number(self.driver[top][0], depth + 1)

    def note(self, word, low, count):
        key = ("slice", id(word), low + count)
        interval = self.word_range(word)
        self.places[key] = {"what": f"bits {low + count - 1}:{low} of {self.title(word)}", "range": interval,
                            "has": low + count,
                            "source": self.source(word), "proved": self.fits(interval, low + count),
                            "rest": not self.lost(word, low, count)}

    def title(self, word):
        """Name of a word, or of the register that it is written to; the number of a generate block is left out."""
        bit = next(bit for bit in word["bits"] if isinstance(bit, int))
        if bit not in self.names:
            bit = self.taken.get(bit, bit)
        if bit in self.names:
            return re.sub(r"\[\d+\]", "[]", self.names[bit][0])
        return self.expression(word) or word["kind"]

    def expression(self, word):
        """The Verilog that a cell was made from."""
        src = self.cells[word["cell"]]["attributes"].get("src", "") if word["cell"] else ""
        at = re.fullmatch(r"(.*):(\d+)\.(\d+)-(\d+)\.(\d+)", src.split("|")[-1])
        if not at or at[1].startswith("/") or not (ROOT / at[1]).is_file():
            return ""
        lines = (ROOT / at[1]).read_text().splitlines()[int(at[2]) - 1:int(at[4])]
        if not lines:
            return ""
        lines[-1] = lines[-1][:int(at[5]) - 1]
        return " ".join(" ".join(lines)[int(at[3]) - 1:].split())

    def source(self, word):
        src = self.cells[word["cell"]]["attributes"].get("src", "") if word["cell"] else ""
        return re.sub(r"^.*/", "", src.split("|")[-1])

    def evaluate(self, word):
        cell = self.cells[word["cell"]]
        kind, about, ports = cell["type"], cell["parameters"], cell["connections"]
        width = len(word["bits"])

        def number(port):
            sign = int(about.get(f"{port}_SIGNED", "0"), 2) == 1
            return self.bits_range(ports[port], sign, word)

        def any_number():
            return unsigned(width)

        def union(*intervals):
            return min(i[0] for i in intervals), max(i[1] for i in intervals)

        if kind in ("$sdff", "$sdffe", "$sdffce"):
            if word["port"] != "Q":
                return any_number()
            value = self.vector(ports["D"], word)
            return union(value, (0, 0))
        if kind in ("$mux", "$pmux"):
            parts = [ports["A"]] + [ports["B"][i:i + width] for i in range(0, len(ports["B"]), width)]
            # a register may keep its number
            return union(*(self.vector(part, word) for part in parts if part != word["bits"]))
        if kind in ("$add", "$sub", "$mul", "$neg"):
            a = number("A")
            b = number("B") if kind != "$neg" else (0, 0)
            if kind == "$add":
                value = a[0] + b[0], a[1] + b[1]
            elif kind == "$sub":
                value = a[0] - b[1], a[1] - b[0]
            elif kind == "$neg":
                value = -a[1], -a[0]
            else:
                corners = [x * y for x in a for y in b]
                value = min(corners), max(corners)
            return self.stored(word, value, width)
        if kind in ("$shl", "$sshl"):
            a, b = number("A"), self.bits_range(ports["B"], False)
            b = (0, (1 << len(ports["B"])) - 1) if b[0] < 0 else b
            return self.stored(word, (min(a[0] << b[0], a[0] << b[1]), max(a[1] << b[0], a[1] << b[1])), width)
        if kind in ("$shr", "$sshr"):
            a, b = number("A"), self.bits_range(ports["B"], False)
            if a[0] < 0 and kind == "$shr":
                return any_number()
            b = (0, (1 << len(ports["B"])) - 1) if b[0] < 0 else b
            return self.stored(word, (min(a[0] >> b[0], a[0] >> b[1]), max(a[1] >> b[0], a[1] >> b[1])), width)
        if kind == "$not":
            a = self.vector(ports["A"], word)
            return (-a[1] - 1, -a[0] - 1)
        if kind == "$and":
            for this, other in (("A", "B"), ("B", "A")):
                if len(set(ports[other])) == 1:  # a mask of one bit
                    return union((0, 0), self.vector(ports[this], word))
            a, b = self.vector(ports["A"], word), self.vector(ports["B"], word)
            return (0, min(a[1], b[1])) if a[0] >= 0 and b[0] >= 0 else any_number()
        if kind == "$or":
            a, b = self.vector(ports["A"], word), self.vector(ports["B"], word)
            if a[0] >= 0 and b[0] >= 0:
                return max(a[0], b[0]), (1 << max(a[1], b[1]).bit_length()) - 1
            return any_number()
        if kind == "$xor":
            for this, other in (("A", "B"), ("B", "A")):
                if len(set(ports[other])) == 1:
                    a = self.vector(ports[this], word)
                    return union(a, (-a[1] - 1, -a[0] - 1))
            return any_number()
        return any_number()

    def vector(self, bits, consumer):
        """Interval of bits that are handed on: with a sign if the word that they are has one."""
        top = bits[-1]
        sign = False
        if isinstance(top, int) and top in self.driver:
            word, index = self.driver[top]
            sign = index == len(word["bits"]) - 1 and self.word_range(word)[0] < 0
        return self.bits_range(bits, sign, consumer)

    def stored(self, word, value, width):
        value = self.limited(word, value)
        key = ("result", id(word), width)
        proved = self.fits(value, width)
        if not proved and self.counts(word):
            return unsigned(width)
        self.places[key] = {"what": self.title(word), "range": value, "has": width, "source": self.source(word),
                            "proved": proved}
        return value if proved else (signed(width) if value[0] < 0 else unsigned(width))

    def counts(self, word):
        """A counter or an index: a constant more than it was."""
        ports = self.cells[word["cell"]]["connections"]
        constant = [all(isinstance(bit, str) for bit in ports[port]) for port in "AB" if port in ports]
        return any(constant) and self.loops(word)

    def loops(self, word):
        seen, todo = set(), [word]
        while todo:
            now = todo.pop()
            if now["cell"] is None:
                continue
            for port, bits in self.cells[now["cell"]]["connections"].items():
                if self.cells[now["cell"]]["port_directions"][port] == "input":
                    for bit in bits:
                        source = self.driver.get(bit, (None,))[0] if isinstance(bit, int) else None
                        if source is word:
                            return True
                        if source is not None and id(source) not in seen:
                            seen.add(id(source))
                            todo.append(source)
        return False

    def analyse(self):
        for word in self.words:
            self.word_range(word)
        for name, cell in self.cells.items():
            for port, bits in cell["connections"].items():
                if cell["port_directions"][port] == "input" and cell["type"].startswith("$") and port in "ABD":
                    consumer = next((word for word in self.words if word["cell"] == name), None)
                    if consumer:
                        self.vector(bits, consumer)
        for port, about in self.data["ports"].items():
            if about["direction"] == "output":
                self.outputs(about["bits"], port)
        return list(self.places.values())

    def outputs(self, bits, port):
        """Each word of a port, as its consumer takes it."""
        start = 0
        for at in range(1, len(bits) + 1):
            here = self.driver.get(bits[at]) if at < len(bits) and isinstance(bits[at], int) else None
            before = self.driver.get(bits[at - 1]) if isinstance(bits[at - 1], int) else None
            if at == len(bits) or not here or not before or here[0] is not before[0] or here[1] != before[1] + 1:
                if before:
                    self.vector(bits[start:at], {"bits": bits[start:at], "kind": "output", "cell": None})
                start = at


def needed(interval):
    low, high = interval
    if low >= 0:
        return max(1, high.bit_length())
    return 1 + max((-low - 1).bit_length(), max(0, high).bit_length())


def judge(netlist, place):
    """Why a place is right, or None."""
    if place["proved"]:
        limit = netlist.limits.get(place["what"])
        return f"at most so: {limit[2]}" if limit else "interval"
    if place.get("rest"):
        return "a part: the bits above are read too"
    for where, what, why in REASONS:
        if where in ("", netlist.module) and re.fullmatch(what, place["what"]):
            return why
    return None


def rows_of(netlist):
    """One row for each word: of its copies (the elements of a generate block) with the fewest bits to spare, the union
    of their ranges."""
    copies = {}
    for place in netlist.analyse():
        row = (place["what"], place["range"], needed(place["range"]), place["has"], judge(netlist, place),
               place["source"])
        copies.setdefault(row[0], []).append(row)
    rows = []
    for found in copies.values():
        what, _, bits, has, why, source = max(
            found, key=lambda row: (row[4] is None, row[2] - row[3], row[3], row[4] or "", row[5]))
        ranges = [row[1] for row in found if row[2:5] == (bits, has, why)]
        rows.append((what, (min(low for low, _ in ranges), max(high for _, high in ranges)), bits, has, why, source))
    return sorted(rows)


def label(module, parameters):
    return module + "".join(f" {name}={value}" for name, value in parameters.items())


def power(n):
    """A number as a person reads it."""
    for sign, size in ((1, n), (-1, -n)):
        for more in (0, -1, 1):
            if size > 4096 and (size - more) & (size - more - 1) == 0:
                text = f"2^{(size - more).bit_length() - 1}"
                if more:
                    text += f" + {more}" if more > 0 else f" - {-more}"
                return text if sign > 0 else f"-({text})" if more else f"-{text}"
    return str(n)


def page(results):
    """The generated page."""
    shown = {"COORD_W": 16, "PASSES": 1, "PROJ_W": 51, "VERTS_A": 4}
    lines = ["<!-- SPDX-License-Identifier: Apache-2.0 -->", "# Widths of the arithmetic", "",
             "Written by `scripts/widths.py --write` from the RTL; `scripts/lint narrowing` compares it and fails at a "
             "place without a",
             "bound or a reason. Yosys elaborates each module into words, and intervals are carried from the legal "
             "ranges of the inputs,",
             "both ends included, through every operation, all corners of every product. A **place** is a result that "
             "is stored in fewer",
             "bits than its operands could need, or a slice that leaves out high bits of a result.", "",
             "*interval*: the range fits whatever the inputs are. *At most so*: it fits because of what the legal "
             "inputs are together. Any",
             "other reason: the number is meant modulo its width, or what is left out is looked at elsewhere.", "",
             "| module and parameters | words | by interval | by a limit | other reason | no bit to spare |",
             "|---|---|---|---|---|---|"]
    for module, parameters, rows in results:
        interval = sum(row[4] == "interval" for row in rows)
        limit = sum((row[4] or "").startswith("at most so") for row in rows)
        tight = sum(row[2] == row[3] for row in rows)
        lines.append(f"| {label(module, parameters)} | {len(rows)} | {interval} | {limit} | "
                     f"{len(rows) - interval - limit} | {tight} |")
    for module, parameters, rows in results:
        if any(name in shown and value != shown[name] for name, value in parameters.items()):
            continue
        lines += ["", f"## {label(module, parameters)}", "", "| word | least | greatest | needs | has | why |",
                  "|---|---|---|---|---|---|"]
        for what, (low, high), bits, has, why, _ in rows:
            lines.append("| `" + what.replace("|", "\\|") + f"` | {power(low)} | {power(high)} | {bits} | {has} | "
                                                            f"{(why or 'NONE').replace('|', chr(92) + '|')} |")
    return "\n".join(lines) + "\n"


def one_bit_less(results):
    """Each word in one bit less than it needs at least, and less than it has: does the bound refuse it?"""
    refused = spare = reasoned = 0
    for _, _, rows in results:
        for _, interval, _, has, why, _ in rows:
            if why != "interval" and not (why or "").startswith("at most so"):
                reasoned += 1
            elif Netlist.fits(interval, has - 1):
                spare += 1
            else:
                refused += 1
    print(f"words={refused + spare + reasoned} refused={refused} spare={spare} not_by_bounds={reasoned}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--write", action="store_true")
    parser.add_argument("--one-bit-less", action="store_true")
    parser.add_argument("--module", action="append", default=[])
    options = parser.parse_args()
    targets = [t for t in TARGETS if not options.module or t[0] in options.module]
    if not targets:
        parser.error(f"--module: one of {' '.join(sorted({t[0] for t in TARGETS}))}")
    results = []
    failed = 0
    for module, parameters, fields in targets:
        rows = rows_of(Netlist(module, parameters, fields))
        results.append((module, parameters, rows))
        for what, (low, high), bits, has, why, source in rows:
            if why is None:
                failed += 1
                print(f"{source}: {label(module, parameters)}: {what} is {low}..{high}, needs {bits} bits, has {has}; "
                      "make it wider, "
                      "or say in scripts/widths.py why no bit that counts is lost")
            elif options.module:
                print(f"{label(module, parameters)}: {what} {low}..{high} needs {bits} has {has}: {why}")
    if options.one_bit_less:
        one_bit_less(results)
    if not options.module:
        text = page(results)
        if options.write:
            PAGE.write_text(text)
        elif options.check and (not PAGE.is_file() or PAGE.read_text() != text):
            failed += 1
            print(f"{PAGE.relative_to(ROOT)} is not what scripts/widths.py --write makes of the RTL")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
