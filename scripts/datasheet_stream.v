// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Measures cchip_primtest in one shape. Run by scripts/datasheet.py --stream; prints lines "key value...":
//   clock N TEXT              a lone EXHAUSTIVE pair, counted from the clock of its s_pair handshake
//   pair NAME MODE VALUES     the same pair again and again (random: another one each time); VALUES: beats of
//                             one pair; lone pair: clocks from handshake of s_pair to handshake of m_result
//                             with m_result_ready = 1; min mean max distance of two results, pairs always
//                             offered; clocks with a beat per 100 clocks with a pair that waits for one; clocks
//                             from the handshake of the last of CONTEXTS pairs to idle = 1
//   drain_bound               CCHIP_DRAIN_BOUND
//   axis_registers            optional registers of cchip_sat_axis: operand product result
//   project_registers         the same of cchip_sat_project
module bench;
`include "cchip_defs.vh"
  parameter integer COORD_W = 16;
  parameter integer SUBSTAGES = 10;
  parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES);
  parameter integer ABSOLUTE_PROJECTION = 0;
  parameter integer WARPED_EXACT = 1;
  parameter integer VERTS_A = 3;
  parameter integer VERTS_B = 3;
  // results measured, after twice CONTEXTS results that are not; pairs of equal length end in groups of CONTEXTS
  parameter integer PAIRS = CONTEXTS * (1 + 100 / CONTEXTS);
  // 1: random pairs only, 2: random pairs in mode EXHAUSTIVE only; both without the drain, which is then 0. Random pairs in
  // mode EXHAUSTIVE have equal beats, so fewer of them are measured: whole rounds of CONTEXTS, 40 results or more
  parameter integer BRIEF = 0;
  // 1: only the latency of a lone pair of each kind is measured, without random pairs; what else a line tells is 0
  parameter integer LONE = 0;

  localparam [3*COORD_W-1:0] ORIGIN = 0;

  reg clk, rst, pair_valid, random_pairs;
  reg [1:0] mode;
  reg [12*COORD_W-1:0] a, b;
  wire [`CCHIP_RESULT_W-1:0] result;
  wire [`CCHIP_BEATS_W-1:0] beats = result[`CCHIP_RESULT_BEATS];
  wire pair_ready, result_valid, idle;

  cchip_primtest #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .CONTEXTS           (CONTEXTS),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .WARPED_EXACT       (WARPED_EXACT),
      .VERTS_A            (VERTS_A),
      .VERTS_B            (VERTS_B)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .s_pair_valid  (pair_valid),
      .s_pair_ready  (pair_ready),
      .s_pair_data   (`CCHIP_REQUEST_OF(16'd0, a, b, 4'd0, mode)),
      .m_result_valid(result_valid),
      .m_result_ready(1'b1),
      .m_result_data (result),
      .rm_id         (),
      .idle          (idle)
  );

  integer clocks, accepted, last_accept, last_result, least, greatest, total, intervals, i, seed, latency;
  integer busy, waiting, least_beats, greatest_beats;
  reg show;

  function [3*COORD_W-1:0] point(input integer x, input integer y, input integer z);
    point = {z[COORD_W-1:0], y[COORD_W-1:0], x[COORD_W-1:0]};
  endfunction

  // random coordinates; quads repeat vertex 2, so they are planar
  task random_pair;
    begin
      for (i = 0; i < 12 * COORD_W; i = i + 1) begin
        a[i] = $random(seed);
        b[i] = $random(seed);
      end
      a[9*COORD_W+:3*COORD_W] = a[6*COORD_W+:3*COORD_W];
      b[9*COORD_W+:3*COORD_W] = b[6*COORD_W+:3*COORD_W];
    end
  endtask

  // one clock; a sample is what the rising edge at its end sees
  task tick;
    begin
      if (random_pairs) random_pair;
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
        if (beats < least_beats) least_beats = beats;
        if (beats > greatest_beats) greatest_beats = beats;
      end
      if (dut.u_controller.beat_valid_q) busy = busy + 1;
      if (dut.u_controller.pair_waits) waiting = waiting + 1;
      clk = 1;
      #1 clk = 0;
      #1 clocks = clocks + 1;
    end
  endtask

  task event_line(input [100*8-1:0] text);
    $display("clock %0d %0s", clocks - (last_accept < 0 ? clocks : last_accept), text);
  endtask

  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;
  localparam [8:0] FIRST = {`CCHIP_AXIS_NORMAL_A, 6'd0};
  localparam [8:0] LAST = {`CCHIP_AXIS_CROSS, LAST_K[2:0], LAST_L[2:0]};

  task watch;
    begin
      if (pair_valid && pair_ready) event_line("handshake of `s_pair`");
      if (dut.u_controller.load_valid_q) event_line("`load_*_q`: the input register; its context is chosen");
      if (dut.u_controller.start_valid) event_line("`start_*`: pair at the head of the start FIFO");
      if (dut.beat_valid && dut.beat_code == FIRST) event_line("`beat_q`: first beat, enters `cchip_sat_pipeline`");
      if (dut.beat_valid && dut.beat_code == LAST) event_line("`beat_q`: last beat enters");
      if (dut.verdict_valid && dut.verdict_user[11:3] == FIRST) event_line("`verdict_*`: first verdict");
      if (dut.verdict_valid && dut.verdict_user[11:3] == LAST) event_line("`verdict_*`: last verdict");
      if (dut.outcome_valid) event_line("`outcome`: result leaves the controller, then its context is free");
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
      clear;
    end
  endtask

  task clear;
    begin
      last_result = -1;
      least = 1000000;
      greatest = 0;
      total = 0;
      intervals = 0;
      busy = 0;
      waiting = 0;
      least_beats = 1000;
      greatest_beats = 0;
    end
  endtask

  // a pair into the empty module, until it is idle again
  task lone_pair;
    begin
      pair_valid = 1;
      while (accepted == 0) tick;
      pair_valid = 0;
      while (!idle) tick;
      latency = last_result - last_accept;
    end
  endtask

  task known_pairs;
    begin
      // A in the plane z = 0, a triangle or a square
      a = {point(-4, 4, 0), point(VERTS_A == 4 ? 4 : 0, 4, 0), point(4, -4, 0), point(-4, -4, 0)};
      b = {point(-2, 0, 3), point(VERTS_B == 4 ? 6 : 2, 0, 3), point(6, 0, -3), point(-2, 0, -3)};
      both_modes("crossing_hit");
      b = {point(-4, 4, 3), point(VERTS_B == 4 ? 4 : 0, 4, 3), point(4, -4, 3), point(-4, -4, 3)};
      both_modes("parallel_apart");
      b = {point(-4, 4, 0), point(VERTS_B == 4 ? 4 : 0, 4, 0), point(4, -4, 0), point(-4, -4, 0)};
      both_modes("coplanar_hit");
      b = {4{ORIGIN}};
      both_modes("degenerate_hit");
      if (VERTS_B == 4) begin
        b = {point(-4, 4, 2), point(4, 4, -2), point(4, -4, 2), point(-4, -4, -2)};
        both_modes(VERTS_A == 4 ? "planar_warped_hit" : "triangle_warped_hit");
        a = b;
        if (VERTS_A == 4) both_modes("warped_warped_hit");
      end
    end
  endtask

  // everything about one kind of pair in one mode
  task measure(input [30*8-1:0] name, input [1:0] its_mode);
    begin
      mode = its_mode;
      reset;
      lone_pair;
      $write("pair %0s %0s", name, mode == `CCHIP_MODE_EXHAUSTIVE ? "EXHAUSTIVE" : mode == `CCHIP_MODE_DIRECTED ? "DIRECTED" : "reserved");
      if (LONE) $display(" 0 %0d 0 0 0 0 0", latency);
      else steady_state;
    end
  endtask

  // pairs always offered, then the drain
  task steady_state;
    begin
      reset;
      pair_valid = 1;
      while (intervals < (BRIEF != 0 ? CONTEXTS : 2 * CONTEXTS)) tick;
      clear;
      while (intervals < (BRIEF != 0 && mode == `CCHIP_MODE_EXHAUSTIVE ? CONTEXTS * (1 + 40 / CONTEXTS) : PAIRS)) tick;
      if (least_beats == greatest_beats) $write(" %0d", least_beats);
      else $write(" %0d..%0d", least_beats, greatest_beats);
      $write(" %0d %0d %.2f %0d", latency, least, total * 1.0 / intervals, greatest);
      $write(" %.1f", 100.0 * busy / waiting);
      if (BRIEF != 0) $display(" 0");
      else begin
        reset;
        pair_valid = 1;
        while (accepted < CONTEXTS) tick;
        pair_valid = 0;
        while (!idle) tick;
        $display(" %0d", clocks - last_accept);
      end
    end
  endtask

  task both_modes(input [30*8-1:0] name);
    begin
      measure(name, `CCHIP_MODE_EXHAUSTIVE);
      if (BRIEF < 2) measure(name, `CCHIP_MODE_DIRECTED);
    end
  endtask

  initial begin
    clk = 0;
    seed = 1;
    random_pairs = 1;
    mode = `CCHIP_MODE_EXHAUSTIVE;
    reset;
    show = 1;
    lone_pair;
    if (!LONE) both_modes("random_planar");
    if (BRIEF == 0) measure("any", 2'd3);
    random_pairs = 0;
    if (!BRIEF) known_pairs;
    $display("drain_bound %0d", `CCHIP_DRAIN_BOUND(SUBSTAGES, CONTEXTS));
    $display("axis_registers %0d %0d %0d", dut.u_pipeline.u_axis.OPERAND_REGS, dut.u_pipeline.u_axis.PRODUCT_REGS,
             dut.u_pipeline.u_axis.u_cross.RESULT_REGS);
    $display("project_registers %0d %0d %0d", dut.u_pipeline.u_project.OPERAND_REGS,
             dut.u_pipeline.u_project.PRODUCT_REGS, dut.u_pipeline.u_project.RESULT_REGS);
    $finish;
  end
endmodule
`default_nettype wire
