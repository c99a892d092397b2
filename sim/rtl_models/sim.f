// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// For simulation only, to be read after rtl/cchip.f: what cchip_pr_slot with SIMULATION = 1 instantiates, the broad
// phase with an AXI4 master of its own, and rules of AXI4 (cchip_chip_rules.sv puts them beside the chip's masters,
// cchip_refit_axi_rules.sv beside those of cchip_refit_axi).
cchip_axi_rules.v
cchip_broad_phase_axi.v
cchip_pr_config_memory.v
cchip_pr_virtual.v
