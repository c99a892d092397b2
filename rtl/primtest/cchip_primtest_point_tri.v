// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_primtest_point_tri: does the sphere of a point A meet a triangle B? Reconfigurable module:
// ports identical to the other primitive tests. Seven axes decide: the normal of the face, the
// perpendiculars to the three edges, the directions to the three vertices.
//   latency      lone pair, handshake of s_pair to handshake of m_result with ready = 1:
//                CCHIP_POINT_LATENCY(COORD_W) clocks, for any data
//   throughput   one axis per clock, one pair per 7 clocks
//   in flight    at most CONTEXTS pairs between the handshakes of s_pair and m_result
//   reset        no pair accepted before is ever answered; s_pair_ready is 0 while rst is 1
// s_pair_a: centre in bits [0 +: 3*COORD_W], x lowest; radius, unsigned, in
// [3*COORD_W +: COORD_W]; the rest is ignored. s_pair_b: triangle; vertex i in bits
// [3*COORD_W*i +: 3*COORD_W]. Any coordinates, degenerate triangles and radius 0 included.
// s_pair_mode: CCHIP_MODE_EXHAUSTIVE and _DIRECTED do the same; others: axis class ILLEGAL, hit 1,
// definite 0. s_pair_err: eta (0 exact). m_result_grid: exact answer for the grid, touching is a
// hit; m_result_definite = eta is 0; m_result_hit = grid or not definite.
// m_result_axis = {class, 0, l}: first of NORMAL_B (face), CROSS (edge l), NORMAL_A (vertex l) that
// separates, class NONE if there is none.
module cchip_primtest_point_tri #(
    // width of a signed coordinate, and of the unsigned radius (bit); legal: 4..20
    parameter integer COORD_W = 16,
    parameter integer CONTEXTS = 8   // pairs in flight; legal: 1..256
) (
    // ---- clock and reset
    input  wire                                   clk,                // clock, rising edge
    input  wire                                   rst,  // synchronous reset, active high
    // ---- requests
    input  wire                                   s_pair_valid,       // a pair is offered
    // the pair is accepted if s_pair_valid = 1 as well
    output wire                                   s_pair_ready,
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,  // anything; returned with the result
    // 0 EXHAUSTIVE, 1 DIRECTED, which do the same; 2 and 3 are reserved
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    // point A: centre in bits [0 +: 3*COORD_W], x lowest; radius in [3*COORD_W +: COORD_W],
    // unsigned, in grid steps; the rest is ignored
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    // triangle B: vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest; i = 0..2, slot 3 is
    // ignored
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,
    // eta: 0 exact; any other value: the answer is never definite
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,
    // ---- results
    output wire                                   m_result_valid,     // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                                   m_result_ready,
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,       // tag of the pair
    // grid or not definite: never a false "no"
    output wire                                   m_result_hit,
    // the exact answer for the grid: distance <= radius
    output wire                                   m_result_grid,
    // eta is 0 and the mode is legal
    output wire                                   m_result_definite,
    // witness {class[2:0], k[2:0], l[2:0]}
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,     // 7; 0 for a reserved mode
    // ---- status
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,  // constant: 4 (CCHIP_RM_POINT_TRI)
    // no accepted pair is without an accepted result
    output wire                                   idle
);

  localparam integer POINT_W = 3 * COORD_W;
  localparam integer COUNT_W = $clog2(CONTEXTS + 1);
  localparam [31:0] FULL = CONTEXTS;
  localparam [31:0] LAST = CONTEXTS - 1;
  localparam [31:0] ONE = 1;
  localparam integer RESULT_W = `CCHIP_RESULT_W;
  // header of a pair: {reserved mode, eta is 0, tag}
  localparam integer HEAD_W = `CCHIP_TAG_W + 2;
  localparam integer INPUT_W = HEAD_W + COORD_W + 4 * POINT_W;

  `CCHIP_REFUSE(COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX,
                cchip_error_COORD_W_must_be_4_to_20)
  `CCHIP_REFUSE(CONTEXTS < 1 || CONTEXTS > `CCHIP_CONTEXTS_MAX,
                cchip_error_CONTEXTS_must_be_1_to_256)

  assign rm_id = `CCHIP_RM_POINT_TRI;

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
      awake_q <= 1'b1;  // the queue of pairs has room one clock after rst
      // + 1 or - 1
      if (accept != answer) pairs_q <= pairs_q + ({COUNT_W{answer}} | ONE[COUNT_W-1:0]);
      ready_q <= awake_q
          && (up ? pairs_q != LAST[COUNT_W-1:0] : down || pairs_q != FULL[COUNT_W-1:0]);
      idle_q  <= !up && (down ? pairs_q == ONE[COUNT_W-1:0] : pairs_q == {COUNT_W{1'b0}});
    end

  assign s_pair_ready = ready_q;
  assign idle         = idle_q;

  // ---- queue of pairs: room for every pair in flight; the machine takes one per 7 clocks
  wire queue_room, wait_valid, take;
  wire [INPUT_W-1:0] wait_data;
  wire [HEAD_W-1:0] head = {s_pair_mode[1], s_pair_err == 4'd0, s_pair_tag};
  cchip_fifo #(
      .WIDTH     (INPUT_W),
      .DEPTH     (CONTEXTS),
      .ROOM_KNOWN(1)
  ) u_pairs (
      .clk    (clk),
      .rst    (rst),
      .s_valid(accept),
      .s_ready(queue_room),
      .s_data ({head, s_pair_a[POINT_W+:COORD_W], s_pair_b[0+:3*POINT_W], s_pair_a[0+:POINT_W]}),
      .m_valid(wait_valid),
      .m_ready(take),
      .m_data (wait_data)
  );
  wire unused_operands = &{1'b0, s_pair_mode[0], s_pair_b[`CCHIP_PRIMITIVE_W(COORD_W)-1:3*POINT_W],
      s_pair_a[`CCHIP_PRIMITIVE_W(COORD_W)-1:POINT_W+COORD_W]};

  // ---- the machine: answers in order
  wire verdict_valid;
  wire [HEAD_W-1:0] verdict_head;
  wire [6:0] separated;
  cchip_point_axes #(
      .COORD_W(COORD_W),
      .USER_W (HEAD_W)
  ) u_axes (
      .clk                (clk),
      .rst                (rst),
      .s_pair_valid       (wait_valid),
      .s_pair_ready       (take),
      .s_pair_point       (wait_data[0+:POINT_W]),
      .s_pair_triangle    (wait_data[POINT_W+:3*POINT_W]),
      .s_pair_radius      (wait_data[4*POINT_W+:COORD_W]),
      .s_pair_user        (wait_data[4*POINT_W+COORD_W+:HEAD_W]),
      .m_verdict_valid    (verdict_valid),
      .m_verdict_separated(separated),
      .m_verdict_user     (verdict_head)
  );

  // ---- the first axis that separates
  wire [`CCHIP_TAG_W-1:0] tag;
  wire exact, reserved;
  assign {reserved, exact, tag} = verdict_head;

  function [`CCHIP_AXIS_CODE_W-1:0] code(input [`CCHIP_CLASS_W-1:0] axis_class, input [1:0] l);
    code = {axis_class, {`CCHIP_INDEX_W + 1{1'b0}}, l};
  endfunction
  wire [`CCHIP_AXIS_CODE_W-1:0] first_axis =
      separated[0] ? code(`CCHIP_AXIS_NORMAL_B, 2'd0)
      : separated[1] ? code(`CCHIP_AXIS_CROSS, 2'd0)
      : separated[2] ? code(`CCHIP_AXIS_CROSS, 2'd1)
      : separated[3] ? code(`CCHIP_AXIS_CROSS, 2'd2)
      : separated[4] ? code(`CCHIP_AXIS_NORMAL_A, 2'd0)
      : separated[5] ? code(`CCHIP_AXIS_NORMAL_A, 2'd1)
      : separated[6] ? code(`CCHIP_AXIS_NORMAL_A, 2'd2) : code(`CCHIP_AXIS_NONE, 2'd0);

  reg outcome_valid_q;
  reg [RESULT_W-1:0] outcome_q;
  wire grid = reserved || separated == 7'd0;
  wire definite = exact && !reserved;
  always @(posedge clk) begin
    outcome_valid_q <= verdict_valid && !rst;
    outcome_q[`CCHIP_RESULT_TAG]      <= tag;
    outcome_q[`CCHIP_RESULT_GRID]     <= grid;
    outcome_q[`CCHIP_RESULT_DEFINITE] <= definite;
    outcome_q[`CCHIP_RESULT_HIT]      <= grid || !definite;
    outcome_q[`CCHIP_RESULT_AXIS]     <= reserved ? code(`CCHIP_AXIS_ILLEGAL, 2'd0) : first_axis;
    outcome_q[`CCHIP_RESULT_BEATS]    <= reserved ? 6'd0 : 6'd7;
  end

  // ---- results: the queue has room for every pair in flight, so no verdict ever waits
  wire result_room;
  wire [RESULT_W-1:0] result;
  cchip_fifo #(
      .WIDTH     (RESULT_W),
      .DEPTH     (CONTEXTS),
      .ROOM_KNOWN(1)
  ) u_results (
      .clk    (clk),
      .rst    (rst),
      .s_valid(outcome_valid_q),
      .s_ready(result_room),
      .s_data (outcome_q),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data (result)
  );
  assign m_result_tag      = result[`CCHIP_RESULT_TAG];
  assign m_result_hit      = result[`CCHIP_RESULT_HIT];
  assign m_result_grid     = result[`CCHIP_RESULT_GRID];
  assign m_result_definite = result[`CCHIP_RESULT_DEFINITE];
  assign m_result_axis     = result[`CCHIP_RESULT_AXIS];
  assign m_result_beats    = result[`CCHIP_RESULT_BEATS];

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_queue_room, !accept || queue_room)
      `CCHIP_ASSERT(a_result_room, !outcome_valid_q || result_room)
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, pairs_q} <= FULL)
    end

endmodule
`default_nettype wire
