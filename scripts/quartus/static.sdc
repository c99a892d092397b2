# SPDX-License-Identifier: Apache-2.0
# Timing of cchip_pr_static: 200 MHz inside; its pins are slow serial ones with a register each.
create_clock -name clk -period 5.000 [get_ports clk]
derive_clock_uncertainty
set_false_path -from [get_ports {rst decouple region_rst in_bit in_shift in_send out_take out_shift}]
set_false_path -to [get_ports out_bit]
