"""`gripscale report RESULT`: one self-contained HTML page of a result."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gripscale.cli.terminal import command, say, screen


@command
def report(
    result: Annotated[
        Path,
        typer.Argument(
            help="Results folder of a run, comparison, study, calibration or uncertainty, or one "
            "of its .nc files.",
            metavar="RESULT",
            readable=False,
        ),
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            help="The page, instead of report.html in the results folder.",
            metavar="FILE.html",
            readable=False,
        ),
    ] = None,
) -> None:
    """Write one HTML page with inputs, results, figures and evidence; it needs no network."""
    from gripscale.report import write_report

    page = write_report(result, output)
    say(screen(), f"Report, {page.stat().st_size / 1e6:.1f} MB, is {page}")
