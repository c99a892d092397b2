// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_primtest_array: LANES primitive tests of one kind behind the ports of one.
// A place is a context of a lane. The entry knows which lanes have a free place, chooses one in
// turn and sends the pair down a chain of registers that passes all lanes and never stalls; the
// place is free again when the result has left.
//   latency      CCHIP_ARRAY_LATENCY(LANES) clocks more than a lane alone, whichever lane it is
//   throughput   one pair and one result per clock if the lanes keep up; per lane one axis per
//                clock
//   in flight    at most LANES * CONTEXTS pairs between the handshakes of s_pair and m_result
//   fair         pairs go to the lanes with a free place in turn; a result at the head of its lane
//                lets at most CCHIP_ARRAY_WAIT_BOUND(LANES) others leave before it
//   cuts         every path: each output, s_pair_ready included, is a flip-flop; two registers from
//                lane to lane
//   reset        no pair accepted before is ever answered; s_pair_ready is 0 while rst is 1 and
//                CCHIP_ARRAY_LATENCY(LANES) + 1 clocks longer
// Ports and their meaning: cchip_primtest_tri_tri, _tri_quad, _quad_quad.
module cchip_primtest_array #(
    parameter integer COORD_W = 16,  // width of a signed coordinate (bit); legal: 4..20
    // registers in each of the stages axis and project (clock); legal:
    // CCHIP_SUBSTAGES_MIN(COORD_W)..32
    parameter integer SUBSTAGES = 10,
    // pairs in flight in each lane; legal: 1..256
    parameter integer CONTEXTS = `CCHIP_CONTEXTS_DEFAULT(SUBSTAGES),
    // 1: one projector more, same results: cchip_sat_project; legal: 0, 1
    parameter integer ABSOLUTE_PROJECTION = 0,
    // 1: warped quads are decided exactly; 0: no programme TETRAHEDRON: what the directed beats do
    // not decide of a warped quad ends with hit 1, definite 0; legal: 0, 1
    parameter integer WARPED_EXACT = 1,
    // primitive tests; six of cchip_primtest_tri_tri take 144 of the 156 multiplier blocks of an
    // LFE5U-85F (lane); legal: 1..16
    parameter integer LANES = 6,
    // vertices of A (vertex); legal: 3, 4; VERTS_A VERTS_B is 3 3, 3 4 or 4 4
    parameter integer VERTS_A = 3,
    parameter integer VERTS_B = 3  // vertices of B (vertex); legal: VERTS_A..4
) (
    input  wire                                   clk,                // clock, rising edge
    input  wire                                   rst,  // synchronous reset, active high
    input  wire                                   s_pair_valid,       // a pair is offered
    // the pair is accepted if s_pair_valid = 1 as well
    output wire                                   s_pair_ready,
    input  wire [               `CCHIP_TAG_W-1:0] s_pair_tag,  // anything; returned with the result
    // 0 EXHAUSTIVE, 1 DIRECTED; 2 and 3 are reserved
    input  wire [              `CCHIP_MODE_W-1:0] s_pair_mode,
    // A: vertex i in bits [3*COORD_W*i +: 3*COORD_W], x lowest; slot 3 of a triangle is ignored
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_a,
    input  wire [`CCHIP_PRIMITIVE_W(COORD_W)-1:0] s_pair_b,           // B likewise
    // eta: upper bound, in whole grid steps and infinity norm, on the error of the difference of
    // any two vertices of the pair; 0 exact, 15 unknown
    input  wire [               `CCHIP_ERR_W-1:0] s_pair_err,
    output wire                                   m_result_valid,     // a result is offered
    // the result is taken if m_result_valid = 1 as well
    input  wire                                   m_result_ready,
    output wire [               `CCHIP_TAG_W-1:0] m_result_tag,       // tag of the pair
    // grid or not definite: never a false "no"
    output wire                                   m_result_hit,
    // the exact answer for the grid coordinates
    output wire                                   m_result_grid,
    // grid is proven for the unrounded primitives
    output wire                                   m_result_definite,
    // witness {class[2:0], k[2:0], l[2:0]}
    output wire [         `CCHIP_AXIS_CODE_W-1:0] m_result_axis,
    // axes issued for the pair; 0 for a reserved mode
    output wire [             `CCHIP_BEATS_W-1:0] m_result_beats,
    // constant: that of one lane, CCHIP_RM_TRI_TRI, _TRI_QUAD or _QUAD_QUAD
    output wire [             `CCHIP_RM_ID_W-1:0] rm_id,
    // no accepted pair is without an accepted result
    output wire                                   idle
);

  // {lane, one-hot; request}
  localparam integer REQUEST_W = `CCHIP_REQUEST_W(COORD_W);
  localparam integer PAIR_W = LANES + REQUEST_W;
  localparam integer LANE_W = LANES > 1 ? $clog2(LANES) : 1;
  localparam integer ANSWER_W = `CCHIP_RESULT_W;
  // {lane; result}
  localparam integer RESULT_W = LANE_W + ANSWER_W;
  localparam integer PLACES_W = $clog2(CONTEXTS + 1);
  localparam integer COUNT_W = $clog2(LANES * CONTEXTS + 1);
  localparam integer SHUT_W = $clog2(`CCHIP_ARRAY_LATENCY(LANES) + 1);
  localparam [31:0] PLACES = CONTEXTS;
  localparam [31:0] COUNT = LANES * CONTEXTS;
  localparam [31:0] SHUT = `CCHIP_ARRAY_LATENCY(LANES);
  localparam [31:0] MODULE = `CCHIP_RM_OF(VERTS_A, VERTS_B);
  localparam [`CCHIP_RM_ID_W-1:0] RM = MODULE[`CCHIP_RM_ID_W-1:0];

  `CCHIP_REFUSE(LANES < 1 || LANES > `CCHIP_LANES_MAX, cchip_error_LANES_must_be_1_to_16)

  assign rm_id = RM;

  // ---- reset passes the lanes as a pair does; both ends are shut until it is through. It starts
  // as 1, so that no lane runs before it was reset.
  reg  [2*LANES-1:0] rst_q;
  reg  [ SHUT_W-1:0] shut_clocks_q;
  reg                shut_q;
  wire [  2*LANES:0] rst_way = {rst_q, rst};
  wire               shut = rst | shut_q;

  initial rst_q = {2 * LANES{1'b1}};

  always @(posedge clk) begin
    rst_q <= rst_way[2*LANES-1:0];
    if (rst) begin
      shut_clocks_q <= SHUT[SHUT_W-1:0];
      shut_q        <= 1'b1;
    end else if (shut_q) begin
      shut_clocks_q <= shut_clocks_q - {{SHUT_W - 1{1'b0}}, 1'b1};
      shut_q        <= shut_clocks_q > {{SHUT_W - 1{1'b0}}, 1'b1};
    end
  end

  // ---- the lane of the next pair is chosen one clock ahead, and its place is reserved at once
  reg  [LANES-1:0] choice_q;  // one-hot; without a next pair it stays at the lane of the last one
  reg              ready_q;
  wire [LANES-1:0] room;  // lanes with a place that is free and not taken
  wire             accept = s_pair_valid & ready_q;
  wire             choose = s_pair_valid | ~ready_q;

  // first lane with room from the one behind choice_q on: the lowest bit not below `turn`
  wire [  LANES-1:0] turn = (choice_q << 1) | (choice_q >> (LANES - 1));
  wire [2*LANES-1:0] room_twice = {room, room};
  wire [2*LANES-1:0] first = room_twice & ~(room_twice - {{LANES{1'b0}}, turn});
  wire [  LANES-1:0] choice_d = first[LANES-1:0] | first[LANES+:LANES];
  wire [  LANES-1:0] take = choice_d & {LANES{choose}};

  always @(posedge clk)
    if (shut) begin
      choice_q <= {1'b1, {LANES - 1{1'b0}}};
      ready_q  <= 1'b0;
    end else if (choose) begin
      if (room != {LANES{1'b0}}) choice_q <= choice_d;
      ready_q <= room != {LANES{1'b0}};
    end

  assign s_pair_ready = ready_q;

  // ---- number of pairs between the two handshakes; idle follows from it
  reg  [COUNT_W-1:0] pairs_q;
  reg                idle_q;
  wire               answer = m_result_valid & m_result_ready;

  always @(posedge clk)
    if (shut) begin
      pairs_q <= {COUNT_W{1'b0}};
      idle_q  <= 1'b1;
    end else begin
      if (accept != answer)
        pairs_q <= accept ? pairs_q + {{COUNT_W - 1{1'b0}}, 1'b1} : pairs_q
            - {{COUNT_W - 1{1'b0}}, 1'b1};
      idle_q <= !accept && (idle_q || (answer && pairs_q == {{COUNT_W - 1{1'b0}}, 1'b1}));
    end

  assign idle = idle_q;

  // ---- the lanes. way of the pairs, way back of the results: word i enters station i, word i + 1
  // leaves it
  wire [  PAIR_W*(LANES+1)-1:0] way;
  wire [               LANES:0] back_valid, back_ready;
  wire [RESULT_W*(LANES+1)-1:0] back;
  wire [             LANES-1:0] own_valid, own_ready;  // results of a lane itself
  wire [            LANE_W-1:0] answer_lane;

  assign way[PAIR_W-1:0] = {
    choice_q & {LANES{accept & ~rst}},
    `CCHIP_REQUEST_OF(s_pair_tag, s_pair_a, s_pair_b, s_pair_err, s_pair_mode)
  };
  assign back_valid[0] = 1'b0;
  assign back[RESULT_W-1:0] = {RESULT_W{1'b0}};
  assign m_result_valid = back_valid[LANES];
  assign back_ready[LANES] = m_result_ready;
  assign {answer_lane, `CCHIP_RESULT_OF(m_result_tag, m_result_hit, m_result_grid,
      m_result_definite, m_result_axis, m_result_beats)} = back[RESULT_W*LANES+:RESULT_W];
  wire unused = &{1'b0, rst_way[2*LANES], way[PAIR_W*LANES+:PAIR_W], back_ready[0]};

  genvar lane;
  generate
    for (lane = 0; lane < LANES; lane = lane + 1) begin : gen_lanes
      localparam [31:0] LANE = lane;
      localparam [31:0] ONE_HOT = 32'd1 << lane;

      // places that are neither reserved nor in flight; places_q follows a reservation one clock
      // late, places is up to date
      reg  [PLACES_W-1:0] places_q;
      reg                 room_q, give_q, take_q;
      wire [PLACES_W-1:0] places = places_q - {{PLACES_W - 1{1'b0}}, take_q};
      wire                several = |(places >> 1);
      always @(posedge clk)
        if (shut) begin
          give_q   <= 1'b0;
          take_q   <= 1'b0;
          places_q <= PLACES[PLACES_W-1:0];
          room_q   <= 1'b1;
        end else begin
          give_q   <= answer && answer_lane == LANE[LANE_W-1:0];
          take_q   <= take[lane];
          places_q <= places + {{PLACES_W - 1{1'b0}}, give_q};
          room_q   <= give_q | (take[lane] ? several : room_q);
        end
      assign room[lane] = room_q;

      // two registers for the way: one beside the lane, one half way to it
      wire              lane_rst = rst_q[2*lane+1];
      wire [PAIR_W-1:0] pair;
      cchip_delay #(.WIDTH(PAIR_W), .DEPTH(2)) u_way (
          .clk(clk),
          .rst(rst),
          .d  (way[PAIR_W*lane+:PAIR_W]),
          .q  (pair)
      );
      assign way[PAIR_W*(lane+1)+:PAIR_W] = pair;

      wire                pair_valid = pair[REQUEST_W+lane];
      wire                pair_ready;
      wire                lane_valid, lane_ready;  // result as it leaves the lane
      wire [ANSWER_W-1:0] lane_own, own;
      wire [`CCHIP_RM_ID_W-1:0] lane_rm_id;
      wire                lane_idle;
      cchip_primtest #(
          .COORD_W            (COORD_W),
          .SUBSTAGES          (SUBSTAGES),
          .CONTEXTS           (CONTEXTS),
          .ABSOLUTE_PROJECTION(ABSOLUTE_PROJECTION),
          .WARPED_EXACT       (WARPED_EXACT),
          .VERTS_A            (VERTS_A),
          .VERTS_B            (VERTS_B)
      ) u_primtest (
          .clk           (clk),
          .rst           (lane_rst),
          .s_pair_valid  (pair_valid),
          .s_pair_ready  (pair_ready),
          .s_pair_data   (pair[REQUEST_W-1:0]),
          .m_result_valid(lane_valid),
          .m_result_ready(lane_ready),
          .m_result_data (lane_own),
          .rm_id         (lane_rm_id),
          .idle          (lane_idle)
      );
      wire unused_lane = &{1'b0, pair_ready, lane_rm_id, lane_idle};

      // a register between the lane's FIFO and the merge of this station
      cchip_skid_buffer #(.WIDTH(ANSWER_W)) u_own (
          .clk    (clk),
          .rst    (lane_rst),
          .s_valid(lane_valid),
          .s_ready(lane_ready),
          .s_data (lane_own),
          .m_valid(own_valid[lane]),
          .m_ready(own_ready[lane]),
          .m_data (own)
      );

      // results of this lane and of the `lane` lanes before: one of its own for at most `lane` of
      // theirs
      reg  [lane:0] theirs_q;  // bit n: n of theirs may still pass first
      wire          merged_ready;
      wire          own_next = own_valid[lane] & (~back_valid[lane] | theirs_q[0]);
      assign own_ready[lane]  = merged_ready & (~back_valid[lane] | theirs_q[0]);
      assign back_ready[lane] = merged_ready & (~own_valid[lane] | ~theirs_q[0]);
      always @(posedge clk)
        if (lane_rst || (merged_ready && own_next)) theirs_q <= ONE_HOT[lane:0];
        else if (back_valid[lane] && merged_ready && !theirs_q[0]) theirs_q <= theirs_q >> 1;

      // two registers from station to station
      wire                half_valid, half_ready;
      wire [RESULT_W-1:0] half;
      cchip_skid_buffer #(.WIDTH(RESULT_W)) u_merged (
          .clk    (clk),
          .rst    (lane_rst),
          .s_valid(own_valid[lane] | back_valid[lane]),
          .s_ready(merged_ready),
          .s_data (own_next ? {LANE[LANE_W-1:0], own} : back[RESULT_W*lane+:RESULT_W]),
          .m_valid(half_valid),
          .m_ready(half_ready),
          .m_data (half)
      );
      cchip_skid_buffer #(.WIDTH(RESULT_W)) u_back (
          .clk    (clk),
          .rst    (lane == LANES - 1 ? shut : lane_rst),
          .s_valid(half_valid),
          .s_ready(half_ready),
          .s_data (half),
          .m_valid(back_valid[lane+1]),
          .m_ready(back_ready[lane+1]),
          .m_data (back[RESULT_W*(lane+1)+:RESULT_W])
      );

      always @(posedge clk) begin
        if (!lane_rst) begin
          `CCHIP_ASSERT(a_place, !pair_valid || pair_ready)
        end
        if (!shut) begin
          `CCHIP_ASSERT(a_room, room_q == (places != {PLACES_W{1'b0}}))
          `CCHIP_ASSERT(a_places, {{32 - PLACES_W{1'b0}}, places} <= PLACES)
        end
      end
    end
  endgenerate

  always @(posedge clk)
    if (!shut) begin
      `CCHIP_ASSERT(a_count, {{32 - COUNT_W{1'b0}}, pairs_q} <= COUNT)
      `CCHIP_ASSERT(a_choice, choice_q != {LANES{1'b0}}
          && (choice_q & (choice_q - {{LANES - 1{1'b0}}, 1'b1})) == {LANES{1'b0}})
    end

endmodule
`default_nettype wire
