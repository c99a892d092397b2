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
//   about        With a single net for all of them the reset of the whole chip has more than two
//                thousand pins, and its wires are the slowest of the device.
//   timing       rst_copy is what rst was one clock before.
//   rules        All blocks that exchange anything must get a copy of the same depth, so that they
//                leave the reset on the same clock. The reset in front of the copies must last at
//                least two clocks: on its first one the blocks still work.
//   inside       Synthesis merges flip-flops that are equal, so the module has the attribute
//                keep_hierarchy, which Yosys and Vivado obey. In Quartus switch the removal of
//                duplicate registers off for these instances.
//   test         tests/unit/test_cchip_reset_copy.cpp: the rule on every clock, power-up included.
//                In use: the resets of cchip_chip and cchip_chip_core at any clock of their
//                queries.
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
