"""`gripscale compare-surfaces` and `compare-rubbers`: roads or compounds side by side."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

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
            "name.",
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
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Rank roads under one rubber by friction: with what confidence, and by which wavelengths."""
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
        **work.solving(workers),
    )
    work.finish(roads, "tables and figures", drawings="", page=True)


@command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        argument(
            "Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name.",
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
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Rank compounds on one road by friction: with what confidence, and why."""
    from gripscale.case_file.named_inputs import names_of, read_rubber
    from gripscale.core.units import temperature_in_kelvin
    from gripscale.questions.vary.rubber_comparison import compare_compounds

    chosen = case_of(rubbers, case, "the road and the load")
    kelvin = None if temperature is None else temperature_in_kelvin(temperature)
    work = terminal.CaseCommand(chosen)
    work.open_results(output, "rubbers")
    compounds = compare_compounds(
        work.case,
        {
            name: read_rubber(value, work.file)
            for name, value in zip(names_of(rubbers), rubbers, strict=True)
        },
        temperature=kelvin,
        **work.solving(workers),
    )
    work.finish(compounds, "table and figures", text="compounds.txt", drawings="", page=True)
