// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_vertex_transform: the vertices of a leaf pair relative to the origin of B's leaf:
// those of A moved by the map of the query, M o_A + t - o_B and M times the offset of a vertex,
// each exact and rounded once; those of B in the same unit.
//   order        primitive 0 of A with 0, then 1 of B, then 1 of A with 0 and 1 of B; a vertex of
//                each at a time, 3 a pair or with a quad 4, where a triangle's last one comes twice
//   latency      CCHIP_VERTEX_TRANSFORM_LATENCY(PASSES) clocks from s_valid to the first vertex
//   throughput   a leaf pair every PASSES (1 + vertices) clocks, from its first pair of
//                primitives to the last without a gap; a corrupt one every 2 clocks
//   s_valid      until s_ready, nothing of s_* changes; a leaf pair begins while room = 1
//   numbers      units of the leaf pair, two's complement (docs/hardware/image.md)
//   multipliers  36 blocks of 18x18 bit, with PASSES = 2 half as many
//   reset        what is inside is dropped
// Bit for bit model::move_leaves.
module cchip_vertex_transform #(
    // a vertex; 1 takes 36 multiplier blocks of 18x18 bit, 2 takes 18 (clock); legal: 1, 2
    parameter integer PASSES = 1
) (
    input  wire          clk,          // clock, rising edge
    input  wire          rst,          // synchronous reset, active high
    input  wire          s_valid,      // a leaf pair; nothing of s_* changes until s_ready
    output wire          s_ready,      // it is taken
    // ---- map of the query
    input  wire [ 287:0] s_m,          // M of its query, 30 fraction bits, row by row
    input  wire [ 107:0] s_t,          // t, 32 fraction bits
    input  wire [   3:0] s_shift,      // the map is M 2^-shift
    input  wire [  11:0] s_error,      // bound on the error of a position, 2^-38
    // ---- leaves (docs/hardware/image.md)
    // kinds of the leaves, {B's, A's}: 1 triangle, 2 two triangles, 3 quad
    input  wire [   3:0] s_kinds,
    input  wire [1023:0] s_lines,      // the leaves, {B's, A's} (image.md, docs/hardware/image.md)
    input  wire          room,         // a leaf pair may begin
    output wire          corrupt,  // with s_ready: an extent is over 24, so there are no vertices
    // ---- a pair of primitives begins: its vertices come in CCHIP_VERTEX_LAUNCH clocks
    output wire          launch,       // a pair of primitives begins
    // which primitive, {A's, B's}; s_* are still those of its leaves
    output wire [   1:0] launch_pair,
    // ---- vertices
    output wire          m_valid,      // a vertex of A and one of B
    output wire          m_first,      // the first of a pair of primitives
    output wire          m_last,       // its last
    output wire [ 134:0] m_a,          // vertex of A, 3 x 45 bit, x lowest; units of the leaf pair
    output wire [  74:0] m_b,          // vertex of B, 3 x 25 bit
    // rounding lost a bit: {vertex of B, vertex of A, origin of A's leaf}
    output wire [   2:0] m_lost,
    // bound on twice the error of a vertex of A, in units, less its flags of m_lost
    output wire [  15:0] m_error_a,
    output wire [   5:0] m_error_b,    // the same of B
    output wire          m_open        // a leaf says that no answer is definite
);

  localparam [1:0] QUAD = 2'd3;
  localparam [4:0] EXTENT_MAX = 5'd24;
  // Clocks from the last pass of a vertex to its output
  localparam integer OUT = PASSES == 1 ? 15 : 14;

  `CCHIP_REFUSE(PASSES < 1 || PASSES > 2, cchip_error_PASSES_must_be_1_or_2)
  // the clocks below are counted for a leaf of two
  `CCHIP_REFUSE(`CCHIP_MUL18_LATENCY != 2, cchip_error_vertex_transform_needs_CCHIP_MUL18_LATENCY_2)

  wire [511:0] line_a = s_lines[511:0];
  wire [511:0] line_b = s_lines[1023:512];
  wire [4:0] extent_a = line_a[`CCHIP_LEAF_LINE_EXTENT];
  wire [4:0] extent_b = line_b[`CCHIP_LEAF_LINE_EXTENT];
  wire [1:0] quads = {s_kinds[3:2] == QUAD, s_kinds[1:0] == QUAD};

  // ---- which vertex: origin of A's leaf, then pair by pair
  wire [71:0] factor, offset_b1;
  wire pass, origin1, valid1, first1, last1;
  cchip_leaf_sequencer #(.PASSES(PASSES)) u_sequencer (
      .clk        (clk),
      .rst        (rst),
      .s_valid    (s_valid),
      .s_ready    (s_ready),
      .s_kinds    (s_kinds),
      .s_illegal  (extent_a > EXTENT_MAX || extent_b > EXTENT_MAX),
      .s_origin_a (line_a[`CCHIP_LEAF_LINE_ORIGIN]),
      .s_points_a (line_a[`CCHIP_LEAF_LINE_POINTS]),
      .s_points_b (line_b[`CCHIP_LEAF_LINE_POINTS]),
      .room       (room),
      .corrupt    (corrupt),
      .launch     (launch),
      .launch_pair(launch_pair),
      .m_factor   (factor),
      .m_pass     (pass),
      .m_offset_b (offset_b1),
      .m_origin   (origin1),
      .m_valid    (valid1),
      .m_first    (first1),
      .m_last     (last1)
  );

  // ---- clocks 1 to 7: M times it
  wire [55:0] moved7[0:2];
  genvar i, j;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_row
      if (PASSES == 1) begin : gen_whole
        cchip_dot3 #(.A_W(32), .B_W(24), .OPERAND_REGS(1)) u_dot (
            .clk(clk),
            .a  (s_m[96*i+:96]),
            .b  (factor),
            .q  (moved7[i])
        );
        wire unused_pass = &{1'b0, pass};
      end else begin : gen_halves
        // 25 bits, so that the sum of three lower halves fits
        wire [53:0] half;
        wire [74:0] wider;
        for (j = 0; j < 3; j = j + 1) begin : gen_component
          wire [31:0] entry = s_m[96*i+32*j+:32];
          assign half[18*j+:18]  = pass ? {{3{entry[31]}}, entry[31:17]} : {1'b0, entry[16:0]};
          assign wider[25*j+:25] = {factor[24*j+23], factor[24*j+:24]};
        end
        wire [42:0] sum;
        reg  [42:0] low_q;
        reg  [55:0] both_q;
        cchip_dot3 #(.A_W(18), .B_W(25), .OPERAND_REGS(1)) u_dot (
            .clk(clk),
            .a  (half),
            .b  (wider),
            .q  (sum)
        );
        always @(posedge clk) begin
          low_q  <= sum;
          both_q <= {{13{low_q[42]}}, low_q} + {sum[38:0], 17'd0};
        end
        assign moved7[i] = both_q;
        wire unused_sum = &{1'b0, sum[42:39]};
      end
    end
  endgenerate

  // ---- the unit, how far each leaf is above it, and the bounds on the errors
  wire [3:0] shift1;
  wire [4:0] cut_a4, cut_b4, fine4;
  cchip_leaf_unit #(.OUT(OUT)) u_unit (
      .clk       (clk),
      .s_shift   (s_shift),
      .s_error   (s_error),
      .s_extent_a(extent_a),
      .s_extent_b(extent_b),
      .s_quads   (quads),
      .s_rounded ({line_b[`CCHIP_LEAF_LINE_ROUNDED], line_a[`CCHIP_LEAF_LINE_ROUNDED]}),
      .s_open    (line_a[`CCHIP_LEAF_LINE_OPEN] | line_b[`CCHIP_LEAF_LINE_OPEN]),
      .m_shift   (shift1),
      .m_cut_a   (cut_a4),
      .m_cut_b   (cut_b4),
      .m_fine    (fine4),
      .m_error_a (m_error_a),
      .m_error_b (m_error_b),
      .m_open    (m_open)
  );

  // ---- clocks 8 to 15: origin of A's leaf
  wire [134:0] origin15;
  wire origin_lost15;
  cchip_leaf_origin u_origin (
      .clk       (clk),
      .rst       (rst),
      .s_origin  (origin1),
      .s_t       (s_t),
      .s_origin_b(line_b[`CCHIP_LEAF_LINE_ORIGIN]),
      .s_shift   (shift1),
      .s_fine    (fine4),
      .s_moved   ({moved7[2], moved7[1], moved7[0]}),
      .m_origin  (origin15),
      .m_lost    (origin_lost15)
  );

  // ---- clocks 8 to OUT: offsets in the unit, and the sum
  wire [4:0] cut_a7, cut_b;
  wire [71:0] offset_b;
  cchip_delay #(.WIDTH(5), .DEPTH(3)) u_cut_a (.clk(clk), .rst(1'b0), .d(cut_a4), .q(cut_a7));
  cchip_delay #(.WIDTH(5), .DEPTH(OUT - 7), .MEMORY(1)) u_cut_b (
      .clk(clk),
      .rst(1'b0),
      .d  (cut_b4),
      .q  (cut_b)
  );
  cchip_delay #(.WIDTH(72), .DEPTH(OUT - 4), .MEMORY(1)) u_offset_b (
      .clk(clk),
      .rst(1'b0),
      .d  (offset_b1),
      .q  (offset_b)
  );
  wire [2:0] lost_a, lost_b;
  reg [134:0] a_q;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      wire [27:0] rounded, offset_a;
      wire lost;
      cchip_round_shift #(
          .D_W      (56),
          .BASE     (29),
          .SHIFT_MAX(27),
          .Q_W      (28)
      ) u_a (
          .clk (clk),
          .d   (moved7[i]),
          .s   (cut_a7),
          .q   (rounded),
          .lost(lost)
      );
      cchip_delay #(.WIDTH(29), .DEPTH(OUT - 11), .MEMORY(1)) u_offset_a (
          .clk(clk),
          .rst(1'b0),
          .d  ({lost, rounded}),
          .q  ({lost_a[i], offset_a})
      );
      always @(posedge clk) a_q[45*i+:45] <= origin15[45*i+:45] + {{17{offset_a[27]}}, offset_a};
      cchip_round_shift #(
          .D_W      (25),
          .BASE     (0),
          .SHIFT_MAX(24),
          .Q_W      (25)
      ) u_b (
          .clk (clk),
          .d   ({offset_b[24*i+:24], 1'b0}),
          .s   (cut_b),
          .q   (m_b[25*i+:25]),
          .lost(lost_b[i])
      );
    end
  endgenerate
  reg [1:0] lost_q;
  always @(posedge clk) lost_q <= {|lost_a, origin_lost15};
  assign m_a = a_q;
  assign m_lost = {|lost_b, lost_q};
  cchip_delay #(.WIDTH(3), .DEPTH(OUT - 1), .RESET(1)) u_valid (
      .clk(clk),
      .rst(rst),
      .d  ({last1, first1, valid1}),
      .q  ({m_last, m_first, m_valid})
  );

  wire unused = &{1'b0, line_a[`CCHIP_LEAF_LINE_RESERVED], line_a[`CCHIP_LEAF_LINE_ID0],
                  line_a[`CCHIP_LEAF_LINE_ID1], line_a[`CCHIP_LEAF_LINE_RESERVED2],
                  line_b[`CCHIP_LEAF_LINE_RESERVED], line_b[`CCHIP_LEAF_LINE_ID0],
                  line_b[`CCHIP_LEAF_LINE_ID1], line_b[`CCHIP_LEAF_LINE_RESERVED2], lost_q};

endmodule
`default_nettype wire
