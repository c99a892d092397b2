#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/fpga.py: reading of reports, cache of tool runs, harness.

report.json and stat.json are recorded: one run of nextpnr-ecp5 0.11.1 without the unused kinds of block, and the
statistics of Yosys 0.23 of a design in the harness. Environment: VERILATOR, IVERILOG, YOSYS, CAMPAIGN
(cchip_campaign)."""
import contextlib
import copy
import io
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(ROOT / "scripts"), str(ROOT / "tests")]
import datasheet  # noqa: E402
import fpga  # noqa: E402
import placed  # noqa: E402
from tools import run, tool  # noqa: E402


class Reports(unittest.TestCase):
    def setUp(self):
        self.report = json.loads((HERE / "report.json").read_text())
        self.stat = (HERE / "stat.json").read_text()

    def figures(self, clocks, row=None):
        """Figures of a row whose seeds 1, 2.. reached these clocks."""
        reports = {}
        for seed, clock in enumerate(clocks, 1):
            reports[seed] = clock and copy.deepcopy(self.report)
            if not clock:
                continue
            for domain in reports[seed]["fmax"].values():
                domain["achieved"] = clock
        beats = {fpga.TYPICAL: {"exhaustive": 10.0, "directed": 2.5}}
        return fpga.figures(row or fpga.rows()["tri_tri"], HERE, reports, beats)

    def test_delays_of_the_critical_path_add_up_to_the_period(self):
        period = sum(part["delay"] for part in fpga.critical_path(self.report))
        self.assertAlmostEqual(period, 1e3 / fpga.fmax(self.report), places=2)

    def test_the_slowest_clock_counts(self):
        self.report["fmax"]["slow"] = {"achieved": 12.5, "constraint": 250}
        self.assertEqual(fpga.fmax(self.report), 12.5)

    def test_paths_from_and_to_pins_do_not_count(self):
        for path in self.report["critical_paths"]:
            if "<async>" in (path["from"], path["to"]):
                path["path"][0]["delay"] = 1000
        self.assertLess(sum(part["delay"] for part in fpga.critical_path(self.report)), 1000)

    def test_critical_path_in_words(self):
        words = fpga.in_words(fpga.critical_path(self.report))
        ends = re.match(r"register `(\S+)` -> register `(\S+)`: ", words)
        self.assertEqual(ends.group(1), "u_pipeline.u_user.genblk3.gen_memory.q_q")
        self.assertEqual(ends.group(2), "u_controller.u_free.valid_q")
        logic, routing = map(float, re.search(r"; ([\d.]+) ns logic, ([\d.]+) ns routing$", words).groups())
        self.assertAlmostEqual(logic + routing, 1e3 / fpga.fmax(self.report), delta=0.11)

    def test_ends_of_a_path(self):
        for port, kind in (("Q", "register"), ("DI", "register"), ("CE", "register"), ("P17", "multiplier"),
                           ("A3", "multiplier"), ("DOA5", "block RAM"), ("ADB11", "block RAM")):
            self.assertEqual(fpga.block_of("u_dut.u_x.q", port), kind, port)
        self.assertEqual(fpga.block_of("u_dut.u_x.mem.0.7$DPRAM_COMB3", "WRE"), "distributed RAM")
        for cell, name in (("u_dut.u_primtest.u_pipeline.u_axis.q_TRELLIS_FF_Q_3", "u_pipeline.u_axis.q"),
                           ("u_dut.u_primtest.u_operands.mem.0.4", "u_operands.mem.0.4"),
                           ("u_dut.gen_lane[2].u_lane.u_primtest.q_TRELLIS_FF_Q", "gen_lane[2].u_lane.u_primtest.q"),
                           ("out_r_TRELLIS_FF_Q_7", "harness: out_r")):
            self.assertEqual(fpga.name_of(cell), name)

    def test_cells_are_those_of_the_module_alone(self):
        module, regions, harness = fpga.module_cells(fpga.cells(self.stat))
        self.assertEqual(regions, {})
        design = json.loads(self.stat)["design"]["num_cells_by_type"]
        for cell in ("LUT4", "TRELLIS_FF", "CCU2C", "MULT18X18D"):
            self.assertEqual(module[cell] + harness.get(cell, 0), design[cell], cell)
        self.assertGreater(harness["TRELLIS_FF"], 0)
        self.assertNotIn("MULT18X18D", harness)

    def test_cells_of_regions_count_once_per_slot(self):
        module = lambda cells: {"num_cells_by_type": cells}
        modules = {"\\fpga_harness": module({"LUT4": 1, "$paramod\\fpga_subsystem\\SLOTS=2": 1}),
                   "$paramod\\fpga_subsystem\\SLOTS=2": module(
                       {"TRELLIS_FF": 3, "$paramod$1\\cchip_primtest_subsystem": 1}),
                   "$paramod$1\\cchip_primtest_subsystem": module({"LUT4": 10, "$paramod$2\\cchip_pr_region": 2}),
                   "$paramod$2\\cchip_pr_region": module({"LUT4": 100, "inner": 1}),
                   "\\inner": module({"LUT4": 1000})}
        static, regions, harness = fpga.module_cells(fpga.cells(json.dumps({"modules": modules})))
        self.assertEqual((static, regions, harness), ({"LUT4": 10}, {"LUT4": 2200}, {"LUT4": 1, "TRELLIS_FF": 3}))

    def test_slowest_ends_by_register(self):
        end = lambda cell, delay, event="posedge clk": {"cell": f"u_dut.{cell}", "delay": [delay - 0.5, delay],
                                                        "event": event, "port": "DI"}
        nets = [{"event": "posedge clk", "endpoints": [end("a_TRELLIS_FF_Q", 3.0), end("b_TRELLIS_FF_Q_1", 5.0)]},
                {"event": "posedge clk", "endpoints": [end("b_TRELLIS_FF_Q_2", 4.0),
                                                       end("c_TRELLIS_FF_Q", 9, "<async>")]},
                {"event": "<async>", "endpoints": [end("d_TRELLIS_FF_Q", 9.0)]},
                {"event": "posedge clk", "endpoints": [end("e_TRELLIS_FF_Q", 1.0)]}]
        self.assertEqual(fpga.endpoints({"detailed_net_timings": nets}, 2), [["b", 5.0], ["a", 3.0]])

    def test_median_and_rates(self):
        row = self.figures([100.0, 300.0, 200.0])
        self.assertEqual((row["fmax_min"], row["fmax_median"], row["fmax_max"]), (100.0, 200.0, 300.0))
        self.assertEqual(row["pairs_per_s"][fpga.TYPICAL], {"exhaustive": 20e6, "directed": 80e6})
        self.assertEqual(self.figures([100.0, 300.0])["fmax_median"], 200.0)
        array = self.figures([100.0], fpga.rows()["array6"])
        self.assertEqual(array["pairs_per_s"][fpga.TYPICAL]["exhaustive"], 60e6)

    def test_last_line(self):
        line = fpga.last_line(self.figures([99.96]))
        self.assertRegex(line, r"^tri_tri w=16 lut=\d+ ff=\d+ dsp=24 ram=\d+ fmax_mhz=100\.0 seeds=1$")
        line = fpga.last_line(self.figures([80.0] * 3, fpga.rows()["tri_tri_w18"]))
        self.assertRegex(line, r"^tri_tri w=18 .* seeds=3$")

    def test_seeds_that_did_not_route_are_counted(self):
        row = self.figures([100, None, 80, 90])
        self.assertEqual(row["fmax_median"], 90)
        self.assertEqual(fpga.clocks_of(row), "80.0 / 90.0 / 100.0, 3 of 4 seeds")
        self.assertRegex(fpga.last_line(row), r" fmax_mhz=90\.0 seeds=3 of 4$")

    def test_a_tool_that_does_not_end_is_named(self):
        program = "import resource; resource.setrlimit(resource.RLIMIT_CPU, (1, 2))\nwhile True: pass"
        with (tempfile.TemporaryDirectory() as folder,
              unittest.mock.patch.object(fpga, "ROOT", pathlib.Path(folder)),
              self.assertRaisesRegex(fpga.ToolError, r"^endless: python3\S* did not end within --limit$")):
            fpga.step("endless", [sys.executable, "-c", program], {}, [], "never", pathlib.Path(folder))

    def test_tables_have_a_row_for_each_row(self):
        row = self.figures([100.0])
        row["families"] = {family: {**{column: 1 for column in columns}, "packed": 1}
                           for family, (_, columns, *_) in fpga.FAMILIES.items()}
        found = {"tri_tri": row, "tri_quad": row}
        self.assertEqual(fpga.area_table(found).count("\n"), 2 + 2)
        self.assertEqual(fpga.classes_table(found).count("\n"), 2 + 2)
        self.assertEqual(fpga.families_table(found).count("\n"), 2 + 2 * len(fpga.FAMILIES))

    def test_families_that_were_not_counted_keep_their_lines(self):
        counts = {column: 12345 for column in fpga.FAMILIES["Gowin"][1]}
        found = {"tri_tri": {"families": {"Gowin": counts}}, "quad_quad": {"families": {}}}
        before = fpga.present_table("families")
        after = fpga.with_others("families", fpga.families_table(found), found).splitlines()
        self.assertEqual(len(after), len(before))
        changed = [(old, new) for old, new in zip(before, after) if old != new]
        self.assertEqual(len(changed), 1)
        self.assertRegex(changed[0][0], r"^\| `?tri_tri`? \| Gowin \|")
        self.assertIn("12345", changed[0][1])

    def test_a_family_that_does_not_end_leaves_the_others(self):
        def count(row, family):
            if family == "Gowin":
                raise fpga.ToolError("yosys failed (exit code -9)")
            return {**{column: 1 for column in fpga.FAMILIES[family][1]}, "packed": 0}

        options = fpga.arguments(["chip", "--families", "--family", "Gowin", "--family", "GateMate"])
        with unittest.mock.patch.object(fpga, "count_family", count), unittest.mock.patch("builtins.print") as said, \
                unittest.mock.patch.object(fpga, "say"):
            self.assertEqual(fpga.count_families([fpga.rows()["chip"]], options), 1)
        self.assertIn("| `chip` | GateMate | 1 |", said.call_args[0][0])
        self.assertNotIn("Gowin", said.call_args[0][0])

    def test_page_has_a_place_for_every_table(self):
        for name in (*fpga.TABLES, *fpga.SUBSYSTEMS, "families"):
            self.assertTrue(re.search(datasheet.BLOCK.format(f" {name}"), fpga.page_of(name).read_text(), re.S), name)


class OwnFolder(unittest.TestCase):
    """fpga.py works in a folder of its own."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root, self.build = fpga.ROOT, fpga.BUILD
        fpga.ROOT = pathlib.Path(self.folder.name)
        fpga.BUILD = fpga.ROOT / "build"
        self.addCleanup(self.restore)

    def restore(self):
        fpga.ROOT, fpga.BUILD = self.root, self.build


class Floorplan(unittest.TestCase):
    """Block RAMs and multipliers of a chip by the names that its instances have."""
    @staticmethod
    def chip(cache_blocks=56, test=36):
        core = "u_dut.u_core."
        broad = core + "u_broad_phase."
        rams = [f"{broad}u_cache.u_data.gen_blocks.gen_block[{i}].u_block" for i in range(cache_blocks)] + \
            [f"{broad}u_cache.u_fill.gen_beat[{b}].u_beats.gen_block[{i}].u_block" for b in range(4)
             for i in range(4)] + \
            [f"{broad}u_cache.gen_port[{p}].u_port.u_entries.gen_block[{i}].u_block" for p in range(2)
             for i in range(4)] + \
            [f"{broad}u_get_data.u_pairs.gen_port[{p}].u_lines.gen_block[{i}].u_block" for p in range(2)
             for i in range(14)] + \
            [f"{broad}u_bv_unit.u_feed.u_{side}.gen_block[{i}].u_block" for side in "ab" for i in range(12)] + \
            [f"{core}u_queues.u_memory.gen_block[0].u_block"]
        multipliers = [f"{broad}u_bv_unit.u_lane_a.gen_direction[{i}].u_block" for i in range(77)] + \
            [f"{core}u_transform.u_vertices.u_mul[{i}].u_block"
             for i in range(36)] + [f"{core}u_slots.u_mul[{i}].u_block" for i in range(test)]
        return {**dict.fromkeys(rams, "DP16KD"), **dict.fromkeys(multipliers, "MULT18X18D"),
                "u_dut.u_core.x_LUT4_A": "TRELLIS_COMB"}

    def test_each_has_a_place_of_its_own_and_its_kind(self):
        for cache_blocks in (7, 28, 56, 120):
            for test in (24, 36):
                kinds = self.chip(cache_blocks, test)
                found = fpga.floorplan.anchors(kinds)
                self.assertEqual(set(found), {cell for cell, kind in kinds.items() if kind != "TRELLIS_COMB"})
                self.assertEqual(len(set(found.values())), len(found))
                for cell, bel in found.items():
                    self.assertRegex(bel, r"/Y(22|46|70|82)/EBR[0-3]$" if kinds[cell] == "DP16KD"
                                     else r"/Y(10|34|58)/MULT18_[0145]$")

    def test_rams_of_the_same_bits_lie_beside_each_other(self):
        found = fpga.floorplan.anchors(self.chip())
        pairs = "u_dut.u_core.u_broad_phase.u_get_data.u_pairs"
        name = lambda port, block: f"{pairs}.gen_port[{port}].u_lines.gen_block[{block}].u_block"
        column = lambda port, block: int(re.search(r"X(\d+)", found[name(port, block)])[1])
        self.assertTrue(all(abs(column(0, block) - column(1, block)) <= 3 for block in range(14)))

    def test_more_than_the_device_has_is_an_error(self):
        with self.assertRaisesRegex(ValueError, "has 156 MULT18X18D, the design needs 163"):
            fpga.floorplan.anchors(self.chip(test=50))

    def test_the_netlist_keeps_everything_else(self):
        text = json.dumps(
            {"modules": {"top": {"cells": {"u_slots.a": {"type": "MULT18X18D", "attributes": {"src": "x"}},
                                           "b": {"type": "LUT4"}}}}})
        top = json.loads(fpga.floorplan.anchored(text, {"router2/bbMargin/x": "14"}))["modules"]["top"]
        cells = top["cells"]
        self.assertEqual(top["settings"], {"router2/bbMargin/x": "14"})
        self.assertEqual(cells["u_slots.a"]["attributes"], {"src": "x", "BEL": "X78/Y10/MULT18_0"})
        self.assertEqual(cells["b"], {"type": "LUT4"})

    def test_tiles_that_stay_empty_are_full_of_cells_without_nets(self):
        empty = fpga.floorplan.empty_tiles()
        places = {cell["attributes"]["BEL"] for cell in empty.values()}
        tiles = sum(len(columns) * len(rows) for columns, rows in fpga.floorplan.EMPTY)
        self.assertEqual((len(empty), len(places)), (16 * tiles,) * 2)  # zones do not overlap
        self.assertTrue(all(cell["connections"] == {} for cell in empty.values()))
        self.assertEqual({cell["type"] for cell in empty.values()}, {"LUT4", "TRELLIS_FF"})
        # of a tile: all there is
        self.assertEqual({place.split("/")[2] for place in places if place.startswith("X66/Y71/")},
                         {f"SLICE{part}.{kind}{half}" for part in "ABCD" for kind in ("K", "FF") for half in "01"})
        # none where a block RAM or a multiplier may be
        self.assertFalse({int(place.split("/Y")[1].split("/")[0]) for place in places} & {10, 22, 34, 46, 58, 70, 82})

    def test_the_picture_has_each_block_in_its_colour(self):
        svg = fpga.floorplan.picture({"a": (1, 2), "b": (1, 2), "c": (9, 9)},
                                     {"a": "TRELLIS_FF", "b": "TRELLIS_FF", "c": "DP16KD"},
                                     lambda cell: "u_x" if cell in "ab" else "u_y", "title")
        self.assertEqual((svg.count("<rect"), svg.count("<path"), svg.count('stroke="#000"')), (1 + 1 + 3, 2, 1))
        self.assertIn(">u_x</text>", svg)


    def test_heat_is_drawn_where_it_is_in_one_scale(self):
        svg = fpga.floorplan.heat({"a": [["0", "4"], ["", "1"]], "b": [["9"]]})
        self.assertEqual((svg.count("<path"), svg.count("M0,")), (3, 1))
        self.assertIn("overused wires: 5, at most 4 in a tile", svg)
        self.assertIn("overused wires: 9, at most 9 in a tile", svg)


class Placement(unittest.TestCase):
    """A register a, a LUT behind it, a register b; a block RAM that b addresses: placed by hand, delays made up."""
    NETLIST = {"modules": {"unused": {"cells": {}}, "top": {"cells": {
        name: {"type": kind, "attributes": {"NEXTPNR_BEL": place}} for name, kind, place in (
            ("u_dut.u_core.u_x.a_TRELLIS_FF_Q", "TRELLIS_FF", "X2/Y3/SLICEA.FF0"),
            ("u_dut.u_core.u_x.a_LUT4_A", "TRELLIS_COMB", "X5/Y9/SLICEA.LUT0"),
            ("u_dut.u_core.u_y.b_TRELLIS_FF_Q_1", "TRELLIS_FF", "X70/Y60/SLICEA.FF0"),
            ("u_dut.u_core.u_y.u_ram.mem.0.0", "DP16KD", "X71/Y61/EBR0"))}}}}
    DELAYS = """
        (INTERCONNECT u_dut.u_core.u_x.a_TRELLIS_FF_Q/Q u_dut.u_core.u_x.a_LUT4_A/A (1000:1000:1000) (900:900:900))
        (INTERCONNECT u_dut.u_core.u_x.a_LUT4_A/F u_dut.u_core.u_y.b_TRELLIS_FF_Q_1/DI (6000:6000:6000) (6000:6000:6000))
        (INTERCONNECT u_dut.u_core.u_y.b_TRELLIS_FF_Q_1/Q u_dut.u_core.u_y.u_ram.mem.0.0/ADA3 (800:800:800) (800:800:800))
      (INSTANCE u_dut.u_core.u_x.a_TRELLIS_FF_Q)
        (IOPATH CLK Q (400:450:525) (400:450:525))
      (INSTANCE u_dut.u_core.u_x.a_LUT4_A)
        (IOPATH A F (100:200:240) (100:200:240))
      (INSTANCE u_dut.u_core.u_y.b_TRELLIS_FF_Q_1)
        (IOPATH CLK Q (400:450:525) (400:450:525))
      (SETUPHOLD (posedge DI) (posedge CLK) (10:20:35) (0:0:0))
      (INSTANCE u_dut.u_core.u_y.u_ram.mem.0.0)
      (SETUPHOLD (posedge ADA3) (posedge CLKA) (100:100:100) (0:0:0))
"""  # noqa: E501  lines of nextpnr

    def setUp(self):
        self.timing = placed.Placed(json.dumps(self.NETLIST), self.DELAYS)

    def test_the_latest_arrival_counts_cells_wires_and_set_up(self):
        (slow, end), (fast, other) = self.timing.ends()
        self.assertAlmostEqual(slow, 0.525 + 1.0 + 0.24 + 6.0 + 0.035)
        self.assertAlmostEqual(fast, 0.525 + 0.8 + 0.1)
        path = self.timing.path(slow, end)
        self.assertEqual((fpga.name_of(path.source), path.pin, self.timing.look_up_tables(path)),
                         ("u_core.u_x.a", "DI", 1))
        self.assertAlmostEqual(path.wire_ns, 7.0)
        self.assertEqual(other, ("u_dut.u_core.u_y.u_ram.mem.0.0", "ADA3"))

    def test_sources_are_ranked_and_blocks_have_a_place(self):
        sources = placed.ranking(self.timing, fpga.name_of, 5)
        self.assertEqual([(fpga.name_of(path.source), behind) for path, behind in sources],
                         [("u_core.u_x.a", 1), ("u_core.u_y.b", 0)])
        self.assertEqual(placed.spread(self.timing, fpga.block_in)["u_y"], (2, [[70, 71, 71], [60, 61, 61]]))

    def test_estimate_of_several_seeds(self):
        line = fpga.estimate_line("x", {1: self.timing, 2: self.timing}, 200)
        self.assertEqual(line, "x estimate_mhz=128.2 min=128.2 max=128.2 ends_behind_200_mhz=1 seeds=2")

    def test_rows_of_blocks_have_the_parameters_of_the_chip(self):
        # what each instance in the chip sets to a number is what its row says
        text = "".join((ROOT / "rtl" / file).read_text()
                       for file in ("chip/cchip_chip_core.v", "traversal/cchip_broad_phase.v"))
        chip = dict(datasheet.parse("cchip_chip")[0])
        chip.update(PLACES=int(chip["PAIRS"]) + int(chip["LEAVES"]), LEAF_W=6, CONTEXT_W=4, KINDS=3, PLACE_W=6)
        compared = 0
        for name, parameters in fpga.CHIP_PARAMETERS.items():
            instance = re.search(rf"{name} #\((.*?)\)\s*u_\w+ \(", text, re.S)
            if not instance:
                continue
            own = dict(datasheet.parse(name)[0]) | dict(parameters)
            for parameter, value in re.findall(r"\.(\w+) *\(([^()]*)\)", instance[1]):
                value = re.sub(r"(.+) \? (.+) : (.+)", r"\2 if \1 else \3", value)
                value = eval(value, {}, {key: int(n)
                                         for key, n in chip.items() if str(n).isdigit()}) if "`" not in value else None
                if value is not None:
                    self.assertEqual(int(own[parameter]), value, f"{name}.{parameter}")
                    compared += 1
        self.assertGreater(compared, 25)


class Steps(OwnFolder):
    def run_step(self, depends, script="echo run >> count; cat {}/in > {}/out"):
        return fpga.step("name", ["sh", "-c", script], {"in": "text"}, depends, "out")

    def runs(self):
        return (fpga.ROOT / "count").read_text().count("run")

    def test_a_step_runs_again_only_for_other_inputs(self):
        first = self.run_step([1])
        self.assertEqual((first / "out").read_text(), "text")
        self.assertEqual(self.run_step([1]), first)
        self.assertEqual(self.runs(), 1)
        self.assertNotEqual(self.run_step([2]), first)
        self.assertEqual(self.runs(), 2)

    def test_a_failing_tool_is_one_line_with_its_log(self):
        with self.assertRaises(fpga.ToolError) as caught:
            self.run_step([1], "echo 'ERROR: no such thing'; exit 3")
        message = str(caught.exception)
        self.assertNotIn("\n", message)
        self.assertIn("ERROR: no such thing", message)
        log = re.search(r"see (\S+?):", message).group(1)
        self.assertIn("no such thing", (fpga.ROOT / log).read_text())

    def test_without_its_product_a_tool_has_failed(self):
        with self.assertRaises(fpga.ToolError):
            self.run_step([1], "true")
        self.run_step([1])  # and is run again

    def test_a_row_that_fails_leaves_the_others(self):
        failures = []
        self.assertIsNone(fpga.attempt(failures, self.run_step, [1], "exit 1"))
        self.assertEqual(len(failures), 1)


class Bitstreams(OwnFolder):
    def test_only_those_of_todays_rtl_are_copied(self):
        of_today = "0123456789ab"
        fpga.BUILD.mkdir()
        (fpga.BUILD / "chip.bit").write_bytes(b"bits")
        made = {"file": "build/chip.bit", "seed": 2, "fmax_mhz": 71.5, "rtl": of_today}
        fpga.save({"chip": {"bitstream": made}, "chip_tri": {"bitstream": {**made, "rtl": "of before"}},
                   "chip_small": {"bitstream": {**made, "file": "build/gone.bit"}}, "tri_tri": {"bitstream": {}}})
        into = fpga.ROOT / "dist"
        into.mkdir()
        (into / "collisionchip-chip_tri-lfe5u85f.bit").write_bytes(b"of an earlier release")
        said = io.StringIO()
        with contextlib.redirect_stdout(said), unittest.mock.patch.object(fpga, "rtl_of", lambda row: of_today):
            self.assertEqual(fpga.copy_bitstreams(into), 0)
        self.assertEqual([path.name for path in into.iterdir()], ["collisionchip-chip-lfe5u85f.bit"])
        self.assertEqual((into / "collisionchip-chip-lfe5u85f.bit").read_bytes(), b"bits")
        self.assertEqual(said.getvalue(), f"chip seed=2 fmax_mhz=71.5 {into}/collisionchip-chip-lfe5u85f.bit\n")

    def test_without_any_nothing_is_copied(self):
        self.assertEqual(fpga.copy_bitstreams(fpga.ROOT / "dist"), 0)
        self.assertEqual(list((fpga.ROOT / "dist").iterdir()), [])


class Beats(OwnFolder):
    def beats(self, campaign):
        return fpga.mean_beats("tri-tri", fpga.argparse.Namespace(campaign=campaign, pairs=500))

    def test_general_pairs_take_every_axis_or_at_most_four(self):
        means = self.beats(os.environ["CAMPAIGN"])[fpga.TYPICAL]
        self.assertEqual(means["exhaustive"], 2 + 3 * 3)
        self.assertTrue(1 < means["directed"] < 4, means)

    def test_without_the_campaign_there_are_none(self):
        self.assertEqual(self.beats("no/such/program"), {})


class Harness(unittest.TestCase):
    ROWS = {"tri_tri": (), "tri_tri_w18": (), "quad_quad": (), "array6": (("LANES", 2),)}

    def each_row(self):
        for name, parameters in self.ROWS.items():
            row = fpga.rows()[name]
            row = fpga.dataclasses.replace(row, files="cchip.f", parameters=parameters or row.parameters)
            files = [file for file in fpga.sources(row) if file.endswith(".v")]
            yield row, files

    def clean(self, *command):
        self.assertEqual(run(*command, cwd=ROOT), (0, ""), " ".join(command))

    def test_verilator(self):
        for row, files in self.each_row():
            self.clean(tool("verilator"), "--lint-only", "-Wall", "-Irtl/include", *row.macros(),
                       "rtl/lint/verilator_waiver.vlt", *files, "--top-module", "fpga_harness")

    def test_icarus(self):
        for row, files in self.each_row():
            self.clean(tool("iverilog"), "-g2005", "-Wall", "-t", "null", "-Irtl/include",
                       *row.macros(), "-s", "fpga_harness", *files)

    def test_yosys(self):
        for row, files in self.each_row():
            self.clean(tool("yosys"), "-q", "-p", fpga.read_verilog(files, *row.macros()) +
                       "hierarchy -check -top fpga_harness; proc; check -assert; select -assert-none t:$dlatch")

    def test_synthesis_keeps_a_register_for_every_port(self):
        row = fpga.rows()["tri_tri"]
        _, ports = datasheet.parse(row.top)
        bits = {direction: sum(eval(width, {"COORD_W": row.coord_w}) for name, d, width in ports
                               if d == direction and name != "clk") for direction in ("input", "output")}
        expected, fold = 2 * bits["input"] + bits["output"], bits["output"]
        while fold > 1:
            fold = -(-fold // 5)
            expected += fold
        files = [file for file in fpga.sources(row) if file.endswith(".v") and file != fpga.HARNESS]
        out = subprocess.run([tool("yosys"), "-p", fpga.read_verilog(files, "-lib") +
                              fpga.read_verilog([fpga.HARNESS], *row.macros()) + "synth -top fpga_harness; "
                              "select -count t:*DFF*"], cwd=ROOT, check=True, stdout=subprocess.PIPE, text=True).stdout
        self.assertEqual(int(re.findall(r"^(\d+) objects\.$", out, re.M)[-1]), expected)


if __name__ == "__main__":
    unittest.main()
