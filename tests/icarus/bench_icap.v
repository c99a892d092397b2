// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_icap: the bytes of a small bitstream as they are in a file, through cchip_config_port with a port of 32 bit and
// cchip_icap to the twin of the device's cell. Last line PASS or FAIL, exit code 1 for FAIL. Words at the cell are those
// of UG470, not computed here.
module bench_icap;
  reg clk = 0, rst = 1, run = 0, s_valid = 0;
  always #5 clk = ~clk;
  wire s_ready, cfg_valid, cfg_error, error_8, available, done;
  wire [31:0] cfg_data;
  reg [31:0] s_data;
  // words of memory: the file's bytes, first lowest: FF FF FF FF, AA 99 55 66, NOOP 20 00 00 00, write of CMD 30 00 80 01
  // with 00 00 00 0D (DESYNC), or a word that no packet begins with
  reg [31:0] file[0:5];
  reg [31:0] expected[0:5];
  integer words, seen, failures;
  cchip_config_port #(.CFG_W(32), .CFG_DIVIDER(1)) u_port (
      .clk(clk), .rst(rst), .run(run), .length(32'd4 * words), .s_valid(s_valid), .s_ready(s_ready), .s_data(s_data),
      .cfg_valid(cfg_valid), .cfg_data(cfg_data), .done(done), .crc(), .stall()
  );
  cchip_icap #(.FAMILY(7), .PAUSE(16)) u_icap (
      .clk(clk), .rst(rst), .cfg_valid(cfg_valid), .cfg_data(cfg_data), .cfg_error(cfg_error), .available(available)
  );
  cchip_icap #(.FAMILY(8), .PAUSE(16)) u_icap_8 (
      .clk(clk), .rst(rst), .cfg_valid(cfg_valid), .cfg_data(cfg_data), .cfg_error(error_8), .available()
  );
  task check(input good, input [8*60-1:0] what);
    if (good !== 1'b1) begin
      $display("FAIL %0s", what);
      failures = failures + 1;
    end
  endtask
  always @(posedge clk)
    if (!u_icap.u_cell.csib) begin
      if (u_icap.u_cell.i !== expected[seen]) begin
        $display("word %0d: %h instead of %h", seen, u_icap.u_cell.i, expected[seen]);
        check(0, "wrong word at the cell");
      end
      check(!u_icap.u_cell.rdwrb, "RDWRB is not 0");
      seen = seen + 1;
    end
  task transfer(input integer count);
    integer k;
    begin
      words = count;
      seen = 0;
      @(posedge clk) #1 run = 1;
      for (k = 0; k < count; k = k + 1) begin
        s_data = file[k];
        s_valid = 1;
        @(posedge clk);
        while (!s_ready) @(posedge clk);
        #1;
      end
      s_valid = 0;
      repeat (10) @(posedge clk);
      #1 run = 0;
      repeat (2) @(posedge clk);
    end
  endtask
  initial begin
    failures = 0;
    words = 1;
    seen = 0;
    file[0] = 32'hFFFFFFFF; expected[0] = 32'hFFFFFFFF;
    file[1] = 32'h665599AA; expected[1] = 32'h5599AA66;
    file[2] = 32'h00000020; expected[2] = 32'h04000000;
    file[3] = 32'h01800030; expected[3] = 32'h0C000180;
    file[4] = 32'h0D000000; expected[4] = 32'h000000B0;
    file[5] = 32'h00000020; expected[5] = 32'h04000000;
    repeat (3) @(posedge clk);
    #1 rst = 0;
    check(u_icap.u_cell.o[7:0] == 8'h9F, "status before the sync word");
    transfer(3);
    check(seen == 3, "three words at the cell");
    check(u_icap.u_cell.o[7:0] == 8'hDF, "status after the sync word");
    check(!cfg_error && !error_8, "no error");
    file[0] = 32'h01800030; expected[0] = 32'h0C000180;
    file[1] = 32'h0D000000; expected[1] = 32'h000000B0;
    repeat (30) @(posedge clk);
    transfer(2);
    check(u_icap.u_cell.o[7:0] == 8'h9F && !cfg_error, "status after DESYNC");
    // an error of the bitstream, reported by both cells, and gone with the next transfer
    repeat (30) @(posedge clk);
    file[0] = 32'h665599AA; expected[0] = 32'h5599AA66;
    file[1] = 32'h000000E0; expected[1] = 32'h07000000;
    transfer(2);
    check(cfg_error && error_8, "an error of the bitstream is reported");
    repeat (30) @(posedge clk);
    check(cfg_error, "the error stays");
    // the device, still aligned, reports the old error until an end and another sync word
    file[0] = 32'h01800030; expected[0] = 32'h0C000180;
    file[1] = 32'h0D000000; expected[1] = 32'h000000B0;
    file[2] = 32'h665599AA; expected[2] = 32'h5599AA66;
    file[3] = 32'h00000020; expected[3] = 32'h04000000;
    transfer(4);
    check(!cfg_error && !error_8, "the error ends with the next transfer");
    check(u_icap.u_cell.o[7:0] == 8'hDF, "status of the next transfer");
    // not available: no word reaches the cell, and that is an error
    repeat (30) @(posedge clk);
    force u_icap.u_cell.avail = 1'b0;
    repeat (3) @(posedge clk);
    check(!available, "not available");
    transfer(1);
    check(seen == 0 && cfg_error && !error_8, "a word is lost while the cell is not available");
    if (failures != 0) $finish_and_return(1);
    $display("PASS");
    $finish;
  end
endmodule
`default_nettype wire
