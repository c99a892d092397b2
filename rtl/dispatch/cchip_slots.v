// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_slots: primitive tests in 1 to 4 slots behind the queues of waiting pairs, each pair
// answered exactly once. With SWAPS = 1 cchip_swaps exchanges their modules at run time; with
// SWAPS = 0 they are what SLOTn_RM_ID says, and the inputs of swaps have no effect.
//   pairs        cchip_dispatcher: which module answers for which kinds; a pair of the illegal kind
//                0, of a kind that no slot provides, or that a swap by force gives up, is answered
//                as open: hit 1, grid 1, definite 0
//   latency      6 clocks from `some` to the slot, that of the test, 6 to m_result
//   throughput   a pair every 3 clocks, with quads every 4
//   cuts         every path but rst and core_rst
//   reset        rst: no pair; a slot whose rewriting was cut off stays decoupled until a good
//                swap. core_rst: no pair; a slot that is decoupled keeps the reset that the swap
//                gives it
//   timing       6 clocks from some to the first vertex in a slot, that of the test, 6 from its
//                result to m_result. Swaps: cchip_config_controller.
//   rules        Every pair that is popped is answered exactly once, unless a reset comes in
//                between. Without swaps a kind beyond every slot's module has no provider from the
//                start, so its pairs come back open. core_rst discards the pairs alone: a swap in
//                flight continues and ends well or not, and the slot serves what is loaded then.
//   why          cchip_primtest_subsystem and cchip_chip_core share it, so what a swap does to
//                pairs is written and tested once.
//   test         With its two users: tests/unit/test_cchip_primtest_subsystem.cpp,
//                tests/unit/test_cchip_chip_core.cpp, scripts/run campaign-swaps, make sim-chip.
module cchip_slots #(
    parameter integer COORD_W = 16,  // width of a coordinate (bit); legal: 4..20
    // registers of the primitive test's stages (clock); legal: see cchip_pr_region
    parameter integer SUBSTAGES = `CCHIP_SUBSTAGES_DEFAULT,
    // pairs inside a slot; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    parameter integer ABSOLUTE_PROJECTION = 0,  // see cchip_primtest; legal: 0, 1
    parameter integer WARPED_EXACT = 1,  // see cchip_primtest; legal: 0, 1
    parameter integer EXHAUSTIVE = 1,  // see cchip_primtest; legal: 0, 1
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    parameter integer SLOTS = 1,                                      // slots; legal: 1..4
    parameter integer SWAPS = 0,  // 1: modules are exchanged at run time; legal: 0, 1
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    // reset on configuration (clock); legal: from 1 on
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    parameter integer SLOT0_RM_ID = 1,  // module of slot 0 at power-up; legal: 0..KINDS
    parameter integer SLOT1_RM_ID = 3,  // of slot 1 (module); legal: 0..KINDS
    parameter integer SLOT2_RM_ID = 2,  // of slot 2 (module); legal: 0..KINDS
    parameter integer SLOT3_RM_ID = 1,  // of slot 3 (module); legal: 0..KINDS
    // 1: simulated reconfiguration (see cchip_pr_slot); legal: 0, 1
    parameter integer SIMULATION = 0,
    parameter integer SEED = 1  // start of its random numbers; legal: any
) (
    input  wire                              clk,               // clock, rising edge
    input  wire                              rst,               // synchronous reset, active high
    input  wire                              core_rst,          // resets the pairs, not the swaps
    // ---- queues, kind k at bit k (cchip_descriptor_queues)
    input  wire [                   KINDS:0] some,              // bit k: pairs of kind k wait
    output wire [                   KINDS:0] kind,  // one-hot: the queue that is looked at
    output wire                              look,              // see cchip_descriptor_queues
    output wire                              pop,               // the pair leaves its queue
    output wire [                       1:0] vertex,            // vertex that is read
    // its descriptor, 2 and 3 clocks after pop
    input  wire [   `CCHIP_DESCRIPTOR_W-1:0] descriptor,
    input  wire [`CCHIP_POINT_W(COORD_W)-1:0] a,  // operand of A, 2 clocks after vertex
    input  wire [`CCHIP_POINT_W(COORD_W)-1:0] b,                // operand of B
    // ---- answers
    output wire                              m_result_valid,    // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                              m_result_ready,
    output wire [         `CCHIP_KIND_W-1:0] m_result_kind,     // kind of the pair
    output wire [       `CCHIP_RESULT_W-1:0] m_result_data,     // record RESULT
    // ---- events, one clock: an answer of this module left, 0: of none; a pair was refused
    output wire                              answered,          // an answer left, one clock
    output wire [         `CCHIP_KIND_W-1:0] answered_module,   // module that gave it; 0: left open
    output wire                              refused_kind,  // a pair of kind 0 was taken, one clock
    // a pair of a kind without a provider was taken, one clock
    output wire                              refused_provider,
    // ---- state of the slots: of four, those that are not there show 0
    output wire [ 4*`CCHIP_PAIR_COUNT_W-1:0] outstanding,  // of each of four slots: pairs inside
    output wire [      4*`CCHIP_RM_ID_W-1:0] rm_id,  // of each of four slots: active module
    output wire [                       3:0] decoupled,         // of each of four slots
    // ---- swaps (cchip_swaps): which kinds no slot can serve, the module that a slot shows, what a
    //      swap asks of it and what it answers, words for the configuration port
    // bit k - 1: no slot can get the module of kind k
    input  wire [                 KINDS-1:0] no_provider,
    // {stop: no further pairs, decouple: cut off from the rest, hold_reset: held in reset,
    // roc_start: its reset on configuration begins, one clock}, a bit per slot each
    input  wire [`CCHIP_TO_SLOTS_W(SLOTS)-1:0] to_slots,
    // {quiet: it has no pairs and will get none, decoupled: it is cut off and all its pairs are
    // answered, roc_busy: its reset on configuration lasts, module in the partition, pairs that it
    // gave up in this swap, module that it shows, 0: none}, a field per slot each
    output wire [`CCHIP_FROM_SLOTS_W(SLOTS)-1:0] from_slots,
    // a word is written to the configuration port
    input  wire                              cfg_valid,
    input  wire [                 CFG_W-1:0] cfg_data           // the word
);

  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;
  localparam integer COUNT_OF_PAIRS_W = `CCHIP_PAIR_COUNT_W;
  localparam integer ID_W = `CCHIP_RM_ID_W;
  localparam integer KIND_W = `CCHIP_KIND_W;
  localparam [31:0] MODULES = KINDS;
  wire reset = rst | core_rst;

  `CCHIP_REFUSE(SWAPS != 0 && SWAPS != 1, cchip_error_slots_SWAPS_must_be_0_or_1)
  `CCHIP_REFUSE(KINDS != 3 && KINDS != 4, cchip_error_slots_KINDS_must_be_3_or_4)

  wire [SLOTS-1:0] stop, decouple, hold_reset, roc_start, quiet, slots_decoupled, roc_busy;
  wire [ID_W*SLOTS-1:0] region_rm_id;
  wire [COUNT_OF_PAIRS_W*SLOTS-1:0] lost;
  wire [KIND_W*SLOTS-1:0] slot_module;
  assign {stop, decouple, hold_reset, roc_start} = to_slots;
  assign from_slots = {quiet, slots_decoupled, roc_busy, region_rm_id, lost, slot_module};

  // ---- dispatch
  wire [SLOTS-1:0] vertex_valid, result_valid;
  wire vertex_first, vertex_last;
  wire [SLOTS*`CCHIP_PAIR_ID_W-1:0] vertex_id;
  wire [SLOTS*RESULT_W-1:0] result;
  wire [SLOTS-1:0] idle;
  wire [SLOTS-1:0] region_decoupled;  // slots_decoupled: when all its pairs are answered, too
  wire [ID_W*SLOTS-1:0] slot_rm_id;
  wire [COUNT_OF_PAIRS_W*SLOTS-1:0] slot_outstanding;
  wire [SLOTS-1:0] stopped, cut_off;  // by a swap
  wire [KINDS:1] unserved;
  localparam [31:0] BUILT_0 = SLOT0_RM_ID;
  localparam [31:0] BUILT_1 = SLOTS > 1 ? SLOT1_RM_ID : 0;
  localparam [31:0] BUILT_2 = SLOTS > 2 ? SLOT2_RM_ID : 0;
  localparam [31:0] BUILT_3 = SLOTS > 3 ? SLOT3_RM_ID : 0;
  genvar k;
  generate
    for (k = 1; k <= KINDS; k = k + 1) begin : gen_unserved
      localparam [31:0] KIND = k;
      // without swaps: what the modules that were built do not serve
      assign unserved[k] = SWAPS != 0 ? no_provider[k-1] :
          !(`CCHIP_RM_SERVES(BUILT_0[ID_W-1:0], KIND[ID_W-1:0])
          || `CCHIP_RM_SERVES(BUILT_1[ID_W-1:0], KIND[ID_W-1:0])
          || `CCHIP_RM_SERVES(BUILT_2[ID_W-1:0], KIND[ID_W-1:0])
          || `CCHIP_RM_SERVES(BUILT_3[ID_W-1:0], KIND[ID_W-1:0]));
    end
  endgenerate

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
      .no_provider     (unserved),
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
      .stop            (stopped),
      .quiet           (quiet),
      .decouple        (cut_off),
      .decoupled       (slots_decoupled),
      .outstanding     (slot_outstanding),
      .lost            (lost),
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
      assign stopped[slot] = SWAPS != 0 && stop[slot];
      assign cut_off[slot] = SWAPS != 0 && decouple[slot];
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
          .EXHAUSTIVE         (EXHAUSTIVE),
          .KINDS              (KINDS),
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
          .decouple      (cut_off[slot]),
          .decoupled     (region_decoupled[slot]),
          .hold_reset    (SWAPS != 0 && hold_reset[slot]),
          .roc_start     (SWAPS != 0 && roc_start[slot]),
          .roc_busy      (roc_busy[slot]),
          .region_rm_id  (region_rm_id[ID_W*slot+:ID_W]),
          .cfg_valid     (SWAPS != 0 && cfg_valid),
          .cfg_data      (cfg_data),
          .s_vertex_valid(vertex_valid[slot]),
          .s_vertex_data (vertex_data),
          .m_result_valid(result_valid[slot]),
          .m_result_data (result[RESULT_W*slot+:RESULT_W]),
          .rm_id         (module_id),
          .idle          (idle[slot])
      );
      assign slot_module[KIND_W*slot+:KIND_W] =
          module_id <= MODULES[ID_W-1:0] ? module_id[KIND_W-1:0] : {KIND_W{1'b0}};
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

  wire unused = &{1'b0, idle, region_decoupled};

endmodule
`default_nettype wire
