// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_bv_feed: takes the lines of node pairs and hands their parts to the box test, each at its
// clock: the pose's rows and the origins to cchip_bv_offset, then child after child to the lanes.
//   rule         position 0, 1, 2, ... of a node are its children that count, in their order; if
//                there are less than four, one that does not count comes last
//   beats        s_a and s_b are the lower halves of the lines on the first clock of a node pair,
//                the upper ones on the second; all else of s_ stays until s_ready
//   throughput   a node pair in max(3, children that count) clocks
//   latency      clocks from the first one of a node pair are in the names: x10 comes 10 after it
//   memory       block RAM keeps the children until the lanes take them
//   cuts         every path but s_valid to s_soon, and the context to row_context0, which a block
//                RAM takes
//   reset        drops the node pairs
//   ports        A number in a name: clocks after the first one of its node pair; what belongs to a
//                child comes that much later again as the child has a position, 0..3.
//   timing       A node pair of at most three children on each side that count takes three clocks,
//                any other four; s_ready, a register, is high on the last one. Lines are read on
//                all of these clocks.
//   inside       Two cchip_block_ram of 16 node pairs, written four words at once, for the children
//                of A and of B; one for tags. A chain of registers carries the first and the last
//                clock of each node pair.
//   why          cchip_bv_offset needs eight clocks before the lanes can start. Children that wait
//                in block RAM cost no flip-flops, and since its port for writing is four words
//                wide, no multiplexers.
module cchip_bv_feed #(
    // queries in flight, each with a pose (query); legal: 2, 4, 8, 16
    parameter integer QUERIES = 16,
    parameter integer TAG_W = 5      // width of the tag (bit); legal: >= 1
) (
    input  wire                       clk,            // clock, rising edge
    input  wire                       rst,            // synchronous reset, active high
    // ---- a node pair; s_soon tells of s_ready a clock ahead
    input  wire                       s_valid,        // a node pair
    // on the last of its clocks; all that belongs to it stays until then
    output wire                       s_ready,
    output wire                       s_soon,         // s_ready on the next clock
    input  wire [          TAG_W-1:0] s_tag,  // any number, which comes back with the verdict
    input  wire [$clog2(QUERIES)-1:0] s_context,      // query whose pose relates the two
    // half of the line of the node of A (image.md, docs/hardware/image.md, "Inner node"): the lower
    // one on the first clock of a node pair, the upper one on the second
    input  wire [              255:0] s_a,
    input  wire [              255:0] s_b,            // the same of the node of B
    // children of A that count; bits beyond its children are ignored
    input  wire [                3:0] s_a_children,
    input  wire [                3:0] s_b_children,   // the same of B
    // ---- for the pose and cchip_bv_offset
    output wire [$clog2(QUERIES)-1:0] row_context0,   // s_context
    output wire [                1:0] row0,           // row of M, 0, 1, 2
    output wire                       start2,  // first clock of a node pair for cchip_bv_offset
    output wire [               53:0] a_origin2,      // origin of A's node, for three clocks
    output wire [                4:0] a_step2,        // its step
    output wire [               53:0] b_origin2,      // origin of B's node
    output wire [                4:0] b_step2,        // its step
    output wire [$clog2(QUERIES)-1:0] lane_context8,  // s_context, later
    // ---- for the lanes: one child after the other
    output wire [              101:0] a_child10,      // a child of A, as it is stored
    output wire [                3:0] a_about10,      // {number, inner, counts}
    output wire                       a_coarse11,     // its node's cut exponent is 3
    output wire [              101:0] b_child13,      // a child of B
    output wire [                3:0] b_about13,      // {number, inner, counts}
    output wire                       b_coarse13,     // its node's cut exponent is 3
    // ---- for the choice
    output wire                       first18,        // first clock of a node pair, later
    output wire                       last18,         // last clock of a node pair, later
    output wire                       first29,        // first clock, later
    output wire                       last30,         // last clock, later: the clock of the verdict
    output wire [          TAG_W-1:0] tag30,          // with last30: tag of that node pair
    output wire [                4:0] tests30         // with last30: child pairs that count
);

  localparam integer CONTEXT_W = $clog2(QUERIES);

  // ---- clocks of a node pair
  reg [1:0] count_q;  // 0, 1, 2, and 3 if there are four children that count
  reg first_beat_q;  // count_q is 0
  reg ready_q, four_q;
  wire [3:0] a_counts, b_counts;
  wire [7:0] a_inner;  // and of B
  assign s_ready = ready_q;
  assign s_soon  = s_valid && (count_q == 2'd1 ? !four_q : count_q == 2'd2 && !ready_q);
  wire taken = s_valid & ready_q;
  always @(posedge clk) begin
    four_q <= &a_counts | &b_counts;
    if (rst) begin
      count_q      <= 2'd0;
      first_beat_q <= 1'b1;
      ready_q      <= 1'b0;
    end else begin
      if (s_valid) count_q <= ready_q ? 2'd0 : count_q + 2'd1;
      if (s_valid) first_beat_q <= ready_q;
      ready_q <= s_soon;
    end
  end

  // ---- the first beat, and what is known from it, for the other clocks
  // children of a node, from their number - 1
  function [3:0] there(input [1:0] last);
    there = {last == 2'd3, last[1], last != 2'd0, 1'b1};
  endfunction
  assign a_counts = s_a_children & there(s_a[`CCHIP_NODE_LINE_CHILDREN]);
  assign b_counts = s_b_children & there(s_b[`CCHIP_NODE_LINE_CHILDREN]);
  reg [255:0] a_first_q, b_first_q;
  reg [3:0] a_counts_q1, b_counts_q1;
  always @(posedge clk)
    if (first_beat_q) begin
      a_first_q   <= s_a;
      b_first_q   <= s_b;
      a_counts_q1 <= a_counts;
      b_counts_q1 <= b_counts;
    end
  wire [7:0] kinds_a = a_first_q[`CCHIP_NODE_LINE_KINDS];
  wire [7:0] kinds_b = b_first_q[`CCHIP_NODE_LINE_KINDS];
  genvar i, j;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_child
      assign a_inner[i]   = kinds_a[2*i+:2] == 2'd0;
      assign a_inner[4+i] = kinds_b[2*i+:2] == 2'd0;
    end
  endgenerate

  // ---- the first and the last clock of each node pair, later
  localparam integer LATEST = 30;
  reg [LATEST-1:1] first_q;
  reg [LATEST:1] last_q;
  always @(posedge clk) begin
    if (rst) begin
      first_q <= {LATEST - 1{1'b0}};
      last_q  <= {LATEST{1'b0}};
    end else begin
      first_q <= {first_q[LATEST-2:1], s_valid & first_beat_q};
      last_q  <= {last_q[LATEST-1:1], taken};
    end
  end
  assign first18 = first_q[18];
  assign last18  = last_q[18];
  assign first29 = first_q[29];
  assign last30  = last_q[30];

  // ---- origins
  reg [53:0] a_origin_q2, b_origin_q2;
  reg [4:0] a_step_q2, b_step_q2;
  always @(posedge clk)
    if (first_q[1]) begin
      a_step_q2   <= a_first_q[`CCHIP_NODE_LINE_STEP];
      a_origin_q2 <= a_first_q[`CCHIP_NODE_LINE_ORIGIN];
      b_step_q2   <= b_first_q[`CCHIP_NODE_LINE_STEP];
      b_origin_q2 <= b_first_q[`CCHIP_NODE_LINE_ORIGIN];
    end
  assign a_origin2    = a_origin_q2;
  assign a_step2      = a_step_q2;
  assign b_origin2    = b_origin_q2;
  assign b_step2      = b_step_q2;
  assign row_context0 = s_context;
  assign row0         = count_q;
  assign start2       = first_q[2];
  reg [8*CONTEXT_W-1:0] context_q;
  always @(posedge clk) context_q <= {context_q[7*CONTEXT_W-1:0], s_context};
  assign lane_context8 = context_q[7*CONTEXT_W+:CONTEXT_W];

  // ---- which child has a position: those before the first one that does not count, then those
  // behind it
  function [1:0] hole_of(input [2:0] counts);
    hole_of = !counts[0] ? 2'd0 : !counts[1] ? 2'd1 : !counts[2] ? 2'd2 : 2'd3;
  endfunction
  function [1:0] child_of(input [1:0] place, input [1:0] hole);
    child_of = place == 2'd3 ? hole : place + {1'b0, place >= hole};
  endfunction
  reg [1:0] place_q1, a_hole_q1, b_hole_q1;
  reg [11:0] a_number_q;  // from clock 2 to 7
  reg [17:0] b_number_q;  // to 10
  always @(posedge clk) begin
    place_q1   <= count_q;
    if (first_beat_q) a_hole_q1 <= hole_of(a_counts[2:0]);
    if (first_beat_q) b_hole_q1 <= hole_of(b_counts[2:0]);
    a_number_q <= {a_number_q[9:0], child_of(place_q1, a_hole_q1)};
    b_number_q <= {b_number_q[15:0], child_of(place_q1, b_hole_q1)};
  end

  // ---- children in memory: 16 node pairs, of which at most 5 wait for the lanes, 11 for a verdict
  reg [3:0] place_q, a_place_q7, b_place_q10, end_place_q28;
  always @(posedge clk) begin
    if (rst) begin
      place_q       <= 4'd0;
      a_place_q7    <= 4'd0;
      b_place_q10   <= 4'd0;
      end_place_q28 <= 4'd0;
    end else begin
      place_q       <= place_q + {3'd0, taken};
      a_place_q7    <= a_place_q7 + {3'd0, last_q[7]};
      b_place_q10   <= b_place_q10 + {3'd0, last_q[10]};
      end_place_q28 <= end_place_q28 + {3'd0, last_q[28]};
    end
  end

  localparam integer WORD_W = 107;
  wire [511:0] line_a = {s_a, a_first_q};
  wire [511:0] line_b = {s_b, b_first_q};
  wire [407:0] children_a = line_a[`CCHIP_NODE_LINE_CHILD];
  wire [407:0] children_b = line_b[`CCHIP_NODE_LINE_CHILD];
  wire [4*WORD_W-1:0] a_words, b_words;
  generate
    for (j = 0; j < 4; j = j + 1) begin : gen_word
      localparam [31:0] J = j;
      assign a_words[WORD_W*j+:WORD_W] = {
        a_first_q[`CCHIP_NODE_LINE_CUT_EXPONENT],
        J[1:0],
        a_inner[j],
        a_counts_q1[j],
        children_a[102*j+:102]
      };
      assign b_words[WORD_W*j+:WORD_W] = {
        b_first_q[`CCHIP_NODE_LINE_CUT_EXPONENT],
        J[1:0],
        a_inner[4+j],
        b_counts_q1[j],
        children_b[102*j+:102]
      };
    end
  endgenerate
  // from a block to the first logic it is far
  wire [WORD_W-1:0] a_word9, b_word12;
  reg [WORD_W-1:0] a_word_q10, b_word_q13;
  reg a_coarse_q11;
  always @(posedge clk) begin
    a_word_q10   <= a_word9;
    b_word_q13   <= b_word12;
    a_coarse_q11 <= a_word_q10[106];
  end
  assign a_child10  = a_word_q10[101:0];
  assign a_about10  = a_word_q10[105:102];
  assign a_coarse11 = a_coarse_q11;
  assign b_child13  = b_word_q13[101:0];
  assign b_about13  = b_word_q13[105:102];
  assign b_coarse13 = b_word_q13[106];
  cchip_block_ram #(.WIDTH(WORD_W), .WORDS(4), .ADDR_W(6)) u_a (
      .clk       (clk),
      .write     (first_q[1]),
      .write_addr(place_q),
      .write_data(a_words),
      .read_addr ({a_place_q7, a_number_q[11:10]}),
      .read_data (a_word9)
  );
  cchip_block_ram #(.WIDTH(WORD_W), .WORDS(4), .ADDR_W(6)) u_b (
      .clk       (clk),
      .write     (first_q[1]),
      .write_addr(place_q),
      .write_data(b_words),
      .read_addr ({b_place_q10, b_number_q[17:16]}),
      .read_data (b_word12)
  );

  // ---- tag and number of tests, which is right from the third clock on
  function [2:0] number_of(input [3:0] counts);
    number_of = {2'd0, counts[0]} + {2'd0, counts[1]} + {2'd0, counts[2]} + {2'd0, counts[3]};
  endfunction
  reg [2:0] a_number_of_q1, b_number_of_q1;
  reg [4:0] tests_q2;
  always @(posedge clk) begin
    if (first_beat_q) a_number_of_q1 <= number_of(a_counts);
    if (first_beat_q) b_number_of_q1 <= number_of(b_counts);
    // their product: as one it would take a multiplier block
    tests_q2       <= ({2'd0, a_number_of_q1} & {5{b_number_of_q1[0]}}) +
        ({1'd0, a_number_of_q1, 1'd0} & {5{b_number_of_q1[1]}}) +
        ({a_number_of_q1, 2'd0} & {5{b_number_of_q1[2]}});
  end
  cchip_block_ram #(.WIDTH(TAG_W + 5), .ADDR_W(4)) u_about (
      .clk       (clk),
      .write     (s_valid),
      .write_addr(place_q),
      .write_data({s_tag, tests_q2}),
      .read_addr (end_place_q28),
      .read_data ({tag30, tests30})
  );

  wire unused = &{1'b0, line_a, line_b};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_stays, s_valid || count_q == 2'd0)
    end

endmodule
`default_nettype wire
