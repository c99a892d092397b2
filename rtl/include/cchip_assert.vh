// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// Immediate assertion, to be used as a statement in a clocked block:
//   always @(posedge clk) if (!rst) begin `CCHIP_ASSERT(a_no_overflow, !(push && full)) end
// With Verilator (--assert) and Yosys (-formal) it is an assertion, with Icarus a message that ends
// the run, in synthesis nothing.
`ifndef CCHIP_ASSERT_VH
`define CCHIP_ASSERT_VH
`ifdef VERILATOR
`define CCHIP_ASSERT(label, condition) label: assert (condition);
`else
`ifdef FORMAL
`define CCHIP_ASSERT(label, condition) label: assert (condition);
`else
`ifdef SYNTHESIS
`define CCHIP_ASSERT(label, condition)
`else
`define CCHIP_ASSERT(label, condition) \
  begin : label \
    if (!(condition)) begin $display("CCHIP_ASSERT failed: %m"); $finish; end \
  end
`endif
`endif
`endif
`endif
