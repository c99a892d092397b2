// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_cache: lines of 64 bytes from memory, two ways, two ports that read at once.
//   credit       a port has PLACES places. It asks for a line and names the place, and asks again
//                for a place only after the answer. There is no ready: every request is taken, and
//                every answer must be
//   answer       a line, or a code of cchip_axi_read without data, in any order. Lines in flight
//                (MISSES of them) hold up only the requests for them; all of these get the
//                line as it arrives, before its frame is reallocated
//   beats        a line is two beats of 256 bits: the lower half with m_valid, the upper one on the
//                next clock. m_place stays for both
//   lock         lines in a lock range stay once they are loaded, at most one way of a set, until
//                they are invalidated
//   invalidate   lines first..last. invalidate_ready = 1 again: no later answer is of data that
//                memory held before the command
//   latency      7 clocks from s_valid to m_valid for a line that is there and a port that is free,
//                7 from s_valid to m_read_valid, 21 from a line's last beat to m_valid
//   throughput   a line per port and two clocks; an arriving line takes two clocks of port 0, an
//                invalidation three in 9 of port 1
//   collision    a request that meets a change of its set within 7 clocks, or both of whose ways
//                are held, is looked up again. The places whose requests are have their turn: one
//                that has had the turn for AGE clocks is the only one to get a frame. So a request
//                that is looked up again has its line, or a code, after at most 2 PLACES turns of
//                AGE + T + 16 PLACES + 32 MISSES clocks each, T the longest time of a read, not
//                counting those of invalidations
//   silence      a slot whose read ended with CCHIP_READ_TIMEOUT or CCHIP_READ_OWED is out of use
//                while its response is outstanding. With all of them out of use a request whose
//                line is not there is answered with CCHIP_READ_OWED
//   reset        invalidates every line; takes 2^SET_W clocks, requests wait
module cchip_cache #(
    parameter integer CACHE_KB = 128,  // size of the data (KiB); legal: 1, 2, 4 ... 1024
    // lines that a port may be waiting for; legal: 2, 4, 8, 16, 32, 64
    parameter integer PLACES = 32,
    parameter integer MISSES = 32,     // lines in flight from memory; legal: 2, 4, 8, 16, 32
    // width of a line's number, address / 64 (bit); legal: 4 + log2 CACHE_KB .. 58
    parameter integer LINE_W = 32,
    parameter integer LOCKS = 2,       // ranges of lines to lock; legal: 1..4
    // width of the data bus of memory (bit); legal: 64, 128, 256, 512
    parameter integer DATA_W = 128
) (
    // ---- clock and reset
    input  wire                            clk,                 // clock, rising edge
    input  wire                            rst,                 // synchronous reset, active high
    // ---- requests and answers of the two ports
    input  wire [                     1:0] s_valid,             // bit p: port p asks for a line
    input  wire [    2*$clog2(PLACES)-1:0] s_place,             // its place for the line
    input  wire [            2*LINE_W-1:0] s_line,              // number of the line
    // ---- answers
    output wire [                     1:0] m_valid,             // bit p: an answer of port p
    output wire [    2*$clog2(PLACES)-1:0] m_place,             // its place
    // outcome of the read (ReadCode, docs/hardware/definitions.md)
    output wire [2*`CCHIP_READ_CODE_W-1:0] m_code,
    // a beat of 256 bits of the line, if m_code is OK: its lower half with m_valid, its upper one
    // on the next clock, on which m_place stays; port 0 in the lower half
    output wire [                   511:0] m_data,
    // ---- locked lines: lines to lock; none if first > last
    input  wire [        LOCKS*LINE_W-1:0] lock_first,          // first line of each range to lock
    // last line of each range; a range with first > last is empty
    input  wire [        LOCKS*LINE_W-1:0] lock_last,
    // ---- invalidation
    input  wire                            invalidate_valid,    // command: invalidate lines
    // no command is in progress; with invalidate_valid: taken
    output wire                            invalidate_ready,
    input  wire [              LINE_W-1:0] invalidate_first,    // first line to invalidate
    input  wire [              LINE_W-1:0] invalidate_last,     // last line to invalidate
    // ---- read requests: client of cchip_axi_read
    output wire                            m_read_valid,        // request to cchip_axi_read
    output wire [      $clog2(MISSES)-1:0] m_read_slot,         // place of the line there
    output wire [                    57:0] m_read_line,         // number of the line
    // ---- read answers
    input  wire                            s_read_valid,  // beat of an answer of cchip_axi_read
    input  wire [      $clog2(MISSES)-1:0] s_read_slot,         // its place
    input  wire [                     2:0] s_read_beat,         // number of the beat in its line
    input  wire                            s_read_last,         // last beat
    // outcome of the read, while s_read_last = 1
    input  wire [  `CCHIP_READ_CODE_W-1:0] s_read_code,
    input  wire [              DATA_W-1:0] s_read_data,         // data
    input  wire [              MISSES-1:0] s_read_outstanding,  // outstanding of its slots
    // ---- events to count: what happens on this clock, for counters; of each port
    output wire [                     1:0] count_hit,  // bit p: port p answered a request at once
    // bit p: a request of port p needs a line from memory
    output wire [                     1:0] count_miss,
    // bit p: a request of port p waits for a line in flight
    output wire [                     1:0] count_wait,
    // bit p: a request of port p is looked up again
    output wire [                     1:0] count_again
);

  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer MISS_W = $clog2(MISSES);
  localparam integer SETS = 8 * CACHE_KB;
  localparam integer SET_W = $clog2(SETS);
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam [4:0] AGE = 5'd31;

  `CCHIP_REFUSE(CACHE_KB < 1 || CACHE_KB > 1024 || (1 << SET_W) != SETS,
                cchip_error_cache_CACHE_KB_must_be_a_power_of_two_1_to_1024)
  `CCHIP_REFUSE(PLACES < 2 || PLACES > 64 || (1 << PLACE_W) != PLACES,
                cchip_error_cache_PLACES_must_be_a_power_of_two_2_to_64)
  `CCHIP_REFUSE(MISSES < 2 || MISSES > 32 || (1 << MISS_W) != MISSES,
                cchip_error_cache_MISSES_must_be_2_4_8_16_or_32)
  `CCHIP_REFUSE(LINE_W <= SET_W || LINE_W > 58 || LOCKS < 1 || LOCKS > 4,
                cchip_error_cache_LINE_W_must_be_over_SET_W_to_58_and_LOCKS_1_to_4)

  // An entry of a way: {valid, locked, turn, the slot of the read that filled it or will, tag}. The
  // two turns of a set, combined by exclusive or, are the way to replace next.
  localparam integer ENTRY_W = 3 + MISS_W + LINE_W - SET_W;

  // ---- lines in flight
  wire [MISSES-1:0] held, filled;  // has a frame; its data are in the frame
  wire free_valid;
  wire [MISS_W-1:0] free_slot;
  wire allocate;  // slot has this frame from the next clock on
  wire [MISS_W-1:0] allocate_slot;
  wire [SET_W:0] allocate_frame;  // {set, way}
  wire [LINE_W-1:0] allocate_line;
  wire [1:0] grant;
  wire granted;
  wire fill_valid;  // takes a clock of port 0
  wire [MISS_W-1:0] fill_slot;
  wire [CODE_W-1:0] fill_code;
  wire [SET_W:0] fill_frame;
  wire [255:0] fill_data;
  wire collect;  // who waits for collect_slot is to be served
  wire [MISS_W-1:0] collect_slot;
  wire [CODE_W-1:0] serve_code;
  wire [SET_W:0] serve_frame;
  wire [1:0] serving, serve_valid;
  wire exhausted;  // no slot will come back unless memory answers a read of long ago

  wire [1:0] free, beat5;  // of the ports: a fill may come; the half of a line in stage 5

  // Beats take a register: the read master lies where the bus is, the memories of lines where the
  // cache is.
  reg beat_valid_q, beat_last_q;
  reg [MISS_W-1:0] beat_slot_q;
  reg [2:0] beat_q;
  reg [CODE_W-1:0] beat_code_q;
  reg [DATA_W-1:0] beat_data_q;
  always @(posedge clk) begin
    beat_valid_q <= ~rst & s_read_valid;
    beat_last_q  <= s_read_last;
    beat_slot_q  <= s_read_slot;
    beat_q       <= s_read_beat;
    beat_code_q  <= s_read_code;
    beat_data_q  <= s_read_data;
  end
  cchip_cache_fill #(.MISSES(MISSES), .FRAME_W(SET_W + 1), .DATA_W(DATA_W)) u_fill (
      .clk           (clk),
      .rst           (rst),
      .free          (free[0]),
      .free_valid    (free_valid),
      .free_slot     (free_slot),
      .free_take     (granted),
      .allocate      (allocate),
      .allocate_slot (allocate_slot),
      .allocate_frame(allocate_frame),
      .held          (held),
      .filled        (filled),
      .exhausted     (exhausted),
      .s_read_valid  (beat_valid_q),
      .s_read_slot   (beat_slot_q),
      .s_read_beat   (beat_q),
      .s_read_last   (beat_last_q),
      .s_read_code   (beat_code_q),
      .s_read_data   (beat_data_q),
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

  // ---- the one write to the entries
  wire running;  // 0 while the entries are cleared after reset: this set
  wire [SET_W-1:0] walk_set;
  wire walk_next;
  wire [1:0] want, want_way, want_locked, want_victim;  // stage 6 of the ports: a frame for a line
  wire [2*LINE_W-1:0] line6;
  wire [1:0] kill6, walks6, walks_stale6, walk_hits6;
  wire [2*MISS_W-1:0] fill_slot6;
  wire [3:0] fill_way6, walk_ways6;
  wire [4*(MISS_W+1)-1:0] walk_keep6;
  wire [1:0] entry_write;  // ways
  wire [SET_W-1:0] entry_set;
  wire [1:0] change_by;  // ports whose stage 6 made the change
  wire [2*ENTRY_W-1:0] entry_data;
  cchip_cache_change #(.MISSES(MISSES), .SET_W(SET_W), .LINE_W(LINE_W)) u_change (
      .clk           (clk),
      .rst           (rst),
      .running       (running),
      .clear_set     (walk_set),
      .kill          (kill6[0]),
      .kill_slot     (fill_slot6[0+:MISS_W]),
      .kill_way      (fill_way6[1:0]),
      .walk          (walks6[1]),
      .walk_stale    (walks_stale6[1]),
      .walk_hits     (walk_hits6[1]),
      .walk_ways     (walk_ways6[3:2]),
      .walk_keep     (walk_keep6[2*(MISS_W+1)+:2*(MISS_W+1)]),
      .walk_next     (walk_next),
      .want          (want),
      .want_way      (want_way),
      .want_locked   (want_locked),
      .want_victim   (want_victim),
      .line          (line6),
      .free_slot     (free_slot),
      .grant         (grant),
      .granted       (granted),
      .entry_write   (entry_write),
      .entry_set     (entry_set),
      .entry_data    (entry_data),
      .change_by     (change_by),
      .allocate      (allocate),
      .allocate_slot (allocate_slot),
      .allocate_frame(allocate_frame),
      .allocate_line (allocate_line)
  );
  assign m_read_valid = allocate;
  assign m_read_slot  = allocate_slot;
  assign m_read_line  = {{58 - LINE_W{1'b0}}, allocate_line};

  // ---- invalidation: one set after the other, each in a clock of port 1
  wire walk_valid;
  wire [LINE_W-1:0] first, last;
  cchip_cache_invalidate #(.SET_W(SET_W), .LINE_W(LINE_W), .MISSES(MISSES)) u_invalidate (
      .clk       (clk),
      .rst       (rst),
      .s_valid   (invalidate_valid),
      .s_ready   (invalidate_ready),
      .s_first   (invalidate_first),
      .s_last    (invalidate_last),
      .running   (running),
      .walk_valid(walk_valid),
      .walk_set  (walk_set),
      .first     (first),
      .last      (last),
      .walk_done (walks6[1]),
      .walk_next (walk_next),
      .held      (held),
      .serving   (|serve_valid)
  );

  // ---- of the requests that have been looked up again one is the oldest, each in turn
  wire [2*PLACES-1:0] retried;
  // One is looked at for two clocks, because it is one of many: on the first its flag is read, on
  // the second, marked by look_q, its outcome is followed.
  reg [PLACE_W:0] oldest_q;  // {port, place}
  reg look_q, retried_q;
  reg [4:0] age_q;
  reg alone_q;  // the oldest one alone gets a frame
  always @(posedge clk) begin
    retried_q <= retried[oldest_q];
    if (rst) begin
      look_q   <= 1'b0;
      oldest_q <= {PLACE_W + 1{1'b0}};
      age_q    <= 5'd0;
      alone_q  <= 1'b0;
    end else begin
      look_q <= ~look_q;
      if (look_q && retried_q) begin
        if (age_q != AGE) age_q <= age_q + 5'd1;
        alone_q <= age_q == AGE;
      end else if (look_q) begin
        oldest_q <= oldest_q + {{PLACE_W{1'b0}}, 1'b1};
        age_q    <= 5'd0;
        alone_q  <= 1'b0;
      end
    end
  end

  // ---- the ports. Port 0 fills frames, port 1 walks through sets
  wire [2*SET_W-1:0] sets6 = {line6[LINE_W+:SET_W], line6[0+:SET_W]};
  wire [2*SET_W+1:0] data_addr;  // frames that the ports read or write in stage 5
  wire [1:0] fill_write;
  reg walk_valid_q;  // a clock later: they come from far
  reg [SET_W-1:0] walk_set_q;
  always @(posedge clk) begin
    walk_valid_q <= ~rst & walk_valid;
    walk_set_q   <= walk_set;
  end
  genvar p;
  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_port
      localparam [31:0] P = p;
      cchip_cache_port #(
          .PLACES(PLACES),
          .MISSES(MISSES),
          .SET_W (SET_W),
          .LINE_W(LINE_W),
          .LOCKS (LOCKS)
      ) u_port (
          .clk             (clk),
          .rst             (rst),
          .running         (running),
          .s_valid         (s_valid[p]),
          .s_place         (s_place[PLACE_W*p+:PLACE_W]),
          .s_line          (s_line[LINE_W*p+:LINE_W]),
          .m_valid         (m_valid[p]),
          .m_place         (m_place[PLACE_W*p+:PLACE_W]),
          .m_code          (m_code[CODE_W*p+:CODE_W]),
          .count           ({count_again[p], count_wait[p], count_miss[p], count_hit[p]}),
          .lock_first      (lock_first),
          .lock_last       (lock_last),
          .free            (free[p]),
          .maint_soon      (p == 0 ? 1'b0 : walk_valid),
          .maint_valid     (p == 0 ? fill_valid : walk_valid_q),
          .maint_set       (p == 0 ? fill_frame[SET_W:1] : walk_set_q),
          .fill_way        (fill_frame[0]),
          .fill_slot       (fill_slot),
          .fill_code       (fill_code),
          .invalidate_first(first),
          .invalidate_last (last),
          .free_valid      (free_valid),
          .free_slot       (free_slot),
          .exhausted       (exhausted),
          .held            (held),
          .filled          (filled),
          .allocate        (allocate),
          .allocate_slot   (allocate_slot),
          .allocate_frame  (allocate_frame),
          .collect         (collect),
          .collect_slot    (collect_slot),
          .collect_code    (serve_code),
          .collect_frame   (serve_frame),
          .serving         (serving[p]),
          .serve_valid     (serve_valid[p]),
          .entry_write     (entry_write),
          .entry_set       (entry_set),
          .entry_data      (entry_data),
          .change_by       (change_by),
          .sets6           (sets6),
          .retried         (retried[PLACES*p+:PLACES]),
          .oldest_here     (oldest_q[PLACE_W] == P[0]),
          .oldest_place    (oldest_q[PLACE_W-1:0]),
          .alone           (alone_q),
          .beat5           (beat5[p]),
          .data_addr       (data_addr[(SET_W+1)*p+:SET_W+1]),
          .fill_write      (fill_write[p]),
          .want            (want[p]),
          .want_way        (want_way[p]),
          .want_locked     (want_locked[p]),
          .want_victim     (want_victim[p]),
          .line6           (line6[LINE_W*p+:LINE_W]),
          .grant           (grant[p]),
          .kill6           (kill6[p]),
          .fill_slot6      (fill_slot6[MISS_W*p+:MISS_W]),
          .fill_way6       (fill_way6[2*p+:2]),
          .walk6           (walks6[p]),
          .walk_stale6     (walks_stale6[p]),
          .walk_hits6      (walk_hits6[p]),
          .walk_ways6      (walk_ways6[2*p+:2]),
          .walk_keep6      (walk_keep6[2*(MISS_W+1)*p+:2*(MISS_W+1)])
      );
    end
  endgenerate

  // ---- data
  cchip_dual_ram #(.WIDTH(256), .ADDR_W(SET_W + 2)) u_data (
      .clk        (clk),
      .write      (fill_write[0]),
      .addr_a     ({data_addr[0+:SET_W+1], beat5[0]}),
      .write_data (fill_data),
      .read_data_a(m_data[255:0]),
      .addr_b     ({data_addr[SET_W+1+:SET_W+1], beat5[1]}),
      .read_data_b(m_data[511:256])
  );

  wire unused = &{1'b0, free[1], fill_write[1], kill6[1], walks6[0], walks_stale6[0], walk_hits6[0],
                  fill_slot6[MISS_W+:MISS_W], fill_way6[3:2], walk_ways6[1:0],
                  walk_keep6[0+:2*(MISS_W+1)]};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_free, !(free_valid && exhausted))
    end

endmodule
`default_nettype wire
