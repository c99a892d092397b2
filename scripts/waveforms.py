#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Timing diagrams of docs/pictures from simulations: wave_NAME.json (WaveJSON) and wave_NAME.svg.

usage: waveforms.py [--check] [--programs FOLDER] [NAME...]
  --programs FOLDER  of cchip_query_vectors, for `query`, default build/release/bin
  NAME               default: all
  pair    two pairs through cchip_primtest_tri_tri, the second overtakes, its result is stalled
  cache   a line through cchip_cache: miss, wait, hit
  read    a read of cchip_axi_read that times out, one that is refused, one that works
  swap    a swap by cchip_config_controller in a simulated slot
  query   a query through cchip_chip; a column is 100 clocks, values are numbers of events

Runs scripts/waves/NAME.v with Icarus Verilog (command: IVERILOG) and reads the signals of its top from the clock on
which its `show` is 1. A column is what a rising edge of clk sees; columns in which nothing changes are left out, with a
gap for them. With --check nothing is written, and the exit code is 1 if a file is stale."""
import argparse
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from generated_page import ROOT, compare, write
from pictures import BLUE, FOLDER, GREY, INK, PALE, Picture

KEEP = 2  # a gap stands for at least this number of clocks
LEFT, TOP, ROW, COLUMN, GAP = 150, 56, 26, 22, 18  # pixels

WINDOW = {"query": 100}  # clocks of a column that counts events
# name: title, rows. A row: signal, or "signal while qualifier", whose value matters only while the qualifier is 1, or
# "signal while qualifier as Enum" with names of scripts/definitions.json. A list begins with the group's name.
WAVES = {
    "pair": ("Two pairs into the triangle test, their results out", [
        "idle",
        ["s_pair", "s_pair_valid", "s_pair_ready", "s_pair_tag while s_pair_valid"],
        ["m_result", "m_result_valid", "m_result_ready", "m_result_tag while m_result_valid",
         "m_result_hit while m_result_valid",
         "m_result_definite while m_result_valid", "m_result_beats while m_result_valid"]]),
    "cache": ("One line, asked for three times: miss, wait, hit", [
        ["s", "s_valid", "s_place while s_valid", "s_line while s_valid"],
        ["count", "count_miss", "count_wait", "count_hit"],
        ["m_read", "m_read_valid", "m_read_line while m_read_valid"],
        ["s_read", "s_read_valid", "s_read_beat while s_read_valid", "s_read_last while s_read_valid"],
        ["m", "m_valid", "m_place while m_valid", "m_code while m_valid as ReadCode"]]),
    "read": ("Three reads of one slot, limit 20: TIMEOUT, OWED, OK", [
        ["s", "s_valid", "s_line while s_valid"],
        ["m_axi", "m_axi_arvalid", "m_axi_rvalid", "m_axi_rready", "m_axi_rlast while m_axi_rvalid"],
        "outstanding",
        ["m", "m_valid", "m_beat while m_valid", "m_last while m_valid", "m_code while answered as ReadCode"]]),
    "swap": ("A swap: TRI_QUAD into a slot that holds TRI_TRI", [
        ["s_swap", "s_swap_valid", "s_swap_ready", "s_swap_module while s_swap_valid as ModuleId"],
        "phase as SwapPhase",
        ["memory", "m_axi_arvalid", "m_axi_rvalid"],
        ["slot", "stop", "quiet", "decouple", "decoupled", "hold_reset", "roc_start", "roc_busy",
         "region_rm_id while coupled as ModuleId"],
        ["port", "cfg_valid"],
        ["m_report", "m_report_valid", "m_report_code while m_report_valid as SwapCode"]]),
    "query": ("A query: events in each 100 clocks from the doorbell on", [
        ["memory", "read_beat", "write_beat"],
        ["cache", "cache_miss", "cache_hit"],
        ["pairs", "node_pair", "leaf_pair", "primitive_pair"],
        "record"]),
}


def simulate(name, programs):
    """The VCD of a bench."""
    files = [(ROOT / path).parent / line for path in ("rtl/cchip.f", "sim/rtl_models/sim.f")
             for line in (ROOT / path).read_text().splitlines() if line.endswith(".v")]
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "bench.vvp"
        more, plusargs = [], []
        if name == "query":
            more, plusargs = [ROOT / "tests/icarus/bench_chip.v"], ["+memory=memory.hex", "+records=records.hex"]
            vectors = pathlib.Path(programs).resolve() / "cchip_query_vectors"
            if not vectors.exists():
                raise SystemExit(f"waveforms.py: no {vectors}, run: make build")
            subprocess.run([vectors, "memory.hex", "records.hex"], cwd=folder, check=True)
        for command in ([os.environ.get("IVERILOG") or "iverilog", "-g2005", "-I", ROOT / "rtl/include", "-s", "bench",
                         "-o", program,
                         ROOT / f"scripts/waves/{name}.v", *more, *files], ["vvp", "-n", program, *plusargs]):
            result = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                    timeout=100)
            if result.returncode or "ASSERT failed" in result.stdout:
                raise SystemExit(f"waveforms.py: {name}.v: {command[0]} says\n{result.stdout}")
        return (pathlib.Path(folder) / "dump.vcd").read_text()


def clocks(vcd):
    """What each rising edge of clk sees, from show = 1 on: a dictionary from signal to binary digits."""
    head, body = vcd.split("$enddefinitions $end", 1)
    signals = dict(re.findall(r"\$var \w+ \d+ (\S+) (\w+)", head)[::-1])
    state = {}
    changes = []

    def rises():
        return any(name == "clk" and value == "1" for name, value in changes) and state.get("clk") == "0"

    for line in body.splitlines() + ["#"]:
        if line.startswith("#"):
            if rises() and state.get("show") == "1":
                yield dict(state)
            state.update(changes)
            changes = []
        elif line and line[0] in "01xz" and line[1:] in signals:
            changes.append((signals[line[1:]], line[0]))
        elif line.startswith("b"):
            value, code = line[1:].split()
            if code in signals:
                changes.append((signals[code], value))


def parsed(row):
    match = re.fullmatch(r"(\w+)(?: while (\w+))?(?: as (\w+))?", row)
    return match.groups()


def leaves(rows):
    for row in rows:
        if isinstance(row, list):
            yield from leaves(row[1:])
        else:
            yield row


def value(row, clock, names):
    """What a row shows on a clock: None is a value that does not matter."""
    signal, qualifier, enum = parsed(row)
    if qualifier and clock[qualifier] != "1":
        return None
    bits = clock[signal]
    if not set(bits) <= {"0", "1"}:
        raise SystemExit(f"waveforms.py: {signal} is {bits} where it is shown")
    return names[enum][int(bits, 2)] if enum else int(bits, 2)


def wave_json(name, programs):
    """The text of wave_NAME.json."""
    definitions = json.loads((ROOT / "scripts/definitions.json").read_text())
    names = {}
    for enum in definitions["enums"]:
        names[enum["name"]] = {one["value"]: one["name"] for one in enum["values"]}
    title, rows = WAVES[name]
    vcd = simulate(name, programs)
    wide = {signal for bits, signal in re.findall(r"\$var \w+ (\d+) \S+ (\w+)", vcd) if bits != "1"}
    seen = list(clocks(vcd))
    window = WINDOW.get(name)
    if window:  # the last column may be shorter
        columns = [[sum(clock[row].count("1") for clock in seen[at:at + window]) or None for row in leaves(rows)]
                   for at in range(0, len(seen), window)]
    else:
        columns = [[value(row, clock, names) for row in leaves(rows)] for clock in seen]
    if not columns:
        raise SystemExit(f"waveforms.py: {name}.v never sets show")
    moving = [at for at in range(len(columns)) if at in (0, len(columns) - 1) or columns[at] != columns[at - 1]]
    if window:
        moving = range(len(columns))
    shown = sorted({near for at in moving for near in (at - 1, at) if near >= 0})
    picks = []  # numbers of clocks; None is a gap
    for at in shown:
        skipped = at - picks[-1] - 1 if picks else 0
        picks += [None] if skipped >= KEEP else range(at - skipped, at)
        picks.append(at)

    def line(index, row):
        signal, _, enum = parsed(row)
        wave, data, before = "", [], ()
        for at in picks:
            now = before if at is None else columns[at][index]
            if at is None:
                wave += "|"
            elif now == before and not (window and now):
                wave += "."
            elif now is None:
                wave += "x"
            elif window or signal in wide or enum:
                wave += "="
                data.append(now if enum else f"{now:#x}" if now > 9 and not window else str(now))
            else:
                wave += str(now)
            before = now
        return {"name": signal, "wave": wave, **({"data": data} if data else {})}

    index = iter(range(len(columns[0])))

    def lines(rows):
        return [[row[0], *lines(row[1:])] if isinstance(row, list) else line(next(index), row) for row in rows]

    clk = "".join("|" if at is None else "p" if column == 0 else "." for column, at in enumerate(picks))
    signals = [] if window else [{"name": "clk", "wave": clk}]
    for row in lines(rows):
        signals += [{}, row] if isinstance(row, list) else [row]
    labels = " ".join("-" if at is None else str(at * (window or 1)) for at in picks)
    parts = [json.dumps(signal) for signal in signals]
    return ('{"head": {"text": ' + json.dumps(title) + ', "tock": ' + json.dumps(labels) + '},\n "signal": [\n  '
            + ",\n  ".join(parts).replace(", {\"name\"", ",\n    {\"name\"") + "]}\n")


def drawn(text):
    """The picture of such a text: what it uses of WaveJSON."""
    source = json.loads(text)
    rows = []  # group or None, row or None for an empty line
    for entry in source["signal"]:
        group = isinstance(entry, list)
        rows += [(entry[0] if group else None, row) for row in (entry[1:] if group else [entry])]

    def runs(row):
        """(from column, to column, sign, value) of what a row shows."""
        wave, data, found = row["wave"], iter(row.get("data", ())), []
        for column, sign in enumerate(wave):
            if sign in ".|":
                found[-1][1] = column + 1
            else:
                found.append([column, column + 1, sign, next(data) if sign == "=" else ""])
        return found

    labels = source["head"]["tock"].split()
    gaps = [label == "-" for label in labels]
    widths = [GAP if label == "-" else max(COLUMN, 7 * len(label) + 6) for label in labels]
    for _, row in rows:
        for begin, end, _, words in runs(row) if row else ():
            widths[begin] += max(0, 7 * len(words) + 10 - sum(widths[begin:end]))
    edges = [LEFT]
    for width in widths:
        edges.append(edges[-1] + width)
    height = TOP + sum(ROW if row else ROW / 2 for _, row in rows) + 12
    picture = Picture(source["head"]["text"], round(edges[-1] + 14), round(height))
    picture.text(14, 24, source["head"]["text"], 14, weight="bold", anchor="start")
    for column, label in enumerate(labels):
        middle = (edges[column] + edges[column + 1]) / 2
        picture.text(middle, TOP - 10, "..." if gaps[column] else label, 10, GREY)
        if gaps[column]:
            picture.parts.append(f'<rect x="{edges[column]:g}" y="{TOP - 4}" width="{GAP}" '
                                 f'height="{height - TOP - 4:g}" fill="{PALE}"/>')
    y = TOP
    for group, row in rows:
        if row is None or not row:
            y += ROW / 2
            continue
        top, low = y + 5, y + ROW - 5
        picture.text(LEFT - 10, low - 4, row["name"], 11, BLUE[1] if group else INK, anchor="end")
        level = low
        for begin, end, sign, words in runs(row):
            x, right = edges[begin], edges[end]
            if sign == "p":
                points = [(x, low)]
                for column in range(begin, end):
                    middle = (edges[column] + edges[column + 1]) / 2
                    points += [] if gaps[column] else [(edges[column], low), (edges[column], top), (middle, top),
                                                       (middle, low)]
                picture.line(*points, (right, low), tip=False)
            elif sign in "01":
                fresh = top if sign == "1" else low
                picture.line(*([(x, level)] if begin else []), (x, fresh), (right, fresh), tip=False)
                level = fresh
            else:
                fill = PALE if sign == "x" else BLUE[0]
                picture.parts.append(f'<rect x="{x:g}" y="{top:g}" width="{right - x:g}" height="{low - top:g}" '
                                     f'fill="{fill}" '
                                     f'stroke="{GREY}" stroke-width="{0.5 if sign == "x" else 1.5}"/>')
                if words:
                    picture.text((x + right) / 2, low - 4, words, 11)
        y += ROW
    return picture.svg().replace("scripts/pictures.py", "scripts/waveforms.py")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
                                     usage=argparse.SUPPRESS)
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--programs", default=ROOT / "build/release/bin")
    parser.add_argument("names", nargs="*", choices=[[], *WAVES], metavar="NAME")
    options = parser.parse_args()
    fresh = {}
    for name in options.names or WAVES:
        text = wave_json(name, options.programs)
        fresh[FOLDER / f"wave_{name}.json"] = text
        fresh[FOLDER / f"wave_{name}.svg"] = drawn(text)
    if options.check:
        return max(compare(path, text, "scripts/waveforms.py") for path, text in fresh.items())
    write(fresh)
    return 0


if __name__ == "__main__":
    sys.exit(main())
