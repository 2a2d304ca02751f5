"""Panels of friction over speed: one for each temperature and pressure that was measured."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.measured import COLOUR, Series, measured
from gripscale.figures.palette import WIDE
from gripscale.figures.style import log_axis, sheet
from gripscale.shown import Shown, shown

MOST_COLUMNS = 3
MOST_PANELS = 9
"""Series that are drawn; more would not be read."""
LEAST_WIDTH = 4.5
"""Below which the legend has no room [inch]."""


def speeds_of(data: xr.Dataset) -> Shown:
    """Return how the speeds of a result with measured friction are shown."""
    return shown("speed", str(data.attrs.get("case", "")))


def panels_of(data: xr.Dataset, draw: Callable[[Axes, Series], None], head: float) -> Figure:
    """Return the panels, each with what `draw` draws and the measured friction over it.

    Parameters
    ----------
    data : xarray.Dataset
        With measured friction.
    draw : callable
        Draws what belongs to a series below its points, over speeds as `speeds_of` shows them.
    head : float
        Height of the legend [inch].
    """
    series = list(measured(data))[:MOST_PANELS]
    columns = min(len(series), MOST_COLUMNS)
    rows = -(-len(series) // columns)
    figure, panels = sheet(
        max(WIDE * columns / MOST_COLUMNS, LEAST_WIDTH), head + 2.2 * rows, rows, columns,
        gap=0.05, sharey=True, sharex=True,
    )  # fmt: skip
    how = speeds_of(data)
    for axes, one in zip(panels.flat, series, strict=False):
        draw(axes, one)
        _points(axes, one, how)
    for axes in list(panels.flat)[len(series) :]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel("friction coefficient $\\mu$ [-]")
    for column in range(columns):
        last = max(row for row in range(rows) if row * columns + column < len(series))
        panels[last, column].set_xlabel(f"sliding speed $v$ [{how.unit}]")
        panels[last, column].tick_params(labelbottom=True)
    panels[0, 0].set_ylim(bottom=0.0)
    place: Any = "outside upper center"
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc=place, ncols=3 if columns > 1 else 2)
    return figure


def _points(axes: Axes, one: Series, how: Shown) -> None:
    """Draw what was measured, over everything else."""
    axes.errorbar(
        how.of(one.speed), one.friction, yerr=np.nan_to_num(one.spread), fmt="o", ms=4.5,
        mfc="white", mec=COLOUR, ecolor=COLOUR, mew=1.2, capsize=2.2, zorder=5, label="measured",
    )  # fmt: skip
    log_axis(axes, "x")
    axes.set_title(one.label.removeprefix("measured").removeprefix(", "))
