// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_sequencer: requests, phases and reports of cchip_config_controller, and what the slots
// are told in them.
//   latency      every request is answered by exactly one report; one during a swap by BUSY, 2
//                clocks later or 3
//   order        HEADER, SHUTDOWN, DECOUPLE, RESET, TRANSFER, CHECK, ROC, RECOUPLE, REPORT; what
//                fails before DECOUPLE leaves the slot at work, what fails from there on leaves it
//                stopped, decoupled and in reset
//   bounds       SHUTDOWN: shutdown_limit; DECOUPLE, ROC, RECOUPLE: SLOT_LIMIT; HEADER and
//                TRANSFER: error or timeout of the fetch, or their words are there; the rest: fixed
//   cuts         every path: each output is a flip-flop, m_report_data one of two
//   reset        no swap, slots at work, except one whose transfer had begun and not ended well:
//                half_q outlives rst and keeps it stopped, decoupled and in reset until a good
//                transfer
module cchip_swap_sequencer #(
    // slots, 1 or 2
    parameter integer SLOTS = 1,
    // longest wait for a slot to decouple, to end its ROC, to recouple, clocks, >= 16
    parameter integer SLOT_LIMIT = 4096
) (
    input  wire                                 clk,
    input  wire                                 rst,
    input  wire                                 s_swap_valid,
    output wire                                 s_swap_ready,
    input  wire [    `CCHIP_SWAP_REQUEST_W-1:0] s_swap_data,
    output wire                                 m_report_valid,
    output wire [     `CCHIP_SWAP_REPORT_W-1:0] m_report_data,
    input  wire                                 abort_swap,
    input  wire [                         31:0] shutdown_limit,
    input  wire [                         31:0] memory_limit,
    output wire [                    SLOTS-1:0] stop,
    output wire [                    SLOTS-1:0] decouple,
    output wire [                    SLOTS-1:0] hold_reset,
    output wire [                    SLOTS-1:0] roc_start,
    input  wire [                    SLOTS-1:0] quiet,
    input  wire [                    SLOTS-1:0] decoupled,
    input  wire [                    SLOTS-1:0] roc_busy,
    input  wire [     `CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id,
    input  wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] lost,
    output wire [           `CCHIP_PHASE_W-1:0] phase,
    output wire                                 busy,             // a phase other than IDLE
    output wire                                 in_header,        // phase is HEADER, TRANSFER
    output wire                                 in_transfer,
    output wire [         `CCHIP_SLOT_ID_W-1:0] slot,             // of the request
    output wire [           `CCHIP_RM_ID_W-1:0] module_id,
    output wire [                         31:0] address,
    output wire [                         31:0] size,
    output wire [                         31:0] limit,            // of the memory
    // the fetch works, in HEADER and in TRANSFER
    output wire                                 run,
    input  wire                                 header_done,
    input  wire                                 header_ok,
    input  wire [            `CCHIP_SWAP_W-1:0] header_code,
    input  wire                                 owes,
    input  wire                                 bus_error,
    input  wire                                 timeout,
    input  wire                                 transfer_done,
    input  wire                                 crc_ok,
    input  wire                                 cfg_error
);

  // clocks of a phase, counted from 0
  localparam [3:0] DECIDE = 4'd2;  // of HEADER: the request is judged
  localparam [3:0] RESET_LAST = 4'd1;
  localparam [3:0] CHECK_LAST = 4'd7;  // the device may report an error on all but this one
  localparam [3:0] SEEN = 4'd6;  // roc_busy counts from here on in ROC, decoupled in RECOUPLE
  localparam [3:0] RECOUPLE_AT = 4'd1;  // decouple falls behind it, after reset
  localparam [9:0] AT_IDLE = 10'd1;
  localparam [9:0] AT_REPORT = AT_IDLE << `CCHIP_PHASE_REPORT;
  localparam [31:0] LIMIT = SLOT_LIMIT;
  localparam [31:0] SLOT_COUNT = SLOTS;

  generate
    if (SLOTS < 1 || SLOTS > 2) begin : gen_illegal
      cchip_error_SLOTS_must_be_1_or_2 u_error ();
    end
    if (SLOT_LIMIT < 16) begin : gen_illegal_limit
      cchip_error_SLOT_LIMIT_below_16 u_error ();
    end
  endgenerate

  // ---- request
  wire [9:0] pass;  // one-hot: this phase is over and was good
  reg [`CCHIP_PHASE_W-1:0] phase_q;
  reg [9:0] at_q;  // phase_q, one-hot
  reg [`CCHIP_SLOT_ID_W-1:0] slot_q;
  reg [`CCHIP_RM_ID_W-1:0] module_q;
  reg [31:0] address_q, size_q;
  reg force_q;
  reg [31:0] memory_limit_q;
  reg [31:0] bound_q;  // of the phase: shutdown_limit up to SHUTDOWN, SLOT_LIMIT from then on
  reg ready_q, refuse_q;  // a request during a swap waits for its report
  reg [`CCHIP_SLOT_ID_W-1:0] refuse_slot_q;
  reg [`CCHIP_RM_ID_W-1:0] refuse_module_q;
  wire [`CCHIP_SLOT_ID_W-1:0] s_swap_slot;
  wire [`CCHIP_RM_ID_W-1:0] s_swap_module;
  wire [31:0] s_swap_address, s_swap_size;
  wire s_swap_force;
  assign `CCHIP_SWAP_REQUEST_OF(s_swap_slot, s_swap_module, s_swap_address, s_swap_size,
      s_swap_force) = s_swap_data;
  wire idle = at_q[`CCHIP_PHASE_IDLE];
  wire accept = s_swap_valid & ready_q;
  wire begins = accept & idle;

  always @(posedge clk) begin
    if (begins) begin
      slot_q <= s_swap_slot;
      module_q <= s_swap_module;
      address_q <= s_swap_address;
      size_q <= s_swap_size;
      force_q <= s_swap_force;
    end
    if (idle) memory_limit_q <= memory_limit == 32'd0 ? `CCHIP_MEMORY_LIMIT_DEFAULT : memory_limit;
    if (idle) bound_q <= shutdown_limit == 32'd0 ? `CCHIP_SHUTDOWN_LIMIT_DEFAULT : shutdown_limit;
    else if (pass[`CCHIP_PHASE_SHUTDOWN]) bound_q <= LIMIT;
    if (accept) refuse_slot_q <= s_swap_slot;
    if (accept) refuse_module_q <= s_swap_module;
  end

  // ---- the slot
  reg [SLOTS-1:0] mine_q;  // one-hot: the slot of the request
  function [SLOTS-1:0] one_hot(input [7:0] number);
    integer i;
    begin
      one_hot = {SLOTS{1'b0}};
      for (i = 0; i < SLOTS; i = i + 1) one_hot[i] = number == i[7:0];
    end
  endfunction
  function [23:0] choose(input [24*SLOTS-1:0] from, input [SLOTS-1:0] select);
    integer i;
    begin
      choose = 24'd0;
      for (i = 0; i < SLOTS; i = i + 1) choose = choose | (from[24*i+:24] & {24{select[i]}});
    end
  endfunction
  wire [24*SLOTS-1:0] slots;  // {lost, rm_id} of each
  wire [23:0] chosen = choose(slots, mine_q);
  genvar s;
  generate
    for (s = 0; s < SLOTS; s = s + 1) begin : gen_slot
      assign slots[24*s+:24] = {lost[16*s+:16], region_rm_id[8*s+:8]};
    end
  endgenerate

  reg match_q;  // the region shows the module asked for
  reg [`CCHIP_PAIR_COUNT_W-1:0] slot_lost_q, lost_q;
  reg quiet_q, decoupled_q, roc_busy_q;
  always @(posedge clk) begin
    if (begins) mine_q <= one_hot(s_swap_slot);
    slot_lost_q <= chosen[23:8];
    match_q <= chosen[7:0] == module_q;
    quiet_q <= |(quiet & mine_q);
    decoupled_q <= |(decoupled & mine_q);
    roc_busy_q <= |(roc_busy & mine_q);
  end

  // ---- is the request legal, and is it needed?
  reg illegal_q, same_q;
  reg [31:0] last_byte_q;
  reg outside_q;
  always @(posedge clk) begin
    last_byte_q <= address_q + size_q - 32'd1;
    outside_q <= {24'd0, slot_q} >= SLOT_COUNT || module_q > `CCHIP_RM_QUAD_QUAD
        || address_q[5:0] != 6'd0;
    illegal_q <= outside_q || size_q == 32'd0 || last_byte_q < address_q;
    same_q <= ~decoupled_q & match_q;
  end

  // ---- sequence: to the next phase, or with a code to REPORT
  reg [31:0] clocks_q;  // in this phase
  reg [3:0] step_q;  // the same, from 0 to 15
  reg decide_q, reset_last_q, check_last_q, late_q;  // step_q is DECIDE, ..., SEEN or more
  reg expired_q, error_q, forced_q, abort_q;
  reg fault_q;  // the fetch failed, a clock ago
  reg [`CCHIP_SWAP_W-1:0] fault_code_q;
  // 1 + number of consecutive clocks on which the region showed the module asked for. One such
  // clock proves nothing: a region full of garbage may show any number.
  reg [4:0] alike_q;
  wire at_header = at_q[`CCHIP_PHASE_HEADER];
  wire at_shutdown = at_q[`CCHIP_PHASE_SHUTDOWN];
  wire at_decouple = at_q[`CCHIP_PHASE_DECOUPLE];
  wire at_transfer = at_q[`CCHIP_PHASE_TRANSFER];
  wire at_check = at_q[`CCHIP_PHASE_CHECK];
  wire at_roc = at_q[`CCHIP_PHASE_ROC];
  wire at_recouple = at_q[`CCHIP_PHASE_RECOUPLE];
  wire at_report = at_q[`CCHIP_PHASE_REPORT];

  wire roc_over = at_roc & late_q & ~roc_busy_q;
  wire fails_early =
      (at_header & (decide_q ? illegal_q | same_q | owes : fault_q | (header_done & ~header_ok)))
      | (at_shutdown & expired_q & ~quiet_q & ~decoupled_q & ~force_q);
  wire fails_late = (at_decouple & expired_q & ~decoupled_q)
      | (at_transfer & (error_q | fault_q))
      | (at_check & (error_q | (check_last_q & ~crc_ok)))
      | (at_roc & (roc_busy_q ? expired_q : late_q & ~match_q))
      | (at_recouple & late_q & decoupled_q & expired_q);
  // DECOUPLE is not aborted: the slot finishes decoupling first
  wire aborts = abort_q & ~at_decouple;
  wire past = |at_q[`CCHIP_PHASE_RECOUPLE:`CCHIP_PHASE_DECOUPLE];  // the slot is no longer at work
  // A failure takes effect one clock after it is detected: fail_q drives the many registers that it
  // resets, so that they do not wait for the logic of failing.
  wire failing = fails_early | fails_late;
  reg fail_q;

  // a phase never passes while it fails; if it passes and is aborted on one clock, passing wins
  assign pass[`CCHIP_PHASE_IDLE] = begins;
  assign pass[`CCHIP_PHASE_HEADER] = at_header & ~decide_q & ~fault_q & header_done & header_ok
      & ~fail_q;
  assign pass[`CCHIP_PHASE_SHUTDOWN] = at_shutdown
      & (quiet_q | decoupled_q | (expired_q & force_q)) & ~fail_q;
  assign pass[`CCHIP_PHASE_DECOUPLE] = at_decouple & decoupled_q & ~fail_q;
  assign pass[`CCHIP_PHASE_RESET] = at_q[`CCHIP_PHASE_RESET] & reset_last_q & ~fail_q;
  assign pass[`CCHIP_PHASE_TRANSFER] = at_transfer & transfer_done & ~error_q & ~fault_q & ~fail_q;
  assign pass[`CCHIP_PHASE_CHECK] = at_check & check_last_q & crc_ok & ~error_q & ~fail_q;
  assign pass[`CCHIP_PHASE_ROC] = roc_over & match_q & alike_q[4] & ~fail_q;
  assign pass[`CCHIP_PHASE_RECOUPLE] = at_recouple & late_q & ~decoupled_q & ~fail_q;
  assign pass[`CCHIP_PHASE_REPORT] = at_report;

  wire [`CCHIP_SWAP_W-1:0] code_of_header = decide_q ?
      (illegal_q ? `CCHIP_SWAP_REQUEST : same_q ? `CCHIP_SWAP_SAME : `CCHIP_SWAP_MEMORY) :
      fault_q ? fault_code_q : header_code;
  wire [`CCHIP_SWAP_W-1:0] code_d = abort_q ? `CCHIP_SWAP_ABORTED :
      ({4{at_header}} & code_of_header)
      | ({4{at_shutdown}} & `CCHIP_SWAP_SHUTDOWN)
      | ({4{at_decouple}} & `CCHIP_SWAP_DEVICE)
      | ({4{at_transfer}} & (error_q ? `CCHIP_SWAP_DEVICE : fault_code_q))
      | ({4{at_check}} & (error_q ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_CRC))
      | ({4{at_roc}} & (roc_busy_q ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_WRONG_MODULE))
      | ({4{at_recouple}} & (decoupled_q ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_OK));

  wire enter = fail_q | (|pass);
  wire reports = fail_q | pass[`CCHIP_PHASE_RECOUPLE];
  wire refuses = refuse_q & ~reports;
  wire [SLOTS-1:0] mine_if_transfer = mine_q & {SLOTS{pass[`CCHIP_PHASE_RESET]}};
  wire [SLOTS-1:0] mine_if_recouple = mine_q & {SLOTS{pass[`CCHIP_PHASE_ROC]}};
  wire [SLOTS-1:0] mine_if_fails = mine_q & {SLOTS{fail_q & past}};
  wire gone = at_decouple & decoupled_q & forced_q;

  // ---- what the slots are told
  reg [SLOTS-1:0] stop_q, decouple_q, hold_reset_q, roc_start_q;
  reg [SLOTS-1:0] half_q;  // the region holds no whole module
  initial half_q = {SLOTS{1'b0}};
  always @(posedge clk) begin
    if (!rst) half_q <= (half_q | mine_if_transfer) & ~mine_if_recouple;
    if (rst) begin
      stop_q       <= half_q;
      decouple_q   <= half_q;
      hold_reset_q <= half_q;
      roc_start_q  <= {SLOTS{1'b0}};
    end else begin
      if (pass[`CCHIP_PHASE_HEADER]) stop_q <= stop_q | mine_q;
      else if (reports) stop_q <= decouple_q | mine_if_fails;
      if (pass[`CCHIP_PHASE_SHUTDOWN]) decouple_q <= decouple_q | mine_q;
      else if (at_recouple && step_q == RECOUPLE_AT) decouple_q <= decouple_q & ~mine_q;
      else decouple_q <= decouple_q | mine_if_fails;
      if (pass[`CCHIP_PHASE_DECOUPLE]) hold_reset_q <= hold_reset_q | mine_q;
      else hold_reset_q <= (hold_reset_q | mine_if_fails) & ~mine_if_recouple;
      roc_start_q <= mine_q & {SLOTS{pass[`CCHIP_PHASE_CHECK]}};
    end
  end

  // ---- phase and report
  reg run_q;  // the fetch works
  reg report_valid_q;
  reg refused_q;  // the report is that of a refused request
  reg [`CCHIP_SWAP_W-1:0] code_q;
  always @(posedge clk) begin
    clocks_q <= enter ? 32'd1 : clocks_q + 32'd1;
    step_q <= enter ? 4'd0 : step_q == 4'd15 ? 4'd15 : step_q + 4'd1;
    decide_q <= !enter && step_q == DECIDE - 4'd1;
    reset_last_q <= !enter && step_q == RESET_LAST - 4'd1;
    check_last_q <= !enter && step_q == CHECK_LAST - 4'd1;
    late_q <= !enter && step_q >= SEEN - 4'd1;
    expired_q <= !enter && (expired_q || clocks_q == bound_q);
    error_q <= cfg_error & (at_transfer | at_check);
    forced_q <= ~idle & (forced_q | (at_shutdown & expired_q & ~quiet_q));
    alike_q <= roc_over ? alike_q + 5'd1 : 5'd1;
    fault_q <= bus_error | timeout;
    fault_code_q <= bus_error ? `CCHIP_SWAP_BUS : `CCHIP_SWAP_MEMORY;
    lost_q <= begins ? 16'd0 : gone ? slot_lost_q : lost_q;
    refused_q <= refuses;
    if (!fail_q) code_q <= code_d;
    if (rst) begin
      phase_q <= `CCHIP_PHASE_IDLE;
      at_q <= AT_IDLE;
      fail_q <= 1'b0;
      abort_q <= 1'b0;
      ready_q <= 1'b0;
      refuse_q <= 1'b0;
      run_q <= 1'b0;
      report_valid_q <= 1'b0;
    end else begin
      abort_q <= |at_q[`CCHIP_PHASE_ROC:`CCHIP_PHASE_HEADER] & ~reports & ~pass[`CCHIP_PHASE_ROC]
          & (abort_q | abort_swap);
      fail_q <= (failing | (aborts & ~(|pass))) & ~fail_q;
      at_q <= fail_q ? AT_REPORT : (at_q & ~pass) | {pass[8:0], pass[9]};
      phase_q <= fail_q ? `CCHIP_PHASE_REPORT : at_report ? `CCHIP_PHASE_IDLE : phase_q
          + {3'd0, |pass};
      ready_q <= ~(accept & ~idle) & ~(refuse_q & reports);
      refuse_q <= (accept & ~idle) | (refuse_q & reports);
      run_q <= pass[`CCHIP_PHASE_RESET]
          | ((run_q | decide_q) & ~failing & ~aborts & ~enter & (at_header | at_transfer));
      report_valid_q <= reports | refuses;
    end
  end

  assign s_swap_ready = ready_q;
  assign m_report_valid = report_valid_q;
  // slot_q, module_q and lost_q do not change in REPORT
  assign m_report_data = refused_q
      ? `CCHIP_SWAP_REPORT_OF(refuse_slot_q, refuse_module_q, `CCHIP_SWAP_BUSY, 16'd0)
      : `CCHIP_SWAP_REPORT_OF(slot_q, module_q, code_q, lost_q);
  assign stop = stop_q;
  assign decouple = decouple_q;
  assign hold_reset = hold_reset_q;
  assign roc_start = roc_start_q;
  assign phase = phase_q;
  assign busy = ~idle;
  assign in_header = at_header;
  assign in_transfer = at_transfer;
  assign slot = slot_q;
  assign module_id = module_q;
  assign address = address_q;
  assign size = size_q;
  assign limit = memory_limit_q;
  assign run = run_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_phase, at_q == AT_IDLE << phase_q)
      `CCHIP_ASSERT(a_pass, (pass & (pass - 10'd1)) == 10'd0)
      `CCHIP_ASSERT(a_fail, !(failing || fail_q) || pass == 10'd0)
      `CCHIP_ASSERT(a_order, (hold_reset_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_stopped, (decouple_q & ~stop_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_half, (half_q & ~hold_reset_q) == {SLOTS{1'b0}})
    end

endmodule
`default_nettype wire
