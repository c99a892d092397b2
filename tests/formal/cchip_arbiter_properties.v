// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// Proved of cchip_arbiter: grant is exactly the first requesting source in the circle behind the one served last (after reset:
// from source 0 on), nothing without a request; so it is one-hot and of a requester. While a request stays, at most N - 1
// other sources are served.
module cchip_arbiter_properties #(
    parameter integer N = 4
) (
    input wire         clk,
    input wire         rst,
    input wire [N-1:0] request,
    input wire         take
);
  wire [N-1:0] grant;
  cchip_arbiter #(
      .N(N)
  ) dut (
      .clk    (clk),
      .rst    (rst),
      .request(request),
      .grant  (grant),
      .take   (take)
  );

  // the circle from the source behind the one served last: bit i of turned_* is source start_q + i
  reg [7:0] start_q;
  wire [2*N-1:0] two = {request, request} >> start_q;
  wire [2*N-1:0] two_grants = {grant, grant} >> start_q;
  wire [N-1:0] turned_request = two[N-1:0];
  wire [N-1:0] turned_grant = two_grants[N-1:0];

  // one source, any
  (* anyconst *) wire [$clog2(N)-1:0] mine;
  reg [7:0] others_q;  // served since it has been asking
  wire served = take & (|grant);

  reg started_q = 1'b0;
  integer i;
  always @(posedge clk) begin
    started_q <= 1'b1;
    if (rst) start_q <= 8'd0;
    else if (take) for (i = 0; i < N; i = i + 1) if (grant[i]) start_q <= i == N - 1 ? 8'd0 : i[7:0] + 8'd1;
    others_q <= rst || !request[mine] || (take && grant[mine]) ? 8'd0 : others_q + {7'd0, served};
  end

  always @(*) begin
    assume (mine < N);
    if (!started_q) assume (rst);
    if (started_q) begin
      first_in_turn: assert (turned_grant == (turned_request & (~turned_request + 1'b1)));
      fair: assert (others_q < N);
    end
  end
  always @(posedge clk) last_of_all: cover (started_q && others_q == N - 1 && served && grant[mine]);
endmodule
`default_nettype wire
