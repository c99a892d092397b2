// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_pr_gate: a queue of two beats that is empty and shows zeros after every clock with close, and takes
// nothing after a clock with stop. Order, no loss, no duplicate; stable under stall unless it is closed.
module cchip_pr_gate_properties #(
    parameter integer WIDTH = 3
) (
    input wire             clk,
    input wire             close,
    input wire             stop,
    input wire             s_valid,
    input wire [WIDTH-1:0] s_data,
    input wire             m_ready
);
  wire s_ready, m_valid;
  wire [WIDTH-1:0] m_data;
  cchip_pr_gate #(
      .WIDTH(WIDTH)
  ) dut (
      .clk    (clk),
      .close  (close),
      .stop   (stop),
      .s_valid(s_valid),
      .s_ready(s_ready),
      .s_data (s_data),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

  reg started_q = 1'b0;
  reg closed_q, stopped_q, stalled_q;
  reg [1:0] count_q;
  reg [WIDTH-1:0] first_q, second_q, data_q;
  wire push = s_valid & s_ready;
  wire pop = m_valid & m_ready;
  always @(posedge clk) begin
    started_q <= 1'b1;
    closed_q  <= close;
    stopped_q <= stop;
    stalled_q <= m_valid & ~m_ready & ~close;
    data_q    <= m_data;
    count_q   <= close ? 2'd0 : count_q + {1'b0, push} - {1'b0, pop};
    if (pop) first_q <= count_q == 2'd2 ? second_q : s_data;
    else if (push && count_q == 2'd0) first_q <= s_data;
    if (push) second_q <= s_data;
  end

  always @(*) begin
    if (!started_q) assume (close);
    if (started_q) begin
      valid: assert (m_valid == (count_q != 2'd0));
      order: assert (!m_valid || m_data == first_q);
      ready: assert (s_ready == (!closed_q && !stopped_q && count_q != 2'd2));
      zeros: assert (!closed_q || m_data == {WIDTH{1'b0}});
      stable: assert (!stalled_q || (m_valid && m_data == data_q));
    end
  end
  always @(posedge clk) begin
    full: cover (started_q && count_q == 2'd2 && stopped_q);
    lost: cover (started_q && closed_q && count_q == 2'd0);
  end
endmodule
`default_nettype wire
