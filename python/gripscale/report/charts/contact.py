"""Contact area, friction and load against wavelength; contact pressure along each wave."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.figures.palette import INK, MILLI
from gripscale.figures.stretches import down_to, waves_beyond
from gripscale.figures.view import JUDGE, PredictionView
from gripscale.report.charts.look import (
    COLOURS,
    RED,
    curve,
    dashed_entry,
    hover,
    legend,
    plot,
    shades,
    single,
    whole_decades,
)
from gripscale.report.elements import Chart

Array = NDArray[np.float64]
WAVELENGTH = "wavelength λ [mm]"
LOAD = ("pressure_received", "modulus")
"""What is drawn on one axis: pressure, and the modulus that carries it."""
TIPS = [("λ", "@x mm"), ("value", "@y")]


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
        hover(figure, dots, TIPS)
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
        hover(figure, dots, TIPS)
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
        hover(figure, dots, TIPS)
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
