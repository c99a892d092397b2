// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Two pairs through cchip_primtest_tri_tri for scripts/waveforms.py: a hit, which takes more axes, and right behind it a pair
// that the first axis separates, so it overtakes. The receiver takes nothing for two clocks of the second result.
module bench;
  localparam integer COORD_W = 16;

  reg clk = 0, rst = 1, show = 0;
  reg s_pair_valid = 0, m_result_ready = 1;
  reg [15:0] s_pair_tag = 0;
  reg [12*COORD_W-1:0] s_pair_a, s_pair_b;
  wire s_pair_ready, m_result_valid, m_result_hit, m_result_definite, idle;
  wire [15:0] m_result_tag;
  wire [5:0] m_result_beats;

  cchip_primtest_tri_tri dut (
      .clk              (clk),
      .rst              (rst),
      .s_pair_valid     (s_pair_valid),
      .s_pair_ready     (s_pair_ready),
      .s_pair_tag       (s_pair_tag),
      .s_pair_mode      (2'd1),
      .s_pair_a         (s_pair_a),
      .s_pair_b         (s_pair_b),
      .s_pair_err       (4'd0),
      .m_result_valid   (m_result_valid),
      .m_result_ready   (m_result_ready),
      .m_result_tag     (m_result_tag),
      .m_result_hit     (m_result_hit),
      .m_result_grid    (),
      .m_result_definite(m_result_definite),
      .m_result_axis    (),
      .m_result_beats   (m_result_beats),
      .rm_id            (),
      .idle             (idle)
  );

  function [3*COORD_W-1:0] point(input integer x, input integer y, input integer z);
    point = {z[COORD_W-1:0], y[COORD_W-1:0], x[COORD_W-1:0]};
  endfunction

  always #1 clk = ~clk;

  initial begin
    $dumpvars(1, bench);
    s_pair_a = {48'd0, point(0, 4, 0), point(4, -4, 0), point(-4, -4, 0)};
    repeat (4) @(negedge clk);
    rst = 0;
    repeat (4) @(negedge clk);
    show = 1;
    @(negedge clk);
    s_pair_valid = 1;
    s_pair_tag = 1;  // crosses the plane of A inside A
    s_pair_b = {48'd0, point(2, 0, 3), point(6, 0, -3), point(-2, 0, -3)};
    @(negedge clk);
    s_pair_tag = 2;  // lies three steps above A
    s_pair_b = {48'd0, point(0, 4, 3), point(4, -4, 3), point(-4, -4, 3)};
    @(negedge clk);
    s_pair_valid = 0;
    wait (m_result_valid && m_result_tag == 16'd1);
    m_result_ready = 0;
    repeat (3) @(negedge clk);
    m_result_ready = 1;
    repeat (3) @(negedge clk);
    $finish;
  end
endmodule
`default_nettype wire
