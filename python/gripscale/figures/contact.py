"""Contact area and friction against wavelength, per wave and running (figures 5 and 8 of LW)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import COLOURS, MILLI, WIDE
from gripscale.figures.stretches import down_to, waves_beyond
from gripscale.figures.style import (
    DOTTED,
    area_axis,
    dashed_entry,
    falling_wavelength,
    line,
    sheet,
    styled,
)
from gripscale.figures.view import PredictionView

if TYPE_CHECKING:
    import xarray as xr


@styled
def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw relative contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols are the running values, open symbols and thin lines those of each wave; a model
    without waves is a level line at its total. Friction leaves out what is at rest, which has none;
    of a prediction without a single converged wave the legend says that there is nothing to draw.
    Lines are dashed beyond the measured band of the rubber.
    """
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = axes[0]
    views = [PredictionView(data, name) for name, data in predictions.items()]
    for view, colour in zip(views, COLOURS, strict=False):
        _pair(area, view, "contact_fraction", colour)
        if view.moving:
            _pair(friction, view, "friction", colour)
    area_axis(area, top=1.15)
    area.set_ylabel("relative contact area [-]")
    friction.set_ylabel("friction coefficient [-]")
    friction.set_ylim(bottom=0.0)
    waves = [length for view in views if view.waves for length in view.column("wavelength") / MILLI]
    for panel in (area, friction):
        if waves:
            falling_wavelength(panel, waves)
        else:
            panel.set_xticks([])
    dashed_entry(area)
    figure.legend(*area.get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def _pair(axes: Axes, view: PredictionView, quantity: str, colour: str) -> None:
    """Draw the running value and the value of each wave against wavelength [mm]."""
    if not view.waves:
        total = view.total(quantity)
        if np.isfinite(total):
            axes.axhline(total, color=colour, ls=DOTTED, label=f"{view.name}, total")
        return
    if not view.converged.any():
        axes.plot([], [], ls="", label=f"{view.name}: {view.why(view.waves - 1)}")
        return
    wavelength = view.column("wavelength") / MILLI
    running = view.usable(f"running_{quantity}")
    beyond = waves_beyond(view.data)
    look: dict[str, Any] = {"color": colour, "marker": "o"}
    line(axes, wavelength, running, down_to(beyond), f"{view.name}, running", **look)
    look |= {"mfc": "white", "lw": 0.8}
    line(axes, wavelength, view.usable(quantity), beyond, f"{view.name}, each wave", **look)
