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
    SLOPE_IN_CONTACT: ("rms slope in contact [-]", GREY),
}
_SAME = 0.01  # relative distance of two rules that lie on each other in a figure


def cut_off_sheet(data: xr.Dataset) -> draw.Sheet:
    """Describe friction, contact and the slope in contact over the same cut-offs.

    Curves are solid where the roughness was measured and dotted where it is continued.
    """
    lengths, measured = data.cut_off.values / MILLI, data.curve_measured.values.astype(bool)
    x = replace(
        chart.wavelength_axis(lengths), label="cut-off: shortest wavelength of the surface [mm]"
    )
    below = ~measured | np.append(~measured[1:], False)  # from the last measured point on
    parts = (measured, "solid", "measured roughness"), (below, "dotted", "continued roughness")
    panels = []
    for name, (label, colour) in _CURVES.items():
        first, values = name == FRICTION, data[name].values
        marks: list[chart.Mark] = [
            chart.Series(lengths[where], values[where], colour, words * first, dash, marker="o",
                         size=3.0)
            for where, dash, words in parts
            if where.any()
        ]  # fmt: skip
        if name == SLOPE_IN_CONTACT:
            marks.append(chart.CrossLine(CONTACT_SLOPE))
        else:
            low, high = (data[f"{name}_{end}"].values for end in ("lower", "upper"))
            words = "90 % band of the continuation" * first
            marks.insert(0, chart.ShadedBand(lengths, low, high, colour, words))
        area = name == AREA
        y = chart.PlotAxis(label, log=area, low=None if area else 0.0)
        panels.append(chart.Panel(x, y, [*marks, *_rules(data)]))
    layout = {"sharex": True, "height_ratios": [1.2, 1.0, 0.8]}
    return draw.Sheet(panels, 1, WIDE, 6.6, gap=0.03, legend_columns=2, layout=layout)


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
