// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_swaps: exchanges the modules of the slots of cchip_slots at run time: which slot gets which
// module when (cchip_swap_scheduler), from where (cchip_bitstream_table), how soon again after a
// failure (cchip_swap_retry), and how (cchip_config_controller). One swap at a time, while the
// other slots work.
//   SWAPS        0: there are none; the inputs have no effect, the outputs are 0
//   registers    as docs/hardware/registers.md has them
//   slots        what a swap asks of a slot, and what the slot answers: cchip_config_controller
//   cuts         every path but the reads of table_data and phase_clocks
//   reset        no swap; a slot whose rewriting was cut off stays decoupled until a good swap
//   timing       A report is in the registers a clock after it.
//   inside       Wiring, and which slot the phase in progress belongs to.
//   why          It is beside the registers, which set it, and not among the pairs. So a reset of
//                the core leaves a swap alone, and between it and cchip_slots there are twelve
//                handshakes instead of forty signals through every level.
//   test         With its two users: tests/unit/test_cchip_primtest_subsystem.cpp, make
//                campaign-swaps, scripts/run campaign-chip-swaps.
module cchip_swaps #(
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    parameter integer SLOTS = 1,        // slots; legal: 1..4
    parameter integer SWAPS = 1,        // 0: there are none, every output is 0; legal: 0, 1
    parameter integer COUNT_W = 8,      // width of the number of waiting pairs (bit); legal: 1..16
    parameter integer CFG_W = 8,        // width of the configuration port (bit); legal: 8, 32
    parameter integer CFG_DIVIDER = 2   // clocks per word of the port; legal: from 1 on
) (
    input  wire                                 clk,             // clock, rising edge
    input  wire                                 rst,             // synchronous reset, active high
    // ---- queues of waiting pairs, of the kinds from 1 on; a full one is worth a swap
    input  wire [            KINDS*COUNT_W-1:0] waiting,  // pairs in the queues of kinds 1, 2, 3
    input  wire [                    KINDS-1:0] full,  // a queue that is full is worth a swap
    // bit k - 1: no slot can get the module of kind k
    output wire [                    KINDS-1:0] no_provider,
    // ---- slots
    output wire [`CCHIP_TO_SLOTS_W(SLOTS)-1:0] to_slots,  // see cchip_slots
    input  wire [`CCHIP_FROM_SLOTS_W(SLOTS)-1:0] from_slots,  // see cchip_slots
    // ---- registers
    output wire [         4*`CCHIP_PHASE_W-1:0] phase,  // of each of four slots: phase of its swap
    input  wire                                 clear,  // 1: lost and clocks of phases become 0
    // 1: abort the swap in progress; ignored without one and from RECOUPLE on
    input  wire                                 abort_swap,
    // 1: the scheduler exchanges modules by itself
    input  wire                                 enable,
    input  wire                                 command_valid,  // a swap by software, 1 for a clock
    input  wire [         `CCHIP_SLOT_ID_W-1:0] command_slot,    // its slot
    input  wire [           `CCHIP_RM_ID_W-1:0] command_module,  // its module
    // give up pairs that are not answered in time
    input  wire                                 command_force,
    // longest wait for the pairs inside: 1..2^32 - 1 clocks; 0: CCHIP_SHUTDOWN_LIMIT_DEFAULT
    input  wire [                         31:0] shutdown_limit,
    // longest wait for an address to be taken or a beat: 1..2^32 - 1 clocks; 0:
    // CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [                         31:0] memory_limit,
    input  wire [                         31:0] min_batch,       // pairs that are worth a swap
    // clocks after which an unserved kind gets a slot regardless of the batch
    input  wire [                         31:0] max_age,
    // the last report: record SWAP_REPORT, docs/hardware/definitions.md
    output wire [     `CCHIP_SWAP_REPORT_W-1:0] last_report,
    // {lost, error, done} of a report, one clock
    output wire [                          2:0] swap_events,
    output wire [                         31:0] lost,            // pairs lost by swaps with force
    // ---- table of bitstreams and clocks of phases, read within the clock
    // 1 for a clock: a word of the table is written
    input  wire                                 write_table,
    input  wire [                          6:0] write_word,      // which
    input  wire [                         31:0] write_data,      // what is written
    input  wire [                          3:0] write_bytes,     // which bytes
    // word of the table, or phase, that is read
    input  wire [                          6:0] read_word,
    output wire [                         31:0] table_data,      // word of the table
    output wire [                         31:0] phase_clocks,    // clocks of the phase read_word
    // ---- to be counted, one clock each
    output wire                                 swapped,         // a swap ended well, one clock
    // a swap failed or was refused, SAME not counted, one clock
    output wire                                 rejected,
    output wire                                 stall,  // a slot of the port passed without data
    // ---- memory of the bitstreams, AXI4, read only
    output wire                                 m_axi_arvalid,   // AXI4 read, address
    input  wire                                 m_axi_arready,   // AXI4 read, address
    output wire [                         31:0] m_axi_araddr,    // AXI4 read, address, byte
    output wire [                          7:0] m_axi_arlen,     // AXI4 read, beats - 1, at most 15
    input  wire                                 m_axi_rvalid,    // AXI4 read, data
    output wire                                 m_axi_rready,    // AXI4 read, data
    input  wire [                         31:0] m_axi_rdata,     // AXI4 read, data
    input  wire [                          1:0] m_axi_rresp,     // AXI4 read, response
    input  wire                                 m_axi_rlast,  // AXI4 read, last beat of the burst
    // ---- configuration port of the device
    // a word is written to the configuration port
    output wire                                 cfg_valid,
    output wire [                    CFG_W-1:0] cfg_data,        // the word
    // the device reports an error of its configuration, from any clock; a level, or a pulse of at
    // least two clocks of clk
    input  wire                                 cfg_error
);

  localparam integer PHASE_W = `CCHIP_PHASE_W;

  genvar slot;
  generate
    if (SWAPS != 0 && SWAPS != 1) begin : gen_illegal
      cchip_error_swaps_SWAPS_must_be_0_or_1 u_error ();
    end
    if (SWAPS == 0) begin : gen_swaps
      assign no_provider  = {KINDS{1'b0}};
      assign to_slots     = {`CCHIP_TO_SLOTS_W(SLOTS){1'b0}};
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
      assign m_axi_rready  = 1'b0;
      assign cfg_valid     = 1'b0;
      assign cfg_data      = {CFG_W{1'b0}};
      wire unused = &{1'b0, waiting, full, from_slots, clear, abort_swap, enable, command_valid,
          command_slot, command_module,
          command_force, shutdown_limit, memory_limit, min_batch, max_age, write_table, write_word,
          write_data, write_bytes, read_word, m_axi_arready, m_axi_rvalid, m_axi_rdata,
          m_axi_rresp, m_axi_rlast, cfg_error, clk, rst};
    end else begin : gen_swaps
      wire [SLOTS-1:0] stop, decouple, hold_reset, roc_start, quiet, decoupled, roc_busy;
      wire [`CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id;
      wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] slot_lost;
      wire [`CCHIP_KIND_W*SLOTS-1:0] slot_module;
      assign to_slots = {stop, decouple, hold_reset, roc_start};
      assign {quiet, decoupled, roc_busy, region_rm_id, slot_lost, slot_module} = from_slots;
      wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] table_valid, invalidate, resting, hopeless;
      wire [4:0] table_entry;
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
          .SLOTS(SLOTS),
          .KINDS(KINDS)
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
          .SLOTS(SLOTS),
          .KINDS(KINDS)
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
          .KINDS  (KINDS),
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
          .waiting         (waiting),
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
          .decoupled     (decoupled),
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
      wire unused = &{1'b0, busy};
    end
  endgenerate

endmodule
`default_nettype wire
