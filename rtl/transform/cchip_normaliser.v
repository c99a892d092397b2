// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_normaliser: a pair of primitives on its own grid. The least n for which
// (x - min + half) >> n fits COORD_W bits on all three axes, the coordinates on that grid with the
// middle of the range at 0, and eta, the bound on what all roundings together may have moved.
//   latency      CCHIP_NORMALISER_LATENCY(PASSES) clocks for every vertex
//   throughput   one vertex of A and one of B every PASSES clocks, never stalls
//   input        3 or 4 vertices a pair, PASSES clocks apart, first and last marked; pairs follow
//                each other at that rate or later
//   numbers      units of the leaf pair, two's complement (docs/hardware/image.md)
//   eta          0: nothing was rounded; 15 for an open pair; else
//                min(15, 1 + ceil(max(error of A, error of B) / 2^n)), where an error is s_error_*
//                and 1 for each flag of s_lost that a vertex of the pair has
//   reset        vertices inside are dropped
// Bit for bit model::normalise.
module cchip_normaliser #(
    parameter integer COORD_W = 16,  // width of a coordinate on the grid (bit); legal: 4..20
    parameter integer PASSES  = 1    // from one vertex of a pair to the next (clock); legal: 1, 2
) (
    input  wire                               clk,        // clock, rising edge
    input  wire                               rst,        // synchronous reset, active high
    input  wire                               s_valid,    // a vertex of A and one of B
    input  wire                               s_first,    // the first of a pair
    input  wire                               s_last,     // its last, the third or the fourth
    input  wire [                      134:0] s_a,  // vertex of A, 3 x 45 bit, x lowest; units
    input  wire [                       74:0] s_b,        // vertex of B, 3 x 25 bit
    // rounding it lost a bit: {B's, A's, origin of A's leaf}; what a rounding has lost a bit of:
    // {vertex of B, vertex of A, origin of A's leaf}
    input  wire [                        2:0] s_lost,
    // with the last vertex: bound on twice the error of a vertex of A without what s_lost says,
    // units; with the last vertex: bound on twice the error of a vertex, less its s_lost; units
    input  wire [                       15:0] s_error_a,
    input  wire [                        5:0] s_error_b,  // the same of B
    // with the last vertex: no answer for this pair is definite
    input  wire                               s_open,
    output wire                               m_valid,    // a vertex on the grid
    output wire                               m_first,    // the first of its pair
    output wire                               m_last,     // its last
    output wire [`CCHIP_POINT_W(COORD_W)-1:0] m_a,        // vertex of A, grid steps
    output wire [`CCHIP_POINT_W(COORD_W)-1:0] m_b,        // vertex of B
    output wire [           `CCHIP_ERR_W-1:0] m_err       // eta of the pair, 0..15
);

  localparam integer A_W = 45;
  localparam integer B_W = 25;
  localparam integer SPANS = A_W - COORD_W + 1;  // values of n but the greatest
  localparam integer N_W = $clog2(SPANS + 1);
  localparam integer ERROR_W = 16;
  localparam [31:0] ERR_UNKNOWN = `CCHIP_ERR_UNKNOWN;
  localparam [`CCHIP_ERR_W-1:0] UNKNOWN = ERR_UNKNOWN[`CCHIP_ERR_W-1:0];
  // Clocks from a vertex to its subtraction: those of the last of four vertices, and 10 of the span
  localparam integer WAIT = 3 * PASSES + 10;

  `CCHIP_REFUSE(COORD_W < `CCHIP_COORD_W_MIN || COORD_W > `CCHIP_COORD_W_MAX,
                cchip_error_COORD_W_must_be_4_to_20)
  `CCHIP_REFUSE(PASSES < 1 || PASSES > 2, cchip_error_PASSES_must_be_1_or_2)

  // ---- clocks 1 to 3: least and greatest coordinate on each axis, and the bits in which any
  // coordinate differs from the first one of its axis
  reg [3:1] valid_q, last_q;
  reg [2:1] first_q;
  reg [2:0] lost_q1, lost_q2, lost_q3;
  wire [3*A_W-1:0] least3, greatest3;
  wire [3*SPANS-1:0] differs;
  reg [SPANS-1:0] differs_q1, differs_q2, differs_q3;
  genvar i;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      wire [  A_W-1:0] a = s_a[A_W*i+:A_W];
      wire [  A_W-1:0] b = {{A_W - B_W{s_b[B_W*i+B_W-1]}}, s_b[B_W*i+:B_W]};
      reg  [SPANS-1:0] reference_q;
      wire [SPANS-1:0] reference = s_first ? a[SPANS-1:0] : reference_q;
      assign differs[SPANS*i+:SPANS] = (a[SPANS-1:0] ^ reference) | (b[SPANS-1:0] ^ reference);
      reg above_q1;
      reg [A_W-1:0] a_q1, b_q1, less_q2, more_q2, least_q3, greatest_q3;
      wire less = first_q[2] || $signed(less_q2) < $signed(least_q3);
      wire more = first_q[2] || $signed(more_q2) > $signed(greatest_q3);
      always @(posedge clk) begin
        if (s_valid) reference_q <= reference;
        above_q1 <= $signed(a) > $signed(b);
        a_q1     <= a;
        b_q1     <= b;
        less_q2  <= above_q1 ? b_q1 : a_q1;
        more_q2  <= above_q1 ? a_q1 : b_q1;
        if (valid_q[2] && less) least_q3 <= less_q2;
        if (valid_q[2] && more) greatest_q3 <= more_q2;
      end
      assign least3[A_W*i+:A_W] = least_q3;
      assign greatest3[A_W*i+:A_W] = greatest_q3;
    end
  endgenerate
  always @(posedge clk) begin
    valid_q    <= rst ? 3'd0 : {valid_q[2:1], s_valid};
    first_q    <= {first_q[1], s_first};
    last_q     <= {last_q[2:1], s_last};
    differs_q1 <= differs[0+:SPANS] | differs[SPANS+:SPANS] | differs[2*SPANS+:SPANS];
    differs_q2 <= differs_q1;
    lost_q1    <= s_lost;
    lost_q2    <= lost_q1;
    if (valid_q[2]) begin
      differs_q3 <= differs_q2 | (first_q[2] ? {SPANS{1'b0}} : differs_q3);
      lost_q3    <= lost_q2 | (first_q[2] ? 3'd0 : lost_q3);
    end
  end

  // ---- clocks 4 to 6: the greatest span; the greater error
  reg [A_W-1:0] x_q4, y_q4, z_q4, xy_q5, z_q5, span_q6;
  wire [ERROR_W-1:0] error_a3;
  wire [5:0] error_b3;
  wire open3;
  reg [ERROR_W-1:0] error_a_q4, error_q5;
  reg [6:0] error_b_q4;
  wire [ERROR_W-1:0] error_b4 = {{ERROR_W - 7{1'b0}}, error_b_q4};
  cchip_delay #(.WIDTH(ERROR_W + 7), .DEPTH(3)) u_error (
      .clk(clk),
      .rst(1'b0),
      .d  ({s_open, s_error_b, s_error_a}),
      .q  ({open3, error_b3, error_a3})
  );
  always @(posedge clk) begin
    x_q4 <= greatest3[0+:A_W] - least3[0+:A_W];
    y_q4 <= greatest3[A_W+:A_W] - least3[A_W+:A_W];
    z_q4 <= greatest3[2*A_W+:A_W] - least3[2*A_W+:A_W];
    xy_q5 <= x_q4 > y_q4 ? x_q4 : y_q4;
    z_q5 <= z_q4;
    span_q6 <= xy_q5 > z_q5 ? xy_q5 : z_q5;
    error_a_q4 <= error_a3 + {{ERROR_W - 1{1'b0}}, lost_q3[0]} + {{ERROR_W - 1{1'b0}}, lost_q3[1]};
    error_b_q4 <= {1'b0, error_b3} + {6'd0, lost_q3[2]};
    error_q5 <= error_a_q4 > error_b4 ? error_a_q4 : error_b4;
  end

  // ---- clocks 7 to 9: n. Bit k says that n is greater than k: (span + half(k)) >> k does not fit
  reg [SPANS-1:0] over_q7, carry_q7, below_q8;  // bit k of below: 2^k is below 2^n
  reg [N_W-1:0] n;
  integer k;
  wire [SPANS:0] below = {1'b0, below_q8};
  generate
    for (i = 0; i < SPANS; i = i + 1) begin : gen_n
      if (i == SPANS - 1) begin : gen_last
        always @(posedge clk) over_q7[i] <= 1'b0;
      end else begin : gen_over
        always @(posedge clk) over_q7[i] <= |span_q6[A_W-1:COORD_W+i];
      end
      if (i == 0) begin : gen_no_half
        always @(posedge clk) carry_q7[i] <= 1'b0;
      end else begin : gen_carry
        always @(posedge clk) carry_q7[i] <= &span_q6[COORD_W+i-1:i-1];
      end
    end
  endgenerate
  always @(posedge clk) below_q8 <= over_q7 | carry_q7;
  always @* begin
    n = {N_W{1'b0}};
    for (k = 1; k <= SPANS; k = k + 1) n = n | (k[N_W-1:0] & {N_W{below[k-1] & ~below[k]}});
  end

  // What the pair is known by, from the clock on which its n is there, and that of the pair whose
  // vertices are on their way out
  localparam integer KNOWN_W = 3 * A_W + N_W + 17 + ERROR_W + 1;
  wire [  3*A_W-1:0] least8;
  wire [  SPANS-1:0] differs8;
  wire [ERROR_W-1:0] error8;
  wire last8, open8;
  reg [KNOWN_W-1:0] known_q9, known_q;
  cchip_delay #(.WIDTH(3 * A_W + SPANS + 1), .DEPTH(5), .MEMORY(1)) u_least (
      .clk(clk),
      .rst(1'b0),
      .d  ({least3, differs_q3, open3}),
      .q  ({least8, differs8, open8})
  );
  cchip_delay #(.WIDTH(ERROR_W), .DEPTH(3)) u_error_5 (
      .clk(clk),
      .rst(1'b0),
      .d  (error_q5),
      .q  (error8)
  );
  cchip_delay #(.WIDTH(1), .DEPTH(5), .RESET(1)) u_last (
      .clk(clk),
      .rst(rst),
      .d  (valid_q[3] & last_q[3]),
      .q  (last8)
  );
  wire exits, exits_first;
  always @(posedge clk) begin
    if (last8) known_q9 <= {least8, n, below_q8[15:0], |(differs8 & below_q8), error8, open8};
    if (exits && exits_first) known_q <= known_q9;
  end
  wire [3*A_W-1:0] least;
  wire [N_W-1:0] shift;
  wire [15:0] fraction;  // its bits: what 2^n cuts of the error
  wire lost, open;
  wire [ERROR_W-1:0] error;
  assign {least, shift, fraction, lost, error, open} = known_q;

  // ---- vertices on their way out
  wire [3*A_W-1:0] out_a;
  wire [3*B_W-1:0] out_b;
  wire exits_last;
  cchip_delay #(.WIDTH(3 * A_W + 3 * B_W), .DEPTH(WAIT), .MEMORY(1)) u_vertices (
      .clk(clk),
      .rst(1'b0),
      .d  ({s_b, s_a}),
      .q  ({out_b, out_a})
  );
  cchip_delay #(.WIDTH(3), .DEPTH(WAIT - 1), .RESET(1)) u_exits (
      .clk(clk),
      .rst(rst),
      .d  ({s_last, s_first, s_valid}),
      .q  ({exits_last, exits_first, exits})
  );
  cchip_delay #(.WIDTH(3), .DEPTH(5), .RESET(1)) u_valid (
      .clk(clk),
      .rst(rst),
      .d  ({exits_last, exits_first, exits}),
      .q  ({m_last, m_first, m_valid})
  );
  reg [N_W-1:0] shift_q;
  always @(posedge clk) shift_q <= shift;
  generate
    for (i = 0; i < 6; i = i + 1) begin : gen_out
      wire [A_W-1:0] vertex;
      reg  [A_W-1:0] from_least_q;
      if (i < 3) begin : gen_a
        assign vertex = out_a[A_W*i+:A_W];
      end else begin : gen_b
        assign vertex = {{A_W - B_W{out_b[B_W*(i-3)+B_W-1]}}, out_b[B_W*(i-3)+:B_W]};
      end
      always @(posedge clk) from_least_q <= vertex - least[A_W*(i%3)+:A_W];
      wire [COORD_W:0] rounded_more;
      wire [COORD_W-1:0] rounded = rounded_more[COORD_W-1:0];
      wire inexact;
      cchip_round_shift #(
          .D_W      (A_W + 1),
          .BASE     (0),
          .SHIFT_MAX(SPANS),
          .Q_W      (COORD_W + 1)
      ) u_round (
          .clk (clk),
          .d   ({1'b0, from_least_q}),
          .s   (shift_q),
          .q   (rounded_more),
          .lost(inexact)
      );
      wire unused = &{1'b0, inexact, rounded_more[COORD_W]};
      // n is the least shift for which the pair fits, rounding included
      always @(posedge clk) begin
        if (m_valid && !rst) begin
          `CCHIP_NARROW_UNSIGNED(a_rounded, rounded_more[COORD_W])
        end
      end
      wire [COORD_W-1:0] middle = rounded ^ {1'b1, {COORD_W - 1{1'b0}}};
      if (i < 3) begin : gen_m_a
        assign m_a[COORD_W*i+:COORD_W] = middle;
      end else begin : gen_m_b
        assign m_b[COORD_W*(i-3)+:COORD_W] = middle;
      end
    end
  endgenerate

  // ---- eta, in the four clocks of the coordinates
  reg [ERROR_W-1:0] coarse_q, steps_q;
  reg [1:0] fine_q;
  reg coarse_rest_q, rest_q, exact_q, exact_q2, open_q, open_q2;
  reg [`CCHIP_ERR_W-1:0] eta_q, eta_q2;
  wire [  N_W-1:0] coarse_shift = {shift[N_W-1:2], 2'd0};
  wire [ERROR_W:0] steps = {1'b0, steps_q} + {{ERROR_W{1'b0}}, rest_q};
  always @(posedge clk) begin
    coarse_q <= error >> coarse_shift;
    fine_q <= shift[1:0];
    coarse_rest_q <= |(error & fraction);
    exact_q <= error == {ERROR_W{1'b0}} & ~lost;
    open_q <= open;
    steps_q <= coarse_q >> fine_q;
    rest_q <= coarse_rest_q;
    exact_q2 <= exact_q;
    open_q2 <= open_q;
    eta_q         <= open_q2 || (!exact_q2 && steps > 17'd14) ? UNKNOWN :
                     exact_q2 ? 4'd0 : steps[3:0] + 4'd1;
    eta_q2 <= eta_q;
  end
  assign m_err = eta_q2;

endmodule
`default_nettype wire
