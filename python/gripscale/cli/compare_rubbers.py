"""`gripscale compare-rubbers A B ... --case CASE.toml`: compounds side by side on one road."""

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

    from gripscale.compounds import Compounds


@command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        typer.Argument(
            help="Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name. The others are compared with the first.",
            metavar="RUBBER...",
            show_default=False,
        ),
    ],
    case: Annotated[
        Path | None,
        typer.Option(
            help="Case whose road, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
            readable=False,
            show_default=False,
        ),
    ] = None,
    temperature: Annotated[
        str | None,
        typer.Option(
            help='Such as "20 C"; by default one that all have or can be shifted to.',
            show_default=False,
        ),
    ] = None,
    uncertainty: Annotated[
        bool, typer.Option(help="Predict what each measurement leaves open, too.")
    ] = True,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare compounds on the same road: friction, area, and what makes the difference."""
    from gripscale.case import folder, read_case
    from gripscale.compounds import compare_compounds
    from gripscale.units import parse_quantity

    chosen = case_of(rubbers, case, "the road and the load")
    try:
        kelvin = None if temperature is None else parse_quantity(temperature, "temperature")
    except ValueError as error:
        raise InputError(f"--temperature = {temperature!r}: {error}") from error
    file = read_case(chosen)
    target = output or file.resolve(file.case.output.folder) / "rubbers"
    folder.require_writable(target)
    console = screen()
    folder.make(target)
    if uncertainty:
        say(console, "The compounds; then, for what their measurements leave open, half-planes.")
    made = compare_compounds(
        file,
        dict(zip(names_of(rubbers), rubbers, strict=True)),
        target,
        temperature=kelvin,
        uncertainty=uncertainty,
        workers=workers,
        on_task=teller(console),
    )
    _conclude(console, made, target)


def _conclude(console: Console, made: Compounds, target: Path) -> None:
    """Print and keep the table, draw the figures, and say which predictions failed."""
    from gripscale.figures.compounds import compound_friction_figure, compound_moduli_figure
    from gripscale.figures.style import save_figure
    from gripscale.report.compounds_table import compounds_sentences, compounds_table

    table = compounds_table(made.data)
    below = [*compounds_sentences(made.data), *(f"note: {note}" for note in made.notes)]
    keep(console, target / "compounds.txt", [table], below)
    save_figure(compound_moduli_figure(made.rubbers), target, "compound_moduli")
    if "friction_running" in made.data:
        save_figure(compound_friction_figure(made.data), target, "compound_friction")
    console.print()
    say(console, f"Result (compounds.nc), table and figures are in {target}")
    statuses = made.data.prediction_status.values.tolist()
    fail_if_any([one for one in statuses if one != "converged"], "compounds")
