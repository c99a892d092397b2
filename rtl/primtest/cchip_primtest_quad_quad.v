// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_primtest_quad_quad: do two quads intersect? Reconfigurable module: ports identical to the
// other primitive tests; the machine is cchip_primtest.
//   latency      lone pair, EXHAUSTIVE, no special case: CCHIP_PAIR_LATENCY(SUBSTAGES, 18) clocks
//                from handshake of s_pair to handshake of m_result with ready = 1
//   throughput   one axis per clock; EXHAUSTIVE: one pair per 18 clocks; DIRECTED: at most 4 axes
//                for pairs that are planar on the grid, not coplanar, not degenerate, and with err
//                1..14 up to 16 more for a hit that only its depth can make definite
//                (docs/develop/architecture.md, The depth rule)
//   in flight    at most CONTEXTS pairs between the handshakes of s_pair and m_result
//   cuts         every path: each output, s_pair_ready included, is a flip-flop
//   reset        no pair accepted before is ever answered; s_pair_ready is 0 while rst is 1
// s_pair_a: quad, s_pair_b: quad; vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest. Quads are
// canonical: planar ones in weakly convex cyclic order, or warped, or all vertices on one line.
// s_pair_mode: CCHIP_MODE_EXHAUSTIVE or _DIRECTED; others: axis class ILLEGAL, hit 1, definite 0.
// s_pair_err: eta (0 exact, 15 unknown). m_result_grid: exact answer for the grid;
// m_result_definite: proven for the unrounded primitives; m_result_hit = grid or not definite.
// m_result_axis = {class, k, l}: the separating axis (also where definite = 0 turns grid = 0 into
// hit = 1), class NONE if there is none.
module cchip_primtest_quad_quad #(
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
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,
    output wire                                   m_result_valid,
    input  wire                                   m_result_ready,
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,
    output wire                                   m_result_hit,
    output wire                                   m_result_grid,
    output wire                                   m_result_definite,
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                   idle
);

  cchip_primtest #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .CONTEXTS           (CONTEXTS),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .WARPED_EXACT       (WARPED_EXACT),
      .VERTS_A            (4),
      .VERTS_B            (4)
  ) u_primtest (
      .clk           (clk),
      .rst           (rst),
      .s_pair_valid  (s_pair_valid),
      .s_pair_ready  (s_pair_ready),
      .s_pair_data   (`CCHIP_REQUEST_OF(s_pair_tag, s_pair_a, s_pair_b, s_pair_err, s_pair_mode)),
      .m_result_valid(m_result_valid),
      .m_result_ready(m_result_ready),
      .m_result_data (`CCHIP_RESULT_OF(m_result_tag, m_result_hit, m_result_grid,
          m_result_definite, m_result_axis, m_result_beats)),
      .rm_id         (rm_id),
      .idle          (idle)
  );

endmodule
`default_nettype wire
