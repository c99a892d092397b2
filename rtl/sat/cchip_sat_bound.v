// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_bound: how far the projections of the unrounded vertices can lie from those of the grid.
// Part of macro stage 3; shifts and adds, no multiplier. a, b are the edges whose cross product is the
// axis, c_i the points relative to the reference (docs/architecture.md, certainty):
//   m_gap_bound     = E |axis|_1, E = 2^s_error_shift >= eta
//   m_sign_bound[i] = E (|axis|_1 + (|a|_1 + |b|_1 + 2 E) 2^n), n smallest with 2^n >= |c_i|_1 + 2 E
//   latency      SUBSTAGES clocks from s_axis, s_edge_norm, s_error_shift; one less from s_difference
//   throughput   one axis per clock, never stalls
//   numbers      unsigned, CCHIP_BOUND_W(COORD_W) bits, no overflow
//   reset        none (data only)
module cchip_sat_bound #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16,
    // registers from s_axis to the outputs, clocks, >= 6
    parameter integer SUBSTAGES = 10,
    // points to project
    parameter integer POINTS = 3
) (
    input  wire                             clk,
    input  wire [        6*(COORD_W+1)-1:0] s_axis,
    input  wire [              COORD_W+2:0] s_edge_norm,
    input  wire [                      2:0] s_error_shift,
    input  wire [ 3*POINTS*(COORD_W+1)-1:0] s_difference,  // one clock after s_axis
    output wire [POINTS*(2*COORD_W+11)-1:0] m_sign_bound,
    output wire [           2*COORD_W+10:0] m_gap_bound
);

`include "cchip_defs.vh"

  localparam integer EDGE_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer NORM_W = `CCHIP_NORM_W(COORD_W);
  localparam integer AXIS_NORM_W = `CCHIP_AXIS_NORM_W(COORD_W);
  localparam integer BOUND_W = `CCHIP_BOUND_W(COORD_W);
  // |c|_1 + 2 E - 1 <= 3 (2^COORD_W - 1) + 31 < 2^U_W
  localparam integer U_W = COORD_W + 3;
  localparam integer LOG_W = $clog2(U_W + 1);
  // |a|_1 + |b|_1 + 2 E <= 6 (2^COORD_W - 1) + 32 < 2^(NORM_W + 1)
  localparam integer FACTOR_W = NORM_W + 1;
  localparam integer PRODUCT_W = BOUND_W - 4;
  // substages used: difference, norm (2), sum, product, bound. The first one to spare separates logarithm
  // and product, the second one sum and logarithm, the rest follow the logarithm.
  localparam integer SPARE = SUBSTAGES - 6;
  localparam integer SUM_REGS = SPARE >= 2 ? 1 : 0;

  generate
    if (SPARE < 0) begin : gen_illegal
      cchip_error_SUBSTAGES_below_minimum_for_COORD_W u_error ();
    end
  endgenerate

  // s_error_shift beside the sums and beside the last substage
  wire [2:0] shift_sum, shift_bound;
  cchip_delay #(
      .WIDTH(3),
      .DEPTH(1 + `CCHIP_NORM1_LATENCY)
  ) u_shift_sum (
      .clk(clk),
      .rst(1'b0),
      .d  (s_error_shift),
      .q  (shift_sum)
  );
  cchip_delay #(
      .WIDTH(3),
      .DEPTH(SUBSTAGES - 1 - 1 - `CCHIP_NORM1_LATENCY)
  ) u_shift_bound (
      .clk(clk),
      .rst(1'b0),
      .d  (shift_sum),
      .q  (shift_bound)
  );

  // ---- |axis|_1, needed by the last substage
  wire [AXIS_NORM_W-1:0] axis_norm_early, axis_norm;
  cchip_norm1 #(
      .V_W(AXIS_W)
  ) u_axis_norm (
      .clk(clk),
      .v  (s_axis),
      .q  (axis_norm_early)
  );
  cchip_delay #(
      .WIDTH(AXIS_NORM_W),
      .DEPTH(SUBSTAGES - 1 - `CCHIP_NORM1_LATENCY)
  ) u_axis_norm_delay (
      .clk(clk),
      .rst(1'b0),
      .d  (axis_norm_early),
      .q  (axis_norm)
  );

  // ---- |a|_1 + |b|_1 + 2 E, needed by the substage before
  wire [FACTOR_W-1:0] factor;
  reg [FACTOR_W-1:0] factor_q;
  wire [5:0] twice_error = 6'd2 << s_error_shift;
  always @(posedge clk) factor_q <= {1'b0, s_edge_norm} + {{FACTOR_W - 6{1'b0}}, twice_error};
  cchip_delay #(
      .WIDTH(FACTOR_W),
      .DEPTH(SUBSTAGES - 3)
  ) u_factor (
      .clk(clk),
      .rst(1'b0),
      .d  (factor_q),
      .q  (factor)
  );

  reg [BOUND_W-1:0] gap_q;
  always @(posedge clk) gap_q <= {{BOUND_W - AXIS_NORM_W{1'b0}}, axis_norm} << shift_bound;
  assign m_gap_bound = gap_q;

  wire [5:0] twice_error_less_1 = (6'd2 << shift_sum) - 6'd1;

  // position of the highest one, plus 1: smallest n with 2^n >= u + 1
  function [LOG_W-1:0] length(input [U_W-1:0] u);
    integer j;
    begin
      length = {LOG_W{1'b0}};
      for (j = 0; j < U_W; j = j + 1) if (u[j]) length = j[LOG_W-1:0] + {{LOG_W - 1{1'b0}}, 1'b1};
    end
  endfunction

  genvar i;
  generate
    for (i = 0; i < POINTS; i = i + 1) begin : gen_point
      wire [   EDGE_W:0] norm;
      reg  [    U_W-1:0] sum_q;
      wire [    U_W-1:0] sum;
      wire [  LOG_W-1:0] log;
      reg  [PRODUCT_W-1:0] product_q;
      reg  [BOUND_W-1:0] bound_q;
      cchip_norm1 #(
          .V_W(EDGE_W)
      ) u_norm (
          .clk(clk),
          .v  (s_difference[3*EDGE_W*i+:3*EDGE_W]),
          .q  (norm)
      );
      always @(posedge clk)
        sum_q <= {1'b0, norm} + {{U_W - 6{1'b0}}, twice_error_less_1};
      cchip_delay #(
          .WIDTH(U_W),
          .DEPTH(SUM_REGS)
      ) u_sum (
          .clk(clk),
          .rst(1'b0),
          .d  (sum_q),
          .q  (sum)
      );
      cchip_delay #(
          .WIDTH(LOG_W),
          .DEPTH(SPARE - SUM_REGS)
      ) u_log (
          .clk(clk),
          .rst(1'b0),
          .d  (length(sum)),
          .q  (log)
      );
      always @(posedge clk) begin
        product_q <= {{PRODUCT_W - FACTOR_W{1'b0}}, factor} << log;
        bound_q   <= ({4'd0, product_q} + {{BOUND_W - AXIS_NORM_W{1'b0}}, axis_norm}) << shift_bound;
      end
      assign m_sign_bound[BOUND_W*i+:BOUND_W] = bound_q;
    end
  endgenerate

endmodule
`default_nettype wire
