// SPDX-License-Identifier: Apache-2.0
`timescale 1ns / 1ps
`default_nettype none
`include "cchip_defs.vh"
// cchip_pr_virtual: takes the place of sim/rtl_models/cchip_pr_virtual.v, with the same ports: what
// cchip_pr_slot holds
// with SIMULATION = 1. Here it is a fabric whose latches are written by the words of the
// configuration port. The region
// is the columns FABRIC_FIRST..FABRIC_COLUMNS - 1; the columns before them hold the neighbour,
// whose pins the bench
// reads.
module cchip_pr_virtual #(
    parameter integer SLOT_ID = 0,
    parameter integer KINDS = 4,
    parameter integer RM_ID = 0,
    parameter integer CFG_W = 32,
    parameter integer SEED = 1,
    parameter integer COORD_W = 4,
    parameter integer SUBSTAGES = 10,
    parameter integer CONTEXTS = 1,
    parameter integer ABSOLUTE_PROJECTION = 0,
    parameter integer WARPED_EXACT = 1
) (
    input  wire                                clk,
    input  wire                                rst,
    input  wire                                cfg_valid,
    input  wire [                   CFG_W-1:0] cfg_data,
    input  wire                                s_vertex_valid,
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                idle
);

  wire [32*`FABRIC_ROWS-1:0] frame;
  wire [20*`FABRIC_COLUMNS-1:0] strobe;
  wire writing, error;
  cchip_fabric_frames #(
      .ROWS   (`FABRIC_ROWS),
      .COLUMNS(`FABRIC_COLUMNS),
      .FIRST  (`FABRIC_FIRST),
      .LAST   (`FABRIC_COLUMNS - 1)
  ) u_frames (
      .clk      (clk),
      .fenced   (bench.fenced),
      .abandon  (bench.abandon),
      .cfg_valid(cfg_valid),
      .cfg_data (cfg_data),
      .frame    (frame),
      .strobe   (strobe),
      .writing  (writing),
      .error    (error)
  );

  wire [15:0] neighbour_out;
  wire [35:0] pins;
  fabric_core u_core (
      .clk   (clk),
      .frame (frame),
      .strobe(strobe),
      .fin   ({s_vertex_data, s_vertex_valid, rst}),
      .fout  (pins),
      .win   (bench.neighbour_in),
      .wout  (neighbour_out)
  );
  assign {idle, rm_id, m_result_data, m_result_valid} = pins;

endmodule
`default_nettype wire
