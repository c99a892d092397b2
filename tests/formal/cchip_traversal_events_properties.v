// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_traversal_events, with a pipeline of 7 clocks behind it that decides at will and a box test that answers at will:
//   lock      while an event of a query is in the pipeline none enters
//   places    a start or a node pair from a stack gets a place that no other has; a verdict has the place it came for, and the query
//             of that place
//   room      node pairs and entries of the leaf queue together never want more than the leaf queue has: a verdict always has room
//   once      each verdict and each result enters once; a query has one start in the pipeline
//   turns     a result enters within 18 clocks of the one before it, or of its coming, though verdicts keep coming; so does a verdict
//   continues   with nothing else to do and a place free, a query that waits starts within 12 clocks and a stack that wants to send a
//             node pair does within 12
// Assumed: an event leaves as cchip_traversal_decision lets it: it keeps or gives back its place and its room; verdicts are of
// places whose node pair is with the box test; an answer is taken after its query has ended.
module cchip_traversal_events_properties #(
    parameter integer QUERIES = 2,
    parameter integer PAIRS = 4,
    parameter integer LEAF_DEPTH = 4
) (
    input wire         clk,
    input wire         rst,
    input wire         s_query_valid,
    input wire [511:0] s_query,
    input wire         start_ready,
    input wire         s_verdict_valid,
    input wire [  1:0] verdict_place,
    input wire         s_result_valid,
    input wire [ 11:0] s_result,
    input wire         s_drop_valid,
    input wire         s_drop_context,
    input wire         goes_in,
    input wire         leaf_in,
    input wire         cancel_in,
    input wire         ends_in,
    input wire         wants_in,
    input wire         s_leaf_room,
    input wire         s_answer_room
);
  localparam integer STAGES = 7;
  wire s_query_ready, lookup, s_result_ready, s_drop_ready;
  wire [1:0] lookup_place;
  wire m_valid, m_is_verdict, m_is_result, m_is_start, m_is_pop, m_context, m_extra;
  wire [1:0] m_place;
  reg lookup_context_q;
  wire left_active, left_back;

  // ---- the pipeline
  reg [STAGES-1:0] valid_q, verdict_q, result_q, start_q, pop_q, context_q, extra_q;
  reg [2*STAGES-1:0] place_q;
  localparam integer LAST = STAGES - 1;
  wire left = valid_q[LAST];
  wire [1:0] left_place = place_q[2*LAST+:2];
  wire left_context = context_q[LAST];
  reg [QUERIES-1:0] active_q, wants_q;
  wire was_active = active_q[left_context];
  wire cancel = start_q[LAST] & cancel_in;
  wire goes = pop_q[LAST] | (start_q[LAST] & ~cancel & goes_in) | (verdict_q[LAST] & was_active & goes_in);
  wire [1:0] had_room = result_q[LAST] ? 2'd0 : 2'd1 + {1'b0, verdict_q[LAST] & extra_q[LAST]};
  wire leaf = verdict_q[LAST] & was_active & leaf_in & (had_room != {1'b0, goes});
  wire [1:0] left_room = had_room - {1'b0, goes} - {1'b0, leaf};
  assign left_back   = left & ~goes & ~result_q[LAST];
  assign left_active = start_q[LAST] ? goes : was_active & ~(ends_in & ~goes);
  wire left_wants = left_active & wants_in;
  wire answer = left & (start_q[LAST] ? ~cancel & ~goes : was_active & ~left_active);
  reg [2:0] answers_q;
  // ---- places: lent, with the box test, a verdict waits
  reg [PAIRS-1:0] lent_q, out_q, back_q, of_q;
  reg [2:0] leaves_q;
  wire [PAIRS-1:0] one = 1;
  wire [PAIRS-1:0] m_one = one << m_place;
  wire [PAIRS-1:0] left_one = one << left_place;
  wire [PAIRS-1:0] verdict_one = one << verdict_place;
  wire takes_place = m_valid & (m_is_start | m_is_pop);
  // a running number: results taken and not yet events
  reg [1:0] results_q;
  wire drop_taken = s_drop_valid & s_drop_ready;
  reg drop_taken_q;
  reg running_q, started_q;
  initial started_q = 1'b0;

  cchip_traversal_events #(
      .QUERIES   (QUERIES),
      .PAIRS     (PAIRS),
      .PLACE_W   (2),
      .LEAF_DEPTH(LEAF_DEPTH),
      .ANSWERS   (3)
  ) dut (
      .clk            (clk),
      .rst            (rst),
      .running        (running_q),
      .s_query_valid  (s_query_valid),
      .s_query_ready  (s_query_ready),
      .s_query        (s_query),
      .query          (),
      .query_bad      (),
      .start_ready    (start_ready),
      .s_verdict_valid(s_verdict_valid),
      .s_verdict      ({verdict_place, 57'd0}),
      .lookup         (lookup),
      .lookup_place   (lookup_place),
      .lookup_context (lookup_context_q),
      .lookup_epoch   (2'd0),
      .s_result_valid (s_result_valid),
      .s_result_ready (s_result_ready),
      .s_result       (s_result),
      .s_drop_valid   (s_drop_valid),
      .s_drop_ready   (s_drop_ready),
      .s_drop_context (s_drop_context),
      .s_drop_epoch   (2'd0),
      .m_valid        (m_valid),
      .m_verdict_event(m_is_verdict),
      .m_result_event (m_is_result),
      .m_start_event  (m_is_start),
      .m_pop_event    (m_is_pop),
      .m_context      (m_context),
      .m_epoch        (),
      .m_extra        (m_extra),
      .m_place        (m_place),
      .m_verdict      (),
      .m_result       (),
      .m_few          (),
      .s_leaving_valid(valid_q[LAST-2]),
      .s_leaving_context(context_q[LAST-2]),
      .s_left_valid   (left),
      .s_left_context (left_context),
      .s_left_active  (left_active),
      .s_left_wants   (left_wants),
      .s_left_start   (left & start_q[LAST]),
      .s_left_cancel  (left & cancel),
      .s_left_back    (left_back),
      .s_left_place   (left_place),
      .s_left_room    (left ? left_room : 2'd0),
      .s_leaf_room    (s_leaf_room),
      .s_answer_room  (s_answer_room)
  );

  reg query_q;  // a query waits
  reg [4:0] result_clocks_q, verdict_clocks_q;  // since one entered, while others wait
  reg [3:0] query_clocks_q, stack_clocks_q;  // for how long with nothing else to do
  wire quiet = ~|valid_q & ~m_valid & ~s_verdict_valid & ~|back_q & ~s_result_valid & results_q == 0 & ~s_drop_valid;
  wire free = ~&lent_q & total < LEAF_DEPTH & start_ready & answers_q == 0;
  always @(posedge clk) begin
    started_q <= 1'b1;
    running_q <= ~rst;
    {verdict_q, result_q, start_q, pop_q, context_q, extra_q} <= {
      verdict_q[LAST-1:0], m_is_verdict, result_q[LAST-1:0], m_is_result, start_q[LAST-1:0], m_is_start, pop_q[LAST-1:0],
      m_is_pop, context_q[LAST-1:0], m_context, extra_q[LAST-1:0], m_extra
    };
    place_q <= {place_q[2*LAST-1:0], m_place};
    if (lookup) lookup_context_q <= of_q[lookup_place];
    drop_taken_q <= ~rst & drop_taken;
    if (rst) begin
      valid_q        <= 0;
      active_q       <= 0;
      wants_q        <= 0;
      answers_q      <= 0;
      lent_q         <= 0;
      out_q          <= 0;
      back_q         <= 0;
      leaves_q       <= 0;
      results_q      <= 0;
      query_q        <= 1'b0;
      query_clocks_q <= 0;
      stack_clocks_q <= 0;
      result_clocks_q <= 0;
      verdict_clocks_q <= 0;
    end else begin
      result_clocks_q <= results_q == 0 || (m_valid && m_is_result && !drop_taken_q) ? 0 : result_clocks_q + 1;
      verdict_clocks_q <= back_q == 0 || (m_valid && m_is_verdict) ? 0 : verdict_clocks_q + 1;
      valid_q <= {valid_q[LAST-1:0], m_valid};
      if (left) begin
        active_q[left_context] <= left_active;
        wants_q[left_context]  <= left_wants;
      end
      answers_q <= answers_q + {2'd0, answer} - {2'd0, s_answer_room};
      lent_q    <= (lent_q | (takes_place ? m_one : 0)) & ~(left_back ? left_one : 0);
      out_q     <= (out_q | (left & goes ? left_one : 0)) & ~(s_verdict_valid ? verdict_one : 0);
      back_q    <= (back_q | (s_verdict_valid ? verdict_one : 0)) & ~(m_valid & m_is_verdict ? m_one : 0);
      if (left & goes) of_q[left_place] <= left_context;
      leaves_q  <= leaves_q + {2'd0, left & leaf} - {2'd0, s_leaf_room};
      results_q <= results_q + {1'b0, s_result_valid & s_result_ready} - {1'b0, m_valid & m_is_result & ~drop_taken_q};
      query_q   <= query_q ? ~(left & start_q[LAST] & ~cancel) : s_query_valid & s_query_ready;
      query_clocks_q <= quiet & free & query_q & ~&active_q & ~|wants_q ? query_clocks_q + 1 : 0;
      stack_clocks_q <= quiet & free & ~query_q & |wants_q ? stack_clocks_q + 1 : 0;
    end
  end

  // entries of the leaf queue that are spoken for; what is in the pipeline has its own
  reg [3:0] total;
  integer i;
  always @(*) begin
    total = {1'b0, leaves_q};
    for (i = 0; i < PAIRS; i = i + 1) total = total + {3'd0, out_q[i] | back_q[i]};
    for (i = 0; i < STAGES; i = i + 1)
      total = total + {3'd0, valid_q[i] & ~result_q[i]} + {3'd0, valid_q[i] & verdict_q[i] & extra_q[i]};
    // the verdict's own entry is counted with its place until it is an event
    total = total + {3'd0, m_valid & ~m_is_result & ~m_is_verdict} + {3'd0, m_valid & m_is_verdict & m_extra};
  end
  reg twice;
  always @(*) begin
    twice = 1'b0;
    for (i = 0; i < STAGES; i = i + 1) twice = twice | (valid_q[i] & (context_q[i] == m_context));
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (s_verdict_valid) assume (verdict_place < PAIRS && out_q[verdict_place] && !back_q[verdict_place]);
    if (s_leaf_room) assume (leaves_q != 0);
    if (s_answer_room) assume (answers_q != 0);
  end
  always @(posedge clk) if (started_q && !$past(rst) && $past(s_drop_valid && !s_drop_ready)) assume (s_drop_valid && $stable(s_drop_context));
  always @(*)
    if (started_q && !rst) begin
      lock: assert (!m_valid || !twice);
      one_kind: assert (!m_valid || {2'd0, m_is_verdict} + {2'd0, m_is_result} + {2'd0, m_is_start} + {2'd0, m_is_pop} == 3'd1);
      place: assert (!takes_place || (m_place < PAIRS && !lent_q[m_place]));
      verdict_place_known: assert (!(m_valid && m_is_verdict) || (back_q[m_place] && m_context == of_q[m_place]));
      room: assert (total <= LEAF_DEPTH);
      results: assert (!(m_valid && m_is_result && !drop_taken_q) || results_q != 0);
      results_inside: assert (results_q != 2'd3 || !s_result_ready);
      pop_wanted: assert (!(m_valid && m_is_pop) || wants_q[m_context]);
      start_once: assert (!(m_valid && m_is_start) || !(|(valid_q & start_q)));
      start_idle: assert (!(m_valid && m_is_start) || !active_q[m_context]);
      result_enters: assert (result_clocks_q <= 5'd18);
      verdict_enters: assert (verdict_clocks_q <= 5'd18);
      query_goes_on: assert (query_clocks_q < 4'd12);
      stack_goes_on: assert (stack_clocks_q < 4'd12);
    end
endmodule
`default_nettype wire
