"""One self-contained HTML page per result: inputs, fits, tables, figures to zoom, evidence, method.

Needs the extra `gripscale[report]` (Bokeh and Jinja2). The page carries its scripts and
images, so it opens without a network, and its content security policy forbids it to ask for one.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.core.errors import FileError, using_extra
from gripscale.io.folders import write_text

if TYPE_CHECKING:
    from gripscale.report.elements import Page

__all__ = ["write_page"]


def write_page(page: Callable[[], Page], output: str | Path) -> Path:
    """Write the HTML page that a function composes and return its path.

    Raises `FileError` if the page cannot be written, `InputError` without `gripscale[report]`.
    """
    collecting = gc.isenabled()
    gc.disable()  # a page leaves little garbage, and collecting takes a tenth of the time
    try:
        with using_extra("report", "a report", "bokeh", "jinja2", "markupsafe"):
            from gripscale.report.build import render

            path = Path(output)
            if not path.parent.is_dir():
                raise FileError(f"{path} cannot be written: there is no folder {path.parent}")
            return write_text(path, render(page()))
    finally:
        if collecting:
            gc.enable()
