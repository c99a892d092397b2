// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Stands for the region in the proof of cchip_pr_slot: every output is anything on every clock, but rm_id tells its reset.
module cchip_pr_region #(
    parameter integer RM_ID = 0,
    parameter integer COORD_W = 4,
    parameter integer SUBSTAGES = 5,
    parameter integer CONTEXTS = 1,
    parameter integer ABSOLUTE_PROJECTION = 0,
    parameter integer WARPED_EXACT = 1
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
  (* anyseq *) wire [36:0] any;
  assign {s_pair_ready, m_result_valid, m_result_tag, m_result_hit, m_result_grid, m_result_definite, m_result_axis,
          m_result_beats, idle} = any;
  assign rm_id = {rst, 7'd1};
endmodule
`default_nettype wire
