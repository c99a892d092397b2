# SPDX-License-Identifier: Apache-2.0
# Stand-in for Vivado: tclsh vivado_stubs.tcl SCRIPT [NAME=VALUE...]. Options as in UG835. A checkpoint is a file with
# the state of the design that it holds, so that commands out of order meet a state in which they are wrong (UG909).
source [file join [file dirname [info script]] stubs.tcl]
set argv [lassign $argv script]

namespace eval state {
  variable cell u_region
  variable design {}
  variable sources {}
  variable constraints {}
  variable verified 0
  variable routed_statics 0
  variable pblock {}
  variable part {}
}

proc need {args} {
  foreach {key values} $args {
    stub::must {[dict exists $state::design $key] && [dict get $state::design $key] in $values} \
      {design: $key is not one of: $values}
  }
}
proc become {args} {
  foreach {key value} $args {
    dict set state::design $key $value
  }
}

# ---- sources and synthesis
stub::command create_project {-in_memory -force} {-part} 2 {
  stub::must {$state::design eq ""} {create_project: the last design is still open}
  set state::design {stage empty}
  set state::sources {}
  set state::constraints {}
  set state::part [dict get $opt -part]
}
stub::command close_project {} {} 0 {
  stub::must {$state::design ne ""} {close_project: nothing is open}
  set state::design {}
}
stub::command read_verilog {-sv} {-library} 1 {
  need stage empty
  stub::exists [lindex $args 0]
  lappend state::sources {*}[lindex $args 0]
}
stub::command read_xdc {-unmanaged} {-mode -cells -ref} 1 {
  need stage empty
  stub::exists $args
  lappend state::constraints {*}$args
}
stub::command synth_design {-rtl -lint -no_lc -assert} {-top -part -mode -flatten_hierarchy -include_dirs
  -generic -verilog_define -directive -name -max_dsp} 0 {
  need stage empty
  set top [dict get $opt -top]
  set names [lmap file $state::sources {file rootname [file tail $file]}]
  stub::must {$top in $names} {synth_design: no file of module $top was read}
  foreach folder [dict get $opt -include_dirs] {
    stub::must {[file isfile $folder/cchip_defs.vh]} {synth_design: no cchip_defs.vh in $folder}
  }
  foreach file $state::constraints {
    stub::constrain $file $top
  }
  become stage synth top $top ooc [expr {[dict exists $opt -mode] && [dict get $opt -mode] eq "out_of_context"}]
  if {$top eq "cchip_pr_static"} {
    stub::must {"CCHIP_PR_BLACK_BOX" in [dict get $opt -verilog_define]} {synth_design: the cell is not empty}
    stub::must {![dict get $state::design ooc]} {synth_design: the static side needs its buffers}
    become content empty locked 0 pblock {} reconfigurable 0
  } elseif {$top eq "cchip_pr_region"} {
    stub::must {[dict get $state::design ooc]} {synth_design: a persona needs -mode out_of_context}
    stub::must {[regexp {^RM_ID=([0-3])$} [dict get $opt -generic] -> id]} {synth_design: no RM_ID}
    become content persona_$id
  }
}

# ---- checkpoints
stub::command write_checkpoint {-force} {-cell} 1 {
  need stage {synth opt placed routed}
  stub::write [lindex $args 0] $state::design
}
stub::command open_checkpoint {} {-part} 1 {
  stub::must {$state::design eq ""} {open_checkpoint: the last design is still open}
  set state::design [stub::read [lindex $args 0]]
}
stub::command read_checkpoint {-incremental} {-cell -directive} 1 {
  need content empty top cchip_pr_static
  stub::must {[dict get $opt -cell] eq $state::cell} {read_checkpoint: no cell [dict get $opt -cell]}
  set persona [stub::read [lindex $args 0]]
  stub::must {[dict get $persona top] eq "cchip_pr_region" && [dict get $persona ooc]} {read_checkpoint: not a persona}
  become content [dict get $persona content] stage synth
}

# ---- floorplan
stub::command get_cells {-hierarchical -quiet} {-filter} 1 {
  need top cchip_pr_static
  stub::must {[lindex $args 0] eq $state::cell} {get_cells: no cell $args}
  return $args
}
stub::command create_pblock {} {} 1 {
  set state::pblock [lindex $args 0]
  become pblock {}
}
stub::command get_pblocks {-quiet} {} 1 {
  stub::must {$args eq $state::pblock} {get_pblocks: no pblock $args}
  return $args
}
stub::command add_cells_to_pblock {} {} 2
stub::command resize_pblock {} {-add -remove} 1 {
  foreach range [dict get $opt -add] {
    stub::must {[regexp {^([A-Z0-9]+)_X\d+Y\d+:([A-Z0-9]+)_X\d+Y\d+$} $range -> from to] && $from eq $to} \
      {resize_pblock: $range is no range}
    dict set state::design pblock $from $range
  }
}
stub::command get_clock_regions {-quiet} {-filter} 1 {
  foreach region [lindex $args 0] {
    stub::must {[regexp {^X\d+Y\d+$} $region]} {get_clock_regions: $region}
  }
  return [lindex $args 0]
}
# a clock region of 10 x 50 slices, with a column of multiplier blocks and one of memories
stub::command get_sites {-quiet} {-of_objects -filter} 1 {
  stub::must {[regexp {^NAME =~ ([A-Z0-9]+)_X\*Y\*$} [dict get $opt -filter] -> kind]} {get_sites: filter}
  set shapes {SLICE {10 50} RAMB18 {1 20} RAMB36 {1 10}}
  dict set shapes [expr {[string match {xc7*} $state::part] ? "DSP48" : "DSP48E2"}] {1 20}
  set sites {}
  if {[dict exists $shapes $kind]} {
    lassign [dict get $shapes $kind] width height
    foreach region [dict get $opt -of_objects] {
      regexp {X(\d+)Y(\d+)} $region -> column row
      for {set x 0} {$x < $width} {incr x} {
        for {set y 0} {$y < $height} {incr y} {
          lappend sites ${kind}_X[expr {$column * $width + $x}]Y[expr {$row * $height + $y}]
        }
      }
    }
  }
  return $sites
}
stub::command set_property {} {-dict} 3 {
  lassign $args name value
  set legal {HD.RECONFIGURABLE {true} SNAPPING_MODE {ON OFF ROUTING NESTED} RESET_AFTER_RECONFIG {true false}
    SEVERITY {Warning}}
  stub::must {[dict exists $legal $name] && $value in [dict get $legal $name]} {set_property: $name $value}
  if {$name eq "HD.RECONFIGURABLE"} {
    stub::must {[lindex $args 2] eq $state::cell} {set_property: $name of [lindex $args 2]}
    become reconfigurable 1
  }
}
stub::command get_drc_checks {} {} 1

# ---- implementation
stub::command opt_design {} {-directive} 0 {
  need stage synth
  if {[dict get $state::design top] eq "cchip_pr_static"} {
    stub::must {[string match persona_* [dict get $state::design content]]} {opt_design: the cell is empty}
  }
  become stage opt
}
stub::command place_design {} {-directive} 0 {
  need stage opt
  if {[dict get $state::design top] eq "cchip_pr_static"} {
    need reconfigurable 1
    foreach kind {SLICE RAMB18 RAMB36} {
      stub::must {[dict exists $state::design pblock $kind]} {place_design: no $kind in the pblock}
    }
    stub::must {[llength [dict keys [dict get $state::design pblock] DSP48*]] == 1} {place_design: no multipliers}
  }
  become stage placed
}
stub::command phys_opt_design {} {-directive} 0 {
  need stage placed
}
stub::command route_design {} {-directive} 0 {
  need stage placed
  become stage routed
  if {[dict get $state::design top] eq "cchip_pr_static" && ![dict get $state::design locked]} {
    become static [incr state::routed_statics]
  }
}
stub::command update_design {-black_box -buffer_ports -strict} {-cells -from_file} 0 {
  stub::must {[dict get $opt -cells] eq $state::cell} {update_design: no cell}
  if {[dict exists $opt -black_box]} {
    need stage routed
    become content empty
  } elseif {[dict exists $opt -buffer_ports]} {
    need content empty
    become content greybox stage opt
  }
}
stub::command lock_design {-unlock} {-level} 1 {
  need content empty stage routed
  stub::must {[dict get $opt -level] eq "routing"} {lock_design: level [dict get $opt -level] is not routing}
  become locked 1
}

# ---- reports
foreach report {report_utilization report_timing_summary report_drc report_route_status} {
  stub::command $report {-hierarchical} {-file -pblocks -cells -max_paths} 0 {
    stub::write [dict get $opt -file] {}
  }
}

# ---- verification and bitstreams
stub::command pr_verify {-full_check -in_memory} {-initial -additional -file} 2 {
  set files [dict get $opt -additional]
  set initial [stub::read [dict get $opt -initial]]
  set text {}
  foreach file $files {
    set other [stub::read $file]
    stub::must {[dict get $other stage] eq "routed"} {pr_verify: $file is not routed}
    # environment VENDOR_INCOMPATIBLE: name of a checkpoint that does not fit
    set fits [expr {[dict get $other static] == [dict get $initial static] &&
      [file tail $file] ne $::env(VENDOR_INCOMPATIBLE)}]
    append text "PR_VERIFY: check points are [expr {$fits ? {} : {not }}]compatible\n"
  }
  stub::write [dict get $opt -file] [string map {"are not compatible" "differ"} $text]
  set state::verified 1
}
stub::command write_bitstream {-force -bin_file -no_partial_bitfile -raw_bitfile} {-cell -reference_bitfile} 1 {
  need stage routed top cchip_pr_static reconfigurable 1
  stub::must {$state::verified} {write_bitstream: nothing was verified}
  stub::must {[dict get $state::design content] ne "empty"} {write_bitstream: the cell is empty}
  stub::must {![dict exists $opt -cell] || ![dict exists $opt -no_partial_bitfile]} {write_bitstream: nothing to write}
  set name [lindex $args 0]
  stub::write $name [dict get $state::design content]
  if {[dict exists $opt -bin_file]} {
    stub::write [file rootname $name].bin [dict get $state::design content]
  }
}

source $script
stub::must {$state::design eq ""} {the script ends with an open design}
