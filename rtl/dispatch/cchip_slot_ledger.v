// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_slot_ledger: the pairs inside one slot. Inside it a pair has a number, 0..CREDIT-1; its tag
// and kind stay here. Each pair is answered exactly once: by the first result with its number, or,
// when the slot is decoupled before that, as an open pair: hit 1, grid 1, definite 0, axis class
// CCHIP_AXIS_ILLEGAL, beats 0.
//   credit       room = 1: another pair may be granted. A pair uses a credit from its grant until
//                its answer has left, so there is always room for every answer
//   garbage      a result whose number is not that of a pair inside is dropped
//   latency      5 clocks from a result to m_valid of an empty ledger
//   throughput   a result on every clock; a grant on every third
//   stop         quiet = 1: stop has lasted long enough for every grant in flight, and no pair is
//                inside. Answers that wait for the receiver do not matter
//   decouple     after SETTLE_CLOCKS the pairs inside are counted in `lost` and answered as open,
//                one per clock; then decoupled rises. It falls one clock after decouple
//   reset        no pair inside, no answer; open for pairs after CREDIT + 2 clocks
//   about        The pairs inside one slot: how many there may be, what their numbers mean, and
//                how each of them ends.
//   timing       After rst every number is made free: open for pairs after CREDIT + 2 clocks. After
//                decouple 16 clocks pass, then the numbers are walked through, one per clock, and
//                16 clocks later decoupled rises; without pairs inside it rises after the first 16.
//   numbers      A number is free, inside, or neither: its pair is answered, and the answer has not
//                left. outstanding counts the second, credit the second and third.
//   why          No ready runs to a slot or back: what was granted has room at every station, here
//                too, so a slot drains regardless of the receiver. Whether a number is inside is
//                told by two bits that differ, one written with the grant, one with the answer: two
//                memories with one writer each. Giving up is the arrival of an open result for
//                every number; those that are not inside are dropped like any garbage.
module cchip_slot_ledger #(
    // most pairs between grant and answer; at most CONTEXTS of every module of the slot; legal:
    // 1..256
    parameter integer CREDIT = 42
) (
    input  wire                            clk,             // clock, rising edge
    input  wire                            rst,             // synchronous reset, active high
    output wire                            open,            // the slot may be given pairs
    output wire                            room,            // there is a credit
    // a pair is given to the slot; only while open was 1 at most 6 clocks ago and room is 1
    input  wire                            grant,
    output wire [    `CCHIP_PAIR_ID_W-1:0] id,  // number of the pair, 2 clocks after grant
    input  wire [        `CCHIP_TAG_W-1:0] s_tag,           // its tag, 3 clocks after grant
    input  wire [       `CCHIP_KIND_W-1:0] s_kind,          // its kind, 3 clocks after grant
    // ---- from the slot: record SLOT_RESULT, and the module in it
    input  wire                            s_result_valid,  // a result comes from the slot
    input  wire [`CCHIP_SLOT_RESULT_W-1:0] s_result_data,   // record SLOT_RESULT
    input  wire [       `CCHIP_KIND_W-1:0] module_id,  // module in the slot, which gave the result
    // ---- answers: record ANSWER
    output wire                            m_valid,         // an answer is offered
    input  wire                            m_ready,         // it is taken if m_valid = 1 as well
    output wire [     `CCHIP_ANSWER_W-1:0] m_data,          // record ANSWER
    input  wire                            stop,            // the slot is given no more pairs
    // stop has lasted for 16 clocks and no pair is inside
    output wire                            quiet,
    input  wire                            decouple,        // the slot is cut off
    // it is cut off, and every pair that was inside has been answered
    output wire                            decoupled,
    output wire [ `CCHIP_PAIR_COUNT_W-1:0] outstanding,     // pairs inside
    // pairs that were inside when the slot was decoupled last
    output wire [ `CCHIP_PAIR_COUNT_W-1:0] lost
);

  localparam integer ID_W = CREDIT > 1 ? $clog2(CREDIT) : 1;
  localparam integer COUNT_W = $clog2(CREDIT + 1);
  localparam integer PAIR_W = `CCHIP_TAG_W + `CCHIP_KIND_W;
  localparam integer FOUND_W = `CCHIP_SLOT_RESULT_W - `CCHIP_PAIR_ID_W;  // a result without number
  localparam [31:0] CREDITS = CREDIT;
  localparam [31:0] LAST = CREDIT - 1;
  // Longer than a grant takes after stop, and than a result takes after decouple.
  localparam [ID_W+3:0] SETTLE_CLOCKS = 15;

  `CCHIP_REFUSE(CREDIT < 1 || CREDIT > `CCHIP_CONTEXTS_MAX, cchip_error_CREDIT_must_be_1_to_256)

  // ---- sequence
  localparam [2:0] CLEAR = 3'd0;  // every number is made free
  localparam [2:0] WORK = 3'd1;
  localparam [2:0] SETTLE = 3'd2;
  localparam [2:0] ABANDON = 3'd3;  // every number is answered as an open pair
  localparam [2:0] CLOSED = 3'd4;
  reg [2:0] state_q;
  reg [ID_W+3:0] step_q;  // clocks in this state
  reg clearing_q, giving_q, open_q, decoupled_q;
  wire some_inside;
  wire [COUNT_W-1:0] pairs_inside;
  reg [COUNT_W-1:0] lost_q;
  wire last_step = step_q == LAST[ID_W+3:0];

  always @(posedge clk) begin
    step_q <= step_q + {{ID_W + 3{1'b0}}, 1'b1};
    open_q <= !rst && state_q == WORK && !decouple;
    decoupled_q <= decouple && (rst || decoupled_q || state_q == CLEAR || state_q == CLOSED);
    if (rst) begin
      state_q    <= CLEAR;
      step_q     <= {ID_W + 4{1'b0}};
      clearing_q <= 1'b0;
      giving_q   <= 1'b0;
      lost_q     <= {COUNT_W{1'b0}};
    end else
      case (state_q)
        CLEAR:
        if (!clearing_q) begin
          step_q     <= {ID_W + 4{1'b0}};
          clearing_q <= 1'b1;
        end else if (last_step) begin
          state_q    <= decouple ? CLOSED : WORK;
          clearing_q <= 1'b0;
        end
        WORK:
        if (decouple) begin
          state_q <= SETTLE;
          step_q  <= {ID_W + 4{1'b0}};
          lost_q  <= {COUNT_W{1'b0}};
        end
        SETTLE:
        if (step_q == SETTLE_CLOCKS) begin
          state_q <= some_inside ? ABANDON : CLOSED;
          step_q  <= {ID_W + 4{1'b0}};
          if (some_inside) lost_q <= pairs_inside;
          giving_q <= some_inside;
        end
        ABANDON:
        if (last_step) begin
          state_q  <= SETTLE;
          step_q   <= {ID_W + 4{1'b0}};
          giving_q <= 1'b0;
        end
        default: if (!decouple) state_q <= WORK;
      endcase
  end
  assign open      = open_q;
  assign decoupled = decoupled_q;
  assign lost      = {{`CCHIP_PAIR_COUNT_W - COUNT_W{1'b0}}, lost_q};

  reg [3:0] stopped_q;  // clocks since stop rose, at most 15
  reg quiet_q;
  always @(posedge clk) begin
    stopped_q <= rst || !stop ? 4'd0 : stopped_q + {3'd0, ~&stopped_q};
    quiet_q   <= !rst && stop && (&stopped_q) && !some_inside;
  end
  assign quiet = quiet_q;

  // ---- credit and pairs inside
  wire accept;  // of a result
  wire unused_room;
  wire unused_some;
  wire [COUNT_W-1:0] unused_used;

  cchip_count #(
      .LIMIT(CREDIT)
  ) u_used (
      .clk  (clk),
      .rst  (rst),
      .up   (grant),
      .down (m_valid & m_ready),
      .count(unused_used),
      .some (unused_some),
      .room (room)
  );

  cchip_count #(
      .LIMIT(CREDIT)
  ) u_inside (
      .clk  (clk),
      .rst  (rst),
      .up   (grant),
      .down (accept),
      .count(pairs_inside),
      .some (some_inside),
      .room (unused_room)
  );
  assign outstanding = {{`CCHIP_PAIR_COUNT_W - COUNT_W{1'b0}}, pairs_inside};

  // ---- numbers. Two bits say whether a number is that of a pair inside: the one that the grant
  // writes beside the pair, and the one that the answer writes; they differ while it is.
  reg granted_q, take_q;  // a clock after grant, two
  reg given_q;  // the bit of the pair granted, a clock later
  wire free_valid, unused_free_ready, free_bit;
  wire [ID_W-1:0] free_id;
  wire [PAIR_W-1:0] pair;
  wire granted_bit, answered_bit;
  wire [ID_W-1:0] id_of_result;

  cchip_fifo #(
      .WIDTH     (ID_W + 1),
      .DEPTH     (CREDIT),
      .ROOM_KNOWN(1)
  ) u_free (
      .clk    (clk),
      .rst    (rst),
      .s_valid(clearing_q | accept),
      .s_ready(unused_free_ready),
      .s_data ({clearing_q | ~granted_bit, clearing_q ? step_q[ID_W-1:0] : id_of_result}),
      .m_valid(free_valid),
      .m_ready(take_q),
      .m_data ({free_bit, free_id})
  );
  assign id = {{`CCHIP_PAIR_ID_W - ID_W{1'b0}}, free_id};

  always @(posedge clk) begin
    granted_q <= ~rst & grant;
    take_q    <= ~rst & granted_q;
    given_q   <= ~clearing_q & free_bit;
  end

  // ---- results: three clocks to find the pair
  wire [`CCHIP_PAIR_ID_W-1:0] id_of_slot = s_result_data[`CCHIP_SLOT_RESULT_ID];
  wire [ID_W-1:0] id_in = giving_q ? step_q[ID_W-1:0] : id_of_slot[ID_W-1:0];
  wire [FOUND_W-1:0] found;
  wire [`CCHIP_KIND_W-1:0] found_module;  // in the slot when the result came
  reg [2:0] valid_q;  // after 1, 2, 3 clocks
  reg [2:0] open_pair_q;
  reg [3*ID_W-1:0] id_q;
  // the same number as that of a result 1, 2, 3 clocks before: it is not inside any more
  reg [2:0] same_q;
  reg [1:0] again_q;  // after 2 and 3 clocks
  assign id_of_result = id_q[2*ID_W+:ID_W];
  assign accept = valid_q[2] & ~again_q[1] & (granted_bit ^ answered_bit);

  integer i;
  always @(posedge clk) begin
    valid_q <= rst || clearing_q ? 3'd0
        : {valid_q[1:0], giving_q | (s_result_valid && {24'd0, id_of_slot} < CREDITS)};
    open_pair_q <= {open_pair_q[1:0], giving_q};
    id_q <= {id_q[2*ID_W-1:0], id_in};
    for (i = 0; i < 3; i = i + 1) same_q[i] <= valid_q[i] && id_q[ID_W*i+:ID_W] == id_in;
    again_q <= {again_q[0], |same_q};
  end

  cchip_ram #(
      .WIDTH (1 + PAIR_W),
      .DEPTH (CREDIT),
      .ADDR_W(ID_W)
  ) u_pairs (
      .clk       (clk),
      .write     (take_q | clearing_q),
      .write_addr(clearing_q ? step_q[ID_W-1:0] : free_id),
      .write_data({given_q, s_kind, s_tag}),
      .read_addr (id_in),
      .read_data ({granted_bit, pair})
  );

  reg answered_d_q;  // what is written, a clock after its address
  always @(posedge clk) answered_d_q <= ~clearing_q & granted_bit;
  cchip_ram #(
      .WIDTH (1),
      .DEPTH (CREDIT),
      .ADDR_W(ID_W)
  ) u_answered (
      .clk       (clk),
      .write     (accept | clearing_q),
      .write_addr(clearing_q ? step_q[ID_W-1:0] : id_of_result),
      .write_data(answered_d_q),
      .read_addr (id_in),
      .read_data (answered_bit)
  );

  cchip_delay #(
      .WIDTH (`CCHIP_KIND_W + FOUND_W),
      .DEPTH (3),
      .MEMORY(1)
  ) u_found (
      .clk(clk),
      .rst(1'b0),
      .d  ({module_id, s_result_data[`CCHIP_SLOT_RESULT_W-1:`CCHIP_PAIR_ID_W]}),
      .q  ({found_module, found})
  );

  // ---- answers
  wire open_pair = open_pair_q[2];
  wire [`CCHIP_TAG_W-1:0] tag = pair[`CCHIP_TAG_W-1:0];
  wire [`CCHIP_RESULT_W-1:0] result = open_pair
      ? `CCHIP_RESULT_OF(tag, 1'b1, 1'b1, 1'b0, {`CCHIP_AXIS_ILLEGAL, 6'd0}, 6'd0) : {found, tag};
  wire unused_ready;
  cchip_fifo #(
      .WIDTH     (`CCHIP_ANSWER_W),
      .DEPTH     (CREDIT),
      .ROOM_KNOWN(1)
  ) u_answers (
      .clk    (clk),
      .rst    (rst),
      .s_valid(accept),
      .s_ready(unused_ready),
      .s_data (`CCHIP_ANSWER_OF(result, pair[`CCHIP_TAG_W+:`CCHIP_KIND_W],
          open_pair ? {`CCHIP_KIND_W{1'b0}} : found_module)),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

  wire unused = &{1'b0, unused_room, unused_some, unused_used, unused_ready, unused_free_ready};

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_number, !take_q || free_valid)
      `CCHIP_ASSERT(a_open, !grant || state_q == WORK || state_q == SETTLE)
      `CCHIP_ASSERT(a_closed, !decoupled_q || state_q != CLOSED || !some_inside)
    end

endmodule
`default_nettype wire
