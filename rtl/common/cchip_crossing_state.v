// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_crossing_state: one side's part in the common reset of a clock crossing. Both sides have
// one; a reset of either stops and clears both, whatever the ratio of the clocks.
//   states       CLEAR (nothing inside) -> RUN -> LEAVE -> STOP -> CLEAR, a Gray code, so that the
//                other clock may sample it
//   RUN          is left because of rst, or because the other side is in STOP
//   LEAVE        until the other side is known to have run: what is seen of it from then on is
//                newer than this run
//   STOP         until the other side no longer runs: only then may the pointers be cleared, since
//                they change by more than a bit
//   CLEAR        until rst is 0 and the other side is clear as well
//   latency      a reset of one side ends on both after 3 to 5 crossings of each direction,
//                (STAGES + 1) clocks of the receiving side each
//   cuts         run and state are flip-flops
//   power-up     STOP, by an initial value; where a device has none, both resets must be 1 together
//                for more clocks of each side than its synchroniser has
//   reset        see above; a reset of a single clock is enough
//   test         through the parent, cchip_async_fifo, whose proof is about these states
module cchip_crossing_state (
    input  wire       clk,    // clock of this side, rising edge
    input  wire       rst,    // synchronous reset of this side, active high
    input  wire [1:0] other,  // state of the other side, synchronised to clk
    output wire [1:0] state,  // for the synchroniser of the other side
    output wire       run,    // 1: beats may pass
    output wire       clear   // 1: pointers must be 0 from the next clock on
);

  localparam [1:0] STOP = 2'b00, CLEAR = 2'b01, RUN = 2'b11, LEAVE = 2'b10;

  reg [1:0] state_q;
  initial state_q = STOP;
  wire other_runs = other[1];  // RUN or LEAVE

  always @(posedge clk)
    case (state_q)
      CLEAR:   if (!rst && other != STOP) state_q <= RUN;
      RUN:     if (rst || other == STOP) state_q <= LEAVE;
      LEAVE:   if (other_runs || other == STOP) state_q <= STOP;
      default: if (!other_runs) state_q <= CLEAR;
    endcase

  assign state = state_q;
  assign run = state_q == RUN && !rst;
  assign clear = (state_q == STOP && !other_runs) || state_q == CLEAR;

endmodule
`default_nettype wire
