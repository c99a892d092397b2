// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_axis_controller: sequences the axes of many pairs through one SAT pipeline (paper, figure 6).
//   pair in      never stalls: the owner accepts at most CONTEXTS pairs that have no accepted result
//   beats        one per clock while a pair waits; beats of a pair leave back to back
//   latency      s_pair to its first beat 2 clocks, last verdict to m_result 1 clock
//   cuts         every path except s_pair_valid -> m_load (the context being loaded)
//   reset        empties everything; no pair of before is ever answered
// A pair gets a context: its slot in the operand memory. The owner stores the operands on the clock of
// s_pair under m_load_context and feeds each beat's operands to the pipeline 1 clock after the beat.
// {context, code} travels with the beat; a verdict returns it.
// Programmes: EXHAUSTIVE = nA, nB, e_k x f_l (l runs first), 11 beats whatever they find; the first
// separating axis is reported. Every other mode is a reserved request: one idle beat of class ILLEGAL, then
// hit = 1, definite = 0, beats = 0.
// Coplanar and degenerate pairs (nA or nB zero, or all of B in A's plane) that no axis separates are
// left open: definite = 0.
module cchip_axis_controller #(
    // pairs in flight
    parameter integer CONTEXTS = 34,
    // width of a context number, bit: at least $clog2(CONTEXTS), at least 1
    parameter integer CONTEXT_W = 6
) (
    input  wire                 clk,
    input  wire                 rst,
    // pairs
    input  wire                 s_pair_valid,
    input  wire [         15:0] s_pair_tag,
    input  wire [          1:0] s_pair_mode,
    input  wire [          3:0] s_pair_err,
    output wire [CONTEXT_W-1:0] m_load_context,
    // beats to the pipeline and what comes back
    output wire                 m_beat_valid,
    output wire [CONTEXT_W-1:0] m_beat_context,
    output wire [          8:0] m_beat_code,
    input  wire                 s_verdict_valid,
    input  wire [CONTEXT_W-1:0] s_verdict_context,
    input  wire [          8:0] s_verdict_code,
    input  wire                 s_verdict_separated,
    input  wire                 s_verdict_axis_zero,
    input  wire [          2:0] s_verdict_zero,
    // results
    output wire                 m_result_valid,
    output wire [         15:0] m_result_tag,
    output wire                 m_result_hit,
    output wire                 m_result_grid,
    output wire                 m_result_definite,
    output wire [          8:0] m_result_axis,
    output wire [          5:0] m_result_beats
);

`include "cchip_defs.vh"

  localparam [31:0] CONTEXT_COUNT = CONTEXTS;
  localparam integer FRESH_W = CONTEXT_W + 1;
  localparam [8:0] CODE_FIRST = {`CCHIP_AXIS_NORMAL_A, 6'd0};
  localparam [8:0] CODE_ILLEGAL = {`CCHIP_AXIS_ILLEGAL, 6'd0};
  localparam [8:0] CODE_LAST = {`CCHIP_AXIS_CROSS, 3'd2, 3'd2};
  localparam [31:0] EXHAUSTIVE_BEATS = `CCHIP_EXHAUSTIVE_BEATS_TRI_TRI;

  generate
    if (CONTEXTS < 1 || CONTEXTS > `CCHIP_CONTEXTS_MAX || (1 << CONTEXT_W) < CONTEXTS) begin : gen_illegal
      cchip_error_CONTEXTS_must_be_1_to_256 u_error ();
    end
  endgenerate

  wire last_verdict;

  // ---- contexts: each number is handed out once after reset, then from the list of those given back
  reg  [  FRESH_W-1:0] fresh_q;
  wire                 fresh_left = fresh_q != CONTEXT_COUNT[FRESH_W-1:0];
  wire                 free_valid;
  wire [CONTEXT_W-1:0] free_context;
  wire                 free_ready;

  assign m_load_context = fresh_left ? fresh_q[CONTEXT_W-1:0] : free_context;

  always @(posedge clk)
    if (rst) fresh_q <= {FRESH_W{1'b0}};
    else if (s_pair_valid && fresh_left) fresh_q <= fresh_q + {{FRESH_W - 1{1'b0}}, 1'b1};

  cchip_fifo #(
      .WIDTH(CONTEXT_W),
      .DEPTH(CONTEXTS)
  ) u_free (
      .clk    (clk),
      .rst    (rst),
      .s_valid(last_verdict),
      .s_ready(free_ready),
      .s_data (s_verdict_context),
      .m_valid(free_valid),
      .m_ready(s_pair_valid & ~fresh_left),
      .m_data (free_context)
  );

  // ---- pairs that wait for their first beat
  wire                 start_valid, start_ready, start_space;
  wire [CONTEXT_W-1:0] start_context;
  wire                 start_legal;

  cchip_fifo #(
      .WIDTH(CONTEXT_W + 1),
      .DEPTH(CONTEXTS)
  ) u_start (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_pair_valid),
      .s_ready(start_space),
      .s_data ({m_load_context, s_pair_mode == `CCHIP_MODE_EXHAUSTIVE}),
      .m_valid(start_valid),
      .m_ready(start_ready),
      .m_data ({start_context, start_legal})
  );

  // ---- the pair whose axes are being issued; its registers are the beat
  reg                  beat_valid_q /* verilator public_flat_rd */;
  reg  [CONTEXT_W-1:0] beat_context_q;
  reg  [          8:0] beat_code_q;

  function last_code(input [8:0] code);
    last_code = code == CODE_LAST || code == CODE_ILLEGAL;
  endfunction

  function [8:0] next_code(input [8:0] code);
    case (code[8:6])
      `CCHIP_AXIS_NORMAL_A: next_code = {`CCHIP_AXIS_NORMAL_B, 6'd0};
      `CCHIP_AXIS_NORMAL_B: next_code = {`CCHIP_AXIS_CROSS, 6'd0};
      default:
      next_code = code[2:0] == 3'd2 ? {code[8:6], code[5:3] + 3'd1, 3'd0}
                                    : {code[8:3], code[2:0] + 3'd1};
    endcase
  endfunction

  // a pair waits for an axis slot (read by monitors)
  wire pair_waits /* verilator public_flat_rd */ = start_valid | beat_valid_q;
  assign start_ready = ~beat_valid_q | last_code(beat_code_q);

  always @(posedge clk) begin
    if (rst) beat_valid_q <= 1'b0;
    else if (start_ready) beat_valid_q <= start_valid;
    if (start_ready) begin
      beat_context_q <= start_context;
      beat_code_q    <= start_legal ? CODE_FIRST : CODE_ILLEGAL;
    end else beat_code_q <= next_code(beat_code_q);
  end

  assign m_beat_valid   = beat_valid_q;
  assign m_beat_context = beat_context_q;
  assign m_beat_code    = beat_code_q;

  // ---- verdicts of one pair come back to back: one accumulator
  reg         separated_q, special_q;
  reg  [ 8:0] witness_q;
  wire        first_verdict = s_verdict_code == CODE_FIRST;
  wire        separated_before = ~first_verdict & separated_q;
  wire        separated = separated_before | s_verdict_separated;
  wire [ 8:0] witness = separated_before ? witness_q : s_verdict_separated ? s_verdict_code : 9'd0;
  wire        normal_a = s_verdict_code[8:6] == `CCHIP_AXIS_NORMAL_A;
  wire        normal_b = s_verdict_code[8:6] == `CCHIP_AXIS_NORMAL_B;
  wire        special = (~first_verdict & special_q) | (normal_a & (s_verdict_axis_zero | &s_verdict_zero))
                        | (normal_b & s_verdict_axis_zero);
  assign last_verdict = s_verdict_valid & last_code(s_verdict_code);

  always @(posedge clk)
    if (s_verdict_valid) begin
      separated_q <= separated;
      special_q   <= special;
      witness_q   <= witness;
    end

  // ---- result: tag and eta of the context arrive with the registered outcome
  wire [19:0] side;
  cchip_ram #(
      .WIDTH (20),
      .DEPTH (CONTEXTS),
      .ADDR_W(CONTEXT_W)
  ) u_side (
      .clk       (clk),
      .write     (s_pair_valid),
      .write_addr(m_load_context),
      .write_data({s_pair_err, s_pair_tag}),
      .read_addr (s_verdict_context),
      .read_data (side)
  );

  reg result_valid_q, grid_q, open_q, illegal_q;
  always @(posedge clk) begin
    if (rst) result_valid_q <= 1'b0;
    else result_valid_q <= last_verdict;
    illegal_q <= s_verdict_code == CODE_ILLEGAL;
    grid_q    <= ~separated;
    open_q    <= special & ~separated;
  end

  assign m_result_valid    = result_valid_q;
  assign m_result_tag      = side[15:0];
  assign m_result_grid     = grid_q | illegal_q;
  assign m_result_definite = side[19:16] == 4'd0 & ~open_q & ~illegal_q;
  assign m_result_hit      = m_result_grid | ~m_result_definite;
  assign m_result_axis     = illegal_q ? CODE_ILLEGAL : witness_q;
  assign m_result_beats    = illegal_q ? 6'd0 : EXHAUSTIVE_BEATS[5:0];

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_context_free, !s_pair_valid || fresh_left || free_valid)
      `CCHIP_ASSERT(a_start_space, !s_pair_valid || start_space)
      `CCHIP_ASSERT(a_free_space, !last_verdict || free_ready)
    end

endmodule
`default_nettype wire
