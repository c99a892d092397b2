// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_dp16kd: one block RAM of Lattice ECP5 with its output registers, its pins as vectors. Yosys
// does not pack the registers, so the leaves for ECP5 take the block itself.
//   width        of a port 1, 2, 4, 9 or 18 bits. 36 bits: port A writes {d_b, d_a} and is not
//                read, port B reads {q_b, q_a}
//   address      that of a bit of 16 KiBit: word i of 1, 2, 4, 9, 18, 36 bits at i, 2 i, 4 i, 8 i,
//                16 i, 32 i; of 18 and 36 bits the lowest bits of port A's address enable the bytes
//   latency      q belongs to the address of 2 clocks before
//   collision    a word that is read on the clock on which it is written: any value
//   reset        none
module cchip_dp16kd #(
    parameter integer WIDTH_A = 18,
    parameter integer WIDTH_B = 18
) (
    input  wire        clk,
    input  wire        write,
    input  wire [13:0] addr_a,
    input  wire [17:0] d_a,
    input  wire [17:0] d_b,
    output wire [17:0] q_a,
    input  wire [13:0] addr_b,
    output wire [17:0] q_b
);

  DP16KD #(
      .DATA_WIDTH_A(WIDTH_A),
      .DATA_WIDTH_B(WIDTH_B),
      .REGMODE_A   ("OUTREG"),
      .REGMODE_B   ("OUTREG"),
      .RESETMODE   ("SYNC"),
      .CSDECODE_A  ("0b000"),
      .CSDECODE_B  ("0b000"),
      .CLKAMUX     ("CLKA"),
      .CLKBMUX     ("CLKB"),
      .GSR         ("DISABLED")
  ) u_block (
      .CLKA(clk), .CEA(1'b1), .WEA(write), .OCEA(1'b1), .RSTA(1'b0),
      .CSA0(1'b0), .CSA1(1'b0), .CSA2(1'b0),
      .CLKB(clk), .CEB(1'b1), .WEB(1'b0), .OCEB(1'b1), .RSTB(1'b0),
      .CSB0(1'b0), .CSB1(1'b0), .CSB2(1'b0),
      .ADA0(addr_a[0]), .ADA1(addr_a[1]), .ADA2(addr_a[2]), .ADA3(addr_a[3]),
      .ADA4(addr_a[4]), .ADA5(addr_a[5]), .ADA6(addr_a[6]), .ADA7(addr_a[7]),
      .ADA8(addr_a[8]), .ADA9(addr_a[9]), .ADA10(addr_a[10]), .ADA11(addr_a[11]),
      .ADA12(addr_a[12]), .ADA13(addr_a[13]),
      .ADB0(addr_b[0]), .ADB1(addr_b[1]), .ADB2(addr_b[2]), .ADB3(addr_b[3]),
      .ADB4(addr_b[4]), .ADB5(addr_b[5]), .ADB6(addr_b[6]), .ADB7(addr_b[7]),
      .ADB8(addr_b[8]), .ADB9(addr_b[9]), .ADB10(addr_b[10]), .ADB11(addr_b[11]),
      .ADB12(addr_b[12]), .ADB13(addr_b[13]),
      .DIA0(d_a[0]), .DIA1(d_a[1]), .DIA2(d_a[2]), .DIA3(d_a[3]), .DIA4(d_a[4]), .DIA5(d_a[5]),
      .DIA6(d_a[6]), .DIA7(d_a[7]), .DIA8(d_a[8]), .DIA9(d_a[9]), .DIA10(d_a[10]), .DIA11(d_a[11]),
      .DIA12(d_a[12]), .DIA13(d_a[13]), .DIA14(d_a[14]), .DIA15(d_a[15]), .DIA16(d_a[16]),
      .DIA17(d_a[17]),
      .DIB0(d_b[0]), .DIB1(d_b[1]), .DIB2(d_b[2]), .DIB3(d_b[3]), .DIB4(d_b[4]), .DIB5(d_b[5]),
      .DIB6(d_b[6]), .DIB7(d_b[7]), .DIB8(d_b[8]), .DIB9(d_b[9]), .DIB10(d_b[10]), .DIB11(d_b[11]),
      .DIB12(d_b[12]), .DIB13(d_b[13]), .DIB14(d_b[14]), .DIB15(d_b[15]), .DIB16(d_b[16]),
      .DIB17(d_b[17]),
      .DOA0(q_a[0]), .DOA1(q_a[1]), .DOA2(q_a[2]), .DOA3(q_a[3]),
      .DOA4(q_a[4]), .DOA5(q_a[5]), .DOA6(q_a[6]), .DOA7(q_a[7]),
      .DOA8(q_a[8]), .DOA9(q_a[9]), .DOA10(q_a[10]), .DOA11(q_a[11]),
      .DOA12(q_a[12]), .DOA13(q_a[13]), .DOA14(q_a[14]), .DOA15(q_a[15]),
      .DOA16(q_a[16]), .DOA17(q_a[17]),
      .DOB0(q_b[0]), .DOB1(q_b[1]), .DOB2(q_b[2]), .DOB3(q_b[3]), .DOB4(q_b[4]), .DOB5(q_b[5]),
      .DOB6(q_b[6]), .DOB7(q_b[7]), .DOB8(q_b[8]), .DOB9(q_b[9]), .DOB10(q_b[10]), .DOB11(q_b[11]),
      .DOB12(q_b[12]), .DOB13(q_b[13]), .DOB14(q_b[14]), .DOB15(q_b[15]), .DOB16(q_b[16]),
      .DOB17(q_b[17])
  );

endmodule
`default_nettype wire
