// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_ram: memory with one write port and one registered read port.
//   latency      read data 1 clock after the address
//   throughput   one write and one read per clock
//   collision    a read of the address written on the same clock returns the old word
//   reset        none; words are undefined until written
module cchip_ram #(
    // width of a word, bit
    parameter integer WIDTH = 8,
    // words
    parameter integer DEPTH = 16,
    // width of an address, bit: at least $clog2(DEPTH)
    parameter integer ADDR_W = 4
) (
    input  wire              clk,
    input  wire              write,
    input  wire [ADDR_W-1:0] write_addr,
    input  wire [ WIDTH-1:0] write_data,
    input  wire [ADDR_W-1:0] read_addr,
    output reg  [ WIDTH-1:0] read_data
);

  generate
    if (WIDTH < 1 || DEPTH < 1 || (1 << ADDR_W) < DEPTH) begin : gen_illegal
      cchip_error_ram_WIDTH_or_DEPTH_below_1_or_ADDR_W_too_small u_error ();
    end
  endgenerate

  reg [WIDTH-1:0] mem[0:DEPTH-1];

  always @(posedge clk) begin
    if (write) mem[write_addr] <= write_data;
    read_data <= mem[read_addr];
  end

endmodule
`default_nettype wire
