// SPDX-License-Identifier: Apache-2.0
// Cells of the fabric that nextpnr's packer knows, as black boxes for Yosys.
(* blackbox *) module LUT1 (output O, input I0); parameter [1:0] INIT = 0; endmodule
(* blackbox *) module LUT2 (output O, input I0, I1); parameter [3:0] INIT = 0; endmodule
(* blackbox *) module LUT3 (output O, input I0, I1, I2); parameter [7:0] INIT = 0; endmodule
(* blackbox *) module LUT4 (output O, input I0, I1, I2, I3); parameter [15:0] INIT = 0; endmodule
(* blackbox *) module LUTFF (output O, input D, CLK); endmodule
(* blackbox *) module Global_Clock (output CLK); endmodule
(* blackbox *) module IO_1_bidirectional_frame_config_pass (output O, Q, input I, T, CLK); endmodule
(* blackbox *) module InPass4_frame_config_mux (output O0, O1, O2, O3, input CLK);
  parameter I0_reg = 0; parameter I1_reg = 0; parameter I2_reg = 0; parameter I3_reg = 0;
endmodule
(* blackbox *) module OutPass4_frame_config_mux (input I0, I1, I2, I3, CLK);
  parameter I0_reg = 0; parameter I1_reg = 0; parameter I2_reg = 0; parameter I3_reg = 0;
endmodule
