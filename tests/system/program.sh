#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# program.sh <cchip>: what only the program from outside shows: exit codes, pipes, streams, a full disk.
set -uo pipefail
cchip=$1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
failures=0

expect() { # expect <what> <wanted> <got>
  if [[ "$2" != "$3" ]]; then
    printf 'FAILED %s: wanted "%s", got "%s"\n' "$1" "$2" "$3"
    failures=$((failures + 1))
  fi
}

cat > "$folder/pairs.csv" << 'CSV'
a0x,a0y,a0z,a1x,a1y,a1z,a2x,a2y,a2z,b0x,b0y,b0z,b1x,b1y,b1z,b2x,b2y,b2z,touches
0,0,0,4,0,0,0,4,0,1,1,-1,1,1,1,2,2,1,1
0,0,0,4,0,0,0,4,0,0,0,1,4,0,1,0,4,2,0
CSV

"$cchip" pairs "$folder/pairs.csv" --expect touches > "$folder/out" 2> "$folder/err"
expect "exit code of a good run" 0 $?
expect "stderr of a good run" "" "$(cat "$folder/err")"
expect "summary" "pairs=2 hits=1 mismatches=0" "$(tail -n 1 "$folder/out" | cut -d ' ' -f 1-3)"

sed 's/0$/1/' "$folder/pairs.csv" | "$cchip" pairs - --expect touches > "$folder/out"
expect "exit code of a mismatch" 3 $?

"$cchip" pairs "$folder/none.csv" > "$folder/out" 2> "$folder/err"
expect "exit code of a missing file" 2 $?
expect "lines on stderr" 1 "$(wc -l < "$folder/err")"
expect "bytes on stdout" 0 "$(wc -c < "$folder/out")"

"$cchip" pairs "$folder/pairs.csv" --engine exact > /dev/full 2> "$folder/err"
expect "exit code of a full disk" 1 $?
expect "message of a full disk" "cchip: cannot write standard output: No space left on device; check the disk space and the program that reads the pipe" "$(cat "$folder/err")"

"$cchip" pairs "$folder/pairs.csv" --trace "$folder/run.fst" > "$folder/out" 2> "$folder/err"
expect "exit code with a waveform" 0 $?
expect "waveform and layout" "run.fst run.gtkw run.gtkw.axis run.gtkw.mode run.gtkw.programme" "$(cd "$folder" && echo run.*)"

# Enough pairs for a progress bar, which a pipe must not see.
awk 'NR == 1 { print } NR == 2 { for (i = 0; i < 20000; i++) print }' "$folder/pairs.csv" > "$folder/many.csv"
"$cchip" pairs "$folder/many.csv" --engine exact --format csv 2> "$folder/err" > "$folder/out"
expect "stderr without a terminal" "pairs=20000 hits=20000 mismatches=0" "$(cut -d ' ' -f 1-3 "$folder/err")"
expect "rows" 20001 "$(wc -l < "$folder/out")"

if ((failures > 0)); then exit 1; fi
echo "cchip from outside: all as expected"
