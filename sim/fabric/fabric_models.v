// SPDX-License-Identifier: Apache-2.0
`timescale 1ns / 1ps
// Cells of the fabric for the simulation, lighter than the generated ones, with two properties that
// these lack:
//   delay        of a LUT: 4 ns, or LUT_DELAY of fabric.py while frames are written; of a
//                multiplexer of the wiring:
//                1 ns. Half-written logic forms rings: one without delay never lets time pass, and
//                one that oscillates
//                often in a clock takes hours. The neighbour's path of two LUTs must fit in a
//                clock. No timing of silicon
//   settled      once the configuration is whole a flip-flop takes 0 or 1 at random where it would
//                store X. Silicon has
//                no X; while frames are written X is kept, because it is what gets counted
module fabric_state;
  reg settled = 1'b0;
  wire [15:0] delay = settled ? 16'd4 : `LUT_DELAY;
endmodule

module LUT4c_frame_config_dffesr #(
    parameter integer NoConfigBits = 19
) (
    input  wire [             3:0] I,
    output wire                    O,
    input  wire                    Ci,
    output wire                    Co,
    input  wire                    SR,
    input  wire                    EN,
    input  wire                    UserCLK,
    input  wire [NoConfigBits-1:0] ConfigBits
);
  wire i0 = ConfigBits[17] ? Ci : I[0];
  wire [7:0] by_i0 = {
    i0 ? ConfigBits[15] : ConfigBits[14], i0 ? ConfigBits[13] : ConfigBits[12],
    i0 ? ConfigBits[11] : ConfigBits[10], i0 ? ConfigBits[9] : ConfigBits[8],
    i0 ? ConfigBits[7] : ConfigBits[6], i0 ? ConfigBits[5] : ConfigBits[4],
    i0 ? ConfigBits[3] : ConfigBits[2], i0 ? ConfigBits[1] : ConfigBits[0]};
  wire lut;
  assign #(fabric_state.delay) lut = I[3]
      ? (I[2] ? (I[1] ? by_i0[7] : by_i0[6]) : (I[1] ? by_i0[5] : by_i0[4]))
      : (I[2] ? (I[1] ? by_i0[3] : by_i0[2]) : (I[1] ? by_i0[1] : by_i0[0]));
  reg flop;
  wire next = EN ? (SR ? ConfigBits[18] : lut) : flop;
  always @(posedge UserCLK) flop <= next === 1'bx && fabric_state.settled ? $random : next;
  assign O  = ConfigBits[16] ? flop : lut;
  assign Co = (Ci & I[1]) | (Ci & I[2]) | (I[1] & I[2]);
endmodule

module my_buf (input wire A, output wire X); assign X = A; endmodule
module clk_buf (input wire A, output wire X); assign X = A; endmodule
module cus_mux21 (input wire A0, A1, S, output wire X); assign X = S ? A1 : A0; endmodule
