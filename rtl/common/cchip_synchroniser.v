// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_synchroniser: bits from another clock through a chain of flip-flops.
//   latency      STAGES clocks from the clock that samples a change; one more where the first
//                flip-flop becomes metastable at that clock
//   throughput   a bit that changes must keep its value for more than a period of clk to be seen
//   bits         each is sampled on its own: of several that change at once, some may be seen a
//                clock earlier. WIDTH above 1 is for codes of which one bit changes at a time
//   cuts         the input comes straight from a flip-flop of the other clock
//   power-up     0 where the device has initial values; others leave within STAGES clocks
//   reset        none
//   devices      ASYNC_REG keeps the chain together in Vivado; scripts/vivado/cdc.xdc and
//                scripts/quartus/cdc.sdc bound the path into it
module cchip_synchroniser #(
    parameter integer WIDTH = 1,  // bits; legal: >= 1
    parameter integer STAGES = 2  // flip-flops of the chain; legal: >= 2
) (
    input  wire             clk,  // clock of q, rising edge
    input  wire [WIDTH-1:0] d,    // from flip-flops of another clock
    output wire [WIDTH-1:0] q     // d of STAGES clocks ago
);

  `CCHIP_REFUSE(WIDTH < 1 || STAGES < 2, cchip_error_synchroniser_WIDTH_below_1_or_STAGES_below_2)

  (* ASYNC_REG = "TRUE" *)
  reg [WIDTH*STAGES-1:0] sync_q;
  initial sync_q = {WIDTH * STAGES{1'b0}};
  always @(posedge clk) sync_q <= {sync_q[WIDTH*(STAGES-1)-1:0], d};
  assign q = sync_q[WIDTH*STAGES-1-:WIDTH];

endmodule
`default_nettype wire
