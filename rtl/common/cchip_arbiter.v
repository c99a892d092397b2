// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_arbiter: one of several requests, in turn (round robin).
//   rule         the search begins behind the source that was served last, after reset at source 0;
//                grant is one-hot, or 0 without a request
//   fair         a request that stays lets at most N - 1 others be served before it
//   latency      0 clocks: grant follows request
//   cuts         nothing
//   reset        the search begins at source 0
//   about        Every choice between equals in this project is one of these.
//   timing       A request may be taken back.
//   why          A mask of the sources behind the last one, a search below the mask and one without
//                it, side by side. The depth grows with the logarithm of N; that of a token that
//                runs from source to source grows with N.
module cchip_arbiter #(
    parameter integer N = 4  // sources; legal: 1..32
) (
    input  wire         clk,      // clock, rising edge
    input  wire         rst,      // synchronous reset, active high
    input  wire [N-1:0] request,  // bit i: source i asks
    output wire [N-1:0] grant,    // one-hot: the source whose turn it is; 0 without a request
    input  wire         take      // the source of grant, if any, is served on this clock
);

  `CCHIP_REFUSE(N < 1 || N > 32, cchip_error_arbiter_N_must_be_1_to_32)

  reg [N-1:0] behind_q;  // sources behind the one served last

  function [N-1:0] lowest(input [N-1:0] of);
    integer i;
    reg found;
    begin
      lowest = {N{1'b0}};
      found = 1'b0;
      for (i = 0; i < N; i = i + 1) begin
        lowest[i] = of[i] & ~found;
        found = found | of[i];
      end
    end
  endfunction
  // sources behind the lowest one: found without waiting for the grant
  function [N-1:0] above(input [N-1:0] of);
    integer i;
    reg found;
    begin
      above = {N{1'b0}};
      found = 1'b0;
      for (i = 0; i < N; i = i + 1) begin
        above[i] = found;
        found = found | of[i];
      end
    end
  endfunction

  wire [N-1:0] next = request & behind_q;
  assign grant = |next ? lowest(next) : lowest(request);

  always @(posedge clk)
    if (rst) behind_q <= {N{1'b0}};
    else if (take && |request) behind_q <= |next ? above(next) : above(request);

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one, (grant & (grant - {{N - 1{1'b0}}, 1'b1})) == {N{1'b0}})
      `CCHIP_ASSERT(a_some, (grant == {N{1'b0}}) == (request == {N{1'b0}}))
      `CCHIP_ASSERT(a_asked, (grant & ~request) == {N{1'b0}})
    end

endmodule
`default_nettype wire
