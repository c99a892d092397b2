// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
// Models for simulation only, to be read after rtl/cchip.f: cchip_pr_slot with SIMULATION = 1 instantiates them.
cchip_pr_config_memory.v
cchip_pr_virtual.v
