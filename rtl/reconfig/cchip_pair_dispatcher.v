// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_pair_dispatcher: gives the pairs that wait at the heads of three queues, one queue per
// kind, to the slots that work on their kind; pairs of a kind that no slot and no bitstream
// provides go to `refused`, tag and kind only.
//   latency      0 clocks to a slot: queues and slots are registered on their side; `refused`: the
//                turn comes to a pair that waits one clock later, or three if others are refused
//                before it
//   throughput   one pair per clock for each queue, if a slot takes it
//   offers       m_pair_valid of a slot is 1 only on clocks on which its m_pair_ready is 1, so a
//                pair is never offered to a slot that is being shut down, nor taken back.
//                m_pair_ready must therefore not wait for m_pair_valid.
//   fair         two slots of one kind get the pairs of its queue in turn while both are ready; the
//                queues and the illegal pairs are refused in turn
//   cuts         s_valid to s_ready; m_pair_valid and s_ready follow m_pair_ready, m_refused_ready
//                and registers, m_pair_valid and m_refused_* also s_valid
//   reset        `serves` is registered: no pair is given on the first clock after rst
module cchip_pair_dispatcher #(
    // slots, 1 or 2
    parameter integer SLOTS = 2,
    // width of a pair, bit; its tag at REQUEST_TAG
    parameter integer WIDTH = 406
) (
    input  wire                           clk,
    input  wire                           rst,
    // module that works in each slot, ModuleId; 0: none, or no new pairs
    input  wire [`CCHIP_KIND_W*SLOTS-1:0] serves,
    // bit k - 1: no slot and no bitstream provides kind k
    input  wire [                    2:0] no_provider,
    // heads of the queues, kind k at bit and word k - 1
    input  wire [                    2:0] s_valid,
    output wire [                    2:0] s_ready,
    input  wire [            3*WIDTH-1:0] s_data,
    // pairs of an illegal kind
    input  wire                           s_illegal_valid,
    output wire                           s_illegal_ready,
    input  wire [       `CCHIP_TAG_W-1:0] s_illegal_tag,
    // slots
    output wire [              SLOTS-1:0] m_pair_valid,
    input  wire [              SLOTS-1:0] m_pair_ready,
    output wire [        SLOTS*WIDTH-1:0] m_pair_data,
    // pairs to be answered without a test; kind 0: illegal
    output wire                           m_refused_valid,
    input  wire                           m_refused_ready,
    output wire [       `CCHIP_TAG_W-1:0] m_refused_tag,
    output wire [      `CCHIP_KIND_W-1:0] m_refused_kind
);

  localparam integer TAG_W = `CCHIP_TAG_W;

  generate
    if (SLOTS < 1 || SLOTS > 2) begin : gen_illegal
      cchip_error_SLOTS_must_be_1_or_2 u_error ();
    end
  endgenerate

  // ---- slots. choice: one-hot, the queue of each slot
  reg  [3*SLOTS-1:0] choice_q;
  wire [3*SLOTS-1:0] give;  // the slot takes a pair of this queue if it has one
  genvar slot, kind;
  generate
    for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_slots
      wire [1:0] serve = serves[2*slot+:2];
      always @(posedge clk) choice_q[3*slot+:3] <= rst ? 3'd0
          : {serve == 2'd3, serve == 2'd2, serve == 2'd1};
      assign m_pair_valid[slot] = |(give[3*slot+:3] & s_valid);
      // serve_q is a copy of its own for the selection of the data, which has many loads; while
      // m_pair_valid is 0, the data are those of any queue
      reg [1:0] serve_q;
      always @(posedge clk) serve_q <= serve;
      assign m_pair_data[WIDTH*slot+:WIDTH] =
          serve_q == 2'd3 ? s_data[2*WIDTH+:WIDTH] : serve_q == 2'd2 ? s_data[WIDTH+:WIDTH]
              : s_data[0+:WIDTH];
    end
    if (SLOTS == 1) begin : gen_one
      assign give = choice_q & {3{m_pair_ready[0]}};
    end else begin : gen_two
      reg turn_q;  // the slot that goes first where both are ready for one queue
      wire [2:0] ready0 = choice_q[2:0] & {3{m_pair_ready[0]}};
      wire [2:0] ready1 = choice_q[5:3] & {3{m_pair_ready[1]}};
      assign give[2:0] = ready0 & ~(ready1 & {3{turn_q}});
      assign give[5:3] = ready1 & ~(ready0 & {3{~turn_q}});
      always @(posedge clk)
        if (rst) turn_q <= 1'b0;
        else if (|m_pair_valid) turn_q <= m_pair_valid[0];
    end
  endgenerate

  // ---- refused pairs: illegal ones and those of the queues without a provider, in turn
  reg  [2:0] refuse_q;
  wire [2:0] served;  // a slot works on the kind, so its pairs must not be refused
  always @(posedge clk) refuse_q <= rst ? 3'd0 : no_provider & ~served;

  wire [3:0] waits = {s_valid & refuse_q, s_illegal_valid};
  // one-hot, a register: what a queue is told does not depend on the other queues
  reg  [3:0] turn_of_refused_q;
  // Round robin: the token moves from the present turn to the first other queue that waits; if none
  // does, the turn stays.
  function [3:0] next_turn(input [3:0] now, input [3:0] offers);
    reg [3:0] token;
    integer i;
    begin
      token = now;
      next_turn = 4'd0;
      for (i = 0; i < 4; i = i + 1) begin
        token = {token[2:0], token[3]};
        next_turn = next_turn | (token & offers);
        token = token & ~offers;
      end
      next_turn = next_turn | token;
    end
  endfunction
  always @(posedge clk)
    if (rst) turn_of_refused_q <= 4'b0001;
    else if (m_refused_ready || !m_refused_valid) turn_of_refused_q <= next_turn(turn_of_refused_q,
        waits);

  wire [3:0] turn = turn_of_refused_q;
  assign m_refused_valid = |(waits & turn);
  assign m_refused_kind  = {turn[3] | turn[2], turn[3] | turn[1]};
  assign m_refused_tag = (s_illegal_tag & {TAG_W{turn[0]}}) | (s_data[0+:TAG_W] & {TAG_W{turn[1]}})
      | (s_data[WIDTH+:TAG_W] & {TAG_W{turn[2]}}) | (s_data[2*WIDTH+:TAG_W] & {TAG_W{turn[3]}});
  assign s_illegal_ready = m_refused_ready & turn[0];

  generate
    for (kind = 0; kind < 3; kind = kind + 1) begin : gen_kinds
      localparam [31:0] KIND = kind + 1;
      wire [SLOTS-1:0] taken, works;
      for (slot = 0; slot < SLOTS; slot = slot + 1) begin : gen_taken
        assign taken[slot] = give[3*slot+kind];
        assign works[slot] = choice_q[3*slot+kind] || serves[2*slot+:2] == KIND[1:0];
      end
      assign served[kind]  = |works;
      assign s_ready[kind] = |taken | (m_refused_ready & turn[kind+1] & refuse_q[kind]);

      always @(posedge clk)
        if (!rst) begin
          `CCHIP_ASSERT(a_once, (taken & (taken - {{SLOTS - 1{1'b0}}, 1'b1})) == {SLOTS{1'b0}})
          `CCHIP_ASSERT(a_one_way, !(|taken && m_refused_ready && turn[kind+1] && refuse_q[kind]))
        end
    end
  endgenerate

endmodule
`default_nettype wire
