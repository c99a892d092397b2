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
//   cuts         every path: each output is a flip-flop
//   reset        what is inside is dropped
// Bit for bit model::move_leaves.
module cchip_vertex_transform #(
    // clocks a vertex, 1 or 2
    parameter integer PASSES = 1
) (
    input  wire          clk,
    input  wire          rst,
    input  wire          s_valid,
    output wire          s_ready,
    // map of the query
    input  wire [ 287:0] s_m,          // 30 fraction bits, row by row
    input  wire [ 107:0] s_t,          // 32 fraction bits
    input  wire [   3:0] s_shift,      // M is M 2^-shift
    input  wire [  11:0] s_error,      // bound on the error of a position, 2^-38
    // leaves (docs/hardware/image.md)
    input  wire [   3:0] s_kinds,      // {B's, A's}
    input  wire [1023:0] s_lines,      // {B's, A's}
    input  wire          room,         // for the pairs of primitives of a leaf pair
    output wire          corrupt,      // with s_ready: an illegal extent, so there are no vertices
    // a pair of primitives begins: its vertices come in CCHIP_VERTEX_LAUNCH clocks
    output wire          launch,
    output wire [   1:0] launch_pair,  // {A's, B's}
    // vertices
    output wire          m_valid,
    output wire          m_first,
    output wire          m_last,
    output wire [ 134:0] m_a,          // 3 x 45 bit
    output wire [  74:0] m_b,          // 3 x 25 bit
    output wire [   2:0] m_lost,       // a rounding lost a bit: {vertex of B, of A, A's origin}
    output wire [  15:0] m_error_a,    // bound on twice the error of a vertex, less its m_lost
    output wire [   5:0] m_error_b,
    output wire          m_open        // no answer for this pair is definite
);

  localparam [1:0] TWO_TRIANGLES = 2'd2;
  localparam [1:0] QUAD = 2'd3;
  localparam [4:0] EXTENT_MAX = 5'd24;
  // Clocks from the last pass of a vertex to its output
  localparam integer OUT = PASSES == 1 ? 15 : 14;

  generate
    if (PASSES < 1 || PASSES > 2) begin : gen_illegal
      cchip_error_PASSES_must_be_1_or_2 u_error ();
    end
    // the clocks below are counted for a leaf of two
    if (`CCHIP_MUL18_LATENCY != 2) begin : gen_illegal_latency
      cchip_error_vertex_transform_needs_CCHIP_MUL18_LATENCY_2 u_error ();
    end
  endgenerate

  // ---- which vertex: origin of A's leaf, then pair by pair
  wire [511:0] line_a = s_lines[511:0];
  wire [511:0] line_b = s_lines[1023:512];
  wire [1:0] kind_a = s_kinds[1:0];
  wire [1:0] kind_b = s_kinds[3:2];
  wire [4:0] extent_a = line_a[76:72];
  wire [4:0] extent_b = line_b[76:72];
  wire four = kind_a == QUAD || kind_b == QUAD;
  wire [1:0] last_vertex = four ? 2'd3 : 2'd2;
  wire [1:0] last_pair = {kind_a == TWO_TRIANGLES, kind_b == TWO_TRIANGLES};
  wire illegal = extent_a > EXTENT_MAX || extent_b > EXTENT_MAX;
  reg started_q, pass_q, ready_q, corrupt_q;
  reg [1:0] vertex_q, pair_q;
  wire begins = ~started_q & s_valid & room & ~ready_q;
  wire works = started_q | pass_q | (begins & ~illegal);
  wire last_pass = PASSES == 1 || pass_q;
  wire ends_pair = started_q & vertex_q == last_vertex;
  reg [1:0] vertex_d, pair_d;
  wire pass_d = PASSES == 2 && works && !pass_q;
  wire started_d = (started_q | (works & last_pass)) & ~ready_q;
  always @* begin
    vertex_d = vertex_q;
    pair_d   = pair_q;
    if (!started_q || ready_q) begin
      vertex_d = 2'd0;
      pair_d   = 2'd0;
    end else if (last_pass) begin
      vertex_d = ends_pair ? 2'd0 : vertex_q + 2'd1;
      // {A's, B's}: B's is the faster one
      if (ends_pair) pair_d = {pair_q[1] | (pair_q[0] == last_pair[0]), last_pair[0] & ~pair_q[0]};
    end
  end
  always @(posedge clk) begin
    vertex_q <= vertex_d;
    pair_q <= pair_d;
    started_q <= ~rst & started_d;
    pass_q <= ~rst & pass_d;
    corrupt_q <= begins & illegal;
    ready_q   <= ~rst & ((begins & illegal) | (started_d & vertex_d == last_vertex &&
        pair_d == last_pair && (PASSES == 1 || pass_d)));
  end
  assign s_ready = ready_q;
  assign corrupt = corrupt_q;

  // ---- the vertex, into registers before the multipliers. Offsets of triangles get 24 bits, as
  // those of quads have
  function [71:0] offset(input [359:0] vertices, input quad, input [2:0] place);
    reg [59:0] triangle;
    reg [71:0] corner;
    begin
      case (place)
        3'd0: triangle = vertices[0+:60];
        3'd1: triangle = vertices[60+:60];
        3'd2: triangle = vertices[120+:60];
        3'd3: triangle = vertices[180+:60];
        3'd4: triangle = vertices[240+:60];
        default: triangle = vertices[300+:60];
      endcase
      case (place[1:0])
        2'd0: corner = vertices[0+:72];
        2'd1: corner = vertices[72+:72];
        2'd2: corner = vertices[144+:72];
        default: corner = vertices[216+:72];
      endcase
      offset = quad ? corner : {triangle[59:40], 4'd0, triangle[39:20], 4'd0, triangle[19:0], 4'd0};
    end
  endfunction
  // Places 0..2 of the first primitive, 3..5 of the second
  function [2:0] place_of(input [1:0] vertex, input quad, input second);
    place_of = {1'b0, !quad && vertex == 2'd3 ? 2'd2 : vertex} + (second ? 3'd3 : 3'd0);
  endfunction
  wire [2:0] place_a = place_of(vertex_q, kind_a == QUAD, pair_q[1]);
  wire [2:0] place_b = place_of(vertex_q, kind_b == QUAD, pair_q[0]);
  wire [71:0] factor = started_q ? offset(line_a[144+:360], kind_a == QUAD, place_a) : line_a[71:0];
  reg [71:0] offset_b_q;
  always @(posedge clk) offset_b_q <= offset(line_b[144+:360], kind_b == QUAD, place_b);
  reg origin_q1, launch_q1, valid_q1, first_q1, last_q1;
  reg [1:0] pair_q1;
  always @(posedge clk) begin
    origin_q1 <= ~rst & ~started_q & works & last_pass;
    valid_q1  <= ~rst & started_q & last_pass;
    launch_q1 <= ~rst & started_q & last_pass & vertex_q == 2'd0;
    first_q1  <= vertex_q == 2'd0;
    last_q1   <= ends_pair;
    pair_q1   <= pair_q;
  end
  assign launch = launch_q1;
  assign launch_pair = pair_q1;

  // ---- clocks 1 to 7: M times it
  wire [55:0] moved7[0:2];
  genvar i, j;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_row
      if (PASSES == 1) begin : gen_whole
        cchip_dot3 #(
            .A_W         (32),
            .B_W         (24),
            .OPERAND_REGS(1)
        ) u_dot (
            .clk(clk),
            .a  (s_m[96*i+:96]),
            .b  (factor),
            .q  (moved7[i])
        );
      end else begin : gen_halves
        // 25 bits, so that the sum of three lower halves fits
        wire [53:0] half;
        wire [74:0] wider;
        for (j = 0; j < 3; j = j + 1) begin : gen_component
          wire [31:0] entry = s_m[96*i+32*j+:32];
          assign half[18*j+:18]  = pass_q ? {{3{entry[31]}}, entry[31:17]} : {1'b0, entry[16:0]};
          assign wider[25*j+:25] = {factor[24*j+23], factor[24*j+:24]};
        end
        wire [42:0] sum;
        reg  [42:0] low_q;
        reg  [55:0] both_q;
        cchip_dot3 #(
            .A_W         (18),
            .B_W         (25),
            .OPERAND_REGS(1)
        ) u_dot (
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

  // ---- clocks 1 to 4: the unit, 2^(x - 48), and how far each leaf is above it
  reg signed [5:0] moved_extent_q2, moved_extent_q3;
  reg [4:0] extent_a_q1, extent_b_q1, extent_b_q2, extent_b_q3, x_q3, cut_a_q4, cut_b_q4, fine_q4;
  reg  [5:0] below_a_q4;
  reg  [3:0] shift_q1;
  reg  [4:0] greater_q2;  // of B's extent and 8
  wire [5:0] below_a3 = {1'b0, x_q3} - $unsigned(moved_extent_q3);
  wire [4:0] fine3 = x_q3 - 5'd8;
  always @(posedge clk) begin
    extent_a_q1 <= extent_a;
    extent_b_q1 <= extent_b;
    shift_q1 <= s_shift;
    moved_extent_q2 <= {1'b0, extent_a_q1} - {2'd0, shift_q1};
    extent_b_q2 <= extent_b_q1;
    greater_q2 <= extent_b_q1 > 5'd8 ? extent_b_q1 : 5'd8;
    moved_extent_q3 <= moved_extent_q2;
    extent_b_q3 <= extent_b_q2;
    x_q3 <= moved_extent_q2 > $signed({1'b0, greater_q2}) ? moved_extent_q2[4:0] : greater_q2;
    below_a_q4 <= below_a3;
    cut_a_q4 <= below_a3 > 6'd27 ? 5'd27 : below_a3[4:0];
    cut_b_q4 <= x_q3 - extent_b_q3;
    fine_q4 <= fine3;
  end

  // ---- clocks 1 to 7: errors. Twice that of the query, 2^(11 - x); twice the step of A's leaf,
  // because rows of |M| add up to less than 2; the step of B's leaf
  reg [3:0] flags_q1, flags_q2, flags_q3, flags_q4;  // {rounded B, A, quad B, A}
  reg [11:0] query_q1, query_q2, query_q3, query_q4;
  reg [14:0] query_q5, query_q6;
  reg [1:0] fine_q5;
  reg query_rest_q5, query_rest_q6;
  reg [6:0] step_a_q5, step_a_q6;
  reg  [ 5:0] step_b_q5;
  reg  [15:0] error_a_q7;
  reg  [ 3:0] open_q;
  wire [14:0] query4 = {query_q4, 3'd0};
  wire [14:0] cut4 = ~(15'h7FFF << fine_q4);
  wire [ 6:0] step_a4 = (flags_q4[0] ? 7'd4 : 7'd64) >> below_a_q4;
  wire [ 5:0] step_b4 = (flags_q4[1] ? 6'd2 : 6'd32) >> cut_b_q4;
  always @(posedge clk) begin
    flags_q1      <= {line_b[77], line_a[77], kind_b == QUAD, kind_a == QUAD};
    flags_q2      <= flags_q1;
    flags_q3      <= flags_q2;
    flags_q4      <= flags_q3;
    query_q1      <= s_error;
    query_q2      <= query_q1;
    query_q3      <= query_q2;
    query_q4      <= query_q3;
    query_q5      <= query4 >> {fine_q4[4:2], 2'd0};
    query_rest_q5 <= |(query4 & cut4);
    fine_q5       <= fine_q4[1:0];
    query_q6      <= query_q5 >> fine_q5;
    query_rest_q6 <= query_rest_q5;
    step_a_q5     <= flags_q4[2] ? step_a4 | {6'd0, step_a4 == 7'd0} : 7'd0;
    step_b_q5     <= flags_q4[3] ? step_b4 | {5'd0, step_b4 == 6'd0} : 6'd0;
    step_a_q6     <= step_a_q5;
    error_a_q7    <= {1'b0, query_q6} + {9'd0, step_a_q6} + {15'd0, query_rest_q6};
    open_q        <= {open_q[2:0], line_a[78] | line_b[78]};
  end
  cchip_delay #(
      .WIDTH (16),
      .DEPTH (OUT - 7),
      .MEMORY(1)
  ) u_error_a (
      .clk(clk),
      .rst(1'b0),
      .d  (error_a_q7),
      .q  (m_error_a)
  );
  cchip_delay #(
      .WIDTH (6),
      .DEPTH (OUT - 5),
      .MEMORY(1)
  ) u_error_b (
      .clk(clk),
      .rst(1'b0),
      .d  (step_b_q5),
      .q  (m_error_b)
  );
  cchip_delay #(
      .WIDTH (1),
      .DEPTH (OUT - 4),
      .MEMORY(1)
  ) u_open (
      .clk(clk),
      .rst(1'b0),
      .d  (open_q[3]),
      .q  (m_open)
  );

  // ---- clocks 8 to 15: origin of A's leaf, one row after the other
  wire [14:7] row;  // row[k]: the origin is at clock k, its row r at k + r
  wire row_1, row_2;  // of t and o_B
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(6),
      .RESET(1)
  ) u_row (
      .clk(clk),
      .rst(rst),
      .d  (origin_q1),
      .q  (row[7])
  );
  reg [14:8] row_q;
  assign row[14:8] = row_q;
  reg origin_q2;
  assign row_1 = origin_q1;
  assign row_2 = origin_q2;
  wire [35:0] t = row_1 ? s_t[36+:36] : row_2 ? s_t[72+:36] : s_t[0+:36];
  wire [23:0] origin_b = row_1 ? line_b[24+:24] : row_2 ? line_b[48+:24] : line_b[0+:24];
  reg  [35:0] t_q1;
  reg  [23:0] origin_b_q1;
  reg  [36:0] beside_q2;
  wire [36:0] beside8;  // t - o_B, 2^-32
  wire [ 3:0] shift7;
  wire [ 4:0] fine9;
  cchip_delay #(
      .WIDTH (37),
      .DEPTH (6),
      .MEMORY(1)
  ) u_beside (
      .clk(clk),
      .rst(1'b0),
      .d  (beside_q2),
      .q  (beside8)
  );
  cchip_delay #(
      .WIDTH (4),
      .DEPTH (6),
      .MEMORY(1)
  ) u_shift (
      .clk(clk),
      .rst(1'b0),
      .d  (shift_q1),
      .q  (shift7)
  );
  cchip_delay #(
      .WIDTH (5),
      .DEPTH (5),
      .MEMORY(1)
  ) u_fine (
      .clk(clk),
      .rst(1'b0),
      .d  (fine_q4),
      .q  (fine9)
  );
  reg [55:0] moved_1_q8, moved_2_q8, moved_2_q9, shifted_q8;
  reg cut_q8, cut_q9, cut_q10, cut_q11, cut_q12;
  wire signed [55:0] of_row = row[8] ? moved_1_q8 : row[9] ? moved_2_q9 : moved7[0];
  reg [59:0] sum_q9;
  wire [44:0] origin12;
  wire origin_lost12;
  reg [44:0] origin_0_q, origin_1_q;
  reg lost_0_q, lost_1_q, origin_lost_q;
  reg [134:0] origin_q;
  cchip_round_shift #(
      .D_W      (60),
      .BASE     (14),
      .SHIFT_MAX(16),
      .Q_W      (45)
  ) u_origin (
      .clk (clk),
      .d   (sum_q9),
      .s   (fine9),
      .q   (origin12),
      .lost(origin_lost12)
  );
  wire lost12 = origin_lost12 | cut_q12;
  always @(posedge clk) begin
    origin_q2 <= ~rst & origin_q1;
    row_q <= rst ? 7'd0 : row[13:7];
    t_q1 <= t;
    origin_b_q1 <= origin_b;
    beside_q2 <= {t_q1[35], t_q1} - {{5{origin_b_q1[23]}}, origin_b_q1, 8'd0};
    moved_1_q8 <= moved7[1];
    moved_2_q8 <= moved7[2];
    moved_2_q9 <= moved_2_q8;
    shifted_q8 <= of_row >>> shift7;
    cut_q8 <= |(of_row[14:0] & ~(15'h7FFF << shift7));
    sum_q9 <= {{beside8[36], beside8} + {{4{shifted_q8[55]}}, shifted_q8[55:22]}, shifted_q8[21:0]};
    cut_q9 <= cut_q8;
    cut_q10 <= cut_q9;
    cut_q11 <= cut_q10;
    cut_q12 <= cut_q11;
    if (row[12]) {lost_0_q, origin_0_q} <= {lost12, origin12};
    if (row[13]) {lost_1_q, origin_1_q} <= {lost12, origin12};
    if (row[14]) begin
      origin_q      <= {origin12, origin_1_q, origin_0_q};
      origin_lost_q <= lost12 | lost_1_q | lost_0_q;
    end
  end

  // ---- clocks 8 to OUT: offsets in the unit, and the sum
  wire [4:0] cut_a7, cut_b;
  wire [71:0] offset_b;
  cchip_delay #(
      .WIDTH(5),
      .DEPTH(3)
  ) u_cut_a (
      .clk(clk),
      .rst(1'b0),
      .d  (cut_a_q4),
      .q  (cut_a7)
  );
  cchip_delay #(
      .WIDTH (5),
      .DEPTH (OUT - 7),
      .MEMORY(1)
  ) u_cut_b (
      .clk(clk),
      .rst(1'b0),
      .d  (cut_b_q4),
      .q  (cut_b)
  );
  cchip_delay #(
      .WIDTH (72),
      .DEPTH (OUT - 4),
      .MEMORY(1)
  ) u_offset_b (
      .clk(clk),
      .rst(1'b0),
      .d  (offset_b_q),
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
      cchip_delay #(
          .WIDTH (29),
          .DEPTH (OUT - 11),
          .MEMORY(1)
      ) u_offset_a (
          .clk(clk),
          .rst(1'b0),
          .d  ({lost, rounded}),
          .q  ({lost_a[i], offset_a})
      );
      always @(posedge clk) a_q[45*i+:45] <= origin_q[45*i+:45] + {{17{offset_a[27]}}, offset_a};
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
  always @(posedge clk) lost_q <= {|lost_a, origin_lost_q};
  assign m_a = a_q;
  assign m_lost = {|lost_b, lost_q};
  cchip_delay #(
      .WIDTH(3),
      .DEPTH(OUT - 1),
      .RESET(1)
  ) u_valid (
      .clk(clk),
      .rst(rst),
      .d  ({last_q1, first_q1, valid_q1}),
      .q  ({m_last, m_first, m_valid})
  );

  reg s_valid_q;
  always @(posedge clk) begin
    s_valid_q <= s_valid & ~ready_q & ~rst;
    if (!rst) begin
      `CCHIP_ASSERT(a_held, !s_valid_q || s_valid)
      `CCHIP_ASSERT(a_ready, !ready_q || s_valid)
      `CCHIP_ASSERT(a_started, !started_q || s_valid)
    end
  end

  wire unused = &{1'b0, line_a[511:504], line_a[143:79], line_b[511:504], line_b[143:79], lost_q,
      flags_q4, below_a3};

endmodule
`default_nettype wire
