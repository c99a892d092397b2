// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// queue_spec: the stream m is the stream s behind a queue of DEPTH beats: order, no loss, no duplicate; an offered beat
// stays as it is until it is taken or reset comes. What a module says beyond that, it says about `count`.
module queue_spec #(
    parameter integer WIDTH = 1,
    parameter integer DEPTH = 2
) (
    input  wire             clk,
    input  wire             rst,
    input  wire             s_valid,
    input  wire             s_ready,
    input  wire [WIDTH-1:0] s_data,
    input  wire             m_valid,
    input  wire             m_ready,
    input  wire [WIDTH-1:0] m_data,
    output wire [      7:0] count,    // beats inside
    output wire             stalled   // the beat now offered was not taken a clock ago
);
  reg started_q = 1'b0;
  reg stalled_q;
  reg [7:0] count_q;
  reg [WIDTH*DEPTH-1:0] queue_q;  // the head lowest
  reg [WIDTH-1:0] data_q;
  wire push = s_valid & s_ready;
  wire pop = m_valid & m_ready;
  // a new beat enters at the end of those that are left
  wire [7:0] left = count_q - {7'd0, pop};
  wire [WIDTH*DEPTH-1:0] rest = pop ? queue_q >> WIDTH : queue_q;
  assign count   = count_q;
  assign stalled = stalled_q;
  always @(posedge clk) begin
    started_q <= 1'b1;
    stalled_q <= m_valid & ~m_ready & ~rst;
    data_q    <= m_data;
    count_q   <= rst ? 8'd0 : left + {7'd0, push};
    queue_q   <= rest;
    if (push) queue_q[WIDTH*left+:WIDTH] <= s_data;
  end

  always @(*)
    if (started_q) begin
      none_invented: assert (!m_valid || count_q != 8'd0);
      order: assert (!m_valid || m_data == queue_q[WIDTH-1:0]);
      stable: assert (!stalled_q || (m_valid && m_data == data_q));
    end
endmodule
`default_nettype wire
