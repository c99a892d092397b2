// SPDX-License-Identifier: Apache-2.0
`timescale 1ns / 1ps
`default_nettype none
// bench_apb: writes and reads of random bytes over cchip_apb_axil, against registers that answer
// after random waits, some with an error. PASS accesses=N errors=N, or FAIL.
module bench_apb;
  reg clk = 1'b0, rst = 1'b1;
  reg psel = 1'b0, penable = 1'b0, pwrite = 1'b0;
  reg [7:0] paddr = 8'd0;
  reg [31:0] pwdata = 32'd0;
  reg [3:0] pstrb = 4'd0;
  wire pready, pslverr;
  wire [31:0] prdata;
  wire awvalid, wvalid, bready, arvalid, rready;
  wire [7:0] awaddr, araddr;
  wire [31:0] wdata;
  wire [3:0] wstrb;
  reg awready = 1'b0, wready = 1'b0, bvalid = 1'b0, arready = 1'b0, rvalid = 1'b0;
  reg [1:0] bresp = 2'd0, rresp = 2'd0;
  reg [31:0] rdata = 32'd0;
  integer seed = 1, accesses = 2000, done = 0, errors = 0, wrong = 0, waits = 0, i;

  cchip_apb_axil #(.ADDRESS_W(8)) u_dut (
      .clk(clk), .rst(rst), .s_apb_psel(psel), .s_apb_penable(penable), .s_apb_pwrite(pwrite), .s_apb_paddr(paddr),
      .s_apb_pprot(3'd0), .s_apb_pwdata(pwdata), .s_apb_pstrb(pstrb), .s_apb_pready(pready), .s_apb_prdata(prdata),
      .s_apb_pslverr(pslverr), .m_axil_awvalid(awvalid), .m_axil_awready(awready), .m_axil_awaddr(awaddr),
      .m_axil_awprot(), .m_axil_wvalid(wvalid), .m_axil_wready(wready), .m_axil_wdata(wdata), .m_axil_wstrb(wstrb),
      .m_axil_bvalid(bvalid), .m_axil_bready(bready), .m_axil_bresp(bresp), .m_axil_arvalid(arvalid),
      .m_axil_arready(arready), .m_axil_araddr(araddr), .m_axil_arprot(), .m_axil_rvalid(rvalid), .m_axil_rready(rready),
      .m_axil_rdata(rdata), .m_axil_rresp(rresp));

  always #5 clk = !clk;

  // The registers: 64 words; those at and above 0xC0 answer with an error.
  reg [31:0] word[0:63];
  reg have_aw = 1'b0, have_w = 1'b0, have_ar = 1'b0;
  reg [7:0] at = 8'd0, from = 8'd0;
  reg [31:0] value = 32'd0;
  reg [3:0] bytes = 4'd0;
  always @(posedge clk) begin
    awready <= $random(seed);
    wready  <= $random(seed);
    arready <= $random(seed);
    if (awvalid && awready) {have_aw, at} <= {1'b1, awaddr};
    if (wvalid && wready) {have_w, value, bytes} <= {1'b1, wdata, wstrb};
    if (arvalid && arready) {have_ar, from} <= {1'b1, araddr};
    if (have_aw && have_w && !bvalid && $random(seed)) begin
      bvalid <= 1'b1;
      bresp  <= at >= 8'hC0 ? 2'b10 : 2'b00;
      if (at < 8'hC0) for (i = 0; i < 4; i = i + 1) if (bytes[i]) word[at[7:2]][8*i+:8] <= value[8*i+:8];
      {have_aw, have_w} <= 2'b00;
    end
    if (have_ar && !rvalid && $random(seed)) begin
      rvalid <= 1'b1;
      rresp  <= from >= 8'hC0 ? 2'b11 : 2'b00;
      rdata  <= word[from[7:2]];
      have_ar <= 1'b0;
    end
    if (bvalid && bready) bvalid <= 1'b0;
    if (rvalid && rready) rvalid <= 1'b0;
  end

  // The host, and what the words must be.
  reg [31:0] expected[0:63];
  task access(input is_write);
    begin
      @(negedge clk);
      psel = 1'b1;
      penable = 1'b0;
      pwrite = is_write;
      paddr = {$random(seed), 2'b00};
      pwdata = $random(seed);
      pstrb = is_write ? $random(seed) : 4'd0;
      @(negedge clk);
      penable = 1'b1;
      waits = 0;
      @(posedge clk);
      while (!pready && waits < 1000) begin
        waits = waits + 1;
        @(posedge clk);
      end
      if (waits >= 1000 || pslverr !== (paddr >= 8'hC0)) wrong = wrong + 1;
      if (!is_write && paddr < 8'hC0 && prdata !== expected[paddr[7:2]]) wrong = wrong + 1;
      if (is_write && paddr < 8'hC0)
        for (i = 0; i < 4; i = i + 1) if (pstrb[i]) expected[paddr[7:2]][8*i+:8] = pwdata[8*i+:8];
      errors = errors + pslverr;
      done = done + 1;
      @(negedge clk);
      penable = 1'b0;
      psel = 1'b0;
      if ($random(seed)) @(negedge clk);
    end
  endtask

  initial begin
    if ($value$plusargs("seed=%d", seed)) ;
    if ($value$plusargs("accesses=%d", accesses)) ;
    for (i = 0; i < 64; i = i + 1) begin
      word[i] = i;
      expected[i] = i;
    end
    repeat (3) @(negedge clk);
    rst = 1'b0;
    while (done < accesses && wrong == 0) access($random(seed));
    if (wrong == 0 && errors > 0) $display("PASS accesses=%0d errors=%0d", done, errors);
    else $display("FAIL access %0d of seed %0d: wrong=%0d errors=%0d waits=%0d", done, seed, wrong, errors, waits);
    $finish;
  end
endmodule
`default_nettype wire
