// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
`default_nettype none
// cchip_icap_cell of Xilinx devices: the cell itself, which a device has once or twice. Takes the
// place of reconfig/cchip_icap_cell.v in rtl/cchip_xilinx.f.
//   latency, throughput, cuts, reset   those of the device: UG470 (ICAPE2), UG570 (ICAPE3)
module cchip_icap_cell #(
    parameter integer FAMILY = 7  // see reconfig/cchip_icap_cell.v
) (
    input  wire        clk,
    input  wire        csib,
    input  wire        rdwrb,
    input  wire [31:0] i,
    output wire [31:0] o,
    output wire        avail,
    output wire        prerror
);

  generate
    if (FAMILY == 7) begin : gen_7_series
      ICAPE2 #(
          .ICAP_WIDTH("X32")
      ) u_icap (
          .CLK  (clk),
          .CSIB (csib),
          .RDWRB(rdwrb),
          .I    (i),
          .O    (o)
      );
      assign avail   = 1'b1;
      assign prerror = 1'b0;
    end else begin : gen_ultrascale
      wire done;
      ICAPE3 u_icap (
          .CLK    (clk),
          .CSIB   (csib),
          .RDWRB  (rdwrb),
          .I      (i),
          .O      (o),
          .AVAIL  (avail),
          .PRDONE (done),
          .PRERROR(prerror)
      );
      wire unused = &{1'b0, done};
    end
  endgenerate

endmodule
`default_nettype wire
