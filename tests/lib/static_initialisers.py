#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No object of the libraries is made at run time before main(): a query from the constructor of a user's global object
may come first.

usage: static_initialisers.py NM LIBRARY..."""
import re
import subprocess
import sys

# Source files with Boost.Multiprecision, whose initialisers set limits of numbers; nothing of ours reads those. Headers
# of urdfdom include <iostream>, whose initialiser makes the standard streams.
ALLOWED = {"along.cpp", "behind_plane.cpp", "box_division.cpp", "certify.cpp", "common_part.cpp", "cut_polygon.cpp",
           "distance.cpp", "edges.cpp", "grid_oracle.cpp", "intersection.cpp", "meeting.cpp", "oracle.cpp",
           "pair_proof.cpp", "posed_distances.cpp", "shells.cpp", "solid_rays.cpp", "solid_side.cpp", "solids.cpp",
           "urdf.cpp", "verify_receipts.cpp"}

INITIALISER = r"_GLOBAL__sub_I|__static_initialization_and_destruction|__cxx_global_var_init"

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
        elif re.search(INITIALISER, line) and source not in ALLOWED:
            bad.append(f"{library}: {source}: {line.split(maxsplit=2)[-1]}")
if seen < len(libraries):
    sys.exit(f"static_initialisers.py: {seen} object files in {len(libraries)} libraries: is {nm} the right one?")
for line in bad:
    print(line)
print(f"{seen} object files, {len(bad)} initialisers that run before main()")
sys.exit(1 if bad else 0)
