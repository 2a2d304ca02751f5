"""`gripscale fit-surface FILES`: the surface half of a run, from profiles to sine waves."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from gripscale.cli.terminal import command, say, screen

if TYPE_CHECKING:
    from gripscale.surface import PreparedSurface


def _option(text: str) -> Any:
    return typer.Option(help=text, show_default=False)


@command
def fit_surface(
    files: Annotated[list[str], typer.Argument(help="Profiles.", show_default=False)],
    scales: Annotated[int | None, _option("Number of sine waves.")] = None,
    smallest_wavelength: Annotated[str | None, _option('The last wave, such as "0.1 mm".')] = None,
    cut_off: Annotated[
        str | None,
        _option(
            'Where the roughness ends, in its place: "0.1 mm", "instrument", "rms_slope 1.3" (of '
            'the surface), "rms_slope 1.3 of profile", either with "extrapolate" at its end.'
        ),
    ] = None,
    slopes: Annotated[bool, _option("Print the rms slope down to each wavelength.")] = False,
    upper_share: Annotated[float, typer.Option(help="Share of the heights that counts.")] = 1.0,
    s_wavelength: Annotated[float | None, _option("Given instead of fitted.")] = None,
    s_amplitude: Annotated[float | None, _option("Given instead of fitted.")] = None,
    single_factor: Annotated[bool, _option("One factor for both lengths.")] = False,
    crop: Annotated[tuple[str, str] | None, _option('Such as "120 mm" "1780 mm".')] = None,
    x_unit: Annotated[str | None, _option("Where the file does not state it.")] = None,
    z_unit: Annotated[str | None, _option("Where the file does not state it.")] = None,
    keep_spikes: Annotated[bool, _option("Leave spikes in.")] = False,
    detrend: Annotated[str, typer.Option(help="linear, mean or none.")] = "linear",
    output: Annotated[
        Path | None, typer.Option(help="Folder for figures.", metavar="DIR", readable=False)
    ] = None,
) -> None:
    """Clean profiles, find their height difference correlation and fit sine waves to it."""
    from gripscale.case import Surface, folder, prepare_surface, validate
    from gripscale.report.cut_off import slope_table
    from gripscale.report.inputs_text import surface_lines, waves_table

    stated = {
        "files": files,
        "scales": scales,
        "smallest_wavelength": smallest_wavelength,
        "cut_off": cut_off,
        "upper_share": upper_share,
        "s_wavelength": s_wavelength,
        "s_amplitude": s_amplitude,
        "crop": None if crop is None else list(crop),
        "x_unit": x_unit,
        "z_unit": z_unit,
    }
    values = {key: value for key, value in stated.items() if value is not None}
    if scales is None and smallest_wavelength is None and cut_off is None:
        values["scales"] = 8
    flags = {"remove_spikes": not keep_spikes, "detrend": detrend, "single_factor": single_factor}
    surface = validate(Surface, values | flags, "options")
    if output is not None:
        folder.require_writable(output)
    prepared = prepare_surface(surface)
    console = screen()
    lines = [*surface_lines(prepared), *waves_table(prepared.sines), *_ambiguity(prepared)]
    if slopes and prepared.measured is not None:
        lines += slope_table(prepared.measured.slopes)
    for line in lines:
        say(console, line)
    if output is not None:
        from gripscale.figures.case_all import surface_figures

        folder.make(output)
        surface_figures(prepared, output)
        say(console, f"Figures are in {output}")


def _ambiguity(prepared: PreparedSurface) -> Iterator[str]:
    """Yield how far the correlation determines the waves, where there are several."""
    from gripscale.surface import sine_ambiguity

    if prepared.correlation is None or len(prepared.sines) < 2:
        return
    found = sine_ambiguity(prepared.correlation, prepared.sines)
    low, high = (length * 1e3 for length in found.first_wavelength)
    yield (
        f"C_z is known to {found.band:.2g} decades; {len(found.stacks)} of {found.tried} stacks "
        f"tried follow it as well: {found.waves.low:.0f} to {found.waves.high:.0f} waves, "
        f"s_wavelength {found.s_wavelength.low:.2g} to {found.s_wavelength.high:.2g}, "
        f"first wave {low:.3g} to {high:.3g} mm, "
        f"rms slope {found.rms_slope.low:.2f} to {found.rms_slope.high:.2f}"
    )
