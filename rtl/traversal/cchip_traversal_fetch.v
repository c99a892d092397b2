// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_traversal_fetch: what cchip_traversal asks cchip_get_data for: the lines of a node pair as
// an event sends it, else those of the next leaf pair, which has waited in the leaf queue for a
// place.
//   rule         a node pair has its place already; a leaf pair gets one as it leaves, and gives it
//                back with s_back_valid
//   latency      1 clock from s_goes to m_valid
//   throughput   a pair per clock
//   reset        the queue is empty, every place is free
//   inside       cchip_leaf_queue, a cchip_pool of places for leaf pairs, and one output register.
module cchip_traversal_fetch #(
    parameter integer QUERIES = 16,     // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,       // node pairs in flight; legal: 1..63
    // leaf pairs that are fetched at once; legal: 1..63; PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    // entries of the leaf queue (entry); legal: PAIRS + 1 .. 128
    parameter integer LEAF_DEPTH = 72,
    parameter integer CREDIT = 32       // leaf pairs that the receiver has room for; legal: >= 1
) (
    input  wire                            clk,             // clock, rising edge
    input  wire                            rst,             // synchronous reset, active high
    input  wire [     $clog2(QUERIES)-1:0] s_context,       // context of an event in its last stage
    input  wire [                     1:0] s_epoch,         // its epoch
    // record QUERY_LINES of its query (definitions, docs/hardware/definitions.md)
    input  wire [`CCHIP_QUERY_LINES_W-1:0] s_lines,
    input  wire                            s_goes,          // a node pair goes to its place
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_place,         // this place
    input  wire [  `CCHIP_NODE_PAIR_W-1:0] s_record,        // the node pair, record NODE_PAIR
    input  wire                            s_leaf,          // leaf pairs go into the leaf queue
    // {kinds, line of the first} of the children of B, of A
    input  wire [                    79:0] s_leaf_nodes,
    // bit 4 i + j: child i of A with child j of B
    input  wire [                    15:0] s_leaf_set,
    input  wire                            s_step,          // a node pair was expanded
    input  wire [                     4:0] s_tests,         // pairs of volumes that were compared
    // ---- the epoch that a context has from the next clock on
    input  wire                            epoch_write,     // a context gets an epoch
    input  wire [     $clog2(QUERIES)-1:0] epoch_context,   // this context
    input  wire [                     1:0] epoch,           // this epoch
    // the receiver has room for one more leaf pair
    input  wire                            s_credit,
    output wire                            leaf_room,       // an entry has left the leaf queue
    // ---- leaf pairs whose query has ended
    output wire                            m_drop_valid,    // a leaf pair whose query has ended
    // it is accepted if m_drop_valid = 1 as well
    input  wire                            m_drop_ready,
    output wire [     $clog2(QUERIES)-1:0] m_drop_context,  // its context
    output wire [                     1:0] m_drop_epoch,    // its epoch
    input  wire                            s_back_valid,  // the place of a leaf pair is free again
    input  wire [$clog2(PAIRS+LEAVES)-1:0] s_back_place,    // this place
    // ---- lines for a place of cchip_get_data; always taken
    output wire                            m_valid,         // two lines are wanted; always accepted
    output wire [$clog2(PAIRS+LEAVES)-1:0] m_place,         // for this place
    output wire [     $clog2(QUERIES)-1:0] m_context,       // context of the query
    // record NODE_PAIR; of a leaf pair the kinds of its leaves
    output wire [  `CCHIP_NODE_PAIR_W-1:0] m_record,
    output wire [                    63:0] m_lines,         // numbers of the lines, {B's, A's}
    // ---- what happens on this clock, for counters
    output wire                            count_step,      // a node pair was expanded
    output wire [                     4:0] count_tests,     // pairs of volumes compared for it
    output wire                            count_leaf_pair  // a leaf pair was fetched
);

  localparam integer PLACE_W = $clog2(PAIRS + LEAVES);
  localparam integer CONTEXT_W = $clog2(QUERIES);

  wire fetch_valid, leaf_place_valid;
  wire [PLACE_W-1:0] leaf_place;
  wire [3:0] fetch_kinds;
  wire [63:0] fetch_lines;
  wire fetch_ready = leaf_place_valid & ~s_goes;
  wire fetch = fetch_valid & fetch_ready;
  cchip_leaf_queue #(.QUERIES(QUERIES), .DEPTH(LEAF_DEPTH), .CREDIT(CREDIT)) u_leaves (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (s_leaf),
      .s_context    (s_context),
      .s_epoch      (s_epoch),
      .s_a          (s_leaf_nodes[39:0]),
      .s_b          (s_leaf_nodes[79:40]),
      .s_leaves     (s_leaf_set),
      .m_room       (leaf_room),
      .epoch_write  (epoch_write),
      .epoch_context(epoch_context),
      .epoch        (epoch),
      .s_credit     (s_credit),
      .m_valid      (fetch_valid),
      .m_ready      (fetch_ready),
      .m_drop_valid (m_drop_valid),
      .m_drop_ready (m_drop_ready),
      .m_context    (m_drop_context),
      .m_epoch      (m_drop_epoch),
      .m_kinds      (fetch_kinds),
      .m_lines      (fetch_lines)
  );
  cchip_pool #(.FIRST(PAIRS), .COUNT(LEAVES), .WIDTH(PLACE_W)) u_leaf_places (
      .clk        (clk),
      .rst        (rst),
      .m_valid    (leaf_place_valid),
      .m_ready    (fetch),
      .m_number   (leaf_place),
      .back_valid (s_back_valid),
      .back_number(s_back_place)
  );

  wire [31:0] line_a = s_lines[`CCHIP_QUERY_LINES_BASE_A] +
      {8'd0, s_record[`CCHIP_NODE_PAIR_LINE_A]};
  wire [31:0] line_b = s_lines[`CCHIP_QUERY_LINES_BASE_B] +
      {8'd0, s_record[`CCHIP_NODE_PAIR_LINE_B]};
  reg out_q, step_q, fetch_q;
  reg [PLACE_W-1:0] place_q;
  reg [CONTEXT_W-1:0] context_q;
  reg [`CCHIP_NODE_PAIR_W-1:0] record_q;
  reg [63:0] lines_q;
  reg [4:0] tests_q;
  always @(posedge clk) begin
    place_q   <= s_goes ? s_place : leaf_place;
    context_q <= s_goes ? s_context : m_drop_context;
    // of a leaf pair: its kinds, and the epoch of its query
    record_q  <= s_goes ? s_record :
        `CCHIP_NODE_PAIR_OF({22'd0, fetch_kinds[1:0]}, 4'd0, {22'd0, fetch_kinds[3:2]}, 4'd0,
            m_drop_epoch, 1'b0);
    lines_q   <= s_goes ? {line_b, line_a} : fetch_lines;
    tests_q   <= s_tests;
    out_q     <= ~rst & (s_goes | fetch);
    step_q    <= ~rst & s_step;
    fetch_q   <= ~rst & fetch;
  end
  assign m_valid         = out_q;
  assign m_place         = place_q;
  assign m_context       = context_q;
  assign m_record        = record_q;
  assign m_lines         = lines_q;
  assign count_step      = step_q;
  assign count_tests     = tests_q;
  assign count_leaf_pair = fetch_q;

  wire unused = &{1'b0, s_lines[`CCHIP_QUERY_LINES_TAG]};

endmodule
`default_nettype wire
