// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_leaf_sequencer: which vertex of a leaf pair is current in cchip_vertex_transform: first the
// origin of A's leaf, then vertex after vertex of one pair of primitives after the other.
//   order        primitive 0 of A with 0, then 1 of B, then 1 of A with 0 and 1 of B; 3 vertices a
//                pair or with a quad 4, where a triangle's last one comes twice
//   begin        a leaf pair begins while room = 1; an illegal one has no vertices: corrupt = 1
//                with s_ready
//   latency      m_factor and m_pass follow the registers of the state, all other m_* and launch
//                come a clock later
//   throughput   a vertex every PASSES clocks; a leaf pair every PASSES (1 + vertices) clocks, a
//                corrupt one every 2 clocks
//   cuts         all but s_* to m_factor
//   reset        no leaf pair
//   rules        Offsets of triangles get the 24 bits that those of quads have.
module cchip_leaf_sequencer #(
    parameter integer PASSES = 1  // clocks a vertex; legal: 1, 2
) (
    input  wire         clk,          // clock, rising edge
    input  wire         rst,          // synchronous reset, active high
    input  wire         s_valid,      // a leaf pair; nothing of it changes until s_ready
    output wire         s_ready,      // it is done
    input  wire [  3:0] s_kinds,      // kinds of the leaves, {B's, A's}
    input  wire         s_illegal,    // an extent is illegal
    input  wire [ 71:0] s_origin_a,   // origin of A's leaf, 3 x 24 bit
    input  wire [359:0] s_points_a,   // vertices of A's leaf, as offsets from its origin
    input  wire [359:0] s_points_b,   // vertices of B's leaf
    input  wire         room,         // there is room for the pairs of primitives of a leaf pair
    output wire         corrupt,      // with s_ready: s_illegal, so there were no vertices
    output wire         launch,       // a pair of primitives begins
    output wire [  1:0] launch_pair,  // which one, {A's, B's}
    // A's origin or the offset of a vertex of A, 3 x 24 bit; what M is to be multiplied with: A's
    // origin or the offset of a vertex of A, 3 x 24 bit
    output wire [ 71:0] m_factor,
    output wire         m_pass,       // of PASSES = 2 the second pass
    output wire [ 71:0] m_offset_b,   // offset of the vertex of B, a clock later
    output wire         m_origin,     // m_factor of the clock before was the origin
    output wire         m_valid,      // it was a vertex
    output wire         m_first,      // the first one of its pair
    output wire         m_last        // the last one of its pair
);

  localparam [1:0] TWO_TRIANGLES = 2'd2;
  localparam [1:0] QUAD = 2'd3;

  wire [1:0] kind_a = s_kinds[1:0];
  wire [1:0] kind_b = s_kinds[3:2];
  wire four = kind_a == QUAD || kind_b == QUAD;
  wire [1:0] last_vertex = four ? 2'd3 : 2'd2;
  wire [1:0] last_pair = {kind_a == TWO_TRIANGLES, kind_b == TWO_TRIANGLES};
  reg started_q, pass_q, ready_q, corrupt_q;
  reg [1:0] vertex_q, pair_q;
  wire begins = ~started_q & s_valid & room & ~ready_q;
  wire works = started_q | pass_q | (begins & ~s_illegal);
  wire last_pass = PASSES == 1 || pass_q;
  wire ends_pair = started_q & vertex_q == last_vertex;
  reg [1:0] vertex_d, pair_d;
  wire pass_d = PASSES == 2 && works && !pass_q;
  wire started_d = (started_q | (works & last_pass)) & ~ready_q;
  always @* begin
    vertex_d = vertex_q;
    pair_d   = pair_q;
    if (!started_q || ready_q) begin
      vertex_d = 2'd0;
      pair_d   = 2'd0;
    end else if (last_pass) begin
      vertex_d = ends_pair ? 2'd0 : vertex_q + 2'd1;
      // {A's, B's}: B's is the faster one
      if (ends_pair) pair_d = {pair_q[1] | (pair_q[0] == last_pair[0]), last_pair[0] & ~pair_q[0]};
    end
  end
  always @(posedge clk) begin
    vertex_q <= vertex_d;
    pair_q <= pair_d;
    started_q <= ~rst & started_d;
    pass_q <= ~rst & pass_d;
    corrupt_q <= begins & s_illegal;
    ready_q   <= ~rst & ((begins & s_illegal) | (started_d & vertex_d == last_vertex &&
        pair_d == last_pair && (PASSES == 1 || pass_d)));
  end
  assign s_ready = ready_q;
  assign corrupt = corrupt_q;

  // ---- the vertex, into registers before the multipliers. Offsets of triangles get 24 bits, as
  // those of quads have
  function [71:0] offset(input [359:0] vertices, input quad, input [2:0] place);
    reg [59:0] triangle;
    reg [71:0] corner;
    begin
      case (place)
        3'd0: triangle = vertices[0+:60];
        3'd1: triangle = vertices[60+:60];
        3'd2: triangle = vertices[120+:60];
        3'd3: triangle = vertices[180+:60];
        3'd4: triangle = vertices[240+:60];
        default: triangle = vertices[300+:60];
      endcase
      case (place[1:0])
        2'd0: corner = vertices[0+:72];
        2'd1: corner = vertices[72+:72];
        2'd2: corner = vertices[144+:72];
        default: corner = vertices[216+:72];
      endcase
      offset = quad ? corner : {triangle[59:40], 4'd0, triangle[39:20], 4'd0, triangle[19:0], 4'd0};
    end
  endfunction
  // Places 0..2 of the first primitive, 3..5 of the second
  function [2:0] place_of(input [1:0] vertex, input quad, input second);
    place_of = {1'b0, !quad && vertex == 2'd3 ? 2'd2 : vertex} + (second ? 3'd3 : 3'd0);
  endfunction
  wire [2:0] place_a = place_of(vertex_q, kind_a == QUAD, pair_q[1]);
  wire [2:0] place_b = place_of(vertex_q, kind_b == QUAD, pair_q[0]);
  assign m_factor = started_q ? offset(s_points_a, kind_a == QUAD, place_a) : s_origin_a;
  reg [71:0] offset_b_q;
  always @(posedge clk) offset_b_q <= offset(s_points_b, kind_b == QUAD, place_b);
  reg origin_q1, launch_q1, valid_q1, first_q1, last_q1;
  reg [1:0] pair_q1;
  always @(posedge clk) begin
    origin_q1 <= ~rst & ~started_q & works & last_pass;
    valid_q1  <= ~rst & started_q & last_pass;
    launch_q1 <= ~rst & started_q & last_pass & vertex_q == 2'd0;
    first_q1  <= vertex_q == 2'd0;
    last_q1   <= ends_pair;
    pair_q1   <= pair_q;
  end
  assign launch = launch_q1;
  assign launch_pair = pair_q1;
  assign m_pass = pass_q;
  assign m_offset_b = offset_b_q;
  assign m_origin = origin_q1;
  assign m_valid = valid_q1;
  assign m_first = first_q1;
  assign m_last = last_q1;

  reg s_valid_q;
  always @(posedge clk) begin
    s_valid_q <= s_valid & ~ready_q & ~rst;
    if (!rst) begin
      `CCHIP_ASSERT(a_held, !s_valid_q || s_valid)
      `CCHIP_ASSERT(a_ready, !ready_q || s_valid)
      `CCHIP_ASSERT(a_started, !started_q || s_valid)
    end
  end

endmodule
`default_nettype wire
