// SPDX-License-Identifier: Apache-2.0
`default_nettype none
`include "cchip_defs.vh"
// bench_mul18: a cchip_mul18 of any latency against `*`, a new pair of factors on every clock.
//   BENCH_SIGNED   macro: 1 or 0, SIGNED of the leaf
//   +products=N    random ones, a quarter of the factors from the corners; all pairs of corners go first
//   +seed=S        of the random ones
// Ends with "PASS products=N latency=L" or "FAIL ...".
module bench_mul18;

  localparam integer LATENCY = `CCHIP_MUL18_LATENCY;
  localparam integer CORNERS = 12;

  reg clk;
  reg [17:0] a, b;
  wire [35:0] p;
  cchip_mul18 #(
      .SIGNED(`BENCH_SIGNED)
  ) dut (
      .clk(clk),
      .a  (a),
      .b  (b),
      .p  (p)
  );

  integer products, seed, n;
  reg [35:0] want[0:LATENCY];  // place i: of the factors i clocks ago
  integer i;

  function [17:0] corner(input integer which);
    case (which)
      0: corner = 18'h00000;
      1: corner = 18'h00001;
      2: corner = 18'h00002;
      3: corner = 18'h1fffe;
      4: corner = 18'h1ffff;
      5: corner = 18'h20000;
      6: corner = 18'h20001;
      7: corner = 18'h3fffe;
      8: corner = 18'h3ffff;
      9: corner = 18'h15555;
      10: corner = 18'h2aaaa;
      default: corner = 18'h10000;
    endcase
  endfunction

  task choose(output [17:0] factor);
    integer word;
    begin
      word   = $random(seed);
      factor = word[19:18] == 2'd0 ? corner(word[31:20] % CORNERS) : word[17:0];
    end
  endtask

  initial begin
    if (!$value$plusargs("products=%d", products)) products = 1000;
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    clk = 0;
    for (n = 0; n < CORNERS * CORNERS + products; n = n + 1) begin
      if (n < CORNERS * CORNERS) begin
        a = corner(n / CORNERS);
        b = corner(n % CORNERS);
      end else begin
        choose(a);
        choose(b);
      end
      for (i = LATENCY; i > 0; i = i - 1) want[i] = want[i-1];
      if (`BENCH_SIGNED != 0) want[0] = $signed(a) * $signed(b);
      else want[0] = a * b;
      #1;
      if (n >= LATENCY && p !== want[LATENCY]) begin
        $display("FAIL product %0d is %h, not %h", n - LATENCY, p, want[LATENCY]);
        $finish;
      end
      clk = 1;
      #1 clk = 0;
    end
    $display("PASS products=%0d latency=%0d", n - LATENCY, LATENCY);
    $finish;
  end

endmodule
`default_nettype wire
