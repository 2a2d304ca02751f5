"""Friction and contact area over speed and temperature, as maps and as one curve over a_T v."""

from __future__ import annotations

from typing import Any

import matplotlib as mpl
import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator

from gripscale.figures.palette import GREY, INK, WIDE
from gripscale.figures.stretches import predictions_beyond
from gripscale.figures.study_axes import along
from gripscale.figures.style import (
    area_axis,
    dashed_entry,
    line,
    log_axis,
    sheet,
    short_number,
    styled,
)
from gripscale.study.display import axis_label, axis_shown
from gripscale.study.temperature import BEYOND_SHIFT, REDUCED_SPEED

PANELS = {
    "total_friction": "friction coefficient $\\mu$ [-]",
    "total_contact_fraction": "real contact area $A_r/A_0$ [-]",
}
LEVELS = 9
MOST_DECADES = 7
"""Numbers below the reduced speed, which may go over many powers of ten."""
TEMPERATURES = mpl.colors.ListedColormap(mpl.colormaps["plasma"](np.linspace(0.0, 0.88, 256)))


@styled
def map_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 over the speed, to the right, and the temperature.

    Dots are the predictions; open where some of the friction rests on the rubber beyond its
    measured band, crosses where the temperature lies beyond those the shift rests on. What did not
    converge is left white.
    """
    figure, panels = sheet(WIDE, 3.3, 1, 2, gap=0.06, sharey=True)
    for axes, (name, label) in zip(panels[0], PANELS.items(), strict=True):
        values = result[name].transpose("temperature", "speed").values
        x = along(axes, result, "speed")
        y = axis_shown(result, "temperature").of(result.temperature)
        levels = MaxNLocator(LEVELS).tick_values(np.nanmin(values), np.nanmax(values))
        filled = axes.contourf(x, y, values, levels=levels, cmap="viridis")
        axes.contour(x, y, values, levels=levels, colors="white", linewidths=0.4)
        bar = figure.colorbar(filled, ax=axes, label=label, pad=0.02)
        bar.outline.set_linewidth(0.0)
        bar.ax.yaxis.set_major_formatter(lambda value, _: short_number(value))
        _points(axes, result, x, y)
        axes.grid(visible=False)
    panels[0, 0].set_ylabel(axis_label(result, "temperature"))
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


@styled
def friction_master_figure(result: xr.Dataset) -> Figure:
    """Draw friction and A_r/A_0 of all temperatures over the reduced speed a_T v.

    Where temperature does nothing but shift the relaxation times, they are one curve. Dashed is
    what rests on the rubber beyond its measured band.
    """
    figure, panels = sheet(WIDE, 3.3, 1, 2, gap=0.06)
    speeds = axis_shown(result, "speed")
    celsius = axis_shown(result, "temperature").of(result.temperature)
    scale = ScalarMappable(Normalize(celsius.min(), celsius.max()), TEMPERATURES)
    for axes, (name, label) in zip(panels[0], PANELS.items(), strict=True):
        for i, colour in enumerate(scale.to_rgba(celsius)):
            one = result.isel(temperature=i)
            look: dict[str, Any] = {"color": colour, "marker": "o", "ms": 2.6, "lw": 1.0}
            line(axes, speeds.of(one[REDUCED_SPEED]), one[name], predictions_beyond(one), **look)
        log_axis(axes, "x")
        axes.xaxis.set_major_locator(LogLocator(numticks=MOST_DECADES))
        axes.set_xlabel(f"reduced speed $a_T v$ [{speeds.unit}]")
        axes.set_ylabel(label)
        dashed_entry(axes)
    friction, area = panels[0]
    friction.set_ylim(bottom=0.0)
    area_axis(area)
    bar = figure.colorbar(scale, ax=panels[0], label=axis_label(result, "temperature"), pad=0.02)
    bar.outline.set_linewidth(0.0)
    handles, labels = friction.get_legend_handles_labels()
    if handles:
        figure.legend(handles, labels, loc="outside upper center")
    return figure


def _points(axes: Axes, result: xr.Dataset, x: Any, y: Any) -> None:
    """Mark the predictions by what they rest on."""
    beyond = np.asarray(
        result.total_friction.copy(data=predictions_beyond(result)).transpose(
            "temperature", "speed"
        )
    ).astype(bool)
    shifted = result[BEYOND_SHIFT].transpose("temperature", "speed").values.astype(bool)
    solved = np.isfinite(result.total_friction.transpose("temperature", "speed").values)
    shape = np.shape(solved)
    kinds = (
        (~beyond & ~shifted, "solved", {"marker": ".", "color": INK, "ms": 2.5}),
        (
            beyond & ~shifted,
            "beyond the measured band",
            {"marker": "o", "mfc": "none", "mec": INK, "ms": 3.0, "mew": 0.5},
        ),
        (
            shifted,
            "beyond the temperatures of the shift",
            {"marker": "x", "color": GREY, "ms": 3.0, "mew": 0.7},
        ),
    )
    speeds, temperatures = np.broadcast_to(x, shape), np.broadcast_to(np.reshape(y, (-1, 1)), shape)
    for kind, label, look in kinds:
        which = kind & solved
        if which.any():
            places = speeds[which], temperatures[which]
            axes.plot(*places, ls="", clip_on=False, label=label, **look)  # type: ignore[arg-type]
