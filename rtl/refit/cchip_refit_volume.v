// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_refit_volume: box and cuts of a child of a node from its bounds (docs/hardware/image.md).
//   box          of each axis both ends in steps from the node's origin, rounded outward; a box is
//                never flat at -64
//   cuts         from the corner of the rounded box to the bound, rounded down, 0..7
//   order        x, y, z; directions without z at least 5 clocks after y, with z 5 after z
//   numbers      bounds are rounded outward from 2^-48 to 2^-24 first. That loses nothing: steps,
//                units of cuts and corners are whole multiples of 2^-24
//   latency      5 clocks; s_origin, s_step and s_cut_exponent must not change meanwhile
//   throughput   an interval per clock
//   cuts         every path: m_data is chosen between flip-flops, the others are flip-flops
//   reset        nothing in flight
module cchip_refit_volume (
    input  wire        clk,             // clock, rising edge
    input  wire        rst,             // synchronous reset, active high
    input  wire [53:0] s_origin,        // of the node, 3 x 18 bit, 2^-18
    input  wire [ 4:0] s_step,          // its step
    input  wire        s_cut_exponent,  // its cut exponent - 2
    input  wire        s_valid,         // an interval of the child
    input  wire        s_axis,          // of an axis of the box
    input  wire [ 5:0] s_axes,          // direction: axes {negated, used}, 3 bit each, x first
    input  wire [51:0] s_least,         // least position, 2^-48
    input  wire [51:0] s_greatest,      // greatest position
    output wire        m_valid,         // a part of the volume
    output wire        m_axis,          // of the box
    output wire [13:0] m_data           // {greatest, least}, or 0 and the cuts {lower, upper}
);

  // ---- 1: whole 2^-24; 2: what they are measured from; 3: how far; 4: in steps or units of cuts
  reg valid_q1, valid_q2, valid_q3, valid_q4, valid_q5;
  reg axis_q1, axis_q2, axis_q3, axis_q4, axis_q5;
  reg [5:0] axes_q1, axes_q2, axes_q3, axes_q4, axes_q5;
  reg signed [27:0] least_q1, least_q2, greatest_q1, greatest_q2;
  reg signed [27:0] lower_q2, upper_q2;  // the node's origin or a corner of the box
  reg signed [28:0] low_q3, high_q3, low_q4, high_q4;
  reg [4:0] shift_q2, shift_q3;
  wire corner = &axes_q1[2:0];

  // ---- both ends of the box on each axis, and what they add to a direction
  wire [83:0] lower_terms, upper_terms;
  reg signed [6:0] least_q5, greatest_q5;
  reg [2:0] lower_q5, upper_q5;
  genvar i;
  generate
    for (i = 0; i < 3; i = i + 1) begin : gen_axis
      wire signed [27:0] origin = {{4{s_origin[18*i+17]}}, s_origin[18*i+:18], 6'd0};
      wire signed [27:0] least = {{21{least_q5[6]}}, least_q5};
      wire signed [27:0] greatest = {{21{greatest_q5[6]}}, greatest_q5};
      reg signed [27:0] least_q, greatest_q;
      always @(posedge clk)
        if (valid_q5 && axis_q5 && axes_q5[i]) begin
          least_q    <= origin + (least <<< s_step);
          greatest_q <= origin + (greatest <<< s_step);
        end
      wire negated = axes_q1[3+i];
      assign lower_terms[28*i+:28] = !axes_q1[i] ? 28'd0 :
          axis_q1 ? origin : negated ? -greatest_q : least_q;
      assign upper_terms[28*i+:28] = !axes_q1[i] ? 28'd0 :
          axis_q1 ? origin : negated ? -least_q : greatest_q;
    end
  endgenerate

  function [2:0] cut_of(input signed [28:0] length);
    cut_of = length < 29'sd0 ? 3'd0 : length > 29'sd7 ? 3'd7 : length[2:0];
  endfunction
  wire signed [28:0] greatest4 = high_q4 > 29'sd63 ? -29'sd63 : -high_q4;
  always @(posedge clk) begin
    {axis_q5, axis_q4, axis_q3, axis_q2, axis_q1} <= {axis_q4, axis_q3, axis_q2, axis_q1, s_axis};
    {axes_q5, axes_q4, axes_q3, axes_q2, axes_q1} <= {axes_q4, axes_q3, axes_q2, axes_q1, s_axes};
    least_q1    <= s_least[51:24];
    greatest_q1 <= s_greatest[51:24] + {27'd0, |s_greatest[23:0]};
    least_q2    <= least_q1;
    greatest_q2 <= greatest_q1;
    lower_q2    <= lower_terms[0+:28] + lower_terms[28+:28] + lower_terms[56+:28];
    upper_q2    <= upper_terms[0+:28] + upper_terms[28+:28] + upper_terms[56+:28];
    // a unit of cuts is 2^(k - 1) steps of a face diagonal, 2^k of a cube diagonal
    shift_q2    <= axis_q1 ? s_step : s_step + 5'd1 + {4'd0, s_cut_exponent} + {4'd0, corner};
    shift_q3    <= shift_q2;
    low_q3      <= {least_q2[27], least_q2} - {lower_q2[27], lower_q2};
    high_q3     <= {upper_q2[27], upper_q2} - {greatest_q2[27], greatest_q2};
    low_q4      <= low_q3 >>> shift_q3;
    high_q4     <= high_q3 >>> shift_q3;
    least_q5    <= low_q4[6:0];
    greatest_q5 <= greatest4[6:0];
    lower_q5    <= cut_of(low_q4);
    upper_q5    <= cut_of(high_q4);
    if (rst) {valid_q5, valid_q4, valid_q3, valid_q2, valid_q1} <= 5'd0;
    else
      {valid_q5, valid_q4, valid_q3, valid_q2, valid_q1} <=
          {valid_q4, valid_q3, valid_q2, valid_q1, s_valid};
  end
  assign m_valid = valid_q5;
  assign m_axis  = axis_q5;
  assign m_data  = axis_q5 ? {greatest_q5, least_q5} : {8'd0, lower_q5, upper_q5};

  wire unused = &{1'b0, axes_q5[5:3], s_least[23:0]};
  always @(posedge clk)
    if (!rst && valid_q4 && axis_q4) begin
      `CCHIP_NARROW(a_least, low_q4[28:6])
      `CCHIP_NARROW(a_greatest, greatest4[28:6])
    end

endmodule
`default_nettype wire
