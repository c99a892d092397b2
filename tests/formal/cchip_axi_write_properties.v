// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_axi_write, for any behaviour of memory (also against the rules of the bus) and any offers of clients, with a
// `limit` that changes on any clock:
//   addresses and data are stable until taken; a burst lies within a line, has as many beats as its address says, wlast on
//   the last one only; memory never has more than OUTSTANDING writes to answer; addresses and data go in the same order;
//   every write is answered once, after its last beat, in the order of its client's writes: OK or BUS two clocks after a
//   response that came for it, when its address and all its data, with the strobes of the client, had been taken; TIMEOUT
//   without such a response; OWED only for a write of which memory has seen nothing and never sees anything; and while there
//   are writes to answer and `limit` stays 1 an answer comes within BOUND clocks.
// One write, any: the solver chooses the client and the write that is followed. It marks its address and its strobes.
module cchip_axi_write_properties #(
    parameter integer CLIENTS     = 2,
    parameter integer DATA_W      = 256,
    parameter integer OUTSTANDING = 2
) (
    input wire                                       clk,
    input wire                                       rst,
    input wire [                        CLIENTS-1:0] s_valid,
    input wire [                        CLIENTS-1:0] s_last,
    input wire [CLIENTS*(64-$clog2(DATA_W/8))-1:0] s_address,
    input wire [                 CLIENTS*DATA_W-1:0] s_data,
    input wire [               CLIENTS*DATA_W/8-1:0] s_strb,
    input wire                                       m_axi_awready,
    input wire                                       m_axi_wready,
    input wire                                       m_axi_bvalid,
    input wire                                       m_axi_bid,
    input wire [                                1:0] m_axi_bresp
);
  localparam integer STRB_W = DATA_W / 8;
  localparam [2:0] BEAT = $clog2(STRB_W);
  localparam integer ADDRESS_W = 64 - $clog2(STRB_W);
  localparam integer PLACE = $clog2(STRB_W);  // bit of an address: second half of the line
  // changes on any clock; 0, which means the default, is a limit that no trace reaches
  (* anyseq *) wire [1:0] any_limit;
  wire [31:0] limit = any_limit;
  localparam [4:0] BOUND = 5'd9;

  wire [CLIENTS-1:0] s_ready, m_valid;
  wire [`CCHIP_WRITE_CODE_W-1:0] m_code;
  wire any_outstanding, m_axi_awvalid, m_axi_wvalid, m_axi_wlast, m_axi_bready, m_axi_awid;
  wire [63:0] m_axi_awaddr;
  wire [7:0] m_axi_awlen;
  wire [DATA_W-1:0] m_axi_wdata;
  wire [STRB_W-1:0] m_axi_wstrb;
  cchip_axi_write #(
      .CLIENTS    (CLIENTS),
      .DATA_W     (DATA_W),
      .OUTSTANDING(OUTSTANDING)
  ) dut (
      .clk          (clk),
      .rst          (rst),
      .limit        (limit),
      .s_valid      (s_valid),
      .s_ready      (s_ready),
      .s_last       (s_last),
      .s_address    (s_address),
      .s_data       (s_data),
      .s_strb       (s_strb),
      .m_valid      (m_valid),
      .m_code       (m_code),
      .any_outstanding(any_outstanding),
      .m_axi_awvalid(m_axi_awvalid),
      .m_axi_awready(m_axi_awready),
      .m_axi_awid   (m_axi_awid),
      .m_axi_awaddr (m_axi_awaddr),
      .m_axi_awlen  (m_axi_awlen),
      .m_axi_wvalid (m_axi_wvalid),
      .m_axi_wready (m_axi_wready),
      .m_axi_wdata  (m_axi_wdata),
      .m_axi_wstrb  (m_axi_wstrb),
      .m_axi_wlast  (m_axi_wlast),
      .m_axi_bvalid (m_axi_bvalid),
      .m_axi_bready (m_axi_bready),
      .m_axi_bid    (m_axi_bid),
      .m_axi_bresp  (m_axi_bresp)
  );

  wire memory_ok;
  cchip_axi_rules #(
      .DATA_W  (DATA_W),
      .READS   (0),
      .WRITES  (OUTSTANDING),
      .BOUNDARY(64),
      .MEMORY  (0)
  ) rules (
      .clk          (clk),
      .rst          (rst),
      .memory_ok    (memory_ok),
      .m_axi_awvalid(m_axi_awvalid),
      .m_axi_awready(m_axi_awready),
      .m_axi_awid   (m_axi_awid),
      .m_axi_awaddr (m_axi_awaddr),
      .m_axi_awlen  (m_axi_awlen),
      .m_axi_awsize (BEAT),
      .m_axi_awburst(2'b01),
      .m_axi_awcache(4'd0),
      .m_axi_awprot (3'd0),
      .m_axi_wvalid (m_axi_wvalid),
      .m_axi_wready (m_axi_wready),
      .m_axi_wdata  (m_axi_wdata),
      .m_axi_wstrb  (m_axi_wstrb),
      .m_axi_wlast  (m_axi_wlast),
      .m_axi_bvalid (m_axi_bvalid),
      .m_axi_bready (m_axi_bready),
      .m_axi_bid    (m_axi_bid),
      .m_axi_bresp  (m_axi_bresp)
  );

  reg started_q = 1'b0;
  reg rst_q = 1'b1;
  always @(posedge clk) begin
    started_q <= 1'b1;
    rst_q <= rst;
  end

  // ---- clients: where each is in its write, and how many wait for their answer. A line has two beats
  localparam integer CHOSEN_W = CLIENTS < 2 ? 1 : $clog2(CLIENTS);
  (* anyconst *) reg [CHOSEN_W-1:0] any_client;
  wire [CHOSEN_W-1:0] chosen = CLIENTS < 2 ? 1'b0 : any_client;
  (* anyseq *) wire mark;  // if a write of that client begins now, it is the one that is followed
  reg marked_q;  // it has begun
  reg [CLIENTS-1:0] begun_q, second_q, mine_q;  // in a write; at the line's second beat; in the one that is followed
  reg [5*CLIENTS-1:0] open_q;
  wire [CLIENTS-1:0] takes, ends, mine;
  wire [ADDRESS_W*CLIENTS-1:0] addresses = s_address;
  genvar c;
  generate
    for (c = 0; c < CLIENTS; c = c + 1) begin : gen_client
      assign takes[c] = s_valid[c] & s_ready[c];
      assign ends[c] = s_last[c] | (begun_q[c] ? second_q[c] : addresses[ADDRESS_W*c]);
      assign mine[c] = begun_q[c] ? mine_q[c] : (mark && !marked_q && chosen == c);
      always @(posedge clk) begin
        if (takes[c]) begin
          begun_q[c]  <= ~ends[c];
          second_q[c] <= 1'b1;
          mine_q[c]   <= mine[c];
        end
        open_q[5*c+:5] <= open_q[5*c+:5] + {4'd0, takes[c] & ends[c]} - {4'd0, m_valid[c]};
        if (rst) begin
          begun_q[c] <= 1'b0;
          open_q[5*c+:5] <= 5'd0;
        end
      end
`ifndef COVER
      always @(*) if (started_q && !rst_q && !rst) assert (!m_valid[c] || open_q[5*c+:5] != 0);
`endif
      always @(*) begin
        assume (s_strb[STRB_W*c+STRB_W-1] == mine[c]);
        if (!begun_q[c]) assume (addresses[ADDRESS_W*c+ADDRESS_W-1] == mine[c]);
      end
    end
  endgenerate

  // ---- the write that is followed. One bit of data, of strobes and of the address stands for all
  wire my_beat = takes[chosen] & mine[chosen];
  wire my_end = my_beat & ends[chosen];
  wire my_data = s_data[DATA_W*chosen];
  wire my_strb = s_strb[STRB_W*chosen];
  reg complete_q;  // all its beats were taken
  reg [1:0] beats_q;  // that were taken
  reg [1:0] data_q, strb_q;
  reg place_q;
  reg [4:0] ahead_q;  // answers to earlier writes of its client that come first
  reg answered_q, owed_q;  // it was answered, with OWED
  wire answer = m_valid[chosen] && complete_q && !answered_q && ahead_q == 5'd0;
  wire [4:0] left = open_q[5*chosen+:5] - {4'd0, m_valid[chosen]};

  // ---- the bus: bursts by their number
  wire take_address = m_axi_awvalid & m_axi_awready;
  wire take_data = m_axi_wvalid & m_axi_wready;
  wire take_last = take_data & m_axi_wlast;
  reg [2:0] aw_n, w_n, b_n;  // addresses, bursts and responses so far
  reg [3:0] aw_long, w_long;  // which of them have two beats
  reg w_second;
  wire response = m_axi_bvalid & m_axi_bready & ~m_axi_bid & aw_n != b_n & w_n != b_n;
  wire aw_mine = m_axi_awvalid & m_axi_awaddr[63];
  wire w_mine = m_axi_wvalid & m_axi_wstrb[STRB_W-1];
  reg aw_seen, w_seen;
  reg [2:0] aw_mine_n, w_mine_n;  // number of its burst
  reg [1:0] sent_q;  // its beats that memory has taken
  reg [1:0] came_q, okay_q;  // its response came 1, 2 clocks ago
  wire its_response = response & aw_seen & aw_mine_n == b_n;
  reg late_q;  // it was given up, and then its response came
  // offered and not taken on the last clock
  reg aw_stays, w_stays;
  reg [2:0] aw_was;
  reg [3:0] w_was;
  wire [2:0] aw_is = {m_axi_awaddr[63], m_axi_awaddr[PLACE], m_axi_awlen[0]};
  wire [3:0] w_is = {m_axi_wstrb[STRB_W-1], m_axi_wstrb[0], m_axi_wdata[0], m_axi_wlast};
  // clocks without an answer while there are writes to answer and the limit is 1
  reg [4:0] waits_q;

  always @(posedge clk) begin
    if (my_beat) begin
      data_q[beats_q[0]] <= my_data;
      strb_q[beats_q[0]] <= my_strb;
      if (beats_q == 2'd0) place_q <= addresses[ADDRESS_W*chosen];
    end
    aw_stays <= ~rst & m_axi_awvalid & ~m_axi_awready;
    w_stays  <= ~rst & m_axi_wvalid & ~m_axi_wready;
    aw_was   <= aw_is;
    w_was    <= w_is;
    if (take_address) aw_long[aw_n[1:0]] <= m_axi_awlen[0];
    if (take_last) w_long[w_n[1:0]] <= w_second;
    okay_q <= {okay_q[0], m_axi_bresp == 2'b00};
    if (aw_mine && !aw_seen) aw_mine_n <= aw_n;
    if (w_mine && !w_seen) w_mine_n <= w_n;
    if (rst) begin
      marked_q   <= 1'b0;
      complete_q <= 1'b0;
      beats_q    <= 2'd0;
      answered_q <= 1'b0;
      owed_q     <= 1'b0;
      {aw_n, w_n, b_n} <= 9'd0;
      w_second   <= 1'b0;
      aw_seen    <= 1'b0;
      w_seen     <= 1'b0;
      sent_q     <= 2'd0;
      came_q     <= 2'd0;
      waits_q    <= 5'd0;
      late_q     <= 1'b0;
    end else begin
      marked_q   <= marked_q | my_beat;
      complete_q <= complete_q | my_end;
      beats_q    <= beats_q + {1'd0, my_beat};
      ahead_q    <= my_end ? left : ahead_q - {4'd0, m_valid[chosen] & ahead_q != 5'd0};
      answered_q <= answered_q | answer;
      owed_q     <= owed_q | (answer & m_code == `CCHIP_WRITE_OWED);
      aw_n       <= aw_n + {2'd0, take_address};
      w_n        <= w_n + {2'd0, take_last};
      b_n        <= b_n + {2'd0, response};
      if (take_data) w_second <= ~m_axi_wlast;
      aw_seen    <= aw_seen | aw_mine;
      w_seen     <= w_seen | w_mine;
      sent_q     <= sent_q + {1'd0, take_data & w_mine};
      came_q     <= {came_q[0], its_response};
      waits_q    <= open_q == 0 || m_valid != 0 || limit != 1 ? 5'd0 : waits_q + 5'd1;
      late_q     <= late_q | (its_response & answered_q);
    end
  end

  always @(*) begin
    assume (started_q || rst);
    assume (chosen < CLIENTS);
  end
`ifdef COVER
  always @(posedge clk)
    if (started_q && !rst && !rst_q) begin
      if (`COVER == 0) goal_ok: assert (!(answer && m_code == `CCHIP_WRITE_OK && beats_q == 2'd2));
      if (`COVER == 1) goal_late: assert (!late_q);
      if (`COVER == 2) goal_owed: assert (!(answer && m_code == `CCHIP_WRITE_OWED));
      if (`COVER == 3) goal_blank: assert (!(answered_q && beats_q == 2'd2 && sent_q == 2'd1 && aw_seen && w_n == aw_mine_n + 3'd1));
    end
`else
  wire [2:0] unanswered = aw_n - b_n;
  always @(*)
    if (started_q && !rst_q && !rst) begin
      aw_stable: assert (!aw_stays || (m_axi_awvalid && aw_is == aw_was));
      w_stable: assert (!w_stays || (m_axi_wvalid && w_is == w_was));
      kind: assert (m_axi_awaddr[PLACE-1:0] == 0);
      in_line: assert (!m_axi_awvalid || {1'd0, m_axi_awaddr[PLACE]} + m_axi_awlen <= 1);
      last: assert (!(m_axi_wvalid && w_second) || m_axi_wlast);
      length_address: assert (!(take_address && w_n != aw_n && w_n - aw_n < 3'd4) || m_axi_awlen[0] == w_long[aw_n[1:0]]);
      length_data: assert (!(take_last && w_n != aw_n && aw_n - w_n < 3'd4) || aw_long[w_n[1:0]] == w_second);
      length_both: assert (!(take_last && take_address && w_n == aw_n) || m_axi_awlen[0] == w_second);
      counted: assert (unanswered + m_axi_awvalid <= OUTSTANDING);
      in_order: assert (!(aw_seen && w_seen) || aw_mine_n == w_mine_n);
      its_address: assert (!aw_mine || (complete_q && m_axi_awaddr[PLACE] == place_q && m_axi_awlen + 1 == beats_q));
      its_data: assert (!w_mine || (complete_q && sent_q < beats_q && m_axi_wdata[0] == data_q[sent_q[0]] &&
          m_axi_wstrb[0] == strb_q[sent_q[0]]));
      one_client: assert ((m_valid & (m_valid - 1)) == 0);
      honest: assert (!(answer && m_code == `CCHIP_WRITE_OK) || (came_q[1] && okay_q[1] && sent_q == beats_q));
      bus: assert (!(answer && m_code == `CCHIP_WRITE_BUS) || (came_q[1] && !okay_q[1]));
      told: assert (!came_q[1] || answered_q || (answer && !m_code[1]));
      nothing_sent: assert (!((answer && m_code == `CCHIP_WRITE_OWED) || owed_q) || !(aw_seen || w_seen || aw_mine || w_mine));
      in_time: assert (waits_q != BOUND);
    end
`endif
endmodule
`default_nettype wire
