"""One self-contained HTML page per result: inputs, fits, tables, figures to zoom, evidence, method.

Needs the extra `gripscale[report]` (Bokeh and Jinja2). The page carries its scripts and
images, so it opens without a network, and its content security policy forbids it to ask for one.
"""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from gripscale.core.errors import InputError

if TYPE_CHECKING:
    from gripscale.report.elements import Page

__all__ = ["write_page", "write_report"]

_EXTRA = ("bokeh", "jinja2", "markupsafe")


def write_report(result: str | Path, output: str | Path | None = None) -> Path:
    """Write the HTML report of `result` and return its path.

    Parameters
    ----------
    result
        Results folder of a run, comparison, study, calibration or uncertainty, or of roads or
        compounds side by side; or one of their netCDF files.
    output
        The file to write; `report.html` in the results folder by default.

    Raises
    ------
    FileError
        If the result is missing or unreadable, or the page cannot be written.
    InputError
        If the libraries of `gripscale[report]` are not installed.
    """
    with _page_libraries():
        from gripscale.report.build import build

        return build(Path(result), None if output is None else Path(output))


def write_page(page: Callable[[], Page], output: str | Path) -> Path:
    """Write the HTML page that a function composes and return its path.

    Raises `FileError` if the page cannot be written, `InputError` if the libraries of
    `gripscale[report]` are not installed.
    """
    with _page_libraries():
        from gripscale.report.build import write

        return write(page(), Path(output))


@contextmanager
def _page_libraries() -> Iterator[None]:
    """Refuse in one sentence where a library is missing.

    Garbage is not collected meanwhile: imports and a page leave little, and a collection takes a
    tenth of the time.
    """
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] not in _EXTRA:
            raise
        raise InputError(
            f"a report needs {error.name}, which is not installed; "
            "install it with: pip install 'gripscale[report]'"
        ) from error
    finally:
        if collecting:
            gc.enable()
