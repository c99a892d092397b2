// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_skid_buffer: it is a queue of two beats. Order, no loss, no duplicate, stability under stall, and
// ready and valid on exactly the clocks on which the queue has room or a beat.
module cchip_skid_buffer_properties #(
    parameter integer WIDTH = 3
) (
    input wire             clk,
    input wire             rst,
    input wire             s_valid,
    input wire [WIDTH-1:0] s_data,
    input wire             m_ready
);
  wire s_ready, m_valid;
  wire [WIDTH-1:0] m_data;
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

  // ---- the queue
  reg started_q = 1'b0;
  reg reset_q, stalled_q;
  reg [1:0] count_q;
  reg [WIDTH-1:0] first_q, second_q, data_q;
  wire push = s_valid & s_ready;
  wire pop = m_valid & m_ready;
  always @(posedge clk) begin
    started_q <= 1'b1;
    reset_q   <= rst;
    stalled_q <= m_valid & ~m_ready & ~rst;
    data_q    <= m_data;
    count_q   <= rst ? 2'd0 : count_q + {1'b0, push} - {1'b0, pop};
    if (pop) first_q <= count_q == 2'd2 ? second_q : s_data;
    else if (push && count_q == 2'd0) first_q <= s_data;
    if (push) second_q <= s_data;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      valid: assert (m_valid == (count_q != 2'd0));
      order: assert (!m_valid || m_data == first_q);
      ready: assert (s_ready == (!reset_q && count_q != 2'd2));
      stable: assert (!stalled_q || (m_valid && m_data == data_q));
    end
  end
  always @(posedge clk) begin
    full: cover (started_q && count_q == 2'd2);
    drained: cover (started_q && stalled_q && count_q == 2'd1);
  end
endmodule
`default_nettype wire
