// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_primtest_blank: empty reconfigurable module: ports identical to the primitive tests. Never
// ready, never valid, idle = 1, rm_id = CCHIP_RM_BLANK, results 0. All outputs are constants.
//   about        It fills a slot that has no test in it.
//   timing       Every output is a constant.
//   why          A sender that reads rm_id first sees that no module is there. One that does not is
//                held back by s_pair_ready = 0; no pair is lost.
module cchip_primtest_blank #(
    parameter integer COORD_W = 16  // width of a coordinate, only for the ports (bit); legal: >= 1
) (
    input  wire                                   clk,                // not used
    input  wire                                   rst,                // not used
    input  wire                                   s_pair_valid,       // not used
    output wire                                   s_pair_ready,       // 0
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,         // not used
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,        // not used
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,           // not used
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,           // not used
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,         // not used
    output wire                                   m_result_valid,     // 0
    input  wire                                   m_result_ready,     // not used
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,       // 0
    output wire                                   m_result_hit,       // 0
    output wire                                   m_result_grid,      // 0
    output wire                                   m_result_definite,  // 0
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,      // 0
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,     // 0
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,              // 0 (CCHIP_RM_BLANK)
    output wire                                   idle                // 1
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

  wire unused =
      &{1'b0, clk, rst, s_pair_valid, s_pair_tag, s_pair_mode, s_pair_a, s_pair_b, s_pair_err,
          m_result_ready};

endmodule
`default_nettype wire
