"""The evidence: two measures of friction, error estimates, residuals, iterations, status."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gripscale.figures.view import PredictionView
from gripscale.report.charts.contact import failed
from gripscale.report.charts.look import (
    BLUE,
    COLOURS,
    ORANGE,
    RED,
    curve,
    hover,
    legend,
    plot,
    positive,
    wave_ticks,
    whole_decades,
)
from gripscale.report.elements import Chart

WAVE = "number of the wave"
TIPS = [("wave", "@x"), ("value", "@y")]


def verification_charts(predictions: Sequence[PredictionView]) -> list[Chart]:
    """Return the figures that say how far the numbers may be trusted."""
    moving = [one for one in predictions if one.moving]
    charts = []
    for one in moving:
        charts.append(_two_frictions(one))
        if one.shows("friction_mismatch"):
            charts.append(_mismatch(one))
    if any((one.column("residual") > 0.0).any() for one in predictions):
        charts.append(_residual(predictions))
    return [*charts, _iterations(predictions)]


def _two_frictions(one: PredictionView) -> Chart:
    figure = plot(WAVE, "friction coefficient of the wave [-]")
    wave = one.number
    traction, lost = one.usable("friction"), one.usable("friction_from_dissipation")
    look: dict[str, Any] = {"size": 11, "fill_color": None, "line_color": BLUE, "line_width": 2}
    dots = [figure.scatter(wave, traction, legend_label="from the contact traction", **look)]
    look = {"marker": "cross", "size": 11, "line_color": ORANGE, "line_width": 2}
    dots.append(figure.scatter(wave, lost, legend_label="from the energy lost", **look))
    hover(figure, dots, TIPS)
    failed(figure, wave[~one.converged], one.column("friction")[~one.converged])
    wave_ticks(figure, one.waves)
    return Chart(
        f"two-frictions-{one.name}",
        "The two measures of friction, found independently; a cross in its circle means they "
        "agree.",
        "Friction coefficient of each wave from traction and from dissipation.",
        legend(figure),
    )


def _mismatch(one: PredictionView) -> Chart:
    """Show the mismatch, and the solver's error estimates where it gives them."""
    figure = plot(WAVE, "error [%]", log="y")
    wave = one.number
    friction = np.abs(one.usable("friction"))
    curves = [("mismatch of the two frictions", BLUE, one.usable("friction_mismatch"))]
    if one.has("friction_error"):
        share = np.abs(one.usable("friction_error")) / np.where(friction > 0, friction, np.nan)
        curves.append(("estimated error of friction", ORANGE, share))
    if one.has("contact_fraction_error"):
        error = np.abs(one.usable("contact_fraction_error"))
        curves.append(("estimated error of contact fraction", COLOURS[2], error))
    whole_decades(figure, *(100.0 * values for _, _, values in curves))
    dots = [curve(figure, wave, 100.0 * positive(v), c, name) for name, c, v in curves]
    hover(figure, dots, TIPS)
    wave_ticks(figure, one.waves)
    return Chart(
        f"errors-{one.name}",
        "Errors of the discretisation: friction relative, contact fraction absolute (of the "
        "wavelength).",
        "Mismatch of the two frictions and estimated errors of each wave in per cent.",
        legend(figure),
    )


def _residual(predictions: Sequence[PredictionView]) -> Chart:
    figure = plot(WAVE, "residual force / applied force [-]", log="y")
    for one, colour in zip(predictions, COLOURS, strict=False):
        wave = one.number
        residual = positive(one.column("residual"))
        hover(figure, [curve(figure, wave, residual, colour, one.name)], TIPS)
        failed(figure, wave[~one.converged], residual[~one.converged])
    whole_decades(figure, *(one.column("residual") for one in predictions))
    wave_ticks(figure, max(one.waves for one in predictions))
    return Chart(
        "residual",
        "What is left of the equations when Newton's iteration ends.",
        "Residual of each wave on a logarithmic axis.",
        legend(figure),
    )


def _iterations(predictions: Sequence[PredictionView]) -> Chart:
    figure = plot(WAVE, "Newton iterations")
    width = 0.8 / len(predictions)
    for i, (one, colour) in enumerate(zip(predictions, COLOURS, strict=False)):
        wave = one.number + (i - 0.5 * (len(predictions) - 1)) * width
        count, good = one.column("newton_iterations"), one.converged
        look: dict[str, Any] = {"width": 0.9 * width, "line_color": None}
        figure.vbar(x=wave[good], top=count[good], fill_color=colour, legend_label=one.name, **look)
        if not good.all():
            label = "not converged"
            figure.vbar(x=wave[~good], top=count[~good], fill_color=RED, legend_label=label, **look)
    figure.y_range.update(start=0)
    wave_ticks(figure, max(one.waves for one in predictions))
    return Chart(
        "iterations",
        "Newton iterations over all load steps; red where the wave did not converge.",
        "Newton iterations of each wave.",
        legend(figure),
    )
