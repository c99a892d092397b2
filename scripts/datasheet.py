#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The datasheets: builds them from the RTL, and measures what they show.

A datasheet has the page docs/modules/MODULE.md, if the module has one, or else the header comment of its file; the
tables of parameters and ports, made of the declarations in the RTL and the comments there; an instance template, if
designs of others instantiate the module; what docs/figures/modules.csv has measured. `make docs` writes one for every
module into the site, scripts/export.py one into the folder of each top; git has none of them.

Comments in the head of a module, which --check asks for: the meaning of a parameter or port stands behind its
declaration or in the lines above it; for a parameter, "; legal: " and the legal values may follow. A line `// ----
NAME` above that begins a group of ports; what follows a colon or semicolon explains it, and its further lines are
indented.

usage: datasheet.py                        measure everything, rewrite the generated tables (many minutes)
       datasheet.py PAGE...                the same for some pages only: a module, architecture, verification
       datasheet.py --page MODULE          print a datasheet
       datasheet.py --write simulation     measure what --compare simulation does and rewrite it, so it takes minutes
       datasheet.py --compare simulation   write nothing; measure what simulation tells, and exit 1 with the differences
                                           if a table says otherwise (not: areas; of the primitive tests' tables only
                                           the latency of a lone pair)
       datasheet.py --compare all          the same for every generated table (many minutes)
       datasheet.py --check                write nothing; exit 1 if a parameter or port has no meaning in the RTL, a
                                           page in docs/modules/ no module, a module no row of figures or no link in
                                           docs/README.md, or if a page names a file or links to a page that does not
                                           exist
       datasheet.py --templates            write nothing; elaborate the instance templates, exit 1 with what Icarus
                                           Verilog says about one (a name that the RTL does not have, another width)
       datasheet.py --latency MODULE       clocks from an input to the output it changes (Icarus Verilog)
       datasheet.py --stream [NAME=VALUE...]   a primitive test: latency, clocks per pair, drain (Icarus Verilog);
                                           NAME: a parameter of scripts/datasheet_stream.v, as VERTS_B=4
       datasheet.py --widths               widths and smallest SUBSTAGES for every COORD_W (Icarus Verilog)
       datasheet.py --leaves               18x18 multipliers for every COORD_W, shape and projection (Icarus Verilog)
       datasheet.py --bounds               two bounds on the error of a sign, mean over random triples of edges

Tables are written into docs/figures/modules.csv, and on pages between the lines `<!-- generated: begin NAME -->` and
`<!-- generated: end -->`. JOBS = tools at the same time (default: all processors). Tools: Debian's yosys 0.23 and
iverilog 11; default parameters unless a table says otherwise."""
import concurrent.futures
import csv
import difflib
import functools
import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
RTL = ROOT / "rtl"
MODELS = ROOT / "sim" / "rtl_models" / "sim.f"  # for simulation only
MODULES = ROOT / "docs" / "modules"
FIGURES = ROOT / "docs" / "figures" / "modules.csv"
README = ROOT / "README.md"
ARCHITECTURE = ROOT / "docs" / "develop" / "architecture.md"
VERIFICATION = ROOT / "docs" / "develop" / "verification.md"
BLOCK = r"(<!-- generated: begin{} -->\n).*?(<!-- generated: end -->)"

# A pair of one vertex with a reserved mode, which is answered at once.
RESERVED_PAIR = ("s_vertex_valid = 1; s_vertex_data[`CCHIP_VERTEX_FIRST] = 1; s_vertex_data[`CCHIP_VERTEX_LAST] = 1; "
                 "s_vertex_data[`CCHIP_VERTEX_MODE] = 2;")

# How a change of the inputs is made visible: (what is prepared, what changes, the output that answers).
STIMULI = {
    "cchip_delay": ("", "d = 1;", "q"),
    "cchip_reset_copy": ("", "rst = 1;", "rst_copy"),
    "cchip_skid_buffer": ("", "s_valid = 1;", "m_valid"),
    "cchip_fifo": ("", "s_valid = 1;", "m_valid"),
    "cchip_ram": ("write = 1; tick; write_addr = 1; tick; write_data = 1; write = 0; tick;", "read_addr = 1;",
                  "read_data"),
    "cchip_block_ram": ("write = 1; write_addr = 1; write_data = 1; tick; write = 0; repeat (2) tick;",
                        "read_addr = 1;",
                        "read_data"),
    "cchip_dual_ram": ("write = 1; addr_a = 1; write_data = 1; tick; write = 0; addr_a = 0; repeat (2) tick;",
                       "addr_b = 1;",
                       "read_data_b"),
    "cchip_mul18": ("", "a = 1; b = 1;", "p"),
    "cchip_mul_wide": ("", "a = 1; b = 1;", "p"),
    "cchip_dot3": ("", "a = 1; b = 1;", "q"),
    "cchip_cross3": ("", "a = 1; b = 1 << dut.E_W;", "q"),
    "cchip_norm1": ("", "v = 1;", "q"),
    "cchip_sat_select": ("", "s_a = 1;", "m_e_from"),
    "cchip_sat_axis": ("", "s_e_to = 1; s_f_to = 1 << dut.COORD_W;", "m_axis"),
    "cchip_sat_bound": ("", "s_axis = 1;", "m_gap_bound"),
    "cchip_sat_project": ("", "s_axis = 1; s_points = 1;", "m_projection"),
    "cchip_sat_compare": ("s_own = 1; s_allow_below = 1;", "s_projection = {1024{1'b1}} << dut.PROJ_W;", "m_separated"),
    "cchip_box_compare": (
        "", "s_a = 1 | 1 << 3 * dut.COORD_W | 1 << 6 * dut.COORD_W;", "m_separated"),
    "cchip_programme_plan": ("", "s_axis_largest = 1;", "m_info"),
    "cchip_programme_exhaustive": ("", "s_valid = 1;", "m_valid"),
    "cchip_axis_programme": ("s_state = `CCHIP_PROG_ILLEGAL;", "s_valid = 1;", "m_outcome"),
    "cchip_sat_pipeline": ("", "s_beat_valid = 1;", "m_verdict_valid"),
    "cchip_point_axes": ("", "s_pair_valid = 1;", "m_verdict_valid"),
    "cchip_primtest_point_tri": ("", "s_pair_valid = 1;", "m_result_valid"),
    "cchip_axis_controller": ("", "s_pair_valid = 1;", "m_beat_valid"),
    "cchip_primtest_array": ("m_result_ready = 1; s_pair_mode = 2;", "s_pair_valid = 1;", "m_result_valid"),
    "cchip_onehot_mux": ("", "select = 1; s_data = 1;", "m_data"),
    "cchip_onehot_index": ("", "select = 2;", "index"),
    "cchip_arbiter": ("", "request = 1;", "grant"),
    "cchip_count": ("", "up = 1;", "some"),
    "cchip_timeout": ("limit = 1; restart = 1; tick;", "restart = 0;", "expired"),
    "cchip_pool": ("m_ready = 1; repeat (40) tick;", "back_valid = 1;", "m_valid"),
    "cchip_counter_file": ("count = 1; tick; count = 0;", "read = 1; tick; read = 0;", "ack"),
    "cchip_vertex_collector": ("", "s_vertex_valid = 1; s_vertex_data[1:0] = 3;", "m_pair_valid"),
    "cchip_descriptor_queues": ("", "s_valid = 1;", "some"),
    "cchip_operand_memory": (
        "room = 1; s_pair_a = 1; s_pair_valid = 1; repeat (3) tick; s_pair_valid = 0; m_place = 1;",
        "m_place = 0;", "m_a"),
    "cchip_dispatch_sequencer": ("serves = 1; room = 1;", "some = 1;", "launch"),
    "cchip_slot_ledger": ("repeat (60) tick; grant = 1; tick; grant = 0;", "s_result_valid = 1;", "m_valid"),
    "cchip_dispatcher": ("slot_module = 1;", "some = 2;", "m_vertex_valid"),
    "cchip_slots": ("repeat (20) tick; m_result_ready = 1;", "some = 1;", "m_result_valid"),
    "cchip_stream_merge": ("", "s_valid = 1;", "m_valid"),
    "cchip_subsystem_status": ("", "report_valid = 1;", "swap_events"),
    "cchip_swaps": ("", "command_valid = 1;", "swap_events"),
    "cchip_swap_scheduler": ("", "command_valid = 1;", "m_report_valid"),
    "cchip_primtest_subsystem": ("m_result_ready = 1; s_pair_mode = 2; s_pair_kind = 1;", "s_pair_valid = 1;",
                                 "m_result_valid"),
    "cchip_pr_region": ("", RESERVED_PAIR, "m_result_valid"),
    "cchip_swap_request": ("", "s_swap_data = 1 << `CCHIP_SLOT_ID_W; begins = 1;", "module_id"),
    "cchip_swap_signals": ("slot = 1;", "to_stop = 1;", "stop"),
    "cchip_crc32": ("clear = 1; tick; clear = 0;", "valid = 1;", "crc"),
    "cchip_bitstream_fetch": ("words = 4; limit = 100;", "run = 1;", "m_axi_arvalid"),
    "cchip_axi_read": ("limit = 100; tick;", "s_valid = 1;", "m_axi_arvalid"),
    "cchip_axi_read_address": ("", "s_valid = 1;", "m_axi_arvalid"),
    "cchip_axi_read_late": ("limit = 1; repeat (20) tick;", "live = {1024{1'b1}};", "found"),
    "cchip_axi_write_collect": ("s_last = 1; tick;", "s_valid = 1;", "m_write_valid"),
    "cchip_axi_write_send": ("room = 1; repeat (2) tick;", "s_write_valid = 1;", "m_axi_awvalid"),
    "cchip_axi_write_late": ("limit = 1; repeat (20) tick;", "waiting = 1;", "timeout"),
    "cchip_axi_write": ("limit = 100; s_last = 1; tick;", "s_valid = 1;", "m_axi_awvalid"),
    "cchip_cache": ("repeat (1 << dut.SET_W) tick; repeat (2) tick;", "s_valid = 1;", "m_read_valid"),
    "cchip_cache_requests": ("free = 1; repeat (3) tick;", "s_valid = 1;", "look"),
    "cchip_cache_waiters": ("look = 1; tick; look = 0; sleep = 1; tick; sleep = 0;", "collect = 1;", "serving"),
    "cchip_cache_way": (
        "write = 1; write_set = 1; tick; write_set = 0; write_data = {1024{1'b1}}; tick; write = 0; "
        "line4 = {1024{1'b1}} << dut.SET_W; set1 = 1; repeat (8) tick;", "set1 = 0;", "match4"),
    "cchip_cache_port": (
        "running = 1; exhausted = 1; entry_write = 3; tick; entry_write = 0; repeat (12) tick;",
        "s_valid = 1;", "m_valid"),
    "cchip_cache_change": ("running = 1; tick;", "want = 1;", "allocate"),
    "cchip_cache_invalidate": ("repeat ((1 << dut.SET_W) + 4) tick;", "s_valid = 1;", "walk_valid"),
    "cchip_cache_fill": (
        "free = 1; repeat (6) tick; free_take = 1; tick; free_take = 0; allocate = 1; tick; allocate = 0;",
        "s_read_valid = 1; s_read_last = 1; s_read_valid <= #2 0;", "fill_valid"),
    "cchip_pose_setup": ("tick;", "s_valid = 1; s_m = 1 << 20;", "m_valid"),
    "cchip_bv_offset": ("", "start = 1; row_t = 1 << 10; a_step = 7; b_step = 7;", "offset"),
    "cchip_bv_lane_a": ("", "child = 1; offset = 1 << 10;", "planes"),
    "cchip_bv_lane_b": ("", "child = 1;", "planes"),
    "cchip_bv_compare": ("", "a = 1 << 11;", "separated"),
    "cchip_bv_cell": ("b = 1 << 332; load = 1; tick; load = 0;", "s_a = 1 << 332;", "m_row"),
    "cchip_bv_feed": ("", "s_valid = 1; s_tag = 1;", "last30"),
    "cchip_bv_pose": ("tick;", "s_pose_valid = 1; s_pose_m = 1 << 20;", "m_pose_valid"),
    "cchip_bv_unit": ("tick;", "s_valid = 1;", "m_valid"),
    "cchip_round_shift": ("", "d = 1 << dut.BASE;", "q"),
    "cchip_leaf_sequencer": ("room = 1; repeat (3) tick;", "s_valid = 1;", "m_origin"),
    "cchip_leaf_unit": ("", "s_extent_a = 20;", "m_cut_b"),
    "cchip_leaf_origin": ("s_t = {1024{1'b1}};", "s_origin = 1;", "m_origin"),
    "cchip_vertex_transform": ("s_kinds = 5; room = 1;", "s_valid = 1;", "m_valid"),
    "cchip_normaliser": ("", "s_valid = 1;", "m_valid"),
    "cchip_transform": ("s_kinds = 5; repeat (4) tick;", "s_valid = 1;", "m_valid"),
    "cchip_leaf_feed": ("m_begin_ready = 1;", "s_leaf_valid = 1; s_leaf_valid <= #2 0;", "m_valid"),  # room for two
    "cchip_refit": ("s_lines = 4; s_root = 1;", "s_valid = 1; s_valid <= #2 0;", "m_read_valid"),
    "cchip_refit_axi": ("s_lines = 4; s_root = 1;", "s_valid = 1; s_valid <= #2 0;", "m_axi_arvalid"),
    "cchip_refit_axes": ("", "place = 1;", "axes"),
    "cchip_refit_leaf": ("s_line = {1024{1'b1}};", "s_axes = 1;", "m_least"),
    "cchip_refit_frame": ("", "search = 1; search <= #2 0;", "m_done"),
    "cchip_refit_volume": ("", "s_valid = 1;", "m_valid"),
    "cchip_refit_node": ("s_node = 5;", "start = 1; start <= #2 0;", "idle"),
    "cchip_refit_walk": ("s_lines = 4; go = 1;", "start = 1; start <= #2 0;", "m_read_valid"),
    "cchip_query_ring": ("", "enable = 1; producer = 1;", "m_read_valid"),
    "cchip_record_ring": ("size_log2 = 4; tick;", "s_valid = 1;", "m_valid"),
    "cchip_calc_result": ("repeat (8) tick;", "s_end_valid = 1;", "m_leaf_valid"),
    "cchip_soft_reset": ("", "request = 1;", "resetting"),
    "cchip_chip_regs": ("", "s_axil_arvalid = 1;", "s_axil_rvalid"),
    "cchip_chip": ("", "s_axil_arvalid = 1;", "s_axil_rvalid"),
    "cchip_chip_core": ("enable = 1; pairs_each = 1;", "query_producer = 1;", "m_axi_arvalid"),
    "cchip_line_pairs": ("", "s_place = 1 | 1 << dut.PLACE_W; s_valid = 3; s_valid <= #2 0;", "m_pair_valid"),
    "cchip_node_check": ("s_valid = 1; tick; s_valid = 0;", "lookup = 1;", "lookup_nodes"),
    "cchip_first_pair": ("", "pairs = 2;", "first"),
    "cchip_verdict_view": ("", "s_verdict = 1;", "m_some_wait"),
    "cchip_traversal_contexts": (
        "repeat (80) tick; write8 = 1; state8 = {1024{1'b1}}; context8 = 1; tick; write8 = 0;",
        "s_context = 1;", "state5"),
    "cchip_query_check": ("repeat (3) tick;", "s_valid = 1;", "waits"),
    "cchip_traversal_fetch": ("repeat (40) tick;", "s_goes = 1;", "m_valid"),
    "cchip_get_data": ("", "s_valid = 1;", "m_line_valid"),
    "cchip_leaf_queue": ("epoch_write = 1; tick; epoch_write = 0;", "s_valid = 1; s_leaves = 1;", "m_valid"),
    "cchip_traversal": ("m_start_ready = 1; pairs_each = 1; repeat (100) tick;", "s_query_valid = 1;", "m_start_valid"),
    "cchip_traversal_events": ("running = 1; repeat (100) tick;", "s_result_valid = 1;", "m_valid"),
    "cchip_traversal_decision": ("tick;", "s_valid = 1; s_is_start = 1;", "m_start"),
    "cchip_broad_phase": ("pairs_each = 1; repeat (1200) tick;", "s_query_valid = 1;", "m_read_valid"),
    "cchip_axi_rules": ("", "m_axi_bvalid = 1;", "memory_ok"),
    "cchip_broad_phase_axi": ("pairs_each = 1; repeat (1200) tick;", "s_query_valid = 1;", "m_axi_arvalid"),
    "cchip_bitstream_header": ("clear = 1; tick; tick; clear = 0; s_valid = 1; repeat (3) tick; s_valid = 0;",
                               "s_valid = 1;",
                               "done"),
    "cchip_config_port": ("length = 4;", "run = 1; s_valid = 1;", "done"),
    "cchip_swap_retry": ("", "report_valid = 1; report_data = {16'd0, `CCHIP_SWAP_BUS, 8'd1, 8'd0}; valid = 4'd15;",
                         "resting"),
    "cchip_phase_clocks": ("phase = 1; read_phase = 1; repeat (2) tick;", "elapsed = 1;", "read_clocks"),
    "cchip_bitstream_table": ("write = 1; write_word = 1; write_data = 1; write_bytes = 1; tick; write = 0;",
                              "look = 1;", "size"),
    "cchip_swap_sequencer": ("", "s_swap_valid = 1;", "phase"),
    "cchip_config_controller": ("", "s_swap_valid = 1;", "phase"),
    "cchip_subsystem_regs": ("", "s_axil_arvalid = 1;", "s_axil_rvalid"),
    "cchip_roc_generator": ("", "configured = 1;", "roc"),
    "cchip_pr_decoupler": ("", "s_vertex_valid = 1;", "r_vertex_valid"),
    "cchip_pr_config_memory": (
        "cfg_valid = 1; cfg_data = 'h66; tick; cfg_data = 'h55; tick; cfg_data = 'h99; tick; cfg_data = 'haa; tick; "
        "cfg_data = 0; repeat (3) tick; cfg_valid = 0;", "cfg_valid = 1;", "garbage"),
    "cchip_pr_virtual": ("", RESERVED_PAIR, "m_result_valid"),
    "cchip_pr_slot": ("", RESERVED_PAIR, "m_result_valid"),
}

# Yosys takes too long for these; docs/hardware/fpga.md has their area, placed and routed.
PLACED_ONLY = ("cchip_primtest_array",)
# Modules around reconfigurable regions, and the parameters of their area: the regions are empty cells, as in the static
# design of a user. A tool that sees what is in them looks through the partition and counts neither side rightly.
STATIC_SIDE = {"cchip_primtest_subsystem": "SLOTS 1"}

# Modules that a design of its own instantiates: their ports are in groups, and they have an instance template.
INSTANTIATED = ("cchip_primtest", "cchip_primtest_tri_tri", "cchip_primtest_tri_quad", "cchip_primtest_quad_quad",
                "cchip_primtest_point_tri", "cchip_primtest_subsystem", "cchip_broad_phase", "cchip_chip",
                "cchip_cache",
                "cchip_axi_read", "cchip_axi_write", "cchip_fifo", "cchip_skid_buffer")

LATENCY_LIMIT = 1000  # clocks; a longer wait means a stimulus without effect

# Vertices of A and of B.
SHAPES = {"tri_tri": (3, 3), "tri_quad": (3, 4), "quad_quad": (4, 4)}
PRIMTESTS = {"cchip_primtest": (3, 3), **{f"cchip_primtest_{name}": verts for name, verts in SHAPES.items()}}


def fail(message):
    sys.exit(f"datasheet.py: {message}")


def run(*command, cwd=ROOT):
    result = subprocess.run(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if result.returncode:
        fail(f"{command[0]} failed:\n{result.stdout}")
    return result.stdout


# ---- the RTL


@functools.lru_cache(None)
def rtl_files():
    """Path of every module below the root, those for simulation only at the end."""
    files = [file_list.parent / line.strip() for file_list in (RTL / "cchip.f", MODELS)
             for line in file_list.read_text().splitlines() if line.strip().endswith(".v")]
    return {path.stem: str(path.relative_to(ROOT)) for path in files}


def squeeze(text):
    return re.sub(r"\s+", "", text)


DECLARATION = re.compile(r"\s*(?:parameter\s+integer\s+(?P<parameter>\w+)\s*=\s*(?P<value>[^,]*[^,\s])|"
                         r"(?P<direction>input|output)\s+(?:wire|reg)\s+(?:signed\s+)?(?:\[(?P<top>[^\]]*):0\])?\s*"
                         r"(?P<port>\w+))\s*,?\s*$")


def head(text, module):
    """Parameters [(name, default, meaning)] and ports [(direction, upper end of the range, name, meaning, group)] of a
    module in a file's text; a meaning is empty and a group None where the RTL has no comment."""
    found = re.search(rf"^module\s+{module}\b(.*?)^\)\s*;", text, re.S | re.M)
    if not found:
        fail(f"no module {module}")
    parameters, ports, above, group = [], [], [], None
    for line in found[1].splitlines():
        code, _, comment = (part.strip() for part in line.partition("//"))
        declaration = DECLARATION.match(code)
        if declaration:
            in_heading = [bool(above[0].startswith("----")) if above else False]
            for one in above[1:]:
                in_heading.append(one.startswith("     ") and in_heading[-1])
            heading = " ".join(one.strip("- ") for one, yes in zip(above, in_heading) if yes)
            group = heading or group
            meaning = " ".join([one.strip() for one, yes in zip(above, in_heading) if not yes] + [comment]).strip()
            if declaration["parameter"]:
                parameters.append((declaration["parameter"], declaration["value"], meaning))
            else:
                if not meaning and group and "AXI4" in group:  # what the standard says of the signal
                    meaning = re.search(r"AXI4(?:-Lite)?", group)[0]
                ports.append((declaration["direction"], declaration["top"] or "", declaration["port"], meaning, group))
        elif code.startswith(")"):
            group = None
        above = [] if code else above + [line.split("//", 1)[1].removeprefix(" ")] if comment else above
    return parameters, ports


@functools.lru_cache(None)
def declared(module):
    """The head of a module of this project."""
    return head((ROOT / rtl_files()[module]).read_text(), module)


def parse(module):
    """Parameters [(name, default)] and ports [(name, direction, width)] of a module, in order; blanks removed."""
    parameters, ports = declared(module)
    widths = [(name, direction, width_of(squeeze(top))) for direction, top, name, _, _ in ports]
    return [(name, squeeze(value).replace("`", "")) for name, value, _ in parameters], widths


@functools.lru_cache(None)
def definitions():
    """Constants by name, and functions of COORD_W as (factor, summand): all of them are linear."""
    data = json.loads((ROOT / "scripts" / "definitions.json").read_text())
    constants = {c["name"]: c["value"] for c in data["constants"]}
    sources = {f["name"]: (f["args"], f["expr"]) for f in data["functions"]}
    for record in data["records"]:
        sources[f"{record['name']}_W"] = (record["args"], " + ".join(f["width"] for f in record["fields"]))

    def value(text, given):
        names = constants | given | {n: (lambda *a, s=s: value(s[1], dict(zip(s[0], a)))) if s[0] else None
                                     for n, s in sources.items()}
        return eval(re.sub(r"\b([A-Z]\w*)\b(?!\()",
                           lambda m: str(value(sources[m[1]][1], {})) if m[1] in sources else m[1], text),
                    {"__builtins__": {}}, names)

    linear = {}
    for name, (args, text) in sources.items():
        if not args:
            constants[name] = value(text, {})
    for name, (args, text) in sources.items():
        if args == ["w"] and name.endswith("_W"):
            zero, one, two = (value(text, {"w": w}) for w in range(3))
            assert two - one == one - zero, name
            linear[name] = (one - zero, zero)
    return constants, linear


def plain(text):
    """A width with the definitions of scripts/definitions.json worked out: `CCHIP_TAG_W-1 becomes 15."""
    constants, linear = definitions()

    def function(match):
        factor, summand = linear[match[1]]
        text = f"{factor}*COORD_W" if factor != 1 else "COORD_W"
        return f"({text}+{summand})" if summand else text

    text = re.sub(r"`?CCHIP_(\w+)\(COORD_W\)", function, text)
    text = re.sub(r"`?CCHIP_(\w+)", lambda m: str(constants.get(m[1], m[1])), text)
    alone = re.fullmatch(r"\(([^()]*)\)-1", text)
    text = f"{alone[1]}-1" if alone else text
    sums = re.fullmatch(r"(.*?)((?:[+-]\d+)+)", text)
    if re.fullmatch(r"[\d+-]+", text):
        return str(eval(text))
    return f"{sums[1]}{eval(sums[2]):+d}" if sums and sums[1] and sums[1][-1] not in "*(" else text


def width_of(top):
    """Width of the range [top:0]."""
    if not top:
        return "1"
    top = plain(top)
    base, offset = re.fullmatch(r"(.*?)([+-]?\d+)?", top).groups() if re.search(r"(^|[+-])\d+$", top) else (top, "0")
    width = int(offset) + 1
    return str(width) if not base else base if width == 0 else f"{base}{width:+d}"


# ---- measurements


def simulate(bench, *options):
    with tempfile.TemporaryDirectory() as folder:
        program = f"{folder}/bench.vvp"
        run("iverilog", "-g2005", "-Irtl/include", "-s", "bench", "-o", program, *options, *rtl_files().values(), bench)
        return run("vvp", "-n", program)


def latency(module):
    """Clocks from a change of the inputs to the change of the output."""
    if module not in STIMULI:
        fail(f"{module}: scripts/datasheet.py has no line in STIMULI that says how to measure its latency; add one")
    prepare, change, output = STIMULI[module]
    _, ports = parse(module)
    names = [name for name, _, _ in ports]
    # Ports are generous 1024-bit registers and wires: connections cut or extend them.
    declarations = "".join(f"  {'reg' if d == 'input' else 'wire'} [1023:0] {n};\n" for n, d, _ in ports if n != "clk")
    zero = "".join(f"    {n} = 0;\n" for n, d, _ in ports if d == "input")
    bench = f"""`include "cchip_defs.vh"
`default_nettype none
module bench;
  reg clk;
{declarations}  {module} dut ({", ".join(f".{n}({n})" for n in names)});
  task tick; begin #1 clk = 1; #1 clk = 0; #1; end endtask
  integer clocks;
  reg [1023:0] before;
  initial begin
{zero}    {"rst = 1; repeat (100) tick; rst = 0;" if "rst" in names else ""}
    {prepare}
    repeat (100) tick;
    before = {output};
    {change}
    #1;
    for (clocks = 0; {output} === before && clocks < {LATENCY_LIMIT}; clocks = clocks + 1) tick;
    $display("%0d", clocks);
  end
endmodule
"""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "latency.v"
        path.write_text(bench)
        clocks = int(simulate(str(path)).split()[-1])
    if clocks == LATENCY_LIMIT:
        fail(f"{module}: {output} does not answer to {change!r} within {clocks} clocks; mend its line of STIMULI")
    return clocks


@functools.lru_cache(None)
def stream(*settings):
    """Lines `key value...` printed by the bench of cchip_primtest."""
    return simulate("scripts/datasheet_stream.v", *(f"-Pbench.{s}" for s in settings))


def widths():
    return simulate("scripts/datasheet_widths.v")


def yosys(script, options=""):
    """A command that anybody can paste into a shell in rtl/."""
    return f'yosys -p "read_verilog {options}-Iinclude $(grep \'[.]v$\' cchip.f | tr \'\\n\' \' \'); {script}"'


@functools.lru_cache(None)
def leaf_count(width, shape, absolute):
    """Instances of cchip_mul18 in cchip_sat_pipeline, which Icarus elaborates."""
    verts_a, verts_b = SHAPES[shape]
    settings = {"COORD_W": width, "SUBSTAGES": 12, "ABSOLUTE_PROJECTION": absolute, "VERTS_A": verts_a,
                "VERTS_B": verts_b}
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "pipeline.vvp"
        run("iverilog", "-g2005", "-Irtl/include", "-o", str(program), "-s", "cchip_sat_pipeline",
            *(f"-Pcchip_sat_pipeline.{name}={value}" for name, value in settings.items()), *rtl_files().values())
        return str(len(re.findall(r'^S_\w+ \.scope module, "\w+" "cchip_mul18"', program.read_text(), re.M)))


def leaves():
    """Lines `COORD_W` and the leaves of every shape with relative and with absolute projection."""
    text = "COORD_W " + " ".join(f"{shape},_{kind}" for shape in SHAPES for kind in ("relative", "absolute")) + "\n"
    for width in range(4, 21):
        text += f"{width} {' '.join(leaf_count(width, shape, absolute) for shape in SHAPES for absolute in (0, 1))}\n"
    return text


def power_above(n):
    """Smallest power of two >= n."""
    return 1 << (n - 1).bit_length() if n > 0 else 0


def bounds():
    """Mean of two bounds on the error of det(a, b, c), divided by the error bound without rounding (eta = 1).

    `one` is the hardware's, `products` bounds each product of norms for itself: min of 1-norms and of 1-norm and
    infinity norm, each rounded up to a power of two."""
    draw = random.Random(1)
    lines = "COORD_W one products\n"
    for width in (8, 12, 16, 20):
        sums = [0.0, 0.0]
        samples = 20000
        for _ in range(samples):
            size = draw.randint(2, width)
            a, b, c = ([draw.randint(-(1 << size) + 1, (1 << size) - 1) for _ in range(3)] for _ in range(3))
            cross = sum(abs(a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2]) for i in range(3))
            n1 = [sum(map(abs, v)) for v in (a, b, c)]
            top = [max(map(abs, v)) for v in (a, b, c)]
            n1_up, top_up = [list(map(power_above, norms)) for norms in (n1, top)]
            product = lambda x, y: min(n1_up[x] * n1_up[y], 2 * top_up[x] * n1_up[y], 2 * n1_up[x] * top_up[y])
            exact = cross + (n1[0] + n1[1] + 2) * (n1[2] + 2)
            sums[0] += (cross + (n1[0] + n1[1] + 2) * power_above(n1[2] + 2)) / exact
            sums[1] += (cross + product(1, 2) + product(2, 0) + 2 * sum(n1) + 6) / exact
        lines += f"{width} {sums[0] / samples:.3f} {sums[1] / samples:.3f}\n"
    return lines


TARGETS = {
    "Lattice ECP5": ("synth_ecp5", {
        "LUT": r"LUT4", "carry": r"CCU2C", "FF": r"TRELLIS_FF", "multiplier blocks": r"MULT18X18D",
        "block RAM": r"DP16KD", "distributed RAM": r"TRELLIS_DPR16X4", "shift register": r"(?!)"}),
    # the attribute: see "Netlists" in docs/README.md
    "Xilinx 7": ("setattr -mod -set keep_hierarchy 1 cchip_mul18; synth_xilinx -family xc7 -flatten", {
        "LUT": r"LUT[1-6]", "carry": r"CARRY4", "FF": r"FD[RSCP]E", "multiplier blocks": r"DSP48E1",
        "block RAM": r"RAMB\w+", "distributed RAM": r"RAM\d+\w+", "shift register": r"SRL\w+"}),
}


def synthesis(script, module):
    """The command that synthesises a module for its area."""
    if module not in STATIC_SIDE:
        return yosys(f"{script} -top {module}")
    return yosys(f"chparam -set {STATIC_SIDE[module]} {module}; {script} -top {module}", "-DCCHIP_PR_BLACK_BOX ")


def cells(script, module):
    """Cell counts of the last statistics that Yosys prints."""
    out = run("sh", "-c", synthesis(script, module), cwd=RTL)
    last = out[out.rindex("Number of cells"):]
    return {name: int(count) for name, count in re.findall(r"^ +(\w+) +(\d+)$", last, re.M)}


# ---- pages


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows]) + "\n"


def text_table(text):
    rows = [line.split() for line in text.strip().splitlines()]
    return table([f"`{c}`" if c.isupper() else c.replace("_", " ") for c in rows[0]], rows[1:])


def values(text):
    return {line.split()[0]: line.split()[1:] for line in text.strip().splitlines()
            if line and not line.startswith(("clock ", "pair "))}


def pairs(text):
    """[name, mode, beats, latency, least, mean, greatest, busy, drain] of every line `pair ...`."""
    return [line.split()[1:] for line in text.splitlines() if line.startswith("pair ")]


def shape_settings(shape):
    return f"VERTS_A={shape[0]}", f"VERTS_B={shape[1]}"


def lone_only(path, rows):
    """The table of a primitive test's page with the latencies of the lone pairs that were measured."""
    lines = [line for line in path.read_text().splitlines()
             if re.match(r"\| .* \| (EXHAUSTIVE|DIRECTED|reserved) \|", line)]
    shown = {tuple(cells[:2]): cells for cells in ([c.strip() for c in line.strip("|").split("|")] for line in lines)}
    for row in rows:
        shown.setdefault(tuple(row[:2]), row)[3] = row[3]
    return list(shown.values())


def speed(module, quick=False):
    """The table of a primitive test."""
    settings = shape_settings(PRIMTESTS[module])
    text = stream(*settings, *(["LONE=1"] if quick else []))
    rows = [[name.replace("_", " "), mode, beats, lone, f"{least} / {mean} / {greatest}", busy, drain]
            for name, mode, beats, lone, least, mean, greatest, busy, drain in pairs(text)]
    rows = lone_only(MODULES / f"{module}.md", rows) if quick else rows
    text = (f"Clocks, printed by `scripts/datasheet.py --stream {' '.join(settings)}`:\n\n" +
            table(["pair", "mode", "beats", "latency of a lone pair", "clocks per pair, min / mean / max",
                   "beats per 100 clocks while pairs wait", "drain after `CONTEXTS` pairs"], rows) +
            f"\nDrain bound, `CCHIP_DRAIN_BOUND`: {values(text)['drain_bound'][0]} clocks.\n")
    return text


def synthesised(module):
    return rtl_files()[module].startswith("rtl/") and module not in PLACED_ONLY


def targets(module):
    return [target for target in TARGETS if module not in STATIC_SIDE or target == "Lattice ECP5"]


def measured(module, simulation=True, synthesis=True):
    """Figures of a module, by column of docs/figures/modules.csv."""
    found = {}
    if simulation and module in STIMULI:
        found["latency"] = str(latency(module))
    for target in targets(module) if synthesis and synthesised(module) else ():
        script, patterns = TARGETS[target]
        counts = cells(script, module)
        for kind, pattern in patterns.items():
            found[f"{target}: {kind}"] = str(sum(n for cell, n in counts.items() if re.fullmatch(pattern, cell)))
    return found


@functools.lru_cache(None)
def figures():
    """The rows of docs/figures/modules.csv by module."""
    with FIGURES.open(newline="") as file:
        return {row["module"]: row for row in csv.DictReader(file)}


def write_figures(found):
    """Writes {module: figures} into docs/figures/modules.csv, in the order of rtl/cchip.f."""
    before = figures()
    columns = ["module", "latency", *(f"{target}: {kind}" for target, (_, kinds) in TARGETS.items() for kind in kinds)]
    with FIGURES.open("w", newline="") as file:
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows({"module": module, **before.get(module, {}), **found.get(module, {})}
                         for module in rtl_files())
    print(f"wrote {FIGURES.relative_to(ROOT)}", flush=True)


THROUGHPUT = [*([f"SUBSTAGES={n}"] for n in (6, 8, 10, 12)), *([f"CONTEXTS={n}"] for n in (1, 2, 3, 4, 5, 8)),
              ["COORD_W=8", "SUBSTAGES=6"], ["COORD_W=18", "SUBSTAGES=8"], ["COORD_W=20", "SUBSTAGES=12"],
              ["ABSOLUTE_PROJECTION=1"]]


def throughput():
    body = []
    for settings in THROUGHPUT:
        text = stream("BRIEF=1", *settings)
        found = values(text)
        exhaustive, directed = pairs(text)[:2]
        body.append([f"`{' '.join(settings)}`", exhaustive[3], " / ".join(exhaustive[4:7]), " / ".join(directed[4:7]),
                     " + ".join(found["axis_registers"]), " + ".join(found["project_registers"])])
    return table(["`scripts/datasheet.py --stream BRIEF=1` with", "latency of a lone pair, EXHAUSTIVE",
                  "clocks per pair, EXHAUSTIVE, min / mean / max", "the same, DIRECTED",
                  "optional registers of axis: operand + product + result", "the same of project"], body)


# (COORD_W, SUBSTAGES, ABSOLUTE_PROJECTION, shape) of the table of configurations: settings of the bench
CONFIGURATIONS = {(width, substages, absolute, shape): (*shape_settings(verts), f"COORD_W={width}",
                                                        f"SUBSTAGES={substages}",
                                                        f"ABSOLUTE_PROJECTION={absolute}")
                  for width, substages, absolute in ((16, 10, 0), (16, 10, 1), (16, 6, 0), (8, 6, 0), (20, 12, 0))
                  for shape, verts in SHAPES.items()}


def configurations():
    """One row per configuration."""
    rows = []
    for (width, substages, absolute, shape), settings in CONFIGURATIONS.items():
        exhaustive = pairs(stream("BRIEF=2", *settings))[0]
        rows.append([shape, width, substages, "absolute" if absolute else "relative",
                     leaf_count(width, shape, absolute),
                     exhaustive[3], exhaustive[5], f"`--stream BRIEF=2 {' '.join(settings)}`"])
    return table(["`cchip_primtest_`", "`COORD_W`", "`SUBSTAGES`", "projection", "18x18 multipliers",
                  "latency, clocks", "clocks per pair", "`scripts/datasheet.py --leaves` and"], rows)


def clock_table():
    lines = stream("BRIEF=2", "LONE=1").splitlines()
    rows = [line.split(" ", 2)[1:] for line in lines if line.startswith("clock ")]
    return table(["clock", "what is valid"], rows)


BLOCKS = {"widths": lambda: text_table(widths()), "leaves": lambda: text_table(leaves()),
          "bounds": lambda: text_table(bounds()), "throughput": throughput, "clocks": clock_table}


def begin(name):
    return f"<!-- generated: begin{' ' + name if name else ''} -->"


def replaced(path, name, block):
    """The text of a page with a new block."""
    text = path.read_text()
    pattern = re.compile(BLOCK.format(f" {name}" if name else ""), re.S)
    if not pattern.search(text):
        fail(f"{path.relative_to(ROOT)}: no lines '{begin(name)}' and '<!-- generated: end -->'; add them where the "
             "table belongs")
    return pattern.sub(lambda m: f"{m.group(1)}{block}{m.group(2)}", text)


def rewrite(path, name, block):
    path.write_text(replaced(path, name, block))
    print(f"wrote {path.relative_to(ROOT)} {name}".rstrip(), flush=True)


def blocks(page, quick=False):
    """(path, name, how it is made) of the generated blocks of a page; simulation makes all of them."""
    if page == "architecture":
        return [(ARCHITECTURE, name, make) for name, make in BLOCKS.items()]
    if page == "verification":
        return [(VERIFICATION, "configurations", configurations)]
    return [(MODULES / f"{page}.md", "", lambda: speed(page, quick))] if page in PRIMTESTS else []


def pages():
    return [*rtl_files(), "architecture", "verification"]


def in_parallel(function, items):
    with concurrent.futures.ThreadPoolExecutor(int(os.environ.get("JOBS") or os.cpu_count())) as pool:
        return list(pool.map(function, items))


def settings_of_all(quick):
    """Every setting of the bench that the tables need, the slowest first."""
    full = [[*shape_settings(shape), *(["LONE=1"] if quick else [])] for shape in reversed(SHAPES.values())]
    return full + [["BRIEF=2", *s] for s in CONFIGURATIONS.values()] + [["BRIEF=1", *s] for s in THROUGHPUT]


def write_simulation():
    in_parallel(lambda settings: stream(*settings), settings_of_all(True))
    jobs = [block for page in pages() for block in blocks(page, quick=True)]
    for (path, name, _), block in zip(jobs, in_parallel(lambda job: job[2](), jobs)):
        rewrite(path, name, block)
    write_figures(dict(zip(rtl_files(), in_parallel(lambda module: measured(module, synthesis=False), rtl_files()))))


def compare(what):
    """Prints what the generated blocks and figures would become; 1 if one of them is stale."""
    quick = what == "simulation"
    in_parallel(lambda settings: stream(*settings), settings_of_all(quick))
    jobs = [block for page in pages() for block in blocks(page, quick=quick)]
    stale = 0
    for (path, name, _), fresh in zip(jobs, in_parallel(lambda job: replaced(job[0], job[1], job[2]()), jobs)):
        difference = list(difflib.unified_diff(path.read_text().splitlines(), fresh.splitlines(), "page", "measured",
                                               lineterm="", n=0))
        if difference:
            stale += 1
            print(f"{path.relative_to(ROOT)}: block '{begin(name)}' is stale: scripts/datasheet.py {path.stem}")
            print("\n".join(difference[2:12]), flush=True)
    count = 0
    for module, found in zip(rtl_files(),
                             in_parallel(lambda module: measured(module, synthesis=not quick), rtl_files())):
        shown = figures().get(module, {})
        difference = [f"{key} {shown.get(key)}, measured {value}"
                      for key, value in found.items() if shown.get(key) != value]
        count += len(found)
        if difference:
            stale += 1
            print(f"{FIGURES.relative_to(ROOT)}: {module} is stale: scripts/datasheet.py {module}: "
                  f"{'; '.join(difference)}", flush=True)
    print(f"{len(jobs)} generated blocks, {count} figures, {stale} stale")
    return 1 if stale or not jobs or not count else 0


# ---- datasheets


def escaped(text, module):
    """A comment of the RTL in a cell of a table: names are code, names of modules and pages are links."""
    parameters, ports = declared(module)
    own = {name for name, *_ in parameters} | {name for _, _, name, *_ in ports if "_" in name}

    def word(match):
        name = match[0]
        if name.startswith("docs/"):
            return f"[{name.rsplit('/', 1)[1].split('#')[0]}](../{name.removeprefix('docs/')})"
        if name in rtl_files() and name != module:
            return f"[{name}]({name}.md)"
        return f"`{name}`" if name in own or "_" in name else name

    for character, entity in (("&", "&amp;"), ("<", "&lt;"), ("|", "&#124;"), ("*", "&#42;"), ("[", "&#91;"),
                              ("]", "&#93;"), ("~", "&#126;")):
        text = text.replace(character, f"\0{entity}\0")
    parts = text.split("\0")
    return "".join(part if i % 2 else re.sub(r"\bdocs/[\w/-]+\.md(#[\w-]+)?|\b[A-Za-z]\w*\b", word,
                                             part.replace("`", ""))
                   for i, part in enumerate(parts))


def parameter_table(module):
    rows = []
    for name, value, meaning in declared(module)[0]:
        text, _, legal = meaning.partition("; legal: ")
        rows.append([f"`{name}`", f"`{value.replace('`', '')}`", escaped(legal, module) or "-", escaped(text, module)])
    refused = sorted(set(re.findall(r"\bcchip_error_\w+", (ROOT / rtl_files()[module]).read_text())))
    text = table(["parameter", "default", "legal", "meaning"], rows) if rows else ""
    return text + ("\nOther values stop elaboration at " + ", ".join(f"`{name}`" for name in refused) + ".\n"
                   if refused else "")


def port_table(module):
    rows, last = [], None
    for (_, _, _, meaning, group), (name, direction, width) in zip(declared(module)[1], parse(module)[1]):
        if group != last:
            last = group
            rows.append([f"**{escaped(group, module)}**", "", "", ""])
        rows.append([f"`{name}`", direction, f"`{width}`", escaped(meaning, module)])
    return table(["port", "direction", "width", "meaning"], rows)


def measured_text(module):
    row, text = figures().get(module, {}), ""
    if row.get("latency"):
        _, change, output = STIMULI[module]
        inputs = list(dict.fromkeys(re.findall(r"\b(\w+)(?:\[[^\]]*\])? <?= ", change)))
        text += (f"Latency: {row['latency']} clocks, from {' and '.join(f'`{name}`' for name in inputs)} to "
                 f"`{output}`; "
                 f"`scripts/datasheet.py --latency {module}`.\n")
    kinds = list(next(iter(TARGETS.values()))[1])
    rows = [[target, *(row[f"{target}: {kind}"] for kind in kinds)]
            for target in targets(module) if row.get(f"{target}: LUT")]
    if rows:
        what = (f"static side, `{STATIC_SIDE[module]}`, regions black-boxed" if module in STATIC_SIDE
                else "default parameters")
        text += "\n" + table([f"Yosys 0.23, {what}"] + kinds, rows) + "\nCommands, in `rtl/`:\n\n"
        text += "".join(f"    {synthesis(TARGETS[target][0], module)}\n" for target in targets(module))
        text += "\nFmax: whole primitive tests are placed and routed, see [fpga.md](../hardware/fpga.md).\n"
    return text


def header(module):
    """Title and text of the header comment of a module's file."""
    text = (ROOT / rtl_files()[module]).read_text()
    found = re.search(rf"^// {module}: (.*\n(?://.*\n)*)", text, re.M)
    if not found:
        fail(f"{rtl_files()[module]}: no header comment that begins with // {module}:")
    return "".join(f"    {line}\n" for line in re.sub(r"^// ?", "", found[1], flags=re.M).rstrip().split("\n"))


def datasheet(module):
    """The whole page."""
    path, rtl = MODULES / f"{module}.md", rtl_files()[module]
    if path.exists():
        text = path.read_text().rstrip() + "\n"
    else:
        text = f"<!-- SPDX-License-Identifier: Apache-2.0 -->\n# {module}\n\n[RTL](../../{rtl})"
        test = f"tests/unit/test_{module}.cpp"
        text += f", [test](../../{test})\n\n" if (ROOT / test).exists() else "\n\n"
        text += header(module)
    made = {"Parameters": parameter_table(module), "Ports": port_table(module)}
    if module in INSTANTIATED:
        made["Instance template"] = "Every parameter has its default value here and can be left out.\n\n" + template(
            module)
    made["Measured"] = measured_text(module)
    first, new = re.search(r"^## |\Z", text, re.M).start(), ""
    for heading, block in made.items():
        section = re.search(rf"^## {heading}\n", text, re.M)
        if not block:
            continue
        if heading == "Measured":
            text = text.rstrip() + ("\n\n" if section else f"\n\n## {heading}\n\n") + block
        elif section:
            text = text[:section.end()] + f"\n{block}" + text[section.end():]
        else:
            new += f"## {heading}\n\n{block}\n"
    return text[:first].rstrip() + f"\n\n{new}" + text[first:]


# ---- instance templates


def template(module):
    """An instance to copy: every parameter with its default, every port at a net of its name."""
    parameters, ports = declared(module)
    _, widths = parse(module)
    defaults = {}
    for name, value, _ in parameters:  # a default may name parameters before it, which an instance does not see
        defaults[name] = re.sub(r"(?<![\w`])[A-Z]\w*", lambda word: defaults.get(word[0], word[0]), value)
    lines = [f"    .{name}({defaults[name]})" + "," * (name != parameters[-1][0]) for name, _, _ in parameters]
    notes = [f"default: {value}" if defaults[name] != value else "" for name, value, _ in parameters]
    text = [f"{line}  // {note}" if note else line for line, note in zip(lines, notes)]
    if "`" in "".join(defaults.values()):
        text.insert(0, "    // the macros are those of cchip_defs.vh")
    last, body = None, []
    length = max(len(name) for name, _, _ in widths)
    for (*_, group), (name, direction, width) in zip(ports, widths):
        if group != last:
            last = group
            body.append(f"    // {re.split('[:;]', group)[0]}")
        pin = f"    .{name}({name})" + "," * (name != widths[-1][0])
        body.append(f"{pin:{2 * length + 8}}  // {direction}{'' if width == '1' else ', ' + width}")
    return "\n".join(["```verilog", f"{module} #(", *text, f") u_{module.removeprefix('cchip_')} (", *body,
                      ");", "```", ""])


def harness(module):
    """The template within a module that declares its nets as the RTL declares the ports."""
    parameters, ports = declared(module)
    code = re.search(r"^```verilog\n(.*?)^```$", datasheet(module), re.M | re.S)[1]
    nets = "".join(f"  wire {f'[{top}:0] ' if top else ''}{name};\n" for _, top, name, _, _ in ports)
    constants = "".join(f"  localparam integer {name} = {value};\n" for name, value, _ in parameters)
    return f"module template_{module};\n{constants}{nets}{code}endmodule\n"


def elaborate_templates():
    """Icarus Verilog reads every template; what it says about one is a finding."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "templates.v"
        path.write_text('`include "cchip_defs.vh"\n`default_nettype none\n'
                        + "".join(harness(module) for module in INSTANTIATED))
        command = ["iverilog", "-g2005", "-Wall", "-Irtl/include", "-o", f"{folder}/templates.vvp",
                   *(word for module in INSTANTIATED for word in ("-s", f"template_{module}")),
                   *rtl_files().values(), str(path)]
        result = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    said = [line for line in result.stdout.splitlines() if "templates.v" in line or "error" in line]
    print("\n".join([*said, f"{len(INSTANTIATED)} instance templates, "
                            f"{'wrong' if said or result.returncode else 'elaborated'}"]))
    return 1 if said or result.returncode else 0


# ---- check


def findings(module):
    rtl, page = rtl_files()[module], MODULES / f"{module}.md"
    parameters, ports = declared(module)
    yield from (f"{rtl}: {name}: no comment says what it means" for name, _, meaning in parameters if not meaning)
    yield from (f"{rtl}: {name}: no comment says what it means" for _, _, name, meaning, _ in ports if not meaning)
    if module in INSTANTIATED and None in [group for *_, group in ports]:
        yield f"{rtl}: a line like '// ---- request' is to begin the ports"
    if module not in figures():
        yield f"{FIGURES.relative_to(ROOT)}: no row {module}: scripts/datasheet.py {module}"
    link = f"modules/{module}.md" if page.exists() else f"../{rtl}"
    if f"({link})" not in (ROOT / "docs" / "README.md").read_text():
        yield f"docs/README.md: no link to {link}"
    if not page.exists() and f"\n// {module}: " not in (ROOT / rtl).read_text():
        yield f"{rtl}: no header comment that begins with '// {module}: '"
    for _, name, _ in blocks(module):
        if not page.exists() or not re.search(BLOCK.format(f" {name}" if name else ""), page.read_text(), re.S):
            yield f"{page.relative_to(ROOT)}: no '{begin(name)}' with '<!-- generated: end -->' behind it"


def check():
    found = [finding for module in rtl_files() for finding in findings(module)]
    for path in sorted(MODULES.glob("*.md")):
        if path.stem not in rtl_files():
            found.append(f"{path.relative_to(ROOT)}: no such module in rtl/cchip.f")
    found += [f"{FIGURES.relative_to(ROOT)}: {module}: no such module in rtl/cchip.f"
              for module in figures() if module not in rtl_files()]
    folders = [ROOT / name / "README.md" for name in ("rtl", "sim", "lib", "cpp_ref", "bench", "tests")]
    for path in [README, ROOT / "CONTRIBUTING.md", *folders, *sorted((ROOT / "docs").rglob("*.md"))]:
        for name in re.findall(r"`((?:tests|bench)/[\w/]+\.cpp)`", path.read_text()):
            if not (ROOT / name).exists():
                found.append(f"{path.relative_to(ROOT)}: names {name}, which does not exist")
        for link in re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", path.read_text()):
            if not (path.parent / link).exists():
                found.append(f"{path.relative_to(ROOT)}: link to {link}, which does not exist")
    count = sum(len(part) for module in rtl_files() for part in declared(module))
    print("\n".join(found) if found else f"{len(rtl_files())} modules, {count} parameters and ports, each with its "
                                         "meaning")
    return 1 if found or not count else 0


def main():
    arguments = sys.argv[1:]
    option = arguments[0] if arguments and arguments[0].startswith("-") else None
    if option in ("-h", "--help"):
        print(__doc__)
    elif option == "--check" and len(arguments) == 1:
        return check()
    elif option == "--latency" and len(arguments) == 2 and arguments[1] in STIMULI:
        print(latency(arguments[1]))
    elif option == "--stream":
        print(stream(*arguments[1:]), end="")
    elif option == "--widths" and len(arguments) == 1:
        print(widths(), end="")
    elif option == "--leaves" and len(arguments) == 1:
        print(leaves(), end="")
    elif option == "--bounds" and len(arguments) == 1:
        print(bounds(), end="")
    elif option == "--templates" and len(arguments) == 1:
        return elaborate_templates()
    elif option == "--page" and len(arguments) == 2 and arguments[1] in rtl_files():
        print(datasheet(arguments[1]), end="")
    elif arguments == ["--write", "simulation"]:
        write_simulation()
    elif option == "--compare" and arguments[1:] in (["simulation"], ["all"]):
        return compare(arguments[1])
    elif option or not set(arguments) <= set(pages()):
        print(__doc__, file=sys.stderr)
        return 2
    else:
        for page in arguments or pages():
            for path, name, make in blocks(page):
                rewrite(path, name, make())
        write_figures({page: measured(page) for page in arguments or pages() if page in rtl_files()})
    return 0


if __name__ == "__main__":
    sys.exit(main())
