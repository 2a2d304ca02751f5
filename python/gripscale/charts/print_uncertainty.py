"""What is not known of a case: distributions, what matters most, and bands over a varied load."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import MaxNLocator

from gripscale.analysis.variance_shares import SURE
from gripscale.charts.ladder import Series, measured
from gripscale.charts.print_comparison import panels_of, speeds_of
from gripscale.charts.style import (
    BLUE,
    COLOURS,
    FAINT,
    GREY,
    INK,
    ORANGE,
    WIDE,
    log_axis,
    save_figure,
    sheet,
    styled,
)
from gripscale.core.units import MEGA
from gripscale.experiment.axis import axis_label, axis_shown

TOTAL_LABELS = {
    "friction": "friction coefficient $\\mu$ [-]",
    "contact_fraction": "real contact area $A_r/A_0$ [-]",
}
MOST_BINS = 24
MEDIAN, END = 1.6, 0.9
"""Widths of the lines at median and ends."""
ROUND = (1, 2, 5, 10)
"""Steps between the numbers of an axis."""
SEVERAL = 2
"""Samples there must be for a distribution."""


def draw_uncertainty(data: xr.Dataset, folder: Path) -> None:
    """Draw distributions and what matters most, or bands where a load is varied, into `folder`."""
    axis = next((str(name) for name in data.failed.dims if name != "model"), "")
    if axis:
        save_figure(band_figure(data, axis), folder, f"over_{axis}")
        return
    save_figure(distribution_figure(data), folder, "distributions")
    for name in data.model.values:
        one = data.sel(model=name)
        if np.isfinite(one.friction_share).any():
            save_figure(tornado_figure(one), folder, f"tornado_{name}")


@styled
def distribution_figure(data: xr.Dataset) -> Figure:
    """Draw how friction and contact fraction are distributed, a row for each model.

    Lines are the median and the ends of the 90 % interval, the triangle is the case itself.
    """
    rows = data.sizes["model"]
    figure, panels = sheet(WIDE, 1.2 + 1.7 * rows, rows, 2, gap=0.06)
    for row, (model, colour) in enumerate(zip(data.model.values, COLOURS, strict=False)):
        one = data.sel(model=model)
        for axes, (name, label) in zip(panels[row], TOTAL_LABELS.items(), strict=True):
            _distribution(axes, one, name, colour)
            axes.set_xlabel(label)
        number = one.sizes["sample"] - int(one.failed)
        panels[row][0].set_ylabel(f"samples (of {number})")
        panels[row][0].set_title(str(model), loc="left")
    entries = [
        Line2D([], [], color=INK, lw=MEDIAN, label="median"),
        Line2D([], [], color=INK, lw=END, label="5 and 95 %"),
        Line2D([], [], color=INK, marker="v", ls="", label="the case itself"),
    ]
    figure.legend(handles=entries, loc="outside upper center", ncols=3)
    return figure


def _distribution(axes: Axes, one: xr.Dataset, name: str, colour: str) -> None:
    values = one[name].values
    known = values[np.isfinite(values)]
    if known.size < SEVERAL:
        return
    counts, *_ = axes.hist(
        known, bins=min(MOST_BINS, 1 + known.size // 6), color=colour, alpha=0.45
    )
    low, middle, high = one[f"{name}_quantile"].values[[0, 2, 4]]
    for at, width in ((low, END), (middle, MEDIAN), (high, END)):
        axes.axvline(at, color=INK, lw=width)
    top = float(np.max(counts))
    axes.set_ylim(top=1.25 * top)
    axes.yaxis.set_major_locator(MaxNLocator(5, steps=ROUND, integer=True))
    axes.xaxis.set_major_locator(MaxNLocator(6, steps=ROUND))
    axes.plot(float(one[f"{name}_case"]), 1.12 * top, "v", color=INK, clip_on=False)


@styled
def tornado_figure(one: xr.Dataset) -> Figure:
    """Draw what each source does to the friction of one model at one load, most on top.

    Bars go from 5 to 95 % of what a source does to friction, the others in their middle. Beside
    them is its share of the variance with its standard error; grey is what so many samples cannot
    tell from nothing.
    """
    ranked = np.argsort(one.friction_share.values, kind="stable")
    shares, errors = one.friction_share.values, one.friction_share_error.values
    figure, panels = sheet(WIDE, 1.3 + 0.34 * len(ranked), 1, 2, gap=0.03, sharey=True)
    bars, dots = panels[0]
    middle = float(np.exp(np.nanmean(np.log(one.friction.values))))
    for place, k in enumerate(ranked):
        low, high = one.friction_end.values[k]
        seen = shares[k] > SURE * errors[k]
        for end, colour in ((low, BLUE), (high, ORANGE)):
            bars.barh(place, end - middle, left=middle, height=0.6, color=colour if seen else GREY)
        dots.errorbar(
            shares[k], place, xerr=errors[k], fmt="o", color=INK if seen else GREY, ms=4.0, lw=1.0
        )
    bars.axvline(middle, color=INK, lw=0.8)
    bars.set_yticks(np.arange(len(ranked)), [str(one.label.values[k]) for k in ranked])
    bars.set_xlabel(TOTAL_LABELS["friction"])
    bars.set_title(f"{one.model.item()}: what each does alone", loc="left")
    words = ("to 5 %", "to 95 %", "not told from nothing")
    entries = [
        Patch(color=colour, label=text)
        for colour, text in zip((BLUE, ORANGE, GREY), words, strict=True)
    ]
    figure.legend(handles=entries, loc="outside upper center", ncols=3)
    dots.tick_params(axis="y", length=0.0)
    dots.axvline(0.0, color=INK, lw=0.8)
    dots.set_xlabel("share of the variance of $\\ln\\mu$ [-]")
    return figure


@styled
def band_figure(data: xr.Dataset, axis: str) -> Figure:
    """Draw medians over what is varied, with bands of 50 and 90 % of the samples."""
    figure, panels = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    x = axis_shown(data, axis).of(data[axis].values)
    for model, colour in zip(data.model.values, COLOURS, strict=False):
        one = data.sel(model=model).transpose(axis, ...)
        for axes, (name, text) in zip(panels[0], TOTAL_LABELS.items(), strict=True):
            q = one[f"{name}_quantile"].values
            axes.fill_between(x, q[:, 0], q[:, 4], color=colour, alpha=0.18, lw=0.0)
            axes.fill_between(x, q[:, 1], q[:, 3], color=colour, alpha=0.3, lw=0.0)
            axes.plot(x, q[:, 2], color=colour, label=f"{model}: median, 50 and 90 %")
            axes.plot(x, one[f"{name}_case"], "o", color=colour, mfc="white", ms=3.5)
            axes.set_ylabel(text)
            axes.set_xlabel(axis_label(data, axis))
            if (x > 0.0).all() and len(x) > 1:
                log_axis(axes, "x")
    panels[0][0].set_ylim(bottom=0.0)
    panels[0][1].set_ylim(bottom=0.0)
    panels[0][0].plot([], [], "o", color=INK, mfc="white", ms=3.5, label="the case itself")
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


# The area term fitted to measured friction: the fit, its residuals, the profiles of parameters.

MARKS = "osd^v"
SHOWN = {"Pa": (MEGA, "MPa"), "m/s": (1.0, "m/s"), "eV": (1.0, "eV"), "1": (1.0, "-")}
"""What a parameter is divided by to be drawn, and its unit then."""
PARAMETER_LABELS = {
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


def draw_calibration(data: xr.Dataset, folder: Path) -> list[Path]:
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
    axes.set_xlabel(f"{PARAMETER_LABELS.get(name, name)} [{unit}]")
    missing = [word for word, end in (("lower", low), ("upper", high)) if not np.isfinite(end)]
    if missing:
        ends = " and ".join(missing)
        axes.set_title(f"{ends} end{'s' * (len(missing) > 1)} not determined")
