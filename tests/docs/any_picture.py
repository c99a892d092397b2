#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""scripts/picture.py fits its camera to meshes of any size, at any place, without area or without volume.

usage: any_picture.py CCHIP PICTURE.PY

Exit codes: 0 all as expected, 1 not."""
import contextlib
import importlib.util
import io
import pathlib
import subprocess
import sys
import tempfile
import traceback

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
SIDES = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]


def write(path, points, faces):
    path.write_text("".join("v %.17g %.17g %.17g\n" % tuple(p) for p in points)
                    + "".join(f"f {face}\n" for face in faces))


def main():
    cchip, script = sys.argv[1:]
    spec = importlib.util.spec_from_file_location("picture", script)
    picture = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(picture)
    picture.WIDTH, picture.HEIGHT, picture.LINE = 220, 150, 0.75  # a quarter, which takes a sixteenth of the time
    failures = 0

    def check(name, good, seen):
        nonlocal failures
        if not good:
            failures += 1
            print(f"FAILED {name}: {seen}")

    def draw(meshes, *options):
        """Exit code and output."""
        sys.argv = [script, str(meshes), str(png), *options]
        text, code = io.StringIO(), 0
        with contextlib.redirect_stderr(text):
            try:
                picture.main()
            except SystemExit as end:
                code = end.code
            except Exception:
                traceback.print_exc()
                code = 1
        return code, text.getvalue()

    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        a, b, ply, png = (folder / file for file in ("a.obj", "b.obj", "both.ply", "both.png"))
        cases = {"unit": (CUBE, SIDES), "tiny": ([[1e-9 * c for c in p] for p in CUBE], SIDES),
                 "huge": ([[1e180 * c for c in p] for p in CUBE], SIDES),
                 "far": ([[c + 1e6 for c in p] for p in CUBE], SIDES),
                 "long": ([(1000 * x, y, z) for x, y, z in CUBE], SIDES),
                 "beside a segment": (CUBE + [(0.5, 0.5, 2)], SIDES + ["1 8 9", "1 8 8"])}
        for name, (points, faces) in cases.items():
            for view in (("1", "-1.6", "1.1"), ("0", "0", "1")):
                write(a, points, faces)
                write(b, points, faces)
                subprocess.run([cchip, "collide", a, b, "--ply", ply], check=True, stdout=subprocess.DEVNULL)
                png.unlink(missing_ok=True)
                code, text = draw(ply, "--view", *view)
                if code != 0:
                    check(name, False, text)
                    continue
                rows = picture.read_png(png)
                drawn = [(x, y) for y, row in enumerate(rows) for x in range(picture.WIDTH) if row[4 * x + 3]]
                xs, ys = zip(*drawn)
                free = (min(xs), picture.WIDTH - 1 - max(xs), min(ys), picture.HEIGHT - 1 - max(ys))
                # The margin is 4 % of width and height, 8 and 6 pixels; one of the two directions is full.
                good = min(free) >= 5 and (max(free[:2]) <= 10 or max(free[2:]) <= 8)
                check(f"{name}, view {view}", good, f"free at the sides: {free}")
        bad = folder / "bad.ply"
        for text in ("", "ply\n", "ply\nformat ascii 1.0\nend_header\n"):
            bad.write_text(text)
            code, said = draw(bad)
            check("no PLY of cchip", code == 2 and "not written by cchip" in said, said)
        bad.write_bytes(ply.read_bytes()[:400])
        code, said = draw(bad)
        check("cut off", code == 2 and "not written by cchip" in said, said)
        code, said = draw(folder / "none.ply")
        check("missing", code == 2 and "No such file" in said, said)
    print(f"{2 * len(cases) + 5} pictures, {failures} failures")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
