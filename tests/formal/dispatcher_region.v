// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Stands for the region in the proof of cchip_dispatcher: module 1, which answers the pairs that it holds in any order and
// after any time, each once. In reset it drops them and every output is anything, as while it is rewritten.
// Proved here: it never gets a vertex in reset, nor a number that it holds already.
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
  wire first = s_vertex_valid & s_vertex_data[`CCHIP_VERTEX_FIRST];
  wire last = s_vertex_valid & s_vertex_data[`CCHIP_VERTEX_LAST];
  wire [`CCHIP_PAIR_ID_W-1:0] id = s_vertex_data[`CCHIP_VERTEX_ID];

  (* anyseq *) wire any_valid;
  (* anyseq *) wire [`CCHIP_PAIR_ID_W-1:0] any_id;
  (* anyseq *) wire [`CCHIP_RM_ID_W-1:0] any_module;
  reg [CONTEXTS-1:0] holds_q;  // complete pairs
  reg [`CCHIP_PAIR_ID_W-1:0] id_q;  // of the pair whose vertices come
  assign m_result_valid = any_valid;
  // definite, unlike the answer of a pair that is given up
  assign m_result_data = `CCHIP_SLOT_RESULT_OF(any_id, 1'b0, 1'b0, 1'b1, 9'd0, 6'd0);
  assign rm_id = rst ? any_module : 8'd1;
  assign idle = 1'b0;
  wire [CONTEXTS-1:0] one = 1;
  wire [CONTEXTS-1:0] completes = last ? one << (first ? id : id_q) : {CONTEXTS{1'b0}};
  wire [CONTEXTS-1:0] leaves = any_valid ? one << any_id : {CONTEXTS{1'b0}};
  reg started_q = 1'b0;
  always @(posedge clk) begin
    started_q <= 1'b1;
    if (first) id_q <= id;
    holds_q <= rst ? {CONTEXTS{1'b0}} : (holds_q | completes) & ~leaves;
  end
  always @(*) begin
    assume (rst || !any_valid || (any_id < CONTEXTS && (holds_q & leaves) != 0));
    if (started_q) begin
      no_vertex_in_reset: assert (!rst || !s_vertex_valid);
      number_known: assert (!first || id < CONTEXTS);
      number_free: assert ((holds_q & completes) == 0);
    end
  end
endmodule
`default_nettype wire
