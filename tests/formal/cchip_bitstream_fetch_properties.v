// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_bitstream_fetch, for 38 clocks from reset, for any behaviour of memory (also against its own rules):
//   addresses are stable until taken, bursts lie within 64 bytes, two are in flight at most, the FIFO is never pushed when
//   full (assertion a_room of the FIFO); no word appears after run = 0; a timeout comes after `limit` clocks
//   without progress and never before, while `limit` changes on any clock; an error or a timeout lasts until run = 0. With ROOM, for 20 clocks: never are more words asked for than the
//   FIFO has room for.
module cchip_bitstream_fetch_properties (
    input wire        clk,
    input wire        rst,
    input wire        run,
    input wire [31:0] address,
    input wire [29:0] words,
    input wire        m_ready,
    input wire        m_axi_arready,
    input wire        m_axi_rvalid,
    input wire [31:0] m_axi_rdata,
    input wire [ 1:0] m_axi_rresp,
    input wire        m_axi_rlast
);
  // changes on any clock; 0, which means the default, is a limit that no trace reaches
  (* anyseq *) wire [2:0] any_limit;
  wire [31:0] limit = any_limit;
  wire m_valid, bus_error, timeout, outstanding, m_axi_arvalid, m_axi_rready;
  wire [31:0] m_data, m_axi_araddr;
  wire [7:0] m_axi_arlen;
  cchip_bitstream_fetch dut (
      .clk          (clk),
      .rst          (rst),
      .run          (run),
      .address      (address),
      .words        (words),
      .limit        (limit),
      .m_valid      (m_valid),
      .m_ready      (m_ready),
      .m_data       (m_data),
      .bus_error    (bus_error),
      .timeout      (timeout),
      .outstanding  (outstanding),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast)
  );

  wire memory_ok;
  cchip_axi_rules #(
      .ADDRESS_W(32),
      .DATA_W   (32),
      .READS    (2),
      .WRITES   (0),
      .BOUNDARY (64),
      .MEMORY   (0)
  ) rules (
      .clk          (clk),
      .rst          (rst),
      .memory_ok    (memory_ok),
      .m_axi_arvalid(m_axi_arvalid),
      .m_axi_arready(m_axi_arready),
      .m_axi_arid   (1'b0),
      .m_axi_araddr (m_axi_araddr),
      .m_axi_arlen  (m_axi_arlen),
      .m_axi_arsize (3'b010),
      .m_axi_arburst(2'b01),
      .m_axi_arcache(4'd0),
      .m_axi_arprot (3'd0),
      .m_axi_rvalid (m_axi_rvalid),
      .m_axi_rready (m_axi_rready),
      .m_axi_rid    (1'b0),
      .m_axi_rdata  (m_axi_rdata),
      .m_axi_rresp  (m_axi_rresp),
      .m_axi_rlast  (m_axi_rlast)
  );

  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  reg run_q = 1'b0, run_q2 = 1'b0;
  reg asked_q = 1'b0, failed_q = 1'b0;
  reg [31:0] araddr_q;
  reg [7:0] arlen_q;
  reg [1:0] bursts_q = 2'd0;
  reg [2:0] idle_q = 3'd0;  // clocks without progress while a beat is owed
  reg [2:0] idle_q2 = 3'd0;
  reg [2:0] limit_q, limit_q2, limit_q3;
  reg timeout_q = 1'b0;
  // the limit was reached 2 clocks ago, by the one of a clock before
  wire reached = idle_q2 != 3'd0 && limit_q3 != 3'd0 && idle_q2 >= limit_q3;
  reg [6:0] asked_for_q = 7'd0;  // words asked for since run, less those that left the FIFO
  wire [6:0] asked_for = asked_for_q + (m_axi_arvalid & ~asked_q & run_q ? m_axi_arlen[6:0] + 7'd1 : 7'd0);
  wire taken = m_axi_arvalid & m_axi_arready;
  wire beat = m_axi_rvalid & m_axi_rready;
  wire ended = beat & m_axi_rlast & bursts_q != 2'd0;
  wire busy = m_axi_arvalid | bursts_q != 2'd0;

  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
    run_q <= run & ~rst;
    run_q2 <= run_q & ~rst;
    asked_q <= m_axi_arvalid & ~m_axi_arready & ~rst;
    failed_q <= (bus_error | timeout) & run & ~rst;
    araddr_q <= m_axi_araddr;
    arlen_q <= m_axi_arlen;
    bursts_q <= rst ? 2'd0 : bursts_q + {1'b0, taken} - {1'b0, ended};
    idle_q2 <= rst ? 3'd0 : idle_q;
    {limit_q3, limit_q2, limit_q} <= {limit_q2, limit_q, any_limit};
    timeout_q <= timeout & ~rst;
    asked_for_q <= rst | ~run_q ? 7'd0 : asked_for - {6'd0, m_valid & m_ready};
    idle_q <= rst | ~run | ~run_q | ~busy | taken | beat ? 3'd0 : idle_q == 3'd7 ? 3'd7 : idle_q + 3'd1;
  end

  always @(*) begin
    assume (started_q || rst);
    assume (!run || run_q || !outstanding);
    assume (address[1:0] == 2'b00);
    if (started_q && !rst_q) begin
      stable: assert (!asked_q || (m_axi_arvalid && m_axi_araddr == araddr_q && m_axi_arlen == arlen_q));
      within_64: assert (!m_axi_arvalid || {4'd0, m_axi_araddr[5:2]} + m_axi_arlen <= 8'd15);
      kind: assert (m_axi_araddr[1:0] == 2'b00 || !m_axi_arvalid);
      two: assert (bursts_q != 2'd3 && !(bursts_q == 2'd2 && m_axi_arvalid));
`ifdef ROOM
      room: assert (asked_for <= 7'd32);
`endif
      debt: assert (outstanding == busy);
      empty: assert (run_q || run_q2 || !m_valid);
      late: assert (!reached || bus_error || timeout || !run_q);
      early: assert (!timeout || timeout_q || reached);
      sticky: assert (!failed_q || bus_error || timeout || !run_q);
      awake: assert (m_axi_rready);
    end
  end
endmodule
`default_nettype wire
