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
//   rules        fewer than 1,900 leaf pairs are without a result behind cchip_get_data
//   latency      14 or 15 clocks from s_verdict_valid to m_valid
//   throughput   an event every second clock, of one query one in 8 clocks
//   cuts         every path: each output depends on flip-flops only
//   reset        drops all queries; takes 4 QUERIES clocks, events wait
module cchip_traversal #(
    // queries at once: 2, 4, 8 or 16
    parameter integer QUERIES = 16,
    // node pairs in flight
    parameter integer PAIRS = 48,
    // leaf pairs that are fetched at once; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    // entries of a query's stack: 8, 16, 32 or 64
    parameter integer STACK = 64,
    // entries of the leaf queue, more than PAIRS
    parameter integer LEAF_DEPTH = 72,
    // leaf pairs that the receiver has room for
    parameter integer CREDIT = 32
) (
    input  wire                            clk,
    input  wire                            rst,
    // limits; they may change on any clock, and count for the queries at work too.
    // node pairs of a query in flight, 0..7; 0 counts as 1; half of it with leaf pairs out
    input  wire [                     2:0] pairs_each,
    // node pairs of a query, 0..2^32 - 1; 0: it ends with code STEPS at its first one
    input  wire [                    31:0] step_limit,
    // open pairs of a FIRST query, 0..255; 0 counts as 1
    input  wire [                     7:0] open_limit,
    // queries (docs/hardware/image.md)
    input  wire                            s_query_valid,
    output wire                            s_query_ready,
    input  wire [                   511:0] s_query,
    // one that has started, for the box test and the transform, which need its pose. Not a stream:
    // m_start_ready = 1 says that the receivers have room for one more, m_start_valid is a pulse
    // some clocks later, even if m_start_ready is 0 then. The next one comes later still
    output wire                            m_start_valid,
    input  wire                            m_start_ready,
    output wire [     $clog2(QUERIES)-1:0] m_start_context,
    output wire [                     1:0] m_start_epoch,
    output wire [                   511:0] m_start_query,
    // lines for a place of cchip_get_data; always taken
    output wire                            m_valid,
    output wire [$clog2(PAIRS+LEAVES)-1:0] m_place,
    output wire [     $clog2(QUERIES)-1:0] m_context,
    output wire [                    58:0] m_record,
    output wire [                    63:0] m_lines,
    // a leaf pair has left there
    input  wire                            s_leaf_valid,
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_leaf_place,
    // verdicts of cchip_bv_unit, and what cchip_get_data knows of the node pair
    input  wire                            s_verdict_valid,
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_verdict_place,
    input  wire [                    15:0] s_verdict_waiting,
    input  wire [                    15:0] s_verdict_leaves,
    input  wire [                    15:0] s_verdict_strong,
    input  wire [                     3:0] s_verdict_best,
    input  wire [                     4:0] s_verdict_tests,
    output wire                            lookup,
    output wire [$clog2(PAIRS+LEAVES)-1:0] lookup_place,
    input  wire [     $clog2(QUERIES)-1:0] lookup_context,
    input  wire [                    58:0] lookup_record,
    input  wire [                    66:0] lookup_nodes,
    // outcome of a leaf pair, and room for another one
    input  wire                            s_result_valid,
    output wire                            s_result_ready,
    input  wire [     $clog2(QUERIES)-1:0] s_result_context,
    input  wire [                     1:0] s_result_epoch,
    input  wire [                     2:0] s_result_hits,      // definite hits, 0..4
    input  wire [                     2:0] s_result_open,      // others
    input  wire [                     2:0] s_result_code,
    input  wire                            s_credit,
    // of each result, in the order of s_result: was its query still at work? On the clock on which
    // the end that it may bring about enters the queue of m_done, which it leaves a clock later at
    // the earliest
    output wire                            m_judged_valid,
    output wire                            m_judged_live,
    output wire [                    31:0] m_judged_tag,
    // queries that have ended
    output wire                            m_done_valid,
    input  wire                            m_done_ready,
    output wire [                    31:0] m_done_tag,
    output wire [                     2:0] m_done_code,
    output wire [                     1:0] m_done_answer,      // no, yes, open
    output wire [                    31:0] m_done_steps,
    output wire [                    31:0] m_done_pairs,
    // what happens on this clock, for counters
    output wire                            count_step,
    output wire [                     4:0] count_tests,
    output wire                            count_leaf_pair
);

  localparam integer PLACE_W = $clog2(PAIRS + LEAVES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer EPOCH_W = 2;
  localparam integer RECORD_W = 59;
  localparam integer NODES_W = 67;
  localparam integer STACK_W = $clog2(STACK);
  localparam integer STATE_W = STACK_W + 81;  // cchip_traversal_decision says of what
  // pairs of one epoch of a query: entries of the leaf queue and the one at work, 16 leaf pairs
  // each; a pair at every place; what is behind cchip_get_data. At most 4,027
  localparam [31:0] WORK_MOST = 16 * LEAF_DEPTH + 16 + PAIRS + LEAVES + 1899;
  localparam integer WORK_W = 12;
  localparam integer ANSWERS = 2 * QUERIES;
  localparam [31:0] FULL = STACK;
  localparam [31:0] LAST_EPOCH = QUERIES * 4 - 1;

  generate
    if (QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES) begin : gen_illegal_queries
      cchip_error_traversal_QUERIES_must_be_2_4_8_or_16 u_error ();
    end
    if (PAIRS < 1 || LEAVES < 1 || PAIRS + LEAVES < 8 || PAIRS + LEAVES > 64 ||
        (1 << PLACE_W) != PAIRS + LEAVES) begin : gen_illegal_places
      cchip_error_traversal_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together u_error ();
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

  // ---- stage 1: an event
  wire valid1, valid5;
  wire judge1, judge5;
  wire [3:0] is1, is5;  // {pop, start, result, verdict}
  wire [CONTEXT_W-1:0] context1, context5;
  wire [EPOCH_W-1:0] epoch1;
  wire extra1, extra3;
  wire [PLACE_W-1:0] place1, place5;
  wire [56:0] verdict1, verdict3;
  wire [8:0] result1, result5;
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
  wire [95:0] constants8;
  wire [WORK_W-1:0] work8;
  wire [RECORD_W-1:0] record8;
  wire [STACK_W-1:0] at8;
  wire [140:0] entry8;
  wire [79:0] leaf_nodes8;
  wire [15:0] leaf_set8;
  wire [68:0] answer8;
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
      .running(running_q),
      .s_query_valid(s_query_valid),
      .s_query_ready(s_query_ready),
      .s_query(s_query),
      .query(query),
      .query_bad(query_bad),
      .start_ready(m_start_ready),
      .s_verdict_valid(s_verdict_valid),
      .s_verdict({
        s_verdict_place,
        s_verdict_tests,
        s_verdict_best,
        s_verdict_strong,
        s_verdict_leaves,
        s_verdict_waiting
      }),
      .lookup(lookup),
      .lookup_place(lookup_place),
      .lookup_context(lookup_context),
      .lookup_epoch(lookup_record[57:56]),
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
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(4),
      .RESET(1)
  ) u_valid (
      .clk(clk),
      .rst(rst),
      .d  (valid1),
      .q  (valid5)
  );
  cchip_delay #(
      .WIDTH(5 + CONTEXT_W + PLACE_W + 9),
      .DEPTH(4)
  ) u_event (
      .clk(clk),
      .rst(1'b0),
      .d  ({judge1, is1, context1, place1, result1}),
      .q  ({judge5, is5, context5, place5, result5})
  );
  cchip_delay #(
      .WIDTH(58),
      .DEPTH(2)
  ) u_verdict (
      .clk(clk),
      .rst(1'b0),
      .d  ({extra1, verdict1}),
      .q  ({extra3, verdict3})
  );
  // a clock later than what is looked up
  cchip_delay #(
      .WIDTH(RECORD_W),
      .DEPTH(5)
  ) u_record (
      .clk(clk),
      .rst(1'b0),
      .d  (lookup_record),
      .q  (record5)
  );
  cchip_delay #(
      .WIDTH(NODES_W),
      .DEPTH(4)
  ) u_nodes (
      .clk(clk),
      .rst(1'b0),
      .d  (lookup_nodes),
      .q  (nodes4)
  );
  // ---- stages 1 to 5: the query, the last entry of its stack, what its epoch has in flight
  (* ram_style = "distributed" *)
  reg [STATE_W-1:0] states[0:QUERIES-1];
  (* ram_style = "distributed" *)
  reg [95:0] constants[0:QUERIES-1];  // {tag, line of B, line of A}
  (* ram_style = "distributed" *)
  reg [WORK_W-1:0] works[0:4*QUERIES-1];  // node pairs and leaf pairs of each epoch
  reg [STATE_W-1:0] state_q2, state_q3, state_q4, state_q5;
  reg [95:0] constants_q2, constants_q3, constants_q4, constants_q5;
  reg [CONTEXT_W-1:0] context_q2, context_q3;
  reg [EPOCH_W-1:0] epoch_q2, epoch_q3, epoch_q4, epoch_q5;
  reg own_q2;  // the event is of the query as it is
  reg live_q3, live_q4, live_q5;
  reg [STACK_W-1:0] top_q3;
  reg [WORK_W-1:0] work_q4, work_q5;
  wire [EPOCH_W-1:0] now2;
  wire active2;
  wire [STACK_W:0] entries2, entries3;
  wire [31:0] steps3;
  wire unused_mode2, unused_hit3;
  wire [2:0] unused_under2, unused_under3;
  wire [72:0] unused_state2;
  wire [EPOCH_W+1:0] unused_state3;
  wire [39:0] unused_counts3;
  assign {now2, active2, unused_mode2, entries2, unused_under2, unused_state2} = state_q2;
  assign {unused_state3, entries3, unused_under3, steps3, unused_counts3, unused_hit3} = state_q3;
  wire [140:0] entry5;
  cchip_block_ram #(
      .WIDTH (141),
      .ADDR_W(CONTEXT_W + STACK_W)
  ) u_stack (
      .clk       (clk),
      .write     (push8),
      .write_addr({context_q8, at8}),
      .write_data(entry8),
      .read_addr ({context_q3, top_q3}),
      .read_data (entry5)
  );
  reg over_q4, over_q5, full_q4, full_q5, failed_q5, some_leaves_q5, some_wait_q5, room_q5;
  reg extra_q4, extra_q5, rest_q5;
  reg [56:0] verdict_q4, verdict_q5;
  reg [NODES_W-1:0] nodes_q5;
  wire [15:0] waiting4 = verdict_q4[15:0];
  wire [15:0] leaves4 = verdict_q4[31:16];
  wire [3:0] best4 = verdict_q4[51:48];
  // leaf pairs are counted in two steps: of each child of A, then of all
  reg [11:0] row_q4;
  reg [4:0] leaves_q5;
  function [2:0] ones(input [3:0] of);
    ones = {2'd0, of[0]} + {2'd0, of[1]} + {2'd0, of[2]} + {2'd0, of[3]};
  endfunction
  always @(posedge clk) begin
    state_q2 <= states[context1];
    constants_q2 <= constants[context1];
    own_q2 <= is1[2] | is1[3];
    epoch_q2 <= epoch1;
    context_q2 <= context1;
    context_q3 <= context_q2;
    top_q3 <= entries2[STACK_W-1:0] - {{STACK_W - 1{1'b0}}, 1'b1};
    epoch_q3 <= own_q2 ? now2 : epoch_q2;
    live_q3 <= active2 && (own_q2 || now2 == epoch_q2);
    work_q4 <= works[{context_q3, epoch_q3}];
    over_q4 <= steps3 >= step_limit;
    full_q4 <= entries3 == FULL[STACK_W:0];
    {extra_q4, verdict_q4} <= {extra3, verdict3};
    {extra_q5, verdict_q5, nodes_q5} <= {extra_q4, verdict_q4, nodes4};
    failed_q5 <= |nodes4[NODES_W-1-:3];
    some_leaves_q5 <= |leaves4;
    some_wait_q5 <= |waiting4;
    rest_q5 <= |(waiting4 & ~(16'd1 << best4));
    room_q5 <= ~|leaves4 | extra_q4;
    row_q4 <= {ones(verdict3[31:28]), ones(verdict3[27:24]), ones(verdict3[23:20]),
               ones(verdict3[19:16])};
    leaves_q5 <= ({2'd0, row_q4[11:9]} + {2'd0, row_q4[8:6]}) +
        ({2'd0, row_q4[5:3]} + {2'd0, row_q4[2:0]});
    {over_q5, full_q5, live_q4, live_q5, work_q5} <= {over_q4, full_q4, live_q3, live_q4, work_q4};
    {epoch_q4, epoch_q5} <= {epoch_q3, epoch_q4};
    {state_q3, state_q4, state_q5} <= {state_q2, state_q3, state_q4};
    {constants_q3, constants_q4, constants_q5} <= {constants_q2, constants_q3, constants_q4};
  end

  // ---- stages 5 to 7: what happens
  cchip_traversal_decision #(
      .STACK (STACK),
      .WORK_W(WORK_W)
  ) u_decision (
      .clk            (clk),
      .rst            (rst),
      .pairs_each     (pairs_each),
      .open_limit     (open_limit),
      .s_valid        (valid5),
      .s_is_verdict   (is5[0]),
      .s_is_result    (is5[1]),
      .s_is_start     (is5[2]),
      .s_is_pop       (is5[3]),
      .s_epoch        (epoch_q5),
      .s_live         (live_q5),
      .s_state        (state_q5),
      .s_constants    (constants_q5),
      .s_work         (work_q5),
      .s_over         (over_q5),
      .s_full         (full_q5),
      .s_verdict      (verdict_q5),
      .s_some_wait    (some_wait_q5),
      .s_rest         (rest_q5),
      .s_some_leaves  (some_leaves_q5),
      .s_leaves       (leaves_q5),
      .s_extra        (extra_q5),
      .s_room         (room_q5),
      .s_record       (record5),
      .s_nodes        (nodes_q5),
      .s_failed       (failed_q5),
      .s_result       (result5),
      .s_entry        (entry5),
      .query_bad      (query_bad),
      .query_mode     (query[476]),
      .query_constants({query[511:480], query[63:0]}),
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
    {epoch_q6, epoch_q7, epoch_q8} <= {epoch_q5, epoch_q6, epoch_q7};
    {live_q6, live_q7, live_q8} <= {live_q5, live_q6, live_q7};
    if (rst) {valid_q6, valid_q7, valid_q8, judge_q6, judge_q7, judge_q8} <= 6'd0;
    else begin
      {valid_q6, valid_q7, valid_q8} <= {valid5, valid_q6, valid_q7};
      {judge_q6, judge_q7, judge_q8} <= {valid5 & judge5, judge_q6, judge_q7};
    end
  end

  // ---- stage 8: everything is written
  wire [CONTEXT_W-1:0] write_context = running_q ? context_q8 : clear_q[CONTEXT_W-1:0];
  wire write = valid_q8 | ~running_q;
  wire [STATE_W-1:0] write_state = running_q ? state8 : {STATE_W{1'b0}};
  always @(posedge clk) begin
    if (write) states[write_context] <= write_state;
    if (valid_q8) constants[context_q8] <= constants8;
    if (write)
      works[running_q?{context_q8, epoch_q8} : clear_q] <= running_q ? work8 : {WORK_W{1'b0}};
  end
  assign m_judged_valid  = judge_q8;
  assign m_judged_live   = live_q8;
  assign m_judged_tag    = constants8[95:64];
  assign m_start_valid   = started6;
  assign m_start_context = context_q6;
  assign m_start_epoch   = epoch_q6;
  assign m_start_query   = query;

  wire done_ready;
  cchip_fifo #(
      .WIDTH     (101),
      .DEPTH     (ANSWERS),
      .ROOM_KNOWN(1)
  ) u_done (
      .clk    (clk),
      .rst    (rst),
      .s_valid(ends8),
      .s_ready(done_ready),
      .s_data ({constants8[95:64], answer8}),
      .m_valid(m_done_valid),
      .m_ready(m_done_ready),
      .m_data ({m_done_tag, m_done_code, m_done_answer, m_done_steps, m_done_pairs})
  );

  wire fetch_valid, leaf_place_valid;
  wire [PLACE_W-1:0] leaf_place;
  wire [3:0] fetch_kinds;
  wire [63:0] fetch_lines;
  wire fetch_ready = leaf_place_valid & ~goes8;
  wire fetch = fetch_valid & fetch_ready;
  cchip_leaf_queue #(
      .QUERIES(QUERIES),
      .DEPTH  (LEAF_DEPTH),
      .CREDIT (CREDIT)
  ) u_leaves (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (leaf8),
      .s_context    (context_q8),
      .s_epoch      (epoch_q8),
      .s_a          (leaf_nodes8[39:0]),
      .s_b          (leaf_nodes8[79:40]),
      .s_leaves     (leaf_set8),
      .m_room       (leaf_room),
      .epoch_write  (write),
      .epoch_context(write_context),
      .epoch        (write_state[STATE_W-1-:EPOCH_W]),
      .s_credit     (s_credit),
      .m_valid      (fetch_valid),
      .m_ready      (fetch_ready),
      .m_drop_valid (drop_valid),
      .m_drop_ready (drop_ready),
      .m_context    (drop_context),
      .m_epoch      (drop_epoch),
      .m_kinds      (fetch_kinds),
      .m_lines      (fetch_lines)
  );
  cchip_pool #(
      .FIRST(PAIRS),
      .COUNT(LEAVES),
      .WIDTH(PLACE_W)
  ) u_leaf_places (
      .clk        (clk),
      .rst        (rst),
      .m_valid    (leaf_place_valid),
      .m_ready    (fetch),
      .m_number   (leaf_place),
      .back_valid (s_leaf_valid),
      .back_number(s_leaf_place)
  );

  // ---- to cchip_get_data: node pairs, else leaf pairs
  reg out_q, out_step_q, out_fetch_q;
  reg [PLACE_W-1:0] out_place_q;
  reg [CONTEXT_W-1:0] out_context_q;
  reg [RECORD_W-1:0] out_record_q;
  reg [63:0] out_lines_q;
  reg [4:0] out_tests_q;
  always @(posedge clk) begin
    out_place_q <= goes8 ? place_q8 : leaf_place;
    out_context_q <= goes8 ? context_q8 : drop_context;
    out_record_q  <= goes8 ? record8 :
        {1'b0, drop_epoch, 26'd0, fetch_kinds[3:2], 26'd0, fetch_kinds[1:0]};
    out_lines_q   <= goes8 ? {
      constants8[63:32] + {8'd0, record8[51:28]}, constants8[31:0] + {8'd0, record8[23:0]}
    } : fetch_lines;
    out_tests_q <= tests8;
    out_q <= ~rst & (goes8 | fetch);
    out_step_q <= ~rst & step8;
    out_fetch_q <= ~rst & fetch;
  end
  assign m_valid         = out_q;
  assign m_place         = out_place_q;
  assign m_context       = out_context_q;
  assign m_record        = out_record_q;
  assign m_lines         = out_lines_q;
  assign count_step      = out_step_q;
  assign count_tests     = out_tests_q;
  assign count_leaf_pair = out_fetch_q;
  wire unused = &{1'b0, unused_mode2, unused_under2, unused_state2, unused_state3, unused_under3,
                  unused_counts3, unused_hit3, entries2[STACK_W]};

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_done, !ends8 || done_ready)
      `CCHIP_ASSERT(a_results, !valid_q8 || work8 <= WORK_MOST[WORK_W-1:0])
      `CCHIP_ASSERT(a_pop, !(valid5 && is5[3]) || (live_q5 && |state_q5[76+:STACK_W+1]))
      `CCHIP_ASSERT(a_work, !(valid5 && (is5[0] || is5[1])) || |work_q5)
    end

endmodule
`default_nettype wire
