"""The figures of docs/verification.md: `python -m tests.verification.draw docs/figures`."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts.style import BLUE, GREEN, GREY, ORANGE, WIDE, save_figure, sheet, styled
from tests.verification.test_convergence import COLUMNS, FAMILIES, Errors, errors_of
from tests.verification.transient_cases import PLAIN, SPEED

LABELS = {"area": "error of the contact fraction [-]", "friction": "relative error of friction [-]"}


@styled
def convergence_figure(errors: dict[str, Errors]) -> Figure:
    """Draw rms errors against columns, with their rates."""
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    for panel, (quantity, label) in zip(axes[0], LABELS.items(), strict=True):
        for (name, found), colour in zip(errors.items(), (BLUE, GREEN, ORANGE), strict=True):
            if values := getattr(found, quantity):
                text = f"{name}, rate {found.rate(quantity):.1f}"
                panel.plot(found.columns, values, color=colour, marker="o", label=text)
        panel.set(xscale="log", yscale="log", xlabel="columns (rows = columns / 8)", ylabel=label)
        panel.set_xticks(COLUMNS, [str(number) for number in COLUMNS])
        panel.minorticks_off()
        low, high = panel.get_ylim()
        slope = [0.55 * high * (COLUMNS[0] / number) ** 2 for number in COLUMNS]
        panel.plot(COLUMNS, slope, color=GREY, ls=":", lw=1.0, label="slope 2")
        panel.set_ylim(min(low, slope[-1]), high)
        panel.legend()
    return figure


def start_stop_return() -> tuple[gs.TransientResult, gs.ScaleResult]:
    """Return a start, a stop, a start and a reversal in time, and the steady state."""
    mesh = {"columns": 96, "rows": 14}
    programme = ((1.5, SPEED), (0.3, 0.0), (1.0, SPEED), (1.5, -SPEED))
    stages = [PLAIN.stage(passages, speed) for passages, speed in programme]
    return PLAIN.run(*stages, **mesh), PLAIN.steady(**mesh)


@styled
def transient_figure(moving: gs.TransientResult, steady: gs.ScaleResult) -> Figure:
    """Draw friction and contact fraction against the sliding distance, forth and back."""
    figure, axes = sheet(WIDE, 3.1, 1, 2, gap=0.06)
    distance = moving.distance / moving.wavelength
    back = moving.speed < 0.0
    turn = int(np.argmax(back)) - 1
    for panel, values, levels in (
        (axes[0][0], moving.friction, [steady.friction, -steady.friction]),
        (axes[0][1], moving.contact_fraction, [steady.contact_fraction]),
    ):
        for place, level in enumerate(levels):
            label = "steady state" if place == 0 else None
            panel.axhline(level, color=GREY, ls=":", lw=1.2, label=label)
        panel.plot(distance[~back], values[~back], color=BLUE, label="forth, with a stop at 1.5")
        panel.plot(distance[turn:], values[turn:], color=GREEN, label="back")
        panel.set_xlabel("sliding distance over wavelength [-]")
    axes[0][0].set_ylabel("friction coefficient [-]")
    axes[0][1].set_ylabel("contact fraction [-]")
    axes[0][0].legend(loc=(0.02, 0.2))
    return figure


def main(folder: str) -> None:
    """Draw both into `folder`, as PNG only."""
    errors = {name: errors_of(name) for name in FAMILIES}
    figures = {
        "convergence": convergence_figure(errors),
        "transient": transient_figure(*start_stop_return()),
    }
    for name, figure in figures.items():
        _, pdf = save_figure(figure, Path(folder), name)
        pdf.unlink()


if __name__ == "__main__":
    main(*sys.argv[1:])
