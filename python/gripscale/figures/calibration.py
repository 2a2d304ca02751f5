"""The area term fitted to measured friction: the fit, its residuals, the profiles of parameters."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.by_temperature import panels_of, speeds_of
from gripscale.figures.measured import Series, measured
from gripscale.figures.palette import BLUE, COLOURS, FAINT, GREY, MEGA, ORANGE, WIDE
from gripscale.figures.style import log_axis, save_figure, sheet, styled

MARKS = "osd^v"
SHOWN = {"Pa": (MEGA, "MPa"), "m/s": (1.0, "m/s"), "eV": (1.0, "eV"), "1": (1.0, "-")}
"""What a parameter is divided by to be drawn, and its unit then."""
NAMES = {
    "stress_0": "stress $\\tau_0$",
    "width": "width $c$",
    "speed_0": "speed $v_0$",
    "activation_energy": "activation energy $\\epsilon$",
    "ratio": "ratio",
    "critical_speed": "critical speed $v_c$",
    "exponent": "exponent $n$",
}
CEILING = 2.5
"""Highest excess that is drawn, over the threshold."""


def draw(data: xr.Dataset, folder: Path) -> list[Path]:
    """Write every figure of a calibration into `folder`; return the paths.

    Raises `FileError` if one cannot be written.
    """
    figures = {
        "measured_and_fitted": fitted_figure,
        "residuals": residual_figure,
        "profiles": profiles_figure,
    }
    return [
        path for name, make in figures.items() for path in save_figure(make(data), folder, name)
    ]


@styled
def fitted_figure(data: xr.Dataset) -> Figure:
    """Draw measured friction with its spread, the hysteresis alone, and the total with its band.

    One panel for each temperature and pressure; points where the model has no answer are left out
    of its lines.
    """
    return panels_of(data, lambda axes, one: _fitted(axes, data, one), head=0.5)


@styled
def residual_figure(data: xr.Dataset) -> Figure:
    """Draw predicted less measured friction over speed, over the spread where it is known."""
    figure, panels = sheet(WIDE, 2.8)
    axes = panels[0, 0]
    known = bool(np.isfinite(data.difference_in_spread).any())
    name = "difference_in_spread" if known else "difference"
    scale = 1.0 if known else data.attrs["scatter"]
    axes.axhspan(-scale, scale, color=FAINT, alpha=0.5, lw=0)
    axes.axhline(0.0, color=GREY, lw=0.8)
    speeds = speeds_of(data)
    for number, one in enumerate(measured(data)):
        axes.plot(
            speeds.of(one.speed), data[name].values[one.chosen], MARKS[number % len(MARKS)],
            color=COLOURS[number % len(COLOURS)], label=one.label.removeprefix("measured, "),
        )  # fmt: skip
    log_axis(axes, "x")
    axes.set_xlabel(f"sliding speed $v$ [{speeds.unit}]")
    unit = "spread" if known else "-"
    axes.set_ylabel(f"fitted less measured $\\mu$ [{unit}]")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


@styled
def profiles_figure(data: xr.Dataset) -> Figure:
    """Draw by how much the sum of squares rises where each parameter is held elsewhere.

    The interval is where the curve is below the line; an end that is not determined has none.
    """
    count = data.sizes["parameter"]
    columns = min(count, 2)
    figure, panels = sheet(
        3.5 * columns, 0.4 + 2.1 * -(-count // columns), -(-count // columns), columns, gap=0.05
    )
    for at, axes in enumerate(panels.flat):
        if at < count:
            _profile(axes, data.isel(parameter=at))
        else:
            axes.set_visible(False)
    for axes in panels[:, 0]:
        axes.set_ylabel("rise of the sum of squares [-]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    place: Any = "outside upper center"
    figure.legend(handles, labels, loc=place, ncols=4)
    return figure


def _fitted(axes: Axes, data: xr.Dataset, one: Series) -> None:
    there = one.chosen & np.isfinite(data.friction.values)
    speed = speeds_of(data).of(data.measured_speed.values[there])
    total, band = data.friction.values[there], data.friction_band.values[there]
    hysteresis = data.hysteresis.values[there]
    axes.fill_between(speed, total - band, total + band, color=ORANGE, alpha=0.25, lw=0)
    axes.plot(speed, total, color=ORANGE, label="hysteresis and area term")
    axes.plot(speed, hysteresis, color=BLUE, marker=".", label="hysteresis alone")


def _profile(axes: Axes, one: xr.Dataset) -> None:
    threshold, level = (float(one.attrs[name]) for name in ("threshold", "level"))
    divisor, unit = SHOWN[str(one.unit.item())]
    told = np.isfinite(one.profile_excess.values)
    value, excess = one.profile_value.values[told] / divisor, one.profile_excess.values[told]
    low, high, best = (float(one[name]) / divisor for name in ("low", "high", "estimate"))
    name = str(one.parameter.item())
    if name != "activation_energy" and value.max() > 5.0 * value.min():
        log_axis(axes, "x", (1.0, 2.0, 5.0) if value.max() < 200.0 * value.min() else (1.0,))
    axes.axvspan(
        low if np.isfinite(low) else value.min(), high if np.isfinite(high) else value.max(),
        color=FAINT, alpha=0.5, lw=0, label="interval",
    )  # fmt: skip
    axes.plot(value, excess, color=BLUE, label="profile")
    axes.axhline(threshold, color=ORANGE, lw=1.0, label=f"{100.0 * level:.0f} %")
    axes.axvline(best, color=GREY, lw=1.0, label="best")
    axes.set_ylim(0.0, CEILING * threshold)
    axes.set_xlim(value.min(), value.max())
    axes.set_xlabel(f"{NAMES.get(name, name)} [{unit}]")
    missing = [word for word, end in (("lower", low), ("upper", high)) if not np.isfinite(end)]
    if missing:
        ends = " and ".join(missing)
        axes.set_title(f"{ends} end{'s' * (len(missing) > 1)} not determined")
