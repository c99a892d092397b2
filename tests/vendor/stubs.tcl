# SPDX-License-Identifier: Apache-2.0
# What the stand-ins for Vivado and Quartus share. A command is declared with its options as the manual lists them;
# a call with another option, without a value or with too many arguments is an error. Each call is a line of the log
# (environment VENDOR_LOG): command and arguments, separated by tabs.
namespace eval stub {
  variable log [open $::env(VENDOR_LOG) a]
}

# command NAME {-flag ...} {-option-with-value ...} most-arguments [body]: the body sees the arguments as `args` and
# the options as the dictionary `opt`: -flag 1, -option its last value.
proc stub::command {name flags valued most {body {}}} {
  proc ::stub::do_$name {opt args} $body
  proc ::$name {args} "stub::call [list $name $flags $valued $most] {*}\$args"
}

proc stub::call {name flags valued most args} {
  variable log
  puts $log [join [concat [list $name] $args] \t]
  flush $log
  set opt {}
  set rest {}
  while {[llength $args] > 0} {
    set args [lassign $args word]
    if {$word in $flags} {
      dict set opt $word 1
    } elseif {$word in $valued} {
      if {[llength $args] == 0} {
        error "$name: $word has no value"
      }
      set args [lassign $args value]
      dict set opt $word $value
    } elseif {[string match {-[a-z]*} $word]} {
      error "$name: no option $word"
    } else {
      lappend rest $word
    }
  }
  if {[llength $rest] > $most} {
    error "$name: more than $most arguments: $rest"
  }
  return [stub::do_$name $opt {*}$rest]
}

proc stub::must {condition message} {
  if {![uplevel 1 [list expr $condition]]} {
    error [uplevel 1 [list subst $message]]
  }
}

proc stub::exists {files} {
  foreach file $files {
    if {![file isfile $file]} {
      error "no file $file"
    }
  }
}

proc stub::write {file text} {
  if {![file isdirectory [file dirname $file]]} {
    error "no folder for $file"
  }
  set channel [open $file w]
  puts -nonewline $channel $text
  close $channel
}

proc stub::read {file} {
  exists [list $file]
  set channel [open $file]
  set text [::read $channel]
  close $channel
  return $text
}

# ---- timing constraints: the same commands in XDC and SDC. Every name must be a port of the design.
namespace eval stub {
  variable ports {}
}

proc stub::ports_of {top} {
  if {![dict exists $::env(VENDOR_PORTS) $top]} {
    error "no module $top"
  }
  return [dict get $::env(VENDOR_PORTS) $top]
}

stub::command get_ports {} {} 1 {
  foreach port [lindex $args 0] {
    if {$port ni $stub::ports} {
      error "get_ports: no port $port, there are: $stub::ports"
    }
  }
  return $args
}
stub::command create_clock {} {-name -period} 1 {
  stub::must {[dict exists $opt -period] && [llength $args] == 1} {create_clock: period and port}
}
stub::command derive_clock_uncertainty {} {} 0
stub::command set_false_path {} {-from -to} 0

proc stub::constrain {file top} {
  set stub::ports [ports_of $top]
  exists [list $file]
  uplevel #0 [list source $file]
}
