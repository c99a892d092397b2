// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_axis_controller: sequences the axes of many pairs through one SAT pipeline (paper, figure 6).
//   pair in      never stalls, from the second clock after rst: the owner accepts at most CONTEXTS pairs
//                that have no accepted result
//   beats        one per clock while a pair waits: beats of an EXHAUSTIVE pair leave back to back;
//                otherwise pairs that start and pairs that continue take turns
//   latency      s_pair to its first beat 2 clocks; verdict to the next beat of its pair 3 clocks, to
//                m_result 1 clock
//   cuts         every path
//   reset        empties everything; no pair of before is ever answered
// A pair gets a context: its slot in the operand memory. The owner stores the operands on the clock of
// s_pair under m_load_context and feeds each beat's operands to the pipeline 1 clock after the beat.
// The programme state {context, programme, code, beats, ...} travels with the beat (m_beat_user) and
// comes back with the verdict; which axis follows is decided by cchip_axis_programme.
// EXHAUSTIVE: nA, nB, all e_k x f_l (l runs first) whatever they find, the first separating axis is
// reported; a special case that none separates goes on with its programme. Its verdicts come back to
// back too, so one accumulator serves all. Reserved modes: one idle beat, then axis class ILLEGAL.
module cchip_axis_controller #(
    // pairs in flight
    parameter integer CONTEXTS = 35,
    // width of a context number, bit: at least $clog2(CONTEXTS), at least 1
    parameter integer CONTEXT_W = 6,
    // vertices of A and of B: 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,
    // 1: warped quads are decided exactly; 0: what the directed beats do not decide is left open (definite = 0)
    parameter integer WARPED_EXACT = 1
) (
    input  wire                       clk,
    input  wire                       rst,
    // pairs
    input  wire                       s_pair_valid,
    input  wire [               15:0] s_pair_tag,
    input  wire [                1:0] s_pair_mode,
    input  wire [                3:0] s_pair_err,
    output wire [      CONTEXT_W-1:0] m_load_context,
    // beats to the pipeline and what comes back
    output wire                       m_beat_valid,
    output wire [      CONTEXT_W-1:0] m_beat_context,
    output wire [                8:0] m_beat_code,
    output wire                       m_beat_allow_above,
    output wire                       m_beat_allow_below,
    output wire [     CONTEXT_W+36:0] m_beat_user,
    input  wire                       s_verdict_valid,
    input  wire [     CONTEXT_W+36:0] s_verdict_user,
    input  wire                       s_verdict_separated,
    input  wire                       s_verdict_certain_gap,
    input  wire [VERTS_A+VERTS_B-4:0] s_verdict_negative,
    input  wire [VERTS_A+VERTS_B-4:0] s_verdict_zero,
    input  wire [VERTS_A+VERTS_B-4:0] s_verdict_certain,
    input  wire                       s_verdict_clear,
    input  wire [                2:0] s_verdict_axis_negative,
    input  wire [                2:0] s_verdict_axis_zero,
    input  wire [                1:0] s_verdict_axis_largest,
    input  wire                       s_verdict_box_separated,
    input  wire                       s_verdict_box_certain,
    // results
    output wire                       m_result_valid,
    output wire [               15:0] m_result_tag,
    output wire                       m_result_hit,
    output wire                       m_result_grid,
    output wire                       m_result_definite,
    output wire [                8:0] m_result_axis,
    output wire [                5:0] m_result_beats
);

`include "cchip_defs.vh"

  localparam [31:0] CONTEXT_COUNT = CONTEXTS;
  localparam integer FRESH_W = CONTEXT_W + 1;
  // programme state: {certain, open, beats, info, code, programme}, see cchip_axis_programme
  localparam integer STATE_W = 37;
  localparam [8:0] CODE_FIRST = {`CCHIP_AXIS_NORMAL_A, 6'd0};
  localparam [8:0] CODE_ILLEGAL = {`CCHIP_AXIS_ILLEGAL, 6'd0};
  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;

  generate
    if (CONTEXTS < 1 || CONTEXTS > `CCHIP_CONTEXTS_MAX || (1 << CONTEXT_W) < CONTEXTS) begin : gen_illegal
      cchip_error_CONTEXTS_must_be_1_to_256 u_error ();
    end
    if (WARPED_EXACT != 0 && WARPED_EXACT != 1) begin : gen_illegal_warped
      cchip_error_WARPED_EXACT_must_be_0_or_1 u_error ();
    end
  endgenerate

  // ---- contexts: each number is handed out once after reset, then from the list of those given back
  wire                 outcome;  // the verdict ends its pair
  wire [CONTEXT_W-1:0] verdict_context = s_verdict_user[STATE_W+:CONTEXT_W];
  reg  [  FRESH_W-1:0] fresh_q;
  wire                 fresh_left = fresh_q != CONTEXT_COUNT[FRESH_W-1:0];
  wire                 free_valid, free_ready;
  wire [CONTEXT_W-1:0] free_context;

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
      .s_valid(outcome),
      .s_ready(free_ready),
      .s_data (verdict_context),
      .m_valid(free_valid),
      .m_ready(s_pair_valid & ~fresh_left),
      .m_data (free_context)
  );

  // ---- pairs that wait for their first beat
  wire                 start_valid, start_ready, start_space;
  wire [CONTEXT_W-1:0] start_context;
  wire [          1:0] start_mode;

  cchip_fifo #(
      .WIDTH(CONTEXT_W + 2),
      .DEPTH(CONTEXTS)
  ) u_start (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_pair_valid),
      .s_ready(start_space),
      .s_data ({m_load_context, s_pair_mode}),
      .m_valid(start_valid),
      .m_ready(start_ready),
      .m_data ({start_context, start_mode})
  );

  wire [2:0] start_programme = start_mode == `CCHIP_MODE_EXHAUSTIVE ? `CCHIP_PROG_EXHAUSTIVE
                             : start_mode == `CCHIP_MODE_DIRECTED ? `CCHIP_PROG_NORMALS
                                                                  : `CCHIP_PROG_ILLEGAL;
  wire [8:0] start_code = start_mode[1] ? CODE_ILLEGAL : CODE_FIRST;
  wire [STATE_W-1:0] start_state = {1'b1, 1'b0, 6'd0, 17'd0, start_code, start_programme};

  // ---- pairs that wait for their next beat
  reg                          next_valid_q;
  reg  [CONTEXT_W+STATE_W-1:0] next_q;
  wire                         ready_valid, ready_space, ready_ready;
  wire [CONTEXT_W+STATE_W-1:0] ready_state;

  cchip_fifo #(
      .WIDTH(CONTEXT_W + STATE_W),
      .DEPTH(CONTEXTS)
  ) u_ready (
      .clk    (clk),
      .rst    (rst),
      .s_valid(next_valid_q),
      .s_ready(ready_space),
      .s_data (next_q),
      .m_valid(ready_valid),
      .m_ready(ready_ready),
      .m_data (ready_state)
  );

  // ---- the beat
  reg                          beat_valid_q /* verilator public_flat_rd */;
  reg  [CONTEXT_W+STATE_W-1:0] beat_q;

  wire [2:0] beat_programme = beat_q[2:0];
  wire [8:0] beat_code = beat_q[11:3];
  wire [11:0] beat_info = beat_q[23:12];
  wire [5:0] beat_count = beat_q[34:29];

  // an EXHAUSTIVE pair keeps the pipeline until its last axis
  function last_exhaustive(input [8:0] code);
    last_exhaustive = code == {`CCHIP_AXIS_CROSS, LAST_K[2:0], LAST_L[2:0]};
  endfunction
  wire keep = beat_valid_q && beat_programme == `CCHIP_PROG_EXHAUSTIVE && !last_exhaustive(beat_code);
  reg [8:0] keep_code;
  always @*
    case (beat_code[8:6])
      `CCHIP_AXIS_NORMAL_A: keep_code = {`CCHIP_AXIS_NORMAL_B, 6'd0};
      `CCHIP_AXIS_NORMAL_B: keep_code = {`CCHIP_AXIS_CROSS, 6'd0};
      default:
      keep_code = beat_code[2:0] == LAST_L[2:0] ? {beat_code[8:6], beat_code[5:3] + 3'd1, 3'd0}
                                                : {beat_code[8:3], beat_code[2:0] + 3'd1};
    endcase

  // a pair waits for an axis slot (read by monitors)
  wire pair_waits /* verilator public_flat_rd */ = start_valid | ready_valid | beat_valid_q;
  reg  started_q;  // a pair that started had the last turn
  wire take_start = start_valid & (~ready_valid | ~started_q);
  assign ready_ready = ~keep & ~take_start;
  assign start_ready = ~keep & take_start;

  always @(posedge clk) begin
    if (rst) beat_valid_q <= 1'b0;
    else beat_valid_q <= keep | ready_valid | start_valid;
    if (rst) started_q <= 1'b0;
    else if (!keep) started_q <= take_start;
    if (keep) begin
      beat_q[11:3]  <= keep_code;
      beat_q[34:29] <= beat_count + 6'd1;
    end else beat_q <= take_start ? {start_context, start_state} : ready_state;
  end

  assign m_beat_valid   = beat_valid_q;
  assign m_beat_context = beat_q[STATE_W+:CONTEXT_W];
  assign m_beat_code    = beat_code;
  assign m_beat_user    = beat_q;

  // in-plane axes are one-sided: the own vertices lie on the side of sign(-n_d), d = l
  //   info of DEGENERATE: signs of both normals; of COPLANAR: whether n_d is negative
  wire in_plane_a = beat_code[8:6] == `CCHIP_AXIS_IN_PLANE_A;
  wire in_plane_b = beat_code[8:6] == `CCHIP_AXIS_IN_PLANE_B;
  wire [2:0] normal_negative = in_plane_a ? beat_info[2:0] : beat_info[8:6];
  wire [2:0] normal_zero = in_plane_a ? beat_info[5:3] : beat_info[11:9];
  wire coplanar = beat_programme == `CCHIP_PROG_COPLANAR;
  wire n_negative = coplanar ? (in_plane_a ? beat_info[0] : beat_info[1]) : |(normal_negative & (3'd1 << beat_code[1:0]));
  wire n_zero = ~coplanar & (|(normal_zero & (3'd1 << beat_code[1:0])));
  wire one_sided = in_plane_a | in_plane_b;
  assign m_beat_allow_above = ~one_sided | n_zero | ~n_negative;
  assign m_beat_allow_below = ~one_sided | n_zero | n_negative;

  // ---- what follows from the verdict
  wire [STATE_W-1:0] next_state;
  wire               outcome_grid, outcome_certain, outcome_open, outcome_illegal, proceed;
  wire [        8:0] outcome_witness;
  wire [        5:0] outcome_beats;

  cchip_axis_programme #(
      .VERTS_A     (VERTS_A),
      .VERTS_B     (VERTS_B),
      .WARPED_EXACT(WARPED_EXACT)
  ) u_programme (
      .clk            (clk),
      .s_valid        (s_verdict_valid),
      .s_state        (s_verdict_user[STATE_W-1:0]),
      .s_separated    (s_verdict_separated),
      .s_certain_gap  (s_verdict_certain_gap),
      .s_negative     (s_verdict_negative),
      .s_zero         (s_verdict_zero),
      .s_certain      (s_verdict_certain),
      .s_clear        (s_verdict_clear),
      .s_axis_negative(s_verdict_axis_negative),
      .s_axis_zero    (s_verdict_axis_zero),
      .s_axis_largest (s_verdict_axis_largest),
      .s_box_separated(s_verdict_box_separated),
      .s_box_certain  (s_verdict_box_certain),
      .m_outcome      (outcome),
      .m_grid         (outcome_grid),
      .m_certain      (outcome_certain),
      .m_open         (outcome_open),
      .m_illegal      (outcome_illegal),
      .m_witness      (outcome_witness),
      .m_beats        (outcome_beats),
      .m_proceed      (proceed),
      .m_state        (next_state)
  );

  always @(posedge clk) begin
    if (rst) next_valid_q <= 1'b0;
    else next_valid_q <= proceed;
    next_q <= {verdict_context, next_state};
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
      .read_addr (verdict_context),
      .read_data (side)
  );

  reg result_valid_q, grid_q, certain_q, open_q, illegal_q;
  reg [8:0] witness_q;
  reg [5:0] beats_q;
  always @(posedge clk) begin
    if (rst) result_valid_q <= 1'b0;
    else result_valid_q <= outcome;
    grid_q    <= outcome_grid;
    certain_q <= outcome_certain;
    open_q    <= outcome_open;
    illegal_q <= outcome_illegal;
    witness_q <= outcome_witness;
    beats_q   <= outcome_beats;
  end

  wire err_none = side[19:16] == 4'd0;
  wire err_unknown = &side[19:16];

  assign m_result_valid    = result_valid_q;
  assign m_result_tag      = side[15:0];
  assign m_result_grid     = grid_q;
  assign m_result_definite = ~illegal_q & (err_none ? certain_q | ~open_q : certain_q & ~err_unknown);
  assign m_result_hit      = m_result_grid | ~m_result_definite;
  assign m_result_axis     = witness_q;
  assign m_result_beats    = beats_q;

`include "cchip_assert.vh"
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_context_free, !s_pair_valid || fresh_left || free_valid)
      `CCHIP_ASSERT(a_start_space, !s_pair_valid || start_space)
      `CCHIP_ASSERT(a_free_space, !outcome || free_ready)
      `CCHIP_ASSERT(a_ready_space, !next_valid_q || ready_space)
      `CCHIP_ASSERT(a_verdict_ends_or_proceeds, !(outcome && proceed))
    end

endmodule
`default_nettype wire
