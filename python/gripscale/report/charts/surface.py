"""Profiles, their height difference correlation with its fits, and what the fits leave over."""

from __future__ import annotations

from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from gripscale.html_report.charts.look import (
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
from gripscale.html_report.elements import Chart
from gripscale.surface import SelfAffineFit, SineStack

Array = NDArray[np.float64]
MILLI, SQUARE_MM = 1e-3, 1e-6


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
        x, z = _trace(one, part)
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


def _trace(one: xr.Dataset, part: str) -> tuple[Array, Array]:
    """Return the envelope as one line that runs from lowest to highest in each piece."""
    x = np.repeat(one[f"{part}_x"].values, 2)
    z = np.column_stack([one[f"{part}_lowest"].values, one[f"{part}_highest"].values]).ravel()
    return x, z


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
    fine = np.geomspace(lag[0], _first_wavelength(inputs, lag[-1]), 600)
    waves = _waves(inputs).height_difference(np.minimum(fine, fine[-1]))
    figure.line(
        fine / MILLI,
        single(positive(held(inputs, fine)) / SQUARE_MM),
        color=BLUE,
        line_width=1.8,
        legend_label="sine waves, as fitted",
    )
    figure.line(
        fine / MILLI,
        single(positive(waves) / SQUARE_MM),
        color=BLUE,
        line_dash="dotted",
        legend_label="pure sine waves",
    )
    law = self_affine(inputs)
    if law is not None:
        figure.line(
            lag / MILLI,
            law.evaluate(lag) / SQUARE_MM,
            color=ORANGE,
            line_width=1.8,
            line_dash="dashed",
            legend_label=f"self-affine, H = {law.hurst:.2f}",
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
    usable = (value > 0.0) & (lag <= _first_wavelength(inputs, lag[-1]))
    low, high = inputs.attrs.get("sines_lag_min_m"), inputs.attrs.get("sines_lag_max_m")
    fits = [("sine waves", BLUE, held(inputs, lag), low, high)]
    law = self_affine(inputs)
    if law is not None:
        fits.append(("self-affine", ORANGE, law.evaluate(lag), law.lag_min, law.lag_max))
    figure.line(lag[[0, -1]] / MILLI, [0.0, 0.0], color=INK, line_width=1)
    for name, colour, fit, first, last in fits:
        inside = usable & (lag >= (first or 0.0)) & (lag <= (last or np.inf))
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


def held(inputs: xr.Dataset, lag: Array) -> Array:
    """Return C_z [m^2] of the waves as `fit_sines` uses it: the first one held at its mean."""
    waves = _waves(inputs)
    first = SineStack(wavelength=waves.wavelength[:1], amplitude=waves.amplitude[:1])
    rest = waves.height_difference(lag) - first.height_difference(lag)
    return np.asarray(
        rest + first.height_difference(np.minimum(lag, 0.25 * float(waves.wavelength[0])))
    )


def self_affine(inputs: xr.Dataset) -> SelfAffineFit | None:
    """Return the self-affine fit the run found, if it found one."""
    attrs = inputs.attrs
    if "self_affine_hurst" not in attrs:
        return None
    return SelfAffineFit(
        hurst=float(attrs["self_affine_hurst"]),
        xi_parallel=float(attrs["self_affine_xi_parallel_m"]),
        xi_perpendicular=float(attrs["self_affine_xi_perpendicular_m"]),
        lag_min=float(attrs["self_affine_lag_min_m"]),
        lag_max=float(attrs["self_affine_lag_max_m"]),
        residual=float(attrs["self_affine_residual_decades"]),
    )


def _waves(inputs: xr.Dataset) -> SineStack:
    wavelength, amplitude = inputs["wave_wavelength"].values, inputs["wave_amplitude"].values
    return SineStack(wavelength=wavelength, amplitude=amplitude)


def _first_wavelength(inputs: xr.Dataset, longest: float) -> float:
    return min(float(inputs["wave_wavelength"].values[0]), float(longest))
