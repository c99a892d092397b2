// SPDX-License-Identifier: Apache-2.0
`include "cchip_defs.vh"
`default_nettype none
// fpga_harness: a module with the streams of a primitive test on three pins, for place and route alone.
//   d      shifted along a register; the exclusive or of two neighbours in it is registered again for each input of
//          the module (without the exclusive or synthesis would merge both registers)
//   q      all outputs of the module, registered, then folded by exclusive or, two levels of at most five inputs
// Every input comes from and every output goes to a register of its own, so that the slowest path is the module's.
// Its hierarchy is kept in synthesis: nothing of the module depends on the harness, its cells are counted alone.
// Macros: CCHIP_FPGA_TOP the module, CCHIP_FPGA_COORD_W its COORD_W, CCHIP_FPGA_PARAMETERS further parameters,
// each with a comma in front, as ",.SUBSTAGES(8)".
`ifndef CCHIP_FPGA_TOP
`define CCHIP_FPGA_TOP cchip_primtest_tri_tri
`endif
`ifndef CCHIP_FPGA_COORD_W
`define CCHIP_FPGA_COORD_W `CCHIP_COORD_W_DEFAULT
`endif
`ifndef CCHIP_FPGA_PARAMETERS
`define CCHIP_FPGA_PARAMETERS
`endif
module fpga_harness (
    input  wire clk,
    input  wire d,
    output reg  q
);

  localparam integer SLOTS_W = 3 * `CCHIP_VERTICES * `CCHIP_FPGA_COORD_W;
  localparam integer IN_W = 2 * SLOTS_W + `CCHIP_ERR_W + `CCHIP_MODE_W + `CCHIP_TAG_W + 3;
  // at most 625
  localparam integer OUT_W = `CCHIP_TAG_W + `CCHIP_AXIS_CODE_W + `CCHIP_BEATS_W + `CCHIP_RM_ID_W + 6;
  localparam integer FOLD_W = (OUT_W + 4) / 5;
  localparam integer FOLD2_W = (FOLD_W + 4) / 5;

  reg  [   IN_W-1:0] shift;
  reg  [   IN_W-1:0] in;
  wire [  OUT_W-1:0] out;
  // padded to whole groups of five
  reg  [5*FOLD_W-1:0] out_r;
  reg  [5*FOLD2_W-1:0] fold;
  reg  [FOLD2_W-1:0] fold2;
  integer i;

  (* keep_hierarchy *)
  `CCHIP_FPGA_TOP #(
      .COORD_W(`CCHIP_FPGA_COORD_W) `CCHIP_FPGA_PARAMETERS
  ) u_dut (
      .clk              (clk),
      .rst              (in[0]),
      .s_pair_valid     (in[1]),
      .m_result_ready   (in[2]),
      .s_pair_tag       (in[3+:`CCHIP_TAG_W]),
      .s_pair_mode      (in[3+`CCHIP_TAG_W+:`CCHIP_MODE_W]),
      .s_pair_err       (in[3+`CCHIP_TAG_W+`CCHIP_MODE_W+:`CCHIP_ERR_W]),
      .s_pair_a         (in[IN_W-SLOTS_W-1-:SLOTS_W]),
      .s_pair_b         (in[IN_W-1-:SLOTS_W]),
      .s_pair_ready     (out[0]),
      .m_result_valid   (out[1]),
      .m_result_hit     (out[2]),
      .m_result_grid    (out[3]),
      .m_result_definite(out[4]),
      .idle             (out[5]),
      .m_result_tag     (out[6+:`CCHIP_TAG_W]),
      .m_result_axis    (out[6+`CCHIP_TAG_W+:`CCHIP_AXIS_CODE_W]),
      .m_result_beats   (out[6+`CCHIP_TAG_W+`CCHIP_AXIS_CODE_W+:`CCHIP_BEATS_W]),
      .rm_id            (out[OUT_W-1-:`CCHIP_RM_ID_W])
  );

  always @(posedge clk) begin
    shift <= {shift[IN_W-2:0], d};
    in <= shift ^ {shift[IN_W-2:0], shift[IN_W-1]};
    out_r <= {{(5 * FOLD_W - OUT_W) {1'b0}}, out};
    fold <= {5 * FOLD2_W{1'b0}};
    for (i = 0; i < FOLD_W; i = i + 1) fold[i] <= ^out_r[5*i+:5];
    for (i = 0; i < FOLD2_W; i = i + 1) fold2[i] <= ^fold[5*i+:5];
    q <= ^fold2;
  end

endmodule
`default_nettype wire
