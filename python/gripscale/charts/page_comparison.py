"""Models side by side: from rung to rung, down to each wavelength, over a varied input."""

from __future__ import annotations

import math
import textwrap
from typing import Any

import numpy as np
import xarray as xr
from bokeh.models import ColumnDataSource, FixedTicker

from gripscale.charts.ladder import (
    JUDGE,
    Look,
    Row,
    looks,
    on_the_surface,
    rows_of,
    varied,
    worth_drawing,
)
from gripscale.charts.page import (
    dashed_entry,
    hover,
    legend,
    line,
    plot,
    positive,
    tick_closely,
    whole_decades,
)
from gripscale.charts.page_elements import Chart
from gripscale.charts.page_run import draw_measured
from gripscale.charts.style import BLUE, FLAG, ORANGE, down_to, predictions_beyond
from gripscale.core.units import MILLI
from gripscale.experiment.axis import axis_shown
from gripscale.model import with_adhesive

QUANTITIES = {"contact_fraction": "contact area A_r/A_0", "friction": "friction coefficient μ"}
ROW = 44
"""Height of a row of the ladder [px]."""
LABEL = 24
"""Letters of a line of a label beside the ladder: the frame keeps its width on a telephone."""


def ladder_charts(comparison: xr.Dataset) -> list[Chart]:
    """Return the steps from rung to rung, and the rungs down to each wavelength."""
    comparison = on_the_surface(comparison)
    charts = [_ladder(comparison, name) for name in QUANTITIES]
    if np.isfinite(comparison.running_friction.values).any():
        charts += [_by_wavelength(comparison, name) for name in QUANTITIES]
    return charts


def axis_charts(comparison: xr.Dataset) -> list[Chart]:
    """Return area and friction of every rung over the axis of a comparison."""
    own = on_the_surface(comparison)
    return [_over(own, varied(own), name) for name in QUANTITIES]


def _ladder(comparison: xr.Dataset, name: str) -> Chart:
    rows = list(rows_of(comparison, name))
    figure = plot(f"{QUANTITIES[name]} [-]", "", log="x", height=90 + ROW * len(rows))
    for at, row in enumerate(rows):
        if math.isfinite(row.before):
            shade = ORANGE if row.value > row.before else BLUE
            left, right = sorted((row.before, row.value))
            figure.hbar(y=at, left=left, right=right, height=0.5, fill_alpha=0.35, color=shade,
                        line_color=None)  # fmt: skip
        if row.value > 0.0:
            _mark(figure, at, row)
    tick_closely(figure)
    figure.yaxis.ticker = figure.ygrid.ticker = FixedTicker(ticks=list(range(len(rows))))
    figure.yaxis.major_label_overrides = {at: _label(row) for at, row in enumerate(rows)}
    figure.y_range.update(start=len(rows) - 0.4, end=-0.6)
    return Chart(
        f"ladder-{name}",
        f"{_title(name)} from rung to rung: a bar runs from the rung before, blue "
        "where the number falls, orange where it rises; lines are one standard uncertainty, a "
        "star is for friction partly beyond the measured band.",
        f"{QUANTITIES[name]} of each model, with the step from the one before.",
        figure,
    )


def _label(row: Row) -> str:
    text = row.label if math.isfinite(row.value) else f"{row.label} ({row.note})"
    return textwrap.fill(text, LABEL)


def _mark(figure: Any, at: int, row: Row) -> None:
    if math.isfinite(row.uncertainty):
        low, high = row.ends
        figure.segment(x0=[low], x1=[high], y0=[at], y1=[at], color=row.colour, line_width=1.6)
    factor = f"×{row.factor:.3g}" if math.isfinite(row.factor) else "–"
    source = ColumnDataSource({"x": [row.value], "y": [at], "factor": [factor]})
    dots = figure.scatter("x", "y", source=source, size=10, line_color=row.colour,
                          fill_color=row.colour if row.filled else "white")  # fmt: skip
    hover(figure, [dots], [(row.label, "@x"), ("factor", "@factor")])


def _by_wavelength(comparison: xr.Dataset, name: str) -> Chart:
    data = comparison.isel(wavelength=worth_drawing(comparison))
    length = data.wavelength.values / MILLI
    log = "y" if name == "contact_fraction" else ""
    label = f"{QUANTITIES[name]} of longer waves [-]"
    figure = plot("wavelength λ [mm]", label, log=log, wavelengths=length, height=400)
    values = data[f"running_{name}"].values
    beyond = down_to(data[FLAG] == 1) if FLAG in data else np.zeros(length.size, dtype=bool)
    if log:
        whole_decades(figure, values)
    else:
        figure.y_range.update(start=0.0)
    for at, (rung, look) in enumerate(looks(data)):
        known = np.isfinite(values[at])
        if known.any():
            text = str(data.label.values[at])
            _line(figure, length[known], values[at][known], look, text, beyond[known],
                  strong=rung == JUDGE)  # fmt: skip
    dashed_entry(figure, beyond)
    return Chart(
        f"by-wavelength-{name}",
        f"{_title(name)} down to each wavelength, of every model: where area is lost and friction "
        "made. Dashed is beyond the measured band.",
        f"Running {QUANTITIES[name]} of each model against wavelength, which falls to the right.",
        legend(figure),
    )


def _over(comparison: xr.Dataset, axis: str, name: str) -> Chart:
    shown = axis_shown(comparison, axis)
    x = shown.of(comparison[axis].values)
    spread_out = bool(x.min() > 0.0 and x.max() > 8.0 * x.min())
    log = ("x" if spread_out else "") + ("y" if name == "contact_fraction" else "")
    words = axis.replace("_", " ")
    figure = plot(f"{words} [{shown.unit}]", f"{QUANTITIES[name]} [-]", log=log, height=400)
    if name == "contact_fraction":
        whole_decades(figure, comparison[f"total_{name}"].values)
    else:
        figure.y_range.update(start=0.0)
    for at, (rung, look) in enumerate(looks(comparison)):
        one = comparison.isel(rung=at)
        values, spread = one[f"total_{name}"].values, one[f"{name}_spread"].values
        if not np.isfinite(values).any():
            continue
        text = str(one.label.item())
        _line(figure, x, values, look, text, predictions_beyond(one), strong=rung == JUDGE)
        if np.isfinite(spread).any():
            low, high = positive(values - spread), values + spread
            figure.varea(x=x, y1=low, y2=high, fill_color=look.colour, fill_alpha=0.15,
                         legend_label=text)  # fmt: skip
    dashed_entry(figure, predictions_beyond(comparison))
    if name == "friction":
        _with_area_term(figure, x, comparison)
    if axis == "speed" and name == "friction":
        draw_measured(figure, comparison, axis_shown(comparison, "speed"))
    return Chart(
        f"over-{axis}-{name}",
        f"{_title(name)} of every model over {words}; bands are the standard "
        "deviation over its samples, dashed is beyond the measured band.",
        f"{QUANTITIES[name]} of each model against {words}.",
        legend(figure),
    )


def _with_area_term(figure: Any, x: Any, comparison: xr.Dataset) -> None:
    both = with_adhesive(comparison)
    if both is None:
        return
    for at, (_, look) in enumerate(looks(comparison)):
        values = both.isel(rung=at).values
        if np.isfinite(values).any():
            figure.line(x, values, color=look.colour, line_dash="dotdash",
                        legend_label="with the area term")  # fmt: skip


def _title(name: str) -> str:
    return QUANTITIES[name][0].upper() + QUANTITIES[name][1:]


def _line(
    figure: Any, x: Any, y: Any, look: Look, label: str, beyond: Any, *, strong: bool
) -> None:
    own = {"color": look.colour, "line_width": 3.0 if strong else 1.6, "line_dash": look.dash}
    line(figure, x, y, beyond, legend_label=label, **own)
    dots = figure.scatter(x, y, size=8, marker=look.bokeh_marker, line_color=look.colour,
                          fill_color=look.colour, legend_label=label)  # fmt: skip
    hover(figure, [dots], [(label, "@y"), ("at", "@x")])
