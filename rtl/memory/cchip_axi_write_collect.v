// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_axi_write_collect: takes the writes of the clients of cchip_axi_write beat by beat, one
// client at a time, and passes a write on when all its beats are here.
//   write        ends with s_last or with the last beat of the line. A client keeps its turn until
//                its write ends; then the next one has it
//   order        writes in the order in which they end; beats in the same order. A beat is offered
//                as soon as it is here, also before its write is
//   latency      4 clocks from s_valid of an idle client to m_write_valid; s_ready follows s_valid
//                by a clock
//   throughput   a beat per clock
//   reset        no write
//   rules        For the clients those of cchip_axi_write. Beats leave in the order of their
//                writes, possibly before m_write_valid.
//   inside       A cchip_arbiter of the clients, a cchip_onehot_mux for their beats, and two
//                cchip_fifo of 16 entries, for writes and for beats.
module cchip_axi_write_collect #(
    parameter integer CLIENTS = 2,  // clients; legal: 1..4
    parameter integer DATA_W = 128  // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    input  wire                                       clk,             // clock, rising edge
    input  wire                                       rst,  // synchronous reset, active high
    // ---- writes, beat by beat
    input  wire [                        CLIENTS-1:0] s_valid,  // bit c: client c offers a beat
    // bit c: the beat is accepted if s_valid[c] = 1 as well
    output wire [                        CLIENTS-1:0] s_ready,
    // bit c: it is the last one of the write
    input  wire [                        CLIENTS-1:0] s_last,
    // address of the first beat, in beats; address in beats: / (DATA_W / 8), of the first beat
    input  wire [CLIENTS*(64-$clog2(DATA_W/8))-1:0] s_address,
    input  wire [                 CLIENTS*DATA_W-1:0] s_data,          // data
    input  wire [               CLIENTS*DATA_W/8-1:0] s_strb,          // strobes
    // a write whose beats are all here
    output wire                                       m_write_valid,
    // it is accepted if m_write_valid = 1 as well
    input  wire                                       m_write_ready,
    output wire [                                1:0] m_write_client,  // its client
    output wire [                                2:0] m_write_length,  // its beats - 1
    // address of its first beat, in beats
    output wire [        64-$clog2(DATA_W/8)-1:0] m_write_address,
    // ---- beats
    output wire                                       m_beat_valid,    // a beat
    // it is accepted if m_beat_valid = 1 as well
    input  wire                                       m_beat_ready,
    output wire [                       DATA_W/8-1:0] m_beat_strb,     // its strobes
    output wire [                         DATA_W-1:0] m_beat_data      // its data
);

  localparam integer STRB_W = DATA_W / 8;
  localparam integer ADDRESS_W = 64 - $clog2(STRB_W);
  localparam [31:0] LAST_BEAT = 512 / DATA_W - 1;
  // beats that wait: at least a line, and two for those on their way
  localparam integer QUEUE_DEPTH = 16;

  // ---- clients: one has its turn until its write ends. s_ready follows s_valid by a clock
  reg [CLIENTS-1:0] turn_q;  // whose turn it is, one-hot or 0
  reg [CLIENTS-1:0] ready_q;  // the same, while there is room
  reg begun_q;  // the write of that client has begun and not ended
  reg [4:0] held_q;  // beats taken that have not left their queue
  wire pop = m_beat_valid & m_beat_ready;  // a beat leaves it
  wire [CLIENTS-1:0] grant;

  // {last, address, strobes, data} of the client that is granted
  localparam integer BEAT_W = 1 + ADDRESS_W + STRB_W + DATA_W;
  wire [CLIENTS*BEAT_W-1:0] offered;
  genvar c;
  generate
    for (c = 0; c < CLIENTS; c = c + 1) begin : gen_client
      assign offered[BEAT_W*c+:BEAT_W] = {
        s_last[c], s_address[ADDRESS_W*c+:ADDRESS_W], s_strb[STRB_W*c+:STRB_W],
        s_data[DATA_W*c+:DATA_W]
      };
    end
  endgenerate
  wire last;
  wire [ADDRESS_W-1:0] address;
  wire [STRB_W-1:0] strb;
  wire [DATA_W-1:0] data;
  cchip_onehot_mux #(.N(CLIENTS), .WIDTH(BEAT_W)) u_choose (
      .select(ready_q),
      .s_data(offered),
      .m_data({last, address, strb, data})
  );
  wire [1:0] client;
  cchip_onehot_index #(.N(CLIENTS), .WIDTH(2)) u_client (.select(turn_q), .index(client));

  reg in_valid_q, in_end_q;  // a beat that was taken; it ends its write
  reg [1:0] in_client_q;
  reg [ADDRESS_W-1:0] in_address_q;  // of its write
  reg [2:0] in_length_q, in_place_q;  // its number in the write and in the line
  reg [STRB_W+DATA_W-1:0] in_beat_q;
  wire taken = |(s_valid & ready_q);
  wire [2:0] place = begun_q ? in_place_q + 3'd1 : address[2:0] & LAST_BEAT[2:0];
  wire ends = last || place == LAST_BEAT[2:0];
  wire begun_d = taken ? ~ends : begun_q;
  wire room = ~(held_q[4] | (&held_q[3:1]));  // at most 13: two more may be on their way
  wire [CLIENTS-1:0] turn_d = begun_d ? turn_q : grant;
  cchip_arbiter #(.N(CLIENTS)) u_turn (
      .clk    (clk),
      .rst    (rst),
      .request(s_valid),
      .grant  (grant),
      .take   (~begun_d & room)
  );
  always @(posedge clk) begin
    in_end_q  <= ends;
    in_beat_q <= {strb, data};
    turn_q    <= turn_d;
    if (taken) begin
      in_place_q  <= place;
      in_length_q <= begun_q ? in_length_q + 3'd1 : 3'd0;
      in_client_q <= client;
      if (!begun_q) in_address_q <= address;
    end
    if (rst) begin
      in_valid_q <= 1'b0;
      ready_q    <= {CLIENTS{1'b0}};
      begun_q    <= 1'b0;
      held_q     <= 5'd0;
    end else begin
      in_valid_q <= taken;
      ready_q    <= turn_d & {CLIENTS{room}};
      begun_q    <= begun_d;
      if (taken != pop) held_q <= held_q + {{4{pop}}, 1'b1};  // + 1 or - 1
    end
  end
  assign s_ready = ready_q;

  // ---- what waits
  localparam integer WRITE_W = 2 + 3 + ADDRESS_W;
  wire write_room, beat_room;
  cchip_fifo #(.WIDTH(WRITE_W), .DEPTH(QUEUE_DEPTH), .ROOM_KNOWN(1)) u_writes (
      .clk    (clk),
      .rst    (rst),
      .s_valid(in_valid_q & in_end_q),
      .s_ready(write_room),
      .s_data ({in_client_q, in_length_q, in_address_q}),
      .m_valid(m_write_valid),
      .m_ready(m_write_ready),
      .m_data ({m_write_client, m_write_length, m_write_address})
  );
  cchip_fifo #(.WIDTH(STRB_W + DATA_W), .DEPTH(QUEUE_DEPTH), .ROOM_KNOWN(1)) u_beats (
      .clk    (clk),
      .rst    (rst),
      .s_valid(in_valid_q),
      .s_ready(beat_room),
      .s_data (in_beat_q),
      .m_valid(m_beat_valid),
      .m_ready(m_beat_ready),
      .m_data ({m_beat_strb, m_beat_data})
  );

  wire unused = &{1'b0, write_room, beat_room};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_beat, !pop || held_q != 5'd0)
    end

endmodule
`default_nettype wire
