// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_bv_unit: the whole box test: which children of a node of A may meet which children of a
// node of B, which of these child pairs go on, and which is the best of them.
//   latency      30 clocks from the clock of s_ready to the verdict; 21 clocks from a pose that is
//                accepted to m_pose_valid
//   throughput   a node pair every max(3, children of A that count, those of B) clocks, back to
//                back; a pose every 13 clocks, beside the node pairs
//   rule         a context's pose may be replaced when no node pair of it is without a verdict
//   cuts         every path but s_context to a block RAM; no ready from behind
//   reset        drops poses and node pairs in flight; poses in memory stay
// Bit for bit model::test_boxes and model::sort_children (docs/hardware/image.md, "Box test").
module cchip_bv_unit #(
    // queries in flight, each with a pose (query); legal: 2, 4, 8, 16
    parameter integer QUERIES = 16,
    parameter integer TAG_W = 5      // width of the tag (bit); legal: >= 1
) (
    input  wire                       clk,             // clock, rising edge
    input  wire                       rst,             // synchronous reset, active high
    input  wire                       s_pose_valid,    // the pose of a query
    output wire                       s_pose_ready,    // it is taken
    input  wire [$clog2(QUERIES)-1:0] s_pose_context,  // the query's number
    // M, 30 fraction bits, row by row; magnitudes at most 1
    input  wire [              287:0] s_pose_m,
    input  wire [              107:0] s_pose_t,        // t, 32 fraction bits
    input  wire [                3:0] s_pose_shift,    // the map is M 2^-shift
    // bound on the error of a position that the query's map gives, 2^-38
    input  wire [               11:0] s_pose_error,
    // a pose is in memory; node pairs of it may come from this clock on
    output wire                       m_pose_valid,
    output wire [$clog2(QUERIES)-1:0] m_pose_context,  // whose
    // ---- a node pair: lines of inner nodes, the lower halves on its first clock, the upper ones
    //      on the second; and which children count. All else stays until s_ready, which s_soon
    //      tells a clock ahead
    input  wire                       s_valid,         // a node pair
    // on the last of its clocks; all that belongs to it stays until then
    output wire                       s_ready,
    output wire                       s_soon,          // s_ready on the next clock
    input  wire [          TAG_W-1:0] s_tag,  // any number, which comes back with the verdict
    input  wire [$clog2(QUERIES)-1:0] s_context,       // query whose pose relates the two
    // half of the line of the node of A (image.md, docs/hardware/image.md, "Inner node"): the lower
    // one on the first clock of a node pair, the upper one on the second
    input  wire [              255:0] s_a,
    input  wire [              255:0] s_b,             // the same of the node of B
    // children of A that count; bits beyond its children are ignored
    input  wire [                3:0] s_a_children,
    input  wire [                3:0] s_b_children,    // the same of B
    // ---- its verdict; bit 4 i + j is child i of A with child j of B
    // a verdict, in the order of the node pairs; nothing waits for a receiver
    output wire                       m_valid,
    output wire [          TAG_W-1:0] m_tag,           // of its node pair
    // bit 4 i + j, child i of A and child j of B: both count, they overlap, and at least one is an
    // inner node
    output wire [               15:0] m_waiting,
    output wire [               15:0] m_leaves,  // both count, they overlap, and both are leaves
    output wire [               15:0] m_strong,  // of m_waiting, those with a key of 8 or more
    // of m_waiting, the number of the greatest key, the first of equals; any number if there is
    // none
    output wire [                3:0] m_best,
    output wire [                4:0] m_tests          // child pairs compared, 0..16
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  `CCHIP_REFUSE(TAG_W < 1, cchip_error_bv_unit_TAG_W_below_1)

  // ---- numbers in names: clocks from the first one of a node pair
  wire [CONTEXT_W-1:0] row_context0, lane_context8;
  wire [1:0] row0;
  wire start2, first18, last18, first29;
  wire [53:0] a_origin2, b_origin2;
  wire [4:0] a_step2, b_step2;
  wire [101:0] a_child10, b_child13;
  wire [3:0] a_about10, b_about13;
  wire a_coarse11, b_coarse13;
  cchip_bv_feed #(.QUERIES(QUERIES), .TAG_W(TAG_W)) u_feed (
      .clk          (clk),
      .rst          (rst),
      .s_valid      (s_valid),
      .s_ready      (s_ready),
      .s_soon       (s_soon),
      .s_tag        (s_tag),
      .s_context    (s_context),
      .s_a          (s_a),
      .s_b          (s_b),
      .s_a_children (s_a_children),
      .s_b_children (s_b_children),
      .row_context0 (row_context0),
      .row0         (row0),
      .start2       (start2),
      .a_origin2    (a_origin2),
      .a_step2      (a_step2),
      .b_origin2    (b_origin2),
      .b_step2      (b_step2),
      .lane_context8(lane_context8),
      .a_child10    (a_child10),
      .a_about10    (a_about10),
      .a_coarse11   (a_coarse11),
      .b_child13    (b_child13),
      .b_about13    (b_about13),
      .b_coarse13   (b_coarse13),
      .first18      (first18),
      .last18       (last18),
      .first29      (first29),
      .last30       (m_valid),
      .tag30        (m_tag),
      .tests30      (m_tests)
  );

  wire [56:0] row_m2;
  wire [28:0] row_t2;
  wire [3:0] shift2;
  wire [6:0] epsilon2;
  wire [90:0] pose_select11;
  wire [170:0] pose_m12;
  wire [389:0] pose_magnitude12;
  wire [181:0] pose_factor12;
  cchip_bv_pose #(.QUERIES(QUERIES)) u_pose (
      .clk           (clk),
      .rst           (rst),
      .s_pose_valid  (s_pose_valid),
      .s_pose_ready  (s_pose_ready),
      .s_pose_context(s_pose_context),
      .s_pose_m      (s_pose_m),
      .s_pose_t      (s_pose_t),
      .s_pose_shift  (s_pose_shift),
      .s_pose_error  (s_pose_error),
      .m_pose_valid  (m_pose_valid),
      .m_pose_context(m_pose_context),
      .row_context   (row_context0),
      .row           (row0),
      .row_m         (row_m2),
      .row_t         (row_t2),
      .shift         (shift2),
      .epsilon       (epsilon2),
      .lane_context  (lane_context8),
      .pose_select   (pose_select11),
      .pose_m        (pose_m12),
      .pose_magnitude(pose_magnitude12),
      .pose_factor   (pose_factor12)
  );

  // ---- the grid, and what it gives, later
  wire [1:0] a_scale7;
  wire [2:0] b_scale7;
  wire [7:0] slack11;
  wire [50:0] offset14;
  wire far14, near14;
  cchip_bv_offset u_offset (
      .clk     (clk),
      .start   (start2),
      .a_origin(a_origin2),
      .a_step  (a_step2),
      .b_origin(b_origin2),
      .b_step  (b_step2),
      .row_m   (row_m2),
      .row_t   (row_t2),
      .shift   (shift2),
      .epsilon (epsilon2),
      .a_scale (a_scale7),
      .b_scale (b_scale7),
      .slack   (slack11),
      .offset  (offset14),
      .is_far  (far14),
      .is_near (near14)
  );
  wire [1:0] a_scale10;
  wire [2:0] b_scale13;
  wire [7:0] slack14;
  cchip_delay #(.WIDTH(2), .DEPTH(3)) u_a_scale (.clk(clk), .rst(rst), .d(a_scale7), .q(a_scale10));
  cchip_delay #(.WIDTH(3), .DEPTH(6)) u_b_scale (.clk(clk), .rst(rst), .d(b_scale7), .q(b_scale13));
  cchip_delay #(.WIDTH(8), .DEPTH(3)) u_slack (.clk(clk), .rst(rst), .d(slack11), .q(slack14));

  // ---- lanes
  wire [331:0] a_planes19, b_planes18;
  cchip_bv_lane_a u_lane_a (
      .clk           (clk),
      .child         (a_child10),
      .scale         (a_scale10),
      .coarse        (a_coarse11),
      .pose_select   (pose_select11),
      .pose_m        (pose_m12),
      .pose_magnitude(pose_magnitude12),
      .pose_factor   (pose_factor12),
      .offset        (offset14),
      .planes        (a_planes19)
  );
  cchip_bv_lane_b u_lane_b (
      .clk   (clk),
      .child (b_child13),
      .scale (b_scale13),
      .coarse(b_coarse13),
      .slack (slack14),
      .planes(b_planes18)
  );

  // of the children: a node pair that is far has none that counts
  wire [3:0] a_about14, b_about18;
  cchip_delay #(.WIDTH(4), .DEPTH(4)) u_a_about4 (
      .clk(clk), .rst(rst), .d(a_about10), .q(a_about14)
  );
  wire [2:0] a_about19;  // {near, inner, counts}
  cchip_delay #(.WIDTH(3), .DEPTH(5)) u_a_about (
      .clk(clk), .rst(rst), .d({near14, a_about14[1], a_about14[0] & ~far14}), .q(a_about19)
  );
  wire [1:0] a_number29;
  cchip_delay #(.WIDTH(2), .DEPTH(15)) u_a_number (
      .clk(clk), .rst(rst), .d(a_about14[3:2]), .q(a_number29)
  );
  cchip_delay #(.WIDTH(4), .DEPTH(5)) u_b_about (
      .clk(clk), .rst(rst), .d(b_about13), .q(b_about18)
  );

  // ---- a cell for each position of a child of B; the last one is empty in node pairs of three
  // clocks
  wire [334:0] passed[0:4];
  wire [17:0] found[0:4];
  reg [3:1] load_q;
  always @(posedge clk) load_q <= {load_q[2:1], first18};
  wire [3:0] load = {load_q, first18};
  assign passed[0] = {a_about19, a_planes19};
  assign found[0]  = 18'd0;
  genvar j;
  generate
    for (j = 0; j < 4; j = j + 1) begin : gen_cell
      wire counts = b_about18[0] & (j == 3 ? last18 : 1'b1);
      cchip_bv_cell u_cell (
          .clk  (clk),
          .load (load[j]),
          .b    ({b_about18[3:1], counts, b_planes18}),
          .s_a  (passed[j]),
          .m_a  (passed[j+1]),
          .s_row(found[j]),
          .m_row(found[j+1])
      );
    end
  endgenerate

  // ---- the rows of the children of A together
  wire [17:0] row29 = found[4];
  reg [15:0] waiting_q30, leaves_q30, strong_q30;
  reg [3:0] key_q30, best_q30;
  reg some_q30;
  wire better29 = row29[3:0] != 4'd0 && (first29 || !some_q30 || row29[17:14] > key_q30);
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_row
      localparam [31:0] I = i;
      wire mine = a_number29 == I[1:0];
      always @(posedge clk)
        if (mine || first29) begin
          waiting_q30[4*i+:4] <= row29[3:0] & {4{mine}};
          leaves_q30[4*i+:4]  <= row29[7:4] & {4{mine}};
          strong_q30[4*i+:4]  <= row29[11:8] & {4{mine}};
        end
    end
  endgenerate
  always @(posedge clk) begin
    some_q30 <= row29[3:0] != 4'd0 || (some_q30 && !first29);
    if (better29) begin
      key_q30  <= row29[17:14];
      best_q30 <= {a_number29, row29[13:12]};
    end
  end
  assign m_waiting = waiting_q30;
  assign m_leaves  = leaves_q30;
  assign m_strong  = strong_q30;
  assign m_best    = best_q30;

  wire unused = &{1'b0, passed[4]};

endmodule
`default_nettype wire
