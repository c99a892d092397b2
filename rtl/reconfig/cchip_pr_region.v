// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_pr_region: the reconfigurable partition: one cell, one module name, the same ports for any
// module in it. RM_ID chooses the persona: blank, which never answers, or, behind a
// cchip_vertex_collector, the test of two triangles, of a triangle and a quad, of two quads, or of
// a point and a triangle. Vendor flows synthesise this module out of context once per RM_ID and
// exchange the results in the static design. The streams are records VERTEX and SLOT_RESULT; of a
// point A's vertex 0 is the centre, x of vertex 1 the radius.
//   latency      from the last vertex: that of the test + 1 clock
//   throughput   that of the test, a pair per 3 or 4 clocks at most, of points per 7
//   credit       no ready: at most CONTEXTS pairs may lie between their first vertex and their
//                result
//   cuts         every path: each output is a flip-flop, or a constant of the blank persona
//   reset        no pair inside; pairs are taken from the third clock after rst on
// With the macro CCHIP_PR_BLACK_BOX the module has its ports and nothing else: the empty cell of
// the static design.
`ifdef CCHIP_PR_BLACK_BOX
(* black_box *)
`endif
module cchip_pr_region #(
    parameter integer RM_ID = 1,  // the persona; legal: 0..4, CCHIP_RM_BLANK..CCHIP_RM_POINT_TRI
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    // 1: one projector more, same results: cchip_sat_project; legal: 0, 1
    parameter integer ABSOLUTE_PROJECTION = 0,
    // 1: warped quads are decided exactly; 0: what the directed beats do not decide of a warped
    // quad ends with hit 1, definite 0; legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    parameter integer EXHAUSTIVE = 1  // see cchip_primtest; legal: 0, 1
) (
    input  wire                                clk,             // clock, rising edge
    input  wire                                rst,             // synchronous reset, active high
    input  wire                                s_vertex_valid,  // a vertex of each primitive
    // record VERTEX, docs/hardware/definitions.md
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,  // a result
    // record SLOT_RESULT, docs/hardware/definitions.md
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,           // constant: RM_ID
    output wire                                idle  // no pair is begun or without a result
);

`ifndef CCHIP_PR_BLACK_BOX
  generate
    if (RM_ID == 0) begin : gen_blank
      assign m_result_valid = 1'b0;
      assign m_result_data  = {`CCHIP_SLOT_RESULT_W{1'b0}};
      assign rm_id          = `CCHIP_RM_BLANK;
      assign idle           = 1'b1;
      wire unused = &{1'b0, clk, rst, s_vertex_valid, s_vertex_data};
    end else if (RM_ID >= 1 && RM_ID <= `CCHIP_KINDS_MAX) begin : gen_test
      wire pair_valid, pair_ready, busy, test_idle;
      wire [`CCHIP_REQUEST_W(COORD_W)-1:0] pair;
      wire [`CCHIP_RESULT_W-1:0] result;
      reg idle_q;

      cchip_vertex_collector #(
          .COORD_W(COORD_W)
      ) u_collector (
          .clk           (clk),
          .rst           (rst),
          .s_vertex_valid(s_vertex_valid),
          .s_vertex_data (s_vertex_data),
          .m_pair_valid  (pair_valid),
          .m_pair_data   (pair),
          .busy          (busy)
      );

      if (RM_ID <= 3) begin : gen_sat
        cchip_primtest #(
            .COORD_W            (COORD_W),
            .SUBSTAGES          (SUBSTAGES),
            .CONTEXTS           (CONTEXTS),
            .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
            .WARPED_EXACT       (WARPED_EXACT),
            .EXHAUSTIVE         (EXHAUSTIVE),
            .VERTS_A            (`CCHIP_RM_VERTS_A(RM_ID)),
            .VERTS_B            (`CCHIP_RM_VERTS_B(RM_ID))
        ) u_test (
            .clk           (clk),
            .rst           (rst),
            .s_pair_valid  (pair_valid),
            .s_pair_ready  (pair_ready),
            .s_pair_data   (pair),
            .m_result_valid(m_result_valid),
            .m_result_ready(1'b1),
            .m_result_data (result),
            .rm_id         (rm_id),
            .idle          (test_idle)
        );
      end else begin : gen_point
        wire [`CCHIP_TAG_W-1:0] tag;
        wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] a, b;
        wire [`CCHIP_ERR_W-1:0] err;
        wire [`CCHIP_MODE_W-1:0] mode;
        assign `CCHIP_REQUEST_OF(tag, a, b, err, mode) = pair;
        cchip_primtest_point_tri #(
            .COORD_W (COORD_W),
            .CONTEXTS(CONTEXTS)
        ) u_test (
            .clk              (clk),
            .rst              (rst),
            .s_pair_valid     (pair_valid),
            .s_pair_ready     (pair_ready),
            .s_pair_tag       (tag),
            .s_pair_mode      (mode),
            .s_pair_a         (a),
            .s_pair_b         (b),
            .s_pair_err       (err),
            .m_result_valid   (m_result_valid),
            .m_result_ready   (1'b1),
            .m_result_tag     (result[`CCHIP_RESULT_TAG]),
            .m_result_hit     (result[`CCHIP_RESULT_HIT]),
            .m_result_grid    (result[`CCHIP_RESULT_GRID]),
            .m_result_definite(result[`CCHIP_RESULT_DEFINITE]),
            .m_result_axis    (result[`CCHIP_RESULT_AXIS]),
            .m_result_beats   (result[`CCHIP_RESULT_BEATS]),
            .rm_id            (rm_id),
            .idle             (test_idle)
        );
      end
      assign m_result_data = {result[`CCHIP_RESULT_W-1:`CCHIP_TAG_W], result[`CCHIP_PAIR_ID_W-1:0]};
      always @(posedge clk) idle_q <= rst | (test_idle & ~busy & ~s_vertex_valid);
      assign idle = idle_q;

      wire unused = &{1'b0, pair_ready, result[`CCHIP_TAG_W-1:`CCHIP_PAIR_ID_W]};
    end else begin : gen_error
      cchip_error_RM_ID_must_be_0_to_4 u_error ();
    end
  endgenerate
`endif

endmodule
`default_nettype wire
