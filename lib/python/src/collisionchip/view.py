# SPDX-License-Identifier: Apache-2.0
"""A result as a page that a browser or a notebook shows. Result.show() makes it."""
from __future__ import annotations

import html
import os
import pathlib
import sys
import tempfile
import webbrowser


class View:
    """An HTML page, which needs nothing beside it. A notebook shows it where it is the last expression of a cell."""

    def __init__(self, page: str) -> None:
        self.page = page

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the page. Raises OSError: the file cannot be written."""
        pathlib.Path(path).write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        return (f'<iframe srcdoc="{html.escape(self.page, quote=True)}" sandbox="allow-scripts" '
                'style="width: 100%; height: 600px; border: 0"></iframe>')


def three_folder() -> str:
    """Where three.js is: in the package, if it was there when the package was built, or else where Debian has it."""
    own = pathlib.Path(__file__).parent / "three"
    return str(own if own.is_dir() else "/usr/share/javascript/three")


def _in_notebook() -> bool:
    """Is this a kernel of Jupyter? Its front end shows what a cell returns."""
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def show(page: bytes, path: str | os.PathLike[str] | None) -> View:
    """What Result.show() does with its page."""
    view = View(page.decode("utf-8", errors="replace"))
    if path is not None:
        view.save(path)
    elif not _in_notebook():
        with tempfile.NamedTemporaryFile("w", encoding="utf-8", prefix="collisionchip-", suffix=".html",
                                         delete=False) as file:
            file.write(view.page)  # stays: the browser reads it later
        webbrowser.open(pathlib.Path(file.name).as_uri())
    return view
