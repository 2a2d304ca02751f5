"""Master curve and Prony series, and what the fit leaves over."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from bokeh.models.annotations.geometry import Span
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.figures.palette import MEGA
from gripscale.figures.view import PredictionView
from gripscale.report.charts.look import (
    BLUE,
    GREEN,
    GREY,
    INK,
    ORANGE,
    dashed_entry,
    hover,
    legend,
    plot,
    single,
)
from gripscale.report.elements import Chart

Array = NDArray[np.float64]
OMEGA = "angular frequency ω [rad/s]"


def rubber_charts(inputs: xr.Dataset, excited: PredictionView | None) -> list[Chart]:
    """Return moduli, loss factor and, where it was measured, the residuals of the fit.

    `excited` is the prediction whose waves are marked, if any.
    """
    charts = [_moduli(inputs, excited), _loss_factor(inputs, excited)]
    if "master_frequency" in inputs:
        charts.append(_residuals(inputs))
    if "term_modulus" in inputs:
        charts.append(_spectrum(inputs))
    return charts


def _moduli(inputs: xr.Dataset, excited: PredictionView | None) -> Chart:
    figure = plot(OMEGA, "modulus [MPa]", log="xy", height=400)
    for name, colour, part in (("E′", BLUE, "storage"), ("E″", ORANGE, "loss")):
        _admissible(figure, inputs, part, colour, name)
        _line(
            figure, inputs, inputs[f"series_{part}"].values / MEGA, colour, f"{name}, Prony series"
        )
        if f"master_{part}" in inputs:
            _points(figure, inputs, inputs[f"master_{part}"].values / MEGA, colour, name)
    _say_dashed(figure, inputs)
    _marks(figure, excited, "modulus", MEGA)
    return Chart(
        "master-curve",
        "Storage and loss modulus: measured, and the Prony series that is solved with. "
        "Diamonds: |E*| at the frequencies of the waves.",
        "Storage and loss modulus against angular frequency on logarithmic axes.",
        legend(figure),
    )


def _loss_factor(inputs: xr.Dataset, excited: PredictionView | None) -> Chart:
    figure = plot(OMEGA, "loss factor E″/E′ [-]", log="x", height=400)
    factor = inputs["series_loss"].values / inputs["series_storage"].values
    _line(figure, inputs, factor, GREEN, "Prony series")
    if "master_loss" in inputs:
        measured = inputs["master_loss"].values / inputs["master_storage"].values
        _points(figure, inputs, measured, GREEN, "")
    _say_dashed(figure, inputs)
    _marks(figure, excited, "loss_factor", 1.0)
    return Chart(
        "loss-factor",
        "Loss factor: measured, Prony series, and at the frequencies of the waves.",
        "Loss factor against angular frequency.",
        legend(figure),
    )


def _admissible(figure: Figure, inputs: xr.Dataset, part: str, colour: str, name: str) -> None:
    """Shade what the data leave open."""
    if f"series_low_{part}" not in inputs:
        return
    low, high = (single(inputs[f"series_{side}_{part}"].values / MEGA) for side in ("low", "high"))
    omega = inputs["series_omega"].values
    label = f"{name}, admissible"
    figure.varea(omega, low, high, fill_color=colour, fill_alpha=0.2, legend_label=label)


def _line(figure: Figure, inputs: xr.Dataset, values: Array, colour: str, label: str) -> None:
    """Draw a curve of the series, dashed beyond the measured band."""
    omega, values = inputs["series_omega"].values, np.asarray(values)
    low = float(inputs.attrs.get("band_low_rad_per_s", -math.inf))
    high = float(inputs.attrs.get("band_high_rad_per_s", math.inf))
    inside = (omega >= low) & (omega <= high)
    for shown, dash in ((inside, "solid"), (omega <= low, "dashed"), (omega >= high, "dashed")):
        if shown.any():
            look: dict[str, Any] = {"line_width": 1.8, "line_dash": dash, "legend_label": label}
            figure.line(omega[shown], single(values[shown]), color=colour, **look)


def _say_dashed(figure: Figure, inputs: xr.Dataset) -> None:
    """Say what is dashed, and mark where it begins."""
    ends = [inputs.attrs.get(f"band_{end}_rad_per_s") for end in ("low", "high")]
    dashed_entry(figure, [ends[0] is not None])
    look: dict[str, Any] = {"line_color": GREY, "line_dash": "dotted", "line_width": 1.2}
    marked = [float(end) for end in ends if end is not None and 0.0 < end < math.inf]
    for end in marked:
        figure.add_layout(Span(location=end, dimension="height", **look))
    if marked:
        nowhere = [math.nan, math.nan]
        figure.line(nowhere, nowhere, legend_label="ends of the measured band", **look)


def _points(figure: Figure, inputs: xr.Dataset, values: Array, colour: str, name: str) -> None:
    omega = 2.0 * math.pi * inputs["master_frequency"].values
    out = _left_out(inputs)
    label = f"{name}, measured".removeprefix(", ")
    dots = figure.scatter(
        omega[~out], values[~out], size=5, color=colour, alpha=0.6, legend_label=label
    )
    hover(figure, [dots], [("ω", "@x rad/s"), (name or "E″/E′", "@y")])
    if out.any():
        figure.scatter(
            omega[out],
            values[out],
            marker="x",
            size=8,
            line_width=1.5,
            color=colour,
            legend_label=f"{label}, left out",
        )


def _left_out(inputs: xr.Dataset) -> NDArray[np.bool_]:
    if "master_left_out" not in inputs:
        return np.zeros(inputs.sizes["row"], dtype=bool)
    return np.asarray(inputs["master_left_out"].values != 0)


def _marks(figure: Figure, excited: PredictionView | None, name: str, unit: float) -> None:
    """Mark what the rubber is like on the waves."""
    if excited is not None:
        look: dict[str, Any] = {"marker": "diamond", "size": 9, "line_color": INK}
        omega, values = excited.column("angular_frequency"), excited.column(name) / unit
        figure.scatter(omega, values, fill_color="white", legend_label="waves", **look)


def _residuals(inputs: xr.Dataset) -> Chart:
    figure = plot(OMEGA, "Prony series / measured − 1 [%]", log="x")
    kept = ~_left_out(inputs)
    omega = 2.0 * math.pi * inputs["master_frequency"].values[kept]
    figure.line(omega[[0, -1]], [0.0, 0.0], color=INK, line_width=1)
    for name, colour, part in (("E′", BLUE, "storage"), ("E″", ORANGE, "loss")):
        fit, measured = inputs[f"master_series_{part}"].values, inputs[f"master_{part}"].values
        error = 100.0 * (fit / measured - 1.0)[kept]
        figure.scatter(omega, error, size=5, color=colour, legend_label=name)
    return Chart(
        "prony-residual",
        "What the Prony series leaves over at the rows that were fitted.",
        "Relative error of the Prony series in both moduli against angular frequency.",
        legend(figure),
    )


def _spectrum(inputs: xr.Dataset) -> Chart:
    figure = plot("relaxation time τ [s]", "modulus of the element [MPa]", log="xy")
    times, moduli = inputs["term_relaxation_time"].values, inputs["term_modulus"].values / MEGA
    foot = np.full_like(moduli, float(moduli.min()) / 10.0)
    figure.segment(times, foot, times, moduli, color=BLUE, line_width=1.5)
    tops = figure.scatter(times, moduli, size=8, color=BLUE)
    hover(figure, [tops], [("τ", "@x s"), ("E", "@y MPa")])
    return Chart(
        "prony-spectrum",
        "The Maxwell elements of the Prony series.",
        "Modulus of each Maxwell element against its relaxation time.",
        figure,
    )
