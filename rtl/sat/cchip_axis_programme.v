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
//                quad is hit only if every sign is certain (docs/develop/architecture.md), else
//                TETRAHEDRON decides
//   TETRAHEDRON  also for a hit of CROSSING without a warped quad that only depth can prove: all
//                e_k x f_l, until one of them is not deep
// The state is the record STATE of docs/hardware/definitions.md. Its field info holds a record of
// its own for each programme: INFO_NORMALS (after nA), INFO_CROSSING, INFO_COPLANAR,
// INFO_DEGENERATE, INFO_TETRAHEDRON.
// The verdicts of an EXHAUSTIVE pair come on consecutive clocks.
module cchip_axis_programme #(
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,      // vertices of B (vertex); legal: VERTS_A..4
    // 1: warped quads are decided exactly; 0: no programme TETRAHEDRON for warped quads; what the
    // directed beats do not decide of one is left open; legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    parameter integer EXHAUSTIVE = 1  // 0: there are no EXHAUSTIVE pairs; legal: 0, 1
) (
    input  wire                          clk,              // clock, rising edge
    // synchronous reset, active high: no earlier verdict has an effect
    input  wire                          rst,
    input  wire                          s_valid,          // there is a verdict
    input  wire [    `CCHIP_STATE_W-1:0] s_state,          // programme state of its beat, see below
    input  wire                          s_separated,  // the intervals of all vertices are disjoint
    input  wire                          s_certain_gap,    // for the unrounded primitives too
    input  wire [   VERTS_A+VERTS_B-4:0] s_negative,       // bit i: projected point p_i < 0
    input  wire [   VERTS_A+VERTS_B-4:0] s_zero,           // bit i: p_i = 0
    // the sign of point VERTS_A - 2 (W_l on a cross axis) is that of the unrounded vertices
    input  wire                          s_certain,
    // on a normal: all sides are certain (cchip_sat_compare)
    input  wire                          s_clear,
    // the primitives overlap on the axis by more than the error, both ways
    input  wire                          s_deep,
    input  wire [                   2:0] s_axis_negative,  // components of the axis: < 0
    input  wire [                   2:0] s_axis_zero,      // components of the axis: = 0
    input  wire [                   1:0] s_axis_largest,  // component of the largest absolute value
    // boxes disjoint in component l of the beat's code
    input  wire                          s_box_separated,
    input  wire                          s_box_certain,    // by more than E
    output wire                          m_outcome,        // the pair is decided by this verdict
    output wire                          m_grid,           // no axis separates
    output wire                          m_certain,  // that holds for the unrounded primitives
    output wire                          m_open,           // left undecided (WARPED_EXACT = 0)
    output wire                          m_illegal,        // reserved mode
    output wire [`CCHIP_AXIS_CODE_W-1:0] m_witness,        // axis code of the result
    output wire [    `CCHIP_BEATS_W-1:0] m_beats,  // beats issued for the pair, this one included
    output wire                          m_proceed,        // the pair continues with m_state
    output wire [    `CCHIP_STATE_W-1:0] m_state           // state of its next beat
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

  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;
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
  wire exhaustive = EXHAUSTIVE != 0 && programme == `CCHIP_PROG_EXHAUSTIVE;
  wire tetra = programme == `CCHIP_PROG_TETRAHEDRON;
  wire degenerate = programme == `CCHIP_PROG_DEGENERATE;

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

  // ---- depth: zero and in-plane axes are no facet normals of a solid A - B; it is flat if both
  // normals are zero
  wire flat = degenerate && (&info[`CCHIP_INFO_DEGENERATE_A_ZERO])
      && (&info[`CCHIP_INFO_DEGENERATE_B_ZERO]);

  reg valid_q, exhaustive_q, normals_q, crossing_q, illegal_q;
  reg complete_q, normal_a_q, normal_b_q, exhaustive_last_q, second_q, box_q, box_certain_q;
  reg loops_l_q, l_goes_on_q, k_ends_q, last_kind_q;
  reg separated_q, certain_gap_q, sign_certain_q, sign_negative_q, certain_q, open_q, deep_q,
      depth_only_q;
  reg [`CCHIP_PROG_W-1:0] programme_q;
  reg [`CCHIP_AXIS_CODE_W-1:0] code_q;
  reg [2:0] k_next_q, l_next_q;
  reg [`CCHIP_INFO_W-1:0] info_q;
  reg [`CCHIP_BEATS_W-1:0] beats_q;
  reg [`CCHIP_CLASS_W-1:0] next_class_q;
  reg [2:0] next_k_q;

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
    deep_q            <= s_state[`CCHIP_STATE_DEEP] & ~flat
        & (s_deep | &s_axis_zero | is_in_plane_a | is_in_plane_b);
    depth_only_q      <= tetra && (TETRA == 0 || (!info[`CCHIP_INFO_TETRAHEDRON_WARPED_A]
        && !info[`CCHIP_INFO_TETRAHEDRON_WARPED_B]));
    complete_q        <= tetra | degenerate;
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
    sign_certain_q    <= s_certain;
    sign_negative_q   <= s_negative[VERTS_A-2];
    // the class that follows the last axis of this one
    next_class_q      <= axis_class == `CCHIP_AXIS_NORMAL_A
        && info[`CCHIP_INFO_TETRAHEDRON_WARPED_B] ? `CCHIP_AXIS_NORMAL_B
                       : axis_class == `CCHIP_AXIS_NORMAL_A || axis_class == `CCHIP_AXIS_NORMAL_B
                           ? `CCHIP_AXIS_CROSS
                       : is_cross ? `CCHIP_AXIS_IN_PLANE_A : `CCHIP_AXIS_IN_PLANE_B;
    next_k_q          <= {2'd0, axis_class == `CCHIP_AXIS_NORMAL_A
        && info[`CCHIP_INFO_TETRAHEDRON_WARPED_B]};
  end

  wire [`CCHIP_INFO_W-1:0] normal_a_info;
  wire normal_clear, certain_sides;
  wire [`CCHIP_PLAN_W-1:0] plan;
  cchip_programme_plan #(
      .VERTS_A     (VERTS_A),
      .VERTS_B     (VERTS_B),
      .WARPED_EXACT(WARPED_EXACT),
      .EXHAUSTIVE  (EXHAUSTIVE)
  ) u_plan (
      .clk            (clk),
      .s_state        (s_state),
      .s_negative     (s_negative),
      .s_zero         (s_zero),
      .s_clear        (s_clear),
      .s_axis_negative(s_axis_negative),
      .s_axis_zero    (s_axis_zero),
      .s_axis_largest (s_axis_largest),
      .m_info         (normal_a_info),
      .m_clear        (normal_clear),
      .m_certain      (certain_sides),
      .m_plan         (plan)
  );

  // ================ clock 2: what follows, pair by pair
  // ---- CROSSING: t(k, l) is the projection of W_l; certain: t > 0 on the first, t < 0 on the
  // second axis
  wire certain_crossing = certain_q && sign_certain_q && sign_negative_q == second_q;
  wire warped_a_crossing = info_q[`CCHIP_INFO_CROSSING_WARPED_A];
  wire warped_b_crossing = info_q[`CCHIP_INFO_CROSSING_WARPED_B];
  wire to_tetra = !certain_crossing && (warped_a_crossing || warped_b_crossing ? TETRA != 0
                                                                             : second_q && deep_q);

  // ---- next axis of the programmes that visit all axes: the next l, the next k, the next class
  wire [`CCHIP_CLASS_W-1:0] code_class = code_q[`CCHIP_AXIS_CODE_CLASS];
  wire [`CCHIP_INDEX_W-1:0] code_k = code_q[`CCHIP_AXIS_CODE_K];
  wire [`CCHIP_INDEX_W-1:0] code_l = code_q[`CCHIP_AXIS_CODE_L];
  wire [`CCHIP_AXIS_CODE_W-1:0] next_code =
      l_goes_on_q ? `CCHIP_AXIS_CODE_OF(l_next_q, code_k, code_class)
      : `CCHIP_AXIS_CODE_OF((loops_l_q ? 3'd0 : code_l), (k_ends_q ? next_k_q : k_next_q),
          (k_ends_q ? next_class_q : code_class));
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
      witness = `CCHIP_AXIS_CODE_OF(3'd0, 3'd0, `CCHIP_AXIS_ILLEGAL);
    end else if (box_q) begin
      witness = `CCHIP_AXIS_CODE_OF(code_l, 3'd0, `CCHIP_AXIS_BOX);
      certain = box_certain_q;
    end else if (!separated_q) begin
      if (normals_q) outcome = 1'b0;
      else begin
        outcome = crossing_q ? second_q && !to_tetra : last_axis | (depth_only_q & ~deep_q);
        grid    = 1'b1;
        certain = (crossing_q & certain_crossing) | (complete_q & deep_q);
        witness = 9'd0;
      end
    end
  end

  // ---- next state, used if the pair is not decided
  wire take_plan = normals_q & normal_b_q;
  wire take_tetra = crossing_q & to_tetra;
  wire state_certain = normals_q ? normal_clear : crossing_q ? certain_crossing : certain_q;
  wire [`CCHIP_INFO_W-1:0] state_info = normals_q ? normal_a_info : info_q;
  wire [`CCHIP_AXIS_CODE_W-1:0] state_code =
      normals_q ? `CCHIP_AXIS_CODE_OF(3'd0, 3'd0, `CCHIP_AXIS_NORMAL_B)
      : crossing_q ? `CCHIP_AXIS_CODE_OF({1'b0, info_q[`CCHIP_INFO_CROSSING_L_UP]},
          {1'b0, info_q[`CCHIP_INFO_CROSSING_K_UP]}, `CCHIP_AXIS_CROSS)
      : next_code;

  reg valid_q2, deep_q2;
  reg outcome_q2, grid_q2, certain_q2, open_q2, illegal_q2, take_plan_q2, take_tetra_q2;
  reg [`CCHIP_AXIS_CODE_W-1:0] witness_q2;
  reg [`CCHIP_BEATS_W-1:0] beats_q2;
  reg [1:0] warped_q2;
  reg [`CCHIP_PLAN_W-1:0] plan_q2, state_q2;
  always @(posedge clk) begin
    if (rst) valid_q2 <= 1'b0;
    else valid_q2 <= valid_q;
    deep_q2            <= deep_q;
    outcome_q2         <= outcome;
    grid_q2            <= grid;
    certain_q2         <= certain;
    open_q2            <= open;
    illegal_q2         <= illegal;
    witness_q2         <= witness;
    beats_q2           <= beats_q;
    take_plan_q2       <= take_plan;
    take_tetra_q2      <= take_tetra;
    warped_q2          <= {warped_b_crossing, warped_a_crossing};
    plan_q2            <= plan;
    state_q2           <= `CCHIP_PLAN_OF(programme_q, state_code, state_info, open_q,
        state_certain);
  end

  // ================ clock 3: EXHAUSTIVE or not; with EXHAUSTIVE = 0 found_valid is constant 0
  wire found_valid, found_outcome, found_proceed, found_separated, found_certain, found_to_tetra,
      found_deep;
  wire [`CCHIP_AXIS_CODE_W-1:0] found_witness;
  wire [`CCHIP_PLAN_W-1:0] found_plan;
  cchip_programme_exhaustive #(.TETRAHEDRON(TETRA)) u_exhaustive (
      .clk             (clk),
      .rst             (rst),
      .s_valid         (valid_q & exhaustive_q),
      .s_normal_a      (normal_a_q),
      .s_normal_b      (normal_b_q),
      .s_last          (exhaustive_last_q),
      .s_code          (code_q),
      .s_separated     (separated_q),
      .s_certain_gap   (certain_gap_q),
      .s_sign_certain  (sign_certain_q),
      .s_sign_negative (sign_negative_q),
      .s_deep          (deep_q),
      .s_certain_sides (certain_sides),
      .s_plan          (plan),
      .m_valid         (found_valid),
      .m_outcome       (found_outcome),
      .m_proceed       (found_proceed),
      .m_separated     (found_separated),
      .m_witness       (found_witness),
      .m_certain       (found_certain),
      .m_to_tetrahedron(found_to_tetra),
      .m_deep          (found_deep),
      .m_plan          (found_plan)
  );
  wire [`CCHIP_INFO_W-1:0] found_info = found_plan[`CCHIP_PLAN_INFO];
  wire [1:0] found_warped = {found_info[`CCHIP_INFO_CROSSING_WARPED_B],
                             found_info[`CCHIP_INFO_CROSSING_WARPED_A]};

  reg deep_q3, outcome_q3, proceed_q3, grid_q3, certain_q3, open_q3, illegal_q3;
  reg take_plan_q3, take_found_q3, take_tetra_q3;
  reg [`CCHIP_AXIS_CODE_W-1:0] witness_q3;
  reg [`CCHIP_BEATS_W-1:0] beats_q3;
  reg [1:0] warped_q3;
  reg [`CCHIP_PLAN_W-1:0] plan_q3, state_q3;
  always @(posedge clk) begin
    if (rst) outcome_q3 <= 1'b0;
    else outcome_q3 <= found_valid ? found_outcome : valid_q2 & outcome_q2;
    if (rst) proceed_q3 <= 1'b0;
    else proceed_q3 <= found_valid ? found_proceed : valid_q2 & ~outcome_q2;
    deep_q3       <= found_valid ? found_deep : deep_q2;
    grid_q3       <= found_valid ? ~found_separated : grid_q2;
    certain_q3    <= found_valid ? found_certain : certain_q2;
    open_q3       <= found_valid ? found_plan[`CCHIP_PLAN_OPEN] & ~found_separated : open_q2;
    illegal_q3    <= illegal_q2;
    witness_q3    <= found_valid ? found_witness : witness_q2;
    beats_q3      <= beats_q2;
    take_plan_q3  <= take_plan_q2;
    take_found_q3 <= found_valid;
    take_tetra_q3 <= found_valid ? found_to_tetra : take_tetra_q2;
    warped_q3     <= found_valid ? found_warped : warped_q2;
    plan_q3       <= plan_q2;
    state_q3      <= state_q2;
  end

  // ================ clock 4: the next state
  // first axis of TETRAHEDRON; its info is the record INFO_TETRAHEDRON
  wire [`CCHIP_AXIS_CODE_W-1:0] tetra_code =
      warped_q3 == 2'b00 ? `CCHIP_AXIS_CODE_OF(3'd0, 3'd0, `CCHIP_AXIS_CROSS)
      : `CCHIP_AXIS_CODE_OF(3'd0, 3'd1,
          (warped_q3[0] ? `CCHIP_AXIS_NORMAL_A : `CCHIP_AXIS_NORMAL_B));
  wire [`CCHIP_PLAN_W-1:0] state = take_plan_q3 ? plan_q3 : take_found_q3 ? found_plan : state_q3;
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
    m_state_q   <= `CCHIP_STATE_OF((take_tetra_q3 ? `CCHIP_PROG_TETRAHEDRON
        : state[`CCHIP_PLAN_PROGRAMME]), (take_tetra_q3 ? tetra_code : state[`CCHIP_PLAN_CODE]),
        (take_tetra_q3 ? {12'd0, warped_q3} : state[`CCHIP_PLAN_INFO]), beats_q3,
        state[`CCHIP_PLAN_OPEN], state[`CCHIP_PLAN_CERTAIN], deep_q3);
  end

  wire unused = &{1'b0, found_info};

endmodule
`default_nettype wire
