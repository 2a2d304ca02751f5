"""The figures of docs/verification.md: `python -m tests.verification.draw docs/figures`."""

import sys
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import gripscale as gs
from gripscale.charts.chart import CrossLine, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.paper import save_figure
from gripscale.charts.style import BLUE, GREEN, GREY, ORANGE
from tests.verification.test_convergence import COLUMNS, FAMILIES, Errors, errors_of
from tests.verification.transient_cases import PLAIN, SPEED

LABELS = {"area": "error of the contact fraction [-]", "friction": "relative error of friction [-]"}


def convergence_figure(errors: dict[str, Errors]) -> Figure:
    """Draw rms errors against columns, with their rates."""
    ticks = {float(number): str(number) for number in COLUMNS}
    panels = []
    for quantity, label in LABELS.items():
        marks: list[Mark] = []
        highest = 0.0
        for (name, error), colour in zip(errors.items(), (BLUE, GREEN, ORANGE), strict=True):
            if values := getattr(error, quantity):
                text = f"{name}, rate {error.rate(quantity):.1f}"
                marks.append(Series(error.columns, values, colour, text, marker="o"))
                highest = max(highest, *values)
        slope = [0.55 * highest * (COLUMNS[0] / number) ** 2 for number in COLUMNS]
        marks.append(Series(COLUMNS, slope, GREY, "slope 2", "dotted", 1.0))
        columns = PlotAxis("columns (rows = columns / 8)", log=True, ticks=ticks)
        panels.append(Panel(columns, PlotAxis(label, log=True), marks, legend="best"))
    return Sheet(panels, legend="").on_paper()


def start_stop_return() -> tuple[gs.TransientResult, gs.ScaleResult]:
    """Return a start, a stop, a start and a reversal in time, and the steady state."""
    mesh = {"columns": 96, "rows": 14}
    programme = ((1.5, SPEED), (0.3, 0.0), (1.0, SPEED), (1.5, -SPEED))
    stages = [PLAIN.stage(passages, speed) for passages, speed in programme]
    return PLAIN.run(*stages, **mesh), PLAIN.steady(**mesh)


def transient_figure(moving: gs.TransientResult, steady: gs.ScaleResult) -> Figure:
    """Draw friction and contact fraction against the sliding distance, forth and back."""
    distance = moving.distance / moving.wavelength
    back = moving.speed < 0.0
    turn = int(np.argmax(back)) - 1
    panels = []
    for label, values, levels in (
        ("friction coefficient [-]", moving.friction, [steady.friction, -steady.friction]),
        ("contact fraction [-]", moving.contact_fraction, [steady.contact_fraction]),
    ):
        marks: list[Mark] = [CrossLine(at, GREY, "steady state", "dotted", 1.2) for at in levels]
        marks += [
            Series(distance[~back], values[~back], BLUE, "forth, with a stop at 1.5"),
            Series(distance[turn:], values[turn:], GREEN, "back"),
        ]
        panels.append(
            Panel(PlotAxis("sliding distance over wavelength [-]"), PlotAxis(label), marks)
        )
    return Sheet(panels).on_paper()


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
