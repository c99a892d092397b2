// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_traversal_decision, of any event in any state, for all time (it has no loop):
//   pairs     each child pair that waits goes to the box test or is on the stack, one of both; else the query ends with the code
//             of a full stack. What goes is the child pair it should be
//   leaves    the leaf pairs of a node pair are in the leaf queue's entry, or the query ends
//   place     the place of a node pair is kept by the one that goes, or free
//   room      each entry of the leaf queue that an event had is kept, used or given back
//   stack     an entry is written within the stack, on top; the count follows; it says what a pop takes first, and whether others stay
//   work      the epoch counts what goes, what is left, and what has come back, one by one
//   end       a query that ends had an error, a first hit, open pairs at their limit, or nothing left; its epoch is over. One
//             without anything in flight or on the stack ends
//   progress  a query with nothing in flight asks for its stack
//   limits    of any value, changing at any time: 0 counts as 1
//   stale     an event of a query that has ended changes nothing but the work of its epoch
// Assumed: what cchip_traversal gives: one of four events, its flags as the words they tell of, a pop of a live query with an
// entry, a start of a context without a query, a verdict or result of an epoch that has work, counts in their ranges.
module cchip_traversal_decision_properties #(
    parameter integer STACK = 8
) (
    input wire         clk,
    input wire         rst,
    input wire [  2:0] pairs_each,
    input wire [  7:0] open_limit,
    input wire         s_valid,
    input wire [  1:0] kind,
    input wire [  1:0] s_epoch,
    input wire         s_live,
    input wire [ 83:0] s_state,
    input wire [ 95:0] s_constants,
    input wire [ 11:0] s_work,
    input wire         s_over,
    input wire [ 56:0] s_verdict,
    input wire         s_extra,
    input wire [ 58:0] s_record,
    input wire [ 66:0] s_nodes,
    input wire [  8:0] s_result,
    input wire [135:0] stack_entry,
    input wire         query_bad,
    input wire         query_mode,
    input wire [ 95:0] query_constants
);
  localparam integer STACK_W = $clog2(STACK);
  localparam integer STATE_W = STACK_W + 81;
  (* anyconst *) wire [3:0] c;  // a child pair

  // ---- the event
  wire verdict = kind == 2'd0;
  wire result = kind == 2'd1;
  wire start = kind == 2'd2;
  wire pop = kind == 2'd3;
  wire [1:0] now;
  wire active, mode, hit;
  wire [STACK_W:0] entries;
  wire [2:0] under;
  wire [31:0] steps, pairs;
  wire [7:0] opens;
  assign {now, active, mode, entries, under, steps, pairs, opens, hit} = s_state;
  wire [15:0] waiting = s_verdict[15:0];
  wire [15:0] leaves = s_verdict[31:16];
  wire [15:0] strong_set = s_verdict[47:32];
  wire [3:0] best = s_verdict[51:48];
  wire [15:0] entry_waiting = stack_entry[119:104];
  wire [15:0] entry_strong = stack_entry[135:120];
  wire [2:0] code = s_nodes[66:64];
  // {others wait besides the first, first}: of {strong, waiting} the lowest strong one, else the lowest one
  function [4:0] ahead(input [31:0] of);
    integer k;
    begin
      ahead = 5'd0;
      for (k = 15; k >= 0; k = k - 1) if (of[31:16] != 0 ? of[16+k] : of[k]) ahead[3:0] = k[3:0];
      ahead[4] = (of[15:0] & ~(16'd1 << ahead[3:0])) != 0;
    end
  endfunction
  reg [4:0] count;
  integer i;
  always @(*) begin
    count = 0;
    for (i = 0; i < 16; i = i + 1) count = count + leaves[i];
  end

  wire [STATE_W-1:0] m_state;
  wire [95:0] m_constants;
  wire [11:0] m_work;
  wire m_active, m_wants, m_start, m_cancel, m_started, m_goes, m_back, m_push, m_leaf, m_ends, m_step;
  wire [58:0] m_record;
  wire [1:0] m_room;
  wire [STACK_W-1:0] m_at;
  wire [140:0] m_entry;
  wire [79:0] m_leaf_nodes;
  wire [15:0] m_leaf_set;
  wire [68:0] m_answer;
  wire [4:0] m_tests;
  cchip_traversal_decision #(
      .STACK (STACK),
      .WORK_W(12)
  ) dut (
      .clk            (clk),
      .rst            (rst),
      .pairs_each     (pairs_each),
      .open_limit     (open_limit),
      .s_valid        (s_valid),
      .s_is_verdict   (verdict),
      .s_is_result    (result),
      .s_is_start     (start),
      .s_is_pop       (pop),
      .s_epoch        (s_epoch),
      .s_live         (s_live),
      .s_state        (s_state),
      .s_constants    (s_constants),
      .s_work         (s_work),
      .s_over         (s_over),
      .s_full         (entries == STACK),
      .s_verdict      (s_verdict),
      .s_some_wait    (waiting != 0),
      .s_rest         ((waiting & ~(16'd1 << best)) != 0),
      .s_some_leaves  (leaves != 0),
      .s_leaves       (count),
      .s_extra        (s_extra),
      .s_room         (leaves == 0 || s_extra),
      .s_record       (s_record),
      .s_nodes        (s_nodes),
      .s_failed       (code != 0),
      .s_result       (s_result),
      .s_entry        ({ahead(stack_entry[135:104]), stack_entry}),
      .query_bad      (query_bad),
      .query_mode     (query_mode),
      .query_constants(query_constants),
      .m_state        (m_state),
      .m_constants    (m_constants),
      .m_work         (m_work),
      .m_active       (m_active),
      .m_wants        (m_wants),
      .m_start        (m_start),
      .m_cancel       (m_cancel),
      .m_started      (m_started),
      .m_goes         (m_goes),
      .m_record       (m_record),
      .m_back         (m_back),
      .m_room         (m_room),
      .m_push         (m_push),
      .m_at           (m_at),
      .m_entry        (m_entry),
      .m_leaf         (m_leaf),
      .m_leaf_nodes   (m_leaf_nodes),
      .m_leaf_set     (m_leaf_set),
      .m_ends         (m_ends),
      .m_answer       (m_answer),
      .m_step         (m_step),
      .m_tests        (m_tests)
  );
  always @(*) begin
    assume (entries <= STACK);
    assume (s_work <= 12'd4027);
    assume (!s_live || active);
    if (start) assume (!active);
    if (pop) assume (s_live && entries != 0 && entry_waiting != 0 && under != 3'd7);
    if (verdict || result) assume (s_work != 0);
    if (verdict && s_live) assume (under != 0);
    if (s_live) assume (s_epoch == now && s_work >= {9'd0, under} && (!result || s_work > {9'd0, under}));
    assume ((strong_set & ~waiting) == 0 && (entry_strong & ~entry_waiting) == 0);
    if (waiting != 0) assume (((waiting >> best) & 16'd1) != 0);
  end

  // ---- what is expected, three clocks later
  wire step = verdict & s_live & code == 0 & ~s_record[58] & ~s_over;
  reg past_q0, past_q, past_q2, valid_q0, valid_q, valid_q2, started_q, started_q2;
  reg [1:0] kind_q0, kind_q, kind_q2;
  reg live_q0, live_q, live_q2, step_q0, step_q, step_q2, over_q0, over_q, over_q2, extra_q0, extra_q, extra_q2, bad_q0, bad_q, bad_q2;
  reg [STATE_W-1:0] state_q0, state_q, state_q2;
  reg [11:0] work_q0, work_q, work_q2;
  reg [15:0] leaves_q0, leaves_q, leaves_q2, waiting_q0, waiting_q, waiting_q2;
  reg [4:0] count_q0, count_q, count_q2;
  reg [8:0] result_q0, result_q, result_q2;
  reg [2:0] code_q0, code_q, code_q2;
  // sides of the node pair whose child pairs wait: {inner, first, node}
  wire [3:0] inner_a = {s_nodes[31:30] == 0, s_nodes[29:28] == 0, s_nodes[27:26] == 0, s_nodes[25:24] == 0};
  wire [3:0] inner_b = {s_nodes[63:62] == 0, s_nodes[61:60] == 0, s_nodes[59:58] == 0, s_nodes[57:56] == 0};
  reg [51:0] a_q0, a_q, a_q2, b_q0, b_q, b_q2;
  // limits of the clock on which they count, at least 1
  reg [2:0] pairs_each_q;
  reg [7:0] open_limit_q, open_limit_q2;
  initial {past_q0, past_q, past_q2, valid_q0, valid_q, valid_q2} = 6'd0;
  always @(posedge clk) begin
    {past_q0, past_q, past_q2} <= {1'b1, past_q0, past_q};
    {valid_q0, valid_q, valid_q2} <= {s_valid & ~rst, valid_q0 & ~rst, valid_q & ~rst};
    {started_q, started_q2} <= {m_started, started_q};
    {kind_q0, live_q0, step_q0, over_q0, extra_q0, bad_q0, state_q0, work_q0} <= {kind, s_live, step, s_over & ~s_record[58], s_extra, query_bad, s_state, s_work};
    {kind_q, live_q, step_q, over_q, extra_q, bad_q, state_q, work_q} <= {kind_q0, live_q0, step_q0, over_q0, extra_q0, bad_q0, state_q0, work_q0};
    {kind_q2, live_q2, step_q2, over_q2, extra_q2, bad_q2, state_q2, work_q2} <= {kind_q, live_q, step_q, over_q, extra_q, bad_q, state_q, work_q};
    {leaves_q0, count_q0, result_q0, code_q0} <= {leaves, count, s_result, code};
    {leaves_q, count_q, result_q, code_q} <= {leaves_q0, count_q0, result_q0, code_q0};
    {leaves_q2, count_q2, result_q2, code_q2} <= {leaves_q, count_q, result_q, code_q};
    waiting_q0 <= pop ? entry_waiting : step ? waiting : 16'd0;
    a_q0 <= pop ? stack_entry[51:0] : {inner_a, s_nodes[23:0], s_record[23:0]};
    b_q0 <= pop ? stack_entry[103:52] : {inner_b, s_nodes[55:32], s_record[51:28]};
    {waiting_q, a_q, b_q} <= {waiting_q0, a_q0, b_q0};
    {waiting_q2, a_q2, b_q2} <= {waiting_q, a_q, b_q};
    pairs_each_q  <= pairs_each == 0 ? 3'd1 : pairs_each;
    open_limit_q  <= open_limit == 0 ? 8'd1 : open_limit;
    open_limit_q2 <= open_limit_q;
  end
  wire verdict2 = kind_q2 == 2'd0;
  wire result2 = kind_q2 == 2'd1;
  wire start2 = kind_q2 == 2'd2;
  wire pop2 = kind_q2 == 2'd3;
  wire [1:0] was_now, is_now;
  wire was_active, was_mode, was_hit, is_active, is_mode, is_hit;
  wire [STACK_W:0] had, has;
  wire [2:0] was_under, is_under;
  wire [31:0] was_steps, was_pairs, is_steps, is_pairs;
  wire [7:0] was_opens, is_opens;
  assign {was_now, was_active, was_mode, had, was_under, was_steps, was_pairs, was_opens, was_hit} = state_q2;
  assign {is_now, is_active, is_mode, has, is_under, is_steps, is_pairs, is_opens, is_hit} = m_state;
  wire [2:0] m_code = m_answer[68:66];
  // child pair c as it is to go on
  wire [1:0] ci = c[3:2];
  wire [1:0] cj = c[1:0];
  wire [27:0] c_a = a_q2[48+ci] ? {4'd15, a_q2[47:24] + {22'd0, ci}} : {4'd1 << ci, a_q2[23:0]};
  wire [27:0] c_b = b_q2[48+cj] ? {4'd15, b_q2[47:24] + {22'd0, cj}} : {4'd1 << cj, b_q2[23:0]};
  wire c_goes = m_goes && m_record[27:0] == c_a && m_record[55:28] == c_b;
  wire c_stays = m_push && m_entry[104+c];
  wire c_waits = waiting_q2[c];
  wire spilt = m_ends && m_code == 3'd3;
  wire started = start2 & m_goes;
  wire [11:0] goes_more = {11'd0, m_goes & ~verdict2};
  wire [11:0] came = {11'd0, result2 | (verdict2 & ~m_goes)};
  wire [11:0] leaf_more = m_leaf ? {7'd0, count_q2} : 12'd0;

  always @(*)
    if (past_q2 && !valid_q2)
      nothing: assert (!(m_start | m_cancel | m_goes | m_back | m_push | m_leaf | m_ends | m_step | m_active | m_wants) && m_room == 0 && m_tests == 0);
  always @(*) if (past_q0 && !valid_q0) no_start: assert (!m_started);
  always @(*)
    if (past_q2 && valid_q2) begin
      first: assert (!m_push || m_entry[140:136] == ahead(m_entry[135:104]));
      pairs_left: assert (!c_waits || c_goes || c_stays || spilt);
      pairs_once: assert (!(c_waits && c_goes && c_stays));
      pairs_known: assert (!c_stays || c_waits);
      pairs_rest: assert (!m_push || (m_entry[103:0] == {b_q2, a_q2} && (m_entry[135:120] & ~m_entry[119:104]) == 0));
      leaves_kept: assert (!step_q2 || leaves_q2 == 0 || spilt || (m_leaf && m_leaf_set == leaves_q2));
      leaves_known: assert (!m_leaf || (step_q2 && leaves_q2 != 0));
      place: assert (result2 ? !m_goes && !m_back : m_goes != m_back);
      room: assert ({1'b0, m_room} + {2'd0, m_goes} + {2'd0, m_leaf} == (result2 ? 3'd0 : verdict2 & extra_q2 ? 3'd2 : 3'd1));
      stack_at: assert (!m_push || (pop2 ? {1'b0, m_at} == had - 1 : {1'b0, m_at} == had));
      stack_count: assert (!is_active || has == (start2 ? 0 : had + (m_push && verdict2) - (pop2 && !m_push)));
      stack_room: assert (!is_active || has <= STACK);
      work: assert (start2 ? m_work == (work_q2 != 0 ? work_q2 : {11'd0, m_goes}) : m_work == work_q2 + goes_more + leaf_more - came);
      under_way: assert (!is_active || (start2 ? is_under == 1 : is_under == was_under + pop2 - (verdict2 & live_q2 & ~m_goes)));
      end_epoch: assert (is_now == was_now + {1'b0, m_ends} && m_active == is_active && !(m_ends && is_active));
      end_reason: assert (!m_ends || (start2 ? bad_q2 && m_code == 3'd6 : live_q2 && (m_code != 0 || (m_work == 0 && has == 0) || (result2 && !was_mode && result_q2[2:0] != 0))));
      end_code: assert (!(verdict2 && live_q2 && code_q2 != 0) || (m_ends && m_code == code_q2));
      end_result: assert (!(result2 && live_q2 && result_q2[8:6] != 0) || (m_ends && m_code == result_q2[8:6]));
      end_steps: assert (!(verdict2 && live_q2 && code_q2 == 0 && over_q2) || (m_ends && m_code == 3'd2));
      end_open: assert (!(result2 && live_q2 && !was_mode && result_q2[8:6] == 0 && result_q2[2:0] == 0 && was_opens + result_q2[5:3] >= {1'b0, open_limit_q2}) || (m_ends && m_code == 3'd1));
      end_host: assert (!(m_ends && result2 && result_q2[8:6] == 0 && m_code == 3'd1) || (result_q2[2:0] == 0 && was_opens + result_q2[5:3] >= {1'b0, open_limit_q2}));
      end_hit: assert (!(result2 && live_q2 && !was_mode && result_q2[8:6] == 0 && result_q2[2:0] != 0) || (m_ends && m_code == 0 && m_answer[65:64] == 2'd1));
      end_nothing_left: assert (!((live_q2 || started) && m_work == 0 && has == 0) || m_ends);
      end_answer: assert (!m_ends || m_answer[65:0] == {is_hit ? 2'd1 : is_opens != 0 ? 2'd2 : 2'd0, is_steps, is_pairs});
      goes_on: assert (!(was_active && !start2) || is_active == !m_ends);
      begins: assert (!start2 || (m_start && m_cancel == (work_q2 != 0) && started_q2 == m_goes && is_active == m_goes && m_goes == (work_q2 == 0 && !bad_q2)));
      progress: assert (!(is_active && is_under == 0 && has != 0 && (!live_q2 || m_work == 0)) || m_wants);
      wants: assert (!m_wants || (is_active && has != 0 && is_under < pairs_each_q));
      stale: assert (start2 || live_q2 || (m_state == state_q2 && !(m_push | m_leaf | m_ends | m_step | m_goes)));
    end
endmodule
`default_nettype wire
