// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_fifo: first-in first-out queue: distributed memory and a cchip_skid_buffer behind it.
//   latency      2 clocks from the push to m_valid of an empty queue
//   throughput   one beat per clock, DEPTH >= 2
//   capacity     DEPTH beats in memory and the 2 of the skid buffer
//   cuts         valid, ready and data: every output is a flip-flop; m_ready reaches the skid buffer alone
//   reset        empty; s_ready = 0 while rst is 1
module cchip_fifo #(
    // width of the payload, bit
    parameter integer WIDTH = 8,
    // beats in memory
    parameter integer DEPTH = 16,
    // 1: the sender sees to it that s_valid finds s_ready = 1; saves the logic between them
    parameter integer ROOM_KNOWN = 0
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

  // banks of 16 words, the smallest memory of LUTs, that take turns: pointers run round by themselves, nothing is
  // compared. Each bank is read with a pointer of its own: short ways.
  localparam integer BANKS = (DEPTH + 15) / 16;
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam [31:0] LAST = DEPTH - 1;
  localparam [31:0] FULL = DEPTH;
  localparam [31:0] ONE = 1;

  generate
    if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
      cchip_error_fifo_WIDTH_or_DEPTH_below_1 u_error ();
    end
  endgenerate

  reg [BANKS-1:0] write_bank_q, read_bank_q;  // one-hot
  reg [3:0] write_q;  // word, of all banks
  reg [COUNT_W-1:0] count_q;  // beats in memory
  reg ready_q, some_q;  // count_q < DEPTH, >= 1
  wire room;  // in the skid buffer

  assign s_ready = ready_q;

  wire push = s_valid & (ready_q | ROOM_KNOWN != 0);
  wire take = some_q & room;

  // ---- memory
  wire [WIDTH*BANKS-1:0] words;
  genvar b;
  generate
    for (b = 0; b < BANKS; b = b + 1) begin : gen_bank
      (* ram_style = "distributed" *)
      reg [WIDTH-1:0] mem [0:15];
      reg [3:0] read_q;
      always @(posedge clk) begin
        if (push & write_bank_q[b]) mem[write_q] <= s_data;
        if (rst) read_q <= 4'd0;
        else if (take & read_bank_q[b]) read_q <= read_q + 4'd1;
      end
      assign words[WIDTH*b+:WIDTH] = mem[read_q];
    end
  endgenerate

  function [WIDTH-1:0] choose(input [WIDTH*BANKS-1:0] from, input [BANKS-1:0] bank);
    integer j;
    begin
      choose = from[0+:WIDTH];
      for (j = 1; j < BANKS; j = j + 1) if (bank[j]) choose = from[WIDTH*j+:WIDTH];
    end
  endfunction
  wire [WIDTH-1:0] word = choose(words, read_bank_q);

  cchip_skid_buffer #(
      .WIDTH(WIDTH)
  ) u_out (
      .clk    (clk),
      .rst    (rst),
      .s_valid(some_q),
      .s_ready(room),
      .s_data (word),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );

  // the bank after this one
  wire [BANKS-1:0] write_bank_next = (write_bank_q << 1) | (write_bank_q >> (BANKS - 1));
  wire [BANKS-1:0] read_bank_next = (read_bank_q << 1) | (read_bank_q >> (BANKS - 1));

  always @(posedge clk)
    if (rst) begin
      write_q <= 4'd0;
      write_bank_q <= ONE[BANKS-1:0];
      read_bank_q <= ONE[BANKS-1:0];
      count_q <= {COUNT_W{1'b0}};
      ready_q <= 1'b0;
      some_q  <= 1'b0;
    end else begin
      if (push & write_bank_q[BANKS-1]) write_q <= write_q + 4'd1;
      if (push) write_bank_q <= write_bank_next;
      if (take) read_bank_q <= read_bank_next;
      if (push != take) count_q <= count_q + ({COUNT_W{take}} | ONE[COUNT_W-1:0]);  // + 1 or - 1
      ready_q <= push & ~take ? count_q != LAST[COUNT_W-1:0] : take || count_q != FULL[COUNT_W-1:0];
      some_q  <= push | (some_q & ~(room & count_q == ONE[COUNT_W-1:0]));
    end

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_room, ROOM_KNOWN == 0 || !s_valid || ready_q)
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, count_q} <= FULL)
      `CCHIP_ASSERT(a_some, some_q == (count_q != {COUNT_W{1'b0}}))
    end

endmodule
`default_nettype wire
