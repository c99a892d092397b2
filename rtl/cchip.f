// SPDX-License-Identifier: Apache-2.0 WITH SHL-2.1
common/cchip_delay.v
common/cchip_skid_buffer.v
common/cchip_fifo.v
common/cchip_ram.v
arith/cchip_mul18.v
arith/cchip_mul_wide.v
arith/cchip_dot3.v
arith/cchip_cross3.v
sat/cchip_sat_select.v
sat/cchip_sat_axis.v
sat/cchip_sat_project.v
sat/cchip_sat_compare.v
sat/cchip_sat_pipeline.v
sat/cchip_axis_controller.v
primtest/cchip_primtest_tri_tri.v
