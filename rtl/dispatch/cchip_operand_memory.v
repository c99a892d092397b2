// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_operand_memory: the vertices of the pairs that wait, in block RAM, four words a pair, at
// the place of the pair's descriptor (cchip_descriptor_queues). A word is one vertex of A and one
// of B.
//   write        all vertices of the pair on s_pair on the clock on which it is accepted, at the
//                earliest 1 clock after it is offered: a pair every 2 clocks, and one for each pair
//                that is read meanwhile
//   triangles    A of a tri-quad pair is written with its third vertex twice, so that a test of
//                quads takes it as a quad; of a kind with triangles or points alone the fourth
//                vertex is not read
//   read         m_a, m_b: vertex m_vertex of the pair at m_place, 2 clocks later
//   collision    the pair at m_place has left its queue when its vertex 0 is read, and its place
//                may be the next one. A new pair is accepted only behind a clock with m_vertex = 0,
//                so it never comes before the last vertex of the old one is read
//   reset        no pair is accepted; what was written stays
module cchip_operand_memory #(
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    parameter integer PLACE_W = 9    // width of a place: 1 << PLACE_W pairs (bit); legal: 3..12
) (
    input  wire                                   clk,           // clock, rising edge
    input  wire                                   rst,           // synchronous reset, active high
    input  wire                                   s_pair_valid,  // a pair is offered
    // 1 on the clock on which it is accepted and written
    output wire                                   s_pair_ready,
    // ModuleId of its test; 2: A is a triangle that a test of quads takes
    input  wire [              `CCHIP_KIND_W-1:0] s_pair_kind,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,      // primitive A
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,      // primitive B
    // there is room for the kind of the pair; stays 1 until the pair is accepted; of the kind of
    // the pair: its queue has room, and where
    input  wire                                   room,
    // where it goes; used on the clock on which it is accepted
    input  wire [                    PLACE_W-1:0] place,
    input  wire [                    PLACE_W-1:0] m_place,       // the pair that is read
    // the vertex that is read; 0 while none is
    input  wire [                            1:0] m_vertex,
    output wire [    `CCHIP_POINT_W(COORD_W)-1:0] m_a,           // that vertex of A, 2 clocks later
    output wire [    `CCHIP_POINT_W(COORD_W)-1:0] m_b            // that vertex of B, 2 clocks later
);

  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);

  `CCHIP_REFUSE(COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX,
                cchip_error_COORD_W_must_be_4_to_20)
  `CCHIP_REFUSE(PLACE_W < 3 || PLACE_W > 12, cchip_error_PLACE_W_must_be_3_to_12)

  // ---- accept: a pair that holds still is accepted one clock after there is room for it
  // and no vertex behind the first is read
  reg ready_q;
  wire write = s_pair_valid & ready_q;
  assign s_pair_ready = ready_q;
  always @(posedge clk) ready_q <= ~rst & s_pair_valid & room & (m_vertex == 2'd0) & ~ready_q;

  // ---- memory: a word per vertex, four are written at once
  wire [4*POINT_W-1:0] a = {
    s_pair_kind[0] ? s_pair_a[3*POINT_W+:POINT_W] : s_pair_a[2*POINT_W+:POINT_W],
    s_pair_a[3*POINT_W-1:0]
  };
  wire [8*POINT_W-1:0] words;
  genvar v;
  generate
    for (v = 0; v < 4; v = v + 1) begin : gen_words
      assign words[2*POINT_W*v+:2*POINT_W] = {s_pair_b[POINT_W*v+:POINT_W], a[POINT_W*v+:POINT_W]};
    end
  endgenerate
  cchip_block_ram #(
      .WIDTH (2 * POINT_W),
      .WORDS (4),
      .ADDR_W(PLACE_W + 2)
  ) u_memory (
      .clk       (clk),
      .write     (write),
      .write_addr(place),
      .write_data(words),
      .read_addr ({m_place, m_vertex}),
      .read_data ({m_b, m_a})
  );

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, !write || room)
      `CCHIP_ASSERT(a_read, !write || m_vertex == 2'd0 || m_place != place)
    end

  wire unused = &{1'b0, s_pair_kind[`CCHIP_KIND_W-1:1]};

endmodule
`default_nettype wire
