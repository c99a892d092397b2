// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_fifo: first-in first-out queue in distributed memory with a register behind it.
//   latency      2 clocks from the push to m_valid of an empty queue
//   throughput   one beat per clock, DEPTH >= 3
//   capacity     DEPTH beats
//   reset        empty; s_ready = 0 while rst is 1
module cchip_fifo #(
    parameter integer WIDTH = 8,      // width of the payload (bit); legal: >= 1
    parameter integer DEPTH = 16,     // capacity (beat); legal: >= 1, any number
    // 1: the sender raises s_valid only while s_ready is 1; saves the logic that checks it; legal:
    // 0, 1
    parameter integer ROOM_KNOWN = 0
) (
    // ---- clock and reset
    input  wire             clk,      // clock, rising edge
    input  wire             rst,      // synchronous reset, active high
    // ---- input stream
    input  wire             s_valid,  // the sender offers s_data
    output wire             s_ready,  // there is room; the beat is taken if s_valid = 1 as well
    input  wire [WIDTH-1:0] s_data,   // payload in
    // ---- output stream
    output wire             m_valid,  // m_data is the oldest beat
    input  wire             m_ready,  // the receiver takes the beat if m_valid = 1 as well
    // oldest beat, does not change while m_valid = 1 and m_ready = 0; undefined while m_valid = 0
    output wire [WIDTH-1:0] m_data
);

  // The memory is made of banks of 16 words, the smallest memory that LUTs form. Successive beats
  // go to successive banks, so a pointer of 4 bits wraps by itself and no comparison is needed.
  // Each bank has a read pointer of its own, which moves one clock after the read. There must be
  // two banks at least, so that no bank is read on two consecutive clocks.
  localparam integer BANKS = DEPTH > 16 ? (DEPTH + 15) / 16 : 2;
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam [31:0] LAST = DEPTH - 1;
  localparam [31:0] FULL = DEPTH;
  localparam [31:0] ONE = 1;
  localparam [BANKS-1:0] FIRST_BANK = {{BANKS - 1{1'b0}}, 1'b1};
  localparam [31:0] TWO = 2;

  `CCHIP_REFUSE(WIDTH < 1 || DEPTH < 1, cchip_error_fifo_WIDTH_or_DEPTH_below_1)

  reg [BANKS-1:0] write_bank_q, read_bank_q;  // one-hot
  reg [3:0] write_q;  // write pointer, the same for all banks
  reg [COUNT_W-1:0] count_q; // beats in memory and output register
  reg ready_q, some_q, more_q;  // count_q < DEPTH, >= 1, >= 2
  reg valid_q;
  reg [WIDTH-1:0] data_q;

  assign s_ready = ready_q;
  assign m_valid = valid_q;
  assign m_data  = data_q;

  wire push = s_valid && (ready_q || ROOM_KNOWN != 0);
  wire pop = valid_q & m_ready;
  wire up = push & ~pop;
  wire down = pop & ~push;
  wire load = (~valid_q & some_q) | (m_ready & more_q);

  // ---- memory
  wire [WIDTH*BANKS-1:0] words;
  genvar b;
  generate
    for (b = 0; b < BANKS; b = b + 1) begin : gen_bank
      `CCHIP_LUT_RAM
      reg [WIDTH-1:0] mem [0:15];
      reg [3:0] read_q;
      reg was_read_q;
      always @(posedge clk) begin
        if (push && write_bank_q[b]) mem[write_q] <= s_data;
        if (rst) begin
          was_read_q <= 1'b0;
          read_q     <= 4'd0;
        end else begin
          was_read_q <= load & read_bank_q[b];
          if (was_read_q) read_q <= read_q + 4'd1;
        end
      end
      assign words[WIDTH*b+:WIDTH] = mem[read_q];
    end
  endgenerate

  function [WIDTH-1:0] choose(input [WIDTH*BANKS-1:0] from, input [BANKS-1:0] bank);
    integer j;
    begin
      choose = from[0+:WIDTH];
      for (j = 1; j < BANKS; j = j + 1) if (bank[j]) choose = from[WIDTH*j+:WIDTH];
    end
  endfunction
  // with DEPTH = 1 a push finds the queue empty: its word needs the output register only, no memory
  wire [WIDTH-1:0] word = DEPTH == 1 ? s_data : choose(words, read_bank_q);

  // the bank after this one
  wire [BANKS-1:0] write_bank_next = (write_bank_q << 1) | (write_bank_q >> (BANKS - 1));
  wire [BANKS-1:0] read_bank_next = (read_bank_q << 1) | (read_bank_q >> (BANKS - 1));

  // the comparisons use registers only; push and pop, which come late, select among their results
  always @(posedge clk) begin
    if (DEPTH == 1 ? push : load) data_q <= word;
    if (rst) begin
      write_q <= 4'd0;
      write_bank_q <= FIRST_BANK;
      read_bank_q <= FIRST_BANK;
      count_q <= {COUNT_W{1'b0}};
      ready_q <= 1'b0;
      some_q  <= 1'b0;
      more_q  <= 1'b0;
      valid_q <= 1'b0;
    end else begin
      if (push && write_bank_q[BANKS-1]) write_q <= write_q + 4'd1;
      if (push) write_bank_q <= write_bank_next;
      if (load) read_bank_q <= read_bank_next;
      if (push != pop) count_q <= count_q + ({COUNT_W{pop}} | ONE[COUNT_W-1:0]);  // + 1 or - 1
      ready_q <= up ? count_q != LAST[COUNT_W-1:0] : pop || count_q != FULL[COUNT_W-1:0];
      some_q  <= up || (down ? more_q : some_q);
      more_q  <= up ? some_q : down ? more_q && {{32 - COUNT_W{1'b0}}, count_q} != TWO : more_q;
      valid_q <= load | (valid_q & ~m_ready);
    end
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, ROOM_KNOWN == 0 || !s_valid || ready_q)
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, count_q} <= FULL)
      `CCHIP_ASSERT(a_some, some_q == (count_q != {COUNT_W{1'b0}}))
      `CCHIP_ASSERT(a_more, more_q == ({{32 - COUNT_W{1'b0}}, count_q} >= TWO))
      `CCHIP_ASSERT(a_valid, !valid_q || some_q)
    end

endmodule
`default_nettype wire
