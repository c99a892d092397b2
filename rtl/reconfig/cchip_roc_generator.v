// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_roc_generator: reset on configuration (paper, listing 3.3 and figure 8) for a module that
// has none of its own.
//   rule         roc = 1 on the CYCLES clocks after every clock on which configured or rst is 1,
//                else 0: a pulse gives a reset of exactly CYCLES clocks; a level gives one that
//                begins one clock later and is CYCLES - 1 clocks longer
//   latency      1 clock
//   reset        rst counts as a configuration; so does power-up: roc is 1 for CYCLES clocks then
//   about        Reset on configuration, listing 3.3 and figure 8 of the paper: a module that has
//                no reset of its own after a configuration, or is closed source, gets one of CYCLES
//                clocks from outside. Used by cchip_pr_slot, usable alone.
//                clk         _/~\_/~\_/~\_/~\_/~\_/~\_
//                configured  ___/~~~\_________________
//                roc         _______/~~~~~~~\_________   CYCLES = 2
//   timing       A pulse makes exactly CYCLES clocks; a level makes a reset that begins one clock
//                after it and ends CYCLES clocks after its last clock; a second configuration
//                during the reset starts it again.
//   why          The paper writes roc_out.write(true); wait(); wait(); roc_out.write(false). One
//                register per clock of the reset is that as hardware; it needs no counter and
//                cannot be left in a state it does not leave by itself.
module cchip_roc_generator #(
    parameter integer CYCLES = 2  // length of the reset (clock); legal: 1..32
) (
    input  wire clk,         // clock, rising edge
    input  wire rst,         // synchronous reset, active high; counts as a configuration
    // 1 on one clock, or on as many as one likes: a configuration has ended
    input  wire configured,
    output wire roc          // reset of the module
);

  `CCHIP_REFUSE(CYCLES < 1 || CYCLES > 32, cchip_error_ROC_CYCLES_must_be_1_to_32)

  reg [CYCLES-1:0] left_q;  // ones: clocks to come
  initial left_q = {CYCLES{1'b1}};

  assign roc = left_q[CYCLES-1];

  always @(posedge clk) left_q <= rst || configured ? {CYCLES{1'b1}} : left_q << 1;

endmodule
`default_nettype wire
