"""Height difference correlation: measured, self-affine fit and sine waves (figures 3b and 4 of LW).

Beyond a quarter of the first wavelength the waves are drawn as they were fitted, the first one by
its mean over phases, A_1^2 (see `fit_sines`); the pure sines, which fall back there, are dotted.
Neither is drawn beyond the first wavelength.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

from gripscale.case.drawn import sine_curves
from gripscale.figures.palette import BLUE, COLOURS, GREY, INK, MILLI, NARROW, ORANGE, SQUARE_MM
from gripscale.figures.style import DASHED, DOTTED, log_axis, sheet, styled
from gripscale.surface import HeightDifference, SelfAffineFit, SineStack


@styled
def correlation_figure(
    measured: HeightDifference,
    sines: Mapping[str, SineStack],
    self_affine: SelfAffineFit | None = None,
) -> Figure:
    """Draw C_z [mm^2] against lag [mm], with the named sine stacks and their wavelengths marked."""
    figure, panels = sheet(NARROW, 3.7)
    axes = panels[0, 0]
    _measured(axes, measured)
    if self_affine is not None:
        curve = self_affine.evaluate(measured.lag) / SQUARE_MM
        text = f"self-affine, $H$ = {self_affine.hurst:.2f}"
        axes.plot(measured.lag / MILLI, curve, color=ORANGE, ls=DASHED, label=text)
    lag = np.geomspace(measured.lag[0], measured.lag[-1], 1000)
    for (name, stack), colour in zip(sines.items(), [BLUE, *COLOURS[2:]], strict=False):
        _waves(axes, stack, lag, name, colour)
    log_axis(axes, "x")
    log_axis(axes, "y")
    axes.set_xlabel("lag $l$ [mm]")
    axes.set_ylabel("height difference correlation $C_z$ [mm$^2$]")
    value = measured.value / SQUARE_MM
    axes.set_ylim(0.3 * value[value > 0.0].min(), 3.0 * value.max())
    axes.legend(loc="lower right")
    return figure


def _measured(axes: Axes, measured: HeightDifference) -> None:
    lag = measured.lag / MILLI
    if measured.lower is not None and measured.upper is not None:
        low, high = measured.lower / SQUARE_MM, measured.upper / SQUARE_MM
        axes.fill_between(lag, low, high, color=GREY, alpha=0.35, lw=0, label="95 % band")
    axes.plot(lag, measured.value / SQUARE_MM, ".", color=INK, ms=4.0, label="measured")


def _waves(axes: Axes, stack: SineStack, lag: NDArray[np.float64], name: str, colour: str) -> None:
    """Draw the waves up to the first wavelength as fitted and as pure sines; mark wavelengths."""
    lag = lag[lag <= stack.wavelength[0]]
    fitted, pure = (curve / SQUARE_MM for curve in sine_curves(stack, lag))
    pure[lag <= 0.25 * stack.wavelength[0]] = np.nan  # the same as fitted
    axes.plot(lag / MILLI, fitted, color=colour, label=name)
    text = "as pure sines, which repeat"
    axes.plot(lag / MILLI, pure, color=colour, lw=0.8, ls=DOTTED, label=text)
    axes.plot(
        stack.wavelength / MILLI,
        np.full(len(stack), 0.0),
        "|",
        color=colour,
        ms=9,
        mew=1.4,
        transform=axes.get_xaxis_transform(),
        label="their wavelengths",
    )
