// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_operand_memory: the vertices of the pairs that wait, in block RAM: one vertex of A and one
// of B per word, four words a pair, at the place of the pair's descriptor
// (cchip_descriptor_queues).
//   write        the pair on s_pair, which holds still, is written one vertex per clock: 3 clocks
//                for triangles and for the illegal kind 0, 4 with quads; s_pair_ready is 1 on the
//                last of them, s_ready says that there is room for its kind
//   triangles    A of a tri-quad pair is written with its third vertex twice, so that a test of
//                quads takes it as a quad
//   read         m_a, m_b: vertex m_vertex of the pair at m_place, 1 clock later
//   cuts         s_pair_ready, m_a and m_b are flip-flops
//   reset        a pair that is half written is written again
module cchip_operand_memory #(
    // width of a coordinate, bit, 4..20
    parameter integer COORD_W = 16,
    // width of a place, bit, 3..12: 4 << PLACE_W words
    parameter integer PLACE_W = 9
) (
    input  wire                                   clk,
    input  wire                                   rst,
    input  wire                                   s_pair_valid,
    output wire                                   s_pair_ready,
    input  wire [              `CCHIP_KIND_W-1:0] s_pair_kind,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,
    // of the kind of the pair: its queue has room, and where
    input  wire                                   room,
    input  wire [                    PLACE_W-1:0] place,
    input  wire [                    PLACE_W-1:0] m_place,
    input  wire [                            1:0] m_vertex,
    output wire [    `CCHIP_POINT_W(COORD_W)-1:0] m_a,
    output wire [    `CCHIP_POINT_W(COORD_W)-1:0] m_b
);

  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);

  generate
    if (COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX) begin : gen_illegal_coord_w
      cchip_error_COORD_W_must_be_4_to_20 u_error ();
    end
    if (PLACE_W < 3 || PLACE_W > 12) begin : gen_illegal
      cchip_error_PLACE_W_must_be_3_to_12 u_error ();
    end
  endgenerate

  // ---- write
  reg [1:0] vertex_q;  // of the pair on s_pair: to be written next
  reg ready_q;
  assign s_pair_ready = ready_q;

  wire begun = |vertex_q;
  wire write = s_pair_valid & (begun | room);
  wire last = vertex_q == {1'b1, s_pair_kind[1]};
  wire before_last = vertex_q == {s_pair_kind[1], ~s_pair_kind[1]};
  wire [1:0] vertex_a = {vertex_q[1], vertex_q[0] & ~(vertex_q[1] & ~s_pair_kind[0])};

  always @(posedge clk)
    if (rst) begin
      vertex_q <= 2'd0;
      ready_q  <= 1'b0;
    end else begin
      vertex_q <= !write || last ? 2'd0 : vertex_q + 2'd1;
      ready_q  <= write & before_last;
    end

  // ---- memory: one write port, one read port with its register. The sender is a register, so the
  // choice of a vertex is the only logic before the block RAM.
  (* ram_style = "block", no_rw_check *)
  reg [2*POINT_W-1:0] mem [0:(4<<PLACE_W)-1];
  reg [2*POINT_W-1:0] data_q;
  assign {m_b, m_a} = data_q;

  // written out: an index times a width would become a multiplier
  function [POINT_W-1:0] choose(input [4*POINT_W-1:0] from, input [1:0] vertex);
    case (vertex)
      2'd0: choose = from[0+:POINT_W];
      2'd1: choose = from[POINT_W+:POINT_W];
      2'd2: choose = from[2*POINT_W+:POINT_W];
      default: choose = from[3*POINT_W+:POINT_W];
    endcase
  endfunction
  always @(posedge clk)
    if (write)
      mem[{place, vertex_q}] <= {choose(s_pair_b, vertex_q), choose(s_pair_a, vertex_a)};
  always @(posedge clk) data_q <= mem[{m_place, m_vertex}];

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_last, !(s_pair_valid && ready_q) || (last && write))
    end

endmodule
`default_nettype wire
