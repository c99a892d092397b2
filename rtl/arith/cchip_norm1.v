// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_norm1: sum of the absolute values of three components. q = |v.x| + |v.y| + |v.z|.
//   latency      CCHIP_NORM1_LATENCY = 3 clocks
//   throughput   one result per clock, never stalls
//   numbers      v two's complement, x in the low bits; q unsigned, exact
//   reset        none (data only)
//   about        The error bounds need this norm of edges, of point differences and of the axis.
//   numbers      Exact: an absolute value is at most 2^(V_W-1), which V_W unsigned bits hold, and
//                three of them are below 2^(V_W+1).
//   why          The 1-norm needs adders only. Euclid's norm would need multipliers, and the bounds
//                that the certainty uses are bounds in the 1-norm anyway. An absolute value would
//                be an addition before the sum. Here the first clock takes the ones' complement of
//                what is negative, which is |v| - 1, and the missing ones go as carries into the
//                sums of the second clock: one addition per clock.
module cchip_norm1 #(
    parameter integer V_W = 17  // width of a component (bit); legal: >= 2
) (
    input  wire             clk,  // clock, rising edge
    input  wire [3*V_W-1:0] v,    // vector, x in the low bits, components signed
    output wire [    V_W:0] q     // norm, unsigned
);

  // ---- clock 1: bits inverted if negative: |v| of v >= 0, |v| - 1 of v < 0
  reg [3*(V_W-1)-1:0] size_q;
  reg x_negative_q;
  reg [1:0] rest_q;  // number of negative components among y and z
  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_component
      always @(posedge clk) size_q[(V_W-1)*d+:V_W-1] <= v[V_W*d+:V_W-1] ^ {V_W - 1{v[V_W*d+V_W-1]}};
    end
  endgenerate
  always @(posedge clk) begin
    x_negative_q <= v[V_W-1];
    rest_q       <= {v[2*V_W-1] & v[3*V_W-1], v[2*V_W-1] ^ v[3*V_W-1]};
  end

  // ---- clock 2: adds the 1 that every negative component still lacks: that of x as the carry into
  // x + y, those of y and z together with z
  wire [V_W:0] xy =
      {1'b0, size_q[0+:V_W-1], x_negative_q} + {1'b0, size_q[V_W-1+:V_W-1], x_negative_q};
  wire [V_W:0] rest = {{V_W - 1{1'b0}}, rest_q};
  reg [V_W-1:0] xy_q, z_q;
  always @(posedge clk) begin
    xy_q <= xy[V_W:1];
    z_q  <= {1'b0, size_q[2*(V_W-1)+:V_W-1]} + rest[V_W-1:0];
  end

  // ---- clock 3: all three
  reg [V_W:0] sum_q;
  always @(posedge clk) sum_q <= {1'b0, xy_q} + {1'b0, z_q};

  assign q = sum_q;
  wire unused = &{1'b0, xy[0], rest[V_W]};

endmodule
`default_nettype wire
