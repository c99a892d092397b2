#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How a campaign in shards scales on this machine: one job at a time and two, in turns, beside one piece.

usage: speed.py [PAIRS SHARDS]      (default 2000000 pairs in 20 shards; environment: CCHIP_BIN, the folder with
                                    cchip_campaign)

The last line has the seconds on the wall, medians of three, and their ratios; load is that of the machine at the
end."""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = os.environ.get("CCHIP_BIN", "build/release/bin")


def timed(*command):
    start = time.perf_counter()
    subprocess.run(command, cwd=ROOT, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    return time.perf_counter() - start


def sharded(cores, pairs, shards):
    with tempfile.TemporaryDirectory() as folder:
        return timed("build/workflow/bin/snakemake", "--snakefile", "workflow/Snakefile", "--profile",
                     "workflow/profiles/local", "--cores", str(cores),
                     "--config", "kind=random", f"amount={pairs}", f"shards={shards}", f"bin={BIN}", f"folder={folder}")


def piece(pairs, shards):
    with tempfile.TemporaryDirectory() as folder:
        return timed(sys.executable, "workflow/campaign.py", "piece", "--kind", "random", "--amount", str(pairs),
                     "--shards", str(shards), "--bin", BIN,
                     "--output", f"{folder}/table.csv")


def main():
    pairs, shards = (int(word) for word in sys.argv[1:3] or (2000000, 20))
    times = [(sharded(1, pairs, shards), sharded(2, pairs, shards), piece(pairs, shards)) for _ in range(3)]
    one, two, whole = (statistics.median(column) for column in zip(*times))
    print(f"pairs={pairs} shards={shards} one_piece={whole:.1f}s one_core={one:.1f}s two_cores={two:.1f}s "
          f"one_core/one_piece={one / whole:.2f} one_core/two_cores={one / two:.2f} load={os.getloadavg()[0]:.1f}")


if __name__ == "__main__":
    main()
