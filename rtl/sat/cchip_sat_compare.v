// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_compare: macro stage 4 of the SAT pipeline (paper, figure 7): are the projection
// intervals (eq. 3) disjoint? Triangle against triangle.
//   latency      CCHIP_COMPARE_LATENCY = 2 clocks
//   throughput   one axis per clock, never stalls
//   numbers      signed projections of PROJ_W bits relative to the reference point
//   reset        none (data only)
// Normal axis (s_cross = 0): own primitive {0}, other one {p0, p1, p2}.
// Cross axis (s_cross = 1):  A {0, p0}, B {p1, p2}.
// Closed sets: separated only if every difference between the two sets is strictly of one sign.
module cchip_sat_compare #(
    // width of a projection, bit
    parameter integer PROJ_W = 51
) (
    input  wire                clk,
    input  wire                s_cross,
    input  wire [3*PROJ_W-1:0] s_projection, // p0 in the low bits
    output reg                 m_separated,
    output reg  [         2:0] m_negative,   // p_i < 0
    output reg  [         2:0] m_zero        // p_i = 0
);

  reg  [  PROJ_W-1:0] d10_q, d20_q;  // p1 - p0, p2 - p0
  reg  [3*PROJ_W-1:0] projection_q;
  reg                 cross_q;

  always @(posedge clk) begin
    projection_q <= s_projection;
    cross_q      <= s_cross;
    d10_q        <= s_projection[PROJ_W+:PROJ_W] - s_projection[0+:PROJ_W];
    d20_q        <= s_projection[2*PROJ_W+:PROJ_W] - s_projection[0+:PROJ_W];
  end

  reg [2:0] negative, zero;
  integer i;
  always @* begin
    for (i = 0; i < 3; i = i + 1) begin
      negative[i] = projection_q[PROJ_W*i+PROJ_W-1];
      zero[i]     = projection_q[PROJ_W*i+:PROJ_W] == {PROJ_W{1'b0}};
    end
  end
  wire [2:0] positive = ~(negative | zero);
  wire d10_negative = d10_q[PROJ_W-1];
  wire d20_negative = d20_q[PROJ_W-1];
  wire d10_positive = ~d10_negative & d10_q != {PROJ_W{1'b0}};
  wire d20_positive = ~d20_negative & d20_q != {PROJ_W{1'b0}};

  wire below = &negative[2:1] & (cross_q ? d10_negative & d20_negative : negative[0]);
  wire above = &positive[2:1] & (cross_q ? d10_positive & d20_positive : positive[0]);

  always @(posedge clk) begin
    m_separated <= below | above;
    m_negative  <= negative;
    m_zero      <= zero;
  end

endmodule
`default_nettype wire
