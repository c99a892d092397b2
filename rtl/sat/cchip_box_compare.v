// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_box_compare: are the bounding boxes of the two primitives disjoint in one component?
//   latency      CCHIP_BOX_LATENCY = 8 clocks
//   throughput   one comparison per clock, never stalls
//   numbers      signed COORD_W-bit coordinates; no multiplier
//   reset        none (data only)
// Only the degenerate programme uses it: primitives on one line have no other separating axis.
//   parameters   Checked in cchip_primtest and cchip_sat_select, not here.
//   timing       Clocks 1 to 4: component; comparisons of the first two and the last two vertices
//                of each primitive; lower and higher of each couple; comparisons of the couples.
//                Clocks 5 to 8: minimum and maximum of all; gaps; gaps against E; verdict.
//   numbers      x < y is the sign of x - y with one bit more. The gaps are differences of two
//                coordinates less 1, COORD_W + 1 bits: the sign tells whether there is a gap, and
//                gap > E is gap - 1 >= E. A coordinate is an axis with |L|_1 = 1, so this is the
//                definite no (docs/develop/architecture.md#a-definite-no) of any other axis.
//   why          It rides on the beats e_0 x f_l of the degenerate programme, component l, and runs
//                beside the four macro stages. So it costs no beat and no multiplier; a unit vector
//                as an axis would have needed one more axis class in stages 1 and 2, and three
//                beats. The stages take longer, so comparison and multiplexer get a clock each.
module cchip_box_compare #(
    parameter integer COORD_W = 16,  // width of a coordinate (bit); legal: 4..20
    parameter integer VERTS_A = 3,   // vertices of A (vertex); legal: 3, 4
    parameter integer VERTS_B = 3    // vertices of B (vertex); legal: 3, 4
) (
    input  wire                            clk,            // clock, rising edge
    // A, vertex 0 in the low bits; of a vertex x lowest
    input  wire [   3*VERTS_A*COORD_W-1:0] s_a,
    input  wire [   3*VERTS_B*COORD_W-1:0] s_b,            // B likewise
    input  wire [                     1:0] s_component,    // 0 x, 1 y, 2 z; 3 is taken as 0
    // E = 2^s_error_shift; eta <= 2^s_error_shift
    input  wire [`CCHIP_ERROR_SHIFT_W-1:0] s_error_shift,
    // the boxes have no common value of this component
    output wire                            m_separated,
    // the gap between them exceeds E, so the unrounded boxes are disjoint too
    output wire                            m_certain_gap
);

  reg m_separated_q;
  reg m_certain_gap_q;
  assign m_separated = m_separated_q;
  assign m_certain_gap = m_certain_gap_q;

  localparam integer GAP_W = COORD_W + 1;
  localparam integer VERTS = VERTS_A + VERTS_B;

  // ---- clock 1: one component of every vertex, A first
  wire [3*VERTS*COORD_W-1:0] all = {s_b, s_a};
  reg [VERTS*COORD_W-1:0] x_q;
  genvar i;
  generate
    for (i = 0; i < VERTS; i = i + 1) begin : gen_component
      always @(posedge clk)
        case (s_component)
          2'd1: x_q[COORD_W*i+:COORD_W] <= all[COORD_W*(3*i+1)+:COORD_W];
          2'd2: x_q[COORD_W*i+:COORD_W] <= all[COORD_W*(3*i+2)+:COORD_W];
          default: x_q[COORD_W*i+:COORD_W] <= all[COORD_W*3*i+:COORD_W];
        endcase
    end
  endgenerate

  // x < y
  function less(input [COORD_W-1:0] x, input [COORD_W-1:0] y);
    reg [COORD_W:0] difference;
    begin
      difference = {x[COORD_W-1], x} - {y[COORD_W-1], y};
      less = difference[COORD_W];
    end
  endfunction

  // ---- clocks 2 and 3: vertices 0 and 1, and the last two, of A and of B: {higher, lower} of each
  // pair.
  // ---- clocks 4 and 5: {higher, lower} of all
  localparam integer PAIR_W = 2 * COORD_W;
  localparam integer A_LAST = COORD_W * (VERTS_A - 2);
  localparam integer B_FIRST = COORD_W * VERTS_A;
  localparam integer B_LAST = COORD_W * (VERTS - 2);
  wire [4*PAIR_W-1:0] couple =
      {x_q[B_LAST+:PAIR_W], x_q[B_FIRST+:PAIR_W], x_q[A_LAST+:PAIR_W], x_q[0+:PAIR_W]};
  reg [4*PAIR_W-1:0] couple_q2, sorted_q3;
  reg [3:0] rising_q2;
  reg [2*PAIR_W-1:0] low_q4, high_q4, range_q5;
  reg [1:0] low_rising_q4, high_rising_q4;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_couple
      wire [COORD_W-1:0] first = couple_q2[PAIR_W*i+:COORD_W];
      wire [COORD_W-1:0] second = couple_q2[PAIR_W*i+COORD_W+:COORD_W];
      always @(posedge clk) begin
        couple_q2[PAIR_W*i+:PAIR_W] <= couple[PAIR_W*i+:PAIR_W];
        rising_q2[i] <= less(couple[PAIR_W*i+:COORD_W], couple[PAIR_W*i+COORD_W+:COORD_W]);
        sorted_q3[PAIR_W*i+:PAIR_W] <= rising_q2[i] ? {second, first} : {first, second};
      end
    end
    for (i = 0; i < 2; i = i + 1) begin : gen_primitive
      wire [COORD_W-1:0] low0 = sorted_q3[2*PAIR_W*i+:COORD_W];
      wire [COORD_W-1:0] low1 = sorted_q3[2*PAIR_W*i+PAIR_W+:COORD_W];
      wire [COORD_W-1:0] high0 = sorted_q3[2*PAIR_W*i+COORD_W+:COORD_W];
      wire [COORD_W-1:0] high1 = sorted_q3[2*PAIR_W*i+PAIR_W+COORD_W+:COORD_W];
      always @(posedge clk) begin
        low_q4[PAIR_W*i+:PAIR_W]  <= {low1, low0};
        high_q4[PAIR_W*i+:PAIR_W] <= {high1, high0};
        low_rising_q4[i]          <= less(low0, low1);
        high_rising_q4[i]         <= less(high0, high1);
        range_q5[PAIR_W*i+:COORD_W] <= low_rising_q4[i] ? low_q4[PAIR_W*i+:COORD_W]
            : low_q4[PAIR_W*i+COORD_W+:COORD_W];
        range_q5[PAIR_W*i+COORD_W+:COORD_W] <= high_rising_q4[i]
            ? high_q4[PAIR_W*i+COORD_W+:COORD_W]
                                                                 : high_q4[PAIR_W*i+:COORD_W];
      end
    end
  endgenerate
  wire [COORD_W-1:0] low_a = range_q5[0+:COORD_W];
  wire [COORD_W-1:0] high_a = range_q5[COORD_W+:COORD_W];
  wire [COORD_W-1:0] low_b = range_q5[PAIR_W+:COORD_W];
  wire [COORD_W-1:0] high_b = range_q5[PAIR_W+COORD_W+:COORD_W];

  // ---- clock 6: (gap - 1) on both sides: negative exactly when there is no gap
  function [GAP_W-1:0] gap(input [COORD_W-1:0] from, input [COORD_W-1:0] to);
    gap = {to[COORD_W-1], to} + ~{from[COORD_W-1], from};
  endfunction
  reg [GAP_W-1:0] a_above_q6, b_above_q6;
  always @(posedge clk) begin
    a_above_q6 <= gap(high_b, low_a);
    b_above_q6 <= gap(high_a, low_b);
  end

  // ---- clock 7: gap - 1 - 2^shift
  wire [`CCHIP_ERROR_SHIFT_W-1:0] error_shift;
  cchip_delay #(.WIDTH(3), .DEPTH(5)) u_error_shift (
      .clk(clk),
      .rst(1'b0),
      .d  (s_error_shift),
      .q  (error_shift)
  );
  reg [GAP_W:0] error_q6;
  reg a_above_q7, b_above_q7, a_near_q7, b_near_q7;
  wire [GAP_W:0] a_left = {a_above_q6[GAP_W-1], a_above_q6} - error_q6;
  wire [GAP_W:0] b_left = {b_above_q6[GAP_W-1], b_above_q6} - error_q6;
  always @(posedge clk) begin
    error_q6   <= {{GAP_W{1'b0}}, 1'b1} << error_shift;
    a_above_q7 <= ~a_above_q6[GAP_W-1];
    b_above_q7 <= ~b_above_q6[GAP_W-1];
    a_near_q7  <= a_left[GAP_W];
    b_near_q7  <= b_left[GAP_W];
  end

  // ---- clock 8: either side
  always @(posedge clk) begin
    m_separated_q   <= a_above_q7 | b_above_q7;
    m_certain_gap_q <= ~(a_near_q7 & b_near_q7);
  end
  wire unused = &{1'b0, a_left, b_left};

endmodule
`default_nettype wire
