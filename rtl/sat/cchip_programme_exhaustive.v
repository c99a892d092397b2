// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_programme_exhaustive: what the verdicts of an EXHAUSTIVE pair have shown so far. They come
// on consecutive clocks, so one set of registers serves all pairs.
//   latency      1 clock, then logic: m_* belong to the verdict that entered one clock before
//   throughput   one verdict per clock
//   reset        m_valid; what is remembered is overwritten by the first verdicts of the next pair
//   about        Part of cchip_axis_programme.
//   timing       Latency 1 clock, then two levels of logic. The verdicts of a pair come on
//                consecutive clocks, nA first; another pair may follow at once.
//   why          The pipeline issues all axes of an EXHAUSTIVE pair back to back, so the state that
//                travels with a beat cannot carry what earlier beats found. One set of registers
//                does, because such a pair's verdicts come back to back, too. Its loop from one
//                verdict to the next is a selection; everything else is computed a clock before.
module cchip_programme_exhaustive #(
    // 1: a warped quad whose hit is not certain continues with programme TETRAHEDRON; legal: 0, 1
    parameter integer TETRAHEDRON = 0
) (
    input  wire                          clk,               // clock, rising edge
    input  wire                          rst,  // synchronous reset, active high: clears m_valid
    input  wire                          s_valid,  // there is a verdict of an EXHAUSTIVE pair
    input  wire                          s_normal_a,  // it is that on nA, the first of the pair
    input  wire                          s_normal_b,        // it is that on nB
    input  wire                          s_last,            // it is the last one
    input  wire [`CCHIP_AXIS_CODE_W-1:0] s_code,            // axis code of its beat
    input  wire                          s_separated,  // the intervals of all vertices are disjoint
    input  wire                          s_certain_gap,     // for the unrounded primitives too
    // the sign of the projection of W_l on a cross axis is that of the unrounded vertices
    input  wire                          s_sign_certain,
    input  wire                          s_sign_negative,   // it is negative
    // eta is 1..14, and the primitives overlap on the axis by more than the error, both ways, or
    // the axis is zero
    input  wire                          s_deep,
    // with nB: m_certain of cchip_programme_plan
    input  wire                          s_certain_sides,
    input  wire [     `CCHIP_PLAN_W-1:0] s_plan,            // with nB: m_plan of the same
    output wire                          m_valid,           // the outputs belong to a verdict
    output wire                          m_outcome,         // the pair is decided by it
    output wire                          m_proceed,         // the pair continues with m_plan
    output wire                          m_separated,       // an axis separates
    output wire [`CCHIP_AXIS_CODE_W-1:0] m_witness,  // axis code of the first that does; 0: none
    // the answer holds for the unrounded primitives
    output wire                          m_certain,
    // with m_proceed: not m_plan but TETRAHEDRON
    output wire                          m_to_tetrahedron,
    output wire                          m_deep,            // all axes so far were deep
    // what the normals lead to, record PLAN, docs/hardware/definitions.md#record-plan
    output wire [     `CCHIP_PLAN_W-1:0] m_plan
);

  // ---- the plan: what the normals lead to
  reg [`CCHIP_PLAN_W-1:0] plan_q;
  always @(posedge clk) if (s_valid && s_normal_b) plan_q <= s_plan;
  assign m_plan = plan_q;
  wire [`CCHIP_INFO_W-1:0] info = plan_q[`CCHIP_PLAN_INFO];
  wire [`CCHIP_AXIS_CODE_W-1:0] code = plan_q[`CCHIP_PLAN_CODE];
  wire warped = info[`CCHIP_INFO_CROSSING_WARPED_A] | info[`CCHIP_INFO_CROSSING_WARPED_B];
  wire is_crossing = plan_q[`CCHIP_PLAN_PROGRAMME] == `CCHIP_PROG_CROSSING;

  // ---- the two axes that CROSSING would visit, and whether their signs are certain
  wire [`CCHIP_INDEX_W-1:0] k = s_code[`CCHIP_AXIS_CODE_K];
  wire [`CCHIP_INDEX_W-1:0] l = s_code[`CCHIP_AXIS_CODE_L];
  wire [`CCHIP_INDEX_W-1:0] first_k = code[`CCHIP_AXIS_CODE_K];
  wire [`CCHIP_INDEX_W-1:0] first_l = code[`CCHIP_AXIS_CODE_L];
  wire first = {k[1:0], l[1:0]} == {first_k[1:0], first_l[1:0]};
  wire second = {k[1:0], l[1:0]}
      == {info[`CCHIP_INFO_CROSSING_K_UP], info[`CCHIP_INFO_CROSSING_L_UP]};

  reg valid_q, normal_a_q, normal_q, last_q, separated_q, certain_gap_q, certain_sides_q,
      still_certain_q, deep_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] code_q;
  always @(posedge clk) begin
    if (rst) valid_q <= 1'b0;
    else valid_q <= s_valid;
    normal_a_q      <= s_normal_a;
    normal_q        <= s_normal_a | s_normal_b;
    last_q          <= s_last;
    code_q          <= s_code;
    separated_q     <= s_separated;
    certain_gap_q   <= s_certain_gap;
    deep_q          <= s_deep;
    certain_sides_q <= s_normal_a | s_certain_sides;  // after nA: nB tells for both
    still_certain_q <= !(first || second) || (s_sign_certain && s_sign_negative == second);
  end

  // ---- found so far: nA is the first axis
  reg found_certain_q;  // signs on both normals, then on the crossing axes too
  reg found_separated_q, found_gap_q, found_deep_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] found_witness_q;
  wire separated_before = ~normal_a_q & found_separated_q;
  wire separated = separated_before | separated_q;
  wire [`CCHIP_AXIS_CODE_W-1:0] witness = separated_before ? found_witness_q : separated_q ? code_q
      : {`CCHIP_AXIS_CODE_W{1'b0}};
  wire gap = separated_before ? found_gap_q : certain_gap_q;
  wire certain = normal_q ? certain_sides_q : found_certain_q & still_certain_q;
  wire deep = deep_q & (normal_a_q | found_deep_q);
  wire to_tetrahedron = TETRAHEDRON != 0 && is_crossing && warped && !certain;

  always @(posedge clk)
    if (valid_q) begin
      found_certain_q   <= certain;
      found_separated_q <= separated;
      found_witness_q   <= witness;
      found_gap_q       <= gap;
      found_deep_q      <= deep;
    end

  assign m_valid          = valid_q;
  assign m_outcome        = last_q & (separated | (is_crossing & ~to_tetrahedron));
  assign m_proceed        = last_q & ~separated & (~is_crossing | to_tetrahedron);
  assign m_separated      = separated;
  assign m_witness        = witness;
  // without a warped quad the set of axes is complete
  assign m_certain        = separated ? gap : certain | (deep & ~warped);
  assign m_deep           = deep;
  assign m_to_tetrahedron = to_tetrahedron;

  wire unused = &{1'b0, info, code, k, l, first_k, first_l, plan_q};

endmodule
`default_nettype wire
