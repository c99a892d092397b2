// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_ram: memory with one write port and one registered read port.
//   latency      read data CCHIP_RAM_LATENCY = 3 clocks after the address. The sender presents the
//                write data one clock after write and write_addr, so that the decoded address,
//                which goes to every bank, comes from registers
//   throughput   one write and one read per clock
//   collision    a read address that comes one clock after the write address reads the new word, an
//                earlier one the old word
//   reset        none; words are undefined until written
module cchip_ram #(
    parameter integer WIDTH = 8,   // width of a word (bit); legal: >= 1
    parameter integer DEPTH = 16,  // words; legal: >= 1
    // width of an address (bit); legal: $clog2(DEPTH); up to 4 also of a smaller memory
    parameter integer ADDR_W = 4
) (
    input  wire              clk,         // clock, rising edge
    input  wire              write,       // 1: write_data of the next clock is stored
    input  wire [ADDR_W-1:0] write_addr,  // where, 0..DEPTH - 1
    input  wire [ WIDTH-1:0] write_data,  // what, one clock after write and write_addr
    input  wire [ADDR_W-1:0] read_addr,   // which word to read, 0..DEPTH - 1
    // the word at the address of CCHIP_RAM_LATENCY clocks before
    output wire [ WIDTH-1:0] read_data
);

  reg [WIDTH-1:0] read_data_q;
  assign read_data = read_data_q;

  `CCHIP_REFUSE(WIDTH < 1 || DEPTH < 1 || (1 << ADDR_W) < DEPTH,
                cchip_error_ram_WIDTH_or_DEPTH_below_1_or_ADDR_W_too_small)
  `CCHIP_REFUSE(ADDR_W > 4 && (1 << (ADDR_W - 1)) >= DEPTH,
                cchip_error_ram_ADDR_W_wider_than_needed)

  // The memory is made of banks of 16 words, the smallest memory that LUTs form. There is a
  // register before and behind the banks; the word of the right bank is selected after the second
  // one.
  localparam integer BANKS = (DEPTH + 15) / 16;
  localparam integer WORD_W = ADDR_W > 4 ? 4 : ADDR_W;

  reg [WORD_W-1:0] write_word_q;
  reg [ADDR_W-1:0] read_addr_q, read_addr_q2;
  reg [WIDTH*BANKS-1:0] words_q2;
  always @(posedge clk) write_word_q <= write_addr[WORD_W-1:0];

  genvar b;
  generate
    for (b = 0; b < BANKS; b = b + 1) begin : gen_bank
      localparam [31:0] B = b;
      `CCHIP_LUT_RAM
      reg [WIDTH-1:0] mem [0:(1<<WORD_W)-1];
      reg write_q;
      if (BANKS == 1) begin : gen_one
        always @(posedge clk) write_q <= write;
      end else begin : gen_decode
        always @(posedge clk) write_q <= write && write_addr[ADDR_W-1:4] == B[ADDR_W-5:0];
      end
      always @(posedge clk) begin
        if (write_q) mem[write_word_q] <= write_data;
        words_q2[WIDTH*b+:WIDTH] <= mem[read_addr_q[WORD_W-1:0]];
      end
    end
  endgenerate

  function [WIDTH-1:0] choose(input [WIDTH*BANKS-1:0] from, input [ADDR_W-1:0] address);
    integer j;
    begin
      choose = from[0+:WIDTH];
      for (j = 1; j < BANKS; j = j + 1)
        if ({{32 - ADDR_W{1'b0}}, address} >> 4 == j[31:0]) choose = from[WIDTH*j+:WIDTH];
    end
  endfunction
  always @(posedge clk) begin
    read_addr_q  <= read_addr;
    read_addr_q2 <= read_addr_q;
    read_data_q  <= choose(words_q2, read_addr_q2);
  end

endmodule
`default_nettype wire
