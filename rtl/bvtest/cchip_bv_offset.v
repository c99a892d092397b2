// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_bv_offset: places a node pair on its grid: where A's node lies from B's, and how the steps
// of the two relate.
//   rule         the grid's step is A's unless B's is much coarser; one slack covers all roundings
//   numbers      offset M o_A + t - o_B in half steps of the grid, 6 fraction bits, rounded down
//   latency      5 clocks from start to the scales, 9 to the slack, 12 to offset, is_far, is_near;
//                each stays until that of the next node pair comes
//   throughput   a node pair every third clock; origins stay for the three clocks from start on
//   cuts         every path
//   reset        none: a start that is not used does no harm
// Bit for bit model::grid_of (docs/hardware/image.md, "Box test").
//   timing       Clocks count from start. Origins stay for the three clocks from start on, in which
//                the rows of M and t come one after the other; steps, shift and epsilon come with
//                start. Each output stays from its clock on until that of the next node pair.
//                cchip_bv_pose gives the rows.
//   numbers      The shifts are split. With s the lesser of the grid's step and 7, M o_A is shifted
//                down and t - o_B up to 2^(s - 31), and their sum down to the grid. Floors of
//                floors are the floor.
//   inside       Three cchip_mul18, one axis after the other. An entry of M that is 1 is treated as
//                in cchip_bv_lane_a.
//   why          The lanes take a child on every clock, so a node pair has four clocks and one set
//                of multipliers serves the three axes. Shifted as it is, no sum is wider than 39
//                bits for any units of the two objects.
module cchip_bv_offset (
    input  wire         clk,       // clock, rising edge
    input  wire         start,     // a node pair; at the earliest 3 clocks after the last one
    input  wire [ 53:0] a_origin,  // origin of A's node, 2^-18
    input  wire [  4:0] a_step,    // its step is 2^(a_step - 24)
    input  wire [ 53:0] b_origin,  // origin of B's node
    input  wire [  4:0] b_step,    // its step
    input  wire [ 56:0] row_m,     // a row of M, 17 fraction bits: row 0 with start, then 1 and 2
    input  wire [ 28:0] row_t,     // t of the same axis, 24 fraction bits
    input  wire [  3:0] shift,     // of the query: A's unit is 2^-shift of B's
    input  wire [  6:0] epsilon,   // bound on the error of a position that M and t give, 2^-24
    // from clock 5: logarithm to base 4 of the grid's step in steps of A, 0..2; 3: A's boxes count
    // as points
    output wire [  1:0] a_scale,
    // from clock 5: logarithm to base 2 of the grid's step in half steps of B, 0..6; 7: B's boxes
    // count as points
    output wire [  2:0] b_scale,
    output wire [  7:0] slack,     // from clock 9: slack, quarters of a half step
    // from clock 12: M o_A + t - o_B, half steps of the grid, 6 fraction bits
    output wire [ 50:0] offset,
    // from clock 12: the offset does not fit in its 17 bits, every child is separated
    output wire         is_far,
    // from clock 12: the slack does not fit in 8 bits, nothing is separated
    output wire         is_near
);

  // The clocks below are counted for a leaf of two.
  `CCHIP_REFUSE(`CCHIP_MUL18_LATENCY != 2, cchip_error_bv_offset_needs_CCHIP_MUL18_LATENCY_2)

  // ---- clocks 0 to 4: e = log2 (B's step / A's), scales, and the grid's step, -1..18
  reg start_q1, start_q2, start_q3;
  reg signed [6:0] e_q1;
  reg [4:0] b_step_q1, b_step_q2;
  reg [3:0] shift_q1, shift_q2;
  reg [6:0] epsilon_q1, epsilon_q2;
  wire a_point = e_q1 > 7'sd5;
  wire b_point = e_q1 < -7'sd5;
  wire signed [6:0] least_y = e_q1[0] ? -7'sd1 : 7'sd0;  // for e >= 1
  wire signed [6:0] y = a_point ? -7'sd1 : e_q1 < 7'sd1 ? -e_q1 : least_y;
  reg [1:0] a_scale_q2, a_scale_q3, a_scale_q4, a_scale_q5;
  reg [2:0] b_scale_q2, b_scale_q3, b_scale_q4, b_scale_q5;
  reg signed [6:0] y_q2, step_q3;
  reg [5:0] a_more_q2, a_more_q3;  // slack for a box that counts as a point
  reg [3:0] b_more_q2, b_more_q3;
  reg [3:0] shift_q3;
  reg [16:0] x_q3;  // 1024 epsilon - 1
  // of the node pair from its fourth clock on
  reg [3:0] low_q4;  // least of step and 7, plus 1
  reg [3:0] high_q4, high_q5, high_q6, high_q7;  // step - 7, at least 0
  reg [1:0] high_q8;
  reg [4:0] amount_q4;
  reg [4:0] g_q4;
  reg [16:0] x_q4;
  reg [5:0] a_more_q4;
  reg [3:0] b_more_q4;
  wire signed [6:0] above = step_q3 - 7'sd7;
  wire signed [6:0] next = step_q3 + 7'sd1;
  wire [3:0] low = above[6] ? next[3:0] : 4'd8;
  always @(posedge clk) begin
    start_q1   <= start;
    start_q2   <= start_q1;
    start_q3   <= start_q2;
    e_q1       <= $signed({2'd0, b_step}) - $signed({2'd0, a_step}) + $signed({3'd0, shift});
    b_step_q1  <= b_step;
    b_step_q2  <= b_step_q1;
    shift_q1   <= shift;
    shift_q2   <= shift_q1;
    shift_q3   <= shift_q2;
    epsilon_q1 <= epsilon;
    epsilon_q2 <= epsilon_q1;
    a_scale_q2 <= a_point ? 2'd3 : e_q1 < 7'sd2 ? 2'd0 : e_q1 < 7'sd4 ? 2'd1 : 2'd2;
    b_scale_q2 <= b_point ? 3'd7 : y[2:0] + 3'd1;
    y_q2       <= y;
    a_more_q2  <= !a_point ? 6'd0 : e_q1 > 7'sd10 ? 6'd1 : 6'd32 >> (e_q1[3:0] - 4'd6);
    b_more_q2  <= !b_point ? 4'd0 : e_q1 < -7'sd8 ? 4'd1 : 4'd8 >> (y[3:0] - 4'd6);
    step_q3    <= $signed({2'd0, b_step_q2}) + y_q2;
    a_scale_q3 <= a_scale_q2;
    b_scale_q3 <= b_scale_q2;
    a_more_q3  <= a_more_q2;
    b_more_q3  <= b_more_q2;
    x_q3       <= {epsilon_q2, 10'd0} - 17'd1;
    if (start_q3) begin
      a_scale_q4 <= a_scale_q3;
      b_scale_q4 <= b_scale_q3;
      low_q4     <= low;
      high_q4    <= above[6] ? 4'd0 : above[3:0];
      amount_q4  <= {1'b0, shift_q3} + {1'b0, low} + 5'd3;
      g_q4       <= next[4:0];
      x_q4       <= x_q3;
      a_more_q4  <= a_more_q3;
      b_more_q4  <= b_more_q3;
    end
    a_scale_q5 <= a_scale_q4;
    b_scale_q5 <= b_scale_q4;
  end
  assign a_scale = a_scale_q5;
  assign b_scale = b_scale_q5;

  // ---- clocks 4 to 8: the slack, 1 + (x / 2^(g + 5) + 1) / 2 and what points need
  reg [11:0] x_q5;
  reg [11:0] base_q6;
  reg [5:0] a_more_q5, a_more_q6;
  reg [3:0] b_more_q5, b_more_q6, b_more_q7;
  reg [12:0] slack_q7, slack_q8;
  reg [7:0] slack_q9;
  reg near_q9, near_q10, near_q11, near_q12;
  always @(posedge clk) begin
    x_q5      <= x_q4[16:5] >> g_q4;
    a_more_q5 <= a_more_q4;
    b_more_q5 <= b_more_q4;
    base_q6   <= {1'b0, x_q5[11:1]} + {11'd0, x_q5[0]};
    a_more_q6 <= a_more_q5;
    b_more_q6 <= b_more_q5;
    slack_q7  <= {1'b0, base_q6} + {7'd0, a_more_q6} + 13'd1;
    b_more_q7 <= b_more_q6;
    slack_q8  <= slack_q7 + {9'd0, b_more_q7};
    slack_q9  <= slack_q8[7:0] & {8{slack_q8[12:8] == 5'd0}};
    near_q9   <= slack_q8[12:8] != 5'd0;
    near_q10  <= near_q9;
    near_q11  <= near_q10;
    near_q12  <= near_q11;
  end
  assign slack = slack_q9;
  assign is_near = near_q12;

  // ---- the offset, one axis after the other: M o_A
  wire [17:0] origin = start ? b_origin[17:0] : start_q1 ? b_origin[35:18] : b_origin[53:36];
  wire signed [36:0] term2[0:2];  // 35 fraction bits
  wire [17:0] again2[0:2];
  genvar j;
  generate
    for (j = 0; j < 3; j = j + 1) begin : gen_term
      wire [18:0] m = row_m[19*j+:19];
      wire signed [35:0] p;
      // M_ij = 1 has no place in 18 bits and is taken for -1: 2^18 times the origin is added again.
      // That is at most one of a row, whose magnitudes add up to less than 2
      reg one_q1;
      reg [17:0] origin_q1, again_q2;
      always @(posedge clk) begin
        one_q1    <= ~m[18] & m[17];
        origin_q1 <= a_origin[18*j+:18];
        again_q2  <= origin_q1 & {18{one_q1}};
      end
      assign again2[j] = again_q2;
      cchip_mul18 u_mul (.clk(clk), .a(m[17:0]), .b(a_origin[18*j+:18]), .p(p));
      assign term2[j] = {p[35], p};
    end
  endgenerate
  wire [17:0] again = again2[0] | again2[1] | again2[2];
  reg signed [38:0] first_q3, rest_q3, turned_q4;
  reg signed [29:0] between_q1, between_q2, between_q3, between_q4;  // t - o_B, 24 fraction bits

  // ---- clocks 4 to 9: to the grid. With s = least of step and 7: both to 2^(s - 31), then to the
  // grid's half steps
  reg signed [38:0] turned_q5, turned_q6;
  reg signed [37:0] between_q5, between_q6;
  reg signed [38:0] sum_q7;
  wire signed [38:0] shifted = sum_q7 >>> {high_q7[3:2], 2'd0};
  wire [3:0] alike = {
    sum_q7[37:31] == {7{sum_q7[38]}},
    sum_q7[30:27] == {4{sum_q7[38]}},
    sum_q7[26:23] == {4{sum_q7[38]}},
    sum_q7[22:19] == {4{sum_q7[38]}}
  };
  reg [19:0] sum_q8;
  reg narrow_q8;  // the bits above those of sum_q8 are like its highest
  reg [2:0] fine_q5;
  reg [16:0] axis_q9;
  reg far_q9;
  always @(posedge clk) begin
    first_q3 <= {{2{term2[0][36]}}, term2[0]} + {{2{term2[1][36]}}, term2[1]};
    rest_q3 <= {
      {{2{term2[2][36]}}, term2[2][36:18]} + {{3{again[17]}}, again}, term2[2][17:0]
    };
    turned_q4 <= first_q3 + rest_q3;
    between_q1 <= {row_t[28], row_t} - {{6{origin[17]}}, origin, 6'd0};
    between_q2 <= between_q1;
    between_q3 <= between_q2;
    between_q4 <= between_q3;
    // turned >> (shift + 4 + s), by eights and by ones
    turned_q5 <= turned_q4 >>> {amount_q4[4:3], 3'd0};
    fine_q5 <= amount_q4[2:0];
    turned_q6 <= turned_q5 >>> fine_q5;
    // between << (7 - s)
    between_q5 <= {{8{between_q4[29]}}, between_q4} <<< (4'd8 - low_q4);
    between_q6 <= between_q5;
    sum_q7 <= turned_q6 + $signed({between_q6[37], between_q6});
    high_q5 <= high_q4;
    high_q6 <= high_q5;
    high_q7 <= high_q6;
    high_q8 <= high_q7[1:0];
    sum_q8 <= shifted[19:0];
    narrow_q8 <= alike[3] && (alike[2] || high_q7[3:2] == 2'd3) && (alike[1] || high_q7[3]) &&
        (alike[0] || high_q7[3:2] != 2'd0);
    {far_q9, axis_q9} <= to_grid(narrow_q8, sum_q8, high_q8);
  end
  function [17:0] to_grid(input narrow, input [19:0] sum, input [1:0] by);
    reg fits;
    begin
      fits = narrow && (by == 2'd3 || sum[18] == sum[19]) && (by[1] || sum[17] == sum[19]) &&
          (by != 2'd0 || sum[16] == sum[19]);
      to_grid = {!fits, sum[16:0]};
      if (by == 2'd1) to_grid[16:0] = sum[17:1];
      if (by == 2'd2) to_grid[16:0] = sum[18:2];
      if (by == 2'd3) to_grid[16:0] = sum[19:3];
    end
  endfunction

  // ---- clocks 9 to 11: the three axes together
  reg start_q4, start_q5, start_q6, start_q7, start_q8, start_q9, start_q10, start_q11;
  reg [16:0] axis_q10, axis_q11;
  reg far_q10, far_q11, far_q12;
  reg [50:0] offset_q12;
  always @(posedge clk) begin
    {start_q4, start_q5, start_q6, start_q7, start_q8, start_q9, start_q10, start_q11} <= {
      start_q3, start_q4, start_q5, start_q6, start_q7, start_q8, start_q9, start_q10
    };
    axis_q10 <= axis_q9;
    axis_q11 <= axis_q10;
    far_q10  <= far_q9;
    far_q11  <= far_q10;
    if (start_q11) begin
      offset_q12 <= {axis_q9, axis_q10, axis_q11};
      far_q12    <= far_q9 | far_q10 | far_q11;
    end
  end
  assign offset = offset_q12;
  assign is_far = far_q12;

  wire unused = &{1'b0, y[6:4], above[5:4], next[6:5], x_q4[4:0], shifted[38:20]};

endmodule
`default_nettype wire
