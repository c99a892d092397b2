// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_pr_decoupler: the boundary of a reconfigurable region. Static side: s_*, m_*. Region side:
// r_*. The streams are records REQUEST and RESULT.
//   latency      1 clock each way
//   throughput   one beat per clock
//   cuts         every path both ways: every output is a flip-flop
//   decouple     decoupled follows one clock later; while it is 1 every output is constant: valid,
//                ready and data 0 on both sides, rm_id CCHIP_RM_BLANK, idle 1. Beats inside, and
//                one handed over on the clock on which decouple rises, are lost: stop first, wait
//                for the answers, then decouple
//   stop         s_pair_ready is 0 from the next clock on; pairs inside and answers pass
//   blank        no pair is accepted while r_rm_id is CCHIP_RM_BLANK: no module would answer it
//   reset        empties both streams; has no effect on decoupled
module cchip_pr_decoupler #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16
) (
    input  wire                                   clk,
    input  wire                                   rst,
    input  wire                                   stop,
    input  wire                                   decouple,
    output wire                                   decoupled,
    // static side
    input  wire                                   s_pair_valid,
    output wire                                   s_pair_ready,
    input  wire [  `CCHIP_REQUEST_W(COORD_W)-1:0] s_pair_data,
    output wire                                   m_result_valid,
    input  wire                                   m_result_ready,
    output wire [            `CCHIP_RESULT_W-1:0] m_result_data,
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                   idle,
    // region side
    output wire                                   r_pair_valid,
    input  wire                                   r_pair_ready,
    output wire [  `CCHIP_REQUEST_W(COORD_W)-1:0] r_pair_data,
    input  wire                                   r_result_valid,
    output wire                                   r_result_ready,
    input  wire [            `CCHIP_RESULT_W-1:0] r_result_data,
    input  wire [             `CCHIP_RM_ID_W-1:0] r_rm_id,
    input  wire                                   r_idle
);

  wire close = rst | decouple;
  wire blank = r_rm_id == `CCHIP_RM_BLANK;

  cchip_skid_buffer #(
      .WIDTH     (`CCHIP_REQUEST_W(COORD_W)),
      .CLEAR_DATA(1)
  ) u_pair (
      .clk    (clk),
      .rst    (close),
      .stop   (stop | blank),
      .s_valid(s_pair_valid),
      .s_ready(s_pair_ready),
      .s_data (s_pair_data),
      .m_valid(r_pair_valid),
      .m_ready(r_pair_ready),
      .m_data (r_pair_data)
  );

  cchip_skid_buffer #(
      .WIDTH     (`CCHIP_RESULT_W),
      .CLEAR_DATA(1)
  ) u_result (
      .clk    (clk),
      .rst    (close),
      .stop   (1'b0),
      .s_valid(r_result_valid),
      .s_ready(r_result_ready),
      .s_data (r_result_data),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data (m_result_data)
  );

  reg decoupled_q;
  reg [`CCHIP_RM_ID_W-1:0] rm_id_q;
  reg idle_q;

  assign decoupled = decoupled_q;
  assign rm_id     = rm_id_q;
  assign idle      = idle_q;

  // the region's own idle does not include the beats inside the two buffers
  wire accept = s_pair_valid & s_pair_ready;
  wire filled = accept | r_pair_valid | r_result_valid | m_result_valid;

  always @(posedge clk) begin
    decoupled_q <= decouple;
    rm_id_q     <= close ? `CCHIP_RM_BLANK : r_rm_id;
    idle_q      <= close | (r_idle & ~filled);
  end

  always @(posedge clk)
    if (!rst && decoupled_q) begin
      `CCHIP_ASSERT(a_no_pair, !s_pair_ready && !r_pair_valid)
      `CCHIP_ASSERT(a_no_result, !m_result_valid && !r_result_ready)
    end

endmodule
`default_nettype wire
