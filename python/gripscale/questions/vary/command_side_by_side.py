"""`gripscale compare-surfaces` and `compare-rubbers`: roads or compounds side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from gripscale import terminal
from gripscale.core.errors import InputError
from gripscale.terminal import OwnFolder, Workers, argument, command, option


def case_of(arguments: Sequence[str], case: Path | None, what: str) -> Path:
    """Return the case the rest is taken from: the one stated, or the first of those given.

    Raises `InputError` if there is none; `what` is taken from it.
    """
    chosen = case or next((Path(text) for text in arguments if text.endswith(".toml")), None)
    if chosen is None:
        raise InputError(f"--case must be given: {what} are taken from a case")
    return chosen


@command
def compare_surfaces_command(
    surfaces: Annotated[
        list[str],
        argument(
            "Two to six roads: files of profiles, cases (their surface), or surfaces known by "
            "name. The others are compared with the first.",
            "SURFACE...",
        ),
    ],
    case: Annotated[
        Path | None,
        option(
            "Case whose rubber, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
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
    from gripscale.case_file.named_inputs import names_of, read_surface
    from gripscale.questions.vary.surface_comparison import compare_surfaces

    work = terminal.CaseCommand(case_of(surfaces, case, "the rubber and the load"))
    work.open_results(output, "surfaces")
    roads = compare_surfaces(
        work.case,
        {
            name: read_surface(value, work.file)
            for name, value in zip(names_of(surfaces), surfaces, strict=True)
        },
        samples=samples or None,
        **work.solving(workers),
    )
    work.finish(roads, "tables and figures", drawings="", page=True)


@command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        argument(
            "Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name. The others are compared with the first.",
            "RUBBER...",
        ),
    ],
    case: Annotated[
        Path | None,
        option(
            "Case whose road, load and solver are taken; by default the first case given.",
            metavar="CASE.toml",
        ),
    ] = None,
    temperature: Annotated[
        str | None, option('Such as "20 C"; by default one that all have or can be shifted to.')
    ] = None,
    uncertainty: Annotated[
        bool, typer.Option(help="Predict what each measurement leaves open, too.")
    ] = True,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Compare compounds on the same road: friction, area, and what makes the difference."""
    from gripscale.case_file.named_inputs import names_of, read_rubber
    from gripscale.core.units import si_value
    from gripscale.questions.vary.rubber_comparison import compare_compounds

    chosen = case_of(rubbers, case, "the road and the load")
    kelvin = si_value("temperature", temperature, "K")
    work = terminal.CaseCommand(chosen)
    opening = (
        "Each compound is predicted first; then the range that the error of its measured moduli "
        "leaves, on half-planes."
    )
    work.open_results(output, "rubbers", *[opening] * uncertainty)
    compounds = compare_compounds(
        work.case,
        {
            name: read_rubber(value, work.file)
            for name, value in zip(names_of(rubbers), rubbers, strict=True)
        },
        temperature=kelvin,
        uncertainty=uncertainty,
        **work.solving(workers),
    )
    contents = "table and figures"
    work.finish(compounds, contents, text="compounds.txt", drawings="", page=True)
