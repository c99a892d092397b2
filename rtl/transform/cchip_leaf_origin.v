// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_leaf_origin: the origin of A's leaf relative to that of B's leaf in cchip_vertex_transform,
// M o_A + t - o_B, exact and rounded once to the unit of the leaf pair, one row after the other.
//   latency      14 clocks from s_origin to m_origin; t and o_B are read on the clock before
//                s_origin and on the two from it on, s_moved 6 clocks behind s_origin
//   throughput   an origin every 4 clocks
//   reset        no origin
//   inside       The three rows pass one shifter and one cchip_round_shift, one after the other: an
//                origin has as many clocks as a pair has vertices.
module cchip_leaf_origin (
    input  wire         clk,         // clock, rising edge
    input  wire         rst,         // synchronous reset, active high
    input  wire         s_origin,    // the origin has its turn: the dot products are on their way
    input  wire [107:0] s_t,         // t, 3 x 36 bit, 32 fraction bits
    input  wire [ 71:0] s_origin_b,  // o_B, 3 x 24 bit
    input  wire [  3:0] s_shift,     // M is M 2^-shift
    input  wire [  4:0] s_fine,      // of cchip_leaf_unit
    input  wire [167:0] s_moved,     // M o_A, 3 x 56 bit
    output wire [134:0] m_origin,    // the origin in the unit, 3 x 45 bit
    output wire         m_lost       // a rounding lost a bit
);

  wire [14:7] row;  // row[k]: the origin is at clock k, its row r at k + r
  cchip_delay #(.WIDTH(1), .DEPTH(6), .RESET(1)) u_row (
      .clk(clk),
      .rst(rst),
      .d  (s_origin),
      .q  (row[7])
  );
  reg [14:8] row_q;
  assign row[14:8] = row_q;
  reg origin_q2;
  wire [35:0] t = s_origin ? s_t[36+:36] : origin_q2 ? s_t[72+:36] : s_t[0+:36];
  wire [23:0] origin_b = s_origin ? s_origin_b[24+:24] :
      origin_q2 ? s_origin_b[48+:24] : s_origin_b[0+:24];
  reg  [35:0] t_q1;
  reg  [23:0] origin_b_q1;
  reg  [36:0] difference_q2;
  wire [36:0] difference8;  // t - o_B, 2^-32
  wire [ 3:0] shift7;
  wire [ 4:0] fine9;
  cchip_delay #(.WIDTH(37), .DEPTH(6), .MEMORY(1)) u_difference (
      .clk(clk),
      .rst(1'b0),
      .d  (difference_q2),
      .q  (difference8)
  );
  cchip_delay #(.WIDTH(4), .DEPTH(6), .MEMORY(1)) u_shift (
      .clk(clk),
      .rst(1'b0),
      .d  (s_shift),
      .q  (shift7)
  );
  cchip_delay #(.WIDTH(5), .DEPTH(5), .MEMORY(1)) u_fine (
      .clk(clk),
      .rst(1'b0),
      .d  (s_fine),
      .q  (fine9)
  );
  reg [55:0] moved_1_q8, moved_2_q8, moved_2_q9, shifted_q8;
  reg cut_q8, cut_q9, cut_q10, cut_q11, cut_q12;
  wire signed [55:0] of_row = row[8] ? moved_1_q8 : row[9] ? moved_2_q9 : s_moved[0+:56];
  reg [59:0] sum_q9;
  wire [44:0] origin12;
  wire origin_lost12;
  reg [44:0] origin_0_q, origin_1_q;
  reg lost_0_q, lost_1_q, origin_lost_q;
  reg [134:0] origin_q;
  cchip_round_shift #(
      .D_W      (60),
      .BASE     (14),
      .SHIFT_MAX(16),
      .Q_W      (45)
  ) u_origin (
      .clk (clk),
      .d   (sum_q9),
      .s   (fine9),
      .q   (origin12),
      .lost(origin_lost12)
  );
  wire lost12 = origin_lost12 | cut_q12;
  always @(posedge clk) begin
    origin_q2 <= ~rst & s_origin;
    row_q <= rst ? 7'd0 : row[13:7];
    t_q1 <= t;
    origin_b_q1 <= origin_b;
    difference_q2 <= {t_q1[35], t_q1} - {{5{origin_b_q1[23]}}, origin_b_q1, 8'd0};
    moved_1_q8 <= s_moved[56+:56];
    moved_2_q8 <= s_moved[112+:56];
    moved_2_q9 <= moved_2_q8;
    shifted_q8 <= of_row >>> shift7;
    cut_q8 <= |(of_row[14:0] & ~(15'h7FFF << shift7));
    sum_q9 <= {
      {difference8[36], difference8} + {{4{shifted_q8[55]}}, shifted_q8[55:22]}, shifted_q8[21:0]
    };
    cut_q9 <= cut_q8;
    cut_q10 <= cut_q9;
    cut_q11 <= cut_q10;
    cut_q12 <= cut_q11;
    if (row[12]) {lost_0_q, origin_0_q} <= {lost12, origin12};
    if (row[13]) {lost_1_q, origin_1_q} <= {lost12, origin12};
    if (row[14]) begin
      origin_q      <= {origin12, origin_1_q, origin_0_q};
      origin_lost_q <= lost12 | lost_1_q | lost_0_q;
    end
  end
  assign m_origin = origin_q;
  assign m_lost   = origin_lost_q;

endmodule
`default_nettype wire
