// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_bv_lane_b: every plane of an axis and of a face diagonal is that of the formula (docs/hardware/image.md, "Box test") in whole numbers of 32
// bits, for every child, scale, cut exponent and slack; boxes may be inverted. The solver does not end for cube diagonals,
// sums of three corners and a cut: scripts/widths.py bounds them, and the unit test compares them.
module cchip_bv_lane_b_properties (
    input wire         clk,
    input wire [101:0] child,
    input wire [  2:0] scale,
    input wire         coarse,
    input wire [  7:0] slack
);
  wire [331:0] planes;
  cchip_bv_lane_b dut (
      .clk   (clk),
      .child (child),
      .scale (scale),
      .coarse(coarse),
      .slack (slack),
      .planes(planes)
  );

  // the child of five clocks ago and the slack of four
  reg [101:0] child1, child2, child3, child4, child5;
  reg [2:0] scale1, scale2, scale3, scale4, scale5;
  reg coarse1, coarse2, coarse3, coarse4, coarse5;
  reg [7:0] slack2, slack3, slack4, slack5;
  reg [2:0] clocks_q = 3'd0;
  always @(posedge clk) begin
    {child1, child2, child3, child4, child5} <= {child, child1, child2, child3, child4};
    {scale1, scale2, scale3, scale4, scale5} <= {scale, scale1, scale2, scale3, scale4};
    {coarse1, coarse2, coarse3, coarse4, coarse5} <= {coarse, coarse1, coarse2, coarse3, coarse4};
    {slack2, slack3, slack4, slack5} <= {slack, slack2, slack3, slack4};
    if (clocks_q != 3'd5) clocks_q <= clocks_q + 3'd1;
  end

  // directions: {negative, not zero} of x, y, z
  localparam [77:0] DIRECTIONS = {
    6'b01_01_11, 6'b01_11_01, 6'b11_01_01, 6'b01_01_01, 6'b11_01_00, 6'b01_01_00, 6'b11_00_01,
    6'b01_00_01, 6'b00_11_01, 6'b00_01_01, 6'b01_00_00, 6'b00_01_00, 6'b00_00_01
  };
  wire [12:0] right;
  genvar d, i;
  generate
    for (d = 0; d < 13; d = d + 1) begin : gen_direction
      wire signed [31:0] up[0:2], low[0:2];
      for (i = 0; i < 3; i = i + 1) begin : gen_axis
        wire [1:0] sign = DIRECTIONS[6*d+2*i+:2];
        wire signed [31:0] least = $signed(child5[14*i+:7]);
        wire signed [31:0] greatest = $signed(child5[14*i+7+:7]);
        wire signed [31:0] most = (scale5 == 3'd7 ? 32'sd0 : (greatest <<< 4) >>> scale5) + $signed({24'd0, slack5});
        wire signed [31:0] fewest = (scale5 == 3'd7 ? 32'sd0 : (least <<< 4) >>> scale5) - $signed({24'd0, slack5});
        assign up[i] = !sign[0] ? 32'sd0 : sign[1] ? -fewest : most;
        assign low[i] = !sign[0] ? 32'sd0 : sign[1] ? -most : fewest;
      end
      localparam integer W = d < 3 ? 12 : 13;
      localparam integer AT = d < 3 ? 24 * d : 72 + 26 * (d - 3);
      wire [31:0] cut_up, cut_low;
      if (d < 3) begin : gen_none
        assign cut_up = 32'd0;
        assign cut_low = 32'd0;
      end else begin : gen_cut
        // cut exponent and 1 more of a cube diagonal, 2 fraction bits, y = scale - 1
        wire [3:0] unit = 4'd2 + {3'd0, coarse5} + (d < 9 ? 4'd0 : 4'd1) + 4'd3 - {1'b0, scale5};
        assign cut_up = scale5 < 3'd3 ? {29'd0, child5[42+6*(d-3)+:3]} << unit : 32'd0;
        assign cut_low = scale5 < 3'd3 ? {29'd0, child5[45+6*(d-3)+:3]} << unit : 32'd0;
      end
      wire signed [31:0] upper = (up[0] + up[1] + up[2] - $signed(cut_up)) >>> 1;
      wire signed [31:0] lower = (low[0] + low[1] + low[2] + $signed(cut_low)) >>> 1;
      wire signed [31:0] got_upper = $signed(planes[AT+:W]);
      wire signed [31:0] got_lower = $signed(planes[AT+W+:W]);
      assign right[d] = got_upper == upper && got_lower == lower;
    end
  endgenerate
  always @(*) if (clocks_q == 3'd5) planes_right: assert (&right[8:0]);
endmodule
`default_nettype wire
