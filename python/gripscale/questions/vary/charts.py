"""Charts of a study: totals over what was varied, which waves make them, speed and temperature.

Contact area and friction against wavelength over a study are figures 5 to 9 of LW.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np
import xarray as xr

from gripscale.charts import chart, style
from gripscale.charts.chart import Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Sheet
from gripscale.charts.page_elements import Picture
from gripscale.charts.style import BEYOND_LABEL, BLUE, GREY, INK, NARROW
from gripscale.core.arrays import Array
from gripscale.core.units import MILLI
from gripscale.io.table import significant
from gripscale.questions.answer.variables import AXIS_TITLES, believed
from gripscale.questions.vary.axis import (
    VARIED_INPUTS,
    axis_label,
    axis_shown,
    dimensions,
    name_of,
    names_at,
    numeric,
    of_numbers,
    several,
)
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT, REDUCED_SPEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_NAMES = 12  # names in a legend of curves, evenly spaced among more
MOST_BANDS = 3  # curves beyond which intervals would cover each other, and are not drawn
INTERVAL = "90 % interval"


def varied_axis(data: xr.Dataset, name: str) -> tuple[PlotAxis, Array]:
    """Return a varied axis of numbers and its values as they are drawn."""
    x = axis_shown(data, name).of(data[name].values)
    low, high = float(x.min()), float(x.max())
    limits: dict[str, Any] = {"low": low, "high": high} if high > low else {}
    return PlotAxis(axis_label(data, name), log=low > 0.0 and high > 8.0 * low, **limits), x


def _curves(data: xr.Dataset, over: list[str]) -> Iterator[tuple[dict[str, int], str, str]]:
    """Yield the points of the axes `over`, with colour and name."""
    points = list(product(*(range(data.sizes[name]) for name in over)))
    colours = style.colours(len(points), ordered=len(over) == 1 and over[0] in numeric(data))
    if over == ["temperature"]:
        colours = style.shades(len(points), "Plasma")
    for point, colour in zip(points, colours, strict=True):
        at = dict(zip(over, point, strict=True))
        yield at, colour, names_at(data, at)


def _beyond(data: xr.Dataset, variable: xr.DataArray) -> xr.DataArray:
    """Return which predictions rest on extrapolation; where it is not known, none."""
    flags = data["total_friction"].copy(data=style.predictions_beyond(data))
    covered = set(flags.dims) <= set(variable.dims)
    return xr.broadcast(flags if covered else xr.DataArray(False), variable)[0]


def _ordinate(quantity: str) -> PlotAxis:
    """Return the axis of a number of an answer: of areas logarithmic, of friction from zero."""
    area = quantity == "contact_fraction"
    return PlotAxis(f"{AXIS_TITLES[quantity]} [-]", log=area, low=None if area else 0.0)


def _total_panel(data: xr.Dataset, quantity: str, axis: str) -> Panel:
    """Return a total over an axis, a curve for each point of the others; names are points."""
    name, numbers = believed(data, quantity), of_numbers(data, axis)
    variable = data[name]
    flags = _beyond(data, variable)
    if numbers:
        abscissa, x = varied_axis(data, axis)
    else:
        # A point over a name has no line to dash: a star is behind the name.
        stars = flags.any([dim for dim in variable.dims if dim != axis]).values
        names = [f"{name_of(data, axis, i)}{' *' * bool(star)}" for i, star in enumerate(stars)]
        x = np.arange(len(names), dtype=float)
        abscissa = PlotAxis(
            f"{VARIED_INPUTS[axis].words} [-]", ticks=dict(enumerate(names)), margin=0.3
        )
    others = [str(dim) for dim in variable.dims if dim != axis]
    ends = [data[f"{name}_{end}"] for end in ("low", "high") if f"{name}_{end}" in data]
    drawn: dict[str, Any] = {"dash": "", "size": 4.5}
    if numbers:
        drawn = {"dash": "solid", "size": 3.0, "clip": False}
    marks: list[Mark] = []
    curves = list(_curves(data, others))
    for at, colour, label in curves:
        only = colour if others else BLUE
        y, beyond, *interval = (
            part.isel(at).transpose(axis).values for part in (variable, flags, *ends)
        )
        bars: dict[str, Any] = {}
        if interval and np.isfinite(interval[0]).any():
            if not numbers:
                bars = dict(zip(("low", "high"), interval, strict=True))
            elif len(curves) <= MOST_BANDS:
                low, high = interval
                marks.append(ShadedBand(x, low, high, only, "" if others else INTERVAL, 0.15))
        marks.append(
            Series(x, y, only, label or "sliding", marker="o", beyond=numbers & beyond, **drawn,
                   **bars)
        )  # fmt: skip
    return Panel(abscissa, _ordinate(quantity), marks)


def totals_figure(result: xr.Dataset) -> Figure:
    """Draw A_r/A_0 and friction over the first numeric axis, a line for each value of the other.

    They are the answers with their 90 % intervals where there are any, else the totals.
    Without a numeric axis they are drawn as points over the names of the first one. Predictions
    that did not converge leave gaps. What rests on the rubber beyond its measured band is dashed,
    of names has a star.
    """
    names = dimensions(result)
    axis = (numeric(result) or names)[0]
    area, friction = (_total_panel(result, name, axis) for name in AXIS_TITLES)
    keys = []
    if any(name.endswith(" *") for name in (area.x.ticks or {}).values()):
        keys.append(Series([], [], GREY, BEYOND_LABEL, dash="", marker="$*$"))
    named = len(area.marks) > 1 or len(friction.marks) > 1 or bool(keys)
    named |= any(np.any(mark.beyond) for mark in area.marks if isinstance(mark, Series))
    legend = "above" if named else ""
    return Sheet([area, friction], legend=legend, legend_columns=4, keys=keys).on_paper()


def _wave_panel(data: xr.Dataset, quantity: str) -> Panel:
    """Return a number down to each wave against wavelength, a curve for each prediction."""
    flags = data["wavelength"].copy(data=style.waves_beyond(data))
    values, lengths, flags = xr.broadcast(
        data[f"running_{quantity}"], data["wavelength"] / MILLI, flags
    )
    curves = list(_curves(data, [str(dim) for dim in values.dims if dim != "scale"]))
    every = -(-len(curves) // _MOST_NAMES)
    marks: list[Mark] = []
    for i, (at, colour, label) in enumerate(curves):
        x, y, beyond = (part.isel(at).values for part in (lengths, values, flags))
        marks.append(Series(x, y, colour, label, marker="o", size=3.0,
                            beyond=style.down_to(beyond), listed=i % every == 0))  # fmt: skip
    area = quantity == "contact_fraction"
    label = f"{_AREA if area else 'friction coefficient'} down to each wave [-]"
    ordinate = PlotAxis(label, log=area, low=None if area else 0.0, high=1.15 if area else None)
    return Panel(chart.wavelength_axis(lengths.values), ordinate, marks)


_AREA = "real contact area $A_r/A_0$"
# Octaves and decades that never reach this share of the friction are not drawn.
_LEAST_SHARE = 0.005


def _stacked(
    result: xr.Dataset,
    axis: str,
    parts: xr.DataArray,
    names: list[str],
    ordinate: PlotAxis,
    scale: str,
) -> Panel:
    """Return a band for each part, the last first: so they stand in the legend as in the stack."""
    rows = parts.transpose(..., axis).values
    there = np.nan_to_num(rows)
    upper = np.where(np.isnan(rows).all(axis=0), np.nan, np.cumsum(there, axis=0))
    seen = np.flatnonzero(there.max(axis=1) >= _LEAST_SHARE * there.sum(axis=0).max())
    abscissa, x = varied_axis(result, axis)
    bands: list[Mark] = [
        ShadedBand(x, upper[i] - there[i], upper[i], colour, names[i], 1.0, edged=True)
        for i, colour in zip(seen, style.shades(max(seen.size, 2), scale), strict=False)
    ]
    total = Series(x, upper[-1], INK, width=1.2, clip=False,
                   beyond=style.predictions_beyond(result))  # fmt: skip
    return Panel(abscissa, ordinate, [*bands[::-1], total])


def map_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 over the speed, to the right, and the temperature.

    Dots are the predictions; open where some of the friction rests on the rubber beyond its
    measured band, crosses where the temperature lies beyond those the shift rests on. What did not
    converge is left white.
    """
    result = result.sortby(["temperature", "speed"]).transpose("temperature", "speed", ...)
    (abscissa, speeds), (ordinate, celsius) = (
        varied_axis(result, name) for name in ("speed", "temperature")
    )
    beyond = style.predictions_beyond(result).astype(bool)
    shifted = result[BEYOND_SHIFT].values.astype(bool)
    solved = np.isfinite(result.total_friction.values)
    x, y = np.meshgrid(speeds, celsius)
    kinds = (
        (solved & ~beyond & ~shifted, "solved", ".", INK, 2.5),
        (solved & beyond & ~shifted, BEYOND_LABEL, "o", INK, 3.0),
        (solved & shifted, "beyond the temperatures of the shift", "x", GREY, 3.0),
    )
    points = [
        Series(x[rows], y[rows], colour, label, "", marker=marker, size=size,
               filled=marker != "o", clip=False)
        for rows, label, marker, colour, size in kinds
        if rows.any()
    ]  # fmt: skip
    panels = []
    for quantity, title in reversed(AXIS_TITLES.items()):
        solved_there = result[believed(result, quantity)].values
        values = chart.ValueMap(speeds, celsius, solved_there, f"{title} [-]", levels=9)
        frame = replace(abscissa, grid=False), replace(ordinate, grid=False)
        panels.append(Panel(*frame, [values, *points]))
    return Sheet(panels, height=3.3, layout={"sharey": True}).on_paper()


def friction_master_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 of all temperatures over the reduced speed a_T v.

    Where temperature does nothing but shift the relaxation times, they are one curve. Dashed is
    what rests on the rubber beyond its measured band.
    """
    celsius = axis_shown(result, "temperature").of(result.temperature)
    label = axis_label(result, "temperature")
    bar = chart.ColourBar(float(celsius.min()), float(celsius.max()), "Plasma", label)
    speeds = axis_shown(result, "speed")
    shares = (celsius - celsius.min()) / max(float(np.ptp(celsius)), 1e-9)
    scale = style.shades(256, "Plasma")
    panels = []
    for quantity in reversed(AXIS_TITLES):
        name = believed(result, quantity)
        flags = _beyond(result, result[name])
        marks: list[Mark] = []
        for i, share in enumerate(shares):
            x, y, beyond = (
                part.isel(temperature=i).values
                for part in (result[REDUCED_SPEED], result[name], flags)
            )
            marks.append(Series(speeds.of(x), y, scale[round(255 * float(share))],
                                name_of(result, "temperature", i), width=1.0, marker="o", size=2.6,
                                beyond=beyond, listed=False))  # fmt: skip
        abscissa = PlotAxis(f"reduced speed $a_T v$ [{speeds.unit}]", log=True, numbers=7)
        panels.append(Panel(abscissa, _ordinate(quantity), marks))
    return Sheet(panels, height=3.3, colour_bar=bar).on_paper()


def stacked_panels(data: xr.Dataset) -> dict[str, Panel]:
    """Return what makes the friction over a single axis of numbers, by the name of its figure."""
    if several(data) != numeric(data) or len(several(data)) != 1:
        return {}
    (axis,) = several(data)
    data = data.isel({name: 0 for name in dimensions(data) if name != axis})
    panels = {}
    if "octave_friction" in data:
        parts = data.octave_friction.sortby("octave", ascending=False)
        names = [f"from {significant(end, 2)} mm" for end in parts.octave.values / MILLI]
        ordinate = PlotAxis("friction coefficient $\\mu$, octave upon octave [-]", low=0.0)
        panels["stacked"] = _stacked(data, axis, parts, names, ordinate, "Viridis")
    if "friction_by_decade" in data:
        parts = data.friction_by_decade / data[believed(data, "friction")]
        parts = parts.rename("friction_by_decade")
        names = [f"from {style.power_of_ten(round(math.log10(t)))} s" for t in parts.decade.values]
        ordinate = PlotAxis("share in $\\mu$, split as at small strain [-]", low=0.0, high=1.0)
        panels["decades"] = _stacked(data, axis, parts, names, ordinate, "Cividis")
    return panels


def study_pictures(result: xr.Dataset) -> Iterator[Picture]:
    """Yield totals and, over a single axis, what makes them; maps of speed and temperature."""
    yield Picture(
        "totals",
        totals_figure(result),
        "Contact area and friction over what was varied, dashed where they rest on the rubber "
        "beyond its measured band.",
        "Two panels of curves, one for each value of the second axis.",
    )
    if REDUCED_SPEED in result.coords and np.isfinite(result.total_friction.values).any():
        yield Picture(
            "friction_master_curve",
            friction_master_figure(result),
            "Friction and contact area over the reduced speed a_T v: one curve where temperature "
            "does nothing but shift the relaxation times of the rubber.",
            "Two panels of curves against a_T v, one for each temperature.",
        )
        if min(result.sizes["speed"], result.sizes["temperature"]) > 1:
            yield Picture(
                "map",
                map_figure(result),
                "Friction and contact area over speed and temperature.",
                "Two maps over speed and temperature with a dot for each prediction.",
            )
    axes = several(result)
    if not (result.prediction_status == "converged").any():
        return
    if len(axes) == 1 and "wavelength" in result:
        alone = result.isel({name: 0 for name in dimensions(result) if name not in axes})
        panels = [_wave_panel(alone, quantity) for quantity in AXIS_TITLES]
        yield Picture(
            "wavelength",
            Sheet(panels, legend="beside").on_paper(),
            "Contact area and friction of each wave and all longer ones.",
            "Two panels of curves against wavelength, which falls to the right.",
        )
    for name, panel in stacked_panels(result).items():
        figure = Sheet([panel], 1, NARROW, 3.6, gap=0.02, legend="beside").on_paper()
        parts = "octaves of wavelength" if name == "stacked" else "relaxation times"
        over = axes[0].replace("_", " ")
        yield Picture(name, figure, f"Friction by {parts}, stacked.", f"Bands against {over}.")
