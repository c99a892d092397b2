#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Time and peak memory of `cchip clash` over many parts, from the files to the report.

usage: clash_scale.py CCHIP [PARTS ...]        default 1000 10000; CCHIP_SEED repeats a run

Parts are tori of 384 triangles in random poses, as many to a volume whatever PARTS is: once with a mesh file for each,
once with one file that is placed everywhere. Prints seconds, peak resident memory, and the bytes a further part adds.
Exit code 1: a run failed, or a part more adds above 1.3 times the memory that it has on average: not linear."""
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

AROUND, ACROSS = 16, 12


def torus():
    lines = []
    for i in range(AROUND):
        for j in range(ACROSS):
            u, v = 2 * math.pi * i / AROUND, 2 * math.pi * j / ACROSS
            radius = 1 + 0.3 * math.cos(v)
            lines.append(f"v {radius * math.cos(u)!r} {radius * math.sin(u)!r} {0.3 * math.sin(v)!r}")
    for i in range(AROUND):
        for j in range(ACROSS):
            a, b, c, d = (p % AROUND * ACROSS + q % ACROSS + 1 for p, q in ((i, j), (i + 1, j), (i + 1, j + 1),
                                                                            (i, j + 1)))
            lines += [f"f {a} {b} {c}", f"f {a} {c} {d}"]
    return "\n".join(lines) + "\n"


def write(folder, parts, own):
    draw = random.Random(int(os.environ.get("CCHIP_SEED") or 1))
    reach = 1.6 * parts ** (1 / 3)
    lines = ['unit = "mm"']
    for i in range(parts):
        file = f"{i if own else 0}.obj"
        if own or i == 0:
            (folder / file).write_text(torus())
        lines += ["[[part]]", f'name = "p{i}"', f'file = "{file}"',
                  f"xyz = {[draw.uniform(-reach, reach) for _ in range(3)]}",
                  f"quaternion = {[draw.gauss(0, 1) for _ in range(4)]}"]
    (folder / "assembly.toml").write_text("\n".join(lines) + "\n")


def run(cchip, folder):
    """Seconds, peak bytes and the last line."""
    with open(folder / "report", "w+") as report:
        at = os.times().elapsed
        process = subprocess.Popen([cchip, "clash", folder / "assembly.toml"], stdout=report)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        seconds = os.times().elapsed - at
        report.seek(0)
        last = report.read().splitlines()[-1:]
    if process.returncode not in (0, 1) or not last or not last[0].startswith("parts="):
        raise RuntimeError(f"exit code {process.returncode}")
    return seconds, usage.ru_maxrss * 1024, last[0]


def main(cchip, counts):
    linear = True
    print(f"load={os.getloadavg()[0]:.1f}\n{'mesh files':12}{'parts':>8}{'pairs':>8}{'s':>8}{'MB':>8}{'B/part':>9}")
    for own in (True, False):
        before = None
        for parts in counts:
            with tempfile.TemporaryDirectory() as name:
                write(pathlib.Path(name), parts, own)
                seconds, peak, last = run(cchip, pathlib.Path(name))
            pairs = re.search(r"pairs=(\d+)", last)[1]
            more = (peak - before[1]) / (parts - before[0]) if before else None
            linear = linear and (more is None or more < 1.3 * before[1] / before[0])
            before = parts, peak
            print(f"{'one each' if own else 'one':12}{parts:8}{pairs:>8}{seconds:8.2f}{peak / 1e6:8.1f}"
                  + (f"{more:9.0f}" if more else ""), flush=True)
    print(f"clash_scale linear={'yes' if linear else 'no'}")
    return int(not linear)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], [int(x) for x in sys.argv[2:]] or [1000, 10000]))
