// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_cache_port: one port of cchip_cache, a pipeline of seven stages. 0 chooses who has the
// clock, 1 to 4 read the entries of both ways and compare their tags, 5 addresses the data, 6
// decides, 7 is the answer.
//   beats        what is in stage 5 stays there for two clocks, with a half of a line each, the
//                lower one first; so stage 0 takes nothing on the clock after it took something
//   stage 0      in this order: a line that arrives or a set to invalidate (maint), a request whose
//                line has come, a deferred or new request, a request to be looked up again; the
//                last two alternate if both wait
//   stage 6      a lookup is a hit, falls asleep on a line in flight, wants a frame, is refused, or
//                is looked up again: if its set has changed since stage 1, if no frame may be
//                reallocated, or if its request is not granted
//   answers      7 clocks after s_valid of an idle port, in any order; m_data comes from the memory
//                that data_addr addresses in stage 5, m_place stays for two clocks
//   throughput   a lookup every two clocks
//   cuts         all but grant to what stage 6 does with it
//   maint        of port 0 a fill, of port 1 a set to invalidate: each port leaves the outputs of
//                the other kind at values that mean nothing
//   reset        nothing inside
//   timing       7 clocks from s_valid of a port that is free to m_valid for a line that is there;
//                a lookup every two clocks: what it finds has two beats of 256 bits, one after the
//                other.
//   rules        Stage 0 gives the clock to a fill, a set or a request in the order that
//                cchip_cache lists; new and repeated requests come from cchip_cache_requests. In
//                stage 6 a lookup is a hit, falls asleep, asks for a frame, is refused with OWED
//                because every slot is lost, or is looked up again. The last happens if its set has
//                changed since stage 1, if no frame of the set may be reallocated, or if the grant
//                went to another port.
//   inside       Two cchip_cache_way, cchip_cache_requests, cchip_cache_waiters. stale_q2 to
//                stale_q6 follow a lookup and remember whether its set has changed; the changes
//                that are still in the two stages behind stage 6 are compared beside it (same_q6).
module cchip_cache_port #(
    parameter integer PLACES = 32,  // places of a port (line); legal: 2, 4, 8, 16, 32, 64
    parameter integer MISSES = 32,  // slots of lines in flight; legal: 2, 4, 8, 16, 32
    parameter integer SET_W = 10,   // width of a set's number (bit); legal: >= 3
    parameter integer LINE_W = 32,  // width of a line's number (bit); legal: SET_W + 1 .. 58
    parameter integer LOCKS = 2     // ranges of lines to lock; legal: 1..4
) (
    input  wire                                     clk,               // clock, rising edge
    input  wire                                     rst,  // synchronous reset, active high
    input  wire                                     running,  // 0: the entries are being cleared
    // ---- requests and answers
    input  wire                                     s_valid,           // a request
    input  wire [               $clog2(PLACES)-1:0] s_place,           // its place
    input  wire [                       LINE_W-1:0] s_line,            // its line
    output wire                                     m_valid,           // an answer
    output wire [               $clog2(PLACES)-1:0] m_place,           // its place
    // outcome of the read (ReadCode, docs/hardware/definitions.md)
    output wire [           `CCHIP_READ_CODE_W-1:0] m_code,
    // what happened: {looked up again, waits, asks memory, hit}
    output wire [                              3:0] count,
    input  wire [                 LOCKS*LINE_W-1:0] lock_first,  // first line of each range to lock
    input  wire [                 LOCKS*LINE_W-1:0] lock_last,         // last line of each range
    // ---- maintenance: a fill, while free, or a set to invalidate, told
    //      ahead
    // the port took nothing on the clock before: a fill may come
    output wire                                     free,
    // maint_valid is 1 on the next clock, for a set to invalidate
    input  wire                                     maint_soon,
    // the port fills a frame, while free, or looks up a set to invalidate, told by maint_soon
    input  wire                                     maint_valid,
    input  wire [                        SET_W-1:0] maint_set,         // its set
    input  wire                                     fill_way,  // way of the frame that is filled
    input  wire [               $clog2(MISSES)-1:0] fill_slot,         // slot of the line
    input  wire [           `CCHIP_READ_CODE_W-1:0] fill_code,         // outcome of its read
    input  wire [                       LINE_W-1:0] invalidate_first,  // first line to invalidate
    input  wire [                       LINE_W-1:0] invalidate_last,   // last line to invalidate
    // ---- lines in flight
    input  wire                                     free_valid,        // there is a free slot
    input  wire [               $clog2(MISSES)-1:0] free_slot,         // its number
    input  wire                                     exhausted,         // every slot is lost
    input  wire [                       MISSES-1:0] held,  // bit of each slot: it has a frame
    // bit of each slot: its data are in the frame
    input  wire [                       MISSES-1:0] filled,
    input  wire                                     allocate,          // a line gets a frame
    input  wire [               $clog2(MISSES)-1:0] allocate_slot,     // slot of its read
    input  wire [                          SET_W:0] allocate_frame,    // {set, way}
    input  wire                                     collect,           // a line has come
    input  wire [               $clog2(MISSES)-1:0] collect_slot,      // its slot
    input  wire [           `CCHIP_READ_CODE_W-1:0] collect_code,      // outcome of its read
    input  wire [                          SET_W:0] collect_frame,     // its frame
    // requests that wait for this line are still being served
    output wire                                     serving,
    // a request whose line has come waits for stage 0
    output wire                                     serve_valid,
    // ---- the one write to the entries, {valid, locked, victim, slot, tag} of each way
    input  wire [                              1:0] entry_write,  // ways whose entry is written
    input  wire [                        SET_W-1:0] entry_set,         // set of the write
    // {valid, locked, victim, slot, tag} of each way
    input  wire [2*(3+$clog2(MISSES)+LINE_W-SET_W)-1:0] entry_data,
    // bit p: the write is a change that stage 6 of port p has made
    input  wire [                              1:0] change_by,
    input  wire [                      2*SET_W-1:0] sets6,  // set in stage 6 of each port
    // ---- of requests that are looked up again one is the oldest, each in turn
    // bit of each place: its request is being looked up again
    output wire [                       PLACES-1:0] retried,
    // the oldest request is one of this port,
    input  wire                                     oldest_here,
    input  wire [               $clog2(PLACES)-1:0] oldest_place,      // of this place
    input  wire                                     alone,  // only the oldest one gets a frame
    // ---- stage 5: the half and the frame to read or to write
    // the half of the line in stage 5: 0 lower, 1 upper
    output wire                                     beat5,
    // frame that stage 5 reads or writes
    output wire [                          SET_W:0] data_addr,
    output wire                                     fill_write,        // stage 5 writes it
    // ---- stage 6: a frame is wanted for line6
    output wire                                     want,  // stage 6 wants a frame for line6
    output wire                                     want_way,          // in this way
    output wire                                     want_locked,       // to be locked
    output wire                                     want_victim,       // victim bit of the entry
    output wire [                       LINE_W-1:0] line6,             // line in stage 6
    input  wire                                     grant,             // it gets the frame
    // ---- a fill without data, whose line is to be invalidated
    // the line in stage 6 came without data: its entry is to be cleared
    output wire                                     kill6,
    output wire [               $clog2(MISSES)-1:0] fill_slot6,        // its slot
    output wire [                              1:0] fill_way6,         // its way, one-hot
    // ---- a set has been looked up: ways to invalidate, and what stays in their entries
    output wire                                     walk6,  // a set to invalidate is in stage 6
    output wire                                     walk_stale6,  // it has changed since stage 1
    // there are lines of the range in it
    output wire                                     walk_hits6,
    output wire [                              1:0] walk_ways6,        // ways that have one
    output wire [           2*($clog2(MISSES)+1)-1:0] walk_keep6       // {victim, slot} of each way
);

  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer SLOT_W = $clog2(MISSES);
  localparam integer TAG_W = LINE_W - SET_W;
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam integer ENTRY_W = 3 + SLOT_W + TAG_W;

  // ---- what goes through the stages: bit i is that of stage i
  reg [6:1] look_q, serve_q, maint_q;
  reg [7:1] some_q;  // one of these
  wire port_free = ~some_q[1] & ~maint_soon;
  assign free  = ~some_q[1];
  assign beat5 = some_q[6];

  // ---- stage 0: who has this clock
  wire [PLACE_W-1:0] serve_place;
  wire [CODE_W-1:0] serve_code;
  wire [SET_W:0] serve_frame;
  wire look0;
  wire [PLACE_W-1:0] look_place0;
  wire [LINE_W-1:0] look_line0;
  reg running_q;  // a clock later: it comes from far
  always @(posedge clk) running_q <= ~rst & running;
  // of stage 7: whether a request that is not answered is retried is known after many gates, and is
  // needed far from them
  reg replay_q7;
  reg [PLACE_W-1:0] place_q7;
  reg [LINE_W-1:0] line_q7;
  cchip_cache_requests #(.PLACES(PLACES), .LINE_W(LINE_W)) u_requests (
      .clk        (clk),
      .rst        (rst),
      .s_valid    (s_valid),
      .s_place    (s_place),
      .s_line     (s_line),
      .replay     (replay_q7),
      .replay_place(place_q7),
      .replay_line(line_q7),
      .free       (port_free & running_q & ~maint_valid & ~serve_valid),
      .look       (look0),
      .look_place (look_place0),
      .look_line  (look_line0)
  );

  always @(posedge clk)
    if (rst) begin
      some_q  <= 7'd0;
      look_q  <= 6'd0;
      serve_q <= 6'd0;
      maint_q <= 6'd0;
    end else begin
      some_q  <= {some_q[6:1], look0 | maint_valid | (port_free & serve_valid)};
      look_q  <= {look_q[5:1], look0};
      serve_q <= {serve_q[5:1], port_free & serve_valid & ~maint_valid};
      maint_q <= {maint_q[5:1], maint_valid};
    end

  wire [PLACE_W-1:0] place5;
  wire [CODE_W-1:0] code5;
  wire [SLOT_W-1:0] slot5;
  wire way4;
  reg [PLACE_W-1:0] place_q6;
  reg [CODE_W-1:0] code_q6;
  reg [SLOT_W-1:0] slot_q6;
  reg way_q5, way_q6;
  cchip_delay #(.WIDTH(PLACE_W + CODE_W + SLOT_W), .DEPTH(5)) u_to_5 (
      .clk(clk),
      .rst(rst),
      .d  ({serve_valid | maint_valid ? serve_place : look_place0,
            maint_valid ? fill_code : serve_code, fill_slot}),
      .q  ({place5, code5, slot5})
  );
  cchip_delay #(.DEPTH(4)) u_way_to_4 (
      .clk(clk),
      .rst(rst),
      .d  (maint_valid ? fill_way : serve_frame[0]),
      .q  (way4)
  );
  reg [LINE_W-1:0] line_q1, line_q2, line_q3, line_q4, line_q5, line_q6;
  reg stale_q2, stale_q3, stale_q4, stale_q5, stale_q6;  // the set has changed since
  wire change = |entry_write;
  wire [1:0] match4;
  always @(posedge clk) begin
    line_q1 <= {
      look_line0[LINE_W-1:SET_W],
      maint_valid ? maint_set : serve_valid ? serve_frame[SET_W:1] : look_line0[SET_W-1:0]
    };
    line_q2  <= line_q1;
    line_q3  <= line_q2;
    line_q4  <= line_q3;
    if (!some_q[5]) line_q5 <= line_q4;
    line_q6  <= line_q5;
    stale_q2 <= change && entry_set == line_q1[SET_W-1:0];
    stale_q3 <= stale_q2 | (change && entry_set == line_q2[SET_W-1:0]);
    stale_q4 <= stale_q3 | (change && entry_set == line_q3[SET_W-1:0]);
    stale_q5 <= stale_q4 | (change && entry_set == line_q4[SET_W-1:0]);
    stale_q6 <= stale_q5 | (change && entry_set == line_q5[SET_W-1:0]);
    if (!some_q[5]) way_q5 <= look_q[4] ? match4[1] : way4;
    way_q6   <= way_q5;
    place_q6 <= place5;
    code_q6  <= code5;
    slot_q6  <= slot5;
  end
  assign line6     = line_q6;
  assign data_addr = {line_q5[SET_W-1:0], way_q5};

  // ---- the entries of the two ways
  wire [1:0] match5, valid5, locked5, victim5, victim6, hold5, full5, in_range5, in_range6;
  wire [2*SLOT_W-1:0] slots5, slots6;
  genvar w;
  generate
    for (w = 0; w < 2; w = w + 1) begin : gen_way
      cchip_cache_way #(
          .WAY   (w),
          .MISSES(MISSES),
          .SET_W (SET_W),
          .LINE_W(LINE_W)
      ) u_way (
          .clk           (clk),
          .write         (entry_write[w]),
          .write_set     (entry_set),
          .write_data    (entry_data[ENTRY_W*w+:ENTRY_W]),
          .allocate      (allocate),
          .allocate_slot (allocate_slot),
          .allocate_frame(allocate_frame),
          .held          (held),
          .filled        (filled),
          .set1          (line_q1[SET_W-1:0]),
          .line4         (line_q4),
          .set5          (line_q5[SET_W-1:0]),
          .first         (invalidate_first),
          .last          (invalidate_last),
          .match4        (match4[w]),
          .match5        (match5[w]),
          .valid5        (valid5[w]),
          .locked5       (locked5[w]),
          .victim5       (victim5[w]),
          .hold5         (hold5[w]),
          .full5         (full5[w]),
          .slot5         (slots5[SLOT_W*w+:SLOT_W]),
          .in_range5     (in_range5[w]),
          .in_range6     (in_range6[w]),
          .victim6       (victim6[w]),
          .slot6         (slots6[SLOT_W*w+:SLOT_W])
      );
    end
  endgenerate

  // lines to lock
  wire [LOCKS-1:0] lock_hit;
  genvar i;
  generate
    for (i = 0; i < LOCKS; i = i + 1) begin : gen_lock
      assign lock_hit[i] = line_q1 >= lock_first[LINE_W*i+:LINE_W] &&
          line_q1 <= lock_last[LINE_W*i+:LINE_W];
    end
  endgenerate
  wire lock5;
  cchip_delay #(.DEPTH(4)) u_lock (.clk(clk), .rst(rst), .d(|lock_hit), .q(lock5));

  // ---- stage 5 to 6: what the decision needs
  wire [1:0] wait5 = match5 & hold5 & ~full5;  // the line is in flight
  wire [1:0] evictable5 = ~hold5 & ~locked5;  // frames that may be evicted
  reg match_q6, both_q6, wait_q6, lacks_q6, prefer_q6, lock_q6;
  reg [1:0] evictable_q6, locked_q6, same_q6;
  reg [SLOT_W-1:0] wait_slot_q6;
  // Taken a clock before, for both come from far: the oldest does not change while it is alone.
  reg alone_q6, is_oldest_q6;
  reg kill_q6, walk_hits_q6;
  always @(posedge clk) begin
    // the lookup of each port that is a clock ahead has the same set
    same_q6 <= {
      sets6[SET_W+:SET_W] == line_q5[SET_W-1:0], sets6[0+:SET_W] == line_q5[SET_W-1:0]
    };
    match_q6 <= |match5;
    both_q6  <= &match5;
    // not reset: no slot is free on the clocks after reset
    lacks_q6     <= look_q[5] & ~(|match5) & (|evictable5);
    wait_q6      <= |wait5;
    wait_slot_q6 <= match5[1] ? slots5[SLOT_W+:SLOT_W] : slots5[0+:SLOT_W];
    evictable_q6 <= evictable5;
    prefer_q6    <= &valid5 ? ^victim5 : valid5[0];
    locked_q6    <= locked5;
    lock_q6      <= lock5;
    alone_q6     <= alone;
    is_oldest_q6 <= oldest_here && oldest_place == place5;
    kill_q6      <= ~rst & maint_q[5] & (code5 != `CCHIP_READ_OK);
    walk_hits_q6 <= ~rst & maint_q[5] & (|in_range5);
  end

  // ---- stage 6
  wire stale = stale_q6 | (|(change_by & same_q6));
  wire fresh = look_q[6] & ~stale;
  wire hit = fresh & match_q6 & ~wait_q6;
  wire sleep = (fresh & wait_q6) | grant;
  wire refuse = fresh & ~match_q6 & exhausted;
  wire replay = look_q[6] & (stale | (~match_q6 & ~grant & ~exhausted));
  // the way to replace is found beside the decision whether any is
  wire victim_way = &evictable_q6 ? prefer_q6 : evictable_q6[1];
  assign want = lacks_q6 & ~stale & free_valid & (~alone_q6 | is_oldest_q6);
  assign want_way = victim_way;
  assign want_locked = lock_q6 & ~(victim_way ? locked_q6[0] : locked_q6[1]);
  assign want_victim = ~victim_way ^ (victim_way ? victim6[0] : victim6[1]);
  assign fill_write = (maint_q[5] && code5 == `CCHIP_READ_OK) || (maint_q[6] && !kill_q6);
  assign kill6 = kill_q6;
  assign fill_slot6 = slot_q6;
  assign fill_way6 = {way_q6, ~way_q6};
  assign walk6 = maint_q[6];
  assign walk_stale6 = stale;
  assign walk_hits6 = walk_hits_q6;
  assign walk_ways6 = in_range6;
  assign walk_keep6 = {victim6[1], slots6[SLOT_W+:SLOT_W], victim6[0], slots6[0+:SLOT_W]};

  // ---- requests that wait for a line: reported in stage 7
  reg sleep_q7;
  reg [SLOT_W-1:0] sleep_slot_q7;
  always @(posedge clk) begin
    if (!some_q[7]) place_q7 <= place_q6;
    line_q7       <= line_q6;
    replay_q7     <= ~rst & replay;
    sleep_q7      <= ~rst & sleep;
    sleep_slot_q7 <= wait_q6 ? wait_slot_q6 : free_slot;
  end
  wire [PLACES-1:0] waiting;
  cchip_cache_waiters #(.PLACES(PLACES), .MISSES(MISSES), .FRAME_W(SET_W + 1)) u_waiters (
      .clk          (clk),
      .rst          (rst),
      .look         (look_q[6]),
      .look_place   (place_q6),
      .sleep        (sleep_q7),
      .sleep_slot   (sleep_slot_q7),
      .retry        (replay_q7),
      .retried      (retried),
      .collect      (collect),
      .collect_slot (collect_slot),
      .collect_code (collect_code),
      .collect_frame(collect_frame),
      .serving      (serving),
      .serve_valid  (serve_valid),
      .serve_ready  (port_free & ~maint_valid),
      .serve_place  (serve_place),
      .serve_code   (serve_code),
      .serve_frame  (serve_frame),
      .waiting      (waiting)
  );

  // ---- answers and counts
  reg valid_q7;
  reg [CODE_W-1:0] code_q7;
  reg [3:0] count_q;
  always @(posedge clk) begin
    code_q7  <= serve_q[6] ? code_q6 : hit ? `CCHIP_READ_OK : `CCHIP_READ_OWED;
    valid_q7 <= ~rst & (hit | refuse | serve_q[6]);
    count_q  <= {4{~rst}} & {replay, fresh & wait_q6, grant, hit};
  end
  assign m_valid = valid_q7;
  assign m_place = place_q7;
  assign m_code  = code_q7;
  assign count   = count_q;

  wire unused = &{1'b0, waiting, both_q6, match4[0]};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_free, free || !maint_valid)
      `CCHIP_ASSERT(a_held, !serve_valid || held[collect_slot])
      `CCHIP_ASSERT(a_alone, !grant || !alone || !alone_q6 ||
          (oldest_here && oldest_place == place_q6))
      `CCHIP_ASSERT(a_one, !fresh || !(match_q6 && both_q6))
      `CCHIP_ASSERT(a_place, !s_valid || !waiting[s_place])
    end

endmodule
`default_nettype wire
