// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// tri_tri_instance: the triangle test in a design, with 16-bit coordinates. A pair goes in, its
// answer comes out under the same tag, both by valid and ready. A triangle is its vertices
// {2, 1, 0}, a vertex its coordinates {z, y, x}.
module tri_tri_instance (
    input  wire         clk,
    input  wire         rst,
    input  wire         pair_valid,
    output wire         pair_ready,
    input  wire  [15:0] pair_tag,
    input  wire [143:0] triangle_a,
    input  wire [143:0] triangle_b,
    input  wire   [3:0] eta,
    output wire         result_valid,
    input  wire         result_ready,
    output wire  [15:0] result_tag,
    output wire         result_hit,
    output wire         result_definite
);
    wire       unused_grid, unused_idle;
    wire [8:0] unused_axis;
    wire [5:0] unused_beats;
    wire [7:0] unused_rm_id;
    wire       unused = &{1'b0, unused_grid, unused_idle, unused_axis, unused_beats, unused_rm_id};

    cchip_primtest_tri_tri u_tri_tri (
        .clk(clk), .rst(rst), .s_pair_mode(2'd1),  // DIRECTED
        .s_pair_valid(pair_valid), .s_pair_ready(pair_ready), .s_pair_tag(pair_tag),
        .s_pair_a({48'd0, triangle_a}), .s_pair_b({48'd0, triangle_b}), .s_pair_err(eta),
        .m_result_valid(result_valid), .m_result_ready(result_ready), .m_result_tag(result_tag),
        .m_result_hit(result_hit), .m_result_definite(result_definite),
        .m_result_grid(unused_grid), .m_result_axis(unused_axis), .m_result_beats(unused_beats),
        .rm_id(unused_rm_id), .idle(unused_idle));
endmodule
`default_nettype wire
