// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_slot_ledger, for anything that the slot sends at any time (any order, any number, garbage), decoupled at any moment:
//   credit    room says whether fewer than CREDIT pairs lie between grant and the leaving of their answer; outstanding is never
//             more than that
//   once      one pair, any, is followed: it is answered at most once, never before its grant, with its tag and kind; by the
//             first result with its number (its value, the module of that clock), as open only if the slot was closed
//             since its grant
//   never 0   with no pair inside and no answer offered for three clocks every pair has been answered; decoupled and quiet say
//             that no pair is inside; an answer by a result that came while the slot was open is offered after
//             6 clocks, unless others are before it
//   numbers   below CREDIT; while the pair followed is inside no other gets its number
//   an offered answer stays as it is until it is taken
//   a result with the number that comes sooner than 6 clocks after the grant, when no module can have answered, may or may not
//   count as the first one
// Assumed of the dispatcher: a grant needs room, comes 3 clocks after the one before at the earliest, and 8 clocks after the
// slot was open and not stopped at the latest. Tags are one bit: the bits of a tag do not know of each other.
module cchip_slot_ledger_properties #(
    parameter integer CREDIT = 2
) (
    input wire                            clk,
    input wire                            rst,
    input wire                            want,
    input wire                            follow,
    input wire                            any_tag,
    input wire [       `CCHIP_KIND_W-1:0] s_kind,
    input wire                            s_result_valid,
    input wire [    `CCHIP_PAIR_ID_W-1:0] s_result_id,
    input wire                            s_result_hit,
    input wire [       `CCHIP_KIND_W-1:0] module_id,
    input wire                            m_ready,
    input wire                            stop,
    input wire                            decouple
);
  wire open, room, m_valid, quiet, decoupled;
  wire [`CCHIP_PAIR_ID_W-1:0] id;
  wire [`CCHIP_ANSWER_W-1:0] m_data;
  wire [`CCHIP_PAIR_COUNT_W-1:0] outstanding, lost;

  // ---- the dispatcher
  reg [3:0] closed_q;  // clocks since the slot was open and not stopped
  reg [2:0] granted_q;  // 1, 2 and 3 clocks ago
  reg [2:0] followed_q;  // that was the pair followed
  reg started_q = 1'b0;
  wire grant = ~rst & want & room & (granted_q[1:0] == 2'b00) & (closed_q <= 4'd8);
  wire mark = grant & follow & (pair_q == NONE);
  wire s_tag = granted_q[2] ? followed_q[2] : any_tag;

  cchip_slot_ledger #(
      .CREDIT(CREDIT)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .open          (open),
      .room          (room),
      .grant         (grant),
      .id            (id),
      .s_tag         ({{`CCHIP_TAG_W - 1{1'b0}}, s_tag}),
      .s_kind        (s_kind),
      .s_result_valid(s_result_valid),
      .s_result_data (`CCHIP_SLOT_RESULT_OF(s_result_id, s_result_hit, 1'b0, 1'b1, 9'd0, 6'd0)),
      .module_id     (module_id),
      .m_valid       (m_valid),
      .m_ready       (m_ready),
      .m_data        (m_data),
      .stop          (stop),
      .quiet         (quiet),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .outstanding   (outstanding),
      .lost          (lost)
  );

  // ---- the answer offered
  wire [`CCHIP_RESULT_W-1:0] result = m_data[`CCHIP_ANSWER_RESULT];
  wire [`CCHIP_KIND_W-1:0] kind_of_answer = m_data[`CCHIP_ANSWER_KIND];
  wire [`CCHIP_KIND_W-1:0] module_of_answer = m_data[`CCHIP_ANSWER_MODULE];
  wire hit_of_answer = result[`CCHIP_RESULT_HIT];
  wire by_module = result[`CCHIP_RESULT_DEFINITE];
  wire ours = result[`CCHIP_RESULT_TAG] == 16'd1;
  wire leaves = m_valid & m_ready;

  // ---- the pair followed
  localparam [1:0] NONE = 2'd0;
  localparam [1:0] GRANTED = 2'd1;
  localparam [1:0] ANSWERED = 2'd2;
  reg [1:0] pair_q;
  reg [`CCHIP_PAIR_ID_W-1:0] id_q;
  reg [`CCHIP_KIND_W-1:0] kind_q;
  reg [2:0] age_q;  // clocks since its grant, at most 7
  reg last_valid_q, last_valid_q2;  // the results 1 and 2 clocks ago
  reg [`CCHIP_PAIR_ID_W-1:0] last_id_q, last_id_q2;
  reg early_q;  // a result with its number came before any module can have answered
  reg came_q;  // a result with its number came
  reg hit_q;  // the first one's
  reg [`CCHIP_KIND_W-1:0] module_q;
  reg closed_since_q;  // decouple was 1, or the slot not open, since the grant
  reg [2:0] since_q;  // clocks since the result came with decouple 0 until then, at most 7
  wire hits = s_result_valid & (s_result_id == (followed_q[1] ? id : id_q));  // from 2 clocks after the grant on
  wire early = pair_q == GRANTED && age_q < 3'd6 && (hits
      || (followed_q[1] && ((last_valid_q && last_id_q == id) || (last_valid_q2 && last_id_q2 == id))));
  wire comes = pair_q == GRANTED && age_q >= 3'd6 && !came_q && hits;

  reg [7:0] used_q;  // between grant and the leaving of the answer
  reg [1:0] silent_q;  // clocks without answer and with no pair inside
  reg answer_q;  // an answer was offered a clock ago
  reg offered_q;
  localparam integer OFFER_W = 3 + 2 * `CCHIP_KIND_W;
  reg [OFFER_W-1:0] offer_q;
  wire [OFFER_W-1:0] offer = {ours, by_module, hit_of_answer, module_of_answer, kind_of_answer};

  always @(posedge clk) begin
    started_q  <= 1'b1;
    closed_q   <= rst ? 4'd15 : open && !stop ? 4'd0 : closed_q + {3'd0, ~&closed_q};
    granted_q  <= rst ? 3'b000 : {granted_q[1:0], grant};
    followed_q <= rst ? 3'b000 : {followed_q[1:0], mark};
    used_q     <= rst ? 8'd0 : used_q + {7'd0, grant} - {7'd0, leaves};
    silent_q   <= rst || m_valid || outstanding != 0 ? 2'd0 : silent_q + {1'b0, ~&silent_q};
    answer_q   <= m_valid;
    offered_q  <= ~rst & m_valid & ~m_ready;
    offer_q    <= offer;
    if (rst) pair_q <= NONE;
    else if (mark) pair_q <= GRANTED;
    else if (leaves && ours) pair_q <= ANSWERED;
    if (followed_q[1]) id_q <= id;
    if (followed_q[2]) kind_q <= s_kind;
    last_valid_q <= s_result_valid;
    last_valid_q2 <= last_valid_q;
    last_id_q    <= s_result_id;
    last_id_q2   <= last_id_q;
    if (rst || pair_q == NONE) begin
      age_q             <= 3'd1;
      early_q           <= 1'b0;
      came_q            <= 1'b0;
      closed_since_q <= decouple | ~open;
      since_q           <= 3'd0;
    end else begin
      age_q             <= age_q + {2'd0, ~&age_q};
      early_q           <= early_q | early;
      came_q            <= came_q | comes;
      closed_since_q <= closed_since_q | decouple | ~open;
      if (comes && !closed_since_q && !decouple && open) since_q <= 3'd1;
      else if (since_q != 3'd0) since_q <= since_q + {2'd0, ~&since_q};
    end
    if (comes) begin
      hit_q    <= s_result_hit;
      module_q <= module_id;
    end
  end

  always @(*) if (!started_q) assume (rst);
`ifdef COVER
  // goals: the task passes if the tool finds a way to the goal
  always @(posedge clk)
    if (started_q && !rst) begin
      if (`COVER == 0) goal_answered: assert (!(leaves && ours && by_module));
      if (`COVER == 1) goal_given_up: assert (!(leaves && ours && !by_module && lost == CREDIT));
      if (`COVER == 2) goal_full: assert (!(outstanding == CREDIT));
      if (`COVER == 3) goal_quiet: assert (!(pair_q == ANSWERED && quiet));
      if (`COVER == 4) goal_again: assert (!(grant && pair_q == ANSWERED && id_q == 0 && closed_q == 4'd0));
    end
`else
  always @(*)
    if (started_q) begin
      room_known: assert (room == (used_q < CREDIT));
      credit: assert (used_q <= CREDIT && outstanding <= used_q);
      stable: assert (!offered_q || (m_valid && offer == offer_q));
      tag_known: assert (!m_valid || result[`CCHIP_RESULT_TAG] <= 16'd1);
      once: assert (!m_valid || !ours || pair_q == GRANTED);
      own_kind: assert (!m_valid || !ours || kind_of_answer == kind_q);
      first_result: assert (!m_valid || !ours || !by_module || early_q
                            || (came_q && hit_of_answer == hit_q && module_of_answer == module_q));
      open_pair: assert (!m_valid || by_module || (hit_of_answer && module_of_answer == 0));
      open_reason: assert (!m_valid || !ours || by_module || closed_since_q);
      all_answered: assert (silent_q != 2'd3 || outstanding != 0 || m_valid || used_q == 8'd0);
      none_left: assert (used_q != 8'd0 || pair_q != GRANTED);
      nothing_inside: assert (!(quiet || decoupled) || outstanding == 0);
      prompt: assert (since_q < 3'd6 || early_q || m_valid || answer_q || pair_q != GRANTED);
      number: assert (!granted_q[1] || id < CREDIT);
      distinct: assert (!granted_q[1] || followed_q[1] || pair_q != GRANTED || came_q || early_q || id != id_q);
    end
`endif
endmodule
`default_nettype wire
