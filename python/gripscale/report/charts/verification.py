"""The evidence: two measures of friction, error estimates, residuals, iterations, status."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from gripscale.html_report.charts.contact import failed
from gripscale.html_report.charts.look import (
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
from gripscale.html_report.elements import Chart
from gripscale.html_report.source import Chain

WAVE = "number of the wave"
TIPS = [("wave", "@x"), ("value", "@y")]


def verification_charts(chains: Sequence[Chain]) -> list[Chart]:
    """Return the figures that say how far the numbers may be trusted."""
    moving = [chain for chain in chains if chain.moving]
    charts = []
    for chain in moving:
        charts.append(_two_frictions(chain))
        if chain.shows("friction_mismatch"):
            charts.append(_mismatch(chain))
    if any((chain.column("residual") > 0.0).any() for chain in chains):
        charts.append(_residual(chains))
    return [*charts, _iterations(chains)]


def _two_frictions(chain: Chain) -> Chart:
    figure = plot(WAVE, "friction coefficient of the wave [-]")
    wave = chain.number
    traction, lost = chain.usable("friction"), chain.usable("friction_from_dissipation")
    look: dict[str, Any] = {"size": 11, "fill_color": None, "line_color": BLUE, "line_width": 2}
    dots = [figure.scatter(wave, traction, legend_label="from the contact traction", **look)]
    look = {"marker": "cross", "size": 11, "line_color": ORANGE, "line_width": 2}
    dots.append(figure.scatter(wave, lost, legend_label="from the energy lost", **look))
    hover(figure, dots, TIPS)
    failed(figure, wave[~chain.converged], chain.column("friction")[~chain.converged])
    wave_ticks(figure, chain.waves)
    return Chart(
        f"two-frictions-{chain.name}",
        "The two measures of friction, found independently; a cross in its circle means they "
        "agree.",
        "Friction coefficient of each wave from traction and from dissipation.",
        legend(figure),
    )


def _mismatch(chain: Chain) -> Chart:
    """Show the mismatch, and the solver's error estimates where it gives them."""
    figure = plot(WAVE, "error [%]", log="y")
    wave = chain.number
    friction = np.abs(chain.usable("friction"))
    curves = [("mismatch of the two frictions", BLUE, chain.usable("friction_mismatch"))]
    if chain.has("friction_error"):
        share = np.abs(chain.usable("friction_error")) / np.where(friction > 0, friction, np.nan)
        curves.append(("estimated error of friction", ORANGE, share))
    if chain.has("contact_fraction_error"):
        error = np.abs(chain.usable("contact_fraction_error"))
        curves.append(("estimated error of contact fraction", COLOURS[2], error))
    whole_decades(figure, *(100.0 * values for _, _, values in curves))
    dots = [curve(figure, wave, 100.0 * positive(v), c, name) for name, c, v in curves]
    hover(figure, dots, TIPS)
    wave_ticks(figure, chain.waves)
    return Chart(
        f"errors-{chain.name}",
        "Errors of the discretisation: friction relative, contact fraction absolute (of the "
        "wavelength).",
        "Mismatch of the two frictions and estimated errors of each wave in per cent.",
        legend(figure),
    )


def _residual(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVE, "residual force / applied force [-]", log="y")
    for chain, colour in zip(chains, COLOURS, strict=False):
        wave = chain.number
        residual = positive(chain.column("residual"))
        hover(figure, [curve(figure, wave, residual, colour, chain.name)], TIPS)
        failed(figure, wave[~chain.converged], residual[~chain.converged])
    whole_decades(figure, *(chain.column("residual") for chain in chains))
    wave_ticks(figure, max(chain.waves for chain in chains))
    return Chart(
        "residual",
        "What is left of the equations when Newton's iteration ends.",
        "Residual of each wave on a logarithmic axis.",
        legend(figure),
    )


def _iterations(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVE, "Newton iterations")
    width = 0.8 / len(chains)
    for i, (chain, colour) in enumerate(zip(chains, COLOURS, strict=False)):
        wave = chain.number + (i - 0.5 * (len(chains) - 1)) * width
        count, good = chain.column("newton_iterations"), chain.converged
        look: dict[str, Any] = {"width": 0.9 * width, "line_color": None}
        figure.vbar(
            x=wave[good], top=count[good], fill_color=colour, legend_label=chain.name, **look
        )
        if not good.all():
            label = "not converged"
            figure.vbar(x=wave[~good], top=count[~good], fill_color=RED, legend_label=label, **look)
    figure.y_range.update(start=0)
    wave_ticks(figure, max(chain.waves for chain in chains))
    return Chart(
        "iterations",
        "Newton iterations over all load steps; red where the wave did not converge.",
        "Newton iterations of each wave.",
        legend(figure),
    )
