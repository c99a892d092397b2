// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_counter_file: eight counters of events in one distributed RAM, with a third of the
// flip-flops of plain counters. Counters below WIDE have 64 bits, the others 32; they wrap.
//   counting     the RAM is walked through, a word per clock. Beside it each counter has the number
//                of its events since its turn, at most 16, which is added when its turn comes.
//   read         `ack` is 1 for one clock, 2 to 18 clocks after `read`, 16 more after each clear,
//                with the value that the counter has then; no other read may come before. A low
//                word is read at its turn, and its high word comes next: both are of one moment.
//                `read_high` answers, 1 clock later, with the high word of the counter of 64 bits
//                that was read last; it may come on the clock of `ack`.
//   throughput   an event of every counter on every clock
//   reset        rst or clear: all counters 0. The RAM is not reset: in the first 16 clocks after
//                it the walk writes each word without adding what it held.
module cchip_counter_file #(
    parameter integer WIDE = 4  // counters of 64 bits, those from 0 on; legal: 0..8
) (
    input  wire        clk,           // clock, rising edge
    input  wire        rst,           // synchronous reset, active high
    input  wire        clear,  // 1: every counter becomes 0; an event on this clock is not counted
    input  wire [ 7:0] count,         // counter i counts 1
    // a word is asked for, one clock; the next one on the clock of ack or later
    input  wire        read,
    input  wire        read_high,     // with read: the high word that was kept
    input  wire [ 2:0] read_counter,  // the counter; stays until ack
    output wire        ack,           // the answer, one clock
    output wire [31:0] read_data      // the word; 0 on other clocks
);

  localparam [31:0] WIDE_COUNT = WIDE;

  `CCHIP_REFUSE(WIDE < 0 || WIDE > 8, cchip_error_WIDE_must_be_0_to_8)

  // ---- the walk: the low word of a counter, then its high word
  reg clearing_q;
  reg [3:0] place_q, place_q2;  // {counter, high word}
  wire start = rst | clear;
  always @(posedge clk) begin
    place_q    <= start ? 4'd0 : place_q + 4'd1;
    place_q2   <= place_q;
    clearing_q <= start | (clearing_q & ~&place_q);
  end

  // ---- events since the counter's turn
  wire [8*5-1:0] fresh;
  genvar i;
  generate
    for (i = 0; i < 8; i = i + 1) begin : gen_counters
      localparam [31:0] COUNTER = i;
      reg [4:0] fresh_q;
      wire turn = place_q == {COUNTER[2:0], 1'b0};
      always @(posedge clk)
        if (start) fresh_q <= 5'd0;
        else fresh_q <= (turn ? 5'd0 : fresh_q) + {4'd0, count[i]};
      assign fresh[5*i+:5] = fresh_q & {5{turn}};

      always @(posedge clk)
        if (!rst) begin
          `CCHIP_ASSERT(a_fresh, fresh_q <= 5'd16)
        end
    end
  endgenerate
  wire [4:0] amount = fresh[0+:5] | fresh[5+:5] | fresh[10+:5] | fresh[15+:5]
      | fresh[20+:5] | fresh[25+:5] | fresh[30+:5] | fresh[35+:5];

  // ---- memory: read, add, write back on the next clock
  `CCHIP_LUT_RAM
  reg [31:0] mem [0:15];
  reg [31:0] word_q;
  reg [4:0] add_q;
  wire [32:0] sum = {1'b0, word_q} + {28'd0, add_q};
  always @(posedge clk) begin
    if (clearing_q) word_q <= 32'd0;
    else word_q <= mem[place_q];
    add_q <= place_q[0] ? {4'd0, sum[32]} : amount;
    mem[place_q2] <= sum[31:0];
  end

  // ---- read
  reg waiting_q, ack_q, high_follows_q;
  reg [31:0] read_data_q, high_q;
  assign ack = ack_q;
  assign read_data = read_data_q;
  // its low word is added now and its high word is read; after a clear the walk begins anew
  wire answers = waiting_q && place_q == {read_counter, 1'b1};
  always @(posedge clk) begin
    waiting_q      <= ~rst & ((read & ~read_high) | (waiting_q & ~answers));
    ack_q          <= ~rst & (answers | (read & read_high));
    high_follows_q <= answers && {29'd0, read_counter} < WIDE_COUNT;
    if (high_follows_q) high_q <= sum[31:0];
    // on the clock of ack the high word is on its way to high_q
    read_data_q <= (sum[31:0] & {32{answers | (read & read_high & high_follows_q)}}) |
        (high_q & {32{read & read_high & ~high_follows_q}});
  end

endmodule
`default_nettype wire
