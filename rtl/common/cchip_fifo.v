// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_fifo: first-in first-out queue in distributed memory with a register behind it.
//   latency      2 clocks from the push to m_valid of an empty queue
//   throughput   one beat per clock, DEPTH >= 3
//   capacity     DEPTH beats
//   cuts         valid, ready and data: every output is a flip-flop
//   reset        empty; s_ready = 0 while rst is 1
module cchip_fifo #(
    // width of the payload, bit
    parameter integer WIDTH = 8,
    // capacity, beats
    parameter integer DEPTH = 16
) (
    input  wire             clk,
    input  wire             rst,
    input  wire             s_valid,
    output wire             s_ready,
    input  wire [WIDTH-1:0] s_data,
    output wire             m_valid,
    input  wire             m_ready,
    output wire [WIDTH-1:0] m_data
);

  // banks of 16 words, the smallest memory of LUTs: each write enable starts from registers
  localparam integer BANKS = (DEPTH + 15) / 16;
  localparam integer PTR_W = DEPTH > 16 ? $clog2(DEPTH) : 4;
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam [31:0] LAST = DEPTH - 1;
  localparam [31:0] FULL = DEPTH;
  localparam [31:0] ONE = 1;
  localparam [31:0] TWO = 2;

  generate
    if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
      cchip_error_fifo_WIDTH_or_DEPTH_below_1 u_error ();
    end
  endgenerate

  reg [PTR_W-1:0] write_q, read_q;
  reg [BANKS-1:0] write_bank_q, read_bank_q;  // their banks, one-hot
  reg [COUNT_W-1:0] count_q; // beats in memory and output register
  reg ready_q, some_q, more_q;  // count_q < DEPTH, >= 1, >= 2
  reg valid_q;
  reg [WIDTH-1:0] data_q;

  assign s_ready = ready_q;
  assign m_valid = valid_q;
  assign m_data  = data_q;

  wire push = s_valid & ready_q;
  wire pop = valid_q & m_ready;
  wire up = push & ~pop;
  wire down = pop & ~push;
  wire load = (~valid_q & some_q) | (m_ready & more_q);

  // ---- memory
  wire [WIDTH*BANKS-1:0] words;
  genvar b;
  generate
    for (b = 0; b < BANKS; b = b + 1) begin : gen_bank
      (* ram_style = "distributed" *)
      reg [WIDTH-1:0] mem [0:15];
      always @(posedge clk) if (s_valid & ready_q & write_bank_q[b]) mem[write_q[3:0]] <= s_data;
      assign words[WIDTH*b+:WIDTH] = mem[read_q[3:0]];
    end
  endgenerate

  function [WIDTH-1:0] choose(input [WIDTH*BANKS-1:0] from, input [BANKS-1:0] bank);
    integer j;
    begin
      choose = {WIDTH{1'b0}};
      for (j = 0; j < BANKS; j = j + 1) choose = choose | (from[WIDTH*j+:WIDTH] & {WIDTH{bank[j]}});
    end
  endfunction
  wire [WIDTH-1:0] word = choose(words, read_bank_q);

  function [PTR_W-1:0] next(input [PTR_W-1:0] pointer);
    next = pointer == LAST[PTR_W-1:0] ? {PTR_W{1'b0}} : pointer + ONE[PTR_W-1:0];
  endfunction

  function [BANKS-1:0] bank_of(input [PTR_W-1:0] pointer);
    integer j;
    begin
      bank_of = {BANKS{1'b0}};
      for (j = 0; j < BANKS; j = j + 1) bank_of[j] = {{32 - PTR_W{1'b0}}, pointer} >> 4 == j[31:0];
    end
  endfunction
  wire [PTR_W-1:0] write_next = next(write_q);
  wire [PTR_W-1:0] read_next = next(read_q);

  // sums and comparisons start from registers: push and pop only choose
  always @(posedge clk) begin
    if (load) data_q <= word;
    if (rst) begin
      write_q <= {PTR_W{1'b0}};
      write_bank_q <= ONE[BANKS-1:0];
      read_bank_q <= ONE[BANKS-1:0];
      read_q  <= {PTR_W{1'b0}};
      count_q <= {COUNT_W{1'b0}};
      ready_q <= 1'b0;
      some_q  <= 1'b0;
      more_q  <= 1'b0;
      valid_q <= 1'b0;
    end else begin
      if (push) write_q <= write_next;
      if (push) write_bank_q <= bank_of(write_next);
      if (load) read_q <= read_next;
      if (load) read_bank_q <= bank_of(read_next);
      count_q <= up ? count_q + ONE[COUNT_W-1:0] : down ? count_q - ONE[COUNT_W-1:0] : count_q;
      ready_q <= up ? count_q != LAST[COUNT_W-1:0] : pop || count_q != FULL[COUNT_W-1:0];
      some_q  <= up || (down ? more_q : some_q);
      more_q  <= up ? some_q : down ? more_q && {{32 - COUNT_W{1'b0}}, count_q} != TWO : more_q;
      valid_q <= load | (valid_q & ~m_ready);
    end
  end

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, count_q} <= FULL)
      `CCHIP_ASSERT(a_some, some_q == (count_q != {COUNT_W{1'b0}}))
      `CCHIP_ASSERT(a_more, more_q == ({{32 - COUNT_W{1'b0}}, count_q} >= TWO))
      `CCHIP_ASSERT(a_valid, !valid_q || some_q)
    end

endmodule
`default_nettype wire
