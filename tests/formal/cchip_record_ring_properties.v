// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_record_ring, for some clocks after reset: records leave in the order in which they were taken, each with the
// phase of its round, to its place in the ring; none is written over one that the host has not read; producer counts the writes
// that were confirmed before the first that failed, so consumer <= producer <= records written <= consumer + 2^size_log2; a
// write that waits does not change.
// Assumed: a ring of at most 8 records; consumer never passes producer; answers come for writes that were taken, once each.
// One record, any, is followed: bit 0 of its data is 1, and of all others 0.
module cchip_record_ring_properties (
    input wire                           clk,
    input wire                           rst,
    input wire [                    2:0] reads,         // records that the host reads
    input wire                           s_valid,
    input wire                           m_ready,
    input wire                           s_answer,
    input wire [`CCHIP_WRITE_CODE_W-1:0] s_answer_code
);
  (* anyconst *) wire [4:0] size_log2;
  (* anyconst *) wire [31:0] followed;
  reg [31:0] taken_q, written_q, answered_q, held_q, consumer_q;
  reg failed_q;
  wire [31:0] producer;
  wire failed, s_ready, m_valid;
  wire [59:0] m_address;
  wire [127:0] m_data;
  wire [15:0] m_strb;
  cchip_record_ring #(
      .DATA_W(128)
  ) dut (
      .clk          (clk),
      .rst          (rst),
      .base         (60'd0),
      .size_log2    (size_log2),
      .consumer     (consumer_q),
      .producer     (producer),
      .failed       (failed),
      .s_valid      (s_valid),
      .s_ready      (s_ready),
      .s_data       ({127'd0, taken_q == followed}),
      .m_valid      (m_valid),
      .m_ready      (m_ready),
      .m_address    (m_address),
      .m_data       (m_data),
      .m_strb       (m_strb),
      .s_answer     (s_answer),
      .s_answer_code(s_answer_code)
  );

  reg started_q = 1'b0, stalled_q;
  reg [59:0] address_q;
  wire [31:0] place = written_q & ~(32'hFFFFFFFF << size_log2);
  wire [31:0] round = written_q >> size_log2;
  always @(posedge clk) started_q <= 1'b1;
  always @* begin
    assume (started_q || rst);
    assume (size_log2 <= 5'd3);
    assume ({29'd0, reads} <= producer - consumer_q);
    assume (!s_answer || answered_q != written_q);
  end
  wire goes = m_valid & m_ready;
  always @(posedge clk) begin
    taken_q <= taken_q + {31'd0, s_valid & s_ready};
    written_q <= written_q + {31'd0, goes};
    answered_q <= answered_q + {31'd0, s_answer};
    failed_q <= failed_q | (s_answer && s_answer_code != `CCHIP_WRITE_OK);
    if (s_answer && s_answer_code == `CCHIP_WRITE_OK && !failed_q) held_q <= held_q + 32'd1;
    consumer_q <= consumer_q + {29'd0, reads};
    stalled_q <= m_valid & ~m_ready;
    address_q <= m_address;
    if (rst) begin
      {taken_q, written_q, answered_q, held_q, consumer_q} <= 160'd0;
      {failed_q, stalled_q} <= 2'd0;
    end
    if (started_q && !rst) begin
      assert (producer == held_q);
      assert (failed == failed_q);
      assert (written_q - consumer_q <= 32'd1 << size_log2);
      assert (producer - consumer_q <= written_q - consumer_q);
      assert (!stalled_q || (m_valid && m_address == address_q));
      if (m_valid) begin
        assert (m_address == {28'd0, place});
        assert (m_data[0] == (written_q == followed));
        assert (m_data[`CCHIP_PAIR_RECORD_PHASE] == ~round[0]);
        assert (written_q - consumer_q < 32'd1 << size_log2);
      end
    end
  end
`ifdef COVER
  always @(posedge clk)
    if (started_q && !rst)
      case (`COVER)
        0: assert (!(m_valid && written_q == followed && followed > 32'd2 && size_log2 == 5'd1));
        1: assert (!(failed && held_q == 32'd2 && !m_valid));
      endcase
`endif
endmodule
`default_nettype wire
