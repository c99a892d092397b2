// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
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
//   reset        drops the events inside. Without an event all outputs that say what happens
//                are 0
//   parameters   cchip_traversal checks them.
//   timing       All outputs three clocks after the event, but m_started after one.
//   numbers      The best child pair of a verdict continues in its parent's place if there is room
//                for its leaves; else all wait, it among the strong ones. From the stack the lowest
//                number goes, of the strong ones if there are some. A child that is a leaf
//                continues as its parent's line with a mask of one child. Any query ends with the
//                code of a line or of a result, with the step limit, with a full stack, and with 0
//                when nothing is in flight or on the stack. Events of a query that has ended change
//                the work of their epoch only.
//   why          One module decides everything about a query, from registers to registers: it can
//                be tested with any state, one event at a time.
module cchip_traversal_decision #(
    parameter integer STACK  = 64,  // entries of a query's stack (entry); legal: 8, 16, 32, 64
    // width of the count of what an epoch has in flight (bit); legal: 6..16
    parameter integer WORK_W = 12
) (
    input  wire                      clk,                    // clock, rising edge
    input  wire                      rst,                    // synchronous reset, active high
    // node pairs of a query that may be in flight, 0..7; 0 counts as 1; half of it for a query for
    // the first hit with leaf pairs out
    input  wire [               2:0] pairs_each,
    // open pairs after which a query for the first hit ends with code host, 0..255; 0 counts as 1
    input  wire [               7:0] open_limit,
    input  wire                      s_valid,                // an event, one of four
    input  wire                      s_is_verdict,           // a verdict on a node pair
    input  wire                      s_is_result,            // a result of a leaf pair
    input  wire                      s_is_start,             // a query starts
    input  wire                      s_is_pop,               // a node pair leaves the stack
    input  wire [               1:0] s_epoch,                // its epoch
    input  wire                      s_live,                 // its query is still in flight
    // ---- the query: records QUERY_STATE and QUERY_LINES
    // {epoch, has a query, mode, entries of the stack, node pairs in flight, steps, hits and open
    // pairs, open pairs, hit}
    input  wire [$clog2(STACK)+80:0] s_state,
    input  wire [`CCHIP_QUERY_LINES_W-1:0] s_constants,      // {tag, line of B, line of A}
    input  wire [        WORK_W-1:0] s_work,  // node pairs and leaf pairs of the epoch
    input  wire                      s_over,                 // steps are at their limit
    input  wire                      s_full,                 // the stack is full
    // ---- a verdict: record BOX_VERDICT
    input  wire [`CCHIP_BOX_VERDICT_W-1:0] s_verdict,  // {tests, best, strong, leaves, waiting}
    input  wire                      s_some_wait,            // waiting is not 0
    input  wire                      s_rest,                 // nor is it without the best
    input  wire                      s_some_leaves,          // leaves is not 0
    input  wire [               4:0] s_leaves,               // how many
    input  wire                      s_extra,  // it has further room in the leaf queue
    // there is room for its leaves and those of the next one
    input  wire                      s_room,
    // ---- its node pair, and what the lines say: records NODE_PAIR and NODES
    input  wire [`CCHIP_NODE_PAIR_W-1:0] s_record,  // the node pair, as m_record of cchip_traversal
    input  wire [`CCHIP_NODES_W-1:0] s_nodes,  // what its lines say, as lookup_nodes there
    input  wire                      s_failed,               // with a code
    input  wire [               8:0] s_result,               // {code, open pairs, definite hits}
    // ---- last of the stack: record STACK_ENTRY
    // last entry of the stack: {others wait besides the first, number of the child pair that a pop
    // takes first, strong, waiting, B, A}, of each {children that are nodes, first child, node}
    input  wire [`CCHIP_STACK_ENTRY_W-1:0] s_entry,
    // ---- the query that starts
    input  wire                      query_bad,              // of a start: the descriptor is bad
    input  wire                      query_mode,             // its mode
    input  wire [`CCHIP_QUERY_LINES_W-1:0] query_constants,  // {tag, line of B, line of A}
    // ---- what is written, and what comes of it
    output wire [$clog2(STACK)+80:0] m_state,                // the query afterwards
    output wire [`CCHIP_QUERY_LINES_W-1:0] m_constants,      // the same
    output wire [        WORK_W-1:0] m_work,                 // work of the epoch afterwards
    output wire                      m_active,               // the context has a query
    output wire                      m_wants,                // of whose stack a node pair may go
    output wire                      m_start,                // it was a start
    // whose context has work in flight; too early for this context
    output wire                      m_cancel,
    // that went well; a start that goes well, two clocks before
    output wire                      m_started,
    output wire                      m_goes,                 // a node pair goes to the box test
    output wire [`CCHIP_NODE_PAIR_W-1:0] m_record,           // this one
    output wire                      m_back,                 // the place is free
    output wire [               1:0] m_room,  // entries of the leaf queue that are free
    output wire                      m_push,                 // an entry is written
    output wire [ $clog2(STACK)-1:0] m_at,                   // there
    output wire [`CCHIP_STACK_ENTRY_W-1:0] m_entry,          // as s_entry
    output wire                      m_leaf,                 // leaf pairs
    // {kinds of B's children, line of the first, kinds of A's, line of the first}, lines from
    // address 0
    output wire [              79:0] m_leaf_nodes,
    output wire [              15:0] m_leaf_set,             // which pairs
    output wire                      m_ends,                 // the query ends
    // {code, answer, steps, pairs}; record QUERY_END
    output wire [`CCHIP_QUERY_END_W-1:0] m_answer,
    output wire                      m_step,                 // a node pair was expanded
    output wire [               4:0] m_tests                 // child pairs compared
);

  localparam integer STACK_W = $clog2(STACK);
  localparam integer NODE_W = `CCHIP_TREE_NODE_W;

  // ---- the first clock: which way the event takes
  wire [1:0] now;
  wire active, all, hit;
  wire [STACK_W:0] entries;
  wire [2:0] nodes;  // in flight
  wire [31:0] steps, pairs;
  wire [7:0] opens;
  assign `CCHIP_QUERY_STATE_OF(hit, opens, pairs, steps, nodes, entries, all, active, now) =
      s_state;
  wire [4:0] tests;
  wire [3:0] best_number;
  wire [15:0] box_strong, box_leaves, box_waiting;
  assign `CCHIP_BOX_VERDICT_OF(box_waiting, box_leaves, box_strong, best_number, tests) = s_verdict;
  wire header = s_record[`CCHIP_NODE_PAIR_HEADER];
  wire [7:0] kinds_a = s_nodes[`CCHIP_NODES_KINDS_A];
  wire [7:0] kinds_b = s_nodes[`CCHIP_NODES_KINDS_B];
  wire [2:0] result_code, result_open, result_hits;
  assign {result_code, result_open, result_hits} = s_result;

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
  reg active_q, all_q, hit_q;
  reg [1:0] now_q, epoch_q;
  reg [STACK_W:0] entries_q;
  reg [2:0] nodes_q;
  reg [31:0] steps_q, pairs_q;
  reg [8:0] opens_q;
  reg some_open_q;
  reg [`CCHIP_QUERY_LINES_W-1:0] constants_q;
  reg [WORK_W-1:0] work_q;
  // its node pair, or that of its leaf pair
  reg [NODE_W-1:0] node_a_q, node_b_q;
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
    push_q <= (push & ~s_full) | (s_is_pop & s_entry[`CCHIP_STACK_ENTRY_REST]);
    entry_more_q <= push;
    entry_less_q <= s_is_pop & ~s_entry[`CCHIP_STACK_ENTRY_REST];

    active_q <= s_is_start ? start_ok : active;
    all_q <= s_is_start ? query_mode : all;
    hit_q <= ~s_is_start & (hit | (counts & |result_hits));
    now_q <= now;
    epoch_q <= s_epoch;
    entries_q <= s_is_start ? {STACK_W + 1{1'b0}} : entries;
    nodes_q <= s_is_start ? 3'd1 : nodes;
    steps_q <= s_is_start ? 32'd0 : steps;
    pairs_q <= s_is_start ? 32'd0 : pairs;
    opens_q <= {1'b0, opens} + (counts ? {6'd0, result_open} : 9'd0);
    some_open_q <= |opens | |result_open;
    constants_q <= s_is_start ? query_constants : s_constants;
    work_q <= s_work;

    // the child pair that continues: of a verdict the best, from the stack the first
    number_q <= s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_FIRST] : best_number;
    waiting_q <= s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_WAITING] : box_waiting;
    strong_q <= s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_STRONG] : box_strong;
    node_a_q <= s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_A] :
        `CCHIP_TREE_NODE_OF(s_record[`CCHIP_NODE_PAIR_LINE_A], s_nodes[`CCHIP_NODES_FIRST_A],
            inner_a);
    node_b_q <= s_is_pop ? s_entry[`CCHIP_STACK_ENTRY_B] :
        `CCHIP_TREE_NODE_OF(s_record[`CCHIP_NODE_PAIR_LINE_B], s_nodes[`CCHIP_NODES_FIRST_B],
            inner_b);
    kinds_a_q <= kinds_a;
    kinds_b_q <= kinds_b;
    leaf_set_q <= box_leaves;
    leaves_q <= s_leaves;
    leaves_less_q <= s_leaves - 5'd1;
    tests_q <= tests;
    counted_q <= counts ? {1'b0, result_hits} + {1'b0, result_open} : 4'd0;
    some_code_q <= |result_code;
    some_hits_q <= |result_hits;
    code_q <= s_is_result ?
        (|result_code ? result_code : |result_hits ? `CCHIP_END_OK : `CCHIP_END_HOST) :
        s_failed ? s_nodes[`CCHIP_NODES_CODE] : spill ? `CCHIP_END_STACK : `CCHIP_END_STEPS;
  end

  // ---- the second clock: counts, the child pair's lines, what stays on the stack
  // a limit of 0 open pairs counts as 1
  wire first_hit = ~all_q & (some_hits_q | (some_open_q & opens_q >= {1'b0, open_limit}));
  // what the event adds to the work of its epoch, takes from the room in the leaf queue, changes of
  // the node pairs of its query in flight, and of the entries of the stack
  reg [WORK_W-1:0] more_work;
  reg [1:0] free_room;
  reg [2:0] nodes_next;
  always @* begin
    more_work  = {WORK_W{1'b0}};
    free_room  = 2'd0;
    nodes_next = nodes_q;
    if (verdict_q) begin
      // its leaf pairs come; the node pair goes, unless a child pair continues in its place
      more_work = leaf_q ? {{WORK_W - 5{1'b0}}, goes_q ? leaves_q : leaves_less_q} :
          {WORK_W{~goes_q}};
      free_room = 2'd1 + {1'b0, extra_q} - {1'b0, leaf_q} - {1'b0, goes_q};
      if (live_q && !goes_q) nodes_next = nodes_q - 3'd1;
    end else if (result_q) begin
      more_work = {WORK_W{1'b1}};
    end else begin  // a start or a pop
      more_work = {{WORK_W - 1{1'b0}}, goes_q};
      free_room = {1'b0, ~goes_q};
      if (pop_q) nodes_next = nodes_q + 3'd1;
    end
  end
  wire [15:0] chosen = 16'd1 << number_q;
  wire [15:0] kept_strong = clears_q ? strong_q & ~chosen : strong_q | chosen;
  wire [23:0] child_a = node_a_q[`CCHIP_TREE_NODE_FIRST];
  wire [23:0] child_b = node_b_q[`CCHIP_TREE_NODE_FIRST];
  wire [3:0] is_inner_a = node_a_q[`CCHIP_TREE_NODE_INNER];
  wire [3:0] is_inner_b = node_b_q[`CCHIP_TREE_NODE_INNER];
  wire [1:0] i = number_q[3:2];
  wire [1:0] j = number_q[1:0];

  reg valid_q2, start_q2, cancel_q2, goes_q2, back_q2, push_q2, leaf_q2, fails_q2, bad_q2, live_q2;
  reg step_q2, active_q2, all_q2, hit_q2, inner_a_q2, inner_b_q2, any_strong_q2;
  reg [1:0] room_q2, now_q2, epoch_q2;
  reg [23:0] child_a_q2, child_b_q2;
  reg [3:0] one_a_q2, one_b_q2;
  reg [NODE_W-1:0] node_a_q2, node_b_q2;
  reg [15:0] waiting_q2, strong_q2, leaf_set_q2;
  reg [2:0] code_q2, nodes_q2;
  reg [WORK_W-1:0] work_q2;
  reg [STACK_W:0] entries_q2;
  reg [STACK_W-1:0] at_q2;
  reg [31:0] steps_q2, pairs_q2;
  reg [7:0] opens_q2;
  reg [`CCHIP_QUERY_LINES_W-1:0] constants_q2;
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
    all_q2 <= all_q;
    hit_q2 <= hit_q;
    room_q2 <= free_room;
    now_q2 <= now_q;
    epoch_q2 <= epoch_q;
    inner_a_q2 <= roots_q | is_inner_a[i];
    inner_b_q2 <= roots_q | is_inner_b[j];
    child_a_q2 <= child_a + {22'd0, i & ~{2{roots_q}}};
    child_b_q2 <= child_b + {22'd0, j & ~{2{roots_q}}};
    one_a_q2 <= 4'd1 << i;
    one_b_q2 <= 4'd1 << j;
    node_a_q2 <= node_a_q;
    node_b_q2 <= node_b_q;
    waiting_q2 <= waiting_q & ~(chosen & {16{clears_q}});
    strong_q2 <= kept_strong;
    any_strong_q2 <= |kept_strong;
    leaf_set_q2 <= leaf_set_q;
    code_q2 <= code_q;
    nodes_q2 <= nodes_next;
    work_q2 <= work_q + more_work;
    entries_q2 <= entries_q + ({STACK_W + 1{entry_less_q}} | {{STACK_W{1'b0}}, entry_more_q});
    at_q2 <= entries_q[STACK_W-1:0] - {{STACK_W - 1{1'b0}}, pop_q};
    steps_q2 <= steps_q + {31'd0, step_q};
    pairs_q2 <= pairs_q + {28'd0, counted_q};
    opens_q2 <= start_q ? 8'd0 : opens_q[8] ? 8'd255 : opens_q[7:0];
    constants_q2 <= constants_q;
    leaf_nodes_q2 <= {
      kinds_b_q, {8'd0, child_b} + constants_q[`CCHIP_QUERY_LINES_BASE_B],
      kinds_a_q, {8'd0, child_a} + constants_q[`CCHIP_QUERY_LINES_BASE_A]
    };
    tests_q2 <= tests_q;
  end

  // ---- the third clock: is the query at its end, and what will a pop take first?
  wire ends = bad_q2 | (live_q2 & (fails_q2 | (~|work_q2 & ~|entries_q2)));
  wire still = active_q2 & ~ends;
  wire [1:0] next_epoch = now_q2 + {1'b0, ends};
  // a child that is a leaf continues with its parent's line and a mask of one child
  wire [23:0] line_a = inner_a_q2 ? child_a_q2 : node_a_q2[`CCHIP_TREE_NODE_LINE];
  wire [23:0] line_b = inner_b_q2 ? child_b_q2 : node_b_q2[`CCHIP_TREE_NODE_LINE];
  wire [3:0] children_a = inner_a_q2 ? 4'd15 : one_a_q2;
  wire [3:0] children_b = inner_b_q2 ? 4'd15 : one_b_q2;
  // While a leaf pair in flight may end a FIRST query, keep half as many node pairs in flight: work
  // begun before its hit is known is wasted. Both comparisons are made: which one counts is known
  // late in the clock
  wire result_pending = live_q2 && ~all_q2 && work_q2 != {{WORK_W - 3{1'b0}}, nodes_q2};
  wire below_half = nodes_q2 < {1'b0, pairs_each[2:1]};
  wire below_all = nodes_q2 < (pairs_each | {2'd0, ~|pairs_each});
  // strong child pairs first, of these the lowest number
  wire [3:0] first;
  wire first_rest;
  wire [15:0] unused_rest, unused_waiting;
  wire unused_several;
  wire [3:0] unused_first;
  cchip_first_pair u_first (
      .pairs  (any_strong_q2 ? strong_q2 : waiting_q2),
      .first  (first),
      .rest   (unused_rest),
      .several(unused_several)
  );
  cchip_first_pair u_others (
      .pairs  (waiting_q2),
      .first  (unused_first),
      .rest   (unused_waiting),
      .several(first_rest)
  );

  reg out_active_q, out_wants_q, out_start_q, out_cancel_q, out_goes_q, out_back_q;
  reg out_push_q, out_leaf_q, out_ends_q, out_step_q;
  reg [1:0] out_room_q;
  reg [STACK_W+80:0] out_state_q;
  wire valid = valid_q2 & ~rst;
  reg [`CCHIP_QUERY_LINES_W-1:0] out_constants_q;
  reg [WORK_W-1:0] out_work_q;
  reg [`CCHIP_NODE_PAIR_W-1:0] out_record_q;
  reg [STACK_W-1:0] out_at_q;
  reg [`CCHIP_STACK_ENTRY_W-1:0] out_entry_q;
  reg [79:0] out_leaf_nodes_q;
  reg [15:0] out_leaf_set_q;
  reg [`CCHIP_QUERY_END_W-1:0] out_answer_q;
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
    out_wants_q <= valid && still && |entries_q2 && (result_pending ? below_half : below_all);
    out_state_q <= `CCHIP_QUERY_STATE_OF(hit_q2, opens_q2, pairs_q2, steps_q2, nodes_q2,
        entries_q2, all_q2, still, next_epoch);
    out_work_q <= work_q2;
    out_constants_q <= constants_q2;
    out_record_q <= start_q2 ?
        `CCHIP_NODE_PAIR_OF(24'd0, 4'd0, 24'd0, 4'd0, next_epoch, 1'b1) :
        `CCHIP_NODE_PAIR_OF(line_a, children_a, line_b, children_b, epoch_q2, 1'b0);
    out_at_q <= at_q2;
    out_entry_q <= `CCHIP_STACK_ENTRY_OF(node_a_q2, node_b_q2, waiting_q2, strong_q2, first,
        first_rest);
    out_leaf_nodes_q <= leaf_nodes_q2;
    out_leaf_set_q <= leaf_set_q2;
    out_answer_q <= `CCHIP_QUERY_END_OF(pairs_q2, steps_q2,
        hit_q2 ? `CCHIP_QUERY_ANSWER_YES : |opens_q2 ? `CCHIP_QUERY_ANSWER_OPEN :
            `CCHIP_QUERY_ANSWER_NO,
        bad_q2 ? `CCHIP_END_BAD_DESCRIPTOR : fails_q2 ? code_q2 : `CCHIP_END_OK);
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
  wire unused = &{1'b0, s_record, s_nodes[`CCHIP_NODES_CODE], unused_rest, unused_waiting,
                  unused_several, unused_first};

endmodule
`default_nettype wire
