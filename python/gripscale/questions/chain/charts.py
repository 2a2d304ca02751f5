"""Charts of waves and chains: area, friction and load by wavelength, evidence.

Contact area and friction against falling wavelength are figures 5 and 8 of LW.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import chart, style
from gripscale.charts.chart import (
    CrossLine,
    Mark,
    Panel,
    PlotAxis,
    Series,
    ShadedBand,
)
from gripscale.charts.draw import Sheet
from gripscale.charts.style import COLOURS, INK, RED
from gripscale.core.units import MILLI
from gripscale.questions.answer.variables import (
    ANSWER,
    AXIS_TITLES,
    HEADINGS,
    OF_THE_PAPER,
    answer_number,
)
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Views = Sequence[PredictionView]


def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw real contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols are the running values, open symbols and thin lines those of each wave; a model
    without waves is a level line at its total, with its answer as a band if it has one.
    Friction leaves out what is at rest, which has none;
    of a prediction without a single converged wave the legend says that there is nothing to draw.
    Lines are dashed beyond the measured band of the rubber.
    """
    return contact_sheet(predictions).on_paper()


def contact_sheet(predictions: Mapping[str, xr.Dataset]) -> Sheet:
    """Describe what `contact_figure` draws; arguments and errors are its own."""
    views = [PredictionView(data, name) for name, data in predictions.items()]
    judged = any(not view.waves for view in views)
    title = f"Points: {OF_THE_PAPER}, for comparison" if judged else ""
    return Sheet([_total_panel(views, name) for name in AXIS_TITLES], legend_title=title)


def _total_panel(views: Views, name: str) -> Panel:
    """Return the panel of the contact fraction or the friction, of and down to each wave."""
    if name == "contact_fraction":
        axis = PlotAxis(f"{AXIS_TITLES[name]} [-]", log=True, high=1.15)
    else:
        least = [float(np.nanmin(view.usable(name), initial=0.0)) for view in views if view.waves]
        axis = PlotAxis(f"{HEADINGS[name]} [-]", low=min(0.0, *least, 0.0))
    abscissa = _wavelengths(views)
    marks = [
        mark
        for view, colour in zip(views, COLOURS, strict=False)
        if view.moving or name != "friction"
        for mark in _total_marks(view, name, colour, abscissa)
    ]
    failed = (mark for view in views if view.waves for mark in _failed(view, name))
    caption = (
        f"{HEADINGS[name]} by wave: running total down to each wave (filled), and of each wave "
        "(open); dashed beyond the measured band."
    )
    return Panel(
        abscissa,
        axis,
        [*marks, *failed],
        name=f"{name.replace('_', '-')}-by-wave",
        caption=caption[0].upper() + caption[1:],
        alt="Points against wavelength, which falls to the right.",
    )


def _wavelengths(views: Views) -> PlotAxis:
    columns = [view.column("wavelength") / MILLI for view in views if view.waves]
    return chart.wavelength_axis(np.concatenate([*columns, []]))


def _total_marks(view: PredictionView, name: str, colour: str, along: PlotAxis) -> Iterator[Mark]:
    """Yield the running value and that of each wave, or the total of a model without waves.

    Above them the answer with its interval, if there is one.
    """
    if not view.waves:
        if np.isfinite(total := view.total(name)):
            yield CrossLine(total, colour, f"{view.name}, total", "dotted", 1.4)
    elif not view.converged.any():
        yield Series([], [], colour, f"{view.name}: {view.why(view.waves - 1)}", dash="")
    else:
        x, beyond = view.column("wavelength") / MILLI, style.waves_beyond(view.data)
        running, each, down_to = f"running_{name}", view.usable(name), style.down_to(beyond)
        yield Series(x, view.usable(running), colour, f"{view.name}, running total", marker="o",
                     beyond=down_to)  # fmt: skip
        yield Series(x, each, colour, f"{view.name}, each wave", marker="o", beyond=beyond,
                     width=0.8, filled=False)  # fmt: skip
    best, low, high = answer_number(view.data, name)
    if np.isfinite(best):
        measured = np.isfinite(low)
        yield CrossLine(best, INK, ANSWER if measured else "answer", width=1.2)
        if measured:
            ends = (
                (0.0, 1.0) if along.low is None or along.high is None else (along.low, along.high)
            )
            yield ShadedBand(ends, [low] * 2, [high] * 2, INK, ANSWER, alpha=0.12)


def _failed(view: PredictionView, quantity: str) -> Iterator[Series]:
    x, y = view.column("wavelength") / MILLI, view.column(quantity)
    bad = ~view.converged & np.isfinite(x) & np.isfinite(y)
    if bad.any():
        yield Series(x[bad], y[bad], RED, "not converged", "", 2.3, marker="x", size=8.0)
