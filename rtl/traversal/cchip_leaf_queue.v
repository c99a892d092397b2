// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_leaf_queue: leaf pairs that wait for a primitive test. One entry holds all of a node
// pair; they leave one by one.
//   rule         a pair of a query still in flight is fetched when the receiver has room for it;
//                one of a query that has ended is dropped, and reported
//   credit       the receiver has room for CREDIT pairs; s_credit = 1 when one has left it
//   latency      5 clocks from s_valid to m_valid
//   throughput   a pair every third clock, a clock more between entries
//   capacity     DEPTH entries; the sender counts them: m_room = 1 when one has left
//   reset        empty, all credit back
//   timing       5 clocks from s_valid of an empty queue to m_valid. m_valid stays until m_ready. A
//                pair is judged when it is next, on the clock before it is offered: one whose query
//                has ended leaves by m_drop, without credit. An entry comes only while fewer than
//                DEPTH are inside by the sender's count (one more for each, one less for each
//                m_room), and not on the first clock after reset. Epochs stay through a reset; the
//                epoch of a context must have been written before its first entry.
//   numbers      CREDIT after reset, one less for each pair that leaves by m, one more for each
//                clock with s_credit.
//   inside       A queue of entries in a cchip_fifo, and a copy of every context's epoch.
//   why          An entry for a node pair instead of 16 for its pairs: room is reserved for one
//                thing.
module cchip_leaf_queue #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer DEPTH = 72,    // capacity (entry); legal: 1..1024
    parameter integer CREDIT = 32    // leaf pairs that the receiver has room for; legal: 1..65535
) (
    input  wire                       clk,            // clock, rising edge
    input  wire                       rst,            // synchronous reset, active high
    // ---- the leaf pairs among the children of a node pair: i of A and j of B is bit 4 i + j
    input  wire                       s_valid,        // a node pair with leaf pairs
    input  wire [$clog2(QUERIES)-1:0] s_context,      // context of its query
    input  wire [                1:0] s_epoch,        // epoch of the query
    input  wire [               39:0] s_a,  // {kinds of the children of A, line of the first}
    input  wire [               39:0] s_b,            // the same of B
    // leaf pairs among the children, as s_verdict_leaves
    input  wire [               15:0] s_leaves,
    output wire                       m_room,         // an entry has left
    // ---- epochs as they change
    input  wire                       epoch_write,    // an epoch changes
    input  wire [$clog2(QUERIES)-1:0] epoch_context,  // of this context
    input  wire [                1:0] epoch,          // to this
    // ---- a pair to fetch, or to drop
    input  wire                       s_credit,  // the receiver has room for one more leaf pair
    output wire                       m_valid,        // a pair to fetch
    input  wire                       m_ready,        // it is taken
    output wire                       m_drop_valid,   // a pair of a query that has ended
    input  wire                       m_drop_ready,   // it is taken
    output wire [$clog2(QUERIES)-1:0] m_context,      // context of the query
    output wire [                1:0] m_epoch,        // epoch of the query
    output wire [                3:0] m_kinds,        // kinds of the leaves, {B's, A's}
    output wire [               63:0] m_lines         // numbers of the lines, {B's, A's}
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer EPOCH_W = 2;
  localparam integer ENTRY_W = CONTEXT_W + EPOCH_W + 96;

  `CCHIP_REFUSE(QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES,
                cchip_error_leaf_queue_QUERIES_must_be_2_4_8_or_16)
  `CCHIP_REFUSE(DEPTH < 1 || DEPTH > 1024, cchip_error_leaf_queue_DEPTH_must_be_1_to_1024)
  `CCHIP_REFUSE(CREDIT < 1 || CREDIT > 65535, cchip_error_leaf_queue_CREDIT_must_be_1_to_65535)

  wire ready, queue_valid, load;
  wire [ENTRY_W-1:0] queue_entry;
  cchip_fifo #(.WIDTH(ENTRY_W), .DEPTH(DEPTH), .ROOM_KNOWN(1)) u_fifo (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_valid),
      .s_ready(ready),
      .s_data ({s_context, s_epoch, s_leaves, s_b, s_a}),
      .m_valid(queue_valid),
      .m_ready(load),
      .m_data (queue_entry)
  );

  // ---- the current entry. Of its next pair: chosen, judged, waiting to be taken
  localparam [1:0] CHOOSE = 2'd0, JUDGE = 2'd1, TAKE = 2'd2;
  reg work_q;
  reg [1:0] state_q;
  reg [79:0] nodes_q;
  reg [15:0] left_q;
  reg [CONTEXT_W-1:0] context_q;
  reg [EPOCH_W-1:0] epoch_q;
  reg [3:0] number_q;
  reg last_q;
  reg valid_q, drop_q, room_q;
  reg [3:0] kinds_q;
  reg [63:0] lines_q;
  wire [15:0] rest;  // without its first pair
  wire [3:0] number;  // of that
  wire more;  // there are others
  cchip_first_pair u_first (.pairs(left_q), .first(number), .rest(rest), .several(more));
  wire taken = (valid_q & m_ready) | (drop_q & m_drop_ready);
  assign load = ~work_q;

  `CCHIP_LUT_RAM
  reg [EPOCH_W-1:0] epochs[0:QUERIES-1];
  wire live = epochs[context_q] == epoch_q;
  wire judge = work_q && state_q == JUDGE;
  wire credit, unused_outside;
  wire [$clog2(CREDIT+1)-1:0] unused_count;
  wire spend = judge & live & credit;
  cchip_count #(.LIMIT(CREDIT)) u_credit (
      .clk  (clk),
      .rst  (rst),
      .up   (spend),
      .down (s_credit),
      .count(unused_count),
      .some (unused_outside),
      .room (credit)
  );

  always @(posedge clk) begin
    if (epoch_write) epochs[epoch_context] <= epoch;
    if (load) {context_q, epoch_q, nodes_q} <= {queue_entry[ENTRY_W-1:96], queue_entry[79:0]};
    if (load) left_q <= queue_entry[95:80];
    else if (state_q == CHOOSE) left_q <= rest;
    if (state_q == CHOOSE) begin
      number_q <= number;
      last_q   <= ~more;
    end
    kinds_q <= {nodes_q[72+2*number_q[1:0]+:2], nodes_q[32+2*number_q[3:2]+:2]};
    lines_q <= {nodes_q[71:40] + {30'd0, number_q[1:0]}, nodes_q[31:0] + {30'd0, number_q[3:2]}};
    if (rst) begin
      work_q   <= 1'b0;
      state_q  <= CHOOSE;
      valid_q  <= 1'b0;
      drop_q   <= 1'b0;
      room_q   <= 1'b0;
    end else begin
      work_q <= load ? queue_valid : ~(taken & last_q);
      room_q <= load & queue_valid;
      if (load) state_q <= CHOOSE;
      else
        case (state_q)
          CHOOSE: state_q <= JUDGE;
          JUDGE: if (~live | credit) state_q <= TAKE;
          default: if (taken) state_q <= CHOOSE;
        endcase
      valid_q  <= spend | (valid_q & ~m_ready);
      drop_q   <= (judge & ~live) | (drop_q & ~m_drop_ready);
    end
  end
  assign m_room       = room_q;
  assign m_valid      = valid_q;
  assign m_drop_valid = drop_q;
  assign m_context    = context_q;
  assign m_epoch      = epoch_q;
  assign m_kinds      = kinds_q;
  assign m_lines      = lines_q;
  wire unused = &{1'b0, unused_count, unused_outside};

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, !s_valid || ready)
      `CCHIP_ASSERT(a_leaves, !s_valid || s_leaves != 16'd0)
      `CCHIP_ASSERT(a_take, (state_q == TAKE) == (valid_q | drop_q) && !(valid_q & drop_q))
      `CCHIP_ASSERT(a_left, !(work_q && state_q == CHOOSE) || left_q != 16'd0)
    end

endmodule
`default_nettype wire
