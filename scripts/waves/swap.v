// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// A swap for scripts/waveforms.py: cchip_config_controller puts module 2 into a simulated slot that holds module 1. The slot has
// no pairs, so it is quiet soon after it is stopped. The bitstream is the shortest one, 16 bytes behind its header.
module bench;
  `include "cchip_defs.vh"
  localparam [`CCHIP_RM_ID_W-1:0] MODULE = 2;

  reg clk = 0, rst = 1, show = 0;
  reg s_swap_valid = 0;
  wire [`CCHIP_RM_ID_W-1:0] s_swap_module = MODULE;
  wire [`CCHIP_SWAP_REPORT_W-1:0] report;
  wire [`CCHIP_SWAP_W-1:0] m_report_code = report[`CCHIP_SWAP_REPORT_CODE];
  wire m_report_valid, s_swap_ready, busy;
  wire [`CCHIP_PHASE_W-1:0] phase;
  wire stop, decouple, decoupled, hold_reset, roc_start, roc_busy;
  wire coupled = !decoupled;
  reg [2:0] stopped = 0;
  wire quiet = stopped[2];
  wire [`CCHIP_RM_ID_W-1:0] region_rm_id;
  wire m_axi_arvalid, m_axi_rready, cfg_valid;
  wire [31:0] m_axi_araddr;
  wire [7:0] m_axi_arlen, cfg_data;
  reg m_axi_rvalid = 0;
  reg [7:0] beats = 0;
  reg [31:0] at = 0;

  // ---- the bitstream: header, payload with its own CRC
  function [31:0] crc(input [127:0] bytes, input integer count);
    integer i;
    begin
      crc = 32'hFFFFFFFF;
      for (i = 0; i < 8 * count; i = i + 1) crc = (crc >> 1) ^ (crc[0] ^ bytes[i] ? 32'hEDB88320 : 32'd0);
      crc = ~crc;
    end
  endfunction
  localparam [95:0] BODY = {32'd0, 16'd0, MODULE, 8'd0, `CCHIP_BITSTREAM_SYNC};
  wire [127:0] payload = {crc({32'd0, BODY}, 12), BODY};
  wire [255:0] bitstream = {payload, crc(payload, 16), 32'd16, {24'd0, MODULE}, `CCHIP_BITSTREAM_MAGIC};

  cchip_config_controller #(
      .CFG_DIVIDER(1)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .s_swap_valid  (s_swap_valid),
      .s_swap_ready  (s_swap_ready),
      .s_swap_data   (`CCHIP_SWAP_REQUEST_OF({`CCHIP_SLOT_ID_W{1'b0}}, MODULE, 32'd0, 32'd32, 1'b0)),
      .m_report_valid(m_report_valid),
      .m_report_data (report),
      .abort_swap    (1'b0),
      .clear         (1'b0),
      .shutdown_limit(32'd0),
      .memory_limit  (32'd0),
      .stop          (stop),
      .decouple      (decouple),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .quiet         (quiet),
      .decoupled     (decoupled),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .lost          ({`CCHIP_PAIR_COUNT_W{1'b0}}),
      .busy          (busy),
      .phase         (phase),
      .phase_slot    (),
      .m_axi_arvalid (m_axi_arvalid),
      .m_axi_arready (1'b1),
      .m_axi_araddr  (m_axi_araddr),
      .m_axi_arlen   (m_axi_arlen),
      .m_axi_rvalid  (m_axi_rvalid),
      .m_axi_rready  (m_axi_rready),
      .m_axi_rdata   (bitstream[32*at+:32]),
      .m_axi_rresp   (2'd0),
      .m_axi_rlast   (beats == 8'd1),
      .cfg_valid     (cfg_valid),
      .cfg_data      (cfg_data),
      .cfg_error     (1'b0),
      .swapped       (),
      .rejected      (),
      .stall         (),
      .read_phase    ({`CCHIP_PHASE_W{1'b0}}),
      .read_clocks   ()
  );

  cchip_pr_slot #(
      .COORD_W   (8),
      .SUBSTAGES (8),
      .RM_ID     (1),
      .SIMULATION(1)
  ) slot (
      .clk           (clk),
      .rst           (rst),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .cfg_valid     (cfg_valid),
      .cfg_data      (cfg_data),
      .s_vertex_valid(1'b0),
      .s_vertex_data ({`CCHIP_VERTEX_W(8) {1'b0}}),
      .m_result_valid(),
      .m_result_data (),
      .rm_id         (),
      .idle          ()
  );

  // memory: the address is taken at once, the first beat comes four clocks later
  always @(negedge clk) begin
    if (m_axi_rvalid && m_axi_rready) begin
      at = at + 1;
      beats = beats - 8'd1;
      m_axi_rvalid = beats != 8'd0;
    end
    if (m_axi_arvalid) begin
      at = m_axi_araddr >> 2;
      beats = m_axi_arlen + 8'd1;
      m_axi_rvalid <= #8 1'b1;
    end
    stopped = stop ? {stopped[1:0], 1'b1} : 3'd0;
  end

  always #1 clk = ~clk;

  initial begin
    $dumpvars(1, bench);
    repeat (4) @(negedge clk);
    rst = 0;
    repeat (60) @(negedge clk);
    show = 1;
    @(negedge clk);
    s_swap_valid = 1;
    @(negedge clk);
    s_swap_valid = 0;
    while (!m_report_valid) @(negedge clk);
    repeat (3) @(negedge clk);
    $finish;
  end
endmodule
`default_nettype wire
