"""Contact area, friction and load against wavelength; contact pressure along each wave."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.analysis.measured_comparison import measured_variables
from gripscale.analysis.measured_friction import MeasuredFriction
from gripscale.charts.ladder import COLOUR, measured
from gripscale.charts.page import (
    RED,
    curve,
    dashed_entry,
    hover,
    legend,
    plot,
    positive,
    shades,
    single,
    wave_ticks,
    whole_decades,
)
from gripscale.charts.page_elements import Chart
from gripscale.charts.style import BLUE, COLOURS, INK, ORANGE, down_to, waves_beyond
from gripscale.charts.view import JUDGE, PredictionView
from gripscale.core.units import MILLI, DisplayUnit, display_unit
from gripscale.model import with_adhesive

Array = NDArray[np.float64]
WAVELENGTH = "wavelength λ [mm]"
LOAD = ("pressure_received", "modulus")
"""What is drawn on one axis: pressure, and the modulus that carries it."""
CONTACT_TIPS = [("λ", "@x mm"), ("value", "@y")]


def contact_charts(
    predictions: Sequence[PredictionView], direct: xr.Dataset | None = None
) -> list[Chart]:
    """Return area, friction, pressure, modulus and the pressure along the waves.

    The totals of `direct`, what judges the predictions, are level lines.
    """
    charts = [_area(predictions, direct)]
    if any(one.moving for one in predictions):
        charts.append(_friction([one for one in predictions if one.moving], direct))
    charts.append(_load(predictions))
    if any(one.shows("max_stretch") for one in predictions):
        charts.append(_stretch(predictions))
    charts.extend(_along(one) for one in predictions if one.has("surface_pressure"))
    return charts


def _area(predictions: Sequence[PredictionView], direct: xr.Dataset | None) -> Chart:
    figure = plot(WAVELENGTH, "relative contact area [-]", log="y", wavelengths=_waves(predictions))
    pairs = ("running_contact_fraction", "contact_fraction")
    _both(figure, predictions, *pairs)
    judged = _judge(figure, predictions, direct, "contact_fraction")
    whole_decades(figure, *(one.usable(name) for one in predictions for name in pairs), judged)
    return Chart(
        "contact-area",
        "Relative contact area: A_r/A_0 down to each wave (filled), and of each wave (open); "
        "dashed beyond the measured band.",
        "Relative contact area against wavelength, which falls to the right.",
        legend(figure),
    )


def _friction(predictions: Sequence[PredictionView], direct: xr.Dataset | None) -> Chart:
    figure = plot(WAVELENGTH, "friction coefficient [-]", wavelengths=_waves(predictions))
    _both(figure, predictions, "running_friction", "friction")
    _judge(figure, predictions, direct, "friction")
    figure.y_range.update(
        start=min(0.0, *(float(np.nanmin(c.column("friction"))) for c in predictions))
    )
    return Chart(
        "friction",
        "Friction coefficient: sum down to each wave (filled), and of each wave (open); "
        "dashed beyond the measured band.",
        "Friction coefficient against wavelength, which falls to the right.",
        legend(figure),
    )


def _both(figure: Figure, predictions: Sequence[PredictionView], running: str, each: str) -> None:
    """Draw the running value and that of each wave; what did not converge is a red cross."""
    for one, colour in zip(predictions, COLOURS, strict=False):
        x = one.column("wavelength") / MILLI
        name = one.name
        beyond = waves_beyond(one.data)
        label = f"{name}, down to the wave"
        dots = [curve(figure, x, one.usable(running), colour, label, beyond=down_to(beyond))]
        options: dict[str, Any] = {"fill": "white", "dash": "dotted"}
        label = f"{name}, each wave"
        dots.append(curve(figure, x, one.usable(each), colour, label, beyond=beyond, **options))
        hover(figure, dots, CONTACT_TIPS)
        failed(figure, x[~one.converged], one.column(each)[~one.converged])
    dashed_entry(figure, *(waves_beyond(one.data) for one in predictions))


def _judge(
    figure: Figure, predictions: Sequence[PredictionView], direct: xr.Dataset | None, quantity: str
) -> Array:
    """Draw the total of the direct contact as a level line and return it, empty if none."""
    total = np.nan if direct is None else PredictionView(direct).total(quantity)
    if not np.isfinite(total):
        return np.empty(0)
    lengths = np.concatenate([one.column("wavelength") for one in predictions]) / MILLI
    ends, level = [lengths.min(), lengths.max()], np.full(2, total)
    drawn = figure.line(ends, level, color=INK, line_width=2.4, line_dash="dotdash",
                        legend_label=JUDGE)  # fmt: skip
    hover(figure, [drawn], [(JUDGE, "@y")])
    return level


def failed(figure: Figure, x: Array, y: Array) -> None:
    """Mark what did not converge."""
    shown = np.isfinite(x) & np.isfinite(y)
    if shown.any():
        look: dict[str, Any] = {"marker": "x", "size": 13, "line_width": 3, "color": RED}
        figure.scatter(x[shown], y[shown], legend_label="not converged", **look)


def _load(predictions: Sequence[PredictionView]) -> Chart:
    how = predictions[0].shown("pressure")
    label = f"pressure, modulus [{how.unit}]"
    figure = plot(WAVELENGTH, label, log="y", wavelengths=_waves(predictions))
    for one, colour in zip(predictions, COLOURS, strict=False):
        x = one.column("wavelength") / MILLI
        pressure, modulus = (how.of(one.column(name)) for name in LOAD)
        label = f"{one.name}, mean pressure"
        dots = [curve(figure, x, pressure, colour, label)]
        options: dict[str, Any] = {"fill": "white", "dash": "dotted"}
        dots.append(curve(figure, x, modulus, colour, f"{one.name}, |E*|", **options))
        hover(figure, dots, CONTACT_TIPS)
    whole_decades(figure, *(how.of(one.column(name)) for one in predictions for name in LOAD))
    return Chart(
        "load",
        "What each wave receives: mean pressure (filled) against the modulus of the rubber there "
        "(open).",
        "Mean pressure and modulus against wavelength.",
        legend(figure),
    )


def _stretch(predictions: Sequence[PredictionView]) -> Chart:
    figure = plot(WAVELENGTH, "principal stretch [-]", wavelengths=_waves(predictions))
    for one, colour in zip(predictions, COLOURS, strict=False):
        x = one.column("wavelength") / MILLI
        largest, least = one.usable("max_stretch"), one.usable("min_stretch")
        dots = [curve(figure, x, largest, colour, f"{one.name}, largest")]
        options: dict[str, Any] = {"fill": "white", "dash": "dotted"}
        dots.append(curve(figure, x, least, colour, f"{one.name}, smallest", **options))
        hover(figure, dots, CONTACT_TIPS)
    return Chart(
        "stretch",
        "Largest and smallest principal stretch in the block: how far the strains are from small.",
        "Largest and smallest principal stretch against wavelength.",
        legend(figure),
    )


def _along(one: PredictionView) -> Chart:
    how = one.shown("pressure")
    figure = plot("x/λ [-], crest at 0", f"contact pressure [{how.unit}]", height=380)
    wavelength, colours = one.column("wavelength"), shades(one.waves)
    for i in range(one.waves):
        phase, pressure = one.pressure_along(i)
        state = "" if one.converged[i] else ", not converged"
        figure.line(
            single(phase),
            single(how.of(pressure)),
            color=colours[i] if one.converged[i] else RED,
            line_width=1.6,
            legend_label=f"{i + 1}: {wavelength[i] / MILLI:.3g} mm{state}",
        )
    return Chart(
        f"pressure-{one.name}",
        f"{one.title}: contact pressure along each wave. Click a wave to hide it.",
        f"Contact pressure along each wave of the {one.name} prediction.",
        legend(figure),
    )


def _waves(predictions: Sequence[PredictionView]) -> Array:
    return np.concatenate([one.column("wavelength") for one in predictions]) / MILLI


# The evidence: two measures of friction, error estimates, residuals, iterations, status.

WAVE = "number of the wave"
VERIFICATION_TIPS = [("wave", "@x"), ("value", "@y")]


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
    hover(figure, dots, VERIFICATION_TIPS)
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
    hover(figure, dots, VERIFICATION_TIPS)
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
        hover(figure, [curve(figure, wave, residual, colour, one.name)], VERIFICATION_TIPS)
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


# Measured friction over speed, and what was predicted at one speed among it.

MARKS = ("circle", "square", "triangle", "diamond", "inverted_triangle", "hex")
"""Of measurements at several temperatures or pressures."""


def measured_chart(found: MeasuredFriction, predictions: Sequence[PredictionView]) -> Chart:
    """Return measured friction with the totals of `predictions`, each at its speed."""
    how = predictions[0].shown("speed") if predictions else display_unit("speed")
    figure = plot(f"speed [{how.unit}]", "friction coefficient [-]", log="x", height=400)
    figure.y_range.update(start=0.0)
    draw_measured(figure, xr.Dataset(measured_variables(found)), how)
    for one, colour in zip(predictions, COLOURS, strict=False):
        _point(figure, one, float(one.data.total_friction), f"{one.name}, hysteresis", colour)
        both = with_adhesive(one.data)
        if both is not None:
            label = f"{one.name}, with the area term"
            _point(figure, one, float(both), label, colour, fill_color="white")
    return Chart(
        "measured-friction",
        "Measured friction over speed, with what is predicted at the speed of the case. Bars are "
        "the standard deviation of the measurement.",
        "Measured friction against speed, and predicted friction at one speed.",
        legend(figure),
    )


def draw_measured(figure: Any, data: xr.Dataset, how: DisplayUnit) -> None:
    """Draw what was measured at each temperature and pressure over speed, shown as `how`."""
    for number, series in enumerate(measured(data)):
        speed = how.of(series.speed)
        spread = np.nan_to_num(series.spread)
        low, high = series.friction - spread, series.friction + spread
        figure.segment(x0=speed, x1=speed, y0=low, y1=high, color=COLOUR,
                       line_width=1.6)  # fmt: skip
        dots = figure.scatter(speed, series.friction, size=9, line_color=COLOUR,
                              marker=MARKS[number % len(MARKS)], fill_color="white",
                              line_width=2, legend_label=series.label)  # fmt: skip
        hover(figure, [dots], [(series.label, "@y"), ("speed", f"@x {how.unit}")])


def _point(
    figure: Any, one: PredictionView, friction: float, label: str, colour: str, **look: Any
) -> None:
    if np.isfinite(friction):
        options = {"marker": "star", "size": 17, "color": colour, "line_width": 2} | look
        how = one.shown("speed")
        dots = figure.scatter(how.of([one.speed]), [friction], legend_label=label, **options)
        hover(figure, [dots], [(label, "@y"), ("speed", f"@x {how.unit}")])
