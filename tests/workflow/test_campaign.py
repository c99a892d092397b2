#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A campaign in shards, with shards killed in the middle, has the counts of the campaign in one piece.

usage: test_campaign.py [Merge|Local|Slurm|Sweep|Dask]      environment: CCHIP_BIN, the folder with cchip_campaign
Sweep: the table of scripts/run fpga-sweep from made-up clocks. Dask: scripts/run test-dask, with fewer queries. Merge
and Sweep need neither Snakemake nor Dask. Exit codes: 0 passed, 1 failed, 77 skipped."""
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SNAKEMAKE = ROOT / "build/workflow/bin/snakemake"
CAMPAIGN = ROOT / "workflow/campaign.py"
BIN = pathlib.Path(os.environ.get("CCHIP_BIN", ROOT / "build/release/bin")).resolve()
PART = 1 << 16


def call(*command, **more):
    return subprocess.run([sys.executable, CAMPAIGN, *map(str, command)], cwd=ROOT, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, **more)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.folder.chmod(0o711)  # for the socket of munged

    def settings(self, kind, amount, shards):
        return ["--kind", kind, "--amount", amount, "--shards", shards, "--seed", 5]

    def piece(self, *settings):
        made = call("piece", *settings, "--bin", BIN, "--output", self.folder / "piece.csv")
        self.assertEqual(made.returncode, 0, made.stdout)
        return (self.folder / "piece.csv").read_text()

    def programs(self):
        """A folder whose cchip_campaign writes its process ID before it becomes the real one."""
        folder = self.folder / "bin"
        folder.mkdir()
        (self.folder / "pids").mkdir()
        (folder / "cchip_campaign").write_text(
            f'#!/bin/sh\n: > "{self.folder}/pids/$$"\nexec "{BIN}/cchip_campaign" "$@"\n')
        (folder / "cchip_campaign").chmod(0o755)
        return folder

    def snakemake(self, profile, kind, amount, shards, before=()):
        return [*map(str, before), str(SNAKEMAKE), "--snakefile", "workflow/Snakefile", "--profile",
                f"workflow/profiles/{profile}",
                "--cores", "2", "--config", f"kind={kind}", f"amount={amount}", f"shards={shards}", "seed=5",
                f"bin={self.folder}/bin", f"folder={self.folder}"]

    def results(self):
        return {path.name: path.stat().st_mtime_ns for path in self.folder.glob("*-in*/shard*.json")}


class Merge(Case):
    """What campaign.py refuses, and that shards of every kind add up."""

    def shards(self, kind, amount, shards):
        settings = self.settings(kind, amount, shards)
        files = [self.folder / f"{kind}{shard}.json" for shard in range(shards)]
        for shard, file in enumerate(files):
            made = call("run", *settings, "--shard", shard, "--bin", BIN, "--output", file)
            self.assertEqual(made.returncode, 0, made.stdout)
        return settings, files

    def merge(self, settings, files):
        return call("merge", *settings, "--output", self.folder / "table.csv", *files)

    def test_kinds(self):
        for kind, amount, shards in (("random", PART + 100, 2), ("grid", PART + 100, 2), ("relation", PART + 100, 2),
                                     ("certainty", PART + 100, 2), ("boxes", PART + 100, 2), ("swaps", 100, 2),
                                     ("chip", 20, 2), ("faults", 20, 2)):
            program = {"swaps": "cchip_swaps", "chip": "cchip_chip_campaign", "faults": "cchip_chip_campaign"}.get(kind)
            if program and not (BIN / program).exists():
                continue
            with self.subTest(kind):
                settings, files = self.shards(kind, amount, shards)
                merged = self.merge(settings, files)
                self.assertEqual(merged.returncode, 0, merged.stdout)
                self.assertEqual((self.folder / "table.csv").read_text(), self.piece(*settings))

    def test_refused(self):
        settings, files = self.shards("relation", 2 * PART, 2)
        text = files[1].read_text()
        for wrong, why in ((text[:-40], "relation1.json"), (text.replace('"seed": 5', '"seed": 6'), "seed is 6"),
                           (files[0].read_text(), "shard 0 is in"),
                           (text.replace('"program": "', '"program": "0'), "builds"),
                           (text.replace("--pairs", "--coord-w"), "other commands")):
            with self.subTest(why):
                files[1].write_text(wrong)
                merged = self.merge(settings, files)
                self.assertEqual(merged.returncode, 1)
                self.assertIn(why, merged.stdout)
        merged = self.merge(settings, files[:1])
        self.assertEqual((merged.returncode, "shards are missing: 1" in merged.stdout), (1, True))
        self.assertFalse((self.folder / "table.csv").exists())

    def test_wrong_results(self):
        """A shard with wrong results is counted, and the campaign ends with exit code 3."""
        settings, files = self.shards("relation", 2 * PART, 2)
        shard = json.loads(files[1].read_text())
        shard["counts"]["total"]["wrong"] = 1
        files[1].write_text(json.dumps({**shard, "exit_code": 3}))
        merged = self.merge(settings, files)
        self.assertEqual((merged.returncode, "wrong=1 wrong_shards=1" in merged.stdout), (3, True))


@unittest.skipUnless(SNAKEMAKE.exists(), "no build/workflow: make build/workflow/requirements.txt")
class Local(Case):
    def test_two_shards_killed(self):
        kind, amount, shards = "relation", 20 * PART - 1000, 20
        self.programs()
        command = self.snakemake("local", kind, amount, shards)
        with (self.folder / "log").open("w") as log:
            running = subprocess.Popen(command, cwd=ROOT, stdout=log, stderr=log)
            killed, seen = 0, set()
            while running.poll() is None:
                for pid in sorted({path.name for path in (self.folder / "pids").iterdir()} - seen, key=int):
                    seen.add(pid)
                    if killed < 2 and len(seen) in range(5, 20, 4):  # the fifth shard and the ninth, or a later one
                        try:
                            os.kill(int(pid), signal.SIGKILL)
                            killed += 1
                        except ProcessLookupError:
                            pass
                time.sleep(0.02)
        text = (self.folder / "log").read_text()
        self.assertEqual((running.returncode, killed), (0, 2), text)
        self.assertEqual(text.count("exit code -9"), 2, text)
        table = next(self.folder.glob("*-in20/table.csv"))
        self.assertEqual(table.read_text(), self.piece(*self.settings(kind, amount, shards)))
        print(f"shards={shards} killed={killed} runs={len(seen)} {text[text.index('pairs='):].splitlines()[0]}")
        # again: nothing is made but what is missing
        before = self.results()
        table.unlink()
        (table.parent / "shard7.json").unlink()
        again = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(again.returncode, 0, again.stdout)
        after = self.results()
        self.assertEqual([name for name in after if after[name] != before[name]], ["shard7.json"])
        self.assertEqual(table.read_text(), (self.folder / "piece.csv").read_text())


@unittest.skipUnless(SNAKEMAKE.exists(), "no build/workflow: make build/workflow/requirements.txt")
class Slurm(Case):
    def test_job_killed(self):
        """Under a real Slurm on loopback; this script calls itself in it, as Killer."""
        kind, amount, shards = "relation", 8 * PART - 1000, 8
        self.programs()
        command = self.snakemake("slurm", kind, amount, shards,
                                 [ROOT / "tests/workflow/slurm.sh", self.folder / "slurm",
                                 sys.executable, "-B", __file__, "--kill"])
        made = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=560)
        if made.returncode == 77:
            self.skipTest(made.stdout)
        print(*(line for line in made.stdout.splitlines() if re.match(r"killed|Trying|pairs=", line)), sep="\n")
        self.assertEqual(made.returncode, 0, made.stdout)
        self.assertEqual(made.stdout.count("killed job"), 1)
        self.assertIn("Trying to restart", made.stdout)
        table = next(self.folder.glob("*-in8/table.csv"))
        self.assertEqual(table.read_text(), self.piece(*self.settings(kind, amount, shards)))


class Sweep(Case):
    """What scripts/run fpga-sweep places and merges."""

    def test_place(self):
        """A netlist that is there, and a program in the place of nextpnr that notes what it was asked."""
        tool = self.folder / "nextpnr"
        tool.write_text("#!/bin/sh\n[ $# = 1 ] && echo 1 && exit\necho \"$@\" > %s/asked\n"
                        "while [ $# -gt 1 ]; do [ \"$1\" = --report ] && echo '{\"fmax\": {\"clk\": {\"achieved\": "
                        "101.5}}}' > \"$2\"; shift; done\n" % self.folder)
        tool.chmod(0o755)
        (ROOT / "build/fpga").mkdir(parents=True, exist_ok=True)
        made = tempfile.TemporaryDirectory(dir=ROOT / "build/fpga", prefix="sweep-")
        self.addCleanup(made.cleanup)
        (pathlib.Path(made.name) / "netlist.json").write_text("{}")
        (self.folder / "synth.json").write_text(
            json.dumps({"row": "tri_tri", "synthesis": pathlib.Path(made.name).name}))
        before = set(ROOT.glob("build/fpga/tri_tri.seed3-*"))
        self.addCleanup(lambda: [shutil.rmtree(left) for left in set(ROOT.glob("build/fpga/tri_tri.seed3-*")) - before])
        done = subprocess.run([sys.executable, "-B", ROOT / "workflow/fpga_sweep.py", "place", "tri_tri", "3",
                               self.folder / "synth.json", self.folder / "placed.json",
                               f"--nextpnr={tool}", "--freq=125"], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        placed = json.loads((self.folder / "placed.json").read_text())
        self.assertEqual((placed["row"], placed["seed"], placed["fmax_mhz"]), ("tri_tri", 3, 101.5))
        self.assertIn("--freq 125.0 --seed 3", (self.folder / "asked").read_text())

    def merge(self, shards, seeds=2):
        files = []
        for number, (row, seed, clock) in enumerate(shards):
            files.append(self.folder / f"{number}.json")
            files[-1].write_text(json.dumps({"row": row, "synthesis": "", "seed": seed, "fmax_mhz": clock}))
        return subprocess.run([sys.executable, "-B", ROOT / "workflow/fpga_sweep.py", "merge", self.folder / "t.csv",
                               *files, "--seeds", str(seeds),
                               "--parameter", "SUBSTAGES"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    def test_table(self):
        made = self.merge([("tri_tri", 1, 100.0), ("tri_tri_substages6", 1, 90.0), ("tri_tri", 2, 110.5),
                           ("tri_tri_substages6", 2, 80.0)])
        self.assertEqual(made.returncode, 0, made.stdout)
        lines = (self.folder / "t.csv").read_text().splitlines()[1:]
        self.assertEqual(lines, ["tri_tri,SUBSTAGES,10,2,110.5,105.25,100.0",
                                 "tri_tri_substages6,SUBSTAGES,6,2,90.0,85.0,80.0"])

    def test_refused(self):
        for shards, why in (([("tri_tri", 1, 1.0)], "not one result for each"),
                            ([("tri_tri", 1, 1.0)] * 2, "there twice")):
            made = self.merge(shards)
            self.assertEqual((made.returncode, why in made.stdout), (1, True), made.stdout)
        self.assertFalse((self.folder / "t.csv").exists())


@unittest.skipUnless((ROOT / "build/dask/installed").exists(), "no build/dask: scripts/run test-dask")
class Dask(unittest.TestCase):
    def test_workers_killed(self):
        made = subprocess.run([ROOT / "build/dask/bin/python", "-B", ROOT / "lib/python/tests/over_dask.py", "50000"],
                              stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=500)
        self.assertEqual(made.returncode, 0, made.stdout)
        self.assertRegex(made.stdout.splitlines()[-1], r"^queries=[0-9]+ differing=0 lost=0$")


def run_and_kill(command):
    """Runs a command and kills one running job of Slurm while it does, the third one or a later one; its exit code."""
    running = subprocess.Popen(command)
    killed = False
    while running.poll() is None:
        jobs = subprocess.run(["squeue", "--noheader", "--states=RUNNING", "--format=%i"], stdout=subprocess.PIPE,
                              text=True).stdout.split()
        late = [job for job in jobs if int(job) >= 3]
        if late and not killed:
            killed = subprocess.run(["scancel", "--full", "--signal=KILL", late[0]]).returncode == 0
            print(f"killed job {late[0]}", flush=True)
        time.sleep(0.1)
    return running.returncode


if __name__ == "__main__":
    if sys.argv[1:2] == ["--kill"]:
        sys.exit(run_and_kill(sys.argv[2:]))
    result = unittest.main(exit=False, verbosity=2).result
    sys.exit(1 if not result.wasSuccessful() else 77 if result.skipped else 0)
