"""Surfaces under one rubber, or compounds on one surface, side by side: their results."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, ClassVar

from gripscale.charts.page_elements import Picture
from gripscale.core.finding import Finding
from gripscale.io.table import Table
from gripscale.questions.inputs.page import rubbers_of
from gripscale.questions.result import Result
from gripscale.questions.vary import page, page_side_by_side
from gripscale.questions.vary.inputs import READING_NOTES
from gripscale.report.elements import Page
from gripscale.report.failures import first_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gripscale.rubber import Rubber


class SideBySide(Result):
    """Answers of several roads or compounds, ranked by their friction."""

    dim: ClassVar[str]  # dimension of what stands side by side

    @property
    def notes(self) -> Sequence[str]:
        """How inputs were read, and what was not measured."""
        return tuple(str(self.data.attrs.get(READING_NOTES, "")).splitlines())

    @property
    def lines(self) -> Sequence[str]:
        """The ranking by friction, with the confidence of each step and its causes."""
        return tuple(page_side_by_side.ranking_lines(self.data, self.dim))

    @property
    def findings(self) -> Sequence[Finding]:
        """What has no answer, and extrapolation of the rubber."""
        return tuple(page.study_findings(self.data))

    @property
    def failure(self) -> str:
        """What has no answer; empty if everything has."""
        failed, total = page.failed_predictions(self.data)
        return first_of(failed, total, f"{page_side_by_side.noun(self.data, self.dim)}s")

    def parts(self) -> Iterator[str | Table]:
        """Yield the ranking, the texture of surfaces, and notes."""
        yield from page_side_by_side.side_by_side_tables(self.data, self.dim)
        yield from (f"note: {note}" for note in self.notes)

    def table(self) -> Table:
        """Return the answers by rank."""
        return page_side_by_side.ranking_table(self.data, self.dim)

    @abstractmethod
    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength, and statistics of surfaces or moduli of compounds."""

    def figures(self) -> Iterator[tuple[str, Figure]]:
        """Yield the pictures, with their names."""
        for picture in self.pictures():
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        """Return the ranking, its figures, and the inputs."""
        pictures = list(self.pictures())
        return page_side_by_side.side_by_side_page(self.data, self.dim, self.findings, pictures)


class Surfaces(SideBySide):
    """Several surfaces under the rubber and the load of a case."""

    kind = "surfaces"
    file = "surfaces.nc"
    dim = "surface"

    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength, and correlation and spectrum."""
        from gripscale.questions.vary.charts_side_by_side import road_pictures

        yield from road_pictures(self.data)


class Compounds(SideBySide):
    """Several compounds on the surface and under the load of a case."""

    kind = "compounds"
    file = "compounds.nc"
    dim = "rubber"

    @property
    def rubbers(self) -> dict[str, Rubber]:
        """The compounds as they were solved, at one temperature; without strain energy."""
        names = [str(name) for name in self.data.rubber.values]
        rubbers = rubbers_of(self.data)
        return dict(zip(names, rubbers, strict=True)) if len(rubbers) == len(names) else {}

    def pictures(self) -> Iterator[Picture]:
        """Yield friction by wavelength and relaxation time, and the moduli."""
        from gripscale.questions.vary.charts_side_by_side import compound_pictures

        yield from compound_pictures(self.data, self.rubbers)
