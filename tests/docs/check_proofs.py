#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""docs/develop/formal.md lists the modules of tests/formal/*.sby and no other. Prints a note, and passes, if the RTL is
not the one that docs/hardware/fpga.md was measured on.

usage: check_proofs.py ROOT"""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(sys.argv[1])
listed = re.findall(r"^\| \[(\w+)\]", (root / "docs/develop/formal.md").read_text(), re.M)
proved = [path.stem for path in (root / "tests/formal").glob("*.sby")]
for name in sorted(set(proved) ^ set(listed)):
    print(f"docs/develop/formal.md: {name} is "
          f"{'not listed' if name in proved else 'listed, but tests/formal has no proof of it'}")
doubles = len(listed) != len(set(listed))
if doubles:
    print("docs/develop/formal.md: a module is listed twice")

measured = re.search(r"git tree `([0-9a-f]{40})` of `rtl/`", (root / "docs/hardware/fpga.md").read_text())
if not measured:
    sys.exit("docs/hardware/fpga.md does not name the git tree of rtl/ that was measured")
tree = subprocess.run(["git", "-C", str(root), "rev-parse", "HEAD:rtl"], stdout=subprocess.PIPE,
                      stderr=subprocess.DEVNULL, text=True)
if tree.returncode == 0 and tree.stdout.strip() != measured[1]:
    print(f"note: docs/hardware/fpga.md was measured on another rtl/ ({measured[1][:12]}) than that of HEAD; "
          "scripts/run fpga measures again")
print(f"{len(proved)} modules with proofs")
sys.exit(set(proved) != set(listed) or doubles or not proved)
