# SPDX-License-Identifier: Apache-2.0
# Stand-in for quartus_sh -t: tclsh quartus_stubs.tcl SCRIPT [NAME=VALUE...]. Assignments as in the Quartus Prime Pro
# settings file manual (683296); a compilation checks those of its revision as the user guide Partial Reconfiguration
# (683834) wants them, and writes the files that it names.
source [file join [file dirname [info script]] stubs.tcl]
package provide ::quartus::project 7.0
set script [lindex $argv 0]
set quartus(args) [lrange $argv 1 end]
set argv {}

namespace eval state {
  variable global_names {FAMILY DEVICE TOP_LEVEL_ENTITY PROJECT_OUTPUT_DIRECTORY SEARCH_PATH VERILOG_MACRO VERILOG_FILE SDC_FILE
    GENERATE_PR_RBF_FILE ON_CHIP_BITSTREAM_DECOMPRESSION REVISION_TYPE}
  variable instance_names {PARTITION PARTIAL_RECONFIGURATION_PARTITION PLACE_REGION ROUTE_REGION RESERVE_PLACE_REGION
    RESERVE_ROUTE_REGION CORE_ONLY_PLACE_REGION REGION_NAME EXPORT_PARTITION_SNAPSHOT_FINAL QDB_FILE_PARTITION
    ENTITY_REBINDING RTL_PARAMETER VIRTUAL_PIN}
  variable project {}
  variable revision {}
  variable saved {}
  variable assigned {}
}

stub::command project_new {-overwrite} {-revision -family -part} 1 {
  stub::must {$state::project eq ""} {project_new: a project is open}
  set state::project [lindex $args 0]
  set state::revision [expr {[dict exists $opt -revision] ? [dict get $opt -revision] : $state::project}]
}
stub::command project_close {} {} 0 {
  stub::must {$state::project ne ""} {project_close: no project}
  stub::must {[dict get $state::saved $state::revision] eq $state::assigned} {project_close: assignments were not exported}
  set state::project {}
}
stub::command set_global_assignment {-remove} {-name -section_id} 1 {
  stub::must {$state::project ne ""} {set_global_assignment: no project}
  set name [dict get $opt -name]
  stub::must {$name in $state::global_names} {set_global_assignment: $name}
  if {$name in {VERILOG_FILE SDC_FILE}} {
    stub::exists $args
    dict lappend state::assigned $name [lindex $args 0]
    return
  }
  stub::must {$name ne "SEARCH_PATH" || [file isfile [lindex $args 0]/cchip_defs.vh]} {SEARCH_PATH: $args}
  stub::must {$name ne "REVISION_TYPE" || [lindex $args 0] in {PR_BASE PR_IMPL}} {REVISION_TYPE: $args}
  dict set state::assigned $name [lindex $args 0]
}
stub::command set_instance_assignment {-remove} {-name -to -entity} 1 {
  stub::must {$state::project ne ""} {set_instance_assignment: no project}
  set name [dict get $opt -name]
  stub::must {$name in $state::instance_names} {set_instance_assignment: $name}
  set to [dict get $opt -to]
  stub::must {$name eq "VIRTUAL_PIN" || $to in {u_region |}} {set_instance_assignment: no $to}
  if {[dict exists $opt -remove]} {
    stub::must {[dict exists $state::assigned "$name $to"]} {set_instance_assignment: $name is not set}
    dict unset state::assigned "$name $to"
  } else {
    dict set state::assigned "$name $to" [lindex $args 0]
  }
}
stub::command set_parameter {} {-name -to -entity} 1
stub::command export_assignments {} {} 0 {
  dict set state::saved $state::revision $state::assigned
}
stub::command create_revision {-set_current -copy_results} {-based_on} 1 {
  stub::must {![dict exists $state::saved [lindex $args 0]]} {create_revision: [lindex $args 0] exists}
  dict set state::saved [lindex $args 0] [dict get $state::saved [dict get $opt -based_on]]
}
stub::command set_current_revision {} {} 1 {
  stub::must {[dict get $state::saved $state::revision] eq $state::assigned} {set_current_revision: assignments were not exported}
  set state::revision [lindex $args 0]
  set state::assigned [dict get $state::saved $state::revision]
}

proc inside {inner outer} {
  set corners {^X(\d+) Y(\d+) X(\d+) Y(\d+)$}
  return [expr {[regexp $corners $inner -> l b r t] && [regexp $corners $outer -> ol ob or ot] &&
    $ol < $l && $ob < $b && $l < $r && $r < $or && $b < $t && $t < $ot}]
}

stub::command qexec {} {} 1 {
  stub::must {$state::project eq ""} {qexec: close the project first}
  stub::must {[regexp {^quartus_sh --flow compile (\w+) -c (\w+)$} [lindex $args 0] -> project revision]} {qexec: $args}
  stub::must {[dict exists $state::saved $revision]} {compile: no revision $revision}
  set a [dict get $state::saved $revision]
  set top [dict get $a TOP_LEVEL_ENTITY]
  set names [lmap file [dict get $a VERILOG_FILE] {file rootname [file tail $file]}]
  stub::must {$top in $names} {compile: no file of module $top}
  stub::must {[llength [lsort -unique $names]] == [llength $names]} {compile: a file twice}
  foreach file [dict get $a SDC_FILE] {
    stub::constrain $file $top
  }
  file mkdir [dict get $a PROJECT_OUTPUT_DIRECTORY]
  if {![dict exists $a REVISION_TYPE]} {
    return
  }
  foreach {name value} {PARTITION pr_region PARTIAL_RECONFIGURATION_PARTITION ON RESERVE_PLACE_REGION ON
      CORE_ONLY_PLACE_REGION ON RESERVE_ROUTE_REGION OFF} {
    stub::must {[dict get $a "$name u_region"] eq $value} {compile: $name of the partition is not $value}
  }
  stub::must {[inside [dict get $a "PLACE_REGION u_region"] [dict get $a "ROUTE_REGION u_region"]]} \
    {compile: the routing region must enclose the place region}
  stub::must {[regexp {^RM_ID=[0-3]$} [dict get $a "RTL_PARAMETER u_region"]]} {compile: no persona}
  if {[dict get $a REVISION_TYPE] eq "PR_BASE"} {
    stub::write [dict get $a "EXPORT_PARTITION_SNAPSHOT_FINAL |"] static
  } else {
    stub::must {![dict exists $a "EXPORT_PARTITION_SNAPSHOT_FINAL |"]} {compile: a persona must not export the static side}
    stub::must {[dict get $a "ENTITY_REBINDING u_region"] eq "cchip_pr_region"} {compile: ENTITY_REBINDING}
    stub::exists [list [dict get $a "QDB_FILE_PARTITION |"]]
  }
  if {[dict get $a GENERATE_PR_RBF_FILE] eq "ON"} {
    stub::write [dict get $a PROJECT_OUTPUT_DIRECTORY]/$revision.[dict get $a "PARTITION u_region"].rbf \
      [dict get $a "RTL_PARAMETER u_region"]
  }
}

source $script
stub::must {$state::project eq ""} {the script ends with an open project}
