"""Contact area and friction against wavelength over a study (figures 5 to 9 of LW)."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from gripscale.figures.palette import MILLI, WIDE
from gripscale.figures.stretches import BEYOND_BESIDE, down_to, waves_beyond
from gripscale.figures.study_axes import colours, legend_beside
from gripscale.figures.style import (
    area_axis,
    dashed_entry,
    falling_wavelength,
    line,
    sheet,
    styled,
)
from gripscale.study.display import name_of

MOST_NAMES = 12


@styled
def wavelength_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw running contact area and running friction against wavelength over one axis.

    Dashed is what rests on the rubber beyond its measured band.
    """
    figure, panels = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = panels[0]
    ordered = np.issubdtype(result[axis].dtype, np.number)
    shades = colours(result.sizes[axis], ordered=ordered)
    every = -(-len(shades) // MOST_NAMES)
    for i, colour in enumerate(shades):
        one = result.isel({axis: i})
        x = one.wavelength / MILLI
        label = name_of(result, axis, i) if i % every == 0 else None
        beyond = down_to(waves_beyond(one))
        look: dict[str, Any] = {"marker": "o", "ms": 3.0, "color": colour}
        line(area, x, one.running_contact_fraction, beyond, label, **look)
        line(friction, x, one.running_friction, beyond, **look)
    area_axis(area, top=1.15)
    area.set_ylabel("relative contact area, running [-]")
    friction.set_ylabel("friction coefficient, running [-]")
    friction.set_ylim(bottom=0.0)
    wavelengths = result.wavelength.values[np.isfinite(result.wavelength.values)] / MILLI
    for panel in (area, friction):
        falling_wavelength(panel, wavelengths)
    dashed_entry(area, BEYOND_BESIDE)
    legend_beside(figure, *area.get_legend_handles_labels())
    if title:
        figure.suptitle(title, fontsize=9.0)
    return figure
