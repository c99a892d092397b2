// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_query_ring, for some clocks after reset: no line is read that the host has not written, none twice; at most AHEAD are in
// flight; queries leave in their order, each with the data that memory gave for its own line; a line that could not be read, and
// all that follow it, never leave. So the indices never pass each other: consumer <= lines read <= producer.
// Assumed: the host keeps producer - consumer <= 2^size_log2, and memory answers the slots that were asked for, once each.
// One query, any, is followed: bit 0 of its line is 1, and of all others 0.
module cchip_query_ring_properties #(
    parameter integer SLOTS = 4,
    parameter integer AHEAD = 4
) (
    input wire                          clk,
    input wire                          rst,
    input wire                          enable,
    input wire [                   2:0] more,           // queries that the host adds
    input wire                          s_read_valid,
    input wire [     $clog2(SLOTS)-1:0] s_read_slot,
    input wire [`CCHIP_READ_CODE_W-1:0] s_read_code,
    input wire                          m_query_ready
);
  localparam integer SLOT_W = $clog2(SLOTS);
  (* anyconst *) wire [3:0] size_log2;
  (* anyconst *) wire [15:0] followed;
  reg [15:0] producer_q;
  wire [15:0] consumer;
  wire failed, m_read_valid, m_query_valid;
  wire [SLOT_W-1:0] m_read_slot;
  wire [57:0] m_read_line;
  wire [511:0] m_query_data;
  reg [SLOTS-1:0] open_q, is_followed_q;
  cchip_query_ring #(
      .SLOTS (SLOTS),
      .AHEAD (AHEAD),
      .DATA_W(512)
  ) dut (
      .clk          (clk),
      .rst          (rst),
      .enable       (enable),
      .base         (58'd0),
      .size_log2    (size_log2),
      .producer     (producer_q),
      .consumer     (consumer),
      .failed       (failed),
      .m_read_valid (m_read_valid),
      .m_read_slot  (m_read_slot),
      .m_read_line  (m_read_line),
      .s_read_valid (s_read_valid),
      .s_read_slot  (s_read_slot),
      .s_read_beat  (3'd0),
      .s_read_last  (1'b1),
      .s_read_code  (s_read_code),
      .s_read_data  ({511'd0, is_followed_q[s_read_slot]}),
      .m_query_valid(m_query_valid),
      .m_query_ready(m_query_ready),
      .m_query_data (m_query_data)
  );

  reg started_q = 1'b0;
  always @(posedge clk) started_q <= 1'b1;
  always @* assume (started_q || rst);

  reg [15:0] read_q;  // lines that were asked for
  reg [15:0] bad_q;   // the first one that could not be read
  reg some_bad_q;
  reg [16*SLOTS-1:0] index_q;
  wire [15:0] place = read_q & ~(16'hFFFF << size_log2);
  wire [15:0] waiting = producer_q + {13'd0, more} - consumer;
  wire [SLOTS-1:0] one = {{SLOTS - 1{1'b0}}, 1'b1};
  wire [15:0] came = index_q[16*s_read_slot+:16];
  always @* begin
    assume ({1'b0, waiting} <= 17'd1 << size_log2);
    assume (!s_read_valid || open_q[s_read_slot]);
  end
  always @(posedge clk) begin
    producer_q <= rst ? 16'd0 : producer_q + {13'd0, more};
    read_q <= rst ? 16'd0 : read_q + {15'd0, m_read_valid};
    open_q <= rst ? 0 : (open_q | (m_read_valid ? one << m_read_slot : 0)) & ~(s_read_valid ? one << s_read_slot : 0);
    if (m_read_valid) begin
      is_followed_q[m_read_slot] <= read_q == followed;
      index_q[16*m_read_slot+:16] <= read_q;
    end
    if (rst) some_bad_q <= 1'b0;
    else if (s_read_valid && s_read_code != `CCHIP_READ_OK) begin
      some_bad_q <= 1'b1;
      if (!some_bad_q || came - consumer < bad_q - consumer) bad_q <= came;
    end
    if (started_q && !rst) begin
      if (m_read_valid) begin
        assert (m_read_line == {42'd0, place});
        assert (!open_q[m_read_slot]);
      end
      assert (read_q - consumer <= producer_q - consumer);
      assert (read_q - consumer <= AHEAD);
      if (m_query_valid) begin
        assert (read_q != consumer);
        assert (m_query_data[0] == (consumer == followed));
        assert (!some_bad_q || consumer != bad_q);
      end
    end
  end
`ifdef COVER
  always @(posedge clk)
    if (started_q && !rst)
      case (`COVER)
        0: assert (!(m_query_valid && consumer == followed && followed > 16'd2 && size_log2 == 4'd1));
        1: assert (!(failed && consumer == 16'd3));
      endcase
`endif
endmodule
`default_nettype wire
