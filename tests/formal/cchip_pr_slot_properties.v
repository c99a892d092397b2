// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_pr_slot around a region of any behaviour (cchip_pr_slot_region.v):
//   while decoupled the static side is constant, and decoupled follows decouple one clock later
//   the region's reset: after rst, hold_reset and for ROC_CYCLES clocks from roc_start or rst on, and never otherwise;
//   roc_busy is 1 until the last clock of that reset
module cchip_pr_slot_properties #(
    parameter integer ROC_CYCLES = 2
) (
    input wire clk,
    input wire rst,
    input wire decouple,
    input wire hold_reset,
    input wire roc_start,
    input wire s_vertex_valid
);
  wire decoupled, roc_busy, m_result_valid, idle;
  wire [`CCHIP_SLOT_RESULT_W-1:0] m_result_data;
  wire [7:0] region_rm_id, rm_id;
  cchip_pr_slot #(
      .COORD_W   (4),
      .SUBSTAGES (5),
      .CONTEXTS  (1),
      .ROC_CYCLES(ROC_CYCLES),
      .SIMULATION(0)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .cfg_valid     (1'b0),
      .cfg_data      (8'd0),
      .s_vertex_valid(s_vertex_valid),
      .s_vertex_data ({`CCHIP_VERTEX_W(4) {1'b1}}),
      .m_result_valid(m_result_valid),
      .m_result_data (m_result_data),
      .rm_id         (rm_id),
      .idle          (idle)
  );

  reg started_q = 1'b0;
  reg since_known_q = 1'b0;
  reg decouple_q, region_rst_q, region_rst_q2;
  reg [7:0] since_q;  // clocks since roc_start or rst
  always @(posedge clk) begin
    started_q     <= 1'b1;
    decouple_q    <= decouple;
    since_q       <= rst | roc_start ? 8'd0 : since_q == 8'd255 ? since_q : since_q + 8'd1;
    region_rst_q  <= rst | hold_reset | (since_q < ROC_CYCLES);  // what the region's reset has to be
    region_rst_q2 <= region_rst_q;
    since_known_q <= started_q;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      follows: assert (decoupled == decouple_q);
      if (decoupled) begin
        constant_result: assert (!m_result_valid && m_result_data == {`CCHIP_SLOT_RESULT_W{1'b0}});
        constant_others: assert (rm_id == 8'd0 && idle);
      end
    end
    if (since_known_q) begin
      region_reset: assert (region_rm_id[7] == region_rst_q2);
      busy: assert (roc_busy == (since_q <= ROC_CYCLES));
    end
  end
  always @(posedge clk) begin
    cut_off: cover (started_q && decoupled && !roc_busy);
    result: cover (started_q && m_result_valid && !decoupled);
  end
endmodule
`default_nettype wire
