// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_first_pair: the lowest of the child pairs of a node pair. Pair 4 i + j is child i of A with
// child j of B. It is found among the four children of B for each child of A, then among these
// rows: a carry chain over 16 bits is slower.
//   latency      0 clocks: all outputs follow pairs
//   cuts         nothing
//   about        The lowest of the child pairs of a node pair, for cchip_leaf_queue and
//                cchip_traversal_decision.
//   timing       Combinational.
//   why          A carry chain over 16 bits is slower, and a priority search over 16 bits deeper.
module cchip_first_pair (
    input  wire [15:0] pairs,   // bit 4 i + j: child i of A with child j of B
    output wire [ 3:0] first,   // number of the lowest one; any if pairs is 0
    output wire [15:0] rest,    // pairs without it
    output wire        several  // there are two or more
);

  wire [3:0] row_some, row_two;  // of child i of A: a pair, two pairs
  wire [7:0] row_first;
  genvar n;
  generate
    for (n = 0; n < 4; n = n + 1) begin : gen_row
      wire [3:0] here = pairs[4*n+:4];
      wire [3:0] rest_here = {here[3] & |here[2:0], here[2] & |here[1:0], &here[1:0], 1'b0};
      wire is_first;  // no row before has a pair
      if (n == 0) begin : gen_first
        assign is_first = 1'b1;
      end else begin : gen_later
        assign is_first = ~|row_some[n-1:0];
      end
      assign row_some[n] = |here;
      assign row_two[n] = |rest_here;
      assign row_first[2*n+:2] = {~|here[1:0], ~here[0] & (here[1] | ~here[2])};
      assign rest[4*n+:4] = is_first ? rest_here : here;
    end
  endgenerate
  wire [1:0] row = {~|row_some[1:0], ~row_some[0] & (row_some[1] | ~row_some[2])};
  assign first = {row, row_first[2*row+:2]};
  assign several = |row_two | (|row_some[1:0] & |row_some[3:2]) | &row_some[1:0] | &row_some[3:2];

endmodule
`default_nettype wire
