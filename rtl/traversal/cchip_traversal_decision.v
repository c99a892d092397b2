// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_traversal_decision: what an event does to its query. Of a node pair whose boxes have been
// compared the best child pair continues in the place of its parent and the others wait on the
// stack; a result ends a query for the first hit, or is counted; a start or a node pair from the
// stack goes to the box test.
//   rule         a query ends with a code, or with 0 if it has nothing in flight and nothing on the
//                stack; it then has the next epoch
//   limits       may change on any clock: of an event open_limit counts on its second clock,
//                pairs_each on its third. 0 counts as 1
//   latency      3 clocks; m_started comes after 1
//   throughput   an event per clock
//   cuts         every path: each output is a flip-flop
//   reset        drops the events inside. Without an event all outputs that say what happens
//                are 0
module cchip_traversal_decision #(
    // entries of a query's stack: 8, 16, 32 or 64
    parameter integer STACK  = 64,
    // width of the count of what an epoch has in flight, bit
    parameter integer WORK_W = 12
) (
    input  wire                      clk,
    input  wire                      rst,
    input  wire [               2:0] pairs_each,       // 0..7
    input  wire [               7:0] open_limit,       // 0..255
    // an event, one of four
    input  wire                      s_valid,
    input  wire                      s_is_verdict,
    input  wire                      s_is_result,
    input  wire                      s_is_start,
    input  wire                      s_is_pop,
    input  wire [               1:0] s_epoch,
    input  wire                      s_live,           // its query is still at work
    // the query: {epoch, has a query, mode, entries of the stack, node pairs in flight, steps, hits
    // and open pairs, open pairs, hit}
    input  wire [$clog2(STACK)+80:0] s_state,
    input  wire [              95:0] s_constants,      // {tag, line of B, line of A}
    input  wire [        WORK_W-1:0] s_work,           // what the epoch has in flight
    input  wire                      s_over,           // steps have reached their limit
    input  wire                      s_full,           // the stack is full
    // a verdict: {tests, best, strong, leaves, waiting}
    input  wire [              56:0] s_verdict,
    input  wire                      s_some_wait,      // waiting is not 0
    input  wire                      s_rest,           // nor is it without the best
    input  wire                      s_some_leaves,    // leaves is not 0
    input  wire [               4:0] s_leaves,         // how many
    input  wire                      s_extra,          // it has further room in the leaf queue
    input  wire                      s_room,           // for its leaves and those of the next one
    // what is known of its node pair
    input  wire [              58:0] s_record,
    input  wire [              66:0] s_nodes,
    input  wire                      s_failed,         // its code is not 0
    input  wire [               8:0] s_result,         // {code, open, hits}
    // last of the stack: {others wait besides the first, first, strong, waiting, B, A}
    input  wire [             140:0] s_entry,
    // the query that starts
    input  wire                      query_bad,
    input  wire                      query_mode,
    input  wire [              95:0] query_constants,
    // what is written, and what comes of it
    output wire [$clog2(STACK)+80:0] m_state,
    output wire [              95:0] m_constants,
    output wire [        WORK_W-1:0] m_work,
    output wire                      m_active,         // the context has a query
    output wire                      m_wants,          // that may have another node pair in flight
    output wire                      m_start,          // it was a start,
    output wire                      m_cancel,         // too early for this context
    output wire                      m_started,        // a start that goes well, two clocks before
    output wire                      m_goes,           // a node pair goes to its place,
    output wire [              58:0] m_record,         // this one
    output wire                      m_back,           // its place is free
    output wire [               1:0] m_room,           // entries of the leaf queue that are free
    output wire                      m_push,           // an entry of the stack
    output wire [ $clog2(STACK)-1:0] m_at,
    output wire [             140:0] m_entry,
    output wire                      m_leaf,           // an entry of the leaf queue
    output wire [              79:0] m_leaf_nodes,
    output wire [              15:0] m_leaf_set,
    output wire                      m_ends,           // an answer:
    output wire [              68:0] m_answer,         // {code, answer, steps, pairs}
    output wire                      m_step,           // a node pair was expanded
    output wire [               4:0] m_tests
);

  // how a query ended (docs/hardware/image.md)
  localparam [2:0] END_OK = 3'd0, END_HOST = 3'd1, END_STEPS = 3'd2, END_STACK = 3'd3;
  localparam [2:0] END_BAD_DESCRIPTOR = 3'd6;
  localparam integer STACK_W = $clog2(STACK);

  // ---- the first clock: which way the event takes
  wire [1:0] now;
  wire active, mode, hit;
  wire [STACK_W:0] entries;
  wire [2:0] under;
  wire [31:0] steps, pairs;
  wire [7:0] opens;
  assign {now, active, mode, entries, under, steps, pairs, opens, hit} = s_state;
  wire [4:0] tests;
  wire [3:0] best_number;
  wire [15:0] box_strong, box_leaves, box_waiting;
  assign {tests, best_number, box_strong, box_leaves, box_waiting} = s_verdict;
  wire header;
  wire [1:0] unused_epoch;
  wire [3:0] unused_children_b, unused_children_a;
  wire [23:0] line_a, line_b, first_a, first_b;
  wire [2:0] data_code, result_code, result_open, result_hits;
  wire [7:0] kinds_a, kinds_b;
  assign {header, unused_epoch, unused_children_b, line_b, unused_children_a, line_a} = s_record;
  assign {data_code, kinds_b, first_b, kinds_a, first_a} = s_nodes;
  assign {result_code, result_open, result_hits} = s_result;
  wire stack_rest;
  wire [3:0] stack_first;
  wire [15:0] stack_strong, stack_waiting;
  wire [51:0] stack_a, stack_b;  // {inner children, first child, node}
  assign {stack_rest, stack_first, stack_strong, stack_waiting, stack_b, stack_a} = s_entry;

  wire known = s_is_verdict & s_live & ~s_failed;
  wire step = known & ~header & ~s_over;
  wire roots = known & header;
  wire onward = step & s_some_wait & s_room;
  wire push = step & s_some_wait & (~s_room | s_rest);
  wire spill = push & s_full;
  wire busy = |s_work;  // of a start: the epoch has something in flight still
  wire start_ok = s_is_start & ~busy & ~query_bad;
  wire goes = start_ok | s_is_pop | roots | (onward & ~spill);
  wire leaf = step & s_some_leaves & ~spill;
  wire counts = s_is_result & s_live;

  wire [3:0] inner_a, inner_b;
  genvar n;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_inner
      assign inner_a[n] = kinds_a[2*n+:2] == 2'd0;
      assign inner_b[n] = kinds_b[2*n+:2] == 2'd0;
    end
  endgenerate

  // what the event is and does
  reg started_q, valid_q, verdict_q, result_q, start_q, pop_q, live_q, counts_q, extra_q;
  reg step_q, roots_q, goes_q, leaf_q, cancel_q, bad_q, box_fails_q, clears_q;
  reg push_q, entry_more_q, entry_less_q;
  // its query
  reg active_q, mode_q, hit_q;
  reg [1:0] now_q, epoch_q;
  reg [STACK_W:0] entries_q;
  reg [2:0] under_q;
  reg [31:0] steps_q, pairs_q;
  reg [8:0] opens_q;
  reg some_open_q;
  reg [95:0] constants_q;
  reg [WORK_W-1:0] work_q;
  // its node pair, or that of its leaf pair
  reg [51:0] half_a_q, half_b_q;
  reg [7:0] kinds_a_q, kinds_b_q;
  reg [3:0] number_q;
  reg [15:0] waiting_q, strong_q, leaf_set_q;
  reg [4:0] leaves_q, leaves_less_q, tests_q;
  reg [3:0] counted_q;
  reg [2:0] code_q;
  reg some_code_q, some_hits_q;
  always @(posedge clk) begin
    valid_q <= ~rst & s_valid;
    started_q <= ~rst & s_valid & start_ok;
    verdict_q <= s_is_verdict;
    result_q <= s_is_result;
    start_q <= s_is_start;
    pop_q <= s_is_pop;
    live_q <= s_live | start_ok;
    counts_q <= counts;
    extra_q <= s_extra;
    step_q <= step;
    roots_q <= roots;
    goes_q <= goes;
    leaf_q <= leaf;
    cancel_q <= s_is_start & busy;
    bad_q <= s_is_start & ~busy & query_bad;
    box_fails_q <= s_is_verdict & s_live & (s_failed | (~header & s_over) | spill);
    clears_q <= s_is_pop | onward;
    push_q <= (push & ~s_full) | (s_is_pop & stack_rest);
    entry_more_q <= push;
    entry_less_q <= s_is_pop & ~stack_rest;

    active_q <= s_is_start ? start_ok : active;
    mode_q <= s_is_start ? query_mode : mode;
    hit_q <= ~s_is_start & (hit | (counts & |result_hits));
    now_q <= now;
    epoch_q <= s_epoch;
    entries_q <= s_is_start ? {STACK_W + 1{1'b0}} : entries;
    under_q <= s_is_start ? 3'd1 : under;
    steps_q <= s_is_start ? 32'd0 : steps;
    pairs_q <= s_is_start ? 32'd0 : pairs;
    opens_q <= {1'b0, opens} + (counts ? {6'd0, result_open} : 9'd0);
    some_open_q <= |opens | |result_open;
    constants_q <= s_is_start ? query_constants : s_constants;
    work_q <= s_work;

    // the child pair that continues: of a verdict the best, from the stack the first
    number_q <= s_is_pop ? stack_first : best_number;
    waiting_q <= s_is_pop ? stack_waiting : box_waiting;
    strong_q <= s_is_pop ? stack_strong : box_strong;
    half_a_q <= s_is_pop ? stack_a : {inner_a, first_a, line_a};
    half_b_q <= s_is_pop ? stack_b : {inner_b, first_b, line_b};
    kinds_a_q <= kinds_a;
    kinds_b_q <= kinds_b;
    leaf_set_q <= box_leaves;
    leaves_q <= s_leaves;
    leaves_less_q <= s_leaves - 5'd1;
    tests_q <= tests;
    counted_q <= counts ? {1'b0, result_hits} + {1'b0, result_open} : 4'd0;
    some_code_q <= |result_code;
    some_hits_q <= |result_hits;
    code_q <= s_is_result ? (|result_code ? result_code : |result_hits ? END_OK : END_HOST) :
        s_failed ? data_code : spill ? END_STACK : END_STEPS;
  end

  // ---- the second clock: counts, the child pair's lines, what stays on the stack
  // a limit of 0 open pairs counts as 1
  wire first_hit = ~mode_q & (some_hits_q | (some_open_q & opens_q >= {1'b0, open_limit}));
  // what is added to the work of the epoch: leaf pairs, and the node pair itself
  wire one_more = goes_q & ~verdict_q;
  wire one_less = result_q | (verdict_q & ~goes_q);
  wire [4:0] leaf_work = goes_q ? leaves_q : leaves_less_q;
  wire [WORK_W-1:0] more = leaf_q ? {{WORK_W - 5{1'b0}}, leaf_work} :
      {{WORK_W - 1{one_less}}, one_less | one_more};
  wire [15:0] chosen = 16'd1 << number_q;
  wire [15:0] kept_strong = clears_q ? strong_q & ~chosen : strong_q | chosen;
  wire [23:0] child_a = half_a_q[47:24];
  wire [23:0] child_b = half_b_q[47:24];
  wire [3:0] is_inner_a = half_a_q[51:48];
  wire [3:0] is_inner_b = half_b_q[51:48];
  wire [1:0] i = number_q[3:2];
  wire [1:0] j = number_q[1:0];

  reg valid_q2, start_q2, cancel_q2, goes_q2, back_q2, push_q2, leaf_q2, fails_q2, bad_q2, live_q2;
  reg step_q2, active_q2, mode_q2, hit_q2, inner_a_q2, inner_b_q2, any_strong_q2;
  reg [1:0] room_q2, now_q2, epoch_q2;
  reg [23:0] child_a_q2, child_b_q2;
  reg [3:0] one_a_q2, one_b_q2;
  reg [51:0] half_a_q2, half_b_q2;
  reg [15:0] waiting_q2, strong_q2, leaf_set_q2;
  reg [2:0] code_q2, under_q2;
  reg [WORK_W-1:0] work_q2;
  reg [STACK_W:0] entries_q2;
  reg [STACK_W-1:0] at_q2;
  reg [31:0] steps_q2, pairs_q2;
  reg [7:0] opens_q2;
  reg [95:0] constants_q2;
  reg [79:0] leaf_nodes_q2;
  reg [4:0] tests_q2;
  always @(posedge clk) begin
    valid_q2 <= ~rst & valid_q;
    start_q2 <= start_q;
    cancel_q2 <= cancel_q;
    goes_q2 <= goes_q;
    back_q2 <= ~goes_q & ~result_q;
    push_q2 <= push_q;
    leaf_q2 <= leaf_q;
    fails_q2 <= box_fails_q | (counts_q & (some_code_q | first_hit));
    bad_q2 <= bad_q;
    live_q2 <= live_q;
    step_q2 <= step_q;
    active_q2 <= active_q;
    mode_q2 <= mode_q;
    hit_q2 <= hit_q;
    room_q2 <= result_q ? 2'd0 : start_q | pop_q ? {1'b0, ~goes_q} :
        2'd1 + {1'b0, extra_q} - {1'b0, leaf_q} - {1'b0, goes_q};
    now_q2 <= now_q;
    epoch_q2 <= epoch_q;
    inner_a_q2 <= roots_q | is_inner_a[i];
    inner_b_q2 <= roots_q | is_inner_b[j];
    child_a_q2 <= child_a + {22'd0, i & ~{2{roots_q}}};
    child_b_q2 <= child_b + {22'd0, j & ~{2{roots_q}}};
    one_a_q2 <= 4'd1 << i;
    one_b_q2 <= 4'd1 << j;
    half_a_q2 <= half_a_q;
    half_b_q2 <= half_b_q;
    waiting_q2 <= waiting_q & ~(chosen & {16{clears_q}});
    strong_q2 <= kept_strong;
    any_strong_q2 <= |kept_strong;
    leaf_set_q2 <= leaf_set_q;
    code_q2 <= code_q;
    under_q2 <= pop_q ? under_q + 3'd1 :
        verdict_q & live_q & ~goes_q ? under_q - 3'd1 : under_q;
    work_q2 <= work_q + more;
    entries_q2 <= entries_q + ({STACK_W + 1{entry_less_q}} | {{STACK_W{1'b0}}, entry_more_q});
    at_q2 <= entries_q[STACK_W-1:0] - {{STACK_W - 1{1'b0}}, pop_q};
    steps_q2 <= steps_q + {31'd0, step_q};
    pairs_q2 <= pairs_q + {28'd0, counted_q};
    opens_q2 <= start_q ? 8'd0 : opens_q[8] ? 8'd255 : opens_q[7:0];
    constants_q2 <= constants_q;
    leaf_nodes_q2 <= {
      kinds_b_q, {8'd0, child_b} + constants_q[63:32],
      kinds_a_q, {8'd0, child_a} + constants_q[31:0]
    };
    tests_q2 <= tests_q;
  end

  // ---- the third clock: is the query at its end, and what will a pop take first?
  wire ends = bad_q2 | (live_q2 & (fails_q2 | (~|work_q2 & ~|entries_q2)));
  wire still = active_q2 & ~ends;
  wire [1:0] next_epoch = now_q2 + {1'b0, ends};
  // a child that is a leaf continues with its parent's line and a mask of one child
  wire [27:0] next_a = inner_a_q2 ? {4'd15, child_a_q2} : {one_a_q2, half_a_q2[23:0]};
  wire [27:0] next_b = inner_b_q2 ? {4'd15, child_b_q2} : {one_b_q2, half_b_q2[23:0]};
  // a FIRST query with leaf pairs out, one of which may end it, asks for half as many. Both
  // comparisons are made, because it is known late which one counts
  wire hopes = live_q2 && ~mode_q2 && work_q2 != {{WORK_W - 3{1'b0}}, under_q2};
  wire below_half = under_q2 < {1'b0, pairs_each[2:1]};
  wire below_all = under_q2 < (pairs_each | {2'd0, ~|pairs_each});
  // a strong child pair before others, the lowest number first
  wire [15:0] of = any_strong_q2 ? strong_q2 : waiting_q2;
  wire [3:0] of_row, two_of_row, row_waits;  // child i of A with any of B
  wire [7:0] lowest_of_row;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_row
      wire [3:0] of_here = of[4*n+:4];
      wire [3:0] waits = waiting_q2[4*n+:4];
      assign of_row[n] = |of_here;
      assign lowest_of_row[2*n+:2] = {~|of_here[1:0], ~of_here[0] & (of_here[1] | ~of_here[2])};
      assign row_waits[n] = |waits;
      assign two_of_row[n] = (|waits[1:0] & |waits[3:2]) | &waits[1:0] | &waits[3:2];
    end
  endgenerate
  wire [1:0] row = {~|of_row[1:0], ~of_row[0] & (of_row[1] | ~of_row[2])};
  wire [3:0] first = {row, lowest_of_row[2*row+:2]};
  wire first_rest = |two_of_row | (|row_waits[1:0] & |row_waits[3:2]) | &row_waits[1:0] |
      &row_waits[3:2];

  reg out_active_q, out_wants_q, out_start_q, out_cancel_q, out_goes_q, out_back_q;
  reg out_push_q, out_leaf_q, out_ends_q, out_step_q;
  reg [1:0] out_room_q;
  reg [STACK_W+80:0] out_state_q;
  wire valid = valid_q2 & ~rst;
  reg [95:0] out_constants_q;
  reg [WORK_W-1:0] out_work_q;
  reg [58:0] out_record_q;
  reg [STACK_W-1:0] out_at_q;
  reg [140:0] out_entry_q;
  reg [79:0] out_leaf_nodes_q;
  reg [15:0] out_leaf_set_q;
  reg [68:0] out_answer_q;
  reg [4:0] out_tests_q;
  always @(posedge clk) begin
    out_start_q <= valid & start_q2;
    out_cancel_q <= valid & cancel_q2;
    out_goes_q <= valid & goes_q2 & ~ends;
    out_back_q <= valid & back_q2;
    out_push_q <= valid & push_q2;
    out_leaf_q <= valid & leaf_q2;
    out_ends_q <= valid & ends;
    out_step_q <= valid & step_q2;
    out_room_q <= valid ? room_q2 : 2'd0;
    out_active_q <= valid & still;
    out_wants_q <= valid && still && |entries_q2 && (hopes ? below_half : below_all);
    out_state_q <= {
      next_epoch, still, mode_q2, entries_q2, under_q2, steps_q2, pairs_q2, opens_q2, hit_q2
    };
    out_work_q <= work_q2;
    out_constants_q <= constants_q2;
    out_record_q <= start_q2 ? {1'b1, next_epoch, 56'd0} : {1'b0, epoch_q2, next_b, next_a};
    out_at_q <= at_q2;
    out_entry_q <= {first_rest, first, strong_q2, waiting_q2, half_b_q2, half_a_q2};
    out_leaf_nodes_q <= leaf_nodes_q2;
    out_leaf_set_q <= leaf_set_q2;
    out_answer_q <= {
      bad_q2 ? END_BAD_DESCRIPTOR : fails_q2 ? code_q2 : END_OK,
      hit_q2 ? 2'd1 : |opens_q2 ? 2'd2 : 2'd0,
      steps_q2,
      pairs_q2
    };
    out_tests_q <= valid & step_q2 ? tests_q2 : 5'd0;
  end
  assign m_state      = out_state_q;
  assign m_constants  = out_constants_q;
  assign m_work       = out_work_q;
  assign m_active     = out_active_q;
  assign m_wants      = out_wants_q;
  assign m_start      = out_start_q;
  assign m_cancel     = out_cancel_q;
  assign m_started    = started_q;
  assign m_goes       = out_goes_q;
  assign m_record     = out_record_q;
  assign m_back       = out_back_q;
  assign m_room       = out_room_q;
  assign m_push       = out_push_q;
  assign m_at         = out_at_q;
  assign m_entry      = out_entry_q;
  assign m_leaf       = out_leaf_q;
  assign m_leaf_nodes = out_leaf_nodes_q;
  assign m_leaf_set   = out_leaf_set_q;
  assign m_ends       = out_ends_q;
  assign m_answer     = out_answer_q;
  assign m_step       = out_step_q;
  assign m_tests      = out_tests_q;
  wire unused = &{1'b0, unused_epoch, unused_children_a, unused_children_b, of_row[3]};

endmodule
`default_nettype wire
