// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_pair_router: the streams of the reconfigurable subsystem. Sorts pairs by kind into three
// queues, gives them to the slots that work on their kind, collects the answers in turn and answers
// itself the pairs that no module can test: those of kind 0 and of kinds without a provider get
// axis class CCHIP_AXIS_ILLEGAL, hit 1, grid 1, definite 0, beats 0.
//   latency      5 clocks to the slot (skid buffer, queue), 1 clock back; own answers wait one to
//                three clocks more
//   throughput   one pair and one answer per clock
//   in flight    4 + 3 * QUEUE_DEPTH pairs at most wait here; a full queue stops the other kinds
//                too
//   fair         slots and own answers leave in turn
//   cuts         s_pair_ready, m_result_valid and m_result_*, all status: flip-flops; between slots
//                and queues see cchip_pair_dispatcher, cchip_result_merge
//   reset        all streams empty
module cchip_pair_router #(
    // width of a coordinate, bit, 4..20
    parameter integer COORD_W = 16,
    // slots, 1 or 2
    parameter integer SLOTS = 2,
    // pairs in each queue, 16..1024
    parameter integer QUEUE_DEPTH = 256
) (
    input  wire                                       clk,
    input  wire                                       rst,
    // pairs of any kind, ModuleId of the test; records REQUEST and RESULT
    input  wire                                       s_pair_valid,
    output wire                                       s_pair_ready,
    input  wire [                  `CCHIP_KIND_W-1:0] s_pair_kind,
    input  wire [      `CCHIP_REQUEST_W(COORD_W)-1:0] s_pair_data,
    output wire                                       m_result_valid,
    input  wire                                       m_result_ready,
    output wire [                  `CCHIP_KIND_W-1:0] m_result_kind,
    output wire [                `CCHIP_RESULT_W-1:0] m_result_data,
    // slots
    output wire [                          SLOTS-1:0] m_slot_valid,
    input  wire [                          SLOTS-1:0] m_slot_ready,
    output wire [SLOTS*`CCHIP_REQUEST_W(COORD_W)-1:0] m_slot_data,
    input  wire [                          SLOTS-1:0] s_slot_valid,
    output wire [                          SLOTS-1:0] s_slot_ready,
    input  wire [          SLOTS*`CCHIP_RESULT_W-1:0] s_slot_data,
    // module of each slot's answers; module that takes pairs (0: none)
    input  wire [            `CCHIP_KIND_W*SLOTS-1:0] slot_module,
    input  wire [            `CCHIP_KIND_W*SLOTS-1:0] serves,
    input  wire [                                2:0] no_provider,
    // kind k at place k - 1
    output wire [        3*$clog2(QUEUE_DEPTH+1)-1:0] waiting,
    // a pair was answered: by a slot with this module, or 0: by the router, because of its kind or
    // for want of a provider
    output wire                                       answered,
    output wire [                                1:0] answered_module,
    output wire                                       refused_kind,
    output wire                                       refused_provider
);

  reg answered_q;
  reg [1:0] answered_module_q;
  reg refused_kind_q;
  reg refused_provider_q;
  assign answered = answered_q;
  assign answered_module = answered_module_q;
  assign refused_kind = refused_kind_q;
  assign refused_provider = refused_provider_q;

  localparam integer PAIR_W = `CCHIP_REQUEST_W(COORD_W);
  localparam integer ANSWER_W = `CCHIP_RESULT_W;
  // {kind; result}
  localparam integer RESULT_W = `CCHIP_KIND_W + ANSWER_W;
  localparam integer COUNT_W = $clog2(QUEUE_DEPTH + 1);

  // ---- sort: the kind is decoded before the input register
  wire in_valid;
  wire [3:0] in_kind;  // one-hot
  wire [PAIR_W-1:0] in_pair;
  wire [2:0] queue_ready;
  wire illegal_ready;

  cchip_skid_buffer #(
      .WIDTH(PAIR_W + 4)
  ) u_in (
      .clk    (clk),
      .rst    (rst),
      .stop   (1'b0),
      .s_valid(s_pair_valid),
      .s_ready(s_pair_ready),
      .s_data ({4'd1 << s_pair_kind, s_pair_data}),
      .m_valid(in_valid),
      .m_ready(|(in_kind & {queue_ready, illegal_ready})),
      .m_data ({in_kind, in_pair})
  );

  // ---- queues
  wire [2:0] head_valid, head_ready;
  wire [3*PAIR_W-1:0] head;
  genvar kind, slot;
  generate
    for (kind = 0; kind < 3; kind = kind + 1) begin : gen_kinds
      cchip_pair_queue #(
          .WIDTH(PAIR_W),
          .DEPTH(QUEUE_DEPTH)
      ) u_queue (
          .clk    (clk),
          .rst    (rst),
          .s_valid(in_valid & in_kind[kind+1]),
          .s_ready(queue_ready[kind]),
          .s_data (in_pair),
          .m_valid(head_valid[kind]),
          .m_ready(head_ready[kind]),
          .m_data (head[PAIR_W*kind+:PAIR_W]),
          .count  (waiting[COUNT_W*kind+:COUNT_W])
      );
    end
  endgenerate

  // ---- to the slots
  wire refusing_valid, refusing_ready, refused_valid, refused_ready;
  wire [`CCHIP_TAG_W-1:0] refusing_tag, refused_tag;
  wire [`CCHIP_KIND_W-1:0] kind_of_refusing, kind_of_refused;

  cchip_pair_dispatcher #(
      .SLOTS(SLOTS),
      .WIDTH(PAIR_W)
  ) u_dispatcher (
      .clk            (clk),
      .rst            (rst),
      .serves         (serves),
      .no_provider    (no_provider),
      .s_valid        (head_valid),
      .s_ready        (head_ready),
      .s_data         (head),
      .s_illegal_valid(in_valid & in_kind[0]),
      .s_illegal_ready(illegal_ready),
      .s_illegal_tag  (in_pair[`CCHIP_REQUEST_TAG]),
      .m_pair_valid   (m_slot_valid),
      .m_pair_ready   (m_slot_ready),
      .m_pair_data    (m_slot_data),
      .m_refused_valid(refusing_valid),
      .m_refused_ready(refusing_ready),
      .m_refused_tag  (refusing_tag),
      .m_refused_kind (kind_of_refusing)
  );

  // a register between queues and merge, so that a queue's ready does not depend on the merge
  cchip_skid_buffer #(
      .WIDTH(`CCHIP_KIND_W + `CCHIP_TAG_W)
  ) u_refused (
      .clk    (clk),
      .rst    (rst),
      .stop   (1'b0),
      .s_valid(refusing_valid),
      .s_ready(refusing_ready),
      .s_data ({kind_of_refusing, refusing_tag}),
      .m_valid(refused_valid),
      .m_ready(refused_ready),
      .m_data ({kind_of_refused, refused_tag})
  );

  // ---- answers: the slots' and, last, our own
  wire [(SLOTS+1)*RESULT_W-1:0] answers;
  generate
    for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_slots
      assign answers[RESULT_W*slot+:RESULT_W] =
          {slot_module[2*slot+:2], s_slot_data[ANSWER_W*slot+:ANSWER_W]};
    end
  endgenerate
  assign answers[RESULT_W*SLOTS+:RESULT_W] =
      {kind_of_refused,
       `CCHIP_RESULT_OF(refused_tag, 1'b1, 1'b1, 1'b0, {`CCHIP_AXIS_ILLEGAL, 6'd0}, 6'd0)};

  cchip_result_merge #(
      .SOURCES(SLOTS + 1),
      .WIDTH  (RESULT_W)
  ) u_merge (
      .clk    (clk),
      .rst    (rst),
      .s_valid({refused_valid, s_slot_valid}),
      .s_ready({refused_ready, s_slot_ready}),
      .s_data (answers),
      .m_valid(m_result_valid),
      .m_ready(m_result_ready),
      .m_data ({m_result_kind, m_result_data})
  );

  // ---- status: at most one answer passes the merge per clock
  wire [SLOTS-1:0] passed = s_slot_valid & s_slot_ready;
  wire refused = refused_valid & refused_ready;
  function [1:0] module_of(input [SLOTS-1:0] from, input [2*SLOTS-1:0] modules);
    integer i;
    begin
      module_of = 2'd0;
      for (i = 0; i < SLOTS; i = i + 1) module_of = module_of | (modules[2*i+:2] & {2{from[i]}});
    end
  endfunction

  always @(posedge clk) begin
    answered_q         <= ~rst & (|passed | refused);
    answered_module_q  <= module_of(passed, slot_module);
    refused_kind_q     <= !rst && refused && kind_of_refused == 2'd0;
    refused_provider_q <= !rst && refused && kind_of_refused != 2'd0;
  end

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_module, !(|passed) || module_of(passed, slot_module) != 2'd0)
    end

endmodule
`default_nettype wire
