// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_cache_requests: which request of one port of cchip_cache is looked up next. New requests
// that find the port taken are deferred, in order; those to be looked up again have a queue of
// their own.
//   turns        if requests of both queues wait, they alternate; a new request is looked up at
//                once if both queues are empty
//   latency      0 clocks: look follows free and s_valid
//   throughput   a lookup on each clock with free = 1
//   cuts         all but free and the new request to the lookup
//   reset        no request. Room is known: at most PLACES requests are with a port at a time
//   inside       Two cchip_fifo: new requests that found the port taken, and those to be looked up
//                again.
module cchip_cache_requests #(
    parameter integer PLACES = 32,  // places of a port (line); legal: 2, 4, 8, 16, 32, 64
    parameter integer LINE_W = 32   // width of a line's number (bit); legal: SET_W + 1 .. 58
) (
    input  wire                      clk,          // clock, rising edge
    input  wire                      rst,          // synchronous reset, active high
    input  wire                      s_valid,      // a new request
    input  wire [$clog2(PLACES)-1:0] s_place,      // its place
    input  wire [        LINE_W-1:0] s_line,       // its line
    // ---- one to be looked up again
    input  wire                      replay,       // a request is to be looked up again
    input  wire [$clog2(PLACES)-1:0] replay_place,  // its place
    input  wire [        LINE_W-1:0] replay_line,  // its line
    // ---- the lookup
    input  wire                      free,         // a request may have this clock
    output wire                      look,         // a request is looked up
    output wire [$clog2(PLACES)-1:0] look_place,   // its place
    output wire [        LINE_W-1:0] look_line     // its line
);

  localparam integer WIDTH = $clog2(PLACES) + LINE_W;

  wire deferred_valid, replay_valid, deferred_ready, replay_ready;
  wire [WIDTH-1:0] deferred_data, replay_data;
  // The queue of those to be looked up again has its turn. Whether it is read does not depend on a
  // request that comes on this clock, which would cross the chip to its flip-flops.
  reg replay_first_q;
  wire use_replay = replay_valid & (replay_first_q | ~deferred_valid);
  cchip_fifo #(.WIDTH(WIDTH), .DEPTH(PLACES), .ROOM_KNOWN(1)) u_deferred (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_valid & (~free | deferred_valid | replay_valid)),
      .s_ready(deferred_ready),
      .s_data ({s_place, s_line}),
      .m_valid(deferred_valid),
      .m_ready(free & ~use_replay),
      .m_data (deferred_data)
  );
  cchip_fifo #(.WIDTH(WIDTH), .DEPTH(PLACES), .ROOM_KNOWN(1)) u_replay(
      .clk    (clk),
      .rst    (rst),
      .s_valid(replay),
      .s_ready(replay_ready),
      .s_data ({replay_place, replay_line}),
      .m_valid(replay_valid),
      .m_ready(free & use_replay),
      .m_data (replay_data)
  );
  always @(posedge clk)
    if (rst) replay_first_q <= 1'b0;
    else if (free && replay_valid) replay_first_q <= ~use_replay;
  assign look = free & (replay_valid | deferred_valid | s_valid);
  assign {look_place, look_line} = use_replay ? replay_data :
      deferred_valid ? deferred_data : {s_place, s_line};

  wire unused = &{1'b0, deferred_ready, replay_ready};

endmodule
`default_nettype wire
