// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_pool: lends the numbers FIRST to FIRST + COUNT - 1, each to one borrower at a time. The one
// that came back first is lent first, so that each is used again as late as possible.
//   latency      2 clocks from back_valid to m_valid if no other number is left
//   throughput   one number lent and one taken back per clock, COUNT >= 3
//   reset        all numbers are free; the first is lent from the 3rd clock on, then one per clock
//   rules        back_valid only with a number that is lent
//   timing       A number that comes back to an empty pool is offered 2 clocks later. After reset
//                the numbers are put into the queue, one on each clock on which none comes back;
//                the first is offered from the third clock on.
//   why          A queue takes the place of a mask and a search for its lowest bit. So every output
//                is a flip-flop at any size. A number rests as long as possible, so a response that
//                is still outstanding for its last user has time to arrive.
module cchip_pool #(
    parameter integer FIRST = 0,   // first number; legal: >= 0
    parameter integer COUNT = 16,  // how many (number); legal: 1..256
    // width of a number (bit); legal: 1..30, wide enough for FIRST + COUNT - 1
    parameter integer WIDTH = 4
) (
    input  wire             clk,         // clock, rising edge
    input  wire             rst,         // synchronous reset, active high
    output wire             m_valid,     // a number is free
    input  wire             m_ready,     // it is lent
    output wire [WIDTH-1:0] m_number,    // which
    input  wire             back_valid,  // a number comes back
    input  wire [WIDTH-1:0] back_number  // which; it was lent
);

  localparam [31:0] BEGIN = FIRST;
  localparam [31:0] LAST = FIRST + COUNT - 1;
  localparam [31:0] ONE = 1;

  `CCHIP_REFUSE(COUNT < 1 || COUNT > 256 || FIRST < 0 || WIDTH < 1 || WIDTH > 30 ||
                FIRST + COUNT > (1 << WIDTH),
                cchip_error_pool_COUNT_must_be_1_to_256_and_all_numbers_have_WIDTH_bit)

  reg filling_q;  // numbers are put into the queue for the first time
  reg [WIDTH-1:0] next_q;
  wire room;
  wire fill = filling_q & room & ~back_valid;
  cchip_fifo #(.WIDTH(WIDTH), .DEPTH(COUNT), .ROOM_KNOWN(1)) u_free (
      .clk    (clk),
      .rst    (rst),
      .s_valid(fill | back_valid),
      .s_ready(room),
      .s_data (back_valid ? back_number : next_q),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_number)
  );
  always @(posedge clk)
    if (rst) begin
      filling_q <= 1'b1;
      next_q    <= BEGIN[WIDTH-1:0];
    end else if (fill) begin
      filling_q <= next_q != LAST[WIDTH-1:0];
      next_q    <= next_q + ONE[WIDTH-1:0];
    end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, !back_valid || room)
    end

endmodule
`default_nettype wire
