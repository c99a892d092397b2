// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// A line through cchip_cache for scripts/waveforms.py, port 0: read from memory, then asked for twice more, once while it is
// in flight and once when it is there.
module bench;
  `include "cchip_defs.vh"
  localparam integer LINE_W = 32;
  localparam [LINE_W-1:0] LINE = 'h40;

  reg clk = 0, rst = 1, show = 0;
  reg s_valid = 0;
  reg [4:0] s_place = 0;
  reg [LINE_W-1:0] s_line = 0;
  wire [1:0] valid, hits, misses, waits;
  wire [9:0] place;
  wire [2*`CCHIP_READ_CODE_W-1:0] code;
  wire [1023:0] data;
  wire m_valid = valid[0], count_hit = hits[0], count_miss = misses[0], count_wait = waits[0];
  wire [4:0] m_place = place[4:0];
  wire [`CCHIP_READ_CODE_W-1:0] m_code = code[`CCHIP_READ_CODE_W-1:0];
  wire [31:0] m_data = data[31:0];
  wire m_read_valid;
  wire [4:0] m_read_slot;
  wire [57:0] m_read_line;
  reg s_read_valid = 0, s_read_last = 0;
  reg [4:0] s_read_slot = 0;
  reg [2:0] s_read_beat = 0;

  cchip_cache dut (
      .clk               (clk),
      .rst               (rst),
      .s_valid           ({1'b0, s_valid}),
      .s_place           ({5'd0, s_place}),
      .s_line            ({{LINE_W{1'b0}}, s_line}),
      .m_valid           (valid),
      .m_place           (place),
      .m_code            (code),
      .m_data            (data),
      .lock_first        ({2{{LINE_W{1'b1}}}}),
      .lock_last         ({2{{LINE_W{1'b0}}}}),
      .invalidate_valid  (1'b0),
      .invalidate_ready  (),
      .invalidate_first  ({LINE_W{1'b0}}),
      .invalidate_last   ({LINE_W{1'b0}}),
      .m_read_valid      (m_read_valid),
      .m_read_slot       (m_read_slot),
      .m_read_line       (m_read_line),
      .s_read_valid      (s_read_valid),
      .s_read_slot       (s_read_slot),
      .s_read_beat       (s_read_beat),
      .s_read_last       (s_read_last),
      .s_read_code       (`CCHIP_READ_OK),
      .s_read_data       ({125'd0, s_read_beat}),
      .s_read_outstanding(32'd0),
      .count_hit         (hits),
      .count_miss        (misses),
      .count_wait        (waits),
      .count_again       ()
  );

  always #1 clk = ~clk;

  task request(input [4:0] its_place);
    begin
      s_valid = 1;
      s_place = its_place;
      s_line = LINE;
      @(negedge clk);
      s_valid = 0;
    end
  endtask

  integer i;
  initial begin
    $dumpvars(1, bench);
    repeat (4) @(negedge clk);
    rst = 0;
    repeat (1100) @(negedge clk);  // the cache empties itself
    show = 1;
    @(negedge clk);
    request(1);
    while (!m_read_valid) @(negedge clk);
    s_read_slot = m_read_slot;
    repeat (4) @(negedge clk);
    request(2);
    repeat (14) @(negedge clk);
    for (i = 0; i < 4; i = i + 1) begin
      s_read_valid = 1;
      s_read_beat = i;
      s_read_last = i == 3;
      @(negedge clk);
    end
    s_read_valid = 0;
    s_read_last = 0;
    repeat (30) @(negedge clk);
    request(3);
    repeat (10) @(negedge clk);
    $finish;
  end
endmodule
`default_nettype wire
