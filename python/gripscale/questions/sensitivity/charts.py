"""Charts of what decides the friction: the master curve, and below it what each part is worth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np
import xarray as xr

from gripscale.charts import style
from gripscale.charts.chart import CrossLine, Mark, Note, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.style import BLUE, GREY, NARROW, ORANGE
from gripscale.core.units import MEGA
from gripscale.questions.answer.charts import NamedTrace, named_traces
from gripscale.questions.sensitivity.friction_sensitivity import LOSS, STORAGE
from gripscale.questions.view import dimensions, points

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_CURVES = 8  # points of the axes that are drawn, evenly spaced among more
_EFFECTS = {
    LOSS: ("$E''$", "more loss, more friction"),
    STORAGE: ("$E'$", "stiffer, less contact and less friction"),
}


def height_traces(data: xr.Dataset, inputs: xr.Dataset) -> list[NamedTrace]:
    """Return the traces at the first point, which show what heights of the surface are worth."""
    return named_traces(data.isel(dict.fromkeys(dimensions(data), 0)), inputs)


def sensitivity_figure(data: xr.Dataset) -> Figure:
    """Draw master curve and derivatives of the friction over the same frequencies."""
    layout = {"sharex": True, "height_ratios": [1.0, 0.9, 0.9]}
    return Sheet(sensitivity_panels(data), 1, NARROW, 6.4, gap=0.03, layout=layout).on_paper()


def sensitivity_panels(data: xr.Dataset) -> list[Panel]:
    """Return the master curve, and an effect by decade of frequency below it for E'' and E'."""
    omega = data.modulus_frequency.values
    listed = list(points(data))
    if len(listed) > _MOST_CURVES:
        chosen = np.linspace(0, len(listed) - 1, _MOST_CURVES).round().astype(int)
        listed = [listed[i] for i in chosen]
    colours = style.colours(len(listed), ordered=len(listed) > 1)
    axis = PlotAxis("angular frequency $\\omega$ [rad/s]", True, float(omega[0]), float(omega[-1]))
    rules = [CrossLine(at, GREY, "", "dotted", 0.9, upright=True) for _, at in _rules(data)]
    moduli: list[Mark] = [
        Series(omega, data.storage_modulus.values / MEGA, BLUE, "$E'$"),
        Series(omega, data.loss_modulus.values / MEGA, ORANGE, "$E''$"),
    ]
    lowest = float(data.loss_modulus.min()) / MEGA / 2.0
    middle = float(np.sqrt(omega[0] * omega[-1]))
    for i, (name, at) in enumerate(_rules(data)):
        align = "left" if at < middle else "right"  # where the axis leaves room for the words
        height = (1.4 + 0.9 * i) * lowest
        moduli.append(Note(at, height, f" tan δ, {name} ", GREY, align=align, italic=True))
    frequency = data.frequency.values
    panels = [
        Panel(
            axis,
            PlotAxis("modulus [MPa]", log=True, low=lowest),
            [*moduli, *rules],
            name="sensitivity-master-curve",
            caption="The master curve of the rubber.",
            alt="Storage and loss modulus against angular frequency.",
        )
    ]
    for name, (symbol, meaning) in _EFFECTS.items():
        curves: list[Mark] = []
        for (text, point), colour in zip(listed, colours, strict=True):
            if not np.isfinite(point[name].values).any():
                continue
            # bands that are not excited at this point have no derivative
            values = point[name].where(point[name] != 0.0).values
            values = values * int(data.attrs["bands_per_decade"])
            label = text if len(listed) > 1 else ""
            curves.append(Series(frequency, values, colour, label, marker="o", size=2.5))
        letter = symbol.strip("$")
        panels.append(
            Panel(
                axis,
                PlotAxis(f"friction by {symbol} [% for 1 %,\nper decade]"),
                [*curves, *rules, CrossLine(0.0)],
                name=f"sensitivity-{'loss' if name == LOSS else 'storage'}",
                caption=f"Per cent of friction for a per cent of {letter} in a decade: {meaning}.",
                alt=f"Derivative of friction by {letter} against angular frequency.",
            )
        )
    return panels


def _rules(data: xr.Dataset) -> Iterator[tuple[str, float]]:
    """Yield the rules of thumb on the drawn axis, and the frequency they look at [rad/s]."""
    if "rule" not in data.dims:
        return
    low, high = data.modulus_frequency.values[[0, -1]]
    for name, at in zip(data.rule.values, data.rule_frequency.values, strict=True):
        if low <= at <= high:
            yield str(name), float(at)
