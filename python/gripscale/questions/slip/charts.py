"""Chart of braking force over slip, with its band."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import xarray as xr

from gripscale.charts import style
from gripscale.charts.chart import Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Sheet
from gripscale.charts.style import WIDE
from gripscale.core.units import celsius


def slip_sheet(data: xr.Dataset) -> Sheet:
    """Describe the braking force over slip, a panel for each kind of friction."""
    highest = 1.08 * float(data.force.max())
    each = [*product(range(data.sizes["temperature"]), range(data.sizes["speed"]))]
    colours = style.colours(len(each), ordered=len(each) > 1)
    slip = np.concatenate([[0.0], 100.0 * data.slip.values])
    panels = []
    for kind in data.kind.values:
        bands: list[Mark] = []
        curves: list[Mark] = []
        for (i, j), colour in zip(each, colours, strict=True):
            curve = data.sel(kind=kind).isel(temperature=i, speed=j)
            low, value, high = (np.concatenate([[0.0], row]) for row in curve.force.values)
            kelvin = float(curve.temperature)
            words = [celsius(kelvin)] if math.isfinite(kelvin) else []
            if data.sizes["speed"] > 1 or not words:
                words.append(f"{3.6 * float(curve.speed):.3g} km/h")
            bands.append(ShadedBand(slip, low, high, colour))
            curves.append(Series(slip, value, colour, ", ".join(words)))
        x = PlotAxis("slip [%]", low=0.0, high=100.0)
        y = PlotAxis("braking force over load [-]", low=0.0, high=highest)
        panels.append(Panel(x, y, [*bands, *curves], title=str(kind)))
    return Sheet(panels, len(panels), WIDE, 3.6, legend_columns=4, layout={"sharey": True})
