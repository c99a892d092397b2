// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_sequencer: the state machine of a swap: requests, phases and reports of
// cchip_config_controller, and what the slots are told in them.
//   order        HEADER, SHUTDOWN, DECOUPLE, RESET, TRANSFER, CHECK, ROC, RECOUPLE, REPORT. A
//                failure before DECOUPLE leaves the slot active, a failure from there on leaves it
//                stopped, decoupled and in reset.
//   reset on configuration   hold_reset falls as roc_start rises, so the only reset that the new
//                module gets once it is whole is that of the slot's ROC generator. rm_id counts
//                from CCHIP_RM_SETTLE_CLOCKS clocks after that reset on, and must then be right for
//                as many clocks: a region full of garbage may show any number on one clock.
//   decision     whether a state ends, well or badly, is a register. Next state, clocks and slots
//                follow from it a clock later, on which nothing else is decided.
//   latency      every request is answered by exactly one report; one that is offered during a swap
//                is taken 2 clocks after the report of that swap
//   bounds       SHUTDOWN: shutdown_limit; DECOUPLE, ROC, RECOUPLE: SLOT_LIMIT; HEADER and
//                TRANSFER: error or timeout of the fetch, or their words are there; the rest: fixed
//   limit        shutdown_limit: 1..2^32 - 1 clocks; 0 means CCHIP_SHUTDOWN_LIMIT_DEFAULT. It may
//                change on any clock: a lower one that has passed already ends SHUTDOWN 4 clocks
//                after the change, a higher one, or 0, gives more time
//   clocks       cfg_error may come from any clock: it passes two flip-flops. Everything else
//                belongs to clk.
//   reset        no swap, slots active, except one whose transfer had begun and not ended well
//                (cchip_swap_signals)
module cchip_swap_sequencer #(
    parameter integer SLOTS = 1,         // slots; legal: 1..4
    // longest wait for a slot to decouple, to end its reset on configuration, to recouple (clock);
    // legal: >= 16
    parameter integer SLOT_LIMIT = 4096
) (
    input  wire                                 clk,             // clock, rising edge
    input  wire                                 rst,             // synchronous reset, active high
    input  wire                                 s_swap_valid,    // a swap is requested
    // the request is taken if s_swap_valid = 1 as well; 0 during a swap
    output wire                                 s_swap_ready,
    // the request: record SWAP_REQUEST, docs/hardware/definitions.md
    input  wire [    `CCHIP_SWAP_REQUEST_W-1:0] s_swap_data,
    // 1 for one clock: a report; there is no ready
    output wire                                 m_report_valid,
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    output wire [     `CCHIP_SWAP_REPORT_W-1:0] m_report_data,
    // 1: abort the swap in progress; ignored without one and from RECOUPLE on
    input  wire                                 abort_swap,
    // longest wait for the pairs inside: 1..2^32 - 1 clocks; 0: CCHIP_SHUTDOWN_LIMIT_DEFAULT
    input  wire [                         31:0] shutdown_limit,
    output wire [                    SLOTS-1:0] stop,            // per slot: accept no more pairs
    // per slot: outputs of the region become constants
    output wire [                    SLOTS-1:0] decouple,
    output wire [                    SLOTS-1:0] hold_reset,      // per slot: the region is in reset
    // per slot: 1 for one clock starts the reset on configuration
    output wire [                    SLOTS-1:0] roc_start,
    // per slot: stop is in force and every accepted pair was answered
    input  wire [                    SLOTS-1:0] quiet,
    input  wire [                    SLOTS-1:0] decoupled,       // per slot: it is decoupled
    // per slot: reset on configuration in progress, from the clock after roc_start on
    input  wire [                    SLOTS-1:0] roc_busy,
    // per slot: module in the region, behind no gate
    input  wire [     `CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id,
    // per slot: pairs lost by decoupling it; read when decoupled rises
    input  wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] lost,
    output wire [           `CCHIP_PHASE_W-1:0] phase,           // its phase, SwapPhase
    // clocks in this phase, 1 on its first
    output wire [                         31:0] phase_clocks,
    output wire                                 busy,            // the phase is not IDLE
    output wire [         `CCHIP_SLOT_ID_W-1:0] slot,            // of the request
    output wire [           `CCHIP_RM_ID_W-1:0] module_id,       // of the request
    output wire [                         31:0] address,         // of the request
    output wire [                         31:0] size,            // of the request
    output wire                                 run,  // the fetch works, in HEADER and TRANSFER
    input  wire                                 header_done,     // the header is here and judged
    input  wire                                 header_ok,       // it is right
    input  wire [            `CCHIP_SWAP_W-1:0] header_code,     // what is wrong with it
    // an address is not taken yet or beats are to come
    input  wire                                 outstanding,
    input  wire                                 bus_error,       // error on the bus, until run = 0
    // limit clocks without an address taken or a beat, until run = 0
    input  wire                                 timeout,
    input  wire                                 transfer_done,   // the payload has passed the port
    input  wire                                 crc_ok,          // its CRC is right
    // the device reports an error, from any clock: a level, or a pulse of at least two clocks of
    // clk, as it passes two flip-flops and a shorter one may be lost; looked at during TRANSFER and
    // CHECK
    input  wire                                 cfg_error
);

  // states; a failure of any of them leads to REPORT
  localparam [3:0] IDLE = 4'd0;
  localparam [3:0] JUDGE = 4'd1;  // phase HEADER
  localparam [3:0] FETCH = 4'd2;  // HEADER
  localparam [3:0] SHUTDOWN = 4'd3;
  localparam [3:0] DECOUPLE = 4'd4;
  localparam [3:0] RESET = 4'd5;
  localparam [3:0] TRANSFER = 4'd6;
  localparam [3:0] CHECK = 4'd7;
  localparam [3:0] PULSE = 4'd8;  // ROC
  localparam [3:0] PULSED = 4'd9;  // ROC
  localparam [3:0] SETTLE = 4'd10;  // ROC
  localparam [3:0] MATCH = 4'd11;  // ROC
  localparam [3:0] RECOUPLE = 4'd12;
  localparam [3:0] REPORT = 4'd13;

  // the clock of a state on which it is decided, from 0; the next state begins 2 clocks later
  localparam [4:0] JUDGE_LAST = 5'd2;  // slot and request have passed their registers
  localparam [4:0] ERROR_FIRST = 5'd2;  // of TRANSFER: cfg_error of an earlier clock is over
  localparam [4:0] CHECK_LAST = 5'd7;  // the device may report an error until here
  localparam [4:0] SETTLE_LAST = `CCHIP_RM_SETTLE_CLOCKS - 4;
  localparam [4:0] MATCH_LAST = `CCHIP_RM_SETTLE_CLOCKS - 1;
  localparam [31:0] LIMIT = SLOT_LIMIT;

  `CCHIP_REFUSE(SLOTS < 1 || SLOTS > 4, cchip_error_SLOTS_must_be_1_to_4)
  `CCHIP_REFUSE(SLOT_LIMIT < 16, cchip_error_SLOT_LIMIT_below_16)

  reg [`CCHIP_PHASE_W-1:0] phase_q;
  reg [3:0] state_q;
  wire idle = state_q == IDLE;

  // ---- request
  reg ready_q;  // 1 in IDLE only
  wire begins = s_swap_valid & ready_q;
  wire forced;
  wire [SLOTS-1:0] mine;  // the request's slot, one-hot; 0 if there is no such slot
  wire [`CCHIP_PAIR_COUNT_W-1:0] given_up;
  wire quiet_q, decoupled_q, roc_busy_q, match_q, same_q, illegal_q;
  cchip_swap_request #(
      .SLOTS(SLOTS)
  ) u_request (
      .clk          (clk),
      .s_swap_data  (s_swap_data),
      .begins       (begins),
      .quiet        (quiet),
      .decoupled    (decoupled),
      .roc_busy     (roc_busy),
      .region_rm_id (region_rm_id),
      .lost         (lost),
      .slot         (slot),
      .module_id    (module_id),
      .address      (address),
      .size         (size),
      .forced       (forced),
      .mine         (mine),
      .is_quiet     (quiet_q),
      .is_decoupled (decoupled_q),
      .is_roc_busy  (roc_busy_q),
      .match        (match_q),
      .same         (same_q),
      .illegal      (illegal_q),
      .given_up     (given_up)
  );

  // ---- errors that the device reports
  (* ASYNC_REG = "TRUE" *) reg [1:0] cfg_error_q;
  reg cfg_error_q3;  // a clock later, so that CHECK sees that of TRANSFER's last clock
  always @(posedge clk) begin
    cfg_error_q  <= {cfg_error_q[0], cfg_error};
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
    last_q <= !moves && ((state_q == JUDGE && ticks_q == JUDGE_LAST - 5'd1)
        || (state_q == CHECK && ticks_q == CHECK_LAST - 5'd1)
        || (state_q == SETTLE && ticks_q == SETTLE_LAST - 5'd1)
        || (state_q == MATCH && ticks_q == MATCH_LAST - 5'd1));
    error_counts_q <= !moves && ticks_q >= ERROR_FIRST - 5'd1;
    expired_q <= !turns && clocks >= LIMIT;
  end

  // ---- states: what ends each of them well or badly, with which code, and what follows
  reg done, fails;
  reg [`CCHIP_SWAP_W-1:0] code;  // of its failure
  reg [3:0] next;
  reg [`CCHIP_PHASE_W-1:0] next_phase;
  reg same_phase;  // the next state is in the same phase
  reg abortable;
  reg shut;  // a failure leaves the slot shut
  wire fetch_fails = bus_error | timeout;
  wire [`CCHIP_SWAP_W-1:0] fetch_code = bus_error ? `CCHIP_SWAP_BUS : `CCHIP_SWAP_MEMORY;
  always @(*) begin
    done       = 1'b0;
    fails      = 1'b0;
    code       = `CCHIP_SWAP_OK;
    same_phase = 1'b0;
    abortable  = 1'b1;
    shut       = 1'b0;
    case (state_q)
      IDLE: begin
        abortable  = 1'b0;
        next       = JUDGE;
        next_phase = `CCHIP_PHASE_HEADER;
      end
      JUDGE: begin
        done       = last_q;
        fails      = last_q & (illegal_q | same_q | outstanding);
        code       = illegal_q ? `CCHIP_SWAP_REQUEST : same_q ? `CCHIP_SWAP_SAME : `CCHIP_SWAP_OWED;
        next       = FETCH;
        next_phase = `CCHIP_PHASE_HEADER;
        same_phase = 1'b1;
      end
      FETCH: begin
        done       = header_done;
        fails      = fetch_fails | (header_done & ~header_ok);
        code       = fetch_fails ? fetch_code : header_code;
        next       = SHUTDOWN;
        next_phase = `CCHIP_PHASE_SHUTDOWN;
      end
      SHUTDOWN: begin
        done       = quiet_q | decoupled_q | (shutdown_expired & forced);
        fails      = shutdown_expired & ~(quiet_q | decoupled_q | forced);
        code       = `CCHIP_SWAP_SHUTDOWN;
        next       = DECOUPLE;
        next_phase = `CCHIP_PHASE_DECOUPLE;
      end
      DECOUPLE: begin
        done       = decoupled_q;
        fails      = expired_q & ~decoupled_q;
        code       = `CCHIP_SWAP_DEVICE;
        abortable  = 1'b0;  // the number of pairs given up is known only at its end
        shut       = 1'b1;
        next       = RESET;
        next_phase = `CCHIP_PHASE_RESET;
      end
      RESET: begin
        done       = 1'b1;  // two clocks
        shut       = 1'b1;
        next       = TRANSFER;
        next_phase = `CCHIP_PHASE_TRANSFER;
      end
      TRANSFER: begin
        done       = transfer_done;
        fails      = fetch_fails | (cfg_error_q[1] & error_counts_q);
        code       = fetch_fails ? fetch_code : `CCHIP_SWAP_DEVICE;
        shut       = 1'b1;
        next       = CHECK;
        next_phase = `CCHIP_PHASE_CHECK;
      end
      CHECK: begin
        done       = last_q;
        fails      = cfg_error_q[1] | cfg_error_q3 | (last_q & ~crc_ok);
        code       = cfg_error_q[1] | cfg_error_q3 ? `CCHIP_SWAP_DEVICE : `CCHIP_SWAP_CRC;
        shut       = 1'b1;
        next       = PULSE;
        next_phase = `CCHIP_PHASE_ROC;
      end
      PULSE: begin
        done       = 1'b1;  // two clocks, then roc_busy is seen
        shut       = 1'b1;
        next       = PULSED;
        next_phase = `CCHIP_PHASE_ROC;
        same_phase = 1'b1;
      end
      PULSED: begin
        done       = ~roc_busy_q;
        fails      = expired_q & roc_busy_q;
        code       = `CCHIP_SWAP_DEVICE;
        shut       = 1'b1;
        next       = SETTLE;
        next_phase = `CCHIP_PHASE_ROC;
        same_phase = 1'b1;
      end
      SETTLE: begin
        done       = last_q;
        shut       = 1'b1;
        next       = MATCH;
        next_phase = `CCHIP_PHASE_ROC;
        same_phase = 1'b1;
      end
      MATCH: begin
        done       = last_q;
        fails      = ~match_q;
        code       = `CCHIP_SWAP_WRONG_MODULE;
        shut       = 1'b1;
        next       = RECOUPLE;
        next_phase = `CCHIP_PHASE_RECOUPLE;
      end
      RECOUPLE: begin
        done       = ~decoupled_q;
        fails      = expired_q & decoupled_q;
        code       = `CCHIP_SWAP_DEVICE;
        abortable  = 1'b0;
        shut       = 1'b1;
        next       = REPORT;
        next_phase = `CCHIP_PHASE_REPORT;
      end
      default: begin  // REPORT
        abortable  = 1'b0;
        next       = IDLE;
        next_phase = `CCHIP_PHASE_IDLE;
      end
    endcase
  end

  // ---- decision, and a clock later what follows from it: that is wide, so it starts at registers.
  // IDLE and REPORT have nothing to decide.
  reg failing_q, ending_q;
  wire deciding = ~failing_q & ~ending_q;
  reg abort_q;  // kept until a state takes notice, dropped with the swap
  wire aborted = abort_q & abortable;
  wire leaves = ending_q | begins | state_q == REPORT;  // unless it fails
  wire reports = failing_q | (ending_q && state_q == RECOUPLE);
  assign moves = failing_q | leaves;
  assign turns = failing_q | (leaves & ~same_phase);

  // ---- phase and report
  reg run_q, report_valid_q, forced_q;
  reg [`CCHIP_SWAP_W-1:0] code_q;
  reg [`CCHIP_PAIR_COUNT_W-1:0] lost_q;
  always @(posedge clk) begin
    if (idle) lost_q <= {`CCHIP_PAIR_COUNT_W{1'b0}};
    else if (state_q == DECOUPLE && forced_q && decoupled_q) lost_q <= given_up;
    if (state_q == SHUTDOWN) forced_q <= ~quiet_q & ~decoupled_q;
    if (deciding) code_q <= aborted ? `CCHIP_SWAP_ABORTED : fails ? code : `CCHIP_SWAP_OK;
    if (rst) begin
      state_q <= IDLE;
      phase_q <= `CCHIP_PHASE_IDLE;
      abort_q <= 1'b0;
      run_q <= 1'b0;
      ready_q <= 1'b0;
      report_valid_q <= 1'b0;
      failing_q <= 1'b0;
      ending_q <= 1'b0;
    end else begin
      failing_q <= deciding & (aborted | fails);
      ending_q <= deciding & done;
      if (failing_q) begin
        state_q <= REPORT;
        phase_q <= `CCHIP_PHASE_REPORT;
      end else if (leaves) begin
        state_q <= next;
        phase_q <= next_phase;
      end
      abort_q <= (abort_q | abort_swap) && state_q >= JUDGE && state_q <= MATCH && !failing_q;
      run_q <= ~failing_q & (leaves ? next == FETCH || next == TRANSFER : run_q);
      ready_q <= (idle & ~begins) | (state_q == REPORT);
      report_valid_q <= reports;
    end
  end

  // ---- what the slot is told as a state ends
  cchip_swap_signals #(
      .SLOTS(SLOTS)
  ) u_signals (
      .clk       (clk),
      .rst       (rst),
      .slot      (mine),
      .fails     (failing_q),
      .shut      (shut),
      .to_stop    (ending_q && state_q == FETCH),
      .to_decouple(ending_q && state_q == SHUTDOWN),
      .to_hold    (ending_q && state_q == DECOUPLE),
      .to_write   (ending_q && state_q == RESET),
      .to_roc     (ending_q && state_q == CHECK),
      .to_recouple(ending_q && state_q == MATCH),
      .to_work    (ending_q && state_q == RECOUPLE),
      .stop      (stop),
      .decouple  (decouple),
      .hold_reset(hold_reset),
      .roc_start (roc_start)
  );

  assign s_swap_ready = ready_q;
  assign m_report_valid = report_valid_q;
  // slot, module_id and lost_q do not change in REPORT
  assign m_report_data = `CCHIP_SWAP_REPORT_OF(slot, module_id, code_q, lost_q);
  assign phase = phase_q;
  assign phase_clocks = clocks;
  assign busy = ~idle;
  assign run = run_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_state, state_q <= REPORT)
      `CCHIP_ASSERT(a_ready, idle || !ready_q)
    end

endmodule
`default_nettype wire
