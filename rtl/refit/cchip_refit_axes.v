// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_refit_axes: axes of the direction at a place. Directions 0..2, the axes themselves, are
// places 0..2, those with cuts places 6..15.
//   cuts         none: combinational
module cchip_refit_axes (
    input  wire [3:0] place,  // place, 0..2 or 6..15
    output reg  [5:0] axes    // axes {negated, used}, 3 bit each, x first
);

  always @*
    case (place)
      4'd0: axes = 6'b000_001;
      4'd1: axes = 6'b000_010;
      4'd2: axes = 6'b000_100;
      4'd6: axes = 6'b000_011;
      4'd7: axes = 6'b010_011;
      4'd8: axes = 6'b000_101;
      4'd9: axes = 6'b100_101;
      4'd10: axes = 6'b000_110;
      4'd11: axes = 6'b100_110;
      4'd12: axes = 6'b000_111;
      4'd13: axes = 6'b100_111;
      4'd14: axes = 6'b010_111;
      default: axes = 6'b001_111;
    endcase

endmodule
`default_nettype wire
