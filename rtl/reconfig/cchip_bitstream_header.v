// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_bitstream_header: takes the four words of a bitstream's header and says what is wrong with
// them.
//   latency      3 clocks from the last word to done; payload_* stay until the next header
//   throughput   one word per clock
//   reset        clear must be 1 for 2 clocks at least between two headers; slot, module_id and
//                size must not change from then to done
module cchip_bitstream_header #(
    parameter integer CFG_W = 8  // width of the configuration port (bit); legal: 8, 32
) (
    input  wire                        clk,             // clock, rising edge
    input  wire                        clear,  // 1 between two headers, for 2 clocks or more
    input  wire                        s_valid,         // s_data is the next word
    input  wire [                31:0] s_data,          // word
    input  wire [`CCHIP_SLOT_ID_W-1:0] slot,            // slot
    input  wire [  `CCHIP_RM_ID_W-1:0] module_id,       // module
    input  wire [                31:0] size,            // header and payload, byte
    output wire                        done,            // four words are here and judged
    output wire                        ok,              // the header is right; with done
    // what is wrong if ok = 0: MAGIC, SLOT, MODULE or LENGTH, the first of them
    output wire [   `CCHIP_SWAP_W-1:0] code,
    output wire [                31:0] payload_length,  // length of the payload, byte
    output wire [                31:0] payload_crc      // CRC-32 of the payload
);

  reg [31:0] magic_q, names_q, length_q, crc_q, expected_q;
  reg [2:0] words_q;
  reg compared_q, magic_ok_q, slot_ok_q, module_ok_q, size_ok_q, length_ok_q;
  reg done_q, ok_q;
  reg [`CCHIP_SWAP_W-1:0] code_q;

  always @(posedge clk) begin
    // a shift register of four words: after the last one, the first word is in magic_q
    if (s_valid && !words_q[2]) {crc_q, length_q, names_q, magic_q} <= {s_data, crc_q, length_q,
        names_q};
    words_q <= clear ? 3'd0 : words_q + {2'd0, s_valid & ~words_q[2]};
    compared_q <= ~clear & words_q[2];
    expected_q <= size - `CCHIP_BITSTREAM_HEADER;
    magic_ok_q <= magic_q == `CCHIP_BITSTREAM_MAGIC && names_q[31:16] == 16'd0;
    slot_ok_q <= names_q[15:8] == slot;
    module_ok_q <= names_q[7:0] == module_id;
    size_ok_q <= size >= `CCHIP_BITSTREAM_HEADER + `CCHIP_BITSTREAM_PAYLOAD_MIN;
    length_ok_q <= length_q == expected_q && size_ok_q && (CFG_W == 8 || length_q[1:0] == 2'd0);
    done_q <= ~clear & compared_q;
    ok_q <= magic_ok_q & slot_ok_q & module_ok_q & length_ok_q;
    code_q <= !magic_ok_q ? `CCHIP_SWAP_MAGIC : !slot_ok_q ? `CCHIP_SWAP_SLOT :
        !module_ok_q ? `CCHIP_SWAP_MODULE : `CCHIP_SWAP_LENGTH;
  end

  assign done = done_q;
  assign ok = ok_q;
  assign code = code_q;
  assign payload_length = length_q;
  assign payload_crc = crc_q;

endmodule
`default_nettype wire
