# SPDX-License-Identifier: Apache-2.0
# Place and route of rows of scripts/fpga.py over seeds, a job for each: scripts/run fpga-sweep, docs/develop/scaling.md.
# Settings: --config rows="tri_tri tri_tri_substages8" seeds=5 parameter=SUBSTAGES options="--freq=125 --nextpnr=PATH" python=PYTHON_WITH_MATPLOTLIB
import pathlib

ROWS = config.get("rows", "tri_tri").split()
SEEDS = int(config.get("seeds", 5))
PARAMETER = config.get("parameter", "")
NAME = "-".join([*ROWS, f"{SEEDS}seeds"])
FOLDER = "build/sweep"
CALL = f"python3 -B {workflow.basedir}/fpga_sweep.py"
OPTIONS = config.get("options", "")
# a change of the RTL or of the script means a new synthesis; one with the same netlist costs no new place and route
SOURCES = [str(path) for path in sorted(pathlib.Path("rtl").rglob("*.v*"))] + ["scripts/fpga.py", "scripts/fpga_harness.v", "scripts/fpga_subsystem.v"]


localrules: all, merge, plot


wildcard_constraints:
    seed=r"\d+",


rule all:
    input:
        f"{FOLDER}/{NAME}.csv",
        f"{FOLDER}/{NAME}.svg",


rule synth:
    input:
        SOURCES,
    output:
        FOLDER + "/shards/{row}.synth.json",
    resources:
        mem_mb=2000,
    shell:
        "{CALL} synth {wildcards.row} {output} {OPTIONS}"


rule place:
    input:
        FOLDER + "/shards/{row}.synth.json",
    output:
        FOLDER + "/shards/{row}.seed{seed}.json",
    resources:
        mem_mb=2000,
    shell:
        "{CALL} place {wildcards.row} {wildcards.seed} {input} {output} {OPTIONS}"


rule merge:
    input:
        expand(FOLDER + "/shards/{row}.seed{seed}.json", row=ROWS, seed=range(1, SEEDS + 1)),
    output:
        f"{FOLDER}/{NAME}.csv",
    params:
        parameter=f"--parameter {PARAMETER}" if PARAMETER else "",
    shell:
        "{CALL} merge {output} {input} --seeds {SEEDS} {params.parameter}"


rule plot:
    input:
        f"{FOLDER}/{NAME}.csv",
    output:
        f"{FOLDER}/{NAME}.svg",
    params:
        python=config.get("python", "build/venv/bin/python"),
    shell:
        "{params.python} -B {workflow.basedir}/fpga_sweep.py plot {input} {output}"
