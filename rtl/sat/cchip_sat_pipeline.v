// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_pipeline: the four macro stages of the separating axis test (paper, figure 7), triangle
// against triangle: select -> axis -> project -> compare.
//   latency      CCHIP_PIPE_LATENCY(SUBSTAGES) clocks, beat to verdict
//   throughput   one axis per clock, never stalls: whoever issues a beat keeps room for its verdict
//   cuts         every path (registered outputs; the first register is behind the multiplexers of select)
//   reset        valid bits only
// s_beat_user travels with the beat and comes back as m_verdict_user.
module cchip_sat_pipeline #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16,
    // registers in each of the stages axis and project, clocks
    parameter integer SUBSTAGES = 10,
    // 0 relative, 1 absolute projection (see cchip_sat_project)
    parameter integer ABSOLUTE_PROJECTION = 0,
    // width of the user field, bit
    parameter integer USER_W = 8
) (
    input  wire                 clk,
    input  wire                 rst,
    input  wire                 s_beat_valid,
    input  wire [          8:0] s_beat_code,          // {class, k, l}
    input  wire [9*COORD_W-1:0] s_beat_a,             // V2, V1, V0
    input  wire [9*COORD_W-1:0] s_beat_b,             // W2, W1, W0
    input  wire [   USER_W-1:0] s_beat_user,
    output wire                 m_verdict_valid,
    output wire                 m_verdict_separated,  // intervals disjoint
    output wire                 m_verdict_axis_zero,  // the axis is the zero vector
    output wire [          2:0] m_verdict_negative,   // sign of the projected points p0..p2
    output wire [          2:0] m_verdict_zero,
    output wire [   USER_W-1:0] m_verdict_user
);

`include "cchip_defs.vh"

  localparam integer POINT_W = 3 * COORD_W;
  localparam integer AXIS_W = `CCHIP_AXIS_W(COORD_W);
  localparam integer PROJ_W = `CCHIP_PROJ_W(COORD_W);

  // ---- control beside the data: valid, user, class of the axis
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(`CCHIP_PIPE_LATENCY(SUBSTAGES)),
      .RESET(1)
  ) u_valid (
      .clk(clk),
      .rst(rst),
      .d  (s_beat_valid),
      .q  (m_verdict_valid)
  );
  cchip_delay #(
      .WIDTH(USER_W),
      .DEPTH(`CCHIP_PIPE_LATENCY(SUBSTAGES))
  ) u_user (
      .clk(clk),
      .rst(1'b0),
      .d  (s_beat_user),
      .q  (m_verdict_user)
  );
  wire compare_cross;
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(`CCHIP_SELECT_LATENCY + 2 * SUBSTAGES)
  ) u_cross (
      .clk(clk),
      .rst(1'b0),
      .d  (s_beat_code[8:6] == `CCHIP_AXIS_CROSS),
      .q  (compare_cross)
  );

  // ---- macro stage 1: select
  wire [POINT_W-1:0] select_e_from, select_e_to, select_f_from, select_f_to;
  wire [3*POINT_W-1:0] select_points;
  cchip_sat_select #(
      .COORD_W(COORD_W)
  ) u_select (
      .clk     (clk),
      .s_code  (s_beat_code),
      .s_a     (s_beat_a),
      .s_b     (s_beat_b),
      .m_e_from(select_e_from),
      .m_e_to  (select_e_to),
      .m_f_from(select_f_from),
      .m_f_to  (select_f_to),
      .m_points(select_points)
  );

  // ---- macro stage 2: axis; the points wait beside it
  wire [ 3*AXIS_W-1:0] axis;
  wire [  POINT_W-1:0] axis_reference;
  wire [3*POINT_W-1:0] axis_points;
  cchip_sat_axis #(
      .COORD_W  (COORD_W),
      .SUBSTAGES(SUBSTAGES)
  ) u_axis (
      .clk     (clk),
      .s_e_from(select_e_from),
      .s_e_to  (select_e_to),
      .s_f_from(select_f_from),
      .s_f_to  (select_f_to),
      .m_axis  (axis)
  );
  cchip_delay #(
      .WIDTH(4 * POINT_W),
      .DEPTH(SUBSTAGES)
  ) u_points (
      .clk(clk),
      .rst(1'b0),
      .d  ({select_e_from, select_points}),
      .q  ({axis_reference, axis_points})
  );

  // ---- macro stage 3: project
  wire [3*PROJ_W-1:0] projection;
  wire                project_axis_zero;
  cchip_sat_project #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .POINTS             (3)
  ) u_project (
      .clk         (clk),
      .s_axis      (axis),
      .s_reference (axis_reference),
      .s_points    (axis_points),
      .m_projection(projection),
      .m_axis_zero (project_axis_zero)
  );

  // ---- macro stage 4: compare
  cchip_sat_compare #(
      .PROJ_W(PROJ_W)
  ) u_compare (
      .clk         (clk),
      .s_cross     (compare_cross),
      .s_projection(projection),
      .m_separated (m_verdict_separated),
      .m_negative  (m_verdict_negative),
      .m_zero      (m_verdict_zero)
  );
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(`CCHIP_COMPARE_LATENCY)
  ) u_axis_zero (
      .clk(clk),
      .rst(1'b0),
      .d  (project_axis_zero),
      .q  (m_verdict_axis_zero)
  );

endmodule
`default_nettype wire
