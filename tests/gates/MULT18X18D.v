// SPDX-License-Identifier: Apache-2.0
`default_nettype none
// Simulation model of Lattice ECP5's multiplier block (FPGA-TN-02205), for netlists, in the modes in which
// rtl/vendor/ecp5/cchip_mul18.v uses it: P = A * B, 18 bits each, both signed or both unsigned, input registers and output
// register on CLK0, always enabled, never reset. Other modes are refused. Ports of the shift chain and the outputs of the input registers
// are left out: a netlist that connects them does not elaborate.
/* verilator lint_off DECLFILENAME */
/* verilator lint_off UNUSEDPARAM */
module MULT18X18D #(
    parameter REG_INPUTA_CLK = "NONE",
    parameter REG_INPUTA_CE = "CE0",
    parameter REG_INPUTA_RST = "RST0",
    parameter REG_INPUTB_CLK = "NONE",
    parameter REG_INPUTB_CE = "CE0",
    parameter REG_INPUTB_RST = "RST0",
    parameter REG_INPUTC_CLK = "NONE",
    parameter REG_PIPELINE_CLK = "NONE",
    parameter REG_OUTPUT_CLK = "NONE",
    parameter REG_OUTPUT_CE = "CE0",
    parameter REG_OUTPUT_RST = "RST0",
    parameter CLK0_DIV = "ENABLED",
    parameter HIGHSPEED_CLK = "NONE",
    parameter GSR = "ENABLED",
    parameter CAS_MATCH_REG = "FALSE",
    parameter SOURCEB_MODE = "B_SHIFT",
    parameter MULT_BYPASS = "DISABLED",
    parameter RESETMODE = "SYNC"
) (
    input  wire A0, A1, A2, A3, A4, A5, A6, A7, A8, A9, A10, A11, A12, A13, A14, A15, A16, A17,
    input  wire B0, B1, B2, B3, B4, B5, B6, B7, B8, B9, B10, B11, B12, B13, B14, B15, B16, B17,
    input  wire C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10, C11, C12, C13, C14, C15, C16, C17,
    input  wire SIGNEDA, SIGNEDB, SOURCEA, SOURCEB,
    input  wire CLK0, CLK1, CLK2, CLK3, CE0, CE1, CE2, CE3, RST0, RST1, RST2, RST3,
    output wire P0, P1, P2, P3, P4, P5, P6, P7, P8, P9, P10, P11, P12, P13, P14, P15, P16, P17, P18,
                P19, P20, P21, P22, P23, P24, P25, P26, P27, P28, P29, P30, P31, P32, P33, P34, P35
);

  generate
    if (REG_INPUTA_CLK != "CLK0" || REG_INPUTB_CLK != "CLK0" || REG_OUTPUT_CLK != "CLK0" || REG_INPUTC_CLK != "NONE"
        || REG_PIPELINE_CLK != "NONE") begin : gen_registers
      mult18x18d_model_has_input_and_output_registers_on_CLK0 u_error ();
    end
    if (REG_INPUTA_CE != "CE0" || REG_INPUTB_CE != "CE0" || REG_OUTPUT_CE != "CE0" || REG_INPUTA_RST != "RST0"
        || REG_INPUTB_RST != "RST0" || REG_OUTPUT_RST != "RST0") begin : gen_control
      mult18x18d_model_has_CE0_and_RST0 u_error ();
    end
    if (CLK0_DIV != "ENABLED" || HIGHSPEED_CLK != "NONE" || CAS_MATCH_REG != "FALSE" || MULT_BYPASS != "DISABLED"
        || SOURCEB_MODE != "B_SHIFT") begin : gen_mode
      mult18x18d_model_is_a_plain_multiplier u_error ();
    end
  endgenerate

  reg signed [18:0] a_q, b_q;
  reg signed [35:0] p_q;
  always @(posedge CLK0) begin
    a_q <= {SIGNEDA & A17, A17, A16, A15, A14, A13, A12, A11, A10, A9, A8, A7, A6, A5, A4, A3, A2, A1, A0};
    b_q <= {SIGNEDB & B17, B17, B16, B15, B14, B13, B12, B11, B10, B9, B8, B7, B6, B5, B4, B3, B2, B1, B0};
    p_q <= a_q * b_q;
  end
  assign {P35, P34, P33, P32, P31, P30, P29, P28, P27, P26, P25, P24, P23, P22, P21, P20, P19, P18, P17,
      P16, P15, P14, P13, P12, P11, P10, P9, P8, P7, P6, P5, P4, P3, P2, P1, P0} = p_q;

`ifndef YOSYS
  always @*
    if (SIGNEDA != SIGNEDB || SOURCEA || SOURCEB || !CE0 || RST0) begin
      $display("MULT18X18D %m: this model is signed or unsigned, always enabled, never reset, without shift chain");
      $finish;
    end
`endif

  wire unused = &{1'b0, CLK1, CLK2, CLK3, CE1, CE2, CE3, RST1, RST2, RST3, C0, C1, C2, C3, C4, C5, C6, C7, C8, C9, C10,
                  C11, C12, C13, C14, C15, C16, C17};

endmodule
`default_nettype wire
