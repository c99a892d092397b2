#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutants of the RTL: how many wrong versions of each module do its unit tests find?

usage: mutants.py [MODULE...] [options]     without MODULE every module that has unit tests
  --each N        mutants of a module: one for each N cells of its netlist, at least 16 and at most 96 (default 2)
  --sample N      only N mutants, spread over the modules: for a look in short time
  --seed N        of the choice of mutants (default 1)
  --jobs N        programs at the same time (default 2)
  --shard I/N     only every N-th module, counted from I = 1: for several machines; results of all are put together by
                  --table
  --build DIR     where unit_tests has been built (default build/release; `scripts/run mutants` builds it)
  --table         only the table of what was run so far
  --write         put the modules that have run into docs/figures/mutants.csv, and the table of its rows into
                  docs/develop/mutants.md
  --again         run those that live once more, with the unit tests of today
  --least N       exit code 1 if of the mutants that can be told from the original fewer than N % were killed (default
                  0)
  --alive         print the mutants that nothing killed

Yosys changes a cell of the netlist of a module: an input or output inverted, at 0 or 1, or made to depend on another
bit (its command `mutate`). All mutants of a module are in one netlist, of which an integer chooses one, so that it is
translated and compiled once. The netlist takes the place of the module in the program of its unit tests, with the last
set of parameters that these have; number 0, no mutant, must pass. A mutant is killed if the tests fail, crash, or run
ten times as long. Modules without unit tests of their own are changed inside the module that uses them.

A mutant that lives may be one that nobody can tell from the original. ABC compares both from the state in which all
registers are 0, under any inputs: `proved` if no inputs of any length tell them apart, `bounded` if none of --depth
clocks do (default 200). Alive is what can be told apart, or for which ABC needs more than a minute.

Of one that lives docs/figures/mutants_alive.csv may say in a sentence why it cannot matter: by reading, not by proof.
It counts as alive, and as explained. A row whose mutant is another one by now, or does not live, is an error.

Everything is kept below build/mutants; a second run goes on where the first one ended. The last line is
`mutants=N equivalent=E killed=K alive=A explained=X`. Exit codes: 0 done, 1 a tool or a test without mutant failed, a
row of mutants_alive.csv is out of date or --least was missed, 2 bad arguments."""
import argparse
import collections
import concurrent.futures
import csv
import functools
import hashlib
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import time

import datasheet

ROOT = pathlib.Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"
OUT = ROOT / "build" / "mutants"
PAGE = ROOT / "docs" / "develop" / "mutants.md"
RECORD = ROOT / "docs" / "figures" / "mutants.csv"
ALIVE = ROOT / "docs" / "figures" / "mutants_alive.csv"
# why a mutant that lives cannot matter; docs/develop/mutants.md has what they mean
KINDS = ("illegal", "unreachable", "same", "speed")
COUNTS = ("mutants", "proved", "bounded", "killed", "differs", "undecided")
# module `ROOM/N`: N modules of a room together, until one of the room is recorded
COLUMNS = ("module", *COUNTS, "commit")
SELECTOR_W = 16
SELECT = """extern "C" int cchip_mutant();
#include <cstdlib>
int cchip_mutant() {
  const char* chosen = std::getenv("CCHIP_MUTANT");
  return chosen ? std::atoi(chosen) : 0;
}
"""


class Failed(Exception):
    pass


def run(command, **more):
    done = subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace", **more)
    if done.returncode:
        raise Failed(f"{' '.join(map(str, command))[:200]}: exit code {done.returncode}\n{done.stdout[-2000:]}")
    return done.stdout


def rtl_files():
    """{module: file} of rtl/cchip.f and of the models for simulation."""
    found = {}
    for folder, name in ((RTL, "cchip.f"), (ROOT / "sim" / "rtl_models", "sim.f")):
        for line in (folder / name).read_text().splitlines():
            if line.endswith(".v"):
                found[pathlib.Path(line).stem] = folder / line
    return found


FILES = rtl_files()
ROOMS = list(dict.fromkeys(path.parent.name for path in FILES.values()))


def uses(module):
    """Modules of the RTL that a module's file names, itself not."""
    return {name for name in re.findall(r"\bcchip_\w+", re.sub(r"//.*", "", FILES[module].read_text()))
            if name in FILES and name != module}


class Module:
    """A module with its unit tests, and the last set of parameters of these."""

    def __init__(self, name, build):
        self.name, self.build, self.folder = name, build, OUT / name
        header = (build / "tests/unit/include/models" / f"{name}.hpp").read_text()
        sets = re.findall(r"struct \w+ \{\n  using Model = (\w+);\n(.*?)\};", header, re.S)
        self.model, parameters = sets[-1]
        self.set = len(sets) - 1
        self.parameters = re.findall(r"static constexpr int (\w+) = (-?\d+);", parameters)
        self.inside = []  # modules without tests of their own

    def results(self):
        path = self.folder / "results.json"
        return json.loads(path.read_text()) if path.exists() else {}

    def save(self, results):
        (self.folder / "results.json").write_text(json.dumps(results, indent=1) + "\n")

    def mutants(self):
        return [line for line in (self.folder / "list").read_text().splitlines() if line]

    def place(self, number):
        """Where mutant `number` is and what it does, for a reader: `$and cchip_x.v:85 A[3] cnot1 5`, of an instance its
        name."""
        line = self.mutants()[number - 1]
        word = lambda option: (re.search(rf" -{option} (\S+)", line) or ["", ""])[1]
        cell = re.sub(r"^(\$\w+?)\$.*/(\w+\.v:\d+)\$\d+$", r"\1 \2", word("cell"))
        if ":" not in cell:
            cell = re.sub(r"[$]\d+(?=_|$)", "", cell) + " " + re.sub(r"^.*/(.*:\d+)[.].*", r"\1", word("src"))
        return f"{cell} {word('port')}[{word('portbit')}] {word('mode')} {word('ctrlbit')}".rstrip()

    # ---- making the program

    def script(self):
        """What Yosys does before it mutates."""
        parameters = " ".join(f"-set {name} {value}" for name, value in self.parameters)
        return "\n".join([f"read_verilog -I{RTL}/include " + " ".join(map(str, sorted(self.needed()))),
                          *([f"chparam {parameters} {self.name}"] if parameters else []),
                          f"hierarchy -check -top {self.name}", "proc", "opt_clean"]) + "\n"

    def prepared(self):
        """The same, with a top that has its name also where Yosys has named it after its parameters."""
        return self.script() + f"rename -top {self.name}\n"

    def needed(self):
        found, open_ = {self.name}, [self.name]
        while open_:
            for name in uses(open_.pop()) - found:
                found.add(name)
                open_.append(name)
        return {FILES[name] for name in found}

    def selection(self):
        return " ".join([self.name] + [pattern for name in self.inside
                                       for pattern in (name, f"$paramod\\{name}\\*", f"$paramod$*\\{name}")])

    def yosys(self, text, name):
        path = self.folder / name
        path.write_text(text)
        return run(["yosys", "-q", "-l", path.with_suffix(".log"), "-s", path])

    def make(self, each, seed):
        """The program with all mutants; returns False if it is there already."""
        key = hashlib.sha256(json.dumps([self.script(), self.selection(), each, seed]
                                        + [path.read_text() for path in sorted(self.needed())]).encode()).hexdigest()
        if (self.folder / "key").exists() and (self.folder / "key").read_text() == key and (
            self.folder / "program").exists():
            return
        self.folder.mkdir(parents=True, exist_ok=True)
        for old in self.folder.glob("results.json"):
            old.unlink()
        self.yosys(self.prepared() + f"select -set own {self.selection()}\ntee -o {self.folder}/cells stat @own\n",
                   "count.ys")
        cells = sum(map(int, re.findall(r"Number of cells: +(\d+)", (self.folder / "cells").read_text())))
        count = max(16, min(96, cells // each))
        own = f"select -set own {self.selection()}\n"
        self.yosys(self.prepared() + own + f"mutate -list {2 * count} -seed {seed} -o {self.folder}/list @own\n",
                   "list.ys")
        # not the clock (of another clock a netlist's simulation says nothing), not where a memory begins (Yosys writes
        # constants only), and no output of registers that begin with a value, which a mutant would lose
        begin = any(re.search(r"\breg\b[^;]*=|\binitial\b", FILES[name].read_text())
                    for name in (self.name, *self.inside))
        lines = [line for line in self.mutants()
                 if not re.search(r"-port (\w+_)?CLK |-cell \$auto\$mem\.cc:\d+:emit", line)
                 and not (begin and "-port Q " in line)]
        lines = [lines[i * len(lines) // min(count, len(lines))] for i in range(min(count, len(lines)))]
        (self.folder / "list").write_text("".join(line.replace("mutate ", f"mutate -ctrl mutant {SELECTOR_W} {number} ",
                                                               1) + "\n" for number, line in enumerate(lines, 1)))
        self.yosys(self.prepared() + f"script {self.folder}/list\nwrite_verilog -noattr {self.folder}/netlist.v\n",
                   "mutate.ys")
        text = (self.folder / "netlist.v").read_text()
        text = re.sub(r"(module [^;]*?)(, mutant\b|\bmutant, )", r"\1", text)
        text = re.sub(r"    \.mutant\(mutant\),?\n", "", text)
        text = re.sub(r",\n  \);", "\n  );", text)
        text = re.sub(rf"  input \[{SELECTOR_W - 1}:0\] mutant;\n", "  import \"DPI-C\" function int cchip_mutant();\n "
                                                                    " integer chosen_mutant = cchip_mutant();\n", text)
        text = re.sub(rf"  wire \[{SELECTOR_W - 1}:0\] mutant;\n",
                      f"  wire [{SELECTOR_W - 1}:0] mutant = chosen_mutant[{SELECTOR_W - 1}:0];\n", text)
        (self.folder / "netlist.v").write_text(text)
        (self.folder / "select.cpp").write_text(SELECT)
        run(["verilator", "--cc", "-Wno-fatal", "-Wno-lint", "-fno-const-bit-op-tree", "-fno-dfg", "--x-assign",
             "unique", "--x-initial", "unique", "--prefix", self.model,
             "--top-module", self.name, "--Mdir", self.folder / "model", "--output-split", "20000",
             self.folder / "netlist.v"])
        ccache = os.environ.get("CMAKE_CXX_COMPILER_LAUNCHER", "")
        run(["make", "-s", "-C", self.folder / "model", "-f", f"{self.model}.mk", f"{self.model}__ALL.a",
             f"CXX={ccache} c++ -w", "OPT_FAST=-O1", "OPT_SLOW=-O0"])
        run(["c++", "-c", self.folder / "select.cpp", "-o", self.folder / "select.o"])
        self.link()
        (self.folder / "key").write_text(key)

    def same_class(self):
        """Is the class of the netlist, from outside, that of the RTL, against which the test was compiled? Not if
        Verilator kept other instances as members."""
        def outside(path):
            text = re.sub(r"//.*|\n\s*\n", "\n", path.read_text())
            return re.findall(r"VL_(?:IN|OUT)\w*\([^)]*\)", text), re.findall(r"\w+\* const \w+;", text)
        return outside(self.folder / "model" / f"{self.model}.h") == outside(self.compiled_model())

    def compiled_model(self):
        """Header of the model in unit_tests; None for a module that a program of its own tests."""
        return next((self.build / "tests/unit").glob(f"*.models/{self.model}.h"), None)

    def compiled(self, part):
        """The test against the class of the netlist."""
        command = shlex.split(run(["ninja", "-C", self.build, "-t", "commands", part]).splitlines()[-1])
        target = self.folder / pathlib.Path(part).name
        command[command.index("-o") + 1] = str(target)
        command[command.index("-c"):command.index("-c")] = [f"-I{self.folder}/model"]
        run(command, cwd=self.build)
        return str(target)

    def link(self):
        """As unit_tests is linked, with the tests of this module alone and the netlist in front of the models; -z
        muldefs: the first definition counts."""
        command = run(["ninja", "-C", self.build, "-t", "commands", "unit_tests"]).splitlines()[-1].split(
            "&&")[1].split()
        tests = [part for part in command if "unit_tests.dir/" in part]
        own = [part for part in tests if re.search(rf"/test_{self.name}\.cpp\.o$", part)
               or f"/test_{self.name}_" in part and self.tests_only_me(part)]
        rest = [part for part in command if part not in tests]
        if not self.same_class():
            own = [self.compiled(part) for part in own]
        rest[rest.index("-o") + 1] = str(self.folder / "program")
        first = next(i for i, part in enumerate(rest) if part.endswith(".a"))
        rest[first:first] = [*own, str(self.folder / "select.o"), str(self.folder / "model" / f"{self.model}__ALL.a"),
                             "-Wl,-z,muldefs"]
        run(rest, cwd=self.build)

    def tests_only_me(self, part):
        source = ROOT / "tests/unit" / re.search(r"(test_\w+\.cpp)\.o$", part)[1]
        return f"[{self.name}]" in source.read_text()

    # ---- running it

    def start(self, mutant, limit):
        """(exit code, or None after `limit` s; seconds)"""
        began = time.monotonic()
        try:
            code = subprocess.run([self.folder / "program", "-a", "-w", "NoTests", "-f", self.folder / "names"],
                                  env={**os.environ, "CCHIP_MUTANT": str(mutant)}, timeout=limit,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                  cwd=self.build / "tests/unit").returncode
        except subprocess.TimeoutExpired:
            code = None
        return code, time.monotonic() - began

    def choose_tests(self):
        """Of test cases for all sets of parameters, which Catch2 numbers, that of the last one."""
        done = subprocess.run([self.folder / "program", "--list-test-names-only"], stdout=subprocess.PIPE, text=True)
        names = [line for line in done.stdout.splitlines() if line.strip()]
        number = lambda name: re.search(r" - (\d+)$", name)
        chosen = [name for name in names if not number(name) or int(number(name)[1]) == self.set]
        (self.folder / "names").write_text("\n".join(name.replace(",", "\\,") for name in chosen) + "\n")

    def test(self, mutants, pool):
        """Runs the mutants that have not run; adds to results.json."""
        results = self.results()
        waits = [number for number in mutants if str(number) not in results]
        if not waits:
            return
        self.choose_tests()
        code, seconds = self.start(0, 600)
        if code != 0:
            raise Failed(f"{self.name}: its tests fail on the netlist without a mutant (exit code {code}): "
                         f"{self.folder}/program -f {self.folder}/names")
        for number, (code, _) in zip(waits, pool.map(lambda number: self.start(number, 10 * seconds + 5), waits)):
            results[str(number)] = {"killed": "time" if code is None else "test"} if code != 0 else {}
        self.save(results)

    # ---- what lives

    def change(self, number):
        """(what Yosys does for mutant `number`, folder for it)"""
        folder = self.folder / f"same{number}"
        folder.mkdir(exist_ok=True)
        return re.sub(r"-ctrl \S+ \d+ \d+ ", "", self.mutants()[number - 1]), folder

    def compare(self, number, depth):
        """Is mutant `number` the same as the original? proved, bounded, differs or unknown."""
        line, folder = self.change(number)
        aiger = folder / "miter.aig"
        text = (self.prepared() + "design -save base\nflatten\nrename -top gold\ndesign -stash gold\ndesign -load "
                                  "base\n" + line + "\nflatten\nrename -top gate\n"
                "design -copy-from gold -as gold gold\nmiter -equiv -flatten gold gate miter\nhierarchy -top miter\n"
                "chformal -remove\nmemory -nordff\nopt -full\ntechmap\nopt -fast\nabc -g AND\ndffunmap\nopt_clean\n"
                "setundef -undriven -zero\nsetundef -init -zero\n"
                f"aigmap\nwrite_aiger -zinit {aiger}\n")
        try:
            (folder / "compare.ys").write_text(text)
            run(["yosys", "-q", "-l", folder / "log", "-s", folder / "compare.ys"], timeout=120)
            read = f"read_aiger {aiger}; strash;"
            said = self.abc(read + " dsat; print_status; scorr; dprove -r; print_status; pdr -T 10; print_status")
            if re.search(r"disproved|was asserted|Output \d+ .* asserted", said):
                return "differs"
            if re.search(r"UNSATISFIABLE|Networks are equivalent|Property proved|proved",
                         said) and not re.search(r"(?<!UN)SATISFIABLE\b", said):
                return "proved"
            said = self.abc(f"{read} scorr; bmc3 -F {depth} -T 30")
            if "was asserted" in said:
                return "differs"
            clocks = re.search(r"No output asserted in (\d+) frames", said)  # fewer than asked for if time has run out
            return "bounded" if clocks and int(clocks[1]) >= depth else "unknown"
        except (Failed, subprocess.TimeoutExpired) as what:
            (folder / "failed").write_text(str(what))
            return "unknown"

    def purged(self, change, name):
        """The text of what Yosys leaves of the module with a change, without what nothing reads; None if it fails."""
        script = self.folder / f"{name}.ys"
        script.write_text(f"{self.prepared()}{change}\nflatten\nopt_expr\nopt_clean -purge\nwrite_rtlil "
                          f"{self.folder}/{name}.il\n")
        try:
            run(["yosys", "-q", "-s", script], timeout=120)
        except (Failed, subprocess.TimeoutExpired):
            return None
        text = (self.folder / f"{name}.il").read_text().partition("\nmodule")[2]
        (self.folder / f"{name}.il").unlink()
        return text

    @functools.lru_cache(maxsize=1)  # noqa: B019  one object for each module, kept to the end
    def original(self):
        return self.purged("", "gold")

    def same_text(self, number):
        """proved if the same text is left of the mutant and of the original: a change of what is not used. Else
        None."""
        text = self.purged(self.change(number)[0], f"same{number}/gate")
        return "proved" if text is not None and text == self.original() else None

    @staticmethod
    def abc(commands):
        """What it says; also if it does not end in time."""
        return subprocess.run(["timeout", "40", "yosys-abc", "-c", commands], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, errors="replace").stdout

    def again(self):
        """Those that live have not run."""
        self.link()
        self.save({number: result for number, result in self.results().items() if "killed" in result
                   or result.get("same") in ("proved", "bounded")})

    def judge(self, way, pool):
        """Asks way(number) about those that live and are not judged."""
        results = self.results()
        waits = [number for number, result in results.items() if not result]
        for number, found in zip(waits, pool.map(lambda number: way(int(number)), waits)):
            if found:  # kept at once: a minute each may have gone into it
                results[number] = {"same": found}
                self.save(results)


def modules(build):
    """Those with unit tests, and in each what has none."""
    tested = [Module(name, build) for name in FILES if (build / "tests/unit/include/models" / f"{name}.hpp").exists()
              and (ROOT / "tests/unit" / f"test_{name}.cpp").exists()]
    found = {module.name: module for module in tested if module.compiled_model()}
    elsewhere = {module.name for module in tested} - found.keys()
    for name in FILES:
        if name in found or name in elsewhere:
            continue
        users = [user for user in FILES if name in uses(user)]
        while users and not any(user in found for user in users):
            users = [user for one in users for user in FILES if one in uses(user)]
        owner = next((user for user in users if user in found), None)
        if owner:
            found[owner].inside.append(name)
    return found


def summary(chosen):
    """A row of RECORD for each that has run: {column: value}."""
    rows = []
    for module in chosen:
        results = list(module.results().values())
        if results:
            row = {kind: sum(result.get("same") == kind for result in results)
                   for kind in ("proved", "bounded", "differs")}
            row.update(module=module.name, mutants=len(results), killed=sum("killed" in result for result in results),
                       commit=commit())
            row["undecided"] = len(results) - row["killed"] - row["proved"] - row["bounded"] - row["differs"]
            rows.append(row)
    return rows


def sentences(path):
    """{module, or "" of a table without: {mutant: row}}: why mutants that live cannot matter."""
    found = collections.defaultdict(dict)
    if path.exists():
        with path.open() as file:
            for row in csv.DictReader(file):
                module = row.get("module", "")
                if row["kind"] not in KINDS or not row["why"] or row["mutant"] in found[module]:
                    raise Failed(f"{path.name}: {module} {row['mutant']}: twice, without a reason, or of a kind that "
                                 f"is none of {', '.join(KINDS)}")
                found[module][row["mutant"]] = row
    return found


def wrong_sentence(path, row, place, lives):
    """What is wrong with a row whose mutant is at `place` now; "" if nothing."""
    name = " ".join([f"{path.name}:", *([row["module"]] if "module" in row else []), row["mutant"]])
    if place != row["place"]:
        return f"{name} is {place}, not {row['place']}"
    return "" if lives else f"{name} does not live; take the row away"


def explained():
    """{module: {mutant: row}} of ALIVE."""
    return sentences(ALIVE)


def out_of_date(chosen):
    """What ALIVE says of mutants that are others by now, or do not live."""
    wrong = []
    for module in chosen:
        results = module.results()
        for number, row in explained()[module.name].items() if results else []:
            result = results.get(number, {})
            wrong.append(wrong_sentence(ALIVE, row, module.place(int(number)) if result else "none",
                                        "killed" not in result and result.get("same") not in ("proved", "bounded")))
    return [what for what in wrong if what]


def commit():
    def git(*words):
        return run(["git", *words], cwd=ROOT).strip()
    return git("rev-parse", "--short=7", "HEAD") + ("+" if git("status", "--porcelain", "rtl", "sim", "tests") else "")


def recorded():
    if not RECORD.exists():
        return []
    with RECORD.open() as file:
        return [{column: row[column] if column in ("module", "commit") else int(row[column]) for column in COLUMNS}
                for row in csv.DictReader(file)]


def record(rows):
    """RECORD with these rows, in the order of FILES, those of modules that are gone left out."""
    all_rows = {row["module"]: row for row in [*recorded(), *rows]}
    rooms = {room_of(row)[0] for row in all_rows.values() if "/" not in row["module"]}
    together = [row for row in all_rows.values() if "/" in row["module"] and room_of(row)[0] not in rooms]
    with RECORD.open("w", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows([*together, *(all_rows[name] for name in FILES if name in all_rows)])


def room_of(row):
    """(room, number of modules)"""
    room, _, number = row["module"].partition("/")
    return (room, int(number)) if number else (FILES[room].parent.name, 1)


def sums(rows):
    """mutants, equivalent by proof and within a bound, killed, alive: told apart and undecided"""
    return [sum(row[column] for row in rows) for column in COUNTS]


def explained_of(rows):
    """Mutants of these rows that live and are explained."""
    found = explained()
    return sum(len(found[row["module"]]) for row in rows)


def table(rows):
    lines = ["| room | modules | mutants | equivalent, proved | equivalent, bounded | killed | alive, told apart by "
             "ABC | alive, undecided | of these explained | killed of those that are not equivalent |",
             "|---|---|---|---|---|---|---|---|---|---|"]
    rooms = collections.defaultdict(list)
    for row in rows:
        rooms[room_of(row)[0]].append(row)
    rooms = {room: rooms[room] for room in ROOMS if room in rooms}
    rooms["all"] = rows
    for room, inside in rooms.items():
        all_sums = sums(inside)
        told = sum(all_sums[3:])
        lines.append(f"| {room} | {sum(room_of(row)[1] for row in inside)} | "
                     + " | ".join(map(str, [*all_sums, explained_of(inside)]))
                     + f" | {100 * all_sums[3] / told if told else 100:.1f} % |")
    return "\n".join(lines) + "\n"


def arguments():
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    parser.add_argument("modules", nargs="*")
    for name, default in (("--each", 2), ("--sample", 0), ("--seed", 1), ("--jobs", 2), ("--depth", 200),
                          ("--least", 0)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--shard", default="1/1")
    parser.add_argument("--build", type=pathlib.Path, default=ROOT / "build" / "release")
    for flag in ("--table", "--write", "--alive", "--again"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args()
    if not re.fullmatch(r"[1-9]\d*/[1-9]\d*", options.shard):
        parser.error("--shard is I/N, as in 1/4")
    options.build = options.build.resolve()
    return options


def attempt(failures, function, *arguments):
    try:
        function(*arguments)
    except Failed as what:
        failures.append(str(what))
        print(f"mutants.py: {what}", file=sys.stderr, flush=True)


def run_tests(module, at, modules_in_all, options, pool):
    module.make(options.each, options.seed)
    if options.again:
        module.again()
    numbers = range(1, len(module.mutants()) + 1)
    if options.sample:
        share = options.sample // modules_in_all + (at < options.sample % modules_in_all)
        numbers = sorted({1 + i * len(numbers) // share for i in range(share)}) if share else []
    module.test(numbers, pool)
    killed = sum("killed" in result for result in module.results().values())
    print(f"{module.name}: mutants={len(module.results())} killed={killed}", flush=True)


def main():
    if set(sys.argv) & {"-h", "--help"}:
        print(__doc__)
        return 0
    options = arguments()
    found = modules(options.build)
    unknown = [name for name in options.modules if name not in found]
    if unknown or not found:
        print(f"mutants.py: no unit tests of {unknown[0]}" if unknown
              else f"mutants.py: no models in {options.build}; run: scripts/run mutants", file=sys.stderr)
        return 2
    chosen = [found[name] for name in options.modules] or list(found.values())
    part, of = map(int, options.shard.split("/"))
    chosen = chosen[part - 1::of]
    failures = []
    if not options.table:
        print(f"seed {options.seed}")
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            # tests first: what lives is judged when all have run
            for at, module in enumerate(chosen):
                attempt(failures, run_tests, module, at, len(chosen), options, pool)
            # seconds each, then minutes
            for module in chosen:
                attempt(failures, module.judge, module.same_text, pool)
            for module in chosen:
                attempt(failures, module.judge, lambda number: module.compare(number, options.depth), pool)
                for row in summary([module]):
                    print(f"{module.name}: " + " ".join(f"{column}={row[column]}" for column in COUNTS), flush=True)
    rows = summary(chosen)
    if rows:
        print(table(rows))
    for what in out_of_date(chosen):
        failures.append(what)
        print(f"mutants.py: {what}", file=sys.stderr)
    if options.alive:
        known = explained()
        for module in chosen:
            for number, result in module.results().items():
                if result.get("same") in ("differs", "unknown"):
                    print(f"{module.name} {number} {result['same']}: {module.place(int(number))}: "
                          f"{known[module.name].get(number, {}).get('why', 'not explained')}")
    if options.write:
        record(rows)
        datasheet.rewrite(PAGE, "mutants", table(recorded()))
    all_sums = sums(rows)
    killed, told = all_sums[3], sum(all_sums[3:])
    print(f"mutants={all_sums[0]} equivalent={all_sums[1] + all_sums[2]} killed={killed} alive={told - killed} "
          f"explained={explained_of(rows)}")
    if told and 100 * killed < options.least * told:
        failures.append("too few")
        print(f"mutants.py: {killed} of {told} killed, less than {options.least} %", file=sys.stderr)
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
