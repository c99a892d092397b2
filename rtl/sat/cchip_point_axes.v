// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_point_axes: which of seven axes separate the sphere of a point from a triangle, exactly.
//   latency      CCHIP_POINT_AXES_LATENCY(COORD_W) clocks, handshake of s_pair to m_verdict_valid
//   throughput   one pair per 7 clocks, never stalls; m_verdict in the order of s_pair
//   cuts         no output depends on an input of the same clock
//   reset        s_pair_ready = 0 while rst is 1; pairs inside are dropped; data is not reset
// d_i are the vertices as seen from the point, G_ij = d_i . d_j their Gram matrix, C_ij its
// cofactors, r the radius. With the crosses c_k = d_i x d_j that leave out vertex k, C_ij = c_i .
// c_j; the normal of the face is n = c_0 + c_1 + c_2, and det G = (n . d_0)^2. So
//   0      face                  det G > r^2 |n|^2,  |n|^2 = sum of all C_ij
//   1..3   edge from i to j      C_kk > r^2 |e|^2 and c_k . n <= 0 (vertex k is not nearer),
//                                |e|^2 = G_ii - 2 G_ij + G_jj,  c_k . n = sum of row k of C
//   4..6   vertex i              G_ii > r^2 and G_ij >= G_ii, G_ik >= G_ii
// Edge 1 is from vertex 0 to 1, 2 from 1 to 2, 3 from 2 to 0.
// Stages, 7 clocks each, one slot a clock: six entries of G and r^2 from one dot product; six
// cofactors from two products of entries; seven products of an entry and a cofactor. A chain of
// registers collects the values of a stage, and a bank holds them for the next.
module cchip_point_axes #(
    // width of a signed coordinate, and of the unsigned radius (bit); legal: 4..20
    parameter integer COORD_W = 16,
    parameter integer USER_W = 18    // width of what travels along with a pair (bit); legal: >= 1
) (
    input  wire                 clk,                  // clock, rising edge
    input  wire                 rst,                  // synchronous reset, active high
    input  wire                 s_pair_valid,         // a pair is offered
    output wire                 s_pair_ready,  // the pair is accepted if s_pair_valid = 1 as well
    input  wire [3*COORD_W-1:0] s_pair_point,         // centre of the sphere, x lowest
    input  wire [9*COORD_W-1:0] s_pair_triangle,      // vertex i in bits [3*COORD_W*i +: 3*COORD_W]
    input  wire [  COORD_W-1:0] s_pair_radius,        // radius, unsigned
    input  wire [   USER_W-1:0] s_pair_user,          // returned with the verdict
    output wire                 m_verdict_valid,  // a verdict, for one clock; it cannot be stopped
    // bit 0: the face's normal separates, 1..3: edge 0, 1, 2, 4..6: vertex 0, 1, 2
    output wire [          6:0] m_verdict_separated,
    output wire [   USER_W-1:0] m_verdict_user        // of the pair
);

  localparam integer D_W = `CCHIP_EDGE_W(COORD_W);
  localparam integer G_W = `CCHIP_GRAM_W(COORD_W);
  localparam integer C_W = `CCHIP_COFACTOR_W(COORD_W);
  localparam integer F_W = `CCHIP_FACE_W(COORD_W);
  // clocks from the handshake of s_pair: bank of G, first cofactor, first product are there
  localparam integer MUL = `CCHIP_COFACTOR_LATENCY(COORD_W);
  localparam integer AT_G = 11 + `CCHIP_GRAM_LATENCY(COORD_W);
  localparam integer AT_C = AT_G + 2 + MUL;
  localparam integer AT_P = AT_C + 2 + MUL;
  localparam integer AT_END = `CCHIP_POINT_AXES_LATENCY(COORD_W);  // AT_P + 7

  // ---- step_q[n]: a pair was accepted n + 1 clocks ago
  reg [AT_END-1:0] step_q;
  reg awake_q;
  assign s_pair_ready = awake_q && step_q[5:0] == 6'd0;
  wire start = s_pair_valid && s_pair_ready;
  always @(posedge clk)
    if (rst) begin
      awake_q <= 1'b0;
      step_q  <= {AT_END{1'b0}};
    end else begin
      awake_q <= 1'b1;
      step_q  <= {step_q[AT_END-2:0], start};
    end

  // ---- stage select: differences, held for 7 clocks; then the two vectors of each slot
  reg [3*D_W-1:0] d0_q, d1_q, d2_q;
  reg [COORD_W-1:0] radius_q;
  reg [USER_W-1:0] user_q;

  function [3*D_W-1:0] from_point(input [3*COORD_W-1:0] corner, input [3*COORD_W-1:0] point);
    integer i;
    reg [COORD_W-1:0] to, from;
    begin
      from_point = {3 * D_W{1'b0}};
      for (i = 0; i < 3; i = i + 1) begin
        to = corner[COORD_W*i+:COORD_W];
        from = point[COORD_W*i+:COORD_W];
        from_point[D_W*i+:D_W] = {to[COORD_W-1], to} - {from[COORD_W-1], from};
      end
    end
  endfunction

  always @(posedge clk)
    if (start) begin
      d0_q <= from_point(s_pair_triangle[0+:3*COORD_W], s_pair_point);
      d1_q <= from_point(s_pair_triangle[3*COORD_W+:3*COORD_W], s_pair_point);
      d2_q <= from_point(s_pair_triangle[6*COORD_W+:3*COORD_W], s_pair_point);
      radius_q <= s_pair_radius;
      user_q   <= s_pair_user;
    end

  // slots: r^2, G00, G01, G02, G11, G12, G22
  wire [3*D_W-1:0] radius_vector = {{2 * D_W{1'b0}}, 1'b0, radius_q};
  reg [3*D_W-1:0] left_q, right_q;
  always @(posedge clk) begin
    left_q  <= step_q[0] ? radius_vector : step_q[1] || step_q[2] || step_q[3] ? d0_q
        : step_q[6] ? d2_q : d1_q;
    right_q <= step_q[0] ? radius_vector : step_q[1] ? d0_q : step_q[2] || step_q[4] ? d1_q : d2_q;
  end

  // ---- stage project, part 1: G. A sum of three products has one bit more than a product.
  wire [G_W-1:0] dot;
  cchip_dot3 #(.A_W(D_W + 1), .B_W(D_W)) u_dot (
      .clk(clk),
      .a  ({left_q[3*D_W-1], left_q[2*D_W+:D_W], left_q[2*D_W-1], left_q[D_W+:D_W],
            left_q[D_W-1], left_q[0+:D_W]}),
      .b  (right_q),
      .q  (dot)
  );

  reg [6*G_W-1:0] dots_q;
  reg [G_W-1:0] rr_q, g00_q, g01_q, g02_q, g11_q, g12_q, g22_q;
  reg [USER_W-1:0] g_user_q;
  wire [USER_W-1:0] user_at_g;
  cchip_delay #(.WIDTH(USER_W), .DEPTH(AT_G - 8), .MEMORY(1)) u_user (
      .clk(clk),
      .rst(1'b0),
      .d  (user_q),
      .q  (user_at_g)
  );
  always @(posedge clk) begin
    dots_q <= {dots_q[5*G_W-1:0], dot};
    if (step_q[AT_G-2]) begin
      {rr_q, g00_q, g01_q, g02_q, g11_q, g12_q, g22_q} <= {dots_q, dot};
      g_user_q <= user_at_g;
    end
  end

  // ---- squares of the edges, and what decides the vertices
  reg [G_W-1:0] sum01_q, sum12_q, sum20_q, e01_q, e12_q, e20_q;
  reg [2:0] beyond_q;  // G_ii > r^2
  reg [5:0] farther_q;  // G_ij >= G_ii
  reg [2:0] vertex_q;

  function not_less(input [G_W-1:0] x, input [G_W-1:0] y);
    reg [G_W-1:0] difference;
    begin
      difference = x - y;
      not_less = ~difference[G_W-1];
    end
  endfunction

  always @(posedge clk) begin
    sum01_q <= g00_q + g11_q;
    sum12_q <= g11_q + g22_q;
    sum20_q <= g22_q + g00_q;
    e01_q <= sum01_q - {g01_q[G_W-2:0], 1'b0};
    e12_q <= sum12_q - {g12_q[G_W-2:0], 1'b0};
    e20_q <= sum20_q - {g02_q[G_W-2:0], 1'b0};
    beyond_q <= {~not_less(rr_q, g22_q), ~not_less(rr_q, g11_q), ~not_less(rr_q, g00_q)};
    farther_q <= {not_less(g12_q, g22_q), not_less(g02_q, g22_q), not_less(g12_q, g11_q),
        not_less(g01_q, g11_q), not_less(g02_q, g00_q), not_less(g01_q, g00_q)};
    vertex_q <= beyond_q & {&farther_q[5:4], &farther_q[3:2], &farther_q[1:0]};
  end

  // ---- stage project, part 2: cofactors, in the order C12, C11, C22, C00, C01, C02
  reg [G_W-1:0] p_q, q_q, s_q, t_q;
  wire [5:0] c_slot = step_q[AT_G-1+:6];
  always @(posedge clk) begin
    p_q <= c_slot[1] ? g22_q : c_slot[2] ? g00_q : c_slot[3] ? g11_q : c_slot[4] ? g12_q : g01_q;
    q_q <= c_slot[1] ? g00_q : c_slot[2] ? g11_q : c_slot[3] ? g22_q : c_slot[5] ? g12_q : g02_q;
    s_q <= c_slot[0] || c_slot[3] ? g12_q : c_slot[2] || c_slot[4] ? g01_q : g02_q;
    t_q <= c_slot[0] ? g00_q : c_slot[1] ? g02_q : c_slot[2] ? g01_q : c_slot[3] ? g12_q
        : c_slot[4] ? g22_q : g11_q;
  end
  wire [2*G_W-1:0] pq, st;
  cchip_mul_wide #(.A_W(G_W), .B_W(G_W)) u_pq (.clk(clk), .a(p_q), .b(q_q), .p(pq));
  cchip_mul_wide #(.A_W(G_W), .B_W(G_W)) u_st (.clk(clk), .a(s_q), .b(t_q), .p(st));
  reg [C_W-1:0] c_q;
  always @(posedge clk) c_q <= pq[C_W-1:0] - st[C_W-1:0];
  wire unused_top = &{1'b0, pq[2*G_W-1:C_W], st[2*G_W-1:C_W]};

  // ---- sums of the rows, less 1, so that the sign says whether a sum is at most 0; and of all
  wire [5:0] p_slot = step_q[AT_C-1+:6];
  wire last_slot = step_q[AT_C+5];
  reg [C_W-1:0] row0_q, row1_q, row2_q, normal_q;
  wire [C_W-1:0] none = {C_W{1'b0}};
  wire [C_W-1:0] least = {C_W{1'b1}};
  always @(posedge clk) begin
    row0_q <= (p_slot[0] ? least : row0_q) + (|p_slot[5:3] ? c_q : none);
    row1_q <= (p_slot[0] ? least : row1_q) + (p_slot[0] || p_slot[1] || p_slot[4] ? c_q : none);
    row2_q <= (p_slot[0] ? least : row2_q) + (p_slot[0] || p_slot[2] || p_slot[5] ? c_q : none);
    normal_q <= (p_slot[0] ? none : normal_q) + (|p_slot[3:1] ? c_q
        : p_slot[0] || p_slot[4] || p_slot[5] ? {c_q[C_W-2:0], 1'b0} : none);
  end

  // ---- what the products need of the first bank, held for 7 clocks more. A multiplier that takes
  // more than 5 clocks needs it after the first bank has changed.
  localparam integer HELD_W = USER_W + 3 + 7 * G_W;
  wire [HELD_W-1:0] held;
  reg [G_W-1:0] h_rr_q, h_e01_q, h_e12_q, h_e20_q, h_g00_q, h_g01_q, h_g02_q;
  reg [2:0] h_vertex_q;
  reg [USER_W-1:0] h_user_q;
  cchip_delay #(.WIDTH(HELD_W), .DEPTH(MUL > 5 ? MUL - 5 : 0)) u_held (
      .clk(clk),
      .rst(1'b0),
      .d  ({g_user_q, vertex_q, rr_q, e01_q, e12_q, e20_q, g00_q, g01_q, g02_q}),
      .q  (held)
  );
  always @(posedge clk)
    if (step_q[AT_C-2])
      {h_user_q, h_vertex_q, h_rr_q, h_e01_q, h_e12_q, h_e20_q, h_g00_q, h_g01_q, h_g02_q} <= held;

  // ---- stage compare, part 1: products r^2 E20, r^2 E01, r^2 E12, G00 C00, G01 C01, G02 C02,
  // r^2 |n|^2
  localparam integer LOW_W = G_W - 1;
  reg [G_W-1:0] x_q;
  reg [C_W-1:0] y_q;
  wire [G_W-1:0] edge_square = p_slot[0] ? h_e20_q : p_slot[1] ? h_e01_q : h_e12_q;
  always @(posedge clk) begin
    x_q <= p_slot[3] ? h_g00_q : p_slot[4] ? h_g01_q : p_slot[5] ? h_g02_q : h_rr_q;
    y_q <= |p_slot[5:3] ? c_q : last_slot ? normal_q
        : {{C_W - G_W{edge_square[G_W-1]}}, edge_square};
  end
  wire [2*G_W-1:0] low, high;
  cchip_mul_wide #(.A_W(G_W), .B_W(G_W)) u_low (
      .clk(clk),
      .a  (x_q),
      .b  ({1'b0, y_q[LOW_W-1:0]}),
      .p  (low)
  );
  cchip_mul_wide #(.A_W(G_W), .B_W(G_W)) u_high (
      .clk(clk),
      .a  (x_q),
      .b  (y_q[C_W-1:LOW_W]),
      .p  (high)
  );
  reg [F_W-1:0] product_q;
  always @(posedge clk)
    product_q <= {{F_W - 2 * G_W{low[2*G_W-1]}}, low} + {high[F_W-LOW_W-1:0], {LOW_W{1'b0}}};
  wire unused_high = &{1'b0, high[2*G_W-1:F_W-LOW_W]};

  // ---- part 2: x > y is x - y - 1 >= 0, and - y - 1 is the complement of y
  wire [C_W-1:0] cofactor;
  cchip_delay #(.WIDTH(C_W), .DEPTH(MUL + 1), .MEMORY(1)) u_cofactor (
      .clk(clk),
      .rst(1'b0),
      .d  (c_q),
      .q  (cofactor)
  );
  wire [C_W-1:0] edge_gap = cofactor + ~product_q[C_W-1:0];
  reg edge20_q, edge01_q, edge12_q;
  reg [F_W-1:0] face_q;
  wire [6:0] f_slot = step_q[AT_P-1+:7];
  wire unused_slot = &{1'b0, f_slot[5:4]};
  wire unused_gap = &{1'b0, edge_gap[C_W-2:0]};
  always @(posedge clk) begin
    if (f_slot[0]) edge20_q <= ~edge_gap[C_W-1];
    if (f_slot[1]) edge01_q <= ~edge_gap[C_W-1];
    if (f_slot[2]) edge12_q <= ~edge_gap[C_W-1];
    face_q <= (f_slot[3] ? {F_W{1'b0}} : face_q) + (product_q ^ {F_W{f_slot[6]}});
  end

  // ---- the rest waits for the face
  wire [2:0] vertex, side;
  cchip_delay #(.WIDTH(USER_W + 6), .DEPTH(MUL + 3), .MEMORY(1)) u_rest (
      .clk(clk),
      .rst(1'b0),
      .d  ({h_user_q, h_vertex_q, row2_q[C_W-1], row1_q[C_W-1], row0_q[C_W-1]}),
      .q  ({m_verdict_user, vertex, side})
  );
  assign m_verdict_valid = step_q[AT_END-1];
  assign m_verdict_separated = {vertex, edge20_q & side[1], edge12_q & side[0], edge01_q & side[2],
      ~face_q[F_W-1]};

endmodule
`default_nettype wire
