// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_fifo: it is a queue of DEPTH beats. Order, no loss, no duplicate, stability under stall; ready exactly
// while there is room; a beat at the head waits one clock at most until it is offered.
module cchip_fifo_properties #(
    parameter integer WIDTH = 2,
    parameter integer DEPTH = 3
) (
    input wire             clk,
    input wire             rst,
    input wire             s_valid,
    input wire [WIDTH-1:0] s_data,
    input wire             m_ready
);
  wire s_ready, m_valid;
  wire [WIDTH-1:0] m_data;
  cchip_fifo #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) dut (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_valid),
      .s_ready(s_ready),
      .s_data (s_data),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

  // ---- the queue: a new beat enters at the end of those there are
  reg started_q = 1'b0;
  reg reset_q, stalled_q, waited_q;
  reg [7:0] count_q;
  reg [WIDTH*DEPTH-1:0] queue_q;  // the head lowest
  reg [WIDTH-1:0] data_q;
  wire push = s_valid & s_ready;
  wire pop = m_valid & m_ready;
  wire [7:0] left = count_q - {7'd0, pop};
  wire [WIDTH*DEPTH-1:0] rest = pop ? queue_q >> WIDTH : queue_q;
  always @(posedge clk) begin
    started_q <= 1'b1;
    reset_q   <= rst;
    stalled_q <= m_valid & ~m_ready & ~rst;
    waited_q  <= ~rst & ~m_valid & (count_q != 8'd0);
    data_q    <= m_data;
    count_q   <= rst ? 8'd0 : left + {7'd0, push};
    queue_q   <= rest;
    if (push) queue_q[WIDTH*left+:WIDTH] <= s_data;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      none_invented: assert (!m_valid || count_q != 8'd0);
      order: assert (!m_valid || m_data == queue_q[WIDTH-1:0]);
      ready: assert (s_ready == (!reset_q && count_q != DEPTH));
      no_wait: assert (!waited_q || m_valid);
      stable: assert (!stalled_q || (m_valid && m_data == data_q));
    end
  end
  always @(posedge clk) full: cover (started_q && count_q == DEPTH && stalled_q);
endmodule
`default_nettype wire
