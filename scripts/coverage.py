#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What the tests reach: lines, branches and toggles of the RTL, branches and lines of the C++ library.

usage: coverage.py [options] BUILD
  BUILD           build folder with CCHIP_COVERAGE in which tests ran with CCHIP_COVERAGE_FOLDER=BUILD/coverage
                  (scripts/run coverage)
  --missing       print every point that nothing reached
  --write         put the tables into docs/develop/coverage.md
  --cpp           the library: BUILD is one by clang (scripts/run coverage-cpp)
  --bins          the table of bins alone, after tests and campaigns of the chip (scripts/run coverage-bins)

Bins count the clocks on which situations of two blocks of the chip meet (sim/rtl_models/cchip_chip_bins.sv).

RTL, by Verilator: a line is a block of statements, a branch one side of an if or a case, a toggle a signal of one bit
(control) that changes after the first reset. Points of all instances and configurations of a module are one. C++, by
clang and llvm-cov (Debian's package llvm): a branch is one side of a condition as it is written, of all instantiations
together.

The last line is `rtl_lines=R% rtl_toggles=T% bins=K/N`, with --bins only the last of these, with --cpp
`cpp_branches=B%`. Exit codes: 0 done, 1 nothing was counted or llvm-cov failed, 2 bad arguments."""
import argparse
import collections
import pathlib
import re
import subprocess
import sys

import datasheet

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "develop" / "coverage.md"
# of cchip_chip_bins.sv, bit 0 first
SITUATIONS = {"cache": ("hit", "miss", "waiter", "again", "locked", "invalidate"),
              "traversal": ("start", "pop", "spill", "end", "cancel"),
              "record ring": ("room", "full", "wrapped"),
              "swap": ("idle", "header", "shutdown", "decouple", "reset", "transfer", "check", "roc",
                       "recouple", "report")}
POINT = re.compile(r"C '(.*)' (\d+)$")
# The one list of what is not asked for, with its reason: (file name, text of the source line or the signal).
EXCLUDED = ROOT / "scripts" / "coverage_excluded.csv"
# What clang counts in.
CPP_ROOMS = ROOT / "scripts" / "coverage_rooms.txt"


class Failed(Exception):
    """The message says what and where."""


def rtl_points(folder):
    """{(file, line, column, kind, what): count} of the modules of rtl/, {(i, j): count} of the bins."""
    points, bins = collections.Counter(), collections.Counter()
    for path in sorted(folder.glob("*.dat")):
        for line in path.read_text().splitlines():
            found = POINT.match(line)
            if not found:
                continue
            fields = dict(field.split("\2", 1) for field in found[1].split("\1") if field)
            name = pathlib.Path(fields["f"])
            if name.name == "cchip_chip_bins.sv" and fields["page"].startswith("v_user"):
                bins[tuple(int(number) for number in re.findall(r"gen_(?:first|second)__BRA__(\d+)__KET__",
                                                                fields["h"]))] += int(found[2])
            if ROOT / "rtl" not in name.parents:
                continue
            kind = fields["page"].split("/")[0].removeprefix("v_")
            points[str(name.relative_to(ROOT)), int(fields["l"]), int(fields["n"]), kind, fields["o"]] += int(found[2])
    if not points:
        raise Failed(f"no counts in {folder}; run the tests with CCHIP_COVERAGE_FOLDER={folder}: scripts/run coverage")
    return points, bins


def bin_table(bins):
    """The bins by the two groups whose situations meet."""
    names = [(group, name) for group, all_names in SITUATIONS.items() for name in all_names]
    rows, missing = collections.defaultdict(lambda: [0, 0]), []
    for (i, j), count in sorted(bins.items()):
        row = rows[f"{names[i][0]}, {names[j][0]}"]
        row[0] += 1
        row[1] += count > 0
        if count == 0:
            missing.append(f"bin {' '.join(names[i])}, {' '.join(names[j])}")
    lines = ["| blocks | bins | reached | not reached |", "|---|---|---|---|"]
    for groups, (count, reached) in rows.items():
        prefixes = groups.split(", ")
        lost = [text[4:] for text in missing if text[4:].startswith(prefixes[0]) and f", {prefixes[1]} " in text]
        short = (text.replace(prefixes[0] + " ", "", 1).replace(prefixes[1] + " ", "", 1) for text in lost)
        lines.append(f"| {groups} | {count} | {reached} | {'; '.join(short)} |")
    total = [sum(row[k] for row in rows.values()) for k in (0, 1)]
    lines.append(f"| all | {total[0]} | {total[1]} | |")
    return "\n".join(lines) + "\n", missing, total


def exclusions():
    """[(file name, kind, pattern, reason)]"""
    rows = [line.split(";", 3) for line in EXCLUDED.read_text().splitlines() if line and not line.startswith("#")]
    return [(name, kind, re.compile(pattern), reason) for name, kind, pattern, reason in rows]


def excluding(point, rules, texts):
    """The numbers of the rules that leave a point out."""
    name, line, _, kind, what = point
    if name not in texts:
        texts[name] = (ROOT / name).read_text().splitlines()
    source = texts[name][line - 1]
    return {number for number, (file, of, pattern, _) in enumerate(rules)
            if re.fullmatch(file, name.split("/")[-1]) and kind == of
            and pattern.search(what if kind == "toggle" else source)}


def rtl_table(points):
    rules, texts = exclusions(), {}
    rows = collections.defaultdict(collections.Counter)
    missing, unused = [], set(range(len(rules)))
    for point, count in sorted(points.items()):
        name, kind = point[0], point[3]
        found = excluding(point, rules, texts)
        if found:
            unused -= found
            for room in (name.split("/")[1], "all"):
                rows[room]["excluded"] += 1
            continue
        for room in (name.split("/")[1], "all"):
            rows[room][kind] += 1
            rows[room][kind, "reached"] += count > 0
        if count == 0:
            missing.append(f"{name}:{point[1]}: {kind} {point[4]}: {texts[name][point[1] - 1].strip()}")
    lines = ["| room of rtl/ | lines | reached | branches | reached | toggles | reached | left out |",
             "|---|---|---|---|---|---|---|---|"]
    for room in [*sorted(set(rows) - {"all"}), "all"]:
        row = rows[room]
        cells = [f"{row[kind]} | {share(row[kind, 'reached'], row[kind])}" for kind in ("line", "branch", "toggle")]
        lines.append(f"| {room} | {' | '.join(cells)} | {row['excluded']} |")
    for number in sorted(unused):
        missing.append(f"{EXCLUDED.name}: rule {number + 1} leaves nothing out")
    return "\n".join(lines) + "\n", missing, rows["all"]


def share(part, whole):
    return f"{100 * part / whole:.1f} %" if whole else "-"


def shown(build):
    """llvm-cov's text about the sources of the rooms, of all programs that were compiled with counters."""
    profile, folder = build / "coverage" / "cpp.profdata", build / "coverage"
    programs = [path for path in sorted((build / "bin").iterdir()) if path.is_file()
                and b"__llvm_covmap" in path.read_bytes()]
    if not programs or not any(folder.glob("*.profraw")):
        raise Failed(f"no counts of the library in {folder}; run scripts/run coverage-cpp")
    try:
        subprocess.run(["llvm-profdata", "merge", "-sparse", "-o", profile, *sorted(folder.glob("*.profraw"))],
                       check=True, stderr=subprocess.PIPE, text=True)
        return subprocess.run(["llvm-cov", "show", "--show-branches=count", "--show-instantiations=false",
                               f"--instr-profile={profile}", programs[0],
                               *(f"--object={path}" for path in programs[1:]),
                               *(ROOT / room for room in re.findall(r"^src:\*/(\S+)/\*$",
                                                                    CPP_ROOMS.read_text(), re.M))],
                              check=True, capture_output=True, text=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        raise Failed(
            f"llvm-cov (Debian's package llvm): {error} {getattr(error, 'stderr', '') or ''}".strip()) from error


def cpp_points(text):
    """{(file, line): (whether reached, source)} and {(file, line, column): [whether true, whether false]}, of all
    instantiations together; conditions that the compiler knows are none."""
    lines, branches, name = {}, {}, ""
    for line in text.splitlines():
        if line.startswith(f"{ROOT}/") and line.endswith(":"):
            name = line[len(f"{ROOT}/"):-1]
        elif found := re.match(r" *(\d+)\| *([\d.]+[kMGTPEZY]?)\|(.*)", line):
            lines[name, int(found[1])] = (found[2] != "0", found[3].strip())
        elif found := re.match(r" *\|  Branch \((\d+):(\d+)\): \[True: (\S+), False: (\S+)\]", line):
            sides = branches.setdefault((name, int(found[1]), int(found[2])), [False, False])
            for k in (0, 1):
                sides[k] |= found[3 + k] != "0"
    return lines, branches


def cpp_table(build):
    lines_of, branches_of = cpp_points(shown(build))
    rows, missing = collections.defaultdict(collections.Counter), []
    for (name, line), (reached, source) in lines_of.items():
        for room in (f"src/{name.split('/')[2]}", "all"):
            rows[room]["lines"] += 1
            rows[room]["lines reached"] += reached
        if not reached:
            missing.append(f"{name}:{line}: line: {source}")
    for (name, line, column), sides in branches_of.items():
        for room in (f"src/{name.split('/')[2]}", "all"):
            rows[room]["branches"] += 2
            rows[room]["branches reached"] += sum(sides)
        if not all(sides):
            never = "never false" if sides[0] else "never true" if sides[1] else "neither"
            missing.append(f"{name}:{line}:{column}: branch {never}: {lines_of[name, line][1]}")
    lines = ["| room of lib/src | lines | reached | branches | reached |", "|---|---|---|---|---|"]
    for room in [*sorted(set(rows) - {"all"}), "all"]:
        row = rows[room]
        lines.append(f"| {room} | {row['lines']} | {share(row['lines reached'], row['lines'])} | {row['branches']} | "
                     f"{share(row['branches reached'], row['branches'])} |")
    return "\n".join(lines) + "\n", missing, rows["all"]


def main():
    if set(sys.argv) & {"-h", "--help"}:
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("build", type=pathlib.Path)
    for flag in ("--missing", "--write", "--cpp", "--bins"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args()
    try:
        if options.cpp:
            text, missing, c = cpp_table(options.build.resolve())
            tables, shares = {"cpp": text}, f"cpp_branches={share(c['branches reached'], c['branches'])}"
        else:
            points, bins = rtl_points(options.build.resolve() / "coverage")
            text, missing, b = bin_table(bins)
            tables, shares = {"bins": text}, f"bins={b[1]}/{b[0]}"
            if not options.bins:
                text, rtl_missing, r = rtl_table(points)
                tables, missing = {"rtl": text, **tables}, rtl_missing + missing
                shares = (f"rtl_lines={share(r['line', 'reached'], r['line'])} "
                          f"rtl_toggles={share(r['toggle', 'reached'], r['toggle'])} {shares}")
    except Failed as what:
        print(f"coverage.py: {what}", file=sys.stderr)
        return 1
    print("\n".join(tables.values()))
    if options.missing:
        print("\n".join(missing))
    for name in tables if options.write else ():
        datasheet.rewrite(PAGE, name, tables[name])
    print(shares.replace(" %", "%"))
    return 0


if __name__ == "__main__":
    sys.exit(main())
