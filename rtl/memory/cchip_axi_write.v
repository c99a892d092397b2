// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_axi_write: AXI4 write master, shared by several clients, for writes that lie within a line
// of 64 bytes: one beat, or several that follow one another.
//   write        its beats in order, the address with the first one. It ends with s_last, or with
//                the last beat of the line whatever s_last is: no burst leaves a line, so none
//                crosses 4 KiB. Writes of several clients are served in turn, never mixed. A client
//                must offer the rest of a write that it has begun without waiting for anything but
//                s_ready
//   answer       one for each write, in the order of the client's writes: CCHIP_WRITE_OK once
//                memory has answered OKAY, CCHIP_WRITE_BUS for another response. There is no ready:
//                the client must take it
//   silence      a write that lasts longer than `limit` clocks, its address and data included, is
//                answered with CCHIP_WRITE_TIMEOUT after 2 limit + OUTSTANDING + 8 clocks at the
//                latest; memory may hold all of it, parts or nothing. What memory has not been
//                offered of its data is sent without strobes. While memory owes that response, a
//                write is not sent but answered with CCHIP_WRITE_OWED. A response that comes after
//                the answer, or unasked, is dropped
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any
//                clock, also during writes: a lower one ends them after 2 limit + OUTSTANDING + 10
//                clocks from the change at the latest, a higher one, or 0, gives them more time
//   order        one ID, so responses come in the order of addresses, and data go in that order.
//                Addresses and data of a write are offered only when all its beats are here: no
//                client can stall the bus
//   latency      5 clocks from s_valid to awvalid, 6 to wvalid, 2 from a response to m_valid
//   throughput   a beat and an address on every clock
//   cuts         every path: each output is a flip-flop
//   reset        must reset the bus too: after it no response to an earlier write may come
module cchip_axi_write #(
    // clients, 1..4
    parameter integer CLIENTS = 2,
    // width of the data bus, bit: 64, 128, 256 or 512
    parameter integer DATA_W = 128,
    // most writes that memory has to answer, 1..64
    parameter integer OUTSTANDING = 16,
    // width of the ID, which is 0: 1..16
    parameter integer ID_W = 1
) (
    input  wire                                       clk,
    input  wire                                       rst,
    input  wire [                               31:0] limit,         // clocks; 0: default
    // writes, beat by beat
    input  wire [                        CLIENTS-1:0] s_valid,
    output wire [                        CLIENTS-1:0] s_ready,       // one-hot or 0
    input  wire [                        CLIENTS-1:0] s_last,
    // address in beats: / (DATA_W / 8), of the first beat
    input  wire [CLIENTS*(64-$clog2(DATA_W/8))-1:0] s_address,
    input  wire [                 CLIENTS*DATA_W-1:0] s_data,
    input  wire [               CLIENTS*DATA_W/8-1:0] s_strb,
    // answers
    output wire [                        CLIENTS-1:0] m_valid,       // one-hot or 0
    output wire [             `CCHIP_WRITE_CODE_W-1:0] m_code,
    output wire                                       any_outstanding,
    output wire                                       m_axi_awvalid,
    input  wire                                       m_axi_awready,
    output wire [                           ID_W-1:0] m_axi_awid,
    output wire [                               63:0] m_axi_awaddr,
    output wire [                                7:0] m_axi_awlen,
    output wire [                                2:0] m_axi_awsize,
    output wire [                                1:0] m_axi_awburst,
    output wire [                                3:0] m_axi_awcache,
    output wire [                                2:0] m_axi_awprot,
    output wire                                       m_axi_wvalid,
    input  wire                                       m_axi_wready,
    output wire [                         DATA_W-1:0] m_axi_wdata,
    output wire [                       DATA_W/8-1:0] m_axi_wstrb,
    output wire                                       m_axi_wlast,
    input  wire                                       m_axi_bvalid,
    output wire                                       m_axi_bready,
    input  wire [                           ID_W-1:0] m_axi_bid,
    input  wire [                                1:0] m_axi_bresp
);

  localparam integer STRB_W = DATA_W / 8;
  localparam integer BYTES_LOG2 = $clog2(STRB_W);
  localparam integer ADDRESS_W = 64 - BYTES_LOG2;
  localparam integer COUNT_W = $clog2(OUTSTANDING + 1);
  localparam integer CODE_W = `CCHIP_WRITE_CODE_W;
  localparam [31:0] BEATS = 512 / DATA_W;
  localparam [31:0] LAST_BEAT = BEATS - 1;
  localparam [31:0] SIZE = BYTES_LOG2;
  // beats that wait: at least a line, and two for those on their way
  localparam integer QUEUE_DEPTH = 16;

  generate
    if (CLIENTS < 1 || CLIENTS > 4) begin : gen_illegal_clients
      cchip_error_axi_write_CLIENTS_must_be_1_to_4 u_error ();
    end
    if (DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W) begin : gen_illegal_width
      cchip_error_axi_write_DATA_W_must_be_64_128_256_or_512 u_error ();
    end
    if (OUTSTANDING < 1 || OUTSTANDING > 64) begin : gen_illegal_outstanding
      cchip_error_axi_write_OUTSTANDING_must_be_1_to_64 u_error ();
    end
    if (ID_W < 1 || ID_W > 16) begin : gen_illegal_id
      cchip_error_axi_write_ID_W_must_be_1_to_16 u_error ();
    end
  endgenerate

  // ---- clients: one has its turn until its write ends. s_ready follows s_valid by a clock
  reg [CLIENTS-1:0] turn_q;  // whose turn it is, one-hot or 0
  reg [CLIENTS-1:0] ready_q;  // the same, while there is room
  reg begun_q;  // the write of that client has begun and not ended
  reg [4:0] held_q;  // beats taken that have not left their queue
  wire pop;  // a beat leaves it
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
  function [BEAT_W-1:0] choose(input [CLIENTS*BEAT_W-1:0] from, input [CLIENTS-1:0] one);
    integer j;
    begin
      choose = {BEAT_W{1'b0}};
      for (j = 0; j < CLIENTS; j = j + 1) if (one[j]) choose = choose | from[BEAT_W*j+:BEAT_W];
    end
  endfunction
  function [1:0] number(input [CLIENTS-1:0] one);
    integer j;
    begin
      number = 2'd0;
      for (j = 0; j < CLIENTS; j = j + 1) if (one[j]) number = number | j[1:0];
    end
  endfunction

  wire last;
  wire [ADDRESS_W-1:0] address;
  wire [STRB_W-1:0] strb;
  wire [DATA_W-1:0] data;
  assign {last, address, strb, data} = choose(offered, ready_q);

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
  cchip_arbiter #(
      .N(CLIENTS)
  ) u_turn (
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
      in_client_q <= number(turn_q);
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

  // ---- beats, and for each write whose beats are all there {client, beats - 1, address}
  localparam integer WRITE_W = 2 + 3 + ADDRESS_W;
  wire write_valid, write_leaves;
  wire [1:0] client;
  wire [2:0] length;
  wire [ADDRESS_W-1:0] write_address;
  wire beat_valid;
  wire [STRB_W-1:0] beat_strb;
  wire [DATA_W-1:0] beat_data;
  wire write_ready, beat_ready;
  cchip_fifo #(
      .WIDTH     (WRITE_W),
      .DEPTH     (QUEUE_DEPTH),
      .ROOM_KNOWN(1)
  ) u_writes (
      .clk    (clk),
      .rst    (rst),
      .s_valid(in_valid_q & in_end_q),
      .s_ready(write_ready),
      .s_data ({in_client_q, in_length_q, in_address_q}),
      .m_valid(write_valid),
      .m_ready(write_leaves),
      .m_data ({client, length, write_address})
  );
  cchip_fifo #(
      .WIDTH     (STRB_W + DATA_W),
      .DEPTH     (QUEUE_DEPTH),
      .ROOM_KNOWN(1)
  ) u_beats (
      .clk    (clk),
      .rst    (rst),
      .s_valid(in_valid_q),
      .s_ready(beat_ready),
      .s_data (in_beat_q),
      .m_valid(beat_valid),
      .m_ready(pop),
      .m_data ({beat_strb, beat_data})
  );

  // ---- writes in flight: those that a client waits for, and in front of them those that were
  // given up and whose response memory owes
  wire waiting_some, waiting_room, dropped_some, dropped_room;
  wire [COUNT_W-1:0] waiting, dropped;
  wire issue;
  wire answered;  // the response to the first write that is waited for
  wire stale;  // a response that comes after the answer
  wire timeout;  // the first write that is waited for is given up
  cchip_count #(
      .LIMIT(OUTSTANDING)
  ) u_waiting (
      .clk  (clk),
      .rst  (rst),
      .up   (issue),
      .down (answered | timeout),
      .count(waiting),
      .some (waiting_some),
      .room (waiting_room)
  );
  cchip_count #(
      .LIMIT(OUTSTANDING)
  ) u_dropped (
      .clk  (clk),
      .rst  (rst),
      .up   (timeout),
      .down (stale),
      .count(dropped),
      .some (dropped_some),
      .room (dropped_room)
  );

  // ---- the head of the queues. Its write is sent, or refused while memory owes. Beats leave their
  // queue as they are sent; if their client has been answered (waiting_some = 0) at once
  wire aw_ready, w_ready;
  reg take_q, take_last_q;  // a beat of this write is to leave the queue; it is the last one
  reg send_q, send_last_q;  // a beat is to be sent; it is the last one
  reg [2:0] take_left_q, send_left_q;  // beats behind it
  reg refused_q;  // the write is refused
  reg [1:0] refused_client_q;
  wire send = send_q & w_ready & (beat_valid | ~waiting_some);
  assign pop = take_q & beat_valid & (w_ready | ~waiting_some);
  wire take_free = ~take_q | (pop & take_last_q);
  wire refuse = write_valid & take_free & dropped_some & ~waiting_some;
  assign issue = write_valid & take_free & ~dropped_some & waiting_room & aw_ready;
  assign write_leaves = take_free & (dropped_some ? ~waiting_some : waiting_room & aw_ready);
  wire refused = pop & take_last_q & refused_q;
  always @(posedge clk) begin
    if (issue | refuse) begin
      take_left_q      <= length;
      take_last_q      <= length == 3'd0;
      refused_q        <= refuse;
      refused_client_q <= client;
    end else if (pop) begin
      take_left_q <= take_left_q - 3'd1;
      take_last_q <= take_left_q == 3'd1;
    end
    if (issue) begin
      send_left_q <= length;
      send_last_q <= length == 3'd0;
    end else if (send) begin
      send_left_q <= send_left_q - 3'd1;
      send_last_q <= send_left_q == 3'd1;
    end
    if (rst) begin
      take_q <= 1'b0;
      send_q <= 1'b0;
    end else begin
      take_q <= issue | refuse | (take_q & ~(pop & take_last_q));
      send_q <= issue | (send_q & ~(send & send_last_q));
    end
  end

  wire [2:0] m_length;
  wire [ADDRESS_W-1:0] m_address;
  cchip_skid_buffer #(
      .WIDTH(3 + ADDRESS_W)
  ) u_address (
      .clk    (clk),
      .rst    (rst),
      .s_valid(issue),
      .s_ready(aw_ready),
      .s_data ({length, write_address}),
      .m_valid(m_axi_awvalid),
      .m_ready(m_axi_awready),
      .m_data ({m_length, m_address})
  );
  cchip_skid_buffer #(
      .WIDTH(1 + STRB_W + DATA_W)
  ) u_data (
      .clk    (clk),
      .rst    (rst),
      .s_valid(send),
      .s_ready(w_ready),
      .s_data ({send_last_q, beat_strb & {STRB_W{waiting_some}}, beat_data}),
      .m_valid(m_axi_wvalid),
      .m_ready(m_axi_wready),
      .m_data ({m_axi_wlast, m_axi_wstrb, m_axi_wdata})
  );
  assign m_axi_awid    = {ID_W{1'b0}};
  assign m_axi_awaddr  = {m_address, {BYTES_LOG2{1'b0}}};
  assign m_axi_awlen   = {5'd0, m_length};
  assign m_axi_awsize  = SIZE[2:0];
  assign m_axi_awburst = 2'b01;
  // not bufferable: the response comes from where the data are seen by all
  assign m_axi_awcache = 4'b0010;
  assign m_axi_awprot  = 3'b000;

  // ---- responses. One counts only if there is a write whose address and data were taken
  reg aw_taken_q, w_taken_q;
  reg bready_q, b_valid_q, b_bad_q;
  wire address_some, address_room, data_some, data_room;
  wire [COUNT_W-1:0] addresses, bursts;
  wire b_counts = b_valid_q & address_some & data_some;
  cchip_count #(
      .LIMIT(OUTSTANDING)
  ) u_addresses (
      .clk  (clk),
      .rst  (rst),
      .up   (aw_taken_q),
      .down (b_counts),
      .count(addresses),
      .some (address_some),
      .room (address_room)
  );
  cchip_count #(
      .LIMIT(OUTSTANDING)
  ) u_bursts (
      .clk  (clk),
      .rst  (rst),
      .up   (w_taken_q),
      .down (b_counts),
      .count(bursts),
      .some (data_some),
      .room (data_room)
  );
  assign stale    = b_counts & dropped_some;
  assign answered = b_counts & ~dropped_some;
  always @(posedge clk) begin
    b_bad_q <= m_axi_bresp != 2'b00;
    if (rst) begin
      bready_q   <= 1'b0;
      b_valid_q  <= 1'b0;
      aw_taken_q <= 1'b0;
      w_taken_q  <= 1'b0;
    end else begin
      bready_q   <= 1'b1;
      b_valid_q  <= m_axi_bvalid && bready_q && m_axi_bid == {ID_W{1'b0}};
      aw_taken_q <= m_axi_awvalid & m_axi_awready;
      w_taken_q  <= m_axi_wvalid & m_axi_wready & m_axi_wlast;
    end
  end
  assign m_axi_bready = bready_q;

  // ---- time: a tick every limit + 1 clocks; a write that was in flight at two ticks is late
  wire tick;
  wire [31:0] since_tick;
  cchip_timeout #(
      .DEFAULT(`CCHIP_MEMORY_LIMIT_DEFAULT)
  ) u_tick (
      .clk    (clk),
      .restart(rst | tick),
      .limit  (limit),
      .elapsed(since_tick),
      .expired(tick)
  );
  reg [COUNT_W-1:0] old_q, late_q;  // writes waited for that saw the last tick, the last two
  assign timeout = late_q != {COUNT_W{1'b0}} && !answered;
  wire gone = answered | timeout;
  wire [COUNT_W-1:0] less = {{COUNT_W - 1{1'b0}}, gone};
  wire [COUNT_W-1:0] old_left = old_q - (old_q == {COUNT_W{1'b0}} ? {COUNT_W{1'b0}} : less);
  always @(posedge clk)
    if (rst) begin
      old_q  <= {COUNT_W{1'b0}};
      late_q <= {COUNT_W{1'b0}};
    end else begin
      old_q  <= tick ? waiting - less : old_left;
      late_q <= tick ? old_left : late_q - (late_q == {COUNT_W{1'b0}} ? {COUNT_W{1'b0}} : less);
    end

  // ---- answers, and whose they are
  localparam integer CLIENT_W = OUTSTANDING < 2 ? 1 : $clog2(OUTSTANDING);
  (* ram_style = "distributed" *)
  reg [1:0] clients[0:(1<<CLIENT_W)-1];
  reg [CLIENT_W-1:0] write_q, read_q;
  wire [1:0] first_client = clients[read_q];
  always @(posedge clk) begin
    if (issue) clients[write_q] <= client;
    if (rst) begin
      write_q <= {CLIENT_W{1'b0}};
      read_q  <= {CLIENT_W{1'b0}};
    end else begin
      if (issue) write_q <= write_q + {{CLIENT_W - 1{1'b0}}, 1'b1};
      if (gone) read_q <= read_q + {{CLIENT_W - 1{1'b0}}, 1'b1};
    end
  end
  reg [CLIENTS-1:0] valid_q;
  reg [CODE_W-1:0] code_q;
  reg any_outstanding_q;
  wire [3:0] one_client = 4'd1 << (refused ? refused_client_q : first_client);
  always @(posedge clk) begin
    code_q <= refused ? `CCHIP_WRITE_OWED : timeout ? `CCHIP_WRITE_TIMEOUT :
        b_bad_q ? `CCHIP_WRITE_BUS : `CCHIP_WRITE_OK;
    if (rst) begin
      valid_q <= {CLIENTS{1'b0}};
      any_outstanding_q <= 1'b0;
    end else begin
      valid_q <= refused | gone ? one_client[CLIENTS-1:0] : {CLIENTS{1'b0}};
      any_outstanding_q <= waiting_some | dropped_some;
    end
  end
  assign m_valid = valid_q;
  assign m_code  = code_q;
  assign any_outstanding = any_outstanding_q;

  wire unused = &{1'b0, one_client, dropped, addresses, bursts, write_ready, beat_ready,
                  dropped_room, address_room, data_room, since_tick};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one_answer, !(refused && gone))
      `CCHIP_ASSERT(a_refuse, !(refused_q && take_q && waiting_some))
      `CCHIP_ASSERT(a_send, !issue || !send_q || (send && send_last_q))
      `CCHIP_ASSERT(a_step, !send_q || !waiting_some || (take_q && take_left_q == send_left_q))
      `CCHIP_ASSERT(a_beat, !pop || held_q != 5'd0)
    end

endmodule
`default_nettype wire
