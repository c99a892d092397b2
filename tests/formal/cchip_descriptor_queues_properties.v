// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_descriptor_queues, for each kind:
//   counts    waiting is the number of pushes less pops, never above DEPTH; some and room are what it says; s_ready is the room of
//             s_kind; a kind above KINDS counts as kind 0
//   order     one descriptor, any, is followed: when all that came before it in its kind have left, a look finds its place a clock
//             later and its data two clocks later, until two clocks after its pop
//   place     while it waits no push gets its place
// Assumed: a descriptor comes only while there is room for its kind; a look is at one kind that is not empty; a pop is of the kind looked at last, once, a clock later at the earliest.
module cchip_descriptor_queues_properties #(
    parameter integer KINDS = 1,
    parameter integer DEPTH = 16
) (
    input wire                     clk,
    input wire                     rst,
    input wire                     offered,
    input wire [`CCHIP_KIND_W-1:0] s_kind,
    input wire                     s_data,
    input wire                     follow,
    input wire                     choose,
    input wire [`CCHIP_KIND_W-1:0] choice,
    input wire                     want_pop
);
  localparam integer PLACE_W = `CCHIP_KIND_BITS(KINDS) + $clog2(DEPTH);
  localparam integer COUNT_W = $clog2(DEPTH + 1);
  wire s_ready, m_data;
  wire s_valid = offered & s_ready;
  wire [PLACE_W-1:0] s_place, m_place;
  wire [KINDS:0] some, room;
  wire [(KINDS+1)*COUNT_W-1:0] waiting;

  // ---- looks and pops
  reg [`CCHIP_KIND_W-1:0] kind_q;
  reg look_q, looked_q;
  wire [KINDS:0] one = 1;
  wire [KINDS:0] kind = one << kind_q;
  wire pop = looked_q & want_pop;
  wire chooses = choose & ~look_q & ~pop & (choice <= KINDS) & (((some >> choice) & one) != 0);
  always @(posedge clk) begin
    look_q   <= ~rst & chooses;
    looked_q <= ~rst & (look_q | looked_q) & ~pop & ~chooses;
    if (chooses) kind_q <= choice;
  end

  cchip_descriptor_queues #(
      .WIDTH(1),
      .KINDS(KINDS),
      .DEPTH(DEPTH)
  ) dut (
      .clk    (clk),
      .rst    (rst),
      .s_valid(s_valid),
      .s_ready(s_ready),
      .s_kind (s_kind),
      .s_data (s_data),
      .s_place(s_place),
      .some   (some),
      .waiting(waiting),
      .room   (room),
      .kind   (kind),
      .look   (look_q),
      .pop    (pop),
      .m_place(m_place),
      .m_data (m_data)
  );

  // ---- one kind, any, and one descriptor of it
  (* anyconst *) wire [`CCHIP_KIND_W-1:0] mine;
  reg [COUNT_W-1:0] count_q;
  reg waits_q;  // the descriptor followed is in its queue
  reg done_q;  // it has left
  reg [COUNT_W-1:0] ahead_q;  // in front of it
  reg data_q;
  reg [PLACE_W-1:0] place_q;
  wire [`CCHIP_KIND_W-1:0] queue = s_kind > KINDS ? 0 : s_kind;
  wire push_here = s_valid & (queue == mine);
  wire pop_here = pop & (kind_q == mine);
  wire mark = push_here & follow & ~waits_q & ~done_q;
  reg found_q;  // the last look was at it
  reg [1:0] since_look_q;  // clocks, at most 3
  reg [2:0] since_pop_q;  // clocks, at most 7
  wire finds = look_q & (kind_q == mine) & waits_q & (ahead_q == 0);
  reg started_q = 1'b0;
  // shifted, not selected: a part beyond the end would be x, and the solver takes none
  wire [(KINDS+1)*COUNT_W-1:0] waiting_from_mine = waiting >> (COUNT_W * mine);
  wire [COUNT_W-1:0] waits_here = waiting_from_mine[COUNT_W-1:0];
  wire [KINDS:0] room_from_mine = room >> mine;
  wire [KINDS:0] some_from_mine = some >> mine;
  wire room_here = room_from_mine[0];
  wire some_here = some_from_mine[0];
  always @(posedge clk) begin
    started_q <= 1'b1;
    if (rst) begin
      count_q <= 0;
      waits_q <= 1'b0;
      done_q  <= 1'b0;
      found_q <= 1'b0;
    end else begin
      count_q <= count_q + push_here - pop_here;
      if (mark) waits_q <= 1'b1;
      else if (pop_here && ahead_q == 0) waits_q <= 1'b0;
      if (waits_q && pop_here && ahead_q == 0) done_q <= 1'b1;
      if (look_q) found_q <= finds;
    end
    if (mark) begin
      data_q  <= s_data;
      place_q <= s_place;
      ahead_q <= count_q - pop_here;
    end else if (pop_here && ahead_q != 0) ahead_q <= ahead_q - 1;
    since_look_q <= look_q ? 2'd0 : since_look_q + {1'b0, ~&since_look_q};
    since_pop_q  <= look_q || looked_q && !pop ? 3'd0 : since_pop_q + {2'd0, ~&since_pop_q};
  end

  always @(*) begin
    assume (mine <= KINDS);
    if (!started_q) assume (rst);
  end
`ifdef COVER
  // goals: the task passes if the tool finds a way to the goal
  always @(posedge clk)
    if (started_q && !rst) begin
      if (`COVER == 0) goal_left: assert (!(done_q && count_q == 1));
      if (`COVER == 1) goal_full: assert (!(waits_q && count_q == DEPTH && ahead_q == DEPTH - 1 && place_q[3:0] == 4'd1));
    end
`else
  always @(*)
    if (started_q) begin
      count: assert (waits_here == count_q && count_q <= DEPTH && some_here == (count_q != 0) && room_here == (count_q != DEPTH));
      ready: assert (queue != mine || s_ready == room_here);
      own_place: assert (!push_here || !waits_q || s_place != place_q);
      place: assert (!found_q || rst || look_q || m_place == place_q);
      order: assert (!found_q || rst || look_q || since_look_q < 2'd2 || since_pop_q > 3'd3 || m_data == data_q);
    end
`endif
endmodule
`default_nettype wire
