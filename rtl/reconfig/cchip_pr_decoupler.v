// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_pr_decoupler: the boundary of a reconfigurable region, a register each way. Static side:
// s_*, m_*. Region side: r_*. The streams are records VERTEX and SLOT_RESULT; neither has a ready.
//   latency      1 clock each way
//   throughput   one beat per clock
//   cuts         every path both ways: every output is a flip-flop
//   decouple     decoupled follows one clock later; while it is 1 every output is constant: valid
//                and data 0 on both sides, rm_id CCHIP_RM_BLANK, idle 1. A beat that comes on the
//                clock on which decouple rises is lost: stop first, wait for the results, then
//                decouple
//   reset        nothing valid; has no effect on decoupled
module cchip_pr_decoupler #(
    parameter integer COORD_W = 16  // width of a signed coordinate (bit); legal: 4..20
) (
    input  wire                                clk,             // clock, rising edge
    input  wire                                rst,             // synchronous reset, active high
    input  wire                                decouple,        // cut off; independent of rst
    // decouple one clock later: every output has its constant on the same clock
    output wire                                decoupled,
    // ---- static side
    input  wire                                s_vertex_valid,  // a vertex of each primitive
    // record VERTEX, docs/hardware/definitions.md
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,  // a result
    // record SLOT_RESULT, docs/hardware/definitions.md
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    // number of the module, one clock late; CCHIP_RM_BLANK while decoupled or in reset
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,
    // the region's idle, and nothing is inside the decoupler; 1 while decoupled or in reset
    output wire                                idle,
    // ---- region side
    output wire                                r_vertex_valid,  // the vertex, to the region
    output wire [`CCHIP_VERTEX_W(COORD_W)-1:0] r_vertex_data,   // record VERTEX
    input  wire                                r_result_valid,  // a result of the region
    input  wire [    `CCHIP_SLOT_RESULT_W-1:0] r_result_data,   // record SLOT_RESULT
    input  wire [          `CCHIP_RM_ID_W-1:0] r_rm_id,  // number of the module in the region
    input  wire                                r_idle           // the region's own idle
);

  wire close = rst | decouple;
  reg decoupled_q;
  reg vertex_valid_q, result_valid_q;
  reg [`CCHIP_VERTEX_W(COORD_W)-1:0] vertex_q;
  reg [`CCHIP_SLOT_RESULT_W-1:0] result_q;
  reg [`CCHIP_RM_ID_W-1:0] rm_id_q;
  reg idle_q;

  always @(posedge clk) begin
    decoupled_q <= decouple;
    if (close) begin
      vertex_valid_q <= 1'b0;
      vertex_q       <= {`CCHIP_VERTEX_W(COORD_W) {1'b0}};
      result_valid_q <= 1'b0;
      result_q       <= {`CCHIP_SLOT_RESULT_W{1'b0}};
      rm_id_q        <= `CCHIP_RM_BLANK;
      idle_q         <= 1'b1;
    end else begin
      vertex_valid_q <= s_vertex_valid;
      vertex_q       <= s_vertex_data;
      result_valid_q <= r_result_valid;
      result_q       <= r_result_data;
      rm_id_q        <= r_rm_id;
      idle_q         <= r_idle & ~s_vertex_valid & ~vertex_valid_q;
    end
  end

  assign decoupled      = decoupled_q;
  assign r_vertex_valid = vertex_valid_q;
  assign r_vertex_data  = vertex_q;
  assign m_result_valid = result_valid_q;
  assign m_result_data  = result_q;
  assign rm_id          = rm_id_q;
  assign idle           = idle_q;

  always @(posedge clk)
    if (!rst && decoupled_q) begin
      `CCHIP_ASSERT(a_no_beat, !vertex_valid_q && !result_valid_q)
    end

endmodule
`default_nettype wire
