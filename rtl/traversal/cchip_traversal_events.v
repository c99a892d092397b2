// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_traversal_events: which event enters the pipeline of cchip_traversal. A verdict goes first,
// then a result, a dropped leaf pair, a query, a stack.
//   rule         an event waits while another one of its query is in the pipeline
//   two clocks   an event is let in on every second clock at most: on the first clock each source
//                asks whether its query has no event inside, on the second one of those enters.
//                A node pair takes the box test four clocks, so this costs no throughput
//   turns        after a verdict that went before a result, the next result goes before verdicts.
//                So a result that is first in line enters at most 16 clocks later, and so does a
//                verdict, if an event leaves 7 clocks after m_valid, or earlier
//   room         a query or a stack enters with a place for its node pair, with room in the leaf
//                queue, a query with a place for its answer, too; a verdict takes further room in
//                the leaf queue if there is some. What was not needed comes back
//   latency      2 or 3 clocks from what enters to m_valid; a verdict is a clock in its queue,
//                another one before it
//   throughput   an event every second clock
//   reset        drops all events; all places and all room are free
module cchip_traversal_events #(
    parameter integer QUERIES = 16,     // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,       // places (node pair); legal: 1..256
    // width of a place's number (bit); legal: wide enough for PAIRS - 1
    parameter integer PLACE_W = 6,
    parameter integer LEAF_DEPTH = 72,  // entries of the leaf queue (entry); legal: >= 1
    parameter integer ANSWERS = 32      // answers that may wait; legal: 1..65535
) (
    input  wire                        clk,                // clock, rising edge
    input  wire                        rst,                // synchronous reset, active high
    input  wire                        running,            // contexts may take queries
    // ---- queries (docs/hardware/image.md); the one that waits or is at its start, whether valid
    input  wire                        s_query_valid,      // a query
    output wire                        s_query_ready,      // it is taken
    // its line (image.md, docs/hardware/image.md, "Query")
    input  wire [               511:0] s_query,
    output wire [               511:0] query,  // the query that waits, or is at its start
    output wire                        query_bad,  // its descriptor is bad; from the third clock on
    // every receiver of a query's pose has room for one more; m_start_event comes after it
    input  wire                        start_ready,
    // ---- verdicts: {place, tests, best, strong, leaves, waiting}
    input  wire                        s_verdict_valid,    // verdict of the box test
    // {place, tests, best, strong, leaves, waiting} of a node pair
    input  wire [        PLACE_W+56:0] s_verdict,
    output wire                        lookup,             // read what is known of lookup_place
    output wire [         PLACE_W-1:0] lookup_place,       // place of a node pair
    input  wire [ $clog2(QUERIES)-1:0] lookup_context,  // what was read: context of the node pair
    input  wire [                 1:0] lookup_epoch,       // its epoch
    // ---- results: {context, epoch, code, open, hits}
    input  wire                        s_result_valid,     // outcome of a leaf pair
    output wire                        s_result_ready,     // it is taken
    // {context, epoch, code, open pairs, definite hits} of a leaf pair
    input  wire [$clog2(QUERIES)+10:0] s_result,
    // ---- leaf pairs whose query has ended
    input  wire                        s_drop_valid,       // a leaf pair whose query has ended
    output wire                        s_drop_ready,       // it is taken
    input  wire [ $clog2(QUERIES)-1:0] s_drop_context,     // its context
    input  wire [                 1:0] s_drop_epoch,       // its epoch
    // ---- the event; verdict, result and place as far as it has one
    output wire                        m_valid,            // an event
    output wire                        m_verdict_event,    // it is a verdict
    output wire                        m_result_event,     // a result, or a dropped pair
    output wire                        m_start_event,      // the start of a query
    output wire                        m_pop_event,        // a node pair that leaves a stack
    // a result that came on s_result, not a dropped leaf pair
    output wire                        m_judge,
    output wire [ $clog2(QUERIES)-1:0] m_context,          // its context
    output wire [                 1:0] m_epoch,            // its epoch, of a verdict or a result
    // a verdict that has further room in the leaf queue
    output wire                        m_extra,
    // place of the node pair; a new one of a start or a stack
    output wire [         PLACE_W-1:0] m_place,
    output wire [                56:0] m_verdict,          // s_verdict without the place
    // {code, open pairs, definite hits}; 0 of a dropped pair
    output wire [                 8:0] m_result,
    // 3 queries or fewer have started whose answers were not taken, a clock ago
    output wire                        m_few,
    // ---- an event leaves the pipeline in two clocks: the next one of its query may ask
    // an event leaves the pipeline in two clocks
    input  wire                        s_leaving_valid,
    input  wire [ $clog2(QUERIES)-1:0] s_leaving_context,  // its context
    input  wire                        s_left_valid,       // an event leaves the pipeline
    input  wire [ $clog2(QUERIES)-1:0] s_left_context,     // its context
    input  wire                        s_left_active,      // the context has a query
    input  wire                        s_left_wants,       // of whose stack a node pair may go
    input  wire                        s_left_start,       // it was a start
    input  wire                        s_left_cancel,  // that is to be tried with another context
    input  wire                        s_left_back,        // its place is free
    input  wire [         PLACE_W-1:0] s_left_place,       // the place
    input  wire [                 1:0] s_left_room,  // entries of the leaf queue that are free
    // ---- further room: an entry has left the leaf queue, an answer was taken
    input  wire                        s_leaf_room,        // an entry has left the leaf queue
    input  wire                        s_answer_room       // an answer was taken
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer ROOM_W = $clog2(LEAF_DEPTH + 1);
  localparam [31:0] DEPTH = LEAF_DEPTH;

  reg [QUERIES-1:0] lock_q;  // has an event in the pipeline that does not leave in the next clock
  reg [QUERIES-1:0] inside_q;  // has an event in the pipeline: idle_q and want_q may change
  reg [QUERIES-1:0] idle_q;  // has no query
  reg [QUERIES-1:0] want_q;  // has a stack and may have another node pair in flight
  reg [QUERIES-1:0] idle_free_q, want_free_q;  // and has none in the pipeline but a new one

  // 0: sources ask whether they may enter; 1: one of them does
  reg choose_q;

  // ---- verdicts, with what is known of their node pairs
  reg verdict_valid_q;
  reg [PLACE_W+56:0] verdict_q;
  wire verdict_take, queue_valid, queue_ready;
  wire [PLACE_W+56:0] queue_verdict;
  cchip_fifo #(.WIDTH(PLACE_W + 57), .DEPTH(PAIRS), .ROOM_KNOWN(1)) u_verdicts (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_verdict_valid),
      .s_ready(queue_ready),
      .s_data (s_verdict),
      .m_valid(queue_valid),
      .m_ready(lookup),
      .m_data (queue_verdict)
  );
  assign lookup       = ~verdict_valid_q | verdict_take;
  assign lookup_place = queue_verdict[57+:PLACE_W];
  always @(posedge clk) begin
    if (lookup) verdict_q <= queue_verdict;
    if (rst) verdict_valid_q <= 1'b0;
    else if (lookup) verdict_valid_q <= queue_valid;
  end

  // ---- results
  wire result_valid, result_take;
  wire [CONTEXT_W-1:0] result_context;
  wire [1:0] result_epoch;
  wire [8:0] result;
  cchip_skid_buffer #(.WIDTH(CONTEXT_W + 11)) u_result (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_result_valid),
      .s_ready(s_result_ready),
      .s_data (s_result),
      .m_valid(result_valid),
      .m_ready(result_take),
      .m_data ({result_context, result_epoch, result})
  );

  reg starting_q;  // a start is in the pipeline

  // ---- contexts: one without a query, one with a stack
  // An idle context stays the candidate until a query starts in it: only a start ends that it is
  // idle, and no other start is in the pipeline meanwhile. What waits to leave the stack is chosen
  // anew each time; two clocks later, when it would enter, only an event that has entered since
  // could have changed that, and that one is inside still.
  wire [QUERIES-1:0] idle_grant, want_grant;
  reg idle_valid_q;
  wire idle_load = ~idle_valid_q & running & ~starting_q;
  reg [QUERIES-1:0] idle_one_q, want_one_q;  // one-hot
  cchip_arbiter #(.N(QUERIES)) u_idle (
      .clk    (clk),
      .rst    (rst),
      .request(idle_free_q),
      .grant  (idle_grant),
      .take   (idle_load)
  );
  cchip_arbiter #(.N(QUERIES)) u_want (
      .clk    (clk),
      .rst    (rst),
      .request(want_free_q),
      .grant  (want_grant),
      .take   (choose_q)
  );
  wire [CONTEXT_W-1:0] idle_context, want_context;
  cchip_onehot_index #(.N(QUERIES), .WIDTH(CONTEXT_W)) u_idle_context (
      .select(idle_one_q),
      .index (idle_context)
  );
  cchip_onehot_index #(.N(QUERIES), .WIDTH(CONTEXT_W)) u_want_context (
      .select(want_one_q),
      .index (want_context)
  );

  // ---- the next query
  wire query_waits;  // it may start
  wire start_take;
  wire start_done = s_left_valid & s_left_start;
  wire start_ends = start_done & ~s_left_cancel;
  cchip_query_check u_query (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_query_valid),
      .s_ready(s_query_ready),
      .s_query(s_query),
      .waits  (query_waits),
      .query  (query),
      .bad    (query_bad),
      .tried  (start_done),
      .started(start_ends)
  );
  always @(posedge clk) begin
    want_one_q <= want_grant;
    if (idle_load) idle_one_q <= idle_grant;
    if (rst) begin
      idle_valid_q <= 1'b0;
      starting_q   <= 1'b0;
    end else begin
      idle_valid_q <= idle_valid_q ? ~start_take : idle_load & |idle_free_q;
      starting_q   <= start_take | (starting_q & ~start_done);
    end
  end

  // ---- a place, room in the leaf queue, room for the answer
  wire place_valid, place_take;
  wire [PLACE_W-1:0] place;
  cchip_pool #(.COUNT(PAIRS), .WIDTH(PLACE_W)) u_places (
      .clk        (clk),
      .rst        (rst),
      .m_valid    (place_valid),
      .m_ready    (place_take),
      .m_number   (place),
      .back_valid (s_left_back),
      .back_number(s_left_place)
  );
  reg [ROOM_W-1:0] room_q;  // of the leaf queue, that no node pair has
  reg [1:0] room_back_q;
  reg some_room_q;  // as it was while sources asked; none is taken before one is let in
  wire some_room = |room_q;
  wire room_take;
  always @(posedge clk) begin
    some_room_q <= some_room;
    if (rst) begin
      room_q      <= DEPTH[ROOM_W-1:0];
      room_back_q <= 2'd0;
    end else begin
      room_back_q <= s_left_room + {1'b0, s_leaf_room};
      room_q      <= room_q + {{ROOM_W - 2{1'b0}}, room_back_q} - {{ROOM_W - 1{1'b0}}, room_take};
    end
  end
  wire answer_room, unused_some;
  localparam integer ANSWERS_W = $clog2(ANSWERS + 1);
  wire [ANSWERS_W-1:0] answers;
  cchip_count #(.LIMIT(ANSWERS)) u_answers (
      .clk  (clk),
      .rst  (rst),
      .up   (start_ends),
      .down (s_answer_room),
      .count(answers),
      .some (unused_some),
      .room (answer_room)
  );
  reg few_q;
  always @(posedge clk) few_q <= rst | ({{32 - ANSWERS_W{1'b0}}, answers} < 32'd4);

  // ---- first clock: which sources may enter?
  reg req_verdict_q, req_result_q, req_drop_q, req_start_q, req_pop_q;
  reg [QUERIES-1:0] verdict_lock_q, result_lock_q, drop_lock_q, start_lock_q, pop_lock_q;
  reg [CONTEXT_W-1:0] idle_context_q, pop_context_q;
  wire asks = ~choose_q & ~rst;
  wire can_go = place_valid & some_room;
  wire can_start = query_waits & ~starting_q & idle_valid_q & answer_room &
      start_ready;
  localparam [QUERIES-1:0] FIRST_CONTEXT = 1;
  always @(posedge clk) begin
    choose_q       <= asks;
    req_verdict_q  <= asks & verdict_valid_q & ~lock_q[lookup_context];
    req_result_q   <= asks & result_valid & ~lock_q[result_context];
    req_drop_q     <= asks & s_drop_valid & ~lock_q[s_drop_context];
    req_start_q    <= asks & can_start & can_go & |(idle_one_q & ~inside_q);
    req_pop_q      <= asks & can_go & |(want_one_q & ~inside_q);
    verdict_lock_q <= FIRST_CONTEXT << lookup_context;
    result_lock_q  <= FIRST_CONTEXT << result_context;
    drop_lock_q    <= FIRST_CONTEXT << s_drop_context;
    start_lock_q   <= idle_one_q;
    pop_lock_q     <= want_one_q;
    idle_context_q <= idle_context;
    pop_context_q  <= want_context;
  end

  // ---- second clock: one event is let in
  reg result_first_q;  // a verdict has gone before a result
  wire drop_take = req_drop_q & ~req_verdict_q & ~req_result_q;
  wire pop_take = req_pop_q & ~req_verdict_q & ~req_result_q & ~req_drop_q & ~req_start_q;
  assign verdict_take = req_verdict_q & ~(result_first_q & req_result_q);
  assign result_take  = req_result_q & (result_first_q | ~req_verdict_q);
  assign start_take   = req_start_q & ~req_verdict_q & ~req_result_q & ~req_drop_q;
  assign place_take   = start_take | pop_take;
  assign room_take    = place_take | (verdict_take & some_room_q);
  assign s_drop_ready = drop_take;
  wire take = req_verdict_q | req_result_q | req_drop_q | req_start_q | req_pop_q;
  wire [CONTEXT_W-1:0] taken = verdict_take ? lookup_context : result_take ? result_context :
      drop_take ? s_drop_context : start_take ? idle_context_q : pop_context_q;
  wire [QUERIES-1:0] locks = (verdict_lock_q & {QUERIES{verdict_take}}) |
      (result_lock_q & {QUERIES{result_take}}) | (drop_lock_q & {QUERIES{drop_take}}) |
      (start_lock_q & {QUERIES{start_take}}) | (pop_lock_q & {QUERIES{pop_take}});
  // a context counts only while it is valid: before, it may be unknown in simulation
  localparam [QUERIES-1:0] ONE_CONTEXT = 1;
  wire [QUERIES-1:0] unlocks = s_leaving_valid ? ONE_CONTEXT << s_leaving_context : {QUERIES{1'b0}};
  wire [QUERIES-1:0] leaves = s_left_valid ? ONE_CONTEXT << s_left_context : {QUERIES{1'b0}};

  reg judge_q;
  reg valid_q, is_verdict_q, is_result_q, is_start_q, is_pop_q, extra_q;
  reg [1:0] epoch_q;
  reg [CONTEXT_W-1:0] context_q;
  reg [PLACE_W-1:0] place_q;
  reg [56:0] of_verdict_q;
  reg [8:0] of_result_q;
  always @(posedge clk) begin
    is_verdict_q <= verdict_take;
    is_result_q  <= result_take | drop_take;
    judge_q      <= result_take;
    is_start_q   <= start_take;
    is_pop_q     <= pop_take;
    context_q    <= taken;
    epoch_q      <= verdict_take ? lookup_epoch : result_take ? result_epoch : s_drop_epoch;
    extra_q      <= verdict_take & some_room_q;
    place_q      <= verdict_take ? verdict_q[57+:PLACE_W] : place;
    of_verdict_q <= verdict_q[56:0];
    of_result_q  <= result_take ? result : 9'd0;
    if (rst) begin
      valid_q <= 1'b0;
      result_first_q <= 1'b0;
      lock_q  <= {QUERIES{1'b0}};
      inside_q <= {QUERIES{1'b0}};
      idle_q  <= {QUERIES{1'b1}};
      want_q  <= {QUERIES{1'b0}};
      idle_free_q <= {QUERIES{1'b0}};
      want_free_q <= {QUERIES{1'b0}};
    end else begin
      idle_free_q <= (idle_q & ~inside_q) | (leaves & {QUERIES{~s_left_active}});
      want_free_q <= (want_q & ~inside_q) | (leaves & {QUERIES{s_left_wants}});
      valid_q <= take;
      result_first_q <= result_first_q ? ~result_take : verdict_take & req_result_q;
      lock_q  <= (lock_q & ~unlocks) | locks;
      inside_q <= (inside_q & ~leaves) | locks;
      idle_q  <= s_left_active ? idle_q & ~leaves : idle_q | leaves;
      want_q  <= s_left_wants ? want_q | leaves : want_q & ~leaves;
    end
  end
  assign m_valid = valid_q;
  assign m_verdict_event = is_verdict_q;
  assign m_result_event = is_result_q;
  assign m_start_event = is_start_q;
  assign m_pop_event = is_pop_q;
  assign m_judge = judge_q;
  assign m_context = context_q;
  assign m_epoch = epoch_q;
  assign m_extra = extra_q;
  assign m_place = place_q;
  assign m_verdict = of_verdict_q;
  assign m_result = of_result_q;
  assign m_few = few_q;
  wire unused = &{1'b0, unused_some};

  // clocks for which the first result, and the first verdict, have waited; whether the other went
  // before it though it might have entered
  reg [4:0] result_waits_q, verdict_waits_q;
  reg result_passed_q, verdict_passed_q;
  wire both = req_result_q & req_verdict_q;
  always @(posedge clk) begin
    result_passed_q  <= ~rst & ~result_take & (result_passed_q | (both & verdict_take));
    verdict_passed_q <= ~rst & ~verdict_take & (verdict_passed_q | (both & result_take));
    result_waits_q  <= rst | ~result_valid | result_take ? 5'd0 : result_waits_q + 5'd1;
    verdict_waits_q <= rst | ~verdict_valid_q | verdict_take ? 5'd0 : verdict_waits_q + 5'd1;
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_verdict, !s_verdict_valid || queue_ready)
      `CCHIP_ASSERT(a_room, room_q <= DEPTH[ROOM_W-1:0])
      `CCHIP_ASSERT(a_locked, !take || !lock_q[taken])
      `CCHIP_ASSERT(a_left, !s_left_valid || inside_q[s_left_context])
      `CCHIP_ASSERT(a_inside, !(start_take || pop_take) || !inside_q[taken])
      `CCHIP_ASSERT(a_wants, !pop_take || want_q[taken])
      `CCHIP_ASSERT(a_idle, !start_take || idle_q[taken])
      `CCHIP_ASSERT(a_result_turn, !(both && verdict_take && result_passed_q))
      `CCHIP_ASSERT(a_verdict_turn, !(both && result_take && verdict_passed_q))
      `CCHIP_ASSERT(a_result_waits, result_waits_q <= 5'd16)
      `CCHIP_ASSERT(a_verdict_waits, verdict_waits_q <= 5'd16)
    end

endmodule
`default_nettype wire
