#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs the bench with Icarus and its twin with Verilator on the same vectors; both must write the same lines.
#   run.sh KIND PAIRS VECTORS_PROGRAM TWIN BENCH FOLDER     CCHIP_SEED chooses the vectors
# At least half of the pairs must be answered: resets drop the others.
set -eu
kind=$1
pairs=$2
vectors=$3
twin=$4
bench=$5
folder=$6
seed=${CCHIP_SEED:-1}
start=$((seed % 1000003 + 1)) # of the generator of stalls and resets
echo "CCHIP_SEED=$seed"

mkdir -p "$folder"
"$vectors" "$kind" "$folder/vectors.hex" "$pairs" "$seed"
"$twin" "$folder/vectors.hex" $start "$folder/verilator.txt"
vvp -n "$bench" +vectors="$folder/vectors.hex" +pairs="$pairs" +start=$start +lines="$folder/icarus.txt" \
  > "$folder/icarus.log" || { cat "$folder/icarus.log"; exit 1; }
cat "$folder/icarus.log"
grep -q "^PASS pairs=$pairs " "$folder/icarus.log"

if ! diff "$folder/icarus.txt" "$folder/verilator.txt" > "$folder/difference.txt"; then
  echo "Icarus (<) and Verilator (>) differ, first lines:" >&2
  head -20 "$folder/difference.txt" >&2
  exit 1
fi
results=$(grep -c '^out ' "$folder/icarus.txt")
[ "$results" -ge $((pairs / 2)) ] || { echo "only $results results of $pairs pairs" >&2; exit 1; }
echo "Icarus and Verilator agree in $results results and $(wc -l < "$folder/icarus.txt") lines"
