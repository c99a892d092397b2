# SPDX-License-Identifier: Apache-2.0
# Area and clock of one module with Vivado, without partial reconfiguration: out-of-context synthesis, place and route.
# NOT RUN BY THIS PROJECT: it has no Vivado. tests/vendor reads this file only.
#
#   vivado -mode batch -source scripts/vivado/synth.tcl [-tclargs NAME=VALUE...]
#     top=cchip_primtest_tri_tri   module of rtl/cchip.f; cchip_chip is the whole chip
#     part=xc7k160tffg676-2        any 7 series, UltraScale or UltraScale+ part
#     parameters=                  as COORD_W=18,SUBSTAGES=12
#     out=build/vivado/synth       folder of checkpoint and reports
# Clock: scripts/vivado/module.xdc. Commands as in UG835 and UG904.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]

set settings [cchip::settings {
  top cchip_primtest_tri_tri
  part xc7k160tffg676-2
  parameters ""
  out build/vivado/synth
} $argv]
dict with settings {}
file mkdir $out

set generics {}
foreach parameter [split $parameters ,] {
  lappend generics -generic $parameter
}

create_project -in_memory -part $part
read_verilog [cchip::rtl_files]
read_xdc -mode out_of_context [cchip::path scripts/vivado/module.xdc]
synth_design -top $top -part $part -mode out_of_context -include_dirs [cchip::include_dir] {*}$generics
opt_design
place_design
phys_opt_design
route_design
write_checkpoint -force [file join $out $top.dcp]
report_utilization -hierarchical -file [file join $out ${top}_utilization.rpt]
report_timing_summary -file [file join $out ${top}_timing.rpt]
close_project
