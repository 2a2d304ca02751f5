"""Profiles, their height difference correlation with its fits, and what the fits leave over."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.case.drawn import trace
from gripscale.figures.palette import MILLI, SQUARE_MM
from gripscale.report.charts.look import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    hover,
    legend,
    plot,
    positive,
    single,
)
from gripscale.report.elements import Chart

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
