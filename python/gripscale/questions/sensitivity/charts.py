"""Charts of what decides the friction: the master curve, and below it what each part is worth."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import xarray as xr

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.style import BLUE, GREEN, NARROW, ORANGE, PURPLE
from gripscale.core.units import MEGA
from gripscale.questions import view
from gripscale.questions.sensitivity.friction_sensitivity import LOSS, STORAGE

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_EFFECTS = {LOSS: "E''", STORAGE: "E'"}


def sensitivity_figure(data: xr.Dataset) -> Figure:
    """Draw the master curve, and an effect by decade of frequency below it for E'' and E'."""
    omega = data.modulus_frequency.values
    axis = PlotAxis("angular frequency $\\omega$ [rad/s]", True, float(omega[0]), float(omega[-1]))
    rules: list[Mark] = []
    if "rule" in data.dims:
        colours = zip(data.rule.values, data.rule_frequency.values, (GREEN, PURPLE), strict=False)
        rules = [
            CrossLine(float(at), colour, f"tan δ, {name}", "dotted", 0.9, upright=True)
            for name, at, colour in colours
            if omega[0] <= at <= omega[-1]
        ]
    moduli: list[Mark] = [
        Series(omega, data.storage_modulus.values / MEGA, BLUE, "$E'$"),
        Series(omega, data.loss_modulus.values / MEGA, ORANGE, "$E''$"),
    ]
    low = float(data.loss_modulus.min()) / MEGA / 2.0
    panels = [Panel(axis, PlotAxis("modulus [MPa]", log=True, low=low), [*moduli, *rules])]
    for name, letter in _EFFECTS.items():
        # bands that are not excited at a point have no derivative
        by_decade = data[name].where(data[name] != 0.0) * int(data.attrs["bands_per_decade"])
        flags = xr.DataArray(False)
        panel = view.panel(data.assign({name: by_decade}), name, "frequency", flags=flags)
        y = PlotAxis(f"friction by ${letter}$ [% for 1 %,\nper decade]")
        panels.append(replace(panel.with_marks([*rules, CrossLine(0.0)]), x=axis, y=y))
    layout = {"sharex": True, "height_ratios": [1.0, 0.9, 0.9]}
    return Sheet(panels, 1, NARROW, 6.4, gap=0.03, layout=layout).on_paper()
