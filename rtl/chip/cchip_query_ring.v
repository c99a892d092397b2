// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_query_ring: fetches queries from a ring of lines in memory and hands them on in order.
//   ring         2^size_log2 lines from `base` on. `producer` counts the queries that the host has
//                written, `consumer` those that have left this module; both run freely, 16 bit. The
//                host keeps producer - consumer <= 2^size_log2, and may write a line again when
//                `consumer` has passed it
//   throughput   AHEAD lines are in flight, so AHEAD queries per latency of memory; at most a read
//                in 2 clocks and a query in 512 / DATA_W + 2
//   latency      2 clocks from producer to m_read_valid, 512 / DATA_W + 2 from a line's last beat
//                to m_query_valid
//   failure      a line that could not be read is not handed on, and none after it: failed = 1
//                until reset, consumer names the line. What was handed on before goes its way
//   memory       one of AHEAD lines, a beat wide; a query is gathered from it in a register
//   reset        nothing is in flight: reads from before must not be answered
module cchip_query_ring #(
    // slots of its client of cchip_axi_read; legal: 2, 4, 8, 16, 32, at least AHEAD
    parameter integer SLOTS = 32,
    parameter integer AHEAD = 4,    // queries in flight or waiting to leave (query); legal: 2, 4, 8
    // width of the data bus of memory (bit); legal: 64, 128, 256, 512
    parameter integer DATA_W = 128
) (
    input  wire                          clk,            // clock, rising edge
    input  wire                          rst,            // synchronous reset, active high
    input  wire                          enable,         // 0: no further line is read
    input  wire [                  57:0] base,           // address of the ring / 64
    input  wire [                   3:0] size_log2,      // the ring has 2^size_log2 lines
    // queries that the host has written, free running
    input  wire [                  15:0] producer,
    output wire [                  15:0] consumer,       // queries that have left, free running
    output wire                          failed,         // a line could not be read; until reset
    output wire                          idle,           // no line is in flight or waits to leave
    // ---- client of cchip_axi_read
    output wire                          m_read_valid,   // request to cchip_axi_read
    output wire [     $clog2(SLOTS)-1:0] m_read_slot,    // its slot
    output wire [                  57:0] m_read_line,    // number of the line, address / 64
    input  wire                          s_read_valid,   // beat of an answer of cchip_axi_read
    input  wire [     $clog2(SLOTS)-1:0] s_read_slot,    // its slot
    input  wire [                   2:0] s_read_beat,    // number of the beat in its line
    input  wire                          s_read_last,    // last beat
    // ReadCode, docs/hardware/definitions.md, while s_read_last = 1
    input  wire [`CCHIP_READ_CODE_W-1:0] s_read_code,
    input  wire [            DATA_W-1:0] s_read_data,    // data
    // ---- queries
    output wire                          m_query_valid,  // a query
    input  wire                          m_query_ready,  // it is taken
    output wire [    `CCHIP_QUERY_W-1:0] m_query_data  // record QUERY, docs/hardware/definitions.md
);

  localparam integer AHEAD_W = $clog2(AHEAD);
  localparam integer SLOT_W = $clog2(SLOTS);
  localparam integer BEATS = 512 / DATA_W;
  localparam [31:0] LIMIT = AHEAD;

  `CCHIP_REFUSE(AHEAD < 2 || AHEAD > 8 || (1 << AHEAD_W) != AHEAD || SLOTS < AHEAD || SLOTS > 32 ||
                (1 << SLOT_W) != SLOTS,
                cchip_error_query_ring_AHEAD_must_be_2_4_or_8_and_SLOTS_a_power_of_two_AHEAD_to_32)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_query_ring_DATA_W_must_be_64_128_256_or_512)

  reg [15:0] asked_q, given_q;  // queries whose line was asked for, that have left
  reg due_q, read_valid_q, failed_q;
  reg [57:0] line_q;
  reg [AHEAD_W-1:0] slot_q;
  reg [AHEAD-1:0] here_q, bad_q;  // of each slot: its line has come, with a code other than OK
  wire [AHEAD_W:0] in_flight = asked_q[AHEAD_W:0] - given_q[AHEAD_W:0];  // at most AHEAD
  wire ask = enable & due_q & ~read_valid_q & ~failed_q;  // due_q is a clock late, hence not twice
  wire [15:0] place = asked_q & ~(16'hFFFF << size_log2);
  wire [AHEAD_W-1:0] head = given_q[AHEAD_W-1:0];
  wire [AHEAD_W-1:0] came = s_read_slot[AHEAD_W-1:0];
  wire comes = s_read_valid & s_read_last;
  wire take = m_query_valid & m_query_ready;
  wire [AHEAD-1:0] one = {{AHEAD - 1{1'b0}}, 1'b1};
  always @(posedge clk) begin
    line_q <= base + {42'd0, place};
    slot_q <= asked_q[AHEAD_W-1:0];
    if (comes) bad_q[came] <= s_read_code != `CCHIP_READ_OK;
    if (rst) begin
      asked_q      <= 16'd0;
      given_q      <= 16'd0;
      here_q       <= {AHEAD{1'b0}};
      due_q        <= 1'b0;
      read_valid_q <= 1'b0;
      failed_q     <= 1'b0;
    end else begin
      due_q        <= asked_q != producer && in_flight < LIMIT[AHEAD_W:0];
      read_valid_q <= ask;
      if (ask) asked_q <= asked_q + 16'd1;
      if (take) given_q <= given_q + 16'd1;
      here_q   <= (here_q | (comes ? one << came : {AHEAD{1'b0}})) &
          ~(take ? one << head : {AHEAD{1'b0}});
      failed_q <= failed_q | (here_q[head] & bad_q[head]);
    end
  end

  // ---- the query that leaves
  `CCHIP_LUT_RAM
  reg [DATA_W-1:0] beats[0:AHEAD*BEATS-1];
  reg [511:0] query_q;
  reg query_valid_q;
  // from a flip-flop, because 512 others depend on it: a clock later, and not that of the slot
  // which has just left
  reg head_good_q;
  always @(posedge clk) head_good_q <= ~rst & ~take & here_q[head] & ~bad_q[head];
  wire gather = head_good_q & ~query_valid_q;
  wire gathered;
  always @(posedge clk) query_valid_q <= ~rst & (gathered | (query_valid_q & ~m_query_ready));
  generate
    if (BEATS == 1) begin : gen_beats
      assign gathered = gather;
      always @(posedge clk) begin
        if (s_read_valid) beats[came] <= s_read_data;
        if (gather) query_q <= beats[head];
      end
      wire unused_beat = &{1'b0, s_read_beat};
    end else begin : gen_beats
      localparam integer BEAT_W = $clog2(BEATS);
      reg [BEAT_W-1:0] beat_q;
      assign gathered = gather & (&beat_q);
      always @(posedge clk) begin
        if (s_read_valid) beats[{came, s_read_beat[BEAT_W-1:0]}] <= s_read_data;
        if (gather) query_q <= {beats[{head, beat_q}], query_q[511:DATA_W]};
        if (rst) beat_q <= {BEAT_W{1'b0}};
        else if (gather) beat_q <= beat_q + {{BEAT_W - 1{1'b0}}, 1'b1};
      end
      if (BEAT_W < 3) begin : gen_unused
        wire unused_beat = &{1'b0, s_read_beat[2:BEAT_W]};
      end
    end
    if (SLOT_W > AHEAD_W) begin : gen_slot
      wire unused = &{1'b0, s_read_slot[SLOT_W-1:AHEAD_W]};
      assign m_read_slot = {{SLOT_W - AHEAD_W{1'b0}}, slot_q};
    end else begin : gen_slot
      assign m_read_slot = slot_q;
    end
  endgenerate
  assign m_read_valid  = read_valid_q;
  assign m_read_line   = line_q;
  assign m_query_valid = query_valid_q;
  assign m_query_data  = query_q;
  assign consumer      = given_q;
  assign failed        = failed_q;
  assign idle          = asked_q == given_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_in_flight, asked_q - given_q <= LIMIT[15:0])
      `CCHIP_ASSERT(a_answer, !s_read_valid || !here_q[came])
    end

endmodule
`default_nettype wire
