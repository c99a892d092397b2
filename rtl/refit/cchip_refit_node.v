// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit_node: finishes a node of which all children have bounds: origin and step, volumes,
// and its write, of which the answer comes while the next node is at work.
//   order        start with the node's header; then the box of the whole node, x, y, z; bounds of
//                the children are read from the block RAM until the state leaves VOLUMES
//   write        begins when the one before it is answered, unless that was an error
//   errors       m_fault for a clock: RANGE, ABORT of this node, or the code of a write
//   time         from start to idle 31 clocks, step, 15 for each child and the beats
//   cuts         every path: m_write_data is chosen between flip-flops
//   reset        nothing in work, no write outstanding
module cchip_refit_node #(
    parameter integer LEVEL_W = 6,   // width of a level
    parameter integer DATA_W = 128   // width of a beat (bit); legal: 64, 128, 256, 512
) (
    input  wire                           clk,            // clock, rising edge
    input  wire                           rst,            // synchronous reset, active high
    input  wire                           drop,           // give up what is not offered yet
    input  wire                           hold_write,     // begin no write
    input  wire                           start,          // a node; only if idle
    input  wire [            LEVEL_W-1:0] s_level,        // its level
    input  wire [                   31:0] s_base,         // address of the image / 64; it stays
    input  wire [                   23:0] s_node,         // its line
    input  wire [                   23:0] s_first,        // line of its first child
    input  wire [                    7:0] s_kinds,        // kinds of the children
    input  wire [                    1:0] s_others,       // children behind the first
    input  wire                           s_cut_exponent, // its cut exponent - 2
    output wire                           idle,           // no node is in work
    // ---- bounds of the whole node, 2^-48
    input  wire                           s_valid,        // those of an axis
    input  wire [                    1:0] s_axis,         // which
    input  wire [                   51:0] s_least,        // least end
    input  wire [                   51:0] s_greatest,     // greatest end
    // ---- bounds of its children
    output wire                           boxes,          // all those of m_level are needed yet
    output wire                           reads,          // they are read
    output wire [            LEVEL_W-1:0] m_level,        // its level
    output wire [                    1:0] m_child,        // this child and those behind it
    output wire [                    3:0] m_place,        // direction
    input  wire [                  103:0] s_bounds,       // {greatest, least} 2 clocks later
    // ---- errors
    output wire                           m_fault,        // an error
    output wire [`CCHIP_REFIT_CODE_W-1:0] m_code,         // its code
    output wire [                   23:0] m_line,         // of this node, or of that written last
    output wire                           m_of_write,     // it is that of the write
    // ---- memory
    output wire                           waits,          // for the answer to a write, or a beat
    output wire                           writing,        // a write is not answered
    output wire                           begins,         // a write begins
    output wire [                   23:0] m_written,      // line that is written, or was
    output wire                           m_write_valid,  // a beat of a write
    input  wire                           m_write_ready,  // it is taken
    output wire                           m_write_last,   // the last one
    output wire [                   31:0] m_write_line,   // address of the line / 64
    output wire [                    2:0] m_write_beat,   // number of the beat
    output wire [             DATA_W-1:0] m_write_data,   // the beat
    input  wire                           s_write_valid,  // the answer
    input  wire [`CCHIP_WRITE_CODE_W-1:0] s_write_code    // its code, of cchip_axi_write
);

  localparam [31:0] WIDTH = DATA_W;
  localparam [31:0] LAST_BEAT = 512 / DATA_W - 1;

  localparam [2:0] IDLE = 3'd0;
  localparam [2:0] FRAME = 3'd1;  // the box comes, and the step is searched for
  localparam [2:0] VOLUMES = 3'd2;  // bounds of the children are read
  localparam [2:0] DRAIN = 3'd3;  // the last volumes come
  localparam [2:0] FILL = 3'd4;  // absent children
  localparam [2:0] BEGIN = 3'd5;  // a write, when the one before it is answered
  localparam [2:0] OFFER = 3'd6;  // its beats
  reg [2:0] state_q;
  reg [LEVEL_W-1:0] level_q;
  reg [23:0] node_q, first_q, written_q;
  reg [7:0] kinds_q;
  reg [1:0] others_q;
  reg cut_exponent_q;

  // ---- origin and step: the search begins 4 clocks behind z
  reg [3:0] box_q;
  wire frame_done, frame_none;
  wire [53:0] origin;
  wire [4:0] step;
  cchip_refit_frame u_frame (
      .clk       (clk),
      .rst       (rst),
      .s_valid   (s_valid),
      .s_axis    (s_axis),
      .s_least   (s_least),
      .s_greatest(s_greatest),
      .search    (box_q[3]),
      .m_done    (frame_done),
      .m_none    (frame_none),
      .m_origin  (origin),
      .m_step    (step)
  );
  wire found = state_q == FRAME && frame_done;

  // ---- volumes, child by child. Cuts wait until the box of the child is there
  reg [1:0] child_q;
  reg [3:0] place_q;
  reg [1:0] pause_q;
  wire issue = state_q == VOLUMES && pause_q == 2'd0;
  wire last_place = place_q == 4'd15;
  wire last_issue = issue && last_place && child_q == others_q;
  reg [6:0] last_q;  // of what has been issued
  reg [1:0] valid_q;
  reg [6:0] way_q1, way_q2;  // {axis, axes}
  wire [5:0] axes;
  cchip_refit_axes u_axes (
      .place(place_q),
      .axes (axes)
  );
  wire volume_valid, volume_axis;
  wire [13:0] volume;
  cchip_refit_volume u_volume (
      .clk           (clk),
      .rst           (rst),
      .s_origin      (origin),
      .s_step        (step),
      .s_cut_exponent(cut_exponent_q),
      .s_valid       (valid_q[1]),
      .s_axis        (way_q2[6]),
      .s_axes        (way_q2[5:0]),
      .s_least       (s_bounds[51:0]),
      .s_greatest    (s_bounds[103:52]),
      .m_valid       (volume_valid),
      .m_axis        (volume_axis),
      .m_data        (volume)
  );
  // they come in the order of their bits; absent children are 0
  reg [407:0] volumes_q;
  reg [1:0] there_q;  // children whose volumes or zeros are there, less 1
  always @(posedge clk) begin
    if (volume_valid && volume_axis) volumes_q <= {volume, volumes_q[407:14]};
    else if (volume_valid) volumes_q <= {volume[5:0], volumes_q[407:6]};
    else if (state_q == FILL && there_q != 2'd3) volumes_q <= {102'd0, volumes_q[407:102]};
    there_q <= state_q == FILL ? there_q + 2'd1 : others_q;
    way_q1  <= {place_q < 4'd3, axes};
    way_q2  <= way_q1;
    if (start) begin
      child_q <= 2'd0;
      place_q <= 4'd0;
      pause_q <= 2'd0;
    end else if (issue) begin
      place_q <= place_q == 4'd2 ? 4'd6 : place_q + 4'd1;
      if (last_place) child_q <= child_q + 2'd1;
      if (place_q == 4'd2) pause_q <= 2'd3;
    end else if (pause_q != 2'd0) pause_q <= pause_q - 2'd1;
  end

  // ---- the write. A beat is chosen by its number
  reg writing_q, offered_q;
  reg [2:0] beat_q;
  reg [31:0] address_q;
  wire [511:0] node = {
    8'd0, volumes_q, 2'd0, cut_exponent_q, others_q, kinds_q, first_q, step, origin
  };
  wire beat_step = offered_q & m_write_ready;
  wire last_beat = beat_q == LAST_BEAT[2:0];
  wire write_end = writing_q & s_write_valid;
  wire write_fault = write_end && s_write_code != `CCHIP_WRITE_OK;
  wire may_begin = state_q == BEGIN && !writing_q && !drop;
  always @(posedge clk) begin
    if (start) begin
      level_q        <= s_level;
      node_q         <= s_node;
      first_q        <= s_first;
      kinds_q        <= s_kinds;
      others_q       <= s_others;
      cut_exponent_q <= s_cut_exponent;
    end
    if (begins) begin
      written_q <= node_q;
      address_q <= s_base + {8'd0, node_q};
      beat_q    <= 3'd0;
    end else if (beat_step) beat_q <= beat_q + 3'd1;
    if (rst) begin
      state_q   <= IDLE;
      box_q     <= 4'd0;
      last_q    <= 7'd0;
      valid_q   <= 2'd0;
      writing_q <= 1'b0;
      offered_q <= 1'b0;
    end else begin
      box_q     <= {box_q[2:0], s_valid && s_axis == 2'd2};
      last_q    <= {last_q[5:0], last_issue};
      valid_q   <= {valid_q[0], issue};
      writing_q <= begins | (writing_q & ~s_write_valid);
      offered_q <= begins | (offered_q & ~(beat_step & last_beat));
      case (state_q)
        IDLE: if (start) state_q <= FRAME;
        FRAME: if (found) state_q <= frame_none ? IDLE : VOLUMES;
        VOLUMES: if (last_issue) state_q <= DRAIN;
        DRAIN: if (last_q[6]) state_q <= FILL;
        FILL: if (there_q == 2'd3) state_q <= BEGIN;
        BEGIN: if (may_begin) state_q <= hold_write ? IDLE : OFFER;
        default: if (beat_step && last_beat) state_q <= IDLE;
      endcase
      if (drop && state_q != OFFER) state_q <= IDLE;
    end
  end
  assign begins        = may_begin & ~hold_write;
  assign idle          = state_q == IDLE;
  assign boxes         = state_q == FRAME;
  assign reads         = state_q == VOLUMES;
  assign m_level       = level_q;
  assign m_child       = child_q;
  assign m_place       = place_q;
  assign m_of_write    = write_fault;
  assign m_fault       = write_fault | (found & frame_none) | (may_begin & hold_write);
  assign m_code        = !write_fault ? (found ? `CCHIP_REFIT_RANGE : `CCHIP_REFIT_ABORT) :
      s_write_code == `CCHIP_WRITE_TIMEOUT ? `CCHIP_REFIT_TIMEOUT :
      s_write_code == `CCHIP_WRITE_OWED ? `CCHIP_REFIT_OWED : `CCHIP_REFIT_WRITE;
  assign m_line        = write_fault ? written_q : node_q;
  assign waits         = state_q == BEGIN || state_q == OFFER;
  assign writing       = writing_q;
  assign m_written     = written_q;
  assign m_write_valid = offered_q;
  assign m_write_last  = last_beat;
  assign m_write_line  = address_q;
  assign m_write_beat  = beat_q;
  assign m_write_data  = node[WIDTH*{29'd0, beat_q}+:DATA_W];

  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_start, !start || idle)
    end

endmodule
`default_nettype wire
