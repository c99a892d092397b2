// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_sequencer: the state machine of a swap: requests, phases and reports of
// cchip_config_controller, and what the slots are told in them.
//   order        HEADER, SHUTDOWN, DECOUPLE, RESET, TRANSFER, CHECK, ROC, RECOUPLE, REPORT. A
//                failure before DECOUPLE leaves the slot at work, a failure from there on leaves it
//                stopped, decoupled and in reset.
//   reset on configuration   hold_reset falls as roc_start rises, so the only reset that the new
//                module gets once it is whole is that of the slot's ROC generator. rm_id counts
//                from CCHIP_RM_SETTLE_CLOCKS clocks after that reset on, and must then be right for
//                as many clocks: a region full of garbage may show any number on one clock.
//   decision     whether a state ends, well or badly, is a register. Next state, clocks and slots
//                follow from it a clock later, on which nothing else is decided.
//   latency      every request is answered by exactly one report; one during a swap by BUSY, 2
//                clocks later or 3
//   bounds       SHUTDOWN: shutdown_limit; DECOUPLE, ROC, RECOUPLE: SLOT_LIMIT; HEADER and
//                TRANSFER: error or timeout of the fetch, or their words are there; the rest: fixed
//   limit        shutdown_limit: 1..2^32 - 1 clocks; 0 means CCHIP_SHUTDOWN_LIMIT_DEFAULT. It may
//                change on any clock: a lower one that has passed already ends SHUTDOWN 4 clocks
//                after the change, a higher one, or 0, gives more time
//   clocks       cfg_error may come from any clock: it passes two flip-flops. Everything else
//                belongs to clk.
//   cuts         every path: each output is a flip-flop, m_report_data one of two
//   reset        no swap, slots at work, except one whose transfer had begun and not ended well:
//                half_q outlives rst and keeps it stopped, decoupled and in reset until a good
//                transfer. Its value at power-up is an initial value, because no reset can tell a
//                power-up, after which every slot holds a whole module, from a reset in the middle
//                of a transfer.
module cchip_swap_sequencer #(
    // slots, 1..4
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
    input  wire [                         31:0] shutdown_limit,   // clocks; 0: default
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
    output wire [                         31:0] phase_clocks,     // in this phase, 1 on the first
    output wire                                 busy,             // a phase other than IDLE
    output wire [         `CCHIP_SLOT_ID_W-1:0] slot,             // of the request
    output wire [           `CCHIP_RM_ID_W-1:0] module_id,
    output wire [                         31:0] address,
    output wire [                         31:0] size,
    // the fetch works, in HEADER and in TRANSFER
    output wire                                 run,
    input  wire                                 header_done,
    input  wire                                 header_ok,
    input  wire [            `CCHIP_SWAP_W-1:0] header_code,
    input  wire                                 outstanding,
    input  wire                                 bus_error,
    input  wire                                 timeout,
    input  wire                                 transfer_done,
    input  wire                                 crc_ok,
    input  wire                                 cfg_error
);

  // states, one bit each; each leads to the next one, the last to the first, a failure to REPORT
  localparam integer IDLE = 0;
  localparam integer JUDGE = 1;  // phase HEADER
  localparam integer FETCH = 2;  // HEADER
  localparam integer SHUTDOWN = 3;
  localparam integer DECOUPLE = 4;
  localparam integer RESET = 5;
  localparam integer TRANSFER = 6;
  localparam integer CHECK = 7;
  localparam integer PULSE = 8;  // ROC
  localparam integer PULSED = 9;  // ROC
  localparam integer SETTLE = 10;  // ROC
  localparam integer MATCH = 11;  // ROC
  localparam integer RECOUPLE = 12;
  localparam integer REPORT = 13;
  localparam integer STATES = 14;
  localparam [STATES-1:0] ABORTABLE =
      ~(14'd1 << IDLE | 14'd1 << DECOUPLE | 14'd1 << RECOUPLE | 14'd1 << REPORT);
  // the next state is in the same phase
  localparam [STATES-1:0] SAME_PHASE =
      14'd1 << JUDGE | 14'd1 << PULSE | 14'd1 << PULSED | 14'd1 << SETTLE;

  // the clock of a state on which it is decided, from 0; the next state begins 2 clocks later
  localparam [4:0] JUDGE_LAST = 5'd2;  // slot and request have passed their registers
  localparam [4:0] ERROR_FIRST = 5'd2;  // of TRANSFER: cfg_error of an earlier clock is over
  localparam [4:0] CHECK_LAST = 5'd7;  // the device may report an error until here
  localparam [4:0] SETTLE_LAST = `CCHIP_RM_SETTLE_CLOCKS - 4;
  localparam [4:0] MATCH_LAST = `CCHIP_RM_SETTLE_CLOCKS - 1;
  localparam [31:0] LIMIT = SLOT_LIMIT;

  generate
    if (SLOTS < 1 || SLOTS > 4) begin : gen_illegal
      cchip_error_SLOTS_must_be_1_to_4 u_error ();
    end
    if (SLOT_LIMIT < 16) begin : gen_illegal_limit
      cchip_error_SLOT_LIMIT_below_16 u_error ();
    end
  endgenerate

  reg [`CCHIP_PHASE_W-1:0] phase_q;
  reg [STATES-1:0] at_q;  // one-hot
  wire idle = at_q[IDLE];

  // ---- request; one that comes during a swap waits in the refusal for a clock without report
  reg ready_q, refuse_q;
  reg [`CCHIP_SLOT_ID_W-1:0] slot_q, refuse_slot_q;
  reg [`CCHIP_RM_ID_W-1:0] module_q, refuse_module_q;
  reg [31:0] address_q, size_q;
  reg force_q;
  wire [`CCHIP_SLOT_ID_W-1:0] s_swap_slot;
  wire [`CCHIP_RM_ID_W-1:0] s_swap_module;
  wire [31:0] s_swap_address, s_swap_size;
  wire s_swap_force;
  assign `CCHIP_SWAP_REQUEST_OF(s_swap_slot, s_swap_module, s_swap_address, s_swap_size,
      s_swap_force) = s_swap_data;
  wire accept = s_swap_valid & ready_q;
  wire begins = accept & idle;

  reg [SLOTS-1:0] mine_q;  // its slot, one-hot; 0 if there is no such slot
  integer s;
  always @(posedge clk) begin
    if (begins) begin
      for (s = 0; s < SLOTS; s = s + 1) mine_q[s] <= s_swap_slot == s[`CCHIP_SLOT_ID_W-1:0];
      slot_q <= s_swap_slot;
      module_q <= s_swap_module;
      address_q <= s_swap_address;
      size_q <= s_swap_size;
      force_q <= s_swap_force;
    end
    if (accept) refuse_slot_q <= s_swap_slot;
    if (accept) refuse_module_q <= s_swap_module;
  end

  // ---- the slot of the request, through registers
  reg [`CCHIP_RM_ID_W-1:0] shown;
  reg [`CCHIP_PAIR_COUNT_W-1:0] given_up;
  integer i;
  always @(*) begin
    shown = {`CCHIP_RM_ID_W{1'b0}};
    given_up = {`CCHIP_PAIR_COUNT_W{1'b0}};
    for (i = 0; i < SLOTS; i = i + 1) begin
      shown = shown
          | (region_rm_id[`CCHIP_RM_ID_W*i+:`CCHIP_RM_ID_W] & {`CCHIP_RM_ID_W{mine_q[i]}});
      given_up = given_up
          | (lost[`CCHIP_PAIR_COUNT_W*i+:`CCHIP_PAIR_COUNT_W] & {`CCHIP_PAIR_COUNT_W{mine_q[i]}});
    end
  end

  reg quiet_q, decoupled_q, roc_busy_q, match_q;  // match: the region shows the module asked for
  reg same_q, illegal_q;
  wire [32:0] past = {1'b0, address_q} + {1'b0, size_q};  // the byte behind the file
  reg over_q;  // it lies beyond 4 GiB, unless its lower 32 bits, of which rest_q knows, are 0
  reg [3:0] rest_q;
  (* ASYNC_REG = "TRUE" *) reg [1:0] cfg_error_q;
  reg cfg_error_q3;  // a clock later, so that CHECK sees that of TRANSFER's last clock
  always @(posedge clk) begin
    quiet_q <= |(quiet & mine_q);
    decoupled_q <= |(decoupled & mine_q);
    roc_busy_q <= |(roc_busy & mine_q);
    match_q <= shown == module_q;
    same_q <= ~decoupled_q & match_q;
    over_q <= past[32];
    rest_q <= {|past[31:24], |past[23:16], |past[15:8], |past[7:0]};
    illegal_q <= mine_q == {SLOTS{1'b0}} || module_q > `CCHIP_RM_QUAD_QUAD
        || address_q[5:0] != 6'd0 || size_q == 32'd0 || (over_q && rest_q != 4'd0);
    cfg_error_q <= {cfg_error_q[0], cfg_error};
    cfg_error_q3 <= cfg_error_q[1];
  end

  // ---- clocks of the phase and of the state, and the bound of the phase
  wire moves;  // to another state
  wire turns;  // to another phase
  wire [31:0] clocks;
  wire shutdown_expired;
  reg [4:0] ticks_q;  // stops at 31
  reg last_q;  // the clock on which a state of fixed length is decided
  reg error_counts_q;  // of TRANSFER: cfg_error of an earlier clock is over
  reg expired_q;  // SLOT_LIMIT
  cchip_timeout #(
      .DEFAULT(`CCHIP_SHUTDOWN_LIMIT_DEFAULT)
  ) u_shutdown (
      .clk    (clk),
      .restart(turns),
      .limit  (shutdown_limit),
      .elapsed(clocks),
      .expired(shutdown_expired)
  );
  always @(posedge clk) begin
    ticks_q <= moves ? 5'd0 : ticks_q + {4'd0, ~&ticks_q};
    last_q <= !moves && ((at_q[JUDGE] && ticks_q == JUDGE_LAST - 5'd1)
        || (at_q[CHECK] && ticks_q == CHECK_LAST - 5'd1)
        || (at_q[SETTLE] && ticks_q == SETTLE_LAST - 5'd1)
        || (at_q[MATCH] && ticks_q == MATCH_LAST - 5'd1));
    error_counts_q <= !moves && ticks_q >= ERROR_FIRST - 5'd1;
    expired_q <= !turns && clocks >= LIMIT;
  end

  // ---- abort: kept until a state takes notice, dropped with the swap
  reg abort_q;

  // ---- states: what ends them well or badly, with which code, in which phase the next one is
  reg [STATES-1:0] done, fails;
  reg [`CCHIP_SWAP_W-1:0] code;  // of the failure of the state
  reg [`CCHIP_PHASE_W-1:0] phase_after;  // of the state behind this one

  always @(*) begin
    done = {STATES{1'b0}};
    fails = {STATES{1'b0}};
    code = `CCHIP_SWAP_OK;
    phase_after = `CCHIP_PHASE_IDLE;

    if (at_q[IDLE]) phase_after = phase_after | `CCHIP_PHASE_HEADER;

    done[JUDGE] = last_q;
    fails[JUDGE] = last_q & (illegal_q | same_q | outstanding);
    if (at_q[JUDGE]) begin
      code = code
          | (illegal_q ? `CCHIP_SWAP_REQUEST : same_q ? `CCHIP_SWAP_SAME : `CCHIP_SWAP_OWED);
      phase_after = phase_after | `CCHIP_PHASE_HEADER;
    end

    done[FETCH] = header_done;
    fails[FETCH] = bus_error | timeout | (header_done & ~header_ok);
    if (at_q[FETCH]) begin
      code = code | (bus_error ? `CCHIP_SWAP_BUS : timeout ? `CCHIP_SWAP_MEMORY : header_code);
      phase_after = phase_after | `CCHIP_PHASE_SHUTDOWN;
    end

    done[SHUTDOWN] = quiet_q | decoupled_q | (shutdown_expired & force_q);
    fails[SHUTDOWN] = shutdown_expired & ~(quiet_q | decoupled_q | force_q);
    if (at_q[SHUTDOWN]) begin
      code = code | `CCHIP_SWAP_SHUTDOWN;
      phase_after = phase_after | `CCHIP_PHASE_DECOUPLE;
    end

    // never aborted: the number of pairs given up is known only at its end
    done[DECOUPLE] = decoupled_q;
    fails[DECOUPLE] = expired_q & ~decoupled_q;
    if (at_q[DECOUPLE]) begin
      code = code | `CCHIP_SWAP_DEVICE;
      phase_after = phase_after | `CCHIP_PHASE_RESET;
    end

    done[RESET] = 1'b1;  // two clocks
    if (at_q[RESET]) phase_after = phase_after | `CCHIP_PHASE_TRANSFER;

    done[TRANSFER] = transfer_done;
    fails[TRANSFER] = bus_error | timeout | (cfg_error_q[1] & error_counts_q);
    if (at_q[TRANSFER]) begin
      code = code
          | (bus_error ? `CCHIP_SWAP_BUS : timeout ? `CCHIP_SWAP_MEMORY : `CCHIP_SWAP_DEVICE);
      phase_after = phase_after | `CCHIP_PHASE_CHECK;
    end

    done[CHECK] = last_q;
    fails[CHECK] = cfg_error_q[1] | cfg_error_q3 | (last_q & ~crc_ok);
    if (at_q[CHECK]) begin
      code = code | (cfg_error_q[1] | cfg_error_q3 ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_CRC);
      phase_after = phase_after | `CCHIP_PHASE_ROC;
    end

    done[PULSE] = 1'b1;  // two clocks, then roc_busy is seen
    if (at_q[PULSE]) phase_after = phase_after | `CCHIP_PHASE_ROC;

    done[PULSED] = ~roc_busy_q;
    fails[PULSED] = expired_q & roc_busy_q;
    if (at_q[PULSED]) begin
      code = code | `CCHIP_SWAP_DEVICE;
      phase_after = phase_after | `CCHIP_PHASE_ROC;
    end

    done[SETTLE] = last_q;
    if (at_q[SETTLE]) phase_after = phase_after | `CCHIP_PHASE_ROC;

    done[MATCH] = last_q;
    fails[MATCH] = ~match_q;
    if (at_q[MATCH]) begin
      code = code | `CCHIP_SWAP_WRONG_MODULE;
      phase_after = phase_after | `CCHIP_PHASE_RECOUPLE;
    end

    done[RECOUPLE] = ~decoupled_q;
    fails[RECOUPLE] = expired_q & decoupled_q;
    if (at_q[RECOUPLE]) begin
      code = code | `CCHIP_SWAP_DEVICE;
      phase_after = phase_after | `CCHIP_PHASE_REPORT;
    end
  end

  // ---- decision, and a clock later what follows from it: that is wide, so it starts at registers.
  // IDLE and REPORT have nothing to decide.
  reg failing_q, ending_q;
  wire deciding = ~failing_q & ~ending_q;
  wire aborted = abort_q & (|(at_q & ABORTABLE));
  wire fails_now = aborted | (|(at_q & fails));
  wire goes = ending_q | begins | at_q[REPORT];
  wire [STATES-1:0] passes = at_q & {STATES{ending_q}};  // unless it fails
  wire reports = failing_q | passes[RECOUPLE];
  wire late = |at_q[RECOUPLE:DECOUPLE];  // a failure leaves the slot shut
  assign moves = failing_q | goes;
  assign turns = failing_q | (goes & ~(|(at_q & SAME_PHASE)));

  // ---- phase and report
  reg run_q, report_valid_q, refused_q, forced_q;
  reg [`CCHIP_SWAP_W-1:0] code_q;
  reg [`CCHIP_PAIR_COUNT_W-1:0] lost_q;
  wire refuses = refuse_q & ~reports;
  always @(posedge clk) begin
    if (idle) lost_q <= {`CCHIP_PAIR_COUNT_W{1'b0}};
    else if (at_q[DECOUPLE] && forced_q && decoupled_q) lost_q <= given_up;
    if (at_q[SHUTDOWN]) forced_q <= ~quiet_q & ~decoupled_q;
    if (deciding) code_q <= aborted ? `CCHIP_SWAP_ABORTED : fails_now ? code : `CCHIP_SWAP_OK;
    refused_q <= refuses;
    if (rst) begin
      at_q <= {{STATES - 1{1'b0}}, 1'b1};
      phase_q <= `CCHIP_PHASE_IDLE;
      abort_q <= 1'b0;
      run_q <= 1'b0;
      ready_q <= 1'b0;
      refuse_q <= 1'b0;
      report_valid_q <= 1'b0;
      failing_q <= 1'b0;
      ending_q <= 1'b0;
    end else begin
      failing_q <= deciding & fails_now;
      ending_q <= deciding & (|(at_q & done));
      if (failing_q) begin
        at_q <= {1'b1, {STATES - 1{1'b0}}};
        phase_q <= `CCHIP_PHASE_REPORT;
      end else if (goes) begin
        at_q <= {at_q[STATES-2:0], at_q[REPORT]};
        phase_q <= phase_after;
      end
      abort_q <= (abort_q | abort_swap) & (|at_q[MATCH:JUDGE]) & ~failing_q;
      run_q <= ~failing_q & (goes ? at_q[JUDGE] | at_q[RESET] : run_q);
      refuse_q <= (accept & ~idle) | (refuse_q & reports);
      ready_q <= ~((accept & ~idle) | (refuse_q & reports));
      report_valid_q <= reports | refuses;
    end
  end

  // ---- what the slots are told
  reg [SLOTS-1:0] stop_q, decouple_q, hold_reset_q, roc_start_q;
  reg [SLOTS-1:0] half_q;  // the region holds no whole module
  initial half_q = {SLOTS{1'b0}};
  wire [SLOTS-1:0] set_stop = mine_q & {SLOTS{passes[FETCH]}};
  wire [SLOTS-1:0] set_decouple = mine_q & {SLOTS{passes[SHUTDOWN]}};
  wire [SLOTS-1:0] set_hold = mine_q & {SLOTS{passes[DECOUPLE]}};
  wire [SLOTS-1:0] transfer = mine_q & {SLOTS{passes[RESET]}};
  wire [SLOTS-1:0] start_roc = mine_q & {SLOTS{passes[CHECK]}};
  wire [SLOTS-1:0] recouple = mine_q & {SLOTS{passes[MATCH]}};
  wire [SLOTS-1:0] shut = mine_q & {SLOTS{late}};
  always @(posedge clk) begin
    if (!rst && !failing_q) half_q <= (half_q | transfer) & ~recouple;
    if (rst) begin
      stop_q       <= half_q;
      decouple_q   <= half_q;
      hold_reset_q <= half_q;
      roc_start_q  <= {SLOTS{1'b0}};
    end else if (failing_q) begin
      if (!late) stop_q <= decouple_q;
      decouple_q   <= decouple_q | shut;
      hold_reset_q <= hold_reset_q | shut;
      roc_start_q  <= {SLOTS{1'b0}};
    end else begin
      stop_q       <= passes[RECOUPLE] ? decouple_q : stop_q | set_stop;
      decouple_q   <= (decouple_q | set_decouple) & ~recouple;
      hold_reset_q <= (hold_reset_q | set_hold) & ~start_roc;
      roc_start_q  <= start_roc;
    end
  end

  assign s_swap_ready = ready_q;
  assign m_report_valid = report_valid_q;
  // slot_q, module_q and lost_q do not change in REPORT
  assign m_report_data = refused_q
      ? `CCHIP_SWAP_REPORT_OF(refuse_slot_q, refuse_module_q, `CCHIP_SWAP_BUSY,
          {`CCHIP_PAIR_COUNT_W{1'b0}})
      : `CCHIP_SWAP_REPORT_OF(slot_q, module_q, code_q, lost_q);
  assign stop = stop_q;
  assign decouple = decouple_q;
  assign hold_reset = hold_reset_q;
  assign roc_start = roc_start_q;
  assign phase = phase_q;
  assign phase_clocks = clocks;
  assign busy = ~idle;
  assign slot = slot_q;
  assign module_id = module_q;
  assign address = address_q;
  assign size = size_q;
  assign run = run_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_one, at_q != {STATES{1'b0}} && (at_q & (at_q - 14'd1)) == {STATES{1'b0}})
      `CCHIP_ASSERT(a_order, (hold_reset_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_stopped, (decouple_q & ~stop_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_half, (half_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_roc, (roc_start_q & hold_reset_q) == {SLOTS{1'b0}})
    end

endmodule
`default_nettype wire
