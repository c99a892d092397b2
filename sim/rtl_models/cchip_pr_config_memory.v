// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_pr_config_memory: what a device's configuration memory does to one slot; for simulations.
// All slots see every word written to the configuration port.
//   payload      low byte first: CCHIP_BITSTREAM_SYNC, {0 (16 bit), module, slot}, filler, CRC-32
//                (as zlib) of all bytes before it; at least CCHIP_BITSTREAM_PAYLOAD_MIN bytes. The
//                synchronisation word must not occur again: wherever it occurs (32-bit port: in one
//                word) a new payload begins, so a truncated one blocks nothing
//   garbage      1: what is in the slot is undefined: from the word that names the slot until a
//                complete, correct payload has passed; also again from any word after its end that
//                is not the beginning of the next payload
//   select       the module in the slot, CCHIP_RM_*; valid while garbage = 0
//   latency      1 clock from a word of the port to garbage and select
//   reset        none: a configuration survives a reset; RM_ID is the module at power-up
module cchip_pr_config_memory #(
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    // number of this slot, compared with the one in a payload; legal: 0..255
    parameter integer SLOT_ID = 0,
    parameter integer RM_ID = 1,    // module at power-up, CCHIP_RM_BLANK on; legal: 0..KINDS
    parameter integer CFG_W = 8     // width of the configuration port (bit); legal: 8, 32
) (
    input  wire                      clk,        // clock, rising edge
    input  wire                      cfg_valid,  // a word is written to the configuration port
    input  wire [         CFG_W-1:0] cfg_data,   // the word, low byte first
    output wire                      garbage,    // what is in the slot is undefined
    output wire [`CCHIP_RM_ID_W-1:0] select      // the module in the slot; valid while garbage = 0
);

  localparam [31:0] SLOT = SLOT_ID;
  localparam [31:0] RM = RM_ID;
  localparam [31:0] LAST = KINDS;
  localparam [31:0] CFG_BYTES = CFG_W / 8;
  localparam [31:0] SYNC = `CCHIP_BITSTREAM_SYNC;
  localparam [31:0] RESIDUE = 32'hDEBB20E3;  // CRC-32 register after a message and its CRC

  function [31:0] crc_byte(input [31:0] crc, input [7:0] data);
    integer i;
    begin
      crc_byte = crc ^ {24'd0, data};
      for (i = 0; i < 8; i = i + 1) crc_byte = {1'b0, crc_byte[31:1]}
          ^ (crc_byte[0] ? 32'hEDB88320 : 32'd0);
    end
  endfunction
  function [31:0] crc_word(input [31:0] crc, input [31:0] data);
    crc_word = crc_byte(crc_byte(crc_byte(crc_byte(crc, data[7:0]), data[15:8]), data[23:16]),
        data[31:24]);
  endfunction

  reg [31:0] crc_q;
  reg [4:0] count_q;  // bytes of this payload, up to 16; 0: none
  reg ours_q;  // payload for this slot
  reg [1:0] next_q;  // bytes of the next synchronisation word after its end
  reg legal_q;  // its module exists, its unused bits are 0
  reg [`CCHIP_RM_ID_W-1:0] module_q;
  reg garbage_q;
  reg [`CCHIP_RM_ID_W-1:0] select_q;
  initial count_q = 5'd0;
  initial ours_q = 1'b0;
  initial garbage_q = 1'b0;
  initial select_q = RM[7:0];

  assign garbage = garbage_q;
  assign select  = select_q;

  wire [31:0] word;  // the last four bytes
  wire [31:0] crc_next;
  wire match;  // continues with it
  wire next;  // perhaps the beginning of the next payload
  generate
    if (CFG_W == 8) begin : gen_bytes
      reg [23:0] last_q;  // the last three bytes
      initial last_q = 24'd0;
      always @(posedge clk) if (cfg_valid) last_q <= word[31:8];
      assign word = {cfg_data, last_q};
      assign crc_next = crc_byte(crc_q, cfg_data);
      assign match =
          cfg_data == (next_q[1] ? (next_q[0] ? SYNC[31:24] : SYNC[23:16]) : next_q[0]
              ? SYNC[15:8] : SYNC[7:0]);
      assign next = match || cfg_data == SYNC[7:0];
    end else if (CFG_W == 32) begin : gen_words
      assign word = cfg_data;
      assign crc_next = crc_word(crc_q, cfg_data);
      assign match = 1'b0;
      assign next = 1'b0;
    end else begin : gen_illegal
      cchip_error_CFG_W_must_be_8_or_32 u_error ();
    end
    if (SLOT_ID < 0 || SLOT_ID > 255) begin : gen_illegal_slot
      cchip_error_SLOT_ID_must_be_0_to_255 u_error ();
    end
    if (KINDS != 3 && KINDS != 4) begin : gen_illegal_kinds
      cchip_error_memory_KINDS_must_be_3_or_4 u_error ();
    end
    if (RM_ID < 0 || RM_ID > KINDS) begin : gen_illegal_module
      cchip_error_RM_ID_must_be_0_to_KINDS u_error ();
    end
  endgenerate

  wire sync = word == SYNC;
  wire [4:0] count_d = sync ? 5'd4 : count_q == 5'd0 || count_q == 5'd16 ? count_q : count_q
      + CFG_BYTES[4:0];
  wire named = count_d == 5'd8;  // word is {0, module, slot}
  wire here = word[7:0] == SLOT[7:0];
  wire complete = legal_q && count_d == 5'd16 && crc_next == RESIDUE;

  always @(posedge clk)
    if (cfg_valid) begin
      crc_q   <= sync ? crc_word(32'hFFFFFFFF, SYNC) : crc_next;
      count_q <= count_d;
      if (sync) begin
        ours_q <= 1'b0;
      end else if (named) begin
        ours_q   <= here;
        module_q <= word[15:8];
        legal_q  <= word[31:16] == 16'd0 && word[15:8] <= LAST[7:0];
        if (here) garbage_q <= 1'b1;
      end else if (ours_q) begin
        garbage_q <= ~complete & (garbage_q | ~next);
        next_q    <= complete ? 2'd0 : match ? next_q + 2'd1 : 2'd1;
        if (complete) select_q <= module_q;
      end
    end

endmodule
`default_nettype wire
