# SPDX-License-Identifier: Apache-2.0
"""What mkdocs.yml adds to MkDocs (make docs):

- The navigation is docs/README.md: a door for each of its headings, in it the pages that the tables below link to, in this order.
- A heading gets the anchor that GitHub gives it, which is the one that the pages link to.
- A link to a file or folder outside docs/ leads to it in the checkout that holds build/site; a missing one is a warning, so
  that the strict build fails."""
import logging
import os
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
DOCS = ROOT / "docs"
log = logging.getLogger("mkdocs.hooks.site")


def anchor(heading, separator):
    return re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", separator)


def on_config(config):
    sections = re.split(r"^## (.*)\n", (DOCS / "README.md").read_text(), flags=re.M)
    config.nav = [{"Start": "README.md"}]
    for door, text in zip(sections[1::2], sections[2::2]):
        pages = re.findall(r"^\|.*?\]\(([\w/-]+\.md)\)", text, re.M)
        config.nav.append({door: list(dict.fromkeys(pages))})
    config.mdx_configs["toc"] = {"slugify": anchor}
    return config


def on_page_markdown(markdown, page, **_):
    folder = (DOCS / page.file.src_uri).parent

    def outside(link):
        path = pathlib.Path(os.path.normpath(folder / link[1]))
        if DOCS in path.parents and path.is_file():
            return link[0]
        if not path.exists():
            log.warning("%s: link to %s, which does not exist", page.file.src_uri, link[1])
        return f"](repository:{path.relative_to(ROOT)}{link[2] or ''})"

    return re.sub(r"\]\(([^()#:\s]+)(#[^)\s]*)?\)", outside, markdown)


def on_page_content(html, page, config, **_):
    folder = (pathlib.Path(config.site_dir) / page.url).parent
    return re.sub('"repository:([^"#]*)', lambda link: f'"{os.path.relpath(ROOT / link[1], folder)}', html)
