// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_sat_pipeline: the four macro stages of the separating axis test (paper, figure 7):
// select -> axis -> project -> compare; the box comparison runs beside them.
//   latency      CCHIP_PIPE_LATENCY(SUBSTAGES) clocks, beat to verdict; the operands of a beat come
//                CCHIP_RAM_LATENCY clocks after it, from the memory that its context addresses
//   throughput   one axis per clock, never stalls: the issuer of a beat keeps room for its verdict
//   cuts         every path (registered outputs; the first register of a vertex is behind the
//                multiplexers of select)
//   reset        valid bits; data on its way is lost
// s_beat_user travels with the beat and comes back as m_verdict_user.
module cchip_sat_pipeline #(
    parameter integer COORD_W = 16,             // width of a coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal: >=
    // CCHIP_SUBSTAGES_MIN(COORD_W)
    parameter integer SUBSTAGES = 10,
    parameter integer ABSOLUTE_PROJECTION = 0,  // see cchip_sat_project; legal: 0, 1
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,              // vertices of B (vertex); legal: VERTS_A..4
    parameter integer USER_W = 8                // width of the user field (bit); legal: >= 1
) (
    input  wire                            clk,                      // clock, rising edge
    // synchronous reset, active high: no earlier beat comes out
    input  wire                            rst,
    input  wire                            s_beat_valid,  // there is a beat; it is always taken
    input  wire [  `CCHIP_AXIS_CODE_W-1:0] s_beat_code,  // axis code {class[2:0], k[2:0], l[2:0]}
    // the other primitive may be found separated above the own one; one clock after the beat
    input  wire                            s_beat_allow_above,
    input  wire                            s_beat_allow_below,  // below; one clock after the beat
    input  wire [              USER_W-1:0] s_beat_user,  // anything; comes back with the verdict
    // E = 2^s_operand_error_shift >= eta, 0..4; CCHIP_RAM_LATENCY clocks after the beat
    input  wire [`CCHIP_ERROR_SHIFT_W-1:0] s_operand_error_shift,
    // A at the same time, vertex 0 in the low bits; of a vertex x lowest
    input  wire [   3*VERTS_A*COORD_W-1:0] s_operand_a,
    input  wire [   3*VERTS_B*COORD_W-1:0] s_operand_b,              // B likewise
    output wire                            m_verdict_valid,  // the outputs below belong to a beat
    // the intervals on this axis are disjoint
    output wire                            m_verdict_separated,
    // for the unrounded primitives too
    output wire                            m_verdict_certain_gap,
    // bit i: projected point p_i < 0, points as chosen by cchip_sat_select
    output wire [     VERTS_A+VERTS_B-4:0] m_verdict_negative,
    output wire [     VERTS_A+VERTS_B-4:0] m_verdict_zero,           // bit i: p_i = 0
    // the sign of point VERTS_A - 2 is certain: on a cross axis that of W_l
    output wire                            m_verdict_certain,
    // every point of the other is certainly beyond the whole own set: see cchip_sat_compare
    output wire                            m_verdict_clear,
    // the primitives overlap on the axis by more than the error, both ways; without meaning on an
    // in-plane axis
    output wire                            m_verdict_deep,
    // component of the axis < 0, x in bit 0
    output wire [                     2:0] m_verdict_axis_negative,
    output wire [                     2:0] m_verdict_axis_zero,      // component = 0
    // component of the largest absolute value
    output wire [                     1:0] m_verdict_axis_largest,
    // boxes disjoint in component l of the code
    output wire                            m_verdict_box_separated,
    output wire                            m_verdict_box_certain,    // by more than E
    output wire [              USER_W-1:0] m_verdict_user            // s_beat_user of the beat
);

  localparam integer POINT_W = 3 * COORD_W;
  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer NORM_W = `CCHIP_NORM_W(COORD_W);
  localparam integer PROJ_W = `CCHIP_PROJ_W(COORD_W);
  localparam integer BOUND_W = `CCHIP_BOUND_W(COORD_W);

  // ---- control beside the data
  cchip_delay #(.WIDTH(1), .DEPTH(`CCHIP_PIPE_LATENCY(SUBSTAGES)), .RESET(1)) u_valid (
      .clk(clk),
      .rst(rst),
      .d  (s_beat_valid),
      .q  (m_verdict_valid)
  );
  cchip_delay #(.WIDTH(USER_W), .DEPTH(`CCHIP_PIPE_LATENCY(SUBSTAGES)), .MEMORY(1)) u_user (
      .clk(clk),
      .rst(rst),
      .d  (s_beat_user),
      .q  (m_verdict_user)
  );
  reg [1:0] allow_q;
  always @(posedge clk) allow_q <= {s_beat_allow_above, s_beat_allow_below};
  wire project_allow_above, project_allow_below;
  cchip_delay #(.WIDTH(2), .DEPTH(`CCHIP_SELECT_LATENCY - 2 + 2 * SUBSTAGES), .MEMORY(1)) u_allow (
      .clk(clk),
      .rst(rst),
      .d  (allow_q),
      .q  ({project_allow_above, project_allow_below})
  );
  wire [`CCHIP_ERROR_SHIFT_W-1:0] axis_error_shift;
  cchip_delay #(
      .WIDTH (3),
      .DEPTH (`CCHIP_SELECT_LATENCY - `CCHIP_RAM_LATENCY + SUBSTAGES),
      .MEMORY(1)
  ) u_error_shift (
      .clk(clk),
      .rst(rst),
      .d  (s_operand_error_shift),
      .q  (axis_error_shift)
  );

  // ---- box comparison
  wire box_separated, box_certain;
  wire [1:0] box_component;
  cchip_delay #(.WIDTH(2), .DEPTH(`CCHIP_RAM_LATENCY)) u_box_component (
      .clk(clk),
      .rst(1'b0),
      .d  (s_beat_code[1:0]),
      .q  (box_component)
  );
  cchip_box_compare #(.COORD_W(COORD_W), .VERTS_A(VERTS_A), .VERTS_B(VERTS_B)) u_box (
      .clk          (clk),
      .s_a          (s_operand_a),
      .s_b          (s_operand_b),
      .s_component  (box_component),
      .s_error_shift(s_operand_error_shift),
      .m_separated  (box_separated),
      .m_certain_gap(box_certain)
  );
  cchip_delay #(
      .WIDTH (2),
      .DEPTH (`CCHIP_PIPE_LATENCY(SUBSTAGES) - `CCHIP_RAM_LATENCY - `CCHIP_BOX_LATENCY),
      .MEMORY(1)
  ) u_box_delay (
      .clk(clk),
      .rst(rst),
      .d  ({box_separated, box_certain}),
      .q  ({m_verdict_box_separated, m_verdict_box_certain})
  );

  // ---- macro stage 1: select
  wire [POINT_W-1:0] select_e_from, select_e_to, select_f_from, select_f_to;
  wire [POINTS*POINT_W-1:0] select_points;
  wire [1:0] select_own;
  cchip_sat_select #(.COORD_W(COORD_W), .VERTS_A(VERTS_A), .VERTS_B(VERTS_B)) u_select (
      .clk     (clk),
      .s_code  (s_beat_code),
      .s_a     (s_operand_a),
      .s_b     (s_operand_b),
      .m_e_from(select_e_from),
      .m_e_to  (select_e_to),
      .m_f_from(select_f_from),
      .m_f_to  (select_f_to),
      .m_points(select_points),
      .m_own   (select_own)
  );
  wire [1:0] project_own;
  cchip_delay #(.WIDTH(2), .DEPTH(2 * SUBSTAGES), .MEMORY(1)) u_own (
      .clk(clk),
      .rst(rst),
      .d  (select_own),
      .q  (project_own)
  );

  // ---- macro stage 2: axis; the points wait beside it
  wire [        3*AXIS_W-1:0] axis;
  wire [          NORM_W-1:0] axis_edge_norm;
  wire [         POINT_W-1:0] axis_reference;
  wire [  POINTS*POINT_W-1:0] axis_points;
  cchip_sat_axis #(.COORD_W(COORD_W), .SUBSTAGES(SUBSTAGES)) u_axis (
      .clk        (clk),
      .s_e_from   (select_e_from),
      .s_e_to     (select_e_to),
      .s_f_from   (select_f_from),
      .s_f_to     (select_f_to),
      .m_axis     (axis),
      .m_edge_norm(axis_edge_norm)
  );
  cchip_delay #(.WIDTH((POINTS + 1) * POINT_W), .DEPTH(SUBSTAGES), .MEMORY(1)) u_points (
      .clk(clk),
      .rst(rst),
      .d  ({select_e_from, select_points}),
      .q  ({axis_reference, axis_points})
  );

  // ---- macro stage 3: project
  wire [POINTS*PROJ_W-1:0] projection;
  wire [BOUND_W-1:0] sign_bound, gap_bound;
  wire [2:0] project_axis_negative, project_axis_zero;
  wire [1:0] project_axis_largest;
  cchip_sat_project #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .POINTS             (POINTS),
      .SIGN               (VERTS_A - 2)
  ) u_project (
      .clk            (clk),
      .s_axis         (axis),
      .s_edge_norm    (axis_edge_norm),
      .s_error_shift  (axis_error_shift),
      .s_reference    (axis_reference),
      .s_points       (axis_points),
      .m_projection   (projection),
      .m_sign_bound   (sign_bound),
      .m_gap_bound    (gap_bound),
      .m_axis_negative(project_axis_negative),
      .m_axis_zero    (project_axis_zero),
      .m_axis_largest (project_axis_largest)
  );

  // ---- macro stage 4: compare
  cchip_sat_compare #(
      .PROJ_W (PROJ_W),
      .BOUND_W(BOUND_W),
      .POINTS (POINTS),
      .OWN    (VERTS_A - 2)
  ) u_compare (
      .clk          (clk),
      .s_own        (project_own),
      .s_allow_above(project_allow_above),
      .s_allow_below(project_allow_below),
      .s_projection (projection),
      .s_sign_bound (sign_bound),
      .s_gap_bound  (gap_bound),
      .m_separated  (m_verdict_separated),
      .m_certain_gap(m_verdict_certain_gap),
      .m_negative   (m_verdict_negative),
      .m_zero       (m_verdict_zero),
      .m_certain    (m_verdict_certain),
      .m_clear      (m_verdict_clear),
      .m_deep       (m_verdict_deep)
  );
  cchip_delay #(.WIDTH(8), .DEPTH(`CCHIP_COMPARE_LATENCY)) u_axis_signs (
      .clk(clk),
      .rst(1'b0),
      .d  ({project_axis_negative, project_axis_zero, project_axis_largest}),
      .q  ({m_verdict_axis_negative, m_verdict_axis_zero, m_verdict_axis_largest})
  );

endmodule
`default_nettype wire
