// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_leaf_unit: the unit of a leaf pair in cchip_vertex_transform, how far its leaves are above
// it, and the bounds on the errors of its vertices (docs/hardware/image.md).
//   unit         2^(x - 48), x the greatest of the extent of A's leaf in B's frame, of the extent
//                of B's leaf, and of 8
//   error        of A: twice that of the query, and twice the step of A's leaf if it is rounded,
//                because rows of |M| add up to less than 2; of B: the step of its leaf
//   latency      1 clock to m_shift, 4 to m_cut_a, m_cut_b and m_fine, OUT to the errors and m_open
//   throughput   a leaf pair per clock
//   reset        none: values count only with the vertex they belong to
module cchip_leaf_unit #(
    // from the last pass of a vertex to its output (clock); legal: >= 10
    parameter integer OUT = 15
) (
    input  wire        clk,         // clock, rising edge
    input  wire [ 3:0] s_shift,     // M is M 2^-shift
    input  wire [11:0] s_error,     // bound on the error of a position, 2^-38
    input  wire [ 4:0] s_extent_a,  // extent of A's leaf
    input  wire [ 4:0] s_extent_b,  // extent of B's leaf
    input  wire [ 1:0] s_quads,     // the leaf is one quad, {B's, A's}
    input  wire [ 1:0] s_rounded,   // its vertices are rounded, {B's, A's}
    input  wire        s_open,      // no answer for this leaf pair is definite
    output wire [ 3:0] m_shift,     // s_shift, a clock later
    output wire [ 4:0] m_cut_a,     // bits of an offset of A below the unit
    output wire [ 4:0] m_cut_b,     // bits of an offset of B below the unit
    output wire [ 4:0] m_fine,      // x - 8, where the unit is 2^(x - 48)
    output wire [15:0] m_error_a,   // bound on twice the error of a vertex of A
    output wire [ 5:0] m_error_b,   // the same of B
    output wire        m_open       // s_open
);

  // ---- clocks 1 to 4: the unit, 2^(x - 48), and how far each leaf is above it
  reg signed [5:0] moved_extent_q2, moved_extent_q3;
  reg [4:0] extent_a_q1, extent_b_q1, extent_b_q2, extent_b_q3, x_q3, cut_a_q4, cut_b_q4, fine_q4;
  reg  [5:0] below_a_q4;
  reg  [3:0] shift_q1;
  reg  [4:0] greater_q2;  // of B's extent and 8
  wire [5:0] below_a3 = {1'b0, x_q3} - $unsigned(moved_extent_q3);
  wire [4:0] fine3 = x_q3 - 5'd8;
  always @(posedge clk) begin
    extent_a_q1 <= s_extent_a;
    extent_b_q1 <= s_extent_b;
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
    flags_q1      <= {s_rounded, s_quads};
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
    open_q        <= {open_q[2:0], s_open};
  end
  cchip_delay #(.WIDTH(16), .DEPTH(OUT - 7), .MEMORY(1)) u_error_a (
      .clk(clk),
      .rst(1'b0),
      .d  (error_a_q7),
      .q  (m_error_a)
  );
  cchip_delay #(.WIDTH(6), .DEPTH(OUT - 5), .MEMORY(1)) u_error_b (
      .clk(clk),
      .rst(1'b0),
      .d  (step_b_q5),
      .q  (m_error_b)
  );
  cchip_delay #(.WIDTH(1), .DEPTH(OUT - 4), .MEMORY(1)) u_open (
      .clk(clk),
      .rst(1'b0),
      .d  (open_q[3]),
      .q  (m_open)
  );
  assign m_shift = shift_q1;
  assign m_cut_a = cut_a_q4;
  assign m_cut_b = cut_b_q4;
  assign m_fine  = fine_q4;

  wire unused = &{1'b0, flags_q4, below_a3};

endmodule
`default_nettype wire
