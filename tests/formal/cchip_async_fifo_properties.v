// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_async_fifo, with both clocks free and each reset at any time: any beat that is taken and not lost in a
// reset leaves once, unchanged and in its place; no beat leaves that was not taken; never more than DEPTH + 1 are inside;
// a beat on offer stays, unless m_rst comes; a pointer changes by one bit of its Gray code, except when its side clears
// it, and then the other side does not run. A step is a sample of the global clock; what an edge has done is judged on
// the step after it.
module cchip_async_fifo_properties #(
    parameter integer WIDTH = 1,
    parameter integer DEPTH = 4
) (
    input wire             s_clk,
    input wire             s_rst,
    input wire             s_valid,
    input wire [WIDTH-1:0] s_data,
    input wire             m_clk,
    input wire             m_rst,
    input wire             m_ready
);
  localparam integer POINTER_W = $clog2(DEPTH) + 1;
  localparam [1:0] CLEAR = 2'b01, RUN = 2'b11;
  localparam [3:0] MOST = DEPTH + 1;

  wire s_ready, m_valid;
  wire [WIDTH-1:0] m_data;
  cchip_async_fifo #(
      .WIDTH (WIDTH),
      .DEPTH (DEPTH),
      .STAGES(2)
  ) dut (
      .s_clk  (s_clk),
      .s_rst  (s_rst),
      .s_valid(s_valid),
      .s_ready(s_ready),
      .s_data (s_data),
      .m_clk  (m_clk),
      .m_rst  (m_rst),
      .m_valid(m_valid),
      .m_ready(m_ready),
      .m_data (m_data)
  );
  // signals of the queue: flattening joins them with these wires
  (* hierconn *) wire [1:0] \dut.s_state ;
  (* hierconn *) wire [1:0] \dut.m_state ;
  (* hierconn *) wire [POINTER_W-1:0] \dut.write_gray_q ;
  (* hierconn *) wire [POINTER_W-1:0] \dut.read_gray_q ;
  wire [1:0] s_state = \dut.s_state ;
  wire [1:0] m_state = \dut.m_state ;
  wire [POINTER_W-1:0] write_gray = \dut.write_gray_q ;
  wire [POINTER_W-1:0] read_gray = \dut.read_gray_q ;

  (* gclk *) reg step;
  (* anyseq *) reg pick;  // track the beat that is taken

  // the step before
  reg started_q = 1'b0;
  reg s_clk_q, m_clk_q, push_q, pop_q, m_rst_q, m_valid_q, m_ready_q;
  reg [WIDTH-1:0] s_data_q, m_data_q;
  reg [1:0] s_state_q, m_state_q;
  reg [POINTER_W-1:0] write_gray_q, read_gray_q;
  always @(posedge step) begin
    started_q <= 1'b1;
    {s_clk_q, m_clk_q} <= {s_clk, m_clk};
    push_q <= s_valid & s_ready;
    pop_q <= m_valid & m_ready;
    {m_rst_q, m_valid_q, m_ready_q} <= {m_rst, m_valid, m_ready};
    {s_data_q, m_data_q} <= {s_data, m_data};
    {s_state_q, m_state_q} <= {s_state, m_state};
    {write_gray_q, read_gray_q} <= {write_gray, read_gray};
  end
  wire s_edge = started_q & s_clk & ~s_clk_q;
  wire m_edge = started_q & m_clk & ~m_clk_q;
  wire push = s_edge & push_q;
  wire pop = m_edge & pop_q;
  wire m_left = started_q && m_state_q == RUN && m_state != RUN;
  wire s_cleared = started_q && s_state_q != CLEAR && s_state == CLEAR;
  wire m_cleared = started_q && m_state_q != CLEAR && m_state == CLEAR;
  wire lost = m_edge & m_rst_q & m_valid_q & ~m_ready_q;  // the beat on offer

  // what is inside, and one of the beats
  reg [3:0] count_q = 4'd0;
  reg broken_q = 1'b1;  // the receiver has left its run: what is pushed until the sender is clear is lost
  reg tracked_q = 1'b0;
  reg [3:0] ahead_q;
  reg [WIDTH-1:0] word_q;
  wire leaves = pop | lost;
  wire [3:0] left = count_q - {3'd0, leaves};
  wire hit = leaves && tracked_q && ahead_q == 4'd0;
  wire [3:0] ahead = ahead_q - {3'd0, leaves};
  always @(posedge step) begin
    ahead_q <= ahead;
    if (m_left) begin
      broken_q  <= 1'b1;
      count_q   <= {3'd0, m_valid};
      tracked_q <= tracked_q && !hit && ahead == 4'd0 && m_valid;
    end else begin
      if (s_cleared) broken_q <= 1'b0;
      count_q   <= left + {3'd0, push & ~broken_q};
      tracked_q <= tracked_q & ~hit;
      if (push && !broken_q && !tracked_q && pick) begin
        tracked_q <= 1'b1;
        ahead_q   <= left;
        word_q    <= s_data_q;
      end
    end
  end

  wire [POINTER_W-1:0] write_change = write_gray ^ write_gray_q;
  wire [POINTER_W-1:0] read_change = read_gray ^ read_gray_q;
`ifdef INVARIANT
  // What holds on every step, so that the beats are proved for all time. The .sby file joins the wires with `keep` to the
  // queue's own signals; the ^ keeps a cell between, so that only they are joined. Written for DEPTH 4.
  (* keep *) wire [POINTER_W-1:0] write;
  (* keep *) wire [POINTER_W-1:0] read;
  (* keep *) wire [2*POINTER_W-1:0] s_pointers;
  wire [5:0] s_pointer_view = s_pointers ^ 6'd0;
  (* keep *) wire [2*POINTER_W-1:0] m_pointers;
  wire [5:0] m_pointer_view = m_pointers ^ 6'd0;
  (* keep *) wire [3:0] s_states;
  wire [3:0] s_state_view = s_states ^ 4'd0;
  (* keep *) wire [3:0] m_states;
  wire [3:0] m_state_view = m_states ^ 4'd0;
  (* keep *) wire [DEPTH*WIDTH-1:0] words;  // of the memory: cchip_async_fifo.sby

  function [POINTER_W-1:0] binary(input [POINTER_W-1:0] code);
    binary = {code[2], code[2] ^ code[1], code[2] ^ code[1] ^ code[0]};
  endfunction
  function [4:0] distance(input [POINTER_W-1:0] from, input [POINTER_W-1:0] to);
    reg [POINTER_W-1:0] d;
    begin
      d = to - from;
      distance = {2'b00, d};
    end
  endfunction
  localparam [4:0] FULL = DEPTH;
  localparam [1:0] STOP = 2'b00, LEAVE = 2'b10;
  // a pointer, and as its two flip-flops on the other side show it
  wire [POINTER_W-1:0] w = binary(write_gray), r = binary(read_gray);
  wire [POINTER_W-1:0] w_0 = binary(m_pointer_view[0+:POINTER_W]), w_1 = binary(m_pointer_view[POINTER_W+:POINTER_W]);
  wire [POINTER_W-1:0] r_0 = binary(s_pointer_view[0+:POINTER_W]), r_1 = binary(s_pointer_view[POINTER_W+:POINTER_W]);
  wire [1:0] s_0 = m_state_view[1:0], s_1 = m_state_view[3:2], m_0 = s_state_view[1:0], m_1 = s_state_view[3:2];
  // the registers above after this step
  wire [3:0] count_d = m_left ? {3'd0, m_valid} : left + {3'd0, push & ~broken_q};
  wire broken_d = m_left | (broken_q & ~s_cleared);
  wire taken = !m_left && push && !broken_q && !tracked_q && pick;
  wire tracked_d = m_left ? tracked_q && !hit && ahead == 4'd0 && m_valid : (tracked_q & ~hit) | taken;
  wire [3:0] ahead_d = taken ? left : ahead;
  wire [WIDTH-1:0] word_d = taken ? s_data_q : word_q;
  wire first = ahead_d == 4'd0 && m_valid;
  wire [1:0] place = r[1:0] + ahead_d[1:0] - {1'b0, m_valid};
  always @(posedge step)
    if (started_q) begin
      if (s_state != STOP) i_write: assert (w == write);
      if (m_state != STOP) i_read: assert (r == read);
      if (s_state == CLEAR) i_write_0: assert (write == 0 && write_gray == 0);
      if (m_state == CLEAR) i_read_0: assert (read == 0 && read_gray == 0);
      if (s_0 == CLEAR) i_w_0: assert (w_0 == 0);
      if (s_1 == CLEAR) i_w_1: assert (w_1 == 0);
      if (m_0 == CLEAR) i_r_0: assert (r_0 == 0);
      if (m_1 == CLEAR) i_r_1: assert (r_1 == 0);
      // in their order, and together no longer than the memory
      if (m_state[1] || (m_state == CLEAR && s_1 != STOP))
        i_m_order: assert (distance(r, w_1) + distance(w_1, w_0) + distance(w_0, w) <= FULL);
      if (m_state == CLEAR && s_0 != STOP) i_m_order_0: assert (distance(r, w_0) + distance(w_0, w) <= FULL);
      if (m_state == CLEAR && s_state != STOP) i_m_order_now: assert (distance(r, w) <= FULL);
      if (s_state[1] || (s_state == CLEAR && m_1 != STOP))
        i_s_order: assert (distance(r_1, r_0) + distance(r_0, r) + distance(r, w) <= FULL);
      if (s_state == CLEAR && m_0 != STOP) i_s_order_0: assert (distance(r_0, r) + distance(r, w) <= FULL);
      if (s_state == CLEAR && m_state[1]) i_s_first: assert (r == 0 && w_0 == 0 && w_1 == 0);
      if (m_state == CLEAR && s_state[1]) i_m_first: assert (r_0 == 0 && r_1 == 0);
      if (s_ready) i_ready: assert (s_state[1] && distance(r_1, w) < FULL);
      // what is inside
      if (m_state == LEAVE) i_left: assert (broken_d);
      if (m_state == RUN) i_runs: assert (!broken_d);
      if (!broken_d && m_state == STOP) i_stop: assert (w == 0 && s_state == CLEAR);
      if (broken_d || m_state == STOP) i_none: assert (count_d == {3'd0, m_valid});
      else i_count: assert (count_d == distance(r, w) + {3'd0, m_valid});
      if (tracked_d) begin
        i_ahead: assert (ahead_d < count_d);
        i_word: assert (word_d == (first ? m_data : words[place*WIDTH+:WIDTH]));
      end
    end
`endif

`ifdef COVER
  // reached: a beat leaves after the sender was reset in the midst of its run
  reg reset_q = 1'b0, again_q = 1'b0;
  always @(posedge step) begin
    if (s_state_q == RUN && s_state != RUN && count_q != 4'd0) reset_q <= 1'b1;
    if (reset_q && s_state == RUN && m_state == RUN && push) again_q <= 1'b1;
    again: assert (!again_q);
  end
`else
  always @(posedge step)
    if (started_q) begin
      if (pop) begin
        beat: assert (count_q != 4'd0);
        if (tracked_q && ahead_q == 4'd0) data: assert (m_data_q == word_q);
      end
      room: assert (count_q <= MOST);
      if (m_edge && m_valid_q && !m_ready_q && !m_rst_q) stays: assert (m_valid && m_data == m_data_q);
      if (!m_edge) only_on_m_clk: assert (m_valid == m_valid_q && m_data == m_data_q);
      write_gray_code: assert (s_cleared || (write_change & (write_change - 1'b1)) == 0);
      read_gray_code: assert (m_cleared || (read_change & (read_change - 1'b1)) == 0);
      // no pointer moves to 0 under a side that looks at it
      if (s_cleared) s_alone: assert (!m_state_q[1]);
      if (m_cleared) m_alone: assert (!s_state_q[1]);
    end
`endif
endmodule
`default_nettype wire
