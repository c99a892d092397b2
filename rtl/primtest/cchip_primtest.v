// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_primtest: the machine behind every primitive test: operand memory, axis controller, SAT
// pipeline, result FIFO. Wrapped by cchip_primtest_tri_tri, _tri_quad and _quad_quad, whose
// headers describe it for the user. The streams are records REQUEST and RESULT.
//   latency      lone pair, handshake of s_pair to handshake of m_result with ready = 1:
//                EXHAUSTIVE without special case CCHIP_PAIR_LATENCY(SUBSTAGES, beats), for any
//                data; each beat that waits for a verdict adds CCHIP_BEAT_LATENCY(SUBSTAGES)
//   throughput   one axis per clock
//   in flight    at most CONTEXTS pairs between the handshakes of s_pair and m_result
//   reset        no pair accepted before is ever answered; s_pair_ready is 0 while rst is 1
module cchip_primtest #(
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
    parameter integer WARPED_EXACT = 1,
    // 0: without the logic of mode EXHAUSTIVE, which is then reserved: axis class ILLEGAL, hit 1,
    // definite 0; legal: 0, 1
    parameter integer EXHAUSTIVE = 1,
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3  // vertices of B (vertex); legal: VERTS_A..4
) (
    // ---- clock and reset
    input  wire                                   clk,             // clock, rising edge
    input  wire                                   rst,             // synchronous reset, active high
    // ---- requests
    input  wire                                   s_pair_valid,    // a pair is offered
    // the pair is accepted if s_pair_valid = 1 as well
    output wire                                   s_pair_ready,
    // the pair: record REQUEST of the fields below
    input  wire [  `CCHIP_REQUEST_W(COORD_W)-1:0] s_pair_data,
    // ---- results
    output wire                                   m_result_valid,  // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                                   m_result_ready,
    // the result: record RESULT of the fields below
    output wire [            `CCHIP_RESULT_W-1:0] m_result_data,
    // ---- status
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,  // constant: CCHIP_RM_OF(VERTS_A, VERTS_B)
    // no accepted pair is without an accepted result
    output wire                                   idle
);

  localparam integer A_W = 3 * VERTS_A * COORD_W;
  localparam integer B_W = 3 * VERTS_B * COORD_W;
  localparam [31:0] RM = `CCHIP_RM_OF(VERTS_A, VERTS_B);
  localparam integer CONTEXT_W = CONTEXTS > 1 ? $clog2(CONTEXTS) : 1;
  localparam integer USER_W = CONTEXT_W + `CCHIP_STATE_W;
  localparam integer COUNT_W = $clog2(CONTEXTS + 1);
  localparam [31:0] FULL = CONTEXTS;
  localparam [31:0] LAST = CONTEXTS - 1;
  localparam [31:0] ONE = 1;
  localparam integer RESULT_W = `CCHIP_RESULT_W;

  `CCHIP_REFUSE(COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX,
                cchip_error_COORD_W_must_be_4_to_20)
  `CCHIP_REFUSE(SUBSTAGES < `CCHIP_SUBSTAGES_MIN(COORD_W),
                cchip_error_SUBSTAGES_below_minimum_for_COORD_W)
  `CCHIP_REFUSE(SUBSTAGES > `CCHIP_SUBSTAGES_MAX, cchip_error_SUBSTAGES_above_32)
  `CCHIP_REFUSE(CONTEXTS < 1 || CONTEXTS > `CCHIP_CONTEXTS_MAX,
                cchip_error_CONTEXTS_must_be_1_to_256)

  assign rm_id = RM[`CCHIP_RM_ID_W-1:0];

  // ---- number of pairs between the two handshakes; ready and idle follow from it
  reg  [COUNT_W-1:0] pairs_q;
  reg                ready_q, idle_q;
  reg                awake_q;
  wire               accept = s_pair_valid & ready_q;
  wire               answer = m_result_valid & m_result_ready;
  wire               up = accept & ~answer;
  wire               down = answer & ~accept;

  always @(posedge clk)
    if (rst) begin
      pairs_q <= {COUNT_W{1'b0}};
      ready_q <= 1'b0;
      idle_q  <= 1'b1;
      awake_q <= 1'b0;
    end else begin
      awake_q <= 1'b1;  // the controller has its first context two clocks after rst
      // + 1 or - 1
      if (accept != answer) pairs_q <= pairs_q + ({COUNT_W{answer}} | ONE[COUNT_W-1:0]);
      ready_q <= awake_q
          && (up ? pairs_q != LAST[COUNT_W-1:0] : down || pairs_q != FULL[COUNT_W-1:0]);
      idle_q  <= !up && (down ? pairs_q == ONE[COUNT_W-1:0] : pairs_q == {COUNT_W{1'b0}});
    end

  assign s_pair_ready = ready_q;
  assign idle         = idle_q;

  // ---- input register and operand memory: one writer, read by the beats
  wire [`CCHIP_TAG_W-1:0] pair_tag;
  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] pair_a, pair_b;
  wire [`CCHIP_ERR_W-1:0] pair_err;
  wire [`CCHIP_MODE_W-1:0] pair_mode;
  assign `CCHIP_REQUEST_OF(pair_tag, pair_a, pair_b, pair_err, pair_mode) = s_pair_data;

  reg [`CCHIP_TAG_W-1:0] load_tag_q;
  reg [`CCHIP_ERR_W-1:0] load_err_q;
  reg [`CCHIP_ERROR_SHIFT_W-1:0] load_shift_q;
  reg [   A_W-1:0] load_a_q;
  reg [   B_W-1:0] load_b_q;

  // smallest shift with eta <= 2^shift
  function [2:0] error_shift(input [3:0] err);
    error_shift = err <= 4'd1 ? 3'd0 : err == 4'd2 ? 3'd1 : err <= 4'd4 ? 3'd2 : err <= 4'd8
        ? 3'd3 : 3'd4;
  endfunction

  always @(posedge clk) begin
    load_tag_q  <= pair_tag;
    load_err_q  <= pair_err;
    load_shift_q <= error_shift(pair_err);
    load_a_q    <= pair_a[A_W-1:0];
    load_b_q    <= pair_b[B_W-1:0];
  end

  generate
    if (VERTS_A == 3) begin : gen_unused_a
      wire unused = &{1'b0, pair_a[`CCHIP_PRIMITIVE_W(COORD_W)-1:A_W]};
    end
    if (VERTS_B == 3) begin : gen_unused_b
      wire unused = &{1'b0, pair_b[`CCHIP_PRIMITIVE_W(COORD_W)-1:B_W]};
    end
  endgenerate

  wire                 beat_valid;
  wire [CONTEXT_W-1:0] load_context, beat_context;
  wire [`CCHIP_AXIS_CODE_W-1:0] beat_code;
  wire                 beat_allow_above, beat_allow_below;
  wire [   USER_W-1:0] beat_user;
  wire [      A_W-1:0] operand_a;
  wire [      B_W-1:0] operand_b;
  wire [`CCHIP_ERROR_SHIFT_W-1:0] operand_shift;

  cchip_ram #(.WIDTH(3 + A_W + B_W), .DEPTH(CONTEXTS), .ADDR_W(CONTEXT_W)) u_operands (
      .clk       (clk),
      .write     (accept),
      .write_addr(load_context),
      .write_data({load_shift_q, load_b_q, load_a_q}),
      .read_addr (beat_context),
      .read_data ({operand_shift, operand_b, operand_a})
  );

  // ---- pipeline: the operands come out of the memory CCHIP_RAM_LATENCY clocks after the beat
  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);
  wire              verdict_valid, verdict_separated, verdict_certain_gap;
  wire [POINTS-1:0] verdict_negative, verdict_zero;
  wire [       2:0] verdict_axis_negative, verdict_axis_zero;
  wire [       1:0] verdict_axis_largest;
  wire              verdict_certain, verdict_clear, verdict_deep;
  wire              verdict_box_separated, verdict_box_certain;
  wire [USER_W-1:0] verdict_user;

  cchip_sat_pipeline #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .VERTS_A            (VERTS_A),
      .VERTS_B            (VERTS_B),
      .USER_W             (USER_W)
  ) u_pipeline (
      .clk                    (clk),
      .rst                    (rst),
      .s_beat_valid           (beat_valid),
      .s_beat_code            (beat_code),
      .s_beat_allow_above     (beat_allow_above),
      .s_beat_allow_below     (beat_allow_below),
      .s_beat_user            (beat_user),
      .s_operand_error_shift  (operand_shift),
      .s_operand_a            (operand_a),
      .s_operand_b            (operand_b),
      .m_verdict_valid        (verdict_valid),
      .m_verdict_separated    (verdict_separated),
      .m_verdict_certain_gap  (verdict_certain_gap),
      .m_verdict_negative     (verdict_negative),
      .m_verdict_zero         (verdict_zero),
      .m_verdict_certain      (verdict_certain),
      .m_verdict_clear        (verdict_clear),
      .m_verdict_deep         (verdict_deep),
      .m_verdict_axis_negative(verdict_axis_negative),
      .m_verdict_axis_zero    (verdict_axis_zero),
      .m_verdict_axis_largest (verdict_axis_largest),
      .m_verdict_box_separated(verdict_box_separated),
      .m_verdict_box_certain  (verdict_box_certain),
      .m_verdict_user         (verdict_user)
  );

  wire                outcome_valid;
  wire [RESULT_W-1:0] outcome;

  cchip_axis_controller #(
      .CONTEXTS    (CONTEXTS),
      .CONTEXT_W   (CONTEXT_W),
      .VERTS_A     (VERTS_A),
      .VERTS_B     (VERTS_B),
      .WARPED_EXACT(WARPED_EXACT),
      .EXHAUSTIVE  (EXHAUSTIVE)
  ) u_controller (
      .clk                    (clk),
      .rst                    (rst),
      .s_pair_valid           (accept),
      .s_pair_tag             (load_tag_q),
      .s_pair_mode            (pair_mode),
      .s_pair_err             (load_err_q),
      .m_load_context         (load_context),
      .m_beat_valid           (beat_valid),
      .m_beat_context         (beat_context),
      .m_beat_code            (beat_code),
      .m_beat_allow_above     (beat_allow_above),
      .m_beat_allow_below     (beat_allow_below),
      .m_beat_user            (beat_user),
      .s_verdict_valid        (verdict_valid),
      .s_verdict_user         (verdict_user),
      .s_verdict_separated    (verdict_separated),
      .s_verdict_certain_gap  (verdict_certain_gap),
      .s_verdict_negative     (verdict_negative),
      .s_verdict_zero         (verdict_zero),
      .s_verdict_certain      (verdict_certain),
      .s_verdict_clear        (verdict_clear),
      .s_verdict_deep         (verdict_deep),
      .s_verdict_axis_negative(verdict_axis_negative),
      .s_verdict_axis_zero    (verdict_axis_zero),
      .s_verdict_axis_largest (verdict_axis_largest),
      .s_verdict_box_separated(verdict_box_separated),
      .s_verdict_box_certain  (verdict_box_certain),
      .m_result_valid         (outcome_valid),
      .m_result_tag           (outcome[`CCHIP_RESULT_TAG]),
      .m_result_hit           (outcome[`CCHIP_RESULT_HIT]),
      .m_result_grid          (outcome[`CCHIP_RESULT_GRID]),
      .m_result_definite      (outcome[`CCHIP_RESULT_DEFINITE]),
      .m_result_axis          (outcome[`CCHIP_RESULT_AXIS]),
      .m_result_beats         (outcome[`CCHIP_RESULT_BEATS])
  );

  // ---- results: the FIFO has room for every pair in flight, so no verdict ever waits
  wire queue_space;

  cchip_fifo #(.WIDTH(RESULT_W), .DEPTH(CONTEXTS), .ROOM_KNOWN(1)) u_results (
      .clk    (clk),
      .rst    (rst),
      .s_valid(outcome_valid),
      .s_ready(queue_space),
      .s_data (outcome),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data (m_result_data)
  );

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_result_space, !outcome_valid || queue_space)
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, pairs_q} <= FULL)
    end

endmodule
`default_nettype wire
