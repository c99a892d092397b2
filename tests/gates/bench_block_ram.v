// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_block_ram: a leaf of cchip_block_ram beside the portable one, which test_block_ram.py calls portable_block_ram.
// Both get the same accesses; reads follow writes, and writes reads, at the same address at all short distances. Words
// not yet written, and words read on the clock on which they are written, are not compared.
//   CCHIP_BENCH_NETLIST  macro: the leaf is the netlist `gate` of these parameters
//   +clocks=N            (default 3000)
//   +seed=N              of the accesses (default 1)
// Ends with "PASS compared=N" or "FAIL clock=N ...".
module bench_block_ram;

  parameter integer WIDTH = 8;
  parameter integer WORDS = 1;
  parameter integer ADDR_W = 9;
  parameter integer MIXED_WIDTH = 1;
  localparam integer ROW_W = WORDS == 4 ? 2 : 0;  // address bits within a row of words written at once
  localparam integer WRITE_W = ADDR_W - ROW_W;

  reg                    clk;
  reg                    write;
  reg  [    WRITE_W-1:0] write_addr;
  reg  [WORDS*WIDTH-1:0] write_data;
  reg  [     ADDR_W-1:0] read_addr;
  wire [      WIDTH-1:0] expected, found;
  wire [    WRITE_W-1:0] row = read_addr[ADDR_W-1:ROW_W];

  portable_block_ram #(
      .WIDTH      (WIDTH),
      .WORDS      (WORDS),
      .ADDR_W     (ADDR_W),
      .MIXED_WIDTH(MIXED_WIDTH)
  ) u_portable (
      .clk       (clk),
      .write     (write),
      .write_addr(write_addr),
      .write_data(write_data),
      .read_addr (read_addr),
      .read_data (expected)
  );

`ifdef CCHIP_BENCH_NETLIST
  gate u_leaf (
`else
  cchip_block_ram #(
      .WIDTH      (WIDTH),
      .WORDS      (WORDS),
      .ADDR_W     (ADDR_W),
      .MIXED_WIDTH(MIXED_WIDTH)
  ) u_leaf (
`endif
      .clk       (clk),
      .write     (write),
      .write_addr(write_addr),
      .write_data(write_data),
      .read_addr (read_addr),
      .read_data (found)
  );

  reg [(1<<WRITE_W)-1:0] written;
  reg [1:0] known;  // what was read one and two clocks before
  reg [WRITE_W-1:0] rows[0:3], read_rows[0:3];  // of the last accesses
  reg [31:0] random;
  reg [WORDS*WIDTH-1:0] data;
  integer clocks, seed, clock, compared, i;

  // one of the last four addresses every second time
  function [WRITE_W-1:0] choose(input [WRITE_W-1:0] recent, input [31:0] any);
    choose = any[31] ? recent : any[WRITE_W-1:0];
  endfunction

  initial begin
    if (!$value$plusargs("clocks=%d", clocks)) clocks = 3000;
    if (!$value$plusargs("seed=%d", seed)) seed = 1;
    clk = 1'b0;
    written = 0;
    known = 2'b00;
    compared = 0;
    for (i = 0; i < 4; i = i + 1) begin
      rows[i] = 0;
      read_rows[i] = 0;
    end
    for (clock = 0; clock < clocks; clock = clock + 1) begin
      write = $unsigned($random(seed)) % 5 < 2;
      write_addr = choose(read_rows[$random(seed) & 3], $random(seed));
      for (i = 0; i < WORDS * WIDTH; i = i + 32) begin
        random = $random(seed);
        data = {data, random};
      end
      write_data = data;
      read_addr = $random(seed);
      read_addr[ADDR_W-1:ROW_W] = choose(rows[$random(seed) & 3], $random(seed));
      #1;
      if (known[1]) begin
        compared = compared + 1;
        if (found !== expected) begin
          $display("FAIL clock=%0d found=%h expected=%h", clock, found, expected);
          $finish;
        end
      end
      known = {known[0], written[row] && !(write && write_addr == row)};
      if (write) written[write_addr] = 1'b1;
      for (i = 3; i > 0; i = i - 1) begin
        rows[i] = rows[i-1];
        read_rows[i] = read_rows[i-1];
      end
      if (write) rows[0] = write_addr;
      read_rows[0] = row;
      clk = 1'b1;
      #1 clk = 1'b0;
    end
    $display("PASS compared=%0d", compared);
    $finish;
  end

endmodule
`default_nettype wire
