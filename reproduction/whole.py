"""`python -m reproduction.whole`: the chain beside the direct contact of whole surfaces.

Prints each line of the table as it is solved, and draws both models in the plane of contact
fraction and friction. A minute of one core.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

from matplotlib.figure import Figure

from gripscale.charts.style import COLOURS, GREY, WIDE, sheet, styled, write_png
from reproduction.inputs import read_inputs
from reproduction.whole_surfaces import Cases, Found, solved


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
        write_png(chain_and_whole_figure(found), folder / "chain_and_whole.png")


@styled
def chain_and_whole_figure(found: Sequence[Found]) -> Figure:
    """Draw every solution; a line leads from the chain to the direct contact of its surface."""
    figure, panels = sheet(WIDE, 3.6, 1, 1)
    axes = panels[0, 0]
    for number, one in enumerate(found):
        colour = COLOURS[number % len(COLOURS)]
        area, friction = one.direct.T
        marker = "o" if number < len(COLOURS) else "^"
        axes.plot(area, friction, marker, color=colour, ms=4, ls="", label=one.case.surface)
        if one.chain is not None:
            axes.plot(*one.chain, "s", color=colour, ms=5, mfc="none")
            axes.plot(
                [one.chain[0], area.mean()], [one.chain[1], friction.mean()], color=GREY, lw=0.6
            )
    axes.set_xlabel("contact fraction [-]")
    axes.set_ylabel("friction coefficient [-]")
    axes.set_yscale("log")
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), title="open squares: the chain")
    return figure


if __name__ == "__main__":
    main()
