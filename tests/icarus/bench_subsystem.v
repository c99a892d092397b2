// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_subsystem: cchip_primtest_subsystem with the ports of a primitive test, for bench_primtest: pairs of kind 1 to the
// module that slot 0 holds at power-up. Registers, memory and configuration port are not used. Verilog-2005, no package.
module bench_subsystem (
    input  wire         clk,
    input  wire         rst,
    input  wire         s_pair_valid,
    output wire         s_pair_ready,
    input  wire [ 15:0] s_pair_tag,
    input  wire [  1:0] s_pair_mode,
    input  wire [191:0] s_pair_a,
    input  wire [191:0] s_pair_b,
    input  wire [  3:0] s_pair_err,
    output wire         m_result_valid,
    input  wire         m_result_ready,
    output wire [ 15:0] m_result_tag,
    output wire         m_result_hit,
    output wire         m_result_grid,
    output wire         m_result_definite,
    output wire [  8:0] m_result_axis,
    output wire [  5:0] m_result_beats,
    output wire [  7:0] rm_id,
    output wire         idle
);

  wire [2:0] kind;
  assign rm_id = {5'd0, m_result_valid ? kind : 3'd1};

  // pairs between their two handshakes
  reg [15:0] pairs_q;
  wire accept = s_pair_valid & s_pair_ready;
  wire answer = m_result_valid & m_result_ready;
  assign idle = pairs_q == 16'd0;
  always @(posedge clk)
    if (rst) pairs_q <= 16'd0;
    else if (accept != answer) pairs_q <= accept ? pairs_q + 16'd1 : pairs_q - 16'd1;

  cchip_primtest_subsystem #(
      .SLOTS(1)
  ) dut (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (s_pair_valid),
      .s_pair_ready     (s_pair_ready),
      .s_pair_kind      (3'd1),
      .s_pair_tag       (s_pair_tag),
      .s_pair_mode      (s_pair_mode),
      .s_pair_a         (s_pair_a),
      .s_pair_b         (s_pair_b),
      .s_pair_err       (s_pair_err),
      .m_result_valid   (m_result_valid),
      .m_result_ready   (m_result_ready),
      .m_result_kind    (kind),
      .m_result_tag     (m_result_tag),
      .m_result_hit     (m_result_hit),
      .m_result_grid    (m_result_grid),
      .m_result_definite(m_result_definite),
      .m_result_axis    (m_result_axis),
      .m_result_beats   (m_result_beats),
      .s_axil_awvalid   (1'b0),
      .s_axil_awready   (),
      .s_axil_awaddr    (12'd0),
      .s_axil_awprot    (3'd0),
      .s_axil_wvalid    (1'b0),
      .s_axil_wready    (),
      .s_axil_wdata     (32'd0),
      .s_axil_wstrb     (4'd0),
      .s_axil_bvalid    (),
      .s_axil_bready    (1'b1),
      .s_axil_bresp     (),
      .s_axil_arvalid   (1'b0),
      .s_axil_arready   (),
      .s_axil_araddr    (12'd0),
      .s_axil_arprot    (3'd0),
      .s_axil_rvalid    (),
      .s_axil_rready    (1'b1),
      .s_axil_rdata     (),
      .s_axil_rresp     (),
      .irq              (),
      .m_axi_arvalid    (),
      .m_axi_arready    (1'b0),
      .m_axi_araddr     (),
      .m_axi_arlen      (),
      .m_axi_arsize     (),
      .m_axi_arburst    (),
      .m_axi_arcache    (),
      .m_axi_arprot     (),
      .m_axi_rvalid     (1'b0),
      .m_axi_rready     (),
      .m_axi_rdata      (32'd0),
      .m_axi_rresp      (2'd0),
      .m_axi_rlast      (1'b0),
      .cfg_valid        (),
      .cfg_data         (),
      .cfg_error        (1'b0)
  );

endmodule
`default_nettype wire
