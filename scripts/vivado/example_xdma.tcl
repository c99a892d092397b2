# SPDX-License-Identifier: Apache-2.0
# A block design of a PCIe card around the packaged IP: XDMA is the host's way to the registers (user BAR) and to the
# memory on the card (DMA), and carries the interrupt. A block RAM stands for that memory: on a board, put its DRAM
# controller in the place of `memory` and `ram`. The driver is examples/chip_linux.c, see docs/hardware/uio.md.
# NOT RUN BY THIS PROJECT: it has no Vivado and no card. tests/vendor runs it with commands that only take notes.
#
#   vivado -mode batch -source scripts/vivado/package_ip.tcl
#   vivado -mode batch -source scripts/vivado/example_xdma.tcl [-tclargs NAME=VALUE...]
#     part=xc7k160tffg676-2      as large a part as the chip needs, with a PCIe block
#     repository=build/vivado/ip folder that package_ip.tcl wrote
#     width=X4  speed=5.0_GT/s   of the link
#     axi_mhz=125  mhz=40        clock of XDMA's side; of the chip, not above it: the interrupt falls for a clock
#     memory_kb=64               block RAM, at address 0
#     synthesise=0               1: synthesis, too
#     out=build/vivado/xdma      folder of the project
# Pins: pcie_refclk, pcie_perst_n, pcie_mgt; the board's constraints place them. IP: PG195, commands: UG835, UG994.
source [file join [file dirname [file normalize [info script]]] .. vendor common.tcl]
source [cchip::path scripts/vendor/block_design.tcl]

set design cchip_xdma
set settings [cchip::settings {
  part xc7k160tffg676-2
  repository build/vivado/ip
  width X4
  speed 5.0_GT/s
  axi_mhz 125
  mhz 40
  memory_kb 64
  synthesise 0
  out build/vivado/xdma
} $argv]
dict with settings {}
if {$mhz > $axi_mhz} {
  error "mhz=$mhz is above axi_mhz=$axi_mhz: XDMA would miss that the interrupt falls"
}
begin_design $design $part $repository $out
# our chain of flip-flops for the interrupt, from one clock into the other
add_files -norecurse [list [cchip::path rtl/common/cchip_synchroniser.v] [cchip::path rtl/include/cchip_assert.vh]]
set_property include_dirs [list [cchip::include_dir]] [current_fileset]
read_xdc -unmanaged [cchip::path scripts/vivado/cdc.xdc]

create_bd_intf_port -mode Slave -vlnv xilinx.com:interface:diff_clock_rtl:1.0 pcie_refclk
create_bd_intf_port -mode Master -vlnv xilinx.com:interface:pcie_7x_mgt_rtl:1.0 pcie_mgt
create_bd_port -dir I -type rst pcie_perst_n
set_property CONFIG.POLARITY ACTIVE_LOW [get_bd_ports pcie_perst_n]

cell refclk ip:util_ds_buf CONFIG.C_BUF_TYPE IBUFDSGTE
cell host ip:xdma CONFIG.mode_selection Advanced CONFIG.xdma_axi_intf_mm AXI_Memory_Mapped \
  CONFIG.pl_link_cap_max_link_width $width CONFIG.pl_link_cap_max_link_speed $speed \
  CONFIG.axi_data_width 128_bit CONFIG.axisten_freq $axi_mhz CONFIG.xdma_num_usr_irq 1 \
  CONFIG.axilite_master_en true CONFIG.axilite_master_size 4 CONFIG.axilite_master_scale Kilobytes \
  CONFIG.pf0_msi_enabled true CONFIG.cfg_mgmt_if false
cell clock ip:clk_wiz CONFIG.PRIM_SOURCE No_buffer CONFIG.PRIM_IN_FREQ $axi_mhz \
  CONFIG.CLKOUT1_REQUESTED_OUT_FREQ $mhz CONFIG.USE_RESET false
cell reset ip:proc_sys_reset CONFIG.C_EXT_RESET_HIGH 0
cell fabric ip:smartconnect CONFIG.NUM_SI 2 CONFIG.NUM_MI 1 CONFIG.NUM_CLKS 2
cell control ip:smartconnect CONFIG.NUM_SI 1 CONFIG.NUM_MI 1 CONFIG.NUM_CLKS 2
cell chip ip:cchip_chip CONFIG.DATA_W 128
cell memory ip:axi_bram_ctrl CONFIG.DATA_WIDTH 128 CONFIG.SINGLE_PORT_BRAM 1
cell ram ip:blk_mem_gen
create_bd_cell -type module -reference cchip_synchroniser interrupt

# buses
bus refclk/CLK_IN_D pcie_refclk
bus host/pcie_mgt pcie_mgt
bus host/M_AXI fabric/S00_AXI
bus chip/m_axi fabric/S01_AXI
bus fabric/M00_AXI memory/S_AXI
bus memory/BRAM_PORTA ram/BRAM_PORTA
bus host/M_AXI_LITE control/S00_AXI
bus control/M00_AXI chip/s_axil

# clocks and resets: aclk of a fabric is XDMA's, aclk1 the chip's. UltraScale buffers the reference clock twice.
if {[llength [get_bd_pins -quiet host/sys_clk_gt]] > 0} {
  wire refclk/IBUF_OUT host/sys_clk_gt
  wire refclk/IBUF_DS_ODIV2 host/sys_clk
} else {
  wire refclk/IBUF_OUT host/sys_clk
}
pin pcie_perst_n host/sys_rst_n
wire host/axi_aclk clock/clk_in1 fabric/aclk control/aclk interrupt/clk
wire clock/locked reset/dcm_locked
wire clock/clk_out1 reset/slowest_sync_clk fabric/aclk1 control/aclk1 chip/clk memory/s_axi_aclk
wire host/axi_aresetn reset/ext_reset_in fabric/aresetn control/aresetn
wire reset/peripheral_aresetn memory/s_axi_aresetn
wire reset/peripheral_reset chip/rst
wire chip/irq interrupt/d
wire interrupt/q host/usr_irq_req

# the card's memory at 0 for host and chip, the registers at 0 of the user BAR
foreach space {host/M_AXI chip/m_axi} {
  assign_bd_address -offset 0x00000000 -range [expr {$memory_kb * 1024}] \
    -target_address_space [get_bd_addr_spaces $space] [get_bd_addr_segs memory/S_AXI/Mem0]
}
assign_bd_address -offset 0x00000000 -range 4096 \
  -target_address_space [get_bd_addr_spaces host/M_AXI_LITE] [get_bd_addr_segs chip/s_axil/registers]

finish_design $design $out $synthesise
