// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_bv_cell: one of the row of cells of the box test. It holds a child of B, while the children
// of A pass through the row, one after the other; and adds its child pair to what the cells before
// it have found for the child of A.
//   latency      1 clock from a to m_a, 7 clocks from a to m_row, for s_row of 6 clocks after a
//   throughput   a child of A on every clock
//   row          {best: key, number of B's child; of each child of B: strong, leaves, waiting};
//                as model::sort_children names them
//   reset        none
//   timing       A child of A on every clock. m_a comes one clock, m_row 7 clocks after s_a.
//   numbers      Planes as cchip_bv_compare takes them. The best is the child pair that waits with
//                the greatest key, the first of equals.
//   inside       cchip_bv_compare, registers, a comparison of two keys.
//   why          Cells in a row need no multiplexer in front of the comparators, and what they find
//                for a child of A is put together on the way.
module cchip_bv_cell (
    input  wire         clk,    // clock, rising edge
    input  wire         load,   // b is held from the next clock on
    input  wire [335:0] b,      // a child of B: {number, inner, counts, planes}
    // a child of A: {near, inner, counts, planes}; near: it counts as overlapping, with key 0,
    // regardless of its planes
    input  wire [334:0] s_a,
    output wire [334:0] m_a,    // the same, a clock later
    // 6 clocks after s_a: what the cells before have found for it, {key and number of the best,
    // strong, leaves, waiting}
    input  wire [ 17:0] s_row,
    output wire [ 17:0] m_row   // 7 clocks after s_a: the same with this cell's child pair
);

  // ---- clock 0
  reg [335:0] b_q;
  reg [334:0] a_q;
  always @(posedge clk) begin
    if (load) b_q <= b;
    a_q <= s_a;
  end
  assign m_a = a_q;
  wire separated2;
  wire [3:0] key6;
  cchip_bv_compare u_compare (
      .clk      (clk),
      .a        (s_a[331:0]),
      .b        (b_q[331:0]),
      .separated(separated2),
      .key      (key6)
  );

  // ---- clocks 1 to 6: what the child pair is
  reg counts_q1, counts_q2, inner_q1, inner_q2;
  reg near_q1, near_q2, near_q3, near_q4, near_q5, near_q6;
  reg [11:0] number_q;  // from clock 1 to 6
  wire overlap2 = counts_q2 & (near_q2 | ~separated2);
  reg [3:0] waiting_q, leaves_q;  // from clock 3 to 6
  always @(posedge clk) begin
    counts_q1 <= s_a[332] & b_q[332];
    counts_q2 <= counts_q1;
    inner_q1  <= s_a[333] | b_q[333];
    inner_q2  <= inner_q1;
    waiting_q <= {waiting_q[2:0], overlap2 & inner_q2};
    leaves_q  <= {leaves_q[2:0], overlap2 & ~inner_q2};
    number_q  <= {number_q[9:0], b_q[335:334]};
    {near_q1, near_q2, near_q3, near_q4, near_q5, near_q6} <= {
      s_a[334], near_q1, near_q2, near_q3, near_q4, near_q5
    };
  end

  // ---- clock 6
  wire waiting6 = waiting_q[3];
  wire leaves6 = leaves_q[3];
  wire [1:0] number6 = number_q[11:10];
  wire [3:0] key = key6 & {4{~near_q6}};
  wire [3:0] found6 = 4'd1 << number6;
  wire better6 = waiting6 && (s_row[3:0] == 4'd0 || key > s_row[17:14]);
  reg [17:0] row_q7;
  always @(posedge clk) begin
    row_q7[3:0]   <= s_row[3:0] | (found6 & {4{waiting6}});
    row_q7[7:4]   <= s_row[7:4] | (found6 & {4{leaves6}});
    row_q7[11:8]  <= s_row[11:8] | (found6 & {4{waiting6 & key[3]}});
    row_q7[17:12] <= better6 ? {key, number6} : s_row[17:12];
  end
  assign m_row = row_q7;

endmodule
`default_nettype wire
