// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit: gives every node of an object's image new volumes after its leaves got new vertices.
// The host writes header and leaves of the moved object; topology and cut exponents stay.
//   order        children before their node, by descent from the root: the kind of a line stands in
//                its parent, so a pass over the lines in the order of their numbers could not tell
//                a leaf from a node. Every line is read once, every node is written once
//   bounds       those of a node's children lie in a block RAM until the node is written, four for
//                each level in work, so the size of an object does not matter. The stored volumes
//                are rounded too much to compute those of the node above from them
//   memory       the ports are those of a client of cchip_axi_read (slot 0) and cchip_axi_write
//   end          m_code, m_line: the current line, m_lines: lines read. After an error a part of
//                the nodes is new, the others are old: no query may use the image
//   silence      each wait for memory lasts `limit` clocks (cchip_timeout) at most; it must exceed
//                those of the masters. What is outstanding then is waited for in the background: a
//                command that comes before it ends is answered with OWED
//   abort        ends the refit before the next request; what is outstanding is awaited first
//   time         13 vertices + beats + 20 clocks a leaf, 27 children + step + 2 beats + 42 a node,
//                with beats of 512 / DATA_W and memory that answers at once
//   cuts         every path: each output is a flip-flop or decoded from the state
//   reset        must reset the masters too; memory may hold a part of the new nodes
module cchip_refit #(
    // levels of nodes in work, leaves not included; a tree of the library has 47 at most; legal:
    // 2..64
    parameter integer LEVELS = 48,
    parameter integer DATA_W = 128  // width of the data bus (bit); legal: 64, 128, 256, 512
) (
    input  wire                           clk,            // clock, rising edge
    input  wire                           rst,            // synchronous reset, active high
    input  wire [                   31:0] limit,  // longest wait for memory, clocks; 0: default
    // ends the refit before its next request; a pulse or longer
    input  wire                           s_abort,
    input  wire                           s_valid,        // a refit
    output wire                           s_ready,        // it is taken
    input  wire [                   31:0] s_base,         // address of the image / 64
    input  wire [                   31:0] s_lines,        // lines of the image
    input  wire [                   23:0] s_root,         // line of its root
    // ---- its end
    output wire                           m_valid,        // the refit has ended
    input  wire                           m_ready,        // its end is taken
    output wire [`CCHIP_REFIT_CODE_W-1:0] m_code,         // RefitCode
    // current line when it ended, 0 if there was none
    output wire [                   23:0] m_line,
    output wire [                   23:0] m_lines,        // lines read
    // ---- reads
    output wire                           m_read_valid,   // a read; there is no ready
    output wire [                   31:0] m_read_line,    // its address / 64
    input  wire                           s_read_valid,   // a beat of its answer
    input  wire                           s_read_last,    // the last one
    input  wire [ `CCHIP_READ_CODE_W-1:0] s_read_code,    // with it, the code of cchip_axi_read
    input  wire [             DATA_W-1:0] s_read_data,    // the beat
    // ---- writes
    output wire                           m_write_valid,  // a beat of a write
    input  wire                           m_write_ready,  // it is taken
    output wire                           m_write_last,   // the last one
    output wire [                   31:0] m_write_line,   // address of the line / 64
    output wire [                    2:0] m_write_beat,   // number of the beat
    output wire [             DATA_W-1:0] m_write_data,   // the beat
    input  wire                           s_write_valid,  // the answer
    input  wire [`CCHIP_WRITE_CODE_W-1:0] s_write_code    // its code, of cchip_axi_write
);

  localparam integer LEVEL_W = $clog2(LEVELS);
  localparam [31:0] LAST_BEAT = 512 / DATA_W - 1;
  localparam [31:0] DEEPEST = LEVELS;
  localparam integer FRAME_W = 24 + 24 + 8 + 2 + 1 + 2;
  localparam [4:0] EXTENT_MAX = 5'd24;

  `CCHIP_REFUSE(LEVELS < 2 || LEVELS > 64, cchip_error_refit_LEVELS_must_be_2_to_64)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_refit_DATA_W_must_be_64_128_256_or_512)

  localparam [3:0] IDLE = 4'd0;
  localparam [3:0] LINE = 4'd1;  // the current line is requested
  localparam [3:0] READ = 4'd2;  // it comes
  localparam [3:0] NODE = 4'd3;  // it is a node
  localparam [3:0] LEAF = 4'd4;  // or a leaf
  localparam [3:0] CHILD = 4'd5;  // a child becomes the current line
  localparam [3:0] PASS = 4'd6;  // intervals pass
  localparam [3:0] NEXT = 4'd7;  // a child is done
  localparam [3:0] UNION = 4'd8;  // all are
  localparam [3:0] SEARCH = 4'd9;  // for the step
  localparam [3:0] FILL = 4'd10;  // absent children
  localparam [3:0] WRITE = 4'd11;
  localparam [3:0] ANSWER = 4'd12;
  localparam [3:0] DONE = 4'd13;
  reg [3:0] state_q;

  // ---- passes: of all vertices of a leaf, of the bounds of all children direction by direction,
  // of all directions child by child
  localparam [1:0] VERTICES = 2'd0;
  localparam [1:0] CHILDREN = 2'd1;
  localparam [1:0] VOLUMES = 2'd2;

  // ---- the refit
  reg [31:0] base_q;
  reg [24:0] lines_q;
  reg [23:0] line_q;  // current
  reg [1:0] kind_q;  // of it
  reg [23:0] visited_q;
  reg [`CCHIP_REFIT_CODE_W-1:0] code_q;
  reg abort_q;

  // ---- the node in work, and those above it
  reg [23:0] node_q, first_q;
  reg [7:0] kinds_q;
  reg [1:0] others_q, index_q;  // children behind the first; the one in work
  reg cut_exponent_q;
  reg [6:0] depth_q;  // nodes in work
  `CCHIP_LUT_RAM
  reg [FRAME_W-1:0] stack[0:(1<<LEVEL_W)-1];
  reg [FRAME_W-1:0] above_q;  // the node above
  wire [1:0] above_index = above_q[1:0];
  wire [6:0] level = depth_q - 7'd1;
  wire [6:0] level_above = depth_q - 7'd2;
  wire push = state_q == NODE;
  always @(posedge clk) begin
    if (push)
      stack[level[LEVEL_W-1:0]] <= {node_q, first_q, kinds_q, others_q, cut_exponent_q, index_q};
    above_q <= stack[level_above[LEVEL_W-1:0]];
  end

  // ---- the line as it was read, or is written
  reg [511:0] data_q;
  wire [511:0] shifted;
  generate
    if (DATA_W == 512) begin : gen_whole
      assign shifted = s_read_data;
    end else begin : gen_beats
      assign shifted = {s_read_valid ? s_read_data : {DATA_W{1'b0}}, data_q[511:DATA_W]};
    end
  endgenerate
  wire [23:0] new_first = data_q[`CCHIP_NODE_LINE_FIRST];
  wire [1:0] new_others = data_q[`CCHIP_NODE_LINE_CHILDREN];
  wire [24:0] new_last = {1'b0, new_first} + {23'd0, new_others};
  wire leaf_quad = kind_q == 2'd3;

  // ---- passes, clock 0: direction, and vertex or child. Directions 0..2 are places 0..2, those
  // with cuts 6..15
  reg run_q;
  reg [1:0] mode_q;
  reg [3:0] place_q;
  reg [2:0] item_q, last_item_q;
  reg [2:0] pause_q;  // the box of a child is to be there before its cuts
  reg [3:0] drain_q;
  wire start = (state_q == LEAF && data_q[`CCHIP_LEAF_LINE_EXTENT] <= EXTENT_MAX) ||
      state_q == UNION;
  wire start_volumes;
  wire by_child = mode_q == VOLUMES;
  wire last_item = item_q == last_item_q;
  wire last_place = place_q == 4'd15;
  wire [3:0] next_place = place_q == 4'd2 ? 4'd6 : last_place ? 4'd0 : place_q + 4'd1;
  wire issue = run_q && pause_q == 3'd0;
  wire last_issue = issue && last_item && last_place;
  always @(posedge clk) begin
    if (start || start_volumes) begin
      mode_q      <= start_volumes ? VOLUMES : state_q == UNION ? CHILDREN : VERTICES;
      place_q     <= 4'd0;
      item_q      <= 3'd0;
      pause_q     <= 3'd0;
      last_item_q <= start_volumes || state_q == UNION ? {1'b0, others_q} :
          kind_q == 2'd1 ? 3'd2 : kind_q == 2'd2 ? 3'd5 : 3'd3;
    end else if (run_q) begin
      pause_q <= pause_q != 3'd0 ? pause_q - 3'd1 : by_child && place_q == 4'd2 ? 3'd4 : 3'd0;
      if (issue) begin
        if (by_child || last_item) place_q <= next_place;
        if (by_child ? last_place : 1'b1) item_q <= last_item ? 3'd0 : item_q + 3'd1;
      end
    end
    drain_q <= run_q ? 4'd13 : drain_q - {3'd0, drain_q != 4'd0};
    if (rst) run_q <= 1'b0;
    else run_q <= start | start_volumes | (run_q & ~last_issue);
  end
  wire pass_done = ~run_q && drain_q == 4'd1;

  // {negated, used} axes of the direction at a place
  function [5:0] axes_of(input [3:0] place);
    case (place)
      4'd0: axes_of = 6'b000_001;
      4'd1: axes_of = 6'b000_010;
      4'd2: axes_of = 6'b000_100;
      4'd6: axes_of = 6'b000_011;
      4'd7: axes_of = 6'b010_011;
      4'd8: axes_of = 6'b000_101;
      4'd9: axes_of = 6'b100_101;
      4'd10: axes_of = 6'b000_110;
      4'd11: axes_of = 6'b100_110;
      4'd12: axes_of = 6'b000_111;
      4'd13: axes_of = 6'b100_111;
      4'd14: axes_of = 6'b010_111;
      default: axes_of = 6'b001_111;
    endcase
  endfunction

  // ---- clocks 1..7: {axes, place, item, first, last item}
  localparam integer CONTROL_W = 6 + 4 + 3 + 2;
  reg [CONTROL_W-1:0] control_q1, control_q2, control_q3, control_q4, control_q5, control_q6;
  reg [6:1] valid_q;
  always @(posedge clk) begin
    control_q1 <= {axes_of(place_q), place_q, item_q, item_q == 3'd0, last_item};
    control_q2 <= control_q1;
    control_q3 <= control_q2;
    control_q4 <= control_q3;
    control_q5 <= control_q4;
    control_q6 <= control_q5;
    valid_q    <= rst ? 6'd0 : {valid_q[5:1], issue};
  end
  wire [5:0] axes6 = control_q6[9+:6];
  wire [3:0] place6 = control_q6[5+:4];

  wire [51:0] leaf_least, leaf_greatest;
  cchip_refit_leaf u_leaf (
      .clk       (clk),
      .s_line    (data_q),
      .s_quad    (leaf_quad),
      .s_vertex  (item_q),
      .s_axes    (axes_of(place_q)),
      .m_least   (leaf_least),
      .m_greatest(leaf_greatest)
  );

  // ---- bounds of the children of the nodes in work
  wire [103:0] stored;
  reg store_q;
  reg [LEVEL_W-1:0] store_level_q;
  reg [1:0] store_child_q;
  reg [3:0] store_place_q;
  reg [51:0] least_q, greatest_q;
  cchip_block_ram #(.WIDTH(104), .WORDS(1), .ADDR_W(LEVEL_W + 6)) u_bounds (
      .clk       (clk),
      .write     (store_q),
      .write_addr({store_level_q, store_child_q, store_place_q}),
      .write_data({greatest_q, least_q}),
      .read_addr ({level[LEVEL_W-1:0], control_q4[3:2], control_q4[5+:4]}),
      .read_data (stored)
  );

  // ---- clock 7: the least and the greatest of all items
  wire [51:0] least6 = mode_q == VERTICES ? leaf_least : stored[51:0];
  wire [51:0] greatest6 = mode_q == VERTICES ? leaf_greatest : stored[103:52];
  reg whole_q;  // of a node's axis
  always @(posedge clk) begin
    if (control_q6[1] || $signed(least6) < $signed(least_q)) least_q <= least6;
    if (control_q6[1] || $signed(greatest6) > $signed(greatest_q)) greatest_q <= greatest6;
    store_place_q <= place6;
    store_level_q <= mode_q == VERTICES ? level[LEVEL_W-1:0] : level_above[LEVEL_W-1:0];
    store_child_q <= mode_q == VERTICES ? index_q : above_index;
    if (rst) begin
      store_q <= 1'b0;
      whole_q <= 1'b0;
    end else begin
      store_q <= valid_q[6] && control_q6[0] && (mode_q == VERTICES ||
          (mode_q == CHILDREN && depth_q != 7'd1));
      whole_q <= valid_q[6] && control_q6[0] && mode_q == CHILDREN && place6 < 4'd3;
    end
  end

  // ---- origin and step, then volumes
  wire search = state_q == PASS && pass_done && mode_q == CHILDREN;
  wire frame_done, frame_none;
  wire [53:0] origin;
  wire [4:0] step;
  cchip_refit_frame u_frame (
      .clk       (clk),
      .rst       (rst),
      .s_valid   (whole_q),
      .s_axis    (store_place_q[1:0]),
      .s_least   (least_q),
      .s_greatest(greatest_q),
      .search    (search),
      .m_done    (frame_done),
      .m_none    (frame_none),
      .m_origin  (origin),
      .m_step    (step)
  );
  assign start_volumes = state_q == SEARCH && frame_done && !frame_none;
  wire volume_valid, volume_axis;
  wire [13:0] volume;
  cchip_refit_volume u_volume (
      .clk           (clk),
      .rst           (rst),
      .s_origin      (origin),
      .s_step        (step),
      .s_cut_exponent(cut_exponent_q),
      .s_valid       (valid_q[6] && by_child),
      .s_axis        (place6 < 4'd3),
      .s_axes        (axes6),
      .s_least       (stored[51:0]),
      .s_greatest    (stored[103:52]),
      .m_valid       (volume_valid),
      .m_axis        (volume_axis),
      .m_data        (volume)
  );
  // they come in the order of their bits; absent children are 0
  reg [407:0] volumes_q;
  reg [1:0] fill_q;  // children that are there, then those that have got zeros too
  always @(posedge clk) begin
    if (volume_valid && volume_axis) volumes_q <= {volume, volumes_q[407:14]};
    else if (volume_valid) volumes_q <= {volume[5:0], volumes_q[407:6]};
    else if (state_q == FILL && fill_q != 2'd3) volumes_q <= {102'd0, volumes_q[407:102]};
    fill_q <= state_q == FILL ? fill_q + 2'd1 : others_q;
  end
  wire [511:0] node = {
    8'd0, volumes_q, 2'd0, cut_exponent_q, others_q, kinds_q, first_q, step, origin
  };

  // ---- memory. A read or write that is given up stays open until its answer comes
  reg reading_q, writing_q, offered_q;
  reg [2:0] beat_q;
  reg read_q;
  reg [31:0] address_q;
  wire write_step = offered_q & m_write_ready;
  wire last_beat = beat_q == LAST_BEAT[2:0];
  wire begin_write = state_q == FILL && fill_q == 2'd3 && !abort_q;
  always @(posedge clk) begin
    if (begin_write) data_q <= node;
    else if (s_read_valid || write_step) data_q <= shifted;
    if (begin_write) beat_q <= 3'd0;
    else if (write_step) beat_q <= beat_q + 3'd1;
    if (state_q == LINE || begin_write)
      address_q <= base_q + {8'd0, state_q == LINE ? line_q : node_q};
  end
  wire request = state_q == LINE && !abort_q && {1'b0, visited_q} + 25'd1 < lines_q;
  always @(posedge clk)
    if (rst) begin
      read_q    <= 1'b0;
      reading_q <= 1'b0;
      writing_q <= 1'b0;
      offered_q <= 1'b0;
    end else begin
      read_q    <= request;
      reading_q <= request | (reading_q & ~(s_read_valid & s_read_last));
      writing_q <= begin_write | (writing_q & ~s_write_valid);
      offered_q <= begin_write | (offered_q & ~(write_step & last_beat));
    end
  wire expired;
  wire [31:0] elapsed;
  wire waits = state_q == READ || state_q == WRITE || state_q == ANSWER;
  cchip_timeout #(.DEFAULT(4 * `CCHIP_MEMORY_LIMIT_DEFAULT)) u_timeout (
      .clk    (clk),
      .restart(rst | ~waits),
      .limit  (limit),
      .elapsed(elapsed),
      .expired(expired)
  );

  // ---- what is next
  reg ready_q, done_q;
  wire read_end = s_read_valid & s_read_last;
  wire [`CCHIP_REFIT_CODE_W-1:0] read_code = s_read_code == `CCHIP_READ_OK ? `CCHIP_REFIT_OK :
      s_read_code == `CCHIP_READ_TIMEOUT ? `CCHIP_REFIT_TIMEOUT :
      s_read_code == `CCHIP_READ_OWED ? `CCHIP_REFIT_OWED : `CCHIP_REFIT_READ;
  wire [`CCHIP_REFIT_CODE_W-1:0] write_code = s_write_code == `CCHIP_WRITE_OK ? `CCHIP_REFIT_OK :
      s_write_code == `CCHIP_WRITE_TIMEOUT ? `CCHIP_REFIT_TIMEOUT :
      s_write_code == `CCHIP_WRITE_OWED ? `CCHIP_REFIT_OWED : `CCHIP_REFIT_WRITE;
  wire bad_command = s_base > 32'hFEFFFFFF || s_lines > 32'h1000000 || s_root == 24'd0 ||
      {8'd0, s_root} >= s_lines;
  reg [3:0] state_d;
  reg [`CCHIP_REFIT_CODE_W-1:0] code_d;  // of a state that ends the refit
  always @* begin
    state_d = state_q;
    code_d  = `CCHIP_REFIT_OK;
    case (state_q)
      IDLE:
      if (ready_q && s_valid) begin
        code_d = reading_q | writing_q ? `CCHIP_REFIT_OWED :
            bad_command ? `CCHIP_REFIT_COMMAND : `CCHIP_REFIT_OK;
        state_d = LINE;
      end
      LINE: begin
        code_d  = abort_q ? `CCHIP_REFIT_ABORT : request ? `CCHIP_REFIT_OK : `CCHIP_REFIT_VISITS;
        state_d = READ;
      end
      READ:
      if (read_end) begin
        code_d  = read_code;
        state_d = kind_q == 2'd0 ? NODE : LEAF;
      end else if (expired) code_d = `CCHIP_REFIT_TIMEOUT;
      NODE: begin
        code_d = {25'd0, depth_q} == DEEPEST ? `CCHIP_REFIT_DEPTH :
            new_first <= line_q || new_last >= lines_q ? `CCHIP_REFIT_OUTSIDE : `CCHIP_REFIT_OK;
        state_d = CHILD;
      end
      LEAF: begin
        code_d  = start ? `CCHIP_REFIT_OK : `CCHIP_REFIT_LEAF;
        state_d = PASS;
      end
      CHILD: state_d = LINE;
      PASS:
      if (pass_done) state_d = mode_q == VERTICES ? NEXT : mode_q == CHILDREN ? SEARCH : FILL;
      NEXT: state_d = index_q == others_q ? UNION : CHILD;
      UNION: state_d = PASS;
      SEARCH:
      if (frame_done) begin
        code_d  = frame_none ? `CCHIP_REFIT_RANGE : `CCHIP_REFIT_OK;
        state_d = PASS;
      end
      FILL:
      if (abort_q) code_d = `CCHIP_REFIT_ABORT;
      else if (fill_q == 2'd3) state_d = WRITE;
      WRITE:
      if (write_step && last_beat) state_d = ANSWER;
      else if (expired) code_d = `CCHIP_REFIT_TIMEOUT;
      ANSWER:
      if (s_write_valid) begin
        code_d  = write_code;
        state_d = depth_q == 7'd1 ? DONE : NEXT;
      end else if (expired) code_d = `CCHIP_REFIT_TIMEOUT;
      default: if (m_ready) state_d = IDLE;
    endcase
    if (code_d != `CCHIP_REFIT_OK) state_d = DONE;
  end
  always @(posedge clk) begin
    case (state_q)
      IDLE: begin
        base_q    <= s_base;
        lines_q   <= s_lines[24:0];
        line_q    <= code_d == `CCHIP_REFIT_OK ? s_root : 24'd0;
        kind_q    <= 2'd0;
        visited_q <= 24'd0;
        depth_q   <= 7'd0;
      end
      LINE: if (request) visited_q <= visited_q + 24'd1;
      NODE: begin
        node_q         <= line_q;
        first_q        <= new_first;
        kinds_q        <= data_q[`CCHIP_NODE_LINE_KINDS];
        others_q       <= new_others;
        cut_exponent_q <= data_q[`CCHIP_NODE_LINE_CUT_EXPONENT];
        index_q        <= 2'd0;
        if (code_d == `CCHIP_REFIT_OK) depth_q <= depth_q + 7'd1;
      end
      CHILD: begin
        line_q <= first_q + {22'd0, index_q};
        kind_q <= kinds_q[{index_q, 1'b0}+:2];
      end
      NEXT: if (index_q != others_q) index_q <= index_q + 2'd1;
      UNION: line_q <= node_q;
      ANSWER:
      if (s_write_valid && depth_q != 7'd1) begin
        {node_q, first_q, kinds_q, others_q, cut_exponent_q, index_q} <= above_q;
        depth_q <= level;
      end
      default: ;
    endcase
    if (state_q != DONE) code_q <= code_d;
    if (rst) begin
      state_q <= IDLE;
      ready_q <= 1'b0;
      done_q  <= 1'b0;
      abort_q <= 1'b0;
    end else begin
      state_q <= state_d;
      ready_q <= state_d == IDLE;
      done_q  <= state_d == DONE;
      abort_q <= (abort_q | s_abort) && state_q != IDLE;
    end
  end
  assign s_ready       = ready_q;
  assign m_valid       = done_q;
  assign m_code        = code_q;
  assign m_line        = line_q;
  assign m_lines       = visited_q;
  assign m_read_valid  = read_q;
  assign m_read_line   = address_q;
  assign m_write_valid = offered_q;
  assign m_write_last  = last_beat;
  assign m_write_line  = address_q;
  assign m_write_beat  = beat_q;
  assign m_write_data  = data_q[DATA_W-1:0];

  wire unused = &{1'b0, elapsed, control_q6[4:2], level, level_above};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_depth, {25'd0, depth_q} <= DEEPEST)
      `CCHIP_ASSERT(a_one, !(reading_q && writing_q))
      `CCHIP_ASSERT(a_answer, !s_read_valid || reading_q)
    end

endmodule
`default_nettype wire
