// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_project: macro stage 3 of the SAT pipeline (paper, figure 7): projections of the points
// onto the axis (eq. 2), relative to the projection of the reference point. m_projection[i] = (p_i - reference) . axis.
//   latency      SUBSTAGES clocks
//   throughput   one axis per clock, never stalls
//   numbers      points of COORD_W bits, axis components of 2 COORD_W + 2 bits, projections of
//                3 COORD_W + 3 bits, exact for every axis that is a cross product of two edges of the pair
//   reset        none (data only)
// ABSOLUTE_PROJECTION = 0: points relative to the reference are projected; POINTS dot products.
// ABSOLUTE_PROJECTION = 1: the paper's: the reference is projected too and its projection subtracted;
//   POINTS + 1 dot products. Identical results, same latency.
// Substages: point differences (relative) or projection differences (absolute), [operand register], leaf
// input, leaf output, [product register], adder levels of wide products, two levels of sums, [result
// registers]. Those in brackets use what SUBSTAGES leaves over CCHIP_PROJECT_SUBSTAGES_MIN: first the
// product register, then the operand register, then results.
module cchip_sat_project #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16,
    // registers from input to output, clocks
    parameter integer SUBSTAGES = 10,
    // 0: relative to the reference before, 1: after the multiplication
    parameter integer ABSOLUTE_PROJECTION = 0,
    // points to project
    parameter integer POINTS = 3
) (
    input  wire                            clk,
    input  wire [       6*(COORD_W+1)-1:0] s_axis,
    input  wire [           3*COORD_W-1:0] s_reference,
    input  wire [    3*POINTS*COORD_W-1:0] s_points,     // p0 in the low bits
    output wire [POINTS*3*(COORD_W+1)-1:0] m_projection, // p0 in the low bits
    output wire                            m_axis_zero   // the axis is the zero vector
);

`include "cchip_defs.vh"

  localparam integer EDGE_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer PROJ_W = `CCHIP_PROJ_W(COORD_W);
  localparam integer SPARE = SUBSTAGES - `CCHIP_PROJECT_SUBSTAGES_MIN(COORD_W);
  localparam integer PRODUCT_REGS = SPARE >= 1 ? 1 : 0;
  localparam integer OPERAND_REGS = SPARE >= 2 ? 1 : 0;
  localparam integer RESULT_REGS = SPARE - OPERAND_REGS - PRODUCT_REGS;

  generate
    if (SPARE < 0) begin : gen_illegal
      cchip_error_SUBSTAGES_below_minimum_for_COORD_W u_error ();
    end
    if (ABSOLUTE_PROJECTION != 0 && ABSOLUTE_PROJECTION != 1) begin : gen_illegal_projection
      cchip_error_ABSOLUTE_PROJECTION_must_be_0_or_1 u_error ();
    end
  endgenerate

  genvar i, d;
  generate
    if (ABSOLUTE_PROJECTION == 0) begin : gen_relative
      reg [3*AXIS_W-1:0] axis_q;
      always @(posedge clk) axis_q <= s_axis;
      for (i = 0; i < POINTS; i = i + 1) begin : gen_point
        reg [3*EDGE_W-1:0] difference_q;
        for (d = 0; d < 3; d = d + 1) begin : gen_component
          wire signed [COORD_W-1:0] from = s_reference[COORD_W*d+:COORD_W];
          wire signed [COORD_W-1:0] to = s_points[COORD_W*(3*i+d)+:COORD_W];
          always @(posedge clk)
            difference_q[EDGE_W*d+:EDGE_W] <= {to[COORD_W-1], to} - {from[COORD_W-1], from};
        end
        cchip_dot3 #(
            .A_W(EDGE_W),
            .B_W(AXIS_W),
            .OPERAND_REGS(OPERAND_REGS),
            .PRODUCT_REGS(PRODUCT_REGS),
            .RESULT_REGS(RESULT_REGS)
        ) u_dot (
            .clk(clk),
            .a  (difference_q),
            .b  (axis_q),
            .q  (m_projection[PROJ_W*i+:PROJ_W])
        );
      end
    end else begin : gen_absolute
      // width of a dot product with W-bit coordinates: CCHIP_PROJ_ABS_W
      localparam integer DOT_W = COORD_W + AXIS_W;
      // latency of cchip_dot3 may differ from the relative one (narrower factor): the rest is delay
      localparam integer FILL = `CCHIP_MUL_LATENCY(EDGE_W, AXIS_W) - `CCHIP_MUL_LATENCY(COORD_W, AXIS_W);
      wire [DOT_W-1:0] reference;
      cchip_dot3 #(
          .A_W(COORD_W),
          .B_W(AXIS_W),
          .OPERAND_REGS(OPERAND_REGS),
          .PRODUCT_REGS(PRODUCT_REGS),
          .RESULT_REGS(RESULT_REGS + FILL)
      ) u_reference (
          .clk(clk),
          .a  (s_reference),
          .b  (s_axis),
          .q  (reference)
      );
      for (i = 0; i < POINTS; i = i + 1) begin : gen_point
        wire [ DOT_W-1:0] point;
        reg  [PROJ_W-1:0] difference_q;
        cchip_dot3 #(
            .A_W(COORD_W),
            .B_W(AXIS_W),
            .OPERAND_REGS(OPERAND_REGS),
            .PRODUCT_REGS(PRODUCT_REGS),
            .RESULT_REGS(RESULT_REGS + FILL)
        ) u_dot (
            .clk(clk),
            .a  (s_points[3*COORD_W*i+:3*COORD_W]),
            .b  (s_axis),
            .q  (point)
        );
        always @(posedge clk) difference_q <= {point[DOT_W-1], point} - {reference[DOT_W-1], reference};
        assign m_projection[PROJ_W*i+:PROJ_W] = difference_q;
      end
    end
  endgenerate

  cchip_delay #(
      .WIDTH(1),
      .DEPTH(SUBSTAGES)
  ) u_axis_zero (
      .clk(clk),
      .rst(1'b0),
      .d  (s_axis == {3 * AXIS_W{1'b0}}),
      .q  (m_axis_zero)
  );

endmodule
`default_nettype wire
