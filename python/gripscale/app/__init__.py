"""A page in the browser: from a road and a rubber to contact and friction, as a case file.

Needs the extra `gripscale[app]` (Panel on Bokeh, TOML Kit). Whatever the page does is in the case
file it shows; it computes nothing itself: inputs are prepared by `gripscale.case_file`, a run is
`gripscale run` in a process of its own, figures are those of the report.
"""

from __future__ import annotations

from pathlib import Path

from gripscale.core.errors import using_extra

__all__ = ["serve_app"]


def serve_app(
    folder: str | Path, *, case: str | Path | None = None, port: int = 0, browser: bool = True
) -> None:
    """Serve the page on this machine, for this machine only, until it is interrupted.

    Raises `FileError` if the folder cannot be written or the case cannot be read. Raises
    `InputError` if the port is none or taken, the case is unusable, or the libraries of
    `gripscale[app]` are not installed.

    Parameters
    ----------
    folder
        Where every visit gets a folder of its own, with its files, case and results; made if
        needed. A visit reads and writes nowhere else.
    case
        A case file each visit starts with; its files are copied. The shipped road by default.
    port
        Port of 127.0.0.1; 0 takes a free one.
    browser
        Open the page in a browser.
    """
    libraries = ("bokeh", "jinja2", "markupsafe", "panel", "param", "tomlkit")
    with using_extra("app", "the page", *libraries):
        from gripscale.app.server import serve
    serve(Path(folder), None if case is None else Path(case), port, browser)
