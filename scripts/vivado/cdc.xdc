# SPDX-License-Identifier: Apache-2.0
# Clock crossings of cchip_chip_cdc, cchip_axi_cdc, cchip_axil_cdc: read it after the clocks are defined, with
# `read_xdc -unmanaged`, since it has loops. From the manuals, never run. It finds the cells
# of every cchip_synchroniser and of the memories of cchip_async_fifo wherever they are.
#   set_max_delay   a path into a synchroniser takes less than the period of the clock that sends, so a pointer that
#                   moves on is never seen twice as late as its next value
#   set_bus_skew    the bits of a Gray pointer arrive within a period of the clock that samples: no two changes at once
#   The memory's words are read two clocks after they were written: a period is enough.
foreach cell [get_cells -hierarchical -filter {ORIG_REF_NAME == cchip_synchroniser || REF_NAME == cchip_synchroniser}] {
  set pins [get_pins -of_objects [get_cells -hierarchical -filter "NAME =~ $cell/sync_q_reg*"] -filter {REF_PIN_NAME == D}]
  set from [all_fanin -flat -startpoints_only -only_cells $pins]
  set from [filter $from "NAME !~ $cell/*"]
  if {[llength $from] == 0} continue
  set sent [get_property -min PERIOD [get_clocks -of_objects $from]]
  set seen [get_property -min PERIOD [get_clocks -of_objects [get_pins -of_objects [get_cells -hierarchical -filter "NAME =~ $cell/sync_q_reg*"] -filter {REF_PIN_NAME == C}]]]
  set to [get_cells -hierarchical -filter "NAME =~ $cell/sync_q_reg*"]
  set_max_delay -datapath_only -from $from -to $to [expr {min($sent, $seen)}]
  if {[llength $from] > 1} { set_bus_skew -from $from -to $to [expr {min($sent, $seen)}] }
}
foreach cell [get_cells -hierarchical -filter {ORIG_REF_NAME =~ cchip_async_fifo* || REF_NAME =~ cchip_async_fifo*}] {
  set to [get_cells -quiet -hierarchical -filter "NAME =~ $cell/data_q_reg*"]
  set from [get_cells -quiet -hierarchical -filter "NAME =~ $cell/mem_reg*"]
  if {[llength $from] && [llength $to]} {
    set_max_delay -datapath_only -from $from -to $to [get_property -min PERIOD [get_clocks -of_objects $to]]
  }
}
