// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_mul_wide: signed A_W x B_W multiplier from 18x18 leaves. p = a * b.
//   latency      CCHIP_MUL_LATENCY(A_W, B_W) + PRODUCT_REGS clocks
//   throughput   one product per clock, never stalls
//   numbers      two's complement, p has A_W + B_W bits and is exact. A factor of at most 18 bits
//                is one limb; a wider one is cut into 17-bit unsigned limbs below a signed limb of
//                at most 18 bits. One leaf per pair of limbs, then an adder tree with a register
//                per level.
//   leaves       CCHIP_LIMBS(A_W) * CCHIP_LIMBS(B_W)
//   reset        none (data only)
module cchip_mul_wide #(
    parameter integer A_W = 17,         // width of a (bit); legal: 2..52
    parameter integer B_W = 34,         // width of b (bit); legal: 2..52
    // extra registers between leaf and adder tree (clock); legal: >= 0
    parameter integer PRODUCT_REGS = 0
) (
    input  wire               clk,  // clock, rising edge
    input  wire [    A_W-1:0] a,    // factor, signed
    input  wire [    B_W-1:0] b,    // factor, signed
    output wire [A_W+B_W-1:0] p     // product, signed
);

  localparam integer P_W = A_W + B_W;
  localparam integer LA = `CCHIP_LIMBS(A_W);
  localparam integer LB = `CCHIP_LIMBS(B_W);
  localparam integer LEAVES = LA * LB;
  localparam integer LEVELS = `CCHIP_LEVELS(LEAVES);
  localparam integer M = 1 << LEVELS;  // leaves of the complete tree
  localparam integer LIMB = `CCHIP_LIMB_W;
  // widths after sign extension to a full top limb
  localparam integer AX_W = LIMB * (LA - 1) + 18;
  localparam integer BX_W = LIMB * (LB - 1) + 18;

  `CCHIP_REFUSE(A_W < 2 || A_W > 52 || B_W < 2 || B_W > 52 || PRODUCT_REGS < 0,
                cchip_error_mul_wide_A_W_and_B_W_must_be_2_to_52)

  wire [AX_W-1:0] ax = {{AX_W - A_W + 1{a[A_W-1]}}, a[A_W-2:0]};
  wire [BX_W-1:0] bx = {{BX_W - B_W + 1{b[B_W-1]}}, b[B_W-2:0]};

  // node i is the registered sum of nodes 2i and 2i+1; nodes M..2M-1 are the shifted products
  wire [P_W*2*M-1:P_W] node;

  genvar i, j;
  generate
    for (i = 0; i < LA; i = i + 1) begin : gen_a
      for (j = 0; j < LB; j = j + 1) begin : gen_b
        localparam integer SHIFT = LIMB * (i + j);
        wire [17:0] x, y;
        wire [35:0] leaf, product;
        if (i == LA - 1) begin : gen_top_a
          assign x = ax[LIMB*i+:18];
        end else begin : gen_low_a
          assign x = {1'b0, ax[LIMB*i+:LIMB]};
        end
        if (j == LB - 1) begin : gen_top_b
          assign y = bx[LIMB*j+:18];
        end else begin : gen_low_b
          assign y = {1'b0, bx[LIMB*j+:LIMB]};
        end
        cchip_mul18 u_mul (.clk(clk), .a(x), .b(y), .p(leaf));
        cchip_delay #(.WIDTH(36), .DEPTH(PRODUCT_REGS)) u_product (
            .clk(clk),
            .rst(1'b0),
            .d  (leaf),
            .q  (product)
        );
        // sign-extended far enough for every shift, then cut to the width of the result
        wire [P_W+35:0] extended = {{P_W{product[35]}}, product};
        if (SHIFT == 0) begin : gen_no_shift
          assign node[P_W*(M+i*LB+j)+:P_W] = extended[P_W-1:0];
        end else begin : gen_shift
          assign node[P_W*(M+i*LB+j)+:P_W] = {extended[P_W-SHIFT-1:0], {SHIFT{1'b0}}};
        end
        wire unused = &{1'b0, extended};
      end
    end
    for (i = LEAVES; i < M; i = i + 1) begin : gen_empty
      assign node[P_W*(M+i)+:P_W] = {P_W{1'b0}};
    end
    for (i = 1; i < M; i = i + 1) begin : gen_sum
      reg [P_W-1:0] sum_q;
      always @(posedge clk) sum_q <= node[P_W*2*i+:P_W] + node[P_W*(2*i+1)+:P_W];
      assign node[P_W*i+:P_W] = sum_q;
    end
  endgenerate

  assign p = node[P_W+:P_W];

endmodule
`default_nettype wire
