"""Charts of a design: friction over rolling resistance, and the master curves it asks for."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.style import BLUE, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW
from gripscale.core.units import MEGA

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PERCENT = 100.0
SAME = 5e-3  # relative difference of rolling resistances that is none
_FREQUENCY = PlotAxis("frequency [Hz]", log=True, numbers=5)
# Difference of rolling resistances over today's from which both curves can be told apart.
_APART = 0.05
COMPOUND_COLOURS = (PURPLE, YELLOW, SKY, GREY)


def answering_point(data: xr.Dataset) -> int:
    """Return the last point whose rolling resistance is at most today's; without one the last."""
    allowed = np.flatnonzero(data.rolling_ratio.values <= 1.0 + 1e-6)
    return int(allowed[-1]) if allowed.size else data.sizes["point"] - 1


def design_figure(data: xr.Dataset) -> Figure:
    """Draw the trade-off curve of a design, and moduli, loss factor and change of some points.

    `data` is that of `gripscale.design`.
    """
    ratio, answer = data.rolling_ratio.values, answering_point(data)
    colours = {0: BLUE, data.sizes["point"] - 1: ORANGE, answer: GREEN}
    # The answer, and ends apart from it.
    drawn = {
        at: colours[at]
        for at in sorted(colours)
        if at == answer or abs(ratio[at] - ratio[answer]) > _APART
    }
    panels = [_trade_off_panel(data, drawn), *_master_curve_panels(data, drawn)]
    return Sheet(panels, 2, height=5.6, legend_columns=4).on_paper()


def _trade_off_panel(data: xr.Dataset, drawn: dict[int, str]) -> Panel:
    rolling = PERCENT * (data.rolling_ratio.values - 1.0)
    low, gain, high = (PERCENT * data[name].values for name in ("gain_low", "gain", "gain_high"))
    marks: list[Mark] = [
        CrossLine(0.0, width=0.7),
        CrossLine(0.0, width=0.7, upright=True),
        Series(rolling, gain, INK, marker="o", size=3.0, low=low, high=high),
        Series([0.0], [0.0], INK, "today", "", marker="s", size=6.0),
    ]
    for at, colour in drawn.items():
        label = f"rolling resistance {rolling[at]:+.0f} %"
        if abs(rolling[at]) < PERCENT * SAME:
            label = "same rolling resistance"
        marks.append(
            Series([rolling[at]], [gain[at]], colour, label, "", marker="o", size=6.0, order=3.0)
        )
    names = data.compound.values.tolist() if "compound" in data.dims else ()
    for at, (name, colour) in enumerate(zip(names, cycle(COMPOUND_COLOURS), strict=False)):
        x, y, low, high = (
            PERCENT * data[f"compound_{key}"].values[[at]]
            for key in ("rolling_ratio", "gain", "gain_low", "gain_high")
        )
        marks.append(
            Series(x - PERCENT, y, colour, name, "", marker="D", size=5.0, low=low, high=high)
        )
    return Panel(
        PlotAxis("change of rolling resistance [%]"),
        PlotAxis("friction gained [%]", margin=0.1),
        marks,
    )


def _master_curve_panels(data: xr.Dataset, drawn: dict[int, str]) -> list[Panel]:
    """Return moduli, loss factor, and moduli over today's; dotted lines enclose those excited."""
    ends = ((data.excited_low, "98 % of the friction between"), (data.excited_high, ""))
    excited: list[Mark] = [
        CrossLine(float(end), GREY, label, "dotted", upright=True) for end, label in ends
    ]
    frequency, (moduli, factor, change) = data.frequency.values, ([*excited] for _ in range(3))
    today = data.today_storage, data.today_loss
    for storage, loss, colour, width in (
        (*today, INK, 1.6),
        *((data.storage[at], data.loss[at], colour, 1.0) for at, colour in drawn.items()),
    ):
        for modulus, old, name, dash in (
            (storage, today[0], "$E'$", "dashdot"),
            (loss, today[1], "$E''$", "solid"),
        ):
            label = name if colour == INK else ""
            moduli.append(Series(frequency, modulus / MEGA, colour, label, dash, width=width))
            change.append(Series(frequency, modulus / old, colour, "", dash, width=width))
        factor.append(Series(frequency, loss / storage, colour, width=width))
    return [
        Panel(_FREQUENCY, PlotAxis("modulus [MPa]", log=True), moduli),
        Panel(_FREQUENCY, PlotAxis("loss factor tan δ [-]", low=0.0), factor),
        Panel(_FREQUENCY, PlotAxis("modulus over today's [-]"), change),
    ]
