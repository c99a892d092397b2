// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_traversal_decision: what an event does to its query. Of a node pair whose boxes have been
// compared the best child pair goes on in the place of its parent and the others wait on the stack;
// a result ends a query for the first hit, or is counted; a start or a node pair from the stack
// goes to the box test.
//   rule         a query ends with a code, or with 0 if it has nothing under way and nothing on the
//                stack; it then has the next epoch
//   limits       may change on any clock: of an event open_limit counts on its first clock,
//                pairs_each on its second. 0 counts as 1
//   latency      2 clocks
//   throughput   an event per clock
//   cuts         every path: each output is a flip-flop
//   reset        forgets the events inside. Without an event all outputs that say what happens
//                are 0
module cchip_traversal_decision #(
    // entries of a query's stack: 8, 16, 32 or 64
    parameter integer STACK  = 64,
    // width of the count of what an epoch has under way, bit
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
    // the query: {epoch, has a query, mode, entries of the stack, node pairs under way, steps, hits
    // and open pairs, open pairs, hit}
    input  wire [$clog2(STACK)+80:0] s_state,
    input  wire [              95:0] s_constants,      // {tag, line of B, line of A}
    input  wire [        WORK_W-1:0] s_work,           // what the epoch has under way
    input  wire                      s_over,           // steps have reached their limit
    input  wire                      s_full,           // the stack is full
    // a verdict: {tests, best, strong, leaves, waiting}
    input  wire [              56:0] s_verdict,
    input  wire                      s_some_wait,      // waiting is not 0
    input  wire                      s_some_leaves,    // leaves is not 0
    input  wire [               4:0] s_leaves,         // how many
    input  wire                      s_extra,          // it has further room in the leaf queue
    input  wire                      s_room,           // for its leaves and those of the next one
    // what is known of its node pair
    input  wire [              58:0] s_record,
    input  wire [              66:0] s_nodes,
    input  wire                      s_failed,         // its code is not 0
    input  wire [               8:0] s_result,         // {code, open, hits}
    input  wire [             135:0] s_entry,          // last of the stack: {strong, waiting, B, A}
    // the query that starts
    input  wire                      query_bad,
    input  wire                      query_mode,
    input  wire [              95:0] query_constants,
    // what is written, and what comes of it
    output wire [$clog2(STACK)+80:0] m_state,
    output wire [              95:0] m_constants,
    output wire [        WORK_W-1:0] m_work,
    output wire                      m_active,         // the context has a query
    output wire                      m_wants,          // that may have another node pair under way
    output wire                      m_start,          // it was a start,
    output wire                      m_cancel,         // too early for this context
    output wire                      m_started,        // which went well
    output wire                      m_goes,           // a node pair goes to its place,
    output wire [              58:0] m_record,         // this one
    output wire                      m_back,           // its place is free
    output wire [               1:0] m_room,           // entries of the leaf queue that are free
    output wire                      m_push,           // an entry of the stack
    output wire [ $clog2(STACK)-1:0] m_at,
    output wire [             135:0] m_entry,
    output wire                      m_leaf,           // an entry of the leaf queue
    output wire [              79:0] m_leaf_nodes,
    output wire [              15:0] m_leaf_set,
    output wire                      m_ends,           // an answer:
    output wire [              68:0] m_answer,         // {code, answer, steps, pairs}
    output wire                      m_step,           // a node pair was expanded
    output wire [               4:0] m_tests
);

  // how a query ended (docs/image.md)
  localparam [2:0] END_OK = 3'd0, END_HOST = 3'd1, END_STEPS = 3'd2, END_STACK = 3'd3;
  localparam [2:0] END_BAD_DESCRIPTOR = 3'd6;
  localparam integer STACK_W = $clog2(STACK);
  localparam [STACK_W:0] ONE_ENTRY = 1;

  // ---- the first clock: what happens
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
  wire [15:0] stack_strong, stack_waiting;
  wire [51:0] stack_a, stack_b;  // {inner children, first child, node}
  assign {stack_strong, stack_waiting, stack_b, stack_a} = s_entry;

  wire known = s_is_verdict & s_live & ~s_failed;
  wire step = known & ~header & ~s_over;
  wire roots = known & header;
  wire onward = step & s_some_wait & s_room;

  wire [3:0] inner_a, inner_b;
  genvar n;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_inner
      assign inner_a[n] = kinds_a[2*n+:2] == 2'd0;
      assign inner_b[n] = kinds_b[2*n+:2] == 2'd0;
    end
  endgenerate

  // the child pair that goes on: of a verdict the best, from the stack a strong one before others,
  // the lowest number first
  wire [15:0] waiting = s_is_pop ? stack_waiting : box_waiting;
  wire [15:0] overlapping = s_is_pop ? stack_strong : box_strong;
  wire [15:0] of = |stack_strong ? stack_strong : stack_waiting;
  wire [15:0] lowest = of & (~of + 16'd1);
  wire [ 3:0] lowest_number;
  assign lowest_number[3] = |lowest[15:8];
  assign lowest_number[2] = |{lowest[15:12], lowest[7:4]};
  assign lowest_number[1] = |{lowest[15:14], lowest[11:10], lowest[7:6], lowest[3:2]};
  assign lowest_number[0] = |{lowest[15], lowest[13], lowest[11], lowest[9], lowest[7], lowest[5],
                              lowest[3], lowest[1]};
  wire [15:0] best = 16'd1 << best_number;
  wire [15:0] rest_waiting = waiting & ~(s_is_pop ? lowest : best);
  wire [15:0] rest_strong = overlapping & ~(s_is_pop ? lowest : best);
  wire rest = |rest_waiting;
  wire push = step & s_some_wait & (~s_room | rest);
  wire spill = push & s_full;

  wire busy = |s_work;  // of a start: the epoch has something under way still
  wire start_ok = s_is_start & ~busy & ~query_bad;
  wire goes = start_ok | s_is_pop | roots | (onward & ~spill);
  wire leaf = step & s_some_leaves & ~spill;
  wire counts = s_is_result & s_live;
  wire [8:0] opens_now = {1'b0, opens} + {6'd0, result_open};
  wire some_open = |opens | |result_open;  // a limit of 0 counts as 1
  wire first_hit = ~mode & (|result_hits | (some_open & opens_now >= {1'b0, open_limit}));
  wire fails = s_live & (s_is_verdict ? s_failed | (~header & s_over) | spill :
                         s_is_result & (|result_code | first_hit));
  wire [2:0] code = s_is_result ? (|result_code ? result_code : |result_hits ? END_OK : END_HOST) :
      s_failed ? data_code : spill ? END_STACK : END_STEPS;
  // what is added to the work of the epoch: pairs of leaves, and the node pair itself
  wire [WORK_W-1:0] more = leaf ? {{WORK_W - 5{1'b0}}, s_leaves} : {WORK_W{1'b0}};
  wire [WORK_W-1:0] one_more = {{WORK_W - 1{1'b0}}, s_is_pop};
  wire [WORK_W-1:0] one_less = {{WORK_W - 1{1'b0}}, s_is_result | (s_is_verdict & ~goes)};

  reg valid_q, start_q, cancel_q, goes_q, roots_q, back_q, push_q, leaf_q, fails_q, bad_q, live_q;
  reg step_q, active_q, mode_q, hit_q;
  reg [1:0] room_q, now_q, epoch_q;
  reg [51:0] half_a_q, half_b_q;
  reg [3:0] number_q;
  reg [15:0] push_waiting_q, push_strong_q, leaf_set_q;
  reg [2:0] code_q, under_q;
  reg [ WORK_W-1:0] work_q;
  reg [  STACK_W:0] entries_q;
  reg [STACK_W-1:0] at_q;
  reg [31:0] steps_q, pairs_q;
  reg [ 7:0] opens_q;
  reg [95:0] constants_q;
  reg [79:0] leaf_nodes_q;
  reg [ 4:0] tests_q;
  always @(posedge clk) begin
    valid_q <= ~rst & s_valid;
    start_q <= s_is_start;
    cancel_q <= s_is_start & busy;
    bad_q <= s_is_start & ~busy & query_bad;
    goes_q <= goes;
    roots_q <= roots;
    back_q <= ~goes & ~s_is_result;
    push_q <= (push & ~s_full) | (s_is_pop & rest);
    leaf_q <= leaf;
    fails_q <= fails;
    code_q <= code;
    live_q <= s_live | start_ok;
    active_q <= s_is_start ? start_ok : active;
    step_q <= step;
    tests_q <= tests;
    room_q         <= s_is_result ? 2'd0 : s_is_start | s_is_pop ? {1'b0, ~goes} :
        2'd1 + {1'b0, s_extra} - {1'b0, leaf} - {1'b0, goes};
    half_a_q <= s_is_pop ? stack_a : {inner_a, first_a, line_a};
    half_b_q <= s_is_pop ? stack_b : {inner_b, first_b, line_b};
    number_q <= s_is_pop ? lowest_number : best_number;
    push_waiting_q <= s_is_pop | onward ? rest_waiting : waiting;
    push_strong_q <= s_is_pop | onward ? rest_strong : overlapping | best;
    work_q         <= s_is_start ? (busy ? s_work : {{WORK_W - 1{1'b0}}, start_ok}) :
        s_work + more + one_more - one_less;
    entries_q      <= s_is_start ? {STACK_W + 1{1'b0}} : push ? entries + ONE_ENTRY :
        s_is_pop & ~rest ? entries - ONE_ENTRY : entries;
    at_q <= entries[STACK_W-1:0] - (s_is_pop ? ONE_ENTRY[STACK_W-1:0] : {STACK_W{1'b0}});
    under_q        <= s_is_start ? 3'd1 : s_is_pop ? under + 3'd1 :
        s_is_verdict & s_live & ~goes ? under - 3'd1 : under;
    steps_q <= s_is_start ? 32'd0 : steps + {31'd0, step};
    pairs_q        <= s_is_start ? 32'd0 :
        counts ? pairs + {29'd0, result_hits} + {29'd0, result_open} : pairs;
    opens_q <= s_is_start ? 8'd0 : ~counts ? opens : opens_now[8] ? 8'd255 : opens_now[7:0];
    hit_q <= ~s_is_start & (hit | (counts & |result_hits));
    mode_q <= s_is_start ? query_mode : mode;
    now_q <= now;
    epoch_q <= s_epoch;
    constants_q <= s_is_start ? query_constants : s_constants;
    leaf_nodes_q <= {
      kinds_b, {8'd0, first_b} + s_constants[63:32], kinds_a, {8'd0, first_a} + s_constants[31:0]
    };
    leaf_set_q <= box_leaves;
  end

  // ---- the second clock: the child pair's lines; is the query at its end?
  wire ends = bad_q | (live_q & (fails_q | (~|work_q & ~|entries_q)));
  wire still = active_q & ~ends;
  wire [1:0] next_epoch = now_q + {1'b0, ends};
  // a child that is a leaf goes on with its parent's line and a mask of one child
  wire [23:0] child_a, parent_a, child_b, parent_b;
  wire [3:0] is_inner_a, is_inner_b;
  assign {is_inner_a, child_a, parent_a} = half_a_q;
  assign {is_inner_b, child_b, parent_b} = half_b_q;
  wire [1:0] i = number_q[3:2];
  wire [1:0] j = number_q[1:0];
  wire [27:0] next_a = roots_q ? {4'd15, child_a} :
      is_inner_a[i] ? {4'd15, child_a + {22'd0, i}} : {4'd1 << i, parent_a};
  wire [27:0] next_b = roots_q ? {4'd15, child_b} :
      is_inner_b[j] ? {4'd15, child_b + {22'd0, j}} : {4'd1 << j, parent_b};
  // a FIRST query with pairs of leaves out, one of which may end it, asks for half as much
  wire hopes = live_q && ~mode_q && work_q != {{WORK_W - 3{1'b0}}, under_q};
  wire [2:0] most = hopes ? {1'b0, pairs_each[2:1]} : pairs_each | {2'd0, ~|pairs_each};

  reg out_active_q, out_wants_q, out_start_q, out_cancel_q, out_started_q, out_goes_q, out_back_q;
  reg out_push_q, out_leaf_q, out_ends_q, out_step_q;
  reg [1:0] out_room_q;
  reg [STACK_W+80:0] out_state_q;
  wire valid = valid_q & ~rst;
  reg [95:0] out_constants_q;
  reg [WORK_W-1:0] out_work_q;
  reg [58:0] out_record_q;
  reg [STACK_W-1:0] out_at_q;
  reg [135:0] out_entry_q;
  reg [79:0] out_leaf_nodes_q;
  reg [15:0] out_leaf_set_q;
  reg [68:0] out_answer_q;
  reg [4:0] out_tests_q;
  always @(posedge clk) begin
    out_start_q <= valid & start_q;
    out_cancel_q <= valid & cancel_q;
    out_started_q <= valid & start_q & goes_q;
    out_goes_q <= valid & goes_q & ~ends;
    out_back_q <= valid & back_q;
    out_push_q <= valid & push_q;
    out_leaf_q <= valid & leaf_q;
    out_ends_q <= valid & ends;
    out_step_q <= valid & step_q;
    out_room_q <= valid ? room_q : 2'd0;
    out_active_q <= valid & still;
    out_wants_q <= valid && still && entries_q != {STACK_W + 1{1'b0}} && under_q < most;
    out_state_q <= {
      next_epoch, still, mode_q, entries_q, under_q, steps_q, pairs_q, opens_q, hit_q
    };
    out_work_q <= work_q;
    out_constants_q <= constants_q;
    out_record_q <= start_q ? {1'b1, next_epoch, 56'd0} : {1'b0, epoch_q, next_b, next_a};
    out_at_q <= at_q;
    out_entry_q <= {push_strong_q, push_waiting_q, half_b_q, half_a_q};
    out_leaf_nodes_q <= leaf_nodes_q;
    out_leaf_set_q <= leaf_set_q;
    out_answer_q <= {
      bad_q ? END_BAD_DESCRIPTOR : fails_q ? code_q : END_OK,
      hit_q ? 2'd1 : |opens_q ? 2'd2 : 2'd0,
      steps_q,
      pairs_q
    };
    out_tests_q <= valid & step_q ? tests_q : 5'd0;
  end
  assign m_state      = out_state_q;
  assign m_constants  = out_constants_q;
  assign m_work       = out_work_q;
  assign m_active     = out_active_q;
  assign m_wants      = out_wants_q;
  assign m_start      = out_start_q;
  assign m_cancel     = out_cancel_q;
  assign m_started    = out_started_q;
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
  wire unused = &{1'b0, unused_epoch, unused_children_a, unused_children_b};

endmodule
`default_nettype wire
