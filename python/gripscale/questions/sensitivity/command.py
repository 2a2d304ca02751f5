"""`gripscale sensitivity CASE.toml`: what decides the friction, by derivatives."""

from __future__ import annotations

from typing import Annotated

import typer

from gripscale.questions import terminal


@terminal.case_command
def sensitivity_command(
    case: terminal.CasePath,
    vary: Annotated[
        list[str] | None,
        terminal.option(
            "Derivatives at several values of an input, once or twice: speed=0.003:30:log5, "
            "temperature='0 C,20 C,60 C', pressure, smallest_wavelength, rubber, surface.",
            metavar="NAME=VALUES",
        ),
    ] = None,
    bands: Annotated[
        int, typer.Option(help="Bands of frequency in a decade of the figure.", metavar="NUMBER")
    ] = 4,
    contact_fraction: Annotated[
        bool,
        typer.Option(
            "--contact-fraction",
            help="Also the derivatives of the contact area, by differences: four further contacts "
            "a band.",
        ),
    ] = False,
    with_feedback: Annotated[
        bool,
        typer.Option(
            "--with-feedback",
            help="Under softening or heat, also let strain and temperature of the rubber follow a "
            "change of speed, pressure or temperature: six further solutions a point.",
        ),
    ] = False,
    modulus: terminal.Modulus = None,
    output: terminal.OwnFolder = None,
    workers: terminal.Workers = None,
) -> None:
    """Tell which part of the master curve, and which input, decides the friction of a case."""
    from gripscale.case_file.named_inputs import read_named_inputs
    from gripscale.questions.sensitivity.question import DERIVED_OVER, sensitivity
    from gripscale.questions.vary.axis import parse_axes

    axes = parse_axes(vary or (), DERIVED_OVER)
    work = terminal.CaseCommand(case)
    work.open_results(output, "sensitivity", f"What decides the friction of {work.file.path}")
    result = sensitivity(
        work.case,
        vary=read_named_inputs(axes, work.file, modulus) or None,
        bands_per_decade=bands,
        contact_fraction=contact_fraction,
        with_feedback=with_feedback,
        **work.solving(workers),
    )
    work.finish(result, "tables and figure")
