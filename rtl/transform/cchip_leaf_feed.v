// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_leaf_feed: leaf pairs from the broad phase to the vertex transform, each with the map of
// its query and a number of cchip_calc_result.
//   map          kept for each context, not for each epoch of it: a leaf pair of a query that has
//                ended may meet the map of the next one. That is harmless: every map is a legal
//                one, and the traversal calls its results dead
//   credit       s_leaf_valid has no ready: at most one leaf pair comes for which m_credit has not
//                been 1; the others wait in cchip_get_data, which has memory for their lines
//   beats        lines come in eight beats of 64 bits each, the lowest first, with s_leaf_valid and
//                on the seven clocks after it
//   end          a leaf pair whose line could not be read, or is illegal, ends without primitive
//                pairs, with CCHIP_END_MEMORY or CCHIP_END_CORRUPT
//   throughput   a leaf pair every 9 clocks
//   latency      9 clocks from s_leaf_valid to m_valid
//   cuts         every path from s_leaf and s_start, and to m_credit
//   reset        leaf pairs inside are dropped
module cchip_leaf_feed #(
    parameter integer QUERIES = 16,  // contexts (query); legal: 2, 4, 8, 16
    parameter integer LEAF_W = 6  // width of a number of cchip_calc_result (bit); legal: 1 or more
) (
    input  wire                       clk,              // clock, rising edge
    input  wire                       rst,              // synchronous reset, active high
    input  wire                       s_start_valid,    // a query has started
    input  wire [$clog2(QUERIES)-1:0] s_start_context,  // its context
    input  wire [ `CCHIP_QUERY_W-1:0] s_start_query,  // record QUERY, docs/hardware/definitions.md
    // ---- leaf pairs
    input  wire                       s_leaf_valid,     // a leaf pair
    input  wire [$clog2(QUERIES)-1:0] s_leaf_context,   // context of its query
    input  wire [                1:0] s_leaf_epoch,     // epoch of its query
    input  wire [                3:0] s_leaf_kinds,     // kinds of its leaves, {B's, A's}
    input  wire                       s_leaf_failed,    // a line could not be read
    // a beat of the leaves (image.md, docs/hardware/image.md), 64 bits of each, {B's, A's}, the
    // lowest first: with s_leaf_valid and on the seven clocks after it
    input  wire [              127:0] s_leaf_lines,
    output wire                       m_credit,         // a leaf pair has left: room for one more
    // ---- a number for a leaf pair; it ends without primitive pairs
    output wire                       m_begin_valid,    // a leaf pair begins
    input  wire                       m_begin_ready,    // it has s_number
    output wire [$clog2(QUERIES)-1:0] m_begin_context,  // context of its query
    output wire [                1:0] m_begin_epoch,    // epoch of its query
    output wire [                1:0] m_begin_pairs,    // its primitive pairs - 1
    input  wire [         LEAF_W-1:0] s_number,         // number for the leaf pair that begins
    output wire                       m_end_valid,      // it ends without primitive pairs
    input  wire                       m_end_ready,      // taken
    output wire [         LEAF_W-1:0] m_end_number,     // its number
    output wire [$clog2(QUERIES)-1:0] m_end_context,    // context of its query
    output wire [                1:0] m_end_epoch,      // epoch of its query
    // MEMORY or CORRUPT of QueryCode, docs/hardware/definitions.md
    output wire [   `CCHIP_END_W-1:0] m_end_code,
    // ---- to cchip_transform
    // a leaf pair for the transform; nothing of it changes until m_ready
    output wire                       m_valid,
    input  wire                       m_ready,          // taken
    output wire [              287:0] m_m,              // M of its query
    output wire [              107:0] m_t,              // t
    output wire [                3:0] m_shift,          // the map is M 2^-shift
    output wire [               11:0] m_error,          // bound on the error of a position, 2^-38
    output wire [                3:0] m_kinds,          // kinds of the leaves
    output wire [             1023:0] m_lines,          // the leaves
    output wire [           LEAF_W:0] m_id,             // {user's objects are exchanged, number}
    // with m_ready: a line is illegal, no primitive pairs follow
    input  wire                       s_corrupt
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer MAP_W = 1 + 12 + 4 + 108 + 288;
  localparam [1:0] TWO_TRIANGLES = 2'd2;

  `CCHIP_REFUSE(QUERIES < 2 || QUERIES > 16 || (1 << CONTEXT_W) != QUERIES || LEAF_W < 1,
                cchip_error_leaf_feed_QUERIES_must_be_2_4_8_or_16_and_LEAF_W_positive)

  `CCHIP_LUT_RAM
  reg [MAP_W-1:0] maps[0:QUERIES-1];
  always @(posedge clk)
    if (s_start_valid)
      maps[s_start_context] <= {
        s_start_query[`CCHIP_QUERY_SWAPPED],
        s_start_query[`CCHIP_QUERY_ERROR],
        s_start_query[`CCHIP_QUERY_SHIFT],
        s_start_query[`CCHIP_QUERY_T],
        s_start_query[`CCHIP_QUERY_M]
      };

  // ---- the leaf pair that waits. What is in its register counts only with its valid bit, so the
  // condition of the thousand flip-flops is that bit alone: the beats shift through them, whether
  // one comes or not
  reg wait_valid_q, wait_failed_q;
  reg [6:0] comes_q;  // which of the other beats comes: one-hot
  wire leaves;  // it goes to the transform, or ends
  reg credit_q;  // a clock later: who gives the next one is far
  reg [CONTEXT_W-1:0] wait_context_q;
  reg [1:0] wait_epoch_q;
  reg [3:0] wait_kinds_q;
  reg [1023:0] wait_lines_q;  // beats
  wire [1023:0] wait_lines;  // {B's, A's}
  genvar b;
  generate
    for (b = 0; b < 8; b = b + 1) begin : gen_beat
      assign wait_lines[64*b+:64]     = wait_lines_q[128*b+:64];
      assign wait_lines[512+64*b+:64] = wait_lines_q[128*b+64+:64];
    end
  endgenerate
  always @(posedge clk) begin
    if (s_leaf_valid)
      {wait_context_q, wait_epoch_q, wait_failed_q, wait_kinds_q} <= {
        s_leaf_context, s_leaf_epoch, s_leaf_failed, s_leaf_kinds
      };
    if (!wait_valid_q) wait_lines_q <= {s_leaf_lines, wait_lines_q[1023:128]};
    comes_q      <= {7{~rst}} & {comes_q[5:0], s_leaf_valid};
    wait_valid_q <= ~rst & (wait_valid_q ? ~leaves : comes_q[6]);
    credit_q     <= ~rst & leaves;
  end
  wire unused = &{1'b0, s_start_query};
  wire two_a = wait_kinds_q[1:0] == TWO_TRIANGLES;
  wire two_b = wait_kinds_q[3:2] == TWO_TRIANGLES;

  // ---- the leaf pair that is with the transform, or that ends
  localparam [1:0] EMPTY = 2'd0, TRANSFORM = 2'd1, ENDS = 2'd2;
  reg [1:0] state_q;
  reg [CONTEXT_W-1:0] context_q;
  reg [1:0] epoch_q;
  reg [3:0] kinds_q;
  reg [1023:0] lines_q;
  reg [MAP_W-1:0] map_q;
  reg [LEAF_W-1:0] number_q;
  reg [`CCHIP_END_W-1:0] code_q;
  assign m_begin_valid   = wait_valid_q && state_q == EMPTY;
  assign m_begin_context = wait_context_q;
  assign m_begin_epoch   = wait_epoch_q;
  assign m_begin_pairs   = {two_a & two_b, two_a | two_b};
  assign m_credit        = credit_q;
  assign leaves          = m_begin_valid & m_begin_ready;
  always @(posedge clk) begin
    if (state_q == EMPTY) begin  // whether there is one or not, as above
      {context_q, epoch_q, kinds_q, lines_q} <= {
        wait_context_q, wait_epoch_q, wait_kinds_q, wait_lines
      };
      map_q    <= maps[wait_context_q];
      number_q <= s_number;
    end
    case (state_q)
      EMPTY:
      if (leaves) begin
        state_q <= wait_failed_q ? ENDS : TRANSFORM;
        code_q  <= `CCHIP_END_MEMORY;
      end
      TRANSFORM:
      if (m_ready) begin
        state_q <= s_corrupt ? ENDS : EMPTY;
        code_q  <= `CCHIP_END_CORRUPT;
      end
      default:  // ENDS
      if (m_end_ready) state_q <= EMPTY;
    endcase
    if (rst) state_q <= EMPTY;
  end
  assign m_end_valid = state_q == ENDS;
  assign m_end_number = number_q;
  assign m_end_context = context_q;
  assign m_end_epoch = epoch_q;
  assign m_end_code = code_q;
  assign m_valid = state_q == TRANSFORM;
  assign {m_error, m_shift, m_t, m_m} = map_q[MAP_W-2:0];
  assign m_kinds = kinds_q;
  assign m_lines = lines_q;
  assign m_id = {map_q[MAP_W-1], number_q};

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_credit, !s_leaf_valid || (!wait_valid_q && comes_q == 7'd0))
    end

endmodule
`default_nettype wire
