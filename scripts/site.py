# SPDX-License-Identifier: Apache-2.0
"""What mkdocs.yml adds to MkDocs (make docs):

- Every module of the RTL has a page modules/MODULE.md, which scripts/datasheet.py builds. A link to the file of a
  module leads to it.
- The navigation is docs/README.md: a tab for each of its headings, in it the pages that the tables below link to, in
  this order. Rows whose first cell names a folder (datasheets) are grouped by it.
- The title of a page is its first heading; MkDocs takes it from the file's name if a comment (SPDX) precedes it.
- A heading gets the anchor that GitHub gives it, which is the one that the pages link to.
- A link to a file or folder outside docs/ leads to it in the checkout that holds build/site; a missing one is a
  warning, so that the strict build fails.
- Long names in tables may break after _ and the like; drawings of text get the class `drawing` (docs/site.css)."""
import logging
import os
import pathlib
import re
import sys

from mkdocs.structure.files import File

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import datasheet  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
DRAWING = re.compile("[\u2500-\u257f]")  # lines of boxes
PAGE_OF = {ROOT / path: DOCS / "modules" / f"{module}.md" for module, path in datasheet.rtl_files().items()}
log = logging.getLogger("mkdocs.hooks.site")


def anchor(heading, separator):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


def on_config(config):
    sections = re.split(r"^## (.*)\n", (DOCS / "README.md").read_text(), flags=re.M)
    config.nav = [{"Start": "README.md"}]
    for door, text in zip(sections[1::2], sections[2::2]):
        entries, folders, folder = [], {}, None
        for cell, page in re.findall(r"^\| *(`[\w/]+`)?.*?\]\(([\w/-]+\.md|\.\./[\w/]+\.v)\)", text, re.M):
            if page.endswith(".v"):
                page = str(PAGE_OF[ROOT / page.removeprefix("../")].relative_to(DOCS))
            folder = cell.strip("`") or folder
            if folder and folder not in folders:
                folders[folder] = []
                entries.append({folder: folders[folder]})
            group = folders[folder] if folder else entries
            if page not in group:
                group.append(page)
        config.nav.append({door: entries})
    config.mdx_configs["toc"] = {"slugify": anchor}
    return config


def on_files(files, config):
    for path in PAGE_OF.values():
        name = str(path.relative_to(DOCS))
        if files.get_file_from_path(name):
            files.remove(files.get_file_from_path(name))
        files.append(File.generated(config, name, content=datasheet.datasheet(path.stem)))
    return files


def on_page_markdown(markdown, page, **_):
    markdown = re.sub(r"\A(?:<!--.*?-->\s*)+", "", markdown, flags=re.S)
    own = DOCS / page.file.src_uri
    folder = own.parent

    def outside(link):
        path = pathlib.Path(os.path.normpath(folder / link[1]))
        path = path if PAGE_OF.get(path, own) == own else PAGE_OF[path]
        if path in PAGE_OF.values() or DOCS in path.parents and path.is_file():
            return f"]({os.path.relpath(path, folder)}{link[2] or ''})"
        if not path.exists():
            log.warning("%s: link to %s, which does not exist", page.file.src_uri, link[1])
        return f"](repository:{path.relative_to(ROOT)}{link[2] or ''})"

    return re.sub(r"\]\(([^()#:\s]+)(#[^)\s]*)?\)", outside, markdown)


def breakable(code):
    return re.sub(r"(?<=\w)([_*/,.(-]+)(?=\w)", r"\1<wbr>", code[0])


def on_page_content(html, page, config, **_):
    html = re.sub(r"<td\b.*?</td>", lambda cell: re.sub(r"(?<=<code>)[^<]+(?=</code>)", breakable, cell[0]),
                  html, flags=re.S)
    html = re.sub(r"<pre>(.*?)</pre>", lambda pre: f'<pre class="drawing">{pre[1]}</pre>' if DRAWING.search(pre[1])
                  else pre[0], html, flags=re.S)
    folder = (pathlib.Path(config.site_dir) / page.url).parent
    return re.sub('"repository:([^"#]*)', lambda link: f'"{os.path.relpath(ROOT / link[1], folder)}', html)
