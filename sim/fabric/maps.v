// SPDX-License-Identifier: Apache-2.0
// Yosys' LUTs, flip-flops and constants become cells of the fabric.
module \$lut (A, Y);
  parameter WIDTH = 1;
  parameter [(1 << WIDTH)-1:0] LUT = 0;
  input [WIDTH-1:0] A;
  output Y;
  generate
    case (WIDTH)
      1: LUT1 #(.INIT(LUT)) _TECHMAP_REPLACE_ (.O(Y), .I0(A[0]));
      2: LUT2 #(.INIT(LUT)) _TECHMAP_REPLACE_ (.O(Y), .I0(A[0]), .I1(A[1]));
      3: LUT3 #(.INIT(LUT)) _TECHMAP_REPLACE_ (.O(Y), .I0(A[0]), .I1(A[1]), .I2(A[2]));
      4: LUT4 #(.INIT(LUT)) _TECHMAP_REPLACE_ (.O(Y), .I0(A[0]), .I1(A[1]), .I2(A[2]), .I3(A[3]));
      default: wire _TECHMAP_FAIL_ = 1;
    endcase
  endgenerate
endmodule
module \$_DFF_P_ (input D, C, output Q);
  LUTFF _TECHMAP_REPLACE_ (.O(Q), .D(D), .CLK(C));
endmodule
module FABRIC_ONE (output O);
  LUT1 #(.INIT(2'b11)) _TECHMAP_REPLACE_ (.O(O));
endmodule
module FABRIC_ZERO (output O);
  LUT1 #(.INIT(2'b00)) _TECHMAP_REPLACE_ (.O(O));
endmodule
