"""What lies below the measurement: friction and contact area against the cut-off.

result = gs.cut_off(case, down_to="10 um")
result.data.curve_friction_from_dissipation
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import xarray as xr

from gripscale.case import Case, in_si
from gripscale.core import provenance
from gripscale.core.finding import Finding
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Table
from gripscale.questions.answer.findings import case_notices
from gripscale.questions.cut_off import page
from gripscale.questions.cut_off.charts import cut_off_sheet
from gripscale.questions.cut_off.curve import cut_off_curve
from gripscale.questions.inputs import record
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.result import Result
from gripscale.report.elements import Page

if TYPE_CHECKING:
    from gripscale.charts.draw import Sheet


class CutOff(Result):
    """Friction and contact area of a case against the cut-off."""

    kind = "cut_off"

    @property
    def lines(self) -> Sequence[str]:
        """Friction and contact at the last cut-off, and how the roughness is continued."""
        return tuple(page.cut_off_lines(self.data))

    @property
    def findings(self) -> Sequence[Finding]:
        """What may change the curves, the most important first."""
        return tuple(case_notices(None, InputRecord(self.inputs)))

    @property
    def failure(self) -> str:
        """Why there is no curve; empty if there is one."""
        return " ".join(map(str, page.cut_off_failures(self.data)))

    def parts(self) -> Iterator[str | Table]:
        """Yield the rules of cut-off, and friction and contact by octave."""
        yield from page.cut_off_parts(self.data)

    def table(self) -> Table:
        """Return friction and contact by octave of the cut-off."""
        return page.curve_table(self.data)

    def figures(self) -> Iterator[tuple[str, Sheet]]:
        """Yield friction, contact area and slope in contact over the cut-off."""
        if not self.failure:
            yield "cut_off", cut_off_sheet(self.data)

    def page_content(self) -> Page:
        """Return curves, rules and tables."""
        return page.cut_off_page(self.data, self.findings)


def cut_off(
    case: Case,
    *,
    down_to: float | str | None = None,
    hurst: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    on_task: OnTask | None = None,
) -> CutOff:
    """Return contact and friction of a case against the cut-off.

    Parameters
    ----------
    case : Case
        Its surface must be measured profiles.
    down_to : float or str, optional
        Last cut-off [m], or a text such as "10 um"; that of the case by default, else 10 um.
    hurst : float, optional
        Hurst exponent of the continued roughness [-], in place of what the case states.
    folder : path, optional
        Keeps the solution as soon as it is there: what was interrupted resumes.
    workers, on_task
        As for `gripscale.experiment.Bench`.

    Returns
    -------
    CutOff
        Over `cut_off`: the curves of `gripscale.continuation.contact_by_cut_off` with the prefix
        `curve_`. Over `rule`: the cut-off that each rule gives, with friction and contact there.
        The totals are those of the last cut-off.

    Raises
    ------
    InputError, FileError
        For what cannot be used; if nothing was measured.
    """
    end = None if down_to is None else in_si("down_to", down_to, "length")
    with bench_in(folder, workers, None, on_task) as bench:
        data = cut_off_curve(case, case.load, bench, down_to=end, hurst=hurst)
    return cut_off_result(data, case)


def cut_off_result(data: xr.Dataset, case: Case) -> CutOff:
    """Return the curves of a case as the result of the question."""
    attrs = {
        "title": "Contact and friction against the cut-off",
        "case_file": case.origin.name,
        **provenance.version_attributes(),
    }
    return CutOff(data.assign_attrs(case.attributes, **attrs), record.inputs(case))
