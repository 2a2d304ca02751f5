"""Figures 5 to 9 of Lind & Wangenheim 2014: area and friction against falling wavelength."""

from __future__ import annotations

import textwrap
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import xarray as xr
from gripscale.charts.print_study import colours
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.charts.style import GREY, NARROW, WIDE, area_axis, falling_wavelength, sheet, styled
from gripscale.core.units import MILLI

Quantity = Literal["area", "friction", "running_friction"]
Predictions = Mapping[str, xr.Dataset]

MARKERS = "osD^vP*"
AXES: dict[str, tuple[str, str]] = {
    "area": ("running_contact_fraction", "relative contact area $A_r/A_0$ [-]"),
    "friction": ("friction", "friction coefficient of each wave $\\mu_i$ [-]"),
    "running_friction": ("running_friction", "friction coefficient, sum of the waves [-]"),
}


@styled
def predictions_figure(
    panels: Mapping[str, Predictions],
    quantities: Sequence[Quantity],
    title: str,
    *,
    ordered: bool = False,
) -> Figure:
    """Draw predictions against wavelength, one panel each, large waves left as in the paper.

    Parameters
    ----------
    panels
        Predictions by name of the line, by name of the panel.
    quantities
        What each panel shows.
    title
        Printed above.
    ordered
        Whether the lines are in an order (such as speeds), to be seen in their colours.
    """
    width = WIDE if len(panels) > 1 else NARROW
    figure, axes = sheet(width, 3.5, 1, len(panels), gap=0.06)
    for panel, (name, predictions), quantity in zip(
        axes[0], panels.items(), quantities, strict=True
    ):
        _panel(panel, predictions, quantity, ordered)
        if len(panels) > 1:
            panel.set_title(name, loc="left")
    if len(set(quantities)) == 1:
        for panel in axes[0][1:]:
            panel.set_ylabel("")
    alike = len({tuple(predictions) for predictions in panels.values()}) == 1
    if alike:
        handles, labels = axes[0][0].get_legend_handles_labels()
        figure.legend(
            handles, labels, loc="outside lower center", ncols=6 if len(panels) > 1 else 3
        )
    else:
        for panel in axes[0]:
            panel.legend()
    lines = textwrap.fill(title, 100 if len(panels) > 1 else 64)
    figure.suptitle(lines, fontsize=9.0, x=0.02, ha="left")
    return figure


def _panel(axes: Axes, predictions: Predictions, quantity: Quantity, ordered: bool) -> None:
    variable, label = AXES[quantity]
    wavelengths: list[float] = []
    shades = colours(sum(name != "static" for name in predictions), ordered=ordered)
    moving = iter(zip(shades, MARKERS, strict=False))
    for name, prediction in predictions.items():
        x, y = prediction.wavelength.values / MILLI, prediction[variable].values
        still: dict[str, Any] = {"color": GREY, "marker": "x", "ls": (0, (4, 2))}
        if name != "static":
            colour, marker = next(moving)
            still = {"color": colour, "marker": marker}
        whole = prediction.prediction_status.item() == "converged"
        axes.plot(x, y, label=name if whole else f"{name}, next wave not solved", ms=4.0, **still)
        wavelengths.extend(x)
    falling_wavelength(axes, wavelengths)
    axes.set_ylabel(label)
    if quantity == "area":
        area_axis(axes)
    else:
        axes.set_ylim(bottom=0.0)
