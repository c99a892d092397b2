// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_cache_way: the entries of one way as one port of cchip_cache sees them, in the stages of
// cchip_cache_port: read in 1 to 3, compared in 4, in 5 it is known whether the line is in flight.
//   entry        {valid, locked, victim, slot, tag}: slot is that of the read that filled the frame
//                or will. If the record of that slot still names this frame, the frame is held, and
//                the line is in flight until the slot is filled
//   latency      3 clocks from line1 to match4, 4 to the values of stage 5
//   throughput   a lookup per clock
//   cuts         line4 reaches match4, line5 reaches hold5 within the clock; all else is cut
//   reset        none: entries are unknown until they have been written
//   inside       A cchip_block_ram of entries between registers on both sides, and the frame of
//                each slot in LUT memory. An entry keeps the slot of the read that filled it: that
//                slot's frame says whether the line is still in flight, so nothing has to be
//                written when it has come.
module cchip_cache_way #(
    parameter integer WAY = 0,      // this way; legal: 0, 1
    parameter integer MISSES = 32,  // slots of lines in flight; legal: 2, 4, 8, 16, 32
    parameter integer SET_W = 10,   // width of a set's number (bit); legal: >= 3
    parameter integer LINE_W = 32   // width of a line's number (bit); legal: SET_W + 1 .. 58
) (
    input  wire                                      clk,             // clock, rising edge
    // ---- the one write to the entries
    input  wire                                      write,           // an entry is written
    input  wire [                         SET_W-1:0] write_set,       // of this set
    input  wire [3+$clog2(MISSES)+LINE_W-SET_W-1:0] write_data,  // {valid,locked,victim,slot,tag}
    input  wire                                      allocate,        // a line gets a frame
    input  wire [                $clog2(MISSES)-1:0] allocate_slot,   // slot of its read
    input  wire [                           SET_W:0] allocate_frame,  // {set, way}
    // ---- of each slot: it has a frame; its data are in the frame
    input  wire [                        MISSES-1:0] held,  // bit of each slot: it has a frame
    // bit of each slot: its data are in the frame
    input  wire [                        MISSES-1:0] filled,
    // ---- the lookup, at stages 1, 4 and 5
    input  wire [                         SET_W-1:0] set1,  // set of the lookup in stage 1
    input  wire [                        LINE_W-1:0] line4,  // line of the lookup in stage 4
    input  wire [                         SET_W-1:0] set5,  // set of the lookup in stage 5
    // ---- lines to invalidate
    input  wire [                        LINE_W-1:0] first,           // first line to invalidate
    input  wire [                        LINE_W-1:0] last,            // last line to invalidate
    output wire                                      match4,          // the line is in this way
    output wire                                      match5,          // the same, in stage 5
    output wire                                      valid5,          // the entry has a line
    output wire                                      locked5,         // which is locked
    output wire                                      victim5,         // victim bit of the entry
    output wire                                      hold5,           // a slot holds the frame
    output wire                                      full5,           // its data are in the frame
    output wire [                $clog2(MISSES)-1:0] slot5,           // slot of the entry
    output wire                                      in_range5,  // its line is one to invalidate
    output wire                                      in_range6,       // the same, in stage 6
    output wire                                      victim6,         // victim bit, in stage 6
    output wire [                $clog2(MISSES)-1:0] slot6            // slot, in stage 6
);

  localparam integer SLOT_W = $clog2(MISSES);
  localparam integer TAG_W = LINE_W - SET_W;
  localparam integer ENTRY_W = 3 + SLOT_W + TAG_W;
  localparam [31:0] NUMBER = WAY;

  wire [ENTRY_W-1:0] entry3;
  cchip_block_ram #(.WIDTH(ENTRY_W), .ADDR_W(SET_W)) u_entries (
      .clk       (clk),
      .write     (write),
      .write_addr(write_set),
      .write_data(write_data),
      .read_addr (set1),
      .read_data (entry3)
  );

  reg [ENTRY_W-1:0] entry_q4;
  wire valid4, locked4, victim4;
  wire [SLOT_W-1:0] slot4;
  wire [TAG_W-1:0] tag4;
  assign {valid4, locked4, victim4, slot4, tag4} = entry_q4;
  wire [LINE_W-1:0] stored_line4 = {tag4, line4[SET_W-1:0]};  // the line in this way
  assign match4 = valid4 && stored_line4 == line4;

  `CCHIP_LUT_RAM
  reg [SET_W:0] frames[0:MISSES-1];
  reg match_q5, valid_q5, locked_q5, victim_q5, held_q5, filled_q5, in_range_q5;
  reg [SLOT_W-1:0] slot_q5;
  reg [SET_W:0] frame_q5;
  reg victim_q6, in_range_q6;
  reg [SLOT_W-1:0] slot_q6;
  always @(posedge clk) begin
    entry_q4 <= entry3;
    if (allocate) frames[allocate_slot] <= allocate_frame;
    frame_q5  <= frames[slot4];
    held_q5   <= held[slot4];
    filled_q5 <= filled[slot4];
    match_q5  <= match4;
    valid_q5  <= valid4;
    locked_q5 <= locked4;
    victim_q5 <= victim4;
    slot_q5   <= slot4;
    in_range_q5 <= valid4 && stored_line4 >= first && stored_line4 <= last;
    in_range_q6 <= in_range_q5;
    victim_q6 <= victim_q5;
    slot_q6   <= slot_q5;
  end
  assign match5  = match_q5;
  assign valid5  = valid_q5;
  assign locked5 = locked_q5;
  assign victim5 = victim_q5;
  assign hold5   = held_q5 && frame_q5 == {set5, NUMBER[0]};
  assign full5   = filled_q5;
  assign slot5   = slot_q5;
  assign in_range5 = in_range_q5;
  assign in_range6 = in_range_q6;
  assign victim6 = victim_q6;
  assign slot6   = slot_q6;

endmodule
`default_nettype wire
