"""Charts of contact and friction against the cut-off, from centimetres to micrometres."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import xarray as xr

from gripscale.charts import chart, draw
from gripscale.charts.style import BLUE, COLOURS, GREY, ORANGE, WIDE
from gripscale.core.units import MILLI
from gripscale.questions.cut_off.curve import AREA, CONTACT_SLOPE, FRICTION, SLOPE_IN_CONTACT

_CURVES = {
    FRICTION: ("friction $\\mu$ [-]", ORANGE),
    AREA: ("contact area $A_r/A_0$ [-]", BLUE),
}
_SAME = 0.01  # relative distance of two rules that lie on each other in a figure


def cut_off_sheet(data: xr.Dataset) -> draw.Sheet:
    """Describe friction, contact and the slope in contact over the same cut-offs."""
    layout = {"sharex": True, "height_ratios": [1.2, 1.0, 0.8]}
    panels = cut_off_panels(data)
    return draw.Sheet(panels, 1, WIDE, 6.6, gap=0.03, legend_columns=2, layout=layout)


def cut_off_panels(data: xr.Dataset) -> list[chart.Panel]:
    """Return friction, contact and slope in contact over the cut-off."""
    lengths = data.cut_off.values / MILLI
    axis = replace(
        chart.wavelength_axis(lengths), label="cut-off: shortest wavelength of the surface [mm]"
    )
    rules = list(_rules(data))
    panels = []
    for name, (label, colour) in _CURVES.items():
        area = name == AREA
        low, high = (data[f"{name}_{end}"].values for end in ("lower", "upper"))
        words = "" if area else "90 % band of the continuation"
        band = chart.ShadedBand(lengths, low, high, colour, words)
        panel = chart.Panel(
            axis,
            chart.PlotAxis(label, log=area, low=None if area else 0.0),
            [band, *_curve(data, name, colour), *rules],
        )
        panels.append(panel)
    unlabelled = (replace(rule, label="") for rule in rules)
    slope = chart.Panel(
        axis,
        chart.PlotAxis("rms slope in contact [-]", low=0.0),
        [*_curve(data, SLOPE_IN_CONTACT, GREY), chart.CrossLine(CONTACT_SLOPE), *unlabelled],
    )
    return [*panels, slope]


def _curve(data: xr.Dataset, name: str, colour: str) -> Iterator[chart.Mark]:
    """Yield a curve, solid where it was measured and dotted where it is continued.

    That of the friction is in the legend.
    """
    lengths, values = data.cut_off.values / MILLI, data[name].values
    measured = data.curve_measured.values.astype(bool)
    below = ~measured | np.append(~measured[1:], False)  # from the last measured point on
    for where, dash, label in (
        (measured, "solid", "measured roughness"),
        (below, "dotted", "continued roughness"),
    ):
        if where.any():
            x, y = lengths[where], values[where]
            words = label if name == FRICTION else ""
            yield chart.Series(x, y, colour, words, dash, marker="o", size=3.0)


def _rules(data: xr.Dataset) -> Iterator[chart.CrossLine]:
    """Yield the rules of cut-off that lie on the axis; those at the same place are one line."""
    first, last = data.cut_off.values[[0, -1]]
    names: dict[float, list[str]] = {}
    for name, at in zip(data.rule.values, data.rule_cut_off.values, strict=True):
        if last <= at <= first:
            length = next((other for other in names if abs(at / other - 1.0) < _SAME), float(at))
            names.setdefault(length, []).append(str(name))
    for i, (at, alike) in enumerate(names.items()):
        colour = COLOURS[(i + 2) % len(COLOURS)]
        label = f"{', '.join(alike)}: {at / MILLI:.2g} mm"
        yield chart.CrossLine(at / MILLI, colour, label, "dashed", 0.9, upright=True)
