"""`gripscale app [CASE.toml]`: a page in the browser, from measurement to friction."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gripscale.cli.terminal import command


@command
def app(
    case: Annotated[
        Path | None,
        typer.Argument(
            help="A case file to start with, instead of the shipped road.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
        ),
    ] = None,
    port: Annotated[int, typer.Option(help="Port of 127.0.0.1; 0 takes a free one.")] = 0,
    folder: Annotated[
        Path,
        typer.Option(
            help="Where each visit gets a folder for its files and results.",
            metavar="DIR",
            readable=False,
        ),
    ] = Path("gripscale-app"),
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Open no browser; the address is printed.")
    ] = False,
) -> None:
    """Open a page that shows, runs and compares cases, on this machine only."""
    from gripscale.app import serve_app

    serve_app(folder, case=case, port=port, browser=not no_browser)
