// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
`include "cchip_assert.vh"
// cchip_swap_retry: back-off. After a swap that failed on its way (CCHIP_SWAP_PUT_OFF) the
// bitstream may be good, but the scheduler must not try it again at once.
//   resting      entries that have failed and not ended well since rest together, for
//                CCHIP_RETRY_CLOCKS << level clocks from the latest failure on. After each rest
//                level grows by one, up to CCHIP_RETRY_DOUBLINGS; it is 0 again once no failed
//                entry is left. An entry that is no longer valid is dropped.
//   hopeless     entries that rest after CCHIP_RETRY_DOUBLINGS failures in a row or more: no one
//                should wait for them until they are tried again
//   latency      1 clock from the report to resting
//   reset        nothing rests, level 0
//   timing       resting rises on the clock after the report and is 1 for exactly
//                CCHIP_RETRY_CLOCKS << level clocks, counted from the latest failure. All outputs
//                come from flip-flops. An entry is hopeless while it rests after eight failures in
//                a row or more, counted while any entry has failed and not ended well; when its
//                rest is over it is tried again.
//   numbers      DEVICE, BUS, MEMORY, SHUTDOWN, ABORTED, OWED. 256, 512, ... 65536 clocks
//                (docs/hardware/definitions.md).
//   inside       A bit per entry: it failed and has not ended well since. One timer for all of them
//                and one level, which grows by one after each rest and is 0 once no bit is left. An
//                entry whose valid bit falls is cleared.
//   why          A fault of the transfer passes: outstanding beats arrive, a bus recovers, an abort
//                was meant for that moment. Discarding the bitstream would leave pairs without a
//                test for no reason; trying again at once would keep the bus and the slot busy. -
//                One timer: swaps come one after the other, so the rests of several entries may as
//                well end together. - A swap of another entry that ends well does not end the rest:
//                otherwise two kinds in turn would never back off.
module cchip_swap_retry #(
    parameter integer SLOTS = 1,  // slots; legal: 1..4
    // kinds of pairs, 4 with points against triangles; the modules are 0..KINDS; legal: 3, 4
    parameter integer KINDS = 3
) (
    input  wire                            clk,                  // clock, rising edge
    input  wire                            rst,                  // synchronous reset, active high
    input  wire                            report_valid,  // a report of the controller, one clock
    // the report: record SWAP_REPORT, docs/hardware/definitions.md
    input  wire [`CCHIP_SWAP_REPORT_W-1:0] report_data,
    // there is a bitstream; entries as in cchip_bitstream_table
    input  wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] valid,
    // the entry must not be tried by itself
    output wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] resting,
    // entries that rest after eight failures in a row or more
    output wire [(SLOTS<<`CCHIP_KIND_BITS(KINDS))-1:0] hopeless
);

  localparam integer MODULE_W = `CCHIP_KIND_BITS(KINDS);
  localparam integer ENTRIES = SLOTS << MODULE_W;
  localparam integer TIMER_W = $clog2(`CCHIP_RETRY_CLOCKS + 1) + `CCHIP_RETRY_DOUBLINGS;
  localparam [TIMER_W-1:0] FIRST = `CCHIP_RETRY_CLOCKS;
  localparam [TIMER_W-1:0] ONE = 1;
  localparam [3:0] LEVEL_MAX = `CCHIP_RETRY_DOUBLINGS;
  localparam [3:0] LEVEL_HOPELESS = LEVEL_MAX - 4'd1;  // the first failure comes at level 0

  `CCHIP_REFUSE(SLOTS < 1 || SLOTS > 4, cchip_error_SLOTS_must_be_1_to_4)
  `CCHIP_REFUSE(KINDS != 3 && KINDS != 4, cchip_error_KINDS_must_be_3_or_4)

  // ---- the report
  wire [`CCHIP_SLOT_ID_W-1:0] slot = report_data[`CCHIP_SWAP_REPORT_SLOT];
  wire [`CCHIP_RM_ID_W-1:0] module_id = report_data[`CCHIP_SWAP_REPORT_MODULE];
  wire [`CCHIP_SWAP_W-1:0] code = report_data[`CCHIP_SWAP_REPORT_CODE];
  wire ended_well = report_valid && code == `CCHIP_SWAP_OK;
  wire put_off = report_valid && `CCHIP_SWAP_PUT_OFF(code);
  reg [ENTRIES-1:0] entry;  // one-hot; 0 if there is no such entry
  integer i;
  always @(*)
    for (i = 0; i < ENTRIES; i = i + 1)
      entry[i] = {slot, module_id} == {i[MODULE_W+:8], {8 - MODULE_W{1'b0}}, i[MODULE_W-1:0]};

  // ---- entries that failed, and their rest
  reg [ENTRIES-1:0] failed_q;
  reg rests_q;
  reg [3:0] level_q;
  reg [TIMER_W-1:0] timer_q;  // clocks since the latest failure
  wire [TIMER_W-1:0] limit = FIRST << level_q;
  assign resting = failed_q & {ENTRIES{rests_q}};
  assign hopeless = resting & {ENTRIES{level_q >= LEVEL_HOPELESS}};

  always @(posedge clk) begin
    timer_q <= put_off ? ONE : timer_q + ONE;
    if (rst) begin
      failed_q <= {ENTRIES{1'b0}};
      rests_q  <= 1'b0;
      level_q  <= 4'd0;
    end else begin
      failed_q <= valid & ((failed_q | (put_off ? entry : {ENTRIES{1'b0}}))
          & ~(ended_well ? entry : {ENTRIES{1'b0}}));
      if (put_off) rests_q <= 1'b1;
      else if (rests_q && timer_q == limit) begin
        rests_q <= 1'b0;
        if (level_q != LEVEL_MAX) level_q <= level_q + 4'd1;
      end
      if (failed_q == {ENTRIES{1'b0}} && !put_off) level_q <= 4'd0;
    end
  end

  wire unused = &{1'b0, report_data[`CCHIP_SWAP_REPORT_LOST]};

endmodule
`default_nettype wire
