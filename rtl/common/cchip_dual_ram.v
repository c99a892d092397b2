// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_dual_ram: block RAM with its output registers and two ports; the first one writes or reads,
// the second one reads.
//   latency      read_data belongs to the address of 2 clocks before
//   throughput   two accesses every clock
//   collision    read_data_a of a clock with write, and read_data_b of the word that is written on
//                that clock: any value; in simulation the old word, with the macro CCHIP_POISON
//                random bits
//   device       rtl/cchip_ecp5.f takes the block itself, vendor/ecp5/cchip_dual_ram.v
//   reset        none; words never written hold any value
//   timing       The outputs are flip-flops. No reset: words are undefined until written.
//   why          A block of any FPGA has two ports, each with its own address; a memory with two
//                readers beside a writer, cchip_block_ram twice, takes two blocks for each bit.
//                Where a write may cost a read, as a line that arrives in cchip_cache, one block is
//                enough. On ECP5 a leaf takes the blocks themselves, for the reason given at
//                cchip_block_ram: 18 bits a block up to 1,024 words, 9 bits with 2,048.
module cchip_dual_ram #(
    parameter integer WIDTH = 8,   // width of a word (bit); legal: >= 1
    parameter integer ADDR_W = 11  // width of an address: 1 << ADDR_W words (bit); legal: 3..16
) (
    input  wire              clk,          // clock, rising edge
    input  wire              write,        // 1: write_data is stored at addr_a
    input  wire [ADDR_W-1:0] addr_a,       // which word to write or to read
    input  wire [ WIDTH-1:0] write_data,   // what to write
    // the word at addr_a of 2 clocks before; any value if it was written on that clock
    output wire [ WIDTH-1:0] read_data_a,
    input  wire [ADDR_W-1:0] addr_b,       // which word to read
    // the word at addr_b of 2 clocks before; any value if it was written on that clock
    output wire [ WIDTH-1:0] read_data_b
);

  `CCHIP_REFUSE(WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16,
                cchip_error_dual_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16)

  (* ram_style = "block", ramstyle = "no_rw_check", no_rw_check *)
  reg [WIDTH-1:0] mem[0:(1<<ADDR_W)-1];
  reg [WIDTH-1:0] word_a_q, word_b_q, read_data_a_q, read_data_b_q;
  always @(posedge clk) begin
    if (write) mem[addr_a] <= write_data;
    word_a_q      <= mem[addr_a];
    read_data_a_q <= word_a_q;
  end
  always @(posedge clk) begin
    word_b_q      <= mem[addr_b];
    read_data_b_q <= word_b_q;
  end
`ifdef CCHIP_POISON
  // simulation: the words of a collision are random bits, not the old word
  reg [1:0] collision_a_q, collision_b_q;
  reg [WIDTH-1:0] random_a_q, random_b_q;
  integer r;
  always @(posedge clk) begin
    collision_a_q <= {collision_a_q[0], write};
    collision_b_q <= {collision_b_q[0], write && addr_a == addr_b};
    for (r = 0; r < WIDTH; r = r + 1) begin
      if (collision_a_q[0]) random_a_q[r] <= ^$random;
      if (collision_b_q[0]) random_b_q[r] <= ^$random;
    end
  end
  assign read_data_a = collision_a_q[1] ? random_a_q : read_data_a_q;
  assign read_data_b = collision_b_q[1] ? random_b_q : read_data_b_q;
`else
  assign read_data_a = read_data_a_q;
  assign read_data_b = read_data_b_q;
`endif

endmodule
`default_nettype wire
