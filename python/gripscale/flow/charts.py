"""Charts of the flow through a gap: fluid pressure, and the paths that carry the flow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gripscale.charts import chart, draw
from gripscale.charts.chart import Mark
from gripscale.charts.style import ORANGE, WIDE
from gripscale.core.arrays import Array
from gripscale.core.units import MEGA, MILLI
from gripscale.flow.gap_flow import GapFlow
from gripscale.half_space.result import RoughContact

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FAINTEST = 1e-3  # flow over its mean below which a path is left white


def gap_flow_figure(flow: GapFlow) -> Figure:
    """Draw fluid pressure and flow along the axis with more flow."""
    axis = int(flow.flow_factor[1] > flow.flow_factor[0])
    density = flow.density[axis]
    paths = np.where(density > FAINTEST, np.log10(np.maximum(density, FAINTEST)), np.nan)
    x, y = (
        step * np.arange(n) / MILLI for step, n in zip(flow.spacing, flow.gap.shape, strict=True)
    )
    junction = flow.junction[axis]
    ring = [] if junction is None else [
        chart.Series(
            [junction.x / MILLI], [junction.y / MILLI], ORANGE, "critical junction", dash="",
            marker="o", size=9.0, filled=False, width=2.0,
        )
    ]  # fmt: skip
    names = (
        (flow.pressure[axis], f"fluid pressure, flow along {'xy'[axis]} [-]"),
        (paths, "log$_{10}$ of flow over its mean"),
    )
    return _maps(x, y, names, ring)


def _maps(x: Array, y: Array, maps: Sequence[tuple[Array, str]], marks: Sequence[Mark]) -> Figure:
    """Draw maps of values with their labels side by side, over x and y [mm]."""
    along, across = (chart.PlotAxis(f"${name}$ [mm]", grid=False) for name in "xy")
    panels = [
        chart.Panel(along, across, [chart.ValueMap(x, y, values.T, label), *marks], to_scale=True)
        for values, label in maps
    ]
    return draw.Sheet(panels, columns=2, width=WIDE, height=3.4).on_paper()


def trapped_water_figure(contact: RoughContact) -> Figure:
    """Draw the pressure of the contact and that of the water in its pools."""
    water = np.zeros(contact.grid.shape) if contact.water is None else contact.water.pressure
    maps = (
        (np.where(contact.active, contact.pressure / MEGA, np.nan), "contact pressure [MPa]"),
        (np.where(water > 0.0, water / MEGA, np.nan), "pressure of trapped water [MPa]"),
    )
    return _maps(contact.x / MILLI, contact.y / MILLI, maps, ())
