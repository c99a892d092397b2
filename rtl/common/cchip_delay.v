// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_delay: q is d, DEPTH clocks later.
//   latency      DEPTH clocks (0 = wire)
//   throughput   one value per clock, never stalls
//   cuts         d -> q if DEPTH > 0
//   reset        RESET = 1 clears every stage (valid bits); RESET = 0 leaves data alone
//   MEMORY = 1   (DEPTH >= 3, RESET = 0) keeps the values in a small memory with a circulating
//                pointer instead of flip-flops. With the macro CCHIP_DELAY_CHAINS, for a family
//                without memories of LUTs, it is a chain of flip-flops, too
//   about        A delay line: q is what d was DEPTH clocks ago. The pipeline uses it for
//                everything that travels beside the arithmetic (valid bits, points, axis codes),
//                and the arithmetic blocks use it for their optional registers.
//   timing       With DEPTH > 0 the path d -> q is cut; with DEPTH = 0 it is combinational. With
//                RESET = 1 the first rising edge with rst = 1 clears all stages. With RESET = 0 the
//                first DEPTH values after power-up are undefined. MEMORY = 1 is the same: the
//                pointer finds into its circle, over 0, from any value of pointer_q and last_q, so
//                it needs no reset either.
//   why          Data registers have no reset: the valid bit beside them says whether they count.
//                That leaves synthesis free to turn a long delay into shift-register cells, which
//                have no reset input. An FPGA without such cells (ECP5) would spend a flip-flop per
//                bit and clock. The wide delays of cchip_sat_pipeline (points, programme state) are
//                therefore memories: DEPTH - 1 words of distributed memory, a circulating pointer
//                that reads a word just before it overwrites it, and the memory's output register.
//                That the pointer ends its circle is known a clock ahead (last_q).
module cchip_delay #(
    parameter integer WIDTH = 1,  // width of the value (bit); legal: >= 1
    parameter integer DEPTH = 1,  // delay; 0 is a wire (clock); legal: >= 0
    parameter integer RESET = 0,  // 1: rst clears every stage; 0: it does not; legal: 0, 1
    // 1: a small memory instead of a chain of registers; needs DEPTH >= 3 and RESET = 0; legal: 0,
    // 1
    parameter integer MEMORY = 0
) (
    input  wire             clk,  // clock, rising edge
    input  wire             rst,  // synchronous reset, active high; used only with RESET = 1
    input  wire [WIDTH-1:0] d,    // value in
    output wire [WIDTH-1:0] q     // value DEPTH clocks later
);

  `CCHIP_REFUSE(WIDTH < 1 || DEPTH < 0 || RESET < 0 || RESET > 1,
                cchip_error_delay_WIDTH_below_1_or_DEPTH_below_0_or_RESET_not_0_or_1)
  `CCHIP_REFUSE(MEMORY < 0 || MEMORY > 1 || (MEMORY == 1 && (DEPTH < 3 || RESET == 1)),
                cchip_error_delay_MEMORY_needs_DEPTH_3_and_RESET_0)
`ifdef CCHIP_DELAY_CHAINS
  localparam integer IN_MEMORY = 0;
`else
  localparam integer IN_MEMORY = MEMORY;
`endif
  generate
    if (DEPTH == 0) begin : gen_wire
      assign q = d;
      wire unused = &{1'b0, clk, rst};
    end else if (IN_MEMORY != 0) begin : gen_memory
      // DEPTH - 1 words and the output register
      localparam integer PTR_W = $clog2(DEPTH - 1);
      localparam [31:0] BEFORE_LAST = DEPTH - 3;
      `CCHIP_LUT_RAM
      reg [WIDTH-1:0] mem [0:DEPTH-2];
      reg [PTR_W-1:0] pointer_q;
      reg last_q;
      reg [WIDTH-1:0] q_q;
      // no reset: from any value at power-up the pointer counts up, overflows to 0 and then counts
      // the DEPTH - 1 words round and round
      initial pointer_q = {PTR_W{1'b0}};
      initial last_q = 1'b0;
      wire unused = &{1'b0, rst};
      always @(posedge clk) begin
        last_q <= pointer_q == BEFORE_LAST[PTR_W-1:0] && !last_q;
        if (last_q) pointer_q <= {PTR_W{1'b0}};
        else pointer_q <= pointer_q + {{PTR_W - 1{1'b0}}, 1'b1};
        mem[pointer_q] <= d;
        q_q <= mem[pointer_q];
      end
      assign q = q_q;
    end else begin : gen_stages
      // chain[WIDTH*i +: WIDTH] is d after i registers
      reg  [WIDTH*DEPTH-1:0]     pipe_q;
      wire [WIDTH*(DEPTH+1)-1:0] chain = {pipe_q, d};
      if (RESET != 0) begin : gen_reset
        always @(posedge clk)
          if (rst) pipe_q <= {WIDTH * DEPTH{1'b0}};
          else pipe_q <= chain[WIDTH*DEPTH-1:0];
      end else begin : gen_no_reset
        always @(posedge clk) pipe_q <= chain[WIDTH*DEPTH-1:0];
        wire unused = &{1'b0, rst};
      end
      assign q = chain[WIDTH*DEPTH+:WIDTH];
    end
  endgenerate

endmodule
`default_nettype wire
