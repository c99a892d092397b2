// SPDX-License-Identifier: Apache-2.0
`default_nettype none
`include "cchip_defs.vh"
// small_region: two small modules with the ports of cchip_pr_region, for a fabric that is generated
// in seconds. A pair is answered from its last vertex, two clocks later.
//   RM_ID 1      the sum of A and B over the vertices of the pair
//   RM_ID 2      A xor B, rotated from vertex to vertex
//   result       {answers since the reset (6 bit), value (12 bit), number of the pair}: the state
//                is seen in every answer, so one that is left over is seen, too
module small_region #(
    parameter integer RM_ID = 1,     // legal: 0, 1, 2
    parameter integer COORD_W = 4,   // legal: 4
    parameter integer CONTEXTS = 1   // not used
) (
    input  wire                                clk,
    input  wire                                rst,
    input  wire                                s_vertex_valid,
    input  wire [`CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,
    output wire                                m_result_valid,
    output wire [    `CCHIP_SLOT_RESULT_W-1:0] m_result_data,
    output wire [          `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                idle
);

  localparam [31:0] NUMBER = RM_ID;
  assign rm_id = NUMBER[7:0];
  wire unused = CONTEXTS != 0;

  generate
    if (RM_ID == 0) begin : gen_blank
      assign m_result_valid = 1'b0;
      assign m_result_data = 26'd0;
      assign idle = 1'b1;
    end else begin : gen_module
      wire first = s_vertex_data[`CCHIP_VERTEX_FIRST];
      wire last = s_vertex_data[`CCHIP_VERTEX_LAST];
      wire [11:0] a = s_vertex_data[`CCHIP_VERTEX_A(4)];
      wire [11:0] b = s_vertex_data[`CCHIP_VERTEX_B(4)];
      reg begun_q, answer_q, valid_q;
      reg [11:0] value_q;
      reg [5:0] count_q;
      reg [7:0] id_q;
      wire [11:0] old = first ? 12'd0 : value_q;
      wire [11:0] value = RM_ID == 1 ? old + a + b : {old[10:0], old[11]} ^ a ^ b;
      always @(posedge clk)
        if (rst) begin
          begun_q  <= 1'b0;
          answer_q <= 1'b0;
          valid_q  <= 1'b0;
          value_q  <= 12'd0;
          count_q  <= 6'd0;
          id_q     <= 8'd0;
        end else begin
          if (s_vertex_valid) begin
            value_q <= value;
            id_q    <= s_vertex_data[`CCHIP_VERTEX_ID];
            begun_q <= ~last;
          end
          answer_q <= s_vertex_valid & last;
          valid_q  <= answer_q;
          if (answer_q) count_q <= count_q + 6'd1;
        end
      assign m_result_valid = valid_q;
      assign m_result_data  = {count_q, value_q, id_q};
      assign idle = ~(begun_q | answer_q | valid_q);
    end
  endgenerate

endmodule
`default_nettype wire
