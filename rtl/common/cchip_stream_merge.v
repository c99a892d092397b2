// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_stream_merge: several streams into one, in turn.
//   latency      1 clock
//   throughput   one beat per clock
//   fair         a beat that is offered lets at most SOURCES - 1 others leave before it
//   cuts         m_valid and m_data are flip-flops; s_ready follows s_valid of the sources, not
//                m_ready
//   reset        empty; s_ready = 0 while rst is 1 and one clock longer
//   errors       none. A source may take an offer back: what was not accepted does not appear.
module cchip_stream_merge #(
    // streams, 1..8
    parameter integer SOURCES = 3,
    // width of the payload, bit
    parameter integer WIDTH = 36
) (
    input  wire                     clk,
    input  wire                     rst,
    input  wire [      SOURCES-1:0] s_valid,
    output wire [      SOURCES-1:0] s_ready,
    input  wire [SOURCES*WIDTH-1:0] s_data,   // source i in bits [WIDTH*i +: WIDTH]
    output wire                     m_valid,
    input  wire                     m_ready,
    output wire [        WIDTH-1:0] m_data
);

  `CCHIP_REFUSE(SOURCES < 1 || SOURCES > 8 || WIDTH < 1,
                cchip_error_stream_merge_SOURCES_not_1_to_8_or_WIDTH_below_1)

  wire [SOURCES-1:0] next;
  wire ready;
  cchip_arbiter #(.N(SOURCES)) u_arbiter (
      .clk    (clk),
      .rst    (rst),
      .request(s_valid),
      .grant  (next),
      .take   (ready)
  );

  assign s_ready = next & {SOURCES{ready}};

  wire [WIDTH-1:0] data;
  cchip_onehot_mux #(.N(SOURCES), .WIDTH(WIDTH)) u_choose (
      .select(next),
      .s_data(s_data),
      .m_data(data)
  );
  cchip_skid_buffer #(.WIDTH(WIDTH)) u_out (
      .clk    (clk),
      .rst    (rst),
      .s_valid(|s_valid),
      .s_ready(ready),
      .s_data (data),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

endmodule
`default_nettype wire
