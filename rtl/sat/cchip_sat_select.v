// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_select: macro stage 1 of the SAT pipeline (paper, figure 7), triangle against triangle.
// Chooses the two edges e, f whose cross product is the axis, and the points to project.
//   latency      CCHIP_SELECT_LATENCY = 1 clock
//   throughput   one axis per clock, never stalls
//   numbers      points of three signed COORD_W-bit coordinates, x in the low bits
//   reset        none (data only)
//
//   class      e             f             points p0, p1, p2
//   NORMAL_A   V0 -> V1      V0 -> V2      W0, W1, W2
//   NORMAL_B   W0 -> W1      W0 -> W2      V0, V1, V2
//   CROSS k l  Vk -> Vk+1    Wl -> Wl+1    Vk+2, Wl, Wl+2     (indices modulo 3)
// The start of e is the reference of the relative projection: all vertices of the axis' own
// primitive(s) that are not among the points project onto the same value as it or as a point.
// Any other class selects like NORMAL_A; its verdict has no meaning.
module cchip_sat_select #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16
) (
    input  wire                 clk,
    input  wire [          8:0] s_code,  // {class, k, l}
    input  wire [9*COORD_W-1:0] s_a,     // V2, V1, V0
    input  wire [9*COORD_W-1:0] s_b,     // W2, W1, W0
    output reg  [3*COORD_W-1:0] m_e_from,
    output reg  [3*COORD_W-1:0] m_e_to,
    output reg  [3*COORD_W-1:0] m_f_from,
    output reg  [3*COORD_W-1:0] m_f_to,
    output reg  [9*COORD_W-1:0] m_points // p2, p1, p0
);

`include "cchip_defs.vh"

  localparam integer POINT_W = 3 * COORD_W;

  wire [`CCHIP_CLASS_W-1:0] axis_class = s_code[8:6];
  wire [1:0] k = s_code[4:3];
  wire [1:0] l = s_code[1:0];
  wire unused = &{1'b0, s_code[5], s_code[2]};

  // vertex i + offset (modulo 3) of a triangle
  function [POINT_W-1:0] vertex(input [3*POINT_W-1:0] triangle, input [1:0] i, input [1:0] offset);
    reg [2:0] sum;
    begin
      sum = {1'b0, i} + {1'b0, offset};
      case (sum)
        3'd0, 3'd3: vertex = triangle[0+:POINT_W];
        3'd1, 3'd4: vertex = triangle[POINT_W+:POINT_W];
        default:    vertex = triangle[2*POINT_W+:POINT_W];
      endcase
    end
  endfunction

  always @(posedge clk)
    case (axis_class)
      `CCHIP_AXIS_CROSS: begin
        m_e_from <= vertex(s_a, k, 2'd0);
        m_e_to   <= vertex(s_a, k, 2'd1);
        m_f_from <= vertex(s_b, l, 2'd0);
        m_f_to   <= vertex(s_b, l, 2'd1);
        m_points <= {vertex(s_b, l, 2'd2), vertex(s_b, l, 2'd0), vertex(s_a, k, 2'd2)};
      end
      `CCHIP_AXIS_NORMAL_B: begin
        m_e_from <= s_b[0+:POINT_W];
        m_e_to   <= s_b[POINT_W+:POINT_W];
        m_f_from <= s_b[0+:POINT_W];
        m_f_to   <= s_b[2*POINT_W+:POINT_W];
        m_points <= s_a;
      end
      default: begin
        m_e_from <= s_a[0+:POINT_W];
        m_e_to   <= s_a[POINT_W+:POINT_W];
        m_f_from <= s_a[0+:POINT_W];
        m_f_to   <= s_a[2*POINT_W+:POINT_W];
        m_points <= s_b;
      end
    endcase

endmodule
`default_nettype wire
