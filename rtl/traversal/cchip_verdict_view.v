// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_verdict_view: what cchip_traversal_decision has to know of a verdict of the box test,
// worked out on the clocks on which its query is read: how many leaf pairs, and what waits.
//   latency      4 clocks
//   throughput   a verdict per clock
//   reset        none: the values count only with the event they belong to
module cchip_verdict_view (
    input  wire                            clk,            // clock, rising edge
    // record BOX_VERDICT (definitions, docs/hardware/definitions.md)
    input  wire [`CCHIP_BOX_VERDICT_W-1:0] s_verdict,
    input  wire                            s_extra,  // the event has further room in the leaf queue
    output wire [`CCHIP_BOX_VERDICT_W-1:0] m_verdict,      // the verdict, 4 clocks later
    output wire                            m_extra,        // s_extra, 4 clocks later
    output wire                            m_some_wait,    // child pairs wait
    output wire                            m_rest,         // child pairs other than the best wait
    output wire                            m_some_leaves,  // there are leaf pairs
    output wire [                     4:0] m_leaves,       // how many
    // there is room for its leaf pairs and for those of the node pair that continues
    output wire                            m_room
);

  wire [`CCHIP_BOX_VERDICT_W-1:0] verdict3;
  wire extra3;
  cchip_delay #(.WIDTH(`CCHIP_BOX_VERDICT_W + 1), .DEPTH(2)) u_delay (
      .clk(clk),
      .rst(1'b0),
      .d  ({s_extra, s_verdict}),
      .q  ({extra3, verdict3})
  );

  function [2:0] ones(input [3:0] of);
    ones = {2'd0, of[0]} + {2'd0, of[1]} + {2'd0, of[2]} + {2'd0, of[3]};
  endfunction
  wire [15:0] leaves3 = verdict3[`CCHIP_BOX_VERDICT_LEAVES];
  reg [`CCHIP_BOX_VERDICT_W-1:0] verdict_q4, verdict_q5;
  reg extra_q4, extra_q5;
  reg [11:0] row_q4;  // leaf pairs of each child of A
  reg [4:0] leaves_q5;
  reg some_wait_q5, rest_q5, some_leaves_q5, room_q5;
  wire [15:0] waiting4 = verdict_q4[`CCHIP_BOX_VERDICT_WAITING];
  wire [15:0] leaves4 = verdict_q4[`CCHIP_BOX_VERDICT_LEAVES];
  wire [3:0] best4 = verdict_q4[`CCHIP_BOX_VERDICT_BEST];
  always @(posedge clk) begin
    {extra_q4, verdict_q4} <= {extra3, verdict3};
    {extra_q5, verdict_q5} <= {extra_q4, verdict_q4};
    row_q4 <= {ones(leaves3[15:12]), ones(leaves3[11:8]), ones(leaves3[7:4]), ones(leaves3[3:0])};
    leaves_q5 <= ({2'd0, row_q4[11:9]} + {2'd0, row_q4[8:6]}) +
        ({2'd0, row_q4[5:3]} + {2'd0, row_q4[2:0]});
    some_leaves_q5 <= |leaves4;
    some_wait_q5   <= |waiting4;
    rest_q5        <= |(waiting4 & ~(16'd1 << best4));
    room_q5        <= ~|leaves4 | extra_q4;
  end
  assign m_verdict     = verdict_q5;
  assign m_extra       = extra_q5;
  assign m_some_wait   = some_wait_q5;
  assign m_rest        = rest_q5;
  assign m_some_leaves = some_leaves_q5;
  assign m_leaves      = leaves_q5;
  assign m_room        = room_q5;

endmodule
`default_nettype wire
