// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// Quartus, which defines this macro, infers no ports of different widths from Verilog.
`ifdef ALTERA_RESERVED_QIS
`define CCHIP_MIXED_WIDTH 0
`else
`define CCHIP_MIXED_WIDTH 1
`endif
// cchip_operand_memory: the vertices of the pairs that wait, in block RAM, four words a pair, at
// the place of the pair's descriptor (cchip_descriptor_queues). A word is one vertex of A and one
// of B.
//   write        all vertices of the pair on s_pair on the clock on which it is accepted, at the
//                earliest 1 clock after it is offered: a pair every 2 clocks
//   triangles    A of a tri-quad pair is written with its third vertex twice, so that a test of
//                quads takes it as a quad
//   read         m_a, m_b: vertex m_vertex of the pair at m_place, 1 clock later
//   collision    the pair at m_place has left its queue when its vertex 0 is read. While m_vertex
//                is 1 to 3 its place is not written: a new pair waits for it
//   cuts         every path: outputs are flip-flops, or m_a and m_b a multiplexer behind some
//   reset        no pair is accepted; what was written stays
module cchip_operand_memory #(
    // width of a coordinate, bit, 4..20
    parameter integer COORD_W = 16,
    // width of a place, bit, 3..12: 1 << PLACE_W pairs
    parameter integer PLACE_W = 9,
    // 1: one block RAM with a wider port for writing; 0: four of them and a multiplexer
    parameter integer MIXED_WIDTH = `CCHIP_MIXED_WIDTH
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

  // ---- accept: a pair that holds still is accepted one clock after there is room for it
  // and nothing is read at its place any more
  reg ready_q;
  wire being_read = m_vertex != 2'd0 && m_place == place;
  wire write = s_pair_valid & ready_q;
  assign s_pair_ready = ready_q;
  always @(posedge clk) ready_q <= ~rst & s_pair_valid & room & ~being_read & ~ready_q;

  // ---- memory: a word per vertex, four are written at once
  wire [4*POINT_W-1:0] a = {
    s_pair_kind[0] ? s_pair_a[3*POINT_W+:POINT_W] : s_pair_a[2*POINT_W+:POINT_W],
    s_pair_a[3*POINT_W-1:0]
  };
  generate
    if (MIXED_WIDTH != 0) begin : gen_mixed
      // the form that tools know as a write port four words wide
      (* ram_style = "block", no_rw_check *)
      reg [2*POINT_W-1:0] mem [0:(4<<PLACE_W)-1];
      reg [2*POINT_W-1:0] data_q;
      integer v;
      always @(posedge clk)
        for (v = 0; v < 4; v = v + 1)
          if (write) mem[{place, v[1:0]}] <= {s_pair_b[POINT_W*v+:POINT_W], a[POINT_W*v+:POINT_W]};
      always @(posedge clk) data_q <= mem[{m_place, m_vertex}];
      assign {m_b, m_a} = data_q;
    end else begin : gen_banks
      wire [8*POINT_W-1:0] words;
      reg [1:0] vertex_q;
      genvar b;
      for (b = 0; b < 4; b = b + 1) begin : gen_bank
        (* ram_style = "block", no_rw_check *)
        reg [2*POINT_W-1:0] mem [0:(1<<PLACE_W)-1];
        reg [2*POINT_W-1:0] data_q;
        always @(posedge clk)
          if (write) mem[place] <= {s_pair_b[POINT_W*b+:POINT_W], a[POINT_W*b+:POINT_W]};
        always @(posedge clk) data_q <= mem[m_place];
        assign words[2*POINT_W*b+:2*POINT_W] = data_q;
      end
      always @(posedge clk) vertex_q <= m_vertex;
      wire [4*POINT_W-1:0] half = vertex_q[1] ? words[4*POINT_W+:4*POINT_W] : words[0+:4*POINT_W];
      assign {m_b, m_a} = vertex_q[0] ? half[2*POINT_W+:2*POINT_W] : half[0+:2*POINT_W];
    end
  endgenerate

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, !write || room)
      `CCHIP_ASSERT(a_read, !write || !being_read)
    end

  wire unused = &{1'b0, s_pair_kind[1]};

endmodule
`default_nettype wire
