// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_fifo: it is a queue of DEPTH beats (queue_spec.v), ready exactly while there is room; a beat at the head
// waits one clock at most until it is offered.
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
  wire s_ready, m_valid, stalled;
  wire [WIDTH-1:0] m_data;
  wire [7:0] count;
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

  queue_spec #(
      .WIDTH(WIDTH),
      .DEPTH(DEPTH)
  ) spec (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_valid),
      .s_ready(s_ready),
      .s_data (s_data),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data),
      .count  (count),
      .stalled(stalled)
  );

  reg started_q = 1'b0;
  reg reset_q, waited_q;
  always @(posedge clk) begin
    started_q <= 1'b1;
    reset_q   <= rst;
    waited_q  <= ~rst & ~m_valid & (count != 8'd0);
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      ready: assert (s_ready == (!reset_q && count != DEPTH));
      no_wait: assert (!waited_q || m_valid);
    end
  end
  always @(posedge clk) full: cover (started_q && count == DEPTH && stalled);
endmodule
`default_nettype wire
