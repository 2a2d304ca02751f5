"""Profiles, their height difference correlation with its fits, and what the fits leave over."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr
from bokeh.models.annotations.geometry import Span
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.case.record import trace
from gripscale.charts.page import dashed_entry, hover, legend, plot, positive, single
from gripscale.charts.page_elements import Chart
from gripscale.charts.style import BLUE, GREEN, GREY, INK, ORANGE
from gripscale.charts.view import PredictionView
from gripscale.core.units import MEGA, MILLI, SQUARE_MM

Array = NDArray[np.float64]
SELF_AFFINE = "correlation_self_affine"


def profile_charts(inputs: xr.Dataset) -> list[Chart]:
    """Return, for each profile, the whole of it and a piece close up."""
    charts = []
    for i, name in enumerate(str(name) for name in inputs["profile_name"].values):
        one = inputs.isel(profile=i)
        charts.append(_whole(one, i, name))
        charts.append(_close_up(one, i, name))
    return charts


def _whole(one: xr.Dataset, i: int, name: str) -> Chart:
    figure = plot("distance x [mm]", "height z [mm]", height=300)
    for part, colour, label in (("read", GREY, "as read"), ("cleaned", BLUE, "cleaned")):
        x, z = trace(*(one[f"{part}_{name}"].values for name in ("x", "lowest", "highest")))
        figure.line(single(x / MILLI), single(z / MILLI), color=colour, legend_label=label)
    return Chart(
        f"profile-{i + 1}",
        f"{name}: as read and cleaned, lowest and highest height of each of "
        f"{one.sizes['bin']} pieces.",
        f"Height of profile {name} against distance, as read and after cleaning.",
        legend(figure),
    )


def _close_up(one: xr.Dataset, i: int, name: str) -> Chart:
    figure = plot("distance x [mm]", "height z [mm]", height=300)
    x, z = one["close_up_x"].values / MILLI, one["close_up_z"].values / MILLI
    line = figure.line(x, z, color=BLUE, line_width=1.4, legend_label="cleaned, every point")
    hover(figure, [line], [("x", "@x{0.000} mm"), ("z", "@y{0.000} mm")])
    return Chart(
        f"close-up-{i + 1}",
        f"{name}: a piece from the middle, every point. Missing heights are gaps.",
        f"Close-up of the cleaned profile {name}.",
        legend(figure),
    )


def correlation_charts(inputs: xr.Dataset) -> list[Chart]:
    """Return C_z with its fits, and the ratio of each fit to the measured curve."""
    lag, value = inputs["lag"].values, inputs["correlation_value"].values
    return [_correlation(inputs, lag, value), _correlation_residual(inputs, lag, value)]


def _correlation(inputs: xr.Dataset, lag: Array, value: Array) -> Chart:
    figure = plot("lag l [mm]", "height difference correlation C_z [mm²]", log="xy", height=400)
    low, high = inputs["correlation_lower"].values, inputs["correlation_upper"].values
    known = np.isfinite(low) & np.isfinite(high)
    figure.varea(
        lag[known] / MILLI,
        positive(low[known]) / SQUARE_MM,
        high[known] / SQUARE_MM,
        color=GREY,
        alpha=0.35,
        legend_label="95 % band",
    )
    look: dict[str, Any] = {"size": 5, "color": INK, "legend_label": "measured"}
    dots = figure.scatter(lag / MILLI, positive(value) / SQUARE_MM, **look)
    hover(figure, [dots], [("lag", "@x{0.0000} mm"), ("C_z", "@y mm²")])
    fine = inputs["fine_lag"].values / MILLI
    for name, label, look in (
        ("fine_sines", "sine waves, as fitted", {"line_width": 1.8}),
        ("fine_pure_sines", "pure sine waves", {"line_dash": "dotted"}),
    ):
        values = single(positive(inputs[name].values) / SQUARE_MM)
        figure.line(fine, values, color=BLUE, legend_label=label, **look)
    if SELF_AFFINE in inputs:
        figure.line(
            lag / MILLI,
            inputs[SELF_AFFINE].values / SQUARE_MM,
            color=ORANGE,
            line_width=1.8,
            line_dash="dashed",
            legend_label=f"self-affine, H = {inputs.attrs['self_affine_hurst']:.2f}",
        )
    figure.y_range.update(start=0.3 * float(np.min(value[value > 0.0])) / SQUARE_MM)
    figure.y_range.update(end=3.0 * float(value.max()) / SQUARE_MM)
    return Chart(
        "correlation",
        "Height difference correlation: measured, superposed sine waves, self-affine fit. Beyond "
        "a quarter of its length the first wave is fitted by its mean over phases.",
        "Height difference correlation against lag on logarithmic axes, with its fits.",
        legend(figure),
    )


def _correlation_residual(inputs: xr.Dataset, lag: Array, value: Array) -> Chart:
    figure = plot("lag l [mm]", "log₁₀ (fit / measured)", log="x", height=400)
    sines = inputs["correlation_sines"].values
    usable = (value > 0.0) & np.isfinite(sines)
    fits = [("sine waves", BLUE, sines, *_fitted_lags(inputs, "sines"))]
    if SELF_AFFINE in inputs:
        law = inputs[SELF_AFFINE].values
        fits.append(("self-affine", ORANGE, law, *_fitted_lags(inputs, "self_affine")))
    figure.line(lag[[0, -1]] / MILLI, [0.0, 0.0], color=INK, line_width=1)
    for name, colour, fit, first, last in fits:
        inside = usable & (lag >= first) & (lag <= last)
        for rows, fill, label in ((inside, colour, "fitted"), (usable & ~inside, None, "not")):
            figure.scatter(
                lag[rows] / MILLI,
                np.log10(fit[rows] / value[rows]),
                size=6,
                line_color=colour,
                fill_color=fill,
                legend_label=f"{name}, {label} {'lags' if fill else 'fitted'}",
            )
    return Chart(
        "correlation-residual",
        "What the fits leave over, in decades of C_z: filled where the lag counted in the fit.",
        "Difference of fitted and measured height difference correlation against lag.",
        legend(figure),
    )


def _fitted_lags(inputs: xr.Dataset, fit: str) -> tuple[float, float]:
    """Return the lags that counted in a fit [m]; all where that is not recorded."""
    low, high = (inputs.attrs.get(f"{fit}_lag_{end}_m") for end in ("min", "max"))
    return low or 0.0, high or np.inf


# Master curve and Prony series, and what the fit leaves over.

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
