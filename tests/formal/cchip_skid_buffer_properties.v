// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_skid_buffer: it is a queue of two beats (queue_spec.v), with ready and valid on exactly the clocks on
// which the queue has room or a beat.
module cchip_skid_buffer_properties #(
    parameter integer WIDTH = 3
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
  cchip_skid_buffer #(
      .WIDTH(WIDTH)
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
      .DEPTH(2)
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
  reg reset_q;
  always @(posedge clk) begin
    started_q <= 1'b1;
    reset_q   <= rst;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      valid: assert (m_valid == (count != 8'd0));
      ready: assert (s_ready == (!reset_q && count != 8'd2));
    end
  end
  always @(posedge clk) begin
    full: cover (started_q && count == 8'd2);
    drained: cover (started_q && stalled && count == 8'd1);
  end
endmodule
`default_nettype wire
