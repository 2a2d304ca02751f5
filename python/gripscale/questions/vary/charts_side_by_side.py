"""Charts of roads and compounds side by side: the ranking, and where its differences arise."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import COLOURS
from gripscale.core.units import MILLI, SQUARE_MM
from gripscale.io.table import significant
from gripscale.questions import view
from gripscale.questions.answer.variables import believed
from gripscale.questions.inputs.charts_of_rubber import compound_moduli_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber

CUBIC_MM = 1e-9
LEAST_POWER_SHARE = 0.02  # share of the largest part of the friction from which one is drawn
_RANKING = (
    "Friction over that of the first, with the 90 % interval of the ratio, and μ below it; "
    "friction of all waves down to each wavelength"
)


def compound_pictures(data: xr.Dataset, rubbers: Mapping[str, Rubber]) -> Iterator[Picture]:
    """Yield the figures of `gripscale.questions.Compounds`: friction, and moduli."""
    yield Picture(
        "compound_friction",
        ranking_figure(data, "rubber"),
        f"{_RANKING}; and up to each relaxation time, split as at small strain.",
        "A point with an interval and two curves for each compound, rising towards short waves "
        "and long times.",
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
        panels.append(_running_panel(data, "octave_friction", "longer waves"))
    if dim == "rubber" and "friction_by_decade" in data:
        panels.append(_running_panel(data, "friction_by_decade", "faster relaxation"))
    return Sheet(panels, len(panels), height=3.2).on_paper()


def _running_panel(data: xr.Dataset, name: str, words: str) -> Panel:
    """Return the running sum of parts of the friction, from where something is lost."""
    stacks = data[name].attrs["stacks"]
    parts = data[name].fillna(0.0).sortby(stacks, stacks != "octave")
    lost = np.abs(parts.transpose(..., stacks).values).max(axis=0)
    seen = np.flatnonzero(lost > LEAST_POWER_SHARE * lost.max(initial=0.0))
    running = parts.cumsum(stacks).assign_coords({stacks: parts[stacks]})
    running = running.assign_attrs({"long_name": f"friction of this and {words}", "symbol": "μ"})
    if seen.size:
        running = running.isel({stacks: slice(max(seen[0] - 1, 0), seen[-1] + 1)})
    curves = running.to_dataset(name="running")
    return view.panel(curves, "running", stacks, flags=xr.DataArray(False))


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
