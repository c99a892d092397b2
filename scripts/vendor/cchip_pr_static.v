// SPDX-License-Identifier: Apache-2.0
`include "cchip_defs.vh"
`default_nettype none
// cchip_pr_static: static side of the partial reconfiguration projects of Vivado and Quartus: the partition
// cchip_pr_region between two stream registers, reached over a serial port, so that any device has pins enough.
//   in     in_shift moves in_bit into a record REQUEST of PAIR_W bit, tag[0] first; in_send = 1 for one clock while
//          in_ready = 1 sends it
//   out    out_take = 1 for one clock copies {idle, rm_id, valid, record RESULT} (STATUS_W bit) and takes the result if
//          valid; out_shift brings it to out_bit, tag[0] first
//   swap   decouple = 1 holds every handshake and reads the region as rm_id 0, idle 0; region_rst resets the region.
//          Both are apart from rst, which resets the static side and the region. Before decouple = 1 wait until all
//          results are out; before decouple = 0 hold region_rst for two clocks.
// Pins go through a register each. clk is the only clock.
module cchip_pr_static (
    input  wire clk,
    input  wire rst,
    input  wire decouple,
    input  wire region_rst,
    input  wire in_bit,
    input  wire in_shift,
    input  wire in_send,
    output wire in_ready,
    input  wire out_take,
    input  wire out_shift,
    output wire out_bit
);

  localparam integer PAIR_W = `CCHIP_REQUEST_W(`CCHIP_COORD_W_DEFAULT);
  localparam integer RESULT_W = `CCHIP_RESULT_W;
  localparam integer STATUS_W = 1 + `CCHIP_RM_ID_W + 1 + RESULT_W;

  // ---- pins
  reg rst_q, decouple_q, region_rst_q, in_bit_q, in_shift_q, in_send_q, in_ready_q, out_take_q, out_shift_q, out_bit_q;
  reg [PAIR_W-1:0] pair_q;
  reg [STATUS_W-1:0] status_q;
  wire [STATUS_W-1:0] status;
  wire pair_ready;

  assign in_ready = in_ready_q;
  assign out_bit  = out_bit_q;

  always @(posedge clk) begin
    rst_q        <= rst;
    decouple_q   <= decouple;
    region_rst_q <= region_rst | rst;
    in_bit_q     <= in_bit;
    in_shift_q   <= in_shift;
    in_send_q    <= in_send;
    in_ready_q   <= pair_ready;
    out_take_q   <= out_take;
    out_shift_q  <= out_shift;
    out_bit_q    <= status_q[0];
    if (in_shift_q) pair_q <= {in_bit_q, pair_q[PAIR_W-1:1]};
    if (out_take_q) status_q <= status;
    else if (out_shift_q) status_q <= status_q >> 1;
  end

  // ---- boundary: registers, and gates that hold both handshakes while decoupled
  wire region_s_valid, region_s_ready, region_m_valid, region_m_ready, idle;
  wire pair_valid, result_valid, result_ready;
  wire [PAIR_W-1:0] pair;
  wire [RESULT_W-1:0] region_result, result;
  wire [`CCHIP_RM_ID_W-1:0] rm_id;

  assign region_s_valid = pair_valid & ~decouple_q;
  assign region_m_ready = result_ready & ~decouple_q;
  assign status = {idle & ~decouple_q, rm_id & {`CCHIP_RM_ID_W{~decouple_q}}, result_valid, result};

  cchip_skid_buffer #(
      .WIDTH(PAIR_W)
  ) u_pair (
      .clk    (clk),
      .rst    (rst_q),
      .stop   (1'b0),
      .s_valid(in_send_q),
      .s_ready(pair_ready),
      .s_data (pair_q),
      .m_valid(pair_valid),
      .m_ready(region_s_ready & ~decouple_q),
      .m_data (pair)
  );

  cchip_skid_buffer #(
      .WIDTH(RESULT_W)
  ) u_result (
      .clk    (clk),
      .rst    (rst_q),
      .stop   (1'b0),
      .s_valid(region_m_valid & ~decouple_q),
      .s_ready(result_ready),
      .s_data (region_result),
      .m_valid(result_valid),
      .m_ready(out_take_q),
      .m_data (result)
  );

  // ---- the partition; without parameters, so that every tool calls the empty cell by the same name
  cchip_pr_region u_region (
      .clk           (clk),
      .rst           (region_rst_q),
      .s_pair_valid  (region_s_valid),
      .s_pair_ready  (region_s_ready),
      .s_pair_data   (pair),
      .m_result_valid(region_m_valid),
      .m_result_ready(region_m_ready),
      .m_result_data (region_result),
      .rm_id         (rm_id),
      .idle          (idle)
  );

endmodule
`default_nettype wire
