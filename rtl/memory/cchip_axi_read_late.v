// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_defs.vh"
// cchip_axi_read_late: finds the reads of cchip_axi_read that have lasted too long, one after the
// other. A tick comes every limit + 1 clocks; a read that was live at two ticks has expired.
//   latency      a read expires after more than limit, and at most 2 limit + 2, clocks of waiting.
//                One ID is looked at per clock, none while an expired read waits to be accepted
//   limit        1..2^32 - 1 clocks; 0 means CCHIP_MEMORY_LIMIT_DEFAULT. It may change on any clock
//                (cchip_timeout)
//   reset        no read has expired
//   why          Two bits for each read instead of an age of 32 bits. A read expires up to a limit
//                later than it could be; that is the price.
module cchip_axi_read_late #(
    parameter integer IDS  = 48,  // reads that may be live; legal: 2..256
    parameter integer ID_W = 6    // width of the number of a read (bit); legal: IDS <= 2^ID_W
) (
    input  wire            clk,       // clock, rising edge
    input  wire            rst,       // synchronous reset, active high
    // longest time of a read, clocks; 0 stands for CCHIP_MEMORY_LIMIT_DEFAULT
    input  wire [    31:0] limit,
    input  wire [ IDS-1:0] live,      // bit of each read: its client waits for it
    input  wire [ IDS-1:0] fresh,     // bit of each read: it becomes live on this clock
    output wire            found,     // found_id has expired
    output wire [ID_W-1:0] found_id,  // number of that read
    input  wire            busy       // the expired read cannot be accepted on this clock
);

  localparam [31:0] LAST_ID = IDS - 1;

  wire tick;
  wire [31:0] elapsed;
  cchip_timeout #(.DEFAULT(`CCHIP_MEMORY_LIMIT_DEFAULT)) u_tick (
      .clk    (clk),
      .restart(rst | tick),
      .limit  (limit),
      .elapsed(elapsed),
      .expired(tick)
  );

  reg tick_q;  // a clock later: it comes from far, and many flip-flops depend on it
  reg [IDS-1:0] seen_q, overdue_q;  // live at the last tick, at the last two ticks
  reg [ID_W-1:0] scan_q;  // the read that is looked at
  reg found_q;
  reg [ID_W-1:0] found_id_q;
  wire [IDS-1:0] overdue = live & overdue_q;
  always @(posedge clk) begin
    tick_q <= ~rst & tick;
    seen_q <= (tick_q ? live : seen_q) & ~fresh;
    overdue_q <= (tick_q ? live & seen_q : overdue_q) & ~fresh;
    if (!found_q) found_id_q <= scan_q;
    if (rst) begin
      scan_q  <= {ID_W{1'b0}};
      found_q <= 1'b0;
    end else begin
      if (!found_q)
        scan_q <= scan_q == LAST_ID[ID_W-1:0] ? {ID_W{1'b0}} : scan_q + {{ID_W - 1{1'b0}}, 1'b1};
      found_q <= found_q ? busy : overdue[scan_q];
    end
  end
  assign found    = found_q;
  assign found_id = found_id_q;

  wire unused = &{1'b0, elapsed};

endmodule
`default_nettype wire
