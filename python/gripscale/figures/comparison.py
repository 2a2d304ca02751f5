"""What each assumption costs: contact area and friction from rung to rung of a comparison."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from gripscale.figures.ladder_rows import BEST, STAR, Row, rows_of
from gripscale.figures.palette import BLUE, FAINT, GREY, INK, ORANGE, WIDE
from gripscale.figures.rungs import JUDGE, on_the_surface
from gripscale.figures.stretches import BEYOND
from gripscale.figures.style import log_axis, sheet, styled

LEAST_RANGE = 3.0
"""Largest over smallest number of an axis, at least: less has no numbers of a log axis in it."""
HALF = 0.27
"""Half the height of a bar, in rows."""


@styled
def comparison_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of each rung and the factor from the rung it follows.

    A bar runs from one rung to the next: blue where the number falls, orange where it rises, the
    factor beside it. Marks carry one standard uncertainty of the mean, dots are the samples. The
    profile as measured, at once, is the one to judge the others by; below it stand the theories,
    the factors of the best estimate and the estimate itself, and what was measured at this speed. A
    rung with failed samples is open; one with a star rests partly on the rubber beyond its measured
    band.
    """
    rows = {name: list(rows_of(comparison, name)) for name in ("contact_fraction", "friction")}
    count = len(rows["friction"])
    figure, panels = sheet(WIDE, 0.95 + 0.33 * count, 1, 2, gap=0.05, sharey=True)
    area, friction = panels[0]
    for axes, name in ((area, "contact_fraction"), (friction, "friction")):
        _draw(axes, rows[name])
    area.set_xlabel("relative contact area $A_r/A_0$ [-]")
    friction.set_xlabel("friction coefficient $\\mu$ [-]")
    area.set_yticks(np.arange(count), [row.label for row in rows["friction"]])
    area.set_ylim(count - 0.4, -0.6)
    for axes in (area, friction):
        axes.tick_params(axis="y", length=0)
        for at in _borders(comparison):
            axes.axhline(at, color=FAINT, lw=0.8, zorder=0)
    if any(row.label.endswith(STAR) for row in rows["friction"]):
        star = Line2D([], [], ls="", marker="$*$", color=INK)
        figure.legend([star], [BEYOND], loc="outside lower left")
    for label in area.get_yticklabels():
        label.set_fontweight(
            "bold" if label.get_text().removesuffix(STAR) in _strong(comparison) else "normal"
        )
    return figure


def _borders(comparison: xr.Dataset) -> list[float]:
    """Return where the ladder, the theories and the best estimate part."""
    theories = int((comparison.group == "theory").sum())
    rungs = on_the_surface(comparison).sizes["rung"]
    return [rungs - theories - 0.5, rungs - 0.5] if theories else [rungs - 0.5]


def _strong(comparison: xr.Dataset) -> set[str]:
    """Return the labels that stand out."""
    return {
        str(label)
        for name, label in zip(comparison.rung.values, comparison.label.values, strict=True)
        if name == JUDGE
    } | {BEST}


def _draw(axes: Axes, rows: list[Row]) -> None:
    shown = [
        end
        for row in rows
        for end in (row.value, row.before, *row.samples, *row.ends)
        if math.isfinite(end) and end > 0.0
    ]
    axes.set_xscale("log")
    low, high = (min(shown), max(shown)) if shown else (0.1, 1.0)
    widen = max(LEAST_RANGE * low / high, 1.0) ** 0.5
    low, high = low / widen, high * widen
    room = (high / low) ** 0.13
    axes.set_xlim(low / room, high * room**2.0)
    log_axis(axes, "x", _steps(high / low * room**2))
    axes.grid(False, axis="y")
    for at, row in enumerate(rows):
        _draw_row(axes, at, row)
    for at, (one, other) in enumerate(pairwise(rows)):
        if math.isfinite(other.before) and other.before == one.value:
            axes.plot([one.value] * 2, [at, at + 1 - HALF], color=GREY, lw=0.7, zorder=1)


def _steps(decade: float) -> tuple[float, ...]:
    return (1.0, 2.0, 5.0) if decade < 60.0 else (1.0, 3.0) if decade < 1000.0 else (1.0,)


def _draw_row(axes: Axes, at: int, row: Row) -> None:
    if not (math.isfinite(row.value) and row.value > 0.0):
        axes.annotate(
            row.note, (0.03, at), xycoords=("axes fraction", "data"), va="center", color=GREY,
            fontsize=7.0, fontstyle="italic",
        )  # fmt: skip
        return
    rises = row.value > row.before
    if math.isfinite(row.before):
        left, right = sorted((row.before, row.value))
        shade = ORANGE if rises else BLUE
        axes.barh(at, right - left, 2 * HALF, left=left, color=shade, alpha=0.35, lw=0, zorder=1.5)
    axes.plot(row.samples, [at] * len(row.samples), "|", ms=6.0, mew=0.8, color=GREY, zorder=2)
    if math.isfinite(row.uncertainty):
        low, high = row.ends
        look: dict[str, Any] = {"color": row.colour, "capsize": 2.0, "elinewidth": 1.0}
        error = [[row.value - low], [high - row.value]]
        axes.errorbar([row.value], [at], xerr=error, fmt="none", capthick=0.8, zorder=3, **look)
    face = row.colour if row.filled else "white"
    size = 9.0 if row.marker == "*" else 4.8
    axes.plot([row.value], [at], row.marker, ms=size, mfc=face, mec=row.colour, mew=0.9, zorder=4)
    _write(axes, at, row)


def _write(axes: Axes, at: int, row: Row) -> None:
    """Write the number to the right of everything in the row, the factor beside the panel."""
    ends = [end for end in (*row.samples, *row.ends, row.before, row.value) if math.isfinite(end)]
    look: dict[str, Any] = {"textcoords": "offset points", "va": "center", "fontsize": 7.0}
    axes.annotate(_short(row.value), (max(ends), at), (5, 0), **look)
    if math.isfinite(row.before):
        place = ("axes fraction", "data")
        axes.annotate(f"×{row.factor:.2f}", (1.0, at), (3, 0), xycoords=place, **look)


def _short(value: float) -> str:
    """Return two significant digits, zeros too."""
    return f"{value:#.2g}".rstrip(".")
