"""Master curve and Prony series, and what the fit leaves over."""

from __future__ import annotations

import math

import numpy as np
import xarray as xr
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.html_report.charts.look import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    hover,
    legend,
    plot,
    single,
)
from gripscale.html_report.elements import Chart
from gripscale.rubber import Rubber

Array = NDArray[np.float64]
MEGA = 1e6
OMEGA = "angular frequency ω [rad/s]"


def rubber_of(inputs: xr.Dataset) -> Rubber:
    """Return the rubber the run recorded."""
    terms = "term_modulus" in inputs
    return Rubber(
        float(inputs.attrs["equilibrium_modulus_Pa"]),
        inputs["term_modulus"].values if terms else (),
        inputs["term_relaxation_time"].values if terms else (),
        bulk_modulus=float(inputs.attrs["bulk_modulus_Pa"]),
    )


def rubber_charts(inputs: xr.Dataset, excitation: Array) -> list[Chart]:
    """Return moduli, loss factor and, where it was measured, the residuals of the fit.

    `excitation` are the angular frequencies of the waves [rad/s].
    """
    rubber = rubber_of(inputs)
    omega = _band(inputs, rubber, excitation)
    charts = [_moduli(inputs, rubber, omega, excitation)]
    charts.append(_loss_factor(inputs, rubber, omega, excitation))
    if "master_frequency" in inputs:
        charts.append(_residuals(inputs, rubber))
    if "term_modulus" in inputs:
        charts.append(_spectrum(inputs))
    return charts


def _band(inputs: xr.Dataset, rubber: Rubber, excitation: Array) -> Array:
    """Return the angular frequencies to draw: all measured, all excited, or all terms."""
    ends = [*excitation[excitation > 0.0]]
    ends += [inputs.attrs[k] for k in inputs.attrs if k.startswith("band_")]
    if "master_frequency" in inputs:
        ends += [*(2.0 * math.pi * inputs["master_frequency"].values[[0, -1]])]
    ends = ends or [*(1.0 / rubber.relaxation_times)] or [1.0]
    return np.geomspace(min(ends) / 3.0, max(ends) * 3.0, 400)


def _moduli(inputs: xr.Dataset, rubber: Rubber, omega: Array, excitation: Array) -> Chart:
    figure = plot(OMEGA, "modulus [MPa]", log="xy", height=400)
    modulus = rubber.complex_modulus(omega)
    curves = (
        ("E′", BLUE, modulus.real, "master_storage"),
        ("E″", ORANGE, modulus.imag, "master_loss"),
    )
    for name, colour, values, measured in curves:
        label = f"{name}, Prony series"
        figure.line(omega, single(values / MEGA), color=colour, line_width=1.8, legend_label=label)
        if measured in inputs:
            _points(figure, inputs, inputs[measured].values / MEGA, colour, name)
    _marks(figure, excitation, np.abs(rubber.complex_modulus(excitation)) / MEGA)
    return Chart(
        "master-curve",
        "Storage and loss modulus: measured, and the Prony series that is solved with. "
        "Diamonds: |E*| at the frequencies of the waves.",
        "Storage and loss modulus against angular frequency on logarithmic axes.",
        legend(figure),
    )


def _loss_factor(inputs: xr.Dataset, rubber: Rubber, omega: Array, excitation: Array) -> Chart:
    figure = plot(OMEGA, "loss factor E″/E′ [-]", log="x", height=400)
    modulus = rubber.complex_modulus(omega)
    values = single(modulus.imag / modulus.real)
    figure.line(omega, values, color=GREEN, line_width=1.8, legend_label="Prony series")
    if "master_loss" in inputs:
        measured = inputs["master_loss"].values / inputs["master_storage"].values
        _points(figure, inputs, measured, GREEN, "")
    at = rubber.complex_modulus(excitation)
    _marks(figure, excitation, at.imag / at.real)
    return Chart(
        "loss-factor",
        "Loss factor: measured, Prony series, and at the frequencies of the waves.",
        "Loss factor against angular frequency.",
        legend(figure),
    )


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


def _marks(figure: Figure, omega: Array, values: Array) -> None:
    if (omega > 0.0).any():
        figure.scatter(
            omega,
            values,
            marker="diamond",
            size=9,
            line_color=INK,
            fill_color="white",
            legend_label="waves",
        )


def _residuals(inputs: xr.Dataset, rubber: Rubber) -> Chart:
    figure = plot(OMEGA, "Prony series / measured − 1 [%]", log="x")
    kept = ~_left_out(inputs)
    omega = 2.0 * math.pi * inputs["master_frequency"].values[kept]
    modulus = rubber.complex_modulus(omega)
    figure.line(omega[[0, -1]], [0.0, 0.0], color=INK, line_width=1)
    for name, colour, fit, column in (
        ("E′", BLUE, modulus.real, "master_storage"),
        ("E″", ORANGE, modulus.imag, "master_loss"),
    ):
        error = 100.0 * (fit / inputs[column].values[kept] - 1.0)
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
