// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_cache_fill: the lines in flight of cchip_cache. A line has a slot, the one of its read,
// from allocation until all who wait for it have been served.
//   fill         lines leave in the order of their last beats, while free is 1, which it is not on
//                the clock after fill_valid; the lower half on
//                fill_data 5 clocks after fill_valid, the upper one on the next, on which filled is
//                1 if the code is CCHIP_READ_OK
//   serve        collect 8 clocks after fill_valid or later, one line after the other: a line is
//                done, and its slot free, one clock after serving is 0 for the first time since
//                the clock after collect
//   silence      a slot whose read ended with CCHIP_READ_TIMEOUT or CCHIP_READ_OWED is lost: it is
//                lent again, within MISSES + 3 clocks, when nothing is outstanding under its ID
//   latency      2 clocks from the last beat to fill_valid, while free is 1
//   throughput   a line every second clock into the frames, every fourth if one waits for each
//   reset        every slot is free after MISSES clocks; memory must not answer reads from before
module cchip_cache_fill #(
    parameter integer MISSES = 32,   // slots (line); legal: 2, 4, 8, 16, 32
    parameter integer FRAME_W = 12,  // width of a frame's number (bit); legal: >= 1
    parameter integer DATA_W = 128   // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    input  wire                          clk,                 // clock, rising edge
    input  wire                          rst,                 // synchronous reset, active high
    // ---- a free slot; it has a frame on the clock after free_take or later
    output wire                          free_valid,          // a slot is free
    output wire [    $clog2(MISSES)-1:0] free_slot,           // which
    input  wire                          free_take,  // it is taken; only while free_valid = 1
    input  wire                          allocate,            // a taken slot gets its frame
    input  wire [    $clog2(MISSES)-1:0] allocate_slot,       // the slot
    input  wire [           FRAME_W-1:0] allocate_frame,      // its frame
    // bit s: slot s has a frame, which must not be reallocated
    output wire [            MISSES-1:0] held,
    output wire [            MISSES-1:0] filled,  // bit s: the data of slot s are in its frame
    // every slot is lost: the responses to all of them are outstanding
    output wire                          exhausted,
    // ---- answers of cchip_axi_read
    // a beat of a line, or an answer without data
    input  wire                          s_read_valid,
    input  wire [    $clog2(MISSES)-1:0] s_read_slot,         // its slot; it is held
    input  wire [                   2:0] s_read_beat,         // number of the beat in its line
    input  wire                          s_read_last,         // the last one of the answer
    // outcome of the read (ReadCode, docs/hardware/definitions.md), while s_read_last = 1
    input  wire [`CCHIP_READ_CODE_W-1:0] s_read_code,
    input  wire [            DATA_W-1:0] s_read_data,         // data
    // a response to the slot is outstanding
    input  wire [            MISSES-1:0] s_read_outstanding,
    // ---- a line goes into its frame; must be taken
    input  wire                          free,  // a line may go; 0 on the clock after fill_valid
    // a line goes into its frame; it must be taken
    output wire                          fill_valid,
    output wire [    $clog2(MISSES)-1:0] fill_slot,           // its slot
    // outcome of its read; its data count only if that is OK
    output wire [`CCHIP_READ_CODE_W-1:0] fill_code,
    output wire [           FRAME_W-1:0] fill_frame,          // its frame
    // lower half of its data 5 clocks after fill_valid, upper half on the next
    output wire [                 255:0] fill_data,
    // ---- who waits for a line
    output wire                          collect,  // those who wait for this line are to be served
    output wire [    $clog2(MISSES)-1:0] collect_slot,        // the line's slot
    // from collect until the next one: outcome of the line's read
    output wire [`CCHIP_READ_CODE_W-1:0] serve_code,
    // from collect until the next one: the line's frame
    output wire [           FRAME_W-1:0] serve_frame,
    input  wire [                   1:0] serving  // bit p: port p has not yet served all of them
);

  localparam integer MISS_W = $clog2(MISSES);
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  // a memory of beats has a row for each half of a slot's line
  localparam integer BEAT_W = DATA_W > 256 ? 256 : DATA_W;
  localparam integer BEATS = 256 / BEAT_W;
  localparam integer ROW_W = MISS_W < 2 ? 3 : MISS_W + 1;

  `CCHIP_REFUSE(MISSES < 2 || MISSES > 32 || (1 << MISS_W) != MISSES || FRAME_W < 1,
                cchip_error_cache_fill_MISSES_must_be_2_4_8_16_or_32_and_FRAME_W_positive)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_cache_fill_DATA_W_must_be_64_128_256_or_512)

  // ---- the slots
  reg [MISSES-1:0] held_q, filled_q;
  wire done;
  reg serve_q;
  reg [MISS_W-1:0] serve_slot_q;
  // Lost slots: scan_q looks at one after the other, back_q has one that goes back to the pool.
  wire frees;
  reg [MISSES-1:0] lost_q;
  reg exhausted_q, back_q;
  reg [MISS_W-1:0] scan_q, back_slot_q;
  wire found = ~back_q & lost_q[scan_q] & ~s_read_outstanding[scan_q];
  assign exhausted = exhausted_q;
  always @(posedge clk) begin
    if (!back_q) back_slot_q <= scan_q;
    if (rst) begin
      exhausted_q <= 1'b0;
      back_q      <= 1'b0;
      scan_q      <= {MISS_W{1'b0}};
    end else begin
      exhausted_q <= &lost_q;
      back_q      <= back_q ? frees : found;
      if (!back_q) scan_q <= scan_q + {{MISS_W - 1{1'b0}}, 1'b1};
    end
  end
  cchip_pool #(.COUNT(MISSES), .WIDTH(MISS_W)) u_free (
      .clk        (clk),
      .rst        (rst),
      .m_valid    (free_valid),
      .m_ready    (free_take),
      .m_number   (free_slot),
      .back_valid (frees | back_q),
      .back_number(frees ? serve_slot_q : back_slot_q)
  );

  // ---- lines that have come
  wire arrived_valid, arrived_ready;
  assign fill_valid = arrived_valid & free;
  cchip_fifo #(.WIDTH(MISS_W + CODE_W), .DEPTH(MISSES), .ROOM_KNOWN(1)) u_arrived (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_read_valid & s_read_last),
      .s_ready(arrived_ready),
      .s_data ({s_read_slot, s_read_code}),
      .m_valid(arrived_valid),
      .m_ready(free),
      .m_data ({fill_slot, fill_code})
  );
  `CCHIP_LUT_RAM
  reg [FRAME_W-1:0] frames[0:MISSES-1];
  always @(posedge clk) if (allocate) frames[allocate_slot] <= allocate_frame;
  assign fill_frame = frames[fill_slot];

  // Stage 6 is for requests that a port puts to sleep a clock after it decides: they are there
  // before all who wait for the line are collected.
  reg fill_q1, fill_q2, fill_q3, fill_q4, fill_q5, fill_q6;
  reg [MISS_W-1:0] slot_q1, slot_q2, slot_q3, slot_q4, slot_q5, slot_q6;
  reg [CODE_W-1:0] code_q1, code_q2, code_q3, code_q4, code_q5, code_q6;
  reg [FRAME_W-1:0] frame_q1, frame_q2, frame_q3, frame_q4, frame_q5, frame_q6;
  genvar b;
  generate
    if (DATA_W > 256) begin : gen_whole  // both halves come at once
      wire [511:0] line;
      wire [31:0] write_row = {{31 - MISS_W{1'b0}}, s_read_slot, 1'b0};
      wire [31:0] row = {{31 - MISS_W{1'b0}}, slot_q3, 1'b0};
      for (b = 0; b < 2; b = b + 1) begin : gen_half
        cchip_block_ram #(.WIDTH(256), .ADDR_W(ROW_W)) u_beats (
            .clk       (clk),
            .write     (s_read_valid),
            .write_addr(write_row[ROW_W-1:0]),
            .write_data(s_read_data[256*b+:256]),
            .read_addr (row[ROW_W-1:0]),
            .read_data (line[256*b+:256])
        );
      end
      assign fill_data = fill_q6 ? line[511:256] : line[255:0];
      wire unused_rows = &{1'b0, row, write_row, s_read_beat};
    end else begin : gen_beats
      localparam integer INDEX_W = $clog2(BEATS);
      localparam [31:0] IN_HALF = BEATS - 1;
      wire [31:0] index = {29'd0, s_read_beat} & IN_HALF;
      wire [31:0] write_row = {{31 - MISS_W{1'b0}}, s_read_slot, s_read_beat[INDEX_W]};
      wire [31:0] row = {{31 - MISS_W{1'b0}}, slot_q3, fill_q4};
      for (b = 0; b < BEATS; b = b + 1) begin : gen_beat
        cchip_block_ram #(.WIDTH(DATA_W), .ADDR_W(ROW_W)) u_beats (
            .clk       (clk),
            .write     (s_read_valid && index == b),
            .write_addr(write_row[ROW_W-1:0]),
            .write_data(s_read_data),
            .read_addr (row[ROW_W-1:0]),
            .read_data (fill_data[DATA_W*b+:DATA_W])
        );
      end
      wire unused_rows = &{1'b0, row, write_row, index};
    end
  endgenerate

  // ---- lines whose waiters are to be served
  wire waiting;
  wire serve_ready;
  wire [MISS_W-1:0] next_slot;
  wire [CODE_W-1:0] next_code;
  wire [FRAME_W-1:0] next_frame;
  reg collect_q, collect_q2, serving_q;
  reg [CODE_W-1:0] serve_code_q;
  reg [FRAME_W-1:0] serve_frame_q;
  cchip_fifo #(.WIDTH(MISS_W + CODE_W + FRAME_W), .DEPTH(MISSES), .ROOM_KNOWN(1)) u_serve (
      .clk    (clk),
      .rst    (rst),
      .s_valid(fill_q6),
      .s_ready(serve_ready),
      .s_data ({slot_q6, code_q6, frame_q6}),
      .m_valid(waiting),
      .m_ready(~serve_q | done),
      .m_data ({next_slot, next_code, next_frame})
  );
  assign done = serve_q & ~collect_q & ~collect_q2 & ~serving_q;
  wire loses = serve_code_q == `CCHIP_READ_TIMEOUT || serve_code_q == `CCHIP_READ_OWED;
  assign frees = done & ~loses;

  always @(posedge clk) begin
    {slot_q1, code_q1, frame_q1} <= {fill_slot, fill_code, fill_frame};
    {slot_q2, code_q2, frame_q2} <= {slot_q1, code_q1, frame_q1};
    // the address of both halves
    if (!fill_q3) {slot_q3, code_q3, frame_q3} <= {slot_q2, code_q2, frame_q2};
    {slot_q4, code_q4, frame_q4} <= {slot_q3, code_q3, frame_q3};
    {slot_q5, code_q5, frame_q5} <= {slot_q4, code_q4, frame_q4};
    {slot_q6, code_q6, frame_q6} <= {slot_q5, code_q5, frame_q5};
    if (~serve_q | done)
      {serve_slot_q, serve_code_q, serve_frame_q} <= {next_slot, next_code, next_frame};
    if (rst) begin
      {fill_q1, fill_q2, fill_q3, fill_q4, fill_q5, fill_q6} <= 6'd0;
      serve_q <= 1'b0;
      collect_q <= 1'b0;
      collect_q2 <= 1'b0;
      serving_q <= 1'b0;
    end else begin
      {fill_q1, fill_q2, fill_q3, fill_q4, fill_q5, fill_q6} <= {
        fill_valid, fill_q1, fill_q2, fill_q3, fill_q4, fill_q5
      };
      serve_q <= waiting | (serve_q & ~done);
      collect_q <= waiting & (~serve_q | done);
      collect_q2 <= collect_q;
      serving_q <= |serving;
    end
  end
  genvar i;
  generate
    for (i = 0; i < MISSES; i = i + 1) begin : gen_slot
      localparam [31:0] I = i;
      wire ends = done && serve_slot_q == I[MISS_W-1:0];
      wire starts = allocate && allocate_slot == I[MISS_W-1:0];
      // found, and this is the slot: of its own bits alone
      wire gone = ~back_q & ~s_read_outstanding[i] & (scan_q == I[MISS_W-1:0]);
      wire fills = fill_q5 && slot_q5 == I[MISS_W-1:0] && code_q5 == `CCHIP_READ_OK;
      always @(posedge clk)
        if (rst) begin
          held_q[i]   <= 1'b0;
          filled_q[i] <= 1'b0;
          lost_q[i]   <= 1'b0;
        end else begin
          lost_q[i]   <= (ends & loses) | (lost_q[i] & ~gone);
          held_q[i]   <= starts | (held_q[i] & ~ends);
          filled_q[i] <= fills | (filled_q[i] & ~starts);
        end
    end
  endgenerate
  assign held         = held_q;
  assign filled       = filled_q;
  assign collect      = collect_q;
  assign collect_slot = serve_slot_q;
  assign serve_code   = serve_code_q;
  assign serve_frame  = serve_frame_q;

  wire unused = &{1'b0, arrived_ready, serve_ready};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_take, !free_take || free_valid)
      `CCHIP_ASSERT(a_allocate, !allocate || !held_q[allocate_slot])
      `CCHIP_ASSERT(a_answer, !s_read_valid || (held_q[s_read_slot] && !filled_q[s_read_slot]))
    end

endmodule
`default_nettype wire
