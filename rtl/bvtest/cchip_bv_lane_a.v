// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_bv_lane_a: planes of one child of a node of A in the directions of B.
//   rule         a plane of m = M^T d is that of the box, m centre +- |m| half, less (b - c) times
//                a face cut less c times a corner cut, m = (a - b) axis + (b - c) face + c corner
//   numbers      half steps of the node pair's grid, rounded down; planes modulo 2^17 in axes, 2^18
//                in diagonals, with 6 fraction bits, of which 1 leaves
//   latency      9 clocks from child; the other inputs come as many clocks after it as they say
//   throughput   a child on every clock
//   reset        none
// Bit for bit model::planes_of_a (docs/hardware/image.md, "Box test").
module cchip_bv_lane_a (
    input  wire         clk,             // clock, rising edge
    // ---- clock 0
    // volume of the child as its node stores it: 6 box corners of 7 bits, 12 face cuts and 8 corner
    // cuts of 3 bits
    input  wire [101:0] child,
    // clock 0: logarithm to base 4 of the grid's step in steps of A, 0..2; 3: the box counts as a
    // point
    input  wire [  1:0] scale,
    input  wire         coarse,          // clock 1: the node's cut exponent is 3 instead of 2
    // clock 1: of each direction which cuts apply: {corner reversed, corner, face reversed, face}
    input  wire [ 90:0] pose_select,
    input  wire [170:0] pose_m,          // clock 2: M, row by row, 17 fraction bits, -1..1
    // clock 2: the magnitudes of m = M^T d of each direction, 9 fraction bits; below 2
    input  wire [389:0] pose_magnitude,
    // clock 2: of each direction {c, 7 fraction bits; b - c, 6 fraction bits}
    input  wire [181:0] pose_factor,
    // clock 4: M o_A + t - o_B in half steps of the grid, 6 fraction bits
    input  wire [ 50:0] offset,
    // clock 9: planes of 3 axes, 24 bits each, then of 10 diagonals, 26 bits each: {lower, upper};
    // directions in the order of image.md, docs/hardware/image.md
    output wire [331:0] planes
);

  // The clocks below are counted for a leaf of two.
  `CCHIP_REFUSE(`CCHIP_MUL18_LATENCY != 2, cchip_error_bv_lane_a_needs_CCHIP_MUL18_LATENCY_2)

  // ---- clock 0: sum and difference of opposite corners are centre and half size in half steps
  wire [41:0] box = child[41:0];
  reg [59:0] cuts_q;  // of diagonal i: 3 bits at 6 i for the upper plane, at 6 i + 3 for the lower
  reg [1:0] scale_q;
  always @(posedge clk) begin
    cuts_q  <= child[101:42] & {60{scale == 2'd0}};
    scale_q <= scale;
  end

  wire signed [17:0] centre2[0:2];  // 5 fraction bits
  wire signed [17:0] half2[0:2];
  wire signed [12:0] centre4[0:2];
  genvar i, j, d, s;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_box
      wire signed [6:0] least = box[14*i+:7];
      wire signed [6:0] greatest = box[14*i+7+:7];
      reg signed [7:0] sum_q;
      reg [6:0] size_q;
      reg signed [12:0] centre_q2, centre_q3, centre_q4;
      reg [11:0] half_q2;
      wire [7:0] size = {greatest[6], greatest} - {least[6], least};
      always @(posedge clk) begin
        sum_q  <= {greatest[6], greatest} + {least[6], least};
        size_q <= size[6:0];
        case (scale_q)
          2'd0: begin
            centre_q2 <= {sum_q, 5'd0};
            half_q2   <= {size_q, 5'd0};
          end
          2'd1: begin
            centre_q2 <= {{2{sum_q[7]}}, sum_q, 3'd0};
            half_q2   <= {2'd0, size_q, 3'd0};
          end
          2'd2: begin
            centre_q2 <= {{4{sum_q[7]}}, sum_q, 1'b0};
            half_q2   <= {4'd0, size_q, 1'b0};
          end
          default: begin
            centre_q2 <= 13'd0;
            half_q2   <= 12'd0;
          end
        endcase
        centre_q3 <= centre_q2;
        centre_q4 <= centre_q3;
      end
      assign centre2[i] = {{5{centre_q2[12]}}, centre_q2};
      assign half2[i]   = {6'd0, half_q2};
      assign centre4[i] = centre_q4;
      wire unused = size[7];
    end
  endgenerate

`ifndef SYNTHESIS
  reg [1:0] settled_q;  // the products' flip-flops no longer hold what they had at power-up
  initial settled_q = 2'd0;
  always @(posedge clk) settled_q <= {settled_q[0], 1'b1};
`endif

  // ---- clocks 2 to 6: M centre + offset, of each axis of B
  wire signed [17:0] moved6[0:2], moved7[0:2];
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      // M_ij centre_j, 6 fraction bits: -1 times a centre of -128 half steps is +128, a bit more
      wire signed [14:0] term4[0:2];
      for (j = 0; j < 3; j = j + 1) begin : gen_term
        wire [18:0] m = pose_m[19*(3*i+j)+:19];
        wire signed [35:0] p;
        reg one_q3, one_q4;  // M_ij is 1, which has no place in 18 bits
        always @(posedge clk) begin
          one_q3 <= ~m[18] & m[17];
          one_q4 <= one_q3;
        end
        cchip_mul18 u_mul (.clk(clk), .a(m[17:0]), .b(centre2[j]), .p(p));
        assign term4[j] = one_q4 ? {centre4[j][12], centre4[j], 1'b0} : p[30:16];
        wire unused = &{1'b0, p[35:31], p[15:0]};
`ifndef SYNTHESIS
        // Holds for any entry: the multiplier takes 18 bits of it, -1 to 1 - 2^-17
        always @(posedge clk) begin
          if (settled_q[1]) begin
            `CCHIP_NARROW(a_term, p[35:30])
          end
        end
`endif
      end
      reg signed [17:0] first_q5, rest_q5, moved_q6, moved_q7;
      assign moved6[i] = moved_q6;
      assign moved7[i] = moved_q7;
      wire [16:0] at = offset[17*i+:17];
      always @(posedge clk) begin
        first_q5 <= {{3{term4[0][14]}}, term4[0]} + {{3{term4[1][14]}}, term4[1]};
        rest_q5 <= {{3{term4[2][14]}}, term4[2]} + {at[16], at};
        moved_q6 <= first_q5 + rest_q5;
        moved_q7 <= moved_q6;
      end
    end
  endgenerate

  // ---- the middle of each direction: axes and face diagonals at clock 7, cube diagonals at 8
  wire signed [17:0] middle7[0:8];
  reg signed [17:0] face0_q7, face1_q7, face2_q7, face3_q7, face4_q7, face5_q7;
  reg signed [17:0] corner0_q8, corner1_q8, corner2_q8, corner3_q8;
  wire signed [17:0] face7[0:5];
  wire signed [17:0] corner8[0:3];
  assign face7[0] = face0_q7;
  assign face7[1] = face1_q7;
  assign face7[2] = face2_q7;
  assign face7[3] = face3_q7;
  assign face7[4] = face4_q7;
  assign face7[5] = face5_q7;
  assign corner8[0] = corner0_q8;
  assign corner8[1] = corner1_q8;
  assign corner8[2] = corner2_q8;
  assign corner8[3] = corner3_q8;
  always @(posedge clk) begin
    face0_q7   <= moved6[0] + moved6[1];
    face1_q7   <= moved6[0] - moved6[1];
    face2_q7   <= moved6[0] + moved6[2];
    face3_q7   <= moved6[0] - moved6[2];
    face4_q7   <= moved6[1] + moved6[2];
    face5_q7   <= moved6[1] - moved6[2];
    corner0_q8 <= face0_q7 + moved7[2];
    corner1_q8 <= face0_q7 - moved7[2];
    corner2_q8 <= face1_q7 + moved7[2];
    corner3_q8 <= moved7[2] - face1_q7;
  end
  generate
    for (d = 0; d < 9; d = d + 1) begin : gen_middle
      if (d < 3) begin : gen_of_axis
        assign middle7[d] = moved7[d];
      end else begin : gen_face
        assign middle7[d] = face7[d-3];
      end
    end
  endgenerate

  function [5:0] choose_face(input [35:0] from, input [2:0] which);
    case (which)
      3'd0: choose_face = from[5:0];
      3'd1: choose_face = from[11:6];
      3'd2: choose_face = from[17:12];
      3'd3: choose_face = from[23:18];
      3'd4: choose_face = from[29:24];
      default: choose_face = from[35:30];
    endcase
  endfunction
  function [5:0] choose_corner(input [23:0] from, input [1:0] which);
    case (which)
      2'd0: choose_corner = from[5:0];
      2'd1: choose_corner = from[11:6];
      2'd2: choose_corner = from[17:12];
      default: choose_corner = from[23:18];
    endcase
  endfunction

  // ---- extent and planes of each direction
  generate
    for (d = 0; d < 13; d = d + 1) begin : gen_direction
      wire [6:0] select = pose_select[7*d+:7];
      wire [5:0] face1 = choose_face(cuts_q[35:0], select[2:0]);
      wire [5:0] corner1 = choose_corner(cuts_q[59:36], select[5:4]);

      wire [15:0] term4[0:2];  // |m_j| half_j, 6 fraction bits
      for (j = 0; j < 3; j = j + 1) begin : gen_term
        wire signed [35:0] p;
        cchip_mul18 u_mul (
            .clk(clk),
            .a  ({8'd0, pose_magnitude[30*d+10*j+:10]}),
            .b  (half2[j]),
            .p  (p)
        );
        assign term4[j] = {2'd0, p[21:8]};
        wire unused = &{1'b0, p[35:22], p[7:0]};
      end
      reg [15:0] first_q5, rest_q5, extent_q6;
      always @(posedge clk) begin
        first_q5  <= term4[0] + term4[1];
        rest_q5   <= term4[2];
        extent_q6 <= first_q5 + rest_q5;
      end

      // Both cuts in one product: (f + c 2^11) (corner + face 2^11), bits 11 to 21.
      wire [13:0] factor = pose_factor[14*d+:14];
      for (s = 0; s < 2; s = s + 1) begin : gen_side  // upper, lower
        wire [2:0] face = select[3] != (s == 1) ? face1[5:3] : face1[2:0];
        wire [2:0] corner = select[6] != (s == 1) ? corner1[5:3] : corner1[2:0];
        reg [3:0] face_q2, corner_q2;
        reg [10:0] cut_q5, cut_q6;
        reg signed [17:0] extent_q7;
        wire signed [35:0] p;
        cchip_mul18 #(.SIGNED(0)) u_mul (
            .clk(clk),
            .a  ({factor[13:7], 4'd0, factor[6:0]}),
            .b  ({3'd0, face_q2, 7'd0, corner_q2}),
            .p  (p)
        );
        always @(posedge clk) begin
          face_q2   <= coarse ? {face, 1'b0} : {1'b0, face};
          corner_q2 <= coarse ? {corner, 1'b0} : {1'b0, corner};
          cut_q5    <= p[21:11];
          cut_q6    <= cut_q5;
          extent_q7 <= {{2'd0, extent_q6[15:2]} - {5'd0, cut_q6}, extent_q6[1:0]};
        end
        wire unused = &{1'b0, p[35:22], p[10:0]};

        if (d < 9) begin : gen_early
          reg [17:0] plane_q8, plane_q9;
          always @(posedge clk) begin
            plane_q8 <= s == 0 ? middle7[d] + extent_q7 : middle7[d] - extent_q7;
            plane_q9 <= plane_q8;
          end
          if (d < 3) begin : gen_out
            assign planes[24*d+12*s+:12] = plane_q9[16:5];
            wire unused_low = &{1'b0, plane_q9[17], plane_q9[4:0]};
          end else begin : gen_out
            assign planes[72+26*(d-3)+13*s+:13] = plane_q9[17:5];
            wire unused_low = &{1'b0, plane_q9[4:0]};
          end
        end else begin : gen_late
          reg signed [17:0] extent_q8;
          reg [17:0] plane_q9;
          always @(posedge clk) begin
            extent_q8 <= extent_q7;
            plane_q9  <= s == 0 ? corner8[d-9] + extent_q8 : corner8[d-9] - extent_q8;
          end
          assign planes[72+26*(d-3)+13*s+:13] = plane_q9[17:5];
          wire unused_low = &{1'b0, plane_q9[4:0]};
        end
      end
    end
  endgenerate

endmodule
`default_nettype wire
