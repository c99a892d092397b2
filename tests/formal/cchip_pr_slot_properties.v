// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_pr_slot around a region that does whatever it likes (cchip_pr_slot_region.v):
//   outstanding is pairs accepted less results given since reset, coupling or decoupling; nothing decouples without the
//   difference being in lost as decoupled rises: a pair is answered or reported
//   quiet = 1 only with stop in force, no pair inside and none accepted
//   while decoupled the static side is constant
//   the region's reset: after rst, hold_reset and for ROC_CYCLES clocks from roc_start or rst on, and never otherwise;
//   roc_busy is 1 until the last clock of that reset
// Assumed: the region gives no more results than it was given pairs (a garbage region can; the count then stays at 0).
module cchip_pr_slot_properties #(
    parameter integer ROC_CYCLES = 2
) (
    input wire clk,
    input wire rst,
    input wire stop,
    input wire decouple,
    input wire hold_reset,
    input wire roc_start,
    input wire s_pair_valid,
    input wire m_result_ready
);
  wire quiet, decoupled, roc_busy, s_pair_ready, m_result_valid, idle;
  wire [15:0] outstanding, lost;
  wire [`CCHIP_RESULT_W-1:0] m_result_data;
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
      .stop          (stop),
      .quiet         (quiet),
      .outstanding   (outstanding),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .lost          (lost),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .cfg_valid     (1'b0),
      .cfg_data      (8'd0),
      .s_pair_valid  (s_pair_valid),
      .s_pair_ready  (s_pair_ready),
      .s_pair_data   ({`CCHIP_REQUEST_W(4) {1'b0}}),
      .m_result_valid(m_result_valid),
      .m_result_ready(m_result_ready),
      .m_result_data (m_result_data),
      .rm_id         (rm_id),
      .idle          (idle)
  );

  reg started_q = 1'b0;
  reg since_known_q = 1'b0;
  reg decouple_q, stop_q, region_rst_q, region_rst_q2;
  reg [15:0] inside_q, lost_q;
  reg [7:0] since_q;  // clocks since roc_start or rst
  wire accept = s_pair_valid & s_pair_ready;
  wire answer = m_result_valid & m_result_ready;
  wire [15:0] inside = inside_q + {15'd0, accept} - {15'd0, answer};
  always @(posedge clk) begin
    started_q     <= 1'b1;
    decouple_q    <= decouple;
    stop_q        <= stop;
    inside_q      <= rst | decouple ? 16'd0 : inside;
    if (rst) lost_q <= 16'd0;
    else if (decouple & ~decouple_q) lost_q <= inside;
    since_q       <= rst | roc_start ? 8'd0 : since_q == 8'd255 ? since_q : since_q + 8'd1;
    region_rst_q  <= rst | hold_reset | (since_q < ROC_CYCLES);  // what the region's reset has to be
    region_rst_q2 <= region_rst_q;
    since_known_q <= started_q;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    assume (!started_q || !answer || inside_q != 16'd0);
    assume (inside_q < 16'd1000);
    if (started_q) begin
      count: assert (outstanding == inside_q);
      reported: assert (lost == lost_q);
      quiet_is_quiet: assert (!quiet || (inside_q == 16'd0 && !accept));
      follows: assert (decoupled == decouple_q);
      if (decoupled) begin
        constant_streams: assert (!s_pair_ready && !m_result_valid);
        constant_fields: assert (m_result_data == {`CCHIP_RESULT_W{1'b0}});
        constant_others: assert (rm_id == 8'd0 && idle);
      end
      stopped: assert (!stop_q || !s_pair_ready);
    end
    if (since_known_q) begin
      region_reset: assert (region_rm_id[7] == region_rst_q2);
      busy: assert (roc_busy == (since_q <= ROC_CYCLES));
    end
  end
  always @(posedge clk) begin
    drained: cover (started_q && quiet && stop_q && lost == 16'd0);
    some_lost: cover (started_q && decoupled && lost == 16'd3);
  end
endmodule
`default_nettype wire
