// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_roc_generator: roc is 1 on the CYCLES clocks after every configuration, reset and power-up, on every
// one of them, and on no other clock.
module cchip_roc_generator_properties #(
    parameter integer CYCLES = 2
) (
    input wire clk,
    input wire rst,
    input wire configured
);
  wire roc;
  cchip_roc_generator #(
      .CYCLES(CYCLES)
  ) dut (
      .clk       (clk),
      .rst       (rst),
      .configured(configured),
      .roc       (roc)
  );

  reg [7:0] since_q = 8'd0;  // clocks since the last one, saturating
  always @(posedge clk) since_q <= rst || configured ? 8'd0 : since_q == 8'd255 ? since_q : since_q + 8'd1;

  always @(*) begin
    long_enough: assert (since_q >= CYCLES || roc);
    no_longer: assert (since_q < CYCLES || !roc);
  end
  always @(posedge clk) over: cover (since_q == CYCLES && !roc);
endmodule
`default_nettype wire
