// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Simulation model of Lattice ECP5's block RAM (FPGA-TN-02204), for netlists: written through port A, read through both
// ports, in the modes that are taken for the memories here, where a byte has 9 bits and an address is that of a bit:
//   inferred     512 words of 36 bits, read through port B one clock after the address
//   rtl/vendor/ecp5/cchip_dp16kd.v   both ports with their output registers, read two clocks after the address: 2,048 words
//                of 9 bits, 1,024 of 18, or 512 of 36 written through A and 512 of 36 or 2,048 of 9 read through B
//   write        CEA and WEA; byte i of the word if ADA<i>; data {DIB, DIA}
//   read         CEB; data {DOB, DOA} of 36 bits, DOB of fewer
//   both at one word on one clock: undefined here (Yosys counts on nothing)
// Other modes, resets, inverted clocks and initial contents other than 0 are refused.
/* verilator lint_off DECLFILENAME */
/* verilator lint_off UNUSEDPARAM */
/* verilator lint_off WIDTHCONCAT */
module DP16KD #(
    parameter integer DATA_WIDTH_A = 18,
    parameter integer DATA_WIDTH_B = 18,
    parameter REGMODE_A = "NOREG",
    parameter REGMODE_B = "NOREG",
    parameter RESETMODE = "SYNC",
    parameter ASYNC_RESET_RELEASE = "SYNC",
    parameter CSDECODE_A = "0b000",
    parameter CSDECODE_B = "0b000",
    parameter WRITEMODE_A = "NORMAL",
    parameter WRITEMODE_B = "NORMAL",
    parameter CLKAMUX = "CLKA",
    parameter CLKBMUX = "CLKB",
    parameter GSR = "ENABLED",
    parameter [319:0] INITVAL_00 = 320'd0,
    parameter [319:0] INITVAL_01 = 320'd0,
    parameter [319:0] INITVAL_02 = 320'd0,
    parameter [319:0] INITVAL_03 = 320'd0,
    parameter [319:0] INITVAL_04 = 320'd0,
    parameter [319:0] INITVAL_05 = 320'd0,
    parameter [319:0] INITVAL_06 = 320'd0,
    parameter [319:0] INITVAL_07 = 320'd0,
    parameter [319:0] INITVAL_08 = 320'd0,
    parameter [319:0] INITVAL_09 = 320'd0,
    parameter [319:0] INITVAL_0A = 320'd0,
    parameter [319:0] INITVAL_0B = 320'd0,
    parameter [319:0] INITVAL_0C = 320'd0,
    parameter [319:0] INITVAL_0D = 320'd0,
    parameter [319:0] INITVAL_0E = 320'd0,
    parameter [319:0] INITVAL_0F = 320'd0,
    parameter [319:0] INITVAL_10 = 320'd0,
    parameter [319:0] INITVAL_11 = 320'd0,
    parameter [319:0] INITVAL_12 = 320'd0,
    parameter [319:0] INITVAL_13 = 320'd0,
    parameter [319:0] INITVAL_14 = 320'd0,
    parameter [319:0] INITVAL_15 = 320'd0,
    parameter [319:0] INITVAL_16 = 320'd0,
    parameter [319:0] INITVAL_17 = 320'd0,
    parameter [319:0] INITVAL_18 = 320'd0,
    parameter [319:0] INITVAL_19 = 320'd0,
    parameter [319:0] INITVAL_1A = 320'd0,
    parameter [319:0] INITVAL_1B = 320'd0,
    parameter [319:0] INITVAL_1C = 320'd0,
    parameter [319:0] INITVAL_1D = 320'd0,
    parameter [319:0] INITVAL_1E = 320'd0,
    parameter [319:0] INITVAL_1F = 320'd0,
    parameter [319:0] INITVAL_20 = 320'd0,
    parameter [319:0] INITVAL_21 = 320'd0,
    parameter [319:0] INITVAL_22 = 320'd0,
    parameter [319:0] INITVAL_23 = 320'd0,
    parameter [319:0] INITVAL_24 = 320'd0,
    parameter [319:0] INITVAL_25 = 320'd0,
    parameter [319:0] INITVAL_26 = 320'd0,
    parameter [319:0] INITVAL_27 = 320'd0,
    parameter [319:0] INITVAL_28 = 320'd0,
    parameter [319:0] INITVAL_29 = 320'd0,
    parameter [319:0] INITVAL_2A = 320'd0,
    parameter [319:0] INITVAL_2B = 320'd0,
    parameter [319:0] INITVAL_2C = 320'd0,
    parameter [319:0] INITVAL_2D = 320'd0,
    parameter [319:0] INITVAL_2E = 320'd0,
    parameter [319:0] INITVAL_2F = 320'd0,
    parameter [319:0] INITVAL_30 = 320'd0,
    parameter [319:0] INITVAL_31 = 320'd0,
    parameter [319:0] INITVAL_32 = 320'd0,
    parameter [319:0] INITVAL_33 = 320'd0,
    parameter [319:0] INITVAL_34 = 320'd0,
    parameter [319:0] INITVAL_35 = 320'd0,
    parameter [319:0] INITVAL_36 = 320'd0,
    parameter [319:0] INITVAL_37 = 320'd0,
    parameter [319:0] INITVAL_38 = 320'd0,
    parameter [319:0] INITVAL_39 = 320'd0,
    parameter [319:0] INITVAL_3A = 320'd0,
    parameter [319:0] INITVAL_3B = 320'd0,
    parameter [319:0] INITVAL_3C = 320'd0,
    parameter [319:0] INITVAL_3D = 320'd0,
    parameter [319:0] INITVAL_3E = 320'd0,
    parameter [319:0] INITVAL_3F = 320'd0
) (
    input  wire DIA0, DIA1, DIA2, DIA3, DIA4, DIA5, DIA6, DIA7, DIA8, DIA9, DIA10, DIA11, DIA12, DIA13,
                DIA14, DIA15, DIA16, DIA17,
    input  wire DIB0, DIB1, DIB2, DIB3, DIB4, DIB5, DIB6, DIB7, DIB8, DIB9, DIB10, DIB11, DIB12, DIB13,
                DIB14, DIB15, DIB16, DIB17,
    input  wire ADA0, ADA1, ADA2, ADA3, ADA4, ADA5, ADA6, ADA7, ADA8, ADA9, ADA10, ADA11, ADA12, ADA13,
    input  wire ADB0, ADB1, ADB2, ADB3, ADB4, ADB5, ADB6, ADB7, ADB8, ADB9, ADB10, ADB11, ADB12, ADB13,
    input  wire CEA, OCEA, CLKA, WEA, RSTA, CSA0, CSA1, CSA2, CEB, OCEB, CLKB, WEB, RSTB, CSB0, CSB1, CSB2,
    output wire DOA0, DOA1, DOA2, DOA3, DOA4, DOA5, DOA6, DOA7, DOA8, DOA9, DOA10, DOA11, DOA12, DOA13,
                DOA14, DOA15, DOA16, DOA17,
    output wire DOB0, DOB1, DOB2, DOB3, DOB4, DOB5, DOB6, DOB7, DOB8, DOB9, DOB10, DOB11, DOB12, DOB13,
                DOB14, DOB15, DOB16, DOB17
);

  // words of 1, 2 or 4 bits have no parity bits: parts of the bytes
  localparam integer PART = DATA_WIDTH_B == 1 || DATA_WIDTH_B == 2 || DATA_WIDTH_B == 4 ? DATA_WIDTH_B : 0;
  generate
    if (REGMODE_B == "NOREG" ? DATA_WIDTH_A != 36 || DATA_WIDTH_B != 36
        : !(DATA_WIDTH_A == 36 && (DATA_WIDTH_B == 9 || DATA_WIDTH_B == 36)
            || DATA_WIDTH_A == DATA_WIDTH_B && DATA_WIDTH_B <= 18 && (DATA_WIDTH_B % 9 == 0 || PART != 0))) begin : gen_width
      dp16kd_model_does_not_know_these_widths u_error ();
    end
    if (REGMODE_A != REGMODE_B || CSDECODE_A != "0b000" || CSDECODE_B != "0b000" || CLKAMUX != "CLKA" || CLKBMUX != "CLKB")
    begin : gen_mode
      dp16kd_model_knows_neither_different_registers_nor_selects_nor_inverted_clocks u_error ();
    end
    if ({INITVAL_3F, INITVAL_3E, INITVAL_3D, INITVAL_3C, INITVAL_3B, INITVAL_3A, INITVAL_39, INITVAL_38,
      INITVAL_37, INITVAL_36, INITVAL_35, INITVAL_34, INITVAL_33, INITVAL_32, INITVAL_31, INITVAL_30,
      INITVAL_2F, INITVAL_2E, INITVAL_2D, INITVAL_2C, INITVAL_2B, INITVAL_2A, INITVAL_29, INITVAL_28,
      INITVAL_27, INITVAL_26, INITVAL_25, INITVAL_24, INITVAL_23, INITVAL_22, INITVAL_21, INITVAL_20,
      INITVAL_1F, INITVAL_1E, INITVAL_1D, INITVAL_1C, INITVAL_1B, INITVAL_1A, INITVAL_19, INITVAL_18,
      INITVAL_17, INITVAL_16, INITVAL_15, INITVAL_14, INITVAL_13, INITVAL_12, INITVAL_11, INITVAL_10,
      INITVAL_0F, INITVAL_0E, INITVAL_0D, INITVAL_0C, INITVAL_0B, INITVAL_0A, INITVAL_09, INITVAL_08,
      INITVAL_07, INITVAL_06, INITVAL_05, INITVAL_04, INITVAL_03, INITVAL_02, INITVAL_01, INITVAL_00}
        != {64 * 320{1'b0}}) begin : gen_init
      dp16kd_model_knows_no_initial_contents u_error ();
    end
  endgenerate

  wire [13:0] write_bit = {ADA13, ADA12, ADA11, ADA10, ADA9, ADA8, ADA7, ADA6, ADA5, ADA4, ADA3, ADA2, ADA1, ADA0};
  wire [13:0] read_bit = {ADB13, ADB12, ADB11, ADB10, ADB9, ADB8, ADB7, ADB6, ADB5, ADB4, ADB3, ADB2, ADB1, ADB0};
  wire [35:0] write_data = {DIB17, DIB16, DIB15, DIB14, DIB13, DIB12, DIB11, DIB10, DIB9, DIB8, DIB7, DIB6, DIB5, DIB4,
      DIB3, DIB2, DIB1, DIB0, DIA17, DIA16, DIA15, DIA14, DIA13, DIA12, DIA11, DIA10, DIA9, DIA8,
      DIA7, DIA6, DIA5, DIA4, DIA3, DIA2, DIA1, DIA0};

  // 512 words of four bytes; a narrower port sees some of them
  localparam integer WRITTEN = DATA_WIDTH_A / 9, READ = DATA_WIDTH_B / 9;
  wire [8:0] write_word = write_bit[13:5], read_word = read_bit[13:5];
  wire [1:0] write_byte = WRITTEN == 4 ? 2'd0 : WRITTEN == 2 ? {write_bit[4], 1'b0} : write_bit[4:3];
  wire [1:0] read_byte = READ == 4 ? 2'd0 : READ == 2 ? {read_bit[4], 1'b0} : read_bit[4:3];
  wire [3:0] bytes_read = (READ == 4 ? 4'd15 : READ == 2 ? 4'd3 : 4'd1) << read_byte;
  wire [3:0] enabled = WRITTEN == 4 ? write_bit[3:0] : WRITTEN == 2 ? {2'd0, write_bit[1:0]} : 4'd1;
  wire [3:0] bytes = CEA & WEA & (PART == 0) ? enabled << write_byte : 4'd0;  // the address may be unknown otherwise
  wire [35:0] placed = write_data << 9 * write_byte;

  reg [35:0] mem[0:511];
  reg [35:0] word, registered;
  reg [35:0] word_a, registered_a;
  integer i;
  initial for (i = 0; i < 512; i = i + 1) mem[i] = 36'd0;

  localparam integer PART_W = PART == 0 ? 1 : PART == 4 ? 12 : PART == 2 ? 13 : 14;  // bits of a part's number
  wire [PART_W-1:0] write_part = write_bit[13-:PART_W], read_part = read_bit[13-:PART_W];
  reg [3:0] parts[0:(1 << PART_W)-1];
  always @(posedge CLKA) if (PART != 0 && CEA && WEA) parts[write_part] <= write_data[3:0];
  always @(posedge CLKA) begin
    if (bytes[0]) mem[write_word][8:0] <= placed[8:0];
    if (bytes[1]) mem[write_word][17:9] <= placed[17:9];
    if (bytes[2]) mem[write_word][26:18] <= placed[26:18];
    if (bytes[3]) mem[write_word][35:27] <= placed[35:27];
  end
  // a port of 36 bits is not read
  always @(posedge CLKA) begin
    if (CEA) word_a <= WEA ? 36'bx : PART != 0 ? {32'd0, parts[write_part]} : mem[write_word] >> 9 * write_byte;
    if (OCEA) registered_a <= word_a;
  end
  always @(posedge CLKB) begin
    if (CEB && PART != 0) word <= CEA && WEA && write_part == read_part ? 36'bx : {32'd0, parts[read_part]};
    else if (CEB) word <= |(bytes & bytes_read) && write_word == read_word ? 36'bx : mem[read_word] >> 9 * read_byte;
    if (OCEB) registered <= word;
  end
  wire [35:0] outputs = REGMODE_B == "OUTREG" ? registered : word;
  wire [35:0] read_data = READ == 4 ? outputs : {outputs[17:0], registered_a[17:0]};

  assign {DOB17, DOB16, DOB15, DOB14, DOB13, DOB12, DOB11, DOB10, DOB9, DOB8, DOB7, DOB6, DOB5, DOB4,
      DOB3, DOB2, DOB1, DOB0, DOA17, DOA16, DOA15, DOA14, DOA13, DOA12, DOA11, DOA10, DOA9, DOA8,
      DOA7, DOA6, DOA5, DOA4, DOA3, DOA2, DOA1, DOA0} = read_data;

`ifndef YOSYS
  always @*
    if (RSTA || RSTB || WEB || CSA0 || CSA1 || CSA2 || CSB0 || CSB1 || CSB2 || !OCEA || !OCEB) begin
      $display("DP16KD %m: this model has no resets and no selects, writes through A only");
      $finish;
    end
`endif

  wire unused = &{1'b0, write_bit[4:2], read_bit[4:0], outputs, registered_a[35:18]};

endmodule
`default_nettype wire
