"""What is the answer: friction and contact area of a case, with their 90 % intervals.

    answer = gs.answer(case)
    answer.friction, answer.friction_interval

Known factors lead from direct contact to finite strain and from lines to a surface (`estimate`).
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Sheet
from gripscale.core.finding import Finding, to_json
from gripscale.experiment.measured_friction import friction_doubts
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import PREDICTIONS, Store
from gripscale.io.table import Table
from gripscale.questions.answer import direct_contact, variables
from gripscale.questions.answer.charts import named_traces, trace_sheet
from gripscale.questions.answer.estimate import answer_of_waves
from gripscale.questions.answer.findings import FINDINGS, case_notices, measured_at_load
from gripscale.questions.answer.page import answer_lines, answer_page, basis_lines
from gripscale.questions.answer.reliance import is_measured, no_answer
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.chain.charts import contact_sheet
from gripscale.questions.chain.view import PredictionView
from gripscale.questions.cut_off.question import cut_off_sheet
from gripscale.questions.inputs import record
from gripscale.questions.inputs.record import InputRecord
from gripscale.questions.result import NO_WIDTHS, Result
from gripscale.report.elements import Page
from gripscale.report.failures import explained, failures_in

# Names of the saved answer in a results folder, and of what is beside it.
ANSWER_FILE, CHAIN_FILE, CURVE_FILE = "answer.nc", "chain.nc", "cut_off.nc"
# Names until the next version, with a warning.
_OLD_NAMES = {
    "adhesive_friction": "interface_friction",
    "total_friction": "friction",
    "total_friction_interval": "friction_interval",
}


class NumbersWithIntervals(Result):
    """Friction and contact area of a case with their intervals, whatever these hold."""

    @property
    def friction(self) -> float:
        """Friction coefficient [-] that `print` states; NaN without an answer or at rest.

        That of the hysteresis, and of the interface where a case has one.
        """
        return variables.answer_number(self.data, "friction").value

    @property
    def friction_interval(self) -> tuple[float, float]:
        """Both ends of the 90 % interval of the friction [-]; NaN where it is not known."""
        return variables.answer_number(self.data, "friction")[1:]

    @property
    def hysteresis_friction(self) -> float:
        """Its part by the hysteresis [-]."""
        name = variables.of_hysteresis(self.data, "friction")
        return variables.answer_number(self.data, name).value

    @property
    def interface_friction(self) -> float:
        """Its part by the interface, over `contact_fraction` [-]; NaN without one."""
        return variables.answer_number(self.data, "interface_friction").value

    def __getattr__(self, name: str) -> Any:
        if name not in _OLD_NAMES:
            raise AttributeError(f"{type(self).__name__} has no attribute {name}")
        new = _OLD_NAMES[name]
        warnings.warn(f"{name} is called {new} now", DeprecationWarning, stacklevel=2)
        return getattr(self, new)

    @property
    def contact_fraction(self) -> float:
        """Real over nominal contact area [-]; NaN without an answer."""
        return variables.answer_number(self.data, "contact_fraction").value

    @property
    def contact_fraction_interval(self) -> tuple[float, float]:
        """Both ends of the 90 % interval of the contact fraction [-]; NaN where it is not known."""
        return variables.answer_number(self.data, "contact_fraction")[1:]


class Answer(NumbersWithIntervals):
    """Friction and contact area of a case, with their intervals and what they rest on."""

    kind = "answer"
    curve: xr.Dataset | None = None
    """Contact against the cut-off, where the case continues its roughness below the measurement."""
    chain: xr.Dataset | None = None
    """Chain of waves of the case: the answer of sine waves, else for comparison if it is solved."""

    @property
    def failure(self) -> str:
        """Why waves stated by hand have no answer."""
        if variables.has_answer(self.data) or is_measured(self.data):
            return ""
        return next(map(explained, failures_in(self.data)), "")

    @property
    def reliable(self) -> bool:
        """Whether there is an answer to rely on (`gripscale.questions.answer.reliance`).

        None of sine waves, which no measured surface judges.
        """
        return is_measured(self.data) and not no_answer(self.data)

    @property
    def status(self) -> str:
        """How the direct contact, or the chain of sine waves, ended: "converged", or why not."""
        return str(self.data["prediction_status"].item())

    @property
    def half_widths(self) -> Mapping[str, float]:
        if not self.reliable:
            return NO_WIDTHS
        names = {"friction": "friction", "area": "contact_fraction"}
        widths = {key: self.data[f"answer_{name}_half_width"] for key, name in names.items()}
        return {key: float(width) for key, width in widths.items() if math.isfinite(width)}

    @property
    def basis(self) -> Sequence[str]:
        """What the numbers are for, the factors they are made of, and what they rest on."""
        return tuple(basis_lines(self.data))

    @property
    def lines(self) -> Sequence[str]:
        return tuple(answer_lines(self.data))

    @cached_property
    def findings(self) -> Sequence[Finding]:
        return tuple(case_notices(self.data, InputRecord(self.inputs)))

    def table(self) -> Table:
        """Return friction, contact area and all that qualifies them as one row."""
        from gripscale.questions.result_json import summary_table

        return summary_table(self.data)

    def figures(self) -> Iterator[tuple[str, Sheet]]:
        for name, trace in named_traces(self.data, self.inputs)[:1]:
            yield "direct_contact", trace_sheet(trace, name)
        if self.chain is not None:
            title = PredictionView(self.chain).title.lower()
            judge = {}
            if is_measured(self.data):
                title, judge = f"{variables.OF_THE_PAPER}, {title}", {variables.JUDGE: self.data}
            yield "contact_and_friction", contact_sheet({title: self.chain} | judge)
        if self.curve is not None:
            yield "cut_off", cut_off_sheet(self.curve)

    def page_content(self) -> Page:
        inputs = InputRecord(self.inputs)
        return answer_page(self.data, inputs, self.findings, self.curve, self.chain)


def answer(case: Case, *, folder: str | Path | None = None) -> Answer:
    """Return friction and contact area of a case, with their 90 % intervals, as `gripscale run`.

    Raises `InputError` if the direct contact cannot use the rubber or a profile, or the roughness
    below the measurement has no result.

        >>> f"{gs.answer(case).friction:.3f}"
        '0.036'

    Parameters
    ----------
    case : Case
        Its surface must be measured for an answer with an interval; of sine waves it is that of
        their chain, and `Answer.reliable` is False.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    """
    return answer_by(bench_of(folder), case, folder)


def answer_by(bench: Bench, case: Case, folder: str | Path | None = None) -> Answer:
    """Return the answer of a case whose predictions a bench solves; see `answer`."""
    load = case.load
    samples = direct_contact.solve_direct_contact(case, bench)
    if samples is None:
        chain = solved_chain(case, bench)
        data = answer_of_waves(sample_numbers(chain, case.task()), case, load)
        result = answer_with_inputs(case, data)
        result.chain = chain
        return result
    curve = direct_contact.continued_curve(case, load, folder)
    data = direct_contact.direct_contact_totals(samples, case, load, curve)
    if case.softening_doubts:
        filled = case.replace(filled=True)
        of_filled = direct_contact.solve_direct_contact(filled, bench)
        assert of_filled is not None  # of the same surface
        continued = direct_contact.continued_curve(filled, load, folder)
        totals = direct_contact.direct_contact_totals(of_filled, filled, load, continued)
        data = variables.with_filled(data, totals)
    data.attrs[FINDINGS] = to_json(direct_contact.other_findings(samples, data, case))
    result = answer_with_inputs(case, data)
    result.curve = curve
    return result


def bench_of(folder: str | Path | None) -> Bench:
    """Return a bench that keeps its predictions in the folder of a result, if there is one."""
    return Bench(None if folder is None else Store(Path(folder) / PREDICTIONS))


def solved_chain(case: Case, bench: Bench) -> xr.Dataset:
    """Return the chain of waves of a case, with the deformed blocks; a failed wave ends it."""
    (predicted,) = bench.solve({variables.OF_THE_PAPER: case.task()}).values()
    sources = {"surface_source": case.surface.source, "rubber_source": case.measured_rubber.source}
    return predicted.assign_attrs(case.attributes | sources)


def answer_with_inputs(case: Case, data: xr.Dataset) -> Answer:
    """Return the numbers of an answer with the record of the inputs, and measured friction."""
    inputs = record.inputs(case, further=friction_doubts(case.friction, case.load.speed))
    return Answer(data.assign(measured_at_load(case, case.friction)), inputs)
