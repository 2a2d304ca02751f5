"""What each assumption costs: contact area and friction of every model of a comparison."""

from __future__ import annotations

import numpy as np
import xarray as xr
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.figures.palette import BLUE, GREY, ORANGE, WIDE
from gripscale.figures.style import sheet, styled


@styled
def comparison_figure(comparison: xr.Dataset) -> Figure:
    """Draw area and friction of each rung, with the spread over its samples.

    The first rung is the chain; the profile as measured, at once, is the one to judge it by, and
    stands out. A rung that did not converge is left empty.
    """
    rungs = comparison.sizes["rung"]
    figure, panels = sheet(WIDE, 0.9 + 0.36 * rungs, 1, 2, gap=0.04, sharey=True)
    area, friction = panels[0]
    _bars(area, comparison, "contact_fraction")
    _bars(friction, comparison, "friction")
    area.set_xlabel("relative contact area $A_r/A_0$ [-]")
    friction.set_xlabel("friction coefficient $\\mu$ [-]")
    area.set_yticks(np.arange(rungs), [str(label) for label in comparison.label.values])
    area.invert_yaxis()
    return figure


def _bars(axes: Axes, comparison: xr.Dataset, name: str) -> None:
    place = np.arange(comparison.sizes["rung"])
    values, spread = comparison[f"total_{name}"].values, comparison[f"{name}_spread"].values
    colours = [ORANGE if str(rung) == "direct" else BLUE for rung in comparison.rung.values]
    axes.barh(place, values, color=colours, height=0.62, alpha=0.85)
    known = np.isfinite(spread)
    axes.errorbar(
        values[known], place[known], xerr=spread[known], fmt="none", ecolor=GREY, capsize=2.5
    )
    for at, value in zip(place, values, strict=True):
        if np.isfinite(value):
            text = f"{value:.3g}"
            axes.annotate(text, (value, at), (4, -9), textcoords="offset points", fontsize=6.5)
    axes.grid(False, axis="y")
    if np.isfinite(values).any():
        axes.set_xlim(0.0, 1.16 * float(np.nanmax(values)))
