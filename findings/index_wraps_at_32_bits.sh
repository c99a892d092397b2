#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Icarus Verilog 11.0 (Debian 12): the index of a bit or word is cut to 32 bits: v[4294967298] is v[2], not x.
#
# By the standard a read beside the range gives x, and a write there does nothing. Icarus keeps to that for the indices 8 and
# 4294967295, but from 2 to the 32 on it starts anew at 0, without a warning, also for words of memories and for writes: w[index]
# = 1 sets bit 2. Shifts are right: v >> 4294967298 is 0, so `(v >> index) & 1` and `v[index]` differ. Yosys 0.23 gives x for the
# bit. A bench that counts on the x to notice a
# wide index out of range, an address of 40 bits for instance, sees a good value instead.
# Seen: "4294967298: bit 1 shift 0 word 12" and "written 00000100" of Icarus; bitv = 1'x of Yosys.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT && cd "$folder"
grep -q '^Icarus Verilog version 11\.0 ' <<< "$(iverilog -V 2> /dev/null)"
grep -q '^Yosys 0\.23 ' <<< "$(yosys -V)"
cat > look.v << 'END'
module look (
    input [39:0] index,
    output bitv, shift, output [7:0] word
);
    wire [7:0] v = 8'b10100100;
    reg [7:0] memory[0:7];
    integer i;
    initial for (i = 0; i < 8; i = i + 1) memory[i] = 10 + i;
    assign bitv = v[index];
    assign shift = v >> index;
    assign word = memory[index];
endmodule
END
cat > bench.v << 'END'
module bench;
    reg [39:0] index;
    reg [7:0] w = 0;
    wire bitv, shift;
    wire [7:0] word;
    look look (index, bitv, shift, word);
    initial begin
        $monitor("%0d: bit %b shift %b word %0d", index, bitv, shift, word);
        index = 2;
        #1 index = 8;
        #1 index = 40'd4294967295;
        #1 index = 40'd4294967298;
        w[index] = 1;
        #1 $display("written %b", w);
    end
endmodule
END
iverilog -g2012 -o look.vvp look.v bench.v
vvp -n look.vvp > seen
yosys -p "read_verilog look.v; hierarchy -top look; proc; memory; opt; eval -set index 40'd4294967298 -show bitv" \
    | sed -n 's/^Eval result: /yosys /p' >> seen
cat seen
diff seen - << 'END'
2: bit 1 shift 1 word 12
8: bit x shift 0 word x
4294967295: bit x shift 0 word x
4294967298: bit 1 shift 0 word 12
written 00000100
yosys \bitv = 1'x.
END
