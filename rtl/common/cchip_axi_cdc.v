// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_axi_cdc: AXI4 from one clock to another, of any ratio and phase: one cchip_async_fifo for
// each channel. It has the signals that change with a beat of this project's masters. Size, burst,
// cache and prot are constants of these masters and go round the bridge; there is no lock, QoS,
// region or user.
//   latency      of a channel, one way: that of cchip_async_fifo; a read takes both ways
//   throughput   a beat per clock of the slower side on each channel, DEPTH >= 4 + 2 STAGES
//   capacity     DEPTH + 1 beats of each channel. It counts no transactions: the master bounds them
//   order        within a channel, kept. Between channels there is none, as in AXI4: a response
//                cannot overtake the beats that cause it, since these have passed before it is made
//   reset        either side for one clock or more, alone or with the other, see cchip_async_fifo:
//                what is inside is lost. The bridge does not end what memory or the master still
//                awaits, so reset both sides unless nothing is outstanding
module cchip_axi_cdc #(
    parameter integer ADDRESS_W = 64,   // width of an address (bit); legal: 12..64
    parameter integer DATA_W = 128,     // width of the data bus (bit); legal: 32, 64 ... 1024
    parameter integer ID_W = 6,         // width of the ID of reads (bit); legal: >= 1
    parameter integer WRITE_ID_W = 1,   // width of the ID of writes (bit); legal: >= 1
    parameter integer DEPTH = 16,       // beats of a channel; legal: 4, 8, 16 ... 4096
    parameter integer STAGES = 2        // flip-flops of each synchroniser; legal: 2..4
) (
    // ---- from the master, on s_clk
    input  wire                  s_clk,          // clock of the master, rising edge
    input  wire                  s_rst,          // synchronous reset, active high
    input  wire                  s_axi_arvalid,  // read addresses: valid
    output wire                  s_axi_arready,  // taken
    input  wire [      ID_W-1:0] s_axi_arid,     // ID
    input  wire [ ADDRESS_W-1:0] s_axi_araddr,   // address
    input  wire [           7:0] s_axi_arlen,    // beats - 1
    output wire                  s_axi_rvalid,   // read data: valid
    input  wire                  s_axi_rready,   // taken
    output wire [      ID_W-1:0] s_axi_rid,      // ID
    output wire [    DATA_W-1:0] s_axi_rdata,    // data
    output wire [           1:0] s_axi_rresp,    // response
    output wire                  s_axi_rlast,    // last beat of the burst
    input  wire                  s_axi_awvalid,  // write addresses: valid
    output wire                  s_axi_awready,  // taken
    input  wire [WRITE_ID_W-1:0] s_axi_awid,     // ID
    input  wire [ ADDRESS_W-1:0] s_axi_awaddr,   // address
    input  wire [           7:0] s_axi_awlen,    // beats - 1
    input  wire                  s_axi_wvalid,   // write data: valid
    output wire                  s_axi_wready,   // taken
    input  wire [    DATA_W-1:0] s_axi_wdata,    // data
    input  wire [  DATA_W/8-1:0] s_axi_wstrb,    // bytes that are written
    input  wire                  s_axi_wlast,    // last beat of the burst
    output wire                  s_axi_bvalid,   // responses of writes: valid
    input  wire                  s_axi_bready,   // taken
    output wire [WRITE_ID_W-1:0] s_axi_bid,      // ID
    output wire [           1:0] s_axi_bresp,    // response
    // ---- to memory, on m_clk
    input  wire                  m_clk,          // clock of memory, rising edge
    input  wire                  m_rst,          // synchronous reset, active high
    output wire                  m_axi_arvalid,  // read addresses: valid
    input  wire                  m_axi_arready,  // taken
    output wire [      ID_W-1:0] m_axi_arid,     // ID
    output wire [ ADDRESS_W-1:0] m_axi_araddr,   // address
    output wire [           7:0] m_axi_arlen,    // beats - 1
    input  wire                  m_axi_rvalid,   // read data: valid
    output wire                  m_axi_rready,   // taken
    input  wire [      ID_W-1:0] m_axi_rid,      // ID
    input  wire [    DATA_W-1:0] m_axi_rdata,    // data
    input  wire [           1:0] m_axi_rresp,    // response
    input  wire                  m_axi_rlast,    // last beat of the burst
    output wire                  m_axi_awvalid,  // write addresses: valid
    input  wire                  m_axi_awready,  // taken
    output wire [WRITE_ID_W-1:0] m_axi_awid,     // ID
    output wire [ ADDRESS_W-1:0] m_axi_awaddr,   // address
    output wire [           7:0] m_axi_awlen,    // beats - 1
    output wire                  m_axi_wvalid,   // write data: valid
    input  wire                  m_axi_wready,   // taken
    output wire [    DATA_W-1:0] m_axi_wdata,    // data
    output wire [  DATA_W/8-1:0] m_axi_wstrb,    // bytes that are written
    output wire                  m_axi_wlast,    // last beat of the burst
    input  wire                  m_axi_bvalid,   // responses of writes: valid
    output wire                  m_axi_bready,   // taken
    input  wire [WRITE_ID_W-1:0] m_axi_bid,      // ID
    input  wire [           1:0] m_axi_bresp     // response
);

  cchip_async_fifo #(.WIDTH(ID_W + ADDRESS_W + 8), .DEPTH(DEPTH), .STAGES(STAGES)) u_ar (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axi_arvalid),
      .s_ready(s_axi_arready),
      .s_data ({s_axi_arid, s_axi_araddr, s_axi_arlen}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axi_arvalid),
      .m_ready(m_axi_arready),
      .m_data ({m_axi_arid, m_axi_araddr, m_axi_arlen})
  );

  cchip_async_fifo #(.WIDTH(ID_W + DATA_W + 3), .DEPTH(DEPTH), .STAGES(STAGES)) u_r (
      .s_clk  (m_clk),
      .s_rst  (m_rst),
      .s_valid(m_axi_rvalid),
      .s_ready(m_axi_rready),
      .s_data ({m_axi_rid, m_axi_rdata, m_axi_rresp, m_axi_rlast}),
      .m_clk  (s_clk),
      .m_rst  (s_rst),
      .m_valid(s_axi_rvalid),
      .m_ready(s_axi_rready),
      .m_data ({s_axi_rid, s_axi_rdata, s_axi_rresp, s_axi_rlast})
  );

  cchip_async_fifo #(.WIDTH(WRITE_ID_W + ADDRESS_W + 8), .DEPTH(DEPTH), .STAGES(STAGES)) u_aw (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axi_awvalid),
      .s_ready(s_axi_awready),
      .s_data ({s_axi_awid, s_axi_awaddr, s_axi_awlen}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axi_awvalid),
      .m_ready(m_axi_awready),
      .m_data ({m_axi_awid, m_axi_awaddr, m_axi_awlen})
  );

  cchip_async_fifo #(.WIDTH(DATA_W + DATA_W/8 + 1), .DEPTH(DEPTH), .STAGES(STAGES)) u_w (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axi_wvalid),
      .s_ready(s_axi_wready),
      .s_data ({s_axi_wdata, s_axi_wstrb, s_axi_wlast}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axi_wvalid),
      .m_ready(m_axi_wready),
      .m_data ({m_axi_wdata, m_axi_wstrb, m_axi_wlast})
  );

  cchip_async_fifo #(.WIDTH(WRITE_ID_W + 2), .DEPTH(DEPTH), .STAGES(STAGES)) u_b (
      .s_clk  (m_clk),
      .s_rst  (m_rst),
      .s_valid(m_axi_bvalid),
      .s_ready(m_axi_bready),
      .s_data ({m_axi_bid, m_axi_bresp}),
      .m_clk  (s_clk),
      .m_rst  (s_rst),
      .m_valid(s_axi_bvalid),
      .m_ready(s_axi_bready),
      .m_data ({s_axi_bid, s_axi_bresp})
  );

endmodule
`default_nettype wire
