// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_cross3: cross product of two vectors of three components. q = a x b.
//   latency      CCHIP_MUL_LATENCY(E_W, E_W) + 1 + OPERAND_REGS + PRODUCT_REGS + RESULT_REGS clocks
//   throughput   one result per clock, never stalls
//   numbers      two's complement, x in the low bits; components of q have 2 E_W bits, exact for
//                |components of a and b| < 2^(E_W-1)
//   cost         six multipliers, three subtractors (paper, section 3.3: with the six of the edges
//                nine adders)
//   reset        none (data only)
module cchip_cross3 #(
    parameter integer E_W = 17,          // width of a component of a and b (bit); legal: 2..52
    // extra registers before the multipliers (clock); legal: >= 0
    parameter integer OPERAND_REGS = 0,
    // extra registers behind the multiplier leaves (clock); legal: >= 0
    parameter integer PRODUCT_REGS = 0,
    // extra registers behind the subtractors (clock); legal: >= 0
    parameter integer RESULT_REGS = 0
) (
    input  wire             clk,  // clock, rising edge
    input  wire [3*E_W-1:0] a,    // vector, x in the low bits, components signed
    input  wire [3*E_W-1:0] b,    // vector, x in the low bits, components signed
    // cross product, x in the low bits, components signed, 2 E_W bits each
    output wire [6*E_W-1:0] q
);

  localparam integer P_W = 2 * E_W;

  wire [3*E_W-1:0] a_in, b_in;
  reg  [3*P_W-1:0] difference_q;

  cchip_delay #(.WIDTH(6 * E_W), .DEPTH(OPERAND_REGS)) u_operand (
      .clk(clk),
      .rst(1'b0),
      .d  ({a, b}),
      .q  ({a_in, b_in})
  );

  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_component
      localparam integer U = (d + 1) % 3;
      localparam integer V = (d + 2) % 3;
      wire [P_W-1:0] uv, vu;
      cchip_mul_wide #(.A_W(E_W), .B_W(E_W), .PRODUCT_REGS(PRODUCT_REGS)) u_uv (
          .clk(clk),
          .a  (a_in[E_W*U+:E_W]),
          .b  (b_in[E_W*V+:E_W]),
          .p  (uv)
      );
      cchip_mul_wide #(.A_W(E_W), .B_W(E_W), .PRODUCT_REGS(PRODUCT_REGS)) u_vu (
          .clk(clk),
          .a  (a_in[E_W*V+:E_W]),
          .b  (b_in[E_W*U+:E_W]),
          .p  (vu)
      );
      always @(posedge clk) difference_q[P_W*d+:P_W] <= uv - vu;
    end
  endgenerate

  cchip_delay #(.WIDTH(3 * P_W), .DEPTH(RESULT_REGS)) u_result (
      .clk(clk),
      .rst(1'b0),
      .d  (difference_q),
      .q  (q)
  );

endmodule
`default_nettype wire
