// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Measures cchip_primtest_tri_tri. Run by scripts/datasheet.py --stream; prints lines "key value...":
//   clock N TEXT              a lone pair, counted from the clock of its s_pair handshake
//   latency                   lone pair: clocks from handshake of s_pair to handshake of m_result, m_result_ready = 1
//   illegal_latency           the same for a reserved mode
//   clocks_per_pair           min mean max distance of two results, pairs always offered, m_result_ready = 1
//   drain                     clocks from the handshake of the last of CONTEXTS pairs to idle = 1, m_result_ready = 1
//   drain_bound               CCHIP_DRAIN_BOUND
//   axis_registers            optional registers of cchip_sat_axis: operand product result
//   project_registers         the same of cchip_sat_project
module bench;
`include "cchip_defs.vh"
  parameter integer COORD_W = 16;
  parameter integer SUBSTAGES = 10;
  parameter integer CONTEXTS = 2 * SUBSTAGES + 14;
  parameter integer ABSOLUTE_PROJECTION = 0;
  parameter integer PAIRS = 300;

  reg clk, rst, pair_valid;
  reg [1:0] mode;
  reg [12*COORD_W-1:0] a, b;
  wire pair_ready, result_valid, idle;

  cchip_primtest_tri_tri #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .CONTEXTS           (CONTEXTS),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION)
  ) dut (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (pair_valid),
      .s_pair_ready     (pair_ready),
      .s_pair_tag       (16'd0),
      .s_pair_mode      (mode),
      .s_pair_a         (a),
      .s_pair_b         (b),
      .s_pair_err       (4'd0),
      .m_result_valid   (result_valid),
      .m_result_ready   (1'b1),
      .m_result_tag     (),
      .m_result_hit     (),
      .m_result_grid    (),
      .m_result_definite(),
      .m_result_axis    (),
      .m_result_beats   (),
      .rm_id            (),
      .idle             (idle)
  );

  integer clocks, accepted, last_accept, last_result, least, greatest, total, intervals, i, seed;
  reg show;

  // one clock; whatever is sampled is what the rising edge at its end sees
  task tick;
    begin
      for (i = 0; i < 12 * COORD_W; i = i + 1) begin
        a[i] = $random(seed);
        b[i] = $random(seed);
      end
      #1;
      if (show) watch;
      if (pair_valid && pair_ready) begin
        accepted = accepted + 1;
        last_accept = clocks;
      end
      if (result_valid) begin
        if (last_result >= 0) begin
          if (clocks - last_result < least) least = clocks - last_result;
          if (clocks - last_result > greatest) greatest = clocks - last_result;
          total = total + clocks - last_result;
          intervals = intervals + 1;
        end
        last_result = clocks;
      end
      clk = 1;
      #1 clk = 0;
      #1 clocks = clocks + 1;
    end
  endtask

  task event_line(input [60*8-1:0] text);
    $display("clock %0d %0s", clocks - (last_accept < 0 ? clocks : last_accept), text);
  endtask

  task watch;
    begin
      if (pair_valid && pair_ready) event_line("handshake of `s_pair`");
      if (dut.load_valid_q) event_line("`load_*_q`: the input register; its context is chosen");
      if (dut.u_controller.start_valid) event_line("`start_*`: pair at the head of the start FIFO");
      if (dut.beat_valid && dut.beat_code == 9'b001_000_000) event_line("`beat_*_q`: first beat, reads the operands");
      if (dut.beat_valid && dut.beat_code == 9'b011_010_010) event_line("`beat_*_q`: last beat");
      if (dut.fetch_valid_q && dut.fetch_code_q == 9'b001_000_000) event_line("`fetch_*_q`: first beat enters `cchip_sat_pipeline`");
      if (dut.fetch_valid_q && dut.fetch_code_q == 9'b011_010_010) event_line("`fetch_*_q`: last beat enters");
      if (dut.verdict_valid && dut.verdict_code == 9'b001_000_000) event_line("`verdict_*`: first verdict");
      if (dut.verdict_valid && dut.verdict_code == 9'b011_010_010) event_line("`verdict_*`: last verdict; the context is free");
      if (dut.outcome_valid) event_line("`outcome`: result leaves the controller");
      if (dut.queue_valid) event_line("`queue`: result at the head of the result FIFO");
      if (result_valid) event_line("handshake of `m_result`");
    end
  endtask

  task reset;
    begin
      rst = 1;
      pair_valid = 0;
      show = 0;
      clocks = 0;
      repeat (3) tick;
      rst = 0;
      tick;
      accepted = 0;
      last_accept = -1;
      last_result = -1;
      least = 1000000;
      greatest = 0;
      total = 0;
      intervals = 0;
    end
  endtask

  // a pair into the empty module, until it is idle again
  task lone_pair(input [1:0] its_mode);
    begin
      mode = its_mode;
      pair_valid = 1;
      while (accepted == 0) tick;
      pair_valid = 0;
      while (!idle) tick;
    end
  endtask

  initial begin
    clk = 0;
    seed = 1;
    reset;
    show = 1;
    lone_pair(`CCHIP_MODE_EXHAUSTIVE);
    $display("latency %0d", last_result - last_accept);
    reset;
    lone_pair(2'd3);
    $display("illegal_latency %0d", last_result - last_accept);
    reset;
    mode = `CCHIP_MODE_EXHAUSTIVE;
    pair_valid = 1;
    while (intervals < PAIRS) tick;
    $display("clocks_per_pair %0d %.2f %0d", least, total * 1.0 / intervals, greatest);
    reset;
    pair_valid = 1;
    while (accepted < CONTEXTS) tick;
    pair_valid = 0;
    while (!idle) tick;
    $display("drain %0d", clocks - last_accept);
    $display("drain_bound %0d", `CCHIP_DRAIN_BOUND(SUBSTAGES, CONTEXTS));
    $display("axis_registers %0d %0d %0d", dut.u_pipeline.u_axis.OPERAND_REGS, dut.u_pipeline.u_axis.PRODUCT_REGS,
             dut.u_pipeline.u_axis.u_cross.RESULT_REGS);
    $display("project_registers %0d %0d %0d", dut.u_pipeline.u_project.OPERAND_REGS,
             dut.u_pipeline.u_project.PRODUCT_REGS, dut.u_pipeline.u_project.RESULT_REGS);
    $finish;
  end
endmodule
`default_nettype wire
