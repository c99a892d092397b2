// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_swap_counters: what the configuration controller has done.
//   latency      1 clock, phase_clocks 2
//   numbers      32 bit, wrap around; phase_clocks[32*(p-1) +: 32] = clocks of phase p in the last
//                swap, 0 if it had none
//   cuts         every path: each output is a flip-flop
//   reset        rst or clear: 0
module cchip_swap_counters (
    input  wire                      clk,
    input  wire                      rst,
    input  wire                      clear,
    input  wire [`CCHIP_PHASE_W-1:0] phase,
    input  wire [              31:0] elapsed,      // clocks in this phase, 1 on the first
    input  wire                      report_valid,
    input  wire [ `CCHIP_SWAP_W-1:0] report_code,
    input  wire                      stall,
    output wire [              31:0] swaps,
    output wire [              31:0] rejected,
    output wire [              31:0] stalls,
    output wire [          9*32-1:0] phase_clocks
);

  reg [31:0] swaps_q;
  reg [31:0] rejected_q;
  reg [31:0] stalls_q;
  reg [9*32-1:0] phase_clocks_q;
  assign swaps = swaps_q;
  assign rejected = rejected_q;
  assign stalls = stalls_q;
  assign phase_clocks = phase_clocks_q;

  wire ok = report_code == `CCHIP_SWAP_OK;
  wire none = report_code == `CCHIP_SWAP_SAME;

  reg [`CCHIP_PHASE_W-1:0] phase_q;
  reg [31:0] clocks_q;
  // the phase is decoded one clock ahead, because the decoded bits drive many registers
  reg [9:0] in_q;  // one-hot, phase_q
  reg first_q;
  integer p;

  always @(posedge clk) begin
    phase_q  <= phase;
    clocks_q <= elapsed;
    first_q <= phase_q == `CCHIP_PHASE_IDLE && phase != `CCHIP_PHASE_IDLE;
    for (p = 0; p < 10; p = p + 1) in_q[p] <= phase == p[`CCHIP_PHASE_W-1:0];
    for (p = 1; p < 10; p = p + 1)
      if (in_q[p]) phase_clocks_q[32*(p-1)+:32] <= clocks_q;
      else if (first_q) phase_clocks_q[32*(p-1)+:32] <= 32'd0;
    if (report_valid && ok) swaps_q <= swaps_q + 32'd1;
    if (report_valid && !ok && !none) rejected_q <= rejected_q + 32'd1;
    if (stall) stalls_q <= stalls_q + 32'd1;
    if (rst || clear) begin
      swaps_q <= 32'd0;
      rejected_q <= 32'd0;
      stalls_q <= 32'd0;
      phase_clocks_q <= {9 * 32{1'b0}};
    end
    if (rst) phase_q <= `CCHIP_PHASE_IDLE;
    if (rst) in_q <= 10'd0;
    if (rst) first_q <= 1'b0;
  end

endmodule
`default_nettype wire
