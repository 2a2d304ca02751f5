"""Which figures a comparison writes."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from gripscale.charts.ladder import (
    BEST,
    COLOUR,
    JUDGE,
    STAR,
    Look,
    Row,
    Series,
    look_of,
    looks,
    measured,
    on_the_surface,
    rows_of,
    varied,
    worth_drawing,
)
from gripscale.charts.print_study import along
from gripscale.charts.style import (
    BEYOND,
    BLUE,
    FAINT,
    FLAG,
    GREY,
    INK,
    ORANGE,
    WIDE,
    area_axis,
    dashed_entry,
    down_to,
    falling_wavelength,
    line,
    log_axis,
    predictions_beyond,
    save_figure,
    sheet,
    styled,
)
from gripscale.core.units import MILLI, DisplayUnit, display_unit
from gripscale.experiment.axis import axis_shown
from gripscale.model import with_adhesive

# What each assumption costs: contact area and friction from rung to rung of a comparison.

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


# All rungs of a comparison over what was varied, such as the speed, and what was measured.

MARKS = "osd^v"
"""Of measurements, temperature by temperature."""
WITH_AREA_TERM = (0, (6, 1.5, 1, 1.5))
"""Dashes of friction with the area term."""
LEAST_SPREAD = 1e-3
"""Lower end of a band over the number itself, where the spread is larger than that."""


@styled
def comparison_axis_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of all rungs over the axis of a comparison.

    Bands are the standard deviation over the samples. Dashed is what rests on the rubber beyond its
    measured band. Where a sample failed the mark is open. The
    best estimate, where it has a factor, is drawn with its standard uncertainty; measured friction
    with its own.
    """
    axis = varied(comparison)
    comparison = on_the_surface(comparison)
    figure, panels = sheet(WIDE, 3.7, 1, 2, gap=0.06)
    area, friction = panels[0]
    for axes, name in ((area, "contact_fraction"), (friction, "friction")):
        x = along(axes, comparison, axis)
        for at, (rung, look) in enumerate(looks(comparison)):
            _rung(axes, x, comparison.isel(rung=at), name, look, strong=rung == JUDGE)
        _best(axes, x, comparison, name)
        if name == "friction":
            _with_area_term(axes, x, comparison)
    if axis == "speed":
        _measured(friction, comparison)
    area_axis(area)
    area.set_ylabel("contact area $A_r/A_0$ [-]")
    friction.set_ylabel("friction coefficient $\\mu$ [-]")
    friction.set_ylim(bottom=min(0.0, float(comparison.total_friction.min())))
    dashed_entry(friction)
    handles, labels = friction.get_legend_handles_labels()
    place: Any = "outside upper center"
    figure.legend(handles, labels, loc=place, ncols=3)
    return figure


def _rung(
    axes: Axes, x: np.ndarray, one: xr.Dataset, name: str, look: Look, *, strong: bool
) -> None:
    values, spread = one[f"total_{name}"].values, one[f"{name}_spread"].values
    if not np.isfinite(values).any():
        return
    width = 2.0 if strong else 1.2
    order = 3 if strong else 2
    label = str(one.label.item())
    beyond = predictions_beyond(one)
    line(axes, x, values, beyond, color=look.colour, ls=look.dash, lw=width, zorder=order)
    whole = (one.converged_samples == one.samples).values
    for chosen, face in ((whole, look.colour), (~whole, "white")):
        if chosen.any():  # nothing, unclipped, has no place on a logarithmic axis
            axes.plot(
                x[chosen], values[chosen], look.marker, ms=4.0, mfc=face, mec=look.colour,
                clip_on=False, zorder=order,
            )  # fmt: skip
    axes.plot([], [], marker=look.marker, ms=4.0, color=look.colour, ls=look.dash, label=label)
    if np.isfinite(spread).any():
        low = np.maximum(values - spread, LEAST_SPREAD * values)
        axes.fill_between(x, low, values + spread, color=look.colour, alpha=0.18, lw=0)


def _with_area_term(axes: Axes, x: np.ndarray, comparison: xr.Dataset) -> None:
    """Draw friction with the area term of the rungs that have one, thin, without marks."""
    both = with_adhesive(comparison)
    if both is None:
        return
    for at, (_, look) in enumerate(looks(comparison)):
        values = both.isel(rung=at).values
        if np.isfinite(values).any():
            axes.plot(x, values, color=look.colour, lw=0.9, ls=WITH_AREA_TERM)
    axes.plot([], [], color=INK, lw=0.9, ls=WITH_AREA_TERM, label="with the area term")


def _best(axes: Axes, x: np.ndarray, comparison: xr.Dataset, name: str) -> None:
    if not np.isfinite(comparison[f"best_{name}_factor"]).any():
        return
    values, sigma = (comparison[f"best_{name}{end}"].values for end in ("", "_uncertainty"))
    error = [values - values * np.exp(-sigma), values * np.exp(sigma) - values]
    axes.errorbar(x, values, yerr=error, fmt="*", ms=8.0, color=INK, capsize=2.5,
                  zorder=4, label="best estimate")  # fmt: skip


def _measured(axes: Axes, comparison: xr.Dataset) -> None:
    """Draw measured friction, each temperature with its own mark."""
    low, high = axes.get_xlim()
    shown = axis_shown(comparison, "speed")
    for number, series in enumerate(measured(comparison)):
        speed = shown.of(series.speed)
        axes.errorbar(
            speed, series.friction, yerr=np.nan_to_num(series.spread),
            fmt=MARKS[number % len(MARKS)], ms=5.5, mfc="white", mec=COLOUR, ecolor=COLOUR,
            mew=1.3, capsize=2.5, zorder=5, label=series.label, clip_on=False,
        )  # fmt: skip
        low, high = min(low, float(speed[0])), max(high, float(speed[-1]))
    axes.set_xlim(low, high)


# Where a comparison's contact area is lost and its friction made: running numbers of each rung.


@styled
def comparison_wavelength_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of each rung down to each wavelength.

    Wavelengths that excite the rubber beyond its measured band are dashed.
    Friction of the direct contacts goes on below the smallest wave of the surface: the edges of the
    contact do that. Their area is that of the contact without the shorter waves.
    """
    comparison = on_the_surface(comparison)
    figure, panels = sheet(WIDE, 3.5, 1, 2, gap=0.06)
    area, friction = panels[0]
    keep = worth_drawing(comparison)
    data = comparison.isel(wavelength=keep)
    for at, (name, look) in enumerate(looks(data)):
        one = data.isel(rung=at)
        label = str(one.label.item())
        _line(area, one, "running_contact_fraction", look, label, strong=name == JUDGE)
        _line(friction, one, "running_friction", look, label, strong=name == JUDGE)
    for axes in (area, friction):
        if keep.any():
            falling_wavelength(axes, data.wavelength.values / MILLI)
    area_axis(area)
    area.set_ylabel("contact area $A_r/A_0$ of longer waves [-]")
    friction.set_ylabel("friction $\\mu$ of longer waves [-]")
    friction.set_ylim(bottom=0.0)
    dashed_entry(friction)
    handles, labels = friction.get_legend_handles_labels()
    place: Any = "outside upper center"
    figure.legend(handles, labels, loc=place, ncols=3)
    return figure


def _line(axes: Axes, one: xr.Dataset, name: str, look: Look, label: str, *, strong: bool) -> None:
    values = one[name].values
    known = np.isfinite(values)
    if not known.any():
        return
    beyond = down_to(one[FLAG] == 1) if FLAG in one else np.zeros(known.size, dtype=bool)
    line(
        axes,
        one.wavelength.values[known] / MILLI,
        values[known],
        beyond[known],
        label,
        marker=look.marker,
        ms=4.0 if strong else 3.0,
        color=look.colour,
        ls=look.dash,
        lw=2.0 if strong else 1.2,
        zorder=3 if strong else 2,
    )


def draw(comparison: xr.Dataset, folder: Path) -> None:
    """Draw a comparison into `folder`: its ladder and wavelengths, or all of it over its axis."""
    axis = varied(comparison)
    if axis:
        save_figure(comparison_axis_figure(comparison), folder, f"over_{axis}")
        return
    save_figure(comparison_figure(comparison), folder, "comparison")
    if worth_drawing(on_the_surface(comparison)).any():
        save_figure(comparison_wavelength_figure(comparison), folder, "by_wavelength")


# Panels of friction over speed: one for each temperature and pressure that was measured.

MOST_COLUMNS = 3
MOST_PANELS = 9
"""Series that are drawn; more would not be read."""
LEAST_WIDTH = 4.5
"""Below which the legend has no room [inch]."""


def speeds_of(data: xr.Dataset) -> DisplayUnit:
    """Return how the speeds of a result with measured friction are shown."""
    return display_unit("speed", data.attrs)


def panels_of(data: xr.Dataset, draw: Callable[[Axes, Series], None], head: float) -> Figure:
    """Return the panels, each with what `draw` draws and the measured friction over it.

    Parameters
    ----------
    data : xarray.Dataset
        With measured friction.
    draw : callable
        Draws what belongs to a series below its points, over speeds as `speeds_of` shows them.
    head : float
        Height of the legend [inch].
    """
    series = list(measured(data))[:MOST_PANELS]
    columns = min(len(series), MOST_COLUMNS)
    rows = -(-len(series) // columns)
    figure, panels = sheet(
        max(WIDE * columns / MOST_COLUMNS, LEAST_WIDTH), head + 2.2 * rows, rows, columns,
        gap=0.05, sharey=True, sharex=True,
    )  # fmt: skip
    how = speeds_of(data)
    for axes, one in zip(panels.flat, series, strict=False):
        draw(axes, one)
        _points(axes, one, how)
    for axes in list(panels.flat)[len(series) :]:
        axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel("friction coefficient $\\mu$ [-]")
    for column in range(columns):
        last = max(row for row in range(rows) if row * columns + column < len(series))
        panels[last, column].set_xlabel(f"sliding speed $v$ [{how.unit}]")
        panels[last, column].tick_params(labelbottom=True)
    panels[0, 0].set_ylim(bottom=0.0)
    place: Any = "outside upper center"
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc=place, ncols=3 if columns > 1 else 2)
    return figure


def _points(axes: Axes, one: Series, how: DisplayUnit) -> None:
    """Draw what was measured, over everything else."""
    axes.errorbar(
        how.of(one.speed), one.friction, yerr=np.nan_to_num(one.spread), fmt="o", ms=4.5,
        mfc="white", mec=COLOUR, ecolor=COLOUR, mew=1.2, capsize=2.2, zorder=5, label="measured",
    )  # fmt: skip
    log_axis(axes, "x")
    axes.set_title(one.label.removeprefix("measured").removeprefix(", "))


# Measured friction and what every model says at its points, one panel for each temperature.


@styled
def at_measured_figure(data: xr.Dataset, labels: dict[str, str]) -> Figure:
    """Draw measured friction with its spread, and the total of every model at the same points.

    Parameters
    ----------
    data : xarray.Dataset
        Of `gripscale.analysis.comparison`.
    labels : dict of str
        Of the models, in words.
    """
    return panels_of(data, lambda axes, one: _models(axes, data, one, labels), head=1.2)


def _models(axes: Axes, data: xr.Dataset, one: Series, labels: dict[str, str]) -> None:
    order = np.argsort(one.speed)
    speed = speeds_of(data).of(one.speed[order])
    for name in (str(name) for name in data.model.values):
        values, look = data.friction.sel(model=name).values[one.chosen], look_of(name)
        if np.isfinite(values).any():
            axes.plot(
                speed, values[order], color=look.colour, ls=look.dash, lw=1.2,
                marker=look.marker, ms=3.5, label=labels.get(name, name),
            )  # fmt: skip
