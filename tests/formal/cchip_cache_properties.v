// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// Proved of cchip_cache, for some clocks after reset (cchip_cache.sby; docs/develop/formal.md says how far):
//   main   each request is answered at most once, and nothing else is; an answer with CCHIP_READ_OK carries data that memory
//          gave for the line of that request; a code other than that comes only after memory has given one; no second read of a
//          line is sent while one is in flight; a slot is not used again while its response is outstanding; a locked line that has
//          come is never read again, so it was not evicted. The assertions of cchip_cache and cchip_cache_fill hold, among them
//          that no two ways hold one line and that the frame of a line stays its own until all who wait for it are served
//   stale  an answer after an invalidation is over is not of data that memory held before its command
//   live   when no request is added, memory answers and nothing is invalidated, every request is answered
// Assumed, what the clients and cchip_axi_read keep: a place is asked for again only after its answer; memory answers the
// reads of its slots, once each; a slot is outstanding from its read to its answer and, after a code TIMEOUT or OWED, as long as
// memory likes.
// One line, any, is followed: bit 0 of its data, in memory, is 1, and that of all other lines is 0. Commands come only in the
// task stale. Requests without a bound take too long, so each task has few, which this says:
//   SET_BITS              all lines are of 2^SET_BITS sets
//   LAST_ASK, LAST_ASK_1  requests of port 0, of port 1, come before this clock; the first may come on clock 9
//   EVERY, ALONE          on every N-th clock only; of one port at a time
//   QUICK                 memory answers on the first or second clock after the read, with CCHIP_READ_OK; three lines, and the
//                         followed one is the first: the cache only tells whether lines are equal
//   LIVE, END             from LAST_ASK on memory answers a read on every clock; all is answered by clock END
`ifndef MISSES
`define MISSES 2
`endif
`ifndef SET_BITS
`define SET_BITS 0
`endif
`ifndef LAST_ASK
`define LAST_ASK 200
`endif
`ifndef LAST_ASK_1
`define LAST_ASK_1 `LAST_ASK
`endif
`ifndef EVERY
`define EVERY 1
`endif
`ifndef END
`define END 200
`endif
module cchip_cache_properties #(
    parameter integer PLACES = 2,
    parameter integer MISSES = `MISSES,
    parameter integer LINE_W = 5
) (
    input wire                      clk,
    input wire [               1:0] s_valid,
    input wire [2*$clog2(PLACES)-1:0] s_place,
    input wire [      2*LINE_W-1:0] s_line,
    input wire                      invalidate_valid,
    input wire [        LINE_W-1:0] invalidate_first,
    input wire [        LINE_W-1:0] invalidate_last,
    input wire                      s_read_valid,
    input wire [$clog2(MISSES)-1:0] s_read_slot,
    input wire [`CCHIP_READ_CODE_W-1:0] s_read_code,
    input wire                      s_read_data,
    input wire [        MISSES-1:0] stays,      // this slot's response stays outstanding after its answer
    input wire                      writes      // the followed line changes in memory (task stale)
);
  localparam integer PLACE_W = $clog2(PLACES);
  localparam integer SLOT_W = $clog2(MISSES);
  localparam integer CODE_W = `CCHIP_READ_CODE_W;
  localparam integer SET_W = 3;

  reg [7:0] clock_q = 8'd0;
  always @(posedge clk) if (clock_q != 8'd255) clock_q <= clock_q + 8'd1;
  wire rst = clock_q == 8'd0;

  (* anyconst *) wire [LINE_W-1:0] followed;
  (* anyconst *) wire locked;
  wire [1:0] m_valid;
  wire [2*PLACE_W-1:0] m_place;
  wire [2*CODE_W-1:0] m_code;
  wire [511:0] m_data;
  wire m_read_valid, invalidate_ready;
  wire [SLOT_W-1:0] m_read_slot;
  wire [57:0] m_read_line;
  wire [1:0] count_hit, count_miss, count_wait, count_again;
  reg [MISSES-1:0] open_read_q, of_followed_q, owed_q;  // of each slot
  cchip_cache #(
      .CACHE_KB(1),
      .PLACES  (PLACES),
      .MISSES  (MISSES),
      .LINE_W  (LINE_W),
      .LOCKS   (1),
      .DATA_W  (512)
  ) dut (
      .clk               (clk),
      .rst               (rst),
      .s_valid           (s_valid),
      .s_place           (s_place),
      .s_line            (s_line),
      .m_valid           (m_valid),
      .m_place           (m_place),
      .m_code            (m_code),
      .m_data            (m_data),
      .lock_first        (locked ? followed : {{LINE_W - 1{1'b0}}, 1'b1}),
      .lock_last         (locked ? followed : {LINE_W{1'b0}}),
      .invalidate_valid  (invalidate_valid),
      .invalidate_ready  (invalidate_ready),
      .invalidate_first  (invalidate_first),
      .invalidate_last   (invalidate_last),
      .m_read_valid      (m_read_valid),
      .m_read_slot       (m_read_slot),
      .m_read_line       (m_read_line),
      .s_read_valid      (s_read_valid),
      .s_read_slot       (s_read_slot),
      .s_read_beat       (3'd0),
      .s_read_last       (1'b1),
      .s_read_code       (s_read_code),
      .s_read_data       ({255'd0, s_read_data, 255'd0, s_read_data}),  // bit 0 of each half
      .s_read_outstanding(open_read_q | owed_q),
      .count_hit         (count_hit),
      .count_miss        (count_miss),
      .count_wait        (count_wait),
      .count_again       (count_again)
  );

  // ---- requests
  reg [2*PLACES-1:0] open_q, wants_followed_q;
  wire [2*PLACES-1:0] asks, answers;
  wire [1:0] asks_followed;
  genvar p, i;
  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_port
      assign asks_followed[p] = s_line[LINE_W*p+:LINE_W] == followed;
      always @* assume (!s_valid[p] || s_line[LINE_W*p+`SET_BITS+:SET_W-`SET_BITS] == 0);
      always @* assume (!s_valid[p] || (clock_q > 8 && clock_q < (p == 0 ? `LAST_ASK : `LAST_ASK_1)));
      always @* assume (!s_valid[p] || clock_q % `EVERY == 9 % `EVERY);
      for (i = 0; i < PLACES; i = i + 1) begin : gen_place
        assign asks[PLACES*p+i] = s_valid[p] && s_place[PLACE_W*p+:PLACE_W] == i;
        assign answers[PLACES*p+i] = m_valid[p] && m_place[PLACE_W*p+:PLACE_W] == i;
        always @* assume (!(asks[PLACES*p+i] && open_q[PLACES*p+i]));
        always @(posedge clk) if (asks[PLACES*p+i]) wants_followed_q[PLACES*p+i] <= asks_followed[p];
      end
    end
  endgenerate
`ifdef QUICK
  always @* assume (followed == 0);
  always @* assume (!s_valid[0] || s_line[SET_W+:LINE_W-SET_W] != 3);
  always @* assume (!s_valid[1] || s_line[LINE_W+SET_W+:LINE_W-SET_W] != 3);
`endif
`ifdef ALONE
  always @* assume (!(&s_valid));
`endif
  always @* assume (followed[`SET_BITS+:SET_W-`SET_BITS] == 0);
  always @(posedge clk) open_q <= rst ? 0 : (open_q | asks) & ~answers;

  // ---- memory
  reg failed_q, invalidated_q, loaded_q;  // a read has failed, a command was taken, the followed line has come
  reg [MISSES-1:0] open_read_q2, open_read_q3;
  always @(posedge clk) {open_read_q3, open_read_q2} <= rst ? 0 : {open_read_q2, open_read_q};
  wire comes_followed = of_followed_q[s_read_slot];
  always @* begin
    assume (!s_read_valid || open_read_q[s_read_slot]);
`ifndef STALE
    assume (!s_read_valid || s_read_data == comes_followed);
`endif
`ifdef QUICK
    assume (!s_read_valid || s_read_code == `CCHIP_READ_OK);
    assume ((open_read_q & open_read_q2 & open_read_q3) == 0);
`endif
`ifdef LIVE
    assume (clock_q < `LAST_ASK || s_read_valid || open_read_q == 0);
`endif
`ifdef STALE
    assume (clock_q > 9 || !invalidate_valid);
`else
    assume (!invalidate_valid);
`endif
  end
  wire [MISSES-1:0] one = {{MISSES - 1{1'b0}}, 1'b1};
  wire stops = s_read_code == `CCHIP_READ_TIMEOUT || s_read_code == `CCHIP_READ_OWED;
  always @(posedge clk) begin
    if (m_read_valid) of_followed_q[m_read_slot] <= m_read_line[LINE_W-1:0] == followed;
    open_read_q <= (open_read_q | (m_read_valid ? one << m_read_slot : 0)) & ~(s_read_valid ? one << s_read_slot : 0);
    owed_q <= (owed_q & stays) | (s_read_valid && stops ? one << s_read_slot : 0);
    failed_q <= failed_q | (s_read_valid && s_read_code != `CCHIP_READ_OK);
    invalidated_q <= invalidated_q | (invalidate_valid && invalidate_ready);
    loaded_q <= loaded_q | (s_read_valid && comes_followed && s_read_code == `CCHIP_READ_OK);
    if (rst) begin
      open_read_q <= 0;
      owed_q <= 0;
      {failed_q, invalidated_q, loaded_q} <= 0;
    end
  end

  // ---- task stale: the line as memory holds it; its value when the command that is at work was taken
  reg now_q, commanded_q, promised_q;
  wire covers = invalidate_first <= followed && followed <= invalidate_last;
  always @(posedge clk) begin
    now_q <= now_q | writes;
    if (invalidate_ready && invalidate_valid && covers) commanded_q <= now_q;
    if (invalidate_ready) promised_q <= commanded_q;
    if (rst) {now_q, commanded_q, promised_q} <= 3'd0;
  end
`ifdef STALE
  always @* assume (!s_read_valid || !comes_followed || s_read_data == now_q);
  wire promised = invalidate_ready ? commanded_q : promised_q;
`endif

  generate
    for (p = 0; p < 2; p = p + 1) begin : gen_answer
      wire [CODE_W-1:0] code = m_code[CODE_W*p+:CODE_W];
      wire of_followed = wants_followed_q[{p[0], m_place[PLACE_W*p+:PLACE_W]}];
      reg upper_q, upper_of_followed_q, upper_promised_q;  // the upper half comes, of such an answer
`ifdef STALE
      wire is_promised = promised;
`else
      wire is_promised = 1'b0;
`endif
      always @(posedge clk) begin
        upper_q <= ~rst & m_valid[p] & (code == `CCHIP_READ_OK);
        upper_of_followed_q <= of_followed;
        upper_promised_q <= is_promised;
        if (!rst) begin
          if (m_valid[p]) begin
            assert (open_q[{p[0], m_place[PLACE_W*p+:PLACE_W]}]);
            assert (code == `CCHIP_READ_OK || failed_q);
            assert (!upper_q);
`ifdef STALE
            assert (code != `CCHIP_READ_OK || !of_followed || !promised || m_data[256*p]);
`else
            assert (code != `CCHIP_READ_OK || m_data[256*p] == of_followed);
`endif
          end
`ifdef STALE
          if (upper_q) assert (!upper_of_followed_q || !upper_promised_q || m_data[256*p]);
`else
          if (upper_q) assert (m_data[256*p] == upper_of_followed_q);
`endif
        end
      end
    end
  endgenerate
  wire reads_followed = m_read_valid && m_read_line[LINE_W-1:0] == followed;
  always @(posedge clk)
    if (!rst) begin
      if (m_read_valid) assert (!open_read_q[m_read_slot] && !owed_q[m_read_slot]);
      if (reads_followed && !invalidated_q) begin
        assert ((open_read_q & of_followed_q) == 0);
        assert (!(locked && loaded_q));
      end
      assert (clock_q < `END || open_q == 0);
    end

`ifdef COVER
  reg read_once_q, evicted_q;
  reg [1:0] waited_q, reads_q;
  reg third_q;  // the followed line was the third that was read
  reg [24:0] came_q, came_followed_q;  // lines that came, 1 clock ago and more
  wire comes = s_read_valid && s_read_code == `CCHIP_READ_OK;
  wire followed_0 = m_valid[0] && m_code[0+:CODE_W] == `CCHIP_READ_OK && wants_followed_q[m_place[0+:PLACE_W]];
  always @(posedge clk) begin
    read_once_q <= ~rst & (read_once_q | reads_followed);
    evicted_q <= ~rst & (evicted_q | (reads_followed && read_once_q && loaded_q && !failed_q && !invalidated_q));
    waited_q <= rst ? 2'd0 : waited_q | count_wait;
    reads_q <= rst ? 2'd0 : reads_q + {1'b0, m_read_valid & ~&reads_q};
    third_q <= ~rst & (third_q | (reads_followed && reads_q == 2'd2));
    came_q <= rst ? 25'd0 : {came_q[23:0], comes};
    came_followed_q <= rst ? 25'd0 : {came_followed_q[23:0], comes && comes_followed};
    if (!rst && clock_q > 9)
      case (`COVER)
        // a request of each port has waited, and both ports answer with the line; a locked line is hit; the line is evicted,
        // read again and answered; every slot is lost and a request is refused; an answer after an invalidation; an answer
        // that waits for its turn, 20 clocks after its line at the earliest, is kept for two clocks by each of two lines that
        // come; the third line that is read is answered
        0: assert (!(&m_valid && m_code == 0 && &waited_q && m_data[0] && m_data[256]));
        1: assert (!(count_hit[0] && locked && loaded_q && !invalidated_q));
        2: assert (!(followed_0 && evicted_q));
        3: assert (!(m_valid[0] && m_code[0+:CODE_W] == `CCHIP_READ_OWED && &owed_q));
        4: assert (!(m_valid[1] && invalidated_q && invalidate_ready && commanded_q && m_code[CODE_W+:CODE_W] == `CCHIP_READ_OK));
        5: assert (!(followed_0 && came_followed_q[24] && came_q[13] && came_q[11] && count_hit == 0));
        6: assert (!(followed_0 && third_q));
      endcase
  end
`endif
  wire unused = &{1'b0, count_miss, count_again, writes};
endmodule
`default_nettype wire
