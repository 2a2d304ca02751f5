"""Figures 2 to 9 of Lind & Wangenheim 2014: master curves, correlations, predictions."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series, wavelength_axis
from gripscale.charts.draw import Sheet
from gripscale.charts.style import COLOURS, GREY, INK, NARROW, ORANGE, WIDE, colours
from gripscale.core.units import MEGA, MILLI, SQUARE_MM
from gripscale.rubber import MasterCurve, Rubber
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack

Quantity = Literal["area", "friction"]
Predictions = Mapping[str, xr.Dataset]

LAG = PlotAxis("lag $l$ [mm]", log=True)
CORRELATION = PlotAxis("height difference correlation $C_z$ [mm$^2$]", log=True)
MARKERS = "osD^vP*"
SLOWEST = 1e-2
"""Of the angular frequencies shown [rad/s]."""
QUANTITIES: dict[str, tuple[str, PlotAxis]] = {
    "area": (
        "running_contact_fraction",
        PlotAxis("relative contact area $A_r/A_0$ [-]", log=True),
    ),
    "friction": ("friction", PlotAxis("friction of each wave $\\mu_i$ [-]", low=0.0)),
}


def master_curves_figure(
    rubbers: Mapping[str, Rubber], measured: Mapping[str, MasterCurve]
) -> Figure:
    """Draw storage and loss modulus of compounds, with the points measured of them.

    Slower than 0.01 rad/s, where no wave excites the rubber, they are left out.
    """
    storage: list[Mark] = []
    loss: list[Mark] = []
    for (name, rubber), colour in zip(rubbers.items(), COLOURS, strict=False):
        low, high = rubber.valid_band or (SLOWEST, 1e12)
        omega = np.geomspace(max(low, SLOWEST), high, 400)
        modulus = rubber.complex_modulus(omega) / MEGA
        for marks, part in ((storage, modulus.real), (loss, modulus.imag)):
            marks.append(Series(omega, part, colour, name))
        if name in measured:
            rows = measured[name]
            shown = rows.angular_frequency >= SLOWEST
            for marks, values in ((storage, rows.storage), (loss, rows.loss)):
                points = rows.angular_frequency[shown], values[shown] / MEGA
                marks.append(Series(*points, colour, dash="", marker=".", size=3.0, alpha=0.5))
    omega_axis = PlotAxis("angular frequency $\\omega$ [rad/s]", log=True)
    panels = [
        Panel(omega_axis, PlotAxis("storage modulus $E'$ [MPa]", log=True), storage),
        Panel(omega_axis, PlotAxis("loss modulus $E''$ [MPa]", log=True), loss),
    ]
    return Sheet(panels, height=3.3, legend="below", legend_columns=4).on_paper()


def both_correlations_figure(curves: Mapping[str, HeightDifference]) -> Figure:
    """Draw C_z of several surfaces in one panel."""
    marks = [
        Series(curve.lag / MILLI, curve.value / SQUARE_MM, colour, name, marker=marker, size=3.5)
        for (name, curve), colour, marker in zip(curves.items(), COLOURS, MARKERS, strict=False)
    ]
    panel = Panel(LAG, CORRELATION, marks, legend="lower right")
    return Sheet([panel], 1, NARROW, height=3.5, legend="").on_paper()


def correlations_figure(
    curves: Mapping[str, HeightDifference], fits: Mapping[str, SelfAffineFit]
) -> Figure:
    """Draw C_z of surfaces with their power laws and plateaus."""
    panels = []
    for name, curve in curves.items():
        marks: list[Mark] = [_surface(curve)]
        if name in fits:
            fit, lag = fits[name], np.geomspace(curve.lag[0], curve.lag[-1], 400)
            label = f"eq. 6, $H$ = {fit.hurst:.2f}"
            marks += [
                Series(lag / MILLI, fit.evaluate(lag) / SQUARE_MM, ORANGE, label),
                CrossLine(fit.xi_parallel / MILLI, GREY, dash="dashed", upright=True),
            ]
        panels.append(Panel(LAG, CORRELATION, marks, name, legend="lower right"))
    return _correlations(panels, height=3.5)


def factors_figure(
    curves: Mapping[str, HeightDifference], stacks: Mapping[str, Mapping[str, SineStack]]
) -> Figure:
    """Draw C_z of surfaces and of sine waves with several magnification factors.

    The waves are drawn up to a quarter of the first wavelength, where its share in the fit ends.
    Legends name the factors s_lambda/s_A and the residual in decades.
    """
    panels = []
    for name, curve in curves.items():
        marks: list[Mark] = [_surface(curve)]
        for (label, stack), colour in zip(stacks[name].items(), COLOURS, strict=False):
            lag = np.geomspace(curve.lag[0], 0.25 * stack.wavelength[0], 800)
            residual = f", {stack.residual:.2f} decades" if stack.residual is not None else ""
            dash = "dashed" if "one factor" in label else "solid"
            value = stack.height_difference(lag) / SQUARE_MM
            marks.append(Series(lag / MILLI, value, colour, f"{label}{residual}", dash, 1.1))
        panels.append(Panel(LAG, CORRELATION, marks, name, legend="lower right"))
    return _correlations(panels, height=3.9)


def _surface(curve: HeightDifference) -> Series:
    values = curve.value / SQUARE_MM
    return Series(curve.lag / MILLI, values, INK, "surface", "", marker=".", size=4.0)


def _correlations(panels: Sequence[Panel], height: float) -> Figure:
    layout = {"sharey": True}
    return Sheet(panels, len(panels), height=height, legend="", layout=layout).on_paper()


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
    several, columns = len(panels) > 1, 3 if len(panels) == 3 else min(len(panels), 2)
    rows = -(-len(panels) // columns)
    alike = len({tuple(predictions) for predictions in panels.values()}) == 1
    drawn = []
    for (name, predictions), quantity in zip(panels.items(), quantities, strict=True):
        variable, axis = QUANTITIES[quantity]
        lengths = [data.wavelength.values / MILLI for data in predictions.values()]
        drawn.append(Panel(
            wavelength_axis(np.concatenate(lengths)),
            axis,
            list(_lines(predictions, variable, ordered=ordered)),
            _broken(name, 40) if several else "",
            legend="" if alike else "best",
        ))  # fmt: skip
    return Sheet(
        drawn,
        columns,
        WIDE * (1.3 if columns == 3 else 1.0) if several else NARROW,
        height=3.5 if rows == 1 else 2.8 * rows,
        legend="below" if alike else "",
        legend_columns=6 if several else 3,
        title=_broken(title, 100 if several else 64),
    ).on_paper()


def _broken(title: str, most: int) -> str:
    """Return a title in lines of about equal length, at most `most` letters each."""
    lines = -(-len(title) // most)
    return textwrap.fill(title, min(most, len(title) // lines + 8))


def _lines(predictions: Predictions, variable: str, *, ordered: bool) -> Iterator[Mark]:
    shades = colours(sum(name != "static" for name in predictions), ordered=ordered)
    moving = iter(zip(shades, MARKERS, strict=False))
    for name, data in predictions.items():
        look = (GREY, "x", "dashed") if name == "static" else (*next(moving), "solid")
        whole = data.prediction_status.item() == "converged"
        label = name if whole else f"{name}, next wave not solved"
        x, y = data.wavelength.values / MILLI, data[variable].values
        yield Series(x, y, look[0], label, look[2], marker=look[1], size=4.0)
