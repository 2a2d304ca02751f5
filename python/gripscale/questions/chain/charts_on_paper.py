"""Blocks on paper: draws `Blocks` with matplotlib."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from gripscale.charts.paper import DASHES, DPI, ROUND, RULES
from gripscale.charts.style import BLUE, FAINT, GREY, INK, ORANGE
from gripscale.core.arrays import Array
from gripscale.questions.chain.charts_of_blocks import Blocks, DrawnBlock

_LINE = 0.12
"""Of a title beyond its third line [inch]."""
FOR_WORDS = 0.2
"""Wavelengths left free above a wave without a mesh."""
MESH_DEPTH = 0.55
"""Depth of the block that is shown [wavelengths]."""
PRESSURE = 0.42
"""Height of a panel of pressure over its width."""
LEFT, RIGHT, BETWEEN = 0.6, 0.22, 0.42
"""Beside the panels: for the labels of the first, at the end, for numbers between two [inch]."""
_HEAD, MIDDLE, FOOT, LAST = 0.5, 0.2, 0.22, 0.22
"""Of a row of panels: its titles, between pressure and block, numbers; below the last [inch]."""


def blocks_on_paper(sheet: Blocks) -> Figure:
    """Return the figure of blocks; matplotlib's own rules stay as they are.

    The panels are placed by hand: they are alike, and a layout engine takes as long as drawing.
    """
    with mpl.rc_context(RULES):
        return _draw(sheet)


def _draw(sheet: Blocks) -> Figure:
    blocks = sheet.blocks
    inside = (sheet.width - LEFT - RIGHT - (sheet.columns - 1) * BETWEEN) / sheet.columns
    columns = min(sheet.columns, max(len(blocks), 1))
    width = LEFT + RIGHT + columns * inside + (columns - 1) * BETWEEN
    rows = max(math.ceil(len(blocks) / columns), 1)
    low, high = _window(blocks)
    head = _HEAD + _LINE * max((block.caption.count("\n") - 2 for block in blocks), default=0)
    row_height = head + inside * (PRESSURE + high - low) + MIDDLE + FOOT
    height = rows * row_height + LAST
    figure = Figure(figsize=(width, height), dpi=DPI)

    def panel(x: float, y: float, high: float) -> Axes:
        return figure.add_axes((x / width, 1 - (y + high) / height, inside / width, high / height))

    for number, block in enumerate(blocks):
        row, column = divmod(number, columns)
        x, y = LEFT + column * (inside + BETWEEN), row * row_height + head
        above = panel(x, y, inside * PRESSURE)
        below = panel(x, y + inside * PRESSURE + MIDDLE, inside * (high - low))
        _pressure(above, block)
        _block(below, block, (low, high))
        above.set_title(block.caption, loc="left", y=1.0, fontsize=7.0, parse_math=False)
        if number == 0 and block.pressure is not None:
            _annotate(above, below, block)
        if column == 0:
            above.set_ylabel(f"$p_c$ [{sheet.pressure_unit}]")
            below.set_ylabel("$z/\\lambda$ [-]")
        else:
            below.set_yticks([])  # those of the first block hold along the row
        if number + columns >= len(blocks):
            below.set_xlabel("$x/\\lambda$ [-]")
    return figure


def _window(blocks: Sequence[DrawnBlock]) -> tuple[float, float]:
    """Return the heights shown [wavelengths]: the deepest valley and a part of the block."""
    if not blocks:
        return -0.16, 0.16
    steepest = max(block.steepness for block in blocks)
    meshed = any(block.mesh is not None for block in blocks)
    return -steepest - 0.06, steepest + (MESH_DEPTH if meshed else FOR_WORDS)


def _pressure(axes: Axes, block: DrawnBlock) -> None:
    """Draw the contact pressure along one wavelength and its mean; of a failed wave the mean."""
    if block.pressure is None:
        axes.text(0.5, 0.75, "no solution", transform=axes.transAxes, ha="center", va="center")
        axes.set_ylim(0.0, 2.0 * block.mean)
    else:
        axes.fill_between(*block.pressure, color=ORANGE, alpha=0.35, lw=0)
        axes.plot(*block.pressure, color=ORANGE, lw=1.0)
        axes.set_ylim(bottom=0.0)
    axes.axhline(block.mean, color=GREY, lw=0.8, ls=DASHES["dashed"])
    axes.set_xlim(-0.5, 0.5)
    axes.set_xticks([])  # those of the block below hold here, too
    axes.yaxis.set_major_locator(MaxNLocator(2, steps=ROUND, min_n_ticks=2))


def _block(axes: Axes, block: DrawnBlock, window: tuple[float, float]) -> None:
    """Draw the rigid wave and, of a solution that has one, the deformed mesh."""
    x = np.linspace(-0.5, 0.5, 200)
    wave = block.steepness * np.cos(2.0 * math.pi * x)
    axes.fill_between(x, wave, window[0], color=FAINT, lw=0)
    if block.mesh is not None:
        _mesh(axes, *block.mesh, top=window[1])
    axes.plot(x, wave, color=INK, lw=0.9, label="wave")
    axes.set_xlim(-0.5, 0.5)
    axes.set_ylim(*window)
    axes.set_xticks([-0.5, 0.0, 0.5], ["-0.5", "0", "0.5"])
    axes.grid(False)


def _annotate(above: Axes, below: Axes, block: DrawnBlock) -> None:
    """Name the dashed line and, where the rubber slides, its direction (along x)."""
    mean = (-0.48, block.mean)
    above.annotate("mean", mean, (0, 2), textcoords="offset points", color=GREY, fontsize=6.5)
    if block.slides:
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
