"""The deformed rubber block of each wave on its rigid sine, with the contact pressure above it."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from gripscale.charts.style import BLUE, DASHES, DPI, FAINT, GREY, INK, ORANGE, ROUND, WIDE
from gripscale.core import Array, checks
from gripscale.core.units import MILLI
from gripscale.questions.chain.view import PredictionView

if TYPE_CHECKING:
    import xarray as xr
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

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
        figure = Figure(figsize=(width, height), dpi=DPI)
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
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))
    axes.set_title(title, loc="left", y=1.0, fontsize=7.0, parse_math=False)


def _draw_mesh(axes: Axes, view: PredictionView, i: int, low: float, high: float) -> None:
    """Draw the rigid wave and the block upon it between two heights [wavelengths].

    Of the periodic mesh some columns and rows of nodes, over three wavelengths.
    """
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
