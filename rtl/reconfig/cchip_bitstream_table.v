// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_bitstream_table: where the bitstreams are: address, size and a valid bit of eight entries,
// entry 4 * slot + module. Addresses and sizes are in distributed RAM.
//   registers    word {entry, 0} is the address, {entry, 1} the size, {entry, 2} the valid bit
//   latency      look-up: 2 clocks from look to address and size, which stay until the next one
//   throughput   a write and a read on every clock, a look-up every 2 clocks
//   collision    a write counts from the next clock on; of a write and invalidate on one clock the
//                write counts
//   cuts         every path but read_word to read_data
//   reset        valid: 0; addresses and sizes are undefined until written
module cchip_bitstream_table (
    input  wire        clk,
    input  wire        rst,
    input  wire        write,
    input  wire [ 4:0] write_word,
    input  wire [31:0] write_data,
    input  wire [ 3:0] write_bytes,  // which bytes are written
    input  wire [ 4:0] read_word,
    output wire [31:0] read_data,    // on the same clock
    input  wire        look,
    input  wire [ 2:0] look_entry,   // stays for 2 clocks
    output wire [31:0] address,
    output wire [31:0] size,
    output wire [ 7:0] valid,
    input  wire [ 7:0] invalidate
);

  reg look_q;
  reg [31:0] address_q, size_q;
  reg [7:0] valid_q;
  assign address = address_q;
  assign size = size_q;
  assign valid = valid_q;

  // ---- addresses and sizes: a memory for each byte, which is written by itself
  wire [3:0] write_place = {write_word[4:2], write_word[0]};
  wire [3:0] read_place = {read_word[4:2], read_word[0]};
  wire [3:0] look_place = {look_entry, look_q};
  wire [31:0] read_stored, look_stored;
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_bytes
      (* ram_style = "distributed" *)
      reg [7:0] mem [0:15];
      always @(posedge clk)
        if (write && !write_word[1] && write_bytes[i]) mem[write_place] <= write_data[8*i+:8];
      assign read_stored[8*i+:8] = mem[read_place];
      assign look_stored[8*i+:8] = mem[look_place];
    end
  endgenerate
  assign read_data = read_word[1] ? {31'd0, valid_q[read_word[4:2]]} : read_stored;

  // ---- look-up: the address, then the size
  always @(posedge clk) begin
    look_q <= ~rst & look;
    if (look) address_q <= look_stored;
    if (look_q) size_q <= look_stored;
  end

  // ---- valid bits
  wire write_valid = write & write_word[1] & write_bytes[0];
  integer e;
  always @(posedge clk)
    for (e = 0; e < 8; e = e + 1)
      if (rst) valid_q[e] <= 1'b0;
      else if (write_valid && write_word[4:2] == e[2:0]) valid_q[e] <= write_data[0];
      else if (invalidate[e]) valid_q[e] <= 1'b0;

endmodule
`default_nettype wire
