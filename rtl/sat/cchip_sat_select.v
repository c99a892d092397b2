// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_sat_select: macro stage 1 of the SAT pipeline (paper, figure 7). Chooses the two edges e, f whose
// cross product is the axis (or a constant unit vector for f), and the points to project.
//   latency      CCHIP_SELECT_LATENCY = 1 clock
//   throughput   one axis per clock, never stalls
//   numbers      points of three signed COORD_W-bit coordinates, x in the low bits
//   reset        none (data only)
//
//   class         e                 f           own points         points of the other
//   NORMAL_A 0    V0V1, quad V0V2   V0V2, V1V3  quad V1            all W
//   NORMAL_A 1..4 two edges of the face without vertex k-1: that vertex;      all W
//   CROSS k l     edge k of A       edge l of B A's others         Wl, B's others
//   IN_PLANE_A k l  edge k of A     unit vector l   none           all W
//   NORMAL_B, IN_PLANE_B: the same with A and B, V and W exchanged
// Sides are edges k = 0..3 from vertex k to k + 1, edge 4 is V0V2, edge 5 V1V3. The points of the other
// primitive fill the last slots; a slot left over (slot 0) repeats one of them. The start of e is the
// reference of the projection: vertices that are not among the points project onto the same value as
// it or as a point. Any other class selects like NORMAL_A; its verdict has no meaning.
module cchip_sat_select #(
    // width of a coordinate, bit
    parameter integer COORD_W = 16,
    // vertices of A and of B: 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3
) (
    input  wire                                     clk,
    input  wire [                              8:0] s_code,    // {class, k, l}
    input  wire [            3*VERTS_A*COORD_W-1:0] s_a,       // vertex 0 in the low bits
    input  wire [            3*VERTS_B*COORD_W-1:0] s_b,
    output reg  [                    3*COORD_W-1:0] m_e_from,
    output reg  [                    3*COORD_W-1:0] m_e_to,
    output reg  [                    3*COORD_W-1:0] m_f_from,
    output reg  [                    3*COORD_W-1:0] m_f_to,
    output reg  [3*(VERTS_A+VERTS_B-3)*COORD_W-1:0] m_points,  // p0 in the low bits
    output reg  [                              1:0] m_own      // slot 0, 1 holds an own point
);

`include "cchip_defs.vh"

  localparam integer POINT_W = 3 * COORD_W;
  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);

  generate
    if (VERTS_A < 3 || VERTS_A > VERTS_B || VERTS_B > 4) begin : gen_illegal
      cchip_error_VERTS_must_be_3_3_or_3_4_or_4_4 u_error ();
    end
  endgenerate

  wire [`CCHIP_CLASS_W-1:0] axis_class = s_code[8:6];
  wire [2:0] k = s_code[5:3];
  wire [2:0] l = s_code[2:0];
  wire is_cross = axis_class == `CCHIP_AXIS_CROSS;
  wire is_in_plane = axis_class == `CCHIP_AXIS_IN_PLANE_A || axis_class == `CCHIP_AXIS_IN_PLANE_B;
  wire own_b = axis_class == `CCHIP_AXIS_NORMAL_B || axis_class == `CCHIP_AXIS_IN_PLANE_B;

  // four vertices each; vertex 3 of a triangle is never selected
  wire [4*POINT_W-1:0] a, b;
  generate
    if (VERTS_A == 4) begin : gen_a_quad
      assign a = s_a;
    end else begin : gen_a_triangle
      assign a = {s_a[0+:POINT_W], s_a};
    end
    if (VERTS_B == 4) begin : gen_b_quad
      assign b = s_b;
    end else begin : gen_b_triangle
      assign b = {s_b[0+:POINT_W], s_b};
    end
  endgenerate

  function [POINT_W-1:0] pick(input [4*POINT_W-1:0] v, input [1:0] i);
    case (i)
      2'd0: pick = v[0+:POINT_W];
      2'd1: pick = v[POINT_W+:POINT_W];
      2'd2: pick = v[2*POINT_W+:POINT_W];
      default: pick = v[3*POINT_W+:POINT_W];
    endcase
  endfunction

  // i + offset among the vertices of a triangle or quad
  function [1:0] around(input quad, input [1:0] i, input [1:0] offset);
    reg [2:0] sum;
    begin
      sum = {1'b0, i} + {1'b0, offset};
      around = !quad && sum >= 3'd3 ? sum[1:0] - 2'd3 : sum[1:0];
    end
  endfunction

  // {to, from} of edge k, {other 1, other 0}: the vertices off it
  function [7:0] edge_of(input quad, input [2:0] index);
    case (index)
      3'd4: edge_of = {2'd3, 2'd1, 2'd2, 2'd0};
      3'd5: edge_of = {2'd2, 2'd0, 2'd3, 2'd1};
      default:
      edge_of = {around(quad, index[1:0], 2'd3), around(quad, index[1:0], 2'd2),
                 around(quad, index[1:0], 2'd1), index[1:0]};
    endcase
  endfunction

  // normals: {own point, f to, f from, e to, e from}
  function [9:0] normal_of(input quad, input [2:0] index);
    if (!quad) normal_of = {2'd0, 2'd2, 2'd0, 2'd1, 2'd0};
    else
      case (index)
        3'd1: normal_of = {2'd0, 2'd3, 2'd1, 2'd2, 2'd1};
        3'd2: normal_of = {2'd1, 2'd3, 2'd0, 2'd2, 2'd0};
        3'd3: normal_of = {2'd2, 2'd3, 2'd0, 2'd1, 2'd0};
        3'd4: normal_of = {2'd3, 2'd2, 2'd0, 2'd1, 2'd0};
        default: normal_of = {2'd1, 2'd3, 2'd1, 2'd2, 2'd0};
      endcase
  endfunction

  wire own_quad = own_b ? VERTS_B == 4 : VERTS_A == 4;
  wire [4*POINT_W-1:0] own = own_b ? b : a;
  wire [4*POINT_W-1:0] other = own_b ? a : b;
  wire [7:0] own_edge = edge_of(own_quad, k);
  wire [7:0] b_edge = edge_of(VERTS_B == 4, l);
  wire [9:0] normal = normal_of(own_quad, k);
  wire unused = &{1'b0, b_edge[7:6], own_edge[7:6], other};

  // f of an in-plane axis: from the origin to unit vector l
  wire [POINT_W-1:0] unit;
  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_unit
      localparam [2:0] D = d;
      assign unit[COORD_W*d+:COORD_W] = {{COORD_W - 1{1'b0}}, l == D};
    end
  endgenerate

  // ---- points
  reg [POINTS*POINT_W-1:0] points;
  always @* begin
    points = {POINTS * POINT_W{1'b0}};
    if (is_cross) begin
      points[0+:POINT_W] = pick(a, own_edge[5:4]);
      if (VERTS_A == 4) points[(VERTS_A-3)*POINT_W+:POINT_W] = pick(a, own_edge[7:6]);
      points[(VERTS_A-2)*POINT_W+:POINT_W] = pick(b, b_edge[1:0]);
      points[(VERTS_A-1)*POINT_W+:POINT_W] = pick(b, b_edge[5:4]);
      if (VERTS_B == 4) points[(POINTS-1)*POINT_W+:POINT_W] = pick(b, b_edge[7:6]);
    end else begin
      points[0+:POINT_W] = is_in_plane ? other[0+:POINT_W] : pick(own, normal[9:8]);
      if (own_b) points[(POINTS-VERTS_A)*POINT_W+:VERTS_A*POINT_W] = a[0+:VERTS_A*POINT_W];
      else points[(POINTS-VERTS_B)*POINT_W+:VERTS_B*POINT_W] = b[0+:VERTS_B*POINT_W];
    end
  end

  always @(posedge clk) begin
    m_e_from <= pick(own, is_cross || is_in_plane ? own_edge[1:0] : normal[1:0]);
    m_e_to   <= pick(own, is_cross || is_in_plane ? own_edge[3:2] : normal[3:2]);
    m_f_from <= is_in_plane ? {POINT_W{1'b0}} : is_cross ? pick(b, b_edge[1:0]) : pick(own, normal[5:4]);
    m_f_to   <= is_in_plane ? unit : is_cross ? pick(b, b_edge[3:2]) : pick(own, normal[7:6]);
    m_points <= points;
    m_own[0] <= is_cross || (!is_in_plane && own_quad);
    m_own[1] <= is_cross && VERTS_A == 4;
  end

endmodule
`default_nettype wire
