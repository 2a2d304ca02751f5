"""Contact area and friction against wavelength, per wave and running (figures 5 and 8 of LW)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import COLOURS, MILLI, WIDE
from gripscale.figures.style import area_axis, falling_wavelength, sheet, styled
from gripscale.figures.view import PredictionView

if TYPE_CHECKING:
    import xarray as xr


@styled
def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw relative contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols and full lines are the running values, open symbols and dashed lines those
    of each wave; a model without waves is a level line at its total. Friction leaves out what is
    at rest, which has none.
    """
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = axes[0]
    views = [PredictionView(data, name) for name, data in predictions.items()]
    for view, colour in zip(views, COLOURS, strict=False):
        _pair(area, view, "contact_fraction", colour)
        if view.moving:
            _pair(friction, view, "friction", colour)
    area.set_ylim(top=1.15)
    area_axis(area)
    area.set_ylabel("relative contact area [-]")
    friction.set_ylabel("friction coefficient [-]")
    friction.set_ylim(bottom=0.0)
    waves = [length for view in views if view.waves for length in view.column("wavelength") / MILLI]
    for panel in (area, friction):
        if waves:
            falling_wavelength(panel, waves)
        else:
            panel.set_xticks([])
    figure.legend(*area.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


def _pair(axes: Axes, view: PredictionView, quantity: str, colour: str) -> None:
    """Draw the running value and the value of each wave against wavelength [mm]."""
    if not view.waves:
        total = view.total(quantity)
        if np.isfinite(total):
            axes.axhline(total, color=colour, ls=(0, (1, 1.5)), label=f"{view.name}, total")
        return
    wavelength = view.column("wavelength") / MILLI
    running = view.usable(f"running_{quantity}")
    axes.plot(wavelength, running, color=colour, marker="o", label=f"{view.name}, running")
    axes.plot(
        wavelength,
        view.usable(quantity),
        color=colour,
        marker="o",
        mfc="white",
        ls=(0, (4, 2)),
        lw=1.0,
        label=f"{view.name}, each wave",
    )
