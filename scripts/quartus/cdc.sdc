# SPDX-License-Identifier: Apache-2.0
# Clock crossings of cchip_chip_cdc, cchip_axi_cdc, cchip_axil_cdc: read it after the clocks are defined. From the
# manuals, never run. limit: the # period of the fastest of the clocks, ns; set it before you read this file, or 3.333 (300 MHz) is taken.
# The net delay bounds the way into the first flip-flop of each cchip_synchroniser, and the skew that of the bits of a
# Gray pointer; the memory's words are read two clocks after they were written.
if {![info exists limit]} { set limit 3.333 }
set_false_path -to [get_registers {*cchip_synchroniser:*|sync_q[*]}] -from [get_registers {*_gray_q[*] *state_q[*] *sent_q *seen_q}]
set_net_delay -max $limit -from [get_registers {*_gray_q[*] *state_q[*] *sent_q *seen_q}] -to [get_registers {*cchip_synchroniser:*|sync_q[*]}]
set_max_skew -from [get_registers {*cchip_async_fifo:*|*_gray_q[*]}] -to [get_registers {*cchip_synchroniser:*|sync_q[*]}] $limit
set_false_path -from [get_registers {*cchip_async_fifo:*|mem*}] -to [get_registers {*cchip_async_fifo:*|data_q[*]}]
set_net_delay -max $limit -from [get_registers {*cchip_async_fifo:*|mem*}] -to [get_registers {*cchip_async_fifo:*|data_q[*]}]
