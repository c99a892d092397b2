// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_block_ram for Lattice ECP5: blocks DP16KD with their own output registers, which Yosys does
// not pack. Takes the place of common/cchip_block_ram.v in rtl/cchip_ecp5.f.
//   blocks       WORDS = 1: one for 18 bits of a word, up to ADDR_W = 10; WORDS = 4: one for 9
//                bits, written 36 bits wide, up to ADDR_W = 11. Larger memories are left to
//                inference, their output register is made of flip-flops
//   latency, throughput, collision, cuts, reset   those of common/cchip_block_ram.v
module cchip_block_ram #(
    // see common/cchip_block_ram.v
    parameter integer WIDTH = 8,
    parameter integer WORDS = 1,
    parameter integer ADDR_W = 9,
    parameter integer MIXED_WIDTH = 1
) (
    input  wire                                   clk,
    input  wire                                   write,
    input  wire [ADDR_W-(WORDS==4 ? 2 : 0)-1:0] write_addr,
    input  wire [                WORDS*WIDTH-1:0] write_data,
    input  wire [                     ADDR_W-1:0] read_addr,
    output wire [                      WIDTH-1:0] read_data
);

  localparam integer LEAST = WORDS == 4 ? 9 : 18;  // bits of a word in a block
  localparam integer BLOCKS = (WIDTH + LEAST - 1) / LEAST;
  localparam integer FITS = WORDS == 4 ? 11 : 10;  // address bits of a block

  generate
    if (WIDTH < 1 || ADDR_W < 3 || ADDR_W > 16) begin : gen_illegal
      cchip_error_block_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16 u_error ();
    end
    if (WORDS != 1 && WORDS != 4) begin : gen_illegal_words
      cchip_error_block_ram_WORDS_must_be_1_or_4 u_error ();
    end

    if (ADDR_W <= FITS) begin : gen_blocks
      // the address of a block is that of a bit; the lowest bits of the port for writing enable
      // the bytes
      wire [13:0] write_bit, read_bit;
      if (WORDS == 4) begin : gen_wide
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 1'b0, 4'b1111};
        assign read_bit  = {{FITS - ADDR_W{1'b0}}, read_addr, 3'd0};
      end else begin : gen_same
        assign write_bit = {{FITS - ADDR_W{1'b0}}, write_addr, 4'b0011};
        assign read_bit  = {{FITS - ADDR_W{1'b0}}, read_addr, 4'd0};
      end
      wire [WORDS*BLOCKS*LEAST-1:0] padded;  // words, each filled up to whole blocks
      wire [BLOCKS*LEAST-1:0] found;
      assign read_data = found[WIDTH-1:0];
      genvar w, b;
      for (w = 0; w < WORDS; w = w + 1) begin : gen_padded
        assign padded[BLOCKS*LEAST*w+:WIDTH] = write_data[WIDTH*w+:WIDTH];
        if (BLOCKS * LEAST > WIDTH) begin : gen_rest
          assign padded[BLOCKS*LEAST*w+WIDTH+:BLOCKS*LEAST-WIDTH] = {BLOCKS * LEAST - WIDTH{1'b0}};
        end
      end
      for (b = 0; b < BLOCKS; b = b + 1) begin : gen_block
        wire [35:0] d;
        wire [17:0] q, unused_a;
        for (w = 0; w < WORDS; w = w + 1) begin : gen_words
          assign d[LEAST*w+:LEAST] = padded[BLOCKS*LEAST*w+LEAST*b+:LEAST];
        end
        if (WORDS == 1) begin : gen_upper
          assign d[35:18] = 18'd0;
        end
        assign found[LEAST*b+:LEAST] = q[LEAST-1:0];
        DP16KD #(
            .DATA_WIDTH_A(WORDS == 4 ? 36 : 18),
            .DATA_WIDTH_B(LEAST),
            .REGMODE_A   ("NOREG"),
            .REGMODE_B   ("OUTREG"),
            .RESETMODE   ("SYNC"),
            .CSDECODE_A  ("0b000"),
            .CSDECODE_B  ("0b000"),
            .CLKAMUX     ("CLKA"),
            .CLKBMUX     ("CLKB"),
            .GSR         ("DISABLED")
        ) u_block (
            .CLKA(clk), .CEA(write), .WEA(1'b1), .OCEA(1'b1), .RSTA(1'b0),
            .CSA0(1'b0), .CSA1(1'b0), .CSA2(1'b0),
            .CLKB(clk), .CEB(1'b1), .WEB(1'b0), .OCEB(1'b1), .RSTB(1'b0),
            .CSB0(1'b0), .CSB1(1'b0), .CSB2(1'b0),
            .ADA0(write_bit[0]), .ADA1(write_bit[1]), .ADA2(write_bit[2]), .ADA3(write_bit[3]),
            .ADA4(write_bit[4]), .ADA5(write_bit[5]), .ADA6(write_bit[6]), .ADA7(write_bit[7]),
            .ADA8(write_bit[8]), .ADA9(write_bit[9]), .ADA10(write_bit[10]), .ADA11(write_bit[11]),
            .ADA12(write_bit[12]), .ADA13(write_bit[13]),
            .ADB0(read_bit[0]), .ADB1(read_bit[1]), .ADB2(read_bit[2]), .ADB3(read_bit[3]),
            .ADB4(read_bit[4]), .ADB5(read_bit[5]), .ADB6(read_bit[6]), .ADB7(read_bit[7]),
            .ADB8(read_bit[8]), .ADB9(read_bit[9]), .ADB10(read_bit[10]), .ADB11(read_bit[11]),
            .ADB12(read_bit[12]), .ADB13(read_bit[13]),
            .DIA0(d[0]), .DIA1(d[1]), .DIA2(d[2]), .DIA3(d[3]), .DIA4(d[4]), .DIA5(d[5]),
            .DIA6(d[6]), .DIA7(d[7]), .DIA8(d[8]), .DIA9(d[9]), .DIA10(d[10]), .DIA11(d[11]),
            .DIA12(d[12]), .DIA13(d[13]), .DIA14(d[14]), .DIA15(d[15]), .DIA16(d[16]),
            .DIA17(d[17]),
            .DIB0(d[18]), .DIB1(d[19]), .DIB2(d[20]), .DIB3(d[21]), .DIB4(d[22]), .DIB5(d[23]),
            .DIB6(d[24]), .DIB7(d[25]), .DIB8(d[26]), .DIB9(d[27]), .DIB10(d[28]), .DIB11(d[29]),
            .DIB12(d[30]), .DIB13(d[31]), .DIB14(d[32]), .DIB15(d[33]), .DIB16(d[34]),
            .DIB17(d[35]),
            .DOA0(unused_a[0]), .DOA1(unused_a[1]), .DOA2(unused_a[2]), .DOA3(unused_a[3]),
            .DOA4(unused_a[4]), .DOA5(unused_a[5]), .DOA6(unused_a[6]), .DOA7(unused_a[7]),
            .DOA8(unused_a[8]), .DOA9(unused_a[9]), .DOA10(unused_a[10]), .DOA11(unused_a[11]),
            .DOA12(unused_a[12]), .DOA13(unused_a[13]), .DOA14(unused_a[14]), .DOA15(unused_a[15]),
            .DOA16(unused_a[16]), .DOA17(unused_a[17]),
            .DOB0(q[0]), .DOB1(q[1]), .DOB2(q[2]), .DOB3(q[3]), .DOB4(q[4]), .DOB5(q[5]),
            .DOB6(q[6]), .DOB7(q[7]), .DOB8(q[8]), .DOB9(q[9]), .DOB10(q[10]), .DOB11(q[11]),
            .DOB12(q[12]), .DOB13(q[13]), .DOB14(q[14]), .DOB15(q[15]), .DOB16(q[16]),
            .DOB17(q[17])
        );
        wire unused = &{1'b0, q, unused_a};
      end
      wire unused = &{1'b0, found, MIXED_WIDTH};
    end else begin : gen_inferred
      (* ram_style = "block", no_rw_check *)
      reg [WIDTH-1:0] mem [0:(1<<ADDR_W)-1];
      reg [WIDTH-1:0] word_q, read_data_q;
      integer i;
      if (WORDS == 4) begin : gen_wide
        always @(posedge clk)
          for (i = 0; i < 4; i = i + 1)
            if (write) mem[{write_addr, i[1:0]}] <= write_data[WIDTH*i+:WIDTH];
      end else begin : gen_same
        always @(posedge clk) if (write) mem[write_addr] <= write_data;
      end
      always @(posedge clk) begin
        word_q      <= mem[read_addr];
        read_data_q <= word_q;
      end
      assign read_data = read_data_q;
      wire unused = &{1'b0, MIXED_WIDTH};
    end
  endgenerate

endmodule
`default_nettype wire
