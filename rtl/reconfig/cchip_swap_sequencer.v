// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`include "cchip_defs.vh"
`default_nettype none
// cchip_swap_sequencer: requests, phases and reports of cchip_config_controller, and what the slots are told in them.
//   latency      every request is answered by exactly one report; one during a swap by BUSY, 2 clocks later or 3
//   order        HEADER, SHUTDOWN, DECOUPLE, RESET, TRANSFER, CHECK, ROC, RECOUPLE, REPORT; what fails before DECOUPLE leaves
//                the slot at work, what fails from there on leaves it stopped, decoupled and in reset
//   bounds       SHUTDOWN: shutdown_limit; DECOUPLE, ROC, RECOUPLE: SLOT_LIMIT; HEADER and TRANSFER: error or timeout of the
//                fetch, or their words are there; the rest: fixed
//   cuts         every path: each output is a flip-flop
//   reset        no swap, slots at work, except one whose transfer had begun and not ended well: half_q outlives rst and
//                keeps it stopped, decoupled and in reset until a good transfer
module cchip_swap_sequencer #(
    // slots, 1 or 2
    parameter integer SLOTS = 1,
    // longest wait for a slot to decouple, to end its ROC, to recouple, clocks, >= 16
    parameter integer SLOT_LIMIT = 4096
) (
    input  wire                clk,
    input  wire                rst,
    input  wire                s_swap_valid,
    output wire                s_swap_ready,
    input  wire [         7:0] s_swap_slot,
    input  wire [         7:0] s_swap_module,
    input  wire [        31:0] s_swap_address,
    input  wire [        31:0] s_swap_size,
    input  wire                s_swap_force,
    output wire                m_report_valid,
    output wire [         7:0] m_report_slot,
    output wire [         7:0] m_report_module,
    output wire [         3:0] m_report_code,
    output wire [        15:0] m_report_lost,
    input  wire                abort_swap,
    input  wire [        31:0] shutdown_limit,
    input  wire [        31:0] memory_limit,
    output wire [   SLOTS-1:0] stop,
    output wire [   SLOTS-1:0] decouple,
    output wire [   SLOTS-1:0] hold_reset,
    output wire [   SLOTS-1:0] roc_start,
    input  wire [   SLOTS-1:0] quiet,
    input  wire [   SLOTS-1:0] decoupled,
    input  wire [   SLOTS-1:0] roc_busy,
    input  wire [ 8*SLOTS-1:0] region_rm_id,
    input  wire [16*SLOTS-1:0] lost,
    output wire [         3:0] phase,
    output wire [         7:0] slot,           // of the request
    output wire [         7:0] module_id,
    output wire [        31:0] address,
    output wire [        31:0] size,
    output wire [        31:0] limit,          // of the memory
    output wire                run,            // the fetch works, in HEADER and in TRANSFER
    input  wire                header_done,
    input  wire                header_ok,
    input  wire [         3:0] header_code,
    input  wire                owes,
    input  wire                bus_error,
    input  wire                timeout,
    input  wire                transfer_done,
    input  wire                crc_ok,
    input  wire                cfg_error
);

  // clocks of a phase, counted from 0
  localparam [3:0] DECIDE = 4'd2;  // of HEADER: the request is judged
  localparam [3:0] RESET_LAST = 4'd1;
  localparam [3:0] CHECK_LAST = 4'd7;  // the device may report an error on all but this one
  localparam [3:0] ROC_SEEN = 4'd6;  // roc_busy counts from here on
  localparam [3:0] RECOUPLE_AT = 4'd1;  // decouple falls behind it, after reset
  localparam [3:0] RECOUPLE_SEEN = 4'd6;  // decoupled counts from here on
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
  reg [3:0] phase_q;
  reg [7:0] slot_q, module_q;
  reg [31:0] address_q, size_q;
  reg force_q;
  reg [31:0] shutdown_limit_q, memory_limit_q;
  reg ready_q, refuse_q;  // a request during a swap waits for its report
  reg [7:0] refuse_slot_q, refuse_module_q;
  wire idle = phase_q == `CCHIP_PHASE_IDLE;
  wire accept = s_swap_valid & ready_q;
  wire begins = accept & idle;

  always @(posedge clk) begin
    if (begins) begin
      slot_q <= s_swap_slot;
      module_q <= s_swap_module;
      address_q <= s_swap_address;
      size_q <= s_swap_size;
      force_q <= s_swap_force;
      shutdown_limit_q <= shutdown_limit == 32'd0 ? `CCHIP_SHUTDOWN_LIMIT_DEFAULT : shutdown_limit;
      memory_limit_q <= memory_limit == 32'd0 ? `CCHIP_MEMORY_LIMIT_DEFAULT : memory_limit;
    end
    if (accept) refuse_slot_q <= s_swap_slot;
    if (accept) refuse_module_q <= s_swap_module;
  end

  // ---- the slot
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
  genvar s;
  generate
    for (s = 0; s < SLOTS; s = s + 1) begin : gen_slot
      assign slots[24*s+:24] = {lost[16*s+:16], region_rm_id[8*s+:8]};
    end
  endgenerate

  reg [SLOTS-1:0] mine_q;  // one-hot
  reg [7:0] rm_id_q;
  reg [15:0] slot_lost_q, lost_q;
  reg quiet_q, decoupled_q, roc_busy_q;
  always @(posedge clk) begin
    if (begins) mine_q <= one_hot(s_swap_slot);
    {slot_lost_q, rm_id_q} <= choose(slots, mine_q);
    quiet_q <= |(quiet & mine_q);
    decoupled_q <= |(decoupled & mine_q);
    roc_busy_q <= |(roc_busy & mine_q);
  end

  // ---- what is wrong with the request
  reg illegal_q, same_q;
  wire [31:0] last_byte = address_q + size_q - 32'd1;
  always @(posedge clk) begin
    illegal_q <= {24'd0, slot_q} >= SLOT_COUNT | module_q > `CCHIP_RM_QUAD_QUAD | size_q == 32'd0
                 | address_q[5:0] != 6'd0 | last_byte < address_q;
    same_q <= ~decoupled_q & rm_id_q == module_q;
  end

  // ---- sequence: next phase, and the code if it is REPORT
  reg [31:0] clocks_q;  // in this phase
  reg [3:0] step_q;  // the same, up to 15
  reg expired_q, error_q, forced_q, abort_q;
  reg [3:0] alike_q;  // clocks on which the region showed the module asked for: garbage may show it on one by chance
  wire roc_over = phase_q == `CCHIP_PHASE_ROC & step_q >= ROC_SEEN & ~roc_busy_q;
  reg [3:0] phase_d, code_d;
  wire past = phase_q >= `CCHIP_PHASE_DECOUPLE;  // the slot is no longer at work
  wire abortable = ~idle & phase_q <= `CCHIP_PHASE_ROC;
  wire [3:0] fetch_code = bus_error ? `CCHIP_SWAP_BUS : `CCHIP_SWAP_MEMORY;

  always @* begin
    phase_d = phase_q;
    code_d  = `CCHIP_SWAP_OK;
    case (phase_q)
      `CCHIP_PHASE_IDLE: if (begins) phase_d = `CCHIP_PHASE_HEADER;
      `CCHIP_PHASE_HEADER:
      if (step_q == DECIDE) begin
        if (illegal_q | same_q | owes) phase_d = `CCHIP_PHASE_REPORT;
        code_d = illegal_q ? `CCHIP_SWAP_REQUEST : same_q ? `CCHIP_SWAP_SAME : `CCHIP_SWAP_MEMORY;
      end else if (bus_error | timeout) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = fetch_code;
      end else if (header_done) begin
        phase_d = header_ok ? `CCHIP_PHASE_SHUTDOWN : `CCHIP_PHASE_REPORT;
        code_d  = header_code;
      end
      `CCHIP_PHASE_SHUTDOWN:
      if (quiet_q | decoupled_q | (expired_q & force_q)) phase_d = `CCHIP_PHASE_DECOUPLE;
      else if (expired_q) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = `CCHIP_SWAP_SHUTDOWN;
      end
      `CCHIP_PHASE_DECOUPLE:
      if (decoupled_q) phase_d = `CCHIP_PHASE_RESET;
      else if (expired_q) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = `CCHIP_SWAP_DEVICE;
      end
      `CCHIP_PHASE_RESET: if (step_q == RESET_LAST) phase_d = `CCHIP_PHASE_TRANSFER;
      `CCHIP_PHASE_TRANSFER:
      if (error_q | bus_error | timeout) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = error_q ? `CCHIP_SWAP_DEVICE : fetch_code;
      end else if (transfer_done) phase_d = `CCHIP_PHASE_CHECK;
      `CCHIP_PHASE_CHECK:
      if (error_q | step_q == CHECK_LAST) begin
        phase_d = error_q | ~crc_ok ? `CCHIP_PHASE_REPORT : `CCHIP_PHASE_ROC;
        code_d  = error_q ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_CRC;
      end
      `CCHIP_PHASE_ROC:
      if (roc_over & (rm_id_q != module_q | alike_q == 4'd15)) begin
        phase_d = rm_id_q == module_q ? `CCHIP_PHASE_RECOUPLE : `CCHIP_PHASE_REPORT;
        code_d  = `CCHIP_SWAP_WRONG_MODULE;
      end else if (expired_q & roc_busy_q) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = `CCHIP_SWAP_DEVICE;
      end
      `CCHIP_PHASE_RECOUPLE:
      if (step_q >= RECOUPLE_SEEN & (~decoupled_q | expired_q)) begin
        phase_d = `CCHIP_PHASE_REPORT;
        code_d  = decoupled_q ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_OK;
      end
      default: phase_d = `CCHIP_PHASE_IDLE;
    endcase
    if (abort_q & abortable & (decoupled_q | expired_q | phase_q != `CCHIP_PHASE_DECOUPLE)) begin
      phase_d = `CCHIP_PHASE_REPORT;
      code_d  = `CCHIP_SWAP_ABORTED;
    end
  end

  wire enter = phase_d != phase_q;
  wire reports = enter & phase_d == `CCHIP_PHASE_REPORT;
  wire fails = reports & past & code_d != `CCHIP_SWAP_OK;
  wire refuses = refuse_q & ~reports;
  wire [SLOTS-1:0] mine_if_transfer = enter & phase_d == `CCHIP_PHASE_TRANSFER ? mine_q : {SLOTS{1'b0}};
  wire [SLOTS-1:0] mine_if_recouple = enter & phase_d == `CCHIP_PHASE_RECOUPLE ? mine_q : {SLOTS{1'b0}};
  wire [SLOTS-1:0] mine_if_fails = fails ? mine_q : {SLOTS{1'b0}};
  wire gone = phase_q == `CCHIP_PHASE_DECOUPLE & decoupled_q & forced_q;
  wire [15:0] lost_d = gone ? slot_lost_q : lost_q;

  // ---- what the slots are told
  reg [SLOTS-1:0] stop_q, decouple_q, hold_reset_q, roc_start_q;
  reg [SLOTS-1:0] half_q;  // the region holds no whole module
  initial half_q = {SLOTS{1'b0}};
  always @(posedge clk) begin
    if (~rst) half_q <= (half_q | mine_if_transfer) & ~mine_if_recouple;
    if (rst) begin
      stop_q       <= half_q;
      decouple_q   <= half_q;
      hold_reset_q <= half_q;
      roc_start_q  <= {SLOTS{1'b0}};
    end else begin
      if (enter & phase_d == `CCHIP_PHASE_SHUTDOWN) stop_q <= stop_q | mine_q;
      else if (reports) stop_q <= decouple_q | mine_if_fails;
      if (enter & phase_d == `CCHIP_PHASE_DECOUPLE) decouple_q <= decouple_q | mine_q;
      else if (phase_q == `CCHIP_PHASE_RECOUPLE & step_q == RECOUPLE_AT) decouple_q <= decouple_q & ~mine_q;
      else decouple_q <= decouple_q | mine_if_fails;
      if (enter & phase_d == `CCHIP_PHASE_RESET) hold_reset_q <= hold_reset_q | mine_q;
      else hold_reset_q <= (hold_reset_q | mine_if_fails) & ~mine_if_recouple;
      roc_start_q <= enter & phase_d == `CCHIP_PHASE_ROC ? mine_q : {SLOTS{1'b0}};
    end
  end

  // ---- phase and report
  reg run_q;  // the fetch works
  reg report_valid_q;
  reg [7:0] report_slot_q, report_module_q;
  reg [3:0] report_code_q;
  reg [15:0] report_lost_q;
  always @(posedge clk) begin
    clocks_q <= enter ? 32'd1 : clocks_q + 32'd1;
    step_q <= enter ? 4'd0 : step_q == 4'd15 ? 4'd15 : step_q + 4'd1;
    expired_q <= ~enter & (expired_q | clocks_q == (phase_q == `CCHIP_PHASE_SHUTDOWN ? shutdown_limit_q : LIMIT));
    error_q <= cfg_error & (phase_q == `CCHIP_PHASE_TRANSFER | phase_q == `CCHIP_PHASE_CHECK);
    abort_q <= ~idle & ~reports & (abort_q | abort_swap);
    forced_q <= ~idle & (forced_q | (phase_q == `CCHIP_PHASE_SHUTDOWN & expired_q & ~quiet_q));
    alike_q <= roc_over ? alike_q + 4'd1 : 4'd0;
    lost_q <= begins ? 16'd0 : lost_d;
    if (reports | refuse_q) begin
      report_slot_q   <= reports ? slot_q : refuse_slot_q;
      report_module_q <= reports ? module_q : refuse_module_q;
      report_code_q   <= reports ? code_d : `CCHIP_SWAP_BUSY;
      report_lost_q   <= reports ? lost_d : 16'd0;
    end
    if (rst) begin
      phase_q <= `CCHIP_PHASE_IDLE;
      ready_q <= 1'b0;
      refuse_q <= 1'b0;
      run_q <= 1'b0;
      report_valid_q <= 1'b0;
    end else begin
      phase_q <= phase_d;
      ready_q <= ~(accept & ~idle) & ~(refuse_q & reports);
      refuse_q <= (accept & ~idle) | (refuse_q & reports);
      run_q <= (run_q | enter | step_q == DECIDE)
               & (phase_d == `CCHIP_PHASE_TRANSFER | (phase_d == `CCHIP_PHASE_HEADER & ~enter));
      report_valid_q <= reports | refuses;
    end
  end

  assign s_swap_ready = ready_q;
  assign m_report_valid = report_valid_q;
  assign m_report_slot = report_slot_q;
  assign m_report_module = report_module_q;
  assign m_report_code = report_code_q;
  assign m_report_lost = report_lost_q;
  assign stop = stop_q;
  assign decouple = decouple_q;
  assign hold_reset = hold_reset_q;
  assign roc_start = roc_start_q;
  assign phase = phase_q;
  assign slot = slot_q;
  assign module_id = module_q;
  assign address = address_q;
  assign size = size_q;
  assign limit = memory_limit_q;
  assign run = run_q;

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_order, (hold_reset_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_stopped, (decouple_q & ~stop_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_half, (half_q & ~hold_reset_q) == {SLOTS{1'b0}})
    end

endmodule
`default_nettype wire
