"""What every question returns: a labelled Dataset that prints, draws, reports and saves itself.

    result = gs.answer(case)
    result.save("answer.nc")
    gs.load("answer.nc").page("answer.html")

The attribute `kind` of a file tells its question.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, ClassVar

import xarray as xr

from gripscale.core import Finding, InputError, Severity
from gripscale.core.described import Described, with_figure
from gripscale.io import netcdf
from gripscale.io.table import Table, as_text
from gripscale.questions.answer.variables import described
from gripscale.questions.inputs.record import InputRecord, input_findings
from gripscale.report.elements import case_title, rerun_section

if TYPE_CHECKING:
    import pandas as pd
    from matplotlib.figure import Figure

    from gripscale.charts.draw import Picture, Sheet
    from gripscale.report.elements import Card, Element, Page, Section

NO_WIDTHS: Mapping[str, float] = MappingProxyType({})
KIND = "kind"  # attribute of a saved result: the question it answers
INPUT_GROUP = "inputs"  # group of a saved result: the record of the inputs of its case
_WIDTH = 100  # characters of a line of a printed result


class Result(Described, ABC):
    """The result of a question about a case.

    Parameters
    ----------
    data : xarray.Dataset
        Numbers of the result, with the attributes of its case.
    inputs : xarray.Dataset, optional
        Record of the inputs of the case, which pages and findings show.
    """

    kind: ClassVar[str]
    """Word for the question."""

    @property
    def file(self) -> str:
        """Name of the result in a results folder."""
        return f"{self.kind}.nc"

    @property
    def failure(self) -> str:
        """What has no result, in a sentence; empty if everything asked for has one."""
        return ""

    def __init__(self, data: xr.Dataset, inputs: xr.Dataset | None = None) -> None:
        self.data = described(data).assign_attrs({KIND: self.kind})
        self.inputs = xr.Dataset() if inputs is None else inputs

    @property
    @abstractmethod
    def lines(self) -> Sequence[str]:
        """The answer in words: what to believe, then what it rests on."""

    @property
    def findings(self) -> Sequence[Finding]:
        """What may change the result, the most important first; at least what its inputs tell."""
        return tuple(input_findings(InputRecord(self.inputs)))

    @property
    def half_widths(self) -> Mapping[str, float]:
        """Relative half widths of `friction` and `area`, where the result has an interval [-]."""
        return NO_WIDTHS

    def parts(self) -> Iterator[str | Table]:
        """Yield tables and sentences that stand below the answer."""
        yield from ()

    @abstractmethod
    def table(self) -> Table:
        """Return the numbers of the result as one table."""

    def pictures(self) -> Iterator[Picture]:
        """Yield the figures that show the result, the most telling first, with their captions."""
        yield from ()

    def figures(self) -> Iterator[tuple[str, Sheet | Figure]]:
        """Yield the figures that show the result, with their names, the most telling first."""
        yield from ((picture.name, picture.figure) for picture in self.pictures())

    def plot(self) -> Figure:
        """Draw the figure that shows the result (matplotlib).

        Raises `InputError` if there is nothing to draw.
        """
        from gripscale.charts.draw import Sheet

        _, figure = next(self.figures(), ("", None))
        if figure is None:
            raise InputError(
                f"the {self.kind} has no figure: {next(iter(self.lines), 'no result')}"
            )
        return figure.on_paper() if isinstance(figure, Sheet) else figure

    def page(self, path: str | Path) -> Path:
        """Write the result as one HTML page that needs no network, and return its path.

        Raises `InputError` without the extra `gripscale[report]`, `FileError` if the page cannot be
        written.
        """
        from gripscale.report import write_page

        return write_page(self.page_content, path)

    @property
    def title(self) -> str:
        """What its page is called."""
        return f"{self.data.attrs.get('title', self.kind)}: {case_title(self.data.attrs)}"

    def cards(self) -> Iterator[Card]:
        """Yield the numbers at the head of its page."""
        yield from ()

    def chapters(self) -> Iterator[Section]:
        """Yield what stands on the page below figures and tables."""
        yield from ()

    def elements(self) -> list[Element]:
        """Return figures and tables as they stand on a page."""
        from gripscale.charts.draw import image
        from gripscale.report.elements import as_elements

        return [*map(image, self.pictures()), *as_elements(self.parts())]

    def page_content(self) -> Page:
        """Return the page: answer, numbers, figures and tables, then how to run it again."""
        from gripscale.report.elements import Page, Section

        lead, *basis = (line.strip() for line in self.lines)
        failed = [Finding(Severity.ERROR, self.failure)] if self.failure else []
        sections = [
            Section("results", "Results", self.elements()),
            *self.chapters(),
            rerun_section(self.data.attrs),
        ]
        findings = [*failed, *self.findings]
        return Page.of(self.title, lead, findings, self.cards(), sections, basis)

    def save(self, path: str | Path) -> Path:
        """Write the result with the record of its inputs to a netCDF file; return its path.

        Raises `FileError` if it cannot be written.
        """
        groups = {INPUT_GROUP: self.inputs} if self.inputs.variables or self.inputs.attrs else {}
        return netcdf.save(self.data, path, groups)

    def to_dataset(self) -> xr.Dataset:
        """Return the numbers as a labelled Dataset."""
        return self.data

    def to_dataframe(self) -> pd.DataFrame:
        """Return the table as a pandas DataFrame, in SI units."""
        import pandas as pd

        return pd.DataFrame({column.name: list(column.values) for column in self.table().columns})

    def text(self, width: int = _WIDTH) -> str:
        """Return the answer, the findings and the tables as text with lines of a width."""
        above = [*self.lines, *warning_lines(self.findings, widths=self.half_widths)]
        below = list(self.parts())
        return as_text(*above, *(["", *below] if below else []), width=width)

    def __str__(self) -> str:
        return self.text()

    def shown_rows(self) -> Iterator[tuple[str, str]]:
        """Yield the lines of the answer."""
        yield from (("", line.strip()) for line in self.lines)

    def _repr_html_(self) -> str:
        lead, *basis = [escape(line.strip()) for line in self.lines]
        rest = "".join(f"<li>{line}</li>" for line in basis)
        findings = "".join(f"<li>{escape(finding.sentence)}</li>" for finding in self.findings)
        folded = f"<details><summary>What may change it</summary><ul>{findings}</ul></details>"
        text = f"<p><b>{lead}</b></p><ul>{rest}</ul>{folded if findings else ''}"
        return with_figure(text, self)


_MOST_OPEN = 5  # findings that a result opens with


def warning_lines(
    findings: Sequence[Finding], rest: str = "`findings`", widths: Mapping[str, float] = NO_WIDTHS
) -> Iterator[str]:
    """Yield the ranked findings that stand open as lines; `rest` has them all.

    These are the first `_MOST_OPEN` of those that may change a number of the result by more than
    its half width in `widths`, which are relative.
    """
    counting = [finding for finding in findings if finding.exceeds(widths)][:_MOST_OPEN]
    if counting:
        yield "Warnings, by what they change:"
    yield from (f"  {finding.sentence}" for finding in counting)
    more = len(findings) - len(counting)
    if more:
        lead = "  ... and" if counting else "Warnings within the interval:"
        yield f"{lead} {more}{' more' if counting else ''} in {rest}"
