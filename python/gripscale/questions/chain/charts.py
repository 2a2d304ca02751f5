"""Charts of waves and chains: area and friction by wavelength, the deformed blocks.

Contact area and friction against falling wavelength are figures 5 and 8 of LW.
"""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import chart, style
from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series, ShadedBand
from gripscale.charts.draw import Sheet
from gripscale.charts.style import BLUE, COLOURS, DASHES, FAINT, GREY, INK, ORANGE, RED, WIDE
from gripscale.core import Array, checks
from gripscale.core.units import MILLI
from gripscale.questions.answer import variables
from gripscale.questions.answer.variables import ANSWER, AXIS_TITLES, HEADINGS
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

Views = Sequence[PredictionView]


def contact_figure(predictions: Mapping[str, xr.Dataset]) -> Figure:
    """Draw real contact area and friction of each named prediction, such as dynamic and static.

    Filled symbols are the running values, open symbols and thin lines those of each wave; a model
    without waves is a level line at its total, with its answer as a band if it has one. Dashed is
    beyond the measured band of the rubber. Nothing at rest has friction.
    """
    return contact_sheet(predictions).on_paper()


def contact_sheet(predictions: Mapping[str, xr.Dataset]) -> Sheet:
    """Describe what `contact_figure` draws; arguments and errors are its own."""
    views = [PredictionView(data, name) for name, data in predictions.items()]
    judged = any(not view.waves for view in views)
    title = f"Points: {variables.OF_THE_PAPER}, for comparison" if judged else ""
    return Sheet([_total_panel(views, name) for name in AXIS_TITLES], legend_title=title)


def _total_panel(views: Views, name: str) -> Panel:
    """Return the panel of the contact fraction or the friction, of and down to each wave."""
    if name == "contact_fraction":
        axis = PlotAxis(f"{AXIS_TITLES[name]} [-]", log=True, high=1.15)
    else:
        least = [float(np.nanmin(view.usable(name), initial=0.0)) for view in views if view.waves]
        axis = PlotAxis(f"{HEADINGS[name]} [-]", low=min(0.0, *least, 0.0))
    columns = [view.column("wavelength") / MILLI for view in views if view.waves]
    abscissa = chart.wavelength_axis(np.concatenate([*columns, []]))
    marks = [
        mark
        for view, colour in zip(views, COLOURS, strict=False)
        if view.moving or name != "friction"
        for mark in _total_marks(view, name, colour, abscissa)
    ]
    failed = (mark for view in views if view.waves for mark in _failed(view, name))
    caption = (
        f"{HEADINGS[name].capitalize()} by wave: running total down to each wave (filled), and of "
        "each wave (open); dashed beyond the measured band."
    )
    return Panel(
        abscissa,
        axis,
        [*marks, *failed],
        name=f"{name.replace('_', '-')}-by-wave",
        caption=caption,
        alt="Points against wavelength, which falls to the right.",
    )


def _total_marks(view: PredictionView, name: str, colour: str, along: PlotAxis) -> Iterator[Mark]:
    """Yield the values of each wave and down to it, or a total without waves; then the answer."""
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
    best, low, high = variables.answer_number(view.data, name)
    if np.isfinite(best):
        measured = np.isfinite(low)
        yield CrossLine(best, INK, ANSWER if measured else "answer", width=1.2)
        if measured:
            ends = (0.0, 1.0) if along.low is None else (along.low, along.high or 1.0)
            yield ShadedBand(ends, [low] * 2, [high] * 2, INK, ANSWER, alpha=0.12)


def _failed(view: PredictionView, quantity: str) -> Iterator[Series]:
    x, y = view.column("wavelength") / MILLI, view.column(quantity)
    bad = ~view.converged & np.isfinite(x) & np.isfinite(y)
    if bad.any():
        yield Series(x[bad], y[bad], RED, "not converged", "", 2.3, marker="x", size=8.0)


# The deformed rubber block of each wave on its rigid sine, with the contact pressure above it.

MESH_DEPTH = 0.55  # height of the block that is shown [wavelengths]
PRESSURE = 0.42  # height of a panel of pressure over its width
# Beside the panels: for the labels of the first, at the end, for numbers between two [inch].
LEFT, RIGHT, BETWEEN = 0.6, 0.22, 0.42
# Of a row of panels: its titles, between pressure and block, numbers below [inch].
HEAD, MIDDLE, FOOT = 0.75, 0.2, 0.4


def block_figure(prediction: xr.Dataset, wave: int = 1) -> Figure:
    """Draw one wave, by its number from 1: pressure above the deformed mesh and the rigid sine.

    `prediction` is over `scale`, as `gripscale.wave.result.waves_to_dataset` has it. Raises
    `InputError` if there is no such wave.
    """
    view = PredictionView(prediction)
    number = checks.whole("wave", wave, least=1, most=max(view.waves, 1))
    return _figure(view, [number - 1], 1, 4.2)


def blocks_figure(prediction: xr.Dataset) -> Figure:
    """Draw every wave of a prediction, largest first, four side by side."""
    view = PredictionView(prediction)
    return _figure(view, range(view.waves), 4, WIDE)


def _figure(view: PredictionView, waves: Sequence[int], columns: int, full: float) -> Figure:
    """Draw waves row by row, each as large as in a figure `full` inches wide of all `columns`."""
    from matplotlib.figure import Figure

    from gripscale.charts.paper import figure_rules

    inside = (full - LEFT - RIGHT - (columns - 1) * BETWEEN) / columns
    columns = min(columns, max(len(waves), 1))
    width = LEFT + RIGHT + columns * inside + (columns - 1) * BETWEEN
    slopes = [view.column("amplitude")[i] / view.column("wavelength")[i] for i in waves]
    steepest = max(slopes, default=0.1)
    low, high = -steepest - 0.06, steepest + MESH_DEPTH
    row_height = HEAD + inside * (PRESSURE + high - low) + MIDDLE + FOOT
    height = max(math.ceil(len(waves) / columns), 1) * row_height
    with figure_rules():
        figure = Figure(figsize=(width, height), dpi=style.DPI)
        for number, i in enumerate(waves):
            row, column = divmod(number, columns)
            start, wide = (LEFT + column * (inside + BETWEEN)) / width, inside / width
            middle = height - row * row_height - HEAD - inside * PRESSURE
            above = figure.add_axes((start, middle / height, wide, inside * PRESSURE / height))
            bottom = middle - MIDDLE - inside * (high - low)
            tall = inside * (high - low) / height
            below = figure.add_axes((start, bottom / height, wide, tall))
            _draw_pressure(above, view, i)
            _draw_mesh(below, view, i, low, high)
            if column == 0:
                above.set_ylabel(f"$p_c$ [{view.display_unit('pressure').unit}]")
                below.set_ylabel("$z/\\lambda$ [-]")
            if number + columns >= len(waves):
                below.set_xlabel("$x/\\lambda$ [-]")
    return figure


def _draw_pressure(axes: Axes, view: PredictionView, i: int) -> None:
    """Draw the contact pressure along a wave and its mean; what a failed one ended with is none."""
    from matplotlib.ticker import MaxNLocator

    columns = ("wavelength", "amplitude", "pressure_received", "contact_fraction")
    length, amplitude, received, contact = (float(view.column(name)[i]) for name in columns)
    unit = view.display_unit("pressure")
    mean = float(unit.of(received))
    title = f"λ = {length / MILLI:.3g} mm\nA = {amplitude / MILLI:.3g} mm\n"
    title += f"p = {mean:.3g} {unit.unit}"
    if view.converged[i]:
        title += f", contact {contact:.2f}"
        x, pascal = view.pressure_along(i)
        axes.fill_between(x, unit.of(pascal), color=ORANGE, alpha=0.35, lw=0)
        axes.plot(x, unit.of(pascal), color=ORANGE, lw=1.0)
        axes.set_ylim(bottom=0.0)
    else:
        title += f"\n{textwrap.fill(view.why(i), 30)}"
        axes.text(0.5, 0.75, "no solution", transform=axes.transAxes, ha="center", va="center")
        axes.set_ylim(0.0, 2.0 * mean)
    axes.axhline(mean, color=GREY, lw=0.8, ls=DASHES["dashed"])
    axes.set_xlim(-0.5, 0.5)
    axes.set_xticks([])  # those of the block below hold here, too
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=style.ROUND, min_n_ticks=2))
    axes.set_title(title, loc="left", y=1.0, fontsize=7.0, parse_math=False)


def _draw_mesh(axes: Axes, view: PredictionView, i: int, low: float, high: float) -> None:
    """Draw the rigid wave and some nodes of the block upon it between heights [wavelengths]."""
    abscissa = np.linspace(-0.5, 0.5, 200)
    steepness = view.column("amplitude")[i] / view.column("wavelength")[i]
    wave = steepness * np.cos(2.0 * math.pi * abscissa)
    axes.fill_between(abscissa, wave, low, color=FAINT, lw=0)
    mesh = view.mesh_along(i) if view.converged[i] else None
    if mesh is not None:
        x, z = mesh
        columns, rows = max((x.shape[1] - 1) // 32, 1), max(len(x) // 24, 1)
        x = np.hstack([x[:, :-1] - 1.0, x[:, :-1], x + 1.0])
        z = np.hstack([z[:, :-1], z[:, :-1], z])
        lines = [np.append(_joined(v[::rows]), _joined(v[:, ::columns].T)) for v in (x, z)]
        axes.fill_between(x[0], z[0], high, color=BLUE, alpha=0.10, lw=0)
        axes.plot(*lines, color=BLUE, lw=0.3, alpha=0.6, label="mesh")
        axes.plot(x[0], z[0], color=BLUE, lw=1.2, label="surface")
    axes.plot(abscissa, wave, color=INK, lw=0.9, label="wave")
    if view.column("sliding_speed")[i] > 0.0:
        look = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
        words, frame = "rubber slides $\\rightarrow$", axes.transAxes
        axes.text(0.05, 0.95, words, fontsize=7.0, va="top", bbox=look, transform=frame)
    axes.set_xlim(-0.5, 0.5)
    axes.set_ylim(low, high)
    axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
    axes.grid(False)


def _joined(rows: Array) -> Array:
    """Return the rows as one, NaN after each: one line with gaps draws as fast as a single one."""
    return np.hstack([rows, np.full((len(rows), 1), math.nan)]).ravel()
