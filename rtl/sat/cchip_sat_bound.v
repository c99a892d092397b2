// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_sat_bound: how far the projections of the unrounded vertices can lie from those of the
// grid.
// Part of macro stage 3; shifts and adds, no multiplier. a, b are the edges whose cross product is
// the axis, c the point whose sign is asked, relative to the reference
// (docs/develop/architecture.md, certainty):
//   m_gap_bound  = E |axis|_1, E = 2^s_error_shift >= eta
//   m_sign_bound = E (|axis|_1 + (|a|_1 + |b|_1 + 2 E) 2^n), n smallest with 2^n >= |c|_1 + 2 E
//   latency      SUBSTAGES + CCHIP_BOUND_LAG clocks from s_axis, s_edge_norm, s_error_shift; one
//                less from s_difference
//   throughput   one axis per clock, never stalls
//   numbers      unsigned, CCHIP_BOUND_W(COORD_W) bits, no overflow
//   reset        none (data only)
module cchip_sat_bound #(
    parameter integer COORD_W = 16,   // width of a coordinate (bit); legal: 4..20
    // registers of the projections beside this (clock); legal: >= 5
    parameter integer SUBSTAGES = 10
) (
    input  wire                                clk,            // clock, rising edge
    // axis L, x in the low bits, components signed
    input  wire [3*`CCHIP_AXIS_W(COORD_W)-1:0] s_axis,
    // |a|_1 + |b|_1 of the edges with L = a x b
    input  wire [  `CCHIP_NORM_W(COORD_W)-1:0] s_edge_norm,
    input  wire [    `CCHIP_ERROR_SHIFT_W-1:0] s_error_shift,  // E = 2^s_error_shift >= eta, 0..4
    // c, the point whose sign is asked, minus reference; x in the low bits, one clock after s_axis
    input  wire [3*`CCHIP_EDGE_W(COORD_W)-1:0] s_difference,
    // bound on the error of its projection, unsigned
    output wire [ `CCHIP_BOUND_W(COORD_W)-1:0] m_sign_bound,
    // bound on the error of the difference of two projections onto the fixed axis L, unsigned
    output wire [ `CCHIP_BOUND_W(COORD_W)-1:0] m_gap_bound
);

  localparam integer EDGE_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer NORM_W = `CCHIP_NORM_W(COORD_W);
  localparam integer AXIS_NORM_W = `CCHIP_AXIS_NORM_W(COORD_W);
  localparam integer BOUND_W = `CCHIP_BOUND_W(COORD_W);
  localparam integer LATENCY = SUBSTAGES + `CCHIP_BOUND_LAG;
  // |c|_1 + 2 E - 1 <= 3 (2^COORD_W - 1) + 31 < 2^U_W
  localparam integer U_W = COORD_W + 3;
  localparam integer GROUPS = (U_W + 3) / 4;
  // E (|a|_1 + |b|_1 + 2 E) <= 16 (6 (2^COORD_W - 1) + 32) < 2^(NORM_W + 5)
  localparam integer FACTOR_W = NORM_W + 5;
  // clocks used: difference, norm, sum, product, bound. What is left over goes, in this order,
  // behind the logarithm, between the two shifts of the product, into the logarithm, behind the
  // logarithm again.
  localparam integer SPARE = LATENCY - 4 - `CCHIP_NORM1_LATENCY;
  localparam integer SHIFT_REGS = SPARE >= 2 ? 1 : 0;
  localparam integer GROUP_REGS = SPARE >= 3 ? 1 : 0;
  localparam integer LOG_REGS = SPARE - SHIFT_REGS - GROUP_REGS;

  `CCHIP_REFUSE(SPARE < 0, cchip_error_SUBSTAGES_below_minimum_for_COORD_W)

  // ---- gap bound; gap_q is one clock ahead of the output, because the sign bound is a sum with it
  wire [`CCHIP_ERROR_SHIFT_W-1:0] shift_norm;
  wire four_gap;
  cchip_delay #(.WIDTH(3), .DEPTH(`CCHIP_NORM1_LATENCY)) u_shift_norm (
      .clk(clk),
      .rst(1'b0),
      .d  (s_error_shift),
      .q  (shift_norm)
  );
  cchip_delay #(.WIDTH(1), .DEPTH(LATENCY - 2 - `CCHIP_NORM1_LATENCY)) u_four_gap (
      .clk(clk),
      .rst(1'b0),
      .d  (shift_norm[2]),
      .q  (four_gap)
  );
  wire [AXIS_NORM_W-1:0] axis_norm;
  reg [AXIS_NORM_W+2:0] gap_low_q;  // shifted by 0..3
  wire [AXIS_NORM_W+2:0] gap_low;
  cchip_norm1 #(.V_W(AXIS_W)) u_axis_norm (.clk(clk), .v(s_axis), .q(axis_norm));
  always @(posedge clk) gap_low_q <= {3'd0, axis_norm} << shift_norm[1:0];
  cchip_delay #(
      .WIDTH (AXIS_NORM_W + 3),
      .DEPTH (LATENCY - 3 - `CCHIP_NORM1_LATENCY),
      .MEMORY(LATENCY - 3 - `CCHIP_NORM1_LATENCY >= 3 ? 1 : 0)
  ) u_gap_low (
      .clk(clk),
      .rst(1'b0),
      .d  (gap_low_q),
      .q  (gap_low)
  );
  reg [BOUND_W-1:0] gap_q, gap_q2;
  always @(posedge clk) begin
    gap_q  <= {{BOUND_W - AXIS_NORM_W - 3{1'b0}}, gap_low} << {four_gap, 2'd0};
    gap_q2 <= gap_q;
  end
  assign m_gap_bound = gap_q2;

  // ---- E (|a|_1 + |b|_1 + 2 E)
  function [FACTOR_W-1:0] shifted_by_ones(input [NORM_W:0] value, input [4:0] choice);
    integer j;
    begin
      shifted_by_ones = {FACTOR_W{1'b0}};
      for (j = 0; j < 5; j = j + 1)
        shifted_by_ones = shifted_by_ones | (({4'd0, value} & {FACTOR_W{choice[j]}}) << j);
    end
  endfunction
  reg [NORM_W-1:0] edge_norm_q;
  reg [NORM_W:0] edges_q2;
  reg [5:0] twice_error_q;
  reg [`CCHIP_ERROR_SHIFT_W-1:0] shift_q;
  reg [4:0] shift_q2;  // one-hot, so that the shift is two levels of LUTs
  reg [FACTOR_W-1:0] factor_q;
  always @(posedge clk) begin
    edge_norm_q   <= s_edge_norm;
    twice_error_q <= 6'd2 << s_error_shift;
    shift_q       <= s_error_shift;
    edges_q2      <= {1'b0, edge_norm_q} + {{NORM_W - 5{1'b0}}, twice_error_q};
    shift_q2      <= 5'd1 << shift_q;
    factor_q      <= shifted_by_ones(edges_q2, shift_q2);
  end
  wire [FACTOR_W-1:0] factor;
  cchip_delay #(
      .WIDTH (FACTOR_W),
      .DEPTH (LATENCY - 5 - SHIFT_REGS),
      .MEMORY(LATENCY - 5 - SHIFT_REGS >= 3 ? 1 : 0)
  ) u_factor (
      .clk(clk),
      .rst(1'b0),
      .d  (factor_q),
      .q  (factor)
  );

  // ---- n = 1 + position of the highest bit that is 1 in |c|_1 + 2 E - 1
  wire [EDGE_W:0] norm;
  cchip_norm1 #(.V_W(EDGE_W)) u_norm (.clk(clk), .v(s_difference), .q(norm));
  reg [4:0] twice_error_less_1_q;
  reg [U_W-1:0] sum_q;
  always @(posedge clk) begin
    twice_error_less_1_q <=
        {shift_norm >= 3'd4, shift_norm >= 3'd3, shift_norm >= 3'd2, shift_norm >= 3'd1, 1'b1};
    sum_q <= {1'b0, norm} + {{U_W - 5{1'b0}}, twice_error_less_1_q};
  end

  // found in groups of four bits: the highest group that is not 0, and the highest 1 in that group
  // (the sum is never 0)
  wire [4*GROUPS-1:0] u = {{4 * GROUPS - U_W{1'b0}}, sum_q};
  wire [3*GROUPS-1:0] found, group;  // {any, position} of each
  genvar g;
  generate
    for (g = 0; g < GROUPS; g = g + 1) begin : gen_group
      assign found[3*g+:3] = {|u[4*g+:4], |u[4*g+2+:2], u[4*g+3] | (u[4*g+1] & ~u[4*g+2])};
    end
  endgenerate
  cchip_delay #(.WIDTH(3 * GROUPS), .DEPTH(GROUP_REGS)) u_group (
      .clk(clk),
      .rst(1'b0),
      .d  (found),
      .q  (group)
  );
  function [4:0] highest(input [3*GROUPS-1:0] groups);
    integer j;
    begin
      highest = 5'd0;
      for (j = 0; j < GROUPS; j = j + 1) if (groups[3*j+2]) highest = {j[2:0], groups[3*j+:2]};
    end
  endfunction
  wire [4:0] log;  // n - 1
  cchip_delay #(.WIDTH(5), .DEPTH(LOG_REGS)) u_log (
      .clk(clk),
      .rst(1'b0),
      .d  (highest(group)),
      .q  (log)
  );

  // ---- product and bound: shifts by 1..4, then by multiples of four
  wire [FACTOR_W+3:0] product_low;
  wire [GROUPS-1:0] log_high;  // one-hot
  cchip_delay #(.WIDTH(FACTOR_W + 4 + GROUPS), .DEPTH(SHIFT_REGS)) u_shift (
      .clk(clk),
      .rst(1'b0),
      .d  ({{3'd0, factor, 1'b0} << log[1:0], {{GROUPS - 1{1'b0}}, 1'b1} << log[4:2]}),
      .q  ({product_low, log_high})
  );
  function [BOUND_W-1:0] shifted_by_fours(input [FACTOR_W+3:0] value, input [GROUPS-1:0] choice);
    integer j;
    begin
      shifted_by_fours = {BOUND_W{1'b0}};
      for (j = 0; j < GROUPS; j = j + 1)
        shifted_by_fours = shifted_by_fours
                         | (({{BOUND_W - FACTOR_W - 4{1'b0}}, value}
                             & {BOUND_W{choice[j]}}) << (4 * j));
    end
  endfunction
  reg [BOUND_W-1:0] product_q, bound_q;
  always @(posedge clk) begin
    product_q <= shifted_by_fours(product_low, log_high);
    bound_q   <= product_q + gap_q;
  end
  assign m_sign_bound = bound_q;

endmodule
`default_nettype wire
