// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_chip: collision detection as a device. Registers on AXI4-Lite, an interrupt, an AXI4 master
// for memory; queries from a ring in memory, records into another one. Registers:
// docs/hardware/chip-registers.md; how a driver uses them: docs/hardware/programmers-guide.md.
//   way          of a query: cchip_chip_core. This module adds cchip_chip_regs, counters,
//                cchip_soft_reset and the interrupt
//   latency      registers: 3 clocks, counters up to 21; a query by its tree
//   interrupt    level: an event of interrupt_status that is enabled; 0 for a clock after each
//                write of interrupt_status, so that an event that stays or comes makes an edge
//   soft reset   drops all queries and lines, clears enable, query_producer and record_consumer;
//                the bus masters await what is outstanding (cchip_soft_reset). A swap continues
//   counters     at most 1 a clock each, two banks of cchip_counter_file, with SWAPS a third
//   swaps        with SWAPS = 1: registers from 0x400 on, m_axi_cfg and cfg; otherwise leave those
//                ports open and their inputs 0
//   cuts         every path but from rst
//   reset        rst resets registers and core, and must reset the bus too; hold it for 2 clocks or
//                more
module cchip_chip #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer PAIRS = 48,  // node pairs in flight; legal: see cchip_traversal
    // leaf pairs that are fetched at once; legal: PAIRS + LEAVES is 8, 16, 32 or 64
    parameter integer LEAVES = 16,
    parameter integer STACK = 64,  // entries of a query's stack (entry); legal: 8, 16, 32, 64
    // entries of the queue of leaves (entry); legal: over PAIRS, to 128
    parameter integer LEAF_DEPTH = 72,
    parameter integer CACHE_KB = 128,  // size of the cache (KiB); legal: 4, 8 ... 1024
    parameter integer MISSES = 32,  // lines in flight from memory; legal: 4, 8, 16, 32
    parameter integer LOCKS = 2,  // ranges of lines to lock; legal: 1..4
    parameter integer COORD_W = 16,  // width of a coordinate on the grid (bit); legal: 4..20
    // registers of the primitive test's stages (clock); legal: see cchip_primtest
    parameter integer SUBSTAGES = `CCHIP_SUBSTAGES_DEFAULT,
    parameter integer PASSES = 1,  // a vertex in the transform (clock); legal: 1, 2
    parameter integer QUEUE_DEPTH = 64,  // primitive pairs that wait; legal: 16, 32 ... 256
    // leaf pairs between leaf feed and record; legal: 4, 8 ... 256
    parameter integer LEAF_NUMBERS = 64,
    parameter integer SLOTS = 1,  // slots of primitive tests; legal: 1..4
    parameter integer SWAPS = 0,  // 1: their modules are exchanged at run time; legal: 0, 1
    // module of slot 0: triangles, triangle and quad, quads; with SWAPS at power-up; legal: 1, 2,
    // 3, with SWAPS 0, too
    parameter integer RM_ID = 3,
    parameter integer SLOT1_RM_ID = 1,                         // of slot 1 (module); legal: 0..3
    parameter integer SLOT2_RM_ID = 2,                         // of slot 2 (module); legal: 0..3
    parameter integer SLOT3_RM_ID = 1,                         // of slot 3 (module); legal: 0..3
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    parameter integer CFG_DIVIDER = 2,  // clocks per word of the port; legal: from 1 on
    // reset on configuration (clock); legal: from 1 on
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    // 1: simulated reconfiguration (see cchip_pr_slot); legal: 0, 1
    parameter integer SIMULATION = 0,
    parameter integer SEED = 1,  // start of its random numbers; legal: any
    parameter integer DATA_W = 128,  // width of the data buses (bit); legal: 128, 256, 512
    // ARCACHE: 3 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_ARCACHE = 3,
    // AWCACHE: 2 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_AWCACHE = 2,
    parameter integer AXI_PROT = 0  // AxPROT: 0 secure, 2 non-secure; legal: 0..7
) (
    // ---- clock and reset
    input  wire                          clk,                // clock, rising edge
    input  wire                          rst,                // synchronous reset, active high
    // ---- registers, AXI4-Lite: docs/hardware/chip-registers.md
    input  wire                          s_axil_awvalid,
    output wire                          s_axil_awready,
    input  wire [                  11:0] s_axil_awaddr,
    input  wire [                   2:0] s_axil_awprot,
    input  wire                          s_axil_wvalid,
    output wire                          s_axil_wready,
    input  wire [                  31:0] s_axil_wdata,
    input  wire [                   3:0] s_axil_wstrb,
    output wire                          s_axil_bvalid,
    input  wire                          s_axil_bready,
    output wire [                   1:0] s_axil_bresp,
    input  wire                          s_axil_arvalid,
    output wire                          s_axil_arready,
    input  wire [                  11:0] s_axil_araddr,
    input  wire [                   2:0] s_axil_arprot,
    output wire                          s_axil_rvalid,
    input  wire                          s_axil_rready,
    output wire [                  31:0] s_axil_rdata,
    output wire [                   1:0] s_axil_rresp,
    // ---- interrupt
    // interrupt: an event that is enabled; level, 0 for a clock after each write of
    // interrupt_status
    output wire                          irq,
    // ---- memory, AXI4 read: memory, AXI4: images, queries, records
    output wire                          m_axi_arvalid,      // read address: valid
    input  wire                          m_axi_arready,      // taken
    output wire [      $clog2(MISSES):0] m_axi_arid,         // ID: {client, slot}
    output wire [                  63:0] m_axi_araddr,       // address, a multiple of 64
    output wire [                   7:0] m_axi_arlen,        // beats of a line - 1
    output wire [                   2:0] m_axi_arsize,       // whole beats
    output wire [                   1:0] m_axi_arburst,      // INCR
    output wire [                   3:0] m_axi_arcache,      // normal, not cacheable, bufferable
    output wire [                   2:0] m_axi_arprot,       // unprivileged, secure, data
    input  wire                          m_axi_rvalid,       // read data: valid
    output wire                          m_axi_rready,       // taken
    input  wire [      $clog2(MISSES):0] m_axi_rid,          // ID
    input  wire [            DATA_W-1:0] m_axi_rdata,        // data
    input  wire [                   1:0] m_axi_rresp,        // response
    input  wire                          m_axi_rlast,        // last beat
    // ---- memory, AXI4 write
    output wire                          m_axi_awvalid,      // write address: valid
    input  wire                          m_axi_awready,      // taken
    output wire                          m_axi_awid,         // 0
    output wire [                  63:0] m_axi_awaddr,       // address, a multiple of the beat
    output wire [                   7:0] m_axi_awlen,        // 0: one beat
    output wire [                   2:0] m_axi_awsize,       // whole beats
    output wire [                   1:0] m_axi_awburst,      // INCR
    output wire [                   3:0] m_axi_awcache,  // normal, not cacheable, not bufferable
    output wire [                   2:0] m_axi_awprot,       // unprivileged, secure, data
    output wire                          m_axi_wvalid,       // write data: valid
    input  wire                          m_axi_wready,       // taken
    output wire [            DATA_W-1:0] m_axi_wdata,        // data
    output wire [          DATA_W/8-1:0] m_axi_wstrb,        // the 16 bytes of a record
    output wire                          m_axi_wlast,        // 1
    input  wire                          m_axi_bvalid,       // response of a write: valid
    output wire                          m_axi_bready,       // taken
    input  wire                          m_axi_bid,          // 0
    input  wire [                   1:0] m_axi_bresp,        // response
    // ---- configuration port: configuration port of the device
    output wire                          cfg_valid,  // a word is written to the configuration port
    output wire [             CFG_W-1:0] cfg_data,           // the word
    // the device reports an error of its configuration, from any clock; a level, or a pulse of at
    // least two clocks of clk
    input  wire                          cfg_error,
    // ---- memory of the bitstreams, AXI4 read: memory of the bitstreams, read only
    // memory of the bitstreams: AXI4 read, address
    output wire                          m_axi_cfg_arvalid,
    // memory of the bitstreams: AXI4 read, address
    input  wire                          m_axi_cfg_arready,
    // memory of the bitstreams: AXI4 read, address, byte
    output wire [                  31:0] m_axi_cfg_araddr,
    // memory of the bitstreams: AXI4 read, beats - 1, at most 15
    output wire [                   7:0] m_axi_cfg_arlen,
    // memory of the bitstreams: AXI4 read, 2: 4 bytes per beat
    output wire [                   2:0] m_axi_cfg_arsize,
    // memory of the bitstreams: AXI4 read, 1: INCR
    output wire [                   1:0] m_axi_cfg_arburst,
    // memory of the bitstreams: AXI4 read, constant
    output wire [                   3:0] m_axi_cfg_arcache,
    // memory of the bitstreams: AXI4 read, constant
    output wire [                   2:0] m_axi_cfg_arprot,
    // memory of the bitstreams: AXI4 read, data
    input  wire                          m_axi_cfg_rvalid,
    // memory of the bitstreams: AXI4 read, data
    output wire                          m_axi_cfg_rready,
    // memory of the bitstreams: AXI4 read, data
    input  wire [                  31:0] m_axi_cfg_rdata,
    // memory of the bitstreams: AXI4 read, response
    input  wire [                   1:0] m_axi_cfg_rresp,
    // memory of the bitstreams: AXI4 read, last beat of the burst
    input  wire                          m_axi_cfg_rlast
);

  localparam [31:0] LOCK_COUNT = LOCKS;
  localparam [31:0] GRID_W = COORD_W;
  localparam [31:0] BUS_BYTES = DATA_W / 8;
  localparam [31:0] CACHE_SIZE = CACHE_KB;
  localparam [31:0] QUERY_COUNT = QUERIES;
  localparam [31:0] SLOT_COUNT = SLOTS;
  // what the modules test, with swaps what they can
  localparam integer MOST_1 = SLOTS > 1 && SLOT1_RM_ID > RM_ID ? SLOT1_RM_ID : RM_ID;
  localparam integer MOST_2 = SLOTS > 2 && SLOT2_RM_ID > MOST_1 ? SLOT2_RM_ID : MOST_1;
  localparam integer MOST_3 = SLOTS > 3 && SLOT3_RM_ID > MOST_2 ? SLOT3_RM_ID : MOST_2;
  localparam integer MOST = SWAPS != 0 ? 3 : MOST_3;
  localparam [2:0] KINDS = {MOST > 2, MOST > 1, 1'b1};

  // ---- what every address says: INCR bursts of whole beats. Writes are not bufferable by default:
  // the response comes from where the data are seen by all
  localparam [31:0] BEAT = $clog2(DATA_W / 8);
  localparam [31:0] ARCACHE = AXI_ARCACHE;
  localparam [31:0] AWCACHE = AXI_AWCACHE;
  localparam [31:0] PROT = AXI_PROT;
  `CCHIP_REFUSE(AXI_ARCACHE < 0 || AXI_ARCACHE > 15, cchip_error_AXI_ARCACHE_must_be_0_to_15)
  `CCHIP_REFUSE(AXI_AWCACHE < 0 || AXI_AWCACHE > 15, cchip_error_AXI_AWCACHE_must_be_0_to_15)
  `CCHIP_REFUSE(AXI_PROT < 0 || AXI_PROT > 7, cchip_error_AXI_PROT_must_be_0_to_7)
  assign m_axi_arsize  = BEAT[2:0];
  assign m_axi_arburst = 2'b01;
  assign m_axi_arcache = ARCACHE[3:0];
  assign m_axi_arprot  = PROT[2:0];
  assign {m_axi_awsize, m_axi_awburst, m_axi_awprot} = {m_axi_arsize, m_axi_arburst, m_axi_arprot};
  assign m_axi_awcache = AWCACHE[3:0];
  assign m_axi_cfg_arsize = 3'b010;
  assign {m_axi_cfg_arburst, m_axi_cfg_arcache, m_axi_cfg_arprot} = {
    m_axi_arburst, m_axi_arcache, m_axi_arprot
  };

  // ---- registers
  wire clear, enable, reset_request, resetting, reset_done, idle;
  wire read_outstanding, write_outstanding;
  wire [8:0] status, status_enable;
  wire status_write;
  wire [31:0] step_limit, memory_limit;
  wire [7:0] open_limit;
  wire [2:0] pairs_each;
  wire [57:0] query_base;
  wire [3:0] query_size_log2;
  wire [15:0] query_producer, query_consumer;
  wire query_failed, record_failed;
  wire [59:0] record_base;
  wire [4:0] record_size_log2;
  wire [31:0] record_consumer, record_producer;
  wire [4*32-1:0] lock_first, lock_last;
  wire [31:0] invalidate_first, invalidate_last;
  wire invalidate_go, invalidate_ready;
  wire counter_read;
  wire [1:0] counter_ack;
  wire [63:0] counter_data;
  wire [9:0] read_word, write_word;
  wire [31:0] write_data;
  wire [3:0] write_bytes;
  reg [4:0] chip_event_q;  // {invalidated, reset done, record failed, query failed, record}
  // of swaps
  wire swap_abort, swap_enable, command_go, command_force, write_table, read_table, read_phases;
  wire read_swaps, read_rejected, read_stalls, read_pairs, swap_ack;
  wire [`CCHIP_SLOT_ID_W-1:0] command_slot;
  wire [`CCHIP_RM_ID_W-1:0] command_module;
  wire [31:0] shutdown_limit, bitstream_limit, minimum_batch, maximum_age;
  wire [`CCHIP_SWAP_REPORT_W-1:0] swap_report;
  wire [2:0] swap_events;  // {lost, error, done}
  wire [31:0] swap_lost, table_data, phase_clocks, swap_data;
  wire [4*`CCHIP_PAIR_COUNT_W-1:0] slot_outstanding;
  wire [4*`CCHIP_RM_ID_W-1:0] slot_rm_id;
  wire [3:0] slot_decoupled;
  wire [4*`CCHIP_PHASE_W-1:0] slot_phase;
  wire answered, refused_provider, count_swap, count_rejected, count_stall;
  wire [`CCHIP_KIND_W-1:0] answered_module;
  wire [8:0] events = {refused_provider, swap_events, chip_event_q};
  reg invalidate_q, invalidating_q;  // a command waits; one waits or is in progress
  // it is a command: after a reset the cache clears itself, which ends without an event
  reg commanded_q;
  wire regs_rst;  // a clock later, as those of the other blocks
  cchip_reset_copy u_regs_reset (.clk(clk), .rst(rst), .rst_copy(regs_rst));
  cchip_chip_regs u_regs (
      .clk                                 (clk),
      .rst                                 (regs_rst),
      .s_axil_awvalid                      (s_axil_awvalid),
      .s_axil_awready                      (s_axil_awready),
      .s_axil_awaddr                       (s_axil_awaddr),
      .s_axil_awprot                       (s_axil_awprot),
      .s_axil_wvalid                       (s_axil_wvalid),
      .s_axil_wready                       (s_axil_wready),
      .s_axil_wdata                        (s_axil_wdata),
      .s_axil_wstrb                        (s_axil_wstrb),
      .s_axil_bvalid                       (s_axil_bvalid),
      .s_axil_bready                       (s_axil_bready),
      .s_axil_bresp                        (s_axil_bresp),
      .s_axil_arvalid                      (s_axil_arvalid),
      .s_axil_arready                      (s_axil_arready),
      .s_axil_araddr                       (s_axil_araddr),
      .s_axil_arprot                       (s_axil_arprot),
      .s_axil_rvalid                       (s_axil_rvalid),
      .s_axil_rready                       (s_axil_rready),
      .s_axil_rdata                        (s_axil_rdata),
      .s_axil_rresp                        (s_axil_rresp),
      .hwif_out_external_raddr             (read_word),
      .hwif_in_external_ack                (counter_ack[0] | counter_ack[1] | swap_ack |
          read_phases | read_table),
      .hwif_in_external_rdata              (counter_data[31:0] | counter_data[63:32] | swap_data |
          (phase_clocks & {32{read_phases}}) | (table_data & {32{read_table}})),
      .hwif_out_external_waddr             (write_word),
      .hwif_out_external_wdata             (write_data),
      .hwif_out_external_wstrb             (write_bytes),
      .hwif_in_capabilities_locks          (LOCK_COUNT[2:0]),
      .hwif_in_capabilities_slots          (SLOT_COUNT[2:0]),
      .hwif_in_capabilities_swaps          (SWAPS != 0),
      .hwif_in_capabilities_kinds          (KINDS),
      .hwif_in_capabilities_coord_w        (GRID_W[7:0]),
      .hwif_in_capacity_bus_bytes          (BUS_BYTES[7:0]),
      .hwif_in_capacity_cache_kb           (CACHE_SIZE[15:0]),
      .hwif_in_capacity_queries            (QUERY_COUNT[7:0]),
      .hwif_out_control_clear              (clear),
      .hwif_out_control_soft_reset         (reset_request),
      .hwif_out_control_enable             (enable),
      .hwif_in_control_enable_hwclr        (resetting),
      .hwif_in_status_write_outstanding    (write_outstanding),
      .hwif_in_status_read_outstanding     (read_outstanding),
      .hwif_in_status_invalidating         (invalidating_q),
      .hwif_in_status_record_failed        (record_failed),
      .hwif_in_status_query_failed         (query_failed),
      .hwif_in_status_idle                 (idle),
      .hwif_in_status_resetting            (resetting),
      .hwif_out_interrupt_status_write     (status_write),
      .hwif_out_interrupt_status_no_provider(status[8]),
      .hwif_in_interrupt_status_no_provider_hwset(events[8]),
      .hwif_out_interrupt_status_swap_lost (status[7]),
      .hwif_in_interrupt_status_swap_lost_hwset(events[7]),
      .hwif_out_interrupt_status_swap_error(status[6]),
      .hwif_in_interrupt_status_swap_error_hwset(events[6]),
      .hwif_out_interrupt_status_swap_done (status[5]),
      .hwif_in_interrupt_status_swap_done_hwset(events[5]),
      .hwif_out_interrupt_status_invalidated(status[4]),
      .hwif_in_interrupt_status_invalidated_hwset(events[4]),
      .hwif_out_interrupt_status_reset_done(status[3]),
      .hwif_in_interrupt_status_reset_done_hwset(events[3]),
      .hwif_out_interrupt_status_record_failed(status[2]),
      .hwif_in_interrupt_status_record_failed_hwset(events[2]),
      .hwif_out_interrupt_status_query_failed(status[1]),
      .hwif_in_interrupt_status_query_failed_hwset(events[1]),
      .hwif_out_interrupt_status_record    (status[0]),
      .hwif_in_interrupt_status_record_hwset(events[0]),
      .hwif_out_interrupt_enable_no_provider(status_enable[8]),
      .hwif_out_interrupt_enable_swap_lost (status_enable[7]),
      .hwif_out_interrupt_enable_swap_error(status_enable[6]),
      .hwif_out_interrupt_enable_swap_done (status_enable[5]),
      .hwif_out_interrupt_enable_invalidated(status_enable[4]),
      .hwif_out_interrupt_enable_reset_done(status_enable[3]),
      .hwif_out_interrupt_enable_record_failed(status_enable[2]),
      .hwif_out_interrupt_enable_query_failed(status_enable[1]),
      .hwif_out_interrupt_enable_record    (status_enable[0]),
      .hwif_out_step_limit_steps           (step_limit),
      .hwif_out_memory_limit_clocks        (memory_limit),
      .hwif_out_open_limit_pairs           (open_limit),
      .hwif_out_pairs_each_pairs           (pairs_each),
      .hwif_out_query_base_low_value       (query_base[25:0]),
      .hwif_out_query_base_high_value      (query_base[57:26]),
      .hwif_out_query_size_log2            (query_size_log2),
      .hwif_out_query_producer_count       (query_producer),
      .hwif_in_query_producer_count_hwclr  ({16{resetting}}),
      .hwif_in_query_consumer_count        (query_consumer),
      .hwif_out_record_base_low_value      (record_base[27:0]),
      .hwif_out_record_base_high_value     (record_base[59:28]),
      .hwif_out_record_size_log2           (record_size_log2),
      .hwif_out_record_consumer_count      (record_consumer),
      .hwif_in_record_consumer_count_hwclr ({32{resetting}}),
      .hwif_in_record_producer_count       (record_producer),
      .hwif_out_lock_first_line            (lock_first),
      .hwif_out_lock_last_line             (lock_last),
      .hwif_out_invalidate_first_line      (invalidate_first),
      .hwif_out_invalidate_last_line       (invalidate_last),
      .hwif_out_invalidate_go              (invalidate_go),
      .hwif_out_counter_read               (counter_read),
      .hwif_out_swap_control_abort         (swap_abort),
      .hwif_out_swap_control_scheduler_enable(swap_enable),
      .hwif_out_swap_command_go            (command_go),
      .hwif_out_swap_command_force         (command_force),
      .hwif_out_swap_command_module_id     (command_module),
      .hwif_out_swap_command_slot          (command_slot),
      .hwif_in_swap_report_module_id       (swap_report[`CCHIP_SWAP_REPORT_MODULE]),
      .hwif_in_swap_report_slot            (swap_report[`CCHIP_SWAP_REPORT_SLOT]),
      .hwif_in_swap_report_code            (swap_report[`CCHIP_SWAP_REPORT_CODE]),
      .hwif_in_swap_report_lost_pairs      (swap_report[`CCHIP_SWAP_REPORT_LOST]),
      .hwif_out_swap_shutdown_limit_clocks (shutdown_limit),
      .hwif_out_swap_memory_limit_clocks   (bitstream_limit),
      .hwif_out_swap_minimum_batch_pairs   (minimum_batch),
      .hwif_out_swap_maximum_age_clocks    (maximum_age),
      .hwif_in_slot_status_outstanding     (slot_outstanding),
      .hwif_in_slot_status_decoupled       (slot_decoupled),
      .hwif_in_slot_status_phase           (slot_phase),
      .hwif_in_slot_status_module_id       (slot_rm_id),
      .hwif_in_swap_lost_value             (swap_lost),
      .hwif_out_swaps_read                 (read_swaps),
      .hwif_out_rejected_read              (read_rejected),
      .hwif_out_stalls_read                (read_stalls),
      .hwif_out_phase_clocks_read          (read_phases),
      .hwif_out_pairs_read                 (read_pairs),
      .hwif_out_bitstream_read             (read_table),
      .hwif_out_bitstream_write            (write_table)
  );

  // ---- events, commands
  wire invalidating = invalidate_q | ~invalidate_ready;
  reg irq_q, query_failed_q, record_failed_q;
  reg [31:0] record_producer_q;
  always @(posedge clk)
    if (rst) begin
      {irq_q, query_failed_q, record_failed_q} <= 3'd0;
      {invalidate_q, invalidating_q, commanded_q} <= 3'd0;
      chip_event_q <= 5'd0;
      record_producer_q <= 32'd0;
    end else begin
      irq_q             <= |(status & status_enable) & ~status_write;
      invalidate_q      <= ~resetting & (invalidate_go | (invalidate_q & ~invalidate_ready));
      invalidating_q    <= ~resetting & invalidating;
      commanded_q       <= ~resetting & (invalidate_q | (commanded_q & invalidating_q));
      query_failed_q    <= query_failed;
      record_failed_q   <= record_failed;
      record_producer_q <= record_producer;
      chip_event_q      <= {
        commanded_q & invalidating_q & ~invalidating,
        reset_done,
        record_failed & ~record_failed_q,
        query_failed & ~query_failed_q,
        record_producer != record_producer_q && !resetting
      };
    end
  assign irq = irq_q;

  cchip_soft_reset u_reset (
      .clk        (clk),
      .rst        (rst),
      .request    (reset_request),
      .outstanding(read_outstanding | write_outstanding),
      .resetting  (resetting),
      .done       (reset_done)
  );

  // ---- counters: words 0x40 to 0x4F are eight of 64 bits, words 0x50 to 0x57 eight of 32; a bank
  // has four of each
  wire count_step, count_leaf_pair, count_pair, count_box_busy;
  wire count_query, count_error, count_record, count_record_wait;
  wire [1:0] count_hit, count_miss;
  reg [15:0] count_q;
  always @(posedge clk)
    count_q <= {
      2'd0, m_axi_arvalid & m_axi_arready, count_leaf_pair, count_miss, count_hit,
      count_record_wait, count_record, count_error, count_query,
      count_pair, count_step, count_box_busy, 1'b1
    };
  wire narrow = read_word[4];
  wire bank = narrow ? read_word[2] : read_word[3];
  genvar b;
  generate
    for (b = 0; b < 2; b = b + 1) begin : gen_bank
      cchip_counter_file u_counters (
          .clk         (clk),
          .rst         (rst),
          .clear       (clear),
          .count       (count_q[8*b+:8]),
          .read        (counter_read && bank == b[0]),
          .read_high   (~narrow & read_word[0]),
          .read_counter({narrow, narrow ? read_word[1:0] : read_word[2:1]}),
          .ack         (counter_ack[b]),
          .read_data   (counter_data[32*b+:32])
      );
    end
  endgenerate

  wire read_swap_counter = read_swaps | read_rejected | read_stalls | read_pairs;
  generate
    if (SWAPS == 0) begin : gen_swap_counters
      assign swap_ack  = read_swap_counter;
      assign swap_data = 32'd0;
      wire unused_counts = &{1'b0, answered, answered_module, count_swap, count_rejected,
          count_stall};
    end else begin : gen_swap_counters
      // words 0x140 on are five of 64 bits, words 0x120 on three of 32
      wire [4:0] answered_by = answered ? 5'd1 << answered_module : 5'd0;
      cchip_counter_file #(
          .WIDE(5)
      ) u_counters (
          .clk         (clk),
          .rst         (rst),
          .clear       (clear),
          .count       ({count_stall, count_rejected, count_swap, answered_by}),
          .read        (read_swap_counter),
          .read_high   (read_pairs & read_word[0]),
          .read_counter(read_word[6] ? read_word[3:1] : 3'd5 + {1'b0, read_word[1:0]}),
          .ack         (swap_ack),
          .read_data   (swap_data)
      );
    end
  endgenerate

  // ---- swaps of the slots' modules
  localparam integer COUNT_W = $clog2(QUEUE_DEPTH + 1);
  wire [3*COUNT_W-1:0] waiting;
  wire [2:0] full, no_provider;  // of the kinds 1, 2, 3
  wire [`CCHIP_TO_SLOTS_W(SLOTS)-1:0] to_slots;
  wire [`CCHIP_FROM_SLOTS_W(SLOTS)-1:0] from_slots;
  cchip_swaps #(
      .SLOTS      (SLOTS),
      .SWAPS      (SWAPS),
      .COUNT_W    (COUNT_W),
      .CFG_W      (CFG_W),
      .CFG_DIVIDER(CFG_DIVIDER)
  ) u_swaps (
      .clk           (clk),
      .rst           (regs_rst),
      .waiting       (waiting),
      .full          (full),
      .no_provider   (no_provider),
      .to_slots      (to_slots),
      .from_slots    (from_slots),
      .phase         (slot_phase),
      .clear         (clear),
      .abort_swap    (swap_abort),
      .enable        (swap_enable),
      .command_valid (command_go),
      .command_slot  (command_slot),
      .command_module(command_module),
      .command_force (command_force),
      .shutdown_limit(shutdown_limit),
      .memory_limit  (bitstream_limit),
      .min_batch     (minimum_batch),
      .max_age       (maximum_age),
      .last_report   (swap_report),
      .swap_events   (swap_events),
      .lost          (swap_lost),
      .write_table   (write_table),
      .write_word    (write_word[6:0]),
      .write_data    (write_data),
      .write_bytes   (write_bytes),
      .read_word     (read_word[6:0]),
      .table_data    (table_data),
      .phase_clocks  (phase_clocks),
      .swapped       (count_swap),
      .rejected      (count_rejected),
      .stall         (count_stall),
      .cfg_valid     (cfg_valid),
      .cfg_data      (cfg_data),
      .cfg_error     (cfg_error),
      .m_axi_arvalid (m_axi_cfg_arvalid),
      .m_axi_arready (m_axi_cfg_arready),
      .m_axi_araddr  (m_axi_cfg_araddr),
      .m_axi_arlen   (m_axi_cfg_arlen),
      .m_axi_rvalid  (m_axi_cfg_rvalid),
      .m_axi_rready  (m_axi_cfg_rready),
      .m_axi_rdata   (m_axi_cfg_rdata),
      .m_axi_rresp   (m_axi_cfg_rresp),
      .m_axi_rlast   (m_axi_cfg_rlast)
  );

  cchip_chip_core #(
      .QUERIES     (QUERIES),
      .PAIRS       (PAIRS),
      .LEAVES      (LEAVES),
      .STACK       (STACK),
      .LEAF_DEPTH  (LEAF_DEPTH),
      .CACHE_KB    (CACHE_KB),
      .MISSES      (MISSES),
      .LOCKS       (LOCKS),
      .COORD_W     (COORD_W),
      .SUBSTAGES   (SUBSTAGES),
      .PASSES      (PASSES),
      .QUEUE_DEPTH (QUEUE_DEPTH),
      .LEAF_NUMBERS(LEAF_NUMBERS),
      .SLOTS       (SLOTS),
      .SWAPS       (SWAPS),
      .RM_ID       (RM_ID),
      .SLOT1_RM_ID (SLOT1_RM_ID),
      .SLOT2_RM_ID (SLOT2_RM_ID),
      .SLOT3_RM_ID (SLOT3_RM_ID),
      .CFG_W       (CFG_W),
      .ROC_CYCLES  (ROC_CYCLES),
      .SIMULATION  (SIMULATION),
      .SEED        (SEED),
      .DATA_W      (DATA_W)
  ) u_core (
      .clk                 (clk),
      .rst                 (rst),
      .core_rst            (resetting),
      .pairs_each          (pairs_each),
      .step_limit          (step_limit),
      .open_limit          (open_limit),
      .memory_limit        (memory_limit),
      .enable              (enable),
      .query_base          (query_base),
      .query_size_log2     (query_size_log2),
      .query_producer      (query_producer),
      .query_consumer      (query_consumer),
      .query_failed        (query_failed),
      .record_base         (record_base),
      .record_size_log2    (record_size_log2),
      .record_consumer     (record_consumer),
      .record_producer     (record_producer),
      .record_failed       (record_failed),
      .lock_first          (lock_first[LOCKS*32-1:0]),
      .lock_last           (lock_last[LOCKS*32-1:0]),
      .invalidate_valid    (invalidate_q),
      .invalidate_ready    (invalidate_ready),
      .invalidate_first    (invalidate_first),
      .invalidate_last     (invalidate_last),
      .read_outstanding    (read_outstanding),
      .write_outstanding   (write_outstanding),
      .idle                (idle),
      .count_step          (count_step),
      .count_leaf_pair     (count_leaf_pair),
      .count_pair          (count_pair),
      .count_box_busy      (count_box_busy),
      .count_query         (count_query),
      .count_error         (count_error),
      .count_record        (count_record),
      .count_record_wait   (count_record_wait),
      .count_hit           (count_hit),
      .count_miss          (count_miss),
      .answered            (answered),
      .answered_module     (answered_module),
      .refused_provider    (refused_provider),
      .slot_outstanding    (slot_outstanding),
      .slot_rm_id          (slot_rm_id),
      .slot_decoupled      (slot_decoupled),
      .swap_waiting        (waiting),
      .swap_full           (full),
      .no_provider         (no_provider),
      .to_slots            (to_slots),
      .from_slots          (from_slots),
      .cfg_valid           (cfg_valid),
      .cfg_data            (cfg_data),
      .m_axi_arvalid       (m_axi_arvalid),
      .m_axi_arready       (m_axi_arready),
      .m_axi_arid          (m_axi_arid),
      .m_axi_araddr        (m_axi_araddr),
      .m_axi_arlen         (m_axi_arlen),
      .m_axi_rvalid        (m_axi_rvalid),
      .m_axi_rready        (m_axi_rready),
      .m_axi_rid           (m_axi_rid),
      .m_axi_rdata         (m_axi_rdata),
      .m_axi_rresp         (m_axi_rresp),
      .m_axi_rlast         (m_axi_rlast),
      .m_axi_awvalid       (m_axi_awvalid),
      .m_axi_awready       (m_axi_awready),
      .m_axi_awid          (m_axi_awid),
      .m_axi_awaddr        (m_axi_awaddr),
      .m_axi_awlen         (m_axi_awlen),
      .m_axi_wvalid        (m_axi_wvalid),
      .m_axi_wready        (m_axi_wready),
      .m_axi_wdata         (m_axi_wdata),
      .m_axi_wstrb         (m_axi_wstrb),
      .m_axi_wlast         (m_axi_wlast),
      .m_axi_bvalid        (m_axi_bvalid),
      .m_axi_bready        (m_axi_bready),
      .m_axi_bid           (m_axi_bid),
      .m_axi_bresp         (m_axi_bresp)
  );

  wire unused = &{1'b0, read_word, write_word, lock_first, lock_last};

endmodule
`default_nettype wire
