// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_config_port: payload of a bitstream from a stream of 32-bit words to the configuration
// port, low byte first, with its CRC-32. The port takes one word in CFG_DIVIDER clocks, called a
// slot; the first slot begins when the first word is there.
//   latency      transfer = 1 + CFG_DIVIDER * (port words + slots without data) clocks from s_valid
//                and run to done
//   throughput   one port word per slot, while s_valid = 1
//   cuts         every path but s_ready: each output is a flip-flop
//   power-up     cfg_valid is 0 by its initial value: no word may enter the device before the first
//                rst; a tool without initial values must start with rst = 1
//   reset        run = 0 ends a transfer and prepares the next: it must be 0 for a clock between
//                two; length is read then
//   numbers      of the last 32-bit word only the bytes within length are used; length is a
//                multiple of 4 for CFG_W = 32
//   timing       From there on a word passes at the end of every slot that has data.
//   numbers      8 bit: byte 0 of each word first, the last word as far as length goes. 32 bit:
//                whole words.
//   inside       A clock divider that starts with the first word, a counter of port words, the byte
//                number, cchip_crc32 behind the output registers: it sees what the device sees.
//   why          The divider is an enable of the one clock, not a clock. A slot without data is
//                lost whole, as on a port whose clock runs on, and counted as a stall.
module cchip_config_port #(
    parameter integer CFG_W = 8,       // width of the configuration port (bit); legal: 8, 32
    // clocks per word of the port; at 100 MHz 2 for 8 bit at 50 MHz, 1 for 32 bit at 100 MHz;
    // legal: >= 1
    parameter integer CFG_DIVIDER = 2
) (
    input  wire             clk,        // clock, rising edge
    input  wire             rst,        // synchronous reset, active high
    input  wire             run,        // 1: work
    input  wire [     31:0] length,     // of the payload, byte, > 0; read while run = 0
    input  wire             s_valid,    // s_data is the next word
    output wire             s_ready,    // the word is taken if s_valid = 1 as well
    input  wire [     31:0] s_data,     // word
    output wire             cfg_valid,  // a word passes the configuration port, one clock
    output wire [CFG_W-1:0] cfg_data,   // the word, first byte lowest
    output wire             done,       // every word has passed
    output wire [     31:0] crc,        // CRC-32 of the words that passed, two clocks after them
    output wire             stall       // a slot of the port passes without data
);

  localparam integer SLOT_W = CFG_DIVIDER > 1 ? $clog2(CFG_DIVIDER) : 1;
  localparam [31:0] SLOT = CFG_DIVIDER - 1;
  localparam [SLOT_W-1:0] ONE = 1;

  `CCHIP_REFUSE((CFG_W != 8 && CFG_W != 32) || CFG_DIVIDER < 1,
                cchip_error_config_port_CFG_W_must_be_8_or_32_and_CFG_DIVIDER_above_0)

  reg ticking_q, done_q, stall_q;
  reg [SLOT_W-1:0] slot_q;  // clocks left in this slot
  reg [31:0] left_q;  // port words
  reg valid_q;
  initial valid_q = 1'b0;
  reg [CFG_W-1:0] data_q;

  wire tick = ticking_q && slot_q == {SLOT_W{1'b0}} && !done_q;
  wire emit = tick & s_valid;
  reg last_q;  // left_q == 1
  wire [CFG_W-1:0] piece;
  wire [31:0] words;  // of the port

  generate
    if (CFG_W == 32) begin : gen_word
      assign piece   = s_data;
      assign s_ready = emit;
      assign words = {2'b00, length[31:2]};
      wire unused = &{1'b0, length[1:0]};
    end else begin : gen_byte
      reg [1:0] lane_q;
      assign piece   = s_data[{lane_q, 3'd0}+:8];
      assign s_ready = emit && (lane_q == 2'd3 || last_q);
      assign words = length;
      always @(posedge clk) lane_q <= !run ? 2'd0 : emit ? lane_q + 2'd1 : lane_q;
    end
  endgenerate

  always @(posedge clk) begin
    slot_q <= !ticking_q || slot_q == {SLOT_W{1'b0}} ? SLOT[SLOT_W-1:0] : slot_q - ONE;
    if (emit) data_q <= piece;
    left_q <= !run ? words : emit ? left_q - 32'd1 : left_q;
    last_q <= !run ? words == 32'd1 : emit ? left_q == 32'd2 : last_q;
    if (rst || !run) begin
      ticking_q <= 1'b0;
      done_q    <= 1'b0;
      valid_q   <= 1'b0;
      stall_q   <= 1'b0;
    end else begin
      ticking_q <= ticking_q | s_valid;
      done_q    <= done_q | (emit & last_q);
      valid_q   <= emit;
      stall_q   <= tick & ~s_valid;
    end
  end

  assign cfg_valid = valid_q;
  assign cfg_data = data_q;
  assign done = done_q;
  assign stall = stall_q;

  // the CRC is read after the transfer, so it is cleared only when the next transfer begins
  cchip_crc32 #(
      .DATA_W(CFG_W)
  ) u_crc (
      .clk  (clk),
      .clear(run & ~ticking_q),
      .valid(valid_q),
      .data (data_q),
      .crc  (crc)
  );

endmodule
`default_nettype wire
