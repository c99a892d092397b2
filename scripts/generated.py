# SPDX-License-Identifier: Apache-2.0
"""What the generators of committed files share: they write what changed, or with --check only say what is stale."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent


def finish(outputs, script):
    """Exit code of a generator. `outputs` is the text of each file by its path below the root."""
    stale = [name for name, text in outputs.items() if not (ROOT / name).exists() or (ROOT / name).read_text() != text]
    if "--check" in sys.argv[1:]:
        for name in stale:
            print(f"{name} is stale: run scripts/{script} and commit the result")
        return 1 if stale else 0
    for name in stale:
        (ROOT / name).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / name).write_text(outputs[name])
        print(f"wrote {name}")
    return 0
