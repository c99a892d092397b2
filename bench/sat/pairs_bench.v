// SPDX-License-Identifier: Apache-2.0
`default_nettype none
`timescale 1ns / 1ns
`include "cchip_defs.vh"
// pairs_bench: sends triangle pairs to a core as fast as it takes them, takes every answer at once.
//   +pairs=FILE     a pair a line: B, A (144 bits each: vertex 2 first, z highest), error; in hex
//   +answers=FILE   written: "TAG HIT DEFINITE" a line, as answers come; TAG counts pairs from 0
// SAT_CORE names the core, a module with the ports of a primitive test. The last line is
// `pairs=N clocks=N lone=N`: clocks from the first pair to the last answer, and the latency of the
// first pair, which is alone.
`ifndef SAT_CORE
`define SAT_CORE plain_sat
`endif
module pairs_bench;
  localparam integer W = 16;
  localparam integer T_W = 9 * W;
  localparam integer LIMIT = 1 << 22;  // clocks without an answer
  reg clk = 1'b0;
  reg rst = 1'b1;
  reg valid = 1'b0;
  reg [T_W-1:0] a, b;
  reg [3:0] err;
  reg [31:0] sent = 0;
  reg [31:0] got = 0;
  reg [31:0] clocks = 0;
  reg [31:0] lone = 0;
  reg [31:0] quiet = 0;
  reg more = 1'b1;
  reg first = 1'b1;  // the first pair is inside, alone
  wire ready, out, hit, definite;
  wire [15:0] tag;
  reg [8*256:1] name;
  integer pairs, answers, found;

  `SAT_CORE #(
      .COORD_W(W)
  ) u_core (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (valid),
      .s_pair_ready     (ready),
      .s_pair_tag       (sent[15:0]),
      .s_pair_mode      (`CCHIP_MODE_DIRECTED),
      .s_pair_a         ({{3 * W{1'b0}}, a}),
      .s_pair_b         ({{3 * W{1'b0}}, b}),
      .s_pair_err       (err),
      .m_result_valid   (out),
      .m_result_ready   (1'b1),
      .m_result_tag     (tag),
      .m_result_hit     (hit),
      .m_result_grid    (),
      .m_result_definite(definite),
      .m_result_axis    (),
      .m_result_beats   (),
      .rm_id            (),
      .idle             ()
  );

  task read_pair;
    begin
      found = $fscanf(pairs, "%h %h %h\n", b, a, err);
      more = found == 3;
    end
  endtask

  always #5 clk = !clk;

  initial begin
    if (!$value$plusargs("pairs=%s", name)) $finish;
    pairs = $fopen(name, "r");
    if (!$value$plusargs("answers=%s", name)) $finish;
    answers = $fopen(name, "w");
    if (pairs == 0 || answers == 0) begin
      $display("cannot open the files");
      $finish;
    end
    read_pair;
    repeat (8) @(negedge clk);
    rst = 1'b0;
    // between the edges: what is set here holds at the next rising edge
    while (more || got != sent) begin
      valid = more && (sent == 0 || !first);
      #1;
      if (out) begin
        $fdisplay(answers, "%0d %0d %0d", tag, hit, definite);
        if (got == 0) lone = clocks;
        got = got + 1;
        first = 1'b0;
      end
      quiet = out ? 0 : quiet + 1;
      if (quiet == LIMIT) begin
        $display("no answer for %0d clocks", LIMIT);
        $finish;
      end
      found = valid && ready;
      @(posedge clk);
      #1;
      if (found != 0) begin
        sent = sent + 1;
        read_pair;
      end
      if (sent != 0) clocks = clocks + 1;
      @(negedge clk);
    end
    $display("pairs=%0d clocks=%0d lone=%0d", got, clocks - lone, lone);
    $finish;
  end

endmodule
`default_nettype wire
