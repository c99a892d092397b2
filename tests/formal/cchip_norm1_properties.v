// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_norm1, for any vector, the least numbers included: q is the sum of the magnitudes.
module cchip_norm1_properties #(
    parameter integer V_W = 17
) (
    input wire             clk,
    input wire [3*V_W-1:0] v
);
  wire [V_W:0] q;
  cchip_norm1 #(
      .V_W(V_W)
  ) dut (
      .clk(clk),
      .v  (v),
      .q  (q)
  );
  reg [3*V_W-1:0] v1, v2, v3;
  reg [1:0] clocks_q = 2'd0;
  always @(posedge clk) begin
    {v1, v2, v3} <= {v, v1, v2};
    if (clocks_q != 2'd3) clocks_q <= clocks_q + 2'd1;
  end
  wire signed [63:0] x = $signed(v3[0+:V_W]);
  wire signed [63:0] y = $signed(v3[V_W+:V_W]);
  wire signed [63:0] z = $signed(v3[2*V_W+:V_W]);
  wire signed [63:0] sum = (x < 0 ? -x : x) + (y < 0 ? -y : y) + (z < 0 ? -z : z);
  always @(*) if (clocks_q == 2'd3) sum_right: assert ({{63 - V_W{1'b0}}, q} == sum);
endmodule
`default_nettype wire
