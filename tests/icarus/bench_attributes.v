// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// What every address of the tops says, by their parameters: size, burst, cache, prot.
module bench_attributes;
  wire [11:0] ar, aw, refit_ar, refit_aw, cfg, subsystem, plain_ar, plain_aw;
  cchip_chip_cdc #(.DATA_W(256), .AXI_ARCACHE(15), .AXI_AWCACHE(11), .AXI_PROT(2)) chip (
      .m_axi_arsize     (ar[11:9]),
      .m_axi_arburst    (ar[8:7]),
      .m_axi_arcache    (ar[6:3]),
      .m_axi_arprot     (ar[2:0]),
      .m_axi_awsize     (aw[11:9]),
      .m_axi_awburst    (aw[8:7]),
      .m_axi_awcache    (aw[6:3]),
      .m_axi_awprot     (aw[2:0]),
      .m_axi_cfg_arsize (cfg[11:9]),
      .m_axi_cfg_arburst(cfg[8:7]),
      .m_axi_cfg_arcache(cfg[6:3]),
      .m_axi_cfg_arprot (cfg[2:0])
  );
  cchip_refit_axi #(.DATA_W(64), .AXI_ARCACHE(7), .AXI_AWCACHE(14), .AXI_PROT(5)) refit (
      .m_axi_arsize (refit_ar[11:9]),
      .m_axi_arburst(refit_ar[8:7]),
      .m_axi_arcache(refit_ar[6:3]),
      .m_axi_arprot (refit_ar[2:0]),
      .m_axi_awsize (refit_aw[11:9]),
      .m_axi_awburst(refit_aw[8:7]),
      .m_axi_awcache(refit_aw[6:3]),
      .m_axi_awprot (refit_aw[2:0])
  );
  cchip_refit_axi plain (
      .m_axi_arsize (plain_ar[11:9]),
      .m_axi_arburst(plain_ar[8:7]),
      .m_axi_arcache(plain_ar[6:3]),
      .m_axi_arprot (plain_ar[2:0]),
      .m_axi_awsize (plain_aw[11:9]),
      .m_axi_awburst(plain_aw[8:7]),
      .m_axi_awcache(plain_aw[6:3]),
      .m_axi_awprot (plain_aw[2:0])
  );
  cchip_primtest_subsystem #(.AXI_ARCACHE(15), .AXI_PROT(2)) tests (
      .m_axi_arsize (subsystem[11:9]),
      .m_axi_arburst(subsystem[8:7]),
      .m_axi_arcache(subsystem[6:3]),
      .m_axi_arprot (subsystem[2:0])
  );

  integer wrong = 0;
  task check(input [11:0] is, input [11:0] expected);
    if (is !== expected) begin
      wrong = wrong + 1;
      $display("%b, not %b", is, expected);
    end
  endtask

  initial begin
    #1;
    check(ar, {3'd5, 2'd1, 4'd15, 3'd2});
    check(aw, {3'd5, 2'd1, 4'd11, 3'd2});
    check(cfg, {3'd2, 2'd1, 4'd15, 3'd2});
    check(refit_ar, {3'd3, 2'd1, 4'd7, 3'd5});
    check(refit_aw, {3'd3, 2'd1, 4'd14, 3'd5});
    check(plain_ar, {3'd4, 2'd1, 4'd3, 3'd0});
    check(plain_aw, {3'd4, 2'd1, 4'd2, 3'd0});
    check(subsystem, {3'd2, 2'd1, 4'd15, 3'd2});
    $display("%0s wrong=%0d", wrong == 0 ? "PASS" : "FAIL", wrong);
    $finish;
  end
endmodule
`default_nettype wire
