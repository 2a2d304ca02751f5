"""`gripscale study`, `compare-surfaces` and `compare-rubbers`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated

import typer

from gripscale.core.errors import InputError
from gripscale.questions import terminal


@terminal.case_command
def study_command(
    case: terminal.CasePath,
    vary: Annotated[
        list[str],
        typer.Option(
            help="What to vary, once or twice: speed=0.003:30:log9, pressure='1 bar,3 bar', "
            "temperature='0 C:60 C:lin7', effects=all,no_heat,none, smallest_wavelength, cut_off, "
            "thickness=1 mm:8 mm:log4, rubber=case,dma.txt, surface.",
            metavar="NAME=VALUES",
        ),
    ],
    output: terminal.OwnFolder = None,
    model: Annotated[
        str | None,
        terminal.option(
            "What predicts: direct (the whole measured surface at once), the default where the "
            "surface was measured, or chain (of sine waves), the default elsewhere."
        ),
    ] = None,
    tolerance: Annotated[
        float, typer.Option(help="Estimated relative error of each direct contact.")
    ] = 0.05,
    workers: terminal.Workers = None,
    cluster: terminal.Cluster = None,
    modulus: terminal.Modulus = None,
) -> None:
    """Vary one or two inputs of a case: table, figures, one result file; resumes where stopped."""
    from gripscale.case_file import folder
    from gripscale.case_file.named_inputs import read_named_inputs
    from gripscale.questions.vary.axis import parse_axes
    from gripscale.questions.vary.question import Variation
    from gripscale.questions.vary.study import Study

    axes = parse_axes(vary)
    work = terminal.CaseCommand(case)
    varied = read_named_inputs(axes, work.file, modulus)
    planned = Study(work.case, varied, model=model, tolerance=tolerance)
    work.open_results(output, "study")
    folder.save_case(work.file, work.target)
    data = planned.run(client=cluster, **work.solving(workers))
    work.finish(Variation(data), "table and figures")


CaseOfRest = Annotated[
    Path | None,
    terminal.option("Case of all else; by default the first case given.", metavar="CASE.toml"),
]


def case_of(arguments: Sequence[str], case: Path | None, what: str) -> Path:
    """Return the case the rest is taken from: the one stated, or the first of those given.

    Raises `InputError` if there is none; `what` is taken from it.
    """
    chosen = case or next((Path(text) for text in arguments if text.endswith(".toml")), None)
    if chosen is None:
        raise InputError(f"--case must be given: {what} are taken from a case")
    return chosen


@terminal.case_command
def compare_surfaces_command(
    surfaces: Annotated[
        list[str],
        terminal.argument(
            "Two to six surfaces: files of profiles, cases (their surface), or surfaces known by "
            "name.",
            "SURFACE...",
        ),
    ],
    case: CaseOfRest = None,
    x_unit: terminal.SurfaceUnit = None,
    z_unit: terminal.SurfaceUnit = None,
    channel: terminal.SurfaceChannel = None,
    crop: terminal.SurfaceCrop = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
) -> None:
    """Rank surfaces under one rubber by friction: how surely, and by which wavelengths."""
    from gripscale.case_file.named_inputs import names_of, read_surface
    from gripscale.questions.vary.ranking import compare_surfaces

    work = terminal.CaseCommand(case_of(surfaces, case, "the rubber and the load"))
    work.open_results(output, "surfaces")
    keys = terminal.surface_keys(x_unit=x_unit, z_unit=z_unit, channel=channel, crop=crop)
    read = [read_surface(value, work.file, keys) for value in surfaces]
    roads = dict(zip(names_of(surfaces), read, strict=True))
    ranking = compare_surfaces(work.case, roads, **work.solving(workers))
    work.finish(ranking, "tables and figures", drawings="")


@terminal.case_command
def compare_rubbers(
    rubbers: Annotated[
        list[str],
        terminal.argument(
            "Two to six compounds: files of moduli, cases (their rubber), or rubbers known by "
            "name.",
            "RUBBER...",
        ),
    ],
    case: CaseOfRest = None,
    temperature: Annotated[
        str | None,
        terminal.option('Such as "20 C"; by default one that all have or can be shifted to.'),
    ] = None,
    modulus: terminal.Modulus = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
) -> None:
    """Rank compounds on one surface by friction: with what confidence, and why."""
    from gripscale.case_file.named_inputs import names_of, read_rubber
    from gripscale.core.units import si_value
    from gripscale.questions.vary.ranking import compare_compounds

    chosen = case_of(rubbers, case, "the surface and the load")
    kelvin = si_value("--temperature", temperature, "K")
    work = terminal.CaseCommand(chosen)
    work.open_results(output, "rubbers")
    read = [read_rubber(value, work.file, modulus) for value in rubbers]
    compounds = dict(zip(names_of(rubbers), read, strict=True))
    solving = work.solving(workers)
    ranking = compare_compounds(work.case, compounds, temperature=kelvin, **solving)
    work.finish(ranking, "table and figures", drawings="")
