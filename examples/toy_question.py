"""A question of your own: how large is the mean pressure where rubber really touches the road.

A question is a function of a case that returns a `Result`. The class says what the result holds in
words, as a table and on its page; `gs.load` gives a saved one back once the room is registered. A
question of the package is a package with the same parts, and its line in `QUESTIONS`. Run as
`python examples/toy_question.py [FOLDER]`.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

import gripscale as gs
from gripscale.case_file import read_case
from gripscale.core.finding import Finding
from gripscale.io.table import Column, Table
from gripscale.questions.registry import QUESTIONS
from gripscale.questions.result import Result
from gripscale.report.elements import Card, Page, Section

CASE = Path(__file__).parent / "road_and_tread" / "case.toml"
KINDS = {"contact_pressure": ":ContactPressure"}


class ContactPressure(Result):
    """Mean pressure on the real contact area, with its interval."""

    kind = "contact_pressure"

    @property
    def pressure(self) -> float:
        """Mean pressure on the real contact area [Pa]."""
        return float(self.data.pressure)

    @property
    def lines(self) -> Sequence[str]:
        """The pressure with its interval, and the nominal one."""
        low, high = (float(end) / 1e6 for end in self.data.interval)
        nominal = float(self.data.nominal_pressure) / 1e6
        return (
            f"Answer: p = {self.pressure / 1e6:.3g} MPa ({low:.3g} to {high:.3g}) in the contact",
            f"  for a nominal pressure of {nominal:g} MPa",
        )

    @property
    def findings(self) -> Sequence[Finding]:
        """Nothing of its own: those of the answer hold."""
        return ()

    def table(self) -> Table:
        """Return the pressure as a table of one row."""
        return Table("pressure", [Column("pressure", [self.pressure], "p", "MPa", 1e6)])

    def page_content(self) -> Page:
        """Return the pressure as a page."""
        card = Card("Pressure in the contact", f"{self.pressure / 1e6:.3g} MPa", self.lines[1])
        table = Section("pressure", "Pressure", [self.table()])
        return Page("Pressure in the contact", "", self.findings, [card], [table])


QUESTIONS.append(__name__)


def contact_pressure(case: gs.Case) -> ContactPressure:
    """Return the mean pressure on the real contact area of a case."""
    answer = gs.answer(case)
    area = np.array([answer.contact_fraction, *answer.contact_fraction_interval])
    pressure, high, low = case.load.pressure / area
    numbers = {"pressure": pressure, "nominal_pressure": case.load.pressure}
    return ContactPressure(xr.Dataset({**numbers, "interval": ("end", [low, high])}))


def main(folder: str = "results/examples") -> None:
    """Ask it of the shipped road, save the result, and load it again."""
    result = contact_pressure(read_case(CASE))
    print(result)
    path = Path(folder) / result.file
    path.parent.mkdir(parents=True, exist_ok=True)
    print("Loaded:", repr(gs.load(result.save(path))))


if __name__ == "__main__":
    main(*sys.argv[1:2])
