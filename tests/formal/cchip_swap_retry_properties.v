// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// Proved of cchip_swap_retry, for each entry: it rests from the clock after its failure on; only an entry rests that is valid and
// has failed on the way and not ended well since; entries that have failed rest together, CCHIP_RETRY_CLOCKS clocks or more
// from the latest failure on.
module cchip_swap_retry_properties (
    input wire                            clk,
    input wire                            rst,
    input wire                            report_valid,
    input wire [`CCHIP_SWAP_REPORT_W-1:0] report_data,
    input wire [                     7:0] valid
);
  wire [7:0] resting;
  cchip_swap_retry #(
      .SLOTS(2)
  ) dut (
      .clk         (clk),
      .rst         (rst),
      .report_valid(report_valid),
      .report_data (report_data),
      .valid       (valid),
      .resting     (resting)
  );

  // one entry, any
  (* anyconst *) wire [2:0] mine;
  wire [3:0] code = report_data[`CCHIP_SWAP_REPORT_CODE];
  wire put_off = report_valid && (code == `CCHIP_SWAP_DEVICE || code >= `CCHIP_SWAP_BUS);
  wire about_mine = report_data[`CCHIP_SWAP_REPORT_SLOT] == mine[2] && report_data[`CCHIP_SWAP_REPORT_MODULE] == mine[1:0];
  reg started_q = 1'b0;
  reg failed_q;
  reg failed_now_q;  // a clock ago
  reg [8:0] since_q;  // clocks since a failure of any entry, at most 256
  always @(posedge clk) begin
    started_q    <= 1'b1;
    failed_q     <= !rst && valid[mine] && (failed_q || (put_off && about_mine))
                    && !(report_valid && code == `CCHIP_SWAP_OK && about_mine);
    failed_now_q <= !rst && valid[mine] && put_off && about_mine;
    since_q      <= rst ? 9'd256 : put_off ? 9'd0 : since_q + {8'd0, since_q != 9'd256};
  end

  always @(*) begin
    if (!started_q) assume (rst);
    if (started_q) begin
      at_once: assert (!failed_now_q || resting[mine]);
      failed: assert (!resting[mine] || failed_q);
      together: assert (resting == 8'd0 || resting[mine] == failed_q);
      long_enough: assert (!failed_q || since_q >= `CCHIP_RETRY_CLOCKS - 1 || resting[mine]);
    end
  end
  always @(posedge clk) two: cover (started_q && resting == 8'h81);
endmodule
`default_nettype wire
