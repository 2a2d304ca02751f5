"""Charts of the flow through a gap: fluid pressure, and the paths that carry the flow."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gripscale.charts import chart, draw
from gripscale.charts.chart import Mark
from gripscale.charts.style import ORANGE, WIDE
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.core.units import MEGA, MILLI
from gripscale.flow.gap_flow import GapFlow, conductances
from gripscale.half_space.result import RoughContact

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FAINTEST = 1e-3
"""Flow over its mean below which a path is left white."""


def flow_density(flow: GapFlow, axis: int) -> Array:
    """Return the flow through each point over the mean flow along an axis [-]."""
    pressure = np.nan_to_num(flow.pressure[axis])
    parts = []
    for along, faces in enumerate(conductances(flow.gap / flow.mean_gap, flow.spacing)):
        drop = pressure - np.roll(pressure, -1, along)
        if along == axis:  # the last cell flows into the first of the next period
            ends = [slice(None), slice(None)]
            ends[axis] = slice(-1, None)
            drop[tuple(ends)] += 1.0
        rate = np.where(np.isnan(flow.pressure[axis]), 0.0, faces * drop)
        parts.append(0.5 * (rate + np.roll(rate, 1, along)))
    density = np.hypot(*parts)
    return density / parts[axis].mean() if parts[axis].any() else density


def gap_flow_figure(flow: GapFlow) -> Figure:
    """Draw fluid pressure and flow along the axis with more flow."""
    axis = int(flow.flow_factor[1] > flow.flow_factor[0])
    density = flow_density(flow, axis)
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
    axes = [chart.PlotAxis(f"${name}$ [mm]", grid=False) for name in "xy"]
    panels = [
        chart.Panel(*axes, [chart.ValueMap(x, y, values.T, label), *marks], to_scale=True)
        for values, label in maps
    ]
    return draw.Sheet(panels, columns=2, width=WIDE, height=3.4).on_paper()


def trapped_water_figure(contact: RoughContact) -> Figure:
    """Draw the pressure of the contact and that of the water in its pools.

    Raises `InputError` for a contact without water.
    """
    if contact.water is None:
        raise InputError("contact must be solved with water; got a dry one: use water=True")
    water, x, y = contact.water.pressure / MEGA, contact.x / MILLI, contact.y / MILLI
    dry = np.where(contact.active, contact.pressure / MEGA, np.nan)
    maps = (
        (dry, "contact pressure [MPa]"),
        (np.where(water > 0.0, water, np.nan), "pressure of trapped water [MPa]"),
    )
    return _maps(x, y, maps, ())
