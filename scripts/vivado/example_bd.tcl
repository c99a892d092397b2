# SPDX-License-Identifier: Apache-2.0
# A block design around the packaged IP, without a processor: JTAG writes registers and memory, the chip reads queries
# from a block RAM and writes records to it. For a board with DRAM put its memory controller in the place of `memory`,
# for a Zynq its processor in the place of `host`.
# NOT RUN BY THIS PROJECT: it has no Vivado. tests/vendor runs it with commands that only take notes.
#
#   vivado -mode batch -source scripts/vivado/package_ip.tcl
#   vivado -mode batch -source scripts/vivado/example_bd.tcl [-tclargs NAME=VALUE...]
#     part=xc7k160tffg676-2      as large a part as the chip needs
#     repository=build/vivado/ip folder that package_ip.tcl wrote
#     input_mhz=100  mhz=40      clock of the board at pin sys_clk, clock of everything
#     memory_kb=64               block RAM, at address 0
#     synthesise=0               1: synthesis, too
#     out=build/vivado/bd        folder of the project
# Registers: 0x44A00000, 4 KiB. Pins: sys_clk, sys_reset (active high), irq. Commands: UG994, options: UG835.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]
source [cchip::path scripts/vendor/block_design.tcl]

set design cchip_example
set settings [cchip::settings {
  part xc7k160tffg676-2
  repository build/vivado/ip
  input_mhz 100
  mhz 40
  memory_kb 64
  synthesise 0
  out build/vivado/bd
} $argv]
dict with settings {}
begin_design $design $part $repository $out

create_bd_port -dir I -type clk -freq_hz [expr {$input_mhz * 1000000}] sys_clk
create_bd_port -dir I -type rst sys_reset
set_property CONFIG.POLARITY ACTIVE_HIGH [get_bd_ports sys_reset]
create_bd_port -dir O -type intr irq

cell clock ip:clk_wiz CONFIG.PRIM_IN_FREQ $input_mhz CONFIG.CLKOUT1_REQUESTED_OUT_FREQ $mhz
cell reset ip:proc_sys_reset CONFIG.C_EXT_RESET_HIGH 1
cell host ip:jtag_axi
cell fabric ip:smartconnect CONFIG.NUM_SI 2 CONFIG.NUM_MI 2
cell chip ip:cchip_chip CONFIG.DATA_W 128
cell memory ip:axi_bram_ctrl CONFIG.DATA_WIDTH 128 CONFIG.SINGLE_PORT_BRAM 1
cell ram ip:blk_mem_gen

# buses: host and chip are masters, registers and memory are slaves
bus host/M_AXI fabric/S00_AXI
bus chip/m_axi fabric/S01_AXI
bus fabric/M00_AXI chip/s_axil
bus fabric/M01_AXI memory/S_AXI
bus memory/BRAM_PORTA ram/BRAM_PORTA

# one clock; the reset of the chip is active high and resets its buses, too
pin sys_clk clock/clk_in1
pin sys_reset clock/reset
pin sys_reset reset/ext_reset_in
wire clock/locked reset/dcm_locked
wire clock/clk_out1 reset/slowest_sync_clk host/aclk fabric/aclk chip/clk memory/s_axi_aclk
wire reset/peripheral_aresetn host/aresetn fabric/aresetn memory/s_axi_aresetn
wire reset/peripheral_reset chip/rst
pin irq chip/irq

# both masters see the memory at the same address; the chip does not see its own registers
foreach space {host/Data chip/m_axi} {
  assign_bd_address -offset 0x00000000 -range [expr {$memory_kb * 1024}] \
    -target_address_space [get_bd_addr_spaces $space] [get_bd_addr_segs memory/S_AXI/Mem0]
}
assign_bd_address -offset 0x44A00000 -range 4096 \
  -target_address_space [get_bd_addr_spaces host/Data] [get_bd_addr_segs chip/s_axil/registers]
exclude_bd_addr_seg -target_address_space [get_bd_addr_spaces chip/m_axi] [get_bd_addr_segs chip/s_axil/registers]

finish_design $design $out $synthesise
