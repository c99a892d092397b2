// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_axis_programme: what follows a verdict: the outcome of the pair, or its next axis.
//   latency      combinational from s_* to m_*; what an EXHAUSTIVE pair has found so far is registered
//   throughput   one verdict per clock
//   reset        none: the registers are rewritten by the first verdicts of every EXHAUSTIVE pair
// A "no" is given only when the intervals of all vertices are disjoint on an axis (s_separated) or the
// boxes are; signs choose the next axis and never decide.
//   NORMALS      nA, nB, then
//   TETRAHEDRON  if a quad is warped and CROSSING cannot be certain: face normals of the warped ones, cross
//                axes over all their edges
//   DEGENERATE   else if none is warped and a normal is zero: boxes, e_k x f_l, e_k x u_d, f_l x u_d
//   COPLANAR     else if none is warped and B lies in A's plane: in-plane axes of A, then of B
//   CROSSING     else: zeros count as negative if the primitive has no negative vertex, else as
//                positive; the edges of A and of B from + to -, then those from - to +. A warped quad
//                is hit only if every sign is certain (docs/architecture.md), else TETRAHEDRON decides
// State, from the top: certain (all signs used so far), open (a warped quad was not decided exactly),
// beats issued before this one (6), info (17), code (9), programme (3). info by programme:
//   NORMALS (nB)  {warped A, largest (2), nA zero (3), nA negative (3), W zero (4), W negative (4)}
//   CROSSING      [5:4] warped B, A, [3:0] {k, l} of the second axis
//   COPLANAR      [1:0] n_d negative of B, of A
//   DEGENERATE    [11:0] {nB zero, nB negative, nA zero, nA negative}
//   TETRAHEDRON   [1:0] warped B, A
module cchip_axis_programme #(
    // vertices of A and of B: 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,
    // 0: warped quads skip TETRAHEDRON and are left open
    parameter integer WARPED_EXACT = 1
) (
    input  wire                       clk,
    input  wire                       s_valid,
    input  wire [               36:0] s_state,
    input  wire                       s_separated,
    input  wire                       s_certain_gap,
    input  wire [VERTS_A+VERTS_B-4:0] s_negative,
    input  wire [VERTS_A+VERTS_B-4:0] s_zero,
    input  wire [VERTS_A+VERTS_B-4:0] s_certain,
    input  wire                       s_clear,     // see cchip_sat_compare: on a normal, all sides are certain
    input  wire [                2:0] s_axis_negative,
    input  wire [                2:0] s_axis_zero,
    input  wire [                1:0] s_axis_largest,
    input  wire                       s_box_separated,
    input  wire                       s_box_certain,
    output reg                        m_outcome,   // the pair is decided
    output reg                        m_grid,      // no axis separates
    output reg                        m_certain,   // holds for the unrounded primitives
    output reg                        m_open,      // left undecided (WARPED_EXACT = 0)
    output reg                        m_illegal,
    output reg  [                8:0] m_witness,
    output wire [                5:0] m_beats,
    output reg                        m_proceed,   // m_state goes on
    output wire [               36:0] m_state
);

`include "cchip_defs.vh"

  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);
  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;

  wire [2:0] programme = s_state[2:0];
  wire [8:0] code = s_state[11:3];
  wire [2:0] axis_class = code[8:6];
  wire [2:0] k = code[5:3];
  wire [2:0] l = code[2:0];
  wire [16:0] info = s_state[28:12];
  wire [5:0] beats = s_state[34:29];
  wire open = s_state[35];
  wire certain = s_state[36];
  wire exhaustive = programme == `CCHIP_PROG_EXHAUSTIVE;
  wire normal_a = axis_class == `CCHIP_AXIS_NORMAL_A;
  wire normal_b = axis_class == `CCHIP_AXIS_NORMAL_B;

  assign m_beats = m_illegal ? 6'd0 : beats + 6'd1;

  // ---- sides: signs of the other primitive's vertices on a normal; vertex 3 of a triangle as zero
  wire [3:0] b_negative, b_zero, a_negative, a_zero;
  generate
    if (VERTS_B == 4) begin : gen_b_quad
      assign b_negative = s_negative[POINTS-1-:4];
      assign b_zero     = s_zero[POINTS-1-:4];
    end else begin : gen_b_triangle
      assign b_negative = {1'b0, s_negative[POINTS-1-:3]};
      assign b_zero     = {1'b1, s_zero[POINTS-1-:3]};
    end
    if (VERTS_A == 4) begin : gen_a_quad
      assign a_negative = s_negative[POINTS-1-:4];
      assign a_zero     = s_zero[POINTS-1-:4];
    end else begin : gen_a_triangle
      assign a_negative = {1'b0, s_negative[POINTS-1-:3]};
      assign a_zero     = {1'b1, s_zero[POINTS-1-:3]};
    end
  endgenerate

  // on normal k = 0 of a quad slot 0 is V1: off the plane through V0 parallel to the diagonals?
  wire warped_a_now = VERTS_A == 4 && !s_zero[0];
  wire warped_b_now = VERTS_B == 4 && !s_zero[0];
  wire [16:0] normal_a_info = {warped_a_now, s_axis_largest, s_axis_zero, s_axis_negative, b_zero, b_negative};

  // ---- EXHAUSTIVE: found so far
  reg  [16:0] found_a_q;        // of beat nA
  reg         found_certain_q;  // signs on nA, then on both normals, then on the crossing axes too
  reg         found_separated_q, found_gap_q;
  reg  [ 8:0] found_witness_q;
  reg  [30:0] found_plan_q;     // what the normals lead to: a state without beats

  // ---- plan: the state after both normals, when nB's verdict is here
  wire [16:0] about_a = exhaustive ? found_a_q : info;
  wire [3:0] side_b_negative = about_a[3:0];
  wire [3:0] side_b_zero = about_a[7:4];
  wire [2:0] na_negative = about_a[10:8];
  wire [2:0] na_zero = about_a[13:11];
  wire [1:0] largest = about_a[15:14];
  wire warped_a = about_a[16];
  wire warped_b = warped_b_now;
  wire warped = warped_a | warped_b;
  wire certain_before = exhaustive ? found_certain_q : certain;
  wire certain_sides = certain_before & s_clear;

  function [8:0] tetra_code(input a_is_warped);
    tetra_code = {a_is_warped ? `CCHIP_AXIS_NORMAL_A : `CCHIP_AXIS_NORMAL_B, 3'd1, 3'd0};
  endfunction

  // first edge i -> i + 1 that leads from the side from_positive to the other; 0 if there is none
  function [1:0] crossing_edge(input [3:0] negative, input [3:0] zero, input quad, input from_positive);
    reg [3:0] side, follow;
    integer i;
    begin
      side   = ~negative & (~zero | {4{|negative}});
      if (!quad) side[3] = side[0];
      follow = {side[0], side[3:1]};
      crossing_edge = 2'd0;
      for (i = 3; i >= 0; i = i - 1)
        if ((quad || i < 3) && side[i] == from_positive && follow[i] != from_positive) crossing_edge = i[1:0];
    end
  endfunction

  wire [1:0] k_down = crossing_edge(a_negative, a_zero, VERTS_A == 4, 1'b1);
  wire [1:0] k_up = crossing_edge(a_negative, a_zero, VERTS_A == 4, 1'b0);
  wire [1:0] l_down = crossing_edge(side_b_negative, side_b_zero, VERTS_B == 4, 1'b1);
  wire [1:0] l_up = crossing_edge(side_b_negative, side_b_zero, VERTS_B == 4, 1'b0);
  wire [2:0] largest_mask = 3'd1 << largest;

  reg [2:0] plan_programme;
  reg [8:0] plan_code;
  reg [16:0] plan_info;
  always @* begin
    if (warped && WARPED_EXACT != 0 && !certain_sides) begin
      plan_programme = `CCHIP_PROG_TETRAHEDRON;
      plan_code      = tetra_code(warped_a);
      plan_info      = {15'd0, warped_b, warped_a};
    end else if (!warped && (&na_zero || &s_axis_zero)) begin
      plan_programme = `CCHIP_PROG_DEGENERATE;
      plan_code      = {`CCHIP_AXIS_CROSS, 6'd0};
      plan_info      = {5'd0, s_axis_zero, s_axis_negative, na_zero, na_negative};
    end else if (!warped && &side_b_zero) begin
      plan_programme = `CCHIP_PROG_COPLANAR;
      plan_code      = {`CCHIP_AXIS_IN_PLANE_A, 3'd0, 1'b0, largest};
      plan_info      = {15'd0, |(s_axis_negative & largest_mask), |(na_negative & largest_mask)};
    end else begin
      plan_programme = `CCHIP_PROG_CROSSING;
      plan_code      = {`CCHIP_AXIS_CROSS, 1'b0, k_down, 1'b0, l_down};
      plan_info      = {11'd0, warped_b, warped_a, k_up, l_up};
    end
  end
  wire plan_open = warped && WARPED_EXACT == 0;
  wire [30:0] plan = {certain_sides, plan_open, plan_info, plan_code, plan_programme};

  // ---- CROSSING: t(k, l) is the projection of W_l; certain: t > 0 on the first, t < 0 on the second axis
  wire second = {k[1:0], l[1:0]} == info[3:0];
  wire certain_crossing = certain & s_certain[VERTS_A-2] & s_negative[VERTS_A-2] == second;
  wire to_tetra = WARPED_EXACT != 0 && |info[5:4] && !certain_crossing;

  // ---- next axis of the other programmes
  wire tetra_a = info[0];
  wire tetra_b = info[1];
  wire tetra = programme == `CCHIP_PROG_TETRAHEDRON;
  wire degenerate = programme == `CCHIP_PROG_DEGENERATE;
  wire [2:0] last_k = tetra && tetra_a ? 3'd5 : LAST_K[2:0];
  wire [2:0] last_l = tetra && tetra_b ? 3'd5 : LAST_L[2:0];
  reg [8:0] next_code;
  reg last_axis;
  always @* begin
    next_code = {axis_class, k + 3'd1, l};
    last_axis = 1'b0;
    case (axis_class)
      `CCHIP_AXIS_NORMAL_A: if (k == 3'd4) next_code = tetra_b ? {`CCHIP_AXIS_NORMAL_B, 6'o10} : {`CCHIP_AXIS_CROSS, 6'd0};
      `CCHIP_AXIS_NORMAL_B: if (k == 3'd4) next_code = {`CCHIP_AXIS_CROSS, 6'd0};
      `CCHIP_AXIS_CROSS:
      if (l != last_l) next_code = {axis_class, k, l + 3'd1};
      else if (k != last_k) next_code = {axis_class, k + 3'd1, 3'd0};
      else begin
        next_code = {`CCHIP_AXIS_IN_PLANE_A, 6'd0};
        last_axis = tetra;
      end
      `CCHIP_AXIS_IN_PLANE_A:
      if (degenerate && l != 3'd2) next_code = {axis_class, k, l + 3'd1};
      else if (k != LAST_K[2:0]) next_code = {axis_class, k + 3'd1, degenerate ? 3'd0 : l};
      else next_code = {`CCHIP_AXIS_IN_PLANE_B, 3'd0, degenerate ? 3'd0 : l};
      default: begin
        if (degenerate && l != 3'd2) next_code = {axis_class, k, l + 3'd1};
        else if (k != LAST_L[2:0]) next_code = {axis_class, k + 3'd1, degenerate ? 3'd0 : l};
        else last_axis = 1'b1;
      end
    endcase
  end

  wire box = degenerate && axis_class == `CCHIP_AXIS_CROSS && k == 3'd0 && s_box_separated;

  // ---- EXHAUSTIVE
  wire first = normal_a;  // k = 0: the first axis
  wire separated_before = ~first & found_separated_q;
  wire found_separated = separated_before | s_separated;
  wire [8:0] found_witness = separated_before ? found_witness_q : s_separated ? code : 9'd0;
  wire found_gap = separated_before ? found_gap_q : s_certain_gap;
  wire exhaustive_last = axis_class == `CCHIP_AXIS_CROSS && k == LAST_K[2:0] && l == LAST_L[2:0];
  wire plan_is_crossing = found_plan_q[2:0] == `CCHIP_PROG_CROSSING;
  wire found_second = {k[1:0], l[1:0]} == found_plan_q[15:12];
  wire crosses = axis_class == `CCHIP_AXIS_CROSS && (code == found_plan_q[11:3] || found_second);
  wire found_to_tetra = WARPED_EXACT != 0 && plan_is_crossing && |found_plan_q[17:16] && !found_certain;
  wire found_certain = first ? s_clear
                     : normal_b ? certain_sides
                                : found_certain_q & (~crosses | (s_certain[VERTS_A-2] & s_negative[VERTS_A-2] == found_second));

  always @(posedge clk)
    if (s_valid && exhaustive) begin
      if (normal_a) found_a_q <= normal_a_info;
      if (normal_b) found_plan_q <= plan;
      found_certain_q   <= found_certain;
      found_separated_q <= found_separated;
      found_witness_q   <= found_witness;
      found_gap_q       <= found_gap;
    end

  // ---- outcome or next state
  reg [8:0] state_code;
  reg [16:0] state_info;
  reg state_certain;
  reg take_plan, take_found_plan, take_tetra;

  always @* begin
    m_outcome       = s_valid;
    m_grid          = 1'b0;
    m_certain       = s_certain_gap;
    m_open          = 1'b0;
    m_illegal       = 1'b0;
    m_witness       = code;
    state_code      = next_code;
    state_info      = info;
    state_certain   = certain;
    take_plan       = 1'b0;
    take_found_plan = 1'b0;
    take_tetra      = 1'b0;
    case (programme)
      `CCHIP_PROG_EXHAUSTIVE: begin
        m_witness = found_witness;
        m_certain = found_gap;
        if (!exhaustive_last) m_outcome = 1'b0;
        else if (!found_separated) begin
          m_grid          = 1'b1;
          m_open          = found_plan_q[29];
          m_certain       = found_certain;
          m_outcome       = s_valid && plan_is_crossing && !found_to_tetra;
          take_found_plan = !found_to_tetra;
          take_tetra      = found_to_tetra;
        end
      end
      `CCHIP_PROG_NORMALS:
      if (!s_separated) begin
        m_outcome     = 1'b0;
        take_plan     = normal_b;
        state_code    = {`CCHIP_AXIS_NORMAL_B, 6'd0};
        state_info    = normal_a_info;
        state_certain = s_clear;
      end
      `CCHIP_PROG_CROSSING:
      if (!s_separated) begin
        m_outcome     = s_valid && second && !to_tetra;
        m_grid        = 1'b1;
        m_open        = open;
        m_certain     = certain_crossing;
        m_witness     = 9'd0;
        state_code    = {`CCHIP_AXIS_CROSS, 1'b0, info[3:2], 1'b0, info[1:0]};
        state_certain = certain_crossing;
        take_tetra    = to_tetra;
      end
      `CCHIP_PROG_ILLEGAL: begin
        m_grid    = 1'b1;
        m_illegal = 1'b1;
        m_witness = {`CCHIP_AXIS_ILLEGAL, 6'd0};
      end
      default:
      if (box) begin
        m_witness = {`CCHIP_AXIS_BOX, 3'd0, l};
        m_certain = s_box_certain;
      end else if (!s_separated) begin
        m_outcome = s_valid && last_axis;
        m_grid    = 1'b1;
        m_open    = open;
        m_certain = 1'b0;
        m_witness = 9'd0;
      end
    endcase
    m_proceed = s_valid && !m_outcome && (!exhaustive || exhaustive_last);
  end

  wire [1:0] tetra_flags = exhaustive ? found_plan_q[17:16] : info[5:4];
  wire [30:0] state = take_plan ? plan
                    : take_found_plan ? found_plan_q
                    : take_tetra ? {state_certain, open, 15'd0, tetra_flags, tetra_code(tetra_flags[0]), `CCHIP_PROG_TETRAHEDRON}
                                      : {state_certain, open, state_info, state_code, programme};
  assign m_state = {state[30:29], beats + 6'd1, state[28:0]};

  wire unused = &{1'b0, s_negative, s_certain};

endmodule
`default_nettype wire
