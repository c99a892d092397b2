// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_line_pairs: lines that come in any order, and the pairs both of whose lines are here. Lines
// of A come through port 0, those of B through port 1, each once; a pair has a place.
//   beats        a line is two beats of 256 bits, the lower half with s_valid, the upper one on the
//                next clock, on which s_place stays; read_beat says which one is read
//   leaves       have a memory of their own, written as above and read in eight beats of 64 bits,
//                so that the lines of node pairs need not wait for theirs
//   order        the port of the second line puts the pair in its queue; if both lines come on one
//                clock, port 0 does. Node pairs and leaf pairs have queues of their own
//   latency      4 clocks from the second line to m_pair_valid or m_leaf_valid; read_lines and
//                read_codes 2 clocks after read_place, leaf_lines and leaf_codes after leaf_place
//   throughput   a line per port and two clocks
//   credit       a place is used again only after its pair has left its queue
//   reset        no earlier line may come; the queues are empty
//   rules        Each line comes once.
//   inside       Of each place one bit, which every line inverts: a second line finds it 1. For
//                each port a cchip_block_ram of lines and another one of the lines of leaf pairs,
//                which is written 256 bits wide and read 64, the codes in LUT memory, and two
//                cchip_fifo.
module cchip_line_pairs #(
    parameter integer PAIRS   = 48,  // node pairs in flight: places 0 .. PAIRS - 1; legal: 1..63
    parameter integer LEAVES  = 16,  // leaf pairs in flight: the places behind them; legal: 1..63
    // width of the number of a pair (bit); legal: 3..6; PAIRS + LEAVES is 2^PLACE_W
    parameter integer PLACE_W = 6
) (
    input  wire                            clk,           // clock, rising edge
    input  wire                            rst,           // synchronous reset, active high
    // ---- lines, {B's, A's}; on the clock after 1, s_valid is 0
    // bit p: a line comes through port p, 0: of A, 1: of B
    input  wire [                     1:0] s_valid,
    input  wire [           2*PLACE_W-1:0] s_place,       // place of its pair
    // outcome of its read (ReadCode, docs/hardware/definitions.md)
    input  wire [2*`CCHIP_READ_CODE_W-1:0] s_code,
    // a half of the line, {B's, A's}: the lower one with s_valid, the upper one on the next clock,
    // on which s_place stays
    input  wire [                   511:0] s_data,
    // ---- pairs that are complete, in the queue of each port
    // bit p: a node pair waits in the queue of port p
    output wire [                     1:0] m_pair_valid,
    input  wire [                     1:0] m_pair_take,   // bit p: it is accepted
    output wire [           2*PLACE_W-1:0] m_pair_place,  // its place
    // bit p: a leaf pair waits in the queue of port p
    output wire [                     1:0] m_leaf_valid,
    input  wire [                     1:0] m_leaf_take,   // bit p: it is accepted
    output wire [           2*PLACE_W-1:0] m_leaf_place,  // its place
    // ---- halves of the lines of a node pair, {B's, A's}
    input  wire [             PLACE_W-1:0] read_place,    // place of a pair whose lines are wanted
    // the halves that are wanted: 0 lower, 1 upper
    input  wire                            read_beat,
    output wire [                   511:0] read_lines,    // halves of its lines, {B's, A's}
    output wire [2*`CCHIP_READ_CODE_W-1:0] read_codes,    // outcomes of their reads
    // ---- eighths of the lines of a leaf pair, {B's, A's}
    // place of a leaf pair whose lines are wanted
    input  wire [             PLACE_W-1:0] leaf_place,
    input  wire [                     2:0] leaf_beat,  // the eighths that are wanted, 0: the lowest
    output wire [                   127:0] leaf_lines,    // eighths of its lines, {B's, A's}
    output wire [2*`CCHIP_READ_CODE_W-1:0] leaf_codes     // outcomes of their reads
);

  localparam integer PLACES = 1 << PLACE_W;
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam [31:0] FIRST_LEAF = PAIRS;
  localparam [PLACES-1:0] ONE_PLACE = 1;
  // the lower bits of a leaf pair's place are its number in the memory: no two have the same
  localparam integer LEAF_W = LEAVES > 1 ? $clog2(LEAVES) : 1;

  // Places one of whose lines has come. Each line comes once, so the next one is the second. A line
  // inverts the bit of its place: no bit depends on what the others are.
  reg [PLACES-1:0] came_q;
  wire [2*PLACES-1:0] comes;  // a line, by place
  // a clock after the data, which go to their memories at once: the cache is far, and which of the
  // places is meant takes many gates
  reg [1:0] valid_q;
  reg [PLACE_W-1:0] place0, place1;
  always @(posedge clk) begin
    valid_q          <= {2{~rst}} & s_valid;
    {place1, place0} <= s_place;
  end
  wire both = &valid_q && place0 == place1;
  wire [1:0] no_room;  // for a pair in its queue: never
  genvar p;
  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_port
      wire [PLACE_W-1:0] place = p == 0 ? place0 : place1;
      assign comes[PLACES*p+:PLACES] = valid_q[p] ? ONE_PLACE << place : {PLACES{1'b0}};
      reg whole_q;  // this line is the second
      reg [PLACE_W-1:0] whole_place_q;
      wire whole_leaf = {{32 - PLACE_W{1'b0}}, whole_place_q} >= FIRST_LEAF;
      wire pair_ready, leaf_ready;
      cchip_fifo #(.WIDTH(PLACE_W), .DEPTH(PAIRS), .ROOM_KNOWN(1)) u_pairs (
          .clk    (clk),
          .rst    (rst),
          .s_valid(whole_q & ~whole_leaf),
          .s_ready(pair_ready),
          .s_data (whole_place_q),
          .m_valid(m_pair_valid[p]),
          .m_ready(m_pair_take[p]),
          .m_data (m_pair_place[PLACE_W*p+:PLACE_W])
      );
      cchip_fifo #(.WIDTH(PLACE_W), .DEPTH(LEAVES), .ROOM_KNOWN(1)) u_leaves (
          .clk    (clk),
          .rst    (rst),
          .s_valid(whole_q & whole_leaf),
          .s_ready(leaf_ready),
          .s_data (whole_place_q),
          .m_valid(m_leaf_valid[p]),
          .m_ready(m_leaf_take[p]),
          .m_data (m_leaf_place[PLACE_W*p+:PLACE_W])
      );
      wire [PLACE_W-1:0] comes_place = s_place[PLACE_W*p+:PLACE_W];
      wire comes_leaf = {{32 - PLACE_W{1'b0}}, comes_place} >= FIRST_LEAF;
      cchip_block_ram #(.WIDTH(256), .ADDR_W(PLACE_W + 1)) u_lines (
          .clk       (clk),
          .write     (s_valid[p] | valid_q[p]),
          .write_addr({comes_place, valid_q[p]}),
          .write_data(s_data[256*p+:256]),
          .read_addr ({read_place, read_beat}),
          .read_data (read_lines[256*p+:256])
      );
      cchip_block_ram #(.WIDTH(64), .WORDS(4), .ADDR_W(LEAF_W + 3)) u_leaf_lines (
          .clk       (clk),
          .write     ((s_valid[p] | valid_q[p]) & comes_leaf),
          .write_addr({comes_place[LEAF_W-1:0], valid_q[p]}),
          .write_data(s_data[256*p+:256]),
          .read_addr ({leaf_place[LEAF_W-1:0], leaf_beat}),
          .read_data (leaf_lines[64*p+:64])
      );
      `CCHIP_LUT_RAM
      reg [CODE_W-1:0] codes[0:PLACES-1];
      reg [CODE_W-1:0] code_q, leaf_code_q;
      always @(posedge clk) begin
        if (s_valid[p]) codes[comes_place] <= s_code[CODE_W*p+:CODE_W];
        code_q        <= codes[read_place];
        leaf_code_q   <= codes[leaf_place];
        whole_place_q <= place;
        whole_q       <= ~rst & valid_q[p] & (came_q[place] | (both & (p == 0)));
      end
      assign read_codes[CODE_W*p+:CODE_W] = code_q;
      assign leaf_codes[CODE_W*p+:CODE_W] = leaf_code_q;
      assign no_room[p] = whole_q & ~(whole_leaf ? leaf_ready : pair_ready);
    end
  endgenerate
  always @(posedge clk)
    if (rst) came_q <= {PLACES{1'b0}};
    else came_q <= came_q ^ comes[PLACES+:PLACES] ^ comes[0+:PLACES];

  wire unused = &{1'b0, no_room};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_whole, no_room == 2'd0)
      `CCHIP_ASSERT(a_beats, (s_valid & valid_q) == 2'd0)
      `CCHIP_ASSERT(a_stays, (!valid_q[0] || place0 == s_place[0+:PLACE_W]) &&
          (!valid_q[1] || place1 == s_place[PLACE_W+:PLACE_W]))
    end

endmodule
`default_nettype wire
