// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_compare: macro stage 4 of the SAT pipeline (paper, figure 7): are the projection
// intervals (eq. 3) disjoint, and are they for the unrounded primitives too?
//   latency      CCHIP_COMPARE_LATENCY = 3 clocks
//   throughput   one axis per clock, never stalls
//   numbers      signed projections relative to the reference point, unsigned bounds of their errors
//   reset        none (data only)
// Own set of the axis: {0} and the slots marked s_own; other set: the other slots. Closed sets:
// separated only if every difference between the two sets is strictly of one sign that is allowed.
// Certain: |value| > bound, strictly. m_clear: every difference between the sets exceeds the gap bound, and each
// point of the other set is on one side of the whole own set.
module cchip_sat_compare #(
    // width of a projection, bit
    parameter integer PROJ_W = 51,
    // width of a bound, bit
    parameter integer BOUND_W = 43,
    // point slots, 3..5
    parameter integer POINTS = 3
) (
    input  wire                      clk,
    input  wire [               1:0] s_own,          // slot 0, 1 holds an own point
    input  wire                      s_allow_above,  // the other set may be separated above the own one
    input  wire                      s_allow_below,
    input  wire [ POINTS*PROJ_W-1:0] s_projection,   // p0 in the low bits
    input  wire [POINTS*BOUND_W-1:0] s_sign_bound,
    input  wire [       BOUND_W-1:0] s_gap_bound,
    output reg                       m_separated,
    output reg                       m_certain_gap,  // separated for the unrounded primitives
    output reg  [        POINTS-1:0] m_negative,     // p_i < 0
    output reg  [        POINTS-1:0] m_zero,         // p_i = 0
    output reg  [        POINTS-1:0] m_certain,      // the sign of p_i is that of the unrounded vertices
    output reg                       m_clear         // every other point lies certainly beyond all own points,
                                                     // on either side
);

  // room for value +- bound
  localparam integer SUM_W = (PROJ_W > BOUND_W ? PROJ_W : BOUND_W) + 1;

  // value - bound - 1 or value + bound: has the sign of the value if and only if |value| > bound
  function [SUM_W-1:0] shrink(input [PROJ_W-1:0] value, input [BOUND_W-1:0] bound);
    reg [SUM_W-1:0] wide_value, wide_bound;
    begin
      wide_value = {{SUM_W - PROJ_W{value[PROJ_W-1]}}, value};
      wide_bound = {{SUM_W - BOUND_W{1'b0}}, bound};
      shrink = wide_value + (value[PROJ_W-1] ? wide_bound : ~wide_bound);
    end
  endfunction

  // ---- clock 1: differences to the own points in slots 0 and 1
  reg [ POINTS*PROJ_W-1:0] p_q, d0_q, d1_q;
  reg [POINTS*BOUND_W-1:0] sign_bound_q;
  reg [       BOUND_W-1:0] gap_bound_q;
  reg [               1:0] own_q;
  reg allow_above_q, allow_below_q;

  always @(posedge clk) begin
    p_q           <= s_projection;
    sign_bound_q  <= s_sign_bound;
    gap_bound_q   <= s_gap_bound;
    own_q         <= s_own;
    allow_above_q <= s_allow_above;
    allow_below_q <= s_allow_below;
  end

  // ---- clock 2: signs, and signs after the bound is taken off
  reg [POINTS-1:0] negative_q2, zero_q2, certain_q2, gap_q2;
  reg [POINTS-1:0] above0_q2, below0_q2, gap0_q2, above1_q2, below1_q2, gap1_q2;
  reg [1:0] own_q2;
  reg allow_above_q2, allow_below_q2;

  always @(posedge clk) begin
    own_q2         <= own_q;
    allow_above_q2 <= allow_above_q;
    allow_below_q2 <= allow_below_q;
  end

  genvar i;
  generate
    for (i = 0; i < POINTS; i = i + 1) begin : gen_point
      wire [PROJ_W-1:0] p = p_q[PROJ_W*i+:PROJ_W];
      wire [PROJ_W-1:0] d0 = d0_q[PROJ_W*i+:PROJ_W];
      wire [PROJ_W-1:0] d1 = d1_q[PROJ_W*i+:PROJ_W];
      wire [SUM_W-1:0] p_sign = shrink(p, sign_bound_q[BOUND_W*i+:BOUND_W]);
      wire [SUM_W-1:0] p_gap = shrink(p, gap_bound_q);
      wire [SUM_W-1:0] d0_gap = shrink(d0, gap_bound_q);
      wire [SUM_W-1:0] d1_gap = shrink(d1, gap_bound_q);
      always @(posedge clk) begin
        d0_q[PROJ_W*i+:PROJ_W] <= s_projection[PROJ_W*i+:PROJ_W] - s_projection[0+:PROJ_W];
        d1_q[PROJ_W*i+:PROJ_W] <= s_projection[PROJ_W*i+:PROJ_W] - s_projection[PROJ_W+:PROJ_W];
        negative_q2[i]         <= p[PROJ_W-1];
        zero_q2[i]             <= p == {PROJ_W{1'b0}};
        certain_q2[i]          <= p_sign[SUM_W-1] == p[PROJ_W-1];
        gap_q2[i]              <= p_gap[SUM_W-1] == p[PROJ_W-1];
        above0_q2[i]           <= ~d0[PROJ_W-1] & d0 != {PROJ_W{1'b0}};
        below0_q2[i]           <= d0[PROJ_W-1];
        gap0_q2[i]             <= d0_gap[SUM_W-1] == d0[PROJ_W-1];
        above1_q2[i]           <= ~d1[PROJ_W-1] & d1 != {PROJ_W{1'b0}};
        below1_q2[i]           <= d1[PROJ_W-1];
        gap1_q2[i]             <= d1_gap[SUM_W-1] == d1[PROJ_W-1];
      end
      wire unused = &{1'b0, p_sign, p_gap, d0_gap, d1_gap};
    end
  endgenerate

  // ---- clock 3: all differences together; slots that hold own points do not count
  wire [POINTS-1:0] skip = {{POINTS - 2{1'b0}}, own_q2};
  wire [POINTS-1:0] skip0 = skip | {POINTS{~own_q2[0]}};
  wire [POINTS-1:0] skip1 = skip | {POINTS{~own_q2[1]}};
  wire above = allow_above_q2 & (&(skip | ~(negative_q2 | zero_q2))) & (&(skip0 | above0_q2)) & (&(skip1 | above1_q2));
  wire below = allow_below_q2 & (&(skip | negative_q2)) & (&(skip0 | below0_q2)) & (&(skip1 | below1_q2));
  // on the same side of the own points in slots 0 and 1 as of the reference
  wire [POINTS-1:0] same0 = below0_q2 ~^ negative_q2;
  wire [POINTS-1:0] same1 = below1_q2 ~^ negative_q2;
  wire all_far = (&(skip | gap_q2)) & (&(skip0 | gap0_q2)) & (&(skip1 | gap1_q2));

  always @(posedge clk) begin
    m_separated   <= above | below;
    m_certain_gap <= (above | below) & all_far;
    m_negative    <= negative_q2;
    m_zero        <= zero_q2;
    m_certain     <= certain_q2;
    m_clear       <= all_far & (&(skip0 | same0)) & (&(skip1 | same1));
  end

endmodule
`default_nettype wire
