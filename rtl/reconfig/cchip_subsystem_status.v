// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_subsystem_status: what the registers of the subsystem show of swaps: the last report, its
// event, the sum of the pairs that were lost.
//   latency      1 clock from a report to every output
//   reset        all 0; clear: lost 0, a report on its clock is not in lost
//   numbers      lost wraps at 2^32. cchip_counter_file has what is counted one by one.
//   why          A report may bring up to 65,535 pairs, so their sum has an adder of its own.
module cchip_subsystem_status (
    input  wire                            clk,           // clock, rising edge
    input  wire                            rst,           // synchronous reset, active high
    // sets lost to 0; a report on this clock is not counted
    input  wire                            clear,
    input  wire                            report_valid,  // a swap ended or was refused, one clock
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    input  wire [`CCHIP_SWAP_REPORT_W-1:0] report_data,
    // the last report: record SWAP_REPORT, docs/hardware/definitions.md
    output wire [`CCHIP_SWAP_REPORT_W-1:0] last_report,
    // {lost, error, done} of a report, one clock
    output wire [                     2:0] swap_events,
    output wire [                    31:0] lost           // pairs given up, sum
);

  reg [`CCHIP_SWAP_REPORT_W-1:0] last_report_q;
  reg [2:0] swap_events_q;
  reg [31:0] lost_q;
  assign last_report = last_report_q;
  assign swap_events = swap_events_q;
  assign lost = lost_q;

  wire [`CCHIP_SWAP_W-1:0] report_code = report_data[`CCHIP_SWAP_REPORT_CODE];
  wire [`CCHIP_PAIR_COUNT_W-1:0] report_lost = report_data[`CCHIP_SWAP_REPORT_LOST];
  wire done = report_code == `CCHIP_SWAP_OK || report_code == `CCHIP_SWAP_SAME;

  always @(posedge clk)
    if (rst) begin
      last_report_q <= {`CCHIP_SWAP_REPORT_W{1'b0}};
      swap_events_q <= 3'd0;
      lost_q        <= 32'd0;
    end else begin
      if (report_valid) last_report_q <= report_data;
      swap_events_q <= {3{report_valid}} & {report_lost != 16'd0, ~done, done};
      lost_q <= clear ? 32'd0 : lost_q + (report_valid ? {16'd0, report_lost} : 32'd0);
    end

endmodule
`default_nettype wire
