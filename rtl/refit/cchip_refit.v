// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit: gives every node of an object's image new volumes after its leaves got new vertices.
// The host writes header and leaves of the moved object; topology and cut exponents stay.
//   order        children before their node, by descent from the root: the kind of a line stands in
//                its parent, so a pass over the lines in the order of their numbers could not tell
//                a leaf from a node. Every line is read once, every node is written once
//   overlap      three parts work at once: cchip_refit_walk reads up to two lines ahead of the
//                current one, vertices of the current leaf pass here, cchip_refit_node finishes the
//                node whose children were done last, and its write waits for its answer meanwhile
//   bounds       those of a node's children lie in a block RAM until the node is finished, four for
//                each level in work, so the size of an object does not matter; beside them those of
//                all children so far. The stored volumes are rounded too much to compute those of
//                the node above from them
//   memory       the ports are those of a client of cchip_axi_read (slots 0, 1) and of
//                cchip_axi_write; two reads and a write in flight
//   end          m_code, m_line: the current line, or the node that was finished or written, if the
//                error is its own; m_lines: lines read. Errors count in the order of the descent,
//                that of a line read ahead when it becomes the current one. What is outstanding is
//                awaited first. After an error a part of the nodes is new, the others are old: no
//                query may use the image
//   silence      each wait for memory lasts `limit` clocks (cchip_timeout) at most; it must exceed
//                those of the masters. What is outstanding then is waited for in the background: a
//                command that comes before it ends is answered with OWED
//   abort        ends the refit before it takes another line or begins another write
//   time         without waits 13 vertices + 2 clocks a leaf, 17 a node (cchip_refit_node takes
//                longer, beside them); waits: docs/modules/cchip_refit.md
//   cuts         every path: each output is a flip-flop, decoded from the state or chosen between
//                flip-flops
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
    output wire                           m_read_slot,    // its slot
    output wire [                   31:0] m_read_line,    // its address / 64
    input  wire                           s_read_valid,   // a beat of an answer
    input  wire                           s_read_slot,    // its slot
    input  wire [                    2:0] s_read_beat,    // its number
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

  localparam integer LEVEL_W = LEVELS == 2 ? 2 : $clog2(LEVELS);
  localparam integer FRAME_W = 24 + 24 + 8 + 2 + 1 + 2;
  localparam [4:0] EXTENT_MAX = 5'd24;

  `CCHIP_REFUSE(LEVELS < 2 || LEVELS > 64, cchip_error_refit_LEVELS_must_be_2_to_64)
  `CCHIP_REFUSE(DATA_W < 64 || DATA_W > 512 || (1 << $clog2(DATA_W)) != DATA_W,
                cchip_error_refit_DATA_W_must_be_64_128_256_or_512)

  localparam [3:0] IDLE = 4'd0;
  localparam [3:0] TAKE = 4'd1;  // the next line becomes the current one
  localparam [3:0] LINE = 4'd2;  // it is here
  localparam [3:0] LEAF = 4'd3;  // its vertices pass
  localparam [3:0] UNION = 4'd4;  // all children are done
  localparam [3:0] RISE = 4'd5;  // bounds of the node pass
  localparam [3:0] NEXT = 4'd6;  // it is the child of the node above that is done
  localparam [3:0] ENDED = 4'd7;  // what is in work or outstanding comes to its end
  localparam [3:0] DONE = 4'd8;
  reg [3:0] state_q, state_d;
  wire rests = state_q == IDLE || state_q == DONE;

  // ---- the refit
  reg [31:0] base_q;
  reg [24:0] lines_q;
  reg [23:0] line_q;  // current
  reg [1:0] kind_q;  // of it
  reg [511:0] data_q;  // what is in it
  reg [23:0] visited_q;
  reg [`CCHIP_REFIT_CODE_W-1:0] code_q, line_code_q;
  reg abort_q;
  // of a node that is finished, or was
  reg fault_q, fault_write_q;
  reg [`CCHIP_REFIT_CODE_W-1:0] fault_code_q;
  reg [23:0] fault_line_q;

  // ---- the lines in the order of the descent
  reg ready_q, done_q;
  wire accept = ready_q & s_valid;
  wire line_valid, reading;
  wire [23:0] new_line;
  wire [1:0] new_kind;
  wire [`CCHIP_REFIT_CODE_W-1:0] new_code;
  wire [511:0] new_data;
  wire take = state_q == TAKE && !abort_q && line_valid;
  cchip_refit_walk #(.LEVELS(LEVELS), .DATA_W(DATA_W)) u_walk (
      .clk         (clk),
      .rst         (rst),
      .start       (accept),
      .go          (!rests && state_q != ENDED && !abort_q),
      .s_base      (base_q),
      .s_lines     (lines_q),
      .s_root      (s_root),
      .m_valid     (line_valid),
      .m_ready     (take),
      .m_line      (new_line),
      .m_kind      (new_kind),
      .m_code      (new_code),
      .m_data      (new_data),
      .reading     (reading),
      .m_read_valid(m_read_valid),
      .m_read_slot (m_read_slot),
      .m_read_line (m_read_line),
      .s_read_valid(s_read_valid),
      .s_read_slot (s_read_slot),
      .s_read_beat (s_read_beat),
      .s_read_last (s_read_last),
      .s_read_code (s_read_code),
      .s_read_data (s_read_data)
  );

  // ---- the node in work, and those above it
  reg [23:0] node_q, first_q;
  reg [7:0] kinds_q;
  reg [1:0] others_q, index_q;  // children behind the first; the one in work
  reg cut_exponent_q;
  reg [6:0] depth_q;  // nodes in work
  `CCHIP_LUT_RAM
  reg [FRAME_W-1:0] stack[0:(1<<LEVEL_W)-1];
  reg [FRAME_W-1:0] above_q;  // the node above
  wire [6:0] level = depth_q - 7'd1;
  wire [6:0] level_above = depth_q - 7'd2;
  wire last_child = index_q == others_q;
  wire push = state_q == LINE && kind_q == 2'd0;
  always @(posedge clk) begin
    if (push)
      stack[level[LEVEL_W-1:0]] <= {node_q, first_q, kinds_q, others_q, cut_exponent_q, index_q};
    above_q <= stack[level_above[LEVEL_W-1:0]];
  end

  // ---- passes, clock 0: place of a direction, and vertex. A leaf's vertices pass direction by
  // direction, or what is stored of a node
  reg run_q, rise_q, conflict_q;
  reg [3:0] place_q;
  reg [2:0] vertex_q, last_vertex_q;
  wire node_idle, node_boxes, node_reads;
  wire [LEVEL_W-1:0] node_level;
  wire [1:0] node_child;
  wire small_leaf = data_q[`CCHIP_LEAF_LINE_EXTENT] <= EXTENT_MAX;
  wire start_leaf = state_q == LINE && kind_q != 2'd0 && line_code_q == `CCHIP_REFIT_OK &&
      small_leaf && !conflict_q;
  wire start_rise = state_q == UNION && !abort_q && !fault_q && node_idle;
  wire last_vertex = vertex_q == last_vertex_q;
  wire last_place = place_q == 4'd15;
  wire last_issue = run_q && last_vertex && last_place;
  wire pop = state_q == RISE && last_issue && depth_q != 7'd1;
  always @(posedge clk) begin
    // bounds of the node that is finished are needed yet; those of a child are read faster than a
    // leaf stores its own
    conflict_q <= node_level == level[LEVEL_W-1:0] &&
        (node_boxes || (node_reads && node_child < index_q));
    if (start_leaf || start_rise) begin
      rise_q        <= start_rise;
      place_q       <= 4'd0;
      vertex_q      <= 3'd0;
      last_vertex_q <= start_rise ? 3'd0 : kind_q == 2'd1 ? 3'd2 : kind_q == 2'd2 ? 3'd5 : 3'd3;
    end else if (run_q) begin
      vertex_q <= last_vertex ? 3'd0 : vertex_q + 3'd1;
      if (last_vertex) place_q <= place_q == 4'd2 ? 4'd6 : place_q + 4'd1;
    end
    if (rst) run_q <= 1'b0;
    else run_q <= start_leaf | start_rise | (run_q & ~last_issue & ~rests);
  end
  wire [5:0] axes;
  cchip_refit_axes u_axes (
      .place(place_q),
      .axes (axes)
  );

  // ---- clocks 1..8: {levels, child, rise, stored, place, first, last vertex}. Bounds are stored
  // as those of a child, of the node in work or above it
  localparam integer CONTROL_W = LEVEL_W + LEVEL_W + 2 + 1 + 1 + 4 + 2;
  wire [CONTROL_W-1:0] control = {
    level_above[LEVEL_W-1:0],
    level[LEVEL_W-1:0],
    rise_q ? above_q[1:0] : index_q,
    rise_q,
    !rise_q || depth_q != 7'd1,
    place_q,
    vertex_q == 3'd0,
    last_vertex
  };
  reg [CONTROL_W-1:0] control_q1, control_q2, control_q3, control_q4, control_q5, control_q6;
  reg [CONTROL_W-1:0] control_q7;
  reg [7:1] valid_q;
  always @(posedge clk) begin
    control_q1 <= control;
    control_q2 <= control_q1;
    control_q3 <= control_q2;
    control_q4 <= control_q3;
    control_q5 <= control_q4;
    control_q6 <= control_q5;
    control_q7 <= control_q6;
    valid_q    <= rst ? 7'd0 : {valid_q[6:1], run_q};
  end
  wire [LEVEL_W-2:0] even4 = control_q4[11+:LEVEL_W-1];
  wire [LEVEL_W-2:0] odd4 = control_q4[11+LEVEL_W+:LEVEL_W-1];
  wire rise6 = control_q6[7];
  wire odd6 = control_q6[10];
  wire [LEVEL_W-1:0] above7, level7;
  wire [1:0] child7;
  wire rise7, stored7, first7, last7;
  wire [3:0] place7;
  assign {above7, level7, child7, rise7, stored7, place7, first7, last7} = control_q7;

  wire [51:0] leaf_least, leaf_greatest;
  cchip_refit_leaf u_leaf (
      .clk       (clk),
      .s_line    (data_q),
      .s_quad    (kind_q == 2'd3),
      .s_vertex  (vertex_q),
      .s_axes    (axes),
      .m_least   (leaf_least),
      .m_greatest(leaf_greatest)
  );

  // ---- bounds of the children of the nodes in work; and of all children so far, levels of even
  // and of odd numbers apart: those of a node are read together with those of the node above
  reg [51:0] least_q, greatest_q, all_least_q, all_greatest_q;
  reg store_q, store_all_q;
  reg [LEVEL_W-1:0] store_level_q, all_level_q;
  reg [1:0] store_child_q;
  reg [3:0] store_place_q, all_place_q;
  wire [103:0] bounds, even, odd;
  wire [3:0] node_place;
  cchip_block_ram #(.WIDTH(104), .WORDS(1), .ADDR_W(LEVEL_W + 6)) u_bounds (
      .clk       (clk),
      .write     (store_q),
      .write_addr({store_level_q, store_child_q, store_place_q}),
      .write_data({greatest_q, least_q}),
      .read_addr ({node_level, node_child, node_place}),
      .read_data (bounds)
  );
  cchip_block_ram #(.WIDTH(104), .WORDS(1), .ADDR_W(LEVEL_W + 3)) u_even (
      .clk       (clk),
      .write     (store_all_q && !all_level_q[0]),
      .write_addr({all_level_q[LEVEL_W-1:1], all_place_q}),
      .write_data({all_greatest_q, all_least_q}),
      .read_addr ({even4, control_q4[5:2]}),
      .read_data (even)
  );
  cchip_block_ram #(.WIDTH(104), .WORDS(1), .ADDR_W(LEVEL_W + 3)) u_odd (
      .clk       (clk),
      .write     (store_all_q && all_level_q[0]),
      .write_addr({all_level_q[LEVEL_W-1:1], all_place_q}),
      .write_data({all_greatest_q, all_least_q}),
      .read_addr ({odd4, control_q4[5:2]}),
      .read_data (odd)
  );

  // ---- clock 7: bounds of a vertex or of a node; 8: the least and the greatest of all vertices;
  // 9: of all children so far
  reg [103:0] item_q, before_q, old_q;
  wire [51:0] least7 = item_q[51:0];
  wire [51:0] greatest7 = item_q[103:52];
  reg whole_q;  // of a node's axis
  always @(posedge clk) begin
    item_q   <= !rise6 ? {leaf_greatest, leaf_least} : odd6 ? odd : even;
    before_q <= odd6 != rise6 ? odd : even;
    if (first7 || $signed(least7) < $signed(least_q)) least_q <= least7;
    if (first7 || $signed(greatest7) > $signed(greatest_q)) greatest_q <= greatest7;
    old_q         <= before_q;
    store_level_q <= rise7 ? above7 : level7;
    store_child_q <= child7;
    store_place_q <= place7;
    all_least_q <= store_child_q != 2'd0 && $signed(old_q[51:0]) < $signed(least_q) ?
        old_q[51:0] : least_q;
    all_greatest_q <= store_child_q != 2'd0 && $signed(old_q[103:52]) > $signed(greatest_q) ?
        old_q[103:52] : greatest_q;
    all_level_q   <= store_level_q;
    all_place_q   <= store_place_q;
    store_q       <= ~rst & valid_q[7] & last7 & stored7;
    store_all_q   <= ~rst & store_q;
    whole_q       <= ~rst & valid_q[7] & rise7 && place7 < 4'd3;
  end

  // ---- nodes of which all children are done
  wire fault, of_write, node_waits, writing, begins;
  wire [`CCHIP_REFIT_CODE_W-1:0] fault_code;
  wire [23:0] fault_line, written;
  cchip_refit_node #(.LEVEL_W(LEVEL_W), .DATA_W(DATA_W)) u_node (
      .clk           (clk),
      .rst           (rst),
      .drop          (rests || fault_q),
      .hold_write    (abort_q),
      .start         (start_rise),
      .s_level       (level[LEVEL_W-1:0]),
      .s_base        (base_q),
      .s_node        (node_q),
      .s_first       (first_q),
      .s_kinds       (kinds_q),
      .s_others      (others_q),
      .s_cut_exponent(cut_exponent_q),
      .idle          (node_idle),
      .s_valid       (whole_q),
      .s_axis        (store_place_q[1:0]),
      .s_least       (least_q),
      .s_greatest    (greatest_q),
      .boxes         (node_boxes),
      .reads         (node_reads),
      .m_level       (node_level),
      .m_child       (node_child),
      .m_place       (node_place),
      .s_bounds      (bounds),
      .m_fault       (fault),
      .m_code        (fault_code),
      .m_line        (fault_line),
      .m_of_write    (of_write),
      .waits         (node_waits),
      .writing       (writing),
      .begins        (begins),
      .m_written     (written),
      .m_write_valid (m_write_valid),
      .m_write_ready (m_write_ready),
      .m_write_last  (m_write_last),
      .m_write_line  (m_write_line),
      .m_write_beat  (m_write_beat),
      .m_write_data  (m_write_data),
      .s_write_valid (s_write_valid),
      .s_write_code  (s_write_code)
  );
  // the first error counts, but that of a write, which is of an earlier node, before all
  reg [23:0] node_visited_q;  // lines read when the node was done
  always @(posedge clk) begin
    if (start_rise) node_visited_q <= visited_q;
    if (fault && (of_write || !fault_q)) begin
      fault_write_q <= of_write;
      fault_code_q  <= fault_code;
      fault_line_q  <= fault_line;
    end
    fault_q <= ~rst && !rests && (fault_q | fault);
  end

  // ---- silence
  wire expired;
  wire [31:0] elapsed;
  wire waits = (state_q == TAKE && !line_valid) || node_waits || (state_q == ENDED && node_idle);
  wire progress = begins | s_write_valid | (s_read_valid & s_read_last);
  cchip_timeout #(.DEFAULT(4 * `CCHIP_MEMORY_LIMIT_DEFAULT)) u_timeout (
      .clk    (clk),
      .restart(rst | ~waits | progress),
      .limit  (limit),
      .elapsed(elapsed),
      .expired(expired)
  );

  // ---- what is next
  wire quiet = node_idle & ~writing & ~reading;
  wire bad_command = s_base > 32'hFEFFFFFF || s_lines > 32'h1000000 || s_root == 24'd0 ||
      {8'd0, s_root} >= s_lines;
  reg [`CCHIP_REFIT_CODE_W-1:0] code_d;  // of a state that ends the refit
  always @* begin
    state_d = state_q;
    code_d  = code_q;
    case (state_q)
      IDLE:
      if (accept) begin
        code_d = reading | writing ? `CCHIP_REFIT_OWED :
            bad_command ? `CCHIP_REFIT_COMMAND : `CCHIP_REFIT_OK;
        state_d = code_d == `CCHIP_REFIT_OK ? TAKE : DONE;
      end
      TAKE: if (take) state_d = LINE;
      LINE:
      if (line_code_q != `CCHIP_REFIT_OK) code_d = line_code_q;
      else if (kind_q == 2'd0) state_d = TAKE;
      else if (!small_leaf) code_d = `CCHIP_REFIT_LEAF;
      else if (!conflict_q) state_d = LEAF;
      LEAF: if (last_issue) state_d = last_child ? UNION : TAKE;
      NEXT: state_d = last_child ? UNION : TAKE;
      UNION: if (start_rise) state_d = RISE;
      RISE: if (last_issue) state_d = depth_q == 7'd1 ? ENDED : NEXT;
      ENDED: if (quiet) state_d = DONE;
      default: if (m_ready) state_d = IDLE;
    endcase
    if (!rests && state_q != ENDED) begin
      if (abort_q && (state_q == TAKE || state_q == UNION)) code_d = `CCHIP_REFIT_ABORT;
      if (code_d != `CCHIP_REFIT_OK || fault_q) state_d = ENDED;
    end
    if (!rests && expired) begin
      if (code_d == `CCHIP_REFIT_OK) code_d = `CCHIP_REFIT_TIMEOUT;
      state_d = DONE;
    end
  end
  always @(posedge clk) begin
    case (state_q)
      IDLE: begin
        base_q    <= s_base;
        lines_q   <= s_lines[24:0];
        line_q    <= 24'd0;
        visited_q <= 24'd0;
        depth_q   <= 7'd0;
      end
      TAKE: begin
        line_q      <= new_line;
        kind_q      <= new_kind;
        data_q      <= new_data;
        line_code_q <= new_code;
        if ((take && new_code != `CCHIP_REFIT_VISITS) || expired) visited_q <= visited_q + 24'd1;
      end
      LINE:
      if (kind_q == 2'd0) begin
        node_q         <= line_q;
        first_q        <= data_q[`CCHIP_NODE_LINE_FIRST];
        kinds_q        <= data_q[`CCHIP_NODE_LINE_KINDS];
        others_q       <= data_q[`CCHIP_NODE_LINE_CHILDREN];
        cut_exponent_q <= data_q[`CCHIP_NODE_LINE_CUT_EXPONENT];
        index_q        <= 2'd0;
        depth_q        <= depth_q + 7'd1;
      end
      LEAF: if (last_issue && !last_child) index_q <= index_q + 2'd1;
      NEXT: if (!last_child) index_q <= index_q + 2'd1;
      UNION: line_q <= node_q;
      RISE:
      if (pop) begin
        {node_q, first_q, kinds_q, others_q, cut_exponent_q, index_q} <= above_q;
        depth_q <= level;
      end
      default: ;
    endcase
    code_q <= rests && !accept ? (state_q == IDLE ? `CCHIP_REFIT_OK : code_q) : code_d;
    if (!rests && (expired || (state_q == ENDED && quiet))) begin
      if (fault_q) begin
        code_q <= fault_code_q;
        line_q <= fault_line_q;
        if (!fault_write_q) visited_q <= node_visited_q;
      end else if (expired && writing && code_q == `CCHIP_REFIT_OK) line_q <= written;
    end
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
  assign s_ready = ready_q;
  assign m_valid = done_q;
  assign m_code  = code_q;
  assign m_line  = line_q;
  assign m_lines = visited_q;

  wire unused = &{1'b0, elapsed, level, level_above};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_depth, rests || depth_q <= 7'd64)
      `CCHIP_ASSERT(a_run, !(start_leaf | start_rise) || !run_q)
    end

endmodule
`default_nettype wire
