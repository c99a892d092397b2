#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# million_pairs.sh <cchip> [pairs]: a stream of random pairs through the RTL needs no more memory than a short one.
set -euo pipefail
cchip=$1
pairs=${2:-1000000}
seed=${CCHIP_SEED:-1}
echo "CCHIP_SEED=$seed pairs=$pairs"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

generate() { # <pairs>: corners anywhere in a cube of 2000 units, thousandths: most need rounding
  awk -v n="$1" -v seed="$seed" 'BEGIN {
    srand(seed); names = ""
    for (p = 0; p < 2; p++) for (v = 0; v < 3; v++) for (c = 1; c <= 3; c++)
      names = names (names == "" ? "" : ",") substr("ab", p + 1, 1) v substr("xyz", c, 1)
    print names
    for (i = 0; i < n; i++) {
      row = ""
      for (k = 0; k < 18; k++) row = row (k ? "," : "") int(2000000 * rand() - 1000000) / 1000
      print row
    }
  }'
}

peak() { # <pairs>: peak resident KiB of a run; its summary goes to $folder/summary
  generate "$1" | python3 -c '
import resource, subprocess, sys
run = subprocess.run([sys.argv[1], "pairs", "-", "--engine", "rtl", "--format", "csv"], stdout=subprocess.DEVNULL,
                     stderr=open(sys.argv[2], "w"))
print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)
sys.exit(run.returncode)' "$cchip" "$folder/summary"
}

short=$(peak 20000)
cat "$folder/summary"
long=$(peak "$pairs")
cat "$folder/summary"
echo "peak memory: $short KiB for 20000 pairs, $long KiB for $pairs pairs"
grep -q "^pairs=$pairs " "$folder/summary"
if ((long > short + 16384)); then
  echo "FAILED: memory grows with the number of pairs"
  exit 1
fi
