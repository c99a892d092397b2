// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_pr_virtual: a reconfigurable region for simulations: all modules and a selector that
// the words of the configuration port move (cchip_pr_config_memory). Same ports as cchip_pr_region
// and the configuration port.
//   garbage      from the word of a payload that names the slot to its last one, and for ever after
//                a bad payload, every output of the region is random on every clock, and all
//                modules are fed random vertices without reset. A controller that does not decouple
//                sees garbage; one that does not reset afterwards sees answers to pairs that were
//                never sent
//   fresh        after the last word of a payload until rst rises: the selected module is in, but
//                none has been reset. An rst from before the module was whole does not count, so
//                only a reset on configuration does
//   otherwise    the selected module, nothing added; rst resets all of them
//   clocks       a module that is not selected has none unless rst or the random vertices want one:
//                what it does cannot be seen, and it takes most of the time of a simulation
//   about        A reconfigurable region for simulations: all modules and a selector that only a
//                complete, correct payload moves. Same ports as cchip_pr_region and the
//                configuration port. cchip_pr_slot holds it if SIMULATION = 1.
//   parameters   Other values stop elaboration as in cchip_pr_config_memory and cchip_pr_region.
//   timing       While garbage = 1: every output is random on every clock, m_result_valid included;
//                all modules get rst = 0 and random vertices, regardless of the inputs. rst resets
//                all modules on the other clocks. Once a payload is whole its module is there but
//                fresh: it continues with random pairs until rst rises. So a controller that holds
//                its region in reset during the transfer, but leaves out the reset on
//                configuration, gets answers to pairs that were never sent.
//   numbers      Random numbers: a 64-bit xorshift, started from SEED and SLOT_ID. It is not reset:
//                every transfer brings other garbage, every run the same.
//   why          Verilator has no X, and a plain multiplexer between modules hides what goes wrong
//                in practice. Random outputs show a missing or late decoupling as answers to no
//                request; modules full of random pairs show a missing reset in the same way.
//   measured     No area, no clock: for simulations only.
module cchip_pr_virtual #(
    // number of this slot, compared with the one in a payload; legal: 0..255
    parameter integer SLOT_ID = 0,
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3,
    parameter integer RM_ID = 1,  // module at power-up, CCHIP_RM_BLANK on; legal: 0..KINDS
    parameter integer CFG_W = 8,  // width of the configuration port (bit); legal: 8, 32
    parameter integer SEED = 1,  // start of the random numbers; legal: any
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    parameter integer ABSOLUTE_PROJECTION = 0,  // see cchip_pr_region; legal: 0, 1
    parameter integer WARPED_EXACT = 1,  // see cchip_pr_region; legal: 0, 1
    parameter integer EXHAUSTIVE = 1  // see cchip_primtest; legal: 0, 1
) (
    input  wire                                clk,             // clock, rising edge
    input  wire                                rst,             // synchronous reset, active high
    // a word is written to the configuration port
    input  wire                                cfg_valid,
    input  wire [                   CFG_W-1:0] cfg_data,        // the word, low byte first
    input  wire                                s_vertex_valid,  // a vertex of each primitive
    // record VERTEX, docs/hardware/definitions.md
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,  // a result
    // record SLOT_RESULT, docs/hardware/definitions.md
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,           // number of the selected module
    // no accepted pair is without an accepted result
    output wire                                idle
);

  localparam integer VERTEX_W = `CCHIP_VERTEX_W(COORD_W);
  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;
  // {valid; result; rm_id; idle}
  localparam integer OUT_W = 1 + RESULT_W + `CCHIP_RM_ID_W + 1;
  localparam [31:0] STEP = OUT_W;
  localparam [31:0] SLOT = SLOT_ID;
  localparam [31:0] START = SEED;

  wire garbage;
  wire [`CCHIP_RM_ID_W-1:0] select;
  cchip_pr_config_memory #(
      .KINDS  (KINDS),
      .SLOT_ID(SLOT_ID),
      .RM_ID  (RM_ID),
      .CFG_W  (CFG_W)
  ) u_memory (
      .clk      (clk),
      .cfg_valid(cfg_valid),
      .cfg_data (cfg_data),
      .garbage  (garbage),
      .select   (select)
  );

  // ---- modules that are whole, but not reset yet
  reg fresh_q, low_q;  // low: rst has been 0 since
  initial fresh_q = 1'b0;
  initial low_q = 1'b1;
  wire dirty = garbage | (fresh_q & ~(low_q & rst));
  always @(posedge clk) begin
    fresh_q <= dirty;
    low_q   <= ~garbage & (low_q | ~rst);
  end

  // ---- random numbers: xorshift of 64 bits; the vertices are the last of them
  reg [63:0] random_q;
  reg [VERTEX_W+63:0] vertex_q;
  initial random_q = {START, SLOT ^ 32'h9E3779B9};
  initial vertex_q = {VERTEX_W + 64{1'b0}};

  function [63:0] xorshift(input [63:0] from);
    begin
      xorshift = from ^ {from[50:0], 13'd0};
      xorshift = xorshift ^ {7'd0, xorshift[63:7]};
      xorshift = xorshift ^ {xorshift[46:0], 17'd0};
    end
  endfunction

  always @(posedge clk)
    if (dirty) begin
      random_q <= xorshift(random_q);
      vertex_q <= {vertex_q[VERTEX_W-1:0], random_q};
    end

  // ---- the modules
  wire [VERTEX_W-1:0] vertex = dirty ? vertex_q[VERTEX_W-1:0] : s_vertex_data;
  wire [(KINDS+1)*OUT_W-1:0] outs;
  genvar i;
  generate
    for (i = 0; i <= KINDS; i = i + 1) begin : gen_module
      localparam [7:0] ID = i;
      wire here = select == ID;
      wire valid, quiet;
      wire [RESULT_W-1:0] result;
      wire [`CCHIP_RM_ID_W-1:0] module_id;
      reg runs_q;  // changes while clk is 0, so that gated_clk has whole pulses only
      initial runs_q = 1'b1;
      always @(negedge clk) runs_q <= here | dirty | rst;
      wire gated_clk = clk & runs_q;
      cchip_pr_region #(
          .RM_ID              (i),
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .EXHAUSTIVE         (EXHAUSTIVE)
      ) u_region (
          .clk           (gated_clk),
          .rst           (rst & ~dirty),
          .s_vertex_valid(dirty | (here & s_vertex_valid)),
          .s_vertex_data (vertex),
          .m_result_valid(valid),
          .m_result_data (result),
          .rm_id         (module_id),
          .idle          (quiet)
      );
      assign outs[OUT_W*i+:OUT_W] = {valid, result, module_id, quiet};
    end
  endgenerate

  assign {m_result_valid, m_result_data, rm_id, idle} =
      garbage ? random_q[OUT_W-1:0] : outs[STEP*{29'd0, select[2:0]}+:OUT_W];

  wire unused = &{1'b0, select[7:3], vertex_q[VERTEX_W+63:VERTEX_W]};

endmodule
`default_nettype wire
