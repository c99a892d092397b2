// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// Immediate assertion, to be used as a statement in a clocked block:
//   always @(posedge clk) if (!rst) begin `CCHIP_ASSERT(a_no_overflow, !(push && full)) end
// With Verilator (--assert) and Yosys (-formal) it is an assertion, with Icarus a message that ends
// the run with exit code 1, in synthesis nothing.
//
// CCHIP_NARROW(label, bits) asserts that a narrowing loses nothing: bits are the ones that are left
// out and the highest one that is kept, all of which must be copies of the sign.
// CCHIP_NARROW_UNSIGNED(label, bits): those that are left out of an unsigned number, all 0.
// Both are statements like CCHIP_ASSERT. Where only legal inputs keep the promise, a condition in
// front of them says so. scripts/widths.py bounds every narrowing, with and without an assertion.
//
// CCHIP_REFUSE(condition, error) refuses parameters. It belongs in the body of a module: where the
// condition holds, it instantiates a module that does not exist, named after the mistake, so that
// every tool stops at elaboration. Otherwise it is nothing.
//
// CCHIP_LUT_RAM stands before a small memory, which Vivado, Yosys and Quartus shall make of LUTs.
// For a family without such memories define it empty.
`ifndef CCHIP_ASSERT_VH
`define CCHIP_ASSERT_VH
`ifndef CCHIP_LUT_RAM
`define CCHIP_LUT_RAM (* ram_style = "distributed", ramstyle = "MLAB" *)
`endif
`define CCHIP_REFUSE(condition, error) if (condition) begin : error error u_error (); end
`define CCHIP_NARROW(label, bits) `CCHIP_ASSERT(label, (&(bits)) || !(|(bits)))
`define CCHIP_NARROW_UNSIGNED(label, bits) `CCHIP_ASSERT(label, !(|(bits)))
`ifdef VERILATOR
`define CCHIP_ASSERT(label, condition) label: assert (condition);
`else
`ifdef FORMAL
`define CCHIP_ASSERT(label, condition) label: assert (condition);
`else
`ifdef SYNTHESIS
`define CCHIP_ASSERT(label, condition)
`else
// $finish ends with exit code 0, which a script would take for a pass
`ifdef __ICARUS__
`define CCHIP_ASSERT_END $finish_and_return(1)
`else
`define CCHIP_ASSERT_END $finish
`endif
`define CCHIP_ASSERT(label, condition) \
  begin : label \
    if (!(condition)) begin $display("CCHIP_ASSERT failed: %m"); `CCHIP_ASSERT_END; end \
  end
`endif
`endif
`endif
`endif
