// SPDX-License-Identifier: Apache-2.0
// What meets across the seams of cchip_chip, for a build that counts coverage: clocks on which a
// situation of one block meets one of another. scripts/coverage.py names the situations in this
// order and lists the pairs.
//   situation    {swap, ring, traversal, cache}; two of different groups are one bin,
//                gen_first[i].gen_second[j], i < j
`include "cchip_defs.vh"
module cchip_chip_bins #(
    // situations of the cache, the traversal, the record ring and the swap
    parameter integer CACHE = 6,
    parameter integer TRAVERSAL = 5,
    parameter integer RING = 3,
    parameter integer SWAP = 10
) (
    input wire                                  clk,
    input wire                                  rst,
    input wire [CACHE+TRAVERSAL+RING+SWAP-1:0] situation
);

  localparam integer ALL = CACHE + TRAVERSAL + RING + SWAP;

  genvar i, j;
  generate
    for (i = 0; i < CACHE + TRAVERSAL + RING; i = i + 1) begin : gen_first
      localparam integer NEXT = i < CACHE ? CACHE : i < CACHE + TRAVERSAL ? CACHE + TRAVERSAL :
          CACHE + TRAVERSAL + RING;
      for (j = NEXT; j < ALL; j = j + 1) begin : gen_second
        bin: cover property (@(posedge clk) !rst && situation[i] && situation[j]);
      end
    end
  endgenerate

endmodule

bind cchip_chip cchip_chip_bins u_bins (
    .clk      (clk),
    .rst      (regs_rst),
    .situation({
      // the phase of the swap in progress, REPORT to IDLE
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_REPORT,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_RECOUPLE,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_ROC,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_CHECK,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_TRANSFER,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_RESET,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_DECOUPLE,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_SHUTDOWN,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_HEADER,
      slot_phase[`CCHIP_PHASE_W-1:0] == `CCHIP_PHASE_IDLE,
      // the record ring: a record begins another round, waits for the host, has room
      u_core.u_records.take && u_core.u_records.place == 32'd0 &&
          u_core.u_records.written_q != 32'd0,
      u_core.u_records.here_q && !u_core.u_records.room_q,
      u_core.u_records.take,
      // the traversal: a start that comes too early, a query's end, a full stack, an entry of the
      // stack is read, a query begins
      u_core.u_broad_phase.u_traversal.cancel8,
      u_core.u_broad_phase.u_traversal.ends8,
      u_core.u_broad_phase.u_traversal.u_decision.spill &&
          u_core.u_broad_phase.u_traversal.u_decision.s_valid,
      u_core.u_broad_phase.u_traversal.u_decision.s_is_pop &&
          u_core.u_broad_phase.u_traversal.u_decision.s_valid,
      u_core.u_broad_phase.u_traversal.started6,
      // the cache: a set is looked up for an invalidation, a line of a range to lock is, a lookup
      // comes again, falls asleep on a line in flight, gets a frame, is a hit
      u_core.u_broad_phase.u_cache.gen_port[1].u_port.maint_q[6],
      (u_core.u_broad_phase.u_cache.gen_port[0].u_port.lock_q6 &&
       u_core.u_broad_phase.u_cache.gen_port[0].u_port.look_q[6]) ||
      (u_core.u_broad_phase.u_cache.gen_port[1].u_port.lock_q6 &&
       u_core.u_broad_phase.u_cache.gen_port[1].u_port.look_q[6]),
      |u_core.u_broad_phase.u_cache.count_again,
      |u_core.u_broad_phase.u_cache.count_wait,
      |u_core.u_broad_phase.u_cache.count_miss,
      |u_core.u_broad_phase.u_cache.count_hit
    })
);
