// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_skid_buffer: stream register with registered ready.
//   latency      1 clock
//   throughput   one beat per clock, also while m_ready toggles
//   capacity     2 beats
//   reset        empties the buffer; s_ready and m_valid are 0 while rst is 1; a beat of the clock
//                on which rst rises is lost
module cchip_skid_buffer #(
    parameter integer WIDTH = 8  // width of the payload (bit); legal: >= 1
) (
    // ---- clock and reset
    input  wire             clk,      // clock, rising edge
    input  wire             rst,      // synchronous reset, active high
    // ---- input stream
    input  wire             s_valid,  // the sender offers s_data
    output wire             s_ready,  // the beat is taken if s_valid = 1 as well
    input  wire [WIDTH-1:0] s_data,   // payload in
    // ---- output stream
    output wire             m_valid,  // m_data is offered; stays until taken
    input  wire             m_ready,  // the receiver takes the beat if m_valid = 1 as well
    // payload out, does not change while m_valid = 1 and m_ready = 0
    output wire [WIDTH-1:0] m_data
);

  `CCHIP_REFUSE(WIDTH < 1, cchip_error_skid_buffer_WIDTH_below_1)

  reg              ready_q;
  reg              skid_valid_q;
  reg  [WIDTH-1:0] skid_data_q;
  reg              valid_q;
  reg  [WIDTH-1:0] data_q;

  assign s_ready = ready_q;
  assign m_valid = valid_q;
  assign m_data  = data_q;

  wire accept = s_valid & ready_q;
  wire advance = m_ready | ~valid_q;
  wire skid_valid_d = ~advance & (skid_valid_q | accept);

  always @(posedge clk) begin
    if (rst) begin
      ready_q      <= 1'b0;
      skid_valid_q <= 1'b0;
      valid_q      <= 1'b0;
    end else begin
      ready_q      <= ~skid_valid_d;
      skid_valid_q <= skid_valid_d;
      if (advance) valid_q <= skid_valid_q | accept;
    end
    if (advance) data_q <= skid_valid_q ? skid_data_q : s_data;
    if (ready_q) skid_data_q <= s_data;
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_ready_means_empty, !(ready_q && skid_valid_q))
      `CCHIP_ASSERT(a_order, !(skid_valid_q && !valid_q))
    end

endmodule
`default_nettype wire
