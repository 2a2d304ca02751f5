"""A question of your own: the mean pressure where rubber really touches the road.

A function of a case returns a `Result`; its command: `python examples/toy_question.py CASE.toml`.
"""

from collections.abc import Iterator

import typer
import xarray as xr

import gripscale as gs
from gripscale.charts.chart import Panel, PlotAxis, Series
from gripscale.charts.draw import Picture, Sheet
from gripscale.io.table import Column, Table
from gripscale.questions import terminal
from gripscale.questions.registry import QUESTIONS
from gripscale.questions.result import Result

KINDS = {"contact_pressure": ":ContactPressure"}
QUESTIONS.append(__name__)


class ContactPressure(Result):
    """Mean pressure on the real contact area, with its interval; saved, `gs.load` gives it back."""

    kind = "contact_pressure"

    @property
    def lines(self) -> tuple[str, ...]:
        p, low, high = self.data.pressure.values / 1e6
        return (f"Answer: p = {p:.3g} MPa ({low:.3g} to {high:.3g}) in the contact",)

    def table(self) -> Table:
        return Table("pressure", [Column("pressure", self.data.pressure.values, "p", "MPa", 1e6)])

    def pictures(self) -> Iterator[Picture]:
        p, low, high = self.data.pressure.values[:, None] / 1e6
        point = Series([0.0], p, marker="o", low=low, high=high)
        figure = Sheet([Panel(PlotAxis(), PlotAxis("pressure [MPa]"), [point])]).on_paper()
        yield Picture("pressure", figure, "Pressure in the contact", "A point with its interval")


def contact_pressure(case: gs.Case) -> ContactPressure:
    """Return the mean pressure on the real contact area of a case."""
    answer = gs.answer(case)
    areas = answer.contact_fraction, *reversed(answer.contact_fraction_interval)
    pressure = "end", [case.load.pressure / area for area in areas]
    return ContactPressure(xr.Dataset({"pressure": pressure}, attrs=case.attributes), answer.inputs)


@terminal.case_command
def command(case: terminal.CasePath, output: terminal.OwnFolder = None) -> None:
    """Print, save and draw the mean pressure on the real contact area of a case."""
    work = terminal.CaseCommand(case)
    work.open_results(output, "contact_pressure")
    work.finish(contact_pressure(work.case), "figure")


if __name__ == "__main__":
    typer.run(command)
