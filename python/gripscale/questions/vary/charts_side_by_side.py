"""Charts of roads and compounds side by side: which waves and relaxation times tell them apart."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import chart
from gripscale.charts.chart import Bars, CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.page_elements import Picture
from gripscale.charts.style import COLOURS, power_of_ten
from gripscale.core.arrays import Array
from gripscale.core.units import MILLI, SQUARE_MM
from gripscale.io.table import significant
from gripscale.questions.inputs.charts_of_rubber import compound_moduli_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber

LEAST_MODULUS_SHARE = 0.005
"""Of the largest difference: decades at either end with less are not drawn."""
MOST_TICKS = 4
CUBIC_MM = 1e-9
LEAST_POWER_SHARE = 0.02
"""Share of the largest friction of an octave from which one is drawn."""
_STEP = 1.12
"""Between the bars of roads beside the smallest wavelength, as a ratio of wavelengths."""


def compound_pictures(data: xr.Dataset, rubbers: Mapping[str, Rubber]) -> Iterator[Picture]:
    """Yield the figures of `gripscale.questions.Compounds`: friction by wave, and moduli."""
    if "friction_running" in data:
        yield Picture(
            "compound_friction",
            compound_friction_figure(data),
            "Where the road was measured, friction of the direct contact over that of the first "
            "compound with its 90 % interval, which ranks the compounds, and μ below it. Of the "
            "chain, less reliable: friction of all waves down to each wavelength, where bars are "
            "the ranges of the totals, and the difference from the first by relaxation time.",
            "A point with an interval and a curve for each compound, rising towards short waves, "
            "and bars of differences.",
        )
    if rubbers:
        yield Picture(
            "compound_moduli",
            compound_moduli_figure(rubbers),
            "Storage modulus and loss factor of each compound, dashed beyond what was measured.",
            "Two panels of curves over the frequency, one curve for each compound.",
        )


def road_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the figures of `gripscale.questions.Roads`: statistics, and friction by wavelength."""
    yield Picture(
        "roads_statistics",
        roads_statistics_figure(data),
        "Height difference correlation and spectrum of each road.",
        "Two panels of curves, one for each road.",
    )
    yield Picture(
        "roads_friction",
        roads_friction_figure(data),
        "Friction of all waves down to each wavelength, of the direct contact by the energy lost; "
        "bars are the ranges of the totals.",
        "A panel for each model with a curve for each road, rising towards short waves.",
    )


def compound_friction_figure(data: xr.Dataset) -> Figure:
    """Draw the ranking, friction of all waves down to each, and differences by relaxation time.

    `data` is that of `gripscale.questions.Compounds`. Waves and relaxation times are of the chain.
    """
    ranked = "best_friction" in data
    chain = "chain, less reliable" if ranked else "chain"
    marks: list[Mark] = []
    for name, colour in zip(data.rubber.values.tolist(), COLOURS, strict=False):
        compound = data.sel(rubber=name)
        wavelength = compound.wavelength.values / MILLI
        marks += _running(wavelength, compound, colour, name, float(wavelength[-1]))
    panels = [_ranking_panel(data)] if ranked else []
    panels.append(
        Panel(
            chart.wavelength_axis(data.wavelength.values / MILLI),
            PlotAxis("$\\mu$ of this and larger waves [-]", low=0.0),
            marks,
            title=chain,
        )
    )
    if "friction_by_decade_difference" in data:
        panels.append(replace(_decades_panel(data), title=chain))
    return Sheet(panels, len(panels)).on_paper()


def _ranking_panel(data: xr.Dataset) -> Panel:
    """Return the best friction of each compound over that of the first, with its interval."""
    marks: list[Mark] = [CrossLine(1.0, width=0.7)]
    names = data.rubber.values.tolist()
    for at, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
        compound = data.isel(rubber=at)
        ratio = float(compound.friction_ratio)
        low, high = (
            [float(compound.get(f"friction_ratio_{end}", math.nan))] for end in ("low", "high")
        )
        marks.append(
            Series([at], [ratio], colour, name, "", marker="o", size=6.0, low=low, high=high,
                   listed=False)
        )  # fmt: skip
    best = {float(at): significant(mu, 2) for at, mu in enumerate(data.best_friction.values)}
    return Panel(
        PlotAxis("$\\mu$, best estimate [-]", ticks=best, low=-0.5, high=len(names) - 0.5),
        PlotAxis("$\\mu$ over that of the first [-]", margin=0.1),
        marks,
        title="direct contact: the ranking",
    )


def _running(x: Array, data: xr.Dataset, colour: str, label: str, end: float) -> list[Mark]:
    """Return friction down to each wave and, at the wavelength `end`, the range of its total."""
    running = data.friction_running
    marks: list[Mark] = [Series(x, running, colour, label, marker="o", size=3.0)]
    if "total_friction_low" in data:
        ends = [float(data.total_friction_low), float(data.total_friction_high)]
        marks.append(Series([end] * 2, ends, colour, width=3.0, alpha=0.35))
    return marks


def _decades_panel(data: xr.Dataset) -> Panel:
    """Return the difference of each compound to the first by decade of relaxation time."""
    names = data.rubber.values.tolist()[1:]
    differences = data.friction_by_decade_difference.transpose("rubber", "decade").fillna(0.0)
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

    `data` is that of `gripscale.questions.Roads`.
    """
    correlation: list[Mark] = []
    spectrum: list[Mark] = []
    for name, colour in zip(data.surface.values.tolist(), COLOURS, strict=False):
        road = data.sel(surface=name)
        if "correlation" in road:
            value = road.correlation.values / SQUARE_MM
            correlation.append(Series(road.lag.values / MILLI, value, colour, name))
        if "spectrum" in road:
            value = road.spectrum.values / CUBIC_MM
            spectrum.append(Series(road.wavenumber.values * MILLI, value, colour, name))
    panels = [
        Panel(
            PlotAxis("lag $l$ [mm]", log=True),
            PlotAxis("height difference $C_z$ [mm$^2$]", log=True),
            correlation,
        ),
        Panel(
            PlotAxis("wavenumber $q$ [rad/mm]", log=True),
            PlotAxis("spectrum $C_1$ [mm$^3$]", log=True),
            spectrum,
        ),
    ]
    return Sheet(panels, height=3.2).on_paper()


def roads_friction_figure(data: xr.Dataset) -> Figure:
    """Draw the friction of all longer waves over wavelength, a panel for each model.

    Bars at the end are what other stretches of the road might give, in 90 % of the samples.
    """
    # From the first to the last octave in which something is lost.
    running = np.nan_to_num(data.friction_running.values.reshape(-1, data.sizes["octave"]))
    lost = np.abs(np.diff(running, axis=1, prepend=0.0)).max(axis=0)
    octaves = np.flatnonzero(lost > LEAST_POWER_SHARE * lost.max())
    if octaves.size:
        data = data.isel(octave=slice(max(octaves[0] - 1, 0), octaves[-1] + 1))
    wavelength = data.octave.values / MILLI
    roads = data.surface.values.tolist()
    panels = []
    for model in data.model.values:
        of_model = data.sel(model=model)
        if not np.isfinite(of_model.friction_running).any():
            continue
        marks: list[Mark] = []
        for at, (name, colour) in enumerate(zip(roads, COLOURS, strict=False)):
            end = float(wavelength[-1]) / _STEP ** (1 + at)
            marks += _running(wavelength, of_model.sel(surface=name), colour, name, end)
        ends = [*wavelength, wavelength[-1] / _STEP ** len(roads)]
        panels.append(Panel(
            chart.wavelength_axis(ends),
            PlotAxis("$\\mu$ of this and longer waves [-]", low=0.0),
            marks,
            title=str(model),
        ))  # fmt: skip
    layout = {"sharey": True}
    panels = panels or [Panel(PlotAxis(), PlotAxis())]
    return Sheet(panels, len(panels), height=3.2, layout=layout).on_paper()
