// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_crc32: CRC-32 of IEEE 802.3 (as in zlib) over a sequence of words, first byte lowest.
//   latency      1 clock from a word to the CRC of all words up to it
//   throughput   one word per clock
//   numbers      reflected polynomial EDB88320, starts with all ones, result inverted
//   cuts         every path: crc is inverted flip-flops
//   reset        clear = 1: crc is that of no words, 0; it wins over valid
//   about        The configuration port computes it over every payload.
//   timing       One word per clock. clear = 1 discards the words and has priority over valid.
//                There is no reset: clear once before the first word.
//   numbers      The CRC of no words is 0, that of the text 123456789 is CBF43926.
//   inside       One register of 32 bits; the function next is the bit-serial rule applied DATA_W
//                times, which synthesis turns into one level of parity trees.
//   why          The serial rule is the definition; written as a loop it is the same text for every
//                width, and there is no table to get wrong.
module cchip_crc32 #(
    parameter integer DATA_W = 8  // width of a word (bit); legal: 8, 16, ...
) (
    input  wire              clk,    // clock, rising edge
    input  wire              clear,  // 1: no words yet
    input  wire              valid,  // data is the next word
    input  wire [DATA_W-1:0] data,   // word, first byte lowest
    output wire [      31:0] crc     // CRC-32 of the words since clear
);

  `CCHIP_REFUSE(DATA_W < 8 || DATA_W % 8 != 0, cchip_error_crc32_DATA_W_must_be_a_multiple_of_8)

  reg [31:0] crc_q;
  assign crc = ~crc_q;

  function [31:0] next(input [31:0] from, input [DATA_W-1:0] word);
    integer i;
    begin
      next = from;
      for (i = 0; i < DATA_W; i = i + 1)
        next = {1'b0, next[31:1]} ^ (next[0] ^ word[i] ? 32'hEDB88320 : 32'd0);
    end
  endfunction

  always @(posedge clk)
    if (clear) crc_q <= 32'hFFFFFFFF;
    else if (valid) crc_q <= next(crc_q, data);

endmodule
`default_nettype wire
