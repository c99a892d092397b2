// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
`include "cchip_defs.vh"
// cchip_phase_clocks: how many clocks the last swap spent in each phase, in distributed RAM.
//   latency      1 clock from elapsed to the word of its phase; read_clocks is valid from 1 clock
//                after read_phase on, which stays meanwhile
//   numbers      32 bit; phases that the last swap did not have read 0
//   cuts         every path but read_phase to read_clocks
//   reset        rst or clear: every phase reads 0. The RAM is not reset, a bit for each phase says
//                whether its word belongs to the last swap.
//   timing       A word shows elapsed one clock later. read_phase must not change while its word is
//                read. rst or clear: every phase reads 0.
//   why          The sequencer counts the clocks of a phase anyway; sixteen words of RAM only
//                remember. A RAM cannot be set to 0 at once, the bits can.
module cchip_phase_clocks (
    input  wire                      clk,         // clock, rising edge
    input  wire                      rst,         // synchronous reset, active high
    input  wire                      clear,       // 1: every phase reads 0
    input  wire [`CCHIP_PHASE_W-1:0] phase,       // phase of the controller, SwapPhase
    input  wire [              31:0] elapsed,     // clocks in this phase, 1 on its first
    input  wire [`CCHIP_PHASE_W-1:0] read_phase,  // the phase that is read
    output wire [              31:0] read_clocks  // its clocks, from 1 clock after read_phase on
);

  localparam integer PHASES = 1 << `CCHIP_PHASE_W;

  `CCHIP_LUT_RAM
  reg [31:0] mem [0:PHASES-1];
  always @(posedge clk) mem[phase] <= elapsed;

  reg idle_q;
  reg [PHASES-1:0] known_q;  // the word of the phase is of the last swap
  wire first = idle_q && phase != `CCHIP_PHASE_IDLE;
  integer p;
  always @(posedge clk) begin
    idle_q <= rst || phase == `CCHIP_PHASE_IDLE;
    for (p = 0; p < PHASES; p = p + 1)
      known_q[p] <= !rst && !clear && p != 0
          && (phase == p[`CCHIP_PHASE_W-1:0] || (known_q[p] && !first));
  end

  reg read_known_q;
  always @(posedge clk) read_known_q <= known_q[read_phase];
  assign read_clocks = mem[read_phase] & {32{read_known_q}};

endmodule
`default_nettype wire
