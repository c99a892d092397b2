// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_transform: leaf pairs into pairs of primitives, each on its own grid, vertex by vertex
// as a slot takes them: cchip_vertex_transform and cchip_normaliser.
//   latency      CCHIP_TRANSFORM_LATENCY(PASSES) clocks from s_valid to the first vertex
//   throughput   a leaf pair every PASSES (1 + vertices) clocks; 3 vertices a pair of
//                primitives, with a quad 4
//   kinds        m_kind is the ModuleId of the test; a triangle goes first: a quad of A and a
//                triangle of B change places
//   s_valid      until s_ready, nothing of s_* changes
//   credit       m_valid has no ready: at most CREDIT pairs of primitives begin for which s_credit
//                has not come
//   cuts         every path: each output is a flip-flop, but those of m_a, m_b and m_kind, which
//                are one multiplexer behind theirs
//   reset        pairs inside are dropped; the credit is whole
//   timing       CCHIP_TRANSFORM_LATENCY(PASSES) clocks from the first clock of a leaf pair to its
//                first vertex, 33 or 37; then PASSES clocks a vertex without a gap. 4 for two
//                triangles, 13 for four pairs of triangles, 5 with quads. It begins while at least
//                four of the CREDIT are free. m_err, m_kind, m_face_* and m_id are those of the
//                pair on each of its vertices.
//   numbers      See cchip_vertex_transform, cchip_normaliser and docs/hardware/image.md.
//   inside       The two modules, a counter of credit, and a delay line for what is known of a
//                pair.
//   why          The way from leaves to a slot has a fixed length and no ready runs back along it:
//                a leaf pair begins only when there is room for all that it can become.
module cchip_transform #(
    parameter integer COORD_W = 16,  // width of a coordinate on the grid (bit); legal: 4..20
    // a vertex; 1 takes 36 multiplier blocks of 18x18 bit, 2 takes 18 (clock); legal: 1, 2
    parameter integer PASSES = 1,
    // pairs of primitives that the receiver has room for; legal: 4..4096
    parameter integer CREDIT = 32,
    parameter integer ID_W = 6       // width of s_id and m_id (bit); legal: 1 or more
) (
    input  wire                               clk,       // clock, rising edge
    input  wire                               rst,       // synchronous reset, active high
    // ---- a leaf pair and the map of its query
    // a leaf pair; nothing of s_* changes until s_ready
    input  wire                               s_valid,
    output wire                               s_ready,   // it is taken
    input  wire [                      287:0] s_m,  // M of its query, 30 fraction bits, row by row
    input  wire [                      107:0] s_t,       // t, 32 fraction bits
    input  wire [                        3:0] s_shift,   // the map is M 2^-shift
    input  wire [                       11:0] s_error,   // bound on the error of a position, 2^-38
    input  wire [                        3:0] s_kinds,   // kinds of the leaves, {B's, A's}
    // the leaves, {B's, A's} (image.md, docs/hardware/image.md)
    input  wire [                     1023:0] s_lines,
    input  wire [                   ID_W-1:0] s_id,      // comes back with every pair of primitives
    // with s_ready: an extent is over 24, no pairs of primitives follow
    output wire                               corrupt,
    // ---- vertices; what is on the right from m_kind on is that of the whole pair
    output wire                               m_valid,   // a vertex of each primitive
    output wire                               m_first,   // the first of its pair
    output wire                               m_last,    // its last, the third or the fourth
    output wire [`CCHIP_POINT_W(COORD_W)-1:0] m_a,  // vertex of the first primitive, grid steps
    output wire [`CCHIP_POINT_W(COORD_W)-1:0] m_b,       // vertex of the second
    output wire [           `CCHIP_ERR_W-1:0] m_err,     // eta of the pair
    output wire [          `CCHIP_KIND_W-1:0] m_kind,    // ModuleId of its test
    // number of the face of A, for any places of the primitives
    output wire [                       31:0] m_face_a,
    output wire [                       31:0] m_face_b,  // number of the face of B
    output wire [                   ID_W-1:0] m_id,      // s_id of its leaves
    // which of its leaf pair: 2 (second of A) + (second of B)
    output wire [                        1:0] m_pair,
    input  wire                               s_credit   // the receiver has room for one pair more
);

  localparam [1:0] QUAD = 2'd3;
  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);
  localparam integer COUNT_W = $clog2(CREDIT + 1);
  localparam [31:0] ROOM = CREDIT - 4;
  localparam [31:0] ONE = 1;

  `CCHIP_REFUSE(CREDIT < 4 || CREDIT > 4096, cchip_error_transform_CREDIT_must_be_4_to_4096)
  `CCHIP_REFUSE(ID_W < 1, cchip_error_transform_ID_W_below_1)

  // ---- credit: a leaf pair is up to four pairs of primitives
  reg [COUNT_W-1:0] used_q;
  reg room_q;
  wire launch;
  always @(posedge clk) begin
    if (rst) used_q <= {COUNT_W{1'b0}};
    else if (launch != s_credit)
      used_q <= launch ? used_q + ONE[COUNT_W-1:0] : used_q - ONE[COUNT_W-1:0];
    room_q <= ~rst & used_q <= ROOM[COUNT_W-1:0];
  end

  // ---- vertices
  wire [1:0] launch_pair;
  wire valid, first, last, open;
  wire [134:0] vertex_a;
  wire [ 74:0] vertex_b;
  wire [  2:0] lost;
  wire [ 15:0] error_a;
  wire [  5:0] error_b;
  cchip_vertex_transform #(
      .PASSES(PASSES)
  ) u_vertices (
      .clk        (clk),
      .rst        (rst),
      .s_valid    (s_valid),
      .s_ready    (s_ready),
      .s_m        (s_m),
      .s_t        (s_t),
      .s_shift    (s_shift),
      .s_error    (s_error),
      .s_kinds    (s_kinds),
      .s_lines    (s_lines),
      .room       (room_q),
      .corrupt    (corrupt),
      .launch     (launch),
      .launch_pair(launch_pair),
      .m_valid    (valid),
      .m_first    (first),
      .m_last     (last),
      .m_a        (vertex_a),
      .m_b        (vertex_b),
      .m_lost     (lost),
      .m_error_a  (error_a),
      .m_error_b  (error_b),
      .m_open     (open)
  );
  wire [POINT_W-1:0] a, b;
  cchip_normaliser #(
      .COORD_W(COORD_W),
      .PASSES (PASSES)
  ) u_normaliser (
      .clk      (clk),
      .rst      (rst),
      .s_valid  (valid),
      .s_first  (first),
      .s_last   (last),
      .s_a      (vertex_a),
      .s_b      (vertex_b),
      .s_lost   (lost),
      .s_error_a(error_a),
      .s_error_b(error_b),
      .s_open   (open),
      .m_valid  (m_valid),
      .m_first  (m_first),
      .m_last   (m_last),
      .m_a      (a),
      .m_b      (b),
      .m_err    (m_err)
  );

  // ---- what is known of a pair, from its launch to its last vertex
  wire quad_a = s_kinds[1:0] == QUAD;
  wire quad_b = s_kinds[3:2] == QUAD;
  wire [511:0] line_a = s_lines[511:0];
  wire [511:0] line_b = s_lines[1023:512];
  wire [31:0] face_a = launch_pair[1] ? line_a[`CCHIP_LEAF_LINE_ID1] :
      line_a[`CCHIP_LEAF_LINE_ID0];
  wire [31:0] face_b = launch_pair[0] ? line_b[`CCHIP_LEAF_LINE_ID1] :
      line_b[`CCHIP_LEAF_LINE_ID0];
  wire unused = &{1'b0, line_a, line_b};
  wire quad_a_now, quad_b_now;
  wire [31:0] face_a_now, face_b_now;
  wire [ ID_W-1:0] id_now;
  reg  [ID_W+67:0] known_q;
  wire [1:0] pair_now;
  cchip_delay #(
      .WIDTH (ID_W + 68),
      .DEPTH (`CCHIP_VERTEX_LAUNCH(PASSES) + `CCHIP_NORMALISER_LATENCY(PASSES) - 1),
      .MEMORY(1)
  ) u_known (
      .clk(clk),
      .rst(1'b0),
      .d  ({launch_pair, s_id, face_b, face_a, quad_b, quad_a}),
      .q  ({pair_now, id_now, face_b_now, face_a_now, quad_b_now, quad_a_now})
  );
  wire begins;  // the first vertex is there on the next clock
  cchip_delay #(
      .WIDTH(1),
      .DEPTH(`CCHIP_VERTEX_LAUNCH(PASSES) + `CCHIP_NORMALISER_LATENCY(PASSES) - 1),
      .RESET(1)
  ) u_begins (
      .clk(clk),
      .rst(rst),
      .d  (launch),
      .q  (begins)
  );
  always @(posedge clk)
    if (begins)
      known_q <= {pair_now, id_now, face_b_now, face_a_now, quad_b_now, quad_a_now};
  wire m_quad_a, m_quad_b;
  assign {m_pair, m_id, m_face_b, m_face_a, m_quad_b, m_quad_a} = known_q;
  assign m_kind = 3'd1 + {2'd0, m_quad_a} + {2'd0, m_quad_b};
  wire exchange = m_quad_a & ~m_quad_b;
  assign m_a = exchange ? b : a;
  assign m_b = exchange ? a : b;

  reg begins_q;
  always @(posedge clk) begin
    begins_q <= begins & ~rst;
    if (!rst) begin
      `CCHIP_ASSERT(a_credit, !s_credit || used_q != {COUNT_W{1'b0}})
      `CCHIP_ASSERT(a_first, begins_q == (m_valid & m_first))
    end
  end

endmodule
`default_nettype wire
