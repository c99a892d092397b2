# SPDX-License-Identifier: Apache-2.0
# Packages the exported chip (make export EXPORT_ARGS=cchip_chip) as an IP of Vivado: buses, clock, reset and interrupt
# from the attributes of its ports, the address block of its registers, the memory its master reaches, legal values of
# its parameters; ports and bus of swaps disappear where SWAPS is 0.
# NOT RUN BY THIS PROJECT: it has no Vivado. tests/vendor reads this file only.
#
#   vivado -mode batch -source scripts/vivado/package_ip.tcl [-tclargs NAME=VALUE...]
#     export=build/export/cchip_chip   folder that make export wrote
#     part=xc7k160tffg676-2            any part; the IP is for all 7 series, UltraScale and UltraScale+
#     out=build/vivado/ip              the IP is in out/cchip_chip: add `out` to ip_repo_paths
# Commands: UG1118 (packaging), options: `help ipx::COMMAND` in Vivado.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]

set top cchip_chip
set settings [cchip::settings {
  export build/export/cchip_chip
  part xc7k160tffg676-2
  out build/vivado/ip
} $argv]
dict with settings {}
set verilog [file join $export $top.v]
if {![file exists $verilog]} {
  error "$verilog is missing: make export EXPORT_ARGS=$top"
}
set out [file normalize $out]
file mkdir $out

# Legal values: {value...}, or {least to greatest}.
set parameters {
  QUERIES {2 4 8 16}
  STACK {8 16 32 64}
  CACHE_KB {4 8 16 32 64 128 256 512 1024}
  MISSES {4 8 16 32}
  LOCKS {1 to 4}
  COORD_W {4 to 20}
  PASSES {1 2}
  QUEUE_DEPTH {16 32 64 128 256}
  LEAF_NUMBERS {4 8 16 32 64 128 256}
  SLOTS {1 to 4}
  SWAPS {0 1}
  RM_ID {0 to 3}
  SLOT1_RM_ID {0 to 3}
  SLOT2_RM_ID {0 to 3}
  SLOT3_RM_ID {0 to 3}
  CFG_W {8 32}
  SIMULATION {0 1}
  DATA_W {128 256 512}
}

proc limit_parameter {core name values} {
  set parameter [ipx::get_user_parameters $name -of_objects $core]
  if {[lindex $values 1] eq "to"} {
    set_property value_validation_type range_long $parameter
    set_property value_validation_range_minimum [lindex $values 0] $parameter
    set_property value_validation_range_maximum [lindex $values 2] $parameter
  } else {
    set_property value_validation_type list $parameter
    set_property value_validation_list $values $parameter
  }
}

# The 4 KiB of registers behind s_axil. Vivado may have made a memory map of its own: it is replaced.
proc describe_registers {core} {
  foreach map [ipx::get_memory_maps -quiet -of_objects $core] {
    ipx::remove_memory_map [get_property name $map] $core
  }
  set map [ipx::add_memory_map s_axil $core]
  set_property slave_memory_map_ref s_axil [ipx::get_bus_interfaces s_axil -of_objects $core]
  set block [ipx::add_address_block registers $map]
  set_property usage register $block
  set_property base_address 0 $block
  set_property range 4096 $block
  set_property width 32 $block
}

# What a master reaches, log2 of bytes.
proc describe_space {core bus bits} {
  foreach space [ipx::get_address_spaces -quiet $bus -of_objects $core] {
    ipx::remove_address_space $bus $core
  }
  set space [ipx::add_address_space $bus $core]
  set_property range [expr {1 << $bits}] $space
  set_property master_address_space_ref $bus [ipx::get_bus_interfaces $bus -of_objects $core]
}

create_project -force package_$top [file join $out project] -part $part
add_files -norecurse [list $verilog]
set_property top $top [current_fileset]
update_compile_order -fileset sources_1
ipx::package_project -root_dir [file join $out $top] -vendor collisionchip -library ip -taxonomy /UserIP \
  -import_files -set_current true -force
set core [ipx::current_core]
set_property name $top $core
set_property version 1.0 $core
set_property display_name "Collision detection chip" $core
set_property description "Collision detection of triangle and quad meshes; queries and answers in memory" $core
set families {}
foreach family {artix7 kintex7 virtex7 zynq kintexu virtexu kintexuplus virtexuplus zynquplus} {
  lappend families $family Production
}
set_property supported_families $families $core

foreach bus {s_axil m_axi m_axi_cfg clk rst irq} {
  if {[ipx::get_bus_interfaces -quiet $bus -of_objects $core] eq ""} {
    error "$verilog has no interface $bus: was it written by make export?"
  }
}
dict for {name values} $parameters {
  limit_parameter $core $name $values
}
describe_registers $core
describe_space $core m_axi 38
describe_space $core m_axi_cfg 32

# swaps: m_axi_cfg and the configuration port
set with_swaps {spirit:decode(id('MODELPARAM_VALUE.SWAPS')) = 1}
set_property enablement_dependency $with_swaps [ipx::get_bus_interfaces m_axi_cfg -of_objects $core]
foreach port {cfg_valid cfg_data cfg_error} {
  set_property enablement_dependency $with_swaps [ipx::get_ports $port -of_objects $core]
}
foreach port {cfg_error m_axi_cfg_arready m_axi_cfg_rvalid m_axi_cfg_rdata m_axi_cfg_rresp m_axi_cfg_rlast} {
  set_property driver_value 0 [ipx::get_ports $port -of_objects $core]
}

set_property core_revision 1 $core
ipx::create_xgui_files $core
ipx::update_checksums $core
ipx::check_integrity $core
ipx::save_core $core
close_project
puts "cchip: IP in [file join $out $top]"
