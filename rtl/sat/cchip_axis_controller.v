// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_axis_controller: sequences the axes of many pairs through one SAT pipeline (paper, figure
// 6).
//   pair in      never stalls, from the third clock after rst: the owner accepts at most CONTEXTS
//                pairs whose result has not left at least three clocks ago
//   beats        one per clock while a pair waits: beats of an EXHAUSTIVE pair leave back to back;
//                otherwise pairs that start and pairs that continue alternate
//   latency      s_pair to its first beat 4 clocks; verdict to m_result CCHIP_PROGRAMME_LATENCY
//                clocks, to the next beat of its pair 3 more
//   reset        empties everything; no earlier pair is ever answered
// A pair gets a context: its slot in the operand memory. The owner stores the operands of s_pair
// under m_load_context; each beat's operands reach the pipeline CCHIP_RAM_LATENCY clocks after the
// beat.
// The programme state {context, programme, code, beats, ...} travels with the beat (m_beat_user)
// and comes back with the verdict; which axis follows is decided by cchip_axis_programme.
// EXHAUSTIVE: nA, nB, all e_k x f_l (l runs first) to the end; the first separating axis is
// reported; a special case that none separates continues with its programme. Its verdicts come back
// to back too, so one accumulator serves all. Reserved modes: one idle beat, then axis class
// ILLEGAL; mode EXHAUSTIVE is reserved, too, if the parameter EXHAUSTIVE is 0.
module cchip_axis_controller #(
    parameter integer CONTEXTS = 42,    // pairs in flight; legal: 1..256
    // width of a context number (bit); legal: >= 1, 2^CONTEXT_W >= CONTEXTS
    parameter integer CONTEXT_W = 6,
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3,      // vertices of B (vertex); legal: VERTS_A..4
    // 1: warped quads are decided exactly; 0: what the directed beats do not decide of a warped
    // quad is left open (definite = 0); legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    // 1: both modes; 0: mode EXHAUSTIVE is reserved and its logic is absent; legal: 0, 1
    parameter integer EXHAUSTIVE = 1
) (
    input  wire                                clk,                      // clock, rising edge
    input  wire                                rst,  // synchronous reset, active high
    // ---- pairs
    // there is a pair; it is always taken, from the third clock after rst on
    input  wire                                s_pair_valid,
    // 0 EXHAUSTIVE, 1 DIRECTED, 2 and 3 reserved
    input  wire [           `CCHIP_MODE_W-1:0] s_pair_mode,
    // its tag, returned with the result; one clock after s_pair_valid
    input  wire [            `CCHIP_TAG_W-1:0] s_pair_tag,
    // eta, error bound of the pair in grid steps; one clock after s_pair_valid
    input  wire [            `CCHIP_ERR_W-1:0] s_pair_err,
    // context under which the owner stores the operands if s_pair_valid = 1 on this clock
    output wire [               CONTEXT_W-1:0] m_load_context,
    // ---- beats to the pipeline and what comes back
    output wire                                m_beat_valid,             // there is a beat
    output wire [               CONTEXT_W-1:0] m_beat_context,           // whose operands it needs
    // axis code {class[2:0], k[2:0], l[2:0]}
    output wire [      `CCHIP_AXIS_CODE_W-1:0] m_beat_code,
    // the other primitive may be found separated above the own one; one clock after the beat
    output wire                                m_beat_allow_above,
    // below; one clock after the beat
    output wire                                m_beat_allow_below,
    // {context, programme state}; comes back with the verdict
    output wire [CONTEXT_W+`CCHIP_STATE_W-1:0] m_beat_user,
    // there is a verdict; it is always taken
    input  wire                                s_verdict_valid,
    input  wire [CONTEXT_W+`CCHIP_STATE_W-1:0] s_verdict_user,           // m_beat_user of its beat
    input  wire                                s_verdict_separated,      // the axis separates
    // the unrounded primitives too
    input  wire                                s_verdict_certain_gap,
    // bit i: projected point p_i < 0
    input  wire [         VERTS_A+VERTS_B-4:0] s_verdict_negative,
    input  wire [         VERTS_A+VERTS_B-4:0] s_verdict_zero,           // bit i: p_i = 0
    // the sign of point VERTS_A - 2 is certain
    input  wire                                s_verdict_certain,
    // on a normal: all sides are certain
    input  wire                                s_verdict_clear,
    // the primitives overlap on the axis by more than the error, both ways
    input  wire                                s_verdict_deep,
    // components of the axis: < 0
    input  wire [                         2:0] s_verdict_axis_negative,
    input  wire [                         2:0] s_verdict_axis_zero,  // components of the axis: = 0
    // component of the largest absolute value
    input  wire [                         1:0] s_verdict_axis_largest,
    // boxes disjoint in component l of the code
    input  wire                                s_verdict_box_separated,
    input  wire                                s_verdict_box_certain,    // by more than E
    // ---- results
    output wire                                m_result_valid,  // there is a result, for one clock
    output wire [            `CCHIP_TAG_W-1:0] m_result_tag,             // tag of the pair
    output wire                                m_result_hit,             // grid or not definite
    output wire                                m_result_grid,            // no axis separates
    // grid is proven for the unrounded primitives
    output wire                                m_result_definite,
    // witness: code of the separating axis, 0 if none, class 7 for a reserved mode
    output wire [      `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    // beats of the pair, 0 for a reserved mode
    output wire [          `CCHIP_BEATS_W-1:0] m_result_beats
);

  localparam [31:0] CONTEXT_LAST = CONTEXTS - 1;
  // programme state: {deep, certain, open, beats, info, code, programme}, see cchip_axis_programme
  localparam integer STATE_W = `CCHIP_STATE_W;
  localparam [`CCHIP_AXIS_CODE_W-1:0] CODE_FIRST = {`CCHIP_AXIS_NORMAL_A, 6'd0};
  localparam [`CCHIP_AXIS_CODE_W-1:0] CODE_ILLEGAL = {`CCHIP_AXIS_ILLEGAL, 6'd0};
  localparam [31:0] LAST_K = VERTS_A - 1;
  localparam [31:0] LAST_L = VERTS_B - 1;

  `CCHIP_REFUSE(CONTEXTS < 1 || CONTEXTS > `CCHIP_CONTEXTS_MAX || (1 << CONTEXT_W) < CONTEXTS,
                cchip_error_CONTEXTS_must_be_1_to_256)
  `CCHIP_REFUSE(WARPED_EXACT != 0 && WARPED_EXACT != 1, cchip_error_WARPED_EXACT_must_be_0_or_1)
  `CCHIP_REFUSE(EXHAUSTIVE != 0 && EXHAUSTIVE != 1, cchip_error_EXHAUSTIVE_must_be_0_or_1)

  // ---- contexts: after reset every number is handed out once in order; after that, numbers come
  // from the list of those that pairs have given back
  wire                 outcome;  // a verdict ended its pair
  wire [CONTEXT_W-1:0] verdict_context = s_verdict_user[STATE_W+:CONTEXT_W];
  // the context of a verdict, delayed as cchip_axis_programme delays the verdict
  wire [CONTEXT_W-1:0] side_context, outcome_context;
  cchip_delay #(
      .WIDTH(CONTEXT_W),
      .DEPTH(`CCHIP_PROGRAMME_LATENCY - `CCHIP_RAM_LATENCY)
  ) u_side_context (
      .clk(clk),
      .rst(1'b0),
      .d  (verdict_context),
      .q  (side_context)
  );
  cchip_delay #(.WIDTH(CONTEXT_W), .DEPTH(`CCHIP_RAM_LATENCY)) u_outcome_context (
      .clk(clk),
      .rst(1'b0),
      .d  (side_context),
      .q  (outcome_context)
  );

  reg  [CONTEXT_W-1:0] fresh_q;
  reg                  fresh_left_q;
  wire                 free_valid, free_ready, hand_ready;
  wire [CONTEXT_W-1:0] free_context;
  always @(posedge clk)
    if (rst) begin
      fresh_q      <= {CONTEXT_W{1'b0}};
      fresh_left_q <= 1'b1;
    end else if (hand_ready && fresh_left_q) begin
      fresh_q      <= fresh_q + {{CONTEXT_W - 1{1'b0}}, 1'b1};
      fresh_left_q <= fresh_q != CONTEXT_LAST[CONTEXT_W-1:0];
    end

  cchip_fifo #(.WIDTH(CONTEXT_W), .DEPTH(CONTEXTS), .ROOM_KNOWN(1)) u_free (
      .clk    (clk),
      .rst    (rst),
      .s_valid(outcome),
      .s_ready(free_ready),
      .s_data (outcome_context),
      .m_valid(free_valid),
      .m_ready(hand_ready & ~fresh_left_q),
      .m_data (free_context)
  );
  // holds the next context to hand out; s_pair_valid reaches only this buffer
  wire hand_valid;
  cchip_skid_buffer #(.WIDTH(CONTEXT_W)) u_hand_out (
      .clk    (clk),
      .rst    (rst),
      .s_valid(fresh_left_q | free_valid),
      .s_ready(hand_ready),
      .s_data (fresh_left_q ? fresh_q : free_context),
      .m_valid(hand_valid),
      .m_ready(s_pair_valid),
      .m_data (m_load_context)
  );

  // ---- pairs that wait for their first beat
  reg                  load_valid_q;
  reg  [CONTEXT_W-1:0] load_context_q;
  reg  [`CCHIP_MODE_W-1:0] load_mode_q;
  always @(posedge clk) begin
    if (rst) load_valid_q <= 1'b0;
    else load_valid_q <= s_pair_valid;
    load_context_q <= m_load_context;
    load_mode_q    <= s_pair_mode;
  end
  wire                 start_valid, start_ready, start_space;
  wire [CONTEXT_W-1:0] start_context;
  wire [`CCHIP_MODE_W-1:0] start_mode;
  // eta is 1..14: only then may depth prove a hit
  wire start_deep;
  wire load_deep = s_pair_err != 4'd0 && s_pair_err != `CCHIP_ERR_UNKNOWN;

  cchip_fifo #(.WIDTH(CONTEXT_W + `CCHIP_MODE_W + 1), .DEPTH(CONTEXTS), .ROOM_KNOWN(1)) u_start (
      .clk    (clk),
      .rst    (rst),
      .s_valid(load_valid_q),
      .s_ready(start_space),
      .s_data ({load_deep, load_context_q, load_mode_q}),
      .m_valid(start_valid),
      .m_ready(start_ready),
      .m_data ({start_deep, start_context, start_mode})
  );

  wire exhaustive = EXHAUSTIVE != 0 && start_mode == `CCHIP_MODE_EXHAUSTIVE;
  wire directed = start_mode == `CCHIP_MODE_DIRECTED;
  wire [`CCHIP_PROG_W-1:0] start_programme = exhaustive ? `CCHIP_PROG_EXHAUSTIVE
      : directed ? `CCHIP_PROG_NORMALS : `CCHIP_PROG_ILLEGAL;
  wire [`CCHIP_AXIS_CODE_W-1:0] start_code = exhaustive || directed ? CODE_FIRST : CODE_ILLEGAL;
  wire [STATE_W-1:0] start_state = {start_deep, 1'b1, 1'b0, 6'd0, 14'd0, start_code,
                                    start_programme};

  // ---- pairs that wait for their next beat
  wire                         proceed;
  wire [STATE_W-1:0]           next_state;
  wire                         ready_valid, ready_space, ready_ready;
  wire [CONTEXT_W+STATE_W-1:0] ready_state;

  cchip_fifo #(.WIDTH(CONTEXT_W + STATE_W), .DEPTH(CONTEXTS), .ROOM_KNOWN(1)) u_ready (
      .clk    (clk),
      .rst    (rst),
      .s_valid(proceed),
      .s_ready(ready_space),
      .s_data ({outcome_context, next_state}),
      .m_valid(ready_valid),
      .m_ready(ready_ready),
      .m_data (ready_state)
  );

  // ---- the beat
  reg                          beat_valid_q /* verilator public_flat_rd */;
  reg  [CONTEXT_W+STATE_W-1:0] beat_q;

  wire [`CCHIP_PROG_W-1:0] beat_programme = beat_q[`CCHIP_STATE_PROGRAMME];
  wire [`CCHIP_AXIS_CODE_W-1:0] beat_code = beat_q[`CCHIP_STATE_CODE];
  wire [`CCHIP_INFO_W-1:0] beat_info = beat_q[`CCHIP_STATE_INFO];
  wire [`CCHIP_INDEX_W-1:0] beat_l = beat_code[`CCHIP_AXIS_CODE_L];
  wire [`CCHIP_CLASS_W-1:0] beat_class = beat_code[`CCHIP_AXIS_CODE_CLASS];
  wire [`CCHIP_BEATS_W-1:0] beat_count = beat_q[`CCHIP_STATE_BEATS];

  // while keep is 1, an EXHAUSTIVE pair issues its beats back to back and no other pair does
  reg keep_q;
  wire keep = EXHAUSTIVE != 0 && keep_q;
  // the next axis of that pair: nB or e_k x f_l
  reg keep_cross_q;
  reg [1:0] keep_k_q, keep_l_q;
  wire keep_row = keep_cross_q && keep_l_q == LAST_L[1:0];  // the last l of a k
  wire keep_last = keep_row && keep_k_q == LAST_K[1:0];
  wire [`CCHIP_AXIS_CODE_W-1:0] keep_code =
      {keep_cross_q ? `CCHIP_AXIS_CROSS : `CCHIP_AXIS_NORMAL_B, 1'b0, keep_k_q, 1'b0, keep_l_q};

  // a pair waits for an axis slot (read by monitors)
  wire pair_waits /* verilator public_flat_rd */ = start_valid | ready_valid | beat_valid_q;
  reg  started_q;  // the last turn went to a pair that started
  wire take_start = start_valid & (~ready_valid | ~started_q);
  assign ready_ready = ~keep & (~start_valid | started_q);
  assign start_ready = ~keep & (~ready_valid | ~started_q);

  always @(posedge clk) begin
    if (rst) beat_valid_q <= 1'b0;
    else beat_valid_q <= keep | ready_valid | start_valid;
    if (rst) keep_q <= 1'b0;
    else keep_q <= keep ? ~keep_last : take_start && exhaustive;
    if (rst) started_q <= 1'b0;
    else if (!keep) started_q <= take_start;
    keep_cross_q <= keep;
    keep_l_q <= !keep || keep_row ? 2'd0 : keep_l_q + {1'b0, keep_cross_q};
    keep_k_q <= !keep ? 2'd0 : keep_k_q + {1'b0, keep_row};
    if (keep) begin
      beat_q[`CCHIP_STATE_CODE]  <= keep_code;
      beat_q[`CCHIP_STATE_BEATS] <= beat_count + 6'd1;
    end else beat_q <= take_start ? {start_context, start_state} : ready_state;
  end

  assign m_beat_valid   = beat_valid_q;
  assign m_beat_context = beat_q[STATE_W+:CONTEXT_W];
  assign m_beat_code    = beat_code;
  assign m_beat_user    = beat_q;

  // In-plane axes are one-sided: the primitive's own vertices lie on the side of sign(-n_d), d = l.
  // allow_above and allow_below follow one clock after their beat.
  //   info of DEGENERATE: signs of both normals; of COPLANAR: whether n_d is negative
  wire coplanar = beat_programme == `CCHIP_PROG_COPLANAR;
  reg in_plane_a_q, in_plane_b_q, negative_a_q, negative_b_q, zero_a_q, zero_b_q;
  function of_component(input [2:0] bits, input [1:0] component);
    of_component = component[1] ? bits[2] : component[0] ? bits[1] : bits[0];
  endfunction
  always @(posedge clk) begin
    in_plane_a_q <= beat_class == `CCHIP_AXIS_IN_PLANE_A;
    in_plane_b_q <= beat_class == `CCHIP_AXIS_IN_PLANE_B;
    negative_a_q <= coplanar ? beat_info[`CCHIP_INFO_COPLANAR_A_NEGATIVE]
        : of_component(beat_info[`CCHIP_INFO_DEGENERATE_A_NEGATIVE], beat_l[1:0]);
    negative_b_q <= coplanar ? beat_info[`CCHIP_INFO_COPLANAR_B_NEGATIVE]
        : of_component(beat_info[`CCHIP_INFO_DEGENERATE_B_NEGATIVE], beat_l[1:0]);
    zero_a_q     <= ~coplanar & of_component(beat_info[`CCHIP_INFO_DEGENERATE_A_ZERO], beat_l[1:0]);
    zero_b_q     <= ~coplanar & of_component(beat_info[`CCHIP_INFO_DEGENERATE_B_ZERO], beat_l[1:0]);
  end
  wire unused_info = &{1'b0, beat_info, beat_l};
  wire n_negative = in_plane_a_q ? negative_a_q : negative_b_q;
  wire n_zero = in_plane_a_q ? zero_a_q : zero_b_q;
  wire one_sided = in_plane_a_q | in_plane_b_q;
  assign m_beat_allow_above = ~one_sided | n_zero | ~n_negative;
  assign m_beat_allow_below = ~one_sided | n_zero | n_negative;

  // ---- after the verdict: the outcome of the pair, or its next axis
  wire outcome_certain, outcome_open, outcome_illegal;

  cchip_axis_programme #(
      .VERTS_A     (VERTS_A),
      .VERTS_B     (VERTS_B),
      .WARPED_EXACT(WARPED_EXACT),
      .EXHAUSTIVE  (EXHAUSTIVE)
  ) u_programme (
      .clk            (clk),
      .rst            (rst),
      .s_valid        (s_verdict_valid),
      .s_state        (s_verdict_user[STATE_W-1:0]),
      .s_separated    (s_verdict_separated),
      .s_certain_gap  (s_verdict_certain_gap),
      .s_negative     (s_verdict_negative),
      .s_zero         (s_verdict_zero),
      .s_certain      (s_verdict_certain),
      .s_clear        (s_verdict_clear),
      .s_deep         (s_verdict_deep),
      .s_axis_negative(s_verdict_axis_negative),
      .s_axis_zero    (s_verdict_axis_zero),
      .s_axis_largest (s_verdict_axis_largest),
      .s_box_separated(s_verdict_box_separated),
      .s_box_certain  (s_verdict_box_certain),
      .m_outcome      (outcome),
      .m_grid         (m_result_grid),
      .m_certain      (outcome_certain),
      .m_open         (outcome_open),
      .m_illegal      (outcome_illegal),
      .m_witness      (m_result_axis),
      .m_beats        (m_result_beats),
      .m_proceed      (proceed),
      .m_state        (next_state)
  );

  // ---- result: the tag, eta = 0 and eta unknown are read from memory on the clock of the outcome
  wire [`CCHIP_TAG_W+1:0] side;
  cchip_ram #(.WIDTH(`CCHIP_TAG_W + 2), .DEPTH(CONTEXTS), .ADDR_W(CONTEXT_W)) u_side (
      .clk       (clk),
      .write     (s_pair_valid),
      .write_addr(m_load_context),
      .write_data({s_pair_err == 4'd0, s_pair_err == `CCHIP_ERR_UNKNOWN, s_pair_tag}),
      .read_addr (side_context),
      .read_data (side)
  );

  assign m_result_valid    = outcome;
  wire err_none, err_unknown;
  assign {err_none, err_unknown, m_result_tag} = side;
  assign m_result_definite = ~outcome_illegal
      & (err_none ? outcome_certain | ~outcome_open : outcome_certain & ~err_unknown);
  assign m_result_hit      = m_result_grid | ~m_result_definite;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_context_free, !s_pair_valid || hand_valid)
      `CCHIP_ASSERT(a_start_space, !load_valid_q || start_space)
      `CCHIP_ASSERT(a_free_space, !outcome || free_ready)
      `CCHIP_ASSERT(a_ready_space, !proceed || ready_space)
      `CCHIP_ASSERT(a_verdict_ends_or_proceeds, !(outcome && proceed))
    end

endmodule
`default_nettype wire
