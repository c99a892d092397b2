#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs every fuzz target of a build folder until it has tried RUNS inputs; an input may take 10 s and 2 GB. What a target finds stays
# in the folder <build>/fuzz: copy it to tests/fuzz/corpus/<target> and repair what it shows.
#
# usage: tests/fuzz/run.sh BUILD RUNS [TARGET...]     CCHIP_SEED repeats a run
# Exit codes: 0 nothing found, 1 a crash, a leak, or an input that takes too long or too much memory
set -euo pipefail

build=$(realpath "$1")
runs=$2
shift 2
corpus=$(realpath "$(dirname "$0")/corpus")
if (($# == 0)); then
  mapfile -t targets < <(ls "$corpus")
else
  targets=("$@")
fi
for target in "${targets[@]}"; do
  mkdir -p "$build/fuzz/$target"
  echo "== $target"
  (cd "$build/fuzz" && "$build/bin/fuzz_$target" -runs="$runs" -seed="${CCHIP_SEED:-0}" -timeout=10 -rss_limit_mb=2048 -max_len=4096 \
    -artifact_prefix="$target-" -print_final_stats=1 "$target" "$corpus/$target")
done
echo "targets=${#targets[@]} runs=$runs: nothing found"
