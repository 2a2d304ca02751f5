"""The deformed rubber block of each wave on its rigid sine, with the contact pressure above it."""

from __future__ import annotations

import base64
import io
import math
import textwrap
from typing import TYPE_CHECKING, Any

import matplotlib as mpl
import numpy as np
import PIL.Image
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from gripscale.charts.page_elements import Image, Picture
from gripscale.charts.paper import DASHES, DPI, ROUND, RULES, write_png
from gripscale.charts.style import BLUE, FAINT, GREY, INK, ORANGE, WIDE
from gripscale.charts.view import PredictionView
from gripscale.core import checks
from gripscale.core.arrays import Array
from gripscale.core.units import MILLI

if TYPE_CHECKING:
    import xarray as xr


LINE = 0.12
"""Of a title beyond its third line [inch]."""
FOR_WORDS = 0.2
"""Wavelengths left free above a wave without a mesh."""
MESH_DEPTH = 0.55
"""Depth of the block that is shown [wavelengths]."""
PRESSURE = 0.42
"""Height of a panel of pressure over its width."""
LEFT, RIGHT, BETWEEN = 0.6, 0.22, 0.42
"""Beside the panels: for the labels of the first, at the end, for numbers between two [inch]."""
HEAD, MIDDLE, FOOT, LAST = 0.5, 0.2, 0.22, 0.22
"""Of a row of panels: its titles, between pressure and block, numbers; below the last [inch]."""


def block_figure(prediction: xr.Dataset, wave: int = 1) -> Figure:
    """Draw one wave: contact pressure above the deformed mesh and the rigid sine.

    Parameters
    ----------
    prediction
        Dataset over `scale`, of a prediction or of `gripscale.wave.result.waves_to_dataset`.
    wave
        Number of the wave, from 1.

    Raises
    ------
    InputError
        If there is no such wave.
    """
    view = PredictionView(prediction)
    number = checks.whole("wave", wave, least=1, most=max(view.waves, 1))
    with mpl.rc_context(RULES):
        return _draw(view, [number - 1], columns=1, width=4.2)


def blocks_figure(prediction: xr.Dataset) -> Figure:
    """Draw every wave of a prediction, largest first, four side by side."""
    view = PredictionView(prediction)
    with mpl.rc_context(RULES):
        return _draw(view, range(view.waves), columns=4, width=WIDE)


def _draw(view: PredictionView, waves: Any, columns: int, width: float) -> Figure:
    """Place the panels by hand: they are alike, and a layout engine takes as long as drawing."""
    inside = (width - LEFT - RIGHT - (columns - 1) * BETWEEN) / columns
    columns = min(columns, max(len(waves), 1))
    width = LEFT + RIGHT + columns * inside + (columns - 1) * BETWEEN
    rows = max(math.ceil(len(waves) / columns), 1)
    low, high = _window(view, waves)
    captions = [_caption(view, i) for i in waves]
    head = HEAD + LINE * max((text.count("\n") - 2 for text in captions), default=0)
    row_height = head + inside * (PRESSURE + high - low) + MIDDLE + FOOT
    height = rows * row_height + LAST
    figure = Figure(figsize=(width, height), dpi=DPI)

    def panel(x: float, y: float, high: float) -> Axes:
        return figure.add_axes((x / width, 1 - (y + high) / height, inside / width, high / height))

    for number, i in enumerate(waves):
        row, column = divmod(number, columns)
        x, y = LEFT + column * (inside + BETWEEN), row * row_height + head
        above = panel(x, y, inside * PRESSURE)
        below = panel(x, y + inside * PRESSURE + MIDDLE, inside * (high - low))
        if view.converged[i]:
            _pressure(above, view, i)
        else:
            _no_solution(above, view, i)
        _block(below, view, i, (low, high))
        above.set_title(captions[number], loc="left", y=1.0, fontsize=7.0, parse_math=False)
        if number == 0 and view.converged[i]:
            _annotate(above, below, view, i)
        if column == 0:
            above.set_ylabel(f"$p_c$ [{view.display_unit('pressure').unit}]")
            below.set_ylabel("$z/\\lambda$ [-]")
        else:
            below.set_yticks([])  # those of the first block hold along the row
        if number + columns >= len(waves):
            below.set_xlabel("$x/\\lambda$ [-]")
    return figure


def _window(view: PredictionView, waves: Any) -> tuple[float, float]:
    """Return the heights shown [wavelengths]: the deepest valley and a part of the block."""
    if not len(waves):
        return -0.16, 0.16
    steepest = max(_ratio(view, i) for i in waves)
    meshed = any(view.converged[i] and view.mesh_along(i) is not None for i in waves)
    return -steepest - 0.06, steepest + (MESH_DEPTH if meshed else FOR_WORDS)


def _ratio(view: PredictionView, i: int) -> float:
    return float(view.column("amplitude")[i] / view.column("wavelength")[i])


def _caption(view: PredictionView, i: int) -> str:
    def value(name: str, unit: float) -> str:
        return f"{view.column(name)[i] / unit:.3g}"

    pressure_unit = view.display_unit("pressure")
    contact = f", contact {view.column('contact_fraction')[i]:.2f}"
    return (
        f"λ = {value('wavelength', MILLI)} mm\n"
        f"A = {value('amplitude', MILLI)} mm\n"
        f"p = {value('pressure_received', pressure_unit.divisor)} {pressure_unit.unit}"
        + (contact if view.converged[i] else f"\n{textwrap.fill(view.why(i), 30)}")
    )


def _mean(view: PredictionView, i: int) -> float:
    """Return the mean pressure of a wave as it is shown."""
    return float(view.display_unit("pressure").of(view.column("pressure_received")[i]))


def _no_solution(axes: Axes, view: PredictionView, i: int) -> None:
    """Draw the mean pressure alone: what a failed wave ended with is no result."""
    mean = _mean(view, i)
    axes.axhline(mean, color=GREY, lw=0.8, ls=DASHES["dashed"])
    axes.text(0.5, 0.75, "no solution", transform=axes.transAxes, ha="center", va="center")
    axes.set(xticks=[], xlim=(-0.5, 0.5), ylim=(0.0, 2.0 * mean))
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))


def _pressure(axes: Axes, view: PredictionView, i: int) -> None:
    """Draw the contact pressure and its mean along one wavelength."""
    x, pascal = view.pressure_along(i)
    pressure = view.display_unit("pressure").of(pascal)
    axes.fill_between(x, pressure, color=ORANGE, alpha=0.35, lw=0)
    axes.plot(x, pressure, color=ORANGE, lw=1.0)
    axes.axhline(_mean(view, i), color=GREY, lw=0.8, ls=DASHES["dashed"])
    axes.set_ylim(bottom=0.0)
    axes.set_xlim(-0.5, 0.5)
    axes.set_xticks([])  # those of the block below hold here, too
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))


def _block(axes: Axes, view: PredictionView, i: int, window: tuple[float, float]) -> None:
    """Draw the rigid wave and, of a solution that has one, the deformed mesh."""
    x = np.linspace(-0.5, 0.5, 200)
    wave = _ratio(view, i) * np.cos(2.0 * math.pi * x)
    axes.fill_between(x, wave, window[0], color=FAINT, lw=0)
    mesh = view.mesh_along(i) if view.converged[i] else None
    if mesh is not None:
        _mesh(axes, *mesh, top=window[1])
    axes.plot(x, wave, color=INK, lw=0.9, label="wave")
    axes.set_xlim(-0.5, 0.5)
    axes.set_ylim(*window)
    axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
    axes.grid(False)


def _annotate(above: Axes, below: Axes, view: PredictionView, i: int) -> None:
    """Name the dashed line and, where the rubber slides, its direction (along x)."""
    mean = (-0.48, _mean(view, i))
    above.annotate("mean", mean, (0, 2), textcoords="offset points", color=GREY, fontsize=6.5)
    if view.column("sliding_speed")[i] > 0.0:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
        look: dict[str, Any] = {"fontsize": 7.0, "va": "top", "bbox": box}
        text = "rubber slides $\\rightarrow$"
        below.text(0.05, 0.95, text, transform=below.transAxes, **look)


def _mesh(axes: Axes, x: Array, z: Array, top: float) -> None:
    """Draw the part of the periodic mesh that is seen, thinned where its lines would merge."""
    every = max((x.shape[1] - 1) // 32, 1)
    x = np.hstack([x[:, :-1] - 1.0, x[:, :-1], x + 1.0])
    z = np.hstack([z[:, :-1], z[:, :-1], z])
    seen = np.flatnonzero((x.max(axis=0) >= -0.5) & (x.min(axis=0) <= 0.5))
    first, last = max(seen[0] - 1, 0), seen[-1] + 2
    rows = int(np.argmax(z.min(axis=1) > top)) + 1 if (z.min(axis=1) > top).any() else len(z)
    upright = np.arange(first, last)[np.arange(first, last) % every == 0]
    level = slice(None, rows, max(x.shape[0] // 24, 1))
    edge = [np.append(v[0, first:last], v[rows - 1, first:last][::-1]) for v in (x, z)]
    lines = [np.append(_joined(v[level, first:last]), _joined(v[:rows, upright].T)) for v in (x, z)]
    axes.fill(*edge, color=BLUE, alpha=0.10, lw=0)
    axes.plot(*lines, color=BLUE, lw=0.3, alpha=0.6, label="mesh")
    axes.plot(x[0, first:last], z[0, first:last], color=BLUE, lw=1.2, label="surface")


def _joined(rows: Array) -> Array:
    """Return the rows as one, NaN after each: one line with gaps draws as fast as a single one."""
    return np.hstack([rows, np.full((len(rows), 1), math.nan)]).ravel()


PICTURE_DPI = 170


SHADES = 96
"""Colours the picture is reduced to: a third of the bytes, no visible loss."""


def image(picture: Picture) -> Image:
    """Return a picture as a page holds it."""
    drawn, packed = io.BytesIO(), io.BytesIO()
    write_png(picture.figure, drawn, PICTURE_DPI)
    pixels = PIL.Image.open(drawn).convert("RGB")
    pixels.quantize(SHADES).save(packed, "PNG")
    data = base64.b64encode(packed.getvalue()).decode("ascii")
    name = picture.name.replace("_", "-")
    return Image(name, picture.caption, picture.alt, data, "image/png", *pixels.size)


def blocks_image(prediction: PredictionView) -> Image:
    """Draw the blocks of `prediction`."""
    picture = Picture(
        f"blocks_{prediction.name}",
        blocks_figure(prediction.data),
        f"{prediction.title}: deformed rubber on each rigid wave, contact pressure above. Lengths "
        "in wavelengths, to scale.",
        f"{prediction.waves} panels, largest wave first: contact pressure and deformed mesh of the "
        f"{prediction.name} prediction.",
    )
    return image(picture)
