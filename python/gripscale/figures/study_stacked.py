"""Which wave makes the grip: contributions of the waves to friction and area, stacked."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from gripscale.figures.palette import GREY, INK, WIDE
from gripscale.figures.stretches import (
    BEYOND_BESIDE,
    Flags,
    predictions_beyond,
    stretches,
    waves_beyond,
)
from gripscale.figures.study_axes import (
    Array,
    along,
    colours,
    legend_beside,
    wavelength_names,
)
from gripscale.figures.style import area_axis, line, sheet, styled

HEIGHT = 3.4
HATCHED: Any = {"facecolor": "none", "edgecolor": "white", "hatch": "////", "lw": 0.0}
"""Look of waves beyond the measured band."""


@styled
def stacked_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw friction as the sum, and contact area as the product, of its waves over one axis.

    Each band of friction is the friction coefficient of a wave; each band of area is the part of
    the contact a wave takes away, the lowest line what is left after all of them. Waves beyond the
    measured band of the rubber are hatched.
    """
    figure, panels = sheet(WIDE, HEIGHT, 1, 2, gap=0.06)
    friction, area = panels[0]
    shades, names = _shades(result)
    values = result.friction.transpose("scale", axis).values
    x, beyond = along(friction, result, axis), _beyond(result, axis)
    _stack(friction, x, values, shades, beyond)
    line(friction, x, result.total_friction, predictions_beyond(result), color=INK, lw=1.2)
    friction.set_ylabel("friction coefficient $\\mu$, wave upon wave [-]")
    running = result.running_contact_fraction.transpose("scale", axis).values
    _nested(area, along(area, result, axis), running, shades, beyond)
    area.set_ylabel("relative contact area after each wave [-]")
    _legend(figure, shades, names, title, hatched=bool(beyond.any()))
    return figure


@styled
def shares_figure(result: xr.Dataset, axis: str, title: str = "") -> Figure:
    """Draw the share of each wave in the friction over one axis, and its friction alone.

    Waves beyond the measured band of the rubber are hatched, and dashed.
    """
    figure, panels = sheet(WIDE, HEIGHT, 1, 2, gap=0.06)
    share, alone = panels[0]
    shades, names = _shades(result)
    values = result.friction.transpose("scale", axis).values
    total = result.total_friction.values
    beyond = _beyond(result, axis)
    _stack(share, along(share, result, axis), values / total, shades, beyond)
    share.set_ylim(0.0, 1.0)
    share.set_ylabel("share of each wave in $\\mu$ [-]")
    x = along(alone, result, axis)
    for row, colour, flags in zip(values, shades, beyond, strict=True):
        line(alone, x, row, flags, color=colour)
    alone.set_ylim(bottom=0.0)
    alone.set_ylabel("friction coefficient of each wave $\\mu_i$ [-]")
    _legend(figure, shades, names, title, hatched=bool(beyond.any()))
    return figure


def _shades(result: xr.Dataset) -> tuple[list[str], list[str]]:
    return list(colours(result.sizes["scale"], ordered=True)), wavelength_names(result)


def _beyond(result: xr.Dataset, axis: str) -> Flags:
    """Return for each wave and point whether it excites the rubber beyond the measured band."""
    return waves_beyond(result.transpose("scale", axis, ...))


def _stack(axes: Axes, x: Array, rows: Array, shades: list[str], beyond: Flags) -> None:
    """Fill the band of each row upon the rows before it, hatched beyond; NaN leaves a gap."""
    upper = np.cumsum(np.where(np.isnan(rows), 0.0, rows), axis=0)
    upper[:, np.isnan(rows).all(axis=0)] = np.nan
    lower = np.vstack([np.zeros_like(x), upper[:-1]])
    for low, high, colour in zip(lower, upper, shades, strict=True):
        axes.fill_between(x, low, high, color=colour, lw=0.3, ec="white")
    for low, high, flags in zip(lower, upper, beyond, strict=True):
        _hatch(axes, x, low, high, flags)
    axes.set_ylim(bottom=0.0)


def _hatch(axes: Axes, x: Array, low: Array, high: Array, beyond: Flags) -> None:
    """Hatch a band where it is beyond the measured frequencies."""
    for part, hatched in stretches(beyond):
        if hatched:
            axes.fill_between(x[part], low[part], high[part], **HATCHED)


def _nested(axes: Axes, x: Array, running: Array, shades: list[str], beyond: Flags) -> None:
    """Fill between the running areas, largest wave first, on a log axis; hatched beyond."""
    upper = np.ones_like(x)
    for row, colour, flags in zip(running, shades, beyond, strict=True):
        axes.fill_between(x, row, upper, color=colour, lw=0.3, ec="white")
        _hatch(axes, x, row, upper, flags)
        upper = np.where(np.isnan(row), upper, row)
    line(axes, x, upper, np.any(beyond, axis=0), color=INK, lw=1.2)
    axes.set_ylim(0.7 * float(np.nanmin(running)), 1.0)
    area_axis(axes)


def _legend(
    figure: Figure, shades: list[str], names: list[str], title: str, *, hatched: bool
) -> None:
    """Name the waves beside the panels, last on top as they are stacked."""
    patches = [Patch(color=colour) for colour in shades]
    if hatched:
        entry = Patch(**(HATCHED | {"facecolor": GREY}))
        patches, names = [entry, *patches], [BEYOND_BESIDE, *names]
    legend_beside(figure, patches[::-1], names[::-1], "wavelength")
    if title:
        figure.suptitle(title, fontsize=9.0)
