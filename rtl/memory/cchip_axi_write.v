// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_axi_write: AXI4 write master, shared by several clients, for writes that lie within a line
// of 64 bytes: one beat, or several that follow one another.
//   write        its beats in order, the address with the first one. It ends with s_last, or with
//                the last beat of the line regardless of s_last: no burst leaves a line, so none
//                crosses 4 KiB. Writes of several clients are served in turn, never mixed. A client
//                must offer the rest of a write that it has begun without waiting for anything but
//                s_ready
//   answer       one for each write, in the order of the client's writes: CCHIP_WRITE_OK once
//                memory has answered OKAY, CCHIP_WRITE_BUS for another response. There is no ready:
//                the client must take it
//   silence      a write that lasts longer than `limit` clocks, its address and data included, is
//                answered with CCHIP_WRITE_TIMEOUT after 2 limit + OUTSTANDING + 8 clocks at the
//                latest; memory may hold all of it, parts or nothing. What memory has not been
//                offered of its data is sent without strobes. While that response is outstanding, a
//                write is not sent but answered with CCHIP_WRITE_OWED. A response that comes after
//                the answer, or unasked, is dropped
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any
//                clock, also during writes: a lower one ends them after 2 limit + OUTSTANDING + 10
//                clocks from the change at the latest, a higher one, or 0, gives them more time
//   order        one ID, so responses come in the order of addresses, and data go in that order.
//                Addresses and data of a write are offered only when all its beats are here: no
//                client can stall the bus
//   attributes   the top says awsize (whole beats), awburst (INCR), awcache and awprot
//   latency      5 clocks from s_valid to awvalid, 7 to wvalid, 2 from a response to m_valid
//   throughput   a beat in 2 clocks, an address on every clock
//   reset        must reset the bus too: after it no response to an earlier write may come
module cchip_axi_write #(
    parameter integer CLIENTS = 2,       // clients; legal: 1..4
    parameter integer DATA_W = 128,      // width of the data bus (bit); legal: 64, 128, 256, 512
    parameter integer OUTSTANDING = 16,  // writes that memory may have to answer; legal: 1..64
    parameter integer ID_W = 1           // width of the ID, which is always 0 (bit); legal: 1..16
) (
    // ---- clock and reset
    input  wire                                       clk,              // clock, rising edge
    input  wire                                       rst,  // synchronous reset, active high
    // ---- time limit
    // write timeout in clocks, 1..2^32 - 1; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                               31:0] limit,
    // ---- requests: writes, beat by beat
    input  wire [                        CLIENTS-1:0] s_valid,  // bit c: client c offers a beat
    // bit c: its beat is taken; at most one bit is 1
    output wire [                        CLIENTS-1:0] s_ready,
    input  wire [                        CLIENTS-1:0] s_last,           // last beat of the write
    // address of the write in units of a beat, DATA_W / 8 bytes; looked at with its first beat
    input  wire [CLIENTS*(64-$clog2(DATA_W/8))-1:0] s_address,
    input  wire [                 CLIENTS*DATA_W-1:0] s_data,           // data
    input  wire [               CLIENTS*DATA_W/8-1:0] s_strb,           // bit i: byte i is written
    // ---- answers
    // bit c: the oldest write of client c without an answer is answered; at most one bit is 1
    output wire [                        CLIENTS-1:0] m_valid,
    // outcome of the write (WriteCode, docs/hardware/definitions.md)
    output wire [             `CCHIP_WRITE_CODE_W-1:0] m_code,
    // ---- status
    // memory has to answer writes, those that were given up included
    output wire                                       any_outstanding,
    // ---- AXI4 write address
    output wire                                       m_axi_awvalid,    // AXI4 write address
    input  wire                                       m_axi_awready,    // address taken
    output wire [                           ID_W-1:0] m_axi_awid,       // constant 0
    // address, byte, multiple of a beat
    output wire [                               63:0] m_axi_awaddr,
    output wire [                                7:0] m_axi_awlen,      // beats - 1
    // ---- AXI4 write data
    output wire                                       m_axi_wvalid,     // AXI4 write data
    input  wire                                       m_axi_wready,     // beat taken
    output wire [                         DATA_W-1:0] m_axi_wdata,      // data
    output wire [                       DATA_W/8-1:0] m_axi_wstrb,      // bytes that are written
    output wire                                       m_axi_wlast,      // last beat of its write
    // ---- AXI4 write response
    input  wire                                       m_axi_bvalid,     // response
    output wire                                       m_axi_bready,     // 0 in reset only
    // a response with another ID than 0 is dropped
    input  wire [                           ID_W-1:0] m_axi_bid,
    // response; anything but OKAY is an error
    input  wire [                                1:0] m_axi_bresp
);


  localparam integer STRB_W = DATA_W / 8;
  localparam integer ADDRESS_W = 64 - $clog2(STRB_W);
  localparam integer COUNT_W = OUTSTANDING < 1 ? 1 : $clog2(OUTSTANDING + 1);

  `CCHIP_REFUSE(CLIENTS < 1 || CLIENTS > 4, cchip_error_axi_write_CLIENTS_must_be_1_to_4)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_axi_write_DATA_W_must_be_64_128_256_or_512)
  `CCHIP_REFUSE(OUTSTANDING < 1 || OUTSTANDING > 64,
                cchip_error_axi_write_OUTSTANDING_must_be_1_to_64)
  `CCHIP_REFUSE(ID_W < 1 || ID_W > 16, cchip_error_axi_write_ID_W_must_be_1_to_16)

  // ---- beats of the clients, and for each write whose beats are all there its client, length and
  // address
  wire write_valid, write_ready;
  wire [1:0] client;
  wire [2:0] length;
  wire [ADDRESS_W-1:0] address;
  wire beat_valid, beat_ready;
  wire [STRB_W-1:0] beat_strb;
  wire [DATA_W-1:0] beat_data;
  cchip_axi_write_collect #(.CLIENTS(CLIENTS), .DATA_W(DATA_W)) u_collect (
      .clk            (clk),
      .rst            (rst),
      .s_valid        (s_valid),
      .s_ready        (s_ready),
      .s_last         (s_last),
      .s_address      (s_address),
      .s_data         (s_data),
      .s_strb         (s_strb),
      .m_write_valid  (write_valid),
      .m_write_ready  (write_ready),
      .m_write_client (client),
      .m_write_length (length),
      .m_write_address(address),
      .m_beat_valid   (beat_valid),
      .m_beat_ready   (beat_ready),
      .m_beat_strb    (beat_strb),
      .m_beat_data    (beat_data)
  );

  // ---- writes in flight: those that a client waits for, and in front of them those that were
  // given up and whose response is outstanding
  wire waiting_some, waiting_room, dropped_some, dropped_room;
  wire [COUNT_W-1:0] waiting, dropped;
  wire issue, timeout;  // the first write that is waited for is given up
  wire answered, stale;  // a response comes: to that write; to one that was given up
  cchip_count #(.LIMIT(OUTSTANDING)) u_waiting (
      .clk  (clk),
      .rst  (rst),
      .up   (issue),
      .down (answered | timeout),
      .count(waiting),
      .some (waiting_some),
      .room (waiting_room)
  );
  cchip_count #(.LIMIT(OUTSTANDING)) u_dropped (
      .clk  (clk),
      .rst  (rst),
      .up   (timeout),
      .down (stale),
      .count(dropped),
      .some (dropped_some),
      .room (dropped_room)
  );

  // ---- the first write is sent, or refused while a response is outstanding that was given up
  wire refused;
  wire [1:0] refused_client;
  cchip_axi_write_send #(.DATA_W(DATA_W)) u_send (
      .clk            (clk),
      .rst            (rst),
      .s_write_valid  (write_valid),
      .s_write_ready  (write_ready),
      .s_write_client (client),
      .s_write_length (length),
      .s_write_address(address),
      .s_beat_valid   (beat_valid),
      .s_beat_ready   (beat_ready),
      .s_beat_strb    (beat_strb),
      .s_beat_data    (beat_data),
      .awaited        (waiting_some),
      .room           (waiting_room),
      .pending        (dropped_some),
      .issue          (issue),
      .refused        (refused),
      .refused_client (refused_client),
      .m_axi_awvalid  (m_axi_awvalid),
      .m_axi_awready  (m_axi_awready),
      .m_axi_awaddr   (m_axi_awaddr),
      .m_axi_awlen    (m_axi_awlen),
      .m_axi_wvalid   (m_axi_wvalid),
      .m_axi_wready   (m_axi_wready),
      .m_axi_wdata    (m_axi_wdata),
      .m_axi_wstrb    (m_axi_wstrb),
      .m_axi_wlast    (m_axi_wlast)
  );
  assign m_axi_awid    = {ID_W{1'b0}};

  // ---- responses. One counts only if there is a write whose address and data were taken
  reg aw_taken_q, w_taken_q;
  reg bready_q, b_valid_q, b_bad_q;
  wire address_some, address_room, data_some, data_room;
  wire [COUNT_W-1:0] addresses, bursts;
  wire b_counts = b_valid_q & address_some & data_some;
  cchip_count #(.LIMIT(OUTSTANDING)) u_addresses (
      .clk  (clk),
      .rst  (rst),
      .up   (aw_taken_q),
      .down (b_counts),
      .count(addresses),
      .some (address_some),
      .room (address_room)
  );
  cchip_count #(.LIMIT(OUTSTANDING)) u_bursts (
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

  // ---- time: the first write that is waited for is given up when it has expired
  wire gone = answered | timeout;
  cchip_axi_write_late #(.COUNT_W(COUNT_W)) u_late (
      .clk     (clk),
      .rst     (rst),
      .limit   (limit),
      .waiting (waiting),
      .answered(answered),
      .timeout (timeout)
  );

  // ---- answers, and whose they are
  localparam integer CLIENT_W = OUTSTANDING < 2 ? 1 : $clog2(OUTSTANDING);
  `CCHIP_LUT_RAM
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
  reg [`CCHIP_WRITE_CODE_W-1:0] code_q;
  reg any_outstanding_q;
  wire [3:0] one_client = 4'd1 << (refused ? refused_client : first_client);
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

  wire unused = &{1'b0, one_client, dropped, addresses, bursts, dropped_room, address_room,
                  data_room};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one_answer, !(refused && gone))
    end

endmodule
`default_nettype wire
