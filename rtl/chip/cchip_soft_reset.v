// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_soft_reset: resets a core while its bus masters work on, until nothing is outstanding.
//   resetting    the reset of the core: 1 from a request until `outstanding` has been 0 for CLOCKS
//                clocks in a row, so at least CLOCKS clocks. A request meanwhile starts it anew
//   silence      if memory never answers, resetting stays 1: only rst, with a reset of the bus,
//                ends that
//   latency      1 clock from request to resetting; done is 1 on the first clock after it
//   reset        ends a soft reset, without done
//   rules        The bus masters must not be reset: reads that they hold in their queues go to
//                memory, and their answers reach clients that are in reset and drop them. If memory
//                never answers, resetting stays 1: the module has no time-out, since a core that is
//                let go could take a late answer for its own.
//   inside       One flip-flop and a counter of quiet clocks.
//   test         tests/unit/test_cchip_soft_reset.cpp: a model on every clock, for several CLOCKS.
//                Assertion in the RTL: a_done.
module cchip_soft_reset #(
    // quiet clocks before the reset ends; more than a request needs from its queue to the bus;
    // legal: 2..256
    parameter integer CLOCKS = 16
) (
    input  wire clk,          // clock, rising edge
    input  wire rst,          // synchronous reset, active high
    input  wire request,      // 1 for a clock: reset the core
    input  wire outstanding,  // a response is outstanding
    output wire resetting,    // reset of the core
    output wire done          // the reset has ended; 1 for a clock
);

  localparam integer COUNT_W = $clog2(CLOCKS);
  localparam [31:0] LAST = CLOCKS - 1;

  `CCHIP_REFUSE(CLOCKS < 2 || CLOCKS > 256, cchip_error_soft_reset_CLOCKS_must_be_2_to_256)

  reg resetting_q, done_q;
  reg [COUNT_W-1:0] quiet_q;  // clocks in a row with no pending response of memory
  wire ends = resetting_q && !outstanding && quiet_q == LAST[COUNT_W-1:0];
  always @(posedge clk) begin
    quiet_q <= request || outstanding ? {COUNT_W{1'b0}} : quiet_q + {{COUNT_W - 1{1'b0}}, 1'b1};
    if (rst) begin
      resetting_q <= 1'b0;
      done_q      <= 1'b0;
    end else begin
      resetting_q <= request | (resetting_q & ~ends);
      done_q      <= ends & ~request;
    end
  end
  assign resetting = resetting_q;
  assign done      = done_q;

  reg was_q;  // resetting on the clock before
  always @(posedge clk) begin
    was_q <= resetting_q & ~rst;
    if (!rst) begin
      `CCHIP_ASSERT(a_done, !done_q || (was_q && !resetting_q))
    end
  end

endmodule
`default_nettype wire
