"""Figures 2, 3b and 4 of Lind & Wangenheim 2014: master curves, correlations, sine waves."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.charts.style import COLOURS, GREY, INK, WIDE, sheet, styled
from gripscale.core.units import MEGA, MILLI, SQUARE_MM
from gripscale.rubber import MasterCurve, Rubber
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack


@styled
def master_curves_figure(
    rubbers: Mapping[str, Rubber], measured: Mapping[str, MasterCurve]
) -> Figure:
    """Draw storage and loss modulus of compounds, with the points measured of them."""
    figure, panels = sheet(WIDE, 3.3, 1, 2, gap=0.06)
    storage, loss = panels[0]
    for (name, rubber), colour in zip(rubbers.items(), COLOURS, strict=False):
        band = rubber.valid_band or (1e-2, 1e12)
        omega = np.geomspace(*band, 400)
        modulus = rubber.complex_modulus(omega) / MEGA
        storage.plot(omega, modulus.real, color=colour, label=f"{name}, Prony series")
        loss.plot(omega, modulus.imag, color=colour)
        if name in measured:
            points = measured[name]
            label = f"{name}, measured"
            storage.plot(
                points.angular_frequency, points.storage / MEGA, ".", color=colour, ms=3, alpha=0.5,
                label=label,
            )  # fmt: skip
            loss.plot(
                points.angular_frequency, points.loss / MEGA, ".", color=colour, ms=3, alpha=0.5
            )
    storage.set_ylabel("storage modulus $E'$ [MPa]")
    loss.set_ylabel("loss modulus $E''$ [MPa]")
    for axes in (storage, loss):
        axes.set(xscale="log", yscale="log", xlabel="angular frequency $\\omega$ [rad/s]")
    figure.legend(*storage.get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


@styled
def correlations_figure(
    curves: Mapping[str, HeightDifference], fits: Mapping[str, SelfAffineFit]
) -> Figure:
    """Draw C_z of surfaces with their power laws and plateaus."""
    figure, panels = sheet(WIDE, 3.5, 1, len(curves), gap=0.06, sharey=True)
    for axes, (name, curve) in zip(panels[0], curves.items(), strict=True):
        _measured(axes, curve)
        if name in fits:
            fit = fits[name]
            lag = np.geomspace(curve.lag[0], curve.lag[-1], 400)
            label = f"eq. 6, $H$ = {fit.hurst:.2f}"
            axes.plot(lag / MILLI, fit.evaluate(lag) / SQUARE_MM, color=COLOURS[1], label=label)
            axes.axvline(fit.xi_parallel / MILLI, color=GREY, lw=0.8, ls=(0, (4, 2)))
        axes.set_title(name, loc="left")
        axes.legend(loc="lower right")
    panels[0][0].set_ylabel("height difference correlation $C_z$ [mm$^2$]")
    return figure


@styled
def factors_figure(
    curves: Mapping[str, HeightDifference], stacks: Mapping[str, Mapping[str, SineStack]]
) -> Figure:
    """Draw C_z of surfaces and of sine waves with several magnification factors.

    The waves are drawn up to a quarter of the first wavelength, where its share in the fit ends.
    """
    figure, panels = sheet(WIDE, 3.9, 1, len(curves), gap=0.06, sharey=True)
    for axes, (name, curve) in zip(panels[0], curves.items(), strict=True):
        _measured(axes, curve)
        for i, (label, stack) in enumerate(stacks[name].items()):
            lag = np.geomspace(curve.lag[0], 0.25 * stack.wavelength[0], 800)
            residual = f", {stack.residual:.2f}" if stack.residual is not None else ""
            axes.plot(
                lag / MILLI,
                stack.height_difference(lag) / SQUARE_MM,
                color=COLOURS[i],
                ls="-" if "one factor" not in label else (0, (4, 2)),
                lw=1.1,
                label=f"{label}{residual}",
            )
        axes.set_title(name, loc="left")
        axes.legend(loc="lower right", title="$s_\\lambda/s_A$, residual [decades]")
    panels[0][0].set_ylabel("height difference correlation $C_z$ [mm$^2$]")
    return figure


def _measured(axes: Axes, curve: HeightDifference) -> None:
    axes.plot(curve.lag / MILLI, curve.value / SQUARE_MM, ".", color=INK, ms=4.0, label="surface")
    axes.set(xscale="log", yscale="log", xlabel="lag $l$ [mm]")
    axes.xaxis.set_major_formatter(lambda number, _: f"{number:g}")
