// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_primtest_subsystem: primitive tests of three or four kinds in 1 to 4 slots that are
// exchanged at run time. Pairs of any kind in, answers out, the exchange of modules done by itself
// or by software.
//   latency      that of the test + 18 clocks while a slot serves its kind; a swap longer otherwise
//   throughput   in: a pair every 2 clocks; to the slots: every 3, with quads every 4; that of the
//                tests, of points a pair every 7
//   in flight    QUEUE_DEPTH pairs of each kind in the queues, CONTEXTS for each slot
//   order        answers in any order; tag and kind of the pair come back with each exactly once. A
//                pair that a swap by force gave up, or that no slot can test, is answered as open:
//                hit 1, grid 1, definite 0, axis class CCHIP_AXIS_ILLEGAL
//   reset        drops all pairs and clears registers; a slot whose rewriting was cut off stays
//                decoupled until a good swap
//   errors       codes CCHIP_SWAP_* in the register report, interrupt (0 for a clock after a write
//                of its status); see docs/hardware/registers.md
// Pairs: cchip_operand_memory, cchip_descriptor_queues; slots and their modules: cchip_slots,
// cchip_swaps.
module cchip_primtest_subsystem #(
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight in a slot; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    parameter integer ABSOLUTE_PROJECTION = 0,  // 1: one projector more, same results; legal: 0, 1
    // 0: warped quads are left open where the directed beats do not decide; legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    parameter integer SLOTS = 2,                                      // slots; legal: 1..4
    parameter integer QUEUE_DEPTH = 128,  // pairs in each queue; legal: a power of two, 16..1024
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    // clocks per word of the port: 2 is 50 MHz at a clock of 100 MHz; legal: >= 1
    parameter integer CFG_DIVIDER = 2,
    // reset after a configuration (clock); legal: 1..32
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    parameter integer SLOT0_RM_ID = 1,  // module of slot 0 at power-up; legal: 0..KINDS
    parameter integer SLOT1_RM_ID = 3,  // module of slot 1 at power-up; legal: 0..KINDS
    parameter integer SLOT2_RM_ID = 2,  // module of slot 2 at power-up; legal: 0..KINDS
    parameter integer SLOT3_RM_ID = 1,  // module of slot 3 at power-up; legal: 0..KINDS
    // 0: each slot is a partition of an FPGA; 1: each slot holds all modules, exchanged by the
    // words of the configuration port (see cchip_pr_slot); legal: 0, 1
    parameter integer SIMULATION = 0,
    // start of the random numbers of a simulated reconfiguration; legal: any
    parameter integer SEED = 1,
    // ARCACHE: 3 normal memory, 15 a coherent port; legal: 0..15
    parameter integer AXI_ARCACHE = 3,
    parameter integer AXI_PROT = 0  // AxPROT: 0 secure, 2 non-secure; legal: 0..7
) (
    // ---- clock and reset
    input  wire                                   clk,                // clock, rising edge
    input  wire                                   rst,  // synchronous reset, active high
    // ---- requests: pairs; kind = ModuleId of the test: 1 tri-tri, 2 tri-quad, 3 quad-quad, 4
    //      point-tri with s_pair_a as cchip_primtest_point_tri has it; a kind above KINDS counts as
    //      illegal
    input  wire                                   s_pair_valid,       // a pair is offered
    // the pair is accepted if s_pair_valid = 1 as well
    output wire                                   s_pair_ready,
    // test that is asked for, ModuleId: 1 tri-tri, 2 tri-quad, 3 quad-quad; 0 is illegal
    input  wire [              `CCHIP_KIND_W-1:0] s_pair_kind,
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,  // anything; returned with the result
    // 0 EXHAUSTIVE, 1 DIRECTED; 2 and 3 are reserved
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    // primitive A: vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest; slot 3 of a triangle is
    // ignored
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,           // primitive B likewise
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,         // eta, as in cchip_primtest
    // ---- results
    output wire                                   m_result_valid,     // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                                   m_result_ready,
    output wire [              `CCHIP_KIND_W-1:0] m_result_kind,      // kind of the pair
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,       // tag of the pair
    // grid or not definite: never a false "no"
    output wire                                   m_result_hit,
    // the exact answer for the grid coordinates; 1 without a test
    output wire                                   m_result_grid,
    // grid is proven for the unrounded primitives
    output wire                                   m_result_definite,
    // witness {class[2:0], k[2:0], l[2:0]}; class 7: not tested
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,     // axes issued for the pair
    // ---- registers, AXI4-Lite
    input  wire                                   s_axil_awvalid,     // AXI4-Lite, write address
    output wire                                   s_axil_awready,     // AXI4-Lite, write address
    input  wire [                           11:0] s_axil_awaddr,  // AXI4-Lite, write address, byte
    input  wire [                            2:0] s_axil_awprot,      // AXI4-Lite, ignored
    input  wire                                   s_axil_wvalid,      // AXI4-Lite, write data
    output wire                                   s_axil_wready,      // AXI4-Lite, write data
    input  wire [                           31:0] s_axil_wdata,       // AXI4-Lite, write data
    input  wire [                            3:0] s_axil_wstrb,       // AXI4-Lite, byte lanes
    output wire                                   s_axil_bvalid,      // AXI4-Lite, write response
    input  wire                                   s_axil_bready,      // AXI4-Lite, write response
    output wire [                            1:0] s_axil_bresp,       // AXI4-Lite, OKAY or SLVERR
    input  wire                                   s_axil_arvalid,     // AXI4-Lite, read address
    output wire                                   s_axil_arready,     // AXI4-Lite, read address
    input  wire [                           11:0] s_axil_araddr,  // AXI4-Lite, read address, byte
    input  wire [                            2:0] s_axil_arprot,      // AXI4-Lite, ignored
    output wire                                   s_axil_rvalid,      // AXI4-Lite, read data
    input  wire                                   s_axil_rready,      // AXI4-Lite, read data
    output wire [                           31:0] s_axil_rdata,       // AXI4-Lite, read data
    output wire [                            1:0] s_axil_rresp,       // AXI4-Lite, OKAY or SLVERR
    // ---- interrupt
    // 1 while an enabled bit of interrupt_status is 1; 0 for a clock after each write of it
    output wire                                   irq,
    // ---- memory of the bitstreams, AXI4 read: memory of the bitstreams, AXI4, read only
    output wire                                   m_axi_arvalid,      // AXI4 read, address
    input  wire                                   m_axi_arready,      // AXI4 read, address
    output wire [                           31:0] m_axi_araddr,       // AXI4 read, address, byte
    output wire [                            7:0] m_axi_arlen,  // AXI4 read, beats - 1, at most 15
    output wire [                            2:0] m_axi_arsize,  // AXI4 read, 2: 4 bytes per beat
    output wire [                            1:0] m_axi_arburst,      // AXI4 read, 1: INCR
    output wire [                            3:0] m_axi_arcache,      // AXI4 read, constant
    output wire [                            2:0] m_axi_arprot,       // AXI4 read, constant
    input  wire                                   m_axi_rvalid,       // AXI4 read, data
    output wire                                   m_axi_rready,       // AXI4 read, data
    input  wire [                           31:0] m_axi_rdata,        // AXI4 read, data
    input  wire [                            1:0] m_axi_rresp,        // AXI4 read, response
    input  wire                                   m_axi_rlast,  // AXI4 read, last beat of the burst
    // ---- configuration port: configuration port of the device
    // a word is written to the configuration port
    output wire                                   cfg_valid,
    output wire [                      CFG_W-1:0] cfg_data,           // the word
    // the device reports an error of its configuration, from any clock; a level, or a pulse of at
    // least two clocks of clk
    input  wire                                   cfg_error
);

  reg irq_q;
  assign irq = irq_q;

  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);
  localparam integer COUNT_W = $clog2(QUEUE_DEPTH + 1);
  localparam integer PLACE_W = `CCHIP_KIND_BITS(KINDS) + $clog2(QUEUE_DEPTH);
  localparam [31:0] SLOT_COUNT = SLOTS;
  localparam [31:0] KIND_COUNT = KINDS;
  localparam [31:0] PORT_W = CFG_W;
  localparam [31:0] GRID_W = COORD_W;
  localparam [31:0] DEPTH = QUEUE_DEPTH;

  // ---- what every address says: INCR bursts of whole beats
  localparam [31:0] ARCACHE = AXI_ARCACHE;
  localparam [31:0] PROT = AXI_PROT;
  `CCHIP_REFUSE(AXI_ARCACHE < 0 || AXI_ARCACHE > 15, cchip_error_AXI_ARCACHE_must_be_0_to_15)
  `CCHIP_REFUSE(AXI_PROT < 0 || AXI_PROT > 7, cchip_error_AXI_PROT_must_be_0_to_7)
  assign m_axi_arsize  = 3'b010;
  assign m_axi_arburst = 2'b01;
  assign m_axi_arcache = ARCACHE[3:0];
  assign m_axi_arprot  = PROT[2:0];

  // ---- pairs that wait: descriptors in queues, vertices in the operand memory
  wire [KINDS:0] some, queue_room, kind;
  wire [(KINDS+1)*COUNT_W-1:0] waiting;
  wire kind_room, look, pop;
  wire [PLACE_W-1:0] write_place, read_place;
  wire [1:0] vertex;
  wire [POINT_W-1:0] a, b;
  wire [`CCHIP_DESCRIPTOR_W-1:0] descriptor;

  cchip_operand_memory #(
      .COORD_W(COORD_W),
      .PLACE_W(PLACE_W)
  ) u_operands (
      .clk         (clk),
      .rst         (rst),
      .s_pair_valid(s_pair_valid),
      .s_pair_ready(s_pair_ready),
      .s_pair_kind (s_pair_kind),
      .s_pair_a    (s_pair_a),
      .s_pair_b    (s_pair_b),
      .room        (kind_room),
      .place       (write_place),
      .m_place     (read_place),
      .m_vertex    (vertex),
      .m_a         (a),
      .m_b         (b)
  );

  cchip_descriptor_queues #(
      .WIDTH(`CCHIP_DESCRIPTOR_W),
      .KINDS(KINDS),
      .DEPTH(QUEUE_DEPTH)
  ) u_queues (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_pair_valid & s_pair_ready),
      .s_ready(kind_room),
      .s_kind (s_pair_kind),
      .s_data (`CCHIP_DESCRIPTOR_OF(s_pair_tag, s_pair_err, s_pair_mode)),
      .s_place(write_place),
      .some   (some),
      .waiting(waiting),
      .room   (queue_room),
      .kind   (kind),
      .look   (look),
      .pop    (pop),
      .m_place(read_place),
      .m_data (descriptor)
  );

  // ---- registers
  wire clear, abort_swap, enable, go, force_swap;
  wire [`CCHIP_RM_ID_W-1:0] command_module;
  wire [`CCHIP_SLOT_ID_W-1:0] command_slot;
  wire [31:0] shutdown_limit, memory_limit, minimum_batch, maximum_age;
  wire [`CCHIP_SWAP_REPORT_W-1:0] last_report;
  wire [4:0] status, status_enable;
  wire status_write;
  wire [31:0] lost;
  wire [2:0] swap_events;  // {lost, error, done}
  wire [4*`CCHIP_PAIR_COUNT_W-1:0] outstanding  /* verilator public_flat_rd */;
  wire [4*`CCHIP_RM_ID_W-1:0] rm_id;
  wire [3:0] decoupled;
  wire [4*`CCHIP_PHASE_W-1:0] phase;
  wire answered, refused_kind, refused_provider;
  wire [`CCHIP_KIND_W-1:0] answered_module;

  // external registers: word 0x100/4 on are counters of 64 bits, 0x080/4 on counters of 32; the
  // clocks of phase p are in word 0x0C0/4 + p
  wire [9:0] read_word, write_word;
  wire [31:0] write_data, counter_data, phase_clocks, table_data;
  wire [3:0] write_bytes;
  wire read_swaps, read_rejected, read_stalls, read_pairs, read_phases, read_table, write_table;
  wire swapped, rejected, stall, counter_ack;
  wire [4:0] answered_by = answered ? 5'd1 << answered_module : 5'd0;

  cchip_counter_file #(
      .WIDE(5)
  ) u_counters (
      .clk         (clk),
      .rst         (rst),
      .clear       (clear),
      .count       ({stall, rejected, swapped, answered_by}),
      .read        (read_pairs | read_swaps | read_rejected | read_stalls),
      .read_high   (read_pairs & read_word[0]),
      .read_counter(read_word[6] ? read_word[3:1] : 3'd5 + {1'b0, read_word[1:0]}),
      .ack         (counter_ack),
      .read_data   (counter_data)
  );

  cchip_subsystem_regs u_regs (
      .clk                                         (clk),
      .rst                                         (rst),
      .s_axil_awvalid                              (s_axil_awvalid),
      .s_axil_awready                              (s_axil_awready),
      .s_axil_awaddr                               (s_axil_awaddr),
      .s_axil_awprot                               (s_axil_awprot),
      .s_axil_wvalid                               (s_axil_wvalid),
      .s_axil_wready                               (s_axil_wready),
      .s_axil_wdata                                (s_axil_wdata),
      .s_axil_wstrb                                (s_axil_wstrb),
      .s_axil_bvalid                               (s_axil_bvalid),
      .s_axil_bready                               (s_axil_bready),
      .s_axil_bresp                                (s_axil_bresp),
      .s_axil_arvalid                              (s_axil_arvalid),
      .s_axil_arready                              (s_axil_arready),
      .s_axil_araddr                               (s_axil_araddr),
      .s_axil_arprot                               (s_axil_arprot),
      .s_axil_rvalid                               (s_axil_rvalid),
      .s_axil_rready                               (s_axil_rready),
      .s_axil_rdata                                (s_axil_rdata),
      .s_axil_rresp                                (s_axil_rresp),
      .hwif_out_external_raddr                     (read_word),
      .hwif_in_external_ack                        (read_phases | read_table | counter_ack),
      .hwif_in_external_rdata                      (counter_data
          | (phase_clocks & {32{read_phases}}) | (table_data & {32{read_table}})),
      .hwif_out_external_waddr                     (write_word),
      .hwif_out_external_wdata                     (write_data),
      .hwif_out_external_wstrb                     (write_bytes),
      .hwif_in_capabilities_kinds                  (KIND_COUNT[2:0]),
      .hwif_in_capabilities_coord_w                (GRID_W[7:0]),
      .hwif_in_capabilities_cfg_w                  (PORT_W[7:0]),
      .hwif_in_capabilities_slots                  (SLOT_COUNT[7:0]),
      .hwif_in_queue_depth_pairs                   (DEPTH),
      .hwif_out_control_clear                      (clear),
      .hwif_out_control_abort                      (abort_swap),
      .hwif_out_control_scheduler_enable           (enable),
      .hwif_out_command_go                         (go),
      .hwif_out_command_force                      (force_swap),
      .hwif_out_command_module_id                  (command_module),
      .hwif_out_command_slot                       (command_slot),
      .hwif_in_report_module_id                    (last_report[`CCHIP_SWAP_REPORT_MODULE]),
      .hwif_in_report_slot                         (last_report[`CCHIP_SWAP_REPORT_SLOT]),
      .hwif_in_report_code                         (last_report[`CCHIP_SWAP_REPORT_CODE]),
      .hwif_in_report_lost_pairs                   (last_report[`CCHIP_SWAP_REPORT_LOST]),
      .hwif_out_interrupt_status_write             (status_write),
      .hwif_out_interrupt_status_illegal_kind      (status[4]),
      .hwif_in_interrupt_status_illegal_kind_hwset (refused_kind),
      .hwif_out_interrupt_status_no_provider       (status[3]),
      .hwif_in_interrupt_status_no_provider_hwset  (refused_provider),
      .hwif_out_interrupt_status_lost              (status[2]),
      .hwif_in_interrupt_status_lost_hwset         (swap_events[2]),
      .hwif_out_interrupt_status_error             (status[1]),
      .hwif_in_interrupt_status_error_hwset        (swap_events[1]),
      .hwif_out_interrupt_status_done              (status[0]),
      .hwif_in_interrupt_status_done_hwset         (swap_events[0]),
      .hwif_out_interrupt_enable_illegal_kind      (status_enable[4]),
      .hwif_out_interrupt_enable_no_provider       (status_enable[3]),
      .hwif_out_interrupt_enable_lost              (status_enable[2]),
      .hwif_out_interrupt_enable_error             (status_enable[1]),
      .hwif_out_interrupt_enable_done              (status_enable[0]),
      .hwif_out_shutdown_limit_clocks              (shutdown_limit),
      .hwif_out_memory_limit_clocks                (memory_limit),
      .hwif_out_minimum_batch_pairs                (minimum_batch),
      .hwif_out_maximum_age_clocks                 (maximum_age),
      .hwif_in_slot_status_outstanding             (outstanding),
      .hwif_in_slot_status_decoupled               (decoupled),
      .hwif_in_slot_status_phase                   (phase),
      .hwif_in_slot_status_module_id               (rm_id),
      .hwif_in_lost_value                          (lost),
      .hwif_out_swaps_read                         (read_swaps),
      .hwif_out_rejected_read                      (read_rejected),
      .hwif_out_stalls_read                        (read_stalls),
      .hwif_out_phase_clocks_read                  (read_phases),
      .hwif_out_pairs_read                         (read_pairs),
      .hwif_out_bitstream_read                     (read_table),
      .hwif_out_bitstream_write                    (write_table)
  );

  always @(posedge clk) irq_q <= ~rst & ~status_write & |(status & status_enable);

  // ---- slots and swaps
  wire [`CCHIP_TO_SLOTS_W(SLOTS)-1:0] to_slots;
  wire [`CCHIP_FROM_SLOTS_W(SLOTS)-1:0] from_slots;
  wire [KINDS-1:0] no_provider;  // of the kinds from 1 on
  cchip_slots #(
      .COORD_W            (COORD_W),
      .SUBSTAGES          (SUBSTAGES),
      .CONTEXTS           (CONTEXTS),
      .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
      .WARPED_EXACT       (WARPED_EXACT),
      .KINDS              (KINDS),
      .SLOTS              (SLOTS),
      .SWAPS              (1),
      .CFG_W              (CFG_W),
      .ROC_CYCLES         (ROC_CYCLES),
      .SLOT0_RM_ID        (SLOT0_RM_ID),
      .SLOT1_RM_ID        (SLOT1_RM_ID),
      .SLOT2_RM_ID        (SLOT2_RM_ID),
      .SLOT3_RM_ID        (SLOT3_RM_ID),
      .SIMULATION         (SIMULATION),
      .SEED               (SEED)
  ) u_slots (
      .clk             (clk),
      .rst             (rst),
      .core_rst        (1'b0),
      .some            (some),
      .kind            (kind),
      .look            (look),
      .pop             (pop),
      .vertex          (vertex),
      .descriptor      (descriptor),
      .a               (a),
      .b               (b),
      .m_result_valid  (m_result_valid),
      .m_result_ready  (m_result_ready),
      .m_result_kind   (m_result_kind),
      .m_result_data   (`CCHIP_RESULT_OF(m_result_tag, m_result_hit, m_result_grid,
          m_result_definite, m_result_axis, m_result_beats)),
      .answered        (answered),
      .answered_module (answered_module),
      .refused_kind    (refused_kind),
      .refused_provider(refused_provider),
      .outstanding     (outstanding),
      .rm_id           (rm_id),
      .decoupled       (decoupled),
      .no_provider     (no_provider),
      .to_slots        (to_slots),
      .from_slots      (from_slots),
      .cfg_valid       (cfg_valid),
      .cfg_data        (cfg_data)
  );

  cchip_swaps #(
      .KINDS      (KINDS),
      .SLOTS      (SLOTS),
      .COUNT_W    (COUNT_W),
      .CFG_W      (CFG_W),
      .CFG_DIVIDER(CFG_DIVIDER)
  ) u_swaps (
      .clk           (clk),
      .rst           (rst),
      .waiting       (waiting[COUNT_W+:KINDS*COUNT_W]),
      .full          (~queue_room[KINDS:1]),
      .no_provider   (no_provider),
      .to_slots      (to_slots),
      .from_slots    (from_slots),
      .phase         (phase),
      .clear         (clear),
      .abort_swap    (abort_swap),
      .enable        (enable),
      .command_valid (go),
      .command_slot  (command_slot),
      .command_module(command_module),
      .command_force (force_swap),
      .shutdown_limit(shutdown_limit),
      .memory_limit  (memory_limit),
      .min_batch     (minimum_batch),
      .max_age       (maximum_age),
      .last_report   (last_report),
      .swap_events   (swap_events),
      .lost          (lost),
      .write_table   (write_table),
      .write_word    (write_word[6:0]),
      .write_data    (write_data),
      .write_bytes   (write_bytes),
      .read_word     (read_word[6:0]),
      .table_data    (table_data),
      .phase_clocks  (phase_clocks),
      .swapped       (swapped),
      .rejected      (rejected),
      .stall         (stall),
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
      .cfg_error     (cfg_error)
  );

  wire unused = &{1'b0, read_word, write_word, queue_room[0], waiting[COUNT_W-1:0]};

endmodule
`default_nettype wire
