#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Mutants of the C++ library: how many wrong versions of it do the tests find? The sibling of mutants.py, for what decides: src/exact, src/cpu, src/collide.

usage: mutants_cpp.py [options]
  --most N        mutants (default 600), spread over the files by the number of places in each
  --seed N        of the choice (default 1)
  --jobs N        programs at the same time (default 2)
  --slowest S     leave out test cases that take longer than S seconds (default 2); a larger S later asks only what is new
  --only WORDS    ask only test cases whose names contain WORDS, such as a slow one with a larger S
  --again         bring changed tests into the copy and ask them about the mutants that live
  --table         only the table of what was run so far
  --write         put the table into docs/develop/mutants.md
  --alive         print the mutants that nothing killed, and what docs/figures/mutants_cpp_alive.csv says of them

A mutant changes one place: a comparison gets or loses its equality, + and -, && and || are exchanged, a whole number is one more, a sign is lost, a statement is left out. Places are found in
clang's syntax tree (python3-clang); constant expressions are left alone. All mutants are in one copy of the sources, each behind a test of a global number, so that everything is compiled
once: below build/mutants_cpp. A first run of each test case notes which places it comes by; a mutant runs only there, the quickest cases first. Killed: a test case fails, crashes, needs more
than 4 GB, or takes ten times as long. A run that was stopped goes on where it was; after a change of the sources, or with another seed, it begins again.

Not every mutant that lives is a gap: an error bound that is wider than needed, or a search that prunes less, gives the same answers more slowly. docs/figures/mutants_cpp_alive.csv
may say in a sentence why one cannot matter: by reading, not by proof. It counts as alive, and as explained. A row whose mutant is another one by now, or does not live, is an error.

The last line is `mutants=N reached=R killed=K alive=A explained=X`. Exit codes: 0 done, 1 a tool or a test without mutant failed, or a row is out of date, 2 bad arguments."""
import argparse
import collections
import concurrent.futures
import csv
import hashlib
import json
import os
import pathlib
import random
import re
import shlex
import shutil
import subprocess
import sys
import time

import datasheet
from mutants import Failed, run, sentences, wrong_sentence

ROOT = pathlib.Path(__file__).resolve().parent.parent
OUT = ROOT / "build" / "mutants_cpp"
TREE = OUT / "tree"
PAGE = ROOT / "docs" / "develop" / "mutants.md"
ALIVE = ROOT / "docs" / "figures" / "mutants_cpp_alive.csv"
ROOMS = ("exact", "judge", "query", "search")
# test cases that time nothing and write nothing
TESTS = ("test_touching", "test_intersections", "test_self_contacts", "test_points", "test_along", "test_certificate", "test_solids", "test_collide", "test_distance")
SWAPS = {"<": "<=", "<=": "<", ">": ">=", ">=": ">", "==": "!=", "!=": "==", "+": "-", "-": "+", "&&": "||", "||": "&&"}
HEADER = """#ifndef CCHIP_MUTANT_HPP
#define CCHIP_MUTANT_HPP
extern const int cchip_mutant_chosen;
extern unsigned char cchip_mutant_reached[65536];
inline bool cchip_mutant(int number) { cchip_mutant_reached[number] = 1; return number == cchip_mutant_chosen; }
#endif
"""
CHOICE = """#include <cstdio>
#include <cstdlib>
unsigned char cchip_mutant_reached[65536];
static int choose() { const char* text = std::getenv("CCHIP_MUTANT"); return text ? std::atoi(text) : 0; }
extern const int cchip_mutant_chosen;
const int cchip_mutant_chosen = choose();
namespace { struct Reach { ~Reach() {
  const char* path = std::getenv("CCHIP_MUTANT_REACH");
  if (std::FILE* file = path ? std::fopen(path, "w") : nullptr) {
    for (int i = 0; i < 65536; ++i) if (cchip_mutant_reached[i]) std::fprintf(file, "%d\\n", i);
    std::fclose(file);
  }
} } reach; }
"""


def mine(path):
    return path.parent.name in ROOMS and path.parent.parent == TREE / "lib" / "src"


def tracked():
    return [name for name in run(["git", "-C", ROOT, "ls-files"]).splitlines() if (ROOT / name).is_file()]


def copy_sources(rooms=True):
    """Copies what differs; without the rooms, the mutants stay."""
    for name in tracked():
        source, target = ROOT / name, TREE / name
        if (mine(target) and not rooms) or (target.is_file() and target.read_bytes() == source.read_bytes()):
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(source, target)


def digest(most, seed):
    """Of all that decides which mutants there are."""
    total = hashlib.sha256(f"{most} {seed}".encode())
    for name in tracked():
        if mine(TREE / name):
            total.update(name.encode() + (ROOT / name).read_bytes())
    return total.hexdigest()


def configure():
    (OUT / "mutant.hpp").write_text(HEADER)
    (OUT / "choice.cpp").write_text(CHOICE)
    run(["c++", "-O1", "-fPIC", "-fno-exceptions", "-c", OUT / "choice.cpp", "-o", OUT / "choice.o"])
    run(["cmake", "-S", TREE, "-B", OUT / "build", "-G", "Ninja", "-D", "CMAKE_BUILD_TYPE=Release", "-D", "CMAKE_EXPORT_COMPILE_COMMANDS=ON",
         "-D", f"CMAKE_CXX_FLAGS=-include {OUT}/mutant.hpp -Wno-error -w", "-D", f"CMAKE_EXE_LINKER_FLAGS={OUT}/choice.o"])


def commands():
    """{source: (arguments for clang, folder)} of the rooms."""
    found = {}
    for entry in json.loads((OUT / "build" / "compile_commands.json").read_text()):
        path = pathlib.Path(entry["file"])
        if path.parent.name in ROOMS and path.parent.parent == TREE / "lib" / "src" and path not in found:
            parts = shlex.split(entry["command"])[1:]
            keep, skip = [], False
            for part in parts:
                if skip or part in ("-o", "-c", str(path)):
                    skip = part == "-o"
                    continue
                if part.startswith(("-I", "-D", "-std", "-isystem", "-include")) or (keep and keep[-1] in ("-isystem", "-include", "-I")):
                    keep.append(part)
            found[path] = keep
    return found


def places(index, source, arguments):
    """{(file, begin, end, kind): (text before, [pieces])} of one translation unit."""
    from clang.cindex import CursorKind as K
    unit = index.parse(str(source), args=[*arguments, "-x", "c++"])
    found, texts = {}, {}

    def text_of(path):
        if path not in texts:
            texts[path] = path.read_bytes()
        return texts[path]

    def walk(cursor, constant, statement):
        location = cursor.location.file
        if location is not None and cursor.kind != K.TRANSLATION_UNIT:
            path = pathlib.Path(location.name)
            if not mine(path):
                return
            text = text_of(path)
            begin, end = cursor.extent.start.offset, cursor.extent.end.offset
            inside = text[begin:end].decode(errors="replace")
            kind = cursor.kind
            if kind in (K.FUNCTION_DECL, K.CXX_METHOD, K.CONSTRUCTOR, K.FUNCTION_TEMPLATE, K.VAR_DECL, K.CONVERSION_FUNCTION):
                constant = constant or bool(re.match(r"[^({=]*\bconstexpr\b", inside))
            if kind in (K.STATIC_ASSERT, K.ENUM_DECL, K.CASE_STMT, K.TEMPLATE_NON_TYPE_PARAMETER, K.TYPE_ALIAS_DECL, K.PARM_DECL, K.FIELD_DECL):
                constant = constant or kind != K.CASE_STMT
            if kind == K.IF_STMT and re.match(r"if\s+constexpr", inside):
                constant = True
            children = list(cursor.get_children())
            if not constant:
                if statement and inside and kind in (K.BINARY_OPERATOR, K.COMPOUND_ASSIGNMENT_OPERATOR, K.CALL_EXPR, K.UNARY_OPERATOR) and "\n" not in inside:
                    found[path, begin, begin, "statement"] = ("if (!cchip_mutant({})) ",)
                if kind == K.BINARY_OPERATOR and len(children) == 2:
                    left, right = children
                    middle = text[left.extent.end.offset:right.extent.start.offset].decode(errors="replace").strip()
                    if middle in SWAPS and left.extent.start.offset == begin and right.extent.end.offset == end and "\n" not in inside:
                        a, b = text[begin:left.extent.end.offset].decode(), text[right.extent.start.offset:end].decode()
                        found[path, begin, end, f"{middle} to {SWAPS[middle]}"] = (f"(cchip_mutant({{}}) ? ({a} {SWAPS[middle]} {b}) : ({a} {middle} {b}))",)
                if kind == K.UNARY_OPERATOR and inside.startswith("-") and len(children) == 1 and "\n" not in inside:
                    found[path, begin, end, "sign"] = (f"(cchip_mutant({{}}) ? ({inside[1:]}) : ({inside}))",)
                if kind == K.INTEGER_LITERAL and re.fullmatch(r"\d+[uUlLzZ]*", inside):
                    number = re.match(r"\d+", inside)[0]
                    found[path, begin, end, f"{number} to {int(number) + 1}"] = (f"(cchip_mutant({{}}) ? {int(number) + 1}{inside[len(number):]} : {inside})",)
            for child in children:
                walk(child, constant, kind == K.COMPOUND_STMT)
        else:
            for child in cursor.get_children():
                walk(child, constant, False)

    walk(unit.cursor, False, False)
    return found


def choose(found, most, seed):
    """At most so many, spread over the files; of places that lie in each other one."""
    order = sorted(found, key=lambda place: (str(place[0]), *place[1:]))
    pick = random.Random(seed)
    order = [place for place in order if not place[3][0].isdigit() or pick.random() < 0.3]  # numbers are half of all places
    pick.shuffle(order)
    chosen, taken = [], collections.defaultdict(list)
    for place in order:
        path, begin, end, _ = place
        if len(chosen) == most:
            break
        if all(end <= other_begin or begin >= other_end for other_begin, other_end in taken[path]) and not (begin == end and (begin, end) in taken[path]):
            chosen.append(place)
            taken[path].append((begin, end))
    return sorted(chosen, key=lambda place: (str(place[0]), *place[1:]))


def apply(chosen, found):
    """Writes the files with the mutants; {(file, line): [numbers]}."""
    at, edits = collections.defaultdict(list), collections.defaultdict(list)
    for number, place in chosen.items():
        edits[place[0]].append((place[1], place[2], found[place][0].replace("{}", str(number)), number))
    for path in {place[0] for place in found}:
        text = (ROOT / path.relative_to(TREE)).read_bytes()
        for begin, end, new, number in sorted(edits[path], reverse=True):
            at[path, text[:begin].count(b"\n") + 1].append(number)
            text = text[:begin] + new.encode() + text[end:]
        if path.read_bytes() != text:
            path.write_bytes(text)
    return at


def make(most, seed, jobs):
    if all((OUT / name).exists() for name in ("mutants.json", "digest")) and (OUT / "digest").read_text() == digest(most, seed):
        return
    import clang.cindex
    OUT.mkdir(parents=True, exist_ok=True)
    for name in ("mutants.json", "results.json", "cases.json"):
        (OUT / name).unlink(missing_ok=True)
    copy_sources()
    configure()
    units = commands()
    found = {}
    for source, arguments in sorted(units.items()):
        found.update(places(clang.cindex.Index.create(), source, arguments))
    chosen = dict(enumerate(choose(found, most, seed), 1))
    for _ in range(8):  # what does not compile leaves
        at = apply(chosen, found)
        check = lambda item: subprocess.run(["clang++", "-fsyntax-only", "-ferror-limit=0", "-w", *item[1], str(item[0])], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True).stdout
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            said = "\n".join(pool.map(check, units.items()))
        wrong = {(pathlib.Path(name), int(line)) for name, line in re.findall(r"^(/\S+?):(\d+):\d+: (?:fatal )?(?:error|note):", said, re.M)}
        gone = {number for place in wrong for number in at.get(place, [])} & set(chosen)
        if not re.search(r": (fatal )?error:", said):
            break
        if not gone:
            raise Failed(f"the copy does not compile:\n{said[-3000:]}")
        chosen = {number: place for number, place in chosen.items() if number not in gone}
    run(["cmake", "--build", OUT / "build", "-j", jobs, "--target", *TESTS])
    (OUT / "mutants.json").write_text(json.dumps({number: [str(place[0].relative_to(TREE)), (ROOT / place[0].relative_to(TREE)).read_bytes()[:place[1]].count(b"\n") + 1,
                                                           place[3]] for number, place in chosen.items()}, indent=0))
    (OUT / "digest").write_text(digest(most, seed))


def start(case, mutant, limit, reach=None):
    """(exit code or None after limit s, seconds) of a test case: its program and name"""
    began = time.monotonic()
    environment = {**os.environ, "CCHIP_MUTANT": str(mutant), **({"CCHIP_MUTANT_REACH": str(reach)} if reach else {})}
    name = re.sub(r'([\\\\,\[\]"*~])', r"\\\1", case[1])
    try:
        code = subprocess.run(["prlimit", "--as=4294967296", "--core=0", OUT / "build" / "bin" / case[0], "-a", "-w", "NoTests", name], env=environment, timeout=limit,
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=OUT / "build").returncode
    except subprocess.TimeoutExpired:
        code = None
    return code, time.monotonic() - began


def measure(slowest, only):
    """[[program, test case, seconds, places that it comes by]] of the cases that end in so many seconds, the quickest first; seconds is None of the others, which were given `tried`."""
    path = OUT / "cases.json"
    known = {tuple(case[:2]): case for case in (json.loads(path.read_text()) if path.exists() else [])}
    reach = OUT / "case.reach"
    for program in TESTS:
        listed = subprocess.run([OUT / "build" / "bin" / program, "--list-test-names-only"], stdout=subprocess.PIPE, text=True).stdout
        for name in filter(None, (line.strip() for line in listed.splitlines())):
            old = known.get((program, name))
            if only not in name or (old and (old[2] is not None or old[3] >= slowest)):
                continue
            code, seconds = start((program, name), 0, slowest, reach)
            if code:
                raise Failed(f"{program} fails without a mutant (exit code {code}): {OUT}/build/bin/{program} '{name}'")
            known[program, name] = [program, name, None, slowest] if code is None else [program, name, seconds, reach.read_text().split()]
            path.write_text(json.dumps(list(known.values()), indent=0))
    return sorted((case for case in known.values() if case[2] is not None and case[2] <= slowest and only in case[1]), key=lambda case: case[2])


def test(jobs, slowest, only, again):
    mutants = json.loads((OUT / "mutants.json").read_text())
    path = OUT / "results.json"
    results = json.loads(path.read_text()) if path.exists() else {}
    if again:
        (OUT / "cases.json").unlink(missing_ok=True)
        results = {number: result for number, result in results.items() if "killed" in result}
    cases = [(program, name, seconds, set(places)) for program, name, seconds, places in measure(slowest, only)]

    def judge(number):
        asked = set(map(tuple, results.get(number, {}).get("asked", [])))
        reaching = [case for case in cases if number in case[3]]
        for case in reaching:
            if case[:2] not in asked and start(case, number, 10 * case[2] + 2)[0] != 0:
                return {"killed": f"{case[0]}: {case[1]}"}
        return {"asked": sorted(asked | {case[:2] for case in reaching})}

    waits = [number for number in mutants if "killed" not in results.get(number, {})]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for number, result in zip(waits, pool.map(judge, waits)):
            results[number] = result
            path.write_text(json.dumps(results, indent=0))
            print(f"{number} {':'.join(map(str, mutants[number][:2]))} {mutants[number][2]}: {result.get('killed', 'alive')}", flush=True)


def recorded():
    """(mutants, results) of what was run so far."""
    return json.loads((OUT / "mutants.json").read_text()), json.loads((OUT / "results.json").read_text())


def explained(mutants, results):
    """{mutant: row} of ALIVE; all rows are of mutants that live."""
    found = sentences(ALIVE)[""]
    wrong = []
    for number, row in found.items():
        path, line, change = mutants.get(number, ("", 0, "none"))
        wrong.append(wrong_sentence(ALIVE, row, f"{path.removeprefix('lib/')}:{line} {change}", "killed" not in results.get(number, {})))
    if any(wrong):
        raise Failed("\n".join(filter(None, wrong)))
    return found


def table(mutants, results, why):
    rows = collections.defaultdict(lambda: [0, 0, 0, 0])
    for number, result in results.items():
        for room in (f"src/{mutants[number][0].split('/')[2]}", "all"):
            rows[room][0] += 1
            rows[room][1] += "killed" in result or bool(result.get("asked"))
            rows[room][2] += "killed" in result
            rows[room][3] += number in why
    lines = ["| room | mutants | reached by a test | killed | alive | of these explained | killed of those reached | killed of those not explained |", "|---|---|---|---|---|---|---|---|"]
    for room in [*sorted(set(rows) - {"all"}), "all"]:
        count, reached, killed, reasons = rows[room]
        lines.append(f"| {room} | {count} | {reached} | {killed} | {count - killed} | {reasons} | {100 * killed / reached if reached else 100:.1f} % | "
                     f"{100 * killed / (count - reasons) if count > reasons else 100:.1f} % |")
    return "\n".join(lines) + "\n", rows["all"]


def main():
    if set(sys.argv) & {"-h", "--help"}:
        print(__doc__)
        return 0
    parser = argparse.ArgumentParser(usage=argparse.SUPPRESS, add_help=False)
    for name, default in (("--most", 600), ("--seed", 1), ("--jobs", 2)):
        parser.add_argument(name, type=int, default=default)
    parser.add_argument("--slowest", type=float, default=2)
    parser.add_argument("--only", default="")
    for flag in ("--again", "--table", "--write", "--alive"):
        parser.add_argument(flag, action="store_true")
    options = parser.parse_args()
    try:
        if not options.table:
            print(f"seed {options.seed}", flush=True)
            make(options.most, options.seed, options.jobs)
            if options.again:
                copy_sources(rooms=False)
                run(["cmake", "--build", OUT / "build", "-j", options.jobs, "--target", *TESTS])
            test(options.jobs, options.slowest, options.only, options.again)
        mutants, results = recorded()
        why = explained(mutants, results)
    except (Failed, ImportError) as what:
        print(f"mutants_cpp.py: {what}" + ("; install python3-clang and run with /usr/bin/python3" if isinstance(what, ImportError) else ""), file=sys.stderr)
        return 1
    text, (count, reached, killed, reasons) = table(mutants, results, why)
    print(text)
    if options.alive:
        for number, result in results.items():
            if "killed" not in result:
                print(f"{number} {':'.join(map(str, mutants[number][:2]))} {mutants[number][2]}{'' if result['asked'] else ', not reached'}: {why[number]['why'] if number in why else 'not explained'}")
    if options.write:
        datasheet.rewrite(PAGE, "mutants_cpp", text)
    print(f"mutants={count} reached={reached} killed={killed} alive={count - killed} explained={reasons}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
