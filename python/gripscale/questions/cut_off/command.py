"""`gripscale cut-off CASE.toml`: contact and friction against the cut-off."""

from __future__ import annotations

from typing import Annotated

from gripscale import terminal
from gripscale.core.units import si_value
from gripscale.terminal import CasePath, OwnFolder, Workers, command, option


@command
def cut_off_command(
    case: CasePath,
    down_to: Annotated[
        str | None,
        option(
            "Shortest wavelength, such as '10 um'; that of [below_measurement] by default.",
            metavar="LENGTH",
        ),
    ] = None,
    hurst: Annotated[
        float | None,
        option(
            "Hurst exponent of the roughness below the measurement, in place of that of the "
            "faces that touch.",
            metavar="NUMBER",
        ),
    ] = None,
    output: OwnFolder = None,
    workers: Workers = None,
) -> None:
    """Contact and friction against the cut-off, down below what the profiles resolve."""
    from gripscale.questions.cut_off.question import cut_off

    end = si_value("--down-to", down_to, "m")
    work = terminal.CaseCommand(case)
    opening = f"Contact and friction of {work.file.path} against the cut-off"
    work.open_results(output, "cut_off", opening)
    result = cut_off(work.case, down_to=end, hurst=hurst, **work.solving(workers))
    work.finish(result, "tables and figure")
