// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_level_crossing: a level, as an interrupt, from one clock to another. Each phase of 0, be it
// a single clock, makes a phase of 0 on the other side, so the edge at its end is never lost; a
// phase of 1 that is over before it could pass is.
//   latency      1 clock of s_clk and STAGES + 1 of m_clk while the level rests; after a change
//                twice that until the next one passes
//   cuts         m_level is a flip-flop
//   crossing     one bit each way through cchip_synchroniser: a change waits until the one before
//                it was acknowledged
//   reset        of either side, alone or with the other: m_level is 0 while m_rst is 1; the level
//                comes back after it
module cchip_level_crossing #(
    parameter integer STAGES = 2  // flip-flops of each synchroniser; legal: 2..4
) (
    input  wire s_clk,    // clock of the sender, rising edge
    input  wire s_rst,    // synchronous reset of the sender's side, active high
    input  wire s_level,  // level in
    input  wire m_clk,    // clock of the receiver, rising edge
    input  wire m_rst,    // synchronous reset of the receiver's side, active high
    output wire m_level   // level out
);

  `CCHIP_REFUSE(STAGES < 2 || STAGES > 4, cchip_error_level_crossing_STAGES_not_2_to_4)

  reg sent_q, fell_q, level_q;
  initial {sent_q, level_q} = 2'd0;
  wire seen, acknowledged;
  wire settled = acknowledged == sent_q;
  cchip_synchroniser #(.WIDTH(1), .STAGES(STAGES)) u_forth (
      .clk(m_clk),
      .d  (sent_q),
      .q  (seen)
  );
  // the receiver answers what it has seen, in reset too
  reg seen_q;
  cchip_synchroniser #(.WIDTH(1), .STAGES(STAGES)) u_back (
      .clk(s_clk),
      .d  (seen_q),
      .q  (acknowledged)
  );

  always @(posedge s_clk) begin
    // a phase of 0 is remembered until it has been sent
    fell_q <= ~s_level | s_rst | (fell_q & sent_q);
    if (settled) sent_q <= s_level & ~s_rst & ~(sent_q & fell_q);
  end

  always @(posedge m_clk) begin
    seen_q  <= seen;
    level_q <= seen & ~m_rst;
  end
  assign m_level = level_q;

endmodule
`default_nettype wire
