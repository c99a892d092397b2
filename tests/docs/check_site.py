#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""MkDocs builds docs/ without warnings, the title of a page is its heading, and no page of the site loads anything from
the network.

usage: check_site.py ROOT SITE
Exit codes: 0 yes, 1 no, 77 not tried: no build/docs-venv (make docs)."""
import os
import pathlib
import re
import subprocess
import sys

root, site = map(pathlib.Path, sys.argv[1:])
mkdocs = root / "build/docs-venv/bin/mkdocs"
if not mkdocs.exists():
    print(f"skipped: no {mkdocs}; run: make docs")
    sys.exit(77)
result = subprocess.run([mkdocs, "build", "--quiet", "--strict", "--site-dir", site], cwd=root,
                        env={**os.environ, "NO_MKDOCS_2_WARNING": "1"})
if result.returncode:
    sys.exit(1)
pages = sorted(site.rglob("*.html"))
wrong = [f"{page}: {tag}" for page in pages
         for tag in re.findall(r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"(?:https?:)?//[^>]*>",
                               page.read_text())]
# Titles are headings, not names of files, and no two pages have the same: the menu would not tell them apart.
titles = {}
for page in pages:
    title = re.search(r"<title>(.*?)</title>", page.read_text(), re.S)[1].removesuffix(" - collisionchip")
    heading = re.search(r"<h1\b[^>]*>(.*?)</h1>", page.read_text(), re.S)
    heading = re.sub(r"<a class=\"headerlink.*?</a>|<[^>]*>", "", heading[1]).strip() if heading else ""
    if page.name == "404.html" or page == site / "index.html":  # the title of the start page is the name of the site
        continue
    if title != heading:
        wrong.append(f"{page}: its title is '{title}', its heading '{heading}'")
    if heading in titles:
        wrong.append(f"{page}: has the heading of {titles[heading]}, '{heading}'")
    titles[heading] = page
print("\n".join(wrong) if wrong else f"{len(pages)} pages")
sys.exit(bool(wrong) or not pages)
