"""`gripscale slip CASE.toml`: braking force over slip."""

from __future__ import annotations

from typing import Annotated

import typer

from gripscale.questions import terminal
from gripscale.questions.terminal import CasePath, OwnFolder, Workers, case_command, option


@case_command
def slip_command(
    case: CasePath,
    speed: Annotated[
        str, typer.Option(help="Speeds of the road, such as '50 km/h,80 km/h'.", metavar="SPEEDS")
    ] = "80 km/h",
    temperature: Annotated[
        str | None,
        option(
            "Temperatures of the rubber before the patch, such as '0 C,20 C' or '0 C:60 C:lin4'; "
            "that of the case by default.",
            metavar="TEMPERATURES",
        ),
    ] = None,
    braking: Annotated[
        str,
        typer.Option(help="Speeds from which and to which the wheels brake.", metavar="FROM,TO"),
    ] = "80 km/h,20 km/h",
    stiffness: Annotated[
        float, typer.Option(help="Shear stress of a bristle over its deflection [Pa/m].")
    ] = 1.5e8,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Braking force over slip of a tread as a brush, and braking distances; no tyre prediction."""
    from gripscale.core.errors import InputError
    from gripscale.questions.slip.question import slip_curve

    ends = [end.strip() for end in braking.split(",")]
    if len(ends) != 2:
        raise InputError(
            f'--braking must be two speeds, such as "80 km/h,20 km/h"; got {braking!r}'
        )
    work = terminal.CaseCommand(case)
    work.open_results(output, "slip", f"Braking force over slip of {work.file.path}")
    result = slip_curve(
        work.case,
        speed=speed,
        temperature=temperature,
        braking=ends,
        stiffness=stiffness,
        **work.solving(workers),
    )
    work.finish(result, "tables and figure")
