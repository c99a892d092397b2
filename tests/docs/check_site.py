#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""MkDocs builds docs/ without warnings, and no page of the site loads anything from the network.

usage: check_site.py ROOT SITE
Exit codes: 0 yes, 1 no, 77 not tried: no build/docs-venv (make docs)."""
import pathlib
import re
import subprocess
import sys

root, site = map(pathlib.Path, sys.argv[1:])
mkdocs = root / "build/docs-venv/bin/mkdocs"
if not mkdocs.exists():
    print(f"skipped: no {mkdocs}; run: make docs")
    sys.exit(77)
result = subprocess.run([mkdocs, "build", "--quiet", "--strict", "--site-dir", site], cwd=root)
if result.returncode:
    sys.exit(1)
pages = sorted(site.rglob("*.html"))
wrong = [f"{page}: {tag}" for page in pages
         for tag in re.findall(r"<(?:script|img|link|iframe)\b[^>]*\b(?:src|href)=\"(?:https?:)?//[^>]*>", page.read_text())]
print("\n".join(wrong) if wrong else f"{len(pages)} pages")
sys.exit(bool(wrong) or not pages)
