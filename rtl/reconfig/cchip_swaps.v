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
module cchip_swaps #(
    // kinds of pairs, 3, or 4 with points: the modules are 0..KINDS
    parameter integer KINDS = 3,
    // slots, 1..4
    parameter integer SLOTS = 1,
    // 1: modules are exchanged at run time
    parameter integer SWAPS = 1,
    // width of the number of waiting pairs, bit, 1..16
    parameter integer COUNT_W = 8,
    // width of the configuration port, bit, 8 or 32
    parameter integer CFG_W = 8,
    // clocks per word of the port
    parameter integer CFG_DIVIDER = 2,
    // AxCACHE of reads, 0..15, and AxPROT, 0..7
    parameter integer AXI_ARCACHE = 3,
    parameter integer AXI_PROT = 0
) (
    input  wire                                 clk,
    input  wire                                 rst,
    // queues of waiting pairs, of the kinds from 1 on; a full one is worth a swap
    input  wire [            KINDS*COUNT_W-1:0] waiting,
    input  wire [                    KINDS-1:0] full,
    output wire [                    KINDS-1:0] no_provider,     // no slot can get it
    // slots
    input  wire [       `CCHIP_KIND_W*SLOTS-1:0] slot_module,
    output wire [                    SLOTS-1:0] stop,
    output wire [                    SLOTS-1:0] decouple,
    output wire [                    SLOTS-1:0] hold_reset,
    output wire [                    SLOTS-1:0] roc_start,
    input  wire [                    SLOTS-1:0] quiet,
    input  wire [                    SLOTS-1:0] decoupled,
    input  wire [                    SLOTS-1:0] roc_busy,
    input  wire [     `CCHIP_RM_ID_W*SLOTS-1:0] region_rm_id,
    input  wire [`CCHIP_PAIR_COUNT_W*SLOTS-1:0] slot_lost,
    // registers
    output wire [         4*`CCHIP_PHASE_W-1:0] phase,           // of four slots
    input  wire                                 clear,           // lost, clocks of phases
    input  wire                                 abort_swap,
    input  wire                                 enable,          // of the scheduler
    input  wire                                 command_valid,
    input  wire [         `CCHIP_SLOT_ID_W-1:0] command_slot,
    input  wire [           `CCHIP_RM_ID_W-1:0] command_module,
    input  wire                                 command_force,
    input  wire [                         31:0] shutdown_limit,  // clocks; 0: default
    input  wire [                         31:0] memory_limit,    // clocks; 0: default
    input  wire [                         31:0] min_batch,
    input  wire [                         31:0] max_age,
    output wire [     `CCHIP_SWAP_REPORT_W-1:0] last_report,
    output wire [                          2:0] swap_events,     // {lost, error, done}, one clock
    output wire [                         31:0] lost,
    // table of bitstreams and clocks of phases, read within the clock
    input  wire                                 write_table,
    input  wire [                          6:0] write_word,
    input  wire [                         31:0] write_data,
    input  wire [                          3:0] write_bytes,
    input  wire [                          6:0] read_word,
    output wire [                         31:0] table_data,
    output wire [                         31:0] phase_clocks,    // of phase read_word
    // to be counted, one clock each
    output wire                                 swapped,
    output wire                                 rejected,
    output wire                                 stall,
    // memory of the bitstreams, AXI4, read only
    output wire                                 m_axi_arvalid,
    input  wire                                 m_axi_arready,
    output wire [                         31:0] m_axi_araddr,
    output wire [                          7:0] m_axi_arlen,
    output wire [                          2:0] m_axi_arsize,
    output wire [                          1:0] m_axi_arburst,
    output wire [                          3:0] m_axi_arcache,
    output wire [                          2:0] m_axi_arprot,
    input  wire                                 m_axi_rvalid,
    output wire                                 m_axi_rready,
    input  wire [                         31:0] m_axi_rdata,
    input  wire [                          1:0] m_axi_rresp,
    input  wire                                 m_axi_rlast,
    // configuration port of the device
    output wire                                 cfg_valid,
    output wire [                    CFG_W-1:0] cfg_data,
    input  wire                                 cfg_error        // any clock; level, or 2 clocks
);

  localparam integer PHASE_W = `CCHIP_PHASE_W;

  genvar slot;
  generate
    if (SWAPS != 0 && SWAPS != 1) begin : gen_illegal
      cchip_error_swaps_SWAPS_must_be_0_or_1 u_error ();
    end
    if (SWAPS == 0) begin : gen_swaps
      assign no_provider  = {KINDS{1'b0}};
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
      wire unused = &{1'b0, waiting, full, slot_module, quiet, decoupled, region_rm_id, roc_busy,
          slot_lost, clear, abort_swap, enable, command_valid, command_slot, command_module,
          command_force, shutdown_limit, memory_limit, min_batch, max_age, write_table, write_word,
          write_data, write_bytes, read_word, m_axi_arready, m_axi_rvalid, m_axi_rdata,
          m_axi_rresp, m_axi_rlast, cfg_error, clk, rst};
    end else begin : gen_swaps
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
          .CFG_DIVIDER(CFG_DIVIDER),
          .AXI_ARCACHE(AXI_ARCACHE),
          .AXI_PROT   (AXI_PROT)
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
      wire unused = &{1'b0, busy};
    end
  endgenerate

endmodule
`default_nettype wire
