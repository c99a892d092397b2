// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_dot3: dot product of two vectors of three components. q = a.x b.x + a.y b.y + a.z b.z.
//   latency      CCHIP_MUL_LATENCY(A_W, B_W) + 2 + OPERAND_REGS + PRODUCT_REGS + RESULT_REGS clocks
//   throughput   one result per clock, never stalls
//   numbers      two's complement, x in the low bits; q wraps modulo 2^(A_W+B_W): exact whenever
//                the true value fits, as 3x3 determinants do (CCHIP_PROJ_W)
//   reset        none (data only)
//   about        Dot product of two vectors of three components: one projector of macro stage 3
//                (paper, equation 2: "three multipliers and two adders each").
//   parameters   Illegal values stop elaboration in cchip_mul_wide or cchip_delay.
//   numbers      In general a sum of three such products needs up to two bits more. Here it does
//                not: in the pipeline every result is a 3x3 determinant, and those fit (derivation
//                (docs/develop/architecture.md#widths)). Because additions are modular, wrapped
//                intermediate sums would not matter even if they occurred.
//   why          One adder between two registers. The optional registers are placed by hand where
//                they help: before the multipliers, behind the leaves, and behind the sum, where
//                they only fill up to the wanted latency.
module cchip_dot3 #(
    parameter integer A_W = 17,          // width of a component of a (bit); legal: 2..52
    parameter integer B_W = 34,          // width of a component of b (bit); legal: 2..52
    // extra registers before the multipliers (clock); legal: >= 0
    parameter integer OPERAND_REGS = 0,
    // extra registers behind the multiplier leaves (clock); legal: >= 0
    parameter integer PRODUCT_REGS = 0,
    parameter integer RESULT_REGS = 0  // extra registers behind the last adder (clock); legal: >= 0
) (
    input  wire               clk,  // clock, rising edge
    input  wire [  3*A_W-1:0] a,    // vector, x in the low bits, components signed
    input  wire [  3*B_W-1:0] b,    // vector, x in the low bits, components signed
    output wire [A_W+B_W-1:0] q     // dot product, signed
);

  localparam integer P_W = A_W + B_W;

  wire [3*A_W-1:0] a_in;
  wire [3*B_W-1:0] b_in;
  wire [3*P_W-1:0] product;

  cchip_delay #(.WIDTH(3 * (A_W + B_W)), .DEPTH(OPERAND_REGS)) u_operand (
      .clk(clk),
      .rst(1'b0),
      .d  ({a, b}),
      .q  ({a_in, b_in})
  );

  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_component
      cchip_mul_wide #(.A_W(A_W), .B_W(B_W), .PRODUCT_REGS(PRODUCT_REGS)) u_mul (
          .clk(clk),
          .a  (a_in[A_W*d+:A_W]),
          .b  (b_in[B_W*d+:B_W]),
          .p  (product[P_W*d+:P_W])
      );
    end
  endgenerate

  reg [P_W-1:0] xy_q, z_q, sum_q;
  always @(posedge clk) begin
    xy_q  <= product[0+:P_W] + product[P_W+:P_W];
    z_q   <= product[2*P_W+:P_W];
    sum_q <= xy_q + z_q;
  end

  cchip_delay #(.WIDTH(P_W), .DEPTH(RESULT_REGS)) u_result (
      .clk(clk),
      .rst(1'b0),
      .d  (sum_q),
      .q  (q)
  );

endmodule
`default_nettype wire
