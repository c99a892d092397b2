# SPDX-License-Identifier: Apache-2.0
# Partial reconfiguration with Quartus Prime Pro (Arria 10, Cyclone 10 GX, Stratix 10, Agilex): a base revision with
# the static side cchip_pr_static and one persona, an implementation revision per persona, an .rbf of each.
# NOT RUN BY THIS PROJECT: it has no Quartus. tests/vendor reads this file only; expect to adjust
# `place` and the pins to your device (Chip Planner).
#
#   quartus_sh -t scripts/quartus/pr.tcl [NAME=VALUE...]
#     family="Arria 10"  device=10AX115S2F45I1SG
#     place="X100 Y60 X149 Y139"   rectangle of the partition: left, bottom, right, top
#     initial=quad_quad            persona of the base revision, the largest one
#     pins=                        Tcl file with the pin assignments of the board
#     out=build/quartus/pr         folder of the project
# Assignments and flow: Quartus Prime Pro user guide Partial Reconfiguration (683834), steps 2 to 8; personas by
# RTL_PARAMETER ("method 2").
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]
package require ::quartus::project

set project cchip_pr
set instance u_region
set partition pr_region
set static_database ${project}_static.qdb

set settings [cchip::settings {
  family "Arria 10"
  device 10AX115S2F45I1SG
  place "X100 Y60 X149 Y139"
  initial quad_quad
  pins ""
  out build/quartus/pr
} [expr {[info exists quartus(args)] ? $quartus(args) : $argv}]]
dict with settings {}
set personas [cchip::personas]
if {![dict exists $personas $initial]} {
  error "initial=$initial: expected one of: [dict keys $personas]"
}
if {$pins ne ""} {
  set pins [file normalize $pins]
}
file mkdir $out
cd $out

# The rectangle with a margin for the routing of the partition.
proc widened {rectangle margin} {
  if {![regexp {^X(\d+) Y(\d+) X(\d+) Y(\d+)$} $rectangle -> left bottom right top]} {
    error "place=$rectangle: expected as \"X100 Y60 X149 Y139\""
  }
  return "X[expr {$left - $margin}] Y[expr {$bottom - $margin}] X[expr {$right + $margin}] Y[expr {$top + $margin}]"
}

proc assign_region {name value} {
  set_instance_assignment -name $name $value -to $::instance
}

# Persona of the current revision.
proc assign_persona {name} {
  set_instance_assignment -name RTL_PARAMETER "RM_ID=[dict get $::personas $name]" -to $::instance
}

proc compile {revision} {
  qexec "quartus_sh --flow compile $::project -c $revision"
}

# ---- base revision: static side, partition with its place, first persona
project_new $project -revision $project -overwrite
set_global_assignment -name FAMILY $family
set_global_assignment -name DEVICE $device
set_global_assignment -name TOP_LEVEL_ENTITY cchip_pr_static
set_global_assignment -name PROJECT_OUTPUT_DIRECTORY output_files
set_global_assignment -name SEARCH_PATH [cchip::include_dir]
set_global_assignment -name VERILOG_MACRO SYNTHESIS=1
foreach file [concat [cchip::rtl_files] [list [cchip::static_file]]] {
  set_global_assignment -name VERILOG_FILE $file
}
set_global_assignment -name SDC_FILE [cchip::path scripts/quartus/static.sdc]
set_global_assignment -name GENERATE_PR_RBF_FILE ON
set_global_assignment -name ON_CHIP_BITSTREAM_DECOMPRESSION OFF
if {$pins ne ""} {
  source $pins
}
set_global_assignment -name REVISION_TYPE PR_BASE
assign_region PARTITION $partition
assign_region PARTIAL_RECONFIGURATION_PARTITION ON
assign_region PLACE_REGION $place
assign_region RESERVE_PLACE_REGION ON
assign_region CORE_ONLY_PLACE_REGION ON
assign_region REGION_NAME $partition
assign_region ROUTE_REGION [widened $place 1]
assign_region RESERVE_ROUTE_REGION OFF
assign_persona $initial
set_instance_assignment -name EXPORT_PARTITION_SNAPSHOT_FINAL $static_database -to |
export_assignments

# ---- a revision per persona, on the routed static side
dict for {name id} $personas {
  create_revision ${project}_$name -based_on $project
  set_current_revision ${project}_$name
  set_global_assignment -name REVISION_TYPE PR_IMPL
  set_instance_assignment -name EXPORT_PARTITION_SNAPSHOT_FINAL $static_database -to | -remove
  set_instance_assignment -name QDB_FILE_PARTITION $static_database -to |
  assign_region ENTITY_REBINDING cchip_pr_region
  assign_persona $name
  export_assignments
  set_current_revision $project
}
project_close

# ---- compile: the base revision exports the static side that all others take
compile $project
if {![file exists $static_database]} {
  error "the base revision has not written $static_database"
}
foreach name [dict keys $personas] {
  compile ${project}_$name
  set bitstream [file join output_files ${project}_$name.$partition.rbf]
  if {![file exists $bitstream]} {
    error "revision ${project}_$name has not written $bitstream"
  }
}
puts "cchip: [dict size $personas] personas in $out/output_files"
