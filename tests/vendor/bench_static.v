// SPDX-License-Identifier: Apache-2.0
`include "cchip_defs.vh"
`default_nettype none
// bench_static: pairs through the serial port of cchip_pr_static, one of them while the region is decoupled, which is lost.
// Prints PASS or FAIL.
module bench_static;

  localparam integer W = `CCHIP_COORD_W_DEFAULT;
  localparam integer VERTEX_W = `CCHIP_VERTEX_W(W);
  localparam integer RESULT_W = `CCHIP_SLOT_RESULT_W;
  localparam integer STATUS_W = 1 + `CCHIP_RM_ID_W + 1 + RESULT_W;

  reg clk, rst, decouple, region_rst, in_bit, in_shift, in_send, out_take, out_shift;
  wire out_bit;
  reg failed;

  cchip_pr_static dut (
      .clk       (clk),
      .rst       (rst),
      .decouple  (decouple),
      .region_rst(region_rst),
      .in_bit    (in_bit),
      .in_shift  (in_shift),
      .in_send   (in_send),
      .out_take  (out_take),
      .out_shift (out_shift),
      .out_bit   (out_bit)
  );

  task tick;
    begin
      #5 clk = 1;
      #5 clk = 0;
    end
  endtask

  function [3*W-1:0] point(input integer x, input integer y, input integer z);
    point = {z[W-1:0], y[W-1:0], x[W-1:0]};
  endfunction

  // A: triangle in the plane z = 0; B: the same one, its apex `low` and its base 10 high
  integer i, v;
  reg [`CCHIP_PRIMITIVE_W(W)-1:0] a, b;
  reg [VERTEX_W-1:0] word;
  reg first, last;
  task send(input [7:0] id, input integer low);
    begin
      a = {point(0, 0, 0), point(0, 20, 0), point(20, 0, 0), point(-20, -20, 0)};
      b = {point(0, 0, 0), point(4, 4, low), point(20, 8, 10), point(-8, 20, 10)};
      for (v = 0; v < 3; v = v + 1) begin
        first = v == 0;
        last  = v == 2;
        word  = `CCHIP_VERTEX_OF(first, last, id, 4'd0, `CCHIP_MODE_DIRECTED, a[3*W*v+:3*W], b[3*W*v+:3*W]);
        for (i = 0; i < VERTEX_W; i = i + 1) begin
          in_bit   = word[i];
          in_shift = 1;
          tick;
        end
        in_shift = 0;
        tick;
        in_send = 1;
        tick;
        in_send = 0;
        tick;
      end
      repeat (400) tick;
    end
  endtask

  reg [STATUS_W-1:0] status;
  task take;
    begin
      out_take = 1;
      tick;
      out_take = 0;
      tick;
      tick;
      for (i = 0; i < STATUS_W; i = i + 1) begin
        status[i] = out_bit;
        out_shift = 1;
        tick;
        out_shift = 0;
        tick;
        tick;
      end
    end
  endtask

  task expect_status(input idle, input [7:0] rm_id, input valid, input hit, input [7:0] id);
    begin
      if (status[STATUS_W-1] !== idle || status[STATUS_W-2-:8] !== rm_id || status[RESULT_W] !== valid
          || valid && {status[8], status[7:0]} !== {hit, id}) begin
        failed = 1;
        $display("FAIL status %b, expected idle %0d rm_id %0d valid %0d hit %0d id %0d", status, idle, rm_id, valid, hit, id);
      end
    end
  endtask

  initial begin
    {clk, decouple, region_rst, in_bit, in_shift, in_send, out_take, out_shift, failed} = 0;
    rst = 1;
    repeat (5) tick;
    rst = 0;
    repeat (5) tick;

    send(8'h12, -3);
    take;
    expect_status(1, `CCHIP_RM_TRI_TRI, 1, 1, 8'h12);
    take;
    expect_status(1, `CCHIP_RM_TRI_TRI, 0, 0, 0);

    decouple = 1;
    send(8'h43, 3);
    take;
    expect_status(0, 0, 0, 0, 0);
    region_rst = 1;
    tick;
    tick;
    region_rst = 0;
    tick;
    decouple = 0;
    repeat (400) tick;
    take;
    expect_status(1, `CCHIP_RM_TRI_TRI, 0, 0, 0);
    send(8'h87, 3);
    take;
    expect_status(1, `CCHIP_RM_TRI_TRI, 1, 0, 8'h87);

    if (!failed) $display("PASS");
    $finish;
  end

endmodule
`default_nettype wire
