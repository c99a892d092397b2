# SPDX-License-Identifier: Apache-2.0
# What the scripts for Vivado and Quartus share: where the files are, which personas there are, settings.
namespace eval cchip {
  variable root [file normalize [file join [file dirname [info script]] .. ..]]
}

# Absolute path of a file or folder of this repository.
proc cchip::path {name} {
  variable root
  return [file join $root $name]
}

# Lines of a text file.
proc cchip::lines {name} {
  set channel [open $name r]
  set text [read $channel]
  close $channel
  return [split $text "\n"]
}

# The Verilog files of rtl/cchip.f, in order.
proc cchip::rtl_files {} {
  set files {}
  foreach line [lines [path rtl/cchip.f]] {
    set line [string trim $line]
    if {[string match *.v $line] && ![string match //* $line]} {
      lappend files [path rtl/$line]
    }
  }
  return $files
}

proc cchip::static_file {} {
  return [path scripts/vendor/cchip_pr_static.v]
}

proc cchip::include_dir {} {
  return [path rtl/include]
}

# Personas of cchip_pr_region as a dictionary: name -> RM_ID (blank 0 tri_tri 1 ...), from the shared definitions.
proc cchip::personas {} {
  set found {}
  foreach line [lines [path rtl/include/cchip_defs.vh]] {
    if {[regexp {^`define CCHIP_RM_([A-Z_]+) 8'd(\d+)} $line -> name id]} {
      # cchip_pr_region holds the modules 0..3; the test of a point and a triangle has no place in it yet.
      if {$id <= 3} { dict set found [string tolower $name] $id }
    }
  }
  if {[dict size $found] == 0} {
    error "no CCHIP_RM_... in rtl/include/cchip_defs.vh: run scripts/gen_definitions.py"
  }
  return $found
}

# Settings as a dictionary: the defaults, changed by arguments NAME=VALUE.
proc cchip::settings {defaults arguments} {
  set result $defaults
  foreach argument $arguments {
    if {![regexp {^(\w+)=(.*)$} $argument -> name value] || ![dict exists $defaults $name]} {
      error "argument '$argument': expected NAME=VALUE with NAME one of: [dict keys $defaults]"
    }
    dict set result $name $value
  }
  return $result
}
