#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Illegal parameters stop elaboration with a readable name; legal corners elaborate without a word.

usage: test_elaboration.py Verilator|Icarus|Yosys|Names

Environment: VERILATOR, IVERILOG, YOSYS = commands (default: found on PATH)."""
import functools
import pathlib
import re
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests"))
from tools import run, tool  # noqa: E402

RTL = ROOT / "rtl"
LISTS = (RTL / "cchip.f", ROOT / "sim/rtl_models/sim.f")
FILES = [str(path.parent / line) for path in LISTS for line in path.read_text().splitlines() if line.endswith(".v")]
PATHS = {pathlib.Path(name).stem: name for name in FILES}
TOP = "cchip_primtest_tri_tri"
ARRAY = "cchip_primtest_array"
POINT = "cchip_primtest_point_tri"
QUADS = ("cchip_primtest_tri_quad", "cchip_primtest_quad_quad")


def smallest_substages(coord_w):
    """Three substages around a multiplication of coord_w + 1 by 2 coord_w + 2 bits: 2 clocks for one
    18x18 leaf and one per level of the adder tree over 1, 2, 3 or 6 leaves."""
    return 5 if coord_w <= 8 else 6 if coord_w <= 16 else 7 if coord_w == 17 else 8


COORD_W = "cchip_error_COORD_W_must_be_4_to_20"
TOO_SHORT = "cchip_error_SUBSTAGES_below_minimum_for_COORD_W"
TOO_LONG = "cchip_error_SUBSTAGES_above_32"
CONTEXTS = "cchip_error_CONTEXTS_must_be_1_to_256"
PROJECTION = "cchip_error_ABSOLUTE_PROJECTION_must_be_0_or_1"
WARPED = "cchip_error_WARPED_EXACT_must_be_0_or_1"
EXHAUSTIVE = "cchip_error_EXHAUSTIVE_must_be_0_or_1"
LANES = "cchip_error_LANES_must_be_1_to_16"
VERTS = "cchip_error_VERTS_must_be_3_3_or_3_4_or_4_4"
MUL_WIDE = "cchip_error_mul_wide_A_W_and_B_W_must_be_2_to_52"
DELAY = "cchip_error_delay_WIDTH_below_1_or_DEPTH_below_0_or_RESET_not_0_or_1"
MEMORY = "cchip_error_delay_MEMORY_needs_DEPTH_3_and_RESET_0"
ASYNC = "cchip_error_async_fifo_DEPTH_must_be_a_power_of_two_4_to_4096"
ASYNC_W = "cchip_error_async_fifo_WIDTH_below_1_or_STAGES_not_2_to_4"
SYNC = "cchip_error_synchroniser_WIDTH_below_1_or_STAGES_below_2"
LEVEL = "cchip_error_level_crossing_STAGES_not_2_to_4"
ICAP = "cchip_error_icap_FAMILY_must_be_7_or_8"
PAUSE = "cchip_error_icap_PAUSE_must_be_16_to_65535"
FIFO = "cchip_error_fifo_WIDTH_or_DEPTH_below_1"
SKID = "cchip_error_skid_buffer_WIDTH_below_1"
ROC = "cchip_error_ROC_CYCLES_must_be_1_to_32"
CFG_W = "cchip_error_CFG_W_must_be_8_or_32"
SLOT_ID = "cchip_error_SLOT_ID_must_be_0_to_255"
SIMULATION = "cchip_error_SIMULATION_must_be_0_or_1"
RM_ID = "cchip_error_RM_ID_must_be_0_to_4"
QUEUE = "cchip_error_QUEUE_DEPTH_must_be_a_power_of_two_16_to_1024"
DESCRIPTOR = "cchip_error_descriptor_WIDTH_must_be_1_to_80"
KINDS = "cchip_error_KINDS_must_be_1_to_4"
KINDS_3_4 = "cchip_error_KINDS_must_be_3_or_4"
PLACE = "cchip_error_PLACE_W_must_be_3_to_12"
TAKERS = "cchip_error_TAKERS_must_be_2_to_5"
CREDIT = "cchip_error_CREDIT_must_be_1_to_256"
ARBITER = "cchip_error_arbiter_N_must_be_1_to_32"
ONEHOT_MUX = "cchip_error_onehot_mux_N_must_be_1_to_32_and_WIDTH_at_least_1"
ONEHOT_INDEX = "cchip_error_onehot_index_N_must_be_1_to_64_and_fit_in_WIDTH_bit"
TIMEOUT = "cchip_error_timeout_DEFAULT_below_1"
COUNT = "cchip_error_count_LIMIT_must_be_1_to_65535"
MERGE = "cchip_error_stream_merge_SOURCES_not_1_to_8_or_WIDTH_below_1"
CRC = "cchip_error_crc32_DATA_W_must_be_a_multiple_of_8"
FETCH = "cchip_error_bitstream_fetch_FIFO_DEPTH_below_32"
READ = "cchip_error_axi_read_"
WRITE = "cchip_error_axi_write_"
RULES = "cchip_error_axi_rules_"
CACHE = "cchip_error_cache_"
SLOT_LIMIT = "cchip_error_SLOT_LIMIT_below_16"
POOL = "cchip_error_pool_COUNT_must_be_1_to_256_and_all_numbers_have_WIDTH_bit"
COUNT_W = "cchip_error_COUNT_W_must_be_1_to_16"
PORT = "cchip_error_config_port_CFG_W_must_be_8_or_32_and_CFG_DIVIDER_above_0"
SLOTS = "cchip_error_SLOTS_must_be_1_to_4"
SIGN = "cchip_error_SIGN_must_be_below_POINTS"
COMPARE = "cchip_error_compare_POINTS_must_be_3_to_5_and_OWN_1_or_2"
RAM = "cchip_error_ram_WIDTH_or_DEPTH_below_1_or_ADDR_W_too_small"
BLOCK_RAM = "cchip_error_block_ram_WIDTH_below_1_or_ADDR_W_not_3_to_16"
QUERIES = "cchip_error_bv_QUERIES_must_be_2_4_8_or_16"

# module, parameters, name in the message
ILLEGAL = [
    *((TOP, {"COORD_W": w, "SUBSTAGES": 12}, COORD_W) for w in (-1, 0, 3, 21)),
    *((TOP, {"COORD_W": w, "SUBSTAGES": smallest_substages(w) - 1}, TOO_SHORT) for w in (4, 8, 16, 17, 20)),
    *((module, {"COORD_W": 16, "SUBSTAGES": 5}, TOO_SHORT) for module in QUADS),
    *((TOP, {"SUBSTAGES": s, "CONTEXTS": 34}, TOO_SHORT) for s in (-1, 0)),
    (TOP, {"SUBSTAGES": 33, "CONTEXTS": 34}, TOO_LONG),
    *((TOP, {"CONTEXTS": n}, CONTEXTS) for n in (-1, 0, 257)),
    *((TOP, {"ABSOLUTE_PROJECTION": n}, PROJECTION) for n in (-1, 2)),
    *((module, {"WARPED_EXACT": n}, WARPED) for module in QUADS for n in (-1, 2)),
    ("cchip_primtest", {"VERTS_A": 4, "VERTS_B": 3}, VERTS),
    *((ARRAY, {"LANES": n}, LANES) for n in (-1, 0, 17)),
    (ARRAY, {"LANES": 2, "VERTS_A": 4, "VERTS_B": 3}, VERTS),
    *((ARRAY, {"LANES": 2, "CONTEXTS": n}, CONTEXTS) for n in (0, 257)),
    *(("cchip_sat_select", {"VERTS_A": a, "VERTS_B": b}, VERTS) for a, b in ((4, 3), (3, 5), (2, 3))),
    ("cchip_axis_controller", {"CONTEXTS": 0}, CONTEXTS),
    ("cchip_axis_controller", {"CONTEXTS": 257, "CONTEXT_W": 9}, CONTEXTS),
    ("cchip_axis_controller", {"CONTEXTS": 34, "CONTEXT_W": 5}, CONTEXTS),
    ("cchip_axis_controller", {"WARPED_EXACT": 2}, WARPED),
    *((module, {"EXHAUSTIVE": n}, EXHAUSTIVE)
      for module in ("cchip_axis_controller", "cchip_primtest") for n in (-1, 2)),
    *(("cchip_sat_axis", {"COORD_W": w, "SUBSTAGES": s}, TOO_SHORT) for w, s in ((8, 4), (16, 4), (18, 5))),
    *(("cchip_sat_project", {"COORD_W": w, "SUBSTAGES": smallest_substages(w) - 1}, TOO_SHORT) for w in (8, 17)),
    ("cchip_sat_project", {"ABSOLUTE_PROJECTION": 2}, PROJECTION),
    *(("cchip_sat_project", {"POINTS": 3, "SIGN": n}, SIGN) for n in (-1, 3)),
    ("cchip_sat_bound", {"SUBSTAGES": 4}, TOO_SHORT),
    *(("cchip_sat_compare", {"POINTS": n}, COMPARE) for n in (2, 6)),
    *(("cchip_sat_compare", {"OWN": n}, COMPARE) for n in (0, 3)),
    ("cchip_sat_pipeline", {"COORD_W": 16, "SUBSTAGES": 5}, TOO_SHORT),
    *((POINT, {"COORD_W": w}, COORD_W) for w in (3, 21)),
    *((POINT, {"CONTEXTS": n}, CONTEXTS) for n in (0, 257)),
    ("cchip_sat_pipeline", {"ABSOLUTE_PROJECTION": 2}, PROJECTION),
    *(("cchip_mul_wide", {"A_W": a, "B_W": b}, MUL_WIDE) for a, b in ((1, 18), (18, 1), (53, 18), (18, 53))),
    ("cchip_mul_wide", {"PRODUCT_REGS": -1}, MUL_WIDE),
    ("cchip_dot3", {"A_W": 17, "B_W": 53}, MUL_WIDE),
    ("cchip_cross3", {"E_W": 53}, MUL_WIDE),
    *(("cchip_async_fifo", {"DEPTH": n}, ASYNC) for n in (0, 2, 6, 8192)),
    *(("cchip_async_fifo", {name: n}, ASYNC_W) for name, n in (("WIDTH", 0), ("STAGES", 1), ("STAGES", 5))),
    ("cchip_apb_axil", {"ADDRESS_W": 0}, "cchip_error_apb_axil_ADDRESS_W_below_1"),
    ("cchip_synchroniser", {"WIDTH": 0}, SYNC),
    *(("cchip_icap", {"FAMILY": n}, ICAP) for n in (6, 9)),
    *(("cchip_icap", {"PAUSE": n}, PAUSE) for n in (15, 65536)),
    ("cchip_synchroniser", {"STAGES": 1}, SYNC),
    *(("cchip_level_crossing", {"STAGES": n}, LEVEL) for n in (1, 5)),
    ("cchip_delay", {"WIDTH": 0}, DELAY),
    ("cchip_delay", {"DEPTH": -1}, DELAY),
    ("cchip_delay", {"RESET": 2}, DELAY),
    ("cchip_delay", {"MEMORY": 1, "DEPTH": 2}, MEMORY),
    ("cchip_delay", {"MEMORY": 1, "DEPTH": 5, "RESET": 1}, MEMORY),
    ("cchip_delay", {"MEMORY": 2, "DEPTH": 5}, MEMORY),
    ("cchip_fifo", {"WIDTH": 0}, FIFO),
    ("cchip_fifo", {"DEPTH": 0}, FIFO),
    *(("cchip_skid_buffer", {"WIDTH": n}, SKID) for n in (-1, 0)),
    ("cchip_ram", {"WIDTH": 0}, RAM),
    ("cchip_ram", {"DEPTH": 0}, RAM),
    ("cchip_ram", {"DEPTH": 17, "ADDR_W": 4}, RAM),
    *(("cchip_ram", {"DEPTH": d, "ADDR_W": w}, "cchip_error_ram_ADDR_W_wider_than_needed")
      for d, w in ((16, 5), (32, 6), (1, 8))),
    *(("cchip_dual_ram", case, BLOCK_RAM.replace("block", "dual"))
      for case in ({"WIDTH": 0}, {"ADDR_W": 2}, {"ADDR_W": 17})),
    ("cchip_block_ram", {"WIDTH": 0}, BLOCK_RAM),
    ("cchip_block_ram", {"ADDR_W": 17}, BLOCK_RAM),
    *(("cchip_mul18", {"SIGNED": n}, "cchip_error_mul18_SIGNED_must_be_0_or_1") for n in (-1, 2)),
    ("cchip_block_ram", {"WORDS": 2}, "cchip_error_block_ram_WORDS_must_be_1_or_4"),
    *(("cchip_bv_unit", {"QUERIES": n}, QUERIES) for n in (3, 32)),
    *(("cchip_refit", {"LEVELS": n}, "cchip_error_refit_LEVELS_must_be_2_to_64") for n in (1, 65)),
    *(("cchip_refit", {"DATA_W": n}, "cchip_error_refit_DATA_W_must_be_64_128_256_or_512") for n in (32, 96, 1024)),
    ("cchip_refit_axi", {"LEVELS": 1}, "cchip_error_refit_LEVELS_must_be_2_to_64"),
    *(("cchip_refit_axi", {"DATA_W": n}, "cchip_error_refit_axi_DATA_W_must_be_64_128_256_or_512") for n in (96, 1024)),
    *(("cchip_get_data", {"QUERIES": n}, "cchip_error_get_data_QUERIES_must_be_2_4_8_or_16") for n in (3, 32)),
    *(("cchip_get_data", {"PAIRS": n}, "cchip_error_get_data_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together")
      for n in (0, 20, 120)),
    *(("cchip_get_data", {"LEAF_ROOM": n}, "cchip_error_get_data_LEAF_ROOM_must_be_1_2_or_3") for n in (0, 4)),
    *(("cchip_leaf_queue", {"QUERIES": n}, "cchip_error_leaf_queue_QUERIES_must_be_2_4_8_or_16") for n in (3, 32)),
    *(("cchip_leaf_queue", {"CREDIT": n}, "cchip_error_leaf_queue_CREDIT_must_be_1_to_65535") for n in (0, 65536)),
    *(("cchip_leaf_queue", {"DEPTH": n}, "cchip_error_leaf_queue_DEPTH_must_be_1_to_1024") for n in (0, 1025)),
    *(("cchip_traversal", case, "cchip_error_traversal_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together")
      for case in ({"PAIRS": 20, "LEAVES": 4}, {"LEAVES": 0}, {"PAIRS": 0, "LEAVES": 64}, {"PAIRS": 64, "LEAVES": 64})),
    ("cchip_broad_phase", {"PAIRS": 20, "LEAVES": 4},
     "cchip_error_traversal_PAIRS_and_LEAVES_must_be_8_16_32_or_64_together"),
    *(("cchip_broad_phase", {"CACHE_KB": n}, CACHE + "CACHE_KB_must_be_a_power_of_two_1_to_1024")
      for n in (0, 6, 2048)),
    *(("cchip_traversal", {"QUERIES": n}, "cchip_error_traversal_QUERIES_must_be_2_4_8_or_16") for n in (3, 32)),
    *(("cchip_traversal", case, "cchip_error_traversal_LEAF_DEPTH_must_be_over_PAIRS_to_128")
      for case in ({"LEAF_DEPTH": 48}, {"LEAF_DEPTH": 129})),
    *(("cchip_traversal", {"STACK": n}, "cchip_error_traversal_STACK_must_be_8_16_32_or_64") for n in (4, 12, 128)),
    ("cchip_bv_unit", {"TAG_W": 0}, "cchip_error_bv_unit_TAG_W_below_1"),
    *(("cchip_pr_region", {"RM_ID": n}, RM_ID) for n in (-1, 5)),
    *(("cchip_roc_generator", {"CYCLES": n}, ROC) for n in (0, 33)),
    *(("cchip_pr_config_memory", {"CFG_W": n}, CFG_W) for n in (16, 0)),
    *(("cchip_pr_config_memory", {"SLOT_ID": n}, SLOT_ID) for n in (-1, 256)),
    ("cchip_pr_config_memory", {"RM_ID": 4}, "cchip_error_RM_ID_must_be_0_to_KINDS"),
    ("cchip_pr_config_memory", {"KINDS": 5}, "cchip_error_memory_KINDS_must_be_3_or_4"),
    ("cchip_pr_slot", {"CFG_W": 16}, CFG_W),
    ("cchip_pr_slot", {"SLOT_ID": 256}, SLOT_ID),
    ("cchip_pr_slot", {"SIMULATION": 2}, SIMULATION),
    ("cchip_pr_slot", {"ROC_CYCLES": 0}, ROC),
    *(("cchip_onehot_mux", {"N": n}, ONEHOT_MUX) for n in (0, 33)),
    ("cchip_onehot_mux", {"WIDTH": 0}, ONEHOT_MUX),
    *(("cchip_onehot_index", {"N": n, "WIDTH": w}, ONEHOT_INDEX) for n, w in ((0, 2), (65, 7), (5, 2), (1, 0))),
    *(("cchip_arbiter", {"N": n}, ARBITER) for n in (0, 33)),
    *(("cchip_count", {"LIMIT": n}, COUNT) for n in (0, 65536)),
    ("cchip_timeout", {"DEFAULT": 0}, TIMEOUT),
    *(("cchip_pool", case, POOL) for case in ({"COUNT": 0}, {"COUNT": 257, "WIDTH": 9}, {"FIRST": 1}, {"WIDTH": 0})),
    *(("cchip_vertex_collector", {"COORD_W": n}, COORD_W) for n in (3, 21)),
    *(("cchip_descriptor_queues", {"DEPTH": n}, QUEUE) for n in (8, 24, 2048)),
    *(("cchip_descriptor_queues", {"WIDTH": n}, DESCRIPTOR) for n in (0, 81)),
    *(("cchip_descriptor_queues", {"KINDS": n}, KINDS) for n in (0, 5)),
    ("cchip_operand_memory", {"COORD_W": 3}, COORD_W),
    *(("cchip_operand_memory", {"PLACE_W": n}, PLACE) for n in (2, 13)),
    *(("cchip_dispatch_sequencer", {"TAKERS": n}, TAKERS) for n in (1, 6)),
    *(("cchip_dispatch_sequencer", {"KINDS": n}, KINDS) for n in (0, 5)),
    *((module, {"KINDS": n}, KINDS_3_4)
      for module in ("cchip_swap_scheduler", "cchip_swap_retry", "cchip_bitstream_table") for n in (2, 5)),
    *(("cchip_slots", {"KINDS": n}, "cchip_error_slots_KINDS_must_be_3_or_4") for n in (2, 5)),
    ("cchip_pr_slot", {"RM_ID": 4}, "cchip_error_slot_RM_ID_must_be_0_to_KINDS"),
    *(("cchip_counter_file", {"WIDE": n}, "cchip_error_WIDE_must_be_0_to_8") for n in (-1, 9)),
    *(("cchip_slot_ledger", {"CREDIT": n}, CREDIT) for n in (0, 257)),
    *((module, {"SLOTS": n}, SLOTS) for module in ("cchip_dispatcher", "cchip_swap_scheduler") for n in (0, 5)),
    *(("cchip_primtest_subsystem", {"SLOTS": n}, SLOTS) for n in (0, 5)),
    *(("cchip_bitstream_table", {"SLOTS": n}, SLOTS) for n in (0, 5)),
    *(("cchip_stream_merge", {"SOURCES": n}, MERGE) for n in (0, 9)),
    ("cchip_crc32", {"DATA_W": 12}, CRC),
    ("cchip_bitstream_fetch", {"FIFO_DEPTH": 31}, FETCH),
    *((module, {name: n}, f"cchip_error_{name}_must_be_0_to_{most}") for module, name, most in
      ((top, name, most) for top in ("cchip_chip", "cchip_refit_axi", "cchip_primtest_subsystem")
       for name, most in (("AXI_ARCACHE", 15), ("AXI_AWCACHE", 15), ("AXI_PROT", 7))
       if (top, name) != ("cchip_primtest_subsystem", "AXI_AWCACHE"))
      for n in (-1, most + 1)),
    *(("cchip_cache", {"CACHE_KB": n}, CACHE + "CACHE_KB_must_be_a_power_of_two_1_to_1024") for n in (0, 3, 2048)),
    *(("cchip_cache", {"PLACES": n}, CACHE + "PLACES_must_be_a_power_of_two_2_to_64") for n in (1, 12, 128)),
    *(("cchip_cache", {"MISSES": n}, CACHE + "MISSES_must_be_2_4_8_16_or_32") for n in (12, 64)),
    *(("cchip_cache", case, CACHE + "LINE_W_must_be_over_SET_W_to_58_and_LOCKS_1_to_4")
      for case in ({"LINE_W": 10}, {"LINE_W": 59}, {"LOCKS": 0}, {"LOCKS": 5})),
    *(("cchip_cache_fill", {"MISSES": n}, CACHE + "fill_MISSES_must_be_2_4_8_16_or_32_and_FRAME_W_positive")
      for n in (3, 64)),
    *(("cchip_cache_fill", {"DATA_W": n}, CACHE + "fill_DATA_W_must_be_64_128_256_or_512") for n in (32, 96, 1024)),
    *(("cchip_axi_read", {"CLIENTS": n}, READ + "CLIENTS_must_be_1_to_8") for n in (0, 9)),
    *(("cchip_axi_read", {"SLOTS": n}, READ + "SLOTS_must_be_2_4_8_16_or_32") for n in (1, 3, 64)),
    *(("cchip_axi_read", {"DATA_W": n}, READ + "DATA_W_must_be_64_128_256_or_512") for n in (32, 96, 1024)),
    *(("cchip_axi_write", {"CLIENTS": n}, WRITE + "CLIENTS_must_be_1_to_4") for n in (0, 5)),
    *(("cchip_axi_write", {"DATA_W": n}, WRITE + "DATA_W_must_be_64_128_256_or_512") for n in (32, 96, 1024)),
    *(("cchip_axi_write", {"OUTSTANDING": n}, WRITE + "OUTSTANDING_must_be_1_to_64") for n in (0, 65)),
    *(("cchip_axi_rules", {"READS": n}, RULES + "READS_must_be_0_to_2") for n in (-1, 3)),
    ("cchip_axi_rules", {"WRITES": -1}, RULES + "WRITES_or_AHEAD_too_small"),
    ("cchip_axi_rules", {"AHEAD": 0}, RULES + "WRITES_or_AHEAD_too_small"),
    *(("cchip_axi_rules", {"BOUNDARY": n}, RULES + "BOUNDARY_must_be_a_power_of_2_above_a_beat_to_4096")
      for n in (16, 96, 8192)),
    *(("cchip_axi_write", {"ID_W": n}, WRITE + "ID_W_must_be_1_to_16") for n in (0, 17)),
    *(("cchip_round_shift", case, "cchip_error_round_shift_D_W_must_be_2_to_64_and_BASE_below_it")
      for case in ({"D_W": 1, "BASE": 0, "Q_W": 1}, {"D_W": 65}, {"D_W": 29, "Q_W": 1})),
    *(("cchip_round_shift", {"SHIFT_MAX": n}, "cchip_error_round_shift_SHIFT_MAX_must_be_2_to_63") for n in (1, 64)),
    *(("cchip_round_shift", {"Q_W": n}, "cchip_error_round_shift_Q_W_must_be_1_to_D_W_minus_BASE_plus_1")
      for n in (0, 29)),
    *((module, {"PASSES": n}, "cchip_error_PASSES_must_be_1_or_2")
      for module in ("cchip_vertex_transform", "cchip_normaliser", "cchip_transform") for n in (0, 3)),
    *(("cchip_normaliser", {"COORD_W": n}, COORD_W) for n in (3, 21)),
    *(("cchip_transform", {"CREDIT": n}, "cchip_error_transform_CREDIT_must_be_4_to_4096") for n in (3, 4097)),
    ("cchip_transform", {"ID_W": 0}, "cchip_error_transform_ID_W_below_1"),
    *(("cchip_leaf_feed", case, "cchip_error_leaf_feed_QUERIES_must_be_2_4_8_or_16_and_LEAF_W_positive")
      for case in ({"QUERIES": 3}, {"QUERIES": 32}, {"LEAF_W": 0})),
    *(("cchip_query_ring", case, "cchip_error_query_ring_AHEAD_must_be_2_4_or_8_and_SLOTS_a_power_of_two_AHEAD_to_32")
      for case in ({"AHEAD": 3}, {"AHEAD": 16}, {"SLOTS": 2}, {"SLOTS": 64})),
    *(("cchip_query_ring", {"DATA_W": n}, "cchip_error_query_ring_DATA_W_must_be_64_128_256_or_512")
      for n in (32, 1024)),
    *(("cchip_record_ring", {"DATA_W": n}, "cchip_error_record_ring_DATA_W_must_be_128_256_or_512")
      for n in (64, 1024)),
    *(("cchip_calc_result", {"LEAVES": n}, "cchip_error_calc_result_LEAVES_must_be_a_power_of_two_4_to_256")
      for n in (2, 48, 512)),
    *(("cchip_calc_result", case, "cchip_error_calc_result_JUDGED_must_be_2_to_64_and_CONTEXT_W_positive")
      for case in ({"JUDGED": 1}, {"JUDGED": 65}, {"CONTEXT_W": 0})),
    *(("cchip_soft_reset", {"CLOCKS": n}, "cchip_error_soft_reset_CLOCKS_must_be_2_to_256") for n in (1, 257)),
    *(("cchip_slots", {"SWAPS": n}, "cchip_error_slots_SWAPS_must_be_0_or_1") for n in (-1, 2)),
    *(("cchip_swaps", {"SWAPS": n}, "cchip_error_swaps_SWAPS_must_be_0_or_1") for n in (-1, 2)),
    ("cchip_chip_core", {"MISSES": 2}, "cchip_error_chip_core_MISSES_must_be_4_8_16_or_32"),
    ("cchip_chip_core", {"RM_ID": 0}, "cchip_error_chip_core_RM_ID_must_be_1_to_3"),
    ("cchip_chip_core", {"QUEUE_DEPTH": 512}, "cchip_error_chip_core_QUEUE_DEPTH_must_be_a_power_of_two_16_to_256"),
    ("cchip_swap_sequencer", {"SLOTS": 5}, SLOTS),
    ("cchip_swap_retry", {"SLOTS": 0}, SLOTS),
    ("cchip_swap_retry", {"SLOTS": 5}, SLOTS),
    ("cchip_swap_sequencer", {"SLOT_LIMIT": 15}, SLOT_LIMIT),
    ("cchip_swap_scheduler", {"COUNT_W": 17}, COUNT_W),
    ("cchip_config_port", {"CFG_W": 16}, PORT),
    ("cchip_config_port", {"CFG_DIVIDER": 0}, PORT),
]

# Modules that take a multiplier leaf of two clocks only. It is a macro of the command line, not a parameter.
LEAF_LATENCY = "CCHIP_MUL18_LATENCY"
ILLEGAL += [(f"cchip_{module}", {LEAF_LATENCY: n}, f"cchip_error_{module}_needs_{LEAF_LATENCY}_2")
            for module in ("mul18", "bv_offset", "bv_lane_a", "vertex_transform") for n in (1, 3)]

# module, parameters
LEGAL = [
    *((TOP, {"COORD_W": w, "SUBSTAGES": smallest_substages(w), "ABSOLUTE_PROJECTION": absolute})
      for w, absolute in ((4, 0), (8, 1), (16, 0), (17, 1), (18, 0), (20, 1))),
    *((module, {"COORD_W": w, "SUBSTAGES": smallest_substages(w), "WARPED_EXACT": exact})
      for module in QUADS for w, exact in ((4, 0), (20, 1))),
    (TOP, {"COORD_W": 20, "SUBSTAGES": 32}),
    (QUADS[1], {"COORD_W": 4, "SUBSTAGES": 32, "ABSOLUTE_PROJECTION": 1}),
    *((TOP, {"CONTEXTS": n}) for n in (1, 2, 5, 256)),
    *((module, {}) for module in (TOP, *QUADS, POINT, "cchip_primtest_blank")),
    *((POINT, {"COORD_W": w, "CONTEXTS": n}) for w, n in ((4, 1), (17, 2), (20, 256))),
    *((ARRAY, {"LANES": lanes, "CONTEXTS": contexts, "COORD_W": 4, "SUBSTAGES": smallest_substages(4)})
      for lanes, contexts in ((1, 1), (2, 5), (16, 256))),
    (ARRAY, {"LANES": 3, "VERTS_A": 4, "VERTS_B": 4, "ABSOLUTE_PROJECTION": 1, "WARPED_EXACT": 0}),
    *((f"cchip_axis_{part}", {"VERTS_A": a, "VERTS_B": b, "WARPED_EXACT": exact})
      for part in ("programme", "controller") for a, b, exact in ((3, 3, 1), (3, 4, 0), (4, 4, 1))),
    *((f"cchip_axis_{part}", {"VERTS_A": a, "VERTS_B": b, "EXHAUSTIVE": 0})
      for part in ("programme", "controller") for a, b in ((3, 3), (4, 4))),
    ("cchip_axis_controller", {"CONTEXTS": 1, "CONTEXT_W": 1}),
    ("cchip_axis_controller", {"CONTEXTS": 256, "CONTEXT_W": 8}),
    ("cchip_mul_wide", {"A_W": 2, "B_W": 2}),
    ("cchip_mul_wide", {"A_W": 52, "B_W": 52, "PRODUCT_REGS": 3}),
    ("cchip_delay", {"DEPTH": 0, "RESET": 1}),
    *(("cchip_delay", {"DEPTH": n, "MEMORY": 1}) for n in (3, 4, 20)),
    *(("cchip_fifo", {"DEPTH": n}) for n in (1, 512, 513, 1024)),
    *(("cchip_onehot_mux", {"N": n, "WIDTH": w}) for n, w in ((1, 1), (32, 8))),
    *(("cchip_onehot_index", {"N": n, "WIDTH": w}) for n, w in ((1, 1), (4, 2), (64, 6))),
    *(("cchip_arbiter", {"N": n}) for n in (1, 32)),
    ("cchip_cache", {"CACHE_KB": 1, "PLACES": 2, "MISSES": 2, "LINE_W": 4, "LOCKS": 1, "DATA_W": 512}),
    *(("cchip_cache_fill", {"MISSES": n, "FRAME_W": 1, "DATA_W": w}) for n, w in ((2, 64), (32, 256))),
    *((module, {"AXI_ARCACHE": 15, "AXI_PROT": n}) for module in ("cchip_refit_axi", "cchip_primtest_subsystem")
      for n in (2, 7)),
    *(("cchip_axi_read", {"CLIENTS": c, "SLOTS": s, "DATA_W": w}) for c, s, w in ((1, 2, 512), (8, 32, 64))),
    *(("cchip_axi_write", {"CLIENTS": c, "DATA_W": w, "OUTSTANDING": o, "ID_W": i})
      for c, w, o, i in ((1, 512, 1, 1), (4, 64, 64, 16))),
    *(("cchip_count", {"LIMIT": n}) for n in (1, 65535)),
    *(("cchip_timeout", {"DEFAULT": n}) for n in (1, 2147483647)),
    *(("cchip_leaf_feed", {"QUERIES": q, "LEAF_W": w}) for q, w in ((2, 1), (16, 8))),
    *(("cchip_query_ring", {"SLOTS": s, "AHEAD": a, "DATA_W": w}) for s, a, w in ((2, 2, 512), (32, 8, 64))),
    *(("cchip_record_ring", {"DATA_W": w}) for w in (256, 512)),
    *(("cchip_calc_result", {"LEAVES": n, "CONTEXT_W": c, "JUDGED": j}) for n, c, j in ((4, 1, 2), (256, 4, 64))),
    *(("cchip_soft_reset", {"CLOCKS": n}) for n in (2, 19, 256)),
    *(("cchip_pool", {"FIRST": f, "COUNT": n, "WIDTH": w}) for f, n, w in ((0, 1, 1), (0, 256, 8), (48, 16, 6))),
    *(("cchip_vertex_collector", {"COORD_W": n}) for n in (4, 20)),
    *(("cchip_descriptor_queues", {"DEPTH": d, "KINDS": k, "WIDTH": w})
      for d, k, w in ((16, 1, 1), (1024, 3, 80), (32, 4, 22))),
    *(("cchip_operand_memory", {"COORD_W": w, "PLACE_W": p}) for w, p in ((4, 3), (20, 12))),
    *(("cchip_dispatch_sequencer", {"TAKERS": t, "KINDS": k}) for t, k in ((2, 1), (5, 3), (5, 4))),
    *(("cchip_slot_ledger", {"CREDIT": n}) for n in (1, 256)),
    *(("cchip_dispatcher", {"SLOTS": s, "KINDS": k, "CREDIT": c}) for s, k, c in ((1, 1, 1), (4, 3, 256))),
    *((module, {"SLOTS": n}) for module in ("cchip_swap_scheduler", "cchip_bitstream_table") for n in (1, 4)),
    *(("cchip_primtest_subsystem", {"SLOTS": n}) for n in (1, 3, 4)),
    ("cchip_chip", {"SWAPS": 1, "SLOTS": 2, "RM_ID": 0}),
    ("cchip_chip", {"MISSES": 4}),
    *(("cchip_slots", {"SLOTS": n, "SWAPS": s}) for n, s in ((1, 1), (2, 0), (4, 0))),
    *(("cchip_swaps", {"SLOTS": n, "SWAPS": s}) for n, s in ((1, 0), (4, 1))),
    *(("cchip_stream_merge", {"SOURCES": n}) for n in (1, 8)),
    ("cchip_fifo", {"WIDTH": 1, "DEPTH": 5}),
    *(("cchip_ram", {"WIDTH": 1, "DEPTH": d, "ADDR_W": w}) for d, w in ((1, 1), (5, 4), (17, 5), (256, 8))),
    *(("cchip_leaf_queue", {"QUERIES": q, "DEPTH": d, "CREDIT": c}) for q, d, c in ((2, 1, 1), (16, 1024, 65535))),
    *(("cchip_traversal", {"QUERIES": q, "PAIRS": p, "LEAVES": n, "STACK": s, "LEAF_DEPTH": d, "CREDIT": c})
      for q, p, n, s, d, c in ((2, 1, 7, 8, 2, 1), (16, 63, 1, 64, 128, 65535))),
    *(("cchip_broad_phase", {"CACHE_KB": n}) for n in (1, 1024)),
    ("cchip_dual_ram", {"WIDTH": 1, "ADDR_W": 3}),
    *(("cchip_block_ram", {"WIDTH": 1, "WORDS": n, "ADDR_W": 3}) for n in (1, 4)),
    *(("cchip_bv_unit", {"QUERIES": n, "TAG_W": t}) for n, t in ((2, 1), (8, 40))),
    *(("cchip_round_shift", {"D_W": d, "BASE": b, "SHIFT_MAX": s, "Q_W": q})
      for d, b, s, q in ((2, 1, 2, 1), (64, 0, 63, 65))),
    *(("cchip_normaliser", {"COORD_W": w, "PASSES": p}) for w, p in ((4, 2), (20, 1))),
    *(("cchip_transform", {"PASSES": p, "CREDIT": c, "ID_W": i}) for p, c, i in ((1, 4096, 40), (2, 4, 1))),
    ("cchip_skid_buffer", {"WIDTH": 1}),
    *(("cchip_pr_region", {"RM_ID": n, "COORD_W": 4, "SUBSTAGES": smallest_substages(4)}) for n in range(5)),
    *(("cchip_roc_generator", {"CYCLES": n}) for n in (1, 32)),
    *(("cchip_pr_config_memory", {"CFG_W": w, "SLOT_ID": n}) for w, n in ((8, 0), (32, 255))),
    *(("cchip_pr_decoupler", {"COORD_W": w}) for w in (4, 20)),
    *(("cchip_pr_slot", {"SIMULATION": n, "CFG_W": w, "COORD_W": 4, "SUBSTAGES": smallest_substages(4)})
      for n, w in ((0, 8), (1, 8), (1, 32))),
]
# the tool that takes seconds for a whole module
LEGAL_FEW = [case for case in LEGAL if "primtest" not in case[0] or case[1].get("COORD_W", 16) == 4 or not case[1]]


@functools.lru_cache(None)
def files_of(module):
    """Its file and those of the modules it uses: to read all of them takes most of the time of a case."""
    found, wanted = [], [module]
    while wanted:
        path = PATHS[wanted.pop()]
        if path not in found:
            found.append(path)
            wanted += [name for name in re.findall(r"^ *(\w+) (?:#\(|u_)", pathlib.Path(path).read_text(), re.M)
                       if name in PATHS]
    return found


def macros_of(parameters):
    """Macros of the command line; the other parameters are those of the module."""
    return [f"-D{name}={value}" for name, value in parameters.items() if name == LEAF_LATENCY]


def own(parameters):
    return {name: value for name, value in parameters.items() if name != LEAF_LATENCY}


class Cases:
    legal = LEGAL

    def elaborate(self, module, parameters):
        raise NotImplementedError

    def assert_named(self, name, parameters, text):
        self.assertIn(name, text)

    def test_illegal_parameters_stop_with_their_name(self):
        for module, parameters, name in ILLEGAL:
            with self.subTest(module=module, **parameters):
                code, text = self.elaborate(module, parameters)
                self.assertNotEqual(code, 0, f"accepted; printed: {text}")
                self.assert_named(name, parameters, text)

    def test_legal_corners_pass_silently(self):
        for module, parameters in self.legal:
            with self.subTest(module=module, **parameters):
                self.assertEqual(self.elaborate(module, parameters), (0, ""))


class Verilator(Cases, unittest.TestCase):
    def elaborate(self, module, parameters):
        values = [f"-G{name}={value}" for name, value in own(parameters).items()] + macros_of(parameters)
        return run(tool("verilator"), "--lint-only", "-Wall", f"-I{RTL}/include",
                   f"{RTL}/lint/verilator_waiver.vlt", *values, "--top-module", module, *files_of(module))

    def assert_named(self, name, parameters, text):
        """Verilator elaborates from the leaves up and ends at the first vector without a bit: values far
        below the least may be named by an inner module only."""
        self.assertRegex(text, r"\bcchip_error_\w+" if name == TOO_SHORT or min(parameters.values()) < 1 else name)


class Icarus(Cases, unittest.TestCase):
    def elaborate(self, module, parameters):
        return run(tool("iverilog"), "-g2005", "-Wall", "-t", "null", "-I", f"{RTL}/include", "-s", module,
                   *(f"-P{module}.{name}={value}" for name, value in own(parameters).items()), *macros_of(parameters),
                   *files_of(module))


class Yosys(Cases, unittest.TestCase):
    legal = LEGAL_FEW

    def elaborate(self, module, parameters):
        values = "".join(f" -chparam {name} 32'h{value & 0xffffffff:08x}" for name, value in own(parameters).items())
        return run(tool("yosys"), "-q", "-p",
                   f"read_verilog -DSYNTHESIS {' '.join(macros_of(parameters))} -I{RTL}/include "
                   f"{' '.join(files_of(module))}; "
                   f"hierarchy -check -top {module}{values}; proc; check -assert")


class Names(unittest.TestCase):
    def test_every_error_name_of_the_rtl_has_an_illegal_case(self):
        written = set()
        for name in FILES:
            written |= set(re.findall(r"\bcchip_error_\w+", pathlib.Path(name).read_text()))
        self.assertEqual(written, {name for _, _, name in ILLEGAL})


if __name__ == "__main__":
    unittest.main(verbosity=2)
