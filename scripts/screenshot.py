#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Pictures of windows, without a screen: GTKWave with marks, a page of the site in a browser.

usage: scripts/screenshot.py gtkwave [FOLDER]         docs/pictures/gtkwave.png from build/waves (after make sim)
       scripts/screenshot.py readme FILE.png          README.md as the site would show it; needs make docs, once

The first needs xvfb, xauth, gtkwave and imagemagick (scripts/bootstrap --dev); the second imagemagick and Debian's
chromium, which bootstrap does not install: apt-get install chromium.
Exit codes: 0 done, 1 something is missing or failed, 2 wrong command line.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PICTURE = ROOT / "docs" / "pictures" / "gtkwave.png"

# GTKWave's window, pixels, as Debian 12's draws it.
WIDTH, HEIGHT = 1500, 720
TOP, LEFT = 115, 4          # of what is kept: below the tool bar
FIRST_ROW, ROW = 152, 23    # the middle of the row below the time, and from row to row
PER_NS = 6.25               # at this zoom:
ZOOM = -5
MARK = "#ffb300"

# Each panel: groups of the layout, first time, marks. A mark: number, row (label, which of that name), time, end of the
# span that it names or None. Times are ns of the first pair of make sim.
PANELS = [
    (["stream s_pair", "axis controller"], 20, [("1", ("ready", 0), 35, 45), ("2", ("axis", 0), 75, 185)]),
    (["macro stage 4 compare", "stream m_result"], 340, [("3", ("separated", 0), 355, 465), ("4", ("tag", 0), 515, 538),
                                                         ("5", ("axis", 1), 515, 538)]),
]


def need(command, package):
    if not shutil.which(command):
        raise SystemExit(f"screenshot.py: {command} is missing: install Debian's {package} (scripts/bootstrap --dev)")


def panel_layout(text, groups, start):
    """The layout cut to these groups, and the labels of the rows that it shows, in their order."""
    lines = text.split("\n")
    first = lines.index("@800200")
    kept = [line for line in lines[:first] if not re.match(r"@200|-data|\*|\[(size|timestart|signals_width)", line)]
    head = [f"[timestart] {start}", f"[size] {WIDTH} {HEIGHT}", f"*{ZOOM:.6f} {start}" + " -1" * 26,
            "[signals_width] 230"]
    kept[3:3] = head
    for group in groups:
        begin = next(i for i, line in enumerate(lines) if line == "-" + group and lines[i - 1] == "@800200")
        end = next(i for i, line in enumerate(lines) if line == "-" + group and lines[i - 1] == "@1000200")
        kept += lines[begin - 1:end + 1]
    shown, folded, flags = [], 0, ""
    for line in kept:
        if line.startswith("@"):
            flags = line
            folded -= flags == "@1401200"
        elif line[:1] in "+#-" and line:
            if not folded and flags != "@1401200":
                shown.append(re.sub(r"^[+#]\{(.*?)\}.*", r"\1", line))
            folded += flags == "@c00200"
    return "\n".join(kept) + "\n", shown


def window(command, seconds=40):
    """A picture of what the command shows, once it no longer changes."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "window.png"
        script = f'"$@" > /dev/null 2>&1 & program=$!; i=0; old=none\n' \
                 f'while [ $i -lt {seconds} ]; do sleep 2; i=$((i + 2)); import -window root "{path}"\n' \
                 f'new=$(convert "{path}" -format "%# %k" info:); [ "$new" = "$old" ] && [ "${{new#* }}" -gt 20 ] && ' \
                 f'break; old=$new; done\nkill $program'
        subprocess.run(["xvfb-run", "-a", "-s", f"-screen 0 {WIDTH}x{HEIGHT}x24", "sh", "-c", script, "sh", *command],
                       check=False, timeout=seconds + 60)
        if not path.exists():
            raise SystemExit(f"screenshot.py: {command[0]} showed nothing")
        return path.read_bytes()


def draw_marks(start, marks, shown, left):
    """Options of convert: a frame around each span, its number beside it."""
    options = ["-fill", "none", "-stroke", MARK, "-strokewidth", "3"]
    numbers = []
    for number, (label, which), begin, end in marks:
        rows = [i for i, text in enumerate(shown) if text == label]
        y = FIRST_ROW + ROW * rows[which]
        x1, x2 = (left + (t - start) * PER_NS for t in (begin, end))
        options += ["-draw", f"roundrectangle {x1 - 3:g},{y - 13} {x2 + 3:g},{y + 13} 6,6"]
        numbers += ["-draw", f"fill {MARK} stroke none circle {x1 - 18:g},{y} {x1 - 18:g},{y + 13}",
                    "-draw", f"fill black stroke none font-size 20 text {x1 - 24:g},{y + 7} '{number}'"]
    return options + ["-strokewidth", "0", *numbers]


def gtkwave(folder):
    for command, package in (("xvfb-run", "xvfb and xauth"), ("gtkwave", "gtkwave"), ("import", "imagemagick")):
        need(command, package)
    wave, layout = folder / "sim.fst", folder / "sim.gtkw"
    if not layout.exists():
        raise SystemExit(f"screenshot.py: no {layout} yet, run: make sim")
    parts = []
    with tempfile.TemporaryDirectory() as scratch:
        for i, (groups, start, marks) in enumerate(PANELS):
            text, shown = panel_layout(layout.read_text(), groups, start)
            cut = pathlib.Path(scratch) / f"panel{i}.gtkw"
            # The names of codes are found by their absolute paths: the saved place must be the real one.
            cut.write_text(re.sub(r'^\[savefile\].*$', f'[savefile] "{cut}"', text, flags=re.M))
            whole = pathlib.Path(scratch) / f"window{i}.png"
            whole.write_bytes(
                window(["gtkwave", "--rcvar", "splash_disable on", "--rcvar", "hide_sst on", str(wave), str(cut)]))
            part = pathlib.Path(scratch) / f"part{i}.png"
            bottom = FIRST_ROW + ROW * len(shown) - TOP - 6
            subprocess.run(["convert", whole, *draw_marks(start, marks, shown, left_of_waves(whole)), "-crop",
                            f"{WIDTH - LEFT - 16}x{bottom}+{LEFT}+{TOP}", "+repage", part], check=True)
            parts.append(part)
        subprocess.run(["convert", *parts, "-background", "white", "-splice", "0x8", "-append", "-colors",
                        "64", "-strip",
                        f"PNG8:{PICTURE}"], check=True)
    print(f"wrote {PICTURE.relative_to(ROOT)}, {PICTURE.stat().st_size // 1000} kB")


def left_of_waves(picture):
    """Left edge of the black area: the first column that is dark from the first row to the last."""
    shade = subprocess.run(["convert", picture, "-crop", f"{WIDTH}x{HEIGHT - FIRST_ROW - 60}+0+{FIRST_ROW}", "+repage",
                            "-resize", f"{WIDTH}x1!",
                            "-depth", "8", "gray:-"], check=True, stdout=subprocess.PIPE).stdout
    return next(x for x in range(len(shade) - 50) if max(shade[x + 2:x + 50]) < 90)


def readme(picture):
    need("chromium", "chromium")
    need("convert", "imagemagick")
    mkdocs = ROOT / "build" / "docs-venv" / "bin" / "mkdocs"
    if not mkdocs.exists():
        raise SystemExit("screenshot.py: no MkDocs yet, run: make docs")
    with tempfile.TemporaryDirectory() as scratch:
        root = pathlib.Path(scratch)
        shutil.copytree(ROOT / "docs" / "pictures", root / "docs" / "docs" / "pictures")
        shutil.copy(ROOT / "README.md", root / "docs" / "index.md")
        # The links to other pages lead nowhere here, so this build is not strict; make docs checks links.
        (root / "mkdocs.yml").write_text("site_name: collisionchip\ntheme: {name: readthedocs, highlightjs: false}\n"
                                         "use_directory_urls: false\nplugins: []\n")
        subprocess.run([mkdocs, "build", "--quiet", "--config-file", root / "mkdocs.yml"], check=True,
                       stderr=subprocess.DEVNULL)
        shot = root / "page.png"
        subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
                        f"--user-data-dir={root / 'profile'}",
                        "--window-size=1300,3600", f"--screenshot={shot}", f"file://{root / 'site' / 'index.html'}"],
                       check=True, timeout=120,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        subprocess.run(["convert", shot, "-trim", "+repage", picture], check=True)
    print(f"wrote {picture}")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    commands = parser.add_subparsers(dest="command", required=True)
    of_wave = commands.add_parser("gtkwave")
    of_wave.add_argument("folder", nargs="?", type=pathlib.Path, default=ROOT / "build" / "waves")
    of_page = commands.add_parser("readme")
    of_page.add_argument("picture", type=pathlib.Path)
    options = parser.parse_args()
    if options.command == "gtkwave":
        gtkwave(options.folder.resolve())
    else:
        readme(options.picture)


if __name__ == "__main__":
    sys.exit(main())
