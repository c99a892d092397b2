// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_vertex_collector: the vertices of a pair, one of A and one of B per clock, into a request.
//   latency      1 clock from the last vertex to m_pair_valid
//   throughput   a vertex on every clock: the next pair may follow at once
//   fewer        a vertex is written to its place and to all places behind it, so a triangle that
//                comes as three vertices is complete as a quad: V3 = V2
//   first        begins a pair in any state; vertices before the first `first`, and behind
//                `last`, are ignored
//   reset        no pair begun. m_pair_valid has no ready: the sender's credit says that there is
//                room
//   about        The vertices of a pair, one of A and one of B per clock, become a request for
//                cchip_primtest. It is the entry of a reconfigurable module (cchip_pr_region).
//   timing       No ready: the credit of the ledger says that the test has room.
//   numbers      A test of quads gives it the exact answer on the grid, as its own test would;
//                witness, beats and certainty may differ.
//   why          first always begins a pair. A pair that was cut off by a swap leaves nothing
//                behind, and a region that was rewritten in the middle of a pair waits for the next
//                first.
module cchip_vertex_collector #(
    parameter integer COORD_W = 16  // width of a signed coordinate (bit); legal: 4..20
) (
    input  wire                                 clk,             // clock, rising edge
    input  wire                                 rst,             // synchronous reset, active high
    input  wire                                 s_vertex_valid,  // a vertex of each primitive
    input  wire [ `CCHIP_VERTEX_W(COORD_W)-1:0] s_vertex_data,   // record VERTEX
    // 1 for one clock: the pair is complete
    output wire                                 m_pair_valid,
    // record REQUEST; its tag is the number of the pair
    output wire [`CCHIP_REQUEST_W(COORD_W)-1:0] m_pair_data,
    output wire                                 busy             // a pair is begun or complete
);

  localparam integer POINT_W = `CCHIP_POINT_W(COORD_W);
  localparam integer VERTICES = `CCHIP_VERTICES;

  `CCHIP_REFUSE(COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX,
                cchip_error_COORD_W_must_be_4_to_20)

  wire first, last;
  wire [`CCHIP_PAIR_ID_W-1:0] id;
  wire [`CCHIP_ERR_W-1:0] err;
  wire [`CCHIP_MODE_W-1:0] mode;
  wire [POINT_W-1:0] a, b;
  assign `CCHIP_VERTEX_OF(first, last, id, err, mode, a, b) = s_vertex_data;

  reg [VERTICES*POINT_W-1:0] a_q, b_q;
  reg [VERTICES-1:0] write_mask_q;  // of the next vertex and those behind it
  reg begun_q;  // a first vertex came, and no last one since
  reg valid_q;
  reg [`CCHIP_PAIR_ID_W-1:0] id_q;
  reg [`CCHIP_ERR_W-1:0] err_q;
  reg [`CCHIP_MODE_W-1:0] mode_q;
  wire [VERTICES-1:0] write_mask = first ? {VERTICES{1'b1}} : write_mask_q;

  integer i;
  always @(posedge clk) begin
    if (s_vertex_valid) write_mask_q <= write_mask << 1;
    for (i = 0; i < VERTICES; i = i + 1)
      if (s_vertex_valid && write_mask[i]) begin
        a_q[POINT_W*i+:POINT_W] <= a;
        b_q[POINT_W*i+:POINT_W] <= b;
      end
    if (s_vertex_valid && first) begin
      id_q   <= id;
      err_q  <= err;
      mode_q <= mode;
    end
    if (rst) begin
      begun_q <= 1'b0;
      valid_q <= 1'b0;
    end else begin
      if (s_vertex_valid) begun_q <= (first | begun_q) & ~last;
      valid_q <= s_vertex_valid & last & (first | begun_q);
    end
  end
  assign m_pair_valid = valid_q;
  assign m_pair_data = `CCHIP_REQUEST_OF({{`CCHIP_TAG_W - `CCHIP_PAIR_ID_W{1'b0}}, id_q}, a_q, b_q,
      err_q, mode_q);
  assign busy = begun_q | valid_q;

endmodule
`default_nettype wire
