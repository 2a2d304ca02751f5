"""`gripscale cut-off CASE.toml`: contact and friction against the cut-off."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from gripscale.questions import terminal

if TYPE_CHECKING:
    from gripscale.half_space.result import RoughContact


@terminal.case_command
def cut_off_command(
    case: terminal.CasePath,
    down_to: Annotated[
        str | None,
        terminal.option(
            "Shortest wavelength, such as '10 um'; that of [below_measurement] by default.",
            metavar="LENGTH",
        ),
    ] = None,
    hurst: Annotated[
        float | None,
        terminal.option(
            "Hurst exponent of the roughness below the measurement, in place of that of the "
            "faces that touch.",
            metavar="NUMBER",
        ),
    ] = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
) -> None:
    """Contact and friction against the cut-off, down below what the profiles resolve."""
    import numpy as np

    from gripscale.core.units import in_mm, si_value
    from gripscale.questions.cut_off.question import cut_off

    end = si_value("--down-to", down_to, "m")
    work = terminal.CaseCommand(case)
    opening = f"Contact and friction of {work.file.path} against the cut-off"
    work.open_results(output, "cut_off", opening)
    measured = work.case.surface.measured
    lines = 0 if measured is None else len(measured.cleaned)
    solved: dict[float, list[RoughContact]] = {}

    def print_cut_off(contact: RoughContact) -> None:
        at_cut_off = solved.setdefault(contact.smallest_wavelength, [])
        at_cut_off.append(contact)
        if len(at_cut_off) == lines:
            lengths = [each.grid.lengths[0] for each in at_cut_off]
            friction, area = (
                np.average([getattr(each, name) for each in at_cut_off], weights=lengths)
                for name in ("friction_from_dissipation", "contact_fraction")
            )
            end = in_mm(contact.smallest_wavelength, 3)
            work.console.print(f"roughness down to {end}: μ = {friction:.3f}, A_r/A_0 = {area:.4g}")

    solving = work.solving(workers) | {"on_step": print_cut_off}
    result = cut_off(work.case, down_to=end, hurst=hurst, **solving)
    work.finish(result, "tables and figure")
