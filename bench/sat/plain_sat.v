// SPDX-License-Identifier: Apache-2.0
`default_nettype none
`include "cchip_defs.vh"
// plain_sat: triangle against triangle by eleven axes, as a textbook has it. A yardstick for the
// benchmark in bench/sat, no part of the product.
//   axes         the normals of A and B, then the nine cross products of their edges
//   latency      28 clocks from handshake of s_pair to m_result_valid
//   throughput   one axis per clock: a pair per 11 clocks, whatever its answer
//   multipliers  6 for the axis, 36 for six vertices on it: 42 blocks of 18 x 18 bit
//   numbers      integers, no rounding: an axis has 2*COORD_W+2 bits, a projection 3*COORD_W+4
//   reset        drops the pairs inside
// The ports are those of a primitive test, so that one harness measures both. It takes any mode and
// gives no witness: m_result_axis is 0, m_result_beats 11.
// definite: with error 0, any positive gap proves "no"; "yes" is proved unless the triangles are
// coplanar or one is degenerate, where eleven axes do not suffice. With error eta, a gap over eta
// times the 1-norm of its axis proves "no", an overlap over that on every axis proves "yes": then
// the cube of the error lies inside the difference of the triangles. Error 15: never definite.
// PLAIN_SAT_FAULT puts in a fault, for tests: 1 calls touching apart, 2 trusts flat axes.
`ifndef PLAIN_SAT_FAULT
`define PLAIN_SAT_FAULT 0
`endif
module plain_sat #(
    parameter integer COORD_W = 16  // width of a signed coordinate (bit); legal: 4..16
) (
    input  wire                                   clk,
    input  wire                                   rst,
    input  wire                                   s_pair_valid,
    output wire                                   s_pair_ready,
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,
    output wire                                   m_result_valid,
    input  wire                                   m_result_ready,
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,
    output wire                                   m_result_hit,
    output wire                                   m_result_grid,
    output wire                                   m_result_definite,
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,
    output wire                                   idle
);

  localparam integer P_W = 3 * COORD_W;  // point
  localparam integer T_W = 3 * P_W;  // triangle
  localparam integer E_W = COORD_W + 1;  // component of an edge
  localparam integer L_W = 2 * COORD_W + 2;  // component of an axis
  localparam integer D_W = 3 * COORD_W + 4;  // projection
  localparam integer G_W = D_W + 1;  // gap
  localparam integer N_W = L_W + 1;  // 1-norm of an axis
  localparam integer B_W = N_W + `CCHIP_ERR_W;  // eta times the norm, less than a gap's width
  localparam integer LAST = 10;  // axis
  // clocks from the choice of an axis to its components, its norm, its flags
  localparam integer AT_AXIS = 5;
  localparam integer AT_NORM = 8;
  localparam integer AT_FLAGS = 16;
  localparam signed [G_W-1:0] FAULT_OF_GAP = `PLAIN_SAT_FAULT == 1 ? 1 : 0;
  localparam [2:0] ROOM = 3'd4;  // pairs inside and in the queue

  // ---- 0: a pair is held for eleven clocks
  reg [T_W-1:0] a_q, b_q;
  reg [`CCHIP_ERR_W-1:0] err_q;
  reg [3:0] step_q;
  reg busy_q;
  reg [2:0] free_q;
  wire take = s_pair_valid && s_pair_ready;
  wire give = m_result_valid && m_result_ready;
  wire last = busy_q && step_q == LAST[3:0];
  assign s_pair_ready = (!busy_q || last) && free_q != 3'd0 && !rst;
  always @(posedge clk) begin
    if (take) {err_q, b_q, a_q} <= {s_pair_err, s_pair_b[T_W-1:0], s_pair_a[T_W-1:0]};
    step_q <= take ? 4'd0 : step_q + 4'd1;
    busy_q <= !rst && (take || (busy_q && !last));
    free_q <= rst ? ROOM : free_q - {2'd0, take} + {2'd0, give};
  end

  // ---- 1: ends of the two edges, 2: the edges
  reg [P_W-1:0] e_from, e_to, f_from, f_to;
  reg [1:0] k, l;  // edges of A and B
  function [P_W-1:0] vertex(input [T_W-1:0] triangle, input [1:0] i);
    vertex = i == 2'd0 ? triangle[0+:P_W] : i == 2'd1 ? triangle[P_W+:P_W] : triangle[2*P_W+:P_W];
  endfunction
  function [1:0] next(input [1:0] i);
    next = i == 2'd2 ? 2'd0 : i + 2'd1;
  endfunction
  always @(posedge clk) begin
    if (take) {k, l} <= 4'd0;
    else if (step_q >= 4'd2) {k, l} <= l == 2'd2 ? {k + 2'd1, 2'd0} : {k, l + 2'd1};
    e_from <= step_q == 4'd1 ? vertex(b_q, 2'd0) : vertex(a_q, step_q == 4'd0 ? 2'd0 : k);
    e_to   <= step_q == 4'd1 ? vertex(b_q, 2'd1) : vertex(a_q, step_q == 4'd0 ? 2'd1 : next(k));
    f_from <= step_q == 4'd0 ? vertex(a_q, 2'd0) : vertex(b_q, step_q == 4'd1 ? 2'd0 : l);
    f_to   <= step_q == 4'd0 ? vertex(a_q, 2'd2) : vertex(b_q, step_q == 4'd1 ? 2'd2 : next(l));
  end

  // ---- 3, 4: products, 5: components of the axis
  wire signed [E_W-1:0] e[0:2], f[0:2];
  wire signed [L_W-1:0] axis[0:2];
  genvar c, v;
  generate
    for (c = 0; c < 3; c = c + 1) begin : gen_axis
      localparam integer I = (c + 1) % 3;
      localparam integer J = (c + 2) % 3;
      reg signed [E_W-1:0] e_q, f_q;
      reg signed [L_W-1:0] axis_q;
      wire signed [35:0] plus, minus;
      always @(posedge clk) begin
        e_q <= $signed(e_to[c*COORD_W+:COORD_W]) - $signed(e_from[c*COORD_W+:COORD_W]);
        f_q <= $signed(f_to[c*COORD_W+:COORD_W]) - $signed(f_from[c*COORD_W+:COORD_W]);
        axis_q <= plus[L_W-1:0] - minus[L_W-1:0];
      end
      assign e[c] = e_q;
      assign f[c] = f_q;
      assign axis[c] = axis_q;
      cchip_mul18 u_plus (.clk(clk), .a({{18 - E_W{e[I][E_W-1]}}, e[I]}),
                          .b({{18 - E_W{f[J][E_W-1]}}, f[J]}), .p(plus));
      cchip_mul18 u_minus (.clk(clk), .a({{18 - E_W{e[J][E_W-1]}}, e[J]}),
                           .b({{18 - E_W{f[I][E_W-1]}}, f[I]}), .p(minus));
      wire unused_high = &{1'b0, plus, minus};
    end
  endgenerate

  // ---- beside the axis: is there one, is it a normal, the last; is the error 0, is it known
  reg [AT_FLAGS:1] valid_q, normal_q, last_q, exact_q, known_q;
  reg [2*T_W-1:0] pair_q5;  // the pair of the axis: six vertices
  always @(posedge clk) begin
    valid_q  <= {valid_q[AT_FLAGS-1:1], busy_q} & {AT_FLAGS{!rst}};
    normal_q <= {normal_q[AT_FLAGS-1:1], step_q <= 4'd1};
    last_q   <= {last_q[AT_FLAGS-1:1], last};
    exact_q  <= {exact_q[AT_FLAGS-1:1], err_q == {`CCHIP_ERR_W{1'b0}}};
    known_q  <= {known_q[AT_FLAGS-1:1], err_q != {`CCHIP_ERR_W{1'b1}}};
    // the pair is still held when its first axis is ready
    if (valid_q[AT_AXIS-1] && normal_q[AT_AXIS-1]) pair_q5 <= {b_q, a_q};
  end

  // ---- 6, 7: products, the axis in two limbs; 8: joined; 9, 10: summed
  wire signed [D_W-1:0] along[0:5];
  generate
    for (v = 0; v < 6; v = v + 1) begin : gen_vertex
      wire signed [D_W-1:0] term[0:2];
      reg signed [D_W-1:0] two_q, third_q, along_q;
      for (c = 0; c < 3; c = c + 1) begin : gen_component
        wire [COORD_W-1:0] x = pair_q5[v*P_W+c*COORD_W+:COORD_W];
        wire signed [35:0] axis_wide = {{36 - L_W{axis[c][L_W-1]}}, axis[c]};
        wire signed [17:0] factor = {{18 - COORD_W{x[COORD_W-1]}}, x};
        wire signed [35:0] low, high;
        cchip_mul18 u_low (.clk(clk), .a({1'b0, axis_wide[16:0]}), .b(factor), .p(low));
        cchip_mul18 u_high (.clk(clk), .a(axis_wide[34:17]), .b(factor), .p(high));
        wire signed [52:0] wide = $signed({high, 17'd0}) + $signed({{17{low[35]}}, low});
        reg signed [D_W-1:0] term_q;
        always @(posedge clk) term_q <= wide[D_W-1:0];
        assign term[c] = term_q;
        wire unused_ends = &{1'b0, wide, axis_wide[35]};
      end
      always @(posedge clk) begin
        two_q   <= term[0] + term[1];
        third_q <= term[2];
        along_q <= two_q + third_q;
      end
      assign along[v] = along_q;
    end
  endgenerate

  // ---- 11, 12: ends of both intervals; 13: gaps to either side; 14: the larger one
  wire signed [D_W-1:0] least[0:1], greatest[0:1];
  reg signed [G_W-1:0] gap_up, gap_down, gap_q14;
  reg flat_q14;
  generate
    for (v = 0; v < 2; v = v + 1) begin : gen_side
      reg signed [D_W-1:0] least_of_two, greatest_of_two, third, least_q, greatest_q;
      always @(posedge clk) begin
        least_of_two <= along[3*v] < along[3*v+1] ? along[3*v] : along[3*v+1];
        greatest_of_two <= along[3*v] < along[3*v+1] ? along[3*v+1] : along[3*v];
        third <= along[3*v+2];
        least_q <= third < least_of_two ? third : least_of_two;
        greatest_q <= third < greatest_of_two ? greatest_of_two : third;
      end
      assign least[v] = least_q;
      assign greatest[v] = greatest_q;
    end
  endgenerate
  always @(posedge clk) begin
    gap_up   <= {least[1][D_W-1], least[1]} - {greatest[0][D_W-1], greatest[0]};
    gap_down <= {least[0][D_W-1], least[0]} - {greatest[1][D_W-1], greatest[1]};
    gap_q14  <= (gap_up < gap_down ? gap_down : gap_up) + FAULT_OF_GAP;
    flat_q14 <= !(|gap_up) && !(|gap_down);  // the axis sees one point
  end

  // ---- beside it: the error's share, eta times the 1-norm of the axis
  reg [`CCHIP_ERR_W-1:0] err_q8;
  reg [L_W-1:0] size_x, size_y, size_z;
  reg [N_W-1:0] norm_two, norm_third, norm_q;
  reg [B_W-1:0] bound_low, bound_high, bound_q;
  wire [B_W-1:0] norm = {{`CCHIP_ERR_W{1'b0}}, norm_q};
  always @(posedge clk) begin
    if (valid_q[AT_NORM-1] && normal_q[AT_NORM-1]) err_q8 <= err_q;
    size_x     <= axis[0][L_W-1] ? -axis[0] : axis[0];
    size_y     <= axis[1][L_W-1] ? -axis[1] : axis[1];
    size_z     <= axis[2][L_W-1] ? -axis[2] : axis[2];
    norm_two   <= {1'b0, size_x} + {1'b0, size_y};
    norm_third <= {1'b0, size_z};
    norm_q     <= norm_two + norm_third;
    bound_low  <= (err_q8[0] ? norm : {B_W{1'b0}}) + (err_q8[1] ? norm << 1 : {B_W{1'b0}});
    bound_high <= (err_q8[2] ? norm << 2 : {B_W{1'b0}}) + (err_q8[3] ? norm << 3 : {B_W{1'b0}});
    bound_q    <= bound_low + bound_high;
  end
  reg [B_W-1:0] bound_q11, bound_q12, bound_q13, bound_q14;
  wire signed [G_W-1:0] bound = {{G_W - B_W{1'b0}}, bound_q14};

  // ---- 15, 16: flags of the axis
  reg signed [G_W-1:0] beyond_q, within_q;
  reg apart_q15, flat_q15, apart_q, far_q, deep_q;
  always @(posedge clk) begin
    {bound_q14, bound_q13, bound_q12, bound_q11} <= {bound_q13, bound_q12, bound_q11, bound_q};
    beyond_q  <= bound - gap_q14;  // negative: the gap is over the bound
    within_q  <= gap_q14 + bound;  // negative: the overlap is over the bound
    apart_q15 <= !gap_q14[G_W-1] && |gap_q14;
    flat_q15  <= flat_q14;
    apart_q   <= apart_q15;
    far_q     <= beyond_q[G_W-1];
    deep_q    <= flat_q15 ? !normal_q[AT_FLAGS-1] || `PLAIN_SAT_FAULT == 2
                          : within_q[G_W-1] || (exact_q[AT_FLAGS-1] && !apart_q15);
  end

  // ---- 17: all axes of the pair
  reg any_apart, any_far, all_deep, known, first_q, done_q;
  always @(posedge clk) begin
    done_q <= valid_q[AT_FLAGS] && last_q[AT_FLAGS] && !rst;
    if (rst) first_q <= 1'b1;
    else if (valid_q[AT_FLAGS]) first_q <= last_q[AT_FLAGS];
    if (valid_q[AT_FLAGS]) begin
      any_apart <= apart_q || (any_apart && !first_q);
      any_far   <= far_q || (any_far && !first_q);
      all_deep  <= deep_q && (all_deep || first_q);
      known     <= known_q[AT_FLAGS];
    end
  end

  // ---- 18: tags and answers wait in order
  reg [`CCHIP_TAG_W-1:0] tags[0:3];
  reg [1:0] answers[0:3];  // grid, definite
  reg [1:0] take_q, done_at_q, give_q;
  reg [2:0] waiting_q;
  always @(posedge clk) begin
    if (take) tags[take_q] <= s_pair_tag;
    if (done_q) answers[done_at_q] <= {!any_apart, known && (any_far || all_deep)};
    take_q    <= rst ? 2'd0 : take_q + {1'b0, take};
    done_at_q <= rst ? 2'd0 : done_at_q + {1'b0, done_q};
    give_q    <= rst ? 2'd0 : give_q + {1'b0, give};
    waiting_q <= rst ? 3'd0 : waiting_q + {2'd0, done_q} - {2'd0, give};
  end
  assign m_result_valid = waiting_q != 3'd0;
  assign m_result_tag = tags[give_q];
  assign {m_result_grid, m_result_definite} = answers[give_q];
  assign m_result_hit = m_result_grid || !m_result_definite;
  assign m_result_axis = {`CCHIP_AXIS_CODE_W{1'b0}};
  assign m_result_beats = 6'd11;
  assign rm_id = {`CCHIP_RM_ID_W{1'b0}};
  assign idle = free_q == ROOM;
  wire unused = &{1'b0, s_pair_mode, s_pair_a, s_pair_b};

endmodule
`default_nettype wire
