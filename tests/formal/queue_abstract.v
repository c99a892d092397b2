// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// Stands for cchip_fifo in the proofs of modules that hold queues: anything with the properties proved of cchip_fifo. It is a queue
// of DEPTH beats, ready while there is room; the beat at its head is offered one clock after it is inside or two, at will.
module cchip_fifo #(
    parameter integer WIDTH = 8,
    parameter integer DEPTH = 16,
    parameter integer ROOM_KNOWN = 0
) (
    input  wire             clk,
    input  wire             rst,
    input  wire             s_valid,
    output wire             s_ready,
    input  wire [WIDTH-1:0] s_data,
    output wire             m_valid,
    input  wire             m_ready,
    output wire [WIDTH-1:0] m_data
);
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  (* anyseq *) wire at_once;
  reg reset_q;
  reg offered_q;  // the head has been offered, or has waited a clock
  reg [COUNT_W-1:0] count_q;
  reg [WIDTH*DEPTH-1:0] queue_q;  // the head lowest
  assign s_ready = ~reset_q & (count_q != DEPTH);
  assign m_valid = count_q != 0 && (offered_q || at_once);
  assign m_data  = queue_q[WIDTH-1:0];
  wire push = s_valid & (s_ready | (ROOM_KNOWN != 0));
  wire pop = m_valid & m_ready;
  wire [COUNT_W-1:0] left = count_q - {{COUNT_W - 1{1'b0}}, pop};
  integer i;
  always @(posedge clk) begin
    reset_q   <= rst;
    offered_q <= ~rst & (count_q != 0) & ~pop;
    count_q   <= rst ? {COUNT_W{1'b0}} : left + {{COUNT_W - 1{1'b0}}, push};
    if (pop) queue_q <= queue_q >> WIDTH;
    for (i = 0; i < DEPTH; i = i + 1) if (push && left == i) queue_q[WIDTH*i+:WIDTH] <= s_data;
  end
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, ROOM_KNOWN == 0 || !s_valid || s_ready)
    end
endmodule
`default_nettype wire
