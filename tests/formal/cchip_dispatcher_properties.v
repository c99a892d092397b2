// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_dispatcher (with its sequencer, ledger, merge) and cchip_pr_slot together, around a module that answers the
// pairs it holds in any order and after any time (dispatcher_region.v), while modules are exchanged at any moment, by force or not:
//   once      one pair, any, is followed: its answer leaves at most once, never before it was taken from its queue, with its tag
//             and kind
//   not lost  with no pair inside the slot, none taken for 6 clocks and no answer offered for 6, every pair has been answered
//   reason    it is answered as open only if a slot was closed meanwhile, its kind is illegal or no slot provides it
//   slot      no vertex enters the region in reset; a number is given again only when the pair before has left it; a pair's
//             three vertices come in step; pairs are taken 3 clocks apart or more, each from a queue that is not empty
//   swaps     quiet and decoupled say that no pair is inside
//   answers   an offered answer stays as it is until it is taken
// Assumed: `some` of a kind stays until its pair is taken; swaps follow the order that is proved of cchip_swap_sequencer: stop and
// decouple, reset once the slot's pairs are given up, reset on configuration, recouple; each step lasts as long as it likes.
module cchip_dispatcher_properties #(
    parameter integer SLOTS = 1,
    parameter integer CREDIT = 2
) (
    input wire             clk,
    input wire             rst,
    input wire [      1:0] arrive,          // a pair comes into the queue of the kind
    input wire             follow,
    input wire             any_tag,
    input wire             no_provider,
    input wire             m_result_ready,
    input wire [SLOTS-1:0] want_stop,
    input wire [SLOTS-1:0] want_swap,
    input wire [SLOTS-1:0] go_on
);
  localparam integer COORD_W = 4;
  localparam [`CCHIP_PAIR_COUNT_W-1:0] CREDIT_OF_SLOT = CREDIT;
  wire [1:0] kind;
  wire look, pop, vertex_first, vertex_last;
  wire [1:0] vertex;
  wire [SLOTS-1:0] quiet, closed, vertex_valid, result_valid, stop, decouple;
  wire [SLOTS-1:0] in_credit, empty, in_step;
  wire [SLOTS*`CCHIP_PAIR_ID_W-1:0] vertex_id;
  wire [SLOTS*`CCHIP_SLOT_RESULT_W-1:0] slot_result;
  wire [SLOTS*`CCHIP_KIND_W-1:0] slot_module;
  wire m_valid, answered, refused_kind, refused_provider;
  wire [`CCHIP_KIND_W-1:0] m_kind, answered_module;
  wire [`CCHIP_RESULT_W-1:0] m_data;
  wire [SLOTS*`CCHIP_PAIR_COUNT_W-1:0] outstanding, lost;

  // ---- queues: any
  reg [1:0] some_q;
  reg [2:0] popped_q;  // 1, 2 and 3 clocks ago
  reg [2:0] followed_q;
  wire tag = |popped_q[2:1] ? |followed_q[2:1] : any_tag;
  wire [`CCHIP_DESCRIPTOR_W-1:0] descriptor = {{`CCHIP_DESCRIPTOR_W - 1{1'b0}}, tag};
  wire mark = pop & follow & (pair_q == NONE);

  reg started_q = 1'b0;

  // ---- slots and their swaps
  localparam [1:0] WORK = 2'd0;
  localparam [1:0] CLOSE = 2'd1;
  localparam [1:0] RESET = 2'd2;
  localparam [1:0] ROC = 2'd3;
  genvar s;
  generate
    for (s = 0; s < SLOTS; s = s + 1) begin : gen_slots
      reg [1:0] swap_q;
      reg roc_start_q;
      reg [1:0] roc_clocks_q;
      reg [1:0] vertex_q;  // vertices of the pair that have come
      wire roc_busy, slot_decoupled, idle;
      wire [`CCHIP_RM_ID_W-1:0] rm_id, region_rm_id;
      assign stop[s] = swap_q != WORK || want_stop[s];
      assign decouple[s] = swap_q != WORK;
      assign slot_module[`CCHIP_KIND_W*s+:`CCHIP_KIND_W] = rm_id <= `CCHIP_KINDS_MAX ? rm_id[2:0] : 3'd0;
      always @(posedge clk) begin
        roc_start_q  <= !rst && swap_q == RESET && go_on[s];
        roc_clocks_q <= swap_q != ROC ? 2'd0 : roc_clocks_q + {1'b0, ~&roc_clocks_q};
        vertex_q     <= rst || (vertex_valid[s] && vertex_last) ? 2'd0 : vertex_q + {1'b0, vertex_valid[s]};
        if (rst) swap_q <= WORK;
        else
          case (swap_q)
            WORK: if (want_swap[s]) swap_q <= CLOSE;
            CLOSE: if (go_on[s] && slot_decoupled && closed[s]) swap_q <= RESET;
            RESET: if (go_on[s]) swap_q <= ROC;
            default: if (go_on[s] && roc_clocks_q == 2'd3 && !roc_busy) swap_q <= WORK;
          endcase
      end

      cchip_pr_slot #(
          .COORD_W   (COORD_W),
          .SUBSTAGES (5),
          .CONTEXTS  (CREDIT),
          .ROC_CYCLES(1),
          .SIMULATION(0)
      ) slot (
          .clk           (clk),
          .rst           (rst),
          .decouple      (decouple[s]),
          .decoupled     (slot_decoupled),
          .hold_reset    (swap_q == RESET),
          .roc_start     (roc_start_q),
          .roc_busy      (roc_busy),
          .region_rm_id  (region_rm_id),
          .cfg_valid     (1'b0),
          .cfg_data      (8'd0),
          .s_vertex_valid(vertex_valid[s]),
          .s_vertex_data (`CCHIP_VERTEX_OF(vertex_first, vertex_last, vertex_id[`CCHIP_PAIR_ID_W*s+:`CCHIP_PAIR_ID_W],
                                           4'd0, 2'd0, 12'd0, 12'd0)),
          .m_result_valid(result_valid[s]),
          .m_result_data (slot_result[`CCHIP_SLOT_RESULT_W*s+:`CCHIP_SLOT_RESULT_W]),
          .rm_id         (rm_id),
          .idle          (idle)
      );

      wire [`CCHIP_PAIR_COUNT_W-1:0] pairs_inside = outstanding[`CCHIP_PAIR_COUNT_W*s+:`CCHIP_PAIR_COUNT_W];
      assign in_credit[s] = pairs_inside <= CREDIT;
      assign empty[s] = pairs_inside == 0;
      assign in_step[s] = !vertex_valid[s] || (vertex_first == (vertex_q == 2'd0) && vertex_last == (vertex_q == 2'd2));
    end
  endgenerate

  cchip_dispatcher #(
      .SLOTS (SLOTS),
      .KINDS (1),
      .CREDIT(CREDIT)
  ) dut (
      .clk             (clk),
      .rst             (rst),
      .some            (some_q),
      .kind            (kind),
      .look            (look),
      .pop             (pop),
      .vertex          (vertex),
      .descriptor      (descriptor),
      .no_provider     (no_provider),
      .m_vertex_valid  (vertex_valid),
      .m_vertex_first  (vertex_first),
      .m_vertex_last   (vertex_last),
      .m_vertex_id     (vertex_id),
      .s_result_valid  (result_valid),
      .s_result_data   (slot_result),
      .slot_module     (slot_module),
      .m_result_valid  (m_valid),
      .m_result_ready  (m_result_ready),
      .m_result_kind   (m_kind),
      .m_result_data   (m_data),
      .stop            (stop),
      .quiet           (quiet),
      .decouple        (decouple),
      .decoupled       (closed),
      .outstanding     (outstanding),
      .lost            (lost),
      .answered        (answered),
      .answered_module (answered_module),
      .refused_kind    (refused_kind),
      .refused_provider(refused_provider)
  );

  // ---- the pair followed
  localparam [1:0] NONE = 2'd0;
  localparam [1:0] TAKEN = 2'd1;
  localparam [1:0] ANSWERED = 2'd2;
  reg [1:0] pair_q;
  reg illegal_q;  // it is of kind 0
  reg excused_q;  // the slot was closed, or no slot provided its kind, since it was taken or shortly before
  reg [2:0] excuse_q;  // clocks since
  wire excuse = (|decouple) || no_provider;
  wire ours = m_data[`CCHIP_RESULT_TAG] == 16'd1;
  wire by_module = m_data[`CCHIP_RESULT_DEFINITE];
  wire leaves = m_valid & m_result_ready;

  reg [7:0] inside_q;  // pairs taken, answers not left
  reg [2:0] silent_q;  // clocks without a pair taken, inside or answered
  reg offered_q;
  reg [5:0] offer_q;
  wire [5:0] offer = {ours, by_module, m_data[`CCHIP_RESULT_HIT], m_kind};
  always @(posedge clk) begin
    started_q  <= 1'b1;
    some_q     <= rst ? 2'b00 : (some_q & ~(kind & {2{pop}})) | arrive;
    popped_q   <= rst ? 3'b000 : {popped_q[1:0], pop};
    followed_q <= rst ? 3'b000 : {followed_q[1:0], mark};
    inside_q   <= rst ? 8'd0 : inside_q + {7'd0, pop} - {7'd0, leaves};
    silent_q   <= rst || pop || m_valid || outstanding != 0 ? 3'd0 : silent_q + {2'd0, ~&silent_q};
    offered_q  <= ~rst & m_valid & ~m_result_ready;
    offer_q    <= offer;
    excuse_q   <= excuse ? 3'd0 : excuse_q + {2'd0, ~&excuse_q};
    if (rst) pair_q <= NONE;
    else if (mark) pair_q <= TAKEN;
    else if (leaves && ours) pair_q <= ANSWERED;
    if (mark) illegal_q <= kind[0];
    excused_q <= excuse || (pair_q == NONE ? excuse_q != 3'd7 : excused_q);
  end

  always @(*) if (!started_q) assume (rst);
`ifdef COVER
  // goals: the task passes if the tool finds a way to the goal
  always @(posedge clk)
    if (started_q && !rst) begin
      if (`COVER == 0) goal_answered: assert (!(leaves && ours && by_module));
      if (`COVER == 1) goal_given_up: assert (!(leaves && ours && !illegal_q && !by_module && lost != 0));
      if (`COVER == 2) goal_illegal: assert (!(leaves && ours && illegal_q));
      if (`COVER == 3) goal_full: assert (!(outstanding == {SLOTS{CREDIT_OF_SLOT}}));
      if (`COVER == 4) goal_swapped: assert (!(leaves && ours && by_module && lost != 0));
    end
`else
  always @(*)
    if (started_q) begin
      once: assert (!m_valid || !ours || pair_q == TAKEN);
      tag_known: assert (!m_valid || m_data[`CCHIP_RESULT_TAG] <= 16'd1);
      own_kind: assert (!m_valid || !ours || m_kind == {2'b00, ~illegal_q});
      not_lost: assert (silent_q < 3'd7 || (inside_q == 8'd0 && pair_q != TAKEN));
      reason: assert (!m_valid || !ours || by_module || illegal_q || excused_q);
      illegal: assert (!m_valid || !ours || !by_module || !illegal_q);
      credit: assert (&in_credit);
      nothing_inside: assert (((quiet | closed) & ~empty) == 0);
      vertices: assert (&in_step);
      stable: assert (!offered_q || (m_valid && offer == offer_q));
      apart: assert (!pop || popped_q[1:0] == 2'b00);
      in_queue: assert (!pop || kind == 2'b01 || kind == 2'b10);
      waits: assert (!pop || (kind & some_q) != 0);
    end
`endif
endmodule
`default_nettype wire
