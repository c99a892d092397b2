// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_pose_setup: what the box test needs of a query's pose: M rounded, and of each direction d
// of B, seen from A as m = M^T d, the coefficients of m = (a - b) axis + (b - c) face + c corner,
// with |m_j| sorted a >= b >= c.
//   latency      1 clock from start to pose_m, pose_t and epsilon, which stay until the clock on
//                which s_ready is 1 again; 7 clocks to the first direction
//   throughput   a direction on every clock, a query every 13 clocks
//   numbers      |m| up to 9 fraction bits; b - c and c down to 6 and 7, at most 127
//   reset        drops the query in flight
// Bit for bit model::set_up (docs/hardware/image.md).
//   about        M rounded, and how each direction of B splits into directions of A.
//   timing       A query every 13 clocks. pose_m, pose_t and epsilon from the clock after the query
//                was taken to the one on which s_ready is 1 again; the first direction 7 clocks
//                after it, then one on every clock. Nothing waits for a receiver.
//   numbers      Of equal magnitudes the first one counts as the greater. Queries as a descriptor
//                may hold them: |m| below 2, b + c at most 2 + 2^-5 (docs/hardware/image.md).
//   inside       Three sums of three, three comparisons of two magnitudes, selection.
//   why          The face diagonal is that of the two greater components with their signs, the cube
//                diagonal that of all three. So the split needs no search, and nothing of it is the
//                host's work.
module cchip_pose_setup (
    input  wire         clk,          // clock, rising edge
    input  wire         rst,          // synchronous reset, active high
    input  wire         s_valid,      // a query
    output wire         s_ready,      // it is taken
    input  wire [287:0] s_m,          // M, 30 fraction bits, row by row; magnitudes at most 1
    input  wire [107:0] s_t,          // t, 32 fraction bits
    input  wire [  3:0] s_shift,      // the map is M 2^-shift
    // bound on the error of a position that the query's map gives, 2^-38
    input  wire [ 11:0] s_error,
    // ---- its pose
    output wire [170:0] pose_m,       // M, row by row, 17 fraction bits
    output wire [ 86:0] pose_t,       // t, 24 fraction bits
    // bound on the error of a position that pose_m and pose_t give, 2^-24
    output wire [  6:0] epsilon,
    // ---- one direction after the other
    output wire         m_valid,      // a direction
    // its number, 0..12, in the order of image.md, docs/hardware/image.md
    output wire [  3:0] m_direction,
    // {corner reversed, corner, face reversed, face} as cchip_bv_lane_a takes them
    output wire [  6:0] m_select,
    output wire [ 29:0] m_magnitude,  // magnitudes of m, 9 fraction bits
    output wire [ 13:0] m_factor      // {c, 7 fraction bits; b - c, 6 fraction bits}
);

  // Components of the directions, {negative, not zero} each, component 0 in the lowest bits
  localparam [77:0] DIRECTIONS = {
    6'b01_01_11,
    6'b01_11_01,
    6'b11_01_01,
    6'b01_01_01,
    6'b11_01_00,
    6'b01_01_00,
    6'b11_00_01,
    6'b01_00_01,
    6'b00_11_01,
    6'b00_01_01,
    6'b01_00_00,
    6'b00_01_00,
    6'b00_00_01
  };
  localparam [3:0] LAST = 4'd12;

  // ---- clock 0: rounded to nearest
  reg [170:0] pose_m_q;
  reg [86:0] pose_t_q;
  reg [6:0] epsilon_q;
  reg busy_q;
  reg [3:0] direction_q;
  reg [77:0] left_q;  // the directions from this one on
  wire last = direction_q == LAST;
  wire start = s_valid & s_ready;
  // What is taken counts only with busy_q. So the condition of the pose's registers is this one
  // alone, whether a query comes or not.
  reg ready_q;
  assign s_ready = ready_q;
  wire [20:0] of_m = 21'h180000 >> s_shift;
  wire [21:0] error = {1'b0, of_m} + {10'd0, s_error} + 22'd24575;  // with t's 2^13 and rounding up
  genvar i, j;
  generate
    for (i = 0; i < 9; i = i + 1) begin : gen_m
      wire [31:0] sum = s_m[32*i+:32] + 32'd4096;
      always @(posedge clk) if (ready_q) pose_m_q[19*i+:19] <= sum[31:13];
      wire unused_low = &{1'b0, sum[12:0]};
    end
    for (i = 0; i < 3; i = i + 1) begin : gen_t
      wire [36:0] sum = {s_t[36*i+35], s_t[36*i+:36]} + 37'd128;
      always @(posedge clk) if (ready_q) pose_t_q[29*i+:29] <= sum[36:8];
      wire unused_low = &{1'b0, sum[7:0]};
    end
  endgenerate
  always @(posedge clk) begin
    if (ready_q) epsilon_q <= error[20:14];
    direction_q <= ready_q ? 4'd0 : direction_q + 4'd1;
    left_q <= ready_q ? DIRECTIONS : left_q >> 6;
    if (rst) begin
      busy_q  <= 1'b0;
      ready_q <= 1'b0;
    end else begin
      busy_q  <= start | (busy_q & ~last);
      // ready on the clock of the last direction
      ready_q <= start ? 1'b0 : ~busy_q | last | direction_q == LAST - 4'd1;
    end
  end
  assign pose_m  = pose_m_q;
  assign pose_t  = pose_t_q;
  assign epsilon = epsilon_q;

  // ---- clocks 1 to 3: m, then its magnitudes and signs
  wire [17:0] size4[0:2];
  reg [2:0] negative_q4;
  generate
    for (j = 0; j < 3; j = j + 1) begin : gen_component
      wire [56:0] column = {
        pose_m_q[19*(6+j)+:19], pose_m_q[19*(3+j)+:19], pose_m_q[19*j+:19]
      };
      wire [20:0] term[0:2];
      for (i = 0; i < 3; i = i + 1) begin : gen_term
        wire [20:0] entry = {{2{column[19*i+18]}}, column[19*i+:19]};
        assign term[i] = {21{left_q[2*i]}} & (entry ^ {21{left_q[2*i+1]}});
      end
      // -x is ~x + 1; a direction has one negative component at most
      wire [21:0] first = {term[0], 1'b1} + {term[1], left_q[1] | left_q[3] | left_q[5]};
      reg [20:0] first_q2, rest_q2, m_q3;
      reg [17:0] size_q4;
      assign size4[j] = size_q4;
      wire [20:0] size = m_q3[20] ? -m_q3 : m_q3;
      always @(posedge clk) begin
        first_q2 <= first[21:1];
        rest_q2 <= term[2];
        m_q3 <= first_q2 + rest_q2;
        size_q4 <= size[17:0];
        negative_q4[j] <= m_q3[20];
      end
      wire unused_bits = &{1'b0, size[20:18], first[0]};
    end
  endgenerate

  // ---- clock 4: the order. Of equals the first one counts as greater
  reg [17:0] size0_q5, size1_q5, size2_q5;
  reg [2:0] negative_q5;
  reg ge01_q5, ge02_q5, ge12_q5;
  wire least0 = ~ge01_q5 & ~ge02_q5;
  wire least1 = ge01_q5 & ~ge12_q5;
  wire middle0 = ge01_q5 != ge02_q5;
  wire middle1 = ge01_q5 == ge12_q5;
  wire [17:0] b = middle0 ? size0_q5 : middle1 ? size1_q5 : size2_q5;
  wire [17:0] c = least0 ? size0_q5 : least1 ? size1_q5 : size2_q5;

  // ---- clocks 5 and 6: coefficients. A face is named by the two greater components, a corner by
  // the one whose sign is not that of the two others
  reg [17:0] b_q6, c_q6;
  reg [6:0] select_q6, select_q7;
  reg [29:0] magnitude_q6, magnitude_q7;
  reg [6:0] face_factor_q7, corner_factor_q7;
  wire [17:0] difference = b_q6 - c_q6;
  wire n0 = negative_q5[0], n1 = negative_q5[1], n2 = negative_q5[2];
  wire [1:0] pair = least0 ? 2'd2 : least1 ? 2'd1 : 2'd0;
  wire first_negative = least0 ? n1 : n0;
  wire second_negative = least0 | least1 ? n2 : n1;
  wire most_negative = (n0 & n1) | (n0 & n2) | (n1 & n2);
  wire [1:0] corner = n0 == n1 && n0 == n2 ? 2'd0 : n0 == n1 ? 2'd1 : n0 == n2 ? 2'd2 : 2'd3;
  reg [5:0] valid_q;
  reg [3:0] number_q2, number_q3, number_q4, number_q5, number_q6, number_q7;
  function [9:0] round_up(input [17:0] size);
    round_up = size[17:8] + {9'd0, |size[7:0]};
  endfunction
  always @(posedge clk) begin
    size0_q5 <= size4[0];
    size1_q5 <= size4[1];
    size2_q5 <= size4[2];
    negative_q5 <= negative_q4;
    ge01_q5 <= size4[0] >= size4[1];
    ge02_q5 <= size4[0] >= size4[2];
    ge12_q5 <= size4[1] >= size4[2];
    b_q6 <= b;
    c_q6 <= c;
    select_q6 <= {
      most_negative, corner, first_negative, pair, first_negative != second_negative
    };
    magnitude_q6 <= {round_up(size2_q5), round_up(size1_q5), round_up(size0_q5)};
    select_q7 <= select_q6;
    magnitude_q7 <= magnitude_q6;
    face_factor_q7 <= difference[17:11];
    corner_factor_q7 <= c_q6[16:10] | {7{c_q6[17]}};
    {number_q2, number_q3, number_q4, number_q5, number_q6, number_q7} <= {
      direction_q, number_q2, number_q3, number_q4, number_q5, number_q6
    };
    valid_q <= rst ? 6'd0 : {valid_q[4:0], busy_q};
  end
  assign m_valid     = valid_q[5];
  assign m_direction = number_q7;
  assign m_select    = select_q7;
  assign m_magnitude = magnitude_q7;
  assign m_factor    = {corner_factor_q7, face_factor_q7};

  wire unused = &{1'b0, difference[10:0], c_q6[9:0], error[21], error[13:0]};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_start, !start || !busy_q || last)
    end

endmodule
`default_nettype wire
