// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_broad_phase_axi: cchip_broad_phase with a cchip_axi_read of its own, for an AXI4 memory.
// Ports and rules are those of the two.
//   cuts         every path: each output is a flip-flop
//   reset        must reset the bus, too
//   parameters   Its parts stop elaboration at other values.
//   timing       A read that lasts longer than memory_limit clocks ends its query with code 7.
//   numbers      None of its own.
//   why          A design with other readers of memory uses cchip_broad_phase and makes it a client
//                beside them.
module cchip_broad_phase_axi #(
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
    input  wire                            clk,               // clock, rising edge
    input  wire                            rst,               // synchronous reset, active high
    // ---- limits; they may change on any clock, and count for the queries at work too. node pairs
    //      of a query in flight, 0..7; 0 counts as 1; half of it with leaf pairs out
    // node pairs of a query that may be in flight, 0..7; 0 counts as 1; half of it for a query for
    // the first hit with leaf pairs out
    input  wire [                     2:0] pairs_each,
    // ---- node pairs of a query, 0..2^32 - 1; 0: it ends with code STEPS at its first one
    // node pairs after which a query ends with code steps, 0..2^32 - 1
    input  wire [                    31:0] step_limit,
    // open pairs after which a query for the first hit ends with code host, 0..255; 0 counts as 1
    input  wire [                     7:0] open_limit,
    // ---- queries (docs/hardware/image.md)
    input  wire                            s_query_valid,     // a query
    output wire                            s_query_ready,     // it is taken
    // its line (image.md, docs/hardware/image.md, "Query")
    input  wire [                   511:0] s_query,
    output wire                            m_start_valid,     // a query has started
    output wire [     $clog2(QUERIES)-1:0] m_start_context,   // its context
    output wire [                     1:0] m_start_epoch,     // its epoch
    output wire [                   511:0] m_start_query,     // its line
    // ---- leaf pairs; one of them at most until s_credit says that it has left
    output wire                            m_leaf_valid,      // a leaf pair, for one clock
    output wire [     $clog2(QUERIES)-1:0] m_leaf_context,    // context of its query
    output wire [                     1:0] m_leaf_epoch,      // epoch of its query
    // kinds of the leaves, {B's, A's}: 1 triangle, 2 two triangles, 3 quad
    output wire [                     3:0] m_leaf_kinds,
    output wire                            m_leaf_failed,     // a line could not be read
    // a beat of the leaves (image.md, docs/hardware/image.md), 64 bits of each, {B's, A's}, the
    // lowest first: with m_leaf_valid and on the seven clocks after it
    output wire [                   127:0] m_leaf_lines,
    // the receiver has taken a leaf pair: room for one more of two
    input  wire                            s_credit,
    // ---- outcome of each
    input  wire                            s_result_valid,    // outcome of a leaf pair
    output wire                            s_result_ready,    // it is taken
    input  wire [     $clog2(QUERIES)-1:0] s_result_context,  // context of its query
    input  wire [                     1:0] s_result_epoch,    // epoch of its query
    input  wire [                     2:0] s_result_hits,     // definite hits, 0..4
    input  wire [                     2:0] s_result_open,     // hits that are not definite, 0..4
    // 0, or the code with which the query is to end
    input  wire [                     2:0] s_result_code,
    // ---- queries that have ended
    // judgement of a result, in the order of s_result
    output wire                            m_judged_valid,
    output wire                            m_judged_live,     // its query was still at work
    output wire [                    31:0] m_judged_tag,      // tag of that query
    output wire                            m_done_valid,      // a query has ended
    input  wire                            m_done_ready,      // its answer is taken
    output wire [                    31:0] m_done_tag,        // tag of the query
    // how it ended: 0 ok, 1 for the host, 2 step limit, 3 full stack, 4 corrupt line, 5 line
    // outside, 6 bad descriptor, 7 memory
    output wire [                     2:0] m_done_code,
    output wire [                     1:0] m_done_answer,     // 0 no, 1 yes, 2 open
    output wire [                    31:0] m_done_steps,      // node pairs expanded
    output wire [                    31:0] m_done_pairs,      // hits
    // ---- lines to lock; none if first > last
    input  wire [            LOCKS*32-1:0] lock_first,        // first line of each range to lock
    // last line; a range with first > last is empty
    input  wire [            LOCKS*32-1:0] lock_last,
    input  wire                            invalidate_valid,  // command: invalidate lines
    output wire                            invalidate_ready,  // no command is at work
    input  wire [                    31:0] invalidate_first,  // first line to invalidate
    input  wire [                    31:0] invalidate_last,   // last line to invalidate
    // ---- what happens on this clock, for counters
    output wire                            count_step,        // a node pair was expanded
    output wire [                     4:0] count_tests,       // child pairs compared
    output wire                            count_leaf_pair,   // a leaf pair is fetched
    output wire [                     1:0] count_hit,         // as of cchip_cache
    output wire [                     1:0] count_miss,        // the same
    output wire [                     1:0] count_wait,        // the same
    output wire [                     1:0] count_again,       // the same
    output wire                            count_box_busy,    // the box test has a node pair
    // longest read, clocks; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                    31:0] memory_limit,
    // ---- AXI4, reading
    output wire                            m_axi_arvalid,     // AXI4 read address
    input  wire                            m_axi_arready,
    output wire [      $clog2(MISSES)-1:0] m_axi_arid,
    output wire [                    63:0] m_axi_araddr,      // address, bytes
    output wire [                     7:0] m_axi_arlen,
    output wire [                     2:0] m_axi_arsize,
    output wire [                     1:0] m_axi_arburst,     // INCR
    output wire [                     3:0] m_axi_arcache,
    output wire [                     2:0] m_axi_arprot,
    input  wire                            m_axi_rvalid,      // AXI4 read data
    output wire                            m_axi_rready,      // always 1 after reset
    input  wire [      $clog2(MISSES)-1:0] m_axi_rid,
    input  wire [              DATA_W-1:0] m_axi_rdata,
    input  wire [                     1:0] m_axi_rresp,
    input  wire                            m_axi_rlast
);

  wire read_valid, beat_valid, beat_last;
  wire [$clog2(MISSES)-1:0] read_slot, beat_slot;
  wire [57:0] read_line;
  wire [2:0] beat;
  wire [`CCHIP_READ_CODE_W-1:0] beat_code;
  wire [DATA_W-1:0] beat_data;
  wire any_outstanding;
  wire [MISSES-1:0] outstanding;

  cchip_broad_phase #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .LEAVES    (LEAVES),
      .STACK     (STACK),
      .LEAF_DEPTH(LEAF_DEPTH),
      .CACHE_KB  (CACHE_KB),
      .MISSES    (MISSES),
      .LOCKS     (LOCKS),
      .DATA_W    (DATA_W)
  ) u_broad_phase (
      .clk             (clk),
      .rst             (rst),
      .pairs_each      (pairs_each),
      .step_limit      (step_limit),
      .open_limit      (open_limit),
      .s_query_valid   (s_query_valid),
      .s_query_ready   (s_query_ready),
      .s_query         (s_query),
      .m_start_valid   (m_start_valid),
      .m_start_context (m_start_context),
      .m_start_epoch   (m_start_epoch),
      .m_start_query   (m_start_query),
      .m_leaf_valid    (m_leaf_valid),
      .m_leaf_context  (m_leaf_context),
      .m_leaf_epoch    (m_leaf_epoch),
      .m_leaf_kinds    (m_leaf_kinds),
      .m_leaf_failed   (m_leaf_failed),
      .m_leaf_lines    (m_leaf_lines),
      .s_credit        (s_credit),
      .s_result_valid  (s_result_valid),
      .s_result_ready  (s_result_ready),
      .s_result_context(s_result_context),
      .s_result_epoch  (s_result_epoch),
      .s_result_hits   (s_result_hits),
      .s_result_open   (s_result_open),
      .s_result_code   (s_result_code),
      .m_judged_valid  (m_judged_valid),
      .m_judged_live   (m_judged_live),
      .m_judged_tag    (m_judged_tag),
      .m_done_valid    (m_done_valid),
      .m_done_ready    (m_done_ready),
      .m_done_tag      (m_done_tag),
      .m_done_code     (m_done_code),
      .m_done_answer   (m_done_answer),
      .m_done_steps    (m_done_steps),
      .m_done_pairs    (m_done_pairs),
      .lock_first      (lock_first),
      .lock_last       (lock_last),
      .invalidate_valid(invalidate_valid),
      .invalidate_ready(invalidate_ready),
      .invalidate_first(invalidate_first),
      .invalidate_last (invalidate_last),
      .count_step      (count_step),
      .count_tests     (count_tests),
      .count_leaf_pair (count_leaf_pair),
      .count_hit       (count_hit),
      .count_miss      (count_miss),
      .count_wait      (count_wait),
      .count_again     (count_again),
      .count_box_busy  (count_box_busy),
      .m_read_valid    (read_valid),
      .m_read_slot     (read_slot),
      .m_read_line     (read_line),
      .s_read_valid    (beat_valid),
      .s_read_slot     (beat_slot),
      .s_read_beat     (beat),
      .s_read_last     (beat_last),
      .s_read_code     (beat_code),
      .s_read_data     (beat_data),
      .s_read_outstanding(outstanding)
  );

  localparam [31:0] BEAT = $clog2(DATA_W / 8);
  assign m_axi_arsize  = BEAT[2:0];
  assign m_axi_arburst = 2'b01;
  assign m_axi_arcache = 4'd3;
  assign m_axi_arprot  = 3'd0;
  cchip_axi_read #(
      .CLIENTS(1),
      .SLOTS  (MISSES),
      .DATA_W (DATA_W)
  ) u_read (
      .clk          (clk),
      .rst          (rst),
      .limit        (memory_limit),
      .s_valid      (read_valid),
      .s_slot       (read_slot),
      .s_line       (read_line),
      .m_valid      (beat_valid),
      .m_slot       (beat_slot),
      .m_beat       (beat),
      .m_last       (beat_last),
      .m_code       (beat_code),
      .m_data       (beat_data),
      .any_outstanding(any_outstanding),
      .outstanding  (outstanding),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_arid   (m_axi_arid),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rid    (m_axi_rid),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast)
  );
  wire unused = any_outstanding;

endmodule
`default_nettype wire
