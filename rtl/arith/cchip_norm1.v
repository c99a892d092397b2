// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_norm1: sum of the absolute values of three components. q = |v.x| + |v.y| + |v.z|.
//   latency      CCHIP_NORM1_LATENCY = 2 clocks
//   throughput   one result per clock, never stalls
//   numbers      components two's complement of V_W bits, x in the low bits; q unsigned, V_W + 1 bits, exact
//   reset        none (data only)
module cchip_norm1 #(
    // width of a component, bit, >= 2
    parameter integer V_W = 17
) (
    input  wire             clk,
    input  wire [3*V_W-1:0] v,
    output wire [    V_W:0] q
);

  reg [3*V_W-1:0] absolute_q;
  reg [V_W:0] sum_q;

  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_component
      wire [V_W-1:0] x = v[V_W*d+:V_W];
      always @(posedge clk) absolute_q[V_W*d+:V_W] <= x[V_W-1] ? ~x + {{V_W - 1{1'b0}}, 1'b1} : x;
    end
  endgenerate

  always @(posedge clk)
    sum_q <= {1'b0, absolute_q[0+:V_W]} + {1'b0, absolute_q[V_W+:V_W]} + {1'b0, absolute_q[2*V_W+:V_W]};

  assign q = sum_q;

endmodule
`default_nettype wire
