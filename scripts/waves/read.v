// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Reads of one slot of cchip_axi_read for scripts/waveforms.py: memory does not answer the first one in time, so it ends with a
// time-out; the slot's next request is refused while the answer is outstanding; the late beats are dropped; then a read that works.
module bench;
  `include "cchip_defs.vh"

  reg clk = 0, rst = 1, show = 0;
  reg s_valid = 0;
  reg [57:0] s_line = 0;
  wire m_valid, m_last;
  wire [2:0] m_beat;
  wire [`CCHIP_READ_CODE_W-1:0] m_code;
  wire [15:0] open;
  wire answered = m_valid && m_last;
  wire outstanding = open[0];
  wire m_axi_arvalid, m_axi_rready;
  reg m_axi_rvalid = 0, m_axi_rlast = 0;

  cchip_axi_read #(
      .CLIENTS(1)
  ) dut (
      .clk            (clk),
      .rst            (rst),
      .limit          (32'd20),
      .s_valid        (s_valid),
      .s_slot         (4'd0),
      .s_line         (s_line),
      .m_valid        (m_valid),
      .m_slot         (),
      .m_beat         (m_beat),
      .m_last         (m_last),
      .m_code         (m_code),
      .m_data         (),
      .any_outstanding(),
      .outstanding    (open),
      .m_axi_arvalid  (m_axi_arvalid),
      .m_axi_arready  (1'b1),
      .m_axi_arid     (),
      .m_axi_araddr   (),
      .m_axi_arlen    (),
      .m_axi_rvalid   (m_axi_rvalid),
      .m_axi_rready   (m_axi_rready),
      .m_axi_rid      (4'd0),
      .m_axi_rdata    (128'd0),
      .m_axi_rresp    (2'd0),
      .m_axi_rlast    (m_axi_rlast)
  );

  always #1 clk = ~clk;

  task request(input [57:0] line);
    begin
      s_valid = 1;
      s_line = line;
      @(negedge clk);
      s_valid = 0;
    end
  endtask

  task answer;
    integer i;
    for (i = 0; i < 4; i = i + 1) begin
      m_axi_rvalid = 1;
      m_axi_rlast = i == 3;
      @(negedge clk);
      m_axi_rvalid = 0;
      m_axi_rlast = 0;
    end
  endtask

  task until_answered;
    while (!answered) @(negedge clk);
  endtask

  initial begin
    $dumpvars(1, bench);
    repeat (4) @(negedge clk);
    rst = 0;
    repeat (4) @(negedge clk);
    show = 1;
    @(negedge clk);
    request('h40);
    until_answered;  // TIMEOUT
    repeat (3) @(negedge clk);
    request('h41);
    until_answered;  // OWED
    repeat (3) @(negedge clk);
    answer;
    repeat (6) @(negedge clk);
    request('h42);
    while (!m_axi_arvalid) @(negedge clk);
    repeat (2) @(negedge clk);
    answer;
    until_answered;  // OK
    repeat (3) @(negedge clk);
    $finish;
  end
endmodule
`default_nettype wire
