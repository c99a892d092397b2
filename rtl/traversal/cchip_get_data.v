// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_get_data: fetches the two lines of a node pair or of a leaf pair through the cache,
// waits for both, and hands them on: node pairs to the box test, leaves to the primitive tests.
//   rule         a pair has a place, given by who asks; its lines arrive in any order. Pairs go on
//                in the order in which their second lines come to a port, the two ports in turn;
//                node pairs and leaf pairs have queues and ways out of their own
//   room         leaf pairs wait in their places: LEAF_ROOM of them at most leave for which
//                s_leaf_taken has not been 1
//   beats        a line is two beats of 256 bits, the lower half first: from the cache with
//                s_line_valid and on the next clock, on which s_line_place stays; to the box test
//                on the first clock of m_pair_valid and the next. To who takes leaf pairs it is
//                eight of 64 bits, with m_leaf_valid and on the seven clocks after it; on the last
//                of them m_leaf_left is 1. That saves wires, and a leaf pair is in flight for
//                longer than that
//   check        what a line says of its children, and of a header, leaves with `lookup` when the
//                verdict of the box test comes: code, kinds and lines of the children
//   latency      1 clock from s_valid to m_line_valid, 8 from the second line to m_pair_valid, 7 to
//                m_leaf_valid
//   throughput   a request per clock, a node pair every third clock, a leaf pair every eighth
//   credit       a place is used again only after m_leaf_left or the verdict
//   reset        drops all pairs; no line of an earlier request may come
module cchip_get_data #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,    // node pairs in flight; legal: with LEAVES 8, 16, 32 or 64
    // leaf pairs that are fetched at once, or wait for their receiver; legal: >= 1; PAIRS + LEAVES
    // is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    parameter integer LEAF_ROOM = 1  // leaf pairs that their receiver has room for; legal: 1..3
) (
    input  wire                                                 clk,  // clock, rising edge
    // synchronous reset, active high
    input  wire                                                 rst,
    // ---- two lines wanted; always taken
    // a pair of lines is wanted
    input  wire                                                 s_valid,
    // its place; from PAIRS on a leaf pair
    input  wire [                     $clog2(PAIRS+LEAVES)-1:0] s_place,
    input  wire [                 $clog2(QUERIES)-1:0] s_context,  // context of its query
    input  wire [             `CCHIP_NODE_PAIR_W-1:0] s_record,  // as m_record of cchip_traversal
    // numbers of the lines, {B's, A's}
    input  wire [                                         63:0] s_lines,
    // ---- the poses: node pairs wait for theirs
    input  wire                                                 s_pose_valid,  // a pose is set up
    input  wire [                          $clog2(QUERIES)-1:0] s_pose_context,   // of this context
    // ---- ports of the cache, A's lines through port 0, B's through port 1
    // bit p: request to port p of the cache, p = 0 for A
    output wire [                                          1:0] m_line_valid,
    output wire [                   2*$clog2(PAIRS+LEAVES)-1:0] m_line_place,     // its place
    output wire [                                         63:0] m_line,  // number of the line
    // bit p: a line of port p
    input  wire [                                          1:0] s_line_valid,
    input  wire [                   2*$clog2(PAIRS+LEAVES)-1:0] s_line_place,     // its place
    input  wire [                     2*`CCHIP_READ_CODE_W-1:0] s_line_code,  // outcome of the read
    // a half of the line, {port 1's, port 0's}: the lower one with s_line_valid, the upper one on
    // the next clock, on which s_line_place stays
    input  wire [                                        511:0] s_line_data,
    // ---- node pairs, with the children that count: none if these are headers; a pair that is
    //      taken on the next clock is announced on this one. That is the third clock of the pair or
    //      later
    output wire                                                 m_pair_valid,     // a node pair
    // the box test takes the pair on the next clock
    input  wire                                                 m_pair_soon,
    output wire [                     $clog2(PAIRS+LEAVES)-1:0] m_pair_place,     // its place
    // context of its query
    output wire [                          $clog2(QUERIES)-1:0] m_pair_context,
    // children that count, {B's, A's}
    output wire [                                          7:0] m_pair_children,
    // ---- leaf pairs; no ready: their receiver has taken one, and has room for another
    // the receiver of leaves has taken one of those that it was given: room for one more
    input  wire                                                 s_leaf_taken,
    // a leaf pair, for one clock
    output wire                                                 m_leaf_valid,
    output wire [                     $clog2(PAIRS+LEAVES)-1:0] m_leaf_place,     // its place
    // context of its query
    output wire [                          $clog2(QUERIES)-1:0] m_leaf_context,
    output wire [                                          1:0] m_leaf_epoch,  // epoch of its query
    // kinds of the leaves, {B's, A's}: 1 triangle, 2 two triangles, 3 quad
    output wire [                                          3:0] m_leaf_kinds,
    // a line could not be read
    output wire                                                 m_leaf_failed,
    // a beat of the leaves (image.md, docs/hardware/image.md), 64 bits of each, {B's, A's}, the
    // lowest first: with m_leaf_valid and on the seven clocks after it
    output wire [                                        127:0] m_leaf_lines,
    // the last beat: m_leaf_place is free
    output wire                                                 m_leaf_left,
    // halves of the lines of a node pair, {B's, A's}: the lower ones on the first clock of
    // m_pair_valid, the upper ones on the next clock
    output wire [                                        511:0] m_lines,
    // ---- of a node pair whose verdict has come; 1 clock later
    // read what is known of this place
    input  wire                                                 lookup,
    // place of a node pair
    input  wire [                     $clog2(PAIRS+LEAVES)-1:0] lookup_place,
    output wire [                 $clog2(QUERIES)-1:0] lookup_context,            // its context
    output wire [             `CCHIP_NODE_PAIR_W-1:0] lookup_record,              // its record
    // {code, kinds of B's children, line of the first, kinds of A's, line of the first}; of headers
    // the roots
    output wire [                     `CCHIP_NODES_W-1:0] lookup_nodes
);

  localparam integer PLACES = PAIRS + LEAVES;
  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer RECORD_W = `CCHIP_NODE_PAIR_W;
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam integer LEAF_W = LEAVES > 1 ? $clog2(LEAVES) : 1;  // as in cchip_line_pairs
  localparam [31:0] FIRST_LEAF = PAIRS;
  localparam [31:0] ROOM_AT_FIRST = LEAF_ROOM;

  `CCHIP_REFUSE(QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES,
                cchip_error_get_data_QUERIES_must_be_2_4_8_or_16)
  `CCHIP_REFUSE(PAIRS < 1 || LEAVES < 1 || PLACES < 8 || PLACES > 64 || (1 << PLACE_W) != PLACES,
                cchip_error_get_data_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together)
  `CCHIP_REFUSE(LEAF_ROOM < 1 || LEAF_ROOM > 3, cchip_error_get_data_LEAF_ROOM_must_be_1_2_or_3)

  // ---- requests
  reg ask_q;
  reg [PLACE_W-1:0] ask_place_q;
  reg [63:0] ask_lines_q;
  reg [QUERIES-1:0] no_pose_q;  // contexts whose pose is not set up yet
  // a number counts only while it is valid: before, it may be unknown in simulation
  localparam [QUERIES-1:0] ONE_CONTEXT = 1;
  wire header = s_record[`CCHIP_NODE_PAIR_HEADER];
  wire [QUERIES-1:0] asks_header = s_valid && header ? ONE_CONTEXT << s_context : {QUERIES{1'b0}};
  wire [QUERIES-1:0] posed = s_pose_valid ? ONE_CONTEXT << s_pose_context : {QUERIES{1'b0}};
  `CCHIP_LUT_RAM
  reg [CONTEXT_W+RECORD_W-1:0] records[0:PLACES-1];
  always @(posedge clk) begin
    if (s_valid) records[s_place] <= {s_context, s_record};
    ask_place_q <= s_place;
    ask_lines_q <= s_lines;
    if (rst) begin
      ask_q     <= 1'b0;
      no_pose_q <= {QUERIES{1'b0}};
    end else begin
      ask_q     <= s_valid;
      no_pose_q <= (no_pose_q & ~posed) | asks_header;
    end
  end
  assign m_line_valid = {2{ask_q}};
  assign m_line_place = {2{ask_place_q}};
  assign m_line       = ask_lines_q;

  // ---- the lines as they come, and the pairs both of whose lines are here: a queue of node pairs
  // and one of leaf pairs for each port
  wire [511:0] read_lines;
  wire [2*CODE_W-1:0] read_codes, leaf_codes;
  reg [PLACE_W-1:0] fetch_q, leaf_fetch_q;
  reg beat_q;
  reg [2:0] leaf_beat_q;
  wire [1:0] queue_valid, queue_take, leaf_queue_valid, leaf_queue_take;
  wire [2*PLACE_W-1:0] queue_place, leaf_queue_place;
  cchip_line_pairs #(.PAIRS(PAIRS), .LEAVES(LEAVES), .PLACE_W(PLACE_W)) u_pairs (
      .clk         (clk),
      .rst         (rst),
      .s_valid     (s_line_valid),
      .s_place     (s_line_place),
      .s_code      (s_line_code),
      .s_data      (s_line_data),
      .m_pair_valid(queue_valid),
      .m_pair_take (queue_take),
      .m_pair_place(queue_place),
      .m_leaf_valid(leaf_queue_valid),
      .m_leaf_take (leaf_queue_take),
      .m_leaf_place(leaf_queue_place),
      .read_place  (fetch_q),
      .read_beat   (beat_q),
      .read_lines  (read_lines),
      .read_codes  (read_codes),
      .leaf_place  (leaf_fetch_q),
      .leaf_beat   (leaf_beat_q),
      .leaf_lines  (m_leaf_lines),
      .leaf_codes  (leaf_codes)
  );

  // ---- node pairs: which is next, of the two queues in turn. Memory answers 2 clocks after
  // fetch_q. The first beat is asked for on the first clock alone, and waits in lines_q; the second
  // one waits in the memory's output. Those before have gone when they come: the pair was picked
  // when the one before was loaded.
  reg turn_q;
  wire from1 = queue_valid[1] & (turn_q | ~queue_valid[0]);
  reg fetch_valid_q;
  reg [1:0] age_q;
  reg [CONTEXT_W+RECORD_W-1:0] record_q;
  reg no_pose_fetch_q;
  wire [CONTEXT_W-1:0] fetch_context = record_q[RECORD_W+:CONTEXT_W];
  reg pair_valid_q, fresh_q;
  // The box test tells a clock ahead that it takes the pair, so both of these are flip-flops: that
  // it is taken on this clock, for what picks the next pair, and that there is room for it
  reg ready_q, room_q;
  reg beat_comes_q;  // read_lines has a beat for lines_q
  wire load = fetch_valid_q & age_q[1] & ~no_pose_fetch_q & (~pair_valid_q | ready_q);
  wire pair_valid = load | (pair_valid_q & ~ready_q);  // on the next clock
  wire advance = |queue_valid & (~fetch_valid_q | load);
  assign queue_take = {from1, queue_valid[0] & ~from1} & {2{advance}};
  reg [PLACE_W-1:0] place_q;
  reg [CONTEXT_W+RECORD_W-1:0] hold_record_q;
  reg [511:0] lines_q;
  reg [1:0] failed_q;
  always @(posedge clk) begin
    if (advance) fetch_q <= from1 ? queue_place[PLACE_W+:PLACE_W] : queue_place[0+:PLACE_W];
    record_q        <= records[fetch_q];
    no_pose_fetch_q <= record_q[`CCHIP_NODE_PAIR_HEADER] & no_pose_q[fetch_context];
    beat_q          <= ~advance;
    beat_comes_q    <= age_q == 2'd1 | load;
    if (beat_comes_q) lines_q <= read_lines;
    // A pair that is not complete may be loaded, too: what is loaded counts only with pair_valid_q.
    // So the condition of these flip-flops is a short one.
    if (room_q) begin
      place_q       <= fetch_q;
      hold_record_q <= record_q;
      failed_q      <= {
        read_codes[CODE_W+:CODE_W] != `CCHIP_READ_OK, read_codes[0+:CODE_W] != `CCHIP_READ_OK
      };
    end
    age_q <= advance ? 2'd0 : age_q[1] ? age_q : age_q + 2'd1;
    if (rst) begin
      turn_q        <= 1'b0;
      fetch_valid_q <= 1'b0;
      pair_valid_q  <= 1'b0;
      ready_q       <= 1'b0;
      room_q        <= 1'b1;
      fresh_q       <= 1'b0;
    end else begin
      if (advance) turn_q <= ~from1;
      fetch_valid_q <= advance | (fetch_valid_q & ~load);
      pair_valid_q  <= pair_valid;
      ready_q       <= m_pair_soon;
      room_q        <= ~pair_valid | m_pair_soon;
      fresh_q       <= load;
    end
  end
  wire [23:0] line_a = hold_record_q[`CCHIP_NODE_PAIR_LINE_A];
  wire [23:0] line_b = hold_record_q[`CCHIP_NODE_PAIR_LINE_B];
  assign m_pair_valid    = pair_valid_q;
  assign m_pair_place    = place_q;
  assign m_pair_context  = hold_record_q[RECORD_W+:CONTEXT_W];
  assign m_pair_children = {
    hold_record_q[`CCHIP_NODE_PAIR_CHILDREN_B], hold_record_q[`CCHIP_NODE_PAIR_CHILDREN_A]
  };
  assign m_lines         = lines_q;

  // ---- leaf pairs: which is next; its first beat is read until there is room for it, then the
  // others one after the other, and what is said of it leaves with the first. So a leaf pair leaves
  // 2 clocks after s_leaf_taken.
  reg leaf_turn_q;
  reg [1:0] room_left_q;  // leaf pairs that may leave
  reg some_room_q;  // it is not 0
  reg reads_q;  // leaf_beat_q is read
  wire last = &leaf_beat_q;
  wire pick = |leaf_queue_valid & (~reads_q | last);
  wire first = reads_q && leaf_beat_q == 3'd0 && (some_room_q || s_leaf_taken);
  wire leaf_from1 = leaf_queue_valid[1] & (leaf_turn_q | ~leaf_queue_valid[0]);
  assign leaf_queue_take = {leaf_from1, leaf_queue_valid[0] & ~leaf_from1} & {2{pick}};
  wire [1:0] room_left = room_left_q + {1'b0, s_leaf_taken} - {1'b0, first};
  wire asks_leaf = {{32 - PLACE_W{1'b0}}, s_place} >= FIRST_LEAF;
  wire [23:0] asked_a = s_record[`CCHIP_NODE_PAIR_LINE_A];
  wire [23:0] asked_b = s_record[`CCHIP_NODE_PAIR_LINE_B];
  `CCHIP_LUT_RAM
  reg [CONTEXT_W+5:0] leaf_records[0:(1<<LEAF_W)-1];
  reg [CONTEXT_W+5:0] leaf_record_q, leaf_hold_q;
  reg [PLACE_W-1:0] leaf_place_q;
  reg leaf_failed_q;
  reg [1:0] first_q;  // the first beat comes into the memory's output, leaves
  reg [1:0] last_q;  // the last one, as above
  always @(posedge clk) begin
    if (s_valid && asks_leaf)
      leaf_records[s_place[LEAF_W-1:0]] <= {
        s_context, s_record[`CCHIP_NODE_PAIR_EPOCH], asked_b[1:0], asked_a[1:0]
      };
    if (pick)
      leaf_fetch_q <=
          leaf_from1 ? leaf_queue_place[PLACE_W+:PLACE_W] : leaf_queue_place[0+:PLACE_W];
    leaf_record_q <= leaf_records[leaf_fetch_q[LEAF_W-1:0]];
    if (first_q[0]) begin
      leaf_place_q  <= leaf_fetch_q;
      leaf_hold_q   <= leaf_record_q;
      leaf_failed_q <= leaf_codes != {2{`CCHIP_READ_OK}};
    end
    if (rst) begin
      leaf_turn_q <= 1'b0;
      room_left_q <= ROOM_AT_FIRST[1:0];
      some_room_q <= 1'b1;
      reads_q     <= 1'b0;
      leaf_beat_q <= 3'd0;
      first_q     <= 2'd0;
      last_q      <= 2'd0;
    end else begin
      if (pick) leaf_turn_q <= ~leaf_from1;
      room_left_q <= room_left;
      some_room_q <= room_left != 2'd0;
      reads_q     <= pick | (reads_q & ~last);
      leaf_beat_q <= leaf_beat_q + {2'd0, first || leaf_beat_q != 3'd0};
      first_q     <= {first_q[0], first};
      last_q      <= {last_q[0], reads_q & last};
    end
  end
  assign m_leaf_valid  = first_q[1];
  assign m_leaf_place  = leaf_place_q;
  assign {m_leaf_context, m_leaf_epoch, m_leaf_kinds} = leaf_hold_q;
  assign m_leaf_failed = leaf_failed_q;
  assign m_leaf_left   = last_q[1];
  wire unused = &{1'b0, asked_a, asked_b, hold_record_q};

  // ---- what the lines say, and the record of the pair whose verdict has come
  cchip_node_check #(.QUERIES(QUERIES), .PLACE_W(PLACE_W)) u_check (
      .clk         (clk),
      .rst         (rst),
      .s_valid     (fresh_q & pair_valid_q),
      .s_place     (place_q),
      .s_context   (hold_record_q[RECORD_W+:CONTEXT_W]),
      .s_header    (hold_record_q[`CCHIP_NODE_PAIR_HEADER]),
      .s_numbers   ({line_b, line_a}),
      .s_failed    (failed_q),
      .s_lines     (lines_q),
      .lookup      (lookup),
      .lookup_place(lookup_place),
      .lookup_nodes(lookup_nodes)
  );
  reg [CONTEXT_W+RECORD_W-1:0] lookup_q;
  always @(posedge clk) if (lookup) lookup_q <= records[lookup_place];
  assign {lookup_context, lookup_record} = lookup_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_beats, !(pair_valid_q && fresh_q) || !ready_q)
      `CCHIP_ASSERT(a_beat, reads_q || leaf_beat_q == 3'd0)
      `CCHIP_ASSERT(a_room, {30'd0, room_left_q} <= ROOM_AT_FIRST)
      `CCHIP_ASSERT(a_place, !(s_valid && pair_valid_q && place_q == s_place))
    end

endmodule
`default_nettype wire
