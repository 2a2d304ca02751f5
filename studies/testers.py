"""The shipped road and tread under the loads of testers of skid resistance.

Run as `python -m studies.testers [FOLDER]`.
"""

from __future__ import annotations

import sys
from pathlib import Path

import gripscale as gs
from gripscale.charts.chart import Bars, Mark, Panel, PlotAxis, Series
from gripscale.charts.draw import Sheet
from gripscale.charts.paper import save_figure
from gripscale.charts.style import BLUE, INK
from gripscale.testers import TESTERS

ROOT = Path(__file__).parents[1]
CASE = ROOT / "examples" / "road_and_tread" / "case.toml"
FIGURES = ROOT / "docs" / "figures"


def main(folder: Path = FIGURES) -> None:
    """Answer the shipped case under each load, print and draw the frictions."""
    shipped = gs.read_case(CASE)
    points: list[Mark] = []
    for row, name in enumerate(TESTERS):
        case = gs.Case(shipped.surface, shipped.measured_rubber, tester=name)
        answer = gs.answer(case)
        low, high = answer.friction_interval
        print("\n".join(answer.lines[:3]))
        points += [
            Bars(low, high, row - 0.2, row + 0.2, BLUE),
            Series([answer.friction], [row], INK, dash="", marker="o", size=5.0),
        ]
    titles = {float(row): tester.title for row, tester in enumerate(TESTERS.values())}
    axes = PlotAxis("friction $\\mu$ [-]", low=0.0), PlotAxis(ticks=titles, grid=False)
    sheet = Sheet([Panel(*axes, points)], 1, 6.0, 2.6)
    save_figure(sheet.on_paper(), folder, "testers", ["png"])


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
