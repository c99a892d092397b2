// SPDX-License-Identifier: Apache-2.0
`timescale 1ps / 1ps
`default_nettype none
// bench_chip_cdc: cchip_chip_cdc with three clocks: registers are written and read, the line of a query is read from memory,
// which answers with an error, and the interrupt that says so comes and goes. Last line PASS or FAIL, exit code 1 for FAIL.
//   vvp -n FILE [+axil=PS] [+mem=PS]     halves of the periods of the two clocks; that of the chip is 7000 ps
module bench_chip_cdc;
  integer axil_half = 5000, mem_half = 1700, beats = 0, waited;
  reg clk = 0, axil_clk = 0, mem_clk = 0, rst = 1, axil_rst = 1, mem_rst = 1;
  always #7000 clk = ~clk;
  always #(axil_half) axil_clk = ~axil_clk;
  always #(mem_half) mem_clk = ~mem_clk;
  reg awvalid = 0, wvalid = 0, arvalid = 0;
  reg [11:0] address = 0;
  reg [31:0] wdata = 0;
  wire awready, wready, bvalid, s_arready, s_rvalid, irq;
  wire [1:0] bresp, s_rresp;
  wire [31:0] s_rdata;
  wire m_arvalid, m_rready;
  wire [63:0] m_araddr;
  wire [7:0] m_arlen;
  wire [3:0] m_arid;
  reg m_rvalid = 0, m_rlast = 0;
  reg [3:0] m_rid = 0;
  cchip_chip_cdc #(
      .QUERIES(4), .PAIRS(12), .LEAVES(4), .STACK(64), .LEAF_DEPTH(16), .CACHE_KB(4), .MISSES(8), .QUEUE_DEPTH(16),
      .LEAF_NUMBERS(8), .RM_ID(1)
  ) dut (
      .clk(clk), .rst(rst), .axil_clk(axil_clk), .axil_rst(axil_rst), .mem_clk(mem_clk), .mem_rst(mem_rst),
      .s_axil_awvalid(awvalid), .s_axil_awready(awready), .s_axil_awaddr(address), .s_axil_awprot(3'd0),
      .s_axil_wvalid(wvalid), .s_axil_wready(wready), .s_axil_wdata(wdata), .s_axil_wstrb(4'd15),
      .s_axil_bvalid(bvalid), .s_axil_bready(1'b1), .s_axil_bresp(bresp),
      .s_axil_arvalid(arvalid), .s_axil_arready(s_arready), .s_axil_araddr(address), .s_axil_arprot(3'd0),
      .s_axil_rvalid(s_rvalid), .s_axil_rready(1'b1), .s_axil_rdata(s_rdata), .s_axil_rresp(s_rresp), .irq(irq),
      .m_axi_arvalid(m_arvalid), .m_axi_arready(!m_rvalid), .m_axi_arid(m_arid), .m_axi_araddr(m_araddr),
      .m_axi_arlen(m_arlen), .m_axi_rvalid(m_rvalid), .m_axi_rready(m_rready), .m_axi_rid(m_rid),
      .m_axi_rdata(128'd0), .m_axi_rresp(2'd2), .m_axi_rlast(m_rlast),
      .m_axi_awready(1'b1), .m_axi_wready(1'b1), .m_axi_bvalid(1'b0), .m_axi_bid(1'b0), .m_axi_bresp(2'd0),
      .cfg_error(1'b0), .m_axi_cfg_arready(1'b0), .m_axi_cfg_rvalid(1'b0), .m_axi_cfg_rdata(32'd0),
      .m_axi_cfg_rresp(2'd0), .m_axi_cfg_rlast(1'b0)
  );
  task check(input good, input [8*60-1:0] what);
    if (good !== 1'b1) begin
      $display("FAIL %0s", what);
`ifdef __ICARUS__
      $finish_and_return(1);
`endif
      $finish;
    end
  endtask
  task write(input [11:0] to, input [31:0] value);
    begin
      @(posedge axil_clk) #1 {address, wdata, awvalid, wvalid} = {to, value, 2'b11};
      while (awvalid || wvalid) begin
        @(posedge axil_clk);
        {waited[0], waited[1]} = {awready, wready};
        #1 if (waited[0]) awvalid = 0;
        if (waited[1]) wvalid = 0;
      end
      while (!bvalid) @(posedge axil_clk);
      check(bresp == 2'd0, "response of a write");
      @(posedge axil_clk);
    end
  endtask
  task read(input [11:0] from, input [31:0] value);
    begin
      @(posedge axil_clk) #1 {address, arvalid} = {from, 1'b1};
      @(posedge axil_clk);
      while (!s_arready) @(posedge axil_clk);
      #1 arvalid = 0;
      while (!s_rvalid) @(posedge axil_clk);
      if (s_rdata !== value) $display("register %h: %h instead of %h", from, s_rdata, value);
      check(s_rdata === value && s_rresp == 2'd0, "a register");
      @(posedge axil_clk);
    end
  endtask
  // memory: every beat an error
  always @(posedge mem_clk)
    if (m_arvalid && !m_rvalid) begin
      check(m_araddr == 64'h12340000 && m_arlen == 8'd3, "address and length of the query's line");
      m_rid <= m_arid;
      m_rvalid <= 1;
      m_rlast <= 0;
      beats = 0;
    end else if (m_rvalid && m_rready) begin
      beats = beats + 1;
      m_rlast <= beats == 3;
      if (beats == 4) m_rvalid <= 0;
    end
  initial begin
    if (!$value$plusargs("axil=%d", axil_half)) axil_half = 5000;
    if (!$value$plusargs("mem=%d", mem_half)) mem_half = 1700;
    #100000 rst = 0;
    #30000 mem_rst = 0;
    #50000 axil_rst = 0;
    #200000 read(12'h000, 32'h43484343);
    write(12'h030, 32'hCAFE1234);
    read(12'h030, 32'hCAFE1234);
    write(12'h024, 32'h2);  // query_failed
    write(12'h040, 32'h12340000);
    write(12'h048, 32'd4);
    write(12'h068, 32'd10);
    write(12'h010, 32'd1);
    check(!irq, "no interrupt before the query");
    write(12'h04C, 32'd1);
    for (waited = 0; !irq && waited < 4000; waited = waited + 1) @(posedge axil_clk);
    check(irq, "the interrupt of a query that failed");
    read(12'h020, 32'h2);
    write(12'h020, 32'h2);
    repeat (60) @(posedge axil_clk);
    check(!irq, "the interrupt ends as it is cleared");
    $display("PASS beats=%0d", beats);
    $finish;
  end
endmodule
`default_nettype wire
