// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_cache_invalidate: walks through the sets of cchip_cache: all of them after reset, to clear
// their entries, and those of a range of lines for each command. A set is looked up and changed as
// a request is: one at a time, again if its lookup came to nothing.
//   command      ready = 1 again when the last set has been changed, the reads that were in flight
//                at that time have been answered, their requests served and 7 clocks have passed:
//                answers from then on are of data that memory held after the command
//   latency      9 clocks for each set of the range, at most 2^SET_W of them
//   reset        clears the entries, one set per clock: running = 0 meanwhile
//   why          A set is looked up by a port as a request is, so the walk needs no port of its own
//                into the entries. When it is over, no answer carries data from before the command:
//                reads that were in flight have ended, and the pipeline has run empty.
module cchip_cache_invalidate #(
    parameter integer SET_W = 10,   // width of a set's number (bit); legal: >= 3
    parameter integer LINE_W = 32,  // width of a line's number (bit); legal: SET_W + 1 .. 58
    parameter integer MISSES = 32   // slots of lines in flight; legal: 2, 4, 8, 16, 32
) (
    input  wire              clk,         // clock, rising edge
    input  wire              rst,         // synchronous reset, active high
    input  wire              s_valid,     // a command
    // it is accepted if s_valid = 1 as well; 1 again: the last command is done
    output wire              s_ready,
    input  wire [LINE_W-1:0] s_first,     // first line to invalidate
    input  wire [LINE_W-1:0] s_last,      // last line to invalidate
    output wire              running,     // 0: the entries are being cleared, those of walk_set
    output wire              walk_valid,  // look a set up
    output wire [ SET_W-1:0] walk_set,    // this one
    output wire [LINE_W-1:0] first,       // first line to invalidate
    output wire [LINE_W-1:0] last,        // last line to invalidate
    input  wire              walk_done,   // its lookup is decided upon
    // with walk_done: all lines of the range are out of it; else it is looked up again
    input  wire              walk_next,
    input  wire [MISSES-1:0] held,        // bit of each slot: its line is in flight
    input  wire              serving      // a request whose line has come is being served
);

  localparam [31:0] ONE = 1;
  localparam [2:0] CLEAR = 3'd0, IDLE = 3'd1, ASK = 3'd2, SEE = 3'd3, READS = 3'd4, ANSWERS = 3'd5;
  localparam [2:0] ANSWER_CLOCKS = 3'd7;

  reg [2:0] state_q;
  reg ready_q, running_q, walk_valid_q;
  reg [SET_W-1:0] walk_set_q;
  reg [LINE_W-1:0] first_q, last_q;
  reg [LINE_W-1:0] more_q;  // lines after the first one
  reg count_q;  // left_q is to be loaded: long before the first set has been seen
  reg [SET_W-1:0] left_q;  // sets after this one
  reg [MISSES-1:0] old_q;  // reads in flight at the last set that are still in flight
  reg [2:0] clocks_q;
  reg serving_q;  // a clock later: it comes from far, and those clocks have one to spare
  wire set_last = left_q == {SET_W{1'b0}};
  always @(posedge clk) begin
    if (state_q == IDLE) begin
      first_q <= s_first;
      last_q  <= s_last;
    end
    more_q    <= last_q - first_q;
    serving_q <= serving;
    old_q    <= state_q == READS ? old_q & held : held;
    clocks_q <= state_q == ANSWERS ? clocks_q - 3'd1 : ANSWER_CLOCKS;
    if (rst) begin
      state_q      <= CLEAR;
      running_q    <= 1'b0;
      ready_q      <= 1'b0;
      walk_valid_q <= 1'b0;
      count_q      <= 1'b0;
      walk_set_q   <= {SET_W{1'b0}};
      left_q       <= {SET_W{1'b1}};
    end else begin
      walk_valid_q <= 1'b0;
      case (state_q)
        CLEAR: begin
          walk_set_q <= walk_set_q + ONE[SET_W-1:0];
          left_q     <= left_q - ONE[SET_W-1:0];
          running_q  <= set_last;
          ready_q    <= set_last;
          if (set_last) state_q <= IDLE;
        end
        IDLE: begin
          walk_set_q <= s_first[SET_W-1:0];
          count_q    <= 1'b1;
          ready_q    <= ~s_valid;
          if (s_valid) state_q <= ASK;
        end
        ASK: begin
          walk_valid_q <= 1'b1;
          state_q      <= SEE;
        end
        SEE:
        if (count_q) begin
          left_q  <= |more_q[LINE_W-1:SET_W] ? {SET_W{1'b1}} : more_q[SET_W-1:0];
          count_q <= 1'b0;
        end else if (walk_done) begin
          if (walk_next) begin
            walk_set_q <= walk_set_q + ONE[SET_W-1:0];
            left_q     <= left_q - ONE[SET_W-1:0];
          end
          state_q <= walk_next && set_last ? READS : ASK;
        end
        READS: if (old_q == {MISSES{1'b0}} && !serving_q) state_q <= ANSWERS;
        default:  // ANSWERS
        if (clocks_q == 3'd0) begin
          state_q <= IDLE;
          ready_q <= 1'b1;
        end
      endcase
    end
  end
  assign s_ready    = ready_q;
  assign running    = running_q;
  assign walk_valid = walk_valid_q;
  assign walk_set   = walk_set_q;
  assign first      = first_q;
  assign last       = last_q;

endmodule
`default_nettype wire
