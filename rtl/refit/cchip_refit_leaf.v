// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_refit_leaf: position of a vertex of a leaf along a direction, rounded outward if the leaf
// is: a vertex of such a leaf is off by at most half a step on every axis (docs/hardware/image.md).
//   numbers      2^-48 of the object's unit, so nothing is lost: half a step of a quad of extent 0
//                is 1. An extent of at most 24 is the parent's promise
//   latency      6 clocks
//   throughput   a position per clock, each of any leaf
//   cuts         every path: each output is a flip-flop
//   reset        none
module cchip_refit_leaf (
    input  wire         clk,        // clock, rising edge
    input  wire [511:0] s_line,     // the leaf
    input  wire         s_quad,     // it is a quad
    input  wire [  2:0] s_vertex,   // number of the vertex
    input  wire [  5:0] s_axes,     // direction: axes {negated, used}, 3 bit each, x first
    output wire [ 51:0] m_least,    // least position, 2^-48
    output wire [ 51:0] m_greatest  // greatest position
);

  wire [359:0] points = s_line[`CCHIP_LEAF_LINE_POINTS];
  wire [71:0] origin = s_line[`CCHIP_LEAF_LINE_ORIGIN];
  wire [4:0] extent = s_line[`CCHIP_LEAF_LINE_EXTENT];
  wire rounded = s_line[`CCHIP_LEAF_LINE_ROUNDED];
  wire unused = &{1'b0, s_line};

  // ---- offsets of triangles get the 24 bits that those of quads have
  reg [59:0] triangle;
  reg [71:0] corner;
  always @* begin
    case (s_vertex)
      3'd0: triangle = points[0+:60];
      3'd1: triangle = points[60+:60];
      3'd2: triangle = points[120+:60];
      3'd3: triangle = points[180+:60];
      3'd4: triangle = points[240+:60];
      default: triangle = points[300+:60];
    endcase
    case (s_vertex[1:0])
      2'd0: corner = points[0+:72];
      2'd1: corner = points[72+:72];
      2'd2: corner = points[144+:72];
      default: corner = points[216+:72];
    endcase
  end

  reg [5:0] axes_q1, axes_q2, axes_q3;
  reg [4:0] shift_q;  // extent + 1: a step of a quad is 2^(extent + 1)
  reg [71:0] origin_q1, origin_q2;
  reg [5:0] margin_q1, margin_q2, margin_q3;  // {rounded, half a step is 2 to the power of this}
  wire [152:0] terms;  // along the direction, of each axis
  genvar i;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      reg signed [23:0] offset_q;
      reg signed [48:0] shifted_q;
      reg signed [49:0] position_q;
      wire signed [48:0] offset = {{25{offset_q[23]}}, offset_q};
      wire [49:0] from_centre = {{2{origin_q2[24*i+23]}}, origin_q2[24*i+:24], 24'd0};
      wire signed [50:0] position = {position_q[49], position_q};
      always @(posedge clk) begin
        offset_q   <= s_quad ? corner[24*i+:24] : {triangle[20*i+:20], 4'd0};
        shifted_q  <= offset <<< shift_q;
        position_q <= {shifted_q[48], shifted_q} + from_centre;
      end
      assign terms[51*i+:51] = !axes_q3[i] ? 51'd0 : axes_q3[3+i] ? -position : position;
    end
  endgenerate

  reg [51:0] xy_q, sum_q, least_q, greatest_q;
  reg [50:0] z_q;
  reg [1:0] weight_q;  // axes that are used
  reg [30:0] half_q, margin_q;
  always @(posedge clk) begin
    axes_q1    <= s_axes;
    axes_q2    <= axes_q1;
    axes_q3    <= axes_q2;
    shift_q    <= extent + 5'd1;
    origin_q1  <= origin;
    origin_q2  <= origin_q1;
    margin_q1  <= {rounded, s_quad ? extent : extent + 5'd4};
    margin_q2  <= margin_q1;
    margin_q3  <= margin_q2;
    half_q     <= margin_q3[5] ? 31'd1 << margin_q3[4:0] : 31'd0;
    xy_q       <= {terms[50], terms[0+:51]} + {terms[101], terms[51+:51]};
    z_q        <= terms[102+:51];
    weight_q   <= {1'b0, axes_q3[0]} + {1'b0, axes_q3[1]} + {1'b0, axes_q3[2]};
    sum_q      <= xy_q + {z_q[50], z_q};
    margin_q   <= (weight_q[0] ? half_q : 31'd0) + (weight_q[1] ? {half_q[29:0], 1'b0} : 31'd0);
    least_q    <= sum_q - {21'd0, margin_q};
    greatest_q <= sum_q + {21'd0, margin_q};
  end
  assign m_least = least_q;
  assign m_greatest = greatest_q;

endmodule
`default_nettype wire
