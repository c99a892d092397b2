// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_descriptor_queues: a queue of descriptors for each kind of pair, and one for the illegal
// kind 0, which takes those above KINDS, too, all of them in one block RAM. A place is the address
// in it, {kind, pointer of the kind}.
//   latency      1 clock from a push to `some`; the descriptor at the head of a kind is on m_data 3
//                clocks after `look`, its place 1 clock after; the place stays until 1 clock after
//                the next `look`, m_data no longer than until 3 clocks after the pop
//   throughput   a push on every clock; a pop one clock after its look at the earliest
//   cuts         every path but s_kind to s_ready and s_place
//   reset        empty
//   a place is written again one clock after its pop at the earliest
//   about        What the descriptors mean, the queues do not know.
//   timing       A push is seen by some one clock later. m_place stays until one clock after the
//                next look, m_data no longer than until three clocks after the pop: then its place
//                may be written again. pop comes one clock after its look at the earliest. A place
//                is written again one clock after its pop at the earliest: a module that reads
//                something else at that place (the operand memory) begins on the clock of pop.
//   numbers      A place is {kind, pointer}, CCHIP_KIND_BITS(KINDS) + $clog2(DEPTH) bits: two for
//                the kind, three with four kinds.
//   why          Descriptors are narrow, so one block RAM holds the queues of all kinds; a FIFO for
//                each kind would take a block RAM each. With a queue for kind 0, pairs that no slot
//                can test need no path of their own.
module cchip_descriptor_queues #(
    parameter integer WIDTH = `CCHIP_DESCRIPTOR_W,  // width of a descriptor (bit); legal: 1..80
    parameter integer KINDS = 3,                    // kinds of pairs; legal: 1..3
    // capacity of each queue (descriptor); legal: a power of two, 16..1024
    parameter integer DEPTH = 128
) (
    input  wire                                  clk,                 // clock, rising edge
    input  wire                                  rst,  // synchronous reset, active high
    input  wire                                  s_valid,  // a descriptor comes; only while s_ready
    // the queue of s_kind has room; follows s_kind
    output wire                                  s_ready,
    input  wire [              `CCHIP_KIND_W-1:0] s_kind,  // kind of the descriptor, at most KINDS
    input  wire [                     WIDTH-1:0] s_data,              // the descriptor
    // where the next descriptor of s_kind goes; follows s_kind
    output wire [`CCHIP_KIND_BITS(KINDS)+$clog2(DEPTH)-1:0] s_place,
    // ---- queue k at bit and word k
    output wire [                       KINDS:0] some,                // bit k: queue k is not empty
    output wire [(KINDS+1)*$clog2(DEPTH+1)-1:0]  waiting,  // per queue: descriptors in it
    output wire [                       KINDS:0] room,                // bit k: queue k is not full
    // one-hot: the queue that look and pop are about
    input  wire [                       KINDS:0] kind,
    // 1: the place of the head of kind is fetched
    input  wire                                  look,
    input  wire                                  pop,  // the descriptor at the head of kind leaves
    // 1 clock after look: the place of the head
    output wire [`CCHIP_KIND_BITS(KINDS)+$clog2(DEPTH)-1:0] m_place,
    // 3 clocks after look: the descriptor there
    output wire [                     WIDTH-1:0] m_data
);

  localparam integer KIND_W = `CCHIP_KIND_W;
  localparam integer QUEUE_W = `CCHIP_KIND_BITS(KINDS);
  localparam integer PTR_W = $clog2(DEPTH);
  localparam integer PLACE_W = QUEUE_W + PTR_W;
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam integer QUEUES = KINDS + 1;
  localparam [31:0] LAST = KINDS;

  `CCHIP_REFUSE(WIDTH < 1 || WIDTH > 80, cchip_error_descriptor_WIDTH_must_be_1_to_80)
  `CCHIP_REFUSE(KINDS < 1 || KINDS > `CCHIP_KINDS_MAX, cchip_error_KINDS_must_be_1_to_4)
  `CCHIP_REFUSE(DEPTH < 16 || DEPTH > 1024 || (1 << PTR_W) != DEPTH,
                cchip_error_QUEUE_DEPTH_must_be_a_power_of_two_16_to_1024)

  // ---- pointers and counts
  wire [PTR_W*QUEUES-1:0] write, read;
  wire [QUEUES-1:0] kind_of_push;  // one-hot
  genvar k;
  generate
    for (k = 0; k < QUEUES; k = k + 1) begin : gen_queues
      localparam [31:0] KIND = k;
      reg [PTR_W-1:0] write_q, read_q;
      assign kind_of_push[k] = s_kind == KIND[KIND_W-1:0] || (k == 0 && s_kind > LAST[KIND_W-1:0]);
      wire push_here = s_valid & kind_of_push[k];
      wire pop_here = pop & kind[k];
      always @(posedge clk)
        if (rst) begin
          write_q <= {PTR_W{1'b0}};
          read_q  <= {PTR_W{1'b0}};
        end else begin
          if (push_here) write_q <= write_q + {{PTR_W - 1{1'b0}}, 1'b1};
          if (pop_here) read_q <= read_q + {{PTR_W - 1{1'b0}}, 1'b1};
        end
      assign write[PTR_W*k+:PTR_W] = write_q;
      assign read[PTR_W*k+:PTR_W]  = read_q;

      cchip_count #(
          .LIMIT(DEPTH)
      ) u_count (
          .clk  (clk),
          .rst  (rst),
          .up   (push_here),
          .down (pop_here),
          .count(waiting[COUNT_W*k+:COUNT_W]),
          .some (some[k]),
          .room (room[k])
      );
    end
  endgenerate

  wire [PTR_W-1:0] write_pointer, read_pointer;  // of the kind that comes, of the kind that leaves
  wire [QUEUE_W-1:0] write_kind, read_kind;
  cchip_onehot_mux #(
      .N    (QUEUES),
      .WIDTH(PTR_W)
  ) u_write (
      .select(kind_of_push),
      .s_data(write),
      .m_data(write_pointer)
  );
  cchip_onehot_mux #(
      .N    (QUEUES),
      .WIDTH(PTR_W)
  ) u_read (
      .select(kind),
      .s_data(read),
      .m_data(read_pointer)
  );
  cchip_onehot_index #(
      .N    (QUEUES),
      .WIDTH(QUEUE_W)
  ) u_kind (
      .select(kind),
      .index (read_kind)
  );
  assign s_ready = |(room & kind_of_push);
  assign write_kind = s_kind > LAST[KIND_W-1:0] ? {QUEUE_W{1'b0}} : s_kind[QUEUE_W-1:0];
  assign s_place = {write_kind, write_pointer};

  // ---- memory
  reg [PLACE_W-1:0] place_q;
  assign m_place = place_q;
  always @(posedge clk) if (look) place_q <= {read_kind, read_pointer};

  cchip_block_ram #(
      .WIDTH (WIDTH),
      .ADDR_W(PLACE_W)
  ) u_memory (
      .clk       (clk),
      .write     (s_valid),
      .write_addr(s_place),
      .write_data(s_data),
      .read_addr (place_q),
      .read_data (m_data)
  );

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, !s_valid || s_ready)
      `CCHIP_ASSERT(a_kind, !(look || pop)
          || (kind & (kind - {{KINDS{1'b0}}, 1'b1})) == {QUEUES{1'b0}})
      `CCHIP_ASSERT(a_pop, !pop || |(kind & some))
    end

endmodule
`default_nettype wire
