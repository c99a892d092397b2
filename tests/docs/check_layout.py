#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No page of the site is cut: every page is shown by a browser without a window (Debian's chromium) at two widths.

usage: check_layout.py SITE [--screenshots FOLDER PAGE...]     (scripts/run docs-layout)
  At 1300 px no table, picture or drawing of text is wider than its page (code may scroll). At 400 px, a telephone, the
  page itself does not scroll sideways and pictures fit; a table, drawing or code that needs more room scrolls in a box
  of its own.
  --screenshots: instead write a PNG of each page at each width.
Exit codes: 0 nothing is cut, 1 findings, a line each, 77 not tried: no chromium or no site."""
import functools
import http.server
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading

WIDTHS = (1300, 400)
TIMEOUT = 900
# Shows one page after the other in a frame of each width and posts what it finds to the server that sent it.
MEASURE = """<!doctype html><body style="margin:0"><script>
const pages = PAGES, widths = WIDTHS, found = [];
let shown = 0, blocks = 0;
const load = (frame, page) => new Promise(done => { frame.onload = done; frame.src = page; });
const settled = () => new Promise(done => setTimeout(done, 60));
(async () => {
  for (const width of widths) {
    const frame = document.createElement('iframe');
    frame.style.cssText = `border:0;width:${width}px;height:900px`;
    document.body.replaceChildren(frame);
    for (const page of pages) {
      await load(frame, page);
      await settled();
      const page_document = frame.contentDocument, article = page_document.querySelector('article');
      const report = what => found.push(`${page} at ${width} px: ${what}`);
      if (!article) { report('no article'); continue; }
      shown++;
      const root = page_document.scrollingElement;
      if (root.scrollWidth > width) report(`the page is ${root.scrollWidth} px wide`);
      const right = article.getBoundingClientRect().right;
      for (const block of article.querySelectorAll('table, img, pre.drawing')) {
        blocks++;
        // A drawing of text or a table: as wide as what it holds, even if its box scrolls.
        const inner = block.tagName == 'PRE' ? block.querySelector('code') : block;
        const excess = Math.max(block.getBoundingClientRect().right - right, inner.scrollWidth - inner.clientWidth);
        if (excess > 1 && (width > 1000 || block.tagName == 'IMG')) {
          const words = (block.alt || block.innerText).trim().slice(0, 60).replace(/\\s+/g, ' ');
          report(`${block.tagName.toLowerCase()} is ${Math.round(excess)} px too wide: ${words}`);
        }
      }
    }
  }
  await fetch('/measured', {method: 'POST', body: JSON.stringify({shown, blocks, found})});
})();
</script>"""


class Server(http.server.SimpleHTTPRequestHandler):
    pages, result, finished = [], None, threading.Event()

    def do_GET(self):
        if self.path != "/measure":
            return super().do_GET()
        text = MEASURE.replace("PAGES", json.dumps(self.pages), 1).replace("WIDTHS", json.dumps(WIDTHS), 1).encode()
        self.send_response(200)
        self.send_header("Content-Type", "text/html; charset=utf-8")
        self.send_header("Content-Length", str(len(text)))
        self.end_headers()
        self.wfile.write(text)
        return None

    def do_POST(self):
        type(self).result = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        self.send_response(204)
        self.end_headers()
        self.finished.set()

    def log_message(self, *_):
        pass


def browser(scratch, *options):
    return ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
            "--hide-scrollbars",
            f"--user-data-dir={scratch}", *options]


def screenshots(site, folder, pages):
    folder.mkdir(parents=True, exist_ok=True)
    for page in pages:
        for width in WIDTHS:
            shot = folder / f"{page.replace('/', '-').removesuffix('.html')}-{width}.png"
            with tempfile.TemporaryDirectory() as scratch:
                # A window of a browser is at least 500 px wide; the narrow page is shown in a frame.
                frame = pathlib.Path(scratch) / "frame.html"
                frame.write_text(f'<body style="margin:0"><iframe src="{(site / page).as_uri()}" '
                                 f'style="border:0;width:{width}px;height:1600px"></iframe>')
                subprocess.run(browser(f"{scratch}/profile", "--allow-file-access-from-files",
                                       f"--window-size={max(width, 500)},1700",
                                       "--virtual-time-budget=5000", f"--screenshot={shot}", frame.as_uri()),
                               check=True, timeout=120,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            print(f"wrote {shot}")


def main():
    site = pathlib.Path(sys.argv[1]).resolve()
    if not shutil.which("chromium"):
        print("skipped: no chromium; install Debian's package: apt-get install chromium")
        return 77
    if not (site / "index.html").is_file():
        print(f"skipped: no {site}/index.html; run: make docs")
        return 77
    if sys.argv[2:3] == ["--screenshots"]:
        return screenshots(site, pathlib.Path(sys.argv[3]).resolve(), sys.argv[4:])
    Server.pages = sorted(str(path.relative_to(site)) for path in site.rglob("*.html") if path.name != "404.html")
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Server, directory=str(site))) as server, \
            tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as scratch:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        address = f"http://127.0.0.1:{server.server_address[1]}/measure"
        with subprocess.Popen(browser(scratch, "--remote-debugging-port=0", "--window-size=1400,1000", address),
                              stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            Server.finished.wait(TIMEOUT)
            process.terminate()
        server.shutdown()
    if not Server.result:
        print(f"no answer of the browser within {TIMEOUT} s")
        return 1
    found, shown = Server.result["found"], Server.result["shown"]
    print("\n".join(found) if found else f"{len(Server.pages)} pages, {Server.result['blocks']} tables, pictures and "
                                         f"drawings at {WIDTHS} px: none cut")
    return bool(found) or shown != len(Server.pages) * len(WIDTHS) or not shown


if __name__ == "__main__":
    sys.exit(main())
