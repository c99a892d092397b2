// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_onehot_index: number of the bit that is 1 in a one-hot vector.
//   rule         index is i for select[i] = 1, and 0 if select is 0; two bits of select must not be
//                1 at once
//   latency      0 clocks: index follows select
//   cuts         nothing
//   timing       Combinational.
//   numbers      With two bits of select at 1 the output is the OR of both numbers.
//   why          Each bit of the number is the OR of half of the vector: no priority, so no carry
//                chain.
module cchip_onehot_index #(
    parameter integer N = 4,     // bits of the vector; legal: 1..64
    parameter integer WIDTH = 2  // width of the number (bit); legal: 1..30, 2^WIDTH >= N
) (
    input  wire [    N-1:0] select,  // one-hot, or 0
    output wire [WIDTH-1:0] index    // number of its bit; 0 if select is 0
);

  `CCHIP_REFUSE(N < 1 || N > 64 || WIDTH < 1 || WIDTH > 30 || (1 << WIDTH) < N,
                cchip_error_onehot_index_N_must_be_1_to_64_and_fit_in_WIDTH_bit)

  function [WIDTH-1:0] number(input [N-1:0] one);
    integer i;
    begin
      number = {WIDTH{1'b0}};
      for (i = 0; i < N; i = i + 1) number = number | (i[WIDTH-1:0] & {WIDTH{one[i]}});
    end
  endfunction
  assign index = number(select);

endmodule
`default_nettype wire
