// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_sat_project: macro stage 3 of the SAT pipeline (paper, figure 7): projections of the points
// onto the axis (eq. 2), relative to the projection of the reference point, and what the certainty
// of their signs needs. m_projection[i] = (p_i - reference) . axis.
//   latency      SUBSTAGES clocks; bounds CCHIP_BOUND_LAG more
//   throughput   one axis per clock, never stalls
//   numbers      points of COORD_W bits, axis components of 2 COORD_W + 2 bits, projections of
//                3 COORD_W + 3 bits, exact for every axis that is a cross product of two edges of
//                the pair
//   reset        none (data only)
// ABSOLUTE_PROJECTION = 0: points relative to the reference are projected; POINTS dot products.
// ABSOLUTE_PROJECTION = 1: the paper's: the reference is projected too and its projection
// subtracted;
//   POINTS + 1 dot products. Identical results, same latency.
// Substages: point differences (relative) or projection differences (absolute), [operand register],
// leaf input, leaf output, [product register], adder levels of wide products, two levels of sums,
// [result registers]. Those in brackets use what SUBSTAGES leaves over CCHIP_PROJECT_SUBSTAGES_MIN:
// first the product register, then the operand register, then results. The error bounds run beside
// (cchip_sat_bound).
module cchip_sat_project #(
    parameter integer COORD_W = 16,             // width of a coordinate (bit); legal: 4..20
    // registers from input to output (clock); legal: >= CCHIP_PROJECT_SUBSTAGES_MIN(COORD_W)
    parameter integer SUBSTAGES = 10,
    // 0: subtract the reference before the multiplication, 1: after it; legal: 0, 1
    parameter integer ABSOLUTE_PROJECTION = 0,
    parameter integer POINTS = 3,               // points to project; legal: 3..5
    // number of the point whose sign may have to be certain; legal: 0..POINTS - 1
    parameter integer SIGN = 1
) (
    input  wire                                     clk,              // clock, rising edge
    // axis, x in the low bits, components signed, 2 COORD_W + 2 bits each
    input  wire [     3*`CCHIP_AXIS_W(COORD_W)-1:0] s_axis,
    input  wire [       `CCHIP_NORM_W(COORD_W)-1:0] s_edge_norm,      // |e|_1 + |f|_1 of its edges
    // E = 2^s_error_shift >= eta, 0..4
    input  wire [         `CCHIP_ERROR_SHIFT_W-1:0] s_error_shift,
    // point that projects onto 0, x in the low bits
    input  wire [                    3*COORD_W-1:0] s_reference,
    input  wire [             3*POINTS*COORD_W-1:0] s_points,         // points, p0 in the low bits
    // projections, p0 in the low bits, signed, 3 COORD_W + 3 bits each
    output wire [POINTS*`CCHIP_PROJ_W(COORD_W)-1:0] m_projection,
    // bound on the error of projection SIGN, unsigned, CCHIP_BOUND_LAG clocks after it
    output wire [      `CCHIP_BOUND_W(COORD_W)-1:0] m_sign_bound,
    // bound on the error of the difference of two projections onto this axis, CCHIP_BOUND_LAG
    // clocks after them; of the difference of two true projections
    output wire [      `CCHIP_BOUND_W(COORD_W)-1:0] m_gap_bound,
    // component of the axis < 0, x in bit 0
    output wire [                              2:0] m_axis_negative,
    // component = 0; all three: the zero vector
    output wire [                              2:0] m_axis_zero,
    // component of the largest absolute value, the lowest of equals
    output wire [                              1:0] m_axis_largest
);

  localparam integer EDGE_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer PROJ_W = `CCHIP_PROJ_W(COORD_W);
  localparam integer SPARE = SUBSTAGES - 3 - `CCHIP_MUL_LATENCY(EDGE_W, AXIS_W);
  localparam integer PRODUCT_REGS = SPARE >= 1 ? 1 : 0;
  localparam integer OPERAND_REGS = SPARE >= 2 ? 1 : 0;
  localparam integer RESULT_REGS = SPARE - OPERAND_REGS - PRODUCT_REGS;

  `CCHIP_REFUSE(SUBSTAGES < `CCHIP_PROJECT_SUBSTAGES_MIN(COORD_W),
                cchip_error_SUBSTAGES_below_minimum_for_COORD_W)
  `CCHIP_REFUSE(SIGN < 0 || SIGN >= POINTS, cchip_error_SIGN_must_be_below_POINTS)
  `CCHIP_REFUSE(ABSOLUTE_PROJECTION != 0 && ABSOLUTE_PROJECTION != 1,
                cchip_error_ABSOLUTE_PROJECTION_must_be_0_or_1)

  // ---- points relative to the reference
  reg [3*EDGE_W*POINTS-1:0] difference_q;
  genvar i, d;
  generate
    for (i = 0; i < POINTS; i = i + 1) begin : gen_difference
      for (d = 0; d < 3; d = d + 1) begin : gen_component
        wire signed [COORD_W-1:0] from = s_reference[COORD_W*d+:COORD_W];
        wire signed [COORD_W-1:0] to = s_points[COORD_W*(3*i+d)+:COORD_W];
        always @(posedge clk)
          difference_q[EDGE_W*(3*i+d)+:EDGE_W] <= {to[COORD_W-1], to} - {from[COORD_W-1], from};
      end
    end
  endgenerate

  // ---- dot products
  generate
    if (ABSOLUTE_PROJECTION == 0) begin : gen_relative
      reg [3*AXIS_W-1:0] axis_q;
      always @(posedge clk) axis_q <= s_axis;
      for (i = 0; i < POINTS; i = i + 1) begin : gen_point
        cchip_dot3 #(
            .A_W(EDGE_W),
            .B_W(AXIS_W),
            .OPERAND_REGS(OPERAND_REGS),
            .PRODUCT_REGS(PRODUCT_REGS),
            .RESULT_REGS(RESULT_REGS)
        ) u_dot (
            .clk(clk),
            .a  (difference_q[3*EDGE_W*i+:3*EDGE_W]),
            .b  (axis_q),
            .q  (m_projection[PROJ_W*i+:PROJ_W])
        );
      end
    end else begin : gen_absolute
      wire unused = &{1'b0, difference_q};  // all but that of point SIGN
      // width of a dot product with W-bit coordinates: CCHIP_PROJ_ABS_W
      localparam integer DOT_W = COORD_W + AXIS_W;
      // latency of cchip_dot3 may differ from the relative one (narrower factor): the rest is delay
      localparam integer FILL = `CCHIP_MUL_LATENCY(EDGE_W, AXIS_W)
          - `CCHIP_MUL_LATENCY(COORD_W, AXIS_W);
      // the reference is one more point, the last
      wire [3*COORD_W*(POINTS+1)-1:0] points = {s_reference, s_points};
      wire [DOT_W*(POINTS+1)-1:0] dot;
      wire [PROJ_W-1:0] reference = {dot[DOT_W*(POINTS+1)-1], dot[DOT_W*POINTS+:DOT_W]};
      for (i = 0; i <= POINTS; i = i + 1) begin : gen_dot
        cchip_dot3 #(
            .A_W(COORD_W),
            .B_W(AXIS_W),
            .OPERAND_REGS(OPERAND_REGS),
            .PRODUCT_REGS(PRODUCT_REGS),
            .RESULT_REGS(RESULT_REGS + FILL)
        ) u_dot (
            .clk(clk),
            .a  (points[3*COORD_W*i+:3*COORD_W]),
            .b  (s_axis),
            .q  (dot[DOT_W*i+:DOT_W])
        );
      end
      for (i = 0; i < POINTS; i = i + 1) begin : gen_point
        reg [PROJ_W-1:0] relative_q;
        always @(posedge clk)
          relative_q <= {dot[DOT_W*(i+1)-1], dot[DOT_W*i+:DOT_W]} - reference;
        assign m_projection[PROJ_W*i+:PROJ_W] = relative_q;
      end
    end
  endgenerate

  // ---- error bounds
  cchip_sat_bound #(.COORD_W(COORD_W), .SUBSTAGES(SUBSTAGES)) u_bound (
      .clk          (clk),
      .s_axis       (s_axis),
      .s_edge_norm  (s_edge_norm),
      .s_error_shift(s_error_shift),
      .s_difference (difference_q[3*EDGE_W*SIGN+:3*EDGE_W]),
      .m_sign_bound (m_sign_bound),
      .m_gap_bound  (m_gap_bound)
  );

  // ---- signs and largest component of the axis: |.| in two clocks, then two levels of comparisons
  reg [3*(AXIS_W-1)-1:0] size_q;
  reg [3*AXIS_W-1:0] absolute_q2;
  localparam integer PARTS = (AXIS_W + 8) / 9;
  reg [2:0] negative_q, zero_q2;
  reg y_over_x_q3, z_over_x_q3, z_over_y_q3;
  wire [2:0] negative_q3, zero_q3;
  genvar g;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_axis
      wire [AXIS_W-1:0] v = s_axis[AXIS_W*d+:AXIS_W];
      // v = 0 is detected in two clocks: parts of 9 bits, then all parts
      wire [9*PARTS-1:0] parts = {{9 * PARTS - AXIS_W{1'b0}}, v};
      reg [PARTS-1:0] some_q;
      for (g = 0; g < PARTS; g = g + 1) begin : gen_part
        always @(posedge clk) some_q[g] <= |parts[9*g+:9];
      end
      always @(posedge clk) begin
        zero_q2[d]    <= ~|some_q;
        negative_q[d] <= v[AXIS_W-1];
        size_q[(AXIS_W-1)*d+:AXIS_W-1] <= v[AXIS_W-2:0] ^ {AXIS_W - 1{v[AXIS_W-1]}};
        absolute_q2[AXIS_W*d+:AXIS_W] <= {1'b0, size_q[(AXIS_W-1)*d+:AXIS_W-1]}
            + {{AXIS_W - 1{1'b0}}, negative_q[d]};
      end
    end
  endgenerate

  // x < y
  function less(input [AXIS_W-1:0] x, input [AXIS_W-1:0] y);
    reg [AXIS_W:0] difference;
    begin
      difference = {1'b0, x} - {1'b0, y};
      less = difference[AXIS_W];
    end
  endfunction
  always @(posedge clk) begin
    y_over_x_q3 <= less(absolute_q2[0+:AXIS_W], absolute_q2[AXIS_W+:AXIS_W]);
    z_over_x_q3 <= less(absolute_q2[0+:AXIS_W], absolute_q2[2*AXIS_W+:AXIS_W]);
    z_over_y_q3 <= less(absolute_q2[AXIS_W+:AXIS_W], absolute_q2[2*AXIS_W+:AXIS_W]);
  end
  cchip_delay #(.WIDTH(3), .DEPTH(2)) u_negative (
      .clk(clk),
      .rst(1'b0),
      .d  (negative_q),
      .q  (negative_q3)
  );
  cchip_delay #(.WIDTH(3)) u_zero (.clk(clk), .rst(1'b0), .d(zero_q2), .q(zero_q3));

  wire [1:0] largest = y_over_x_q3 ? (z_over_y_q3 ? 2'd2 : 2'd1) : (z_over_x_q3 ? 2'd2 : 2'd0);
  cchip_delay #(.WIDTH(8), .DEPTH(SUBSTAGES - 3)) u_axis (
      .clk(clk),
      .rst(1'b0),
      .d  ({negative_q3, zero_q3, largest}),
      .q  ({m_axis_negative, m_axis_zero, m_axis_largest})
  );

endmodule
`default_nettype wire
