// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_cache_waiters: the requests of one port of cchip_cache that wait for a line in flight, and
// those whose line has come. Of each place: asleep (on which slot), awake (to be served), neither.
//   sleep        sleep = 1: the request that was on look_place a clock before waits for sleep_slot
//   collect      all that wait for collect_slot are awake from the next clock on; not while one is
//   serve        one after the other, the lowest place first; serve_valid, serve_place, serve_code
//                and serve_frame stay until serve_ready. serving = 0 says that none is left whose
//                frame is needed after this clock
//   retry        retried tells of each place whether its request was to be looked up again when it
//                was decided upon last
//   latency      1 clock from collect to serving, 2 to serve_valid
//   throughput   one request per clock
//   cuts         all but serve_ready to serving
//   reset        no request waits
//   inside       Of each place two bits, asleep and awake, and the slot it waits for. The lowest
//                place that is awake is found by groups of four: a carry chain over 64 bits is
//                slower.
//   why          The slot is written whenever a decision about the place falls, not only when the
//                request falls asleep: that is known too late in the clock to enable registers of
//                all places. It counts only while the place is asleep.
module cchip_cache_waiters #(
    parameter integer PLACES = 32,  // places of a port (line); legal: 2, 4, 8, 16, 32, 64
    parameter integer MISSES = 32,  // slots of lines in flight; legal: 2, 4, 8, 16, 32
    parameter integer FRAME_W = 12  // width of a frame's number, {set, way} (bit); legal: >= 1
) (
    input  wire                          clk,            // clock, rising edge
    input  wire                          rst,            // synchronous reset, active high
    // ---- a lookup, a clock before it is decided upon
    input  wire                          look,  // a lookup is decided upon on the next clock
    input  wire [    $clog2(PLACES)-1:0] look_place,     // its place
    // ---- the decision: one of these, or neither
    input  wire                          sleep,          // the decision: it waits for a line
    input  wire [    $clog2(MISSES)-1:0] sleep_slot,     // slot of that line
    input  wire                          retry,  // the decision: it is to be looked up again
    output wire [            PLACES-1:0] retried,  // bit of each place: the last decision was retry
    input  wire                          collect,        // a line has come
    input  wire [    $clog2(MISSES)-1:0] collect_slot,   // its slot
    input  wire [`CCHIP_READ_CODE_W-1:0] collect_code,   // outcome of its read
    input  wire [           FRAME_W-1:0] collect_frame,  // its frame; both stay while serving = 1
    // ---- a request whose line has come
    output wire                          serving,        // the frame is still needed
    output wire                          serve_valid,    // a request whose line has come
    input  wire                          serve_ready,  // it is accepted if serve_valid = 1 as well
    output wire [    $clog2(PLACES)-1:0] serve_place,    // its place
    output wire [`CCHIP_READ_CODE_W-1:0] serve_code,     // outcome of the read
    output wire [           FRAME_W-1:0] serve_frame,    // frame of the line
    output wire [            PLACES-1:0] waiting  // bit of each place: it waits, or is to be served
);

  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer SLOT_W = $clog2(MISSES);
  localparam integer CODE_W = `CCHIP_READ_CODE_W;

  reg [PLACES-1:0] asleep_q, awake_q, retried_q;
  reg serve_q;
  wire load = ~serve_q | serve_ready;
  // Which place is served is known late in the clock, so awake_q is updated a clock later, with
  // the number of the place served.
  reg [PLACE_W-1:0] serve_place_q;
  reg loaded_q;
  localparam [PLACES-1:0] ONE = 1;
  wire [PLACES-1:0] wakes = awake_q & ~(loaded_q ? ONE << serve_place_q : {PLACES{1'b0}});

  // ---- the lowest place that is awake, by groups of four: the first group with one, and the first
  // in each group
  function [15:0] lowest(input [15:0] of);
    integer k;
    begin
      lowest = of;
      for (k = 1; k < 16; k = k + 1) if (|(of & ((16'd1 << k) - 16'd1))) lowest[k] = 1'b0;
    end
  endfunction
  wire [63:0] awake = {{64 - PLACES{1'b0}}, wakes};
  wire [15:0] group;  // has one
  wire [15:0] group_first = lowest(group);
  wire [31:0] in_group;  // number of the first in each group, of the first group alone
  genvar i;
  generate
    for (i = 0; i < 16; i = i + 1) begin : gen_group
      wire [3:0] four = awake[4*i+:4];
      assign group[i] = |four;
      assign in_group[2*i+:2] = {~(|four[1:0]), ~four[0] & (four[1] | ~four[2])} &
          {2{group_first[i]}};
    end
  endgenerate
  reg [5:0] next_place;
  integer j;
  always @* begin
    next_place = 6'd0;
    for (j = 0; j < 16; j = j + 1)
      next_place = next_place | {j[3:0] & {4{group_first[j]}}, in_group[2*j+:2]};
  end

  reg [CODE_W-1:0] serve_code_q;
  reg [FRAME_W-1:0] serve_frame_q;
  always @(posedge clk) begin
    if (load) serve_place_q <= next_place[PLACE_W-1:0];
    // these stay until all that wait for the line are served: no condition that comes from far
    serve_code_q  <= collect_code;
    serve_frame_q <= collect_frame;
    if (rst) serve_q <= 1'b0;
    else if (load) serve_q <= |wakes;
    loaded_q <= ~rst & load & (|wakes);
  end
  assign serving     = (|wakes) | (serve_q & ~serve_ready);
  assign serve_valid = serve_q;
  assign serve_place = serve_place_q;
  assign serve_code  = serve_code_q;
  assign serve_frame = serve_frame_q;

  // ---- the places
  generate
    for (i = 0; i < PLACES; i = i + 1) begin : gen_place
      localparam [31:0] I = i;
      reg here_q;  // the lookup that is decided upon is of this place
      reg [SLOT_W-1:0] slot_q;  // that it waits for
      wire comes = collect & (slot_q == collect_slot);
      always @(posedge clk) begin
        here_q <= ~rst & look & (look_place == I[PLACE_W-1:0]);
        // It counts only if the place falls asleep now, which is known too late to ask for it here.
        if (here_q) slot_q <= sleep_slot;
        if (rst) begin
          retried_q[i] <= 1'b0;
          asleep_q[i]  <= 1'b0;
          awake_q[i]   <= 1'b0;
        end else begin
          if (here_q) retried_q[i] <= retry;
          asleep_q[i] <= (sleep & here_q) | (asleep_q[i] & ~comes);
          awake_q[i]  <= collect ? asleep_q[i] & comes : wakes[i];
        end
      end
    end
  endgenerate
  assign retried = retried_q;
  assign waiting = asleep_q | wakes;

  wire unused = &{1'b0, next_place};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_collect, !collect || wakes == {PLACES{1'b0}})
      `CCHIP_ASSERT(a_serve, !serve_q ||
          (serve_frame_q == collect_frame && serve_code_q == collect_code))
    end

endmodule
`default_nettype wire
