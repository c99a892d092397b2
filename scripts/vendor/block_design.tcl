# SPDX-License-Identifier: Apache-2.0
# What the block designs of scripts/vivado share: a project, cells, wires, the end. NOT RUN BY THIS PROJECT.

# A project with the packaged IP and an empty design.
proc begin_design {design part repository out} {
  set repository [file normalize $repository]
  if {![file exists [file join $repository cchip_chip component.xml]]} {
    error "repository=$repository: no cchip_chip/component.xml there, run scripts/vivado/package_ip.tcl"
  }
  set out [file normalize $out]
  file mkdir $out
  create_project -force $design [file join $out project] -part $part
  set_property ip_repo_paths [list $repository] [current_project]
  update_ip_catalog
  create_bd_design $design
}

# A cell of the newest version of an IP, with its settings.
proc cell {name ip args} {
  set found [get_ipdefs -all -filter "VLNV =~ *:$ip:* && UPGRADE_VERSIONS == \"\""]
  if {[llength $found] != 1} {
    error "$ip: [llength $found] versions in the catalogue"
  }
  create_bd_cell -type ip -vlnv $found $name
  if {[llength $args] > 0} {
    set_property -dict $args [get_bd_cells $name]
  }
}

# Joins two interface pins, or a pin and a port: a name without a cell.
proc bus {from to} {
  if {[string match */* $to]} {
    connect_bd_intf_net [get_bd_intf_pins $from] [get_bd_intf_pins $to]
  } else {
    connect_bd_intf_net [get_bd_intf_pins $from] [get_bd_intf_ports $to]
  }
}

# Joins a pin to others.
proc wire {from args} {
  foreach to $args {
    connect_bd_net [get_bd_pins $from] [get_bd_pins $to]
  }
}

# Joins a port of the design to a pin.
proc pin {port pin} {
  connect_bd_net [get_bd_ports $port] [get_bd_pins $pin]
}

# Checks the design, makes its wrapper the top, synthesises it if it should.
proc finish_design {design out synthesise} {
  validate_bd_design
  save_bd_design
  set file [get_files $design.bd]
  generate_target all $file
  add_files -norecurse [make_wrapper -files $file -top]
  set_property top ${design}_wrapper [current_fileset]
  update_compile_order -fileset sources_1
  if {$synthesise} {
    launch_runs synth_1 -jobs 2
    wait_on_run synth_1
    if {[get_property PROGRESS [get_runs synth_1]] ne "100%"} {
      error "synthesis has failed, see [file join $out project]"
    }
  }
  close_project
  puts "cchip: block design $design in [file join $out project]"
}
