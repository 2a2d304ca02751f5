"""`gripscale reproduce`: the paper's figures, and its statements judged by number."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from gripscale.core import InputError
from gripscale.questions import terminal
from gripscale.questions.terminal import argument, command, option

TwoOfYours = Annotated[
    tuple[str, str] | None,
    option("Two of your own, files or cases; most figures show the first.", metavar="A B"),
]


@command
def reproduce(
    figures: Annotated[
        list[str] | None, argument("Such as fig5a fig9b; all by default.", "FIGURE...")
    ] = None,
    output: Annotated[Path, option("Folder for the results.", metavar="DIR")] = Path(
        "results/reproduction"
    ),
    surface: TwoOfYours = None,
    rubber: TwoOfYours = None,
    factors: Annotated[
        str | None, option("Magnification of wavelength and amplitude: 3.5/2.4,3/2.2,6/3.")
    ] = None,
    smallest_wavelength: Annotated[
        str | None, option("Of files of profiles; by default where the measurement ends.")
    ] = None,
    x_unit: terminal.SurfaceUnit = None,
    z_unit: terminal.SurfaceUnit = None,
    channel: terminal.SurfaceChannel = None,
    crop: terminal.SurfaceCrop = None,
    modulus: terminal.Modulus = None,
    temperature: Annotated[str | None, option('Of your rubbers, such as "20 C".')] = None,
    workers: terminal.Workers = None,
    cluster: terminal.Cluster = None,
) -> None:
    """Reproduce figures of Lind & Wangenheim 2014 and judge the paper's statements."""
    from gripscale.core import si_value
    from gripscale.reproduction.inputs import read_inputs
    from gripscale.reproduction.run import reproduce_paper
    from gripscale.reproduction.statement import verdict_table

    units = {"x_unit": x_unit, "z_unit": z_unit, "smallest_wavelength": smallest_wavelength}
    inputs = read_inputs(
        surface or (),
        rubber or (),
        [factor_pair(text) for text in (factors.split(",") if factors else ())],
        surface_keys=terminal.surface_keys(channel=channel, crop=crop, **units),
        rubber_keys={"modulus": modulus} if modulus else {},
        temperature=si_value("--temperature", temperature, "K"),
    )
    console = terminal.screen()
    options: Any = {"workers": workers, "client": cluster}
    options["on_task"] = terminal.progress_printer(console)
    statements = reproduce_paper(inputs, output, figures or (), **options)
    terminal.end_steps()
    closing = f"Figures, data, and statements.md with all numbers and reasons are in {output}"
    tables = [verdict_table(statements)] if statements else []
    terminal.print_parts(console, [*tables, closing])


def factor_pair(text: str) -> tuple[float, float]:
    """Return magnification factors of a text such as 3.5/2.4; raise `InputError` for others."""
    from gripscale.core import checks

    try:
        first, second = (float(part) for part in text.split("/"))
    except ValueError as error:
        raise InputError(f'factors must be pairs such as "3.5/2.4"; got {text!r}') from error
    for part in (first, second):
        if checks.number("factors", part) <= 1.0:
            raise InputError(f"factors must be greater than 1; got {part:g}")
    return first, second
