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
//   reset        no pair accepted before is ever answered; s_pair_ready is 0 while rst is 1
// s_pair_a: quad, s_pair_b: quad; vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest. Quads are
// canonical: planar ones in weakly convex cyclic order, or warped, or all vertices on one line.
// s_pair_mode: CCHIP_MODE_EXHAUSTIVE or _DIRECTED; others: axis class ILLEGAL, hit 1, definite 0.
// s_pair_err: eta (0 exact, 15 unknown). m_result_grid: exact answer for the grid;
// m_result_definite: proven for the unrounded primitives; m_result_hit = grid or not definite.
// m_result_axis = {class, k, l}: the separating axis (also where definite = 0 turns grid = 0 into
// hit = 1), class NONE if there is none.
module cchip_primtest_quad_quad #(
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    // 1: one projector more, same results: cchip_sat_project; legal: 0, 1
    parameter integer ABSOLUTE_PROJECTION = 0,
    // 1: warped quads are decided exactly; 0: no programme TETRAHEDRON: what the directed beats do
    // not decide of a warped quad ends with hit 1, definite 0; legal: 0, 1
    parameter integer WARPED_EXACT = 1
) (
    // ---- clock and reset
    input  wire                                   clk,                // clock, rising edge
    input  wire                                   rst,  // synchronous reset, active high
    // ---- requests
    input  wire                                   s_pair_valid,       // a pair is offered
    // the pair is accepted if s_pair_valid = 1 as well
    output wire                                   s_pair_ready,
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,  // anything; returned with the result
    // 0 EXHAUSTIVE, 1 DIRECTED; 2 and 3 are reserved
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    // quad A: vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest; canonical
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    // quad B: vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest; canonical
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,
    // eta: upper bound, in whole grid steps and infinity norm, on the error of the difference of
    // any two vertices of the pair; 0 exact, 15 unknown
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,
    // ---- results
    output wire                                   m_result_valid,     // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                                   m_result_ready,
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,       // tag of the pair
    // grid or not definite: never a false "no"
    output wire                                   m_result_hit,
    // the exact answer for the grid coordinates
    output wire                                   m_result_grid,
    // grid is proven for the unrounded primitives
    output wire                                   m_result_definite,
    // witness {class[2:0], k[2:0], l[2:0]}
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    // axes issued for the pair; 0 for a reserved mode
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,
    // ---- status
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,  // constant: 3 (CCHIP_RM_QUAD_QUAD)
    // no accepted pair is without an accepted result
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
