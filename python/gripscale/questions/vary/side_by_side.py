"""Roads under one rubber, or compounds on one road, side by side: their results."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, ClassVar

from gripscale.core.finding import Finding, Severity
from gripscale.io.table import Table
from gripscale.questions.inputs.page import rubbers_of
from gripscale.questions.result import Result
from gripscale.questions.vary import page_side_by_side
from gripscale.report.elements import Page
from gripscale.report.failures import explained, first_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber


class SideBySide(Result):
    """Friction and contact area of several roads or compounds, with ratios to the first."""

    dim: ClassVar[str]
    """Dimension of what stands side by side."""
    of: ClassVar[str]
    """What a failure counts."""

    @property
    def notes(self) -> Sequence[str]:
        """How inputs were read, and why one has no range or no direct contact."""
        return tuple(str(self.data.attrs.get("notes", "")).splitlines())

    @property
    def lines(self) -> Sequence[str]:
        """Friction of each over that of the first, with its interval."""
        return tuple(page_side_by_side.ratio_lines(self.data, self.dim))

    @property
    def findings(self) -> Sequence[Finding]:
        """What has no totals."""
        failed = page_side_by_side.failed_totals(self.data)
        return tuple(Finding(Severity.ERROR, explained(each)) for each in failed)

    @property
    def failure(self) -> str:
        """What has no totals; empty if everything has."""
        failed = page_side_by_side.failed_totals(self.data)
        return first_of(failed, self.data.prediction_status.size, self.of)


class Roads(SideBySide):
    """Several roads under the rubber and the load of a case."""

    kind = "roads"
    file = "surfaces.nc"
    dim = "surface"
    of = "predictions"

    def parts(self) -> Iterator[str | Table]:
        """Yield answers, totals of each model, texture, and where the differences are."""
        yield from page_side_by_side.roads_tables(self.data)
        yield from page_side_by_side.roads_sentences(self.data)
        yield from (f"note: {note}" for note in self.notes)

    def table(self) -> Table:
        """Return the answers of the roads, or their totals."""
        return page_side_by_side.roads_tables(self.data)[0]

    def figures(self) -> Iterator[tuple[str, Figure]]:
        """Yield friction and area of the roads, and their correlation and spectrum."""
        from gripscale.questions.vary.charts_side_by_side import road_pictures

        for picture in road_pictures(self.data):
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        """Return ratios, totals and statistics of the roads."""
        return page_side_by_side.roads_page(self.data, self.findings)


class Compounds(SideBySide):
    """Several compounds on the road and under the load of a case."""

    kind = "compounds"
    file = "compounds.nc"
    dim = "rubber"
    of = "compounds"

    @property
    def rubbers(self) -> dict[str, Rubber]:
        """The compounds as they were solved, at one temperature; without strain energy."""
        names = [str(name) for name in self.data.rubber.values]
        rubbers = rubbers_of(self.data)
        return dict(zip(names, rubbers, strict=True)) if len(rubbers) == len(names) else {}

    def parts(self) -> Iterator[str | Table]:
        """Yield answers, totals of the chain, and what makes the differences."""
        best = page_side_by_side.believed_table(self.data, self.dim, "compound")
        yield from filter(None, [best])
        yield page_side_by_side.compounds_table(self.data)
        yield from page_side_by_side.compounds_sentences(self.data)
        yield from (f"note: {note}" for note in self.notes)

    def table(self) -> Table:
        """Return the totals of the compounds."""
        return page_side_by_side.compounds_table(self.data)

    def figures(self) -> Iterator[tuple[str, Figure]]:
        """Yield friction and area of the compounds, and their moduli."""
        from gripscale.questions.vary.charts_side_by_side import compound_pictures

        for picture in compound_pictures(self.data, self.rubbers):
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        """Return ratios, totals, and what a study of the compounds has."""
        return page_side_by_side.compounds_page(self.data, self.rubbers)
