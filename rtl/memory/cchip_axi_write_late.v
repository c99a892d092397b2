// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_axi_write_late: tells that the first write that a client waits for has lasted too long. A
// tick comes every limit + 1 clocks; a write that was in flight at two ticks is late. Writes leave
// in order, so two counts are enough: how many of those in flight saw the last tick, and how many
// the last two.
//   latency      a write is late after more than limit, and at most 2 limit + 2, clocks; timeout
//                is 1 on each clock on which one is late and none is answered
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any clock
//                (cchip_timeout)
//   cuts         all but answered to timeout
//   reset        no write is late
module cchip_axi_write_late #(
    parameter integer COUNT_W = 5  // width of the count of writes (bit); legal: >= 1
) (
    input  wire               clk,       // clock, rising edge
    input  wire               rst,       // synchronous reset, active high
    // longest time of a write, clocks; 0 stands for CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [       31:0] limit,
    input  wire [COUNT_W-1:0] waiting,   // writes that clients wait for
    input  wire               answered,  // the first of them is answered on this clock
    output wire               timeout    // the first of them is given up on this clock
);

  wire tick;
  wire [31:0] elapsed;
  cchip_timeout #(.DEFAULT(`CCHIP_MEMORY_LIMIT_DEFAULT)) u_tick (
      .clk    (clk),
      .restart(rst | tick),
      .limit  (limit),
      .elapsed(elapsed),
      .expired(tick)
  );

  localparam [COUNT_W-1:0] NONE = {COUNT_W{1'b0}};
  reg [COUNT_W-1:0] old_q, late_q;  // writes waited for that saw the last tick, the last two
  assign timeout = late_q != NONE && !answered;
  wire [COUNT_W-1:0] leaves = {{COUNT_W - 1{1'b0}}, answered | timeout};
  wire [COUNT_W-1:0] old_left = old_q == NONE ? NONE : old_q - leaves;
  always @(posedge clk)
    if (rst) begin
      old_q  <= NONE;
      late_q <= NONE;
    end else begin
      old_q  <= tick ? waiting - leaves : old_left;
      late_q <= tick ? old_left : late_q == NONE ? NONE : late_q - leaves;
    end

  wire unused = &{1'b0, elapsed};

endmodule
`default_nettype wire
