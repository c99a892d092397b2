// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_round_shift: division by a power of two, rounded to nearest, halves up.
// q = floor(d 2^-(BASE + s) + 1/2), q = d if BASE + s is 0.
//   latency      3 clocks
//   throughput   one value per clock, never stalls
//   numbers      d and q two's complement, q modulo 2^Q_W
//   lost         d is no multiple of 2^(BASE + s): q is not exact
//   reset        none (data only)
//   numbers      A value halfway between two others becomes the greater one.
//   inside       Two barrel shifters that keep one bit below the point, and a flag for what falls
//                off behind it; the last clock adds that bit.
//   why          floor(x + 1/2) is the truncated value and the highest bit that was cut, so no
//                constant that depends on s has to be added before the shift.
module cchip_round_shift #(
    parameter integer D_W = 56,        // width of d (bit); legal: 2..64
    parameter integer BASE = 29,       // bits that are cut for every s; legal: 0..D_W - 1
    parameter integer SHIFT_MAX = 27,  // greatest s (bit); legal: 2..63
    parameter integer Q_W = 27         // width of q (bit); legal: 1..D_W - BASE + 1
) (
    input  wire                           clk,  // clock, rising edge
    input  wire [                D_W-1:0] d,    // signed
    input  wire [$clog2(SHIFT_MAX+1)-1:0] s,    // bits that are cut beside BASE
    output wire [                Q_W-1:0] q,    // signed, modulo 2^Q_W
    output wire                           lost  // d is no multiple of 2^(BASE + s)
);

  localparam integer SHIFT_W = $clog2(SHIFT_MAX + 1);
  localparam integer HALF = SHIFT_W / 2;  // bits of s for the second clock
  localparam integer V_W = D_W - BASE + 1;  // with one bit below the point

  `CCHIP_REFUSE(D_W < 2 || D_W > 64 || BASE < 0 || BASE > D_W - 1,
                cchip_error_round_shift_D_W_must_be_2_to_64_and_BASE_below_it)
  `CCHIP_REFUSE(SHIFT_MAX < 2 || SHIFT_MAX > 63, cchip_error_round_shift_SHIFT_MAX_must_be_2_to_63)
  `CCHIP_REFUSE(Q_W < 1 || Q_W > V_W,
                cchip_error_round_shift_Q_W_must_be_1_to_D_W_minus_BASE_plus_1)

  wire signed [V_W-1:0] start;
  wire start_lost;
  generate
    if (BASE == 0) begin : gen_whole
      assign start = {d, 1'b0};
      assign start_lost = 1'b0;
    end else begin : gen_cut
      assign start = d[D_W-1:BASE-1];
      if (BASE == 1) begin : gen_one
        assign start_lost = 1'b0;
      end else begin : gen_more
        assign start_lost = |d[BASE-2:0];
      end
    end
  endgenerate

  // ---- clocks 1 and 2: upper, then lower bits of s
  reg signed [V_W-1:0] upper, lower, upper_q, lower_q2;
  reg upper_lost, lower_lost, upper_lost_q, lower_lost_q2;
  reg [HALF-1:0] s_q;
  integer i;
  always @* begin
    upper = start;
    upper_lost = start_lost;
    for (i = SHIFT_W - 1; i >= HALF; i = i - 1)
    if (s[i]) begin
      upper_lost = upper_lost | (|($unsigned(upper) & ~({V_W{1'b1}} << (1 << i))));
      upper = upper >>> (1 << i);
    end
  end
  always @* begin
    lower = upper_q;
    lower_lost = upper_lost_q;
    for (i = HALF - 1; i >= 0; i = i - 1)
    if (s_q[i]) begin
      lower_lost = lower_lost | (|($unsigned(lower) & ~({V_W{1'b1}} << (1 << i))));
      lower = lower >>> (1 << i);
    end
  end

  // ---- clock 3: half up
  reg [V_W-1:0] q_q3;
  reg lost_q3;
  always @(posedge clk) begin
    upper_q       <= upper;
    upper_lost_q  <= upper_lost;
    s_q           <= s[HALF-1:0];
    lower_q2      <= lower;
    lower_lost_q2 <= lower_lost;
    q_q3          <= (lower_q2 >>> 1) + $signed({{V_W - 1{1'b0}}, lower_q2[0]});
    lost_q3       <= lower_lost_q2 | lower_q2[0];
  end
  assign q = q_q3[Q_W-1:0];
  assign lost = lost_q3;

  generate
    if (Q_W < V_W) begin : gen_unused
      wire unused = &{1'b0, q_q3[V_W-1:Q_W]};
    end
  endgenerate

endmodule
`default_nettype wire
