// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_blank: self-checking bench of cchip_primtest_blank: for any input the outputs are its constants.
// Ends with "PASS clocks=C" or "FAIL ...", after which Icarus ends with code 1. Verilog-2005, no package.
module bench_blank;

  localparam integer COORD_W = 16;
  localparam integer SIDE_W = 4 * 3 * COORD_W;
  localparam integer INPUTS_W = 4 + 16 + 2 + 2 * SIDE_W + 4;
  localparam integer CLOCKS = 1000;

  reg  [INPUTS_W-1:0] inputs;
  wire [        35:0] outputs;  // everything but rm_id and idle
  wire [         7:0] rm_id;
  wire                idle;
  integer clock, i;
  reg failed;

  cchip_primtest_blank dut (
      .clk              (inputs[0]),
      .rst              (inputs[1]),
      .s_pair_valid     (inputs[2]),
      .m_result_ready   (inputs[3]),
      .s_pair_tag       (inputs[4+:16]),
      .s_pair_mode      (inputs[20+:2]),
      .s_pair_err       (inputs[22+:4]),
      .s_pair_a         (inputs[26+:SIDE_W]),
      .s_pair_b         (inputs[26+SIDE_W+:SIDE_W]),
      .s_pair_ready     (outputs[0]),
      .m_result_valid   (outputs[1]),
      .m_result_tag     (outputs[2+:16]),
      .m_result_hit     (outputs[18]),
      .m_result_grid    (outputs[19]),
      .m_result_definite(outputs[20]),
      .m_result_axis    (outputs[21+:9]),
      .m_result_beats   (outputs[30+:6]),
      .rm_id            (rm_id),
      .idle             (idle)
  );

  initial begin
    failed = 0;
    for (clock = 0; clock < CLOCKS && !failed; clock = clock + 1) begin
      for (i = 0; i < INPUTS_W; i = i + 1) inputs[i] = $random;
      #5;
      if (outputs !== 36'd0 || rm_id !== 8'd0 || idle !== 1'b1) begin
        $display("FAIL clock %0d: outputs %h rm_id %h idle %b, must be 0 0 1", clock, outputs, rm_id, idle);
        failed = 1;
      end
    end
    if (!failed) $display("PASS clocks=%0d", CLOCKS);
`ifdef __ICARUS__
    if (failed) $finish_and_return(1);
`endif
    $finish;
  end

endmodule
`default_nettype wire
