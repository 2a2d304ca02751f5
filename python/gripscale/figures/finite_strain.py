"""Measured finite-strain loops with what fitted rubbers make of them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from gripscale.errors import InputError
from gripscale.figures.palette import COLOURS, GREY, WIDE
from gripscale.figures.style import sheet, styled
from gripscale.rubber import FiniteStrainFit, UniaxialTest, uniaxial_stress

KILO = 1e3


@styled
def finite_strain_figure(fits: Mapping[str, FiniteStrainFit]) -> Figure:
    """Draw nominal stress [kPa] against stretch, one panel for each test.

    Parameters
    ----------
    fits
        Label of each fit in the legend -> fit; all of the same tests.

    Raises
    ------
    InputError
        If there is no fit, or the fits are of different tests.
    """
    found = list(fits.values())
    if not found or any(fit.tests != found[0].tests for fit in found):
        raise InputError("fits must hold at least one fit, all of the same tests")
    tests = found[0].tests
    rows = (len(tests) + 1) // 2
    figure, panels = sheet(WIDE, 2.6 * rows + 0.3, rows, 2)
    for axes, place in zip(panels.flat, range(panels.size), strict=True):
        if place < len(tests):
            _panel(axes, tests[place], fits, place)
        else:
            axes.set_visible(False)
    for axes in panels[-1]:
        axes.set_xlabel("stretch $s$ [-]")
    for axes in panels[:, 0]:
        axes.set_ylabel("nominal stress $P$ [kPa]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure


def _panel(axes: Axes, test: UniaxialTest, fits: Mapping[str, FiniteStrainFit], place: int) -> None:
    """Draw one test, the fits over it, and their errors in the same colours."""
    measured = test.stress / KILO
    axes.plot(test.stretch, measured, "o", ms=3.0, mfc="none", mec=GREY, mew=0.7, label="measured")
    axes.text(0.03, 0.97, "error: rms, work lost", transform=axes.transAxes, va="top", fontsize=7.0)
    looks = zip(fits.items(), COLOURS, ("-", "-", "--", ":", "-.", "-"), strict=False)
    for line, ((label, fit), colour, dash) in enumerate(looks, 1):
        stress = uniaxial_stress(fit.rubber, test.time, test.stretch) / KILO
        axes.plot(test.stretch, stress, color=colour, ls=dash, lw=1.1, label=label)
        rms, work = fit.rms_errors[place], fit.work_errors[place]
        axes.text(
            0.03,
            0.97 - 0.075 * line,
            f"{100 * rms:.1f} %, {100 * work:+.0f} %",
            transform=axes.transAxes,
            va="top",
            fontsize=7.0,
            color=colour,
        )
    axes.set_title(test.name)
    top = float(np.max(measured))
    axes.set_ylim(min(0.0, float(np.min(measured))) - 0.04 * top, 1.25 * top)
