// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_bitstream_fetch: AXI4 read master that reads consecutive words from memory into a FIFO.
// run = 1 starts; address and words are taken on its first clock. run = 0 empties the FIFO; beats
// that are still outstanding are dropped when they come. outstanding is 1 until then, and run must
// stay 0 as long.
//   latency      m_valid 5 clocks after run plus the memory's, counted from arvalid = 1, arready =
//                1 to rvalid = 1
//   throughput   one word per clock if a read takes less than 13 clocks
//   bursts       up to 16 beats, within 64 bytes (never across 4 KiB); two outstanding; only
//                what the FIFO has room for
//   cuts         every path but m_ready to the FIFO's: each output is a flip-flop; m_axi_rready is
//                always 1
//   errors       bus_error: rresp other than OKAY, rlast too early or too late, a beat that was not
//                requested; timeout: `limit` clocks without an address taken or a beat, 2 clocks
//                later. Both stay 1 until run = 0; nothing enters the FIFO any more. RLAST ends a
//                burst, regardless of the count.
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any
//                clock, also during a wait: a lower one that has passed already ends it 3 clocks
//                after the change, a higher one, or 0, gives more time
//   reset        must reset the bus too: after it no beat of an earlier read may come
module cchip_bitstream_fetch #(
    parameter integer FIFO_DEPTH = 32   // capacity of the FIFO (word); legal: >= 32
) (
    input  wire        clk,            // clock, rising edge
    input  wire        rst,            // synchronous reset, active high
    input  wire        run,            // 1: work
    input  wire [31:0] address,  // first word, byte, multiple of 4; read on the first clock of run
    input  wire [29:0] words,          // words to fetch; read on the first clock of run
    input  wire [31:0] limit,  // longest wait: 1..2^32 - 1 clocks; 0: CCHIP_MEMORY_LIMIT_DEFAULT
    output wire        m_valid,        // m_data is the next word
    input  wire        m_ready,        // the word is taken if m_valid = 1 as well
    output wire [31:0] m_data,         // word
    output wire        bus_error,      // error on the bus, until run = 0
    output wire        timeout,  // limit clocks without an address taken or a beat, until run = 0
    output wire        outstanding,    // an address is not taken yet or beats are to come
    output wire        m_axi_arvalid,  // AXI4 read address
    input  wire        m_axi_arready,  // address taken
    output wire [31:0] m_axi_araddr,   // address, byte
    output wire [ 7:0] m_axi_arlen,    // beats - 1, up to 15
    input  wire        m_axi_rvalid,   // beat
    output wire        m_axi_rready,   // 1 except in reset
    input  wire [31:0] m_axi_rdata,    // data
    input  wire [ 1:0] m_axi_rresp,    // response; anything but OKAY is an error
    input  wire        m_axi_rlast     // last beat of a burst
);


  localparam integer COUNT_W = $clog2(FIFO_DEPTH + 1);
  localparam [31:0] ROOM = FIFO_DEPTH - 16;

  `CCHIP_REFUSE(FIFO_DEPTH < 32, cchip_error_bitstream_fetch_FIFO_DEPTH_below_32)

  reg run_q;
  reg error_q, timeout_q;
  wire working = run & run_q & ~error_q & ~timeout_q;

  // ---- addresses: length of the next burst, then the burst
  reg [31:0] addr_q;
  reg [29:0] left_q;  // words not yet asked for
  reg planned_q;  // beats_q is the length of the burst at addr_q
  reg [4:0] beats_q;
  reg arvalid_q;
  reg [1:0] bursts_q;  // addresses taken, last beat not yet here
  reg [COUNT_W-1:0] reserved_q;  // words asked for and not yet taken from the FIFO, a clock late

  reg [4:0] to_edge_q;  // words from addr_q to the edge, which every burst but the last ends at
  wire fits = |left_q[29:5] || left_q[4:0] >= to_edge_q;
  wire room = {{32 - COUNT_W{1'b0}}, reserved_q} <= ROOM;
  wire issue = working & planned_q & ~arvalid_q & ~bursts_q[1] & room;
  wire taken = arvalid_q & m_axi_arready;
  reg pop_q;  // a word left the FIFO a clock ago

  always @(posedge clk) begin
    if (run && !run_q) begin
      addr_q <= address;
      left_q <= words;
      to_edge_q <= 5'd16 - {1'b0, address[5:2]};
    end else if (taken) begin
      addr_q <= addr_q + {25'd0, beats_q, 2'd0};
      left_q <= left_q - {25'd0, beats_q};
      to_edge_q <= 5'd16;
    end
    pop_q <= run_q & m_valid & m_ready;
    if (!planned_q) beats_q <= fits ? to_edge_q : left_q[4:0];
    if (rst) begin
      run_q      <= 1'b0;
      planned_q  <= 1'b0;
      arvalid_q  <= 1'b0;
      reserved_q <= {COUNT_W{1'b0}};
    end else begin
      run_q <= run;
      planned_q <= ~taken & (planned_q ? arvalid_q | working : working && left_q != 30'd0);
      arvalid_q <= issue | (arvalid_q & ~m_axi_arready);
      if (!run_q) reserved_q <= {COUNT_W{1'b0}};
      else
        // one addition: of the beats of a burst, less one if a word leaves
        reserved_q <= reserved_q + (issue ? {{COUNT_W - 5{1'b0}}, pop_q ? beats_q - 5'd1 : beats_q}
                                    : {COUNT_W{pop_q}});
    end
  end

  assign m_axi_arvalid = arvalid_q;
  assign m_axi_araddr  = addr_q;
  assign m_axi_arlen   = {3'd0, beats_q} - 8'd1;

  // ---- beats: RLAST ends a burst, the count only checks it
  reg rready_q;
  reg [4:0] first_q, second_q;  // beats to come of the oldest burst, of the one behind it
  wire beat = m_axi_rvalid & rready_q;
  wire busy = bursts_q != 2'd0;
  wire last = beat & m_axi_rlast & busy;
  wire good = busy && m_axi_rresp == 2'b00 && first_q != 5'd0 && m_axi_rlast == (first_q == 5'd1);
  // kept short: run is left out because its end empties the FIFO, rready_q because it is 1 whenever
  // run_q is 1
  wire push = m_axi_rvalid & run_q & ~error_q & ~timeout_q & good;

  always @(posedge clk) begin
    if (taken && (bursts_q == 2'd0 || (bursts_q == 2'd1 && last))) first_q <= beats_q;
    else if (last) first_q <= second_q;
    else if (beat && first_q != 5'd0) first_q <= first_q - 5'd1;
    if (taken) second_q <= beats_q;
    if (rst) begin
      rready_q <= 1'b0;
      bursts_q <= 2'd0;
      error_q  <= 1'b0;
    end else begin
      rready_q <= 1'b1;
      bursts_q <= bursts_q + {1'b0, taken} - {1'b0, last};
      error_q  <= run & (error_q | (beat & working & ~good));
    end
  end

  assign m_axi_rready = rready_q;
  assign bus_error = error_q;
  assign outstanding = arvalid_q | busy;

  // ---- clocks without an address taken or a beat
  wire limit_reached;
  wire [31:0] waited;
  cchip_timeout #(
      .DEFAULT(`CCHIP_MEMORY_LIMIT_DEFAULT)
  ) u_late (
      .clk    (clk),
      .restart(rst | taken | beat | ~outstanding),
      .limit  (limit),
      .elapsed(waited),
      .expired(limit_reached)
  );
  always @(posedge clk)
    if (rst) timeout_q <= 1'b0;
    else timeout_q <= run & (timeout_q | (working & limit_reached));
  assign timeout = timeout_q;

  wire fifo_ready;
  cchip_fifo #(
      .WIDTH     (32),
      .DEPTH     (FIFO_DEPTH),
      .ROOM_KNOWN(1)
  ) u_fifo (
      .clk    (clk),
      .rst    (rst | ~run_q),
      .s_valid(push),
      .s_ready(fifo_ready),
      .s_data (m_axi_rdata),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

  wire unused = &{1'b0, fifo_ready, waited};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_bursts, bursts_q != 2'd3)
      `CCHIP_ASSERT(a_start, !run || run_q || !outstanding)
    end

endmodule
`default_nettype wire
