"""`gripscale run CASE.toml`: the whole chain, from files to tables, figures and results."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer
from rich.console import Console

from gripscale import dataset, report
from gripscale.case import CaseFile, read_case
from gripscale.chain import ChainError
from gripscale.cli import draw, folder
from gripscale.cli.inputs import RubberStudy, SurfaceStudy, study_rubber, study_surface
from gripscale.cli.solving import Chain, chains_of, solve
from gripscale.cli.summary import rubber_lines, surface_lines
from gripscale.cli.terminal import command, complain, say, screen

REPORT_WIDTH = 110


@command
def run(
    case: Annotated[
        Path, typer.Argument(help="The case file (TOML).", metavar="CASE.toml", readable=False)
    ],
    output: Annotated[
        Path | None,
        typer.Option(
            help="Results folder, instead of the one in the case.", metavar="DIR", readable=False
        ),
    ] = None,
) -> None:
    """Predict contact area and friction of a case: tables, figures and result files."""
    console = screen()
    file = read_case(case)
    target = output if output is not None else file.resolve(file.case.output.folder)
    folder.require_writable(target)
    surface = study_surface(file.case.surface, file.resolve)
    rubber = study_rubber(file.case.rubber, file.resolve)
    chains = chains_of(file.case, surface, rubber)
    opening = _opening(file, surface, rubber)
    for line in opening:
        say(console, line)

    folder.prepare(target)
    folder.write_text(target / "case.toml", file.text)
    draw.inputs(target / "figures", surface, rubber, file.case.load.speed)
    for chain in chains:
        solve(chain, file, console, target / f"{chain.name}.nc")
    _conclude(console, target, opening, chains)
    _fail_if_any([chain.failure for chain in chains if chain.failure is not None])


def _opening(file: CaseFile, surface: SurfaceStudy, rubber: RubberStudy) -> list[str]:
    """Return what the run starts from, line by line."""
    return [
        f"gripscale {dataset.versions()['gripscale']}, case {file.path}",
        "",
        "Surface",
        *(f"  {line}" for line in surface_lines(surface)),
        "",
        "Rubber",
        *(f"  {line}" for line in rubber_lines(rubber)),
    ]


def _conclude(console: Console, target: Path, opening: list[str], chains: list[Chain]) -> None:
    """Print the tables, write them down, draw the figures of the chains."""
    solved = [chain for chain in chains if chain.result is not None]
    for chain in solved:
        console.print()
        console.print(report.prediction_table(chain.solved, chain.title, console.width))
    if solved:
        console.print()
        say(console, report.LEGEND)
    tables = [report.prediction_table(c.solved, c.title, REPORT_WIDTH) for c in solved]
    folder.write_text(
        target / "report.txt",
        report.as_text(*opening, "", *tables, report.LEGEND, width=REPORT_WIDTH),
    )
    draw.chains(target / "figures", solved)
    console.print()
    say(console, f"Results, report and figures are in {target}")


def _fail_if_any(failures: list[ChainError]) -> None:
    """Raise the last failure, which sets the exit code, after a sentence for the others."""
    for failure in failures[:-1]:
        complain(str(failure))
    if failures:
        raise failures[-1]
