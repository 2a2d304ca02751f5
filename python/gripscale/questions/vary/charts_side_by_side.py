"""Charts of roads and compounds side by side: the ranking, and where its differences arise."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.chart import Bars, CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.page_elements import Picture
from gripscale.charts.style import COLOURS, power_of_ten
from gripscale.core.units import MILLI, SQUARE_MM
from gripscale.io.table import significant
from gripscale.questions import view
from gripscale.questions.answer.variables import believed
from gripscale.questions.inputs.charts_of_rubber import compound_moduli_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber

# Of the largest difference: decades at either end with less are not drawn.
LEAST_MODULUS_SHARE = 0.005
MOST_TICKS = 4
CUBIC_MM = 1e-9
LEAST_POWER_SHARE = 0.02  # share of the largest friction of an octave from which one is drawn
_RANKING = (
    "Friction over that of the first, with the 90 % interval of the ratio, and μ below it; "
    "friction of all waves down to each wavelength"
)


def compound_pictures(data: xr.Dataset, rubbers: Mapping[str, Rubber]) -> Iterator[Picture]:
    """Yield the figures of `gripscale.questions.Compounds`: friction, and moduli."""
    yield Picture(
        "compound_friction",
        ranking_figure(data, "rubber"),
        f"{_RANKING}; difference from the first by relaxation time, split as at small strain.",
        "A point with an interval and a curve for each compound, rising towards short waves, and "
        "bars of differences.",
    )
    if rubbers:
        yield Picture(
            "compound_moduli",
            compound_moduli_figure(rubbers),
            "Storage modulus and loss factor of each compound, dashed beyond what was measured.",
            "Two panels of curves over the frequency, one curve for each compound.",
        )


def road_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the figures of `gripscale.questions.Surfaces`: friction, and statistics."""
    yield Picture(
        "roads_friction",
        ranking_figure(data, "surface"),
        f"{_RANKING}.",
        "A point with an interval and a curve for each surface, rising towards short waves.",
    )
    yield Picture(
        "roads_statistics",
        roads_statistics_figure(data),
        "Height difference correlation and spectrum of each surface.",
        "Two panels of curves, one for each surface.",
    )


def ranking_figure(data: xr.Dataset, dim: str) -> Figure:
    """Draw the ratios to the first, friction down to each wavelength, and by relaxation time."""
    names = data[dim].values.tolist()
    ratios, lows, highs = (
        data[f"friction_ratio{end}"].transpose(dim, "over").values[:, :1]
        for end in ("", "_low", "_high")
    )
    marks: list[Mark] = [CrossLine(1.0, width=0.7)]
    for at, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
        marks.append(
            Series([at], ratios[at], colour, name, "", marker="o", size=6.0, low=lows[at],
                   high=highs[at], listed=False)
        )  # fmt: skip
    friction = data[believed(data, "friction")].values
    ticks = {float(at): significant(mu, 2) for at, mu in enumerate(friction)}
    abscissa = PlotAxis("$\\mu$ [-]", ticks=ticks, low=-0.5, high=len(names) - 0.5)
    ordinate = PlotAxis("$\\mu$ over that of the first [-]", margin=0.1)
    panels = [Panel(abscissa, ordinate, marks)]
    if "octave_friction" in data:
        panels.append(_octaves_panel(data, dim))
    if dim == "rubber" and "friction_by_decade" in data:
        panels.append(_decades_panel(data))
    return Sheet(panels, len(panels), height=3.2).on_paper()


def _octaves_panel(data: xr.Dataset, dim: str) -> Panel:
    """Return the friction of all longer waves over wavelength, where something is lost."""
    parts = data["octave_friction"].fillna(0.0).sortby("octave", False)
    lost = np.abs(parts.transpose(dim, ...).values).max(axis=0)
    octaves = np.flatnonzero(lost > LEAST_POWER_SHARE * lost.max(initial=0.0))
    about = {"long_name": "friction of this and longer waves", "symbol": "μ"}
    running = parts.cumsum("octave").assign_coords(octave=parts["octave"]).assign_attrs(about)
    if octaves.size:
        running = running.isel(octave=slice(max(octaves[0] - 1, 0), octaves[-1] + 1))
    curves = data[[dim]].assign(running=running)
    return view.panel(curves, "running", "octave", flags=xr.DataArray(False))


def _decades_panel(data: xr.Dataset) -> Panel:
    """Return the difference of each compound to the first by decade of relaxation time."""
    names = data.rubber.values.tolist()[1:]
    parts = data.friction_by_decade.transpose("rubber", "decade").fillna(0.0)
    differences = parts - parts.isel(rubber=0, drop=True)
    largest = np.abs(differences.values).max(axis=0)
    seen = np.flatnonzero(largest >= LEAST_MODULUS_SHARE * largest.max(initial=0.0))
    if seen.size:
        differences = differences.isel(decade=slice(seen[0], seen[-1] + 1))
    start = np.arange(differences.sizes["decade"]) - 0.4
    width = 0.8 / len(names)
    marks: list[Mark] = [
        Bars(start + i * width, start + (i + 1) * width, 0.0, differences.sel(rubber=name).values,
             COLOURS[(i + 1) % len(COLOURS)])
        for i, name in enumerate(names)
    ]  # fmt: skip
    step = max(1, math.ceil(start.size / MOST_TICKS))
    ticks = {
        float(i): power_of_ten(round(math.log10(time)))
        for i, time in enumerate(differences.decade.values)
        if i % step == 0
    }
    return Panel(
        PlotAxis("relaxation time from [s]", ticks=ticks),
        PlotAxis("difference of $\\mu$ from the first [-]"),
        [*marks, CrossLine(0.0, width=0.7)],
    )


def roads_statistics_figure(data: xr.Dataset) -> Figure:
    """Draw C_z [mm^2] over lag and the spectrum of lines [mm^3] over wavenumber of each road.

    `data` is that of `gripscale.questions.Surfaces`.
    """
    panels = []
    for name, places, size, area, x, y in (
        ("correlation", "lag", MILLI, SQUARE_MM, "lag $l$ [mm]",
         "height difference $C_z$ [mm$^2$]"),
        ("spectrum", "wavenumber", 1.0 / MILLI, CUBIC_MM, "wavenumber $q$ [rad/mm]",
         "spectrum $C_1$ [mm$^3$]"),
    ):  # fmt: skip
        curves: list[Mark] = []
        for road, colour in zip(data.surface.values, COLOURS, strict=False) if name in data else ():
            value = data[name].sel(surface=road).values / area
            curves.append(Series(data[places].values / size, value, colour, str(road)))
        panels.append(Panel(PlotAxis(x, log=True), PlotAxis(y, log=True), curves))
    return Sheet(panels, height=3.2).on_paper()
