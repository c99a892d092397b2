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
//   about        It collects the answers of the slots and the pairs that are left open in
//                cchip_dispatcher, and the requests of the clients of cchip_axi_read. The turns are
//                those of cchip_arbiter.
//   numbers      A source may take an offer back, as a slot does that is decoupled by force: what
//                was not accepted does not appear.
//   why          The choice starts from a one-hot register of the last source: a token goes round
//                from there to the first offer. For two or three sources that is two levels of
//                logic; a subtraction that finds it would bring a carry chain.
module cchip_stream_merge #(
    parameter integer SOURCES = 3,  // streams; legal: 1..8
    parameter integer WIDTH = 36    // width of the payload (bit); legal: >= 1
) (
    input  wire                     clk,      // clock, rising edge
    input  wire                     rst,      // synchronous reset, active high
    input  wire [      SOURCES-1:0] s_valid,  // bit i: source i offers a beat
    // bit i: the beat is taken if s_valid[i] = 1 as well; at most one bit is 1
    output wire [      SOURCES-1:0] s_ready,
    input  wire [SOURCES*WIDTH-1:0] s_data,   // source i in bits [WIDTH*i +: WIDTH]
    output wire                     m_valid,  // a beat is offered
    input  wire                     m_ready,  // the beat is taken if m_valid = 1 as well
    output wire [        WIDTH-1:0] m_data    // the beat
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
