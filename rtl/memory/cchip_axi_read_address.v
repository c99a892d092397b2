// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_axi_read_address: requests and read addresses of cchip_axi_read: a queue per client, one
// stream of all of them in turn, and the address that is on offer. A request whose ID memory may
// still answer for an earlier read is refused instead.
//   refused      a request is refused if beats were pending under its ID as it became the head of
//                the requests, or if an address that was on offer then or since has been given up:
//                that address may carry the same ID
//   abandon      abandon = 1: the client of the read abandon_id has been answered. If its address
//                is on offer it stays there, as AXI demands, and nothing else is issued until it
//                has been taken
//   latency      5 clocks from s_valid to m_axi_arvalid
//   throughput   an address on every clock
//   cuts         all but refuse_ready to refuse and m_axi_arready to issue
//   reset        no request, no address
//   rules        A client asks for a slot only when its last answer for it has come. An address
//                once on offer stays until it is accepted, even if its read is given up. Until then
//                nothing is issued behind it, and the request that waits is refused, because the
//                abandoned address may carry the same ID.
//   inside       A cchip_fifo for each client, a cchip_stream_merge, a register for the first
//                request and one for the address on offer.
//   why          Whether beats are outstanding under an ID is looked up once, as the request
//                becomes the first one; what can change later is one bit, the abandoned address. So
//                no comparison of IDs lies between m_axi_arready and the next address.
module cchip_axi_read_address #(
    parameter integer CLIENTS = 3,      // clients; legal: 1..8
    parameter integer SLOTS = 16,  // lines that a client may be waiting for; legal: 2, 4, 8, 16, 32
    parameter integer DATA_W = 128      // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    input  wire                                      clk,            // clock, rising edge
    input  wire                                      rst,  // synchronous reset, active high
    // ---- requests, one of each client per clock
    input  wire [                       CLIENTS-1:0] s_valid,  // bit c: client c asks for a line
    input  wire [         CLIENTS*$clog2(SLOTS)-1:0] s_slot,         // its slot for the line
    input  wire [                    CLIENTS*58-1:0] s_line,  // number of the line, address / 64
    input  wire [                 CLIENTS*SLOTS-1:0] pending,  // bit of each ID: beats outstanding
    // the client of the read abandon_id has been answered with TIMEOUT
    input  wire                                      abandon,
    input  wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] abandon_id,      // ID of that read
    // a refusal is accepted on this clock
    input  wire                                      refuse_ready,
    output wire                                      refuse,  // the request head_id is refused
    // the address of head_id is put on offer; 1 clock later offer = 1
    output wire                                      issue,
    output wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] head_id,         // ID of the first request
    // first clock on which m_axi_arid is on offer
    output wire                                      offer,
    // the address of taken_id was accepted on the clock before
    output wire                                      taken,
    output wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] taken_id,        // its ID
    output wire                                      m_axi_arvalid,  // AXI4
    input  wire                                      m_axi_arready,  // AXI4
    output wire [$clog2(CLIENTS)+$clog2(SLOTS)-1:0] m_axi_arid,      // AXI4: {client, slot}
    output wire [                              63:0] m_axi_araddr,   // AXI4: a multiple of 64
    output wire [                               7:0] m_axi_arlen     // AXI4: beats of a line - 1
);


  localparam integer SLOT_W = $clog2(SLOTS);
  localparam integer ID_W = $clog2(CLIENTS) + SLOT_W;
  localparam [31:0] LAST_BEAT = 512 / DATA_W - 1;

  // ---- a queue per client, then one stream of {ID, line}
  wire [CLIENTS-1:0] waiting, granted, queue_ready;
  wire [(ID_W+58)*CLIENTS-1:0] waiting_data;
  wire next_valid;
  wire [ID_W-1:0] next_id;
  wire [57:0] next_line;
  wire load_head;
  genvar c;
  generate
    for (c = 0; c < CLIENTS; c = c + 1) begin : gen_client
      localparam [31:0] FIRST_ID = c * SLOTS;
      wire [SLOT_W-1:0] slot;
      wire [57:0] line;
      cchip_fifo #(.WIDTH(SLOT_W + 58), .DEPTH(SLOTS), .ROOM_KNOWN(1)) u_queue (
          .clk    (clk),
          .rst    (rst),
          .s_valid(s_valid[c]),
          .s_ready(queue_ready[c]),
          .s_data ({s_slot[SLOT_W*c+:SLOT_W], s_line[58*c+:58]}),
          .m_valid(waiting[c]),
          .m_ready(granted[c]),
          .m_data ({slot, line})
      );
      wire [ID_W-1:0] id = FIRST_ID[ID_W-1:0] | {{ID_W - SLOT_W{1'b0}}, slot};
      assign waiting_data[(ID_W+58)*c+:ID_W+58] = {id, line};
    end
  endgenerate
  cchip_stream_merge #(.SOURCES(CLIENTS), .WIDTH(ID_W + 58)) u_next (
      .clk    (clk),
      .rst    (rst),
      .s_valid(waiting),
      .s_ready(granted),
      .s_data (waiting_data),
      .m_valid(next_valid),
      .m_ready(load_head),
      .m_data ({next_id, next_line})
  );

  // ---- the head of the requests, and the address on offer
  reg head_valid_q, head_busy_q;
  reg [ID_W-1:0] head_id_q;
  reg [57:0] head_line_q;
  reg arvalid_q;
  reg ar_live_q;  // the client still waits for the read whose address is offered
  reg [ID_W-1:0] arid_q;
  reg [57:0] line_q;
  reg abandoned_q;  // the address that was offered on the last clock had been given up
  reg offer_q, taken_q;
  reg refused_q;  // the head was refused on the last clock: whether it is comes from far
  reg [ID_W-1:0] taken_id_q;
  wire abandoned = arvalid_q & ~ar_live_q;
  assign issue = head_valid_q & ~head_busy_q & (~arvalid_q | (m_axi_arready & ar_live_q));
  assign refuse = head_valid_q & head_busy_q & refuse_ready & ~refused_q;
  assign load_head = issue | refused_q | ~head_valid_q;
  always @(posedge clk) begin
    if (load_head) {head_id_q, head_line_q} <= {next_id, next_line};
    head_busy_q <= load_head ? pending[next_id] | abandoned | abandoned_q : head_busy_q | abandoned;
    abandoned_q <= abandoned;
    taken_id_q  <= arid_q;
    if (issue) begin
      arid_q <= head_id_q;
      line_q <= head_line_q;
    end
    if (rst) begin
      head_valid_q <= 1'b0;
      refused_q    <= 1'b0;
      arvalid_q    <= 1'b0;
      ar_live_q    <= 1'b0;
      offer_q      <= 1'b0;
      taken_q      <= 1'b0;
    end else begin
      if (load_head) head_valid_q <= next_valid;
      refused_q <= refuse;
      arvalid_q <= issue | (arvalid_q & ~m_axi_arready);
      ar_live_q <= issue | (ar_live_q & ~(abandon && abandon_id == arid_q));
      offer_q   <= issue;
      taken_q   <= arvalid_q & m_axi_arready;
    end
  end
  assign head_id       = head_id_q;
  assign offer         = offer_q;
  assign taken         = taken_q;
  assign taken_id      = taken_id_q;
  assign m_axi_arvalid = arvalid_q;
  assign m_axi_arid    = arid_q;
  assign m_axi_araddr  = {line_q, 6'd0};
  assign m_axi_arlen   = LAST_BEAT[7:0];

  wire unused = &{1'b0, queue_ready};

endmodule
`default_nettype wire
