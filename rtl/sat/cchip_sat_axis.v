// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_sat_axis: macro stage 2 of the SAT pipeline (paper, figure 7): axis = e x f (eq. 1).
//   latency      SUBSTAGES clocks
//   throughput   one axis per clock, never stalls
//   numbers      points of COORD_W-bit coordinates; edges have COORD_W + 1 bits, axis components
//                2 COORD_W + 2 bits; exact for every input. m_edge_norm = |e|_1 + |f|_1, unsigned.
//   cost         six wide multipliers, nine adders; the norm
//   reset        none (data only)
// Substages: edges, [operand register], leaf input, leaf output, [product register], adder levels
// of wide products, difference of products, [result registers]. Those in brackets use what
// SUBSTAGES leaves over CCHIP_AXIS_SUBSTAGES_MIN: first the product register, then the operand
// register, then results.
module cchip_sat_axis #(
    parameter integer COORD_W = 16,   // width of a coordinate (bit); legal: 4..20
    // registers from input to output (clock); legal: >= CCHIP_AXIS_SUBSTAGES_MIN(COORD_W), >= 5
    parameter integer SUBSTAGES = 10
) (
    input  wire                                clk,         // clock, rising edge
    input  wire [               3*COORD_W-1:0] s_e_from,    // start of edge e, x in the low bits
    input  wire [               3*COORD_W-1:0] s_e_to,      // end of edge e
    input  wire [               3*COORD_W-1:0] s_f_from,    // start of edge f
    input  wire [               3*COORD_W-1:0] s_f_to,      // end of edge f
    // axis, x in the low bits, components signed, 2 COORD_W + 2 bits each
    output wire [3*`CCHIP_AXIS_W(COORD_W)-1:0] m_axis,
    output wire [  `CCHIP_NORM_W(COORD_W)-1:0] m_edge_norm  // |e|_1 + |f|_1, unsigned
);

  localparam integer EDGE_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer SPARE = SUBSTAGES - `CCHIP_AXIS_SUBSTAGES_MIN(COORD_W);
  localparam integer PRODUCT_REGS = SPARE >= 1 ? 1 : 0;
  localparam integer OPERAND_REGS = SPARE >= 2 ? 1 : 0;
  // edges, norms, their sum
  localparam integer NORM_FILL = SUBSTAGES - 2 - `CCHIP_NORM1_LATENCY;

  `CCHIP_REFUSE(SPARE < 0 || NORM_FILL < 0, cchip_error_SUBSTAGES_below_minimum_for_COORD_W)

  reg [3*EDGE_W-1:0] e_q, f_q;

  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_edge
      wire signed [COORD_W-1:0] e_from = s_e_from[COORD_W*d+:COORD_W];
      wire signed [COORD_W-1:0] e_to = s_e_to[COORD_W*d+:COORD_W];
      wire signed [COORD_W-1:0] f_from = s_f_from[COORD_W*d+:COORD_W];
      wire signed [COORD_W-1:0] f_to = s_f_to[COORD_W*d+:COORD_W];
      always @(posedge clk) begin
        e_q[EDGE_W*d+:EDGE_W] <= {e_to[COORD_W-1], e_to} - {e_from[COORD_W-1], e_from};
        f_q[EDGE_W*d+:EDGE_W] <= {f_to[COORD_W-1], f_to} - {f_from[COORD_W-1], f_from};
      end
    end
  endgenerate

  cchip_cross3 #(
      .E_W(EDGE_W),
      .OPERAND_REGS(OPERAND_REGS),
      .PRODUCT_REGS(PRODUCT_REGS),
      .RESULT_REGS(SPARE - OPERAND_REGS - PRODUCT_REGS)
  ) u_cross (
      .clk(clk),
      .a  (e_q),
      .b  (f_q),
      .q  (m_axis)
  );

  wire [EDGE_W:0] e_norm, f_norm;
  cchip_norm1 #(.V_W(EDGE_W)) u_e_norm (.clk(clk), .v(e_q), .q(e_norm));
  cchip_norm1 #(.V_W(EDGE_W)) u_f_norm (.clk(clk), .v(f_q), .q(f_norm));
  reg [EDGE_W+1:0] edge_norm_q;
  always @(posedge clk) edge_norm_q <= {1'b0, e_norm} + {1'b0, f_norm};
  cchip_delay #(.WIDTH(EDGE_W + 2), .DEPTH(NORM_FILL)) u_edge_norm (
      .clk(clk),
      .rst(1'b0),
      .d  (edge_norm_q),
      .q  (m_edge_norm)
  );

endmodule
`default_nettype wire
