// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_dispatch_sequencer: which kind of pair goes where, and when its vertices are read. One pair
// at a time: a kind is chosen among those that wait and that some taker with room serves, then one
// of these takers, then the pair leaves its queue and its vertices are read, one per clock.
//   takers       the slots and, last, the one that answers pairs no slot can test
//   latency      4 clocks from `some` to `launch` in an idle dispatcher
//   throughput   a pair every 3 clocks, of a kind with quads every 4
//   fair         kinds are served in turn, and so are takers: a kind that can be dispatched waits
//                for at most KINDS + 2 pairs of other kinds
//   order        look (where is the head of `kind`?); a clock later launch, with m_vertex = 0; on
//                the next clocks m_vertex = 1, 2 (and 3)
//   data         what m_vertex reads arrives 2 clocks later, together with m_valid, m_first and
//                m_last; m_kind and m_taker are those of the pair until the next m_first
//   reset        nothing is dispatched
//   about        It knows nothing of pairs but their kind, and nothing of slots but that they have
//                room and serve a kind.
//   timing       A launch every 3 clocks, after a kind with quads every 4. some and room must show
//                a launch on the next clock; a change of serves may still be followed by launches
//                for 5 clocks.
//   numbers      Kind 0 is the illegal one; kinds 2 and 3 have four vertices.
//   why          A pair needs three clocks on its way into a slot, so there is time to choose in
//                steps of two levels of logic. The kind is chosen ahead of time, among those that
//                were possible a clock or two ago; then its takers, with what is true now. If the
//                choice turns out to be out of date, the turn goes to the next kind.
module cchip_dispatch_sequencer #(
    // slots, and the one that answers pairs that no slot can test (taker); legal: 2..5
    parameter integer TAKERS = 2,
    parameter integer KINDS = 3    // kinds of pairs; legal: 1..4
) (
    input  wire                        clk,       // clock, rising edge
    input  wire                        rst,       // synchronous reset, active high
    // ---- kind k at bit k; 0 is the illegal kind
    input  wire [             KINDS:0] some,      // bit k: pairs of kind k wait
    input  wire [TAKERS*(KINDS+1)-1:0] serves,    // bit (KINDS + 1) t + k: taker t serves kind k
    input  wire [          TAKERS-1:0] room,      // bit t: taker t has room for a pair
    output wire [             KINDS:0] kind,      // one-hot: the kind of this turn
    output wire                        look,      // the place of its head is to be fetched
    // the pair leaves its queue, its first vertex is read
    output wire                        launch,
    output wire [          TAKERS-1:0] grant,     // one-hot with launch: its taker; else 0
    output wire [                 1:0] m_vertex,  // vertex that is read on this clock
    // what was read two clocks ago is a vertex of a pair
    output wire                        m_valid,
    output wire                        m_first,   // it is the first one
    output wire                        m_last,    // it is the last one
    output wire [   `CCHIP_KIND_W-1:0] m_kind,    // kind of that pair, until the next m_first
    output wire [          TAKERS-1:0] m_taker    // its taker, one-hot, until the next m_first
);

  localparam integer QUEUES = KINDS + 1;

  `CCHIP_REFUSE(TAKERS < 2 || TAKERS > 5, cchip_error_TAKERS_must_be_2_to_5)
  `CCHIP_REFUSE(KINDS < 1 || KINDS > `CCHIP_KINDS_MAX, cchip_error_KINDS_must_be_1_to_4)

  localparam [1:0] CHOOSE = 2'd0;  // a kind
  localparam [1:0] TAKER = 2'd1;  // one of its takers
  localparam [1:0] LAUNCH = 2'd2;
  localparam [1:0] FOURTH = 2'd3;  // the fourth vertex takes a clock more
  reg [1:0] state_q;

  // ---- the kind whose turn it is, ahead of time: turn_q may be out of date when it is used, so
  // the takers are asked again below
  reg [QUEUES-1:0] possible_q, turn_q;
  wire [QUEUES-1:0] possible, turn;
  wire choose = state_q == CHOOSE && turn_q != {QUEUES{1'b0}};
  wire next_turn = choose || turn_q == {QUEUES{1'b0}};
  genvar k, t;
  generate
    for (k = 0; k < QUEUES; k = k + 1) begin : gen_possible
      wire [TAKERS-1:0] takers;
      for (t = 0; t < TAKERS; t = t + 1) begin : gen_able
        assign takers[t] = serves[QUEUES*t+k] & room[t];
      end
      assign possible[k] = some[k] & (|takers);
    end
  endgenerate

  cchip_arbiter #(
      .N(QUEUES)
  ) u_kinds (
      .clk    (clk),
      .rst    (rst),
      .request(possible_q),
      .grant  (turn),
      .take   (next_turn)
  );

  // ---- the takers that serve it
  reg [TAKERS-1:0] asked_q;
  wire [TAKERS-1:0] able, chosen;
  generate
    for (t = 0; t < TAKERS; t = t + 1) begin : gen_takers
      assign able[t] = room[t] & (|(turn_q & some & serves[QUEUES*t+:QUEUES]));
    end
  endgenerate

  cchip_arbiter #(
      .N(TAKERS)
  ) u_takers (
      .clk    (clk),
      .rst    (rst),
      .request(asked_q),
      .grant  (chosen),
      .take   (state_q == TAKER)
  );

  // ---- sequence
  reg [QUEUES-1:0] kind_q;
  reg look_q, launch_q;
  reg [TAKERS-1:0] grant_q;
  wire four;  // kind_q has four vertices
  generate
    if (KINDS > 2) begin : gen_four
      assign four = |kind_q[3:2];
    end else if (KINDS > 1) begin : gen_four
      assign four = kind_q[2];
    end else begin : gen_four
      assign four = 1'b0;
    end
  endgenerate

  always @(posedge clk) begin
    possible_q <= possible;
    asked_q    <= able;
    if (choose) kind_q <= turn_q;
    if (rst) begin
      state_q  <= CHOOSE;
      turn_q   <= {QUEUES{1'b0}};
      look_q   <= 1'b0;
      launch_q <= 1'b0;
      grant_q  <= {TAKERS{1'b0}};
    end else begin
      if (next_turn) turn_q <= turn;
      look_q   <= choose;
      launch_q <= state_q == TAKER && asked_q != {TAKERS{1'b0}};
      grant_q  <= state_q == TAKER ? chosen : {TAKERS{1'b0}};
      case (state_q)
        CHOOSE: if (choose) state_q <= TAKER;
        TAKER: state_q <= asked_q != {TAKERS{1'b0}} ? LAUNCH : CHOOSE;
        LAUNCH: state_q <= four ? FOURTH : CHOOSE;
        default: state_q <= CHOOSE;
      endcase
    end
  end
  assign kind   = kind_q;
  assign look   = look_q;
  assign launch = launch_q;
  assign grant  = grant_q;

  // ---- read
  wire [`CCHIP_KIND_W-1:0] kind_code;
  cchip_onehot_index #(
      .N    (QUEUES),
      .WIDTH(`CCHIP_KIND_W)
  ) u_kind (
      .select(kind_q),
      .index (kind_code)
  );
  reg [1:0] vertex_q;
  reg four_q;  // the pair that is read has four vertices
  reg valid_q, first_q, last_q;  // a clock after m_vertex
  reg [`CCHIP_KIND_W-1:0] kind_read_q;
  reg [TAKERS-1:0] taker_q;
  reg m_valid_q, m_first_q, m_last_q;
  reg [`CCHIP_KIND_W-1:0] m_kind_q;
  reg [TAKERS-1:0] m_taker_q;
  wire last = vertex_q == {1'b1, four_q};

  always @(posedge clk) begin
    first_q <= launch_q;
    last_q  <= last;
    if (launch_q) begin
      four_q      <= four;
      kind_read_q <= kind_code;
      taker_q     <= grant_q;
    end
    m_first_q <= first_q;
    m_last_q  <= last_q;
    m_kind_q  <= kind_read_q;
    m_taker_q <= taker_q;
    if (rst) begin
      vertex_q  <= 2'd0;
      valid_q   <= 1'b0;
      m_valid_q <= 1'b0;
    end else begin
      if (launch_q || vertex_q != 2'd0) vertex_q <= last && !launch_q ? 2'd0 : vertex_q + 2'd1;
      valid_q   <= launch_q || vertex_q != 2'd0;
      m_valid_q <= valid_q;
    end
  end
  assign m_vertex = vertex_q;
  assign m_valid  = m_valid_q;
  assign m_first  = m_first_q;
  assign m_last   = m_last_q;
  assign m_kind   = m_kind_q;
  assign m_taker  = m_taker_q;

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_launch, !launch_q || (vertex_q == 2'd0 && state_q == LAUNCH))
      `CCHIP_ASSERT(a_grant, launch_q == (grant_q != {TAKERS{1'b0}}))
      `CCHIP_ASSERT(a_one, (grant_q & (grant_q - {{TAKERS - 1{1'b0}}, 1'b1})) == {TAKERS{1'b0}})
    end

endmodule
`default_nettype wire
