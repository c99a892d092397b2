// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`include "cchip_defs.vh"
`default_nettype none
// cchip_primtest_blank: empty reconfigurable module: ports identical to the primitive tests. Never ready,
// never valid, idle = 1, rm_id = CCHIP_RM_BLANK, results 0. All outputs are constants.
module cchip_primtest_blank #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   s_pair_valid,
    output wire                   s_pair_ready,
    input  wire [           15:0] s_pair_tag,
    input  wire [            1:0] s_pair_mode,
    input  wire [4*3*COORD_W-1:0] s_pair_a,
    input  wire [4*3*COORD_W-1:0] s_pair_b,
    input  wire [            3:0] s_pair_err,
    output wire                   m_result_valid,
    input  wire                   m_result_ready,
    output wire [           15:0] m_result_tag,
    output wire                   m_result_hit,
    output wire                   m_result_grid,
    output wire                   m_result_definite,
    output wire [            8:0] m_result_axis,
    output wire [            5:0] m_result_beats,
    output wire [            7:0] rm_id,
    output wire                   idle
);

  assign s_pair_ready      = 1'b0;
  assign m_result_valid    = 1'b0;
  assign m_result_tag      = 16'd0;
  assign m_result_hit      = 1'b0;
  assign m_result_grid     = 1'b0;
  assign m_result_definite = 1'b0;
  assign m_result_axis     = 9'd0;
  assign m_result_beats    = 6'd0;
  assign rm_id             = `CCHIP_RM_BLANK;
  assign idle              = 1'b1;

  wire unused = &{1'b0, clk, rst, s_pair_valid, s_pair_tag, s_pair_mode, s_pair_a, s_pair_b, s_pair_err, m_result_ready};

endmodule
`default_nettype wire
