#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""One shard of a campaign, and the sum of all shards. workflow/Snakefile calls this; it also works by hand.

usage: campaign.py run   --kind KIND --amount N --shards N --shard I --bin FOLDER --output FILE [options]
       campaign.py merge --kind KIND --amount N --shards N --output FILE SHARD... [options]     (a folder: its
       shard*.json) campaign.py check FILE
       campaign.py piece --kind KIND --amount N --shards N --bin FOLDER --output FILE [options]
  --kind NAME    random, grid, relation, certainty, boxes, swaps, chip, faults
  --amount N     pairs (random, grid, relation, certainty, boxes), swaps (swaps) or queries (chip, faults), in all
  --shape NAME   of pairs: tri-tri, tri-quad or quad-quad (default tri-tri; grid: tri-quad)
  --seed N       of the campaign (default 1)

`run` makes shard I of 0..N-1 and writes its counts as JSON: to a temporary name, which is renamed when the file is
whole. `merge` refuses files that are missing, twice there, damaged or of another campaign or program, adds the counts
up and writes a CSV table, its total at the end; `check` prints the total of a table as one line, and its exit code is
the campaign's. `piece` makes the campaign in one piece, with the seeds that the
shards have, and writes the same table.

How a campaign is cut: pairs and swaps are drawn in parts (65,536 pairs, 50 swaps), each with the seed
S * K + part modulo 2^64, where K is odd. A shard is a run of whole parts, so the sum of the shards is exactly the run
in one piece. Pairs: the shard that begins with part f runs with the seed S + f / K, modulo 2^64, which makes its part 0
the part f of the campaign. Swaps: cchip_swaps --part. chip and faults draw everything from one stream of numbers and
cannot be cut so: shard I has the seed S + I, and one piece is the same seeds one after another. The bins of swaps and
faults are sets, which no sum gives; they are left out.
Exit codes: 0 nothing wrong, 1 a shard could not be made or may not be merged, 2 bad arguments, 3 wrong results."""
import argparse
import csv
import hashlib
import io
import json
import os
import pathlib
import re
import subprocess
import sys

PART_SEEDS = 0x9E3779B97F4A7C15  # CommonOptions::seed_of in sim/stimulus/include/cchip/stimulus/campaign.hpp
PART_PAIRS = 1 << 16             # part_pairs, in the same file
PART_SWAPS = 50                  # cchip_swaps --per-part
WRONG = 3                        # exit code of a campaign that found something wrong
NO_GOALS = ["--least-pairs", "0", "--least-hits", "0"]  # merge() demands every pair; a small shard need not have hits

JUDGED = ["pairs", "hits", "special", "wrong_exhaustive", "wrong_directed", "false_no"]
RELATED = ["pairs", "apart", "touching", "crossing", "wrong"]
CERTAIN = ["pairs", "hits", "changed", "exhaustive_no", "exhaustive_hit", "directed_no", "directed_hit", None,
           "contradictions", "false_no", "other_wrong"]
CHIP = ["queries", "hits", "contacts", "open", "fallbacks", None, "differences"]
# kind: (program, size of a part, columns behind the name of a row, key of the last line that counts the amount)
KINDS = {"random": ("cchip_campaign", PART_PAIRS, JUDGED + [None] * 3, "pairs"),
         "grid": ("cchip_campaign", PART_PAIRS, JUDGED + [None] * 3, "pairs"),
         "relation": ("cchip_campaign", PART_PAIRS, RELATED, "pairs"),
         "certainty": ("cchip_campaign", PART_PAIRS, CERTAIN, "pairs"),
         "boxes": ("cchip_campaign", PART_PAIRS, None, "pairs"),
         "swaps": ("cchip_swaps", PART_SWAPS, None, "swaps"),
         "chip": ("cchip_chip_campaign", 1, CHIP, "queries"),
         "faults": ("cchip_chip_campaign", 1, None, "queries")}
BY_SEED = ("chip", "faults")
NO_COUNTS = {"seconds", "seed", "bins", "exchanges", "clocks_mean"}  # of a last line
GOOD = {"pairs", "hits", "queries", "swaps", "contacts", "open", "fallbacks", "rounds", "resets", "bus_resets",
        "damaged_images", "faults", "near", "points", "with_cuts", "apart", "touching", "crossing", "bound_cases",
        "rtl_results"}  # may be over 0


class Refused(Exception):
    """One line: what is wrong with which file."""


def share(amount, shards, shard):
    """First and one behind the last of what a shard has of an amount; the shares differ by one at most."""
    return amount * shard // shards, amount * (shard + 1) // shards


def commands(o, shard):
    """Argument lists of a shard, the program's name first."""
    program, part, _, _ = KINDS[o.kind]
    if o.kind in BY_SEED:
        first, end = share(o.amount, o.shards, shard)
        count, seed = str(end - first), str(o.seed + shard)
        return [] if first == end else [[program, "poses", "--first", count, "--all", "0", "--seed", seed]
                                        if o.kind == "chip" else
                                        [program, "faults", "--queries", count, "--seed", seed]]
    first, end = share(-(-o.amount // part), o.shards, shard)
    if o.kind == "swaps":
        return [[program, "--swaps", str(o.amount), "--seed", str(o.seed), "--threads", "1", "--part", str(n)]
                for n in range(first, end)]
    return [] if first == end else [pairs_command(o, min(end * part, o.amount) - first * part,
                                                  (o.seed + first * pow(PART_SEEDS, -1, 1 << 64)) % (1 << 64))]


def pairs_command(o, pairs, seed):
    more = {"relation": ["--random"],
            "certainty": ["--bounds", str(pairs), "--least-definite", "0", "--least-definite-hits", "0"]}
    return ["cchip_campaign", o.kind, "--shape", o.shape, "--pairs", str(pairs), "--seed", str(seed), "--threads", "1",
            *NO_GOALS, *more.get(o.kind, [])]


def one_piece(o):
    """Argument lists of the campaign in one piece."""
    if o.kind in BY_SEED:
        return [line for shard in range(o.shards) for line in commands(o, shard)]
    if o.kind == "swaps":  # run with all bins as a goal, or part by part; the counts are those of all parts
        return [["cchip_swaps", "--swaps", str(o.amount), "--seed", str(o.seed), "--threads", "1"]]
    return [pairs_command(o, o.amount, o.seed)]


def counts_of(kind, text):
    """Counts of a program's output, {row: {column: number}}: its table and, as row `total`, its last line."""
    columns = KINDS[kind][2]
    counts = {}
    for line in text.splitlines():
        if columns:
            words = line.split()
            name, values = " ".join(words[:-len(columns)]), words[-len(columns):]
            if name and name != "all" and all(re.fullmatch(r"[0-9.]+", value) for value in values):
                counts[name] = {column: int(value) for column, value in zip(columns, values) if column}
        elif line.startswith("reports:"):
            words = line.split()[1:]
            counts["reports"] = {name: int(value) for name, value in zip(words[::2], words[1::2])}
        elif line.startswith("codes:"):
            counts["codes"] = {name: int(value) for name, value in re.findall(r"(\d+)=(\d+)", line)}
    last = dict(re.findall(r"(\w+)=(\S+)", (text.splitlines() or [""])[-1]))
    if KINDS[kind][3] not in last:  # goals that were missed are printed behind it, and shards have none
        raise Refused(f"the last line of the output has no {KINDS[kind][3]}=")
    counts["total"] = {name: int(value) for name, value in last.items() if name not in NO_COUNTS}
    return counts


def add(into, counts):
    for row, columns in counts.items():
        for column, value in columns.items():
            into.setdefault(row, {}).setdefault(column, 0)
            into[row][column] += value
    return into


def write(path, text):
    """The whole file or none: under another name first, renamed when it is on the disk."""
    path = pathlib.Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.name}.{os.uname().nodename}.{os.getpid()}")
    try:
        with partial.open("w") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        partial.replace(path)
    finally:
        partial.unlink(missing_ok=True)


def execute(o, lines):
    """Counts and the worst exit code of some commands."""
    counts, worst = {}, 0
    for line in lines:
        result = subprocess.run([str(pathlib.Path(o.bin) / line[0]), *line[1:]], stdout=subprocess.PIPE, text=True)
        whole_swaps = line[0] == "cchip_swaps" and "--part" not in line  # exits with 3 for an empty bin, too
        if result.returncode not in (0, WRONG):
            raise Refused(f"{' '.join(line)}: exit code {result.returncode}")
        if result.returncode == WRONG and not whole_swaps:
            sys.stderr.write(result.stdout)
            worst = WRONG
        add(counts, counts_of(o.kind, result.stdout))
    return counts, worst


def settings(o):
    return {"kind": o.kind, "amount": o.amount, "shards": o.shards, "shape": o.shape, "seed": o.seed}


def run(o):
    program = pathlib.Path(o.bin) / KINDS[o.kind][0]
    digest = hashlib.sha256(program.read_bytes()).hexdigest()
    counts, worst = execute(o, commands(o, o.shard))
    write(o.output, json.dumps({**settings(o), "shard": o.shard, "commands": commands(o, o.shard), "program": digest,
                                "exit_code": worst, "counts": counts}, indent=1) + "\n")
    return 0  # wrong results are results; merge() ends with their exit code


def load(path, o):
    try:
        shard = json.loads(pathlib.Path(path).read_text())
    except (OSError, ValueError) as error:
        raise Refused(f"{path}: {error}") from None
    for name, value in settings(o).items():
        if shard.get(name) != value:
            raise Refused(f"{path}: {name} is {shard.get(name)}, not {value}")
    if shard["commands"] != commands(o, shard["shard"]):
        raise Refused(f"{path}: was made by other commands")
    return shard


def merge(o):
    found, programs, counts = {}, set(), {}
    # a folder, because the names of many shards are too long for a command
    files = [file for path in map(pathlib.Path, o.files)
             for file in (sorted(path.glob("shard*.json")) if path.is_dir() else [path])]
    for path in files:
        shard = load(path, o)
        if shard["shard"] in found:
            raise Refused(f"{path}: shard {shard['shard']} is in {found[shard['shard']]}, too")
        found[shard["shard"]] = path
        programs.add(shard["program"])
        add(counts,
            {**shard["counts"], "total": {**shard["counts"].get("total", {}),
                                          "wrong_shards": int(shard["exit_code"] != 0)}})
    missing = sorted(set(range(o.shards)) - set(found))
    if missing:
        raise Refused(f"shards are missing: {' '.join(map(str, missing))}")
    if len(programs) != 1:
        raise Refused("the shards were made by different builds of the program")
    return table(o, counts)


def table(o, counts):
    """Writes the table and prints its total; the exit code."""
    total = counts["total"]
    got = total[KINDS[o.kind][3]]
    if o.kind in ("random", "grid", "relation", "certainty", "boxes") and got != o.amount or got < o.amount:
        raise Refused(f"{KINDS[o.kind][3]} is {got}, not {o.amount}")
    lines = [["row", "column", "count"]]
    lines += [[row, column, value] for row, columns in counts.items() if row != "total"
              for column, value in columns.items()]
    lines += [["total", column, value] for column, value in total.items()]
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerows(lines)
    write(o.output, text.getvalue())
    return check(o.output)


def check(path):
    with open(path, newline="") as file:
        total = {line["column"]: int(line["count"]) for line in csv.DictReader(file) if line["row"] == "total"}
    print(" ".join(f"{name}={value}" for name, value in total.items()), flush=True)
    return WRONG if any(value and name not in GOOD for name, value in total.items()) else 0


def piece(o):
    counts, worst = execute(o, one_piece(o))
    return table(o, add(counts, {"total": {"wrong_shards": int(worst != 0)}}))


def main():
    if len(sys.argv) < 2 or {"-h", "--help"} & set(sys.argv):
        print(__doc__)
        return 0 if len(sys.argv) > 1 else 2
    if sys.argv[1] == "check" and len(sys.argv) == 3:
        return check(sys.argv[2])
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("action", choices=("run", "merge", "piece"))
    parser.add_argument("--kind", choices=KINDS, required=True)
    parser.add_argument("--amount", type=int, required=True)
    parser.add_argument("--shards", type=int, required=True)
    parser.add_argument("--shard", type=int)
    parser.add_argument("--shape", choices=("tri-tri", "tri-quad", "quad-quad"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--bin", default="build/release/bin")
    parser.add_argument("--output", required=True)
    parser.add_argument("files", nargs="*")
    o = parser.parse_intermixed_args()
    o.shape = o.shape or ("tri-quad" if o.kind == "grid" else "tri-tri")
    if o.kind == "grid" and o.shape == "tri-tri":
        parser.error("grid tri-tri spreads its sample over all pairs and cannot be cut; tri-quad and quad-quad can")
    if o.amount < 1 or o.shards < 1 or (o.action == "run") != (o.shard is not None and 0 <= o.shard < o.shards):
        parser.error("--amount and --shards are at least 1; --shard I of run is 0..SHARDS-1")
    try:
        return {"run": run, "merge": merge, "piece": piece}[o.action](o)
    except (Refused, OSError) as error:
        print(f"campaign.py: {error}", file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
