// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_mul18: 18x18 multiplier leaf, one multiplier block. p = a * b.
//   latency      2 clocks (input register, output register)
//   throughput   one product per clock, never stalls
//   numbers      two's complement, p is exact, also for (-2^17)^2; with SIGNED = 0 all three are
//                unsigned
//   reset        none (data only): the registers can move into the block
// Every multiplication of the chip goes through this module; a device-specific twin may replace it.
// A twin of another latency says so by the macro CCHIP_MUL18_LATENCY.
module cchip_mul18 #(
    parameter integer SIGNED = 1  // 1: a, b and p are signed; 0: they are not; legal: 0, 1
) (
    input  wire        clk,       // clock, rising edge
    input  wire signed [17:0] a,  // factor
    input  wire signed [17:0] b,  // factor
    output wire signed [35:0] p   // product
);

  `CCHIP_REFUSE(SIGNED != 0 && SIGNED != 1, cchip_error_mul18_SIGNED_must_be_0_or_1)
  `CCHIP_REFUSE(`CCHIP_MUL18_LATENCY != 2, cchip_error_mul18_needs_CCHIP_MUL18_LATENCY_2)

  reg signed [17:0] a_q, b_q;
  (* use_dsp = "yes" *)
  reg signed [35:0] p_q;

  always @(posedge clk) begin
    a_q <= a;
    b_q <= b;
  end
  generate
    if (SIGNED != 0) begin : gen_signed
      always @(posedge clk) p_q <= a_q * b_q;
    end else begin : gen_unsigned
      always @(posedge clk) p_q <= $unsigned(a_q) * $unsigned(b_q);
    end
  endgenerate

  assign p = p_q;

endmodule
`default_nettype wire
