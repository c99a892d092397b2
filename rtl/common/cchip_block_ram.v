// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// 0 for a tool that infers no ports of different widths from Verilog; Quartus, which defines
// ALTERA_RESERVED_QIS, is one.
`ifndef CCHIP_MIXED_WIDTH
`ifdef ALTERA_RESERVED_QIS
`define CCHIP_MIXED_WIDTH 0
`else
`define CCHIP_MIXED_WIDTH 1
`endif
`endif
// cchip_block_ram: block RAM with its output register, one port for writing and one for reading.
// Without that register a block of an ECP5 takes 5.6 ns from clock to output.
//   write        WORDS words at once: word i of write_data at address WORDS * write_addr + i
//   latency      read_data belongs to read_addr of 2 clocks before
//   throughput   a write and a read every clock
//   collision    a word that is read on the clock on which it is written: any value; in simulation
//                the old word, with the macro CCHIP_POISON random bits
//   device       rtl/cchip_ecp5.f takes the block itself, vendor/ecp5/cchip_block_ram.v, because
//                Yosys does not pack the register
//   reset        none; words never written hold any value
module cchip_block_ram #(
    parameter integer WIDTH = 8,                        // width of a word (bit); legal: >= 1
    parameter integer WORDS = 1,  // words that are written at once; legal: 1, 4
    // width of the address of a word: 1 << ADDR_W words (bit); legal: 3..16
    parameter integer ADDR_W = 9,
    // with four words, 1: one memory with a wider port for writing; 0: four and a multiplexer; the
    // macro CCHIP_MIXED_WIDTH is 0 in Quartus, else 1, unless the project defines it; legal: 0, 1
    parameter integer MIXED_WIDTH = `CCHIP_MIXED_WIDTH
) (
    input  wire                                   clk,         // clock, rising edge
    input  wire                                   write,       // 1: write_data is stored
    // where: word i of the data goes to address WORDS * write_addr + i
    input  wire [ADDR_W-(WORDS==4 ? 2 : 0)-1:0] write_addr,
    input  wire [                WORDS*WIDTH-1:0] write_data,  // what, word 0 in the lowest bits
    input  wire [                     ADDR_W-1:0] read_addr,   // which word to read
    // the word at the address of 2 clocks before
    output wire [                      WIDTH-1:0] read_data
);

  reg [WIDTH-1:0] read_data_q;
`ifdef CCHIP_POISON
  // simulation: the word of a collision is random bits, not the old word
  reg [1:0] collision_q;
  reg [WIDTH-1:0] random_q;
  integer r;
  always @(posedge clk) begin
    collision_q <= {collision_q[0], write && read_addr >> (WORDS == 4 ? 2 : 0) == write_addr};
    for (r = 0; r < WIDTH; r = r + 1) if (collision_q[0]) random_q[r] <= ^$random;
  end
  assign read_data = collision_q[1] ? random_q : read_data_q;
`else
  assign read_data = read_data_q;
`endif

  `CCHIP_REFUSE(WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16,
                cchip_error_block_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16)
  `CCHIP_REFUSE(WORDS != 1 && WORDS != 4, cchip_error_block_ram_WORDS_must_be_1_or_4)

  generate
    if (WORDS == 1) begin : gen_single
      (* ram_style = "block", ramstyle = "no_rw_check", no_rw_check *)
      reg [WIDTH-1:0] mem [0:(1<<ADDR_W)-1];
      reg [WIDTH-1:0] word_q;
      always @(posedge clk) if (write) mem[write_addr] <= write_data;
      always @(posedge clk) begin
        word_q      <= mem[read_addr];
        read_data_q <= word_q;
      end
    end else if (MIXED_WIDTH != 0) begin : gen_mixed
      // the form that tools know as a port four words wide
      (* ram_style = "block", ramstyle = "no_rw_check", no_rw_check *)
      reg [WIDTH-1:0] mem [0:(1<<ADDR_W)-1];
      reg [WIDTH-1:0] word_q;
      integer i;
      always @(posedge clk)
        for (i = 0; i < 4; i = i + 1)
          if (write) mem[{write_addr, i[1:0]}] <= write_data[WIDTH*i+:WIDTH];
      always @(posedge clk) begin
        word_q      <= mem[read_addr];
        read_data_q <= word_q;
      end
    end else begin : gen_banks
      wire [4*WIDTH-1:0] words;
      reg [1:0] bank_q;
      genvar b;
      for (b = 0; b < 4; b = b + 1) begin : gen_bank
        (* ram_style = "block", ramstyle = "no_rw_check", no_rw_check *)
        reg [WIDTH-1:0] mem [0:(1<<(ADDR_W-2))-1];
        reg [WIDTH-1:0] word_q;
        always @(posedge clk) if (write) mem[write_addr] <= write_data[WIDTH*b+:WIDTH];
        always @(posedge clk) word_q <= mem[read_addr[ADDR_W-1:2]];
        assign words[WIDTH*b+:WIDTH] = word_q;
      end
      wire [2*WIDTH-1:0] half = bank_q[1] ? words[2*WIDTH+:2*WIDTH] : words[0+:2*WIDTH];
      always @(posedge clk) begin
        bank_q      <= read_addr[1:0];
        read_data_q <= bank_q[0] ? half[WIDTH+:WIDTH] : half[0+:WIDTH];
      end
    end
  endgenerate

endmodule
`default_nettype wire
