# SPDX-License-Identifier: Apache-2.0
# Stand-in for Vivado's packager (UG1118) and its block designs (UG994): tclsh vivado_ip_stubs.tcl SCRIPT [NAME=VALUE...].
# An IP that is packaged has the interfaces that the attributes of its Verilog name; a block design joins what fits:
# master to slave, clock to clock, a reset to one of the same polarity, and validation misses nothing that is open.
source [file join [file dirname [info script]] stubs.tcl]
set argv [lassign $argv script]
namespace eval ipx {}
namespace eval stub::do_ipx {}
namespace eval state {
  variable project 0
  variable files {}
  variable repositories {}
  variable core {}        ;# name: dictionary of what was packaged
  variable properties {}  ;# of each object
  variable root {}
  variable catalogue 0
  variable pins {}        ;# of the block design: pin: {kind direction-or-mode net}
  variable segments {}
  variable assigned {}
  variable validated 0
}

proc property {object name {missing ""}} {
  if {[dict exists $state::properties $object $name]} {
    return [dict get $state::properties $object $name]
  }
  return $missing
}

# Legal names of properties, by kind of object: the word before the first colon.
set legal {
  core {name version display_name description supported_families core_revision}
  parameter {value_validation_type value_validation_list value_validation_range_minimum value_validation_range_maximum}
  interface {slave_memory_map_ref master_address_space_ref enablement_dependency}
  port {enablement_dependency driver_value}
  map {name} space {name range} block {name usage base_address range width}
  fileset {top} project {ip_repo_paths} bdport {CONFIG.POLARITY}
  cell {CONFIG.PRIM_IN_FREQ CONFIG.CLKOUT1_REQUESTED_OUT_FREQ CONFIG.C_EXT_RESET_HIGH CONFIG.NUM_SI CONFIG.NUM_MI
    CONFIG.DATA_W CONFIG.DATA_WIDTH CONFIG.SINGLE_PORT_BRAM}
}

stub::command set_property {} {-dict} 3 {
  set pairs [expr {[dict exists $opt -dict] ? [dict get $opt -dict] : [lrange $args 0 1]}]
  set object [lindex $args end]
  stub::must {$object ne ""} {set_property: no object for $pairs}
  set kind [lindex [split $object :] 0]
  foreach {name value} $pairs {
    stub::must {$name in [dict get $::legal $kind]} {set_property: $kind has no property $name}
    dict set state::properties $object $name $value
  }
}
stub::command get_property {} {} 2 {
  return [property [lindex $args 1] [lindex $args 0]]
}
stub::command create_project {-force -in_memory} {-part} 2 {
  stub::must {!$state::project} {create_project: a project is open}
  set state::project 1
  file mkdir [lindex $args 1]
}
stub::command close_project {} {} 0 {
  stub::must {$state::project} {close_project: nothing is open}
  set state::project 0
}
stub::command add_files {-norecurse} {-fileset} 1 {
  stub::exists [lindex $args 0]
  lappend state::files {*}[lindex $args 0]
}
stub::command current_fileset {} {} 0 {
  return fileset:sources_1
}
stub::command current_project {} {} 0 {
  return project:
}
stub::command update_compile_order {} {-fileset} 0 {
  set top [property fileset:sources_1 top]
  stub::must {$top in [lmap file $state::files {file rootname [file tail $file]}]} {update_compile_order: no file of $top}
}

# ---- packager

# Interfaces {name {mode type}}, ports and parameters of the Verilog of a top, from its attributes.
proc inferred {file top} {
  set text [stub::read $file]
  stub::must {[regexp -indices "\nmodule $top " $text at]} {package_project: no module $top in $file}
  set text [string range $text [lindex $at 0] end]
  set text [string range $text 0 [string first "\n);" $text]]
  set interfaces {}
  set ports {}
  set pattern {(?:\(\* X_INTERFACE_INFO = "(\S+) (\S+) (\S+)"[^\n]*\n *)?(input|output) +wire[^,\n]* (\w+)}
  foreach {- vlnv name signal direction port} [regexp -all -inline $pattern $text] {
    dict set ports $port $direction
    if {$vlnv ne ""} {
      set type [lindex [split $vlnv :] 2]
      set master [expr {$direction eq "output"}]
      if {$type eq "aximm" && $signal eq "ARREADY"} {
        set master [expr {!$master}]
      } elseif {$type eq "aximm" && $signal ne "ARVALID"} {
        continue
      }
      dict set interfaces $name [list [expr {$master ? "master" : "slave"}] $type]
    }
  }
  return [list interfaces $interfaces ports $ports parameters [lmap {- name} [regexp -all -inline {parameter integer (\w+)} $text] {set name}]]
}

# As Vivado does, a slave gets a memory map and a master an address space; a script may replace them.
stub::command ipx::package_project {-import_files -force} {-root_dir -vendor -library -taxonomy -set_current} 0 {
  set state::root [dict get $opt -root_dir]
  file mkdir $state::root
  set state::core [inferred [lindex $state::files 0] [property fileset:sources_1 top]]
  dict set state::core maps s_axil {reg0 {}}
  dict set state::core spaces {m_axi {} m_axi_cfg {}}
}
proc listed {kind key args} {
  set names [dict get $state::core $key]
  if {$key in {interfaces ports maps spaces}} {
    set names [dict keys $names]
  }
  set found [lmap name $names {expr {[llength $args] == 0 || $name eq [lindex $args 0] ? "$kind:$name" : [continue]}}]
  foreach object $found {
    dict set state::properties $object name [lindex [split $object :] 1]
  }
  return $found
}
stub::command ipx::current_core {} {} 0 {
  return core:
}
foreach {command kind key} {get_user_parameters parameter parameters get_bus_interfaces interface interfaces get_ports port ports
  get_memory_maps map maps get_address_spaces space spaces} {
  stub::command ipx::$command -quiet -of_objects 1 \
    "stub::must {\[dict get \$opt -of_objects\] eq {core:}} {ipx::$command: -of_objects}\nreturn \[listed $kind $key {*}\$args\]"
}
foreach {what kind} {memory_map maps address_space spaces} {
  stub::command ipx::remove_$what {} {} 2 "dict unset state::core $kind \[lindex \$args 0\]"
}
stub::command ipx::add_memory_map {} {} 2 {
  dict set state::core maps [lindex $args 0] {}
  return map:[lindex $args 0]
}
stub::command ipx::add_address_block {} {} 2 {
  lassign $args name map
  dict set state::core maps [lindex [split $map :] 1] $name {}
  return block:$name
}
stub::command ipx::add_address_space {} {} 2 {
  dict set state::core spaces [lindex $args 0] {}
  return space:[lindex $args 0]
}
stub::command ipx::create_xgui_files {} {} 1
stub::command ipx::update_checksums {} {} 1
stub::command ipx::check_integrity {} {} 1 {
  foreach property {name version display_name description supported_families core_revision} {
    stub::must {[property core: $property] ne ""} {check_integrity: no $property}
  }
  dict for {name value} [dict get $state::core interfaces] {
    lassign $value mode type
    if {$type eq "aximm" && $mode eq "slave"} {
      set map [property interface:$name slave_memory_map_ref]
      stub::must {[dict exists $state::core maps $map]} {check_integrity: $name has no memory map}
      foreach block [dict keys [dict get $state::core maps $map]] {
        foreach property {usage base_address range width} {
          stub::must {[property block:$block $property] ne ""} {check_integrity: block $block has no $property}
        }
      }
    } elseif {$type eq "aximm"} {
      set space [property interface:$name master_address_space_ref]
      stub::must {[dict exists $state::core spaces $space] && [property space:$space range] > 0} \
        {check_integrity: $name has no address space}
    }
  }
  dict set state::core checked 1
}
stub::command ipx::save_core {} {} 1 {
  stub::must {[dict exists $state::core checked]} {save_core: not checked}
  dict set state::core properties $state::properties
  stub::write [file join $state::root component.xml] $state::core
}

# ---- block design

# Interface pins (mode type) and pins (direction kind) of the vendor's IPs; rst is active high, rstn active low.
set vendor_ips {
  clk_wiz {clk_in1 {I clk} reset {I rst} clk_out1 {O clk} locked {O data}}
  proc_sys_reset {slowest_sync_clk {I clk} ext_reset_in {I rst} dcm_locked {I data} peripheral_reset {O rst}
    peripheral_aresetn {O rstn}}
  jtag_axi {M_AXI {master aximm} aclk {I clk} aresetn {I rstn}}
  smartconnect {aclk {I clk} aresetn {I rstn}}
  axi_bram_ctrl {S_AXI {slave aximm} BRAM_PORTA {master bram} s_axi_aclk {I clk} s_axi_aresetn {I rstn}}
  blk_mem_gen {BRAM_PORTA {slave bram}}
}
set interface_pins {aximm bram}

stub::command update_ip_catalog {-rebuild} {} 0 {
  foreach repository [property project: ip_repo_paths] {
    stub::exists [file join $repository cchip_chip component.xml]
    set state::core [stub::read [file join $repository cchip_chip component.xml]]
  }
  set state::catalogue 1
}
stub::command get_ipdefs -all -filter 0 {
  stub::must {$state::catalogue} {get_ipdefs: the catalogue does not hold the repository}
  stub::must {[regexp {^VLNV =~ \*:ip:(\w+):\* && UPGRADE_VERSIONS == ""$} [dict get $opt -filter] -> name]} {get_ipdefs: filter}
  if {$name eq "cchip_chip"} {
    return collisionchip:ip:$name:1.0
  }
  return [expr {[dict exists $::vendor_ips $name] ? "xilinx.com:ip:$name:1.0" : ""}]
}
stub::command create_bd_design {} {} 1 {
  stub::must {$state::project} {create_bd_design: no project}
}
proc add_pin {name kind} {
  stub::must {![dict exists $state::pins $name]} {$name is there twice}
  dict set state::pins $name $kind
}
stub::command create_bd_port {} {-dir -type -freq_hz -from -to} 1 {
  # inside the design a port that enters drives
  add_pin /[lindex $args 0] [list [expr {[dict get $opt -dir] eq "I" ? "O" : "I"}] \
    [string map {intr data} [dict get $opt -type]]]
}
stub::command get_bd_ports -quiet {} 1 {
  stub::must {[dict exists $state::pins /[lindex $args 0]]} {get_bd_ports: no port $args}
  return bdport:[lindex $args 0]
}
proc dependency {interface} {
  set saved [dict get $state::core properties]
  return [expr {[dict exists $saved interface:$interface enablement_dependency] ?
    [dict get $saved interface:$interface enablement_dependency] : ""}]
}
stub::command create_bd_cell {} {-type -vlnv} 1 {
  set cell [lindex $args 0]
  set name [lindex [split [dict get $opt -vlnv] :] 2]
  if {$name eq "cchip_chip"} {
    dict for {interface value} [dict get $state::core interfaces] {
      lassign $value mode type
      if {$type eq "aximm"} {
        # what SWAPS = 0 removes
        if {![string match {*SWAPS*= 1} [dependency $interface]]} {
          add_pin $cell/$interface $value
        }
      } else {
        add_pin $cell/$interface [dict get {clk {I clk} rst {I rst} irq {O data}} $interface]
      }
    }
  } else {
    dict for {pin kind} [dict get $::vendor_ips $name] {
      add_pin $cell/$pin $kind
    }
  }
  dict set state::properties cell:$cell ip $name
}
stub::command get_bd_cells -quiet {} 1 {
  stub::must {[dict exists $state::properties cell:[lindex $args 0]]} {get_bd_cells: no cell $args}
  return cell:[lindex $args 0]
}
# The pins of a SmartConnect are as many as its settings say.
proc expand_fabric {cell} {
  if {[property cell:$cell ip] eq "smartconnect" && ![dict exists $state::pins $cell/S00_AXI]} {
    foreach {letter setting mode} {S CONFIG.NUM_SI slave M CONFIG.NUM_MI master} {
      for {set i 0} {$i < [property cell:$cell $setting 1]} {incr i} {
        add_pin $cell/${letter}0${i}_AXI [list $mode aximm]
      }
    }
  }
}
stub::command get_bd_intf_pins -quiet {} 1 {
  set pin [lindex $args 0]
  expand_fabric [lindex [split $pin /] 0]
  stub::must {[dict exists $state::pins $pin] && [lindex [dict get $state::pins $pin] 1] in $::interface_pins} \
    {get_bd_intf_pins: no $pin}
  return $pin
}
stub::command get_bd_pins -quiet {} 1 {
  set pin [lindex $args 0]
  stub::must {[dict exists $state::pins $pin] && [lindex [dict get $state::pins $pin] 1] ni $::interface_pins} \
    {get_bd_pins: no $pin}
  return $pin
}
# One drives, the other is open; both are of one kind.
proc join_pins {command drives taken a b} {
  lassign [dict get $state::pins $a] from kind net
  lassign [dict get $state::pins $b] to other taken_by
  stub::must {$kind eq $other} {$command: $a is $kind, $b is $other}
  stub::must {$from eq $drives && $to eq $taken} {$command: $a is $from, $b is $to}
  stub::must {$taken_by eq ""} {$command: $b is joined to $taken_by}
  dict set state::pins $a [list $from $kind $b]
  dict set state::pins $b [list $to $other $a]
}
stub::command connect_bd_intf_net {} {-intf_net} 2 {
  lassign $args a b
  stub::must {[llength [dict get $state::pins $a]] == 2} {connect_bd_intf_net: $a is joined}
  join_pins connect_bd_intf_net master slave $a $b
}
stub::command connect_bd_net {} {-net} 2 {
  set found [lmap pin $args {regsub {^bdport:} $pin /}]
  if {[lindex [dict get $state::pins [lindex $found 0]] 0] eq "I"} {
    set found [lreverse $found]
  }
  join_pins connect_bd_net O I {*}$found
}
stub::command get_bd_addr_spaces -quiet {} 1 {
  stub::must {[regexp {^(\w+)/(\w+)$} [lindex $args 0] -> cell space]} {get_bd_addr_spaces: $args}
  stub::must {[property cell:$cell ip] eq "jtag_axi" && $space eq "Data" ||
    [property cell:$cell ip] eq "cchip_chip" && [dict exists $state::core spaces $space]} {get_bd_addr_spaces: no $args}
  return [lindex $args 0]
}
stub::command get_bd_addr_segs -quiet {} 1 {
  stub::must {[regexp {^(\w+)/(\w+)/(\w+)$} [lindex $args 0] -> cell bus segment]} {get_bd_addr_segs: $args}
  stub::must {[property cell:$cell ip] eq "axi_bram_ctrl" && $bus eq "S_AXI" && $segment eq "Mem0" ||
    [property cell:$cell ip] eq "cchip_chip" && [dict exists $state::core maps $bus $segment]} {get_bd_addr_segs: no $args}
  return [lindex $args 0]
}
stub::command assign_bd_address {-force} {-offset -range -target_address_space} 1 {
  set range [dict get $opt -range]
  stub::must {[dict get $opt -offset] % $range == 0 && ($range & ($range - 1)) == 0} {assign_bd_address: offset and range}
  lappend state::assigned [list [dict get $opt -target_address_space] [lindex $args 0]]
}
stub::command exclude_bd_addr_seg {} {-target_address_space} 1 {
  lappend state::assigned [list [dict get $opt -target_address_space] [lindex $args 0]]
}
stub::command validate_bd_design {-force} {} 0 {
  dict for {pin value} $state::pins {
    lassign $value mode kind net
    stub::must {$net ne "" || $mode eq "O"} {validate_bd_design: $pin is open}
  }
  # every master of the SmartConnect sees every slave of it, or the design says that it does not
  stub::must {[llength [lsort -unique $state::assigned]] == 4} {validate_bd_design: addresses $state::assigned}
  set state::validated 1
}
stub::command save_bd_design {} {} 0
stub::command get_files -quiet {} 1 {
  return $args
}
stub::command generate_target -force {} 2 {
  stub::must {$state::validated} {generate_target: the design is not valid}
}
stub::command make_wrapper {-top} -files 0 {
  set wrapper [file join [pwd] [file rootname [dict get $opt -files]]_wrapper.v]
  stub::write $wrapper {}
  return $wrapper
}
stub::command launch_runs {} -jobs 1
stub::command wait_on_run {} {} 1
stub::command get_runs {} {} 1 {
  set name run:[lindex $args 0]
  dict set state::properties $name PROGRESS 100%
  return $name
}

source $script
stub::must {!$state::project} {the script ends with an open project}
