"""`gripscale compare-surfaces A B ... --case CASE.toml`: roads side by side under one rubber."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from gripscale.cli.options import OwnFolder, Workers
from gripscale.cli.progress import teller
from gripscale.cli.side_by_side import case_of, fail_if_any, keep, names_of
from gripscale.cli.terminal import command, say, screen
from gripscale.errors import InputError

if TYPE_CHECKING:
    from rich.console import Console

    from gripscale.roads import Roads


@command
def compare_surfaces(
    surfaces: Annotated[
        list[str],
        typer.Argument(
            help="Two to six roads: files of profiles, cases (their surface), or surfaces known by "
            "name. The others are compared with the first.",
            metavar="SURFACE...",
            show_default=False,
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(
            help="Case whose rubber, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
        ),
    ] = None,
    samples: Annotated[
        int,
        typer.Option(help="Stretches drawn of each road, for the range of its totals; 0: none."),
    ] = 20,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare roads under the same rubber: friction, area, and which scale makes the difference."""
    from gripscale.case import folder, read_case
    from gripscale.roads import compare_surfaces as compare

    file = read_case(case_of(surfaces, case, "the rubber and the load"))
    target = output or file.resolve(file.case.output.folder) / "surfaces"
    folder.require_writable(target)
    console = screen()
    folder.make(target)
    made = compare(
        file,
        dict(zip(names_of(surfaces), surfaces, strict=True)),
        target,
        samples=samples or None,
        workers=workers,
        on_task=teller(console),
    )
    _conclude(console, made, target)


def _conclude(console: Console, made: Roads, target: Path) -> None:
    """Print and keep the table, draw figures and page, and say which predictions failed."""
    from gripscale.figures.roads import roads_friction_figure, roads_statistics_figure
    from gripscale.figures.style import save_figure
    from gripscale.report import write_report
    from gripscale.report.roads_table import roads_failures, roads_sentences, roads_tables

    below = [*roads_sentences(made.data), *(f"note: {note}" for note in made.notes)]
    keep(console, target / "surfaces.txt", roads_tables(made.data), below)
    save_figure(roads_statistics_figure(made.data), target, "roads_statistics")
    save_figure(roads_friction_figure(made.data), target, "roads_friction")
    console.print()
    say(console, f"Result (surfaces.nc), table and figures are in {target}")
    try:
        say(console, f"Page: {write_report(target / 'surfaces.nc')}")
    except InputError as error:  # the extra is not installed
        say(console, f"note: no page; {error}")
    fail_if_any(roads_failures(made.data), "predictions")
