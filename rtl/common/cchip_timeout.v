// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_timeout: counts clocks and says when `limit` of them have passed without `restart`.
//   limit        1..2^32 - 1 clocks; 0 means DEFAULT, for every user. It may change on any clock,
//                also while something is waited for, and counts from the clock on which it changes:
//                a lower one from the clocks that have passed already, a higher one, or 0, only
//                moves the end away. A change is seen a clock late: what has reached the old limit
//                on the clock of the change expires by it
//   restart      clocks count from the next one on. A user that waits for one thing after another
//                restarts as each begins; one that wants ticks restarts with every expired, and has
//                one every limit + 1 clocks
//   latency      expired is 1 on the clock behind the one on which elapsed has reached the limit,
//                unless that one restarts; it stays 1 until then. A lowered limit that has passed
//                already expires 2 clocks after its change
//   reset        restart = 1 for a clock. elapsed wraps after 2^32 clocks, which no limit reaches
module cchip_timeout #(
    parameter integer DEFAULT = 4096  // the limit that 0 stands for (clock); legal: 1..2^31 - 1
) (
    input  wire        clk,      // clock, rising edge
    // count from the next clock on; for a clock of the user's reset, too
    input  wire        restart,
    input  wire [31:0] limit,    // 1..2^32 - 1 clocks; 0: DEFAULT
    output wire [31:0] elapsed,  // clocks since restart, this one included: 1 on the first
    output wire        expired   // on the last clock elapsed had reached the limit
);

  localparam [31:0] BOUND = DEFAULT;

  `CCHIP_REFUSE(DEFAULT < 1, cchip_error_timeout_DEFAULT_below_1)

  // the bound is chosen and registered as a whole: between two limits it is never a third one
  reg [31:0] bound_q;
  reg [31:0] elapsed_q;
  reg expired_q;
  always @(posedge clk) begin
    bound_q   <= limit == 32'd0 ? BOUND : limit;
    elapsed_q <= restart ? 32'd1 : elapsed_q + 32'd1;
    expired_q <= !restart && elapsed_q >= bound_q;
  end
  assign elapsed = elapsed_q;
  assign expired = expired_q;

  reg known_q;  // restart was 1 once
  initial known_q = 1'b0;
  always @(posedge clk) begin
    known_q <= known_q | restart;
    if (known_q) begin
      `CCHIP_ASSERT(a_elapsed, !expired_q || elapsed_q != 32'd1)
    end
  end

endmodule
`default_nettype wire
