// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_slots: primitive tests in 1 to 4 slots behind the queues of waiting pairs, each pair
// answered exactly once. With SWAPS = 1 their modules are exchanged at run time: scheduler, table
// of bitstreams, back-off, configuration controller. With SWAPS = 0 they are what SLOTn_RM_ID
// says, the inputs of swaps have no effect and their outputs are 0.
//   pairs        cchip_dispatcher: module m answers for the kinds 1..m; a pair of the illegal kind
//                0, of a kind that no slot provides, or that a swap by force gives up, is answered
//                as open: hit 1, grid 1, definite 0
//   latency      6 clocks from `some` to the slot, that of the test, 6 to m_result
//   throughput   a pair every 3 clocks, with quads every 4
//   swaps        cchip_swap_scheduler; one at a time, while the other slots work
//   registers    as cchip_primtest_subsystem has them, docs/hardware/registers.md
//   cuts         every path but the reads of table_data and phase_clocks, rst and core_rst
//   reset        rst: no pair, no swap; a slot whose rewriting was cut off stays decoupled until a
//                good swap. core_rst: no pair; a swap, the table and its bitstreams stay; a slot
//                that is decoupled keeps the reset that the swap gives it
module cchip_slots #(
    // width of a coordinate, bit, 4..20
    parameter integer COORD_W = 16,
    // see cchip_pr_region
    parameter integer SUBSTAGES = `CCHIP_SUBSTAGES_DEFAULT,
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    parameter integer ABSOLUTE_PROJECTION = 0,
    parameter integer WARPED_EXACT = 1,
    // slots, 1..4
    parameter integer SLOTS = 1,
    // 1: modules are exchanged at run time
    parameter integer SWAPS = 0,
    // width of the number of waiting pairs, bit, 1..16
    parameter integer COUNT_W = 8,
    // width of the configuration port, bit, 8 or 32
    parameter integer CFG_W = 8,
    // clocks per word of the port
    parameter integer CFG_DIVIDER = 2,
    // reset on configuration, clocks
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    // modules at power-up, CCHIP_RM_BLANK .. CCHIP_RM_QUAD_QUAD, 0..3; without swaps 1..3
    parameter integer SLOT0_RM_ID = 1,
    parameter integer SLOT1_RM_ID = 3,
    parameter integer SLOT2_RM_ID = 2,
    parameter integer SLOT3_RM_ID = 1,
    // 0: partitions of an FPGA; 1: simulated reconfiguration (see cchip_pr_slot)
    parameter integer SIMULATION = 0,
    // start of the random numbers of a simulated reconfiguration, any
    parameter integer SEED = 1
) (
    input  wire                              clk,
    input  wire                              rst,
    input  wire                              core_rst,
    // queues, kind k at bit k (cchip_descriptor_queues); a full one is worth a swap
    input  wire [                       3:0] some,
    input  wire [             4*COUNT_W-1:0] waiting,
    input  wire [                       3:1] full,
    output wire [                       3:0] kind,
    output wire                              look,
    output wire                              pop,
    output wire [                       1:0] vertex,
    input  wire [   `CCHIP_DESCRIPTOR_W-1:0] descriptor,        // 2 clocks after pop
    input  wire [`CCHIP_POINT_W(COORD_W)-1:0] a,                // 2 clocks after vertex
    input  wire [`CCHIP_POINT_W(COORD_W)-1:0] b,
    // answers
    output wire                              m_result_valid,
    input  wire                              m_result_ready,
    output wire [         `CCHIP_KIND_W-1:0] m_result_kind,
    output wire [       `CCHIP_RESULT_W-1:0] m_result_data,
    // events, one clock: an answer of this module left, 0: of none; a pair was refused
    output wire                              answered,
    output wire [         `CCHIP_KIND_W-1:0] answered_module,
    output wire                              refused_kind,
    output wire                              refused_provider,
    // state of the slots: of four, those that are not there show 0
    output wire [ 4*`CCHIP_PAIR_COUNT_W-1:0] outstanding,
    output wire [      4*`CCHIP_RM_ID_W-1:0] rm_id,
    output wire [                       3:0] decoupled,
    output wire [      4*`CCHIP_PHASE_W-1:0] phase,
    // registers of swaps
    input  wire                              clear,             // lost, clocks of phases
    input  wire                              abort_swap,
    input  wire                              enable,            // of the scheduler
    input  wire                              command_valid,
    input  wire [     `CCHIP_SLOT_ID_W-1:0]  command_slot,
    input  wire [       `CCHIP_RM_ID_W-1:0]  command_module,
    input  wire                              command_force,
    input  wire [                      31:0] shutdown_limit,    // clocks; 0: default
    input  wire [                      31:0] memory_limit,      // clocks; 0: default
    input  wire [                      31:0] min_batch,
    input  wire [                      31:0] max_age,
    output wire [ `CCHIP_SWAP_REPORT_W-1:0]  last_report,
    output wire [                       2:0] swap_events,       // {lost, error, done}, one clock
    output wire [                      31:0] lost,
    // table of bitstreams and clocks of phases, read within the clock
    input  wire                              write_table,
    input  wire [                       5:0] write_word,
    input  wire [                      31:0] write_data,
    input  wire [                       3:0] write_bytes,
    input  wire [                       5:0] read_word,
    output wire [                      31:0] table_data,
    output wire [                      31:0] phase_clocks,      // of phase read_word
    // to be counted, one clock each
    output wire                              swapped,
    output wire                              rejected,
    output wire                              stall,
    // memory of the bitstreams, AXI4, read only
    output wire                              m_axi_arvalid,
    input  wire                              m_axi_arready,
    output wire [                      31:0] m_axi_araddr,
    output wire [                       7:0] m_axi_arlen,
    output wire [                       2:0] m_axi_arsize,
    output wire [                       1:0] m_axi_arburst,
    output wire [                       3:0] m_axi_arcache,
    output wire [                       2:0] m_axi_arprot,
    input  wire                              m_axi_rvalid,
    output wire                              m_axi_rready,
    input  wire [                      31:0] m_axi_rdata,
    input  wire [                       1:0] m_axi_rresp,
    input  wire                              m_axi_rlast,
    // configuration port of the device
    output wire                              cfg_valid,
    output wire [                 CFG_W-1:0] cfg_data,
    input  wire                              cfg_error          // any clock; level, or 2 clocks
);

  localparam integer KINDS = 3;
  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;
  localparam integer COUNT_OF_PAIRS_W = `CCHIP_PAIR_COUNT_W;
  localparam integer ID_W = `CCHIP_RM_ID_W;
  localparam integer PHASE_W = `CCHIP_PHASE_W;
  wire reset = rst | core_rst;

  generate
    if (SWAPS != 0 && SWAPS != 1) begin : gen_illegal
      cchip_error_slots_SWAPS_must_be_0_or_1 u_error ();
    end
  endgenerate

  // ---- dispatch
  wire [SLOTS-1:0] vertex_valid, result_valid;
  wire vertex_first, vertex_last;
  wire [SLOTS*`CCHIP_PAIR_ID_W-1:0] vertex_id;
  wire [SLOTS*RESULT_W-1:0] result;
  wire [`CCHIP_KIND_W*SLOTS-1:0] slot_module;
  wire [KINDS:1] no_provider;
  wire [SLOTS-1:0] stop, quiet, decouple, slots_decoupled, hold_reset, roc_start, roc_busy, idle;
  wire [SLOTS-1:0] region_decoupled;  // slots_decoupled: when all its pairs are answered, too
  wire [ID_W*SLOTS-1:0] region_rm_id, slot_rm_id;
  wire [COUNT_OF_PAIRS_W*SLOTS-1:0] slot_outstanding, slot_lost;

  cchip_dispatcher #(
      .SLOTS (SLOTS),
      .KINDS (KINDS),
      .CREDIT(CONTEXTS)
  ) u_dispatcher (
      .clk             (clk),
      .rst             (reset),
      .some            (some),
      .kind            (kind),
      .look            (look),
      .pop             (pop),
      .vertex          (vertex),
      .descriptor      (descriptor),
      .no_provider     (no_provider),
      .m_vertex_valid  (vertex_valid),
      .m_vertex_first  (vertex_first),
      .m_vertex_last   (vertex_last),
      .m_vertex_id     (vertex_id),
      .s_result_valid  (result_valid),
      .s_result_data   (result),
      .slot_module     (slot_module),
      .m_result_valid  (m_result_valid),
      .m_result_ready  (m_result_ready),
      .m_result_kind   (m_result_kind),
      .m_result_data   (m_result_data),
      .stop            (stop),
      .quiet           (quiet),
      .decouple        (decouple),
      .decoupled       (slots_decoupled),
      .outstanding     (slot_outstanding),
      .lost            (slot_lost),
      .answered        (answered),
      .answered_module (answered_module),
      .refused_kind    (refused_kind),
      .refused_provider(refused_provider)
  );

  // ---- slots
  genvar slot;
  generate
    for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_slots
      wire [ID_W-1:0] module_id;
      // A slot that is decoupled for a swap has no pairs, and its reset is the controller's alone:
      // one that lasts over the end of a transfer would hide the new module's reset on
      // configuration, which has to begin once the module is whole
      wire slot_rst;
      if (SWAPS == 0) begin : gen_reset
        // from a flip-flop beside the slot
        cchip_reset_copy u_reset (
            .clk     (clk),
            .rst     (reset),
            .rst_copy(slot_rst)
        );
      end else begin : gen_reset
        assign slot_rst = rst | (core_rst & ~decouple[slot]);
      end
      wire [`CCHIP_PAIR_ID_W-1:0] id = vertex_id[`CCHIP_PAIR_ID_W*slot+:`CCHIP_PAIR_ID_W];
      wire [`CCHIP_VERTEX_W(COORD_W)-1:0] vertex_data = `CCHIP_VERTEX_OF(vertex_first, vertex_last,
          id, descriptor[`CCHIP_DESCRIPTOR_ERR], descriptor[`CCHIP_DESCRIPTOR_MODE], a, b);
      assign slot_rm_id[ID_W*slot+:ID_W] = module_id;
      cchip_pr_slot #(
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .SLOT_ID            (slot),
          .RM_ID              (slot == 0 ? SLOT0_RM_ID : slot == 1 ? SLOT1_RM_ID
                               : slot == 2 ? SLOT2_RM_ID : SLOT3_RM_ID),
          .ROC_CYCLES         (ROC_CYCLES),
          .CFG_W              (CFG_W),
          .SIMULATION         (SIMULATION),
          .SEED               (SEED)
      ) u_slot (
          .clk           (clk),
          .rst           (slot_rst),
          .decouple      (decouple[slot]),
          .decoupled     (region_decoupled[slot]),
          .hold_reset    (hold_reset[slot]),
          .roc_start     (roc_start[slot]),
          .roc_busy      (roc_busy[slot]),
          .region_rm_id  (region_rm_id[ID_W*slot+:ID_W]),
          .cfg_valid     (cfg_valid),
          .cfg_data      (cfg_data),
          .s_vertex_valid(vertex_valid[slot]),
          .s_vertex_data (vertex_data),
          .m_result_valid(result_valid[slot]),
          .m_result_data (result[RESULT_W*slot+:RESULT_W]),
          .rm_id         (module_id),
          .idle          (idle[slot])
      );
      assign slot_module[2*slot+:2] = module_id[7:2] == 6'd0 ? module_id[1:0] : 2'd0;
    end
    if (SLOTS == 4) begin : gen_state
      assign outstanding = slot_outstanding;
      assign rm_id       = slot_rm_id;
      assign decoupled   = slots_decoupled;
    end else begin : gen_state
      assign outstanding = {{(4 - SLOTS) * COUNT_OF_PAIRS_W{1'b0}}, slot_outstanding};
      assign rm_id       = {{(4 - SLOTS) * ID_W{1'b0}}, slot_rm_id};
      assign decoupled   = {{4 - SLOTS{1'b0}}, slots_decoupled};
    end
  endgenerate

  generate
    if (SWAPS == 0) begin : gen_swaps
      // what the modules that were built do not serve
      localparam integer MOST = SLOT0_RM_ID;
      localparam integer MOST_1 = SLOTS > 1 && SLOT1_RM_ID > MOST ? SLOT1_RM_ID : MOST;
      localparam integer MOST_2 = SLOTS > 2 && SLOT2_RM_ID > MOST_1 ? SLOT2_RM_ID : MOST_1;
      localparam integer MOST_3 = SLOTS > 3 && SLOT3_RM_ID > MOST_2 ? SLOT3_RM_ID : MOST_2;
      assign no_provider  = {MOST_3 < 3, MOST_3 < 2, MOST_3 < 1};
      assign stop         = {SLOTS{1'b0}};
      assign decouple     = {SLOTS{1'b0}};
      assign hold_reset   = {SLOTS{1'b0}};
      assign roc_start    = {SLOTS{1'b0}};
      assign phase        = {4 * PHASE_W{1'b0}};
      assign last_report  = {`CCHIP_SWAP_REPORT_W{1'b0}};
      assign swap_events  = 3'd0;
      assign lost         = 32'd0;
      assign table_data   = 32'd0;
      assign phase_clocks = 32'd0;
      assign {swapped, rejected, stall} = 3'd0;
      assign m_axi_arvalid = 1'b0;
      assign m_axi_araddr  = 32'd0;
      assign m_axi_arlen   = 8'd0;
      assign m_axi_arsize  = 3'd0;
      assign m_axi_arburst = 2'd0;
      assign m_axi_arcache = 4'd0;
      assign m_axi_arprot  = 3'd0;
      assign m_axi_rready  = 1'b0;
      assign cfg_valid     = 1'b0;
      assign cfg_data      = {CFG_W{1'b0}};
      wire unused_of_swaps = &{1'b0, waiting, full, quiet, region_rm_id, roc_busy, slot_lost, clear,
          abort_swap, enable, command_valid, command_slot, command_module, command_force,
          shutdown_limit,
          memory_limit, min_batch, max_age, write_table, write_word, write_data, write_bytes,
          read_word, m_axi_arready, m_axi_rvalid, m_axi_rdata, m_axi_rresp, m_axi_rlast,
          cfg_error};
    end else begin : gen_swaps
      wire [4*SLOTS-1:0] table_valid, invalidate, resting, hopeless;
      wire [3:0] table_entry;
      wire [31:0] table_address, table_size;
      wire table_look, report_valid;
      wire [`CCHIP_SWAP_REPORT_W-1:0] report_data;
      wire [PHASE_W-1:0] phase_now;
      wire [`CCHIP_SLOT_ID_W-1:0] phase_slot;
      wire busy;
      for (slot = 0; slot < 4; slot = slot + 1) begin : gen_phase
        localparam [31:0] SLOT = slot;
        assign phase[PHASE_W*slot+:PHASE_W] =
            phase_slot == SLOT[`CCHIP_SLOT_ID_W-1:0] && slot < SLOTS ? phase_now : {PHASE_W{1'b0}};
      end

      cchip_subsystem_status u_status (
          .clk         (clk),
          .rst         (rst),
          .clear       (clear),
          .report_valid(report_valid),
          .report_data (report_data),
          .last_report (last_report),
          .swap_events (swap_events),
          .lost        (lost)
      );

      cchip_bitstream_table #(
          .SLOTS(SLOTS)
      ) u_table (
          .clk        (clk),
          .rst        (rst),
          .write      (write_table),
          .write_word (write_word),
          .write_data (write_data),
          .write_bytes(write_bytes),
          .read_word  (read_word),
          .read_data  (table_data),
          .look       (table_look),
          .look_entry (table_entry),
          .address    (table_address),
          .size       (table_size),
          .valid      (table_valid),
          .invalidate (invalidate)
      );

      // which slot gets which module when, and how
      wire swap_valid, swap_ready, swap_report;
      wire [`CCHIP_SWAP_REQUEST_W-1:0] swap_data;
      wire [`CCHIP_SWAP_REPORT_W-1:0] swap_report_data;
      cchip_swap_retry #(
          .SLOTS(SLOTS)
      ) u_retry (
          .clk         (clk),
          .rst         (rst),
          .report_valid(swap_report),
          .report_data (swap_report_data),
          .valid       (table_valid),
          .resting     (resting),
          .hopeless    (hopeless)
      );

      cchip_swap_scheduler #(
          .SLOTS  (SLOTS),
          .COUNT_W(COUNT_W)
      ) u_scheduler (
          .clk             (clk),
          .rst             (rst),
          .enable          (enable),
          .min_batch       (min_batch),
          .max_age         (max_age),
          .table_valid     (table_valid),
          .table_invalidate(invalidate),
          .table_resting   (resting),
          .table_hopeless  (hopeless),
          .table_look      (table_look),
          .table_entry     (table_entry),
          .table_address   (table_address),
          .table_size      (table_size),
          .waiting         (waiting[COUNT_W+:3*COUNT_W]),
          .full            (full),
          .no_provider     (no_provider),
          .slot_module     (slot_module),
          .command_valid   (command_valid),
          .command_slot    (command_slot),
          .command_module  (command_module),
          .command_force   (command_force),
          .m_swap_valid    (swap_valid),
          .m_swap_ready    (swap_ready),
          .m_swap_data     (swap_data),
          .s_report_valid  (swap_report),
          .s_report_data   (swap_report_data),
          .m_report_valid  (report_valid),
          .m_report_data   (report_data)
      );

      cchip_config_controller #(
          .SLOTS      (SLOTS),
          .CFG_W      (CFG_W),
          .CFG_DIVIDER(CFG_DIVIDER)
      ) u_controller (
          .clk           (clk),
          .rst           (rst),
          .s_swap_valid  (swap_valid),
          .s_swap_ready  (swap_ready),
          .s_swap_data   (swap_data),
          .m_report_valid(swap_report),
          .m_report_data (swap_report_data),
          .abort_swap    (abort_swap),
          .clear         (clear),
          .shutdown_limit(shutdown_limit),
          .memory_limit  (memory_limit),
          .stop          (stop),
          .decouple      (decouple),
          .hold_reset    (hold_reset),
          .roc_start     (roc_start),
          .quiet         (quiet),
          .decoupled     (slots_decoupled),
          .roc_busy      (roc_busy),
          .region_rm_id  (region_rm_id),
          .lost          (slot_lost),
          .busy          (busy),
          .phase         (phase_now),
          .phase_slot    (phase_slot),
          .m_axi_arvalid (m_axi_arvalid),
          .m_axi_arready (m_axi_arready),
          .m_axi_araddr  (m_axi_araddr),
          .m_axi_arlen   (m_axi_arlen),
          .m_axi_arsize  (m_axi_arsize),
          .m_axi_arburst (m_axi_arburst),
          .m_axi_arcache (m_axi_arcache),
          .m_axi_arprot  (m_axi_arprot),
          .m_axi_rvalid  (m_axi_rvalid),
          .m_axi_rready  (m_axi_rready),
          .m_axi_rdata   (m_axi_rdata),
          .m_axi_rresp   (m_axi_rresp),
          .m_axi_rlast   (m_axi_rlast),
          .cfg_valid     (cfg_valid),
          .cfg_data      (cfg_data),
          .cfg_error     (cfg_error),
          .swapped       (swapped),
          .rejected      (rejected),
          .stall         (stall),
          .read_phase    (read_word[PHASE_W-1:0]),
          .read_clocks   (phase_clocks)
      );
      wire unused_of_swaps = &{1'b0, busy, waiting[COUNT_W-1:0]};
    end
  endgenerate

  wire unused = &{1'b0, idle, region_decoupled};

endmodule
`default_nettype wire
