"""Measured friction and what every model says at its points, one panel for each temperature."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.by_temperature import panels_of, speeds_of
from gripscale.figures.measured import Series
from gripscale.figures.rungs import look_of
from gripscale.figures.style import styled


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
    return panels_of(data, lambda axes, one: _models(axes, data, one, labels), head=1.2)


def _models(axes: Axes, data: xr.Dataset, one: Series, labels: dict[str, str]) -> None:
    order = np.argsort(one.speed)
    speed = speeds_of(data).of(one.speed[order])
    for name in (str(name) for name in data.model.values):
        values, look = data.friction.sel(model=name).values[one.chosen], look_of(name)
        if np.isfinite(values).any():
            axes.plot(
                speed, values[order], color=look.colour, ls=look.dash, lw=1.2,
                marker=look.marker, ms=3.5, label=labels.get(name, name),
            )  # fmt: skip
