// SPDX-License-Identifier: Apache-2.0
`timescale 1ns / 1ps
`default_nettype none
`include "cchip_defs.vh"
// bench: bitstreams in memory -> cchip_config_controller -> frames of a fabric -> the slot behind
// cchip_pr_decoupler.
//   static side  what leaves cchip_pr_slot, and a neighbour in the other columns of the fabric,
//                watched on every clock
//   RTL beside   the module's RTL gets what the region gets; valid, idle and number are compared on
//                every clock on
//                which the slot is coupled, the data with each answer
//   plusargs     without_decoupler: the static side sees the region's outputs as they are;
//                without_roc: the region is
//                neither held in reset during a swap nor reset after it; seed=N
// Defined by fabric.py: FABRIC_ROWS, FABRIC_COLUMNS, FABRIC_FIRST, PERIOD (ns), PAIRS (a swap),
// GOLD (module), GOLD_MORE (parameters of it), SET_SMALL, SET_POINT or SET_TESTS.
module bench;
  `include "images.vh"

  reg clk = 1'b0, rst = 1'b1;
  always #(`PERIOD / 2) clk = ~clk;

  integer seed, clocks = 0;
  reg without_decoupler, without_roc;
  always @(posedge clk) clocks <= clocks + 1;

  // ---- memory: an address is taken at once, the first beat comes four clocks later
  reg [31:0] memory [0:MEMORY_WORDS-1];
  reg [31:0] boot_memory [0:BOOT_WORDS-1];
  wire arvalid, rready;
  wire [31:0] araddr;
  wire [7:0] arlen;
  reg rvalid = 1'b0;
  reg [31:0] read_at = 32'd0;
  reg [31:0] next_at = 32'd0;
  reg [7:0] beats = 8'd0, next_beats = 8'd0;
  reg waiting = 1'b0;
  reg [2:0] delay = 3'd0;
  wire arready = !waiting;
  always @(posedge clk) begin
    if (arvalid && arready) begin
      waiting    <= 1'b1;
      next_at    <= araddr >> 2;
      next_beats <= arlen;
      delay      <= 3'd3;
    end else if (waiting && delay != 3'd0) delay <= delay - 3'd1;
    else if (waiting && (!rvalid || (rready && beats == 8'd0))) begin
      waiting <= 1'b0;
    end
    if (waiting && delay == 3'd0 && (!rvalid || (rready && beats == 8'd0))) begin
      rvalid  <= 1'b1;
      read_at <= next_at;
      beats   <= next_beats;
    end else if (rvalid && rready) begin
      rvalid  <= beats != 8'd0;
      read_at <= read_at + 32'd1;
      beats   <= beats - 8'd1;
    end
  end

  // ---- controller
  reg swap_valid = 1'b0;
  reg [`CCHIP_SWAP_REQUEST_W-1:0] swap_data;
  wire swap_ready, report_valid, stop, decouple, decoupled, hold_reset, roc_start, roc_busy, busy;
  wire [`CCHIP_SWAP_REPORT_W-1:0] report;
  wire [`CCHIP_RM_ID_W-1:0] region_rm_id;
  wire [`CCHIP_PHASE_W-1:0] phase;
  reg [`CCHIP_PHASE_W-1:0] read_phase = `CCHIP_PHASE_TRANSFER;
  wire [31:0] read_clocks;
  wire port_valid, stall;
  wire [31:0] port_data;
  // pairs between their first vertex and their answer, as the static side counts
  integer outstanding = 0;
  reg stop_q = 1'b0;
  always @(posedge clk) stop_q <= stop;

  cchip_config_controller #(
      .CFG_W      (32),
      .CFG_DIVIDER(1)
  ) u_controller (
      .clk           (clk),
      .rst           (rst),
      .s_swap_valid  (swap_valid),
      .s_swap_ready  (swap_ready),
      .s_swap_data   (swap_data),
      .m_report_valid(report_valid),
      .m_report_data (report),
      .abort_swap    (1'b0),
      .clear         (1'b0),
      .shutdown_limit(32'd2000),
      .memory_limit  (32'd0),
      .stop          (stop),
      .decouple      (decouple),
      .hold_reset    (hold_reset),
      .roc_start     (roc_start),
      .quiet         (stop && stop_q && outstanding == 0),
      .decoupled     (decoupled),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .lost          ({`CCHIP_PAIR_COUNT_W{1'b0}}),
      .busy          (busy),
      .phase         (phase),
      .phase_slot    (),
      .m_axi_arvalid (arvalid),
      .m_axi_arready (arready),
      .m_axi_araddr  (araddr),
      .m_axi_arlen   (arlen),
      .m_axi_rvalid  (rvalid),
      .m_axi_rready  (rready),
      .m_axi_rdata   (memory[read_at]),
      .m_axi_rresp   (2'd0),
      .m_axi_rlast   (beats == 8'd0),
      .cfg_valid     (port_valid),
      .cfg_data      (port_data),
      .cfg_error     (fenced && u_slot.gen_simulation.u_virtual.error),
      .swapped       (),
      .rejected      (),
      .stall         (stall),
      .read_phase    (read_phase),
      .read_clocks   (read_clocks)
  );

  // ---- slot; until the power-up configuration has passed the bench has the port, as a flash has
  reg booting = 1'b1, boot_valid = 1'b0;
  reg [31:0] boot_data;
  wire fenced = !booting;
  wire abandon = !booting && (phase == `CCHIP_PHASE_DECOUPLE || phase == `CCHIP_PHASE_RESET);
  reg vertex_valid = 1'b0;
  reg [39:0] vertex = 40'd0;
  wire slot_valid, slot_idle;
  wire [25:0] slot_data;
  wire [7:0] slot_rm_id;
  cchip_pr_slot #(
      .COORD_W   (4),
      .CONTEXTS  (1),
      .KINDS     (4),
      .RM_ID     (0),
      .CFG_W     (32),
      .SIMULATION(1)
  ) u_slot (
      .clk           (clk),
      .rst           (rst),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .hold_reset    (hold_reset && !without_roc),
      .roc_start     (roc_start && !without_roc),
      .roc_busy      (roc_busy),
      .region_rm_id  (region_rm_id),
      .cfg_valid     (booting ? boot_valid : port_valid),
      .cfg_data      (booting ? boot_data : port_data),
      .s_vertex_valid(vertex_valid),
      .s_vertex_data (vertex),
      .m_result_valid(slot_valid),
      .m_result_data (slot_data),
      .rm_id         (slot_rm_id),
      .idle          (slot_idle)
  );

  // the region as it is, one clock behind, as a plain register would show it
  wire r_valid = u_slot.r_result_valid;
  wire [25:0] r_data = u_slot.r_result_data;
  wire [7:0] r_rm_id = u_slot.r_rm_id;
  wire r_idle = u_slot.r_idle;
  reg [35:0] raw_q = 36'd0;
  always @(posedge clk) raw_q <= {r_idle, r_rm_id, r_data, r_valid};
  wire static_valid, static_idle;
  wire [25:0] static_data;
  wire [7:0] static_rm_id;
  assign {static_idle, static_rm_id, static_data, static_valid} =
      without_decoupler ? raw_q : {slot_idle, slot_rm_id, slot_data, slot_valid};

  // ---- the RTL beside it: one of each module; their reset also on the clocks on which the region
  // is cut off, so
  //      that a region that was not reset is found
  reg [7:0] current = 8'd0;  // module that should be in the region
  reg compared = 1'b0;
  wire g_rst = u_slot.region_rst_q || decoupled;
  wire a_valid, a_idle, b_valid, b_idle;
  wire [25:0] a_data, b_data;
  wire [7:0] a_rm_id, b_rm_id;
`ifdef SET_SMALL
  localparam [7:0] A = 8'd1, B = 8'd2;
  localparam [1:0] MODE = `CCHIP_MODE_EXHAUSTIVE;
`elsif SET_TESTS
  localparam [7:0] A = 8'd4, B = 8'd1;
  localparam [1:0] MODE = `CCHIP_MODE_DIRECTED;
`else
  localparam [7:0] A = 8'd4, B = 8'd0;
  localparam [1:0] MODE = `CCHIP_MODE_EXHAUSTIVE;
`endif
  `GOLD #(
      .RM_ID   (A),
      .COORD_W (4),
      .CONTEXTS(1)
      `GOLD_MORE
  ) u_gold_a (
      .clk           (clk),
      .rst           (g_rst),
      .s_vertex_valid(u_slot.r_vertex_valid),
      .s_vertex_data (u_slot.r_vertex_data),
      .m_result_valid(a_valid),
      .m_result_data (a_data),
      .rm_id         (a_rm_id),
      .idle          (a_idle)
  );
  `GOLD #(
      .RM_ID   (B),
      .COORD_W (4),
      .CONTEXTS(1)
      `GOLD_MORE
  ) u_gold_b (
      .clk           (clk),
      .rst           (g_rst),
      .s_vertex_valid(u_slot.r_vertex_valid),
      .s_vertex_data (u_slot.r_vertex_data),
      .m_result_valid(b_valid),
      .m_result_data (b_data),
      .rm_id         (b_rm_id),
      .idle          (b_idle)
  );
  wire g_valid = current == A ? a_valid : current == B ? b_valid : 1'b0;
  wire [25:0] g_data = current == A ? a_data : b_data;
  wire g_idle = current == A ? a_idle : current == B ? b_idle : 1'b1;

  // ---- the neighbour
  reg [7:0] neighbour_in = 8'd1;
  wire [15:0] neighbour_out = u_slot.gen_simulation.u_virtual.neighbour_out;
  reg [15:0] signature = 16'd1;
  reg neighbour_runs = 1'b0;

  // ---- counts; every signal is read at a rising edge, as the next register reads it
  integer swaps = 0, pairs = 0, differences = 0, static_wrong = 0, leaked = 0, failures = 0;
  integer compared_clocks = 0, watched = 0, watched_in_swaps = 0;
  integer written = 0, x_clocks = 0, other_clocks = 0, right_clocks = 0, blank_clocks = 0,
      changes = 0;
  integer false_answers = 0;
  reg [35:0] last_raw = 36'd0;
  wire writing = u_slot.gen_simulation.u_virtual.writing;
  wire [35:0] raw = {r_idle, r_rm_id, r_data, r_valid};
  reg [7:0] target = 8'd0;  // module of the swap in flight
  reg armed = 1'b0;  // the first configuration and reset are over

  always @(posedge clk)
    if (armed) begin
      // the neighbour
      watched <= watched + 1;
      if (busy) watched_in_swaps <= watched_in_swaps + 1;
      if (neighbour_out !== signature) static_wrong <= static_wrong + 1;
      // what passes to the static side: nothing while cut off; else answers to pairs, and the
      // module's number
      if (decoupled ? {static_valid, static_data, static_rm_id, static_idle} !== {1'b0, 26'd0,
          8'd0, 1'b1}
          : (static_valid !== 1'b0 && !(static_valid === 1'b1 && outstanding != 0))
            || (static_rm_id !== 8'd0 && static_rm_id !== current && static_rm_id !== target))
        leaked <= leaked + 1;
      // what leaves the region while it is rewritten
      last_raw <= raw;
      if (writing) begin
        written <= written + 1;
        if (^raw === 1'bx) x_clocks <= x_clocks + 1;
        if (^r_rm_id === 1'bx) ;
        else if (r_rm_id === target || r_rm_id === current) begin
          if (r_rm_id == 8'd0) blank_clocks <= blank_clocks + 1;
          else right_clocks <= right_clocks + 1;
        end else other_clocks <= other_clocks + 1;
        if (raw !== last_raw) changes <= changes + 1;
        if (r_valid === 1'b1) false_answers <= false_answers + 1;
      end
      // the RTL beside it
      if (compared) begin
        compared_clocks <= compared_clocks + 1;
        if (r_valid !== g_valid || r_idle !== g_idle || r_rm_id !== current || (g_valid &&
            r_data !== g_data))
          differences <= differences + 1;
      end
    end

  // the latches follow their data while the strobe is high; the model of them does not
  wire [32*`FABRIC_ROWS-1:0] frame = u_slot.gen_simulation.u_virtual.frame;
  wire strobe = u_slot.gen_simulation.u_virtual.strobe != 0;
  always @(frame) if (strobe === 1'b1) check(1'b0, "data of a frame that change under the strobe");

  always @(posedge clk) begin
    if (neighbour_runs) begin
      signature <= neighbour_in[0] ? 16'd1 : {signature[14:0],
          signature[15] ^ signature[13] ^ signature[12] ^ signature[10]} ^ {9'd0,
              neighbour_in[7:1]};
      neighbour_in <= {$random(seed), 1'b0};
    end
  end

  task check(input right, input [8*60-1:0] what);
    if (right !== 1'b1) begin
      failures = failures + 1;
      $display("FAILED: %0s", what);
    end
  endtask

  // ---- pairs
  integer v, waited;
  reg answered;
  task pair(input [7:0] id);
    begin
      for (v = 0; v < 3; v = v + 1) begin
        @(posedge clk);
        outstanding = 1;
        vertex_valid <= 1'b1;
        vertex <= {$random(seed), $random(seed)};
        vertex[15:0] <= {MODE, id[0] ? 4'd0 : 4'd1, id, v == 2, v == 0};
      end
      @(posedge clk);
      vertex_valid <= 1'b0;
    end
  endtask
  task answer(input [7:0] id);
    begin
      answered = 1'b0;
      waited = 0;
      while (!answered && waited < 2000) begin
        @(posedge clk);
        waited = waited + 1;
        if (static_valid === 1'b1) begin
          answered = 1'b1;
          pairs = pairs + 1;
          if (static_data[7:0] !== id) differences = differences + 1;
        end
      end
      if (!answered) differences = differences + 1;
      outstanding <= 0;
    end
  endtask
  integer n;
  task traffic;
    for (n = 0; n < `PAIRS; n = n + 1) begin
      pair(n[7:0]);
      answer(n[7:0]);
      repeat (n % 4) @(posedge clk);
    end
  endtask

  // ---- swaps; `open`: a pair is sent just before, which the module must answer first
  integer began, bound;
  reg [35:0] before_swap, before_roc;
  task swap(input [7:0] module_id, input [31:0] at, input [31:0] size, input [3:0] expected,
      input open);
    begin
      written = 0; x_clocks = 0; other_clocks = 0; right_clocks = 0; blank_clocks = 0; changes = 0;
          false_answers = 0;
      if (open) pair(8'd200);
      @(posedge clk);
      target <= module_id;
      swap_data <= `CCHIP_SWAP_REQUEST_OF(8'd0, module_id, at, size, 1'b0);
      swap_valid <= 1'b1;
      @(posedge clk);
      while (!swap_ready) @(posedge clk);
      swap_valid <= 1'b0;
      began = clocks;
      before_swap = raw;
      if (open) answer(8'd200);
      bound = 0;
      while (!report_valid && bound < 60000) begin
        @(posedge clk);
        bound = bound + 1;
        if (phase == `CCHIP_PHASE_DECOUPLE) compared <= 1'b0;
        // flip-flops take X only while frames are written
        if (phase == `CCHIP_PHASE_TRANSFER) fabric_state.settled = 1'b0;
        else fabric_state.settled = 1'b1;
        if (roc_start) before_roc = raw;
      end
      check(report_valid, "a swap without a report");
      check(report[`CCHIP_SWAP_REPORT_CODE] == expected, "the code of a swap");
      if (report[`CCHIP_SWAP_REPORT_CODE] == `CCHIP_SWAP_OK) begin
        swaps = swaps + 1;
        current <= module_id;
      end else target <= current;
      $display("swap to %0d: code %0d, %0d clocks, %0d of them TRANSFER", module_id,
               report[`CCHIP_SWAP_REPORT_CODE], clocks - began, read_clocks);
      if (written != 0)
        $display("  while frames were written, %0d clocks: %0d with X, %0d with a wrong number, ",
            written, x_clocks,
                 other_clocks, "%0d with the old or new number, %0d with the blank's, ",
                     right_clocks, blank_clocks,
                 "%0d with changes, %0d answers to no pair", changes, false_answers);
      if (expected == `CCHIP_SWAP_OK)
        $display("  outputs before the swap %h, before the reset on configuration %h, now %h",
            before_swap, before_roc,
                 raw);
      $fflush;
      repeat (4) @(posedge clk);
      if (!decoupled) compared <= 1'b1;
    end
  endtask

  integer i;
  initial begin
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    without_decoupler = $test$plusargs("without_decoupler");
    without_roc = $test$plusargs("without_roc");
    if ($test$plusargs("wave")) begin
      $dumpfile("swap.vcd");
      $dumpvars(1, bench, u_slot, u_controller, u_slot.gen_simulation.u_virtual.u_frames);
    end
    $readmemh("memory.hex", memory);
    $readmemh("boot.hex", boot_memory);
    repeat (4) @(posedge clk);
    for (i = 0; i < BOOT_WORDS; i = i + 1) begin
      @(posedge clk);
      boot_valid <= 1'b1;
      boot_data  <= boot_memory[i];
    end
    @(posedge clk) boot_valid <= 1'b0;
    repeat (4) @(posedge clk);
    fabric_state.settled = 1'b1;
    booting = 1'b0;
    repeat (4) @(posedge clk);
    rst <= 1'b0;
    repeat (8) @(posedge clk);
    neighbour_runs <= 1'b1;
    @(posedge clk);
    armed <= 1'b1;
    repeat (20) @(posedge clk);
    $display("configured: %0d words, all %0d columns, clock %0d", BOOT_WORDS, `FABRIC_COLUMNS,
        clocks);
    $fflush;
    check(static_rm_id === 8'd0 && static_idle === 1'b1, "the blank after power-up");
    compared <= 1'b1;

`ifdef SET_SMALL
    swap(8'd1, MODULE_1_AT, MODULE_1_SIZE, `CCHIP_SWAP_OK, 1'b0);
    traffic;
    swap(8'd2, MODULE_2_AT, MODULE_2_SIZE, `CCHIP_SWAP_OK, 1'b1);
    traffic;
    // a run that must fail has shown it by now
    if (!without_decoupler && !without_roc) begin
      swap(8'd0, MODULE_0_AT, MODULE_0_SIZE, `CCHIP_SWAP_OK, 1'b1);
      repeat (40) @(posedge clk);
      swap(8'd2, MODULE_2_AT, MODULE_2_SIZE, `CCHIP_SWAP_OK, 1'b0);
      traffic;
      // a truncated one: refused by its header, the module works on
      swap(8'd1, TRUNCATED_AT, TRUNCATED_SIZE, `CCHIP_SWAP_LENGTH, 1'b1);
      check(!decoupled && static_rm_id === 8'd2, "the slot after a truncated bitstream");
      traffic;
      // one with a wrong bit: the frames are written, the slot stays cut off and in reset
      swap(8'd1, FLIPPED_AT, FLIPPED_SIZE, `CCHIP_SWAP_CRC, 1'b0);
      check(decoupled && hold_reset && stop, "the slot after a wrong bit");
      repeat (40) @(posedge clk);
      swap(8'd2, MODULE_2_AT, MODULE_2_SIZE, `CCHIP_SWAP_OK, 1'b0);
      traffic;
      // one with a frame for a column of the neighbour, and a right CRC
      swap(8'd1, STRAY_AT, STRAY_SIZE, `CCHIP_SWAP_DEVICE, 1'b0);
      check(decoupled && hold_reset && stop, "the slot after a stray frame");
      repeat (40) @(posedge clk);
      swap(8'd1, MODULE_1_AT, MODULE_1_SIZE, `CCHIP_SWAP_OK, 1'b0);
      traffic;
    end
`elsif SET_TESTS
    swap(8'd4, MODULE_4_AT, MODULE_4_SIZE, `CCHIP_SWAP_OK, 1'b0);
    traffic;
    swap(8'd1, MODULE_1_AT, MODULE_1_SIZE, `CCHIP_SWAP_OK, 1'b1);
    traffic;
`else
    swap(8'd4, MODULE_4_AT, MODULE_4_SIZE, `CCHIP_SWAP_OK, 1'b0);
    traffic;
    swap(8'd0, MODULE_0_AT, MODULE_0_SIZE, `CCHIP_SWAP_OK, 1'b1);
    repeat (40) @(posedge clk);
    swap(8'd4, MODULE_4_AT, MODULE_4_SIZE, `CCHIP_SWAP_OK, 1'b0);
    traffic;
`endif
    check(watched_in_swaps > 0 && compared_clocks > 0, "nothing was watched");
    $display("neighbour: %0d clocks watched, %0d of them in swaps; compared with the RTL: %0d",
             watched, watched_in_swaps, compared_clocks);
    if (failures != 0) $display("FAILED: %0d checks", failures);
    $display("fabric swaps=%0d pairs=%0d differences=%0d static_wrong=%0d leaked=%0d", swaps,
        pairs, differences,
             static_wrong, leaked);
    $finish;
  end

endmodule
`default_nettype wire
