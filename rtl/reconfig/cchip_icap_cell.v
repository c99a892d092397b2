// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_icap_cell: the port ICAPE2 or ICAPE3 of a Xilinx device, portable twin for simulation and
// for all other devices. In a Xilinx device rtl/cchip_xilinx.f puts the cell itself in its place.
//   twin         undoes the swap of the bits of each byte. The sync word aligns it, the command
//                DESYNC ends that; status as in UG470: 0x9F without, 0xDF with alignment, bit 7 is
//                0 after a word of another kind where packets begin, until the next sync word
//   latency      1 clock to the status
//   cuts         every path: all outputs are flip-flops or constants
//   reset        none: what a device knows outlives the reset of its logic; power-up not aligned
//   test         through the parent, cchip_icap
module cchip_icap_cell #(
    parameter integer FAMILY = 7  // 7: ICAPE2 of 7 series, 8: ICAPE3 of UltraScale(+); legal: 7, 8
) (
    input  wire        clk,     // clock, rising edge
    input  wire        csib,    // 0: the port is active
    input  wire        rdwrb,   // 0: a word is written; must not change while csib = 0
    input  wire [31:0] i,       // word, first byte highest, bits of each byte swapped
    output wire [31:0] o,       // status while nothing is read
    output wire        avail,   // ICAPE3: the port can be used; ICAPE2: 1
    output wire        prerror  // ICAPE3: an error of the bitstream; ICAPE2: 0
);

  localparam [31:0] SYNC = 32'hAA995566, WRITE_CMD = 32'h30008001, DESYNC = 32'h0000000D;

  wire [31:0] word;
  genvar k;
  generate
    for (k = 0; k < 32; k = k + 1) begin : gen_unswapped
      assign word[k] = i[(k/8)*8+7-k%8];
    end
  endgenerate

  reg aligned_q, error_q, command_q;
  initial {aligned_q, error_q, command_q} = 3'd0;
  reg [26:0] left_q;  // words of the packet in progress
  initial left_q = 27'd0;
  wire [2:0] kind = word[31:29];  // 1: a packet of up to 2047 words, 2: a long one

  always @(posedge clk)
    if (!csib && !rdwrb) begin
      if (!aligned_q) begin
        if (word == SYNC) begin
          aligned_q <= 1'b1;
          error_q   <= 1'b0;
          left_q    <= 27'd0;
          command_q <= 1'b0;
        end
      end else if (left_q != 27'd0) begin
        left_q <= left_q - 27'd1;
        if (command_q && word == DESYNC) aligned_q <= 1'b0;
        command_q <= 1'b0;
      end else begin
        command_q <= word == WRITE_CMD;
        // words of a packet that writes; a read has none
        left_q <= word[28:27] != 2'b10 ? 27'd0 : kind == 3'd1 ? {16'd0, word[10:0]} : word[26:0];
        if (kind != 3'd1 && kind != 3'd2) begin
          error_q <= 1'b1;
          left_q  <= 27'd0;
        end
      end
    end

  assign o = {24'hFFFFFF, ~error_q, aligned_q, 6'h1F};
  assign avail = 1'b1;
  assign prerror = FAMILY == 8 && error_q;

endmodule
`default_nettype wire
