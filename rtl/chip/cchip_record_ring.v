// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_record_ring: writes records of 16 bytes into a ring in memory, in their order.
//   ring         2^size_log2 records from `base` on. `producer` counts the records that memory has
//                confirmed, `consumer` those that the host has read; both run freely, 32 bit.
//                A full ring holds up s_ready and loses nothing. A consumer beyond the producer is
//                an error of the host: the ring is then full until it is corrected. A consumer
//                gives room 3 clocks after it has changed
//   phase        bit 63 of a record is 1 in the first round of the ring and inverted in each one
//                after it, so a host that clears the ring before use needs to poll memory only
//   throughput   a record in 3 clocks, 4 behind cchip_axi_write: far more than pairs have results
//   latency      2 clocks from s_valid to m_valid
//   failure      a write with another code than OK, or any that follows it, is not counted in
//                `producer`: failed = 1 until reset, and no further record is taken
//   reset        the ring is empty, at its beginning; writes from before must not be answered
module cchip_record_ring #(
    parameter integer DATA_W = 128  // width of the data bus of memory (bit); legal: 128, 256, 512
) (
    input  wire                           clk,            // clock, rising edge
    input  wire                           rst,            // synchronous reset, active high
    input  wire [                   59:0] base,           // address of the ring / 16
    input  wire [                    4:0] size_log2,      // the ring has 2^size_log2 records
    input  wire [                   31:0] consumer,  // records that the host has read, free running
    // records that memory has confirmed, free running
    output wire [                   31:0] producer,
    output wire                           failed,         // a write failed; until reset
    output wire                           idle,           // memory holds every record
    input  wire                           s_valid,        // a record
    output wire                           s_ready,        // it is taken
    // record PAIR_RECORD or DONE_RECORD, docs/hardware/definitions.md
    input  wire [                  127:0] s_data,
    // ---- client of cchip_axi_write: one beat each
    output wire                           m_valid,        // a write of one beat, to cchip_axi_write
    input  wire                           m_ready,        // it is taken
    output wire [64-$clog2(DATA_W/8)-1:0] m_address,      // address of the beat
    output wire [             DATA_W-1:0] m_data,         // the record, in every part of the beat
    output wire [           DATA_W/8-1:0] m_strb,         // the part that is the record
    input  wire                           s_answer,       // answer to a write, in their order
    input  wire [ `CCHIP_WRITE_CODE_W-1:0] s_answer_code  // WriteCode, docs/hardware/definitions.md
);

  localparam integer RECORDS = DATA_W / 128;  // of a beat
  localparam integer LANE_W = RECORDS < 2 ? 1 : $clog2(RECORDS);

  `CCHIP_REFUSE(DATA_W != 128 && DATA_W != 256 && DATA_W != 512,
                cchip_error_record_ring_DATA_W_must_be_128_256_or_512)

  reg [31:0] written_q, held_q;  // records given to memory, confirmed by it
  reg failed_q;

  // ---- one record: empty -> here, until there is room -> valid, until memory takes it. s_ready,
  // and all that 128 flip-flops depend on, is a flip-flop: no handshake spans the chip
  reg empty_q, here_q, valid_q;
  reg [59:0] address_q;
  reg [127:0] data_q;
  reg phase_q;
  // ---- room, in three stages, because a sum and a comparison of 32 bits do not fit into a clock:
  // the consumer, the records that are not read, whether there is room. Records are 3 clocks or
  // more apart, so the last stage knows of all of them
  reg [31:0] mask_q;              // size of the ring - 1
  reg [31:0] consumer_q, held_q2;  // of the same clock
  reg [31:0] unread_q, confirmed_q;  // confirmed and unread; huge if the host is ahead of memory
  reg room_q, host_q;
  wire take = here_q & room_q & host_q & ~failed_q;
  wire sent = valid_q & m_ready;
  always @(posedge clk) begin
    mask_q      <= ~(32'hFFFFFFFF << size_log2);
    consumer_q  <= rst ? 32'd0 : consumer;
    held_q2     <= held_q;
    unread_q    <= rst ? 32'd0 : written_q - consumer_q;
    confirmed_q <= held_q2 - consumer_q;
    room_q      <= ~rst & ~|(unread_q & ~mask_q);
    host_q      <= ~|(confirmed_q & ~mask_q);
  end

  wire [31:0] place = written_q & mask_q;
  wire [31:0] round = written_q >> size_log2;
  wire good = s_answer && s_answer_code == `CCHIP_WRITE_OK;
  always @(posedge clk) begin
    if (empty_q) data_q <= s_data;
    if (!valid_q) begin
      phase_q   <= ~round[0];
      address_q <= base + {28'd0, place};
    end
    if (rst) begin
      written_q <= 32'd0;
      held_q    <= 32'd0;
      failed_q  <= 1'b0;
      empty_q   <= 1'b1;
      here_q    <= 1'b0;
      valid_q   <= 1'b0;
    end else begin
      empty_q  <= empty_q ? ~s_valid : sent;
      here_q   <= (empty_q & s_valid) | (here_q & ~take);
      valid_q  <= take | (valid_q & ~m_ready);
      failed_q <= failed_q | (s_answer & ~good);
      if (take) written_q <= written_q + 32'd1;
      if (good && !failed_q) held_q <= held_q + 32'd1;
    end
  end
  assign producer = held_q;
  assign failed   = failed_q;
  assign idle     = held_q == written_q && !here_q;
  assign s_ready  = empty_q;
  assign m_valid  = valid_q;
  reg [127:0] record;
  always @* begin
    record                           = data_q;
    record[`CCHIP_PAIR_RECORD_PHASE] = phase_q;
  end
  assign m_data = {RECORDS{record}};
  wire unused = &{1'b0, round[31:1]};
  generate
    if (RECORDS == 1) begin : gen_lane
      assign m_address = address_q;
      assign m_strb    = 16'hFFFF;
    end else begin : gen_lane
      wire [LANE_W-1:0] lane = address_q[LANE_W-1:0];
      assign m_address = address_q[59:LANE_W];
      assign m_strb    = {{DATA_W / 8 - 16{1'b0}}, 16'hFFFF} << {lane, 4'd0};
    end
  endgenerate

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_answer, !s_answer || held_q != written_q)
    end

endmodule
`default_nettype wire
