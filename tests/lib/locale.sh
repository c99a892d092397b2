#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# locale.sh <test_ref> <folder>: the test of numbers once more where de_DE exists, which has a decimal comma. Exit code 77:
# it cannot be made here.
set -euo pipefail
mkdir -p "$2"
localedef -i de_DE -f UTF-8 "$2/de_DE.UTF-8" || exit 77
LOCPATH=$2 "$1" "mesh file: numbers are read and written the same in every locale"
