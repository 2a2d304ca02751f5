"""Charts of a design: friction over rolling resistance, and the master curves it asks for."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Note, Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.charts.style import BLUE, FAINT, GREEN, GREY, INK, ORANGE, PURPLE, SKY, YELLOW
from gripscale.core.units import MEGA
from gripscale.questions.design.page import SAME, answering_point, changed_frequencies

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PERCENT = 100.0
_FREQUENCY = PlotAxis("frequency [Hz]", log=True, numbers=5)
# Difference of rolling resistances over today's from which both curves can be told apart.
_APART = 0.05
COMPOUND_COLOURS = (PURPLE, YELLOW, SKY, GREY)


def design_picture(data: xr.Dataset) -> Picture:
    """Return the figure of a design with its caption."""
    return Picture(
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
    ratio, (answer, _) = data.rolling_ratio.values, answering_point(data)
    colours = {0: BLUE, data.sizes["point"] - 1: ORANGE, answer: GREEN}
    # The answer, and ends apart from it.
    drawn = {
        at: colours[at]
        for at in sorted(colours)
        if at == answer or abs(ratio[at] - ratio[answer]) > _APART
    }
    panels = [_trade_off_panel(data, drawn), *_master_curve_panels(data, drawn, answer)]
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


def _master_curve_panels(data: xr.Dataset, drawn: dict[int, str], answer: int) -> list[Panel]:
    """Return moduli, loss factor, and moduli over today's.

    Shaded are the frequencies that change at today's rolling resistance; dotted lines enclose those
    excited.
    """
    shades: list[Mark] = [
        CrossLine(low, FAINT, "changed by more than 20 %" if not at else "", upright=True, to=high)
        for at, (low, high) in enumerate(changed_frequencies(data, data.isel(point=answer)))
    ]
    for end, label in ((data.excited_low, "98 % of the friction between"), (data.excited_high, "")):
        shades.append(CrossLine(float(end), GREY, label, "dotted", upright=True))
    frequency = data.frequency.values

    def curves(today: xr.DataArray, designed: xr.DataArray) -> list[Mark]:
        series = [Series(frequency, today.values, INK, width=1.6)]
        for at, colour in drawn.items():
            series.append(Series(frequency, designed.values[at], colour, width=1.0, order=3.0))
        return [*series]

    moduli, change = [*shades], [CrossLine(1.0), *shades]
    for name, symbol in (("storage", "$E'$"), ("loss", "$E''$")):
        today = data[f"today_{name}"] / MEGA
        moduli += curves(today, data[name] / MEGA)
        moduli.append(Note(frequency[0], float(today[0]), symbol, offset=(3, 6)))
    factor = [*shades, *curves(data.today_loss / data.today_storage, data.loss / data.storage)]
    for at, colour in drawn.items():
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
