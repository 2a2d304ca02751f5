"""Contact area and friction against wavelength, per wave and running (figures 5 and 8 of LW)."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.chain import Prediction
from gripscale.figures.style import (
    COLOURS,
    WIDE,
    falling_wavelength,
    sheet,
    styled,
)


@styled
def contact_figure(predictions: Mapping[str, Prediction]) -> Figure:
    """Draw relative contact area and friction of each named chain, such as dynamic and static.

    Filled symbols and full lines are the running values, open symbols and dashed lines those
    of each wave. Friction leaves out chains at rest, which have none.
    """
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    area, friction = axes[0]
    waves = [s.wavelength * 1e3 for p in predictions.values() for s in p.scales]
    for (name, prediction), colour in zip(predictions.items(), COLOURS, strict=False):
        each = [scale.contact_fraction for scale in prediction.scales]
        _pair(area, prediction, each, prediction.running_contact_fraction, name, colour)
        if prediction.speed > 0.0:
            each = [scale.friction for scale in prediction.scales]
            _pair(friction, prediction, each, prediction.running_friction, name, colour)
    area.set_yscale("log")
    area.set_ylim(top=1.15)
    area.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    area.set_ylabel("relative contact area [-]")
    friction.set_ylabel("friction coefficient [-]")
    friction.set_ylim(bottom=0.0)
    for panel in (area, friction):
        falling_wavelength(panel, waves)
    figure.legend(*area.get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


def _pair(
    axes: Axes,
    prediction: Prediction,
    each: list[float],
    running: np.ndarray,
    name: str,
    colour: str,
) -> None:
    """Draw the running value and the value of each wave against wavelength [mm]."""
    wavelength = [scale.wavelength * 1e3 for scale in prediction.scales]
    usable = [v if s.converged else math.nan for s, v in zip(prediction.scales, each, strict=True)]
    axes.plot(wavelength, running, color=colour, marker="o", label=f"{name}, running")
    axes.plot(
        wavelength,
        usable,
        color=colour,
        marker="o",
        mfc="white",
        ls=(0, (4, 2)),
        lw=1.0,
        label=f"{name}, each wave",
    )
