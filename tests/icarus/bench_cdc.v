// SPDX-License-Identifier: Apache-2.0
`timescale 1ps / 1ps
`default_nettype none
// bench_cdc: beats through every channel of cchip_axi_cdc and cchip_axil_cdc and the interrupt, with clocks of random
// ratio that change, random valid and ready, and resets of either side or of both in the midst. Every field of a beat is
// made of the number of its beat, so a beat that is lost, repeated, out of order or with fields exchanged is seen; only a
// reset may lose beats.
//   vvp -n FILE [+seed=N] [+beats=N]      prints the seed; last line PASS or FAIL, exit code 1 for FAIL
module bench_cdc;
  integer seed, beats, failures;
  reg a_clk = 0, b_clk = 0, a_rst = 1, b_rst = 1;
  integer a_half = 1000, b_half = 1000;
  always #(a_half) a_clk = ~a_clk;
  always #(b_half) b_clk = ~b_clk;

  // ---- channels 0 to 4: AXI4, 5 to 9: AXI4-Lite; forth from a to b: 0, 2, 3, 5, 7, 9 of this order
  localparam integer CHANNELS = 10;
  localparam [CHANNELS-1:0] FORTH = 10'b01_0110_1101;  // bit: channel
  // AR R AW W B, then AW W B AR R
  wire [CHANNELS-1:0] s_valid, s_ready, m_valid, m_ready;
  wire [255:0] s_data[0:CHANNELS-1];
  wire [255:0] m_data[0:CHANNELS-1];
  wire [31:0] passed[0:CHANNELS-1];
  wire [CHANNELS-1:0] wrong;
  reg resync_a = 1, resync_b = 1;

  genvar c;
  generate
    for (c = 0; c < CHANNELS; c = c + 1) begin : gen_channel
      wire [31:0] sent;
      bench_source #(.CHANNEL(c)) u_source (
          .clk  (FORTH[c] ? a_clk : b_clk),
          .rst  (FORTH[c] ? a_rst : b_rst),
          .valid(s_valid[c]),
          .ready(s_ready[c]),
          .data (s_data[c]),
          .sent (sent)
      );
      bench_sink #(.CHANNEL(c)) u_sink (
          .clk   (FORTH[c] ? b_clk : a_clk),
          .rst   (FORTH[c] ? b_rst : a_rst),
          .resync(resync_a | resync_b),
          .sent  (sent),
          .valid (m_valid[c]),
          .ready (m_ready[c]),
          .data  (m_data[c]),
          .wrong (wrong[c]),
          .passed(passed[c])
      );
    end
  endgenerate

  // a channel's beat is the low bits of its data: those above are 0 at the sink, and are not compared there
  localparam integer AX_W = 6 + 64 + 8, R_W = 6 + 128 + 3, AW_W = 1 + 64 + 8, W_W = 128 + 16 + 1, B_W = 3;
  assign m_data[0][255:AX_W] = 0;
  assign m_data[1][255:R_W] = 0;
  assign m_data[2][255:AW_W] = 0;
  assign m_data[3][255:W_W] = 0;
  assign m_data[4][255:B_W] = 0;
  assign m_data[5][255:15] = 0;
  assign m_data[6][255:36] = 0;
  assign m_data[7][255:2] = 0;
  assign m_data[8][255:15] = 0;
  assign m_data[9][255:34] = 0;
  cchip_axi_cdc #(.DEPTH(8)) u_axi (
      .s_clk(a_clk), .s_rst(a_rst), .m_clk(b_clk), .m_rst(b_rst),
      .s_axi_arvalid(s_valid[0]), .s_axi_arready(s_ready[0]),
      .s_axi_arid(s_data[0][5:0]), .s_axi_araddr(s_data[0][69:6]), .s_axi_arlen(s_data[0][77:70]),
      .m_axi_arvalid(m_valid[0]), .m_axi_arready(m_ready[0]),
      .m_axi_arid(m_data[0][5:0]), .m_axi_araddr(m_data[0][69:6]), .m_axi_arlen(m_data[0][77:70]),
      .m_axi_rvalid(s_valid[1]), .m_axi_rready(s_ready[1]),
      .m_axi_rid(s_data[1][5:0]), .m_axi_rdata(s_data[1][133:6]), .m_axi_rresp(s_data[1][135:134]),
      .m_axi_rlast(s_data[1][136]),
      .s_axi_rvalid(m_valid[1]), .s_axi_rready(m_ready[1]),
      .s_axi_rid(m_data[1][5:0]), .s_axi_rdata(m_data[1][133:6]), .s_axi_rresp(m_data[1][135:134]),
      .s_axi_rlast(m_data[1][136]),
      .s_axi_awvalid(s_valid[2]), .s_axi_awready(s_ready[2]),
      .s_axi_awid(s_data[2][0]), .s_axi_awaddr(s_data[2][64:1]), .s_axi_awlen(s_data[2][72:65]),
      .m_axi_awvalid(m_valid[2]), .m_axi_awready(m_ready[2]),
      .m_axi_awid(m_data[2][0]), .m_axi_awaddr(m_data[2][64:1]), .m_axi_awlen(m_data[2][72:65]),
      .s_axi_wvalid(s_valid[3]), .s_axi_wready(s_ready[3]),
      .s_axi_wdata(s_data[3][127:0]), .s_axi_wstrb(s_data[3][143:128]), .s_axi_wlast(s_data[3][144]),
      .m_axi_wvalid(m_valid[3]), .m_axi_wready(m_ready[3]),
      .m_axi_wdata(m_data[3][127:0]), .m_axi_wstrb(m_data[3][143:128]), .m_axi_wlast(m_data[3][144]),
      .m_axi_bvalid(s_valid[4]), .m_axi_bready(s_ready[4]), .m_axi_bid(s_data[4][0]), .m_axi_bresp(s_data[4][2:1]),
      .s_axi_bvalid(m_valid[4]), .s_axi_bready(m_ready[4]), .s_axi_bid(m_data[4][0]), .s_axi_bresp(m_data[4][2:1])
  );
  reg level = 0;  // on b_clk
  wire irq;  // on a_clk
  cchip_axil_cdc #(.DEPTH(4), .STAGES(3)) u_axil (
      .s_clk(a_clk), .s_rst(a_rst), .m_clk(b_clk), .m_rst(b_rst), .m_irq(level), .s_irq(irq),
      .s_axil_awvalid(s_valid[5]), .s_axil_awready(s_ready[5]),
      .s_axil_awaddr(s_data[5][11:0]), .s_axil_awprot(s_data[5][14:12]),
      .m_axil_awvalid(m_valid[5]), .m_axil_awready(m_ready[5]),
      .m_axil_awaddr(m_data[5][11:0]), .m_axil_awprot(m_data[5][14:12]),
      .s_axil_wvalid(s_valid[6]), .s_axil_wready(s_ready[6]),
      .s_axil_wdata(s_data[6][31:0]), .s_axil_wstrb(s_data[6][35:32]),
      .m_axil_wvalid(m_valid[6]), .m_axil_wready(m_ready[6]),
      .m_axil_wdata(m_data[6][31:0]), .m_axil_wstrb(m_data[6][35:32]),
      .m_axil_bvalid(s_valid[7]), .m_axil_bready(s_ready[7]), .m_axil_bresp(s_data[7][1:0]),
      .s_axil_bvalid(m_valid[7]), .s_axil_bready(m_ready[7]), .s_axil_bresp(m_data[7][1:0]),
      .s_axil_arvalid(s_valid[8]), .s_axil_arready(s_ready[8]),
      .s_axil_araddr(s_data[8][11:0]), .s_axil_arprot(s_data[8][14:12]),
      .m_axil_arvalid(m_valid[8]), .m_axil_arready(m_ready[8]),
      .m_axil_araddr(m_data[8][11:0]), .m_axil_arprot(m_data[8][14:12]),
      .m_axil_rvalid(s_valid[9]), .m_axil_rready(s_ready[9]),
      .m_axil_rdata(s_data[9][31:0]), .m_axil_rresp(s_data[9][33:32]),
      .s_axil_rvalid(m_valid[9]), .s_axil_rready(m_ready[9]),
      .s_axil_rdata(m_data[9][31:0]), .s_axil_rresp(m_data[9][33:32])
  );

  // ---- the interrupt: after each phase of 0, of a single clock as well, an edge
  integer drops = 0, edges = 0, i;
  reg irq_before = 0;
  always @(posedge a_clk) begin
    irq_before <= irq;
    if (irq && !irq_before) edges = edges + 1;
  end

  // ---- the run
  reg [CHANNELS-1:0] any_wrong = 0;
  always @(wrong) any_wrong = any_wrong | wrong;
  integer round, least, before, waited;
  function integer least_passed(input integer unused);
    integer k;
    begin
      least_passed = passed[0];
      for (k = 1; k < CHANNELS; k = k + 1) if (passed[k] < least_passed) least_passed = passed[k];
    end
  endfunction
  task move(input integer more);  // until every channel has passed that many beats more, or for too long
    begin
      before = least_passed(0);
      waited = 0;
      while (least_passed(0) < before + more && waited < 4000 * more && any_wrong == 0) begin
        #1000;
        waited = waited + 1;
        if (waited % 512 == 0) a_half = 300 + $unsigned($random(seed)) % 4000;
      end
      if (any_wrong == 0 && least_passed(0) < before + more) begin
        for (i = 0; i < CHANNELS; i = i + 1) $display("channel %0d: %0d beats", i, passed[i]);
        $display("FAIL no beats pass on some channel in round %0d", round);
        $finish_and_return(1);
      end
    end
  endtask

  initial begin
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    if (!$value$plusargs("beats=%d", beats)) beats = 3000;
    $display("seed=%0d", seed);
    seed = seed * 7919 + 17;
    #20000 a_rst = 0;
    #20000 b_rst = 0;
    #100000 {resync_a, resync_b} = 2'b00;
    for (round = 0; least_passed(0) < beats && any_wrong == 0; round = round + 1) begin
      // equal, or of any ratio between 1 to 13 and 13 to 1
      b_half = 300 + $unsigned($random(seed)) % 4000;
      a_half = round % 4 == 0 ? b_half : 300 + $unsigned($random(seed)) % 4000;
      move(100);
      // a reset: of a alone, of b alone, of both, one inside the other
      {resync_a, resync_b} = 2'b11;
      case ($unsigned($random(seed)) % 4)
        0: begin @(posedge a_clk) a_rst <= 1; repeat (1 + $unsigned($random(seed)) % 3) @(posedge a_clk); a_rst <= 0; end
        1: begin @(posedge b_clk) b_rst <= 1; repeat (1 + $unsigned($random(seed)) % 3) @(posedge b_clk); b_rst <= 0; end
        2: begin
          @(posedge a_clk) a_rst <= 1;
          @(posedge b_clk) b_rst <= 1;
          repeat (2 + $unsigned($random(seed)) % 9) @(posedge a_clk);
          a_rst <= 0;
          repeat ($unsigned($random(seed)) % 9) @(posedge b_clk);
          @(posedge b_clk) b_rst <= 0;
        end
        default: begin
          @(posedge b_clk) b_rst <= 1;
          repeat ($unsigned($random(seed)) % 9) @(posedge b_clk);
          @(posedge a_clk) a_rst <= 1;
          @(posedge b_clk) b_rst <= 0;
          repeat ($unsigned($random(seed)) % 9) @(posedge a_clk);
          a_rst <= 0;
        end
      endcase
      repeat (60) @(posedge a_clk);
      repeat (60) @(posedge b_clk);
      move(20);  // beats of before have left
      {resync_a, resync_b} = 2'b00;
      // the interrupt: up, then drops of a clock with rests between them
      @(posedge b_clk) level <= 1;
      repeat (40) @(posedge a_clk);
      repeat (40) @(posedge b_clk);
      edges = 0;
      for (drops = 0; drops < 5; drops = drops + 1) begin
        @(posedge b_clk) level <= 0;
        @(posedge b_clk) level <= 1;
        repeat (40) @(posedge a_clk);
        repeat (40) @(posedge b_clk);
      end
      if (edges != 5 || irq !== 1'b1) begin
        $display("FAIL %0d edges of the interrupt after 5 drops, round %0d", edges, round);
        $finish_and_return(1);
      end
      @(posedge b_clk) level <= 0;
      repeat (40) @(posedge a_clk);
      repeat (40) @(posedge b_clk);
      if (irq !== 1'b0) begin
        $display("FAIL the interrupt stays, round %0d", round);
        $finish_and_return(1);
      end
      // a drop while the rise before it is on its way
      edges = 0;
      @(posedge b_clk) level <= 1;
      @(posedge b_clk);
      @(posedge b_clk) level <= 0;
      @(posedge b_clk) level <= 1;
      repeat (60) @(posedge a_clk);
      repeat (60) @(posedge b_clk);
      if (edges != 2 || irq !== 1'b1) begin
        $display("FAIL %0d edges of the interrupt after a rise and a drop, round %0d", edges, round);
        $finish_and_return(1);
      end
    end
    if (any_wrong != 0) begin
      $display("FAIL wrong beat on channels %b, round %0d", any_wrong, round);
      $finish_and_return(1);
    end
    $display("PASS rounds=%0d beats=%0d", round, least_passed(0));
    $finish;
  end
endmodule

// Beat n of a channel: bits that depend on all of n, and n itself nowhere.
module bench_beat (
    input  wire [ 31:0] channel,
    input  wire [ 31:0] n,
    output wire [255:0] data
);
  genvar k;
  generate
    for (k = 0; k < 8; k = k + 1) begin : gen_word
      wire [31:0] x = (n + 32'd1) * 32'h9E3779B1 ^ (channel * 8 + k) * 32'h85EBCA77;
      wire [31:0] y = (x ^ x >> 15) * 32'h2C1B3C6D;
      assign data[32*k+:32] = y ^ y >> 13;
    end
  endgenerate
endmodule

module bench_source #(
    parameter integer CHANNEL = 0
) (
    input  wire         clk,
    input  wire         rst,
    output reg          valid,
    input  wire         ready,
    output wire [255:0] data,
    output reg  [ 31:0] sent  // beats that were offered, the one on offer included
);
  integer seed = CHANNEL + 100;
  reg [3:0] rate = 15;
  initial {valid, sent} = 0;
  bench_beat u_beat (.channel(CHANNEL), .n(sent), .data(data));
  always @(posedge clk) begin
    if ($random(seed) % 256 == 0) rate <= $random(seed);
    if (rst) begin
      if (valid) sent <= sent + 1;  // lost
      valid <= 0;
    end else if (!valid || ready) begin
      if (valid) sent <= sent + 1;
      valid <= $unsigned($random(seed)) % 16 <= rate;
    end
  end
endmodule

module bench_sink #(
    parameter integer CHANNEL = 0
) (
    input  wire         clk,
    input  wire         rst,
    input  wire         resync,
    input  wire [ 31:0] sent,
    input  wire         valid,
    output reg          ready,
    input  wire [255:0] data,
    output reg          wrong,
    output reg  [ 31:0] passed
);
  // bits of a beat
  localparam integer W = CHANNEL == 0 ? 78 : CHANNEL == 1 ? 137 : CHANNEL == 2 ? 73 : CHANNEL == 3 ? 145 :
      CHANNEL == 4 ? 3 : CHANNEL == 5 || CHANNEL == 8 ? 15 : CHANNEL == 6 ? 36 : CHANNEL == 7 ? 2 : 34;
  integer seed = CHANNEL + 200;
  reg [3:0] rate = 15;
  reg [31:0] n;
  wire [255:0] expected;
  bench_beat u_beat (.channel(CHANNEL), .n(n), .data(expected));
  reg stalled = 0;
  reg [W-1:0] stalled_data;
  initial {ready, wrong, passed, n} = 0;
  always @(posedge clk) begin
    if ($random(seed) % 256 == 0) rate <= $random(seed);
    ready <= $unsigned($random(seed)) % 16 <= rate;
    if (valid === 1'bx || ready === 1'bx) wrong <= 1;
    if (stalled && !rst && (!valid || data[W-1:0] !== stalled_data)) wrong <= 1;
    stalled <= valid & ~ready & ~rst;
    stalled_data <= data[W-1:0];
    if (valid && ready && !rst) begin
      passed = passed + 1;
      // after a reset beats may be missing, but never come twice; beats of few bits are compared up to
      // the first reset only
      #1;
      if (resync && W >= 8) begin
        while (data_q !== expected[W-1:0] && n < sent) begin n = n + 1; #1; end
      end
      if (W >= 8 && (data_q !== expected[W-1:0] || n > sent)) wrong <= 1;
      if (W < 8 && resync && n != 0) exact = 0;
      if (W < 8 && exact && data_q !== expected[W-1:0]) wrong <= 1;
      n = n + 1;
    end
  end
  reg [W-1:0] data_q;
  reg exact = 1;  // until the first reset
  always @(posedge clk) data_q = data[W-1:0];
endmodule
`default_nettype wire
