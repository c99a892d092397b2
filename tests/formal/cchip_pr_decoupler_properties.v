// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_pr_decoupler, the region doing whatever it likes:
//   while decoupled every output is its constant, so no handshake happens on either side
//   decoupled follows decouple one clock later, also during reset
//   both streams are queues of two beats (queue_spec.v), emptied by reset and by decoupling; of the data one bit, any, is
//   followed (which: `bit_pair`, `bit_result`)
//   after stop no pair is accepted, nor while the region is blank; idle = 1 only with nothing in either queue
module cchip_pr_decoupler_properties #(
    parameter integer COORD_W = 4
) (
    input wire                                 clk,
    input wire                                 rst,
    input wire                                 stop,
    input wire                                 decouple,
    input wire                                 s_pair_valid,
    input wire [`CCHIP_REQUEST_W(COORD_W)-1:0] s_pair_data,
    input wire                                 m_result_ready,
    input wire                                 r_pair_ready,
    input wire                                 r_result_valid,
    input wire [          `CCHIP_RESULT_W-1:0] r_result_data,
    input wire [           `CCHIP_RM_ID_W-1:0] r_rm_id,
    input wire                                 r_idle
);
  localparam integer PAIR_W = `CCHIP_REQUEST_W(COORD_W);
  localparam integer RESULT_W = `CCHIP_RESULT_W;

  wire decoupled, s_pair_ready, m_result_valid, idle, r_pair_valid, r_result_ready;
  wire [7:0] rm_id;
  wire [PAIR_W-1:0] r_pair_data;
  wire [RESULT_W-1:0] m_result_data;
  cchip_pr_decoupler #(
      .COORD_W(COORD_W)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .stop          (stop),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .s_pair_valid  (s_pair_valid),
      .s_pair_ready  (s_pair_ready),
      .s_pair_data   (s_pair_data),
      .m_result_valid(m_result_valid),
      .m_result_ready(m_result_ready),
      .m_result_data (m_result_data),
      .rm_id         (rm_id),
      .idle          (idle),
      .r_pair_valid  (r_pair_valid),
      .r_pair_ready  (r_pair_ready),
      .r_pair_data   (r_pair_data),
      .r_result_valid(r_result_valid),
      .r_result_ready(r_result_ready),
      .r_result_data (r_result_data),
      .r_rm_id       (r_rm_id),
      .r_idle        (r_idle)
  );

  // ---- one bit of each queue
  (* anyconst *) reg [7:0] bit_pair;
  (* anyconst *) reg [5:0] bit_result;
  // vectors without an end that an index could pass
  wire [255:0] s_pair_all = {{256 - PAIR_W{1'b0}}, s_pair_data};
  wire [255:0] r_pair_all = {{256 - PAIR_W{1'b0}}, r_pair_data};
  wire [63:0] r_result_all = {{64 - RESULT_W{1'b0}}, r_result_data};
  wire [63:0] m_result_all = {{64 - RESULT_W{1'b0}}, m_result_data};
  wire close = rst | decouple;
  wire [7:0] pairs, results;
  wire pair_stalled, result_stalled;
  queue_spec spec_pair (
      .clk    (clk),
      .rst    (close),
      .s_valid(s_pair_valid),
      .s_ready(s_pair_ready),
      .s_data (s_pair_all[bit_pair]),
      .m_valid(r_pair_valid),
      .m_ready(r_pair_ready),
      .m_data (r_pair_all[bit_pair]),
      .count  (pairs),
      .stalled(pair_stalled)
  );
  queue_spec spec_result (
      .clk    (clk),
      .rst    (close),
      .s_valid(r_result_valid),
      .s_ready(r_result_ready),
      .s_data (r_result_all[bit_result]),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data (m_result_all[bit_result]),
      .count  (results),
      .stalled(result_stalled)
  );

  reg started_q = 1'b0;
  reg decouple_q, close_q, stop_q;
  always @(posedge clk) begin
    started_q  <= 1'b1;
    decouple_q <= decouple;
    close_q    <= close;
    stop_q     <= stop | (r_rm_id == 8'd0);
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      follows: assert (decoupled == decouple_q);
      if (decoupled) begin
        constant_static: assert (!s_pair_ready && !m_result_valid && m_result_data == {RESULT_W{1'b0}});
        constant_others: assert (rm_id == 8'd0 && idle);
        constant_region: assert (!r_pair_valid && !r_result_ready && r_pair_data == {PAIR_W{1'b0}});
        no_handshake: assert (!(s_pair_valid && s_pair_ready) && !(r_pair_valid && r_pair_ready)
            && !(r_result_valid && r_result_ready) && !(m_result_valid && m_result_ready));
      end
      pair_valid: assert (r_pair_valid == (pairs != 8'd0));
      pair_ready: assert (s_pair_ready == (!close_q && !stop_q && pairs != 8'd2));
      result_valid: assert (m_result_valid == (results != 8'd0));
      result_ready: assert (r_result_ready == (!close_q && results != 8'd2));
      idle_is_empty: assert (!idle || (pairs == 8'd0 && results == 8'd0));
    end
  end
  always @(posedge clk) begin
    both_full: cover (started_q && pairs == 8'd2 && results == 8'd2);
    cut_off: cover (started_q && decoupled && !pair_stalled && r_result_valid);
  end
endmodule
`default_nettype wire
