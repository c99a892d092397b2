// SPDX-License-Identifier: Apache-2.0
`include "cchip_defs.vh"
`default_nettype none
// cchip_pr_static: static side of the partial reconfiguration projects of Vivado and Quartus: the partition
// cchip_pr_region between registers, reached over a serial port, so that any device has pins enough.
//   in     in_shift moves in_bit into a record VERTEX of VERTEX_W bit, FIRST first; in_send = 1 for one clock sends it. A
//          pair is three or four vertices. One pair at a time: the next one after the result
//   out    out_take = 1 for one clock copies {idle, rm_id, valid, record SLOT_RESULT} (STATUS_W bit) and takes the result
//          if valid; out_shift brings it to out_bit, ID[0] first
//   swap   decouple = 1 holds back every vertex and result and reads the region as rm_id 0, idle 0; region_rst resets the
//          region. Both are apart from rst, which resets the static side and the region. Before decouple = 1 wait for
//          the result; before decouple = 0 hold region_rst for two clocks.
// Pins go through a register each. clk is the only clock.
module cchip_pr_static (
    input  wire clk,
    input  wire rst,
    input  wire decouple,
    input  wire region_rst,
    input  wire in_bit,
    input  wire in_shift,
    input  wire in_send,
    input  wire out_take,
    input  wire out_shift,
    output wire out_bit
);

  localparam integer VERTEX_W = `CCHIP_VERTEX_W(`CCHIP_COORD_W_DEFAULT);
  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;
  localparam integer STATUS_W = 1 + `CCHIP_RM_ID_W + 1 + RESULT_W;

  // ---- pins
  reg rst_q, decouple_q, region_rst_q, in_bit_q, in_shift_q, in_send_q, out_take_q, out_shift_q, out_bit_q;
  reg [VERTEX_W-1:0] vertex_q;
  reg [STATUS_W-1:0] status_q;
  wire [STATUS_W-1:0] status;

  assign out_bit = out_bit_q;

  always @(posedge clk) begin
    rst_q        <= rst;
    decouple_q   <= decouple;
    region_rst_q <= region_rst | rst;
    in_bit_q     <= in_bit;
    in_shift_q   <= in_shift;
    in_send_q    <= in_send;
    out_take_q   <= out_take;
    out_shift_q  <= out_shift;
    out_bit_q    <= status_q[0];
    if (in_shift_q) vertex_q <= {in_bit_q, vertex_q[VERTEX_W-1:1]};
    if (out_take_q) status_q <= status;
    else if (out_shift_q) status_q <= status_q >> 1;
  end

  // ---- boundary: a register each way, and gates that hold back everything while decoupled
  reg region_s_valid_q, result_valid_q;
  reg [VERTEX_W-1:0] region_s_data_q;
  reg [RESULT_W-1:0] result_q;
  wire region_m_valid, idle;
  wire [RESULT_W-1:0] region_result;
  wire [`CCHIP_RM_ID_W-1:0] rm_id;

  assign status = {idle & ~decouple_q, rm_id & {`CCHIP_RM_ID_W{~decouple_q}}, result_valid_q, result_q};

  always @(posedge clk) begin
    region_s_valid_q <= in_send_q & ~decouple_q & ~rst_q;
    region_s_data_q  <= vertex_q;
    if (region_m_valid && !decouple_q) result_q <= region_result;
    result_valid_q <= ~rst_q & ((region_m_valid & ~decouple_q) | (result_valid_q & ~out_take_q));
  end

  // ---- the partition; without parameters, so that every tool calls the empty cell by the same name
  cchip_pr_region u_region (
      .clk           (clk),
      .rst           (region_rst_q),
      .s_vertex_valid(region_s_valid_q),
      .s_vertex_data (region_s_data_q),
      .m_result_valid(region_m_valid),
      .m_result_data (region_result),
      .rm_id         (rm_id),
      .idle          (idle)
  );

endmodule
`default_nettype wire
