// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// bad_stream: a stream register that breaks one rule, for the tests of the harness.
//   fault   0 none, 1 drops valid when stalled, 2 changes the payload when stalled, 3 sends every 5th item
//           twice, 4 fails an assertion at the 5th item, 5 takes nothing after the 5th item, 6 loses the
//           5th item, 7 inverts the 5th item
//   latency 1 clock; one item per two clocks
module bad_stream (
    input  wire       clk,
    input  wire       rst,
    input  wire [2:0] fault,
    input  wire       s_item_valid,
    output wire       s_item_ready,
    input  wire [7:0] s_item_data,
    output wire       m_item_valid,
    input  wire       m_item_ready,
    output wire [7:0] m_item_data
);

  reg        valid_q, again_q, stalled_q;
  reg  [7:0] data_q;
  reg  [2:0] count_q;

  wire       accept = s_item_valid & s_item_ready;
  wire       fifth = count_q == 3'd4;

  assign s_item_ready = ~valid_q & ~(fault == 3'd5 & count_q == 3'd5);
  assign m_item_valid = valid_q & ~(fault == 3'd1 & stalled_q);
  assign m_item_data  = data_q ^ {7'd0, fault == 3'd2 & stalled_q};

  always @(posedge clk) begin
    stalled_q <= valid_q & ~m_item_ready;
    if (rst) begin
      valid_q   <= 1'b0;
      again_q   <= 1'b0;
      stalled_q <= 1'b0;
      count_q   <= 3'd0;
    end else if (accept) begin
      valid_q <= ~(fault == 3'd6 & fifth);
      again_q <= fault == 3'd3 & fifth;
      data_q  <= s_item_data ^ {8{fault == 3'd7 & fifth}};
      count_q <= fifth & fault != 3'd5 ? 3'd0 : count_q + 3'd1;
    end else if (m_item_valid & m_item_ready) begin
      valid_q <= again_q;
      again_q <= 1'b0;
    end
  end

  always @(posedge clk)
    if (!rst) begin
      a_fault : assert (!(fault == 3'd4 && accept && fifth));
    end

endmodule
`default_nettype wire
