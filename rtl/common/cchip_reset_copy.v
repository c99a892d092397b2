// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_reset_copy: a reset from a flip-flop of its own. One for each block, so that no net has the
// reset pins of a whole design.
//   latency      1 clock
//   power-up     1 where the device has initial values, so that a block is in reset from its first
//                clock on
//   synthesis    equal flip-flops are merged unless their modules are kept: keep_hierarchy, known
//                to Yosys and Vivado
//   cuts         the path
//   reset        none
(* keep_hierarchy = "yes" *)
module cchip_reset_copy (
    input  wire clk,      // clock, rising edge
    input  wire rst,      // synchronous reset, active high
    output wire rst_copy  // the reset, a clock later
);

  reg rst_q;
  initial rst_q = 1'b1;
  always @(posedge clk) rst_q <= rst;
  assign rst_copy = rst_q;

endmodule
`default_nettype wire
