#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What there is to inherit: lines of each room and words of the pages, of the working tree or of a commit. Words by
hand are those outside pages and blocks that a script writes.

usage: weight.py [COMMIT]   (a second column with the change since COMMIT)"""
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
CODE = re.compile(
    r"\.(cpp|hpp|v|vh|py|sh|cmake|c|h|mk|in|html|tcl|rdl|json)$|(^|/)(CMakeLists\.txt|Makefile|lint|bootstrap|run)$")
# Room: the files that belong to it, the first that fits; generated files are none of it.
GENERATED = re.compile(
    r"internal/wire/(definitions|registers|chip_registers)\.hpp$|^rtl/include/.*\.vh$|^rtl/regs/|^docs/figures/")
ROOMS = [("rtl", r"^rtl/"), ("command", r"^(lib/app|lib/program|sim/app)/"),
         ("python", r"^(lib/)?python/(src|collisionchip)/|^(lib/)?python/[^/]*$"),
         ("tests", r"^(tests|(lib/)?python/tests)/"), ("examples", r"^(examples|(lib/)?python/examples)/"),
         ("library",
          r"^(lib/|cpp_ref/(include/cchip|src)/(cpu|collide|mesh|mesh_io|certificate|geometry|device|exact|bvh)/|"
          r"cpp_ref/include/cchip/internal/(exact|bvh|collide|geometry|certificate)/)"),
         ("models and host", r"^cpp_ref/"),
         ("simulation", r"^sim/"), ("bench", r"^bench/"),
         ("scripts", r"^(scripts|workflow|cmake|\.ci)/|^(Makefile|CMakeLists\.txt)$")]
# Pages that a script writes whole, and blocks in others.
WRITTEN = re.compile(r"^docs/(hardware/(definitions|registers|chip-registers)|develop/widths)\.md$")
BLOCK = re.compile(rb"<!-- generated: begin .*?<!-- generated: end -->", re.S)
PRODUCT = ("rtl", "library", "models and host", "command", "python")


def contents(commit):
    """Name and text of each file that git has."""
    if commit is None:
        names = subprocess.run(["git", "ls-files"], cwd=ROOT, check=True, capture_output=True,
                               text=True).stdout.split("\n")
        for name in filter(None, names):
            path = ROOT / name
            if path.is_file() and not path.is_symlink():
                yield name, path.read_bytes()
        return
    names = subprocess.run(["git", "ls-tree", "-r", "--name-only", commit], cwd=ROOT, check=True, capture_output=True,
                           text=True).stdout.split("\n")
    with subprocess.Popen(["git", "cat-file", "--batch"], cwd=ROOT, stdin=subprocess.PIPE,
                          stdout=subprocess.PIPE) as git:
        for name in filter(None, names):
            git.stdin.write(f"{commit}:{name}\n".encode())
            git.stdin.flush()
            size = int(git.stdout.readline().split()[2])
            yield name, git.stdout.read(size)
            git.stdout.read(1)
        git.stdin.close()


def weigh(commit):
    """Lines of each room, words of pages."""
    result = {room: 0 for room, _ in ROOMS}
    result["docs words"] = result["docs words by hand"] = 0
    for name, data in contents(commit):
        if name.startswith("docs/") and name.endswith(".md"):
            result["docs words"] += len(data.split())
            if not WRITTEN.search(name):
                result["docs words by hand"] += len(BLOCK.sub(b"", data).split())
        if GENERATED.search(name) or not CODE.search(name):
            continue
        room = next((room for room, pattern in ROOMS if re.search(pattern, name)), None)
        if room:
            result[room] += data.count(b"\n")
    product = sum(result[room] for room in PRODUCT)
    result["product lines"] = product
    result["words a product line"] = result["docs words"] / product
    return result


def main():
    """Prints the table."""
    now = weigh(None)
    before = weigh(sys.argv[1]) if len(sys.argv) > 1 else None
    for key, value in now.items():
        text = f"{value:10.2f}" if isinstance(value, float) else f"{value:10d}"
        print(f"{key:22s}{text}" + (f"  {value - before[key]:+10.0f}" if before and not isinstance(value, float) else
                                    f"  {value - before[key]:+10.2f}" if before else ""))


if __name__ == "__main__":
    main()
