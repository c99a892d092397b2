// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Stands for cchip_block_ram in proofs that follow one bit of a word for all: it keeps bit 0, any other bit that is read is
// anything at all. Less is known of it than of the memory, so what is proved with it holds with the memory.
module cchip_block_ram #(
    parameter integer WIDTH = 8,
    parameter integer WORDS = 1,
    parameter integer ADDR_W = 9,
    parameter integer MIXED_WIDTH = 0
) (
    input  wire                                   clk,
    input  wire                                   write,
    input  wire [ADDR_W-(WORDS==4 ? 2 : 0)-1:0] write_addr,
    input  wire [                WORDS*WIDTH-1:0] write_data,
    input  wire [                     ADDR_W-1:0] read_addr,
    output wire [                      WIDTH-1:0] read_data
);
  (* anyseq *) wire [WIDTH-1:0] others;
  reg [(1<<ADDR_W)-1:0] bits_q;
  reg word_q, read_q;
  integer w;
  always @(posedge clk) begin
    for (w = 0; w < WORDS; w = w + 1)
      if (write) bits_q[WORDS*write_addr+w] <= write_data[WIDTH*w];
    word_q <= bits_q[read_addr];
    read_q <= word_q;
  end
  assign read_data = {others[WIDTH-1:1], read_q};
endmodule
`default_nettype wire
