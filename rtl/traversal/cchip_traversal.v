// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_traversal: walks the trees of two objects. Of a node pair whose boxes the box test has
// compared, the child pair that overlaps most continues at once; the others wait on the query's
// stack; leaf pairs go to cchip_leaf_queue.
//   rule         every event of a query (start, a verdict, a result of a leaf pair, a pair
//                taken from the stack) passes one pipeline, the events of one query one at a time
//   epochs       a query that ends leaves node pairs and leaf pairs behind. They carry the
//                epoch of their query, are counted, and are dropped as they come back; an epoch
//                is used again when its count is 0
//   room         a verdict always has room: a node pair is in flight only with a place in the leaf
//                queue; a query starts only with a place for its answer
//   few          with 3 queries or fewer between start and taken answer, each may have
//                2 pairs_each + 1 node pairs in flight, 7 at most
//   rules        fewer than 1,900 leaf pairs are without a result behind cchip_get_data
//   latency      14 or 15 clocks from s_verdict_valid to m_valid
//   throughput   an event every second clock, of one query one in 8 clocks
//   reset        drops all queries; takes 4 QUERIES clocks, events wait
module cchip_traversal #(
    parameter integer QUERIES = 16,     // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,       // node pairs in flight; legal: with LEAVES 8, 16, 32 or 64
    // leaf pairs that are fetched at once; legal: >= 1; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    parameter integer STACK = 64,       // stack of a query (entry); legal: 8, 16, 32, 64
    parameter integer LEAF_DEPTH = 72,  // queue of leaves (entry); legal: PAIRS + 1 .. 128
    parameter integer CREDIT = 32  // leaf pairs that the receiver has room for; legal: 1..65535
) (
    input  wire                            clk,                // clock, rising edge
    input  wire                            rst,                // synchronous reset, active high
    // ---- limits; they may change on any clock, and apply to queries in flight, too
    // node pairs of a query that may be in flight, 0..7; 0 counts as 1; with 3 queries or fewer
    // twice as many and one more, 7 at most; half of it for a query for the first hit with leaf
    // pairs out
    input  wire [                     2:0] pairs_each,
    // ---- node pairs of a query, 0..2^32 - 1; 0: it ends with code STEPS at its first one
    // node pairs after which a query ends with code steps, 0..2^32 - 1
    input  wire [                    31:0] step_limit,
    // open pairs after which a query for the first hit ends with code host, 0..255; 0 counts as 1
    input  wire [                     7:0] open_limit,
    // ---- queries (docs/hardware/image.md)
    input  wire                            s_query_valid,      // a query
    output wire                            s_query_ready,      // it is taken
    // its line (image.md, docs/hardware/image.md, "Query")
    input  wire [                   511:0] s_query,
    // ---- one that has started, for the box test and the transform, which need its pose. Not a
    //      stream: m_start_ready = 1 says that the receivers have room for one more, m_start_valid
    //      is a pulse some clocks later, even if m_start_ready is 0 then. The next one comes later
    //      still
    output wire                            m_start_valid,      // a query has started, one clock
    input  wire                            m_start_ready,  // room for one more query, see Timing
    output wire [     $clog2(QUERIES)-1:0] m_start_context,    // its context
    output wire [                     1:0] m_start_epoch,      // its epoch
    output wire [                   511:0] m_start_query,      // its line
    // ---- lines for a place of cchip_get_data; always taken
    output wire                            m_valid,            // the lines of a pair are wanted
    output wire [$clog2(PAIRS+LEAVES)-1:0] m_place,            // place for them
    output wire [     $clog2(QUERIES)-1:0] m_context,          // context of the query
    // what is to come back with the verdict: {header, epoch, children of B, line of B, children of
    // A, line of A}; of leaves {0, epoch, 0, kind of B, 0, kind of A}
    output wire [                    58:0] m_record,
    output wire [                    63:0] m_lines,            // numbers of the lines, {B's, A's}
    // ---- a leaf pair has left there
    input  wire                            s_leaf_valid,  // a leaf pair has left cchip_get_data
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_leaf_place,       // its place, free again
    // ---- verdicts of cchip_bv_unit, and what cchip_get_data knows of the node pair
    input  wire                            s_verdict_valid,    // verdict of the box test
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_verdict_place,    // place of its node pair
    // child pairs that overlap and are not both leaves; child i of A and j of B is bit 4 i + j
    input  wire [                    15:0] s_verdict_waiting,
    input  wire [                    15:0] s_verdict_leaves,   // those that are
    // of the waiting ones those that overlap much
    input  wire [                    15:0] s_verdict_strong,
    // of the waiting ones that which overlaps most
    input  wire [                     3:0] s_verdict_best,
    input  wire [                     4:0] s_verdict_tests,    // child pairs compared
    output wire                            lookup,             // read what is known of this place
    output wire [$clog2(PAIRS+LEAVES)-1:0] lookup_place,       // place of a node pair
    input  wire [     $clog2(QUERIES)-1:0] lookup_context,     // its context
    input  wire [                    58:0] lookup_record,      // its record
    // {code, kinds of B's children, line of the first, kinds of A's, line of the first}; of headers
    // the roots
    input  wire [                    66:0] lookup_nodes,
    // ---- outcome of a leaf pair, and room for another one
    input  wire                            s_result_valid,     // outcome of a leaf pair
    output wire                            s_result_ready,     // it is taken
    input  wire [     $clog2(QUERIES)-1:0] s_result_context,   // context of its query
    input  wire [                     1:0] s_result_epoch,     // epoch of its query
    input  wire [                     2:0] s_result_hits,      // definite hits, 0..4
    input  wire [                     2:0] s_result_open,      // hits that are not definite, 0..4
    // 0, or the code with which the query is to end
    input  wire [                     2:0] s_result_code,
    // the receiver has room for one more leaf pair
    input  wire                            s_credit,
    // ---- of each result, in the order of s_result: was its query still in flight? On the clock on
    //      which the end that it may bring about enters the queue of m_done, which it leaves a
    //      clock later at the earliest
    // judgement of a result, in the order of s_result
    output wire                            m_judged_valid,
    output wire                            m_judged_live,      // its query was still in flight
    output wire [                    31:0] m_judged_tag,       // tag of that query
    // ---- queries that have ended
    output wire                            m_done_valid,       // a query has ended
    input  wire                            m_done_ready,       // its answer is taken
    output wire [                    31:0] m_done_tag,         // tag of the query
    // how it ended: 0 ok, 1 for the host, 2 step limit, 3 full stack, 4 corrupt line, 5 line
    // outside, 6 bad descriptor, 7 memory
    output wire [                     2:0] m_done_code,
    output wire [                     1:0] m_done_answer,      // 0 no, 1 yes, 2 open
    output wire [                    31:0] m_done_steps,       // node pairs expanded
    output wire [                    31:0] m_done_pairs,       // hits
    // ---- what happens on this clock, for counters
    output wire                            count_step,         // a node pair was expanded
    output wire [                     4:0] count_tests,        // child pairs compared
    output wire                            count_leaf_pair     // a leaf pair is fetched
);

  localparam integer PLACE_W = $clog2(PAIRS + LEAVES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer EPOCH_W = 2;
  localparam integer RECORD_W = `CCHIP_NODE_PAIR_W;
  localparam integer NODES_W = `CCHIP_NODES_W;
  localparam integer STACK_W = $clog2(STACK);
  localparam integer STATE_W = `CCHIP_QUERY_STATE_W(STACK_W);
  // pairs of one epoch of a query: entries of the leaf queue and the current one, 16 leaf pairs
  // each; a pair at every place; what is behind cchip_get_data. At most 4,027
  localparam [31:0] WORK_MOST = 16 * LEAF_DEPTH + 16 + PAIRS + LEAVES + 1899;
  localparam integer WORK_W = 12;
  localparam integer ANSWERS = 2 * QUERIES;

  `CCHIP_REFUSE(QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES,
                cchip_error_traversal_QUERIES_must_be_2_4_8_or_16)
  `CCHIP_REFUSE(PAIRS < 1 || LEAVES < 1 || PAIRS + LEAVES < 8 || PAIRS + LEAVES > 64 ||
                (1 << PLACE_W) != PAIRS + LEAVES,
                cchip_error_traversal_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together)
  `CCHIP_REFUSE(LEAF_DEPTH <= PAIRS || LEAF_DEPTH > 128,
                cchip_error_traversal_LEAF_DEPTH_must_be_over_PAIRS_to_128)
  `CCHIP_REFUSE(STACK < 8 || STACK > 64 || (1 << STACK_W) != STACK,
                cchip_error_traversal_STACK_must_be_8_16_32_or_64)

  // ---- stage 1: an event
  wire valid1, valid5;
  wire judge1, judge5;
  wire [3:0] is1, is5;  // {pop, start, result, verdict}
  wire [CONTEXT_W-1:0] context1, context5;
  wire [EPOCH_W-1:0] epoch1;
  wire extra1;
  wire [PLACE_W-1:0] place1, place5;
  wire [`CCHIP_BOX_VERDICT_W-1:0] verdict1;
  wire [8:0] result1, result5;
  wire running, few;
  wire query_bad;
  wire [511:0] query;
  wire drop_valid, drop_ready, leaf_room;
  wire [CONTEXT_W-1:0] drop_context;
  wire [  EPOCH_W-1:0] drop_epoch;
  // what the last stage says
  reg valid_q6, valid_q7, valid_q8;
  reg [CONTEXT_W-1:0] context_q6, context_q7, context_q8;
  reg [PLACE_W-1:0] place_q6, place_q7, place_q8;
  reg [EPOCH_W-1:0] epoch_q6, epoch_q7, epoch_q8;
  wire active8, wants8, start8, cancel8, started6, goes8, back8, push8, leaf8, ends8, step8;
  wire [1:0] room8;
  wire [STATE_W-1:0] state8;
  wire [`CCHIP_QUERY_LINES_W-1:0] constants8;
  wire [WORK_W-1:0] work8;
  wire [RECORD_W-1:0] record8;
  wire [STACK_W-1:0] at8;
  wire [`CCHIP_STACK_ENTRY_W-1:0] entry8;
  wire [79:0] leaf_nodes8;
  wire [15:0] leaf_set8;
  wire [`CCHIP_QUERY_END_W-1:0] answer8;
  wire [4:0] tests8;
  cchip_traversal_events #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .PLACE_W   (PLACE_W),
      .LEAF_DEPTH(LEAF_DEPTH),
      .ANSWERS   (ANSWERS)
  ) u_events (
      .clk(clk),
      .rst(rst),
      .running(running),
      .s_query_valid(s_query_valid),
      .s_query_ready(s_query_ready),
      .s_query(s_query),
      .query(query),
      .query_bad(query_bad),
      .start_ready(m_start_ready),
      .s_verdict_valid(s_verdict_valid),
      .s_verdict({
        s_verdict_place,
        `CCHIP_BOX_VERDICT_OF(s_verdict_waiting, s_verdict_leaves, s_verdict_strong, s_verdict_best,
            s_verdict_tests)
      }),
      .lookup(lookup),
      .lookup_place(lookup_place),
      .lookup_context(lookup_context),
      .lookup_epoch(lookup_record[`CCHIP_NODE_PAIR_EPOCH]),
      .s_result_valid(s_result_valid),
      .s_result_ready(s_result_ready),
      .s_result({s_result_context, s_result_epoch, s_result_code, s_result_open, s_result_hits}),
      .s_drop_valid(drop_valid),
      .s_drop_ready(drop_ready),
      .s_drop_context(drop_context),
      .s_drop_epoch(drop_epoch),
      .m_valid(valid1),
      .m_verdict_event(is1[0]),
      .m_result_event(is1[1]),
      .m_start_event(is1[2]),
      .m_pop_event(is1[3]),
      .m_judge(judge1),
      .m_context(context1),
      .m_epoch(epoch1),
      .m_extra(extra1),
      .m_place(place1),
      .m_verdict(verdict1),
      .m_result(result1),
      .m_few(few),
      .s_leaving_valid(valid_q6),
      .s_leaving_context(context_q6),
      .s_left_valid(valid_q8),
      .s_left_context(context_q8),
      .s_left_active(active8),
      .s_left_wants(wants8),
      .s_left_start(start8),
      .s_left_cancel(cancel8),
      .s_left_back(back8),
      .s_left_place(place_q8),
      .s_left_room(room8),
      .s_leaf_room(leaf_room),
      .s_answer_room(m_done_valid & m_done_ready)
  );

  // ---- stages 2 to 5: it passes on
  wire [RECORD_W-1:0] record5;
  wire [NODES_W-1:0] nodes4;
  cchip_delay #(.WIDTH(1), .DEPTH(4), .RESET(1)) u_valid (
      .clk(clk),
      .rst(rst),
      .d  (valid1),
      .q  (valid5)
  );
  cchip_delay #(.WIDTH(5 + CONTEXT_W + PLACE_W + 9), .DEPTH(4)) u_event (
      .clk(clk),
      .rst(1'b0),
      .d  ({judge1, is1, context1, place1, result1}),
      .q  ({judge5, is5, context5, place5, result5})
  );
  wire [`CCHIP_BOX_VERDICT_W-1:0] verdict5;
  wire extra5, some_wait5, rest5, some_leaves5, room5;
  wire [4:0] leaves5;
  cchip_verdict_view u_verdict (
      .clk          (clk),
      .s_verdict    (verdict1),
      .s_extra      (extra1),
      .m_verdict    (verdict5),
      .m_extra      (extra5),
      .m_some_wait  (some_wait5),
      .m_rest       (rest5),
      .m_some_leaves(some_leaves5),
      .m_leaves     (leaves5),
      .m_room       (room5)
  );
  // a clock later than what is looked up
  cchip_delay #(.WIDTH(RECORD_W), .DEPTH(5)) u_record (
      .clk(clk),
      .rst(1'b0),
      .d  (lookup_record),
      .q  (record5)
  );
  cchip_delay #(.WIDTH(NODES_W), .DEPTH(4)) u_nodes (
      .clk(clk),
      .rst(1'b0),
      .d  (lookup_nodes),
      .q  (nodes4)
  );
  reg [NODES_W-1:0] nodes_q5;
  reg failed_q5;
  always @(posedge clk) begin
    nodes_q5  <= nodes4;
    failed_q5 <= |nodes4[`CCHIP_NODES_CODE];
  end

  // ---- stages 1 to 5: the query, the last entry of its stack, what its epoch has in flight
  wire [EPOCH_W-1:0] epoch5;
  wire live5, over5, full5;
  wire [STATE_W-1:0] state5;
  wire [`CCHIP_QUERY_LINES_W-1:0] constants5;
  wire [WORK_W-1:0] work5;
  wire [`CCHIP_STACK_ENTRY_W-1:0] entry5;
  wire epoch_write;
  wire [CONTEXT_W-1:0] epoch_context;
  wire [EPOCH_W-1:0] epoch;
  cchip_traversal_contexts #(.QUERIES(QUERIES), .STACK(STACK), .WORK_W(WORK_W)) u_contexts (
      .clk          (clk),
      .rst          (rst),
      .running      (running),
      .step_limit   (step_limit),
      .s_context    (context1),
      .s_epoch      (epoch1),
      .s_own        (is1[2] | is1[3]),
      .epoch5       (epoch5),
      .live5        (live5),
      .state5       (state5),
      .constants5   (constants5),
      .work5        (work5),
      .over5        (over5),
      .full5        (full5),
      .entry5       (entry5),
      .write8       (valid_q8),
      .context8     (context_q8),
      .epoch8       (epoch_q8),
      .state8       (state8),
      .constants8   (constants8),
      .work8        (work8),
      .push8        (push8),
      .at8          (at8),
      .entry8       (entry8),
      .epoch_write  (epoch_write),
      .epoch_context(epoch_context),
      .epoch        (epoch)
  );

  // ---- node pairs that a query may have in flight. Few queries leave places, box test and bus
  // idle and wait for memory, so each of them may have more
  reg [2:0] each_q;
  always @(posedge clk)
    each_q <= few ? {pairs_each[1:0], 1'b1} | {3{pairs_each[2]}} : pairs_each;

  // ---- stages 5 to 7: what happens
  cchip_traversal_decision #(.STACK(STACK), .WORK_W(WORK_W)) u_decision (
      .clk            (clk),
      .rst            (rst),
      .pairs_each     (each_q),
      .open_limit     (open_limit),
      .s_valid        (valid5),
      .s_is_verdict   (is5[0]),
      .s_is_result    (is5[1]),
      .s_is_start     (is5[2]),
      .s_is_pop       (is5[3]),
      .s_epoch        (epoch5),
      .s_live         (live5),
      .s_state        (state5),
      .s_constants    (constants5),
      .s_work         (work5),
      .s_over         (over5),
      .s_full         (full5),
      .s_verdict      (verdict5),
      .s_some_wait    (some_wait5),
      .s_rest         (rest5),
      .s_some_leaves  (some_leaves5),
      .s_leaves       (leaves5),
      .s_extra        (extra5),
      .s_room         (room5),
      .s_record       (record5),
      .s_nodes        (nodes_q5),
      .s_failed       (failed_q5),
      .s_result       (result5),
      .s_entry        (entry5),
      .query_bad      (query_bad),
      .query_mode     (query[`CCHIP_QUERY_ALL]),
      .query_constants(`CCHIP_QUERY_LINES_OF(query[`CCHIP_QUERY_BASE_A], query[`CCHIP_QUERY_BASE_B],
          query[`CCHIP_QUERY_TAG])),
      .m_state        (state8),
      .m_constants    (constants8),
      .m_work         (work8),
      .m_active       (active8),
      .m_wants        (wants8),
      .m_start        (start8),
      .m_cancel       (cancel8),
      .m_started      (started6),
      .m_goes         (goes8),
      .m_record       (record8),
      .m_back         (back8),
      .m_room         (room8),
      .m_push         (push8),
      .m_at           (at8),
      .m_entry        (entry8),
      .m_leaf         (leaf8),
      .m_leaf_nodes   (leaf_nodes8),
      .m_leaf_set     (leaf_set8),
      .m_ends         (ends8),
      .m_answer       (answer8),
      .m_step         (step8),
      .m_tests        (tests8)
  );
  reg judge_q6, judge_q7, judge_q8, live_q6, live_q7, live_q8;
  always @(posedge clk) begin
    {context_q6, context_q7, context_q8} <= {context5, context_q6, context_q7};
    {place_q6, place_q7, place_q8} <= {place5, place_q6, place_q7};
    {epoch_q6, epoch_q7, epoch_q8} <= {epoch5, epoch_q6, epoch_q7};
    {live_q6, live_q7, live_q8} <= {live5, live_q6, live_q7};
    if (rst) {valid_q6, valid_q7, valid_q8, judge_q6, judge_q7, judge_q8} <= 6'd0;
    else begin
      {valid_q6, valid_q7, valid_q8} <= {valid5, valid_q6, valid_q7};
      {judge_q6, judge_q7, judge_q8} <= {valid5 & judge5, judge_q6, judge_q7};
    end
  end

  // ---- stage 8: what comes of it
  assign m_judged_valid  = judge_q8;
  assign m_judged_live   = live_q8;
  assign m_judged_tag    = constants8[`CCHIP_QUERY_LINES_TAG];
  assign m_start_valid   = started6;
  assign m_start_context = context_q6;
  assign m_start_epoch   = epoch_q6;
  assign m_start_query   = query;

  wire done_ready;
  cchip_fifo #(.WIDTH(32 + `CCHIP_QUERY_END_W), .DEPTH(ANSWERS), .ROOM_KNOWN(1)) u_done (
      .clk    (clk),
      .rst    (rst),
      .s_valid(ends8),
      .s_ready(done_ready),
      .s_data ({constants8[`CCHIP_QUERY_LINES_TAG], answer8}),
      .m_valid(m_done_valid),
      .m_ready(m_done_ready),
      .m_data ({m_done_tag, m_done_code, m_done_answer, m_done_steps, m_done_pairs})
  );

  // ---- to cchip_get_data: node pairs, else leaf pairs
  cchip_traversal_fetch #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .LEAVES    (LEAVES),
      .LEAF_DEPTH(LEAF_DEPTH),
      .CREDIT    (CREDIT)
  ) u_fetch (
      .clk            (clk),
      .rst            (rst),
      .s_context      (context_q8),
      .s_epoch        (epoch_q8),
      .s_lines        (constants8),
      .s_goes         (goes8),
      .s_place        (place_q8),
      .s_record       (record8),
      .s_leaf         (leaf8),
      .s_leaf_nodes   (leaf_nodes8),
      .s_leaf_set     (leaf_set8),
      .s_step         (step8),
      .s_tests        (tests8),
      .epoch_write    (epoch_write),
      .epoch_context  (epoch_context),
      .epoch          (epoch),
      .s_credit       (s_credit),
      .leaf_room      (leaf_room),
      .m_drop_valid   (drop_valid),
      .m_drop_ready   (drop_ready),
      .m_drop_context (drop_context),
      .m_drop_epoch   (drop_epoch),
      .s_back_valid   (s_leaf_valid),
      .s_back_place   (s_leaf_place),
      .m_valid        (m_valid),
      .m_place        (m_place),
      .m_context      (m_context),
      .m_record       (m_record),
      .m_lines        (m_lines),
      .count_step     (count_step),
      .count_tests    (count_tests),
      .count_leaf_pair(count_leaf_pair)
  );

  wire [STACK_W:0] entries5 = state5[`CCHIP_QUERY_STATE_ENTRIES(STACK_W)];
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_done, !ends8 || done_ready)
      `CCHIP_ASSERT(a_results, !valid_q8 || work8 <= WORK_MOST[WORK_W-1:0])
      `CCHIP_ASSERT(a_pop, !(valid5 && is5[3]) || (live5 && |entries5))
      `CCHIP_ASSERT(a_work, !(valid5 && (is5[0] || is5[1])) || |work5)
    end

endmodule
`default_nettype wire
