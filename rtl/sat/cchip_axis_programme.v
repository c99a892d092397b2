// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_axis_programme: what follows a verdict: the outcome of the pair, or its next axis.
//   latency      CCHIP_PROGRAMME_LATENCY = 4 clocks: 1 decodes verdict and state, 2 makes the plan,
//                3 joins it with what an EXHAUSTIVE pair found before, 4 selects the next state
//   throughput   one verdict per clock
//   reset        valid bits only: what is remembered of an EXHAUSTIVE pair is overwritten by the
//                first verdicts of the next such pair
// A "no" is given only when the intervals of all vertices are disjoint on an axis (s_separated) or
// the boxes are; signs choose the next axis and never decide.
//   NORMALS      nA, nB, then
//   TETRAHEDRON  if a quad is warped and CROSSING cannot be certain: face normals of the warped
//                ones, cross axes over all their edges
//   DEGENERATE   else if none is warped and a normal is zero: boxes, e_k x f_l, e_k x u_d, f_l x
//                u_d
//   COPLANAR     else if none is warped and B lies in A's plane: in-plane axes of A, then of B
//   CROSSING     else: zeros count as negative if the primitive has no negative vertex, else as
//                positive; the edges of A and of B from + to -, then those from - to +. A warped
//                quad is hit only if every sign is certain (docs/architecture.md), else TETRAHEDRON
//                decides
// The state is the record STATE of docs/definitions.md. Its field info holds a record of its own
// for each programme: INFO_NORMALS (after nA), INFO_CROSSING, INFO_COPLANAR, INFO_DEGENERATE,
// INFO_TETRAHEDRON.
// The verdicts of an EXHAUSTIVE pair come on consecutive clocks.
module cchip_axis_programme #(
    // vertices of A and of B: 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,
    // 0: warped quads skip TETRAHEDRON and are left open
    parameter integer WARPED_EXACT = 1
) (
    input  wire                          clk,
    input  wire                          rst,
    input  wire                          s_valid,
    input  wire [    `CCHIP_STATE_W-1:0] s_state,
    input  wire                          s_separated,
    input  wire                          s_certain_gap,
    input  wire [   VERTS_A+VERTS_B-4:0] s_negative,
    input  wire [   VERTS_A+VERTS_B-4:0] s_zero,
    input  wire                          s_certain,        // the sign of point VERTS_A - 2
    // see cchip_sat_compare: on a normal, all sides are certain
    input  wire                          s_clear,
    input  wire [                   2:0] s_axis_negative,
    input  wire [                   2:0] s_axis_zero,
    input  wire [                   1:0] s_axis_largest,
    input  wire                          s_box_separated,
    input  wire                          s_box_certain,
    output wire                          m_outcome,        // the pair is decided
    output wire                          m_grid,           // no axis separates
    output wire                          m_certain,        // holds for the unrounded primitives
    output wire                          m_open,           // left undecided (WARPED_EXACT = 0)
    output wire                          m_illegal,
    output wire [`CCHIP_AXIS_CODE_W-1:0] m_witness,
    output wire [    `CCHIP_BEATS_W-1:0] m_beats,
    output wire                          m_proceed,        // m_state is the pair's next beat
    output wire [    `CCHIP_STATE_W-1:0] m_state
);

  reg m_outcome_q;
  reg m_grid_q;
  reg m_certain_q;
  reg m_open_q;
  reg m_illegal_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] m_witness_q;
  reg [`CCHIP_BEATS_W-1:0] m_beats_q;
  reg m_proceed_q;
  reg [`CCHIP_STATE_W-1:0] m_state_q;
  assign m_outcome = m_outcome_q;
  assign m_grid = m_grid_q;
  assign m_certain = m_certain_q;
  assign m_open = m_open_q;
  assign m_illegal = m_illegal_q;
  assign m_witness = m_witness_q;
  assign m_beats = m_beats_q;
  assign m_proceed = m_proceed_q;
  assign m_state = m_state_q;

  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);
  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;
  // a plan: {certain, open, info, code, programme}, a state without beats
  localparam integer PLAN_W = `CCHIP_STATE_W - `CCHIP_BEATS_W;
  // warped quads may have to go through TETRAHEDRON
  localparam integer TETRA = VERTS_B == 4 && WARPED_EXACT != 0 ? 1 : 0;

  // ================ clock 1: what the verdict and the state say
  wire [`CCHIP_PROG_W-1:0] programme = s_state[`CCHIP_STATE_PROGRAMME];
  wire [`CCHIP_AXIS_CODE_W-1:0] code = s_state[`CCHIP_STATE_CODE];
  wire [`CCHIP_CLASS_W-1:0] axis_class = code[`CCHIP_AXIS_CODE_CLASS];
  wire [`CCHIP_INDEX_W-1:0] k = code[`CCHIP_AXIS_CODE_K];
  wire [`CCHIP_INDEX_W-1:0] l = code[`CCHIP_AXIS_CODE_L];
  wire [`CCHIP_INFO_W-1:0] info = s_state[`CCHIP_STATE_INFO];
  wire [`CCHIP_BEATS_W-1:0] beats = s_state[`CCHIP_STATE_BEATS];
  wire exhaustive = programme == `CCHIP_PROG_EXHAUSTIVE;
  wire tetra = programme == `CCHIP_PROG_TETRAHEDRON;
  wire degenerate = programme == `CCHIP_PROG_DEGENERATE;

  // ---- sides: signs of the other primitive's vertices on a normal; vertex 3 of a triangle as zero
  // the last `verts` points are the vertices
  function [3:0] vertices(input [POINTS-1:0] points, input absent, input integer verts);
    integer i;
    begin
      vertices = {4{absent}};
      for (i = 0; i < verts; i = i + 1) vertices[i] = points[POINTS-verts+i];
    end
  endfunction
  wire [3:0] b_negative = vertices(s_negative, 1'b0, VERTS_B);
  wire [3:0] b_zero = vertices(s_zero, 1'b1, VERTS_B);
  wire [3:0] a_negative = vertices(s_negative, 1'b0, VERTS_A);
  wire [3:0] a_zero = vertices(s_zero, 1'b1, VERTS_A);

  // vertices on the positive side; those on the plane count among them if any is negative
  function [3:0] positive_side(input [3:0] negative, input [3:0] zero, input quad);
    begin
      positive_side = ~negative & (~zero | {4{|negative}});
      if (!quad) positive_side[3] = positive_side[0];
    end
  endfunction

  // first edge i -> i + 1 that leads from the side from_positive to the other; 0 if there is none
  function [1:0] crossing_edge(input [3:0] side, input quad, input from_positive);
    reg [3:0] follow;
    integer i;
    begin
      follow = {side[0], side[3:1]};
      crossing_edge = 2'd0;
      for (i = 3; i >= 0; i = i - 1)
        if ((quad || i < 3) && side[i] == from_positive
            && follow[i] != from_positive) crossing_edge = i[1:0];
    end
  endfunction

  // on normal k = 0 of a quad slot 0 is V1: off the plane through V0 parallel to the diagonals?
  wire warped_a_now = VERTS_A == 4 && !s_zero[0];
  wire warped_b_now = VERTS_B == 4 && !s_zero[0];

  // ---- the last k and l of an axis class in the programmes that visit all of its axes
  wire is_cross = axis_class == `CCHIP_AXIS_CROSS;
  wire is_in_plane_a = axis_class == `CCHIP_AXIS_IN_PLANE_A;
  wire is_in_plane_b = axis_class == `CCHIP_AXIS_IN_PLANE_B;
  wire [2:0] last_k = is_cross
      ? (TETRA != 0 && tetra && info[`CCHIP_INFO_TETRAHEDRON_WARPED_A] ? 3'd5 : LAST_K[2:0])
                    : is_in_plane_a ? LAST_K[2:0] : is_in_plane_b ? LAST_L[2:0] : 3'd4;
  wire [2:0] last_l = !is_cross ? 3'd2 : TETRA != 0 && tetra
      && info[`CCHIP_INFO_TETRAHEDRON_WARPED_B] ? 3'd5 : LAST_L[2:0];
  wire loops_l = is_cross | degenerate;  // l runs through all values for each k; else l stays

  reg valid_q, exhaustive_q, normals_q, crossing_q, illegal_q;
  reg normal_a_q, normal_b_q, exhaustive_last_q, second_q, box_q, box_certain_q;
  reg loops_l_q, l_goes_on_q, k_ends_q, last_kind_q;
  reg separated_q, certain_gap_q, clear_q, sign_certain_q, sign_negative_q, certain_q, open_q,
      certain_before_q;
  reg [2:0] programme_q, axis_negative_q, axis_zero_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] code_q;
  reg [2:0] k_next_q, l_next_q;
  reg [`CCHIP_INFO_W-1:0] info_q, about_a_q;
  reg [`CCHIP_BEATS_W-1:0] beats_q;
  reg warped_a_q, warped_b_q, warped_q, b_on_plane_q, no_normal_q;
  reg [1:0] largest_q;
  reg [3:0] side_a_q, side_b_q;
  reg [2:0] next_class_q, next_k_q;
  // the info of NORMALS after nA
  wire [`CCHIP_INFO_W-1:0] normal_a_info = {
    warped_a_q,
    largest_q,
    axis_zero_q,
    axis_negative_q,
    b_on_plane_q,
    crossing_edge(side_b_q, VERTS_B == 4, 1'b0),
    crossing_edge(side_b_q, VERTS_B == 4, 1'b1)
  };

  always @(posedge clk) begin
    if (rst) valid_q <= 1'b0;
    else valid_q <= s_valid;
    programme_q       <= programme;
    exhaustive_q      <= exhaustive;
    normals_q         <= programme == `CCHIP_PROG_NORMALS;
    crossing_q        <= programme == `CCHIP_PROG_CROSSING;
    illegal_q         <= programme == `CCHIP_PROG_ILLEGAL;
    code_q            <= code;
    info_q            <= info;
    beats_q           <= beats + 6'd1;
    open_q            <= s_state[`CCHIP_STATE_OPEN];
    certain_q         <= s_state[`CCHIP_STATE_CERTAIN];
    normal_a_q        <= axis_class == `CCHIP_AXIS_NORMAL_A;
    normal_b_q        <= axis_class == `CCHIP_AXIS_NORMAL_B;
    exhaustive_last_q <= is_cross && k == LAST_K[2:0] && l == LAST_L[2:0];
    loops_l_q         <= loops_l;
    l_goes_on_q       <= loops_l && l != last_l;
    k_ends_q          <= k == last_k;
    last_kind_q       <= tetra ? is_cross : !is_cross && !is_in_plane_a;
    k_next_q          <= k + 3'd1;
    l_next_q          <= l + 3'd1;
    second_q          <= {k[1:0], l[1:0]} == {info[`CCHIP_INFO_CROSSING_K_UP],
        info[`CCHIP_INFO_CROSSING_L_UP]};
    box_q             <= degenerate && is_cross && k == 3'd0 && s_box_separated;
    box_certain_q     <= s_box_certain;
    separated_q       <= s_separated;
    certain_gap_q     <= s_certain_gap;
    clear_q           <= s_clear;
    sign_certain_q    <= s_certain;
    sign_negative_q   <= s_negative[VERTS_A-2];
    axis_negative_q   <= s_axis_negative;
    axis_zero_q       <= s_axis_zero;
    warped_a_q        <= warped_a_now;
    largest_q         <= s_axis_largest;
    b_on_plane_q      <= &b_zero;
    side_a_q          <= positive_side(a_negative, a_zero, VERTS_A == 4);
    side_b_q          <= positive_side(b_negative, b_zero, VERTS_B == 4);
    // nB of an EXHAUSTIVE pair follows its nA at once
    about_a_q         <= exhaustive ? normal_a_info : info;
    certain_before_q  <= exhaustive ? clear_q : s_state[`CCHIP_STATE_CERTAIN];
    no_normal_q       <= (exhaustive ? &axis_zero_q : &info[`CCHIP_INFO_NORMALS_A_ZERO])
        || &s_axis_zero;
    warped_b_q        <= warped_b_now;
    warped_q          <= (VERTS_A == 4
        && (exhaustive ? warped_a_q : info[`CCHIP_INFO_NORMALS_WARPED_A])) || warped_b_now;
    // the class that follows the last axis of this one
    next_class_q      <= axis_class == `CCHIP_AXIS_NORMAL_A
        && info[`CCHIP_INFO_TETRAHEDRON_WARPED_B] ? `CCHIP_AXIS_NORMAL_B
                       : axis_class == `CCHIP_AXIS_NORMAL_A || axis_class == `CCHIP_AXIS_NORMAL_B
                           ? `CCHIP_AXIS_CROSS
                       : is_cross ? `CCHIP_AXIS_IN_PLANE_A : `CCHIP_AXIS_IN_PLANE_B;
    next_k_q          <= {2'd0, axis_class == `CCHIP_AXIS_NORMAL_A
        && info[`CCHIP_INFO_TETRAHEDRON_WARPED_B]};
  end

  // ================ clock 2: the plan that follows the verdict of nB
  wire [1:0] k_down = crossing_edge(side_a_q, VERTS_A == 4, 1'b1);
  wire [1:0] k_up = crossing_edge(side_a_q, VERTS_A == 4, 1'b0);
  wire [1:0] l_down = about_a_q[`CCHIP_INFO_NORMALS_L_DOWN];
  wire [1:0] l_up = about_a_q[`CCHIP_INFO_NORMALS_L_UP];
  wire b_on_plane = about_a_q[`CCHIP_INFO_NORMALS_B_ON_PLANE];
  wire [2:0] na_negative = about_a_q[`CCHIP_INFO_NORMALS_A_NEGATIVE];
  wire [2:0] na_zero = about_a_q[`CCHIP_INFO_NORMALS_A_ZERO];
  wire [1:0] largest = about_a_q[`CCHIP_INFO_NORMALS_LARGEST];
  wire warped_a = about_a_q[`CCHIP_INFO_NORMALS_WARPED_A];
  wire certain_sides = certain_before_q & clear_q;
  wire [2:0] largest_mask = 3'd1 << largest;

  function [`CCHIP_AXIS_CODE_W-1:0] tetra_code(input a_is_warped);
    tetra_code = {a_is_warped ? `CCHIP_AXIS_NORMAL_A : `CCHIP_AXIS_NORMAL_B, 3'd1, 3'd0};
  endfunction

  reg [`CCHIP_PROG_W-1:0] plan_programme;
  reg [`CCHIP_AXIS_CODE_W-1:0] plan_code;
  reg [`CCHIP_INFO_W-1:0] plan_info;
  always @* begin
    if (TETRA != 0 && warped_q && !certain_sides) begin
      plan_programme = `CCHIP_PROG_TETRAHEDRON;
      plan_code      = tetra_code(warped_a);
      plan_info      = {12'd0, warped_b_q, warped_a};
    end else if (!warped_q && no_normal_q) begin
      plan_programme = `CCHIP_PROG_DEGENERATE;
      plan_code      = {`CCHIP_AXIS_CROSS, 6'd0};
      plan_info      = {2'd0, axis_zero_q, axis_negative_q, na_zero, na_negative};
    end else if (!warped_q && b_on_plane) begin
      plan_programme = `CCHIP_PROG_COPLANAR;
      plan_code      = {`CCHIP_AXIS_IN_PLANE_A, 3'd0, 1'b0, largest};
      plan_info      = {12'd0, |(axis_negative_q & largest_mask), |(na_negative & largest_mask)};
    end else begin
      plan_programme = `CCHIP_PROG_CROSSING;
      plan_code      = {`CCHIP_AXIS_CROSS, 1'b0, k_down, 1'b0, l_down};
      plan_info      = {8'd0, warped_b_q, warped_a, k_up, l_up};
    end
  end
  wire plan_open = warped_q && WARPED_EXACT == 0;
  wire [PLAN_W-1:0] plan = {certain_sides, plan_open, plan_info, plan_code, plan_programme};

  // ---- CROSSING: t(k, l) is the projection of W_l; certain: t > 0 on the first, t < 0 on the
  // second axis
  wire certain_crossing = certain_q && sign_certain_q && sign_negative_q == second_q;
  wire warped_a_crossing = info_q[`CCHIP_INFO_CROSSING_WARPED_A];
  wire warped_b_crossing = info_q[`CCHIP_INFO_CROSSING_WARPED_B];
  wire to_tetra = TETRA != 0 && (warped_a_crossing || warped_b_crossing) && !certain_crossing;

  // ---- EXHAUSTIVE: the same test on the two axes that CROSSING would visit
  reg [PLAN_W-1:0] found_plan_q;  // what the normals lead to
  always @(posedge clk) if (valid_q && exhaustive_q && normal_b_q) found_plan_q <= plan;
  wire [`CCHIP_INFO_W-1:0] found_info = found_plan_q[`CCHIP_STATE_INFO];
  wire [`CCHIP_AXIS_CODE_W-1:0] found_code = found_plan_q[`CCHIP_STATE_CODE];
  wire [1:0] found_warped = {found_info[`CCHIP_INFO_CROSSING_WARPED_B],
                             found_info[`CCHIP_INFO_CROSSING_WARPED_A]};
  wire found_second = {code_q[4:3], code_q[1:0]} ==
      {found_info[`CCHIP_INFO_CROSSING_K_UP], found_info[`CCHIP_INFO_CROSSING_L_UP]};
  wire found_first = {code_q[4:3], code_q[1:0]} == {found_code[4:3], found_code[1:0]};

  // ---- next axis of the programmes that visit all axes: the next l, the next k, the next class
  wire [`CCHIP_AXIS_CODE_W-1:0] next_code = l_goes_on_q ? {code_q[8:3], l_next_q}
                       : {k_ends_q ? {next_class_q, next_k_q} : {code_q[8:6], k_next_q}, loops_l_q
                           ? 3'd0 : code_q[2:0]};
  wire last_axis = last_kind_q & k_ends_q & ~l_goes_on_q;

  // ---- outcome of every programme but EXHAUSTIVE
  reg outcome, grid, certain, open, illegal;
  reg [`CCHIP_AXIS_CODE_W-1:0] witness;
  always @* begin
    outcome = 1'b1;
    grid    = 1'b0;
    certain = certain_gap_q;
    open    = open_q & ~(illegal_q | box_q | separated_q | normals_q);
    illegal = 1'b0;
    witness = code_q;
    if (illegal_q) begin
      grid    = 1'b1;
      illegal = 1'b1;
      witness = {`CCHIP_AXIS_ILLEGAL, 6'd0};
    end else if (box_q) begin
      witness = {`CCHIP_AXIS_BOX, 3'd0, code_q[2:0]};
      certain = box_certain_q;
    end else if (!separated_q) begin
      if (normals_q) outcome = 1'b0;
      else begin
        outcome = crossing_q ? second_q && !to_tetra : last_axis;
        grid    = 1'b1;
        certain = crossing_q & certain_crossing;
        witness = 9'd0;
      end
    end
  end

  // ---- next state, used if the pair is not decided
  wire take_plan = normals_q & normal_b_q;
  wire take_tetra = crossing_q & to_tetra;
  wire state_certain = normals_q ? clear_q : crossing_q ? certain_crossing : certain_q;
  wire [`CCHIP_INFO_W-1:0] state_info = normals_q ? normal_a_info : info_q;
  wire [`CCHIP_AXIS_CODE_W-1:0] state_code = normals_q ? {`CCHIP_AXIS_NORMAL_B, 6'd0}
                        : crossing_q
                            ? {`CCHIP_AXIS_CROSS, 1'b0, info_q[`CCHIP_INFO_CROSSING_K_UP], 1'b0,
                             info_q[`CCHIP_INFO_CROSSING_L_UP]}
                                     : next_code;

  reg valid_q2, exhaustive_q2, exhaustive_last_q2, normal_a_q2, normal_q2;
  reg separated_q2, certain_gap_q2, certain_sides_q2, still_certain_q2;
  reg outcome_q2, grid_q2, certain_q2, open_q2, illegal_q2, take_plan_q2, take_tetra_q2;
  reg [`CCHIP_AXIS_CODE_W-1:0] code_q2, witness_q2;
  reg [`CCHIP_BEATS_W-1:0] beats_q2;
  reg [1:0] warped_q2;
  reg [PLAN_W-1:0] plan_q2, state_q2;
  always @(posedge clk) begin
    if (rst) valid_q2 <= 1'b0;
    else valid_q2 <= valid_q;
    exhaustive_q2      <= exhaustive_q;
    exhaustive_last_q2 <= exhaustive_last_q;
    normal_a_q2        <= normal_a_q;
    normal_q2          <= normal_a_q | normal_b_q;
    separated_q2       <= separated_q;
    certain_gap_q2     <= certain_gap_q;
    certain_sides_q2   <= normal_a_q | certain_sides;  // after nA: nB tells for both
    still_certain_q2   <= !(found_first || found_second)
        || (sign_certain_q && sign_negative_q == found_second);
    outcome_q2         <= outcome;
    grid_q2            <= grid;
    certain_q2         <= certain;
    open_q2            <= open;
    illegal_q2         <= illegal;
    code_q2            <= code_q;
    witness_q2         <= witness;
    beats_q2           <= beats_q;
    take_plan_q2       <= take_plan;
    take_tetra_q2      <= take_tetra;
    warped_q2          <= {warped_b_crossing, warped_a_crossing};
    plan_q2            <= plan;
    state_q2           <= {state_certain, open_q, state_info, state_code, programme_q};
  end

  // ================ clock 3: what an EXHAUSTIVE pair has found so far
  reg found_certain_q;  // signs on both normals, then on the crossing axes too
  reg found_separated_q, found_gap_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] found_witness_q;
  wire separated_before = ~normal_a_q2 & found_separated_q;  // nA is the first axis
  wire found_separated = separated_before | separated_q2;
  wire [`CCHIP_AXIS_CODE_W-1:0] found_witness = separated_before ? found_witness_q : separated_q2
      ? code_q2 : 9'd0;
  wire found_gap = separated_before ? found_gap_q : certain_gap_q2;
  wire found_certain = normal_q2 ? certain_sides_q2 : found_certain_q & still_certain_q2;
  wire plan_is_crossing = found_plan_q[`CCHIP_STATE_PROGRAMME] == `CCHIP_PROG_CROSSING;
  wire found_to_tetra = TETRA != 0 && plan_is_crossing && found_warped != 2'd0 && !found_certain;

  always @(posedge clk)
    if (valid_q2 && exhaustive_q2) begin
      found_certain_q   <= found_certain;
      found_separated_q <= found_separated;
      found_witness_q   <= found_witness;
      found_gap_q       <= found_gap;
    end

  wire found_outcome = exhaustive_last_q2
      & (found_separated | (plan_is_crossing & ~found_to_tetra));
  wire found_proceed = exhaustive_last_q2 & ~found_separated & (~plan_is_crossing | found_to_tetra);

  reg outcome_q3, proceed_q3, grid_q3, certain_q3, open_q3, illegal_q3;
  reg take_plan_q3, take_found_q3, take_tetra_q3;
  reg [`CCHIP_AXIS_CODE_W-1:0] witness_q3;
  reg [`CCHIP_BEATS_W-1:0] beats_q3;
  reg [1:0] warped_q3;
  reg [PLAN_W-1:0] plan_q3, state_q3;
  always @(posedge clk) begin
    if (rst) outcome_q3 <= 1'b0;
    else outcome_q3 <= valid_q2 & (exhaustive_q2 ? found_outcome : outcome_q2);
    if (rst) proceed_q3 <= 1'b0;
    else proceed_q3 <= valid_q2 & (exhaustive_q2 ? found_proceed : ~outcome_q2);
    grid_q3       <= exhaustive_q2 ? ~found_separated : grid_q2;
    certain_q3    <= exhaustive_q2 ? (found_separated ? found_gap : found_certain) : certain_q2;
    open_q3       <= exhaustive_q2 ? found_plan_q[PLAN_W-2] & ~found_separated : open_q2;
    illegal_q3    <= illegal_q2;
    witness_q3    <= exhaustive_q2 ? found_witness : witness_q2;
    beats_q3      <= beats_q2;
    take_plan_q3  <= take_plan_q2;
    take_found_q3 <= exhaustive_q2;
    take_tetra_q3 <= exhaustive_q2 ? found_to_tetra : take_tetra_q2;
    warped_q3     <= exhaustive_q2 ? found_warped : warped_q2;
    plan_q3       <= plan_q2;
    state_q3      <= state_q2;
  end

  // ================ clock 4: the next state
  wire [PLAN_W-1:0] state = take_plan_q3 ? plan_q3 : take_found_q3 ? found_plan_q : state_q3;
  always @(posedge clk) begin
    if (rst) m_outcome_q <= 1'b0;
    else m_outcome_q <= outcome_q3;
    if (rst) m_proceed_q <= 1'b0;
    else m_proceed_q <= proceed_q3;
    m_grid_q    <= grid_q3;
    m_certain_q <= certain_q3;
    m_open_q    <= open_q3;
    m_illegal_q <= illegal_q3;
    m_witness_q <= witness_q3;
    m_beats_q   <= illegal_q3 ? 6'd0 : beats_q3;
    m_state_q   <= {state[PLAN_W-1-:2], beats_q3,
                  take_tetra_q3
                      ? {12'd0, warped_q3, tetra_code(warped_q3[0]), `CCHIP_PROG_TETRAHEDRON}
                          : state[PLAN_W-3:0]};
  end

  wire unused = &{1'b0, s_negative, found_info, found_code};

endmodule
`default_nettype wire
