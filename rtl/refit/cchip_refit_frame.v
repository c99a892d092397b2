// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_refit_frame: origin and step of a node from the box of all that lies below it.
//   origin       middle of the box in 2^-18, to nearest, ties to even, clamped to 18 bits
//   step         the least of 0..18 for which the box, rounded outward to whole steps of
//                2^(step - 24) from the origin, is within -64..63; none: m_none with m_done
//   latency      an axis is done 4 clocks after s_valid; m_done comes step + 2 clocks after search,
//                which must not come before
//   throughput   an axis per clock; one search at a time
//   cuts         every path: each output is a flip-flop
//   reset        no search
module cchip_refit_frame (
    input  wire        clk,         // clock, rising edge
    input  wire        rst,         // synchronous reset, active high
    input  wire        s_valid,     // interval of an axis, 2^-48; axis 0 begins a new box
    input  wire [ 1:0] s_axis,      // which; 0 begins a new box
    input  wire [51:0] s_least,     // its least end, 2^-48
    input  wire [51:0] s_greatest,  // its greatest end
    input  wire        search,      // all three are here
    output wire        m_done,      // the step is found, or there is none
    output wire        m_none,      // with it: there is none
    output wire [53:0] m_origin,    // origin, 3 x 18 bit
    output wire [ 4:0] m_step       // step
);

  localparam [4:0] STEP_MAX = 5'd18;

  // ---- sum of both ends; the ends rounded outward to 2^-24
  reg valid_q1, valid_q2, valid_q3;
  reg [1:0] axis_q1, axis_q2, axis_q3;
  reg signed [52:0] sum_q1;
  reg signed [27:0] least_q1, least_q2, greatest_q1, greatest_q2;
  // ---- origin. The rest behind it is compared with a half
  wire up = sum_q1[30] & ((|sum_q1[29:0]) | sum_q1[31]);
  wire signed [22:0] nearest = {sum_q1[52], sum_q1[52:31]} + {22'd0, up};
  wire fits_field = (&nearest[22:17]) | ~(|nearest[22:17]);
  reg signed [17:0] origin_q2, origin_q3;
  wire [28:0] origin2 = {{5{origin_q2[17]}}, origin_q2, 6'd0};
  // ---- how far the box reaches to both sides, each as a negative number
  reg signed [28:0] low_q3, high_q3, low_q, high_q;
  wire new_box = axis_q3 == 2'd0;
  reg [53:0] origin_q;

  reg search_q, done_q, none_q;
  reg [4:0] step_q;
  wire fits = low_q >= -29'sd64 && high_q >= -29'sd63;
  wire stop = fits || step_q == STEP_MAX;
  always @(posedge clk) begin
    axis_q1     <= s_axis;
    axis_q2     <= axis_q1;
    axis_q3     <= axis_q2;
    sum_q1      <= {s_least[51], s_least} + {s_greatest[51], s_greatest};
    least_q1    <= s_least[51:24];
    greatest_q1 <= s_greatest[51:24] + {27'd0, |s_greatest[23:0]};
    least_q2    <= least_q1;
    greatest_q2 <= greatest_q1;
    origin_q2   <= fits_field ? nearest[17:0] : {nearest[22], {17{~nearest[22]}}};
    low_q3      <= {least_q2[27], least_q2} - origin2;
    high_q3     <= origin2 - {greatest_q2[27], greatest_q2};
    origin_q3   <= origin_q2;
    if (valid_q3) begin
      origin_q <= {origin_q3, origin_q[53:18]};
      if (new_box || low_q3 < low_q) low_q <= low_q3;
      if (new_box || high_q3 < high_q) high_q <= high_q3;
    end
    // floors of floors: a shift by one a clock
    if (search) step_q <= 5'd0;
    if (search_q && !stop) begin
      low_q  <= low_q >>> 1;
      high_q <= high_q >>> 1;
      step_q <= step_q + 5'd1;
    end
    none_q <= ~fits;
    if (rst) begin
      valid_q1 <= 1'b0;
      valid_q2 <= 1'b0;
      valid_q3 <= 1'b0;
      search_q <= 1'b0;
      done_q   <= 1'b0;
    end else begin
      valid_q1 <= s_valid;
      valid_q2 <= valid_q1;
      valid_q3 <= valid_q2;
      search_q <= search | (search_q & ~stop);
      done_q   <= search_q & stop;
    end
  end
  assign m_done = done_q;
  assign m_none = none_q;
  assign m_origin = origin_q;
  assign m_step = step_q;

endmodule
`default_nettype wire
