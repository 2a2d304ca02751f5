"""Where a comparison's contact area is lost and its friction made: running numbers of each rung."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import MILLI, WIDE
from gripscale.figures.rungs import JUDGE, Look, looks, on_the_surface, worth_drawing
from gripscale.figures.stretches import FLAG, down_to
from gripscale.figures.style import (
    area_axis,
    dashed_entry,
    falling_wavelength,
    line,
    sheet,
    styled,
)


@styled
def comparison_wavelength_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of each rung down to each wavelength.

    Wavelengths that excite the rubber beyond its measured band are dashed.
    Friction of the direct contacts goes on below the smallest wave of the surface: the edges of the
    contact do that. Their area is that of the contact without the shorter waves.
    """
    comparison = on_the_surface(comparison)
    figure, panels = sheet(WIDE, 3.5, 1, 2, gap=0.06)
    area, friction = panels[0]
    keep = worth_drawing(comparison)
    data = comparison.isel(wavelength=keep)
    for at, (name, look) in enumerate(looks(data)):
        one = data.isel(rung=at)
        label = str(one.label.item())
        _line(area, one, "running_contact_fraction", look, label, strong=name == JUDGE)
        _line(friction, one, "running_friction", look, label, strong=name == JUDGE)
    for axes in (area, friction):
        if keep.any():
            falling_wavelength(axes, data.wavelength.values / MILLI)
    area_axis(area)
    area.set_ylabel("contact area $A_r/A_0$ of longer waves [-]")
    friction.set_ylabel("friction $\\mu$ of longer waves [-]")
    friction.set_ylim(bottom=0.0)
    dashed_entry(friction)
    handles, labels = friction.get_legend_handles_labels()
    place: Any = "outside upper center"
    figure.legend(handles, labels, loc=place, ncols=3)
    return figure


def _line(axes: Axes, one: xr.Dataset, name: str, look: Look, label: str, *, strong: bool) -> None:
    values = one[name].values
    known = np.isfinite(values)
    if not known.any():
        return
    beyond = down_to(one[FLAG] == 1) if FLAG in one else np.zeros(known.size, dtype=bool)
    line(
        axes,
        one.wavelength.values[known] / MILLI,
        values[known],
        beyond[known],
        label,
        marker=look.marker,
        ms=4.0 if strong else 3.0,
        color=look.colour,
        ls=look.dash,
        lw=2.0 if strong else 1.2,
        zorder=3 if strong else 2,
    )
