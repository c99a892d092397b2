// SPDX-License-Identifier: Apache-2.0
// Rules of AXI4 beside the masters of cchip_refit_axi, for simulators that know bind; the RTL does
// not. Verilator: verilator --assert ... -y sim/rtl_models sim/rtl_models/cchip_refit_axi_rules.sv
// verilator lint_off PINCONNECTEMPTY
bind cchip_refit_axi cchip_axi_rules #(
    .ADDRESS_W(64),
    .DATA_W   (DATA_W),
    .ID_W     (1),
    .READS    (1),
    .WRITES   (1),
    .BOUNDARY (DATA_W == 512 ? 128 : 64)  // a line; a boundary is above a beat
) u_axi_rules (
    .clk          (clk),
    .rst          (rst),
    .memory_ok    (),
    .m_axi_arvalid(m_axi_arvalid),
    .m_axi_arready(m_axi_arready),
    .m_axi_arid   (m_axi_arid),
    .m_axi_araddr (m_axi_araddr),
    .m_axi_arlen  (m_axi_arlen),
    .m_axi_arsize (m_axi_arsize),
    .m_axi_arburst(m_axi_arburst),
    .m_axi_arcache(m_axi_arcache),
    .m_axi_arprot (m_axi_arprot),
    .m_axi_rvalid (m_axi_rvalid),
    .m_axi_rready (m_axi_rready),
    .m_axi_rid    (m_axi_rid),
    .m_axi_rdata  (m_axi_rdata),
    .m_axi_rresp  (m_axi_rresp),
    .m_axi_rlast  (m_axi_rlast),
    .m_axi_awvalid(m_axi_awvalid),
    .m_axi_awready(m_axi_awready),
    .m_axi_awid   (m_axi_awid),
    .m_axi_awaddr (m_axi_awaddr),
    .m_axi_awlen  (m_axi_awlen),
    .m_axi_awsize (m_axi_awsize),
    .m_axi_awburst(m_axi_awburst),
    .m_axi_awcache(m_axi_awcache),
    .m_axi_awprot (m_axi_awprot),
    .m_axi_wvalid (m_axi_wvalid),
    .m_axi_wready (m_axi_wready),
    .m_axi_wdata  (m_axi_wdata),
    .m_axi_wstrb  (m_axi_wstrb),
    .m_axi_wlast  (m_axi_wlast),
    .m_axi_bvalid (m_axi_bvalid),
    .m_axi_bready (m_axi_bready),
    .m_axi_bid    (m_axi_bid),
    .m_axi_bresp  (m_axi_bresp)
);
// verilator lint_on PINCONNECTEMPTY
