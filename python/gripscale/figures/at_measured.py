"""Measured friction and what every model says at its points, one panel for each temperature."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.measured import COLOUR, Series, measured
from gripscale.figures.palette import WIDE
from gripscale.figures.rungs import look_of
from gripscale.figures.style import log_axis, sheet, styled

MOST_COLUMNS, MOST_PANELS = 3, 9


@styled
def at_measured_figure(data: xr.Dataset, labels: dict[str, str]) -> Figure:
    """Draw measured friction with its spread, and the total of every model at the same points.

    Parameters
    ----------
    data : xarray.Dataset
        Of `gripscale.comparison.at_measured`.
    labels : dict of str
        Of the models, in words.
    """
    series = list(measured(data))[:MOST_PANELS]
    columns = min(len(series), MOST_COLUMNS)
    rows = -(-len(series) // columns)
    width = max(WIDE * columns / MOST_COLUMNS, 4.5)
    figure, panels = sheet(
        width, 1.2 + 2.2 * rows, rows, columns, gap=0.05, sharey=True, sharex=True
    )
    for axes, one in zip(panels.flat, series, strict=False):
        _panel(axes, data, one, labels)
    for axes in list(panels.flat)[len(series) :]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel("friction coefficient $\\mu$ [-]")
    panels[0, 0].set_ylim(bottom=0.0)
    handles, texts = panels[0, 0].get_legend_handles_labels()
    place: Any = "outside upper center"
    figure.legend(handles, texts, loc=place, ncols=3 if columns > 1 else 2)
    return figure


def _panel(axes: Axes, data: xr.Dataset, one: Series, labels: dict[str, str]) -> None:
    order = np.argsort(one.speed)
    for name in (str(name) for name in data.model.values):
        values, look = data.friction.sel(model=name).values[one.chosen], look_of(name)
        if np.isfinite(values).any():
            axes.plot(
                one.speed[order], values[order], color=look.colour, ls=look.dash, lw=1.2,
                marker=look.marker, ms=3.5, label=labels.get(name, name),
            )  # fmt: skip
    axes.errorbar(
        one.speed, one.friction, yerr=np.nan_to_num(one.spread), fmt="o", ms=5.0, mfc="white",
        mec=COLOUR, ecolor=COLOUR, mew=1.3, capsize=2.5, zorder=5, label="measured",
    )  # fmt: skip
    log_axis(axes, "x")
    axes.set_xlabel("sliding speed $v$ [m/s]")
    axes.tick_params(labelbottom=True)
    axes.set_title(one.label.removeprefix("measured").removeprefix(", "))
