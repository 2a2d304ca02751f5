"""Master curve with its Prony series, and the frequencies the waves excite (figure 2 of LW)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray

from gripscale.case.drawn import band
from gripscale.figures.palette import BLUE, GREEN, GREY, INK, MEGA, NARROW, ORANGE
from gripscale.figures.stretches import BEYOND
from gripscale.figures.style import DASHED, DOTTED, dashed_entry, log_axis, sheet, styled
from gripscale.rubber import MasterCurve, PronyFit, Rubber

Array = NDArray[np.float64]


@styled
def master_curve_figure(
    rubber: Rubber,
    master: MasterCurve | None = None,
    fit: PronyFit | None = None,
    excitation: ArrayLike = (),
) -> Figure:
    """Draw moduli [MPa] and loss factor against angular frequency.

    Parameters
    ----------
    rubber
        Its Prony series is drawn as lines, dashed beyond the measured band, whose ends are marked.
    master
        The measured points, if any.
    fit
        Tells which rows were left out of the fit; they are drawn as crosses.
    excitation
        Angular frequencies of the waves [rad/s], marked on the axis.
    """
    figure, panels = sheet(NARROW, 4.9, 2, 1, sharex=True, height_ratios=[2.0, 1.0])
    moduli, loss = panels[:, 0]
    omega = np.asarray(excitation, dtype=float)
    _series(moduli, loss, rubber, master, omega)
    if master is not None:
        _points(moduli, loss, master, fit)
    log_axis(loss, "x")
    log_axis(moduli, "y")
    moduli.set_ylabel("modulus $E'$, $E''$ [MPa]")
    loss.set_ylabel("loss factor [-]")
    loss.set_xlabel("angular frequency $\\omega$ [rad/s]")
    loss.set_ylim(bottom=0.0)
    dashed_entry(moduli)
    _ends(moduli, loss, rubber)
    if omega.size:
        _marks(moduli, loss, rubber, omega)
    figure.legend(*moduli.get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def _series(
    moduli: Axes,
    loss: Axes,
    rubber: Rubber,
    master: MasterCurve | None,
    excitation: Array,
) -> None:
    """Draw E', E'' and E''/E' of the Prony series over everything that is shown."""
    omega = band(rubber, master, excitation, 600)
    modulus = rubber.complex_modulus(omega)
    if rubber.admissible is not None:
        low, high = rubber.complex_modulus_band(omega)
        shade: dict[str, Any] = {"alpha": 0.2, "lw": 0.0}
        moduli.fill_between(omega, low.real / MEGA, high.real / MEGA, color=BLUE, **shade)
        moduli.fill_between(omega, low.imag / MEGA, high.imag / MEGA, color=ORANGE, **shade)
        moduli.fill_between([], [], color=GREY, label="admissible", **shade)
    curves = (
        (moduli, modulus.real / MEGA, BLUE, "$E'$, Prony series"),
        (moduli, modulus.imag / MEGA, ORANGE, "$E''$, Prony series"),
        (loss, modulus.imag / modulus.real, GREEN, None),
    )
    for axes, values, colour, label in curves:
        for shown, dash, text in _stretches(rubber, omega, label):
            kind: dict[str, Any] = {"gid": BEYOND} if dash == DASHED else {}
            axes.plot(omega[shown], values[shown], ls=dash, color=colour, label=text, **kind)


def _stretches(
    rubber: Rubber, omega: Array, label: str | None
) -> list[tuple[NDArray[np.bool_], Any, str | None]]:
    """Return the frequencies within the measured band, solid, and those beyond it, dashed."""
    low, high = rubber.valid_band or (0.0, math.inf)
    inside = (omega >= low) & (omega <= high)
    return [(inside, "-", label), (omega <= low, DASHED, None), (omega >= high, DASHED, None)]


def _ends(moduli: Axes, loss: Axes, rubber: Rubber) -> None:
    """Mark the lowest and the highest measured frequency."""
    ends = [end for end in rubber.valid_band or () if 0.0 < end < math.inf]
    look: dict[str, Any] = {"color": GREY, "ls": DOTTED, "lw": 0.9, "zorder": 1.5}
    for k, end in enumerate(ends):
        moduli.axvline(end, label=None if k else "ends of the measured band", **look)
        loss.axvline(end, **look)


def _marks(moduli: Axes, loss: Axes, rubber: Rubber, omega: Array) -> None:
    """Mark the frequencies of the waves on the three curves."""
    modulus = rubber.complex_modulus(omega)
    look: dict[str, Any] = {
        "marker": "o",
        "ls": "",
        "mfc": "white",
        "mec": INK,
        "ms": 3.8,
        "mew": 0.9,
    }
    moduli.plot(omega, modulus.real / MEGA, label="$\\omega_i$ of the waves", **look)
    moduli.plot(omega, modulus.imag / MEGA, **look)
    loss.plot(omega, modulus.imag / modulus.real, **look)


def _points(moduli: Axes, loss: Axes, master: MasterCurve, fit: PronyFit | None) -> None:
    """Draw the measured rows, those left out of the fit as crosses."""
    out = np.zeros(len(master), dtype=bool)
    if fit is not None:
        out = np.isin(master.frequency, fit.outlier_frequency)
    omega = 2.0 * math.pi * master.frequency
    curves = (
        (moduli, master.storage / MEGA, BLUE, "$E'$, measured"),
        (moduli, master.loss / MEGA, ORANGE, "$E''$, measured"),
        (loss, master.loss_factor, GREEN, None),
    )
    for axes, values, colour, label in curves:
        axes.plot(omega[~out], values[~out], ".", color=colour, ms=3.5, alpha=0.6, label=label)
        axes.plot(omega[out], values[out], "x", color=colour, ms=4.5)
    if out.any():
        moduli.plot([], [], "x", color=GREY, ms=4.5, label="left out of the fit")
