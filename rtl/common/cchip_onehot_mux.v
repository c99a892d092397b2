// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_onehot_mux: the word of the source that a one-hot vector selects, as an AND-OR tree.
//   rule         m_data is the word i with select[i] = 1, and 0 if select is 0; two bits of select
//                must not be 1 at once
//   latency      0 clocks: m_data follows select and s_data
//   cuts         nothing
//   about        The word of the source that a one-hot vector selects, as an AND-OR tree: behind
//                every cchip_arbiter whose grant chooses data.
//   timing       Combinational.
//   numbers      With two bits of select at 1 the output is the OR of both words: the module does
//                not check it, because the vectors come from modules that assert it
//                (cchip_arbiter).
//   why          A multiplexer with a number as its select input first decodes the number. The
//                select inputs of this project come from arbiters and registers that are one-hot
//                already, so two levels of gates per bit are enough.
module cchip_onehot_mux #(
    parameter integer N = 4,     // sources; legal: 1..32
    parameter integer WIDTH = 8  // width of a word (bit); legal: >= 1
) (
    input  wire [      N-1:0] select,  // one-hot: bit i selects word i; 0 selects none
    input  wire [N*WIDTH-1:0] s_data,  // word i in bits [WIDTH*i +: WIDTH]
    output wire [  WIDTH-1:0] m_data   // the selected word; 0 if none is
);

  `CCHIP_REFUSE(N < 1 || N > 32 || WIDTH < 1,
                cchip_error_onehot_mux_N_must_be_1_to_32_and_WIDTH_at_least_1)

  function [WIDTH-1:0] choose(input [N*WIDTH-1:0] words, input [N-1:0] one);
    integer i;
    begin
      choose = {WIDTH{1'b0}};
      for (i = 0; i < N; i = i + 1) choose = choose | (words[WIDTH*i+:WIDTH] & {WIDTH{one[i]}});
    end
  endfunction
  assign m_data = choose(s_data, select);

endmodule
`default_nettype wire
