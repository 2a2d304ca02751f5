"""Contact area, friction and load against wavelength; contact pressure along each wave."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from bokeh.plotting import figure as Figure
from numpy.typing import NDArray

from gripscale.html_report.charts.look import (
    COLOURS,
    RED,
    curve,
    hover,
    legend,
    plot,
    shades,
    single,
    whole_decades,
)
from gripscale.html_report.elements import Chart
from gripscale.html_report.source import Chain

Array = NDArray[np.float64]
MILLI, MEGA = 1e-3, 1e6
WAVELENGTH = "wavelength λ [mm]"
TIPS = [("λ", "@x mm"), ("value", "@y")]


def contact_charts(chains: Sequence[Chain]) -> list[Chart]:
    """Return area, friction, pressure, modulus and the pressure along the waves."""
    charts = [_area(chains)]
    if any(chain.moving for chain in chains):
        charts.append(_friction([chain for chain in chains if chain.moving]))
    charts.append(_load(chains))
    if any(chain.shows("max_stretch") for chain in chains):
        charts.append(_stretch(chains))
    charts.extend(_along(chain) for chain in chains if chain.has("surface_pressure"))
    return charts


def _area(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVELENGTH, "relative contact area [-]", log="y", wavelengths=_waves(chains))
    pairs = ("running_contact_fraction", "contact_fraction")
    _both(figure, chains, *pairs)
    whole_decades(figure, *(chain.usable(name) for chain in chains for name in pairs))
    return Chart(
        "contact-area",
        "Relative contact area: A_r/A_0 down to each wave (filled), and of each wave (open).",
        "Relative contact area against wavelength, which falls to the right.",
        legend(figure),
    )


def _friction(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVELENGTH, "friction coefficient [-]", wavelengths=_waves(chains))
    _both(figure, chains, "running_friction", "friction")
    figure.y_range.update(start=min(0.0, *(float(np.nanmin(c.column("friction"))) for c in chains)))
    return Chart(
        "friction",
        "Friction coefficient: sum down to each wave (filled), and of each wave (open).",
        "Friction coefficient against wavelength, which falls to the right.",
        legend(figure),
    )


def _both(figure: Figure, chains: Sequence[Chain], running: str, each: str) -> None:
    """Draw the running value and that of each wave; what did not converge is a red cross."""
    for chain, colour in zip(chains, COLOURS, strict=False):
        x = chain.column("wavelength") / MILLI
        name = chain.name
        dots = [curve(figure, x, chain.usable(running), colour, f"{name}, down to the wave")]
        options: dict[str, Any] = {"fill": "white", "dash": "dashed"}
        label = f"{name}, each wave"
        dots.append(curve(figure, x, chain.usable(each), colour, label, **options))
        hover(figure, dots, TIPS)
        failed(figure, x[~chain.converged], chain.column(each)[~chain.converged])


def failed(figure: Figure, x: Array, y: Array) -> None:
    """Mark what did not converge."""
    shown = np.isfinite(x) & np.isfinite(y)
    if shown.any():
        look: dict[str, Any] = {"marker": "x", "size": 13, "line_width": 3, "color": RED}
        figure.scatter(x[shown], y[shown], legend_label="not converged", **look)


def _load(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVELENGTH, "pressure, modulus [MPa]", log="y", wavelengths=_waves(chains))
    for chain, colour in zip(chains, COLOURS, strict=False):
        x = chain.column("wavelength") / MILLI
        pressure, modulus = chain.column("pressure_received"), chain.column("modulus")
        label = f"{chain.name}, mean pressure"
        dots = [curve(figure, x, pressure / MEGA, colour, label)]
        options: dict[str, Any] = {"fill": "white", "dash": "dashed"}
        dots.append(curve(figure, x, modulus / MEGA, colour, f"{chain.name}, |E*|", **options))
        hover(figure, dots, TIPS)
    names = ("pressure_received", "modulus")
    whole_decades(figure, *(chain.column(name) / MEGA for chain in chains for name in names))
    return Chart(
        "load",
        "What each wave receives: mean pressure (filled) against the modulus of the rubber there "
        "(open).",
        "Mean pressure and modulus against wavelength.",
        legend(figure),
    )


def _stretch(chains: Sequence[Chain]) -> Chart:
    figure = plot(WAVELENGTH, "principal stretch [-]", wavelengths=_waves(chains))
    for chain, colour in zip(chains, COLOURS, strict=False):
        x = chain.column("wavelength") / MILLI
        largest, least = chain.usable("max_stretch"), chain.usable("min_stretch")
        dots = [curve(figure, x, largest, colour, f"{chain.name}, largest")]
        options: dict[str, Any] = {"fill": "white", "dash": "dashed"}
        dots.append(curve(figure, x, least, colour, f"{chain.name}, smallest", **options))
        hover(figure, dots, TIPS)
    return Chart(
        "stretch",
        "Largest and smallest principal stretch in the block: how far the strains are from small.",
        "Largest and smallest principal stretch against wavelength.",
        legend(figure),
    )


def _along(chain: Chain) -> Chart:
    figure = plot("x/λ [-], crest at 0", "contact pressure [MPa]", height=380)
    wavelength, colours = chain.column("wavelength"), shades(chain.waves)
    x, pressure = chain.column("surface_x"), chain.column("surface_pressure")
    for i in range(chain.waves):
        known = np.isfinite(x[i])
        phase = np.mod(x[i][known] / wavelength[i] + 0.5, 1.0) - 0.5
        order = np.argsort(phase)
        state = "" if chain.converged[i] else ", not converged"
        figure.line(
            single(phase[order]),
            single(pressure[i][known][order] / MEGA),
            color=colours[i] if chain.converged[i] else RED,
            line_width=1.6,
            legend_label=f"{i + 1}: {wavelength[i] / MILLI:.3g} mm{state}",
        )
    return Chart(
        f"pressure-{chain.name}",
        f"{chain.title}: contact pressure along each wave. Click a wave to hide it.",
        f"Contact pressure along each wave of the {chain.name} chain.",
        legend(figure),
    )


def _waves(chains: Sequence[Chain]) -> Array:
    return np.concatenate([chain.column("wavelength") for chain in chains]) / MILLI
