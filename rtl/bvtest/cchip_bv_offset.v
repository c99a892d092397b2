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
  reg [11:1] start_q;
  reg signed [6:0] e_q1;
  wire [4:0] b_step_q2;
  wire [3:0] shift_q3;
  wire [6:0] epsilon_q2;
  wire a_point = e_q1 > 7'sd5;
  wire b_point = e_q1 < -7'sd5;
  wire signed [6:0] least_over_b = e_q1[0] ? -7'sd1 : 7'sd0;  // for e >= 1
  // logarithm to base 2 of the grid's step in steps of B
  wire signed [6:0] over_b = a_point ? -7'sd1 : e_q1 < 7'sd1 ? -e_q1 : least_over_b;
  reg [1:0] a_scale_q2, a_scale_q3, a_scale_q4, a_scale_q5;
  reg [2:0] b_scale_q2, b_scale_q3, b_scale_q4, b_scale_q5;
  reg signed [6:0] over_b_q2, step_q3;
  reg [5:0] a_more_q2, a_more_q3;  // slack for a box that counts as a point
  reg [3:0] b_more_q2, b_more_q3;
  reg [16:0] error_q3;  // 1024 epsilon - 1
  // of the node pair from its fourth clock on
  reg [3:0] least_1_q4;  // least of step and 7, plus 1
  reg [3:0] high_q4;  // step - 7, at least 0
  wire [3:0] high_q7;
  reg [1:0] high_q8;
  reg [4:0] amount_q4;
  reg [4:0] step_1_q4;
  reg [16:0] error_q4;
  reg [5:0] a_more_q4;
  reg [3:0] b_more_q4;
  wire signed [6:0] over_7 = step_q3 - 7'sd7;
  wire signed [6:0] step_1 = step_q3 + 7'sd1;
  wire [3:0] least_1 = over_7[6] ? step_1[3:0] : 4'd8;
  cchip_delay #(.WIDTH(5), .DEPTH(2)) u_b_step (.clk(clk), .rst(1'b0), .d(b_step), .q(b_step_q2));
  cchip_delay #(.WIDTH(4), .DEPTH(3)) u_shift (.clk(clk), .rst(1'b0), .d(shift), .q(shift_q3));
  cchip_delay #(.WIDTH(7), .DEPTH(2)) u_error (.clk(clk), .rst(1'b0), .d(epsilon), .q(epsilon_q2));
  always @(posedge clk) begin
    start_q    <= {start_q[10:1], start};
    e_q1       <= $signed({2'd0, b_step}) - $signed({2'd0, a_step}) + $signed({3'd0, shift});
    a_scale_q2 <= a_point ? 2'd3 : e_q1 < 7'sd2 ? 2'd0 : e_q1 < 7'sd4 ? 2'd1 : 2'd2;
    b_scale_q2 <= b_point ? 3'd7 : over_b[2:0] + 3'd1;
    over_b_q2  <= over_b;
    a_more_q2  <= !a_point ? 6'd0 : e_q1 > 7'sd10 ? 6'd1 : 6'd32 >> (e_q1[3:0] - 4'd6);
    b_more_q2  <= !b_point ? 4'd0 : e_q1 < -7'sd8 ? 4'd1 : 4'd8 >> (over_b[3:0] - 4'd6);
    step_q3    <= $signed({2'd0, b_step_q2}) + over_b_q2;
    a_scale_q3 <= a_scale_q2;
    b_scale_q3 <= b_scale_q2;
    a_more_q3  <= a_more_q2;
    b_more_q3  <= b_more_q2;
    error_q3   <= {epsilon_q2, 10'd0} - 17'd1;
    if (start_q[3]) begin
      a_scale_q4 <= a_scale_q3;
      b_scale_q4 <= b_scale_q3;
      least_1_q4 <= least_1;
      high_q4    <= over_7[6] ? 4'd0 : over_7[3:0];
      amount_q4  <= {1'b0, shift_q3} + {1'b0, least_1} + 5'd3;
      step_1_q4  <= step_1[4:0];
      error_q4   <= error_q3;
      a_more_q4  <= a_more_q3;
      b_more_q4  <= b_more_q3;
    end
    a_scale_q5 <= a_scale_q4;
    b_scale_q5 <= b_scale_q4;
  end
  assign a_scale = a_scale_q5;
  assign b_scale = b_scale_q5;

  // ---- clocks 4 to 8: the slack, 1 + (error / 2^(step + 6) + 1) / 2 and what points need
  reg [11:0] error_q5;
  reg [11:0] base_q6;
  wire [5:0] a_more_q6;
  wire [3:0] b_more_q7;
  cchip_delay #(.WIDTH(6), .DEPTH(2)) u_a (.clk(clk), .rst(1'b0), .d(a_more_q4), .q(a_more_q6));
  cchip_delay #(.WIDTH(4), .DEPTH(3)) u_b (.clk(clk), .rst(1'b0), .d(b_more_q4), .q(b_more_q7));
  reg [12:0] slack_q7, slack_q8;
  reg [7:0] slack_q9;
  reg near_q9;
  always @(posedge clk) begin
    error_q5 <= error_q4[16:5] >> step_1_q4;
    base_q6  <= {1'b0, error_q5[11:1]} + {11'd0, error_q5[0]};
    slack_q7 <= {1'b0, base_q6} + {7'd0, a_more_q6} + 13'd1;
    slack_q8 <= slack_q7 + {9'd0, b_more_q7};
    slack_q9 <= slack_q8[7:0] & {8{slack_q8[12:8] == 5'd0}};
    near_q9  <= slack_q8[12:8] != 5'd0;
  end
  cchip_delay #(.DEPTH(3)) u_near (.clk(clk), .rst(1'b0), .d(near_q9), .q(is_near));
  assign slack = slack_q9;

  // ---- the offset, one axis after the other: M o_A
  wire [17:0] origin = start ? b_origin[17:0] : start_q[1] ? b_origin[35:18] : b_origin[53:36];
  wire signed [36:0] term2[0:2];  // 35 fraction bits
  wire [17:0] origin_of_one[0:2];
  genvar j;
  generate
    for (j = 0; j < 3; j = j + 1) begin : gen_term
      wire [18:0] m = row_m[19*j+:19];
      wire signed [35:0] p;
      // M_ij = 1 has no place in 18 bits and is taken for -1: 2^18 times the origin is added again.
      // That is at most one of a row, whose magnitudes add up to less than 2
      reg one_q1;
      reg [17:0] origin_q1, added_q2;
      always @(posedge clk) begin
        one_q1    <= ~m[18] & m[17];
        origin_q1 <= a_origin[18*j+:18];
        added_q2  <= origin_q1 & {18{one_q1}};
      end
      assign origin_of_one[j] = added_q2;
      cchip_mul18 u_mul (.clk(clk), .a(m[17:0]), .b(a_origin[18*j+:18]), .p(p));
      assign term2[j] = {p[35], p};
    end
  endgenerate
  wire [17:0] added = origin_of_one[0] | origin_of_one[1] | origin_of_one[2];
  reg signed [38:0] first_q3, rest_q3, turned_q4;
  reg signed [29:0] from_b_q1;  // t - o_B, 24 fraction bits
  wire signed [29:0] from_b_q4;
  cchip_delay #(.WIDTH(30), .DEPTH(3)) u_t (.clk(clk), .rst(1'b0), .d(from_b_q1), .q(from_b_q4));
  cchip_delay #(.WIDTH(4), .DEPTH(3)) u_high (.clk(clk), .rst(1'b0), .d(high_q4), .q(high_q7));

  // ---- clocks 4 to 9: to the grid. With s = least of step and 7: both to 2^(s - 31), then to the
  // grid's half steps
  reg signed [38:0] turned_q5, turned_q6;
  reg signed [37:0] from_b_q5, from_b_q6;
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
      {{2{term2[2][36]}}, term2[2][36:18]} + {{3{added[17]}}, added}, term2[2][17:0]
    };
    turned_q4 <= first_q3 + rest_q3;
    from_b_q1 <= {row_t[28], row_t} - {{6{origin[17]}}, origin, 6'd0};
    // turned >> (shift + 4 + s), by eights and by ones
    turned_q5 <= turned_q4 >>> {amount_q4[4:3], 3'd0};
    fine_q5 <= amount_q4[2:0];
    turned_q6 <= turned_q5 >>> fine_q5;
    // from_b << (7 - s)
    from_b_q5 <= {{8{from_b_q4[29]}}, from_b_q4} <<< (4'd8 - least_1_q4);
    from_b_q6 <= from_b_q5;
    sum_q7 <= turned_q6 + $signed({from_b_q6[37], from_b_q6});
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
  reg [16:0] axis_q10, axis_q11;
  reg far_q10, far_q11, far_q12;
  reg [50:0] offset_q12;
  always @(posedge clk) begin
    axis_q10 <= axis_q9;
    axis_q11 <= axis_q10;
    far_q10  <= far_q9;
    far_q11  <= far_q10;
    if (start_q[11]) begin
      offset_q12 <= {axis_q9, axis_q10, axis_q11};
      far_q12    <= far_q9 | far_q10 | far_q11;
    end
  end
  assign offset = offset_q12;
  assign is_far = far_q12;

  wire unused = &{1'b0, over_b[6:4], over_7[5:4], step_1[6:5], error_q4[4:0], shifted[38:20]};

endmodule
`default_nettype wire
