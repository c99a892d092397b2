// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
`include "cchip_defs.vh"
// cchip_traversal_contexts: what cchip_traversal keeps of its queries: the state of each context,
// its stack, and how many node pairs and leaf pairs each epoch has in flight. An event reads them
// in stages 1 to 5; what it changes is written in stage 8.
//   rule         an event reads after the last one of its query has written: the next stage 1 of a
//                context is at the earliest the clock behind its stage 8
//   latency      4 clocks from s_context to the values of stage 5, entry5 that of the stack's last
//                entry
//   throughput   an event per clock
//   cuts         every path: each output is a flip-flop, or the output of a block RAM
//   reset        every context and every epoch is cleared, in 4 QUERIES clocks: running = 0
//   inside       States, constants and works in LUT memory; the stacks of all contexts in one
//                cchip_block_ram.
module cchip_traversal_contexts #(
    parameter integer QUERIES = 16,  // queries at once (query); legal: 2, 4, 8, 16
    parameter integer STACK   = 64,  // entries of a query's stack (entry); legal: 8, 16, 32, 64
    // width of the count of what an epoch has in flight (bit); legal: >= 1
    parameter integer WORK_W  = 12
) (
    input  wire                              clk,            // clock, rising edge
    input  wire                              rst,            // synchronous reset, active high
    output wire                              running,        // 0: contexts are being cleared
    input  wire [                      31:0] step_limit,     // node pairs of a query
    input  wire [       $clog2(QUERIES)-1:0] s_context,      // context of an event in stage 1
    input  wire [                       1:0] s_epoch,        // epoch of the event
    // the event is one of the query as it is: a start or a pop
    input  wire                              s_own,
    // epoch of the event in stage 5; with s_own that of the query
    output wire [                       1:0] epoch5,
    output wire                              live5,  // the query of that epoch is still in flight
    // record QUERY_STATE (definitions, docs/hardware/definitions.md)
    output wire [          $clog2(STACK)+80:0] state5,
    output wire [  `CCHIP_QUERY_LINES_W-1:0] constants5,     // record QUERY_LINES
    // node pairs and leaf pairs that its epoch has in flight
    output wire [                WORK_W-1:0] work5,
    output wire                              over5,  // the query's steps have reached step_limit
    output wire                              full5,          // its stack is full
    output wire [  `CCHIP_STACK_ENTRY_W-1:0] entry5,  // last entry of its stack, record STACK_ENTRY
    input  wire                              write8,         // an event in stage 8
    input  wire [       $clog2(QUERIES)-1:0] context8,       // its context
    input  wire [                       1:0] epoch8,         // its epoch
    input  wire [          $clog2(STACK)+80:0] state8,       // the state to write
    input  wire [  `CCHIP_QUERY_LINES_W-1:0] constants8,     // the constants to write
    input  wire [                WORK_W-1:0] work8,          // the work of its epoch to write
    input  wire                              push8,          // an entry is pushed
    input  wire [         $clog2(STACK)-1:0] at8,            // its place on the stack
    input  wire [  `CCHIP_STACK_ENTRY_W-1:0] entry8,         // the entry
    // ---- the epoch that a context has from the next clock on
    output wire                              epoch_write,    // a context gets an epoch
    output wire [       $clog2(QUERIES)-1:0] epoch_context,  // this context
    output wire [                       1:0] epoch           // this epoch
);

  localparam integer CONTEXT_W = $clog2(QUERIES);
  localparam integer EPOCH_W = 2;
  localparam integer STACK_W = $clog2(STACK);
  localparam integer STATE_W = `CCHIP_QUERY_STATE_W(STACK_W);
  localparam [31:0] FULL = STACK;
  localparam [31:0] LAST_EPOCH = QUERIES * 4 - 1;

  // ---- after reset every context and every epoch is written once
  reg running_q;
  reg [CONTEXT_W+EPOCH_W-1:0] clear_q;
  always @(posedge clk)
    if (rst) begin
      running_q <= 1'b0;
      clear_q   <= {CONTEXT_W + EPOCH_W{1'b0}};
    end else if (!running_q) begin
      running_q <= clear_q == LAST_EPOCH[CONTEXT_W+EPOCH_W-1:0];
      clear_q   <= clear_q + {{CONTEXT_W + EPOCH_W - 1{1'b0}}, 1'b1};
    end
  assign running = running_q;

  // ---- stages 1 to 5: the query, the last entry of its stack, what its epoch has in flight
  `CCHIP_LUT_RAM
  reg [STATE_W-1:0] states[0:QUERIES-1];
  `CCHIP_LUT_RAM
  reg [`CCHIP_QUERY_LINES_W-1:0] constants[0:QUERIES-1];
  `CCHIP_LUT_RAM
  reg [WORK_W-1:0] works[0:4*QUERIES-1];  // of each epoch
  reg [STATE_W-1:0] state_q2, state_q3, state_q4, state_q5;
  reg [`CCHIP_QUERY_LINES_W-1:0] constants_q2, constants_q3, constants_q4, constants_q5;
  reg [CONTEXT_W-1:0] context_q2, context_q3;
  reg [EPOCH_W-1:0] epoch_q2, epoch_q3, epoch_q4, epoch_q5;
  reg own_q2;
  reg live_q3, live_q4, live_q5;
  reg [STACK_W-1:0] top_q3;
  reg [WORK_W-1:0] work_q4, work_q5;
  reg over_q4, over_q5, full_q4, full_q5;
  wire [EPOCH_W-1:0] now2 = state_q2[`CCHIP_QUERY_STATE_EPOCH(STACK_W)];
  wire active2 = state_q2[`CCHIP_QUERY_STATE_ACTIVE(STACK_W)];
  wire [STACK_W:0] entries2 = state_q2[`CCHIP_QUERY_STATE_ENTRIES(STACK_W)];
  always @(posedge clk) begin
    state_q2     <= states[s_context];
    constants_q2 <= constants[s_context];
    own_q2       <= s_own;
    epoch_q2     <= s_epoch;
    context_q2   <= s_context;
    context_q3   <= context_q2;
    top_q3       <= entries2[STACK_W-1:0] - {{STACK_W - 1{1'b0}}, 1'b1};
    epoch_q3     <= own_q2 ? now2 : epoch_q2;
    live_q3      <= active2 && (own_q2 || now2 == epoch_q2);
    work_q4      <= works[{context_q3, epoch_q3}];
    over_q4      <= state_q3[`CCHIP_QUERY_STATE_STEPS] >= step_limit;
    full_q4      <= state_q3[`CCHIP_QUERY_STATE_ENTRIES(STACK_W)] == FULL[STACK_W:0];
    {over_q5, full_q5, live_q4, live_q5, work_q5} <= {over_q4, full_q4, live_q3, live_q4, work_q4};
    {epoch_q4, epoch_q5} <= {epoch_q3, epoch_q4};
    {state_q3, state_q4, state_q5} <= {state_q2, state_q3, state_q4};
    {constants_q3, constants_q4, constants_q5} <= {constants_q2, constants_q3, constants_q4};
  end
  assign epoch5     = epoch_q5;
  assign live5      = live_q5;
  assign state5     = state_q5;
  assign constants5 = constants_q5;
  assign work5      = work_q5;
  assign over5      = over_q5;
  assign full5      = full_q5;

  cchip_block_ram #(.WIDTH(`CCHIP_STACK_ENTRY_W), .ADDR_W(CONTEXT_W + STACK_W)) u_stack (
      .clk       (clk),
      .write     (push8),
      .write_addr({context8, at8}),
      .write_data(entry8),
      .read_addr ({context_q3, top_q3}),
      .read_data (entry5)
  );

  // ---- stage 8: everything is written
  wire write = write8 | ~running_q;
  wire [CONTEXT_W-1:0] write_context = running_q ? context8 : clear_q[CONTEXT_W-1:0];
  wire [STATE_W-1:0] write_state = running_q ? state8 : {STATE_W{1'b0}};
  always @(posedge clk) begin
    if (write) states[write_context] <= write_state;
    if (write8) constants[context8] <= constants8;
    if (write)
      works[running_q?{context8, epoch8} : clear_q] <= running_q ? work8 : {WORK_W{1'b0}};
  end
  assign epoch_write   = write;
  assign epoch_context = write_context;
  assign epoch         = write_state[`CCHIP_QUERY_STATE_EPOCH(STACK_W)];

  wire unused = &{1'b0, entries2[STACK_W]};

endmodule
`default_nettype wire
