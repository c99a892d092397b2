// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_refit_walk: the lines of a tree in the order of a descent from its root, a node before its
// children, read up to two lines ahead of their use.
//   ahead        the line behind a leaf is known from the node above it, so it is requested at
//                once; that behind a node only when the node is here
//   errors       of a line go with it, in m_code: of its read, OUTSIDE, DEPTH and VISITS, which
//                takes the place of the first line that may not be read. Behind a node with an
//                error nothing is read
//   memory       a client of cchip_axi_read with slots 0 and 1
//   latency      2 clocks from start or from a leaf's request to the next request, 2 more for each
//                level it goes up; 4 from a node's last beat. m_valid 1 clock behind a leaf's last
//                beat, 3 behind a node's
//   cuts         every path but that of m_data, a read of a LUT RAM
//   reset        must reset memory's answers too
module cchip_refit_walk #(
    parameter integer LEVELS = 48,  // of nodes; legal: 2..64
    parameter integer DATA_W = 128  // width of a beat (bit); legal: 64, 128, 256, 512
) (
    input  wire                           clk,           // clock, rising edge
    input  wire                           rst,           // synchronous reset, active high
    input  wire                           start,         // a walk; what is left of another is lost
    input  wire                           go,            // lines may be requested
    input  wire [                   31:0] s_base,        // address of the image / 64; it stays
    input  wire [                   24:0] s_lines,       // lines of the image; it stays
    input  wire [                   23:0] s_root,        // with start: line of the root
    // ---- the lines
    output wire                           m_valid,       // a line
    input  wire                           m_ready,       // it is taken
    output wire [                   23:0] m_line,  // its number, or that of the one waited for
    output wire [                    1:0] m_kind,        // 0: a node
    output wire [`CCHIP_REFIT_CODE_W-1:0] m_code,        // OK, or why it may not be used
    output wire [                  511:0] m_data,        // what is in it
    output wire                           reading,       // beats are to come
    // ---- memory
    output wire                           m_read_valid,  // a read; there is no ready
    output wire                           m_read_slot,   // its slot
    output wire [                   31:0] m_read_line,   // its address / 64
    input  wire                           s_read_valid,  // a beat of an answer
    input  wire                           s_read_slot,   // its slot
    input  wire [                    2:0] s_read_beat,   // its number
    input  wire                           s_read_last,   // the last one
    input  wire [ `CCHIP_READ_CODE_W-1:0] s_read_code,   // with it, the code of cchip_axi_read
    input  wire [             DATA_W-1:0] s_read_data    // the beat
);

  localparam integer LEVEL_W = $clog2(LEVELS);
  localparam integer BEATS = 512 / DATA_W;
  localparam integer FRAME_W = 24 + 8 + 2 + 2;
  localparam [31:0] DEEPEST = LEVELS;

  localparam [2:0] STOP = 3'd0;
  localparam [2:0] ASK = 3'd1;  // for line_q
  localparam [2:0] NODE = 3'd2;  // it was a node, which comes
  localparam [2:0] CHECK = 3'd3;  // it is here
  localparam [2:0] ENTER = 3'd4;  // its first child is next
  localparam [2:0] NEXT = 3'd5;  // it was a leaf: the next child, or
  localparam [2:0] POP = 3'd6;  // that of the node above
  reg [2:0] state_q;
  reg [23:0] line_q, visited_q;
  reg [1:0] kind_q;
  reg full_q;  // no line more may be read
  reg read_q, read_slot_q;
  reg [31:0] read_line_q;
  reg slot_q;  // of the next request; the other one is that of the last

  // ---- the node whose children are requested, and those above it
  reg [23:0] first_q;
  reg [7:0] kinds_q;
  reg [1:0] others_q, index_q;  // children behind the first; the one requested last
  reg [6:0] depth_q;  // nodes above the next line
  `CCHIP_LUT_RAM
  reg [FRAME_W-1:0] stack[0:(1<<LEVEL_W)-1];
  reg [FRAME_W-1:0] above_q;
  wire [6:0] level = depth_q - 7'd1;
  wire [6:0] level_above = depth_q - 7'd2;
  always @(posedge clk) begin
    if (state_q == ENTER)
      stack[level[LEVEL_W-1:0]] <= {first_q, kinds_q, others_q, index_q};
    above_q <= stack[level_above[LEVEL_W-1:0]];
  end

  // ---- two lines, column by column
  reg head_q;
  genvar i;
  generate
    for (i = 0; i < BEATS; i = i + 1) begin : gen_column
      localparam [31:0] NUMBER = i;
      `CCHIP_LUT_RAM
      reg [DATA_W-1:0] column[0:1];
      always @(posedge clk)
        if (s_read_valid && s_read_beat == NUMBER[2:0]) column[s_read_slot] <= s_read_data;
      assign m_data[DATA_W*i+:DATA_W] = column[head_q];
    end
  endgenerate

  // ---- first, kinds and number of children of the node that comes
  reg [33:0] header_q;
  wire of_node = s_read_valid && s_read_slot != slot_q;
  generate
    if (DATA_W == 64) begin : gen_two_beats
      always @(posedge clk)
        if (of_node && s_read_beat == 3'd0) header_q[4:0] <= s_read_data[63:59];
        else if (of_node && s_read_beat == 3'd1) header_q[33:5] <= s_read_data[28:0];
    end else begin : gen_one_beat
      always @(posedge clk)
        if (of_node && s_read_beat == 3'd0) header_q <= s_read_data[92:59];
    end
  endgenerate
  wire [23:0] new_first = header_q[23:0];
  wire [7:0] new_kinds = header_q[31:24];
  wire [1:0] new_others = header_q[33:32];
  wire [24:0] new_last = {1'b0, new_first} + {23'd0, new_others};
  reg deep_q, outside_q, bad_q;
  reg [1:0] busy_q;  // slots of lines that are requested or here
  wire free = state_q == ASK && !busy_q[slot_q];
  wire request = free && go && !full_q;
  wire refuse = free && full_q;
  wire [1:0] next_index = index_q + 2'd1;
  wire [`CCHIP_REFIT_CODE_W-1:0] read_code = s_read_code == `CCHIP_READ_OK ? `CCHIP_REFIT_OK :
      s_read_code == `CCHIP_READ_TIMEOUT ? `CCHIP_REFIT_TIMEOUT :
      s_read_code == `CCHIP_READ_OWED ? `CCHIP_REFIT_OWED : `CCHIP_REFIT_READ;

  // ---- the two lines
  reg [1:0] valid_q, reading_q;
  localparam integer CODE_W = `CCHIP_REFIT_CODE_W;
  reg [51:0] item_q;  // {number, kind}
  reg [2*CODE_W-1:0] code_q;
  wire take = m_valid & m_ready;
  generate
    for (i = 0; i < 2; i = i + 1) begin : gen_slot
      localparam [0:0] SLOT = i;
      wire asks = (request | refuse) && slot_q == SLOT;
      wire arrives = s_read_valid && s_read_last && s_read_slot == SLOT;
      wire enters = state_q == ENTER && slot_q != SLOT;  // the last request was its own
      wire leaf = item_q[26*i+:2] != 2'd0;
      always @(posedge clk) begin
        if (asks) item_q[26*i+:26] <= {line_q, kind_q};
        if (arrives) code_q[CODE_W*i+:CODE_W] <= read_code;
        else if (asks) code_q[CODE_W*i+:CODE_W] <= `CCHIP_REFIT_VISITS;
        else if (enters && deep_q) code_q[CODE_W*i+:CODE_W] <= `CCHIP_REFIT_DEPTH;
        else if (enters && outside_q) code_q[CODE_W*i+:CODE_W] <= `CCHIP_REFIT_OUTSIDE;
        if (rst || start) begin
          busy_q[i]  <= 1'b0;
          valid_q[i] <= 1'b0;
        end else begin
          busy_q[i] <= asks | (busy_q[i] & ~(take && head_q == SLOT));
          valid_q[i] <= (arrives & leaf) | enters | (asks & refuse) |
              (valid_q[i] & ~(take && head_q == SLOT));
        end
        reading_q[i] <= ~rst & ((asks & request) | (reading_q[i] & ~arrives));
      end
    end
  endgenerate

  // ---- the descent
  wire [CODE_W-1:0] node_code = slot_q ? code_q[0+:CODE_W] : code_q[CODE_W+:CODE_W];
  wire node_arrives = s_read_valid && s_read_last && s_read_slot != slot_q;
  always @(posedge clk) begin
    full_q    <= ~start && {1'b0, visited_q} + 25'd1 >= s_lines;
    bad_q     <= node_code != `CCHIP_REFIT_OK;
    deep_q    <= node_code == `CCHIP_REFIT_OK && {25'd0, depth_q} == DEEPEST;
    outside_q <= node_code == `CCHIP_REFIT_OK && (new_first <= line_q || new_last >= s_lines);
    if (rst) head_q <= 1'b0;
    else if (start) begin
      line_q    <= s_root;
      kind_q    <= 2'd0;
      visited_q <= 24'd0;
      depth_q   <= 7'd0;
      // that of the line taken last: if its answer is still owed, the root is refused
      slot_q    <= ~head_q;
      head_q    <= ~head_q;
    end else begin
      if (take) head_q <= ~head_q;
      if (request) begin
        slot_q    <= ~slot_q;
        visited_q <= visited_q + 24'd1;
      end
      case (state_q)
        ENTER: begin
          {first_q, kinds_q, others_q, index_q} <= {new_first, new_kinds, new_others, 2'd0};
          line_q  <= new_first;
          kind_q  <= new_kinds[1:0];
          depth_q <= depth_q + 7'd1;
        end
        NEXT: begin
          index_q <= next_index;
          line_q  <= first_q + {22'd0, next_index};
          kind_q  <= kinds_q[{next_index, 1'b0}+:2];
        end
        POP: begin
          {first_q, kinds_q, others_q, index_q} <= above_q;
          depth_q <= level;
        end
        default: ;
      endcase
    end
    read_q      <= ~rst & request;
    read_slot_q <= slot_q;
    read_line_q <= s_base + {8'd0, line_q};
    if (rst) state_q <= STOP;
    else if (start) state_q <= ASK;
    else
      case (state_q)
        ASK:
        if (refuse) state_q <= STOP;
        else if (request) state_q <= kind_q == 2'd0 ? NODE : NEXT;
        NODE: if (node_arrives) state_q <= CHECK;
        CHECK: state_q <= ENTER;
        ENTER: state_q <= bad_q | deep_q | outside_q ? STOP : ASK;
        NEXT: state_q <= index_q != others_q ? ASK : depth_q == 7'd1 ? STOP : POP;
        POP: state_q <= NEXT;
        default: ;
      endcase
  end
  assign m_valid = valid_q[head_q];
  assign {m_line, m_kind} = head_q ? item_q[51:26] : item_q[25:0];
  assign m_code       = head_q ? code_q[CODE_W+:CODE_W] : code_q[0+:CODE_W];
  assign reading      = |reading_q;
  assign m_read_valid = read_q;
  assign m_read_slot  = read_slot_q;
  assign m_read_line  = read_line_q;

  wire unused = &{1'b0, level, level_above};
  always @(posedge clk)
    if (!rst) begin
      `CCHIP_ASSERT(a_depth, state_q == STOP || {25'd0, depth_q} <= DEEPEST)
      `CCHIP_ASSERT(a_answer, !s_read_valid || reading_q[s_read_slot])
    end

endmodule
`default_nettype wire
