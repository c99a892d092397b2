// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_mul18 for standard cells: the multiplier leaf as partial products, a carry-save tree of six
// levels and one adder, with registers between them. Takes the place of arith/cchip_mul18.v in
// rtl/cchip_asic.f.
//   latency      CCHIP_MUL18_LATENCY clocks, 2 to 4: registers at the input and behind the adder;
//                from 3 on behind the tree, with 4 also behind its third level
//   throughput, numbers, reset   those of arith/cchip_mul18.v
module cchip_mul18 #(
    // 1: a, b and p are signed; 0: they are not
    parameter integer SIGNED = 1
) (
    input  wire               clk,
    input  wire signed [17:0] a,
    input  wire signed [17:0] b,
    output wire signed [35:0] p
);

  localparam integer STAGES = `CCHIP_MUL18_LATENCY;

  `CCHIP_REFUSE(SIGNED != 0 && SIGNED != 1, cchip_error_mul18_SIGNED_must_be_0_or_1)
  `CCHIP_REFUSE(STAGES < 2 || STAGES > 4,
                cchip_error_mul18_for_standard_cells_has_CCHIP_MUL18_LATENCY_2_to_4)

  reg [17:0] a_q, b_q;
  always @(posedge clk) begin
    a_q <= a;
    b_q <= b;
  end

  // Row i is a b_i 2^i. With signs (Baugh and Wooley), products with one of the two highest bits
  // count negative: they enter inverted, and 2^18 + 2^35 corrects the sum modulo 2^36.
  function [35:0] row(input [17:0] x, input [17:0] y, input integer i);
    reg [17:0] product, inverted;
    begin
      product  = x & {18{y[i]}};
      inverted = SIGNED == 0 ? 18'd0 : i == 17 ? 18'h1ffff : 18'h20000;
      row      = {17'd0, SIGNED != 0 && (i == 0 || i == 17), product ^ inverted} << i;
    end
  endfunction
  // A full adder in each column: two rows and one more into a row of carries and a row of sums,
  // modulo 2^36.
  function [71:0] add(input [71:0] two, input [35:0] one);
    reg [35:0] x, y;
    begin
      {x, y} = two;
      add = {((x & y) | (one & (x ^ y))) << 1, x ^ y ^ one};
    end
  endfunction

  // ---- carry-save tree: 18 rows, then 12, 8, 6
  wire [71:0] a0 = add({row(a_q, b_q, 0), row(a_q, b_q, 1)}, row(a_q, b_q, 2));
  wire [71:0] a1 = add({row(a_q, b_q, 3), row(a_q, b_q, 4)}, row(a_q, b_q, 5));
  wire [71:0] a2 = add({row(a_q, b_q, 6), row(a_q, b_q, 7)}, row(a_q, b_q, 8));
  wire [71:0] a3 = add({row(a_q, b_q, 9), row(a_q, b_q, 10)}, row(a_q, b_q, 11));
  wire [71:0] a4 = add({row(a_q, b_q, 12), row(a_q, b_q, 13)}, row(a_q, b_q, 14));
  wire [71:0] a5 = add({row(a_q, b_q, 15), row(a_q, b_q, 16)}, row(a_q, b_q, 17));
  wire [71:0] b0 = add(a0, a1[35:0]);
  wire [71:0] b1 = add(a2, a1[71:36]);
  wire [71:0] b2 = add(a3, a4[35:0]);
  wire [71:0] b3 = add(a5, a4[71:36]);
  wire [215:0] six_d = {b3, add(b2, b1[71:36]), add(b0, b1[35:0])};
  wire [71:0] c0, c1, c2;
  generate
    if (STAGES >= 4) begin : gen_six
      reg [215:0] six_q;
      always @(posedge clk) six_q <= six_d;
      assign {c2, c1, c0} = six_q;
    end else begin : gen_no_six
      assign {c2, c1, c0} = six_d;
    end
  endgenerate

  // ---- 4 rows, 3, 2
  wire [71:0] d0 = add(c0, c1[35:0]);
  wire [71:0] d1 = add(c2, c1[71:36]);
  wire [71:0] two_d = add(add(d0, d1[35:0]), d1[71:36]);
  wire [71:0] two;
  generate
    if (STAGES >= 3) begin : gen_two
      reg [71:0] two_q;
      always @(posedge clk) two_q <= two_d;
      assign two = two_q;
    end else begin : gen_no_two
      assign two = two_d;
    end
  endgenerate

  reg [35:0] p_q;
  always @(posedge clk) p_q <= two[71:36] + two[35:0];
  assign p = p_q;

endmodule
`default_nettype wire
