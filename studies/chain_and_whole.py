"""`python -m studies.chain_and_whole`: the chain beside the direct contact of whole surfaces.

Prints each line of the table as it is solved, and draws both models in the plane of contact
fraction and friction. A minute of one core.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

from gripscale.charts.chart import Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.paper import save_figure
from gripscale.charts.style import COLOURS, GREY
from gripscale.reproduction.inputs import read_inputs
from studies.whole_surfaces import Cases, Found, solved


def main() -> None:
    """Solve all cases; print them and save the figure."""
    parser = argparse.ArgumentParser(description="The chain beside whole surfaces.")
    parser.add_argument(
        "--figures", type=Path, default=Path("docs/figures"), help="folder of the figure"
    )
    folder = parser.parse_args().figures
    print("| surface | prototype: chain; direct | chain | direct |\n|---|---|---|---|")
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for case in Cases(read_inputs()).small_strain():
        found.append(solved(case))
        print("| " + " | ".join(found[-1].cells()) + " |", flush=True)
        save_figure(chain_and_whole_figure(found), folder, "chain_and_whole", ["png"])


def chain_and_whole_figure(found: Sequence[Found]) -> Figure:
    """Draw every solution; a line leads from the chain to the direct contact of its surface."""
    marks: list[Mark] = []
    for number, solution in enumerate(found):
        colour = COLOURS[number % len(COLOURS)]
        marker = "o" if number < len(COLOURS) else "^"
        area, friction = solution.direct.T
        surface = solution.case.surface
        marks.append(Series(area, friction, colour, surface, "", marker=marker, size=4.0))
        if solution.chain is not None:
            x, y = solution.chain
            marks += [
                Series([x], [y], colour, dash="", marker="s", size=5.0, filled=False),
                Series([x, area.mean()], [y, friction.mean()], GREY, width=0.6),
            ]
    panel = Panel(
        PlotAxis("contact fraction [-]"), PlotAxis("friction coefficient [-]", log=True), marks
    )
    sheet = Sheet([panel], 1, height=3.6, legend="beside", gap=0.02)
    return replace(sheet, legend_title="open squares: the chain").on_paper()


if __name__ == "__main__":
    main()
