# SPDX-License-Identifier: Apache-2.0
# Partial reconfiguration with Vivado (Dynamic Function eXchange, non-project flow): static side cchip_pr_static with
# the partition u_region, every persona of cchip_pr_region in it and an empty one, full and partial bitstreams.
# NOT RUN BY THIS PROJECT: it has no Vivado. tests/vendor reads this file only; expect to adjust
# `regions` and the pins to your board.
#
#   vivado -mode batch -source scripts/vivado/dfx.tcl [-tclargs NAME=VALUE...]
#     part=xc7k160tffg676-2   7 series, UltraScale or UltraScale+
#     regions=X0Y1,X0Y2       clock regions, whole ones, that the partition fills: a column of the device
#     initial=quad_quad       persona of the first implementation, which places the static side: the largest one
#     pins=                   XDC with pins and I/O standards of the board; without it bitstreams are written for their
#                             sizes only: do not load them
#     out=build/vivado/dfx    folder of checkpoints, reports, bitstreams
# Commands and their order: UG909 (DFX), options: UG835.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]

set cell u_region
set module cchip_pr_region

set settings [cchip::settings {
  part xc7k160tffg676-2
  regions X0Y1,X0Y2
  initial quad_quad
  pins ""
  out build/vivado/dfx
} $argv]
dict with settings {}
set personas [cchip::personas]
if {![dict exists $personas $initial]} {
  error "initial=$initial: expected one of: [dict keys $personas]"
}
if {$pins ne "" && ![file exists $pins]} {
  error "pins=$pins: no such file"
}
file mkdir $out

proc in_out {name} {
  return [file join $::out $name]
}

# ---- synthesis

proc synthesise_persona {name id} {
  create_project -in_memory -part $::part
  read_verilog [cchip::rtl_files]
  read_xdc -mode out_of_context [cchip::path scripts/vivado/module.xdc]
  synth_design -top $::module -part $::part -mode out_of_context -flatten_hierarchy rebuilt \
    -include_dirs [cchip::include_dir] -generic RM_ID=$id
  write_checkpoint -force [in_out persona_$name.dcp]
  report_utilization -file [in_out persona_${name}_utilization.rpt]
  close_project
}

# The static side around an empty cell.
proc synthesise_static {} {
  create_project -in_memory -part $::part
  read_verilog [concat [cchip::rtl_files] [list [cchip::static_file]]]
  read_xdc [cchip::path scripts/vivado/static.xdc]
  if {$::pins ne ""} {
    read_xdc $::pins
  }
  synth_design -top cchip_pr_static -part $::part -flatten_hierarchy rebuilt \
    -include_dirs [cchip::include_dir] -verilog_define CCHIP_PR_BLACK_BOX
  write_checkpoint -force [in_out static_synth.dcp]
  close_project
}

# ---- floorplan

# "KIND_XaYb:KIND_XcYd" around all sites of a kind in the clock regions, "" if there are none.
proc site_range {kind} {
  set xs {}
  set ys {}
  set regions [get_clock_regions [split $::regions ,]]
  foreach site [get_sites -quiet -of_objects $regions -filter "NAME =~ ${kind}_X*Y*"] {
    if {[regexp {_X(\d+)Y(\d+)$} $site -> x y]} {
      lappend xs $x
      lappend ys $y
    }
  }
  if {[llength $xs] == 0} {
    return ""
  }
  set xs [lsort -integer $xs]
  set ys [lsort -integer $ys]
  return "${kind}_X[lindex $xs 0]Y[lindex $ys 0]:${kind}_X[lindex $xs end]Y[lindex $ys end]"
}

# Logic, multiplier blocks and memories of whole clock regions: all that a 7 series partition may hold.
proc floorplan {} {
  create_pblock pblock_region
  add_cells_to_pblock [get_pblocks pblock_region] [get_cells $::cell]
  foreach kind {SLICE DSP48 DSP48E2 RAMB18 RAMB36} {
    set range [site_range $kind]
    if {$range ne ""} {
      resize_pblock [get_pblocks pblock_region] -add $range
    }
  }
  # UltraScale and later always snap and always reset after reconfiguration; there both are left alone (UG909).
  if {[string match {x?7*} $::part]} {
    set_property SNAPPING_MODE ON [get_pblocks pblock_region]
    set_property RESET_AFTER_RECONFIG true [get_pblocks pblock_region]
  }
}

# ---- implementation

proc place_and_route {} {
  opt_design
  place_design
  phys_opt_design
  route_design
}

proc save {name} {
  write_checkpoint -force [in_out config_$name.dcp]
  report_timing_summary -file [in_out config_${name}_timing.rpt]
  report_utilization -pblocks [get_pblocks pblock_region] -file [in_out config_${name}_utilization.rpt]
}

# Places and routes static side and first persona, then locks the static side.
proc implement_first {name} {
  open_checkpoint [in_out static_synth.dcp]
  read_checkpoint -cell $::cell [in_out persona_$name.dcp]
  set_property HD.RECONFIGURABLE true [get_cells $::cell]
  floorplan
  report_drc -file [in_out floorplan_drc.rpt]
  place_and_route
  save $name
  update_design -cells $::cell -black_box
  lock_design -level routing
  write_checkpoint -force [in_out static_routed.dcp]
  close_project
}

proc implement_further {name} {
  open_checkpoint [in_out static_routed.dcp]
  read_checkpoint -cell $::cell [in_out persona_$name.dcp]
  place_and_route
  save $name
  close_project
}

# Nothing in the partition but a buffer per port.
proc implement_greybox {} {
  open_checkpoint [in_out static_routed.dcp]
  update_design -cells $::cell -buffer_ports
  place_design
  route_design
  save greybox
  close_project
}

# ---- check and bitstreams

# Static placement, static routing and partition pins are those of the first configuration in all others.
proc verify {first others} {
  set log [in_out pr_verify.log]
  set checkpoints {}
  foreach name $others {
    lappend checkpoints [in_out config_$name.dcp]
  }
  pr_verify -full_check -initial [in_out config_$first.dcp] -additional $checkpoints -file $log
  set compatible [llength [regexp -all -inline {are compatible} [join [cchip::lines $log] "\n"]]]
  if {$compatible != [llength $others]} {
    error "pr_verify calls $compatible of [llength $others] configurations compatible, see $log"
  }
}

# Full and partial bitstream, each with a .bin for a configuration controller.
proc write_bitstreams {name} {
  open_checkpoint [in_out config_$name.dcp]
  if {$::pins eq ""} {
    set_property SEVERITY {Warning} [get_drc_checks {NSTD-1 UCIO-1}]
  }
  write_bitstream -force -bin_file -no_partial_bitfile [in_out full_$name.bit]
  write_bitstream -force -bin_file -cell $::cell [in_out partial_$name.bit]
  close_project
}

dict for {name id} $personas {
  synthesise_persona $name $id
}
synthesise_static
implement_first $initial
set further {}
foreach name [dict keys $personas] {
  if {$name ne $initial} {
    implement_further $name
    lappend further $name
  }
}
implement_greybox
lappend further greybox
verify $initial $further
foreach name [concat $initial $further] {
  write_bitstreams $name
}
puts "cchip: [expr {[llength $further] + 1}] configurations in $out"
