#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The page of `cchip collide --html` in a browser: colours, a face that is clicked, a contact that is chosen, the
section.

usage: html_view.py CCHIP [PICTURE.png]   the picture is for the eye

Exit codes: 0 all as expected, 1 not, 77 there is no browser (chromium) or no three.js (libjs-three)."""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

# A square whose middle is the middle of the picture, and a small face of the same mesh; a triangle that pierces the
# square.
A = "v -4 -4 -1\nv -3 -4 -1\nv -4 -4 1\nv -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3\nf 4 5 6 7\n"
B = "v 2 2 -1\nv 2 2 1\nv 2.5 2 1\nf 1 2 3\n"
STEPS = """
<script>
window.addEventListener("load", () => {
  const out = [], canvas = renderer.domElement, frame = canvas.getBoundingClientRect();
  const middle = {clientX: frame.left + frame.width / 2, clientY: frame.top + frame.height / 2};
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  const note = name => {
    const paper = copy.getContext("2d");
    paper.drawImage(canvas, 0, 0);
    const colour = Array.from(paper.getImageData(copy.width / 2, copy.height / 2, 1, 1).data.slice(0, 3));
    out.push({name, colour, status: byId("status").textContent, chosen: document.querySelectorAll("tr.chosen").length});
  };
  const click = () => canvas.dispatchEvent(new MouseEvent("click", middle));
  note("start");
  click();
  note("face");
  byId("axis").value = "x";
  byId("section").value = 250;
  byId("axis").onchange();
  note("cut away");
  click();
  note("nothing there");
  byId("flip").onclick();
  click();
  note("other side");
  byId("axis").value = "";
  byId("axis").onchange();
  byId("rows").children[0].onclick();
  note("contact");
  const result = document.createElement("pre");
  result.id = "result";
  result.textContent = JSON.stringify(out);
  document.body.append(result);
});
</script>
"""

# Two faces in one plane: the smaller one, of B, covers the middle of the picture.
UNDER = "v -4 -4 0\nv 4 -4 0\nv 4 4 0\nv -4 4 0\nf 1 2 3 4\n"
OVER = "v -2.1 -1.9 0\nv 2.3 -2.2 0\nv 1.7 2.6 0\nv -2.4 1.8 0\nf 1 2 3 4\n"
FLUSH = """
<script>
window.addEventListener("load", () => {
  byId("show-edges").checked = false;
  byId("show-edges").onchange({target: byId("show-edges")});
  const canvas = renderer.domElement, frame = canvas.getBoundingClientRect(), copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height;
  copy.getContext("2d").drawImage(canvas, 0, 0);
  const pixels = copy.getContext("2d").getImageData(copy.width / 2 - 40, copy.height / 2 - 40, 80, 80).data;
  let blue = 0;
  for (let i = 0; i < pixels.length; i += 4) blue += pixels[i + 2] > pixels[i] ? 1 : 0;
  const middle = {clientX: frame.left + frame.width / 2, clientY: frame.top + frame.height / 2};
  canvas.dispatchEvent(new MouseEvent("click", middle));
  const result = document.createElement("pre");
  result.id = "result";
  result.textContent = JSON.stringify({blue, all: pixels.length / 4, status: byId("status").textContent});
  document.body.append(result);
});
</script>
"""


def browse(page, *options):
    command = [BROWSER, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
               "--enable-unsafe-swiftshader",
               "--hide-scrollbars", "--window-size=1200,800", "--virtual-time-budget=5000", *options, page.as_uri()]
    return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, timeout=120).stdout


def run_steps(page, steps):
    """What the steps leave behind in the page, None if its scripts stop before their end."""
    page.write_text(page.read_text().replace("</body>", steps + "</body>"))
    shown = re.search(r'<pre id="result">(.*?)</pre>', browse(page, "--dump-dom"))
    return json.loads(shown[1]) if shown else None


def check(name, good, seen):
    if not good:
        FAILED.append(name)
        print(f"FAILED {name}: {seen}")


def main():
    cchip = sys.argv[1]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        # A name that would end the page's script if it were not written with care.
        (folder / "a<").mkdir()
        a, b, page = folder / "a<" / "script>.obj", folder / "b.obj", folder / "view.html"
        a.write_text(A)
        b.write_text(B)
        subprocess.run([cchip, "collide", a, b, "--html", page], check=True, stdout=subprocess.DEVNULL)
        text = page.read_text()
        check("one file", not re.search(r"<(script|link|img)[^>]*(src|href)=", text), "it names another file")
        check("licence", "Permission is hereby granted" in text and "three.js authors" in text, "it is missing")
        if len(sys.argv) > 2:
            browse(page, f"--screenshot={sys.argv[2]}")
        shown = run_steps(page, STEPS)
        a.write_text(UNDER)
        b.write_text(OVER)
        subprocess.run([cchip, "collide", a, b, "--html", page], check=True, stdout=subprocess.DEVNULL)
        flush = run_steps(page, FLUSH)
        if not shown or not flush:
            print("FAILED: the page's scripts stop before their end")
            return 1
        steps = {step["name"]: step for step in shown}

    def is_orange(step):
        red, green, blue = step["colour"]
        return red > 150 and green < red / 1.8 and blue < green

    def is_pink(step):
        red, green, blue = step["colour"]
        return red > 130 and green < 60 < blue < red

    nothing = "Choose a contact, or click a face."
    check("start", is_orange(steps["start"]) and steps["start"]["status"] == nothing, steps["start"])
    face = steps["face"]
    check("face", is_pink(face) and face["status"] == "face 1 of A: 1 contact" and face["chosen"] == 1, face)
    away = steps["cut away"]
    check("cut away", min(away["colour"]) > 230, away)
    check("nothing there", steps["nothing there"]["status"] == nothing, steps["nothing there"])
    check("other side", steps["other side"]["status"] == face["status"], steps["other side"])
    contact = steps["contact"]
    check("contact", contact["status"] == "face 1 of A, face 0 of B: crossing" and contact["chosen"] == 1, contact)
    check("faces in one plane", flush["blue"] == flush["all"] and flush["status"].startswith("face 0 of B"), flush)
    print(f"{len(steps)} steps, {len(FAILED)} failures")
    return 1 if FAILED else 0


BROWSER = shutil.which("chromium")
FAILED = []
if __name__ == "__main__":
    for missing, package in ((BROWSER is None, "chromium"),
                             (not pathlib.Path("/usr/share/javascript/three").is_dir(), "libjs-three")):
        if missing:
            print(f"skipped: install Debian's package {package}")
            sys.exit(77)
    sys.exit(main())
