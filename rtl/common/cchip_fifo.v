// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_fifo: first-in first-out stream buffer in distributed memory.
//   latency      1 clock (m_valid on the clock after the push)
//   throughput   one beat per clock; with DEPTH = 1 one beat per two clocks
//   capacity     DEPTH beats, any DEPTH >= 1
//   cuts         s_ready and m_valid are flip-flops; m_data is an asynchronous memory read
//   reset        empties the FIFO; s_ready and m_valid are 0 while rst is 1
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

  localparam integer PTR_W = DEPTH > 1 ? $clog2(DEPTH) : 1;
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  localparam [31:0] LAST = DEPTH - 1;
  localparam [31:0] FULL = DEPTH;

  generate
    if (WIDTH < 1 || DEPTH < 1) begin : gen_illegal
      cchip_error_fifo_WIDTH_or_DEPTH_below_1 u_error ();
    end
  endgenerate

  (* ram_style = "distributed" *)
  reg  [  WIDTH-1:0] mem [0:DEPTH-1];
  reg  [  PTR_W-1:0] write_q, read_q;
  reg  [COUNT_W-1:0] count_q;
  reg                ready_q, valid_q;

  assign s_ready = ready_q;
  assign m_valid = valid_q;
  assign m_data  = mem[read_q];

  wire push = s_valid & ready_q;
  wire pop = valid_q & m_ready;
  wire [COUNT_W-1:0] count_d = push == pop ? count_q
                             : push ? count_q + {{COUNT_W - 1{1'b0}}, 1'b1}
                                    : count_q - {{COUNT_W - 1{1'b0}}, 1'b1};

  function [PTR_W-1:0] next(input [PTR_W-1:0] pointer);
    next = pointer == LAST[PTR_W-1:0] ? {PTR_W{1'b0}} : pointer + {{PTR_W - 1{1'b0}}, 1'b1};
  endfunction

  always @(posedge clk) begin
    if (push) mem[write_q] <= s_data;
    if (rst) begin
      write_q <= {PTR_W{1'b0}};
      read_q  <= {PTR_W{1'b0}};
      count_q <= {COUNT_W{1'b0}};
      ready_q <= 1'b0;
      valid_q <= 1'b0;
    end else begin
      if (push) write_q <= next(write_q);
      if (pop) read_q <= next(read_q);
      count_q <= count_d;
      ready_q <= count_d != FULL[COUNT_W-1:0];
      valid_q <= count_d != {COUNT_W{1'b0}};
    end
  end

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, count_q} <= FULL)
      `CCHIP_ASSERT(a_valid, valid_q == (count_q != {COUNT_W{1'b0}}))
    end

endmodule
`default_nettype wire
