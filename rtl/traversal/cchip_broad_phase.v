// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
`include "cchip_defs.vh"
// cchip_broad_phase: from queries to leaf pairs: cache, box test and traversal. Memory is read
// as a client of cchip_axi_read.
//   query        a line as docs/hardware/image.md describes it; its answer comes when every pair
//                of leaves that the query still waited for has its result
//   leaves       leaf pairs of which nothing is known but that their volumes overlap, with
//                their lines in eight beats of 64 bits of each, the lowest first, on the clock of
//                m_leaf_valid and the seven after it. The receiver tests the primitives and answers
//                each with one result; fewer than 1,900 are without one at any time
//   errors       end one query with a code, and leave the others alone
//   bound        every wait has one: a read by the limit of cchip_axi_read, a query by step_limit;
//                results and the receiver of answers are waited for
//   reset        drops queries and lines; takes 2^SET_W clocks of the cache. It acts a clock
//                later: hold rst for 2 clocks or more
module cchip_broad_phase #(
    parameter integer QUERIES = 16,     // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,       // node pairs in flight; legal: with LEAVES 8, 16, 32 or 64
    // leaf pairs that are fetched at once; legal: >= 1; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    parameter integer STACK = 64,       // stack of a query (entry); legal: 8, 16, 32, 64
    parameter integer LEAF_DEPTH = 72,  // queue of leaves (entry); legal: PAIRS + 1 .. 128
    parameter integer CACHE_KB = 128,   // size of the cache (KiB); legal: 1, 2, 4 ... 1024
    parameter integer MISSES = 32,      // lines in flight from memory; legal: 2, 4, 8, 16, 32
    parameter integer LOCKS = 2,        // ranges of lines to lock; legal: 1..4
    // width of the data bus of memory (bit); legal: 64, 128, 256, 512
    parameter integer DATA_W = 128
) (
    // ---- clock and reset
    input  wire                            clk,                // clock, rising edge
    input  wire                            rst,                // synchronous reset, active high
    // ---- limits; they may change on any clock, and count for the queries in flight too.
    //      node pairs of a query in flight, 0..7; 0 counts as 1; half of it with leaf pairs out
    // node pairs of a query that may be in flight, 0..7; 0 counts as 1; with 3 queries or fewer,
    // 2 pairs_each + 1, 7 at most; half of it for a query for the first hit with leaf pairs out
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
    // ---- queries that have started
    output wire                            m_start_valid,      // a query has started
    output wire [     $clog2(QUERIES)-1:0] m_start_context,    // its context
    output wire [                     1:0] m_start_epoch,      // its epoch
    output wire [                   511:0] m_start_query,      // its line
    // ---- leaf pairs: leaf pairs; one of them at most until s_credit says that it has left
    output wire                            m_leaf_valid,       // a leaf pair, for one clock
    output wire [     $clog2(QUERIES)-1:0] m_leaf_context,     // context of its query
    output wire [                     1:0] m_leaf_epoch,       // epoch of its query
    // kinds of the leaves, {B's, A's}: 1 triangle, 2 two triangles, 3 quad
    output wire [                     3:0] m_leaf_kinds,
    output wire                            m_leaf_failed,      // a line could not be read
    // a beat of the leaves (image.md, docs/hardware/image.md), 64 bits of each, {B's, A's}, the
    // lowest first: with m_leaf_valid and on the seven clocks after it
    output wire [                   127:0] m_leaf_lines,
    // the receiver has taken a leaf pair: room for one more of two
    input  wire                            s_credit,
    // ---- results of leaf pairs: outcome of each
    input  wire                            s_result_valid,     // outcome of a leaf pair
    output wire                            s_result_ready,     // it is taken
    input  wire [     $clog2(QUERIES)-1:0] s_result_context,   // context of its query
    input  wire [                     1:0] s_result_epoch,     // epoch of its query
    input  wire [                     2:0] s_result_hits,      // definite hits, 0..4
    input  wire [                     2:0] s_result_open,      // hits that are not definite, 0..4
    // 0, or the code with which the query is to end
    input  wire [                     2:0] s_result_code,
    // ---- judgements of results: of each result, in their order: was its query still in flight?
    // judgement of a result, in the order of s_result
    output wire                            m_judged_valid,
    output wire                            m_judged_live,      // its query was still in flight
    output wire [                    31:0] m_judged_tag,       // tag of that query
    // ---- answers: queries that have ended
    output wire                            m_done_valid,       // a query has ended
    input  wire                            m_done_ready,       // its answer is taken
    output wire [                    31:0] m_done_tag,         // tag of the query
    // how it ended: 0 ok, 1 for the host, 2 step limit, 3 full stack, 4 corrupt line, 5 line
    // outside, 6 bad descriptor, 7 memory
    output wire [                     2:0] m_done_code,
    output wire [                     1:0] m_done_answer,      // 0 no, 1 yes, 2 open
    output wire [                    31:0] m_done_steps,       // node pairs expanded
    output wire [                    31:0] m_done_pairs,       // hits
    // ---- locked lines: lines to lock; none if first > last
    input  wire [            LOCKS*32-1:0] lock_first,         // first line of each range to lock
    // last line; a range with first > last is empty
    input  wire [            LOCKS*32-1:0] lock_last,
    // ---- invalidation
    input  wire                            invalidate_valid,   // command: invalidate lines
    output wire                            invalidate_ready,   // no command is in progress
    input  wire [                    31:0] invalidate_first,   // first line to invalidate
    input  wire [                    31:0] invalidate_last,    // last line to invalidate
    // ---- events to count: what happens on this clock, for counters
    output wire                            count_step,         // a node pair was expanded
    output wire [                     4:0] count_tests,        // child pairs compared
    output wire                            count_leaf_pair,    // a leaf pair is fetched
    output wire [                     1:0] count_hit,          // as of cchip_cache
    output wire [                     1:0] count_miss,         // the same
    output wire [                     1:0] count_wait,         // the same
    output wire [                     1:0] count_again,        // the same
    output wire                            count_box_busy,     // the box test has a node pair
    // ---- read requests: client of cchip_axi_read
    output wire                            m_read_valid,       // request to cchip_axi_read
    output wire [      $clog2(MISSES)-1:0] m_read_slot,        // place of the line there
    output wire [                    57:0] m_read_line,        // number of the line
    // ---- read answers
    input  wire                            s_read_valid,       // beat of an answer
    input  wire [      $clog2(MISSES)-1:0] s_read_slot,        // its place
    input  wire [                     2:0] s_read_beat,        // number of the beat in its line
    input  wire                            s_read_last,        // last beat
    // outcome of the read, while s_read_last = 1
    input  wire [  `CCHIP_READ_CODE_W-1:0] s_read_code,
    input  wire [              DATA_W-1:0] s_read_data,        // data
    input  wire [              MISSES-1:0] s_read_outstanding  // outstanding of its slots
);

  localparam integer PLACES = PAIRS + LEAVES;
  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer RECORD_W = `CCHIP_NODE_PAIR_W;

  wire start_ready, get_valid, lookup, posed;
  wire [PLACE_W-1:0] get_place, lookup_place, leaf_place, pair_place, verdict_place;
  wire leaf_left;
  wire [CONTEXT_W-1:0] get_context, lookup_context, posed_context, pair_context;
  wire [RECORD_W-1:0] get_record, lookup_record;
  wire [63:0] get_lines, line;
  wire [`CCHIP_NODES_W-1:0] lookup_nodes;
  wire [1:0] line_valid, came_valid;
  wire [2*PLACE_W-1:0] line_place, came_place;
  wire [2*`CCHIP_READ_CODE_W-1:0] came_code;
  wire [511:0] came_data, lines;
  wire pair_valid, pair_ready, pair_soon, verdict_valid;
  wire [7:0] pair_children;
  wire [15:0] verdict_waiting, verdict_leaves, verdict_strong;
  wire [3:0] verdict_best;
  wire [4:0] verdict_tests;

  // a flip-flop of the reset for each block: one net would have the pins of all
  wire [3:0] block_rst;
  genvar n;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_reset
      cchip_reset_copy u_reset (.clk(clk), .rst(rst), .rst_copy(block_rst[n]));
    end
  endgenerate

  cchip_traversal #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .LEAVES    (LEAVES),
      .STACK     (STACK),
      .LEAF_DEPTH(LEAF_DEPTH),
      .CREDIT    (LEAVES)
  ) u_traversal (
      .clk              (clk),
      .rst              (block_rst[0]),
      .pairs_each       (pairs_each),
      .step_limit       (step_limit),
      .open_limit       (open_limit),
      .s_query_valid    (s_query_valid),
      .s_query_ready    (s_query_ready),
      .s_query          (s_query),
      .m_start_valid    (m_start_valid),
      .m_start_ready    (start_ready),
      .m_start_context  (m_start_context),
      .m_start_epoch    (m_start_epoch),
      .m_start_query    (m_start_query),
      .m_valid          (get_valid),
      .m_place          (get_place),
      .m_context        (get_context),
      .m_record         (get_record),
      .m_lines          (get_lines),
      .s_leaf_valid     (leaf_left),
      .s_leaf_place     (leaf_place),
      .s_verdict_valid  (verdict_valid),
      .s_verdict_place  (verdict_place),
      .s_verdict_waiting(verdict_waiting),
      .s_verdict_leaves (verdict_leaves),
      .s_verdict_strong (verdict_strong),
      .s_verdict_best   (verdict_best),
      .s_verdict_tests  (verdict_tests),
      .lookup           (lookup),
      .lookup_place     (lookup_place),
      .lookup_context   (lookup_context),
      .lookup_record    (lookup_record),
      .lookup_nodes     (lookup_nodes),
      .s_result_valid   (s_result_valid),
      .s_result_ready   (s_result_ready),
      .s_result_context (s_result_context),
      .s_result_epoch   (s_result_epoch),
      .s_result_hits    (s_result_hits),
      .s_result_open    (s_result_open),
      .s_result_code    (s_result_code),
      .s_credit         (s_credit),
      .m_judged_valid   (m_judged_valid),
      .m_judged_live    (m_judged_live),
      .m_judged_tag     (m_judged_tag),
      .m_done_valid     (m_done_valid),
      .m_done_ready     (m_done_ready),
      .m_done_tag       (m_done_tag),
      .m_done_code      (m_done_code),
      .m_done_answer    (m_done_answer),
      .m_done_steps     (m_done_steps),
      .m_done_pairs     (m_done_pairs),
      .count_step       (count_step),
      .count_tests      (count_tests),
      .count_leaf_pair  (count_leaf_pair)
  );

  cchip_get_data #(.QUERIES(QUERIES), .PAIRS(PAIRS), .LEAVES(LEAVES)) u_get_data (
      .clk            (clk),
      .rst            (block_rst[1]),
      .s_valid        (get_valid),
      .s_place        (get_place),
      .s_context      (get_context),
      .s_record       (get_record),
      .s_lines        (get_lines),
      .s_pose_valid   (posed),
      .s_pose_context (posed_context),
      .m_line_valid   (line_valid),
      .m_line_place   (line_place),
      .m_line         (line),
      .s_line_valid   (came_valid),
      .s_line_place   (came_place),
      .s_line_code    (came_code),
      .s_line_data    (came_data),
      .m_pair_valid   (pair_valid),
      .m_pair_soon    (pair_soon),
      .m_pair_place   (pair_place),
      .m_pair_context (pair_context),
      .m_pair_children(pair_children),
      .s_leaf_taken   (s_credit),
      .m_leaf_valid   (m_leaf_valid),
      .m_leaf_place   (leaf_place),
      .m_leaf_context (m_leaf_context),
      .m_leaf_epoch   (m_leaf_epoch),
      .m_leaf_kinds   (m_leaf_kinds),
      .m_leaf_failed  (m_leaf_failed),
      .m_leaf_lines   (m_leaf_lines),
      .m_leaf_left    (leaf_left),
      .m_lines        (lines),
      .lookup         (lookup),
      .lookup_place   (lookup_place),
      .lookup_context (lookup_context),
      .lookup_record  (lookup_record),
      .lookup_nodes   (lookup_nodes)
  );

  assign count_box_busy = pair_valid;
  wire unused = &{1'b0, pair_ready};

  // The box test's set-up of poses is far from the traversal. A clock for the way: the next query
  // starts when this one has left the traversal's pipeline, and start_ready is 0 by then.
  reg pose_valid_q;
  reg [$clog2(QUERIES)-1:0] pose_context_q;
  reg [287:0] pose_m_q;
  reg [107:0] pose_t_q;
  reg [3:0] pose_shift_q;
  reg [11:0] pose_error_q;
  always @(posedge clk) begin
    pose_valid_q   <= m_start_valid & ~block_rst[2];
    pose_context_q <= m_start_context;
    pose_m_q       <= m_start_query[`CCHIP_QUERY_M];
    pose_t_q       <= m_start_query[`CCHIP_QUERY_T];
    pose_shift_q   <= m_start_query[`CCHIP_QUERY_SHIFT];
    pose_error_q   <= m_start_query[`CCHIP_QUERY_ERROR];
  end
  always @(posedge clk)
    if (!rst && !block_rst[2]) begin
      `CCHIP_ASSERT(a_pose_room, !pose_valid_q || start_ready)
    end

  cchip_bv_unit #(.QUERIES(QUERIES), .TAG_W(PLACE_W)) u_bv_unit (
      .clk           (clk),
      .rst           (block_rst[2]),
      .s_pose_valid  (pose_valid_q),
      .s_pose_ready  (start_ready),
      .s_pose_context(pose_context_q),
      .s_pose_m      (pose_m_q),
      .s_pose_t      (pose_t_q),
      .s_pose_shift  (pose_shift_q),
      .s_pose_error  (pose_error_q),
      .m_pose_valid  (posed),
      .m_pose_context(posed_context),
      .s_valid       (pair_valid),
      .s_ready       (pair_ready),
      .s_soon        (pair_soon),
      .s_tag         (pair_place),
      .s_context     (pair_context),
      .s_a           (lines[255:0]),
      .s_b           (lines[511:256]),
      .s_a_children  (pair_children[3:0]),
      .s_b_children  (pair_children[7:4]),
      .m_valid       (verdict_valid),
      .m_tag         (verdict_place),
      .m_waiting     (verdict_waiting),
      .m_leaves      (verdict_leaves),
      .m_strong      (verdict_strong),
      .m_best        (verdict_best),
      .m_tests       (verdict_tests)
  );

  cchip_cache #(
      .CACHE_KB(CACHE_KB),
      .PLACES  (PLACES),
      .MISSES  (MISSES),
      .LINE_W  (32),
      .LOCKS   (LOCKS),
      .DATA_W  (DATA_W)
  ) u_cache (
      .clk             (clk),
      .rst             (block_rst[3]),
      .s_valid         (line_valid),
      .s_place         (line_place),
      .s_line          (line),
      .m_valid         (came_valid),
      .m_place         (came_place),
      .m_code          (came_code),
      .m_data          (came_data),
      .lock_first      (lock_first),
      .lock_last       (lock_last),
      .invalidate_valid(invalidate_valid),
      .invalidate_ready(invalidate_ready),
      .invalidate_first(invalidate_first),
      .invalidate_last (invalidate_last),
      .m_read_valid    (m_read_valid),
      .m_read_slot     (m_read_slot),
      .m_read_line     (m_read_line),
      .s_read_valid    (s_read_valid),
      .s_read_slot     (s_read_slot),
      .s_read_beat     (s_read_beat),
      .s_read_last     (s_read_last),
      .s_read_code     (s_read_code),
      .s_read_data     (s_read_data),
      .s_read_outstanding(s_read_outstanding),
      .count_hit       (count_hit),
      .count_miss      (count_miss),
      .count_wait      (count_wait),
      .count_again     (count_again)
  );

endmodule
`default_nettype wire
