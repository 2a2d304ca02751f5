"""Measured friction over speed, and what was predicted at one speed among it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from gripscale.figures.measured import COLOUR, measured
from gripscale.figures.view import PredictionView
from gripscale.measured.differences import measured_variables
from gripscale.measured.friction import MeasuredFriction
from gripscale.model import with_adhesive
from gripscale.report.charts.look import COLOURS, hover, legend, plot
from gripscale.report.elements import Chart
from gripscale.shown import Shown, shown

MARKS = ("circle", "square", "triangle", "diamond", "inverted_triangle", "hex")
"""Of measurements at several temperatures or pressures."""


def measured_chart(found: MeasuredFriction, predictions: Sequence[PredictionView]) -> Chart:
    """Return measured friction with the totals of `predictions`, each at its speed."""
    how = predictions[0].shown("speed") if predictions else shown("speed")
    figure = plot(f"speed [{how.unit}]", "friction coefficient [-]", log="x", height=400)
    figure.y_range.update(start=0.0)
    draw_measured(figure, xr.Dataset(measured_variables(found)), how)
    for one, colour in zip(predictions, COLOURS, strict=False):
        _point(figure, one, float(one.data.total_friction), f"{one.name}, hysteresis", colour)
        both = with_adhesive(one.data)
        if both is not None:
            label = f"{one.name}, with the area term"
            _point(figure, one, float(both), label, colour, fill_color="white")
    return Chart(
        "measured-friction",
        "Measured friction over speed, with what is predicted at the speed of the case. Bars are "
        "the standard deviation of the measurement.",
        "Measured friction against speed, and predicted friction at one speed.",
        legend(figure),
    )


def draw_measured(figure: Any, data: xr.Dataset, how: Shown) -> None:
    """Draw what was measured at each temperature and pressure over speed, shown as `how`."""
    for number, series in enumerate(measured(data)):
        speed = how.of(series.speed)
        spread = np.nan_to_num(series.spread)
        low, high = series.friction - spread, series.friction + spread
        figure.segment(x0=speed, x1=speed, y0=low, y1=high, color=COLOUR,
                       line_width=1.6)  # fmt: skip
        dots = figure.scatter(speed, series.friction, size=9, line_color=COLOUR,
                              marker=MARKS[number % len(MARKS)], fill_color="white",
                              line_width=2, legend_label=series.label)  # fmt: skip
        hover(figure, [dots], [(series.label, "@y"), ("speed", f"@x {how.unit}")])


def _point(
    figure: Any, one: PredictionView, friction: float, label: str, colour: str, **look: Any
) -> None:
    if np.isfinite(friction):
        options = {"marker": "star", "size": 17, "color": colour, "line_width": 2} | look
        how = one.shown("speed")
        dots = figure.scatter(how.of([one.speed]), [friction], legend_label=label, **options)
        hover(figure, [dots], [(label, "@y"), ("speed", f"@x {how.unit}")])
