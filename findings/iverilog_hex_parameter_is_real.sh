#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Icarus Verilog 11.0 (Debian 12): a hexadecimal number after -P, `-Ptop.N=0x10`, makes a real of an untyped parameter.
#
# The text is read as a floating-point number, of which C's notation 0x10 is one. `parameter N = 3` becomes
# 16.0 and prints as 16, but N / 32 * 32 is 16 and not 0, and $bits(N) is 1. If N is shifted or counts a replication, the
# message complains of a REAL in a file that has none. A parameter with a type (`parameter integer`) is converted and right.
# Decimal and 'h10 are integers; 010 is ten; 4294967296 is 34 bits wide. Verilator 5.006 and its -GN=0x10 take an integer.
# Seen: "16: N / 32 * 32 = 16, 1 bits" for 0x10, "= 0, 32 bits" for 16; "<<(<) operator may not have REAL operands" for 1 << N.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
grep -q '^Icarus Verilog version 11\.0 ' <<< "$(iverilog -V 2> /dev/null)"
grep -q '^Verilator 5\.006 ' <<< "$(verilator --version)"
cat > top.v << 'END'
module top;
    parameter N = 3;
    parameter integer I = 3;
    initial begin
        $display("%0d: N / 32 * 32 = %0d, %0d bits", N, N / 32 * 32, $bits(N));
        $display("%0d: I / 32 * 32 = %0d, %0d bits", I, I / 32 * 32, $bits(I));
        $finish;
    end
endmodule
END
cat > shift.v << 'END'
module top; parameter N = 3; initial $display("%0d", 1 << N); endmodule
END
for number in 16 "'h10" 0x10 010 4294967296; do
    echo "N=$number"
    iverilog -g2012 "-Ptop.N=$number" -o top.vvp top.v
    vvp -n top.vvp | sed -n 1p
done > seen
echo I=0x10 >> seen
iverilog -g2012 -Ptop.I=0x10 -o top.vvp top.v
vvp -n top.vvp | sed -n 2p >> seen
if iverilog -g2012 -Ptop.N=0x10 -o shift.vvp shift.v > messages 2>&1; then exit 1; fi
grep -o 'operator may not have REAL operands' messages >> seen
nice -n 5 verilator --binary -Wno-WIDTH --top-module top -GN=0x10 top.v > build.log 2>&1
obj_dir/Vtop | sed -n 1p >> seen
cat seen
diff seen - << 'END'
N=16
16: N / 32 * 32 = 0, 32 bits
N='h10
16: N / 32 * 32 = 0, 32 bits
N=0x10
16: N / 32 * 32 = 16, 1 bits
N=010
10: N / 32 * 32 = 0, 32 bits
N=4294967296
4294967296: N / 32 * 32 = 4294967296, 34 bits
I=0x10
16: I / 32 * 32 = 0, 32 bits
operator may not have REAL operands
16: N / 32 * 32 = 0, 32 bits
END
