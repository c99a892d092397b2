// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_bv_lane_b: planes of one child of a node of B, in its own 13 directions, on the grid of the
// node pair.
//   rule         a plane of a direction is the sum of the box corners on that side less a cut; the
//                slack of the node pair moves each corner outward first
//   numbers      half steps of the grid, rounded down, with 2 fraction bits, of which 1 leaves
//   latency      5 clocks from child
//   throughput   a child on every clock
//   reset        none
// Bit for bit model::planes_of_b (docs/hardware/image.md, "Box test").
//   numbers      The widths hold every sum. Cuts count up to scale 2.
//   inside       Shifters for the six corners, 4 + 2 adders a face diagonal, 2 + 2 a cube diagonal.
//                No multiplier.
//   why          The slack is added to the corners: a sum over two or three of them then has two or
//                three times the slack, as it must.
module cchip_bv_lane_b (
    input  wire         clk,     // clock, rising edge
    // ---- clock 0
    input  wire [101:0] child,   // volume of the child as its node stores it
    // clock 0: logarithm to base 2 of the grid's step in half steps of B, 0..6; 7: the box counts
    // as a point
    input  wire [  2:0] scale,
    input  wire         coarse,  // clock 0: the node's cut exponent is 3 instead of 2
    input  wire [  7:0] slack,   // clock 1: slack of the node pair, quarters of a half step
    // clock 5: planes of 3 axes, 24 bits each, then of 10 diagonals, 26 bits each: {lower, upper};
    // directions in the order of image.md, docs/hardware/image.md
    output wire [331:0] planes
);

  // ---- clock 0: corners on the grid, and cuts by their exponent. Cuts count up to scale 2
  wire signed [11:0] least2[0:2], greatest2[0:2];
  reg [59:0] cuts_q1;
  reg [1:0] exponent_q1;  // of a face cut: 3 more, half steps with 2 fraction bits
  always @(posedge clk) begin
    cuts_q1     <= child[101:42] & {60{scale < 3'd3}};
    exponent_q1 <= {1'b0, coarse} + 2'd2 - scale[1:0];
  end
  genvar i, s;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      wire signed [10:0] least = {child[14*i+:7], 4'd0};
      wire signed [10:0] greatest = {child[14*i+7+:7], 4'd0};
      reg signed [10:0] least_q1, greatest_q1;
      reg signed [11:0] least_q2, greatest_q2;
      assign least2[i] = least_q2;
      assign greatest2[i] = greatest_q2;
      always @(posedge clk) begin
        least_q1 <= scale == 3'd7 ? 11'sd0 : least >>> scale;
        greatest_q1 <= scale == 3'd7 ? 11'sd0 : greatest >>> scale;
        least_q2 <= {least_q1[10], least_q1} - {4'd0, slack};
        greatest_q2 <= {greatest_q1[10], greatest_q1} + {4'd0, slack};
      end
    end
  endgenerate

  // ---- clock 2: face diagonals, clock 3: cube diagonals, from {upper, lower} of their parts
  function signed [13:0] widen(input signed [11:0] value);
    widen = {{2{value[11]}}, value};
  endfunction
  reg signed [13:0] upper0_q3, upper1_q3, upper2_q3, upper3_q3, upper4_q3, upper5_q3;
  reg signed [13:0] lower0_q3, lower1_q3, lower2_q3, lower3_q3, lower4_q3, lower5_q3;
  reg signed [13:0] upper0_q4, upper1_q4, upper2_q4, upper3_q4;
  reg signed [13:0] lower0_q4, lower1_q4, lower2_q4, lower3_q4;
  wire signed [13:0] upper3[0:5], lower3[0:5], upper4[0:3], lower4[0:3];
  wire signed [13:0] least3[0:2], greatest3[0:2];
  assign upper3[0] = upper0_q3;
  assign lower3[0] = lower0_q3;
  assign upper3[1] = upper1_q3;
  assign lower3[1] = lower1_q3;
  assign upper3[2] = upper2_q3;
  assign lower3[2] = lower2_q3;
  assign upper3[3] = upper3_q3;
  assign lower3[3] = lower3_q3;
  assign upper3[4] = upper4_q3;
  assign lower3[4] = lower4_q3;
  assign upper3[5] = upper5_q3;
  assign lower3[5] = lower5_q3;
  assign upper4[0] = upper0_q4;
  assign lower4[0] = lower0_q4;
  assign upper4[1] = upper1_q4;
  assign lower4[1] = lower1_q4;
  assign upper4[2] = upper2_q4;
  assign lower4[2] = lower2_q4;
  assign upper4[3] = upper3_q4;
  assign lower4[3] = lower3_q4;
  always @(posedge clk) begin
    upper0_q3 <= widen(greatest2[0]) + widen(greatest2[1]);
    lower0_q3 <= widen(least2[0]) + widen(least2[1]);
    upper1_q3 <= widen(greatest2[0]) - widen(least2[1]);
    lower1_q3 <= widen(least2[0]) - widen(greatest2[1]);
    upper2_q3 <= widen(greatest2[0]) + widen(greatest2[2]);
    lower2_q3 <= widen(least2[0]) + widen(least2[2]);
    upper3_q3 <= widen(greatest2[0]) - widen(least2[2]);
    lower3_q3 <= widen(least2[0]) - widen(greatest2[2]);
    upper4_q3 <= widen(greatest2[1]) + widen(greatest2[2]);
    lower4_q3 <= widen(least2[1]) + widen(least2[2]);
    upper5_q3 <= widen(greatest2[1]) - widen(least2[2]);
    lower5_q3 <= widen(least2[1]) - widen(greatest2[2]);
    upper0_q4 <= upper0_q3 + greatest3[2];
    lower0_q4 <= lower0_q3 + least3[2];
    upper1_q4 <= upper0_q3 - least3[2];
    lower1_q4 <= lower0_q3 - greatest3[2];
    upper2_q4 <= upper1_q3 + greatest3[2];
    lower2_q4 <= lower1_q3 + least3[2];
    upper3_q4 <= greatest3[2] - lower1_q3;
    lower3_q4 <= least3[2] - upper1_q3;
  end

  // ---- cuts off, and each plane at clock 5
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_out_axis
      reg signed [13:0] least_q3, greatest_q3;
      reg [11:0] upper_q4a, upper_q5, lower_q4a, lower_q5;
      assign least3[i] = least_q3;
      assign greatest3[i] = greatest_q3;
      always @(posedge clk) begin
        greatest_q3 <= widen(greatest2[i]);
        least_q3 <= widen(least2[i]);
        upper_q4a <= greatest_q3[12:1];
        lower_q4a <= least_q3[12:1];
        upper_q5       <= upper_q4a;
        lower_q5       <= lower_q4a;
      end
      assign planes[24*i+:24] = {lower_q5, upper_q5};
    end
    for (i = 0; i < 10; i = i + 1) begin : gen_diagonal
      wire [5:0] cut[0:1];  // upper, lower; half steps
      for (s = 0; s < 2; s = s + 1) begin : gen_cut
        reg [5:0] cut_q2, cut_q3;
        always @(posedge clk) begin
          cut_q2 <= {3'd0, cuts_q1[6*i+3*s+:3]} << exponent_q1;
          cut_q3 <= cut_q2;
        end
        assign cut[s] = cut_q3;
      end
      reg [12:0] upper_q5, lower_q5;
      if (i < 6) begin : gen_face
        wire [13:0] upper = {upper3[i][13:3] - {5'd0, cut[0]}, upper3[i][2:0]};
        wire [13:0] lower = {lower3[i][13:3] + {5'd0, cut[1]}, lower3[i][2:0]};
        reg [12:0] upper_q4f, lower_q4f;
        always @(posedge clk) begin
          upper_q4f <= upper[13:1];
          lower_q4f <= lower[13:1];
          upper_q5  <= upper_q4f;
          lower_q5  <= lower_q4f;
        end
        wire unused = &{1'b0, upper[0], lower[0]};
      end else begin : gen_corner
        reg [5:0] upper_cut_q4, lower_cut_q4;
        wire [13:0] upper = {upper4[i-6][13:4] - {4'd0, upper_cut_q4}, upper4[i-6][3:0]};
        wire [13:0] lower = {lower4[i-6][13:4] + {4'd0, lower_cut_q4}, lower4[i-6][3:0]};
        always @(posedge clk) begin
          upper_cut_q4 <= cut[0];
          lower_cut_q4 <= cut[1];
          upper_q5     <= upper[13:1];
          lower_q5     <= lower[13:1];
        end
        wire unused = &{1'b0, upper[0], lower[0]};
      end
      assign planes[72+26*i+:26] = {lower_q5, upper_q5};
    end
  endgenerate

endmodule
`default_nettype wire
