// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_dispatcher: gives the pairs that wait in queues of descriptors to the slots whose module
// can answer for their kind, and collects the answers. A pair of the illegal kind 0, or of a kind
// that no slot provides, is answered as an open pair (see cchip_slot_ledger), and so is a pair that
// a swap by force gives up: every pair that enters the queues is answered exactly once.
//   serves       CCHIP_RM_SERVES: a test of quads takes a triangle as a quad, that of points takes
//                points alone
//   latency      6 clocks from `some` to m_vertex_valid of an idle dispatcher; 6 clocks from a
//                slot's result to m_result
//   throughput   a pair every 3 clocks, of a kind with quads every 4; an answer every clock
//   credit       no ready runs back from a slot: at most CREDIT of its pairs lie between dispatch
//                and answer
//   fair         kinds are served in turn, and so are slots and answers
//   reset        no pair inside any slot, no answer
//   timing       A lone pair: 6 clocks from some to its first vertex, 6 from a result to its
//                answer.
//   numbers      Module m serves the kinds 1..m, the test of points (4) kind 4 alone
//                (CCHIP_RM_SERVES). Pairs of kind 0 and of kinds without a provider go to a taker
//                of their own that answers at once, as open.
//   why          A pair leaves its queue only when a slot with credit takes it, and its operands
//                are at hand by then. So the way to a slot has a fixed length, valid is never
//                formed from ready, and a swap cannot strand a pair in between.
module cchip_dispatcher #(
    parameter integer SLOTS = 2,   // slots; legal: 1..4
    parameter integer KINDS = 3,   // kinds of pairs; legal: 1..3
    // most pairs between dispatch and answer for each slot; legal: 1..256, at most CONTEXTS of each
    // module
    parameter integer CREDIT = 42
) (
    input  wire                                  clk,              // clock, rising edge
    input  wire                                  rst,              // synchronous reset, active high
    // ---- queues: kind k at bit k; see cchip_dispatch_sequencer
    input  wire [                       KINDS:0] some,             // bit k: pairs of kind k wait
    output wire [                       KINDS:0] kind,             // one-hot: the kind of this turn
    output wire                                  look,             // see cchip_descriptor_queues
    output wire                                  pop,              // the pair leaves its queue
    output wire [                           1:0] vertex,  // vertex of it that is read on this clock
    // its descriptor, 2 and 3 clocks after pop
    input  wire [       `CCHIP_DESCRIPTOR_W-1:0] descriptor,
    input  wire [                       KINDS:1] no_provider,      // no slot can serve the kind
    // ---- to the slots: record VERTEX but for its vertices, which go with it
    output wire [                     SLOTS-1:0] m_vertex_valid,   // per slot: a vertex goes to it
    output wire                                  m_vertex_first,   // the first of its pair
    output wire                                  m_vertex_last,    // the last of its pair
    // per slot: number of the pair, with the first vertex
    output wire [  SLOTS*`CCHIP_PAIR_ID_W-1:0]   m_vertex_id,
    // ---- from the slots: records SLOT_RESULT, the module in each slot, 0: none
    input  wire [                     SLOTS-1:0] s_result_valid,   // per slot: a result
    input  wire [SLOTS*`CCHIP_SLOT_RESULT_W-1:0] s_result_data,    // per slot: record SLOT_RESULT
    // per slot: module that is coupled, 0: none
    input  wire [       SLOTS*`CCHIP_KIND_W-1:0] slot_module,
    // ---- answers
    output wire                                  m_result_valid,   // an answer is offered
    // it is taken if m_result_valid = 1 as well
    input  wire                                  m_result_ready,
    output wire [             `CCHIP_KIND_W-1:0] m_result_kind,    // kind of the pair
    output wire [           `CCHIP_RESULT_W-1:0] m_result_data,    // record RESULT
    // ---- swaps
    input  wire [                     SLOTS-1:0] stop,  // per slot: see cchip_slot_ledger
    output wire [                     SLOTS-1:0] quiet,            // per slot
    input  wire [                     SLOTS-1:0] decouple,         // per slot
    output wire [                     SLOTS-1:0] decoupled,        // per slot
    output wire [ SLOTS*`CCHIP_PAIR_COUNT_W-1:0] outstanding,      // per slot: pairs inside
    // per slot: pairs given up by the last decoupling
    output wire [ SLOTS*`CCHIP_PAIR_COUNT_W-1:0] lost,
    // ---- events, one clock: an answer of this module left, 0: of none; a pair of kind 0, or one
    //      that no slot provides, was taken
    output wire                                  answered,         // an answer left, one clock
    // module that gave it; 0: left open
    output wire [             `CCHIP_KIND_W-1:0] answered_module,
    // a pair of kind 0 was taken, one clock
    output wire                                  refused_kind,
    // a pair of a kind without a provider was taken, one clock
    output wire                                  refused_provider
);

  localparam integer KIND_W = `CCHIP_KIND_W;
  localparam integer QUEUES = KINDS + 1;
  localparam integer TAKERS = SLOTS + 1;  // the last one answers at once
  localparam integer ANSWER_W = `CCHIP_ANSWER_W;

  `CCHIP_REFUSE(SLOTS < 1 || SLOTS > 4, cchip_error_SLOTS_must_be_1_to_4)

  // ---- who serves what
  reg [TAKERS*QUEUES-1:0] serves_q;
  wire [SLOTS-1:0] open;
  wire [TAKERS-1:0] room, grant, taker;
  genvar s, k;
  generate
    for (k = 0; k < QUEUES; k = k + 1) begin : gen_serves
      localparam [31:0] KIND = k;
      wire [SLOTS-1:0] able;
      for (s = 0; s < SLOTS; s = s + 1) begin : gen_slots
        wire [`CCHIP_RM_ID_W-1:0] holds =
            {{`CCHIP_RM_ID_W - KIND_W{1'b0}}, slot_module[KIND_W*s+:KIND_W]};
        assign able[s] = k > 0 && `CCHIP_RM_SERVES(holds, KIND[`CCHIP_RM_ID_W-1:0]);
        always @(posedge clk) serves_q[QUEUES*s+k] <= able[s] & open[s] & ~stop[s];
      end
      if (k == 0) begin : gen_illegal_kind
        always @(posedge clk) serves_q[QUEUES*SLOTS+k] <= 1'b1;
      end else begin : gen_kind
        always @(posedge clk) serves_q[QUEUES*SLOTS+k] <= no_provider[k] & ~(|able);
      end
    end
  endgenerate

  wire [KIND_W-1:0] kind_of_pair;
  wire vertex_valid;
  cchip_dispatch_sequencer #(
      .TAKERS(TAKERS),
      .KINDS (KINDS)
  ) u_sequencer (
      .clk     (clk),
      .rst     (rst),
      .some    (some),
      .serves  (serves_q),
      .room    (room),
      .kind    (kind),
      .look    (look),
      .launch  (pop),
      .grant   (grant),
      .m_vertex(vertex),
      .m_valid (vertex_valid),
      .m_first (m_vertex_first),
      .m_last  (m_vertex_last),
      .m_kind  (kind_of_pair),
      .m_taker (taker)
  );
  assign m_vertex_valid = taker[SLOTS-1:0] & {SLOTS{vertex_valid}};

  // ---- slots
  wire [TAKERS-1:0] answer_valid, answer_ready;
  wire [TAKERS*ANSWER_W-1:0] answer;
  generate
    for (s = 0; s < SLOTS; s = s + 1) begin : gen_ledgers
      cchip_slot_ledger #(
          .CREDIT(CREDIT)
      ) u_ledger (
          .clk           (clk),
          .rst           (rst),
          .open          (open[s]),
          .room          (room[s]),
          .grant         (grant[s]),
          .id            (m_vertex_id[`CCHIP_PAIR_ID_W*s+:`CCHIP_PAIR_ID_W]),
          .s_tag         (descriptor[`CCHIP_DESCRIPTOR_TAG]),
          .s_kind        (kind_of_pair),
          .s_result_valid(s_result_valid[s]),
          .s_result_data (s_result_data[`CCHIP_SLOT_RESULT_W*s+:`CCHIP_SLOT_RESULT_W]),
          .module_id     (slot_module[KIND_W*s+:KIND_W]),
          .m_valid       (answer_valid[s]),
          .m_ready       (answer_ready[s]),
          .m_data        (answer[ANSWER_W*s+:ANSWER_W]),
          .stop          (stop[s]),
          .quiet         (quiet[s]),
          .decouple      (decouple[s]),
          .decoupled     (decoupled[s]),
          .outstanding   (outstanding[`CCHIP_PAIR_COUNT_W*s+:`CCHIP_PAIR_COUNT_W]),
          .lost          (lost[`CCHIP_PAIR_COUNT_W*s+:`CCHIP_PAIR_COUNT_W])
      );
    end
  endgenerate

  // ---- pairs that no slot can test, one at a time
  reg refusing_q, refused_q;  // one was taken; its tag is here
  reg [`CCHIP_TAG_W-1:0] refused_tag_q;
  reg [KIND_W-1:0] refused_kind_q;
  reg refused_illegal_q, refused_provider_q;
  reg granted_q, granted_q2;
  always @(posedge clk) begin
    granted_q          <= ~rst & grant[SLOTS];
    granted_q2         <= ~rst & granted_q;
    refused_illegal_q  <= ~rst & grant[SLOTS] & kind[0];
    refused_provider_q <= ~rst & grant[SLOTS] & ~kind[0];
    if (granted_q2) refused_tag_q <= descriptor[`CCHIP_DESCRIPTOR_TAG];
    if (granted_q2) refused_kind_q <= kind_of_pair;
    refusing_q <= ~rst & (grant[SLOTS] | (refusing_q & ~(refused_q & answer_ready[SLOTS])));
    refused_q  <= ~rst & (granted_q2 | (refused_q & ~answer_ready[SLOTS]));
  end
  assign room[SLOTS] = ~refusing_q;
  assign answer_valid[SLOTS] = refused_q;
  wire [`CCHIP_RESULT_W-1:0] refused_result =
      `CCHIP_RESULT_OF(refused_tag_q, 1'b1, 1'b1, 1'b0, {`CCHIP_AXIS_ILLEGAL, 6'd0}, 6'd0);
  assign answer[ANSWER_W*SLOTS+:ANSWER_W] =
      `CCHIP_ANSWER_OF(refused_result, refused_kind_q, {KIND_W{1'b0}});
  assign refused_kind = refused_illegal_q;
  assign refused_provider = refused_provider_q;

  // ---- answers
  wire [KIND_W-1:0] module_of_answer;
  reg answered_q;
  reg [KIND_W-1:0] answered_module_q;
  cchip_stream_merge #(
      .SOURCES(TAKERS),
      .WIDTH  (ANSWER_W)
  ) u_merge (
      .clk    (clk),
      .rst    (rst),
      .s_valid(answer_valid),
      .s_ready(answer_ready),
      .s_data (answer),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data (`CCHIP_ANSWER_OF(m_result_data, m_result_kind, module_of_answer))
  );
  always @(posedge clk) begin
    answered_q        <= ~rst & m_result_valid & m_result_ready;
    answered_module_q <= module_of_answer;
  end
  assign answered = answered_q;
  assign answered_module = answered_module_q;

  wire unused = &{1'b0, descriptor[`CCHIP_DESCRIPTOR_ERR], descriptor[`CCHIP_DESCRIPTOR_MODE],
      taker[SLOTS]};

endmodule
`default_nettype wire
