"""What is the answer: friction and contact area of a case, with their 90 % intervals.

    answer = gs.answer(case)
    answer.friction, answer.friction_interval

The measured surface is pressed and slid as a whole; known factors lead to finite strain and from
lines to a surface (`gripscale.questions.answer.best_estimate`). `gripscale run` prints this object.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from pathlib import Path

import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Sheet
from gripscale.core import provenance
from gripscale.core.finding import Finding, to_json
from gripscale.experiment.measured_friction import friction_doubts
from gripscale.io.table import Table
from gripscale.questions.answer import direct_contact
from gripscale.questions.answer.charts import named_traces, trace_sheet
from gripscale.questions.answer.findings import FINDINGS, case_notices
from gripscale.questions.answer.page import answer_lines, answer_page, basis_lines
from gripscale.questions.answer.reliance import answer_interval, answer_number, is_solved, no_answer
from gripscale.questions.inputs import record
from gripscale.questions.inputs.page_record import InputRecord
from gripscale.questions.result import Result
from gripscale.report.elements import Page

ANSWER_FILE = "answer.nc"
"""Name of the saved answer in a results folder."""


class NumbersWithIntervals(Result):
    """Friction and contact area of a case with their intervals, whatever these hold."""

    @property
    def friction(self) -> float:
        """Friction coefficient of the hysteresis [-]; NaN without an answer or at rest."""
        return answer_number(self.data, "friction")

    @property
    def friction_interval(self) -> tuple[float, float]:
        """Both ends of the 90 % interval of the friction [-]; NaN where it is not known."""
        return answer_interval(self.data, "friction")

    @property
    def adhesive_friction(self) -> float:
        """Friction coefficient of the area term [-], over `contact_fraction`; NaN without one."""
        return answer_number(self.data, "adhesive_friction")

    @property
    def total_friction(self) -> float:
        """Sum of hysteresis and area term [-]; NaN without an area term."""
        return self.friction + self.adhesive_friction

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area [-]; NaN without an answer."""
        return answer_number(self.data, "contact_fraction")

    @property
    def contact_fraction_interval(self) -> tuple[float, float]:
        """Both ends of the 90 % interval of the contact fraction [-]; NaN where it is not known."""
        return answer_interval(self.data, "contact_fraction")


class Answer(NumbersWithIntervals):
    """Friction and contact area of a case, with their intervals and what they rest on."""

    kind = "answer"
    curve: xr.Dataset | None = None
    """Contact against the cut-off, where the case continues its roughness below the measurement."""

    @property
    def reliable(self) -> bool:
        """Whether there is an answer to rely on (`gripscale.questions.answer.reliance`)."""
        return not no_answer(self.data)

    @property
    def status(self) -> str:
        """How the direct contact ended: "converged", or why it has no result."""
        return str(self.data["prediction_status"].item()) if self.is_solved else "not solved"

    @property
    def is_solved(self) -> bool:
        """Whether a measured surface was solved; there is none of sine waves."""
        return is_solved(self.data)

    @property
    def basis(self) -> Sequence[str]:
        """What the numbers are for, the factors they are made of, and what they rest on."""
        return tuple(basis_lines(self.data))

    @property
    def lines(self) -> Sequence[str]:
        return tuple(answer_lines(self.data))

    @cached_property
    def findings(self) -> Sequence[Finding]:
        return tuple(case_notices(self.data if self.is_solved else None, InputRecord(self.inputs)))

    def table(self) -> Table:
        """Return friction, contact area and all that qualifies them as one row."""
        from gripscale.questions.summary_table import summary_table

        return summary_table([self.data])

    def figures(self) -> Iterator[tuple[str, Sheet]]:
        if self.is_solved:
            for name, trace in named_traces(self.data, self.inputs)[:1]:
                yield "direct_contact", trace_sheet(trace, name)

    def page_content(self) -> Page:
        return answer_page(self.data, InputRecord(self.inputs), self.findings)


def answer(case: Case, *, folder: str | Path | None = None) -> Answer:
    """Return friction and contact area of a case, with their 90 % intervals, as `gripscale run`.

    Raises `InputError` if the direct contact cannot use the rubber or a profile, or the roughness
    below the measurement has no result.

        >>> f"{gs.answer(case).friction:.3f}"
        '0.038'

    Parameters
    ----------
    case : Case
        Its surface must be measured for an answer with an interval; of sine waves
        `Answer.reliable` is False.
    folder : path, optional
        Keeps the solution of a roughness that is continued below the measurement.
    """
    inputs = record.inputs(case, further=friction_doubts(case.friction, case.load.speed))
    samples = direct_contact.solve_direct_contact(case)
    attrs = {"case_file": case.origin.name, **case.attributes, **provenance.version_attributes()}
    if samples is None:
        return Answer(xr.Dataset(attrs=attrs), inputs)
    curve = direct_contact.continued_curve(case, case.load, folder)
    data = direct_contact.direct_contact_totals(samples, case, case.load, curve)
    attrs[FINDINGS] = to_json(direct_contact.tread_findings(case, samples, data))
    result = Answer(data.assign_attrs(attrs), inputs)
    result.curve = curve
    return result
