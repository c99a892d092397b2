// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_pr_region: the reconfigurable partition: one cell, one module name, the same ports whatever
// is in it. RM_ID chooses the persona: blank, triangle-triangle, triangle-quad or quad-quad. Vendor
// flows synthesise this module out of context once per RM_ID and exchange the results in the static
// design. The streams are records REQUEST and RESULT.
//   latency, throughput, in flight, reset   those of the persona: nothing is added
//   cuts         what the persona cuts: each output is a flip-flop of it, or a constant of the
//                blank one
// With the macro CCHIP_PR_BLACK_BOX the module has its ports and nothing else: the empty cell of
// the static design.
`ifdef CCHIP_PR_BLACK_BOX
(* black_box *)
`endif
module cchip_pr_region #(
    // persona, CCHIP_RM_BLANK .. CCHIP_RM_QUAD_QUAD, 0..3
    parameter integer RM_ID = 1,
    // width of a coordinate, bit, 4..20
    parameter integer COORD_W = 16,
    // registers in each of the stages axis and project, clocks, >= CCHIP_SUBSTAGES_MIN(COORD_W)
    parameter integer SUBSTAGES = 10,
    // pairs in flight, 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    // 0 relative, 1 absolute projection (see cchip_sat_project)
    parameter integer ABSOLUTE_PROJECTION = 0,
    // 1: warped quads are decided exactly; 0: they are left open (see cchip_axis_controller)
    parameter integer WARPED_EXACT = 1
) (
    input  wire                                   clk,
    input  wire                                   rst,
    input  wire                                   s_pair_valid,
    output wire                                   s_pair_ready,
    input  wire [  `CCHIP_REQUEST_W(COORD_W)-1:0] s_pair_data,
    output wire                                   m_result_valid,
    input  wire                                   m_result_ready,
    output wire [            `CCHIP_RESULT_W-1:0] m_result_data,
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                   idle
);

`ifndef CCHIP_PR_BLACK_BOX
  generate
    if (RM_ID == 0) begin : gen_blank
      cchip_primtest_blank #(
          .COORD_W(COORD_W)
      ) u_persona (
          .clk              (clk),
          .rst              (rst),
          .s_pair_valid     (s_pair_valid),
          .s_pair_ready     (s_pair_ready),
          .s_pair_tag       (s_pair_data[`CCHIP_REQUEST_TAG]),
          .s_pair_mode      (s_pair_data[`CCHIP_REQUEST_MODE(COORD_W)]),
          .s_pair_a         (s_pair_data[`CCHIP_REQUEST_A(COORD_W)]),
          .s_pair_b         (s_pair_data[`CCHIP_REQUEST_B(COORD_W)]),
          .s_pair_err       (s_pair_data[`CCHIP_REQUEST_ERR(COORD_W)]),
          .m_result_valid   (m_result_valid),
          .m_result_ready   (m_result_ready),
          .m_result_tag     (m_result_data[`CCHIP_RESULT_TAG]),
          .m_result_hit     (m_result_data[`CCHIP_RESULT_HIT]),
          .m_result_grid    (m_result_data[`CCHIP_RESULT_GRID]),
          .m_result_definite(m_result_data[`CCHIP_RESULT_DEFINITE]),
          .m_result_axis    (m_result_data[`CCHIP_RESULT_AXIS]),
          .m_result_beats   (m_result_data[`CCHIP_RESULT_BEATS]),
          .rm_id            (rm_id),
          .idle             (idle)
      );
    end else if (RM_ID >= 1 && RM_ID <= 3) begin : gen_test
      cchip_primtest #(
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .VERTS_A            (`CCHIP_RM_VERTS_A(RM_ID)),
          .VERTS_B            (`CCHIP_RM_VERTS_B(RM_ID))
      ) u_persona (
          .clk           (clk),
          .rst           (rst),
          .s_pair_valid  (s_pair_valid),
          .s_pair_ready  (s_pair_ready),
          .s_pair_data   (s_pair_data),
          .m_result_valid(m_result_valid),
          .m_result_ready(m_result_ready),
          .m_result_data (m_result_data),
          .rm_id         (rm_id),
          .idle          (idle)
      );
    end else begin : gen_error
      cchip_error_RM_ID_must_be_0_to_3 u_error ();
    end
  endgenerate
`endif

endmodule
`default_nettype wire
