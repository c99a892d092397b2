// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_axi_write_send: sends the writes of cchip_axi_write_collect, address and data, or refuses
// them while the response to a write that was given up is outstanding.
//   send         a write is sent if no response is pending, with room, and the address can leave;
//                its beats follow, one in 2 clocks
//   answered     once no client waits any more (awaited = 0), the beats that are left are taken
//                from their queue at once, and what memory still has to be offered goes out
//                without strobes
//   refuse       while a response is pending and no client waits, the write leaves its queues
//                and refused, after its last beat
//   latency      1 clock from s_write_valid to m_axi_awvalid, 3 to m_axi_wvalid
//   throughput   a beat in 2 clocks, an address on every clock
//   cuts         the AXI side: its outputs are flip-flops, and m_axi_awready and m_axi_wready end
//                in one
//   reset        nothing is sent
//   rules        If its client is answered with TIMEOUT before all beats have left, the rest of
//                them is taken from the queue at once and goes out without strobes, since AXI wants
//                the burst complete.
//   inside       Two counts of beats, of those that leave the queue (take_*) and of those that are
//                sent (send_*). They run together until the client has been answered. Two
//                cchip_skid_buffer towards AXI.
module cchip_axi_write_send #(
    parameter integer DATA_W = 128  // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    input  wire                              clk,             // clock, rising edge
    input  wire                              rst,             // synchronous reset, active high
    input  wire                              s_write_valid,   // a write whose beats are all here
    // it is accepted if s_write_valid = 1 as well
    output wire                              s_write_ready,
    input  wire [                       1:0] s_write_client,  // its client
    input  wire [                       2:0] s_write_length,  // its beats - 1
    input  wire [64-$clog2(DATA_W/8)-1:0] s_write_address,    // address of its first beat, in beats
    input  wire                              s_beat_valid,    // a beat
    // it is accepted if s_beat_valid = 1 as well
    output wire                              s_beat_ready,
    input  wire [              DATA_W/8-1:0] s_beat_strb,     // its strobes
    input  wire [                DATA_W-1:0] s_beat_data,     // its data
    input  wire                              awaited,  // a client waits for a write in flight
    input  wire                              room,            // another write may be in flight
    // the response to a write that was given up is outstanding
    input  wire                              pending,
    output wire                              issue,           // this write is sent
    // a write was refused, all its beats are gone
    output wire                              refused,
    output wire [                       1:0] refused_client,  // its client
    output wire                              m_axi_awvalid,   // AXI4
    input  wire                              m_axi_awready,   // AXI4
    output wire [                      63:0] m_axi_awaddr,    // AXI4
    output wire [                       7:0] m_axi_awlen,     // AXI4: beats - 1
    output wire                              m_axi_wvalid,    // AXI4
    input  wire                              m_axi_wready,    // AXI4
    output wire [                DATA_W-1:0] m_axi_wdata,     // AXI4
    // AXI4; 0 once the client has been answered
    output wire [              DATA_W/8-1:0] m_axi_wstrb,
    output wire                              m_axi_wlast      // AXI4
);

  localparam integer STRB_W = DATA_W / 8;
  localparam integer BYTES_LOG2 = $clog2(STRB_W);
  localparam integer ADDRESS_W = 64 - BYTES_LOG2;

  // Beats leave their queue as they are sent; if their client has been answered (awaited = 0), at
  // once
  wire aw_ready, w_ready;
  reg take_q, take_last_q;  // a beat of this write is to leave the queue; it is the last one
  reg send_q, send_last_q;  // a beat is to be sent; it is the last one
  reg [2:0] take_left_q, send_left_q;  // beats behind it
  reg refused_q;  // the write is refused
  reg [1:0] refused_client_q;
  // both are decided on one clock and done on the next: the queue of beats and what is sent are
  // wide, and lie far from each other
  reg send, pop;  // a beat is sent, leaves its queue
  wire busy = send | pop;
  assign s_beat_ready = pop;
  always @(posedge clk) begin
    send <= ~rst & ~busy & send_q & w_ready & (s_beat_valid | ~awaited);
    pop  <= ~rst & ~busy & take_q & s_beat_valid & (w_ready | ~awaited);
  end
  wire take_free = ~take_q | (pop & take_last_q);
  wire refuse = s_write_valid & take_free & pending & ~awaited;
  assign issue = s_write_valid & take_free & ~pending & room & aw_ready;
  assign s_write_ready = take_free & (pending ? ~awaited : room & aw_ready);
  assign refused = pop & take_last_q & refused_q;
  always @(posedge clk) begin
    if (issue | refuse) begin
      take_left_q      <= s_write_length;
      take_last_q      <= s_write_length == 3'd0;
      refused_q        <= refuse;
      refused_client_q <= s_write_client;
    end else if (pop) begin
      take_left_q <= take_left_q - 3'd1;
      take_last_q <= take_left_q == 3'd1;
    end
    if (issue) begin
      send_left_q <= s_write_length;
      send_last_q <= s_write_length == 3'd0;
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
  cchip_skid_buffer #(.WIDTH(3 + ADDRESS_W)) u_address (
      .clk    (clk),
      .rst    (rst),
      .s_valid(issue),
      .s_ready(aw_ready),
      .s_data ({s_write_length, s_write_address}),
      .m_valid(m_axi_awvalid),
      .m_ready(m_axi_awready),
      .m_data ({m_length, m_address})
  );
  cchip_skid_buffer #(.WIDTH(1 + STRB_W + DATA_W)) u_data (
      .clk    (clk),
      .rst    (rst),
      .s_valid(send),
      .s_ready(w_ready),
      .s_data ({send_last_q, s_beat_strb & {STRB_W{awaited}}, s_beat_data}),
      .m_valid(m_axi_wvalid),
      .m_ready(m_axi_wready),
      .m_data ({m_axi_wlast, m_axi_wstrb, m_axi_wdata})
  );
  assign m_axi_awaddr   = {m_address, {BYTES_LOG2{1'b0}}};
  assign m_axi_awlen    = {5'd0, m_length};
  assign refused_client = refused_client_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_refuse, !(refused_q && take_q && awaited))
      `CCHIP_ASSERT(a_send, !issue || !send_q || (send && send_last_q))
      `CCHIP_ASSERT(a_step, !send_q || !awaited || (take_q && take_left_q == send_left_q))
    end

endmodule
`default_nettype wire
