// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_pr_slot: one reconfigurable module behind its decoupler and reset generator. The streams
// are records VERTEX and SLOT_RESULT; what is inside, the dispatcher knows (cchip_slot_ledger).
//   latency      that of the module + 2 clocks
//   throughput   that of the module
//   decouple     see cchip_pr_decoupler
//   hold_reset   level, reset of the module one clock later; roc_start: pulse, a reset of
//                ROC_CYCLES clocks; roc_busy is 1 from the next clock to the last clock of that
//                reset. Only a decoupled module may be reset
//   reset        resets streams and module (for ROC_CYCLES clocks more); nothing old comes out. The
//                configuration stays
// SIMULATION = 0: one cchip_pr_region, the partition of FPGA tools. SIMULATION = 1: all modules
// 0..KINDS, exchanged by the words that pass the configuration port (cchip_pr_virtual).
module cchip_pr_slot #(
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    parameter integer ABSOLUTE_PROJECTION = 0,  // see cchip_pr_region; legal: 0, 1
    parameter integer WARPED_EXACT = 1,  // see cchip_pr_region; legal: 0, 1
    parameter integer EXHAUSTIVE = 1,  // see cchip_primtest; legal: 0, 1
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    // number of this slot, compared with the one in a payload; legal: 0..255
    parameter integer SLOT_ID = 0,
    parameter integer RM_ID = 1,  // module at power-up, CCHIP_RM_BLANK on; legal: 0..KINDS
    // length of the reset on configuration (clock); legal: 1..32
    parameter integer ROC_CYCLES = `CCHIP_ROC_CLOCKS_DEFAULT,
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    // 0 the partition of FPGA tools, 1 all modules 0..KINDS, exchanged through the configuration
    // port; legal: 0, 1
    parameter integer SIMULATION = 0,
    parameter integer SEED = 1  // start of the random numbers; legal: any
) (
    input  wire                                clk,             // clock, rising edge
    input  wire                                rst,             // synchronous reset, active high
    // ---- control
    input  wire                                decouple,  // cut the region off; independent of rst
    // decouple one clock later: every output of the region is constant
    output wire                                decoupled,
    // reset of the module as a level, one clock later
    input  wire                                hold_reset,
    // 1 for one clock: reset of the module for ROC_CYCLES clocks
    input  wire                                roc_start,
    // 1 from the clock after roc_start or rst to the last clock of that reset
    output wire                                roc_busy,
    // number of the module in the region, not gated: to be compared before recoupling
    output wire [          `CCHIP_RM_ID_W-1:0] region_rm_id,
    // ---- configuration port of the device
    // a word is written to the configuration port; ignored if SIMULATION = 0
    input  wire                                cfg_valid,
    input  wire [                   CFG_W-1:0] cfg_data,        // the word, low byte first
    // ---- records VERTEX and SLOT_RESULT
    input  wire                                s_vertex_valid,  // a vertex of each primitive
    // record VERTEX, docs/hardware/definitions.md
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,  // a result
    // record SLOT_RESULT, docs/hardware/definitions.md
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    // number of the module; CCHIP_RM_BLANK while decoupled or in reset
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,
    // nothing inside; 1 while decoupled or in reset
    output wire                                idle
);

  // ---- reset of the module
  wire roc;
  reg region_rst_q;
  reg roc_busy_q;
  reg [`CCHIP_RM_ID_W-1:0] region_rm_id_q;
  initial region_rst_q = 1'b1;

  cchip_roc_generator #(
      .CYCLES(ROC_CYCLES)
  ) u_roc (
      .clk       (clk),
      .rst       (rst),
      .configured(roc_start),
      .roc       (roc)
  );

  wire [`CCHIP_RM_ID_W-1:0] r_rm_id;
  always @(posedge clk) begin
    region_rst_q   <= rst | hold_reset | roc;
    roc_busy_q     <= rst | roc_start | roc;
    region_rm_id_q <= r_rm_id;
  end
  assign roc_busy     = roc_busy_q;
  assign region_rm_id = region_rm_id_q;

  // ---- boundary
  wire r_vertex_valid, r_result_valid;
  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] r_vertex_data;
  wire [`CCHIP_SLOT_RESULT_W-1:0] r_result_data;
  wire r_idle;

  cchip_pr_decoupler #(
      .COORD_W(COORD_W)
  ) u_decoupler (
      .clk           (clk),
      .rst           (rst),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .s_vertex_valid(s_vertex_valid),
      .s_vertex_data (s_vertex_data),
      .m_result_valid(m_result_valid),
      .m_result_data (m_result_data),
      .rm_id         (rm_id),
      .idle          (idle),
      .r_vertex_valid(r_vertex_valid),
      .r_vertex_data (r_vertex_data),
      .r_result_valid(r_result_valid),
      .r_result_data (r_result_data),
      .r_rm_id       (r_rm_id),
      .r_idle        (r_idle)
  );

  // ---- region
  generate
    if (SIMULATION == 0) begin : gen_partition
      cchip_pr_region #(
          .RM_ID              (RM_ID),
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .EXHAUSTIVE         (EXHAUSTIVE)
      ) u_region (
          .clk           (clk),
          .rst           (region_rst_q),
          .s_vertex_valid(r_vertex_valid),
          .s_vertex_data (r_vertex_data),
          .m_result_valid(r_result_valid),
          .m_result_data (r_result_data),
          .rm_id         (r_rm_id),
          .idle          (r_idle)
      );
      wire unused = &{1'b0, cfg_valid, cfg_data, SEED};
    end else if (SIMULATION == 1) begin : gen_simulation
      cchip_pr_virtual #(
          .KINDS              (KINDS),
          .SLOT_ID            (SLOT_ID),
          .RM_ID              (RM_ID),
          .CFG_W              (CFG_W),
          .SEED               (SEED),
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .EXHAUSTIVE         (EXHAUSTIVE)
      ) u_virtual (
          .clk           (clk),
          .rst           (region_rst_q),
          .cfg_valid     (cfg_valid),
          .cfg_data      (cfg_data),
          .s_vertex_valid(r_vertex_valid),
          .s_vertex_data (r_vertex_data),
          .m_result_valid(r_result_valid),
          .m_result_data (r_result_data),
          .rm_id         (r_rm_id),
          .idle          (r_idle)
      );
    end else begin : gen_illegal
      cchip_error_SIMULATION_must_be_0_or_1 u_error ();
    end
    if (CFG_W != 8 && CFG_W != 32) begin : gen_illegal_port
      cchip_error_CFG_W_must_be_8_or_32 u_error ();
    end
    if (RM_ID > KINDS) begin : gen_illegal_module
      cchip_error_slot_RM_ID_must_be_0_to_KINDS u_error ();
    end
    if (SLOT_ID < 0 || SLOT_ID > 255) begin : gen_illegal_slot
      cchip_error_SLOT_ID_must_be_0_to_255 u_error ();
    end
  endgenerate

endmodule
`default_nettype wire
