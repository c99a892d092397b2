// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_cache: lines of 64 bytes from memory, two ways, two ports that read at once.
//   credit       a port has PLACES places. It asks for a line and names the place, and asks again
//                for a place only after the answer. There is no ready: every request is taken, and
//                every answer must be
//   answer       a line, or a code of cchip_axi_read without data, in any order. Lines in flight
//                (MISSES of them) hold up nobody but those who ask for them; all of these get the
//                line as it arrives, before its frame is given away
//   lock         lines in a lock range stay once they are loaded, at most one way of a set, until
//                they are invalidated
//   invalidate   lines first..last. invalidate_ready = 1 again: no later answer is of data that
//                memory held before the command
//   latency      7 clocks from s_valid to m_valid for a line that is there and a port that is free,
//                7 from s_valid to m_read_valid, 19 from a line's last beat to m_valid
//   throughput   a line per port and clock; an arriving line takes a clock of port 0, an
//                invalidation one in 7 of port 1
//   collision    a request that meets a change of its set within 7 clocks, or both of whose ways
//                are held, is looked up again. The places whose requests are take turns: one that
//                has had the turn for AGE clocks is the only one to get a frame. So a request that
//                is looked up again has its line, or a code, after at most 2 PLACES turns of
//                AGE + T + 8 PLACES + 16 MISSES clocks each, T the longest time of a read, not
//                counting those of invalidations
//   silence      a slot whose read ended with CCHIP_READ_TIMEOUT or CCHIP_READ_OWED is out of use
//                while memory owes its response. With all of them out of use a request whose line
//                is not there is answered with CCHIP_READ_OWED
//   cuts         every path: each output is a flip-flop
//   reset        forgets every line; takes 2^SET_W clocks, requests wait
module cchip_cache #(
    // size of the data, KiB: 1, 2, 4 ... 1024
    parameter integer CACHE_KB = 128,
    // places of a port: 2, 4, 8, 16, 32 or 64
    parameter integer PLACES = 32,
    // lines in flight: 2, 4, 8, 16 or 32
    parameter integer MISSES = 32,
    // width of a line's number (address / 64), bit, more than SET_W and at most 58
    parameter integer LINE_W = 32,
    // ranges of lines to lock, 1..4
    parameter integer LOCKS = 2,
    // width of the data bus of memory, bit: 64, 128, 256 or 512
    parameter integer DATA_W = 128
) (
    input  wire                            clk,
    input  wire                            rst,
    // requests and answers of the two ports
    input  wire [                     1:0] s_valid,
    input  wire [    2*$clog2(PLACES)-1:0] s_place,
    input  wire [            2*LINE_W-1:0] s_line,
    output wire [                     1:0] m_valid,
    output wire [    2*$clog2(PLACES)-1:0] m_place,
    output wire [2*`CCHIP_READ_CODE_W-1:0] m_code,
    output wire [                  1023:0] m_data,            // if m_code is CCHIP_READ_OK
    // lines to lock; none if first > last
    input  wire [        LOCKS*LINE_W-1:0] lock_first,
    input  wire [        LOCKS*LINE_W-1:0] lock_last,
    // lines to forget
    input  wire                            invalidate_valid,
    output wire                            invalidate_ready,
    input  wire [              LINE_W-1:0] invalidate_first,
    input  wire [              LINE_W-1:0] invalidate_last,
    // client of cchip_axi_read
    output wire                            m_read_valid,
    output wire [      $clog2(MISSES)-1:0] m_read_slot,
    output wire [                    57:0] m_read_line,
    input  wire                            s_read_valid,
    input  wire [      $clog2(MISSES)-1:0] s_read_slot,
    input  wire [                     2:0] s_read_beat,
    input  wire                            s_read_last,
    input  wire [  `CCHIP_READ_CODE_W-1:0] s_read_code,
    input  wire [              DATA_W-1:0] s_read_data,
    input  wire [              MISSES-1:0] s_read_outstanding,  // its slots' bits of outstanding
    // what happens on this clock, for counters; of each port
    output wire [                     1:0] count_hit,         // answered at once
    output wire [                     1:0] count_miss,        // asks memory
    output wire [                     1:0] count_wait,        // waits for a line in flight
    output wire [                     1:0] count_again        // is looked up again
);

  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer MISS_W = $clog2(MISSES);
  localparam integer SETS = 8 * CACHE_KB;
  localparam integer SET_W = $clog2(SETS);
  localparam integer TAG_W = LINE_W - SET_W;
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam [31:0] ONE = 1;
  localparam [5:0] AGE = 6'd63;

  generate
    if (CACHE_KB < 1 || CACHE_KB > 1024 || (1 << SET_W) != SETS) begin : gen_illegal_size
      cchip_error_cache_CACHE_KB_must_be_a_power_of_two_1_to_1024 u_error ();
    end
    if (PLACES < 2 || PLACES > 64 || (1 << PLACE_W) != PLACES) begin : gen_illegal_places
      cchip_error_cache_PLACES_must_be_a_power_of_two_2_to_64 u_error ();
    end
    if (MISSES < 2 || MISSES > 32 || (1 << MISS_W) != MISSES) begin : gen_illegal_misses
      cchip_error_cache_MISSES_must_be_2_4_8_16_or_32 u_error ();
    end
    if (LINE_W <= SET_W || LINE_W > 58 || LOCKS < 1 || LOCKS > 4) begin : gen_illegal_line
      cchip_error_cache_LINE_W_must_be_over_SET_W_to_58_and_LOCKS_1_to_4 u_error ();
    end
  endgenerate

  // An entry of a way: {valid, locked, turn, the slot of the read that filled it or will, tag}. The
  // two turns of a set, combined by exclusive or, are the way to replace next.
  localparam integer ENTRY_W = 3 + MISS_W + TAG_W;
  localparam integer AT_MISS = TAG_W, AT_TURN = TAG_W + MISS_W;
  localparam integer AT_LOCKED = AT_TURN + 1, AT_VALID = AT_TURN + 2;

  // ---- lines in flight
  wire [MISSES-1:0] held, filled;  // has a frame; its data are in the frame
  wire free_valid;
  wire [MISS_W-1:0] free_slot;
  reg allocate_q;  // slot has this frame from the next clock on
  reg [MISS_W-1:0] allocate_slot_q;
  reg [SET_W:0] allocate_frame_q;  // {set, way}
  reg [LINE_W-1:0] allocate_line_q;
  wire [1:0] grant;
  wire granted;
  wire fill_valid;  // takes a clock of port 0
  wire [MISS_W-1:0] fill_slot;
  wire [CODE_W-1:0] fill_code;
  wire [SET_W:0] fill_frame;
  wire [511:0] fill_data;
  wire collect;  // who waits for collect_slot is to be served
  wire [MISS_W-1:0] collect_slot;
  wire [CODE_W-1:0] serve_code;
  wire [SET_W:0] serve_frame;
  wire [1:0] serving, serves0;
  wire exhausted;  // no slot will come back unless memory answers a read of long ago

  cchip_cache_fill #(
      .MISSES (MISSES),
      .FRAME_W(SET_W + 1),
      .DATA_W (DATA_W)
  ) u_fill (
      .clk           (clk),
      .rst           (rst),
      .free_valid    (free_valid),
      .free_slot     (free_slot),
      .free_take     (granted),
      .allocate      (allocate_q),
      .allocate_slot (allocate_slot_q),
      .allocate_frame(allocate_frame_q),
      .held          (held),
      .filled        (filled),
      .exhausted     (exhausted),
      .s_read_valid  (s_read_valid),
      .s_read_slot   (s_read_slot),
      .s_read_beat   (s_read_beat),
      .s_read_last   (s_read_last),
      .s_read_code   (s_read_code),
      .s_read_data   (s_read_data),
      .s_read_outstanding(s_read_outstanding),
      .fill_valid    (fill_valid),
      .fill_slot     (fill_slot),
      .fill_code     (fill_code),
      .fill_frame    (fill_frame),
      .fill_data     (fill_data),
      .collect       (collect),
      .collect_slot  (collect_slot),
      .serve_code    (serve_code),
      .serve_frame   (serve_frame),
      .serving       (serving)
  );
  assign m_read_valid = allocate_q;
  assign m_read_slot  = allocate_slot_q;
  assign m_read_line  = {{58 - LINE_W{1'b0}}, allocate_line_q};

  // ---- the one write to the entries, from registers
  reg [1:0] entry_write_q;  // ways
  reg [SET_W-1:0] entry_set_q;
  wire change = |entry_write_q;
  reg [1:0] change_by_q;  // ports whose stage 6 made it
  reg [2*ENTRY_W-1:0] entry_data_q;

  // ---- invalidation: one set after the other, each in a clock of port 1
  reg running_q;  // 0 while the entries are cleared after reset
  reg walk_valid_q;
  reg [SET_W-1:0] walk_set_q;
  reg [LINE_W-1:0] first_q, last_q;

  // what stage 6 of the ports wants
  wire [1:0] want, want_way, want_locked, want_turn;  // a frame for a line
  wire [2*LINE_W-1:0] line6;
  wire walk6;
  wire walk_stale6;
  wire [1:0] fill_way6;
  wire kill;  // a fill without data: its line is forgotten
  wire [MISS_W-1:0] fill_slot6;
  wire [1:0] walk_ways6;  // ways to forget
  wire walk_forgets6;  // a walk, and there are any
  wire [2*(MISS_W+1)-1:0] walk_keep6;  // their {turn, slot}

  wire [2*SET_W+1:0] data_addr;  // frames that the ports read or write in stage 5
  wire fill_write;

  // ---- requests that have been looked up again take turns at being the oldest
  wire [2*PLACES-1:0] retried;
  reg [PLACE_W:0] oldest_q;  // {port, place}
  reg [5:0] age_q;
  reg alone_q;  // the oldest one alone gets a frame
  always @(posedge clk)
    if (rst) begin
      oldest_q <= {PLACE_W + 1{1'b0}};
      age_q    <= 6'd0;
      alone_q  <= 1'b0;
    end else if (retried[oldest_q]) begin
      if (age_q != AGE) age_q <= age_q + 6'd1;
      alone_q <= age_q == AGE;
    end else begin
      oldest_q <= oldest_q + {{PLACE_W{1'b0}}, 1'b1};
      age_q    <= 6'd0;
      alone_q  <= 1'b0;
    end

  // the lowest bit that is 1, alone
  function [15:0] lowest(input [15:0] of);
    integer j;
    begin
      lowest = of;
      for (j = 1; j < 16; j = j + 1) if (|(of & ((16'd1 << j) - 16'd1))) lowest[j] = 1'b0;
    end
  endfunction

  // what must hold in each port: assertions are outside of the loop, Yosys wants their names once
  wire [1:0] ok_collect, ok_serve, ok_alone, ok_one, ok_place;

  genvar p, w, i;
  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_port
      localparam [31:0] P = p;
      wire ask = s_valid[p];
      wire [PLACE_W-1:0] ask_place = s_place[PLACE_W*p+:PLACE_W];
      wire [LINE_W-1:0] ask_line = s_line[LINE_W*p+:LINE_W];

      // ---- stages 1 to 6: 1 to 4 read the entries, 5 addresses the data, 6 decides
      reg look_q1, look_q2, look_q3, look_q4, look_q5, look_q6;
      reg serve_q1, serve_q2, serve_q3, serve_q4, serve_q5, serve_q6;
      reg own_q1, own_q2, own_q3, own_q4, own_q5, own_q6;
      reg stale_q2, stale_q3, stale_q4, stale_q5, stale_q6;  // the set has changed since
      reg [PLACE_W-1:0] place_q1, place_q2, place_q3, place_q4, place_q5, place_q6;
      reg [LINE_W-1:0] line_q1, line_q2, line_q3, line_q4, line_q5, line_q6;
      reg [CODE_W-1:0] code_q1, code_q2, code_q3, code_q4, code_q5, code_q6;
      reg [MISS_W-1:0] slot_q1, slot_q2, slot_q3, slot_q4, slot_q5, slot_q6;  // of a fill
      reg way_q1, way_q2, way_q3, way_q4, way_q5, way_q6;
      reg lock_q2, lock_q3, lock_q4, lock_q5;  // the line is one to lock
      reg [1:0] same_q6;  // the set of the lookup of each port that is a clock ahead

      // ---- stage 0: who has this clock. A fill or a walk first, then those whose line has come,
      // then new requests, the oldest first, and those to be looked up again, in turn
      wire own0 = p == 0 ? fill_valid : walk_valid_q;
      reg serve_q0;
      wire serve0 = serve_q0 & ~own0;
      wire go0 = running_q & ~own0 & ~serve_q0;
      wire late_valid, again_valid;
      wire [PLACE_W+LINE_W-1:0] late_data, again_data;
      reg again_first_q;
      wire use_again = again_valid & (again_first_q | ~(late_valid | ask));
      wire look0 = go0 & (again_valid | late_valid | ask);
      wire late_ready, again_ready;
      wire again;  // of stage 6
      cchip_fifo #(
          .WIDTH     (PLACE_W + LINE_W),
          .DEPTH     (PLACES),
          .ROOM_KNOWN(1)
      ) u_late (
          .clk    (clk),
          .rst    (rst),
          .s_valid(ask & (~go0 | late_valid | (again_valid & again_first_q))),
          .s_ready(late_ready),
          .s_data ({ask_place, ask_line}),
          .m_valid(late_valid),
          .m_ready(go0 & ~use_again),
          .m_data (late_data)
      );
      cchip_fifo #(
          .WIDTH     (PLACE_W + LINE_W),
          .DEPTH     (PLACES),
          .ROOM_KNOWN(1)
      ) u_again (
          .clk    (clk),
          .rst    (rst),
          .s_valid(again),
          .s_ready(again_ready),
          .s_data ({place_q6, line_q6}),
          .m_valid(again_valid),
          .m_ready(go0 & use_again),
          .m_data (again_data)
      );
      wire [PLACE_W-1:0] look_place0;
      wire [LINE_W-1:0] look_line0;
      assign {look_place0, look_line0} = use_again ? again_data :
          late_valid ? late_data : {ask_place, ask_line};
      wire [SET_W-1:0] own_set0 = p == 0 ? fill_frame[SET_W:1] : walk_set_q;

      // ---- who waits for a line in flight, and for which; whose line has come; who is served next
      reg [PLACES-1:0] sleep_q, wake_q;
      reg [MISS_W*PLACES-1:0] on_q;
      reg [PLACE_W-1:0] serve_place_q0;
      reg [CODE_W-1:0] serve_code_q0;
      reg [SET_W:0] serve_frame_q0;
      // the lowest place, by groups of four: the first group that has one, and the first in each
      wire [63:0] all_wake = {{64 - PLACES{1'b0}}, wake_q};
      wire [63:0] wake_first;  // one-hot
      wire [15:0] group;  // has one
      wire [15:0] group_first = lowest(group);
      wire [31:0] in_group;  // number of the first in each group, of the first group alone
      for (i = 0; i < 16; i = i + 1) begin : gen_group
        wire [3:0] four = all_wake[4*i+:4];
        assign group[i] = |four;
        assign wake_first[4*i+:4] = {
          four[3] & ~(|four[2:0]), four[2] & ~(|four[1:0]), four[1] & ~four[0], four[0]
        } & {4{group_first[i]}};
        assign in_group[2*i+:2] = {~(|four[1:0]), ~four[0] & (four[1] | ~four[2])} &
            {2{group_first[i]}};
      end
      reg [5:0] wake_place;
      integer j;
      always @* begin
        wake_place = 6'd0;
        for (j = 0; j < 16; j = j + 1)
          wake_place = wake_place | {j[3:0] & {4{group_first[j]}}, in_group[2*j+:2]};
      end
      wire load_serve = ~serve_q0 | serve0;
      // A fill or a walk may keep the last one from its clock: its frame must stay until then.
      assign serving[p] = (|wake_q) | (serve_q0 & own0);
      assign serves0[p] = serve_q0;

      wire [LOCKS-1:0] in_range;
      for (i = 0; i < LOCKS; i = i + 1) begin : gen_lock
        assign in_range[i] = line_q1 >= lock_first[LINE_W*i+:LINE_W] &&
            line_q1 <= lock_last[LINE_W*i+:LINE_W];
      end

      // of each way
      wire [2*MISS_W-1:0] miss5, miss6;
      wire [1:0] match4, match5, valid5, locked5, turn5, turn6, hold5, full5;
      wire [1:0] forget5, forget6;
      for (w = 0; w < 2; w = w + 1) begin : gen_way
        localparam [31:0] W = w;
        wire [ENTRY_W-1:0] entry3;
        reg [ENTRY_W-1:0] entry_q4;
        cchip_block_ram #(
            .WIDTH (ENTRY_W),
            .ADDR_W(SET_W)
        ) u_entries (
            .clk       (clk),
            .write     (entry_write_q[w]),
            .write_addr(entry_set_q),
            .write_data(entry_data_q[ENTRY_W*w+:ENTRY_W]),
            .read_addr (line_q1[SET_W-1:0]),
            .read_data (entry3)
        );
        wire [LINE_W-1:0] kept4 = {entry_q4[TAG_W-1:0], line_q4[SET_W-1:0]};  // line in this way
        assign match4[w] = entry_q4[AT_VALID] && kept4 == line_q4;
        reg match_q5, valid_q5, locked_q5, turn_q5, turn_q6, forget_q5, forget_q6;
        reg [MISS_W-1:0] miss_q5, miss_q6;
        wire [MISS_W-1:0] miss4 = entry_q4[AT_MISS+:MISS_W];
        (* ram_style = "distributed" *)
        reg [SET_W:0] frames[0:MISSES-1];
        reg [SET_W:0] frame_q5;
        reg held_q5, filled_q5;
        always @(posedge clk) begin
          entry_q4 <= entry3;
          if (allocate_q) frames[allocate_slot_q] <= allocate_frame_q;
          frame_q5  <= frames[miss4];
          held_q5   <= held[miss4];
          filled_q5 <= filled[miss4];
          match_q5  <= match4[w];
          valid_q5  <= entry_q4[AT_VALID];
          locked_q5 <= entry_q4[AT_LOCKED];
          turn_q5   <= entry_q4[AT_TURN];
          miss_q5   <= miss4;
          forget_q5 <= entry_q4[AT_VALID] && kept4 >= first_q && kept4 <= last_q;
          forget_q6 <= forget_q5;
          turn_q6   <= turn_q5;
          miss_q6   <= miss_q5;
        end
        assign match5[w]  = match_q5;
        assign valid5[w]  = valid_q5;
        assign locked5[w] = locked_q5;
        assign turn5[w]   = turn_q5;
        assign turn6[w]   = turn_q6;
        assign forget5[w] = forget_q5;
        assign forget6[w] = forget_q6;
        assign miss5[MISS_W*w+:MISS_W] = miss_q5;
        assign miss6[MISS_W*w+:MISS_W] = miss_q6;
        assign hold5[w] = held_q5 && frame_q5 == {line_q5[SET_W-1:0], W[0]};
        assign full5[w] = filled_q5;
      end

      wire [1:0] wait5 = match5 & hold5 & ~full5;  // the line is in flight
      wire [1:0] may5 = ~hold5 & ~locked5;  // frames that may be given away
      reg match_q6, wait_q6, lacks_q6, prefer_q6, lock_q6;
      reg [1:0] may_q6, locked_q6;
      reg [MISS_W-1:0] wait_slot_q6;
      // the way to replace is found beside the decision whether any is
      wire victim6 = &may_q6 ? prefer_q6 : may_q6[1];

      wire stale = stale_q6 | (|(change_by_q & same_q6));
      wire fresh = look_q6 & ~stale;
      wire hit = fresh & match_q6 & ~wait_q6;
      wire sleeps = (fresh & wait_q6) | grant[p];
      wire refuse = fresh & ~match_q6 & exhausted;
      // compared a clock before: oldest_q does not change while alone_q is 1
      reg is_oldest_q6;
      assign again = look_q6 & (stale | (~match_q6 & ~grant[p] & ~exhausted));
      assign want[p] = lacks_q6 & ~stale & free_valid & (~alone_q | is_oldest_q6);
      assign want_way[p] = victim6;
      assign want_locked[p] = lock_q6 & ~(victim6 ? locked_q6[0] : locked_q6[1]);
      assign want_turn[p] = ~victim6 ^ (victim6 ? turn6[0] : turn6[1]);
      assign line6[LINE_W*p+:LINE_W] = line_q6;
      assign data_addr[(SET_W+1)*p+:SET_W+1] = {line_q5[SET_W-1:0], way_q5};
      if (p == 0) begin : gen_fill
        assign fill_write = own_q5 && code_q5 == `CCHIP_READ_OK;
        reg kill_q6;
        always @(posedge clk) kill_q6 <= ~rst & own_q5 & (code_q5 != `CCHIP_READ_OK);
        assign kill = kill_q6;
        assign fill_slot6 = slot_q6;
        assign fill_way6  = {way_q6, ~way_q6};
        wire unused_fill = &{1'b0, own_q6, forget5, forget6, miss6};
      end else begin : gen_walk
        reg forgets_q6;
        always @(posedge clk) forgets_q6 <= ~rst & own_q5 & (|forget5);
        assign walk6 = own_q6;
        assign walk_stale6 = stale;
        assign walk_forgets6 = forgets_q6;
        assign walk_ways6  = forget6;
        assign walk_keep6 = {turn6[1], miss6[MISS_W+:MISS_W], turn6[0], miss6[0+:MISS_W]};
        wire unused_walk = &{1'b0, slot_q6, way_q6};
      end

      always @(posedge clk) begin
        {place_q1, code_q1, slot_q1, way_q1} <= own0 ?
            {serve_place_q0, fill_code, fill_slot, fill_frame[0]} :
            {serve_q0 ? serve_place_q0 : look_place0, serve_code_q0, fill_slot, serve_frame_q0[0]};
        {place_q2, code_q2, slot_q2, way_q2} <= {place_q1, code_q1, slot_q1, way_q1};
        {place_q3, code_q3, slot_q3, way_q3} <= {place_q2, code_q2, slot_q2, way_q2};
        {place_q4, code_q4, slot_q4, way_q4} <= {place_q3, code_q3, slot_q3, way_q3};
        {place_q5, code_q5, slot_q5, way_q5} <= {
          place_q4, code_q4, slot_q4, look_q4 ? match4[1] : way_q4
        };
        {place_q6, code_q6, slot_q6, way_q6} <= {place_q5, code_q5, slot_q5, way_q5};
        line_q1 <= {
          look_line0[LINE_W-1:SET_W],
          own0 ? own_set0 : serve_q0 ? serve_frame_q0[SET_W:1] : look_line0[SET_W-1:0]
        };
        line_q2 <= line_q1;
        line_q3 <= line_q2;
        line_q4 <= line_q3;
        line_q5 <= line_q4;
        line_q6 <= line_q5;
        stale_q2 <= change && entry_set_q == line_q1[SET_W-1:0];
        stale_q3 <= stale_q2 | (change && entry_set_q == line_q2[SET_W-1:0]);
        stale_q4 <= stale_q3 | (change && entry_set_q == line_q3[SET_W-1:0]);
        stale_q5 <= stale_q4 | (change && entry_set_q == line_q4[SET_W-1:0]);
        stale_q6 <= stale_q5 | (change && entry_set_q == line_q5[SET_W-1:0]);
        same_q6 <= {
          line6[LINE_W+:SET_W] == line_q5[SET_W-1:0], line6[SET_W-1:0] == line_q5[SET_W-1:0]
        };
        lock_q2 <= |in_range;
        lock_q3 <= lock_q2;
        lock_q4 <= lock_q3;
        lock_q5 <= lock_q4;
        lock_q6 <= lock_q5;
        match_q6 <= |match5;
        // not reset: no slot is free on the clocks after reset
        lacks_q6 <= look_q5 & ~(|match5) & (|may5);
        wait_q6 <= |wait5;
        wait_slot_q6 <= match5[1] ? miss5[MISS_W+:MISS_W] : miss5[0+:MISS_W];
        may_q6 <= may5;
        prefer_q6 <= &valid5 ? ^turn5 : valid5[0];
        locked_q6 <= locked5;
        is_oldest_q6 <= oldest_q == {P[0], place_q5};
        if (load_serve) begin
          serve_place_q0 <= wake_place[PLACE_W-1:0];
          serve_code_q0  <= serve_code;
          serve_frame_q0 <= serve_frame;
        end
        if (rst) begin
          {look_q1, look_q2, look_q3, look_q4, look_q5, look_q6} <= 6'd0;
          {serve_q1, serve_q2, serve_q3, serve_q4, serve_q5, serve_q6} <= 6'd0;
          {own_q1, own_q2, own_q3, own_q4, own_q5, own_q6} <= 6'd0;
          serve_q0 <= 1'b0;
          again_first_q <= 1'b0;
        end else begin
          {look_q1, look_q2, look_q3, look_q4, look_q5, look_q6} <= {
            look0, look_q1, look_q2, look_q3, look_q4, look_q5
          };
          {serve_q1, serve_q2, serve_q3, serve_q4, serve_q5, serve_q6} <= {
            serve0, serve_q1, serve_q2, serve_q3, serve_q4, serve_q5
          };
          {own_q1, own_q2, own_q3, own_q4, own_q5, own_q6} <= {
            own0, own_q1, own_q2, own_q3, own_q4, own_q5
          };
          if (load_serve) serve_q0 <= |wake_q;
          if (go0 && again_valid && (late_valid || ask)) again_first_q <= ~again_first_q;
        end
      end
      for (i = 0; i < PLACES; i = i + 1) begin : gen_place
        localparam [31:0] I = i;
        wire on_line = on_q[MISS_W*i+:MISS_W] == collect_slot;
        reg here_q6, retried_q;  // stage 6 has this place
        wire falls = sleeps & here_q6;
        always @(posedge clk)
          if (rst) retried_q <= 1'b0;
          else if (here_q6) retried_q <= again;
        assign retried[PLACES*p+i] = retried_q;
        always @(posedge clk) begin
          here_q6 <= ~rst & look_q5 & (place_q5 == I[PLACE_W-1:0]);
          // it counts only if the place falls asleep now, which comes too late to be asked here
          if (here_q6) on_q[MISS_W*i+:MISS_W] <= wait_q6 ? wait_slot_q6 : free_slot;
          if (rst) begin
            sleep_q[i] <= 1'b0;
            wake_q[i]  <= 1'b0;
          end else begin
            sleep_q[i] <= falls | (sleep_q[i] & ~(collect & on_line));
            wake_q[i] <= collect ? sleep_q[i] & on_line :
                wake_q[i] & ~(load_serve & wake_first[i]);
          end
        end
      end

      // ---- answers and counts
      reg valid_q7, hit_q, miss_q, wait_q, again_q;
      reg [PLACE_W-1:0] place_q7;
      reg [CODE_W-1:0] code_q7;
      always @(posedge clk) begin
        place_q7 <= place_q6;
        code_q7  <= serve_q6 ? code_q6 : hit ? `CCHIP_READ_OK : `CCHIP_READ_OWED;
        valid_q7 <= ~rst & (hit | refuse | serve_q6);
        hit_q    <= ~rst & hit;
        miss_q   <= ~rst & grant[p];
        wait_q   <= ~rst & fresh & wait_q6;
        again_q  <= ~rst & again;
      end
      assign m_valid[p] = valid_q7;
      assign m_place[PLACE_W*p+:PLACE_W] = place_q7;
      assign m_code[CODE_W*p+:CODE_W] = code_q7;
      assign count_hit[p] = hit_q;
      assign count_miss[p] = miss_q;
      assign count_wait[p] = wait_q;
      assign count_again[p] = again_q;

      reg both_q6;  // the two ways hold the same line
      always @(posedge clk) both_q6 <= &match5;
      wire unused_port = &{1'b0, wake_place, wake_first, code_q6, late_ready, again_ready};
      assign ok_collect[p] = !collect || wake_q == {PLACES{1'b0}};
      assign ok_serve[p] = !serve_q0 || (held[collect_slot] && serve_frame_q0 == serve_frame);
      assign ok_alone[p] = !grant[p] || !alone_q || oldest_q == {P[0], place_q6};
      assign ok_one[p] = !fresh || !(match_q6 && both_q6);
      assign ok_place[p] = !ask || (!sleep_q[ask_place] && !wake_q[ask_place]);
    end
  endgenerate

  // ---- data
  cchip_dual_ram #(
      .WIDTH (512),
      .ADDR_W(SET_W + 1)
  ) u_data (
      .clk        (clk),
      .write      (fill_write),
      .addr_a     (data_addr[0+:SET_W+1]),
      .write_data (fill_data),
      .read_data_a(m_data[511:0]),
      .addr_b     (data_addr[SET_W+1+:SET_W+1]),
      .read_data_b(m_data[1023:512])
  );

  // ---- changes of the entries: a line that could not be read is forgotten, then the walk, then
  // frames for lines. Who cannot have his change is looked up again
  reg favour_q;  // port that gets a frame if both want one
  wire walk_write = walk_forgets6 & ~walk_stale6 & ~kill;
  wire walk_next = walk6 & ~walk_stale6 & ~(kill & walk_forgets6);
  assign grant[0] = want[0] & ~walk_write & ~(want[1] & favour_q);
  assign grant[1] = want[1] & ~kill & ~(want[0] & ~favour_q);
  // Whether any is granted does not depend on whose turn it is: of two that want, one has it.
  assign granted = (want[0] & ~walk_write) | (want[1] & ~kill);
  // whose line it is; any, if none is granted
  wire by = want[1] & (favour_q | ~want[0]);
  wire [LINE_W-1:0] line = by ? line6[LINE_W+:LINE_W] : line6[0+:LINE_W];
  wire way = by ? want_way[1] : want_way[0];
  // The tag of an entry without a line may be any. It is that of `line` in every change, so that
  // the choice among the changes is not on the path to it.
  wire [ENTRY_W-TAG_W-1:0] entry = {
    1'b1, by ? want_locked[1] : want_locked[0], by ? want_turn[1] : want_turn[0], free_slot
  };
  generate
    for (w = 0; w < 2; w = w + 1) begin : gen_entry
      always @(posedge clk)
        entry_data_q[ENTRY_W*w+:ENTRY_W] <= {
          !running_q ? {ENTRY_W - TAG_W{1'b0}} : kill ? {3'b000, fill_slot6} :
              walk_write ? {2'b00, walk_keep6[(MISS_W+1)*w+:MISS_W+1]} : entry,
          line[LINE_W-1:SET_W]
        };
    end
  endgenerate
  always @(posedge clk) begin
    entry_set_q <= !running_q ? walk_set_q : kill ? line6[SET_W-1:0] :
        walk_write ? line6[LINE_W+:SET_W] : line[SET_W-1:0];
    allocate_slot_q  <= free_slot;
    allocate_frame_q <= {line[SET_W-1:0], way};
    allocate_line_q  <= line;
    if (rst) begin
      entry_write_q <= 2'b00;
      change_by_q   <= 2'b00;
      allocate_q    <= 1'b0;
      favour_q      <= 1'b0;
    end else begin
      entry_write_q <= !running_q ? 2'b11 : kill ? fill_way6 : walk_write ? walk_ways6 :
          {way, ~way} & {2{granted}};
      change_by_q <= {grant[1] | walk_write, grant[0] | kill};
      allocate_q  <= granted;
      if (&want) favour_q <= ~favour_q;
    end
  end

  // ---- the walk. It is over when the reads that were in flight at its last set have answered
  localparam [2:0] CLEAR = 3'd0, IDLE = 3'd1, ASK = 3'd2, SEE = 3'd3, READS = 3'd4, ANSWERS = 3'd5;
  localparam [2:0] ANSWER_CLOCKS = 3'd7;
  reg [2:0] state_q;
  reg [SET_W-1:0] left_q;  // sets after this one
  reg [MISSES-1:0] old_q;  // reads in flight
  reg [2:0] clocks_q;
  reg [LINE_W-1:0] more_q;  // lines after the first one
  reg count_q;  // left_q is to be loaded: long before the first set has been seen
  wire set_last = left_q == {SET_W{1'b0}};
  reg ready_q;
  always @(posedge clk) begin
    if (state_q == IDLE) begin
      first_q <= invalidate_first;
      last_q  <= invalidate_last;
    end
    more_q   <= last_q - first_q;
    old_q    <= state_q == READS ? old_q & held : held;
    clocks_q <= state_q == ANSWERS ? clocks_q - 3'd1 : ANSWER_CLOCKS;
    if (rst) begin
      state_q      <= CLEAR;
      running_q    <= 1'b0;
      ready_q      <= 1'b0;
      walk_valid_q <= 1'b0;
      count_q      <= 1'b0;
      walk_set_q   <= {SET_W{1'b0}};
      left_q       <= {SET_W{1'b1}};
    end else begin
      walk_valid_q <= 1'b0;
      case (state_q)
        CLEAR: begin
          walk_set_q <= walk_set_q + ONE[SET_W-1:0];
          left_q     <= left_q - ONE[SET_W-1:0];
          running_q  <= set_last;
          ready_q    <= set_last;
          if (set_last) state_q <= IDLE;
        end
        IDLE: begin
          walk_set_q <= invalidate_first[SET_W-1:0];
          count_q    <= 1'b1;
          ready_q    <= ~invalidate_valid;
          if (invalidate_valid) state_q <= ASK;
        end
        ASK: begin
          walk_valid_q <= 1'b1;
          state_q      <= SEE;
        end
        SEE:
        if (count_q) begin
          left_q  <= |more_q[LINE_W-1:SET_W] ? {SET_W{1'b1}} : more_q[SET_W-1:0];
          count_q <= 1'b0;
        end else if (walk6) begin
          if (walk_next) begin
            walk_set_q <= walk_set_q + ONE[SET_W-1:0];
            left_q     <= left_q - ONE[SET_W-1:0];
          end
          state_q <= walk_next && set_last ? READS : ASK;
        end
        READS: if (old_q == {MISSES{1'b0}} && serves0 == 2'b00) state_q <= ANSWERS;
        default:  // ANSWERS
        if (clocks_q == 3'd0) begin
          state_q <= IDLE;
          ready_q <= 1'b1;
        end
      endcase
    end
  end
  assign invalidate_ready = ready_q;

  wire unused = &{1'b0, ok_collect, ok_serve, ok_alone, ok_one, ok_place};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_collect, &ok_collect)
      `CCHIP_ASSERT(a_serve, &ok_serve)
      `CCHIP_ASSERT(a_alone, &ok_alone)
      `CCHIP_ASSERT(a_one, &ok_one)
      `CCHIP_ASSERT(a_place, &ok_place)
      `CCHIP_ASSERT(a_grant, grant != 2'b11 && granted == |grant)
      `CCHIP_ASSERT(a_free, !(free_valid && exhausted))
      `CCHIP_ASSERT(a_one_change, !(|grant) || !(kill || walk_write))
    end

endmodule
`default_nettype wire
