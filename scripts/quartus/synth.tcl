# SPDX-License-Identifier: Apache-2.0
# Area and clock of one module with Quartus Prime Pro, without partial reconfiguration; ports are virtual pins.
# NOT RUN BY THIS PROJECT: it has no Quartus. tests/vendor reads this file only.
#
#   quartus_sh -t scripts/quartus/synth.tcl [NAME=VALUE...]
#     top=cchip_primtest_tri_tri        module of rtl/cchip.f; cchip_chip is the whole chip
#     family="Arria 10"  device=10AX115S2F45I1SG
#     parameters=                       as COORD_W=18,SUBSTAGES=12
#     out=build/quartus/synth           folder of the project
# Clock: scripts/quartus/module.sdc.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]
package require ::quartus::project

set settings [cchip::settings {
  top cchip_primtest_tri_tri
  family "Arria 10"
  device 10AX115S2F45I1SG
  parameters ""
  out build/quartus/synth
} [expr {[info exists quartus(args)] ? $quartus(args) : $argv}]]
dict with settings {}
file mkdir $out
cd $out

project_new $top -overwrite
set_global_assignment -name FAMILY $family
set_global_assignment -name DEVICE $device
set_global_assignment -name TOP_LEVEL_ENTITY $top
set_global_assignment -name PROJECT_OUTPUT_DIRECTORY output_files
set_global_assignment -name SEARCH_PATH [cchip::include_dir]
set_global_assignment -name VERILOG_MACRO SYNTHESIS=1
foreach file [cchip::rtl_files] {
  set_global_assignment -name VERILOG_FILE $file
}
set_global_assignment -name SDC_FILE [cchip::path scripts/quartus/module.sdc]
foreach parameter [split $parameters ,] {
  set_parameter -name {*}[split $parameter =]
}
foreach port {rst s_* m_* rm_id* idle irq cfg_*} {
  set_instance_assignment -name VIRTUAL_PIN ON -to $port
}
export_assignments
project_close
qexec "quartus_sh --flow compile $top -c $top"
