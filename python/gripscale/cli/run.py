"""`gripscale run CASE.toml`: the answer of a case, from files to tables, figures and results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from gripscale.questions import terminal
from gripscale.questions.terminal import CasePath, argument, case_command, command, option


@case_command
def run(
    case: CasePath,
    output: Annotated[
        Path | None, option("Results folder, instead of the one in the case.", metavar="DIR")
    ] = None,
    verbose: Annotated[
        bool, typer.Option("--verbose", help="Print inputs and every table, too.")
    ] = False,
    figures: Annotated[
        bool, typer.Option("--figures", help="Write figures as files, too: PNG if nothing else.")
    ] = False,
) -> None:
    """Answer with contact area and friction of a case; resumes where it was stopped."""
    from gripscale.cli.solve_run import solve_run
    from gripscale.io.folders import require_writable

    work = terminal.CaseCommand(case)
    target = output or work.file.resolve(work.file.case.output.folder)
    require_writable(target)  # before the files of the case are read
    solve_run(work, target, verbose=verbose, figures=figures)


@command
def report_command(
    result: Annotated[
        Path,
        argument(
            "Results folder of a run, comparison, study, calibration or uncertainty, or of "
            "surfaces or rubbers side by side; or one of its .nc files.",
            "RESULT",
        ),
    ],
    output: Annotated[
        Path | None,
        option("The page, instead of report.html in the results folder.", metavar="FILE.html"),
    ] = None,
) -> None:
    """Write one HTML page with inputs, results, figures and evidence; it needs no network."""
    from gripscale.questions.page_of_folder import write_report

    page = write_report(result, output)
    terminal.print_wrapped(
        terminal.screen(), f"Report, {page.stat().st_size / 1e6:.1f} MB, is {page}"
    )


@command
def open_app(
    case: Annotated[
        Path | None,
        argument("A case file to start with, instead of the shipped road.", "CASE.toml"),
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
