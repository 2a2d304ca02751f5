"""Charts of a study: the answer over what was varied, and what makes it (LW, figures 5 to 9)."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import style
from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BEYOND_LABEL, COLOURS, GREY, NARROW
from gripscale.core.units import MILLI, SQUARE_MM
from gripscale.io.table import significant
from gripscale.model import STATUS
from gripscale.questions import view
from gripscale.questions.answer.variables import believed
from gripscale.questions.vary.study import REDUCED_SPEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def totals_figure(data: xr.Dataset) -> Figure:
    """Draw A_r/A_0 and friction over the first numeric axis, a line for each value of the other.

    They are the answers with their 90 % intervals where there are any, else the totals; without a
    numeric axis points over the names of the first one.
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


def friction_master_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 of all temperatures over the reduced speed a_T v."""
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
    """Yield totals, all temperatures over a_T v and, over a single axis, what makes them."""
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
    several = [dim for dim in view.dimensions(result) if result.sizes[dim] > 1]
    if not (result[STATUS] == "converged").any():
        return
    if len(several) == 1 and "wavelength" in result:
        alone = result.isel({dim: 0 for dim in view.dimensions(result) if dim not in several})
        flags = alone["wavelength"].copy(data=style.waves_beyond(alone)).transpose(..., "scale")
        flags = flags.copy(data=np.logical_or.accumulate(flags.values, axis=-1))
        panels = [
            view.panel(alone, f"running_{name}", "scale", over="wavelength", flags=flags)
            for name in ("contact_fraction", "friction")
        ]
        yield Picture(
            "wavelength",
            Sheet(panels, legend="beside").on_paper(),
            "Contact area and friction of each wave and all longer ones.",
            "Two panels of curves against wavelength, which falls to the right.",
        )
    for name, panel in stacked_panels(result).items():
        figure = Sheet([panel], 1, NARROW, 3.6, gap=0.02, legend="beside").on_paper()
        parts = "octaves of wavelength" if name == "stacked" else "relaxation times"
        over = several[0].replace("_", " ")
        yield Picture(name, figure, f"Friction by {parts}, stacked.", f"Bands against {over}.")


CUBIC_MM = 1e-9


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
    seen = np.flatnonzero(lost > 0.02 * lost.max(initial=0.0))
    running = parts.cumsum(stacks).assign_coords({stacks: parts[stacks]})
    running = running.assign_attrs({"long_name": f"friction of this and {words}", "symbol": "μ"})
    if seen.size:
        running = running.isel({stacks: slice(max(seen[0] - 1, 0), seen[-1] + 1)})
    curves = running.to_dataset(name="running")
    return view.panel(curves, "running", stacks, flags=xr.DataArray(False))


def roads_statistics_figure(data: xr.Dataset) -> Figure:
    """Draw C_z [mm^2] over lag and the spectrum of lines [mm^3] over wavenumber of each road."""
    panels = []
    for name, along, size, label in (
        ("correlation", "lag", SQUARE_MM, "height difference $C_z$ [mm$^2$]"),
        ("spectrum", "wavenumber", CUBIC_MM, "spectrum $C_1$ [mm$^3$]"),
    ):
        curves = data.assign({name: data[name] / size})
        if along == "wavenumber":
            per_mm = along, data[along].values * MILLI, data[along].attrs | {"units": "rad/mm"}
            curves = curves.assign_coords({along: per_mm})
        panel = view.panel(curves, name, along, flags=xr.DataArray(False))
        panels.append(replace(panel, y=PlotAxis(label, log=True)))
    return Sheet(panels, height=3.2).on_paper()
