// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// bench_poison: a design with the fault that CCHIP_POISON is there to find: it reads words of block RAMs on the clock
// on which it writes them and counts on the old word. Each other read must give what was written, with the macro, too.
// Last line "PASS" without the macro; with it "FAIL memories=N", the number of memories whose word was another one, and
// Icarus ends with code 1. Anything else: "BROKEN".
module bench_poison;
  localparam integer W = 40;
  reg clk = 0;
  always #5 clk = ~clk;

  // memory 0: words of their own; 1 and 2: four at once, either form; 3: the second port of two; 4: the first one
  reg write = 0;
  reg [4:0] write_at = 0, read_at = 0;
  reg [W-1:0] data = 0;
  wire [W-1:0] word[0:4];
  cchip_block_ram #(.WIDTH(W), .ADDR_W(5)) u_single (
      .clk(clk), .write(write), .write_addr(write_at), .write_data(data), .read_addr(read_at), .read_data(word[0]));
  genvar g;
  generate
    for (g = 0; g < 2; g = g + 1) begin : gen_four
      cchip_block_ram #(.WIDTH(W), .WORDS(4), .ADDR_W(5), .MIXED_WIDTH(g)) u_four (
          .clk(clk), .write(write), .write_addr(write_at[4:2]), .write_data({4{data}}), .read_addr(read_at),
          .read_data(word[1+g]));
    end
  endgenerate
  cchip_dual_ram #(.WIDTH(W), .ADDR_W(5)) u_dual (
      .clk(clk), .write(write), .addr_a(write ? write_at : read_at), .write_data(data), .read_data_a(word[4]),
      .addr_b(read_at), .read_data_b(word[3]));

  integer i, m, memories;
  reg [4:0] other;
  task access(input with_write, input [4:0] to, input [W-1:0] value, input [4:0] from);
    begin
      write = with_write;
      write_at = to;
      data = value;
      read_at = from;
      @(posedge clk) #1 write = 0;
      @(posedge clk) #1;
    end
  endtask

  initial begin
    for (i = 0; i < 32; i = i + 1) access(1'b1, i[4:0], 40'hA5 + (i >> 2), ~i[4:0]);
    other = 0;
    // a read beside a write to another line, and one of a line at rest
    access(1'b1, 5'd12, 40'hA5 + 3, 5'd20);
    for (m = 0; m < 4; m = m + 1) if (word[m] !== 40'hA5 + 5) other[m] = 1;
    access(1'b0, 5'd12, 40'd0, 5'd12);
    for (m = 0; m < 5; m = m + 1) if (word[m] !== 40'hA5 + 3) other[m] = 1;
    if (other != 0) begin
      $display("BROKEN %b", other);
      $finish_and_return(2);
    end
    access(1'b1, 5'd12, 40'h77, 5'd12);
    memories = 0;
    for (m = 0; m < 5; m = m + 1) if (word[m] !== 40'hA5 + 3) memories = memories + 1;
    access(1'b0, 5'd12, 40'd0, 5'd12);
    for (m = 0; m < 5; m = m + 1) if (word[m] !== 40'h77) other[m] = 1;
    if (other != 0) begin
      $display("BROKEN %b", other);
      $finish_and_return(2);
    end
    if (memories != 0) begin
      $display("FAIL memories=%0d", memories);
      $finish_and_return(1);
    end
    $display("PASS");
    $finish;
  end
endmodule
`default_nettype wire
