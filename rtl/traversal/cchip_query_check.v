// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_query_check: holds the next query of cchip_traversal until it has started, and tells
// whether it is legal.
//   bad          an entry of the map's matrix is beyond 1, RESERVED is not 0, or an image begins in
//                the last 2^24 lines: an image has fewer, but line numbers could wrap
//   latency      waits and bad are 3 clocks behind the acceptance of the query; after a start that
//                was not possible waits is 0 for 2 clocks
//   throughput   a query every 5 clocks
//   cuts         every path: each output is a flip-flop, waits two of them
//   reset        no query
module cchip_query_check (
    input  wire                     clk,       // clock, rising edge
    input  wire                     rst,       // synchronous reset, active high
    input  wire                     s_valid,   // a query
    output wire                     s_ready,   // it is accepted if s_valid = 1 as well
    // record QUERY (definitions, docs/hardware/definitions.md)
    input  wire [`CCHIP_QUERY_W-1:0] s_query,
    output wire                     waits,     // query and bad hold: it may start
    output wire [`CCHIP_QUERY_W-1:0] query,    // the query
    output wire                     bad,       // it is illegal and ends with BAD_DESCRIPTOR
    input  wire                     tried,     // an attempt to start it has left the pipeline
    input  wire                     started    // and it has started: the next one may come
);

  reg valid_q, ready_q, bad_q, judging_q, judged_q;
  reg [8:0] beyond_q;
  reg [`CCHIP_QUERY_W-1:0] query_q;
  wire in = s_valid & ready_q;
  wire [287:0] matrix = query_q[`CCHIP_QUERY_M];
  wire [31:0] base_a = query_q[`CCHIP_QUERY_BASE_A];
  wire [31:0] base_b = query_q[`CCHIP_QUERY_BASE_B];
  wire [8:0] beyond;  // |M_ij| > 1
  genvar n;
  generate
    for (n = 0; n < 9; n = n + 1) begin : gen_m
      wire [31:0] m = matrix[32*n+:32];
      assign beyond[n] = m[31] ? ~m[30] : m[30] & |m[29:0];
    end
  endgenerate
  always @(posedge clk) begin
    if (in) query_q <= s_query;
    beyond_q <= beyond;
    bad_q    <= |beyond_q | (|query_q[`CCHIP_QUERY_RESERVED]) | &base_a[31:24] | &base_b[31:24];
    if (rst) begin
      valid_q   <= 1'b0;
      ready_q   <= 1'b0;
      judging_q <= 1'b0;
      judged_q  <= 1'b0;
    end else begin
      valid_q   <= valid_q ? ~started : in;
      ready_q   <= valid_q ? started : ~in;
      judging_q <= valid_q & ~tried;
      judged_q  <= judging_q & ~tried;
    end
  end
  assign s_ready = ready_q;
  assign waits   = valid_q & judged_q;
  assign query   = query_q;
  assign bad     = bad_q;

  wire unused = &{1'b0, base_a[23:0], base_b[23:0]};

endmodule
`default_nettype wire
