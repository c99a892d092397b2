#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every fuzz target of a build folder until it has tried RUNS inputs; an input may take 10 s and 2 GB. Printed are a line for
# each target and a last line with the totals. The folder <build>/fuzz keeps the log of each target and the inputs that fail:
# copy one to tests/fuzz/corpus/<target>, where the regression replays it, and repair what it shows. Inputs that reach something
# new are kept in build/fuzz-found, where runs of all builds begin: what the fast one finds, AddressSanitizer sees too.
#
# usage: tests/fuzz/run.sh BUILD RUNS [TARGET...]     CCHIP_SEED repeats a run; the log names the seed. CCHIP_RECORD=1 adds the run to
# docs/figures/fuzz.csv (ledger.py), which sums up all of them
# Exit codes: 0 nothing found, 1 a crash, a leak, an input that takes too long or too much memory, less than RUNS inputs, or stopped by a signal
set -euo pipefail

build=$(realpath "$1")
runs=$2
shift 2
here=$(realpath "$(dirname "$0")")
if (($# == 0)); then
  mapfile -t targets < <(ls "$here/corpus")
else
  targets=("$@")
fi
# libFuzzer's choice by entropy costs a quarter of the time of such short inputs: -entropic=0; its search for shorter inputs of the
# same reach costs a sixth (fuzz_bitstream -runs=200000: 2.6 s, 2.1 s without): -reduce_inputs=0. The corpus is minimised by a merge anyway.
# Freed memory and stacks of allocations cost most of the time; 4 MB and one frame still find what an input does.
export ASAN_OPTIONS=quarantine_size_mb=4:malloc_context_size=1

# The longest input, byte: what one descriptor or a handful of lines take. Longer ones are slower and find no more.
longest() {
  case $1 in
    query) echo 64 ;;
    bitstream) echo 128 ;;
    image) echo 512 ;;
    certificate) echo 4096 ;;
    *) echo 352 ;;
  esac
}

count() { grep -c -E "^SUMMARY: $1" "$2" || true; }

found=$(dirname "$build")/fuzz-found
mkdir -p "$build/fuzz"
lines=$build/fuzz/lines
: > "$lines"
cd "$build/fuzz"
total=0 failed=0 start=$SECONDS
declare -A sum=([crashes]=0 [hangs]=0 [leaks]=0)
for target in "${targets[@]}"; do
  mkdir -p "$found/$target"
  log=$target.log
  options=(-runs="$runs" -seed="${CCHIP_SEED:-0}" -max_len="$(longest "$target")" -timeout=10 -rss_limit_mb=2048
    -artifact_prefix="$target-" -print_final_stats=1 -entropic=0 -reduce_inputs=0)
  [[ -f $here/words/$target ]] && options+=(-dict="$here/words/$target")
  from=$SECONDS code=0
  "$build/bin/fuzz_$target" "${options[@]}" "$found/$target" "$here/corpus/$target" > "$log" 2>&1 || code=$?
  done=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  : "${done:=0}"
  hangs=$(count 'libFuzzer: timeout' "$log")
  leaks=$(count 'AddressSanitizer: .* leaked' "$log")
  crashes=0
  if grep -q 'libFuzzer: run interrupted' "$log" || ((code == 130 || code == 143)); then
    echo "target=$target was stopped by a signal: nothing of this run counts" >&2
    exit 1
  fi
  if ((code != 0 && hangs + leaks == 0)); then crashes=1; fi
  echo "target=$target build=$(basename "$build") runs=$done crashes=$crashes hangs=$hangs leaks=$leaks seconds=$((SECONDS - from))" | tee -a "$lines"
  if ((code != 0 || done < runs)); then
    failed=1
    grep -E -A 20 'ERROR|runtime error|not so|SUMMARY' "$log" | cut -c 1-300 | head -n 40 || tail -n 5 "$log"
    echo "$build/fuzz/$log has more; the input is one of $build/fuzz/$target-*" >&2
  fi
  total=$((total + done))
  sum[crashes]=$((sum[crashes] + crashes)) sum[hangs]=$((sum[hangs] + hangs)) sum[leaks]=$((sum[leaks] + leaks))
done
echo "targets=${#targets[@]} runs=$total crashes=${sum[crashes]} hangs=${sum[hangs]} leaks=${sum[leaks]} seconds=$((SECONDS - start))"
if [[ ${CCHIP_RECORD:-0} != 0 ]]; then "$here/ledger.py" --add "$lines"; fi
exit $failed
