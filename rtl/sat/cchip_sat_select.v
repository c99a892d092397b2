// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_sat_select: macro stage 1 of the SAT pipeline (paper, figure 7). Chooses the two edges e, f
// whose cross product is the axis (or a constant unit vector for f), and the points to project.
//   latency      CCHIP_SELECT_LATENCY clocks from s_code, 1 from s_a and s_b, which come
//                CCHIP_RAM_LATENCY = 3 clocks after it
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
// Sides are edges k = 0..3 from vertex k to k + 1, edge 4 is V0V2, edge 5 V1V3. The points of the
// other primitive fill the last slots; a slot left over (slot 0) repeats one of them. The start of
// e is the reference of the projection: vertices that are not among the points project onto the
// same value as it or as a point. Any other class selects like NORMAL_A; its verdict has no
// meaning.
module cchip_sat_select #(
    parameter integer COORD_W = 16,  // width of a coordinate (bit); legal: 4..20
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3    // vertices of B (vertex); legal: VERTS_A..4
) (
    input  wire                                     clk,       // clock, rising edge
    // axis code {class[2:0], k[2:0], l[2:0]}
    input  wire [           `CCHIP_AXIS_CODE_W-1:0] s_code,
    // A, CCHIP_RAM_LATENCY clocks after s_code; vertex 0 in the low bits; of a vertex x lowest
    input  wire [            3*VERTS_A*COORD_W-1:0] s_a,
    input  wire [            3*VERTS_B*COORD_W-1:0] s_b,       // B likewise
    // start of e, and reference of the projections
    output wire [                    3*COORD_W-1:0] m_e_from,
    output wire [                    3*COORD_W-1:0] m_e_to,    // end of e
    output wire [                    3*COORD_W-1:0] m_f_from,  // start of f
    output wire [                    3*COORD_W-1:0] m_f_to,    // end of f
    // points to project, p0 in the low bits
    output wire [3*(VERTS_A+VERTS_B-3)*COORD_W-1:0] m_points,
    // bit i: slot i holds a point of the own set of the axis
    output wire [                              1:0] m_own
);

  reg [3*COORD_W-1:0] m_e_from_q;
  reg [3*COORD_W-1:0] m_e_to_q;
  reg [3*COORD_W-1:0] m_f_from_q;
  reg [3*COORD_W-1:0] m_f_to_q;
  reg [3*(VERTS_A+VERTS_B-3)*COORD_W-1:0] m_points_q;
  reg [1:0] m_own_q;
  assign m_e_from = m_e_from_q;
  assign m_e_to = m_e_to_q;
  assign m_f_from = m_f_from_q;
  assign m_f_to = m_f_to_q;
  assign m_points = m_points_q;
  assign m_own = m_own_q;

  localparam integer POINT_W = 3 * COORD_W;
  localparam integer POINTS = `CCHIP_POINTS(VERTS_A, VERTS_B);

  `CCHIP_REFUSE(VERTS_A < 3 || VERTS_A > VERTS_B || VERTS_B > 4,
                cchip_error_VERTS_must_be_3_3_or_3_4_or_4_4)

  // ---- clock 1: what the code says
  wire [`CCHIP_CLASS_W-1:0] axis_class = s_code[`CCHIP_AXIS_CODE_CLASS];
  reg is_cross_q, is_in_plane_q, own_b_q;
  reg [`CCHIP_INDEX_W-1:0] k_q, l_q;
  always @(posedge clk) begin
    is_cross_q    <= axis_class == `CCHIP_AXIS_CROSS;
    is_in_plane_q <= axis_class == `CCHIP_AXIS_IN_PLANE_A || axis_class == `CCHIP_AXIS_IN_PLANE_B;
    own_b_q       <= axis_class == `CCHIP_AXIS_NORMAL_B || axis_class == `CCHIP_AXIS_IN_PLANE_B;
    k_q           <= s_code[`CCHIP_AXIS_CODE_K];
    l_q           <= s_code[`CCHIP_AXIS_CODE_L];
  end

  // i + offset among the vertices of a triangle or quad
  function [1:0] around(input quad, input [1:0] i, input [1:0] offset);
    reg [2:0] sum;
    begin
      sum = {1'b0, i} + {1'b0, offset};
      around = !quad && sum >= 3'd3 ? sum[1:0] - 2'd3 : sum[1:0];
    end
  endfunction

  // {other 1, other 0, to, from}: the ends of an edge and the vertices that are not on it
  function [7:0] edge_of(input quad, input [2:0] index);
    if (quad && index == 3'd4) edge_of = {2'd3, 2'd1, 2'd2, 2'd0};
    else if (quad && index == 3'd5) edge_of = {2'd2, 2'd0, 2'd3, 2'd1};
    else edge_of = {around(quad, index[1:0], 2'd3), around(quad, index[1:0], 2'd2),
                    around(quad, index[1:0], 2'd1), index[1:0]};
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

  // ---- clock 2: which vertex, {of B, index}, goes to each end of e and f and to each point slot
  wire own_quad = own_b_q ? VERTS_B == 4 : VERTS_A == 4;
  wire [7:0] own_edge = edge_of(own_quad, k_q);
  wire [7:0] b_edge = edge_of(VERTS_B == 4, l_q);
  wire [9:0] normal = normal_of(own_quad, k_q);
  wire is_edge = is_cross_q || is_in_plane_q;

  reg [2:0] e_from_q2, e_to_q2, f_from_q2, f_to_q2;
  reg [2:0] unit_q2;
  reg [1:0] own_q2;
  always @(posedge clk) begin
    e_from_q2 <= {own_b_q, is_edge ? own_edge[1:0] : normal[1:0]};
    e_to_q2   <= {own_b_q, is_edge ? own_edge[3:2] : normal[3:2]};
    f_from_q2 <= is_cross_q ? {1'b1, b_edge[1:0]} : {own_b_q, normal[5:4]};
    f_to_q2   <= is_cross_q ? {1'b1, b_edge[3:2]} : {own_b_q, normal[7:6]};
    unit_q2   <= {is_in_plane_q && l_q == 3'd2, is_in_plane_q && l_q == 3'd1, is_in_plane_q
        && l_q == 3'd0};
    own_q2    <= {is_cross_q && VERTS_A == 4, is_cross_q || (!is_in_plane_q && own_quad)};
  end

  wire [8:0] of_b_edge = {1'b1, b_edge[7:6], 1'b1, b_edge[5:4], 1'b1, b_edge[1:0]};
  wire [14:0] cross_points;
  generate
    if (VERTS_A == 4) begin : gen_cross_quad
      assign cross_points = {of_b_edge, 1'b0, own_edge[7:6], 1'b0, own_edge[5:4]};
    end else begin : gen_cross_triangle
      assign cross_points = {3'd0, of_b_edge, 1'b0, own_edge[5:4]};
    end
  endgenerate

  reg [3*POINTS-1:0] point_q2;
  genvar p;
  generate
    for (p = 0; p < POINTS; p = p + 1) begin : gen_choice
      localparam [31:0] IN_A = p - (POINTS - VERTS_A);
      localparam [31:0] IN_B = p - (POINTS - VERTS_B);
      wire [2:0] of_own = is_in_plane_q ? {~own_b_q, 2'd0} : {own_b_q, normal[9:8]};
      wire [2:0] of_a = p < POINTS - VERTS_A ? of_own : {1'b0, IN_A[1:0]};
      wire [2:0] of_b = p < POINTS - VERTS_B ? of_own : {1'b1, IN_B[1:0]};
      always @(posedge clk) point_q2[3*p+:3] <= is_cross_q ? cross_points[3*p+:3] : own_b_q ? of_a
          : of_b;
    end
  endgenerate

  wire unused = &{1'b0, b_edge[7:6], own_edge[7:6], cross_points};

  // ---- clock 3: one bit for each vertex of A, then of B. f of an in-plane axis: from the origin
  // to unit vector l.
  reg [7:0] e_from_q3, e_to_q3, f_from_q3, f_to_q3;
  reg [8*POINTS-1:0] point_q3;
  reg [2:0] unit_q3;
  reg [1:0] own_q3;
  always @(posedge clk) begin
    e_from_q3 <= 8'd1 << e_from_q2;
    e_to_q3   <= 8'd1 << e_to_q2;
    f_from_q3 <= |unit_q2 ? 8'd0 : 8'd1 << f_from_q2;
    f_to_q3   <= |unit_q2 ? 8'd0 : 8'd1 << f_to_q2;
    unit_q3   <= unit_q2;
    own_q3    <= own_q2;
  end
  generate
    for (p = 0; p < POINTS; p = p + 1) begin : gen_one_hot
      always @(posedge clk) point_q3[8*p+:8] <= 8'd1 << point_q2[3*p+:3];
    end
  endgenerate

  // ---- clock 4: the vertices. A mask removes the vertices that an end or a slot never takes.
  wire [8*POINT_W-1:0] vertices;
  generate
    if (VERTS_A == 4) begin : gen_a_quad
      assign vertices[0+:4*POINT_W] = s_a;
    end else begin : gen_a_triangle
      assign vertices[0+:4*POINT_W] = {{POINT_W{1'b0}}, s_a};
    end
    if (VERTS_B == 4) begin : gen_b_quad
      assign vertices[4*POINT_W+:4*POINT_W] = s_b;
    end else begin : gen_b_triangle
      assign vertices[4*POINT_W+:4*POINT_W] = {{POINT_W{1'b0}}, s_b};
    end
  endgenerate

  function [POINT_W-1:0] pick(input [8*POINT_W-1:0] from, input [7:0] choice);
    integer j;
    begin
      pick = {POINT_W{1'b0}};
      for (j = 0; j < 8; j = j + 1) pick = pick | (from[POINT_W*j+:POINT_W] & {POINT_W{choice[j]}});
    end
  endfunction

  localparam [3:0] ALL_A = VERTS_A == 4 ? 4'hf : 4'h7;
  localparam [3:0] ALL_B = VERTS_B == 4 ? 4'hf : 4'h7;
  localparam [7:0] ALL = {ALL_B, ALL_A};
  // f on a normal of a triangle A: from vertex 0 to vertex 2
  localparam [7:0] F_FROM = {ALL_B, VERTS_A == 4 ? 4'hf : 4'h1};
  localparam [7:0] F_TO = {ALL_B, VERTS_A == 4 ? 4'hf : 4'h4};

  generate
    for (p = 0; p < POINTS; p = p + 1) begin : gen_point
      localparam integer IN_A = p < POINTS - VERTS_A ? 0 : p - (POINTS - VERTS_A);
      localparam integer IN_B = p < POINTS - VERTS_B ? 0 : p - (POINTS - VERTS_B);
      localparam [3:0] OF_A = p < VERTS_A - 2 ? ALL_A : 4'd1 << IN_A;
      localparam [3:0] OF_B = p >= VERTS_A - 2 || (p == 0 && VERTS_B == 4) ? ALL_B : 4'd1 << IN_B;
      localparam [7:0] MASK = {OF_B, OF_A};
      always @(posedge clk) m_points_q[POINT_W*p+:POINT_W] <= pick(vertices, point_q3[8*p+:8]
          & MASK);
    end
  endgenerate

  wire [POINT_W-1:0] unit;
  genvar d;
  generate
    for (d = 0; d < 3; d = d + 1) begin : gen_unit
      assign unit[COORD_W*d+:COORD_W] = {{COORD_W - 1{1'b0}}, unit_q3[d]};
    end
  endgenerate

  always @(posedge clk) begin
    m_e_from_q <= pick(vertices, e_from_q3 & ALL);
    m_e_to_q   <= pick(vertices, e_to_q3 & ALL);
    m_f_from_q <= pick(vertices, f_from_q3 & F_FROM);
    m_f_to_q   <= pick(vertices, f_to_q3 & F_TO) | unit;
    m_own_q    <= own_q3;
  end

endmodule
`default_nettype wire
