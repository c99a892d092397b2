// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
`include "cchip_assert.vh"
// cchip_icap: from the configuration port of cchip_config_controller (CFG_W = 32) to the internal
// configuration access port of Xilinx devices, ICAPE2 or ICAPE3, in cchip_icap_cell.
//   latency      1 clock from cfg_valid to the word at the cell
//   throughput   one word per clock; the cell limits clk, 100 MHz on 7 series: see the data sheet
//                of the device, or take a slower clock for the chip
//   numbers      byte 0 of the file is cfg_data[7:0]. The cell wants byte 0 highest and the bits of
//                each byte swapped (UG470, UG570), which together is all 32 bits in reverse: the
//                sync word's bytes AA 99 55 66 come as 0x665599AA and leave as 0x5599AA66
//   error        cfg_error: the device begins to report an error of the bitstream, or a word came
//                while the cell was not available. It stays until the next word that follows a
//                pause of PAUSE clocks, the first of another transfer, though the device may report
//                the old error until its sync word
//   available    the port of the controller has no ready: words that come with AVAIL = 0 do not
//                reach the cell and are an error, so that the swap ends with the code DEVICE
//   read, abort  never: RDWRB is 0 for ever, so no change of it can abort a transfer
//   cuts         every path: the inputs of the cell and cfg_error are flip-flops
//   reset        no word, no error
module cchip_icap #(
    parameter integer FAMILY = 7,  // 7: ICAPE2 of 7 series, 8: ICAPE3 of UltraScale(+); legal: 7, 8
    // clocks without a word after which a word begins another transfer; legal: 16..65535
    parameter integer PAUSE = 256
) (
    input  wire        clk,        // clock of the controller and of the cell, rising edge
    input  wire        rst,        // synchronous reset, active high
    input  wire        cfg_valid,  // a word passes the configuration port, one clock
    input  wire [31:0] cfg_data,   // the word, first byte lowest
    output wire        cfg_error,  // for the controller: a level, on clk
    output wire        available   // the cell can take words; 7 series: always 1
);

  `CCHIP_REFUSE(FAMILY != 7 && FAMILY != 8, cchip_error_icap_FAMILY_must_be_7_or_8)
  `CCHIP_REFUSE(PAUSE < 16 || PAUSE > 65535, cchip_error_icap_PAUSE_must_be_16_to_65535)

  localparam [31:0] REST = PAUSE;

  wire [31:0] reversed;
  genvar i;
  generate
    for (i = 0; i < 32; i = i + 1) begin : gen_reversed
      assign reversed[i] = cfg_data[31-i];
    end
  endgenerate

  wire avail, prerror;
  wire [31:0] status;
  reg csib_q, error_q, rests_q, avail_q, bad_q, bad_q2;
  initial csib_q = 1'b1;
  reg [31:0] data_q;
  reg [15:0] pause_q;

  always @(posedge clk) begin
    if (cfg_valid) data_q <= reversed;
    avail_q <= avail;
    // 7 series: status bit 7 is CFGERR_B
    bad_q   <= FAMILY == 7 ? ~status[7] : prerror;
    bad_q2  <= bad_q;
    if (rst) begin
      csib_q  <= 1'b1;
      error_q <= 1'b0;
      pause_q <= 16'd0;
      rests_q <= 1'b1;
    end else begin
      csib_q  <= ~(cfg_valid & avail_q);
      error_q <= (cfg_valid & ~avail_q) | (bad_q & ~bad_q2) | (error_q & ~(cfg_valid & rests_q));
      pause_q <= cfg_valid || rests_q ? 16'd0 : pause_q + 16'd1;
      rests_q <= !cfg_valid && (rests_q || pause_q == REST[15:0]);
    end
  end

  cchip_icap_cell #(
      .FAMILY(FAMILY)
  ) u_cell (
      .clk    (clk),
      .csib   (csib_q),
      .rdwrb  (1'b0),
      .i      (data_q),
      .o      (status),
      .avail  (avail),
      .prerror(prerror)
  );

  wire unused = &{1'b0, status, prerror};
  assign cfg_error = error_q;
  assign available = avail_q;

endmodule
`default_nettype wire
