// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_pair_queue: first-in first-out queue of wide words in block RAM, with the number of words
// that wait.
//   latency      3 clocks from the push to m_valid of an empty queue: memory, its output register,
//                m_data
//   throughput   one word per clock
//   capacity     DEPTH words, both registers behind the memory included
//   cuts         every path: s_ready, m_valid, m_data and count are flip-flops
//   reset        empty; s_ready = 0 while rst is 1
//   errors       none: a full queue is not ready
module cchip_pair_queue #(
    // width of the payload, bit
    parameter integer WIDTH = 406,
    // capacity, words, 16..1024
    parameter integer DEPTH = 256
) (
    input  wire                       clk,
    input  wire                       rst,
    input  wire                       s_valid,
    output wire                       s_ready,
    input  wire [          WIDTH-1:0] s_data,
    output wire                       m_valid,
    input  wire                       m_ready,
    output wire [          WIDTH-1:0] m_data,
    output wire [$clog2(DEPTH+1)-1:0] count     // words that were pushed and not taken yet
);

  localparam integer PTR_W = $clog2(DEPTH);
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam [31:0] LAST = DEPTH - 1;
  localparam [31:0] FULL = DEPTH;
  localparam [31:0] ONE = 1;
  localparam [31:0] TWO = 2;

  generate
    if (WIDTH < 1 || DEPTH < 16 || DEPTH > 1024) begin : gen_illegal
      cchip_error_pair_queue_WIDTH_below_1_or_DEPTH_not_16_to_1024 u_error ();
    end
  endgenerate

  reg [PTR_W-1:0] write_q, read_q;
  reg [COUNT_W-1:0] count_q;
  reg [COUNT_W-1:0] stored_q;  // words in the memory that were not read yet
  reg ready_q;  // count_q < DEPTH
  reg some_q, more_q;  // stored_q >= 1, >= 2
  reg fetched_q;  // the memory's output register holds a word
  reg valid_q;
  reg [WIDTH-1:0] fetched_data_q, data_q;

  assign s_ready = ready_q;
  assign m_valid = valid_q;
  assign m_data  = data_q;
  assign count   = count_q;

  wire push = s_valid & ready_q;
  wire pop = valid_q & m_ready;
  wire advance = m_ready | ~valid_q;  // data_q is free
  wire fetch = some_q & (advance | ~fetched_q);

  // ---- memory: one write port, one read port with its register; a word is never read on the clock
  // of its write
  (* ram_style = "block", no_rw_check *)
  reg [WIDTH-1:0] mem [0:DEPTH-1];
  always @(posedge clk) if (push) mem[write_q] <= s_data;
  always @(posedge clk) if (fetch) fetched_data_q <= mem[read_q];

  function [PTR_W-1:0] next(input [PTR_W-1:0] pointer);
    next = pointer == LAST[PTR_W-1:0] ? {PTR_W{1'b0}} : pointer + ONE[PTR_W-1:0];
  endfunction

  // All sums and comparisons are computed from registers; push, pop and fetch, which come late,
  // select among them. n - 1 is written ~(~n + 1): otherwise Yosys merges the sum and the
  // difference into one adder behind the selection.
  always @(posedge clk) begin
    if (advance) data_q <= fetched_data_q;
    if (rst) begin
      write_q   <= {PTR_W{1'b0}};
      read_q    <= {PTR_W{1'b0}};
      count_q   <= {COUNT_W{1'b0}};
      stored_q  <= {COUNT_W{1'b0}};
      ready_q   <= 1'b0;
      some_q    <= 1'b0;
      more_q    <= 1'b0;
      fetched_q <= 1'b0;
      valid_q   <= 1'b0;
    end else begin
      if (push) write_q <= next(write_q);
      if (fetch) read_q <= next(read_q);
      if (push != pop) count_q <= push ? count_q + ONE[COUNT_W-1:0]
          : ~(~count_q + ONE[COUNT_W-1:0]);
      if (push != fetch) stored_q <= push ? stored_q + ONE[COUNT_W-1:0]
          : ~(~stored_q + ONE[COUNT_W-1:0]);
      ready_q   <= push == pop ? count_q != FULL[COUNT_W-1:0] : pop || count_q != LAST[COUNT_W-1:0];
      some_q    <= push | (fetch ? more_q : some_q);
      more_q    <= push == fetch ? more_q : push ? some_q : stored_q > TWO[COUNT_W-1:0];
      fetched_q <= fetch | (fetched_q & ~advance);
      valid_q   <= advance ? fetched_q : valid_q;
    end
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, count_q} <= FULL)
      `CCHIP_ASSERT(a_places, count_q == stored_q + {{COUNT_W - 1{1'b0}}, fetched_q}
          + {{COUNT_W - 1{1'b0}}, valid_q})
      `CCHIP_ASSERT(a_some, some_q == (stored_q != {COUNT_W{1'b0}}))
      `CCHIP_ASSERT(a_more, more_q == (stored_q > ONE[COUNT_W-1:0]))
      `CCHIP_ASSERT(a_ready, !ready_q || count_q != FULL[COUNT_W-1:0])
    end

endmodule
`default_nettype wire
