// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_swap_request: the request that cchip_swap_sequencer works on, whether it is legal, and what
// its slot looks like.
//   request      s_swap_data of the clock with begins = 1
//   illegal      there is no such slot or module, the bitstream is empty, not at a multiple of 64
//                bytes, or ends beyond 4 GiB
//   latency      1 clock from begins to the fields and to mine; 2 from a change of the slot, 3 from
//                the fields, to what is known of them
//   cuts         every path: each output is a flip-flop, given_up a choice among inputs
//   reset        none: the fields count from the first begins on
module cchip_swap_request #(
    parameter integer SLOTS = 1  // slots; legal: 1..4
) (
    input  wire                                 clk,            // clock, rising edge
    // {force, size, address, module, slot}
    input  wire [    `CCHIP_SWAP_REQUEST_W-1:0] s_swap_data,
    input  wire                                 begins,         // the swap of s_swap_data begins
    // ---- the slots
    input  wire [                    SLOTS-1:0] quiet,  // bit of each slot: no pair is inside
    input  wire [                    SLOTS-1:0] decoupled,      // bit of each slot: it is decoupled
    // bit of each slot: its reset on configuration is in progress
    input  wire [                    SLOTS-1:0] roc_busy,
    input  wire [     `CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id,   // module that each slot shows
    input  wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] lost,           // pairs that each slot has given up
    // ---- the request
    output wire [         `CCHIP_SLOT_ID_W-1:0] slot,           // slot
    output wire [           `CCHIP_RM_ID_W-1:0] module_id,      // module
    output wire [                         31:0] address,        // address of the bitstream
    output wire [                         31:0] size,           // its size, byte
    output wire                                 forced,         // pairs may be given up
    // its slot, one-hot; 0 if there is no such slot
    output wire [                    SLOTS-1:0] mine,
    output wire                                 is_quiet,       // no pair is inside the slot
    output wire                                 is_decoupled,   // the slot is decoupled
    // its reset on configuration is in progress
    output wire                                 is_roc_busy,
    output wire                                 match,  // the slot shows the module asked for
    output wire                                 same,           // and is active with it
    output wire                                 illegal,        // the request is illegal
    output wire [      `CCHIP_PAIR_COUNT_W-1:0] given_up        // pairs that the slot has given up
);

  wire [`CCHIP_SLOT_ID_W-1:0] s_swap_slot;
  wire [`CCHIP_RM_ID_W-1:0] s_swap_module;
  wire [31:0] s_swap_address, s_swap_size;
  wire s_swap_force;
  assign `CCHIP_SWAP_REQUEST_OF(s_swap_slot, s_swap_module, s_swap_address, s_swap_size,
      s_swap_force) = s_swap_data;

  reg [`CCHIP_SLOT_ID_W-1:0] slot_q;
  reg [`CCHIP_RM_ID_W-1:0] module_q;
  reg [31:0] address_q, size_q;
  reg force_q;
  reg [SLOTS-1:0] mine_q;
  integer s;
  always @(posedge clk)
    if (begins) begin
      for (s = 0; s < SLOTS; s = s + 1) mine_q[s] <= s_swap_slot == s[`CCHIP_SLOT_ID_W-1:0];
      slot_q    <= s_swap_slot;
      module_q  <= s_swap_module;
      address_q <= s_swap_address;
      size_q    <= s_swap_size;
      force_q   <= s_swap_force;
    end
  assign slot      = slot_q;
  assign module_id = module_q;
  assign address   = address_q;
  assign size      = size_q;
  assign forced    = force_q;
  assign mine      = mine_q;

  wire [`CCHIP_RM_ID_W-1:0] shown;
  cchip_onehot_mux #(
      .N    (SLOTS),
      .WIDTH(`CCHIP_RM_ID_W)
  ) u_shown (
      .select(mine_q),
      .s_data(region_rm_id),
      .m_data(shown)
  );
  cchip_onehot_mux #(
      .N    (SLOTS),
      .WIDTH(`CCHIP_PAIR_COUNT_W)
  ) u_given_up (
      .select(mine_q),
      .s_data(lost),
      .m_data(given_up)
  );

  reg quiet_q, decoupled_q, roc_busy_q, match_q, same_q, illegal_q;
  wire [32:0] past = {1'b0, address_q} + {1'b0, size_q};  // the byte behind the file
  reg over_q;  // it lies beyond 4 GiB, unless its lower 32 bits, of which rest_q knows, are 0
  reg [3:0] rest_q;
  always @(posedge clk) begin
    quiet_q     <= |(quiet & mine_q);
    decoupled_q <= |(decoupled & mine_q);
    roc_busy_q  <= |(roc_busy & mine_q);
    match_q     <= shown == module_q;
    same_q      <= ~decoupled_q & match_q;
    over_q      <= past[32];
    rest_q      <= {|past[31:24], |past[23:16], |past[15:8], |past[7:0]};
    illegal_q   <= mine_q == {SLOTS{1'b0}} || module_q > `CCHIP_RM_POINT_TRI ||
        address_q[5:0] != 6'd0 || size_q == 32'd0 || (over_q && rest_q != 4'd0);
  end
  assign is_quiet     = quiet_q;
  assign is_decoupled = decoupled_q;
  assign is_roc_busy  = roc_busy_q;
  assign match        = match_q;
  assign same         = same_q;
  assign illegal      = illegal_q;

endmodule
`default_nettype wire
