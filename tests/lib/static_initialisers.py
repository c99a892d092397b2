#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No object of the libraries is made at run time before main(): a query from the constructor of a user's global object
may come first.

usage: static_initialisers.py NM LIBRARY..."""
import re
import subprocess
import sys

# Source file: what makes its initialiser, and why that does no harm.
ALLOWED = {
    "oracle.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "meeting.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "distance.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "behind_plane.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "along.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "solid_side.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "edges.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "shells.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "solids.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "common_part.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "intersection.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "posed_distances.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "cut_polygon.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "certify.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
    "pair_proof.cpp": "Boost.Multiprecision's limits of numbers; nothing of ours reads them",
}

nm, *libraries = sys.argv[1:]
bad = []
seen = 0
for library in libraries:
    text = subprocess.run([nm, "-C", library], check=True, stdout=subprocess.PIPE, text=True).stdout
    for line in text.splitlines():
        member = re.match(r"(\S+\.cpp)\.o:$", line)
        if member:
            source = member.group(1)
            seen += 1
        elif re.search(r"_GLOBAL__sub_I|__static_initialization_and_destruction|__cxx_global_var_init", line):
            if source not in ALLOWED:
                bad.append(f"{library}: {source}: {line.split(maxsplit=2)[-1]}")
if seen < len(libraries):
    sys.exit(f"static_initialisers.py: {seen} object files in {len(libraries)} libraries: is {nm} the right one?")
for line in bad:
    print(line)
print(f"{seen} object files, {len(bad)} initialisers that run before main()")
sys.exit(1 if bad else 0)
