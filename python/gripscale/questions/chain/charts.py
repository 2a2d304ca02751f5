"""Charts of waves and chains: area, friction and load by wavelength, evidence, heat.

Contact area and friction against falling wavelength are figures 5 and 8 of LW.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import chart, style
from gripscale.charts.chart import (
    Bars,
    CrossLine,
    Mark,
    Panel,
    PlotAxis,
    Series,
    ShadedBand,
    ValueMap,
)
from gripscale.charts.draw import Sheet
from gripscale.charts.style import BLUE, COLOURS, GREEN, GREY, INK, NARROW, ORANGE, RED, SKY
from gripscale.core import InputError
from gripscale.core.units import MILLI, ZERO_CELSIUS
from gripscale.half_space.result import RoughContact
from gripscale.questions.answer.variables import (
    ANSWER,
    AXIS_TITLES,
    HEADINGS,
    OF_THE_PAPER,
    answer_number,
)
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Views = Sequence[PredictionView]


def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw real contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols are the running values, open symbols and thin lines those of each wave; a model
    without waves is a level line at its total, with its answer as a band if it has one.
    Friction leaves out what is at rest, which has none;
    of a prediction without a single converged wave the legend says that there is nothing to draw.
    Lines are dashed beyond the measured band of the rubber.
    """
    return contact_sheet(predictions).on_paper()


def contact_sheet(predictions: Mapping[str, xr.Dataset]) -> Sheet:
    """Describe what `contact_figure` draws; arguments and errors are its own."""
    views = [PredictionView(data, name) for name, data in predictions.items()]
    judged = any(not view.waves for view in views)
    title = f"Points: {OF_THE_PAPER}, for comparison" if judged else ""
    return Sheet([_total_panel(views, name) for name in AXIS_TITLES], legend_title=title)


def _total_panel(views: Views, name: str) -> Panel:
    """Return the panel of the contact fraction or the friction, of and down to each wave."""
    if name == "contact_fraction":
        axis = PlotAxis(f"{HEADINGS[name]} $A_r/A_0$ [-]", log=True, high=1.15)
    else:
        least = [float(np.nanmin(view.usable(name), initial=0.0)) for view in views if view.waves]
        axis = PlotAxis(f"{HEADINGS[name]} [-]", low=min(0.0, *least, 0.0))
    abscissa = _wavelengths(views)
    marks = [
        mark
        for view, colour in zip(views, COLOURS, strict=False)
        if view.moving or name != "friction"
        for mark in _total_marks(view, name, colour, abscissa)
    ]
    failed = (mark for view in views if view.waves for mark in _failed(view, name))
    return Panel(abscissa, axis, [*marks, *failed])


def _wavelengths(views: Views) -> PlotAxis:
    columns = [view.column("wavelength") / MILLI for view in views if view.waves]
    return chart.wavelength_axis(np.concatenate([*columns, []]))


def _total_marks(view: PredictionView, name: str, colour: str, along: PlotAxis) -> Iterator[Mark]:
    """Yield the running value and that of each wave, or the total of a model without waves.

    Above them the answer with its interval, if there is one.
    """
    if not view.waves:
        if np.isfinite(total := view.total(name)):
            yield CrossLine(total, colour, f"{view.name}, total", "dotted", 1.4)
    elif not view.converged.any():
        yield Series([], [], colour, f"{view.name}: {view.why(view.waves - 1)}", dash="")
    else:
        x, beyond = view.column("wavelength") / MILLI, style.waves_beyond(view.data)
        running, each, down_to = f"running_{name}", view.usable(name), style.down_to(beyond)
        yield Series(x, view.usable(running), colour, f"{view.name}, running total", marker="o",
                     beyond=down_to)  # fmt: skip
        yield Series(x, each, colour, f"{view.name}, each wave", marker="o", beyond=beyond,
                     width=0.8, filled=False)  # fmt: skip
    best, low, high = answer_number(view.data, name)
    if np.isfinite(best):
        measured = np.isfinite(low)
        yield CrossLine(best, INK, ANSWER if measured else "answer", width=1.2)
        if measured:
            ends = (
                (0.0, 1.0) if along.low is None or along.high is None else (along.low, along.high)
            )
            yield ShadedBand(ends, [low] * 2, [high] * 2, INK, ANSWER, alpha=0.12)


def _failed(view: PredictionView, quantity: str) -> Iterator[Series]:
    x, y = view.column("wavelength") / MILLI, view.column(quantity)
    bad = ~view.converged & np.isfinite(x) & np.isfinite(y)
    if bad.any():
        yield Series(x[bad], y[bad], RED, "not converged", "", 2.3, marker="x", size=8.0)


# What warms a wave where it loses energy: name in results, in legends, and colour.
PARTS = {
    "flash_temperature_rise_uniform": ("all waves, spread evenly", SKY),
    "flash_temperature_rise_larger_waves": ("in the contact of larger waves", BLUE),
    "flash_temperature_rise_own": ("the wave's own", ORANGE),
}
BAR = 1.25  # left end of a bar over its wavelength, and that over its right end


def heat_figure(data: xr.Dataset, title: str = "") -> Figure:
    """Draw by how much each wave of a chain is warmer than the rubber before the contact.

    Bars are the temperature where the wave loses its energy, in the parts that add to it, those
    that cool it below zero: heat that comes up from the depth when the contact has passed. Dots are
    at the surface, in the contact of the wave. Waves without solution are left out.

    Raises `InputError` if there are no temperatures in `data`, of `ChainResult.to_dataset`.
    """
    return heat_sheet(data, title).on_paper()


def heat_sheet(data: xr.Dataset, title: str = "") -> Sheet:
    """Describe what `heat_figure` draws; arguments and errors are its own."""
    if not set(PARTS) <= set(data.data_vars) or "scale" not in data.dims:
        raise InputError("data must be of a chain solved with heat; got one without temperatures")
    data = data.isel(scale=np.isfinite(data.flash_temperature_rise_own.values))
    length = data.wavelength.values / MILLI
    above, below = np.zeros(length.size), np.zeros(length.size)
    marks: list[Mark] = [CrossLine(0.0, INK, width=0.7)]
    for name, (label, colour) in PARTS.items():
        part = data[name].values
        start = np.where(part > 0.0, above, below)
        marks.append(Bars(length / BAR, length * BAR, start, start + part, colour, label))
        above, below = above + np.maximum(part, 0.0), below + np.minimum(part, 0.0)
    before = (json.loads(data.attrs.get("conditions", "null")) or {}).get("temperature")
    if before is None:
        # the least that is left of any wave's without what warms it: of the temperature a wave was
        # solved at and the warming it found, which agree to some tenths of a kelvin
        rest = data.temperature - sum(data[name] for name in PARTS)
        before = float(rest.mean()) if rest.size else math.nan
    surface = data.contact_temperature - before
    marks.append(Series(length, surface, INK, "at the surface, in contact", "", marker="o",
                        size=4.0, filled=False))  # fmt: skip
    label = f"above the {before - ZERO_CELSIUS:.3g} °C before the contact [K]"
    panel = Panel(chart.wavelength_axis(length), PlotAxis(label, margin=0.08), marks)
    return Sheet([panel], 1, NARROW, 3.4, legend_columns=2, legend_title=title, gap=0.02)


def direct_heat_figure(contact: RoughContact, title: str = "") -> Figure:
    """Draw by how much the rubber is warmer than before a direct contact.

    On one side where the octaves of wavelengths lose their energy; on the other at the surface, of
    a line with its contact marked below. Raises `InputError` if the contact was not solved with
    heat, sliding.
    """
    if contact.surface_warming is None or contact.scales is None:
        raise InputError("contact must be solved with heat and slide; got one without temperatures")
    length = 2.0 * math.pi / contact.scales.wavenumber / MILLI
    top = 1.1 * float(contact.scales.warming.max())
    octaves = Panel(
        chart.wavelength_axis(length),
        PlotAxis("warming where the octave loses energy [K]", low=0.0, high=top),
        [Series(length, contact.scales.warming, ORANGE, marker="o")],
    )
    x, warming, words = contact.x / MILLI, contact.surface_warming, "warming of the surface [K]"
    along = PlotAxis("along the way of sliding $x$ [mm]", margin=0.0)
    if contact.height.ndim == 1:
        top = float(np.max(warming))
        level = float(np.average(warming, weights=contact.pressure))
        touching = np.where(contact.active, -0.06 * top, np.nan)
        marks: list[Mark] = [
            Series(x, warming, ORANGE, width=0.9, coarse=True),
            CrossLine(level, GREY, "mean in the contact, by pressure", "dashdot"),
            Series(x, touching, GREEN, "contact", width=4.0),
        ]
        warmth = PlotAxis(words, low=-0.12 * top, high=1.25 * top)
        surface = Panel(along, warmth, marks, legend="upper right")
    else:
        field = ValueMap(x, contact.y / MILLI, warming.T, words)
        surface = Panel(
            PlotAxis(along.label, grid=False), PlotAxis("$y$ [mm]", grid=False), [field]
        )
    layout = {"width_ratios": [1.0, 1.5]}
    return Sheet([octaves, surface], height=3.2, title=title, legend="", layout=layout).on_paper()
