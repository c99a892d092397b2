// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_bv_compare, for any planes: separated two clocks later exactly if the intervals of a direction are
// disjoint in whole numbers of 32 bits; the key six clocks later is the least overlap in its unit, at most 15.
module cchip_bv_compare_properties (
    input wire         clk,
    input wire [331:0] a,
    input wire [331:0] b
);
  wire separated;
  wire [3:0] key;
  cchip_bv_compare dut (
      .clk      (clk),
      .a        (a),
      .b        (b),
      .separated(separated),
      .key      (key)
  );

  wire [25:0] disjoint;
  wire [26*4-1:0] keys;  // each at most 15
  genvar d;
  generate
    for (d = 0; d < 13; d = d + 1) begin : gen_direction
      localparam integer W = d < 3 ? 12 : 13;
      localparam integer AT = d < 3 ? 24 * d : 72 + 26 * (d - 3);
      wire signed [31:0] a_upper = $signed(a[AT+:W]);
      wire signed [31:0] a_lower = $signed(a[AT+W+:W]);
      wire signed [31:0] b_upper = $signed(b[AT+:W]);
      wire signed [31:0] b_lower = $signed(b[AT+W+:W]);
      wire signed [31:0] above = a_upper - b_lower;
      wire signed [31:0] below = b_upper - a_lower;
      wire signed [31:0] above_units = above >>> (d < 3 ? 3 : 4);
      wire signed [31:0] below_units = below >>> (d < 3 ? 3 : 4);
      assign disjoint[2*d] = above < 0;
      assign disjoint[2*d+1] = below < 0;
      assign keys[8*d+:4] = above_units > 15 ? 4'd15 : above_units[3:0];
      assign keys[8*d+4+:4] = below_units > 15 ? 4'd15 : below_units[3:0];
    end
  endgenerate
  reg [3:0] least;
  integer i;
  always @(*) begin
    least = 4'd15;
    for (i = 0; i < 26; i = i + 1) if (keys[4*i+:4] < least) least = keys[4*i+:4];
  end

  reg apart1, apart2, apart3, apart4, apart5, apart6;
  reg [3:0] least1, least2, least3, least4, least5, least6;
  reg [2:0] clocks_q = 3'd0;
  always @(posedge clk) begin
    {apart1, apart2, apart3, apart4, apart5, apart6} <= {|disjoint, apart1, apart2, apart3, apart4, apart5};
    {least1, least2, least3, least4, least5, least6} <= {least, least1, least2, least3, least4, least5};
    if (clocks_q != 3'd6) clocks_q <= clocks_q + 3'd1;
  end
  always @(*) begin
    if (clocks_q >= 3'd2) separated_right: assert (separated == apart2);
    if (clocks_q >= 3'd6 && !apart6) key_right: assert (key == least6);
  end
endmodule
`default_nettype wire
