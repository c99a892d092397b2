// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Stands for the region in the proof of cchip_pr_slot: every output is anything on every clock, but rm_id tells its reset.
module cchip_pr_region #(
    parameter integer RM_ID = 0,
    parameter integer COORD_W = 4,
    parameter integer SUBSTAGES = 5,
    parameter integer CONTEXTS = 1,
    parameter integer ABSOLUTE_PROJECTION = 0,
    parameter integer WARPED_EXACT = 1,
    parameter integer EXHAUSTIVE = 1
) (
    input  wire                                clk,
    input  wire                                rst,
    input  wire                                s_vertex_valid,
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                idle
);
  (* anyseq *) wire [`CCHIP_SLOT_RESULT_W+1:0] any;
  assign {m_result_valid, m_result_data, idle} = any;
  assign rm_id = {rst, 7'd1};
endmodule
`default_nettype wire
