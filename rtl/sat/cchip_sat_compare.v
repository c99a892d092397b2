// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_sat_compare: macro stage 4 of the SAT pipeline (paper, figure 7): are the projection
// intervals (eq. 3) disjoint, and are they for the unrounded primitives too?
//   latency      CCHIP_COMPARE_LATENCY = 4 clocks; from the bounds CCHIP_BOUND_LAG = 2 less
//   throughput   one axis per clock, never stalls
//   numbers      signed projections relative to the reference point, unsigned bounds of their
//                errors
//   reset        none (data only)
// Own set of the axis: {0} and the slots marked s_own; other set: the other slots. Closed sets:
// separated only if every difference between the two sets is strictly of one sign that is allowed.
// Certain: |value| > bound, strictly. m_clear: every difference between the sets exceeds the gap
// bound, and each point of the other set is on one side of the whole own set. m_deep: some
// difference exceeds the gap bound, and some is below its negative.
module cchip_sat_compare #(
    // width of a projection, CCHIP_PROJ_W(COORD_W) in the pipeline (bit); legal: >= 2
    parameter integer PROJ_W = 51,
    // width of a bound, CCHIP_BOUND_W(COORD_W) in the pipeline (bit); legal: >= 1
    parameter integer BOUND_W = 43,
    parameter integer POINTS = 3,    // point slots; legal: 3..5
    // the first slots, which can hold own points; the sign of the slot behind them can be certain;
    // legal: 1, 2
    parameter integer OWN = 1
) (
    input  wire                     clk,            // clock, rising edge
    // bit i: slot i holds an own point; bit 1 only with bit 0 and OWN = 2
    input  wire [              1:0] s_own,
    // the other set may be found separated above the own one
    input  wire                     s_allow_above,
    input  wire                     s_allow_below,  // below
    // projections relative to the reference, p0 in the low bits, signed
    input  wire [POINTS*PROJ_W-1:0] s_projection,
    // bound on the error of slot OWN, unsigned, CCHIP_BOUND_LAG = 2 clocks after s_projection
    input  wire [      BOUND_W-1:0] s_sign_bound,
    // bound on the error of a difference on the fixed axis, unsigned, at the same time
    input  wire [      BOUND_W-1:0] s_gap_bound,
    // the intervals have no common point, on an allowed side
    output wire                     m_separated,
    // neither have those of the unrounded primitives
    output wire                     m_certain_gap,
    output wire [       POINTS-1:0] m_negative,     // bit i: p_i < 0
    output wire [       POINTS-1:0] m_zero,         // bit i: p_i = 0
    // |p| of slot OWN exceeds its bound; the sign of p_OWN is that of the unrounded vertices
    output wire                     m_certain,
    // every point of the other set lies beyond all own points, on either side, by more than the gap
    // bound
    output wire                     m_clear,
    // some difference between the sets exceeds the gap bound, and some is below its negative
    output wire                     m_deep
);

  reg m_separated_q;
  reg m_certain_gap_q;
  reg [POINTS-1:0] m_negative_q;
  reg [POINTS-1:0] m_zero_q;
  reg m_certain_q;
  reg m_clear_q;
  reg m_deep_q;
  assign m_separated = m_separated_q;
  assign m_certain_gap = m_certain_gap_q;
  assign m_negative = m_negative_q;
  assign m_zero = m_zero_q;
  assign m_certain = m_certain_q;
  assign m_clear = m_clear_q;
  assign m_deep = m_deep_q;

  `CCHIP_REFUSE(POINTS < 3 || POINTS > 5 || OWN < 1 || OWN > 2,
                cchip_error_compare_POINTS_must_be_3_to_5_and_OWN_1_or_2)

  // size of a value: |v|, or |v| - 1 of a negative one
  localparam integer SIZE_W = PROJ_W - 1;
  // bits of a size that are compared with a bound, as many as the bound has; one more bit is the OR
  // of all higher ones
  localparam integer LOW_W = SIZE_W > BOUND_W ? BOUND_W : SIZE_W;
  // v = 0 is detected in two clocks: parts of 16 bits, then all parts
  localparam integer PARTS = (PROJ_W + 15) / 16;

  // |v| <= bound: size + minus < bound + 1
  function no_more(input minus, input [LOW_W:0] size, input [BOUND_W-1:0] bound);
    reg [BOUND_W+2:0] left;
    begin
      left = {{BOUND_W + 1 - LOW_W{1'b0}}, size, minus} - {2'b00, bound, 1'b1};
      no_more = left[BOUND_W+2];
    end
  endfunction

  // ---- values: the projections, their differences to the own points in slots 0 and 1
  localparam integer VALUES = 3 * POINTS;
  // those that are no difference between the two sets, or of a slot that is not there
  function [VALUES-1:0] ignored(input [1:0] in);
    ignored = {OWN == 2 ? {{POINTS - 2{1'b0}}, in} | {POINTS{~in[1]}} : {POINTS{1'b1}},
               {{POINTS - 2{1'b0}}, in} | {POINTS{~in[0]}}, {{POINTS - 2{1'b0}}, in}};
  endfunction

  // ---- clocks 1 and 2 beside the values
  reg [VALUES-1:0] used_q1;
  reg [1:0] own_q1, own_q2, allow_q1, allow_q2;  // allow: above, below
  always @(posedge clk) begin
    used_q1  <= ~ignored(s_own);
    own_q1   <= s_own;
    own_q2   <= own_q1;
    allow_q1 <= {s_allow_above, s_allow_below};
    allow_q2 <= allow_q1;
  end

  wire [VALUES-1:0] sign;  // clock 1: the value is negative
  wire [VALUES-1:0] zero, near;
  reg uncertain_q3;

  genvar i, g;
  generate
    for (i = 0; i < VALUES; i = i + 1) begin : gen_value
      localparam integer SLOT = i % POINTS;
      localparam integer FROM = i / POINTS;  // 0: the reference, 1 and 2: slots 0 and 1
      if (FROM > OWN || SLOT < FROM) begin : gen_none
        assign sign[i] = 1'b0;
        assign zero[i] = 1'b0;
        assign near[i] = 1'b0;
      end else begin : gen_used
        // clock 1
        reg [PROJ_W-1:0] v_q;
        if (FROM == 0) begin : gen_projection
          always @(posedge clk) v_q <= s_projection[PROJ_W*SLOT+:PROJ_W];
        end else begin : gen_difference
          always @(posedge clk)
            v_q <= s_projection[PROJ_W*SLOT+:PROJ_W] - s_projection[PROJ_W*(FROM-1)+:PROJ_W];
        end
        assign sign[i] = v_q[PROJ_W-1];
        // clock 2
        reg negative_q2;
        reg [LOW_W:0] size_q2;
        reg [PARTS-1:0] some_q2;
        wire [16*PARTS-1:0] v = {{16 * PARTS - PROJ_W{1'b0}}, v_q};
        for (g = 0; g < PARTS; g = g + 1) begin : gen_part
          always @(posedge clk) some_q2[g] <= |v[16*g+:16];
        end
        always @(posedge clk) begin
          negative_q2 <= v_q[PROJ_W-1];
          size_q2     <= {|(v_q[PROJ_W-1:LOW_W] ^ {PROJ_W - LOW_W{v_q[PROJ_W-1]}}),
                          v_q[LOW_W-1:0] ^ {LOW_W{v_q[PROJ_W-1]}}};
        end
        // clock 3
        reg zero_q3, near_q3;
        always @(posedge clk) begin
          zero_q3 <= ~|some_q2;
          near_q3 <= no_more(negative_q2, size_q2, s_gap_bound);
        end
        if (i == OWN) begin : gen_sign
          always @(posedge clk) uncertain_q3 <= no_more(negative_q2, size_q2, s_sign_bound);
        end
        assign zero[i] = zero_q3;
        assign near[i] = near_q3;
      end
    end
  endgenerate

  // ---- clock 2: differences that are not negative, negative, and on another side of the own point
  // than of the reference
  reg [POINTS-1:0] signs_q2;
  reg [VALUES-1:0] up_q2, down_q2, across_q2;
  always @(posedge clk) begin
    signs_q2  <= sign[POINTS-1:0];
    up_q2     <= used_q1 & ~sign;
    down_q2   <= used_q1 & sign;
    across_q2 <= used_q1 & (sign ^ {3{sign[POINTS-1:0]}});
  end

  // ---- clock 3: combines the signs of all differences between the sets
  reg [1:0] own_q3;
  reg above_q3, below_q3, same_q3;
  reg [POINTS-1:0] negative_q3;
  reg [VALUES-1:0] up_q3, down_q3;
  always @(posedge clk) begin
    own_q3      <= own_q2;
    above_q3    <= allow_q2[1] & ~|down_q2;
    below_q3    <= allow_q2[0] & ~|up_q2;
    same_q3     <= ~|across_q2;
    negative_q3 <= signs_q2;
    up_q3       <= up_q2;
    down_q3     <= down_q2;
  end

  // ---- clock 4: combines zero and near, which take one clock longer than the signs
  wire [VALUES-1:0] ignore_q3 = ignored(own_q3);
  wire none_zero = &(ignore_q3 | ~zero);
  wire all_far = &(ignore_q3 | ~near);  // then none is zero
  always @(posedge clk) begin
    m_separated_q   <= (above_q3 & none_zero) | below_q3;
    m_certain_gap_q <= (above_q3 | below_q3) & all_far;
    m_negative_q    <= negative_q3;
    m_zero_q        <= zero[POINTS-1:0];
    m_certain_q     <= ~uncertain_q3;
    m_clear_q       <= same_q3 & all_far;
    m_deep_q        <= (|(up_q3 & ~near)) & (|(down_q3 & ~near));
  end

endmodule
`default_nettype wire
