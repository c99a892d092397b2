// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_cache_change: the one write to the entries of cchip_cache. On each clock one of these, in
// this order: an entry is cleared after reset, a line that could not be read is invalidated (kill),
// the lines that a walk has found are, a line gets a frame. A lookup whose change is not made is
// repeated by its port.
//   grant        which port gets a frame, with free_slot; of two that want one they alternate
//   latency      1 clock from stage 6 to the write and to allocate
//   cuts         entry_*, change_by and allocate*; grant, granted and walk_next follow stage 6
//   reset        nothing is changed
//   rules        A port whose change is not made looks its request up again.
//   why          One writer keeps the two ports consistent: a lookup whose set it has changed is
//                repeated, instead of a forwarding path for each stage. Whether any frame is
//                granted does not depend on the turn, so the free slot leaves its pool early in the
//                clock.
module cchip_cache_change #(
    parameter integer MISSES = 32,  // slots of lines in flight; legal: 2, 4, 8, 16, 32
    parameter integer SET_W = 10,   // width of a set's number (bit); legal: >= 3
    parameter integer LINE_W = 32   // width of a line's number (bit); legal: SET_W + 1 .. 58
) (
    input  wire                                       clk,             // clock, rising edge
    input  wire                                       rst,  // synchronous reset, active high
    input  wire                                       running,         // 0: entries are cleared
    input  wire [                          SET_W-1:0] clear_set,       // both entries of this set
    // ---- port 0: a fill without data
    input  wire                                       kill,  // port 0: a line came without data
    input  wire [                 $clog2(MISSES)-1:0] kill_slot,       // its slot
    input  wire [                                1:0] kill_way,        // its way, one-hot
    // ---- port 1: a walk has looked a set up
    // port 1: a set has been looked up for an invalidation
    input  wire                                       walk,
    input  wire                                       walk_stale,      // it has changed meanwhile
    // there are lines of the range in it
    input  wire                                       walk_hits,
    input  wire [                                1:0] walk_ways,       // ways that have one
    input  wire [             2*($clog2(MISSES)+1)-1:0] walk_keep,     // {victim, slot} of each way
    output wire                                       walk_next,       // the set is done
    // ---- both ports: a line wants a frame
    // bit p: port p wants a frame for its line
    input  wire [                                1:0] want,
    input  wire [                                1:0] want_way,        // bit p: its way
    // bit p: the line is to be locked
    input  wire [                                1:0] want_locked,
    input  wire [                                1:0] want_victim,     // bit p: its victim bit
    input  wire [                       2*LINE_W-1:0] line,  // line in stage 6 of each port
    input  wire [                 $clog2(MISSES)-1:0] free_slot,       // slot that the line gets
    output wire [                                1:0] grant,  // bit p: port p gets the frame
    output wire                                       granted,         // one of them does; |grant
    // ---- the write, {valid, locked, victim, slot, tag} of each way
    output wire [                                1:0] entry_write,  // ways whose entry is written
    output wire [                          SET_W-1:0] entry_set,       // set of the write
    // {valid, locked, victim, slot, tag} of each way
    output wire [2*(3+$clog2(MISSES)+LINE_W-SET_W)-1:0] entry_data,
    // bit p: the change comes from port p
    output wire [                                1:0] change_by,
    output wire                                       allocate,        // a line gets a frame
    output wire [                 $clog2(MISSES)-1:0] allocate_slot,   // its slot
    output wire [                            SET_W:0] allocate_frame,  // {set, way}
    output wire [                         LINE_W-1:0] allocate_line    // its line
);

  localparam integer SLOT_W = $clog2(MISSES);
  localparam integer TAG_W = LINE_W - SET_W;
  localparam integer ENTRY_W = 3 + SLOT_W + TAG_W;

  reg favour_q;  // port that gets a frame if both want one
  wire walk_write = walk_hits & ~walk_stale & ~kill;
  assign walk_next = walk & ~walk_stale & ~(kill & walk_hits);
  assign grant[0] = want[0] & ~walk_write & ~(want[1] & favour_q);
  assign grant[1] = want[1] & ~kill & ~(want[0] & ~favour_q);
  // Whether any is granted does not depend on the turn: of two that want a frame, one gets it.
  assign granted = (want[0] & ~walk_write) | (want[1] & ~kill);

  // the port whose line gets a frame; any, if none does
  wire by = want[1] & (favour_q | ~want[0]);
  wire [LINE_W-1:0] its_line = by ? line[LINE_W+:LINE_W] : line[0+:LINE_W];
  wire way = by ? want_way[1] : want_way[0];
  wire [ENTRY_W-TAG_W-1:0] entry = {
    1'b1, by ? want_locked[1] : want_locked[0], by ? want_victim[1] : want_victim[0], free_slot
  };

  reg [1:0] entry_write_q, change_by_q;
  reg [SET_W-1:0] entry_set_q;
  reg [2*ENTRY_W-1:0] entry_data_q;
  reg allocate_q;
  reg [SLOT_W-1:0] allocate_slot_q;
  reg [SET_W:0] allocate_frame_q;
  reg [LINE_W-1:0] allocate_line_q;
  genvar w;
  generate
    for (w = 0; w < 2; w = w + 1) begin : gen_entry
      // The tag of an entry without a line may be any. It is that of its_line in every change, so
      // that the choice among the changes is not on the path to it.
      always @(posedge clk)
        entry_data_q[ENTRY_W*w+:ENTRY_W] <= {
          !running ? {ENTRY_W - TAG_W{1'b0}} : kill ? {3'b000, kill_slot} :
              walk_write ? {2'b00, walk_keep[(SLOT_W+1)*w+:SLOT_W+1]} : entry,
          its_line[LINE_W-1:SET_W]
        };
    end
  endgenerate
  always @(posedge clk) begin
    entry_set_q <= !running ? clear_set : kill ? line[SET_W-1:0] :
        walk_write ? line[LINE_W+:SET_W] : its_line[SET_W-1:0];
    allocate_slot_q  <= free_slot;
    allocate_frame_q <= {its_line[SET_W-1:0], way};
    allocate_line_q  <= its_line;
    if (rst) begin
      entry_write_q <= 2'b00;
      change_by_q   <= 2'b00;
      allocate_q    <= 1'b0;
      favour_q      <= 1'b0;
    end else begin
      entry_write_q <= !running ? 2'b11 : kill ? kill_way : walk_write ? walk_ways :
          {way, ~way} & {2{granted}};
      change_by_q <= {grant[1] | walk_write, grant[0] | kill};
      allocate_q  <= granted;
      if (&want) favour_q <= ~favour_q;
    end
  end
  assign entry_write    = entry_write_q;
  assign entry_set      = entry_set_q;
  assign entry_data     = entry_data_q;
  assign change_by      = change_by_q;
  assign allocate       = allocate_q;
  assign allocate_slot  = allocate_slot_q;
  assign allocate_frame = allocate_frame_q;
  assign allocate_line  = allocate_line_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_grant, grant != 2'b11 && granted == |grant)
      `CCHIP_ASSERT(a_one_change, !(|grant) || !(kill || walk_write))
    end

endmodule
`default_nettype wire
