// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_async_fifo: first-in first-out queue from one clock to another, of any ratio and phase.
//   latency      from the edge of s_clk that takes a beat: m_valid is 1 after STAGES + 1 or
//                STAGES + 2 edges of m_clk. Room comes back after STAGES + 1 or STAGES + 2 edges of
//                s_clk
//   throughput   one beat per clock of the slower side, DEPTH >= 4 + 2 STAGES at equal clocks
//   capacity     DEPTH + 1 beats
//   crossing     Gray pointers and the state of each side, through cchip_synchroniser; the memory
//                is read on m_clk at words that have been written since STAGES clocks or more
//   reset        either side may be reset, alone or with the other, for one clock or more: both
//                sides empty themselves (cchip_crossing_state) and s_ready and m_valid stay 0 until
//                that is done. Beats inside are lost; none is repeated or made up. The beat that is
//                on offer stays if only s_rst comes: m_valid falls with m_rst alone
//   power-up     empty, by initial values; where a device has none, both resets must be 1 together
//                for STAGES + 2 clocks of each side
//   clocks       both must run for a reset to end; a stopped clock stops the queue, without harm
module cchip_async_fifo #(
    parameter integer WIDTH = 8,   // width of the payload (bit); legal: >= 1
    parameter integer DEPTH = 16,  // words of the memory (beat); legal: 4, 8, 16 ... 4096
    parameter integer STAGES = 2   // flip-flops of each synchroniser; legal: 2..4
) (
    // ---- input stream, on s_clk
    input  wire             s_clk,    // clock of the sender, rising edge
    input  wire             s_rst,    // synchronous reset of the sender's side, active high
    input  wire             s_valid,  // the sender offers s_data
    output wire             s_ready,  // there is room; the beat is taken if s_valid = 1 as well
    input  wire [WIDTH-1:0] s_data,   // payload in
    // ---- output stream, on m_clk
    input  wire             m_clk,    // clock of the receiver, rising edge
    input  wire             m_rst,    // synchronous reset of the receiver's side, active high
    output wire             m_valid,  // m_data is the oldest beat
    input  wire             m_ready,  // the receiver takes the beat if m_valid = 1 as well
    // oldest beat, does not change while m_valid = 1 and m_ready = 0; undefined while m_valid = 0
    output wire [WIDTH-1:0] m_data
);

  localparam integer ADDR_W = $clog2(DEPTH);
  localparam [ADDR_W:0] ONE = 1;

  `CCHIP_REFUSE(WIDTH < 1 || STAGES < 2 || STAGES > 4,
                cchip_error_async_fifo_WIDTH_below_1_or_STAGES_not_2_to_4)
  `CCHIP_REFUSE(DEPTH < 4 || DEPTH > 4096 || (DEPTH & (DEPTH - 1)) != 0,
                cchip_error_async_fifo_DEPTH_must_be_a_power_of_two_4_to_4096)

  function [ADDR_W:0] gray(input [ADDR_W:0] binary);
    gray = binary ^ (binary >> 1);
  endfunction

  // ---- state of the sides
  wire [1:0] s_state, m_state, s_seen_state, m_seen_state;
  wire s_run, m_run, s_clear, m_clear;
  cchip_synchroniser #(.WIDTH(2), .STAGES(STAGES)) u_s_state (
      .clk(s_clk),
      .d  (m_state),
      .q  (s_seen_state)
  );
  cchip_synchroniser #(.WIDTH(2), .STAGES(STAGES)) u_m_state (
      .clk(m_clk),
      .d  (s_state),
      .q  (m_seen_state)
  );
  cchip_crossing_state u_s_side (
      .clk  (s_clk),
      .rst  (s_rst),
      .other(s_seen_state),
      .state(s_state),
      .run  (s_run),
      .clear(s_clear)
  );
  cchip_crossing_state u_m_side (
      .clk  (m_clk),
      .rst  (m_rst),
      .other(m_seen_state),
      .state(m_state),
      .run  (m_run),
      .clear(m_clear)
  );

  // ---- pointers: one bit more than an address, so that full and empty differ. They change by
  //      more than a bit only in a reset, while the other side does not look
  reg [ADDR_W:0] write_q, write_gray_q, read_q, read_gray_q;
  wire [ADDR_W:0] s_seen_gray, m_seen_gray;
  cchip_synchroniser #(.WIDTH(ADDR_W + 1), .STAGES(STAGES)) u_s_pointer (
      .clk(s_clk),
      .d  (read_gray_q),
      .q  (s_seen_gray)
  );
  cchip_synchroniser #(.WIDTH(ADDR_W + 1), .STAGES(STAGES)) u_m_pointer (
      .clk(m_clk),
      .d  (write_gray_q),
      .q  (m_seen_gray)
  );

  // ---- sender
  `CCHIP_LUT_RAM
  reg [WIDTH-1:0] mem[0:DEPTH-1];
  reg ready_q;
  initial ready_q = 1'b0;
  wire push = s_valid & ready_q;
  wire [ADDR_W:0] write_d = push ? write_q + ONE : write_q;
  wire [ADDR_W:0] write_gray_d = gray(write_d);
  // full: the pointers differ in the two highest bits of their Gray codes only
  wire full = write_gray_d == (s_seen_gray ^ {2'b11, {ADDR_W - 1{1'b0}}});

  always @(posedge s_clk) begin
    if (push) mem[write_q[ADDR_W-1:0]] <= s_data;
    write_q      <= s_clear ? {ADDR_W + 1{1'b0}} : write_d;
    write_gray_q <= s_clear ? {ADDR_W + 1{1'b0}} : write_gray_d;
    ready_q      <= s_run & ~full;
  end
  assign s_ready = ready_q;

  // ---- receiver
  reg valid_q;
  initial valid_q = 1'b0;
  reg [WIDTH-1:0] data_q;
  wire load = m_run && read_gray_q != m_seen_gray && (m_ready || !valid_q);
  wire [ADDR_W:0] read_d = load ? read_q + ONE : read_q;

  always @(posedge m_clk) begin
    if (load) data_q <= mem[read_q[ADDR_W-1:0]];
    read_q      <= m_clear ? {ADDR_W + 1{1'b0}} : read_d;
    read_gray_q <= m_clear ? {ADDR_W + 1{1'b0}} : gray(read_d);
    valid_q     <= ~m_rst & (load | (valid_q & ~m_ready));
  end
  assign m_valid = valid_q;
  assign m_data  = data_q;

endmodule
`default_nettype wire
