// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_count: number of things inside something that has room for LIMIT of them, and whether there
// are some and whether there is room, each as a flip-flop.
//   latency      1 clock from up or down to count, some and room
//   reset        count 0, some 0, room 1
//   rules        up only while room = 1, down only while some = 1; both on one clock leave the
//                count as it is
//   timing       All outputs are flip-flops and change one clock after up or down; both on one
//                clock change nothing.
//   why          Who gives out credit needs "is there room?" on the next clock, not a comparison
//                behind a sum. The comparisons use registers only; up and down, which come late,
//                select among their results.
module cchip_count #(
    parameter integer LIMIT = 16  // most things inside; legal: 1..65535
) (
    input  wire                       clk,    // clock, rising edge
    input  wire                       rst,    // synchronous reset, active high
    input  wire                       up,     // one more; only while room = 1
    input  wire                       down,   // one less; only while some = 1
    output wire [$clog2(LIMIT+1)-1:0] count,  // things inside
    output wire                       some,   // count > 0
    output wire                       room    // count < LIMIT
);

  localparam integer COUNT_W = $clog2(LIMIT + 1);
  localparam [31:0] FULL = LIMIT;
  localparam [31:0] LAST = LIMIT - 1;
  localparam [31:0] ONE = 1;

  `CCHIP_REFUSE(LIMIT < 1 || LIMIT > 65535, cchip_error_count_LIMIT_must_be_1_to_65535)

  reg [COUNT_W-1:0] count_q;
  reg some_q, room_q;
  assign count = count_q;
  assign some  = some_q;
  assign room  = room_q;

  // the comparisons use registers only; up and down, which come late, select among their results
  wire one = count_q == ONE[COUNT_W-1:0];
  wire last = count_q == LAST[COUNT_W-1:0];
  always @(posedge clk)
    if (rst) begin
      count_q <= {COUNT_W{1'b0}};
      some_q  <= 1'b0;
      room_q  <= 1'b1;
    end else begin
      // + 1 or - 1
      if (up != down) count_q <= count_q + ({COUNT_W{down}} | ONE[COUNT_W-1:0]);
      some_q <= up || (some_q && !(down && one));
      room_q <= down || (room_q && !(up && last));
    end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_up, !up || room_q)
      `CCHIP_ASSERT(a_down, !down || some_q)
      `CCHIP_ASSERT(a_some, some_q == (count_q != {COUNT_W{1'b0}}))
      `CCHIP_ASSERT(a_room, room_q == (count_q != FULL[COUNT_W-1:0]))
    end

endmodule
`default_nettype wire
