// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_get_data: every line of a request is asked for once, on the next clock; a pair is offered once, only when both
// of its lines have come, as a node pair or as leaves by its place, with its query, its record and its own lines, and not before
// the pose of its query if it is a pair of headers; a node pair stays as it is until it is taken, leaves are there for one clock, and their lines
// leave in eight beats, in which no other leaves are offered, and on the last of which it is told that they have left;
// leaves of which a line could not be read say so, and the code of such a node pair, looked up 4 clocks or more after it was offered,
// is never 0, END_MEMORY if it is A's; if
// no pair waits for a pose, and neither the box test nor the receiver of leaves has anything, a pair that is whole brings about a pair within BOUND clocks.
// Assumed, what cchip_traversal and cchip_cache keep:
//   free      a place is asked for again only after its pair has left
//   asked     the cache answers each line that was asked for once, on a later clock; on the clock after, the place stays for the
//             upper half, and no other line comes on this port
//   beats     the box test takes a pair on its third clock or later
//   taken     the receiver of leaves takes no more than it was given; it never has more than it has room for
// One place, any: the solver chooses it; in the tasks `code` and `beats`, which are of codes and of the beats of leaves only, it is PLACE. Bit 0 of each half of a line stands for all of it.
module cchip_get_data_properties #(
    parameter integer QUERIES = 2,
    parameter integer PAIRS   = 5,
    parameter integer LEAVES  = 3,
    parameter integer LEAF_ROOM = 1
) (
    input wire                                   clk,
    input wire                                   rst,
    input wire                                   s_valid,
    input wire [       $clog2(PAIRS+LEAVES)-1:0] s_place,
    input wire [            $clog2(QUERIES)-1:0] s_context,
    input wire [                           58:0] s_record,
    input wire [                           63:0] s_lines,
    input wire                                   s_pose_valid,
    input wire [            $clog2(QUERIES)-1:0] s_pose_context,
    input wire [                            1:0] s_line_valid,
    input wire [     2*$clog2(PAIRS+LEAVES)-1:0] s_line_place,
    input wire [       2*`CCHIP_READ_CODE_W-1:0] s_line_code,
    input wire [                          511:0] s_line_data,
    input wire                                   m_pair_soon,
    input wire                                   s_leaf_taken,
    input wire                                   lookup,
    input wire [       $clog2(PAIRS+LEAVES)-1:0] lookup_place
);
  localparam integer PLACES = PAIRS + LEAVES;
  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam [2:0] END_OK = 3'd0, END_MEMORY = 3'd7;
  localparam [3:0] BOUND = 4'd8;
  wire [1:0] m_line_valid;
  wire [2*PLACE_W-1:0] m_line_place;
  wire [63:0] m_line;
  wire m_pair_valid, m_leaf_valid, m_leaf_failed;
  wire [PLACE_W-1:0] m_pair_place, m_leaf_place;
  wire [CONTEXT_W-1:0] m_pair_context, m_leaf_context, lookup_context;
  wire [7:0] m_pair_children;
  wire [1:0] m_leaf_epoch;
  wire [3:0] m_leaf_kinds;
  wire [127:0] m_leaf_lines;
  wire m_leaf_left;
  wire [511:0] m_lines;
  wire [58:0] lookup_record;
  wire [66:0] lookup_nodes;
  cchip_get_data #(
      .QUERIES(QUERIES),
      .PAIRS  (PAIRS),
      .LEAVES (LEAVES),
      .LEAF_ROOM(LEAF_ROOM)
  ) dut (
      .clk            (clk),
      .rst            (rst),
      .s_valid        (s_valid),
      .s_place        (s_place),
      .s_context      (s_context),
      .s_record       (s_record),
      .s_lines        (s_lines),
      .s_pose_valid   (s_pose_valid),
      .s_pose_context (s_pose_context),
      .m_line_valid   (m_line_valid),
      .m_line_place   (m_line_place),
      .m_line         (m_line),
      .s_line_valid   (s_line_valid),
      .s_line_place   (s_line_place),
      .s_line_code    (s_line_code),
      .s_line_data    (s_line_data),
      .m_pair_valid   (m_pair_valid),
      .m_pair_soon    (m_pair_soon),
      .m_pair_place   (m_pair_place),
      .m_pair_context (m_pair_context),
      .m_pair_children(m_pair_children),
      .s_leaf_taken   (s_leaf_taken),
      .m_leaf_valid   (m_leaf_valid),
      .m_leaf_place   (m_leaf_place),
      .m_leaf_context (m_leaf_context),
      .m_leaf_epoch   (m_leaf_epoch),
      .m_leaf_kinds   (m_leaf_kinds),
      .m_leaf_failed  (m_leaf_failed),
      .m_leaf_lines   (m_leaf_lines),
      .m_leaf_left    (m_leaf_left),
      .m_lines        (m_lines),
      .lookup         (lookup),
      .lookup_place   (lookup_place),
      .lookup_context (lookup_context),
      .lookup_record  (lookup_record),
      .lookup_nodes   (lookup_nodes)
  );

  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
  end

  // ---- all places: in flight, and lines that the cache has to answer
  reg [PLACES-1:0] busy_q, open_a_q, open_b_q;
  reg m_pair_ready;
  always @(posedge clk) m_pair_ready <= ~rst & m_pair_soon;
  wire pair_taken = m_pair_valid & m_pair_ready;
  wire [PLACES-1:0] one = {{PLACES - 1{1'b0}}, 1'b1};
  wire [PLACE_W-1:0] place_a = s_line_place[0+:PLACE_W];
  wire [PLACE_W-1:0] place_b = s_line_place[PLACE_W+:PLACE_W];
  always @(posedge clk) begin
    busy_q   <= (busy_q | (s_valid ? one << s_place : 0)) & ~(pair_taken ? one << m_pair_place : 0) &
        ~(m_leaf_left ? one << m_leaf_place : 0);
    open_a_q <= (open_a_q | (m_line_valid[0] ? one << m_line_place[0+:PLACE_W] : 0)) & ~(s_line_valid[0] ? one << place_a : 0);
    open_b_q <= (open_b_q | (m_line_valid[1] ? one << m_line_place[PLACE_W+:PLACE_W] : 0)) &
        ~(s_line_valid[1] ? one << place_b : 0);
    if (rst) {busy_q, open_a_q, open_b_q} <= {3 * PLACES{1'b0}};
  end
  // leaves with their receiver
  reg [1:0] there_q;
  always @(posedge clk) there_q <= rst ? 2'd0 : there_q + {1'b0, m_leaf_valid} - {1'b0, s_leaf_taken};
  // contexts whose pose is not there
  reg [QUERIES-1:0] no_pose_q;
  always @(posedge clk) begin
    if (s_pose_valid) no_pose_q[s_pose_context] <= 1'b0;
    if (s_valid && s_record[58]) no_pose_q[s_context] <= 1'b1;
    if (rst) no_pose_q <= {QUERIES{1'b0}};
  end

  // ---- the place that is followed
`ifdef PLACE
  wire [PLACE_W-1:0] place = `PLACE;
`else
  (* anyconst *) reg [PLACE_W-1:0] place;
`endif
  reg asked_q;  // on the last clock
  reg [PLACE_W+1:0] ask_q;
  reg wanted_q, came_a_q, came_b_q, data_a_q, data_b_q, failed_a_q, failed_b_q;
  reg [CONTEXT_W-1:0] context_q;
  reg [58:0] record_q;
  reg [2:0] age_q;  // clocks since its node pair was offered, at most 4
  reg known_q, looked_q;  // it has been offered and its place not asked for again; it was looked up on the last clock
  reg known_a_q, known_b_q;  // then: the line could not be read
  reg stays_q;
  reg [PLACE_W+CONTEXT_W+7:0] was_q;
  wire [PLACE_W+CONTEXT_W+7:0] is = {m_pair_place, m_pair_context, m_pair_children};
  reg upper_a_q, upper_b_q, high_a_q, high_b_q;  // the upper half of its line comes; what it was
  reg [1:0] upper_q;  // each port: the upper half of any line comes
  reg [2*PLACE_W-1:0] upper_place_q;
  reg shown_q;  // its lower halves left on the last clock
  reg [6:0] left_q, sends_q;  // clocks since its leaf pair left, and any: one-hot
  reg [1:0] sent_q;  // of its leaf pair: the upper half of B's line, of A's
  reg [3:0] waits_q;
  wire is_pair = m_pair_valid && m_pair_place == place;
  wire is_leaf = m_leaf_valid && m_leaf_place == place;
  wire gone = (is_pair & m_pair_ready) | (m_leaf_left && m_leaf_place == place);
  wire mine = s_valid && s_place == place;
  wire mine_a = s_line_valid[0] && place_a == place;
  wire mine_b = s_line_valid[1] && place_b == place;
  always @(posedge clk) begin
    ask_q   <= {s_lines[32], s_lines[0], s_place};
    stays_q <= ~rst & m_pair_valid & ~m_pair_ready;
    was_q   <= is;
    if (mine) {context_q, record_q} <= {s_context, s_record};
    if (mine_a) {data_a_q, failed_a_q} <= {s_line_data[0], s_line_code[0+:CODE_W] != `CCHIP_READ_OK};
    if (mine_b) {data_b_q, failed_b_q} <= {s_line_data[256], s_line_code[CODE_W+:CODE_W] != `CCHIP_READ_OK};
    if (upper_a_q) high_a_q <= s_line_data[0];
    if (upper_b_q) high_b_q <= s_line_data[256];
    upper_q <= s_line_valid & {2{~rst}};
    upper_place_q <= s_line_place;
    {upper_a_q, upper_b_q} <= {mine_a, mine_b} & {2{~rst}};
    shown_q <= ~rst & is_pair & ~stays_q;
    left_q  <= {7{~rst}} & {left_q[5:0], is_leaf};
    sends_q <= {7{~rst}} & {sends_q[5:0], m_leaf_valid};
    if (is_leaf) sent_q <= {high_b_q, high_a_q};
    if (is_pair) {known_a_q, known_b_q} <= {failed_a_q, failed_b_q};
    if (rst) begin
      {asked_q, wanted_q, came_a_q, came_b_q, known_q, looked_q} <= 6'd0;
      age_q   <= 3'd0;
      waits_q <= 4'd0;
    end else begin
      asked_q  <= s_valid;
      wanted_q <= mine | (wanted_q & ~gone);
      came_a_q <= (came_a_q | mine_a) & ~gone;
      came_b_q <= (came_b_q | mine_b) & ~gone;
      known_q  <= ~mine & (known_q | is_pair);
      age_q    <= mine ? 3'd0 : age_q[2] | ~(known_q | is_pair) ? age_q : age_q + 3'd1;
      looked_q <= lookup && lookup_place == place && age_q[2] && !mine;
      waits_q  <= ~(came_a_q & came_b_q) | m_pair_valid | m_leaf_valid | |sends_q | |no_pose_q | there_q != 2'd0 ? 4'd0 : waits_q + 4'd1;
    end
  end

  always @(*) begin
    assume (started_q || rst);
    if (s_valid) free: assume (!busy_q[s_place]);
    if (s_line_valid[0]) asked_a: assume (open_a_q[place_a]);
    if (s_line_valid[1]) asked_b: assume (open_b_q[place_b]);
    if (upper_q[0]) half_a: assume (!s_line_valid[0] && place_a == upper_place_q[0+:PLACE_W]);
    if (upper_q[1]) half_b: assume (!s_line_valid[1] && place_b == upper_place_q[PLACE_W+:PLACE_W]);
    if (m_pair_soon) beats: assume (m_pair_valid && stays_q && !m_pair_ready);
    if (s_leaf_taken) taken: assume (there_q != 2'd0);
  end
`ifdef COVER
  reg again_q, both_q;  // the place was asked for again; its lines came on one clock
  always @(posedge clk)
    if (rst) {again_q, both_q} <= 2'd0;
    else begin
      again_q <= again_q | (mine & (known_q | (age_q == 0 && wanted_q)));
      both_q  <= mine_a & mine_b | (both_q & ~mine);
    end
  always @(posedge clk)
    if (started_q && !rst && !rst_q) begin
      if (`COVER == 0) goal_again: assert (!(again_q && is_pair && stays_q && both_q));
      if (`COVER == 1) goal_leaf: assert (!(is_leaf && failed_b_q && !failed_a_q));
      if (`COVER == 2) goal_code: assert (!(looked_q && known_b_q && !known_a_q && lookup_nodes[66:64] == END_MEMORY));
      if (`COVER == 3) goal_header: assert (!(is_pair && record_q[58]));
    end
`else
  always @(*)
    if (started_q && !rst_q && !rst) begin
`ifndef PLACE
      ask: assert (m_line_valid == {2{asked_q}});
      ask_place: assert (!asked_q || ({m_line[32], m_line[0], m_line_place} == {ask_q, ask_q[PLACE_W-1:0]}));
      kind: assert (!(is_pair && place >= PAIRS) && !(is_leaf && place < PAIRS));
      whole: assert (!(is_pair || is_leaf) || (wanted_q && came_a_q && came_b_q));
      posed: assert (!(is_pair && !stays_q && record_q[58]) || posed_q);
      own_lines: assert (!(is_pair && !stays_q) || (m_lines[0] == data_a_q && m_lines[256] == data_b_q));
      own_upper: assert (!shown_q || (m_lines[0] == high_a_q && m_lines[256] == high_b_q));
      own_pair: assert (!is_pair || (m_pair_context == context_q && m_pair_children == {record_q[55:52], record_q[27:24]}));
      own_leaf: assert (!is_leaf || (m_leaf_context == context_q && m_leaf_epoch == record_q[57:56] &&
          m_leaf_kinds == {record_q[29:28], record_q[1:0]}));
      room: assert (there_q <= LEAF_ROOM);
      failed: assert (!is_leaf || m_leaf_failed == (failed_a_q || failed_b_q));
      stable: assert (!stays_q || (m_pair_valid && is == was_q));
      in_time: assert (waits_q != BOUND);
`endif
      own_beat0: assert (!is_leaf || (m_leaf_lines[0] == data_a_q && m_leaf_lines[64] == data_b_q));
      own_beat4: assert (!left_q[3] || (m_leaf_lines[0] == sent_q[0] && m_leaf_lines[64] == sent_q[1]));
      one_leaf: assert (!m_leaf_valid || sends_q == 7'd0);
      left: assert (m_leaf_left == sends_q[6]);
      reported: assert (!(looked_q && (known_a_q || known_b_q)) || lookup_nodes[66:64] != END_OK);
      reported_a: assert (!(looked_q && known_a_q) || lookup_nodes[66:64] == END_MEMORY);
    end
`endif
  // the pose of its query has come since it was asked for, two clocks ago or more
  reg [1:0] pose_came_q;
  wire posed_q = pose_came_q[1];
  always @(posedge clk)
    pose_came_q <= mine ? 2'd0 : {pose_came_q[0], pose_came_q[0] | (s_pose_valid && s_pose_context == context_q)};
endmodule
`default_nettype wire
