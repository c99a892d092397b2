// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_leaf_queue: every pair of an entry leaves once and no other does, with its own payload, in order: lower bits
// of the set first, all pairs of an entry before those of the next one; fetched or forgotten, never both, by the epoch of its
// context on the clock before it is offered; what is offered stays as it is until it is taken; the receiver never has more than
// CREDIT pairs; the queue has room for DEPTH entries; with credit left the next pair is offered within BOUND clocks.
// Assumed, what cchip_traversal and the receiver of the pairs keep:
//   known     no entry of a context whose epoch has not been written since power-up
//   some      an entry holds a pair
//   counted   the sender counts entries in and m_room out, begins on the second clock after reset
//   returned  a credit comes back only for a pair that the receiver has
// Two pairs, any: the solver chooses their entries and bits, and marks the children of the first in bit 1 of their kinds, those
// of the second in bit 0. Three bits of a line stand for all. In the tasks `order` and `time` the bits are FIRST and SECOND.
module cchip_leaf_queue_properties #(
    parameter integer QUERIES = 2,
    parameter integer DEPTH   = 2,
    parameter integer CREDIT  = 2
) (
    input wire                       clk,
    input wire                       rst,
    input wire                       s_valid,
    input wire [$clog2(QUERIES)-1:0] s_context,
    input wire [                1:0] s_epoch,
    input wire [               39:0] s_a,
    input wire [               39:0] s_b,
    input wire [               15:0] s_leaves,
    input wire                       epoch_write,
    input wire [$clog2(QUERIES)-1:0] epoch_context,
    input wire [                1:0] epoch,
    input wire                       s_credit,
    input wire                       m_ready,
    input wire                       m_drop_ready
);
  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam [2:0] BOUND = 3'd6;
  wire m_room, m_valid, m_drop_valid;
  wire [CONTEXT_W-1:0] m_context;
  wire [1:0] m_epoch;
  wire [3:0] m_kinds;
  wire [63:0] m_lines;
  cchip_leaf_queue #(
      .QUERIES(QUERIES),
      .DEPTH  (DEPTH),
      .CREDIT (CREDIT)
  ) dut (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (s_valid),
      .s_context    (s_context),
      .s_epoch      (s_epoch),
      .s_a          (s_a),
      .s_b          (s_b),
      .s_leaves     (s_leaves),
      .m_room       (m_room),
      .epoch_write  (epoch_write),
      .epoch_context(epoch_context),
      .epoch        (epoch),
      .s_credit     (s_credit),
      .m_valid      (m_valid),
      .m_ready      (m_ready),
      .m_drop_valid (m_drop_valid),
      .m_drop_ready (m_drop_ready),
      .m_context    (m_context),
      .m_epoch      (m_epoch),
      .m_kinds      (m_kinds),
      .m_lines      (m_lines)
  );

  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
  end

  // ---- the sender: entries inside; the receiver: pairs it has, or is offered
  reg [1:0] inside_q, outside_q;
  wire taken = m_valid & m_ready;
  wire dropped = m_drop_valid & m_drop_ready;
  always @(posedge clk) begin
    inside_q  <= rst ? 2'd0 : inside_q + {1'b0, s_valid} - {1'b0, m_room};
    outside_q <= rst ? 2'd0 : outside_q + {1'b0, taken} - {1'b0, s_credit};
  end
  wire [2:0] used = {1'b0, outside_q} + {2'd0, m_valid};

  // ---- the epoch of every context, and what it was a clock ago
  reg [2*QUERIES-1:0] epochs_q, epochs_q2;
  reg [QUERIES-1:0] known_q = {QUERIES{1'b0}};
  always @(posedge clk) begin
    if (epoch_write) begin
      epochs_q[2*epoch_context+:2] <= epoch;
      known_q[epoch_context] <= 1'b1;
    end
    epochs_q2 <= epochs_q;
  end

  // ---- the two pairs. One that is not in the set of its entry must never leave
`ifdef FIRST
  wire [3:0] first = `FIRST, second = `SECOND;
`else
  (* anyconst *) reg [3:0] first, second;
`endif
  (* anyseq *) wire choose_first, choose_second;
  reg first_in_q, second_in_q;  // its entry has come
  reg first_left_q, second_left_q;  // and it is to leave
  wire mark_first = s_valid & choose_first & ~first_in_q;
  wire mark_second = s_valid & choose_second & ~second_in_q & (first_in_q | (mark_first & second > first));
  reg [CONTEXT_W-1:0] context_q;
  reg [1:0] epoch_q;
  reg [2:0] line_a_q, line_b_q;
  wire offered = m_valid | m_drop_valid;
  wire taken_any = taken | dropped;
  wire is_first = offered & m_kinds[1] & m_kinds[3];
  wire is_second = offered & m_kinds[0] & m_kinds[2];
  reg stays_q, fetch_q;
  reg [CONTEXT_W+11:0] was_q;
  wire [CONTEXT_W+11:0] is = {m_context, m_epoch, m_kinds, m_lines[34:32], m_lines[2:0]};
  reg [2:0] waits_q;
  always @(posedge clk) begin
    stays_q <= ~rst & offered & ~taken_any;
    fetch_q <= m_valid;
    was_q   <= is;
    if (mark_first) begin
      context_q <= s_context;
      epoch_q   <= s_epoch;
      line_a_q  <= s_a[2:0] + {1'b0, first[3:2]};
      line_b_q  <= s_b[2:0] + {1'b0, first[1:0]};
    end
    if (rst) begin
      {first_in_q, second_in_q, first_left_q, second_left_q} <= 4'd0;
      waits_q       <= 3'd0;
    end else begin
      first_in_q    <= first_in_q | mark_first;
      second_in_q   <= second_in_q | mark_second;
      first_left_q  <= mark_first ? s_leaves[first] : first_left_q & ~(is_first & taken_any);
      second_left_q <= mark_second ? s_leaves[second] : second_left_q & ~(is_second & taken_any);
      waits_q       <= ~first_left_q | offered | outside_q >= CREDIT ? 3'd0 : waits_q + 3'd1;
    end
  end

  always @(*) begin
    assume (started_q || rst);
    if (s_valid) begin
      known: assume (known_q[s_context]);
      some: assume (s_leaves != 16'd0);
      counted: assume (inside_q < DEPTH && !rst_q);
      mark_a: assume ({s_a[39], s_a[37], s_a[35], s_a[33]} == {3'd0, mark_first} << first[3:2]);
      mark_b: assume ({s_b[39], s_b[37], s_b[35], s_b[33]} == {3'd0, mark_first} << first[1:0]);
      mark_2_a: assume ({s_a[38], s_a[36], s_a[34], s_a[32]} == {3'd0, mark_second} << second[3:2]);
      mark_2_b: assume ({s_b[38], s_b[36], s_b[34], s_b[32]} == {3'd0, mark_second} << second[1:0]);
    end
    if (s_credit) returned: assume (outside_q != 2'd0);
  end
`ifdef COVER
  reg fetched_q, dropped_q;  // the first pair
  always @(posedge clk)
    if (rst) {fetched_q, dropped_q} <= 2'd0;
    else begin
      fetched_q <= fetched_q | (is_first & taken);
      dropped_q <= dropped_q | (is_first & dropped);
    end
  always @(posedge clk)
    if (started_q && !rst && !rst_q) begin
      if (`COVER == 0) goal_both: assert (!(dropped_q && is_second && m_valid && stays_q));
      if (`COVER == 1) goal_waits: assert (!(outside_q == CREDIT && fetched_q && second_left_q && inside_q == DEPTH));
      if (`COVER == 2) goal_next: assert (!(fetched_q && is_second && m_context != context_q));
    end
`else
  always @(*)
    if (started_q && !rst_q && !rst) begin
`ifndef MAIN
`ifndef TIME
      in_order: assert (!is_second || (second_left_q && !first_left_q));
`endif
`ifndef ORDER
      in_time: assert (waits_q != BOUND);
`endif
`endif
`ifndef FIRST
      one_of_two: assert (!(m_valid && m_drop_valid));
      stable: assert (!stays_q || (is == was_q && m_valid == fetch_q && m_drop_valid == !fetch_q));
      judged: assert (!offered || stays_q || m_valid == (epochs_q2[2*m_context+:2] == m_epoch));
      credit: assert (used <= CREDIT);
      room: assert (!m_room || inside_q != 0);
      once: assert (!is_first || first_left_q);
      own_query: assert (!is_first || (m_context == context_q && m_epoch == epoch_q));
      own_lines: assert (!is_first || (m_lines[2:0] == line_a_q && m_lines[34:32] == line_b_q));
`endif
    end
`endif
endmodule
`default_nettype wire
