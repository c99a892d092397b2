#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The unit tests with many seeds: a fixed seed is one test, two fixed seeds are two.
# usage: seeds.sh UNIT_TESTS COUNT [FIRST]   (seeds FIRST..FIRST+COUNT-1, default from 3: the regression has 1 and 2)
# Last line: seeds=COUNT failed=N. Exit code: 0 none failed, 1 otherwise.
set -uo pipefail
tests=$1 count=$2 first=${3:-3} failed=0
for ((seed = first; seed < first + count; ++seed)); do
  if CCHIP_SEED=$seed "$tests" -w NoTests > "/tmp/unit_seed_$$.log" 2>&1; then
    echo "CCHIP_SEED=$seed: $(tail -n 2 "/tmp/unit_seed_$$.log" | head -n 1)"
  else
    failed=$((failed + 1))
    echo "CCHIP_SEED=$seed: FAILED"
    grep -A 12 'FAILED:' "/tmp/unit_seed_$$.log" | head -n 60
  fi
done
rm -f "/tmp/unit_seed_$$.log"
echo "seeds=$count failed=$failed"
[ "$failed" -eq 0 ]
