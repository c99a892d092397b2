#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the bench with Icarus and its twin with Verilator on the same vectors; both must write the same lines.
#   run.sh TWIN BENCH FOLDER     CCHIP_SEED chooses the vectors
set -eu
twin=$1
bench=$2
folder=$3
seed=${CCHIP_SEED:-1}
pairs=3000
wanted=2000
start=$((seed % 1000003 + 1)) # of the generator of stalls and resets
echo "CCHIP_SEED=$seed"

mkdir -p "$folder"
"$twin" vectors "$folder/vectors.hex" $pairs "$seed"
"$twin" run "$folder/vectors.hex" $start "$folder/verilator.txt"
vvp -n "$bench" +vectors="$folder/vectors.hex" +pairs=$pairs +start=$start +lines="$folder/icarus.txt" \
  > "$folder/icarus.log"
cat "$folder/icarus.log"
grep -q "^PASS pairs=$pairs " "$folder/icarus.log"

if ! diff "$folder/icarus.txt" "$folder/verilator.txt" > "$folder/difference.txt"; then
  echo "Icarus (<) and Verilator (>) differ, first lines:" >&2
  head -20 "$folder/difference.txt" >&2
  exit 1
fi
results=$(grep -c '^out ' "$folder/icarus.txt")
[ "$results" -ge $wanted ] || { echo "only $results results, $wanted wanted" >&2; exit 1; }
echo "Icarus and Verilator agree in $results results and $(wc -l < "$folder/icarus.txt") lines"
