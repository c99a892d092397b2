// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_swap_signals: what cchip_swap_sequencer tells the slots: stop, decouple, hold in reset,
// reset on configuration (ROC).
//   order        stop, decouple, hold_reset rise one after the other; hold_reset falls as roc_start
//                rises, then decouple falls, then stop. No slot is decoupled that is not stopped,
//                none held in reset that is not decoupled
//   failure      fails = 1 ends the swap: with shut = 0 the slot goes back to work, with shut = 1
//                it stays stopped, decoupled and in reset
//   latency      1 clock
//   throughput   one step per clock
//   reset        slots active, except one whose transfer had begun and not ended well: half_q
//                outlives rst and keeps it stopped, decoupled and in reset until a good transfer.
//                Its value at power-up is an initial value, because no reset can tell a power-up,
//                after which every slot holds a whole module, from a reset in the middle of a
//                transfer
//   timing       1 clock from a step to the signals.
module cchip_swap_signals #(
    parameter integer SLOTS = 1  // slots; legal: 1..4
) (
    input  wire             clk,          // clock, rising edge
    input  wire             rst,          // synchronous reset, active high
    input  wire [SLOTS-1:0] slot,         // of the swap, one-hot; 0 if there is no such slot
    input  wire             fails,        // the swap ends badly
    input  wire             shut,  // with fails: the slot stays stopped, decoupled and in reset
    // ---- the steps of a swap, each 1 for a clock
    input  wire             to_stop,      // step: stop the slot
    input  wire             to_decouple,  // step: decouple it
    input  wire             to_hold,      // step: hold it in reset
    input  wire             to_write,     // the transfer begins
    input  wire             to_roc,  // step: reset on configuration, the transfer has ended well
    input  wire             to_recouple,  // step: couple it again
    input  wire             to_work,      // step: back to work
    output wire [SLOTS-1:0] stop,         // bit of each slot: takes no new pairs
    output wire [SLOTS-1:0] decouple,     // bit of each slot: decouple
    output wire [SLOTS-1:0] hold_reset,   // bit of each slot: the region is held in reset
    output wire [SLOTS-1:0] roc_start     // bit of each slot: reset on configuration, for a clock
);

  reg [SLOTS-1:0] stop_q, decouple_q, hold_reset_q, roc_start_q;
  reg [SLOTS-1:0] half_q;  // the region holds no whole module
  initial half_q = {SLOTS{1'b0}};
  wire [SLOTS-1:0] start_roc = slot & {SLOTS{to_roc}};
  wire [SLOTS-1:0] recouple = slot & {SLOTS{to_recouple}};
  wire [SLOTS-1:0] shuts = slot & {SLOTS{shut}};
  always @(posedge clk) begin
    if (!rst && !fails) half_q <= (half_q | (slot & {SLOTS{to_write}})) & ~recouple;
    if (rst) begin
      stop_q       <= half_q;
      decouple_q   <= half_q;
      hold_reset_q <= half_q;
      roc_start_q  <= {SLOTS{1'b0}};
    end else if (fails) begin
      if (!shut) stop_q <= decouple_q;
      decouple_q   <= decouple_q | shuts;
      hold_reset_q <= hold_reset_q | shuts;
      roc_start_q  <= {SLOTS{1'b0}};
    end else begin
      stop_q       <= to_work ? decouple_q : stop_q | (slot & {SLOTS{to_stop}});
      decouple_q   <= (decouple_q | (slot & {SLOTS{to_decouple}})) & ~recouple;
      hold_reset_q <= (hold_reset_q | (slot & {SLOTS{to_hold}})) & ~start_roc;
      roc_start_q  <= start_roc;
    end
  end
  assign stop       = stop_q;
  assign decouple   = decouple_q;
  assign hold_reset = hold_reset_q;
  assign roc_start  = roc_start_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_order, (hold_reset_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_stopped, (decouple_q & ~stop_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_half, (half_q & ~decouple_q) == {SLOTS{1'b0}})
      `CCHIP_ASSERT(a_roc, (roc_start_q & hold_reset_q) == {SLOTS{1'b0}})
    end

endmodule
`default_nettype wire
