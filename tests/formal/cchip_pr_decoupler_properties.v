// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_pr_decoupler, for any behaviour of the region:
//   while decoupled every output is its constant
//   decoupled follows decouple one clock later, also during reset
//   otherwise each output is the input of the other side one clock ago, and idle = 1 only with no vertex on its way
module cchip_pr_decoupler_properties #(
    parameter integer COORD_W = 4
) (
    input wire                                clk,
    input wire                                rst,
    input wire                                decouple,
    input wire                                s_vertex_valid,
    input wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    input wire                                r_result_valid,
    input wire [    `CCHIP_SLOT_RESULT_W-1:0] r_result_data,
    input wire [          `CCHIP_RM_ID_W-1:0] r_rm_id,
    input wire                                r_idle
);
  localparam integer VERTEX_W = `CCHIP_VERTEX_W(COORD_W);
  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;

  wire decoupled, m_result_valid, idle, r_vertex_valid;
  wire [7:0] rm_id;
  wire [VERTEX_W-1:0] r_vertex_data;
  wire [RESULT_W-1:0] m_result_data;
  cchip_pr_decoupler #(
      .COORD_W(COORD_W)
  ) dut (
      .clk           (clk),
      .rst           (rst),
      .decouple      (decouple),
      .decoupled     (decoupled),
      .s_vertex_valid(s_vertex_valid),
      .s_vertex_data (s_vertex_data),
      .m_result_valid(m_result_valid),
      .m_result_data (m_result_data),
      .rm_id         (rm_id),
      .idle          (idle),
      .r_vertex_valid(r_vertex_valid),
      .r_vertex_data (r_vertex_data),
      .r_result_valid(r_result_valid),
      .r_result_data (r_result_data),
      .r_rm_id       (r_rm_id),
      .r_idle        (r_idle)
  );

  reg started_q = 1'b0;
  reg decouple_q, close_q;
  reg vertex_valid_q, result_valid_q;
  reg [VERTEX_W-1:0] vertex_q;
  reg [RESULT_W-1:0] result_q;
  reg [7:0] rm_id_q;
  always @(posedge clk) begin
    started_q      <= 1'b1;
    decouple_q     <= decouple;
    close_q        <= rst | decouple;
    vertex_valid_q <= s_vertex_valid;
    result_valid_q <= r_result_valid;
    vertex_q       <= s_vertex_data;
    result_q       <= r_result_data;
    rm_id_q        <= r_rm_id;
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      follows: assert (decoupled == decouple_q);
      if (decoupled || close_q) begin
        constant_static: assert (!m_result_valid && m_result_data == {RESULT_W{1'b0}});
        constant_others: assert (rm_id == 8'd0 && idle);
        constant_region: assert (!r_vertex_valid && r_vertex_data == {VERTEX_W{1'b0}});
      end else begin
        vertex: assert (r_vertex_valid == vertex_valid_q && r_vertex_data == vertex_q);
        result: assert (m_result_valid == result_valid_q && m_result_data == result_q);
        module_id: assert (rm_id == rm_id_q);
        idle_is_empty: assert (!idle || !r_vertex_valid);
      end
    end
  end
  always @(posedge clk) begin
    both: cover (started_q && r_vertex_valid && m_result_valid);
    cut_off: cover (started_q && decoupled && s_vertex_valid && r_result_valid);
  end
endmodule
`default_nettype wire
