// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_bitstream_table: where the bitstreams are: address, size and a valid bit of each entry,
// entry M * slot + module, M = 1 << CCHIP_KIND_BITS(KINDS). Addresses and sizes are in distributed
// RAM.
//   registers    word {slot, module (3 bits), 0} is the address, {.., 1} the size, {.., 2} the
//                valid bit; of a slot or module that is not there they are 0 and stay so
//   latency      look-up: 2 clocks from look to address and size, which stay until the next one
//   throughput   a write and a read on every clock, a look-up every 2 clocks
//   collision    a write counts from the next clock on; of a write and invalidate on one clock the
//                write counts
//   cuts         every path but read_word to read_data
//   reset        valid: 0; addresses and sizes are undefined until written
//   about        Software writes it, the scheduler looks up the entry of a swap.
//   timing       A look-up takes 2 clocks: the address is read on the first, the size on the
//                second. rst clears the valid bits.
//   numbers      An entry counts only while its valid bit is 1, so software writes that last.
//                Entries of slots and modules that are not there read as 0; writes to them are
//                ignored.
//   why          Distributed RAM with two read ports (8 words per slot, 16 with points) takes the
//                place of 256 flip-flops per slot and of two multiplexers of all words, one for the
//                bus and one for the scheduler.
module cchip_bitstream_table #(
    parameter integer SLOTS = 2,  // slots; legal: 1..4
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3
) (
    input  wire               clk,                                 // clock, rising edge
    input  wire               rst,                                 // synchronous reset, active high
    input  wire               write,                               // a word is written
    // {slot, module (3 bits), word}: word 0 is the address, 1 the size, 2 the valid bit
    input  wire [        6:0] write_word,
    input  wire [       31:0] write_data,                          // its new value
    input  wire [        3:0] write_bytes,                         // the bytes that are written
    input  wire [        6:0] read_word,                           // the word that is read
    output wire [       31:0] read_data,                           // its value, on the same clock
    input  wire               look,                                // an entry is looked up
    input  wire [        4:0] look_entry,  // {slot, module (3 bits)}; stays for 2 clocks
    output wire [       31:0] address,  // its address, 2 clocks later, until the next look-up
    output wire [       31:0] size,                                // its size likewise
    // the valid bits, entry m + slot << CCHIP_KIND_BITS(KINDS) for module m
    output wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] valid,
    input  wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] invalidate  // clears valid bits
);

  localparam integer MODULE_W = `CCHIP_KIND_BITS(KINDS);
  localparam integer ENTRY_W = MODULE_W + (SLOTS > 2 ? 2 : SLOTS > 1 ? 1 : 0);
  localparam integer ENTRIES = SLOTS << MODULE_W;
  localparam [31:0] SLOTS_HERE = (32'd1 << SLOTS) - 32'd1;
  localparam [31:0] LAST_MODULE = KINDS;

  `CCHIP_REFUSE(SLOTS < 1 || SLOTS > 4, cchip_error_SLOTS_must_be_1_to_4)
  `CCHIP_REFUSE(KINDS != 3 && KINDS != 4, cchip_error_KINDS_must_be_3_or_4)

  reg look_q;
  reg [31:0] address_q, size_q;
  reg [ENTRIES-1:0] valid_q;
  assign address = address_q;
  assign size = size_q;
  assign valid = valid_q;

  // ---- addresses and sizes: a memory for each byte, which is written by itself
  function here(input [4:0] entry);  // there are such a slot and module
    here = SLOTS_HERE[{3'd0, entry[4:3]}] && entry[2:0] <= LAST_MODULE[2:0];
  endfunction
  function [4:0] packed_entry(input [4:0] entry);
    packed_entry = MODULE_W == 3 ? entry : {1'b0, entry[4:3], entry[1:0]};
  endfunction
  wire [4:0] write_entry = packed_entry(write_word[6:2]);
  wire [4:0] read_entry = packed_entry(read_word[6:2]);
  wire [4:0] look_packed = packed_entry(look_entry);
  wire writes = write && here(write_word[6:2]);
  wire [ENTRY_W:0] write_word_addr = {write_entry[ENTRY_W-1:0], write_word[0]};
  wire [ENTRY_W:0] read_word_addr = {read_entry[ENTRY_W-1:0], read_word[0]};
  wire [ENTRY_W:0] look_word_addr = {look_packed[ENTRY_W-1:0], look_q};
  wire [31:0] read_stored, look_stored;
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_bytes
      `CCHIP_LUT_RAM
      reg [7:0] mem [0:(2<<ENTRY_W)-1];
      always @(posedge clk)
        if (writes && !write_word[1] && write_bytes[i]) mem[write_word_addr] <= write_data[8*i+:8];
      assign read_stored[8*i+:8] = mem[read_word_addr];
      assign look_stored[8*i+:8] = mem[look_word_addr];
    end
  endgenerate
  wire [32:0] valid_of = {{33 - ENTRIES{1'b0}}, valid_q};
  assign read_data = !here(read_word[6:2]) ? 32'd0
      : read_word[1] ? {31'd0, valid_of[{1'b0, read_entry}]} : read_stored;

  // ---- look-up: the address, then the size
  always @(posedge clk) begin
    look_q <= ~rst & look;
    if (look) address_q <= look_stored;
    if (look_q) size_q <= look_stored;
  end

  // ---- valid bits
  wire write_valid = writes & write_word[1] & write_bytes[0];
  integer e;
  always @(posedge clk)
    for (e = 0; e < ENTRIES; e = e + 1)
      if (rst) valid_q[e] <= 1'b0;
      else if (write_valid && write_entry == e[4:0]) valid_q[e] <= write_data[0];
      else if (invalidate[e]) valid_q[e] <= 1'b0;

  wire unused = &{1'b0, look_packed, write_entry, read_entry};

endmodule
`default_nettype wire
