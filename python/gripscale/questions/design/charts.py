"""Charts of a design: friction over rolling resistance, and the master curves it asks for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Note, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.page_elements import Picture
from gripscale.charts.style import BLUE, FAINT, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW
from gripscale.core.units import MEGA
from gripscale.questions.design.design_text import at_todays_rolling, changed_frequencies

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PERCENT = 100.0
SAME = 5e-3  # relative difference of rolling resistances that is none
_FREQUENCY = PlotAxis("frequency [Hz]", log=True, numbers=5)
# Difference of rolling resistances over today's from which both curves can be told apart.
_APART = 0.05
COMPOUND_COLOURS = (PURPLE, YELLOW, SKY, GREY)


def design_pictures(data: xr.Dataset) -> Iterator[Picture]:
    """Yield the figure of a design."""
    yield Picture(
        "design",
        design_figure(data),
        "Friction gained against rolling resistance, and the master curves of some points beside "
        "today's.",
        "A curve of friction over rolling resistance with points of compounds, and three panels of "
        "curves over the frequency.",
    )


def design_figure(data: xr.Dataset) -> Figure:
    """Draw the trade-off curve of a design, and moduli, loss factor and change of some points.

    `data` is that of `gripscale.design`.
    """
    ratio = data.rolling_ratio.values
    last = data.sizes["point"] - 1
    same = at_todays_rolling(data)
    answer = last if same is None else int(np.abs(ratio - float(same.rolling_ratio)).argmin())
    colours = {0: BLUE, last: ORANGE, answer: GREEN}
    points = []  # the answer, and ends apart from it
    for at in sorted(colours):
        if at != answer and abs(ratio[at] - ratio[answer]) <= _APART:
            continue
        label = f"rolling resistance {PERCENT * (ratio[at] - 1.0):+.0f} %"
        if abs(ratio[at] - 1.0) < SAME:
            label = "same rolling resistance"
        points.append((at, colours[at], label))
    panels = [_trade_off_panel(data, points), *_master_curve_panels(data, points)]
    return Sheet(panels, 2, height=5.6, legend_columns=4).on_paper()


def _trade_off_panel(data: xr.Dataset, points: list[tuple[int, str, str]]) -> Panel:
    rolling = PERCENT * (data.rolling_ratio.values - 1.0)
    low, gain, high = (PERCENT * data[name].values for name in ("gain_low", "gain", "gain_high"))
    marks: list[Mark] = [
        CrossLine(0.0, width=0.7),
        CrossLine(0.0, width=0.7, upright=True),
        Series(rolling, gain, INK, marker="o", size=3.0, low=low, high=high),
        Series([0.0], [0.0], INK, "today", "", marker="s", size=6.0),
    ]
    for at, colour, label in points:
        marks.append(
            Series([rolling[at]], [gain[at]], colour, label, "", marker="o", size=6.0, order=3.0)
        )
    if "compound" in data.dims:
        for at, name in enumerate(data.compound.values.tolist()):
            compound = data.isel(compound=at)
            x, y, *ends = (
                np.array([PERCENT * float(compound[f"compound_{key}"])])
                for key in ("rolling_ratio", "gain", "gain_low", "gain_high")
            )
            colour = COMPOUND_COLOURS[at % len(COMPOUND_COLOURS)]
            marks.append(
                Series(x - PERCENT, y, colour, name, "", marker="D", size=5.0, low=ends[0],
                       high=ends[1])
            )  # fmt: skip
    return Panel(
        PlotAxis("change of rolling resistance [%]"),
        PlotAxis("friction gained [%]", margin=0.1),
        marks,
    )


def _master_curve_panels(data: xr.Dataset, points: list[tuple[int, str, str]]) -> list[Panel]:
    """Return moduli, loss factor, and moduli over today's.

    Shaded are the frequencies that change at today's rolling resistance; dotted lines enclose those
    excited.
    """
    chosen = at_todays_rolling(data)
    chosen = data.isel(point=-1) if chosen is None else chosen
    shades: list[Mark] = [
        CrossLine(low, FAINT, "changed by more than 20 %" if not at else "", upright=True, to=high)
        for at, (low, high) in enumerate(changed_frequencies(data, chosen))
    ]
    for at, end in enumerate((float(data.excited_low), float(data.excited_high))):
        label = "98 % of the friction between" if not at else ""
        shades.append(CrossLine(end, GREY, label, "dotted", upright=True))
    frequency = data.frequency.values
    moduli, change = [*shades], [CrossLine(1.0), *shades]
    for name, symbol in (("storage", "$E'$"), ("loss", "$E''$")):
        today = data[f"today_{name}"].values / MEGA
        moduli.append(Series(frequency, today, INK, width=1.6))
        for at, colour, _ in points:
            values = data[name].values[at] / MEGA
            moduli.append(Series(frequency, values, colour, width=1.0, order=3.0))
        moduli.append(Note(frequency[0], today[0], symbol, offset=(3, 6)))
    tangent = (data.today_loss / data.today_storage).values
    factor = [*shades, Series(frequency, tangent, INK, width=1.6)]
    for at, colour, _ in points:
        ratio = data.loss.values[at] / data.storage.values[at]
        factor.append(Series(frequency, ratio, colour, width=1.0, order=3.0))
        for name, dash in (("storage", "dashdot"), ("loss", "solid")):
            ratio = data[name].values[at] / data[f"today_{name}"].values
            change.append(Series(frequency, ratio, colour, "", dash, width=1.2))
    change += [
        Series([], [], INK, "$E''$ over today's", width=1.2),
        Series([], [], INK, "$E'$ over today's", "dashdot", width=1.2),
    ]
    return [
        Panel(_FREQUENCY, PlotAxis("modulus [MPa]", log=True), moduli),
        Panel(_FREQUENCY, PlotAxis("loss factor tan δ [-]", low=0.0), factor),
        Panel(_FREQUENCY, PlotAxis("modulus over today's [-]"), change),
    ]
