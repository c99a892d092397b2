// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_box_compare: are the bounding boxes of the two primitives disjoint in one component?
//   latency      CCHIP_BOX_LATENCY = 5 clocks
//   throughput   one comparison per clock, never stalls
//   numbers      signed COORD_W-bit coordinates; no multiplier
//   reset        none (data only)
// Only the degenerate programme uses it: primitives on one line have no other separating axis.
module cchip_box_compare #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16,
    // vertices of A and of B
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3
) (
    input  wire                         clk,
    input  wire [3*VERTS_A*COORD_W-1:0] s_a,            // vertex 0 in the low bits, x lowest
    input  wire [3*VERTS_B*COORD_W-1:0] s_b,
    input  wire [                  1:0] s_component,    // 0 x, 1 y, 2 z; 3 like 0
    input  wire [                  2:0] s_error_shift,  // eta <= 2^s_error_shift
    output reg                          m_separated,
    output reg                          m_certain_gap   // the gap exceeds 2^s_error_shift
);

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

  function [COORD_W-1:0] low(input signed [COORD_W-1:0] x, input signed [COORD_W-1:0] y);
    low = x < y ? x : y;
  endfunction
  function [COORD_W-1:0] high(input signed [COORD_W-1:0] x, input signed [COORD_W-1:0] y);
    high = x < y ? y : x;
  endfunction

  // ---- clocks 2 and 3: minimum and maximum of vertices 0, 1 and of the last two, then of all
  localparam integer A_LAST = COORD_W * (VERTS_A - 1);
  localparam integer B_FIRST = COORD_W * VERTS_A;
  localparam integer B_LAST = COORD_W * (VERTS - 1);
  reg [COORD_W-1:0] low_a0_q2, low_a1_q2, high_a0_q2, high_a1_q2, low_b0_q2, low_b1_q2, high_b0_q2, high_b1_q2;
  reg [COORD_W-1:0] low_a_q3, high_a_q3, low_b_q3, high_b_q3;
  always @(posedge clk) begin
    low_a0_q2  <= low(x_q[0+:COORD_W], x_q[COORD_W+:COORD_W]);
    high_a0_q2 <= high(x_q[0+:COORD_W], x_q[COORD_W+:COORD_W]);
    low_a1_q2  <= low(x_q[A_LAST-COORD_W+:COORD_W], x_q[A_LAST+:COORD_W]);
    high_a1_q2 <= high(x_q[A_LAST-COORD_W+:COORD_W], x_q[A_LAST+:COORD_W]);
    low_b0_q2  <= low(x_q[B_FIRST+:COORD_W], x_q[B_FIRST+COORD_W+:COORD_W]);
    high_b0_q2 <= high(x_q[B_FIRST+:COORD_W], x_q[B_FIRST+COORD_W+:COORD_W]);
    low_b1_q2  <= low(x_q[B_LAST-COORD_W+:COORD_W], x_q[B_LAST+:COORD_W]);
    high_b1_q2 <= high(x_q[B_LAST-COORD_W+:COORD_W], x_q[B_LAST+:COORD_W]);
    low_a_q3   <= low(low_a0_q2, low_a1_q2);
    high_a_q3  <= high(high_a0_q2, high_a1_q2);
    low_b_q3   <= low(low_b0_q2, low_b1_q2);
    high_b_q3  <= high(high_b0_q2, high_b1_q2);
  end

  // ---- clock 4: gaps on both sides, less 1, so that the sign tells whether there is one
  function [GAP_W-1:0] gap(input [COORD_W-1:0] from, input [COORD_W-1:0] to);
    gap = {to[COORD_W-1], to} + ~{from[COORD_W-1], from};
  endfunction
  reg [GAP_W-1:0] a_above_q4, b_above_q4;
  always @(posedge clk) begin
    a_above_q4 <= gap(high_b_q3, low_a_q3);
    b_above_q4 <= gap(high_a_q3, low_b_q3);
  end

  // ---- clock 5
  wire [2:0] error_shift;
  cchip_delay #(
      .WIDTH(3),
      .DEPTH(4)
  ) u_error_shift (
      .clk(clk),
      .rst(1'b0),
      .d  (s_error_shift),
      .q  (error_shift)
  );
  // gap - 1 >= 2^shift
  function exceeds(input [GAP_W-1:0] gap_less_1, input [2:0] shift);
    exceeds = ~gap_less_1[GAP_W-1] & ({1'b0, gap_less_1} >= ({{GAP_W{1'b0}}, 1'b1} << shift));
  endfunction
  always @(posedge clk) begin
    m_separated   <= ~a_above_q4[GAP_W-1] | ~b_above_q4[GAP_W-1];
    m_certain_gap <= exceeds(a_above_q4, error_shift) | exceeds(b_above_q4, error_shift);
  end

endmodule
`default_nettype wire
