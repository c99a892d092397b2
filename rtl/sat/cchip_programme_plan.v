// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_programme_plan: what the verdicts on the normals nA and nB of a pair lead to, if neither
// separates (the rules are in the header of cchip_axis_programme).
//   latency      1 clock, then logic: the outputs are combinational behind the input registers
//   throughput   one verdict per clock
//   reset        none: outputs mean something one clock after a verdict on a normal only
// The verdict on nA gives m_info, which the pair's state carries to nB. The verdict on nB gives
// m_plan. For an EXHAUSTIVE pair, nB must follow nA at once.
//   about        What the verdicts on both normals of a pair lead to, if neither separates: the
//                first state of the next programme. Part of cchip_axis_programme, whose datasheet
//                has the rules.
//   parameters   Checked in cchip_sat_select and cchip_axis_controller, not here.
//   timing       Latency 1 clock from s_*, then the logic that chooses the plan: about three levels
//                of LUTs, behind which cchip_axis_programme has its next register.
//   why          The state carries m_info from nA to nB, so a pair may wait between the two for any
//                time and others may pass. An EXHAUSTIVE pair carries nothing; its nB follows nA at
//                once, so what nA left in the registers is used.
module cchip_programme_plan #(
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,      // vertices of B (vertex); legal: VERTS_A..4
    // 1: warped quads are decided exactly; 0: no programme TETRAHEDRON; a warped quad makes the
    // plan open; legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    parameter integer EXHAUSTIVE = 1  // 0: there are no EXHAUSTIVE pairs; legal: 0, 1
) (
    input  wire                        clk,              // clock, rising edge
    // programme state of the verdict's beat, record STATE,
    // docs/hardware/definitions.md#record-state
    input  wire [  `CCHIP_STATE_W-1:0] s_state,
    input  wire [ VERTS_A+VERTS_B-4:0] s_negative,       // bit i: projected point p_i < 0
    input  wire [ VERTS_A+VERTS_B-4:0] s_zero,           // bit i: p_i = 0
    input  wire                        s_clear,          // all sides are certain
    input  wire [                 2:0] s_axis_negative,  // components of the normal: < 0
    input  wire [                 2:0] s_axis_zero,      // components of the normal: = 0
    input  wire [                 1:0] s_axis_largest,   // component of the largest absolute value
    // of a verdict on nA: record INFO_NORMALS, docs/hardware/definitions.md#record-info_normals;
    // nA: record INFO_NORMALS; all its sides are certain
    output wire [`CCHIP_INFO_W-1:0]    m_info,
    output wire                        m_clear,          // of a verdict on nA: s_clear
    // of a verdict on nB: all sides of both normals are certain
    output wire                        m_certain,
    // of a verdict on nB: record PLAN, docs/hardware/definitions.md#record-plan
    output wire [   `CCHIP_PLAN_W-1:0] m_plan
);

  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);
  localparam integer QUAD_A = VERTS_A == 4 ? 1 : 0;
  localparam integer QUAD_B = VERTS_B == 4 ? 1 : 0;

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
  wire warped_a_now = QUAD_A != 0 && !s_zero[0];
  wire warped_b_now = QUAD_B != 0 && !s_zero[0];

  // ================ clock 1
  wire [`CCHIP_INFO_W-1:0] info = s_state[`CCHIP_STATE_INFO];
  wire exhaustive = EXHAUSTIVE != 0 && s_state[`CCHIP_STATE_PROGRAMME] == `CCHIP_PROG_EXHAUSTIVE;
  reg [3:0] side_a_q, side_b_q;
  reg b_on_plane_q, clear_q, warped_a_q, warped_b_q;
  reg [2:0] axis_negative_q, axis_zero_q;
  reg [1:0] largest_q;
  // of this verdict and that on nA together
  reg [`CCHIP_INFO_W-1:0] about_a_q;
  reg certain_before_q, no_normal_q, warped_q;

  always @(posedge clk) begin
    side_a_q         <= positive_side(a_negative, a_zero, QUAD_A != 0);
    side_b_q         <= positive_side(b_negative, b_zero, QUAD_B != 0);
    b_on_plane_q     <= &b_zero;
    clear_q          <= s_clear;
    warped_a_q       <= warped_a_now;
    warped_b_q       <= warped_b_now;
    axis_negative_q  <= s_axis_negative;
    axis_zero_q      <= s_axis_zero;
    largest_q        <= s_axis_largest;
    // nB of an EXHAUSTIVE pair follows its nA at once
    about_a_q        <= exhaustive ? m_info : info;
    certain_before_q <= exhaustive ? clear_q : s_state[`CCHIP_STATE_CERTAIN];
    no_normal_q      <= (exhaustive ? &axis_zero_q : &info[`CCHIP_INFO_NORMALS_A_ZERO])
        || &s_axis_zero;
    warped_q         <= (QUAD_A != 0
        && (exhaustive ? warped_a_q : info[`CCHIP_INFO_NORMALS_WARPED_A])) || warped_b_now;
  end
  assign m_info = `CCHIP_INFO_NORMALS_OF(crossing_edge(side_b_q, QUAD_B != 0, 1'b1),
      crossing_edge(side_b_q, QUAD_B != 0, 1'b0), b_on_plane_q, axis_negative_q, axis_zero_q,
      largest_q, warped_a_q);
  assign m_clear = clear_q;

  // ================ the plan
  wire [1:0] l_down = about_a_q[`CCHIP_INFO_NORMALS_L_DOWN];
  wire [1:0] l_up = about_a_q[`CCHIP_INFO_NORMALS_L_UP];
  wire b_on_plane = about_a_q[`CCHIP_INFO_NORMALS_B_ON_PLANE];
  wire [2:0] na_negative = about_a_q[`CCHIP_INFO_NORMALS_A_NEGATIVE];
  wire [2:0] na_zero = about_a_q[`CCHIP_INFO_NORMALS_A_ZERO];
  wire [1:0] largest = about_a_q[`CCHIP_INFO_NORMALS_LARGEST];
  wire warped_a = about_a_q[`CCHIP_INFO_NORMALS_WARPED_A];
  wire [1:0] k_down = crossing_edge(side_a_q, QUAD_A != 0, 1'b1);
  wire [1:0] k_up = crossing_edge(side_a_q, QUAD_A != 0, 1'b0);
  wire [2:0] largest_mask = 3'd1 << largest;
  assign m_certain = certain_before_q & clear_q;

  reg [`CCHIP_PROG_W-1:0] programme;
  reg [`CCHIP_AXIS_CODE_W-1:0] code;
  reg [`CCHIP_INFO_W-1:0] plan_info;
  always @* begin
    if (QUAD_B != 0 && WARPED_EXACT != 0 && warped_q && !m_certain) begin
      programme = `CCHIP_PROG_TETRAHEDRON;
      code      = `CCHIP_AXIS_CODE_OF(3'd0, 3'd1,
          warped_a ? `CCHIP_AXIS_NORMAL_A : `CCHIP_AXIS_NORMAL_B);
      plan_info = {12'd0, `CCHIP_INFO_TETRAHEDRON_OF(warped_a, warped_b_q)};
    end else if (!warped_q && no_normal_q) begin
      programme = `CCHIP_PROG_DEGENERATE;
      code      = `CCHIP_AXIS_CODE_OF(3'd0, 3'd0, `CCHIP_AXIS_CROSS);
      plan_info = {2'd0, `CCHIP_INFO_DEGENERATE_OF(na_negative, na_zero, axis_negative_q,
          axis_zero_q)};
    end else if (!warped_q && b_on_plane) begin
      programme = `CCHIP_PROG_COPLANAR;
      code      = `CCHIP_AXIS_CODE_OF({1'b0, largest}, 3'd0, `CCHIP_AXIS_IN_PLANE_A);
      plan_info = {12'd0, `CCHIP_INFO_COPLANAR_OF(|(na_negative & largest_mask),
          |(axis_negative_q & largest_mask))};
    end else begin
      programme = `CCHIP_PROG_CROSSING;
      code      = `CCHIP_AXIS_CODE_OF({1'b0, l_down}, {1'b0, k_down}, `CCHIP_AXIS_CROSS);
      plan_info = {8'd0, `CCHIP_INFO_CROSSING_OF(l_up, k_up, warped_a, warped_b_q)};
    end
  end
  wire open = warped_q && WARPED_EXACT == 0;
  assign m_plan = `CCHIP_PLAN_OF(programme, code, plan_info, open, m_certain);

  wire unused = &{1'b0, s_state};

endmodule
`default_nettype wire
