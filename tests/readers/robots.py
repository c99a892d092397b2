#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""`cchip clash` on each robot of example-robot-data (PyPI), with its SRDF if one has its name.

usage: robots.py CCHIP FOLDER        FOLDER: with robots/*/*/*.urdf somewhere below it

A robot is judged (exit code 0, 1 or 4) or refused in one line with exit code 2. Prints why robots are refused and, at
last, robots=N judged=N refused=N violations=N. Exit code 1: another exit code, more than one line, or fewer judged than
LEAST."""
import collections
import pathlib
import re
import subprocess
import sys

LEAST = 46


def main(program, folder):
    robots = sorted(pathlib.Path(folder).resolve().glob("**/robots/*/*/*.urdf"))
    share = robots[0].parents[4] if robots else None
    counts, reasons, wrong = collections.Counter(), collections.Counter(), []
    for robot in robots:
        options = ["--packages", share]
        srdf = robot.parents[1] / "srdf" / f"{robot.stem}.srdf"
        if srdf.exists():
            options += ["--srdf", srdf]
        run = subprocess.run([program, "clash", robot, *options], capture_output=True, text=True, timeout=300)
        errors = run.stderr.splitlines()
        if run.returncode == 2 and len(errors) == 1:
            counts["refused"] += 1
            reasons[re.sub(r"'[^']*'", "'...'", errors[0].split(".urdf: ")[-1])[-100:]] += 1
        elif run.returncode in (0, 1, 4) and run.stdout.splitlines()[-1].startswith("parts="):
            counts["judged"] += 1
            counts["violations"] += int(re.search(r"violations=(\d+)", run.stdout)[1])
        else:
            wrong.append(f"{robot.name}: exit code {run.returncode}: {errors[-1:]}")
    for reason, count in reasons.most_common():
        print(f"{count:3} {reason}")
    print("\n".join(wrong + [f"robots={len(robots)} judged={counts['judged']} refused={counts['refused']} "
                             f"violations={counts['violations']}"]))
    return int(bool(wrong) or counts["judged"] < LEAST)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
