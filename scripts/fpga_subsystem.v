// SPDX-License-Identifier: Apache-2.0
`include "cchip_defs.vh"
`default_nettype none
// fpga_subsystem: cchip_primtest_subsystem with the ports of a primitive test, so that it fits into fpga_harness. Its
// further inputs come from a shift register that s_pair_tag feeds, its further outputs are folded into idle; each port
// has a register of its own. For place and route alone.
module fpga_subsystem #(
    parameter integer COORD_W = 16,
    parameter integer SLOTS   = 1,
    // modules in the slots
    parameter integer RM_ID   = 3
) (
    input  wire                   clk,
    input  wire                   rst,
    input  wire                   s_pair_valid,
    output wire                   s_pair_ready,
    input  wire [           15:0] s_pair_tag,
    input  wire [            1:0] s_pair_mode,
    input  wire [4*3*COORD_W-1:0] s_pair_a,
    input  wire [4*3*COORD_W-1:0] s_pair_b,
    input  wire [            3:0] s_pair_err,
    output wire                   m_result_valid,
    input  wire                   m_result_ready,
    output wire [           15:0] m_result_tag,
    output wire                   m_result_hit,
    output wire                   m_result_grid,
    output wire                   m_result_definite,
    output wire [            8:0] m_result_axis,
    output wire [            5:0] m_result_beats,
    output wire [            7:0] rm_id,
    output reg                    idle
);

  // {cfg_error; memory: rlast, rresp, rdata, rvalid, arready; registers: rready, arprot, araddr, arvalid, bready, wstrb,
  // wdata, wvalid, awprot, awaddr, awvalid; kind}
  localparam integer IN_W = 111;
  localparam integer OUT_W = 107;

  reg  [ IN_W-1:0] shift, in;
  wire [OUT_W-1:0] out;
  reg  [OUT_W-1:0] out_q;
  reg  [     21:0] fold_q;
  reg  [      4:0] fold2_q;
  wire [    109:0] padded = {{110 - OUT_W{1'b0}}, out_q};
  integer i;

  always @(posedge clk) begin
    shift <= {shift[IN_W-2:0], ^s_pair_tag[1:0]};
    in <= shift ^ {shift[IN_W-2:0], shift[IN_W-1]};
    out_q <= out;
    for (i = 0; i < 22; i = i + 1) fold_q[i] <= ^padded[5*i+:5];
    for (i = 0; i < 5; i = i + 1) fold2_q[i] <= i < 4 ? ^fold_q[5*i+:5] : ^fold_q[21:20];
    idle <= ^fold2_q;
  end
  assign rm_id = 8'd0;

  (* keep_hierarchy *)
  cchip_primtest_subsystem #(
      .COORD_W    (COORD_W),
      .SLOTS      (SLOTS),
      .SLOT0_RM_ID(RM_ID),
      .SLOT1_RM_ID(RM_ID),
      .SLOT2_RM_ID(RM_ID),
      .SLOT3_RM_ID(RM_ID)
  ) u_subsystem (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (s_pair_valid),
      .s_pair_ready     (s_pair_ready),
      .s_pair_kind      (in[1:0]),
      .s_pair_tag       (s_pair_tag),
      .s_pair_mode      (s_pair_mode),
      .s_pair_a         (s_pair_a),
      .s_pair_b         (s_pair_b),
      .s_pair_err       (s_pair_err),
      .m_result_valid   (m_result_valid),
      .m_result_ready   (m_result_ready),
      .m_result_kind    (out[1:0]),
      .m_result_tag     (m_result_tag),
      .m_result_hit     (m_result_hit),
      .m_result_grid    (m_result_grid),
      .m_result_definite(m_result_definite),
      .m_result_axis    (m_result_axis),
      .m_result_beats   (m_result_beats),
      .s_axil_awvalid   (in[2]),
      .s_axil_awready   (out[2]),
      .s_axil_awaddr    (in[3+:12]),
      .s_axil_awprot    (in[15+:3]),
      .s_axil_wvalid    (in[18]),
      .s_axil_wready    (out[3]),
      .s_axil_wdata     (in[19+:32]),
      .s_axil_wstrb     (in[51+:4]),
      .s_axil_bvalid    (out[4]),
      .s_axil_bready    (in[55]),
      .s_axil_bresp     (out[6:5]),
      .s_axil_arvalid   (in[56]),
      .s_axil_arready   (out[7]),
      .s_axil_araddr    (in[57+:12]),
      .s_axil_arprot    (in[69+:3]),
      .s_axil_rvalid    (out[8]),
      .s_axil_rready    (in[72]),
      .s_axil_rdata     (out[9+:32]),
      .s_axil_rresp     (out[42:41]),
      .irq              (out[43]),
      .m_axi_arvalid    (out[44]),
      .m_axi_arready    (in[73]),
      .m_axi_araddr     (out[45+:32]),
      .m_axi_arlen      (out[77+:8]),
      .m_axi_arsize     (out[85+:3]),
      .m_axi_arburst    (out[89:88]),
      .m_axi_arcache    (out[90+:4]),
      .m_axi_arprot     (out[94+:3]),
      .m_axi_rvalid     (in[74]),
      .m_axi_rready     (out[97]),
      .m_axi_rdata      (in[75+:32]),
      .m_axi_rresp      (in[108:107]),
      .m_axi_rlast      (in[109]),
      .cfg_valid        (out[98]),
      .cfg_data         (out[99+:8]),
      .cfg_error        (in[110])
  );

endmodule
`default_nettype wire
