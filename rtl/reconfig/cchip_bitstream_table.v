// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_bitstream_table: where the bitstreams are: address, size and a valid bit of each entry,
// entry 4 * slot + module. Addresses and sizes are in distributed RAM.
//   registers    word {entry, 0} is the address, {entry, 1} the size, {entry, 2} the valid bit; of
//                a slot that is not there they read as 0 and stay so
//   latency      look-up: 2 clocks from look to address and size, which stay until the next one
//   throughput   a write and a read on every clock, a look-up every 2 clocks
//   collision    a write counts from the next clock on; of a write and invalidate on one clock the
//                write counts
//   cuts         every path but read_word to read_data
//   reset        valid: 0; addresses and sizes are undefined until written
module cchip_bitstream_table #(
    // slots, 1..4
    parameter integer SLOTS = 2
) (
    input  wire               clk,
    input  wire               rst,
    input  wire               write,
    input  wire [        5:0] write_word,
    input  wire [       31:0] write_data,
    input  wire [        3:0] write_bytes,  // which bytes are written
    input  wire [        5:0] read_word,
    output wire [       31:0] read_data,    // on the same clock
    input  wire               look,
    input  wire [        3:0] look_entry,   // stays for 2 clocks
    output wire [       31:0] address,
    output wire [       31:0] size,
    output wire [4*SLOTS-1:0] valid,
    input  wire [4*SLOTS-1:0] invalidate
);

  localparam integer ENTRY_W = SLOTS > 2 ? 4 : SLOTS > 1 ? 3 : 2;
  localparam [31:0] ENTRIES = 4 * SLOTS;

  generate
    if (SLOTS < 1 || SLOTS > 4) begin : gen_illegal
      cchip_error_SLOTS_must_be_1_to_4 u_error ();
    end
  endgenerate

  reg look_q;
  reg [31:0] address_q, size_q;
  reg [4*SLOTS-1:0] valid_q;
  assign address = address_q;
  assign size = size_q;
  assign valid = valid_q;

  // ---- addresses and sizes: a memory for each byte, which is written by itself
  wire writes = write && {28'd0, write_word[5:2]} < ENTRIES;
  wire [ENTRY_W:0] write_place = {write_word[2+:ENTRY_W], write_word[0]};
  wire [ENTRY_W:0] read_place = {read_word[2+:ENTRY_W], read_word[0]};
  wire [ENTRY_W:0] look_place = {look_entry[ENTRY_W-1:0], look_q};
  wire [31:0] read_stored, look_stored;
  genvar i;
  generate
    for (i = 0; i < 4; i = i + 1) begin : gen_bytes
      (* ram_style = "distributed", ramstyle = "MLAB" *)
      reg [7:0] mem [0:(2<<ENTRY_W)-1];
      always @(posedge clk)
        if (writes && !write_word[1] && write_bytes[i]) mem[write_place] <= write_data[8*i+:8];
      assign read_stored[8*i+:8] = mem[read_place];
      assign look_stored[8*i+:8] = mem[look_place];
    end
  endgenerate
  wire [15:0] valid_of = {{16 - 4 * SLOTS{1'b0}}, valid_q};
  assign read_data = {28'd0, read_word[5:2]} >= ENTRIES ? 32'd0
      : read_word[1] ? {31'd0, valid_of[read_word[5:2]]} : read_stored;

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
    for (e = 0; e < 4 * SLOTS; e = e + 1)
      if (rst) valid_q[e] <= 1'b0;
      else if (write_valid && write_word[5:2] == e[3:0]) valid_q[e] <= write_data[0];
      else if (invalidate[e]) valid_q[e] <= 1'b0;

  wire unused = &{1'b0, look_entry};

endmodule
`default_nettype wire
