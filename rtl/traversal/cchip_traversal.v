// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_traversal: walks the trees of two objects. Of a node pair whose boxes the box test has
// compared, the child pair that overlaps most goes on at once; the others wait on the query's
// stack; pairs of leaves go to cchip_leaf_queue.
//   rule         every event of a query (start, a verdict, a result of a pair of leaves, a pair
//                taken from the stack) passes one pipeline, the events of one query one at a time
//   epochs       a query that ends leaves node pairs and pairs of leaves behind. They carry the
//                epoch of their query, are counted, and are forgotten as they come back; an epoch
//                is used again when its count is 0
//   room         a verdict always has room: a node pair is under way only with a place in the leaf
//                queue; a query starts only with a place for its answer
//   latency      12 clocks from s_verdict_valid to m_valid
//   throughput   an event per clock, of one query one in 9 clocks
//   cuts         every path: each output is a flip-flop
//   reset        forgets all queries; takes 4 QUERIES clocks, events wait
module cchip_traversal #(
    // queries at once: 2, 4, 8 or 16
    parameter integer QUERIES = 16,
    // node pairs under way
    parameter integer PAIRS = 48,
    // pairs of leaves that are fetched at once; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    // entries of a query's stack: 8, 16, 32 or 64
    parameter integer STACK = 64,
    // entries of the leaf queue, more than PAIRS
    parameter integer LEAF_DEPTH = 72,
    // pairs of leaves that the receiver has room for
    parameter integer CREDIT = 32
) (
    input  wire                             clk,
    input  wire                             rst,
    // node pairs of a query that may be under way, 1..7; half of it with pairs of leaves out
    input  wire [                      2:0] pairs_each,
    input  wire [                     31:0] step_limit,       // node pairs of a query
    input  wire [                      7:0] open_limit,       // open pairs of a FIRST query
    // queries (docs/image.md)
    input  wire                             s_query_valid,
    output wire                             s_query_ready,
    input  wire [                    511:0] s_query,
    // one that has started, for whoever needs its pose: the box test and the transform
    output wire                             m_start_valid,
    input  wire                             m_start_ready,
    output wire [      $clog2(QUERIES)-1:0] m_start_context,
    output wire [                      1:0] m_start_epoch,
    output wire [                    511:0] m_start_query,
    // lines for a place of cchip_get_data; always taken
    output wire                             m_valid,
    output wire [$clog2(PAIRS+LEAVES)-1:0] m_place,
    output wire [      $clog2(QUERIES)-1:0] m_context,
    output wire [                     58:0] m_record,
    output wire [                     63:0] m_lines,
    // a pair of leaves has left there
    input  wire                             s_leaf_valid,
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_leaf_place,
    // verdicts of cchip_bv_unit, and what cchip_get_data knows of the node pair
    input  wire                             s_verdict_valid,
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_verdict_place,
    input  wire [                     15:0] s_verdict_waiting,
    input  wire [                     15:0] s_verdict_leaves,
    input  wire [                     15:0] s_verdict_strong,
    input  wire [                      3:0] s_verdict_best,
    input  wire [                      4:0] s_verdict_tests,
    output wire                             lookup,
    output wire [$clog2(PAIRS+LEAVES)-1:0] lookup_place,
    input  wire [      $clog2(QUERIES)-1:0] lookup_context,
    input  wire [                     58:0] lookup_record,
    input  wire [                     66:0] lookup_nodes,
    // what became of a pair of leaves, and room for another one
    input  wire                             s_result_valid,
    output wire                             s_result_ready,
    input  wire [      $clog2(QUERIES)-1:0] s_result_context,
    input  wire [                      1:0] s_result_epoch,
    input  wire [                      2:0] s_result_hits,    // definite hits, 0..4
    input  wire [                      2:0] s_result_open,    // others
    input  wire [                      2:0] s_result_code,
    input  wire                             s_credit,
    // queries that have ended
    output wire                             m_done_valid,
    input  wire                             m_done_ready,
    output wire [                     31:0] m_done_tag,
    output wire [                      2:0] m_done_code,
    output wire [                      1:0] m_done_answer,    // no, yes, open
    output wire [                     31:0] m_done_steps,
    output wire [                     31:0] m_done_pairs,
    // what happens on this clock, for counters
    output wire                             count_step,
    output wire [                      4:0] count_tests,
    output wire                             count_leaf_pair
);

  // how a query ended (docs/image.md)
  localparam [2:0] END_OK = 3'd0, END_HOST = 3'd1, END_STEPS = 3'd2, END_STACK = 3'd3;
  localparam [2:0] END_BAD_DESCRIPTOR = 3'd6;
  localparam integer PLACE_W = $clog2(PAIRS + LEAVES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer EPOCH_W = 2;
  localparam integer RECORD_W = 59;
  localparam integer NODES_W = 67;
  localparam integer CODE_W = 3;
  localparam integer STACK_W = $clog2(STACK);
  localparam integer WORK_W = 12;  // pairs of one epoch of a query: LEAF_DEPTH 16 and some
  localparam integer ROOM_W = $clog2(LEAF_DEPTH + 1);
  localparam [31:0] FULL = STACK, DEPTH = LEAF_DEPTH;
  localparam [31:0] LAST_EPOCH = QUERIES * 4 - 1;
  localparam integer LIMIT_DONE = 2 * QUERIES;

  generate
    if (QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES) begin : gen_illegal_queries
      cchip_error_traversal_QUERIES_must_be_2_4_8_or_16 u_error ();
    end
    if (LEAF_DEPTH <= PAIRS || LEAF_DEPTH > 128) begin : gen_illegal_depth
      cchip_error_traversal_LEAF_DEPTH_must_be_over_PAIRS_to_128 u_error ();
    end
    if (STACK < 8 || STACK > 64 || (1 << STACK_W) != STACK) begin : gen_illegal_stack
      cchip_error_traversal_STACK_must_be_8_16_32_or_64 u_error ();
    end
  endgenerate

  // ---- after reset every context and every epoch is written once
  reg running_q;
  reg [CONTEXT_W+EPOCH_W-1:0] clear_q;
  always @(posedge clk)
    if (rst) begin
      running_q <= 1'b0;
      clear_q   <= {CONTEXT_W + EPOCH_W{1'b0}};
    end else if (!running_q) begin
      running_q <= clear_q == LAST_EPOCH[CONTEXT_W+EPOCH_W-1:0];
      clear_q   <= clear_q + {{CONTEXT_W + EPOCH_W - 1{1'b0}}, 1'b1};
    end

  // ---- who waits for the pipeline. Verdicts, with what is known of their node pairs
  localparam [1:0] VERDICT = 2'd0, RESULT = 2'd1, START = 2'd2, POP = 2'd3;
  reg verdict_valid_q;
  wire verdict_take, queue_valid, queue_ready;
  wire [PLACE_W+56:0] queue_verdict;
  cchip_fifo #(
      .WIDTH     (PLACE_W + 57),
      .DEPTH     (PAIRS),
      .ROOM_KNOWN(1)
  ) u_verdicts (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_verdict_valid),
      .s_ready(queue_ready),
      .s_data ({
        s_verdict_place,
        s_verdict_tests,
        s_verdict_best,
        s_verdict_strong,
        s_verdict_leaves,
        s_verdict_waiting
      }),
      .m_valid(queue_valid),
      .m_ready(lookup),
      .m_data (queue_verdict)
  );
  reg [PLACE_W+56:0] verdict_q;
  assign lookup       = ~verdict_valid_q | verdict_take;
  assign lookup_place = queue_verdict[57+:PLACE_W];
  always @(posedge clk) begin
    if (lookup) verdict_q <= queue_verdict;
    if (rst) verdict_valid_q <= 1'b0;
    else if (lookup) verdict_valid_q <= queue_valid;
  end

  // Results, and pairs of leaves that nobody waits for any more
  localparam integer RESULT_W = CONTEXT_W + EPOCH_W + 6 + CODE_W;
  wire result_valid, result_take, drop_valid, drop_take;
  wire [RESULT_W-1:0] result;
  cchip_skid_buffer #(
      .WIDTH(RESULT_W)
  ) u_result (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_result_valid),
      .s_ready(s_result_ready),
      .s_data ({s_result_context, s_result_epoch, s_result_code, s_result_open, s_result_hits}),
      .m_valid(result_valid),
      .m_ready(result_take),
      .m_data (result)
  );
  wire [CONTEXT_W-1:0] drop_context;
  wire [EPOCH_W-1:0] drop_epoch;

  // Queries, with a context that has none
  reg [QUERIES-1:0] lock_q;  // has an event in the pipeline
  reg [QUERIES-1:0] idle_q;  // has no query
  reg [QUERIES-1:0] want_q;  // has a stack and may have another node pair under way
  reg query_valid_q, query_ready_q, bad_q, judged_q, idle_valid_q, starting_q;
  reg [511:0] query_q;
  reg [CONTEXT_W-1:0] idle_context_q;
  wire start_take, start_done, start_cancel;  // on its way; ended in the pipeline; try another one
  wire start_ends = start_done & ~start_cancel;
  wire query_in = s_query_valid & query_ready_q;
  wire [8:0] beyond;  // |M_ij| > 1
  wire [QUERIES-1:0] idle_grant, want_grant;
  wire [CONTEXT_W-1:0] idle_context, want_context;
  genvar n, b;
  generate
    for (n = 0; n < 9; n = n + 1) begin : gen_m
      wire [31:0] m = query_q[64+32*n+:32];
      assign beyond[n] = m[31] ? ~m[30] : m[30] & |m[29:0];
    end
    for (b = 0; b < CONTEXT_W; b = b + 1) begin : gen_context
      wire [QUERIES-1:0] with_bit;
      for (n = 0; n < QUERIES; n = n + 1) begin : gen_with
        localparam [31:0] N = n;
        assign with_bit[n] = N[b];
      end
      assign idle_context[b] = |(idle_grant & with_bit);
      assign want_context[b] = |(want_grant & with_bit);
    end
  endgenerate
  cchip_arbiter #(
      .N(QUERIES)
  ) u_idle (
      .clk    (clk),
      .rst    (rst),
      .request(idle_q & ~lock_q),
      .grant  (idle_grant),
      .take   (~idle_valid_q)
  );
  always @(posedge clk) begin
    if (query_in) query_q <= s_query;
    bad_q <= |beyond | (|query_q[479:478]);
    if (~idle_valid_q) idle_context_q <= idle_context;
    if (rst) begin
      query_valid_q <= 1'b0;
      query_ready_q <= 1'b0;
      judged_q      <= 1'b0;
      idle_valid_q  <= 1'b0;
      starting_q    <= 1'b0;
    end else begin
      query_valid_q <= query_valid_q ? ~start_ends : query_in;
      query_ready_q <= query_valid_q ? start_ends : ~query_in;
      judged_q      <= query_valid_q & ~start_done;
      idle_valid_q  <= idle_valid_q ? ~start_take : running_q & |(idle_q & ~lock_q);
      starting_q    <= start_take | (starting_q & ~start_done);
    end
  end
  assign s_query_ready = query_ready_q;

  // Stacks
  reg pop_valid_q;
  reg [CONTEXT_W-1:0] pop_context_q;
  wire pop_take;
  cchip_arbiter #(
      .N(QUERIES)
  ) u_want (
      .clk    (clk),
      .rst    (rst),
      .request(want_q & ~lock_q),
      .grant  (want_grant),
      .take   (1'b1)
  );
  always @(posedge clk) begin
    pop_context_q <= want_context;
    pop_valid_q   <= ~rst & |(want_q & ~lock_q);
  end

  // ---- what an event may need: a place, room in the leaf queue, room for the answer
  reg [PAIRS-1:0] free_q;
  reg place_valid_q;
  reg [PLACE_W-1:0] place_q;
  wire place_take, place_back;
  wire [PLACE_W-1:0] back_place;
  wire [PAIRS-1:0] free_one = free_q & (~free_q + {{PAIRS - 1{1'b0}}, 1'b1});
  wire [PLACE_W-1:0] free_place;
  generate
    for (b = 0; b < PLACE_W; b = b + 1) begin : gen_place
      wire [PAIRS-1:0] with_bit;
      for (n = 0; n < PAIRS; n = n + 1) begin : gen_with
        localparam [31:0] N = n;
        assign with_bit[n] = N[b];
      end
      assign free_place[b] = |(free_one & with_bit);
    end
  endgenerate
  wire place_load = ~place_valid_q | place_take;
  always @(posedge clk) begin
    if (place_load) place_q <= free_place;
    if (rst) begin
      free_q        <= {PAIRS{1'b1}};
      place_valid_q <= 1'b0;
    end else begin
      free_q <= (free_q & ~(free_one & {PAIRS{place_load}})) |
          ({{PAIRS - 1{1'b0}}, place_back} << back_place);
      if (place_load) place_valid_q <= |free_q;
    end
  end
  reg [ROOM_W-1:0] room_q;  // of the leaf queue, that no node pair has
  reg some_room_q;
  wire room_take, leaf_room;
  wire [1:0] room_back;
  wire [ROOM_W-1:0] room = room_q + {{ROOM_W - 2{1'b0}}, room_back} +
      {{ROOM_W - 1{1'b0}}, leaf_room} - {{ROOM_W - 1{1'b0}}, room_take};
  always @(posedge clk)
    if (rst) begin
      room_q      <= DEPTH[ROOM_W-1:0];
      some_room_q <= 1'b1;
    end else begin
      room_q      <= room;
      some_room_q <= room != {ROOM_W{1'b0}};
    end
  wire answer_room, answer_some, answer_up, answer_down;
  wire [$clog2(LIMIT_DONE+1)-1:0] answers;
  cchip_count #(
      .LIMIT(LIMIT_DONE)
  ) u_answers (
      .clk  (clk),
      .rst  (rst),
      .up   (answer_up),
      .down (answer_down),
      .count(answers),
      .some (answer_some),
      .room (answer_room)
  );

  // ---- stage 0: one event is let in
  wire [CONTEXT_W-1:0] result_context = result[RESULT_W-1-:CONTEXT_W];
  wire can_verdict = verdict_valid_q & ~lock_q[lookup_context];
  wire can_result = result_valid & ~lock_q[result_context];
  wire can_drop = drop_valid & ~lock_q[drop_context];
  wire can_go = place_valid_q & some_room_q;
  wire can_start = query_valid_q & judged_q & ~starting_q & idle_valid_q & can_go & answer_room &
      m_start_ready & ~lock_q[idle_context_q];
  wire can_pop = pop_valid_q & want_q[pop_context_q] & ~lock_q[pop_context_q] & can_go;
  assign verdict_take = can_verdict;
  assign result_take  = can_result & ~can_verdict;
  assign drop_take    = can_drop & ~can_verdict & ~can_result;
  assign start_take   = can_start & ~can_verdict & ~can_result & ~can_drop;
  assign pop_take     = can_pop & ~can_verdict & ~can_result & ~can_drop & ~can_start;
  assign place_take   = start_take | pop_take;
  assign room_take    = place_take | (verdict_take & some_room_q);
  wire [CONTEXT_W-1:0] context0 = verdict_take ? lookup_context : result_take ? result_context :
      drop_take ? drop_context : start_take ? idle_context_q : pop_context_q;

  // ---- stages 1 to 7
  reg valid_q1, valid_q2, valid_q3, valid_q4, valid_q5, valid_q6, valid_q7;
  reg [1:0] event_q1, event_q2, event_q3, event_q4, event_q5, event_q6;
  reg [CONTEXT_W-1:0] context_q1, context_q2, context_q3, context_q4, context_q5, context_q6;
  reg [CONTEXT_W-1:0] context_q7;
  reg [EPOCH_W-1:0] epoch_q1;
  reg extra_q1, extra_q2, extra_q3, extra_q4, extra_q5;  // room that the event has
  reg [PLACE_W-1:0] place_q1, place_q2, place_q3, place_q4, place_q5, place_q6;
  // of a verdict
  reg [56:0] verdict_q1, verdict_q2, verdict_q3, verdict_q4, verdict_q5;
  reg [RECORD_W-1:0] record_q1, record_q2, record_q3, record_q4, record_q5;
  reg [NODES_W-1:0] nodes_q1, nodes_q2, nodes_q3, nodes_q4, nodes_q5;
  // of a result
  reg [CODE_W+5:0] result_q1, result_q2, result_q3, result_q4, result_q5;
  wire event_in = verdict_take | result_take | drop_take | start_take | pop_take;
  wire [QUERIES-1:0] locks = {{QUERIES - 1{1'b0}}, event_in} << context0;
  wire [QUERIES-1:0] unlocks = {{QUERIES - 1{1'b0}}, valid_q7} << context_q7;
  always @(posedge clk) begin
    event_q1   <= verdict_take ? VERDICT : result_take | drop_take ? RESULT :
        start_take ? START : POP;
    context_q1 <= context0;
    epoch_q1   <= verdict_take ? lookup_record[57:56] :
        result_take ? result[6+CODE_W+:EPOCH_W] : drop_epoch;
    extra_q1   <= verdict_take & some_room_q;
    place_q1   <= verdict_take ? verdict_q[57+:PLACE_W] : place_q;
    verdict_q1 <= verdict_q[56:0];
    record_q1  <= lookup_record;
    nodes_q1   <= lookup_nodes;
    result_q1  <= result_take ? result[CODE_W+5:0] : {CODE_W + 6{1'b0}};
    {event_q2, context_q2, extra_q2, place_q2} <= {event_q1, context_q1, extra_q1, place_q1};
    {event_q3, context_q3, extra_q3, place_q3} <= {event_q2, context_q2, extra_q2, place_q2};
    {event_q4, context_q4, extra_q4, place_q4} <= {event_q3, context_q3, extra_q3, place_q3};
    {event_q5, context_q5, extra_q5, place_q5} <= {event_q4, context_q4, extra_q4, place_q4};
    {event_q6, context_q6, place_q6} <= {event_q5, context_q5, place_q5};
    context_q7 <= context_q6;
    {verdict_q2, verdict_q3, verdict_q4, verdict_q5} <= {
      verdict_q1, verdict_q2, verdict_q3, verdict_q4
    };
    {record_q2, record_q3, record_q4, record_q5} <= {record_q1, record_q2, record_q3, record_q4};
    {nodes_q2, nodes_q3, nodes_q4, nodes_q5} <= {nodes_q1, nodes_q2, nodes_q3, nodes_q4};
    {result_q2, result_q3, result_q4, result_q5} <= {result_q1, result_q2, result_q3, result_q4};
    if (rst) begin
      {valid_q1, valid_q2, valid_q3, valid_q4, valid_q5, valid_q6, valid_q7} <= 7'd0;
      lock_q <= {QUERIES{1'b0}};
    end else begin
      valid_q1 <= event_in;
      {valid_q2, valid_q3, valid_q4, valid_q5, valid_q6, valid_q7} <= {
        valid_q1, valid_q2, valid_q3, valid_q4, valid_q5, valid_q6
      };
      lock_q <= (lock_q & ~unlocks) | locks;
    end
  end

  // ---- stage 1: the state of the query
  localparam integer STATE_W = EPOCH_W + 2 + (STACK_W + 1) + 3 + 32 + 32 + 8 + 1;
  (* ram_style = "distributed" *)
  reg [STATE_W-1:0] states[0:QUERIES-1];
  (* ram_style = "distributed" *)
  reg [95:0] constants[0:QUERIES-1];  // {tag, line of B, line of A}
  (* ram_style = "distributed" *)
  reg [WORK_W-1:0] works[0:4*QUERIES-1];  // node pairs and pairs of leaves of each epoch
  reg [STATE_W-1:0] state_q2, state_q3, state_q4, state_q5;
  reg [95:0] constants_q2, constants_q3, constants_q4, constants_q5;
  wire [EPOCH_W-1:0] now2 = state_q2[STATE_W-1-:EPOCH_W];
  reg [EPOCH_W-1:0] epoch_q2, epoch_q3, epoch_q4, epoch_q5, epoch_q6;
  reg own_q2;  // the event is of the query as it is
  reg live_q3, live_q4, live_q5;
  reg [WORK_W-1:0] work_q4, work_q5;
  wire [STACK_W:0] entries2 = state_q2[76+:STACK_W+1];
  wire [STACK_W-1:0] top2 = entries2[STACK_W-1:0] - {{STACK_W - 1{1'b0}}, 1'b1};
  reg [STACK_W-1:0] top_q3;
  wire [135:0] entry5;
  wire stack_write;
  wire [CONTEXT_W+STACK_W-1:0] stack_addr;
  wire [135:0] stack_entry;
  cchip_block_ram #(
      .WIDTH (136),
      .ADDR_W(CONTEXT_W + STACK_W)
  ) u_stack (
      .clk       (clk),
      .write     (stack_write),
      .write_addr(stack_addr),
      .write_data(stack_entry),
      .read_addr ({context_q3, top_q3}),
      .read_data (entry5)
  );
  always @(posedge clk) begin
    state_q2     <= states[context_q1];
    constants_q2 <= constants[context_q1];
    own_q2       <= event_q1 == START || event_q1 == POP;
    epoch_q2     <= epoch_q1;
    top_q3       <= top2;
    epoch_q3     <= own_q2 ? now2 : epoch_q2;
    live_q3      <= state_q2[STATE_W-EPOCH_W-1] && (own_q2 || now2 == epoch_q2);
    work_q4      <= works[{context_q3, epoch_q3}];
    {epoch_q4, epoch_q5, epoch_q6} <= {epoch_q3, epoch_q4, epoch_q5};
    {live_q4, live_q5} <= {live_q3, live_q4};
    work_q5 <= work_q4;
    {state_q3, state_q4, state_q5} <= {state_q2, state_q3, state_q4};
    {constants_q3, constants_q4, constants_q5} <= {constants_q2, constants_q3, constants_q4};
  end

  // ---- stages 3 and 4: comparisons
  reg over_q4, over_q5, full_q4, full_q5, fails_q5, leaves_q5, waiting_q5, room_q5;
  reg [4:0] leaf_count_q5;
  wire [15:0] leaves4 = verdict_q4[31:16];
  wire [CODE_W-1:0] code4 = nodes_q4[NODES_W-1-:CODE_W];
  always @(posedge clk) begin
    over_q4 <= state_q3[41+:32] == step_limit;
    over_q5 <= over_q4;
    full_q4 <= state_q3[76+:STACK_W+1] == FULL[STACK_W:0];
    full_q5 <= full_q4;
    fails_q5 <= code4 != END_OK;
    leaves_q5 <= |leaves4;
    waiting_q5 <= |verdict_q4[15:0];
    room_q5 <= ~|leaves4 | extra_q4;
    leaf_count_q5 <= {4'd0, leaves4[0]} + {4'd0, leaves4[1]} + {4'd0, leaves4[2]} +
        {4'd0, leaves4[3]} + {4'd0, leaves4[4]} + {4'd0, leaves4[5]} + {4'd0, leaves4[6]} +
        {4'd0, leaves4[7]} + {4'd0, leaves4[8]} + {4'd0, leaves4[9]} + {4'd0, leaves4[10]} +
        {4'd0, leaves4[11]} + {4'd0, leaves4[12]} + {4'd0, leaves4[13]} + {4'd0, leaves4[14]} +
        {4'd0, leaves4[15]};
  end

  // ---- stage 5: what happens. A child pair goes on, and what is left of the node pair waits
  wire verdict5 = event_q5 == VERDICT;
  wire result5 = event_q5 == RESULT;
  wire start5 = event_q5 == START;
  wire pop5 = event_q5 == POP;
  wire header5 = record_q5[58];
  wire mode5 = state_q5[STATE_W-EPOCH_W-2];
  wire [STACK_W:0] entries5 = state_q5[76+:STACK_W+1];
  wire [2:0] under5 = state_q5[75:73];
  wire step5 = verdict5 & live_q5 & ~fails_q5 & ~header5 & ~over_q5;
  wire header_ok5 = verdict5 & live_q5 & ~fails_q5 & header5;
  wire onward5 = step5 & waiting_q5 & room_q5;
  // {inner children, first child, node} of B and of A
  wire [3:0] inner_a5, inner_b5;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_inner
      assign inner_a5[n] = nodes_q5[24+2*n+:2] == 2'd0;
      assign inner_b5[n] = nodes_q5[56+2*n+:2] == 2'd0;
    end
  endgenerate
  wire [51:0] half_a5 = pop5 ? entry5[51:0] : {inner_a5, nodes_q5[23:0], record_q5[23:0]};
  wire [51:0] half_b5 = pop5 ? entry5[103:52] : {inner_b5, nodes_q5[55:32], record_q5[51:28]};
  wire [15:0] waiting5 = pop5 ? entry5[119:104] : verdict_q5[15:0];
  wire [15:0] strong5 = pop5 ? entry5[135:120] : verdict_q5[47:32];
  wire [15:0] from5 = |entry5[135:120] ? entry5[135:120] : entry5[119:104];
  wire [15:0] lowest5 = from5 & (~from5 + 16'd1);
  wire [15:0] best5 = 16'd1 << verdict_q5[51:48];
  wire [15:0] one5 = pop5 ? lowest5 : best5;
  wire [15:0] rest_waiting5 = waiting5 & ~one5;
  wire [15:0] rest_strong5 = strong5 & ~one5;
  wire [3:0] lowest_number5;
  assign lowest_number5[3] = |lowest5[15:8];
  assign lowest_number5[2] = |{lowest5[15:12], lowest5[7:4]};
  assign lowest_number5[1] = |{lowest5[15:14], lowest5[11:10], lowest5[7:6], lowest5[3:2]};
  wire [7:0] odd5 = {
    lowest5[15], lowest5[13], lowest5[11], lowest5[9],
    lowest5[7], lowest5[5], lowest5[3], lowest5[1]
  };
  assign lowest_number5[0] = |odd5;
  wire rest5 = |rest_waiting5;
  wire push5 = step5 & waiting_q5 & (~room_q5 | rest5);
  wire spill5 = push5 & full_q5;
  wire start_ok5 = start5 & ~|work_q5 & ~bad_q;
  wire goes5 = start_ok5 | pop5 | header_ok5 | (onward5 & ~spill5);
  wire leaf5 = step5 & leaves_q5 & ~spill5;
  wire counts5 = result5 & live_q5;
  wire [2:0] hits5 = result_q5[2:0];
  wire [2:0] open5 = result_q5[5:3];
  wire [8:0] opens5 = {1'b0, state_q5[8:1]} + {6'd0, open5};
  wire [CODE_W-1:0] result_code5 = result_q5[5+CODE_W-:CODE_W];
  wire was5 = state_q5[STATE_W-EPOCH_W-1];  // the context has a query
  wire fails5 = live_q5 & (verdict5 ? fails_q5 | (~header5 & over_q5) | spill5 :
      result5 & (|result_code5 | (~mode5 & (|hits5 | opens5 >= {1'b0, open_limit}))));
  wire [CODE_W-1:0] code5 = result5 ? (|result_code5 ? result_code5 : |hits5 ? END_OK :
      END_HOST) : fails_q5 ? nodes_q5[NODES_W-1-:CODE_W] :
      spill5 ? END_STACK : END_STEPS;
  // what is added to the work of the epoch: pairs of leaves, and the node pair itself
  wire [WORK_W-1:0] more5 = leaf5 ? {{WORK_W - 5{1'b0}}, leaf_count_q5} : {WORK_W{1'b0}};
  wire [WORK_W-1:0] one_more5 = {{WORK_W - 1{1'b0}}, pop5};
  wire [WORK_W-1:0] one_less5 = {{WORK_W - 1{1'b0}}, result5 | (verdict5 & ~goes5)};

  reg goes_q6, header_q6, push_q6, leaf_q6, back_q6, fails_q6, bad_q6, cancel_q6, live_q6, step_q6;
  reg active_q6;
  reg [1:0] room_back_q6;
  reg [51:0] half_a_q6, half_b_q6;
  reg [3:0] number_q6;
  reg [15:0] push_waiting_q6, push_strong_q6;
  reg [CODE_W-1:0] code_q6;
  reg [WORK_W-1:0] work_q6;
  reg [STACK_W:0] entries_q6;
  reg [STACK_W-1:0] at_q6;
  reg [2:0] under_q6;
  reg [31:0] steps_q6, pairs_q6;
  reg [7:0] opens_q6;
  reg hit_q6, mode_q6, root_q6;
  reg [EPOCH_W-1:0] now_q6;
  reg [95:0] constants_q6;
  reg [79:0] leaf_nodes_q6;
  reg [15:0] leaf_set_q6;
  reg [4:0] tests_q6;
  wire [STACK_W:0] one_entry = {{STACK_W{1'b0}}, 1'b1};
  always @(posedge clk) begin
    goes_q6         <= goes5;
    header_q6       <= start5;
    root_q6         <= header_ok5;
    push_q6         <= (push5 & ~full_q5) | (pop5 & rest5);
    leaf_q6         <= leaf5;
    back_q6         <= ~goes5 & ~result5;
    fails_q6        <= fails5;
    bad_q6          <= start5 & ~|work_q5 & bad_q;
    cancel_q6       <= start5 & |work_q5;
    live_q6         <= live_q5 | start_ok5;
    active_q6       <= start5 ? start_ok5 : was5;
    step_q6         <= step5;
    room_back_q6    <= result5 ? 2'd0 : start5 | pop5 ? {1'b0, ~goes5} :
        2'd1 + {1'b0, extra_q5} - {1'b0, leaf5} - {1'b0, goes5};
    half_a_q6       <= half_a5;
    half_b_q6       <= half_b5;
    number_q6       <= pop5 ? lowest_number5 : verdict_q5[51:48];
    push_waiting_q6 <= pop5 | onward5 ? rest_waiting5 : waiting5;
    push_strong_q6  <= pop5 | onward5 ? rest_strong5 : strong5 | best5;
    code_q6         <= code5;
    work_q6         <= start5 ? (|work_q5 ? work_q5 : {{WORK_W - 1{1'b0}}, start_ok5}) :
        work_q5 + more5 + one_more5 - one_less5;
    entries_q6      <= start5 ? {STACK_W + 1{1'b0}} : push5 ? entries5 + one_entry :
        pop5 & ~rest5 ? entries5 - one_entry : entries5;
    at_q6           <= entries5[STACK_W-1:0] - (pop5 ? one_entry[STACK_W-1:0] : {STACK_W{1'b0}});
    under_q6        <= start5 ? 3'd1 : pop5 ? under5 + 3'd1 :
        verdict5 & live_q5 & ~goes5 ? under5 - 3'd1 : under5;
    steps_q6        <= start5 ? 32'd0 : state_q5[72:41] + {31'd0, step5};
    pairs_q6        <= start5 ? 32'd0 :
        counts5 ? state_q5[40:9] + {29'd0, hits5} + {29'd0, open5} : state_q5[40:9];
    opens_q6        <= start5 ? 8'd0 : ~counts5 ? state_q5[8:1] : opens5[8] ? 8'd255 : opens5[7:0];
    hit_q6          <= ~start5 & (state_q5[0] | (counts5 & |hits5));
    mode_q6         <= start5 ? query_q[476] : mode5;
    now_q6          <= state_q5[STATE_W-1-:EPOCH_W];
    constants_q6    <= start5 ? {query_q[511:480], query_q[63:0]} : constants_q5;
    leaf_nodes_q6   <= {
      nodes_q5[63:56], {8'd0, nodes_q5[55:32]} + constants_q5[63:32],
      nodes_q5[31:24], {8'd0, nodes_q5[23:0]} + constants_q5[31:0]
    };
    leaf_set_q6     <= verdict_q5[31:16];
    tests_q6        <= verdict_q5[56:52];
  end

  // ---- stage 6: the child pair's lines; is the query at its end?
  wire ends6 = bad_q6 | (live_q6 & (fails_q6 | (~|work_q6 & ~|entries_q6)));
  wire [CODE_W-1:0] end_code6 = bad_q6 ? END_BAD_DESCRIPTOR :
      fails_q6 ? code_q6 : END_OK;
  wire [1:0] i6 = number_q6[3:2];
  wire [1:0] j6 = number_q6[1:0];
  wire [27:0] next_a6 = root_q6 ? {4'd15, half_a_q6[47:24]} : half_a_q6[{4'd12, i6}] ?
      {4'd15, half_a_q6[47:24] + {22'd0, i6}} : {4'd1 << i6, half_a_q6[23:0]};
  wire [27:0] next_b6 = root_q6 ? {4'd15, half_b_q6[47:24]} : half_b_q6[{4'd12, j6}] ?
      {4'd15, half_b_q6[47:24] + {22'd0, j6}} : {4'd1 << j6, half_b_q6[23:0]};
  reg event_start_q7, cancel_q7, started_q7;
  reg goes_q7, push_q7, leaf_q7, back_q7, ends_q7, active_q7, wants_q7, step_q7;
  reg [1:0] room_back_q7;
  reg [STATE_W-1:0] state_q7;
  reg [WORK_W-1:0] work_q7;
  reg [EPOCH_W-1:0] epoch_q7;
  reg [95:0] constants_q7;
  reg [135:0] entry_q7;
  reg [STACK_W-1:0] at_q7;
  reg [PLACE_W-1:0] place_q7;
  reg [RECORD_W-1:0] record_q7;
  reg [79:0] leaf_nodes_q7;
  reg [15:0] leaf_set_q7;
  reg [4:0] tests_q7;
  reg [68:0] answer_q7;
  wire active6 = active_q6 & ~ends6;
  // a FIRST query with pairs of leaves out, one of which may end it, asks for half as much
  wire hopes6 = ~mode_q6 && work_q6 != {{WORK_W - 3{1'b0}}, under_q6};
  wire [2:0] most6 = hopes6 ? {1'b0, pairs_each[2:1]} : pairs_each;
  wire [EPOCH_W-1:0] now6 = now_q6 + {{EPOCH_W - 1{1'b0}}, ends6};
  always @(posedge clk) begin
    event_start_q7 <= event_q6 == START;
    cancel_q7      <= cancel_q6;
    started_q7     <= event_q6 == START && goes_q6;
    goes_q7        <= valid_q6 & goes_q6 & ~ends6;
    push_q7        <= valid_q6 & push_q6;
    leaf_q7        <= valid_q6 & leaf_q6;
    back_q7        <= valid_q6 & back_q6;
    ends_q7        <= valid_q6 & ends6;
    step_q7        <= valid_q6 & step_q6;
    active_q7      <= active6;
    wants_q7       <= active6 && entries_q6 != {STACK_W + 1{1'b0}} &&
        under_q6 < most6;
    room_back_q7   <= valid_q6 ? room_back_q6 : 2'd0;
    state_q7       <= {
      now6, active6, mode_q6, entries_q6, under_q6, steps_q6, pairs_q6, opens_q6, hit_q6
    };
    work_q7        <= work_q6;
    epoch_q7       <= epoch_q6;
    constants_q7   <= constants_q6;
    entry_q7       <= {push_strong_q6, push_waiting_q6, half_b_q6, half_a_q6};
    at_q7          <= at_q6;
    place_q7       <= place_q6;
    record_q7      <= header_q6 ? {1'b1, now_q6, 56'd0} : {1'b0, epoch_q6, next_b6, next_a6};
    leaf_nodes_q7  <= leaf_nodes_q6;
    leaf_set_q7    <= leaf_set_q6;
    tests_q7       <= tests_q6;
    answer_q7      <= {
      end_code6, hit_q6 ? 2'd1 : |opens_q6 ? 2'd2 : 2'd0, steps_q6, pairs_q6
    };
  end

  // ---- stage 7: everything is written
  wire [CONTEXT_W-1:0] write_context = running_q ? context_q7 : clear_q[CONTEXT_W-1:0];
  wire write = valid_q7 | ~running_q;
  wire [STATE_W-1:0] write_state = running_q ? state_q7 : {STATE_W{1'b0}};
  always @(posedge clk) begin
    if (write) states[write_context] <= write_state;
    if (valid_q7) constants[context_q7] <= constants_q7;
    if (write) works[running_q ? {context_q7, epoch_q7} : clear_q] <= running_q ? work_q7 :
        {WORK_W{1'b0}};
    if (rst) begin
      idle_q <= {QUERIES{1'b1}};
      want_q <= {QUERIES{1'b0}};
    end else begin
      idle_q <= active_q7 ? idle_q & ~unlocks : idle_q | unlocks;
      want_q <= wants_q7 ? want_q | unlocks : want_q & ~unlocks;
    end
  end
  assign stack_write     = push_q7;
  assign stack_addr      = {context_q7, at_q7};
  assign stack_entry     = entry_q7;
  assign place_back      = back_q7;
  assign back_place      = place_q7;
  assign room_back       = room_back_q7;
  assign start_done      = valid_q7 & event_start_q7;
  assign start_cancel    = cancel_q7;
  assign answer_up       = start_done & ~cancel_q7;
  assign m_start_valid   = valid_q7 & started_q7;
  assign m_start_context = context_q7;
  assign m_start_epoch   = epoch_q7;
  assign m_start_query   = query_q;

  wire done_ready;
  cchip_fifo #(
      .WIDTH     (101),
      .DEPTH     (LIMIT_DONE),
      .ROOM_KNOWN(1)
  ) u_done (
      .clk    (clk),
      .rst    (rst),
      .s_valid(ends_q7),
      .s_ready(done_ready),
      .s_data ({constants_q7[95:64], answer_q7}),
      .m_valid(m_done_valid),
      .m_ready(m_done_ready),
      .m_data ({m_done_tag, m_done_code, m_done_answer, m_done_steps, m_done_pairs})
  );
  assign answer_down = m_done_valid & m_done_ready;

  wire fetch_valid, fetch_ready;
  wire [3:0] fetch_kinds;
  wire [63:0] fetch_lines;
  cchip_leaf_queue #(
      .QUERIES(QUERIES),
      .DEPTH  (LEAF_DEPTH),
      .CREDIT (CREDIT)
  ) u_leaves (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (leaf_q7),
      .s_context    (context_q7),
      .s_epoch      (epoch_q7),
      .s_a          (leaf_nodes_q7[39:0]),
      .s_b          (leaf_nodes_q7[79:40]),
      .s_leaves     (leaf_set_q7),
      .m_room       (leaf_room),
      .epoch_write  (write),
      .epoch_context(write_context),
      .epoch        (write_state[STATE_W-1-:EPOCH_W]),
      .s_credit     (s_credit),
      .m_valid      (fetch_valid),
      .m_ready      (fetch_ready),
      .m_drop_valid (drop_valid),
      .m_drop_ready (drop_take),
      .m_context    (drop_context),
      .m_epoch      (drop_epoch),
      .m_kinds      (fetch_kinds),
      .m_lines      (fetch_lines)
  );

  // ---- to cchip_get_data: node pairs, else pairs of leaves
  reg [LEAVES-1:0] leaf_free_q;
  reg leaf_place_valid_q;
  reg [PLACE_W-1:0] leaf_place_q;
  wire fetch = fetch_valid & fetch_ready;
  assign fetch_ready = leaf_place_valid_q & ~goes_q7;
  localparam [31:0] FIRST_LEAF = PAIRS;
  wire [LEAVES-1:0] leaf_one = leaf_free_q & (~leaf_free_q + {{LEAVES - 1{1'b0}}, 1'b1});
  wire [PLACE_W-1:0] leaf_place;
  wire [PLACE_W-1:0] left_leaf = s_leaf_place - FIRST_LEAF[PLACE_W-1:0];
  generate
    for (b = 0; b < PLACE_W; b = b + 1) begin : gen_leaf_place
      wire [LEAVES-1:0] with_bit;
      for (n = 0; n < LEAVES; n = n + 1) begin : gen_with
        localparam [31:0] N = PAIRS + n;
        assign with_bit[n] = N[b];
      end
      assign leaf_place[b] = |(leaf_one & with_bit);
    end
  endgenerate
  wire leaf_load = ~leaf_place_valid_q | fetch;
  reg out_q, out_step_q, out_fetch_q;
  reg [PLACE_W-1:0] out_place_q;
  reg [CONTEXT_W-1:0] out_context_q;
  reg [RECORD_W-1:0] out_record_q;
  reg [63:0] out_lines_q;
  reg [4:0] out_tests_q;
  always @(posedge clk) begin
    if (leaf_load) leaf_place_q <= leaf_place;
    out_place_q   <= goes_q7 ? place_q7 : leaf_place_q;
    out_context_q <= goes_q7 ? context_q7 : drop_context;
    out_record_q  <= goes_q7 ? record_q7 :
        {1'b0, drop_epoch, 26'd0, fetch_kinds[3:2], 26'd0, fetch_kinds[1:0]};
    out_lines_q   <= goes_q7 ? {
      constants_q7[63:32] + {8'd0, record_q7[51:28]}, constants_q7[31:0] + {8'd0, record_q7[23:0]}
    } : fetch_lines;
    out_tests_q   <= step_q7 ? tests_q7 : 5'd0;
    if (rst) begin
      leaf_free_q        <= {LEAVES{1'b1}};
      leaf_place_valid_q <= 1'b0;
      out_q              <= 1'b0;
      out_step_q         <= 1'b0;
      out_fetch_q        <= 1'b0;
    end else begin
      leaf_free_q <= (leaf_free_q & ~(leaf_one & {LEAVES{leaf_load}})) |
          ({{LEAVES - 1{1'b0}}, s_leaf_valid} << left_leaf);
      if (leaf_load) leaf_place_valid_q <= |leaf_free_q;
      out_q       <= goes_q7 | fetch;
      out_step_q  <= step_q7;
      out_fetch_q <= fetch;
    end
  end
  assign m_valid         = out_q;
  assign m_place         = out_place_q;
  assign m_context       = out_context_q;
  assign m_record        = out_record_q;
  assign m_lines         = out_lines_q;
  assign count_step      = out_step_q;
  assign count_tests     = out_tests_q;
  assign count_leaf_pair = out_fetch_q;
  wire unused = &{1'b0, answers, answer_some, entries2[STACK_W], record_q5[57:52],
                  record_q5[27:24]};

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_verdict, !s_verdict_valid || queue_ready)
      `CCHIP_ASSERT(a_done, !ends_q7 || done_ready)
      `CCHIP_ASSERT(a_room, room_q <= DEPTH[ROOM_W-1:0])
      `CCHIP_ASSERT(a_locked, !event_in || !lock_q[context0])
      `CCHIP_ASSERT(a_pop, !(valid_q5 && pop5) || (live_q5 && entries5 != {STACK_W + 1{1'b0}}))
      `CCHIP_ASSERT(a_work, !(valid_q5 && (verdict5 || result5)) || work_q5 != {WORK_W{1'b0}})
    end

endmodule
`default_nettype wire
