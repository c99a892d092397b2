// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`include "cchip_defs.vh"
`default_nettype none
// cchip_subsystem_status: what the registers of the subsystem show of the past: the last report, counters of lost and of
// answered pairs.
//   latency      1 clock from a report to last_* and swap_events, 2 clocks from an answer to its counter
//   cuts         every path: each output is a flip-flop
//   reset        all 0; clear: the counters 0
module cchip_subsystem_status (
    input  wire         clk,
    input  wire         rst,
    input  wire         clear,
    input  wire         report_valid,
    input  wire [  7:0] report_slot,
    input  wire [  7:0] report_module,
    input  wire [  3:0] report_code,
    input  wire [ 15:0] report_lost,
    input  wire         answered,
    input  wire [  1:0] answered_module,  // 0: without a test
    output reg  [  7:0] last_slot,
    output reg  [  7:0] last_module,
    output reg  [  3:0] last_code,
    output reg  [ 15:0] last_lost,
    output reg  [  2:0] swap_events,      // {lost, error, done}, one clock
    output reg  [ 31:0] lost,
    output reg  [255:0] pairs             // 64 bit for each module
);

  wire done = report_code == `CCHIP_SWAP_OK | report_code == `CCHIP_SWAP_SAME;

  always @(posedge clk)
    if (rst) begin
      last_slot   <= 8'd0;
      last_module <= 8'd0;
      last_code   <= 4'd0;
      last_lost   <= 16'd0;
      swap_events <= 3'd0;
      lost        <= 32'd0;
    end else begin
      if (report_valid) begin
        last_slot   <= report_slot;
        last_module <= report_module;
        last_code   <= report_code;
        last_lost   <= report_lost;
      end
      swap_events <= {3{report_valid}} & {report_lost != 16'd0, ~done, done};
      lost <= clear ? 32'd0 : lost + (report_valid ? {16'd0, report_lost} : 32'd0);
    end

  // 64-bit counters in two halves: the carry comes a clock later
  genvar m;
  generate
    for (m = 0; m < 4; m = m + 1) begin : gen_modules
      localparam [31:0] MODULE = m;
      reg carry_q;
      wire count = answered & answered_module == MODULE[1:0];
      always @(posedge clk)
        if (rst | clear) begin
          carry_q         <= 1'b0;
          pairs[64*m+:64] <= 64'd0;
        end else begin
          carry_q <= count & (&pairs[64*m+:32]);
          if (count) pairs[64*m+:32] <= pairs[64*m+:32] + 32'd1;
          if (carry_q) pairs[64*m+32+:32] <= pairs[64*m+32+:32] + 32'd1;
        end
    end
  endgenerate

endmodule
`default_nettype wire
