# SPDX-License-Identifier: Apache-2.0
# Clock of a module that is synthesised out of context: 200 MHz.
create_clock -name clk -period 5.000 [get_ports clk]
