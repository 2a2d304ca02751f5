"""One self-contained HTML page per result: inputs, fits, tables, figures to zoom, evidence, method.

Needs the extra `gripscale[report]` (Bokeh and Jinja2). The page carries its scripts and
images, so it opens without a network, and its content security policy forbids it to ask for one.
"""

from __future__ import annotations

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from gripscale.core.errors import InputError

__all__ = ["write_report"]

EXTRA = ("bokeh", "jinja2", "markupsafe")


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
    with _uncollected():
        try:
            from gripscale.report.build import build
        except ModuleNotFoundError as error:
            if (error.name or "").partition(".")[0] not in EXTRA:
                raise
            raise InputError(
                f"a report needs {error.name}, which is not installed; "
                "install it with: pip install 'gripscale[report]'"
            ) from error
        return build(Path(result), None if output is None else Path(output))


@contextmanager
def _uncollected() -> Iterator[None]:
    """Look for no garbage meanwhile: imports and a page leave little, and to look takes a tenth."""
    collecting = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collecting:
            gc.enable()
