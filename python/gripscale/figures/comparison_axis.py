"""All rungs of a comparison over what was varied, such as the speed, and what was measured."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.measured import COLOUR, measured
from gripscale.figures.palette import INK, WIDE
from gripscale.figures.rungs import JUDGE, Look, looks, on_the_surface, varied
from gripscale.figures.stretches import predictions_beyond
from gripscale.figures.study_axes import along
from gripscale.figures.style import area_axis, dashed_entry, line, sheet, styled
from gripscale.model import with_adhesive
from gripscale.study.display import axis_shown

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
