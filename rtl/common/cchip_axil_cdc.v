// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_axil_cdc: registers on AXI4-Lite and their interrupt on another clock than the host's bus,
// of any ratio and phase: one cchip_async_fifo for each channel, cchip_level_crossing for the
// interrupt.
//   latency      a write or read: that of the registers and two ways through cchip_async_fifo
//   throughput   DEPTH + 1 accesses in flight on each channel
//   order        within a channel, kept; between writes and reads none, as in AXI4-Lite: await the
//                response of a write before a read that depends on it
//   interrupt    a phase of 0 of m_irq, be it one clock, is a phase of 0 of s_irq. s_irq may still
//                be 1 for some clocks after the response of the write that cleared its cause
//   reset        either side for one clock or more, alone or with the other, see cchip_async_fifo:
//                accesses inside are lost and get no response, so reset both sides unless none is
//                in flight
module cchip_axil_cdc #(
    parameter integer ADDRESS_W = 12,  // width of an address (bit); legal: >= 1
    parameter integer DEPTH = 4,       // beats of a channel; legal: 4, 8, 16 ... 4096
    parameter integer STAGES = 2       // flip-flops of each synchroniser; legal: 2..4
) (
    // ---- from the host, on s_clk
    input  wire                 s_clk,           // clock of the host's bus, rising edge
    input  wire                 s_rst,           // synchronous reset, active high
    input  wire                 s_axil_awvalid,  // write addresses: valid
    output wire                 s_axil_awready,  // taken
    input  wire [ADDRESS_W-1:0] s_axil_awaddr,   // address
    input  wire [          2:0] s_axil_awprot,   // protection
    input  wire                 s_axil_wvalid,   // write data: valid
    output wire                 s_axil_wready,   // taken
    input  wire [         31:0] s_axil_wdata,    // data
    input  wire [          3:0] s_axil_wstrb,    // bytes that are written
    output wire                 s_axil_bvalid,   // responses of writes: valid
    input  wire                 s_axil_bready,   // taken
    output wire [          1:0] s_axil_bresp,    // response
    input  wire                 s_axil_arvalid,  // read addresses: valid
    output wire                 s_axil_arready,  // taken
    input  wire [ADDRESS_W-1:0] s_axil_araddr,   // address
    input  wire [          2:0] s_axil_arprot,   // protection
    output wire                 s_axil_rvalid,   // read data: valid
    input  wire                 s_axil_rready,   // taken
    output wire [         31:0] s_axil_rdata,    // data
    output wire [          1:0] s_axil_rresp,    // response
    output wire                 s_irq,           // interrupt, on s_clk
    // ---- to the registers, on m_clk
    input  wire                 m_clk,           // clock of the registers, rising edge
    input  wire                 m_rst,           // synchronous reset, active high
    output wire                 m_axil_awvalid,  // write addresses: valid
    input  wire                 m_axil_awready,  // taken
    output wire [ADDRESS_W-1:0] m_axil_awaddr,   // address
    output wire [          2:0] m_axil_awprot,   // protection
    output wire                 m_axil_wvalid,   // write data: valid
    input  wire                 m_axil_wready,   // taken
    output wire [         31:0] m_axil_wdata,    // data
    output wire [          3:0] m_axil_wstrb,    // bytes that are written
    input  wire                 m_axil_bvalid,   // responses of writes: valid
    output wire                 m_axil_bready,   // taken
    input  wire [          1:0] m_axil_bresp,    // response
    output wire                 m_axil_arvalid,  // read addresses: valid
    input  wire                 m_axil_arready,  // taken
    output wire [ADDRESS_W-1:0] m_axil_araddr,   // address
    output wire [          2:0] m_axil_arprot,   // protection
    input  wire                 m_axil_rvalid,   // read data: valid
    output wire                 m_axil_rready,   // taken
    input  wire [         31:0] m_axil_rdata,    // data
    input  wire [          1:0] m_axil_rresp,    // response
    input  wire                 m_irq            // interrupt, on m_clk: a level
);

  cchip_async_fifo #(.WIDTH(ADDRESS_W + 3), .DEPTH(DEPTH), .STAGES(STAGES)) u_aw (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axil_awvalid),
      .s_ready(s_axil_awready),
      .s_data ({s_axil_awaddr, s_axil_awprot}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axil_awvalid),
      .m_ready(m_axil_awready),
      .m_data ({m_axil_awaddr, m_axil_awprot})
  );

  cchip_async_fifo #(.WIDTH(36), .DEPTH(DEPTH), .STAGES(STAGES)) u_w (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axil_wvalid),
      .s_ready(s_axil_wready),
      .s_data ({s_axil_wdata, s_axil_wstrb}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axil_wvalid),
      .m_ready(m_axil_wready),
      .m_data ({m_axil_wdata, m_axil_wstrb})
  );

  cchip_async_fifo #(.WIDTH(2), .DEPTH(DEPTH), .STAGES(STAGES)) u_b (
      .s_clk  (m_clk),
      .s_rst  (m_rst),
      .s_valid(m_axil_bvalid),
      .s_ready(m_axil_bready),
      .s_data (m_axil_bresp),
      .m_clk  (s_clk),
      .m_rst  (s_rst),
      .m_valid(s_axil_bvalid),
      .m_ready(s_axil_bready),
      .m_data (s_axil_bresp)
  );

  cchip_async_fifo #(.WIDTH(ADDRESS_W + 3), .DEPTH(DEPTH), .STAGES(STAGES)) u_ar (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_axil_arvalid),
      .s_ready(s_axil_arready),
      .s_data ({s_axil_araddr, s_axil_arprot}),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_axil_arvalid),
      .m_ready(m_axil_arready),
      .m_data ({m_axil_araddr, m_axil_arprot})
  );

  cchip_async_fifo #(.WIDTH(34), .DEPTH(DEPTH), .STAGES(STAGES)) u_r (
      .s_clk  (m_clk),
      .s_rst  (m_rst),
      .s_valid(m_axil_rvalid),
      .s_ready(m_axil_rready),
      .s_data ({m_axil_rdata, m_axil_rresp}),
      .m_clk  (s_clk),
      .m_rst  (s_rst),
      .m_valid(s_axil_rvalid),
      .m_ready(s_axil_rready),
      .m_data ({s_axil_rdata, s_axil_rresp})
  );

  cchip_level_crossing #(.STAGES(STAGES)) u_irq (
      .s_clk  (m_clk),
      .s_rst  (m_rst),
      .s_level(m_irq),
      .m_clk  (s_clk),
      .m_rst  (s_rst),
      .m_level(s_irq)
  );

endmodule
`default_nettype wire
