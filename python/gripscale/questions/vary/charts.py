"""Charts of a study: the answer over what was varied, what makes it, speed and temperature.

Contact area and friction against wavelength over a study are figures 5 to 9 of LW.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import chart, style
from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BEYOND_LABEL, GREY, INK, NARROW
from gripscale.core.units import MILLI
from gripscale.io.table import significant
from gripscale.model import STATUS
from gripscale.questions import view
from gripscale.questions.vary.speed_and_temperature import BEYOND_SHIFT, REDUCED_SPEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def totals_figure(data: xr.Dataset) -> Figure:
    """Draw A_r/A_0 and friction over the first numeric axis, a line for each value of the other.

    They are the answers with their 90 % intervals where there are any, else the totals.
    Without a numeric axis they are drawn as points over the names of the first one. Predictions
    that did not converge leave gaps. What rests on the rubber beyond its measured band is dashed,
    of names has a star.
    """
    along = (view.numeric(data) or view.dimensions(data))[0]
    friction, area = (view.panel(data, name, along) for name in view.answers(data))
    keys = []
    if any(name.endswith(view.STAR) for name in (area.x.ticks or {}).values()):
        keys.append(Series([], [], GREY, BEYOND_LABEL, dash="", marker="$*$"))
    curves = [mark for mark in friction.marks if isinstance(mark, Series)]
    named = len(friction.marks) > 1 or bool(keys) or any(np.any(c.beyond) for c in curves)
    legend = "above" if named else ""
    return Sheet([area, friction], legend=legend, legend_columns=4, keys=keys).on_paper()


def _wave_panels(data: xr.Dataset) -> list[Panel]:
    """Return contact area and friction down to each wave, a curve for each prediction."""
    flags = data["wavelength"].copy(data=style.waves_beyond(data)).transpose(..., "scale")
    flags = flags.copy(data=np.logical_or.accumulate(flags.values, axis=-1))
    names = ("running_contact_fraction", "running_friction")
    return [view.panel(data, name, "scale", over="wavelength", flags=flags) for name in names]


def map_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 over the speed, to the right, and the temperature.

    Dots are the predictions; open where some of the friction rests on the rubber beyond its
    measured band, crosses where the temperature lies beyond those the shift rests on. What did not
    converge is left white.
    """
    result = result.sortby(["temperature", "speed"]).transpose("temperature", "speed", ...)
    (abscissa, speeds), (ordinate, celsius) = (
        view.plot_axis(result[name]) for name in ("speed", "temperature")
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
    frame = replace(abscissa, grid=False), replace(ordinate, grid=False)
    panels = []
    for name in view.answers(result):
        label = f"{view.title(result[name])} [-]"
        values = chart.ValueMap(speeds, celsius, result[name].values, label, levels=9)
        panels.append(Panel(*frame, [values, *points]))
    return Sheet(panels, height=3.3, layout={"sharey": True}).on_paper()


def friction_master_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 of all temperatures over the reduced speed a_T v.

    Where temperature does nothing but shift the relaxation times, they are one curve. Dashed is
    what rests on the rubber beyond its measured band.
    """
    names = view.answers(result)
    panels = [view.panel(result, name, "speed", over=REDUCED_SPEED) for name in names]
    return Sheet(panels, height=3.3, legend_columns=6).on_paper()


def stacked_panels(data: xr.Dataset) -> dict[str, Panel]:
    """Return what makes the friction over a single axis of numbers, by the name of its figure."""
    several = [dim for dim in view.dimensions(data) if data.sizes[dim] > 1]
    if several != view.numeric(data) or len(several) != 1:
        return {}
    (along,) = several
    data = data.isel({dim: 0 for dim in view.dimensions(data) if dim != along})
    panels = {}
    if "octave_friction" in data:
        data = data.sortby("octave", ascending=False)
        names = [f"from {significant(end, 2)} mm" for end in data.octave.values / MILLI]
        y = PlotAxis("friction coefficient $\\mu$, octave upon octave [-]", low=0.0)
        panels["stacked"] = view.stacked_panel(data, "octave_friction", along, names, y)
    if "friction_by_decade" in data:
        parts = data["friction_by_decade"]
        shares = data.assign(shares=(parts / parts.sum("decade")).assign_attrs(parts.attrs))
        names = [f"from {style.power_of_ten(round(math.log10(t)))} s" for t in data.decade.values]
        y = PlotAxis("share in $\\mu$, split as at small strain [-]", low=0.0, high=1.0)
        panels["decades"] = view.stacked_panel(shares, "shares", along, names, y)
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
    several = [dim for dim in view.dimensions(result) if result.sizes[dim] > 1]
    if not (result[STATUS] == "converged").any():
        return
    if len(several) == 1 and "wavelength" in result:
        alone = result.isel({dim: 0 for dim in view.dimensions(result) if dim not in several})
        yield Picture(
            "wavelength",
            Sheet(_wave_panels(alone), legend="beside").on_paper(),
            "Contact area and friction of each wave and all longer ones.",
            "Two panels of curves against wavelength, which falls to the right.",
        )
    for name, panel in stacked_panels(result).items():
        figure = Sheet([panel], 1, NARROW, 3.6, gap=0.02, legend="beside").on_paper()
        parts = "octaves of wavelength" if name == "stacked" else "relaxation times"
        over = several[0].replace("_", " ")
        yield Picture(name, figure, f"Friction by {parts}, stacked.", f"Bands against {over}.")
