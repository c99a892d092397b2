// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_broad_phase_axi: cchip_broad_phase with a cchip_axi_read of its own, for an AXI4 memory.
// Ports and rules are those of the two.
//   cuts         every path: each output is a flip-flop
//   reset        must reset the bus, too
module cchip_broad_phase_axi #(
    // queries at once: 2, 4, 8 or 16
    parameter integer QUERIES = 16,
    // node pairs in flight
    parameter integer PAIRS = 48,
    // leaf pairs that are fetched at once; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    // entries of a query's stack: 8, 16, 32 or 64
    parameter integer STACK = 64,
    // entries of the queue of leaves, more than PAIRS
    parameter integer LEAF_DEPTH = 72,
    // size of the cache, KiB: 1, 2, 4 ... 1024
    parameter integer CACHE_KB = 128,
    // lines in flight from memory: 2, 4, 8, 16 or 32
    parameter integer MISSES = 32,
    // ranges of lines to lock, 1..4
    parameter integer LOCKS = 2,
    // width of the data bus of memory, bit: 64, 128, 256 or 512
    parameter integer DATA_W = 128
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
    // a query that has started
    output wire                            m_start_valid,
    output wire [     $clog2(QUERIES)-1:0] m_start_context,
    output wire [                     1:0] m_start_epoch,
    output wire [                   511:0] m_start_query,
    // leaf pairs; one of them at most until s_credit says that it has left
    output wire                            m_leaf_valid,
    output wire [     $clog2(QUERIES)-1:0] m_leaf_context,
    output wire [                     1:0] m_leaf_epoch,
    output wire [                     3:0] m_leaf_kinds,         // {B's, A's}
    output wire                            m_leaf_failed,        // a line could not be read
    output wire [                   127:0] m_leaf_lines,         // one of eight beats
    input  wire                            s_credit,
    // outcome of each
    input  wire                            s_result_valid,
    output wire                            s_result_ready,
    input  wire [     $clog2(QUERIES)-1:0] s_result_context,
    input  wire [                     1:0] s_result_epoch,
    input  wire [                     2:0] s_result_hits,        // definite hits, 0..4
    input  wire [                     2:0] s_result_open,        // others
    input  wire [                     2:0] s_result_code,
    // queries that have ended
    output wire                            m_judged_valid,
    output wire                            m_judged_live,
    output wire [                    31:0] m_judged_tag,
    output wire                            m_done_valid,
    input  wire                            m_done_ready,
    output wire [                    31:0] m_done_tag,
    output wire [                     2:0] m_done_code,
    output wire [                     1:0] m_done_answer,        // no, yes, open
    output wire [                    31:0] m_done_steps,
    output wire [                    31:0] m_done_pairs,
    // lines to lock; none if first > last
    input  wire [            LOCKS*32-1:0] lock_first,
    input  wire [            LOCKS*32-1:0] lock_last,
    // lines to invalidate
    input  wire                            invalidate_valid,
    output wire                            invalidate_ready,
    input  wire [                    31:0] invalidate_first,
    input  wire [                    31:0] invalidate_last,
    // what happens on this clock, for counters
    output wire                            count_step,
    output wire [                     4:0] count_tests,
    output wire                            count_leaf_pair,
    output wire [                     1:0] count_hit,
    output wire [                     1:0] count_miss,
    output wire [                     1:0] count_wait,
    output wire [                     1:0] count_again,
    output wire                            count_box_busy,       // the box test works
    // longest read, clocks
    input  wire [                    31:0] memory_limit,
    // AXI4, reading
    output wire                            m_axi_arvalid,
    input  wire                            m_axi_arready,
    output wire [      $clog2(MISSES)-1:0] m_axi_arid,
    output wire [                    63:0] m_axi_araddr,
    output wire [                     7:0] m_axi_arlen,
    output wire [                     2:0] m_axi_arsize,
    output wire [                     1:0] m_axi_arburst,
    output wire [                     3:0] m_axi_arcache,
    output wire [                     2:0] m_axi_arprot,
    input  wire                            m_axi_rvalid,
    output wire                            m_axi_rready,
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
      .m_axi_arsize (m_axi_arsize),
      .m_axi_arburst(m_axi_arburst),
      .m_axi_arcache(m_axi_arcache),
      .m_axi_arprot (m_axi_arprot),
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
