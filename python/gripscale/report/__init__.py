"""One self-contained HTML page per result: inputs, fits, tables, figures to zoom, evidence, method.

Needs the extra `gripscale[report]` (Bokeh and Jinja2). The page carries its scripts and
images, so it opens without a network, and its content security policy forbids it to ask for one.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.core.errors import using_extra

if TYPE_CHECKING:
    from gripscale.report.elements import Page

__all__ = ["write_page"]


def write_page(page: Callable[[], Page], output: str | Path) -> Path:
    """Write the HTML page that a function composes and return its path.

    Garbage is not collected meanwhile: imports and a page leave little, and a collection takes a
    tenth of the time. Raises `FileError` if the page cannot be written, `InputError` if the
    libraries of `gripscale[report]` are not installed.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        with using_extra("report", "a report", "bokeh", "jinja2", "markupsafe"):
            from gripscale.report.build import write

            return write(page(), Path(output))
    finally:
        if collecting:
            gc.enable()
