"""How the models compare: the answer beside the chain and the theories.

result = gs.compare(case, models=["waves", "measured"])
result.data.total_friction
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from gripscale.case import Case
from gripscale.charts.page_elements import Picture
from gripscale.core import InputError
from gripscale.core.finding import Finding, Severity, Topic, from_json, ranked, to_json
from gripscale.experiment.design import solve_design
from gripscale.experiment.measured_friction import (
    FRICTION_DOUBTS,
    MeasuredFriction,
    friction_doubts,
)
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Table, least_to_most
from gripscale.model import INPUT_DOUBTS, input_doubts_of
from gripscale.questions import view
from gripscale.questions.answer.direct_contact import continuation_factors, continued_curve
from gripscale.questions.answer.estimate import DIRECT, Factor
from gripscale.questions.answer.findings import answer_notices, measured_at_load
from gripscale.questions.answer.page import answer_cards, answer_lines
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.answer.variables import SYMBOLS, believed, is_estimated
from gripscale.questions.chain.findings import comparison_notices
from gripscale.questions.compare import page
from gripscale.questions.compare.charts import by_label, comparison_pictures, varied
from gripscale.questions.compare.comparison import (
    OnStage,
    SolvedLadder,
    comparison_setups,
    ladder_design,
    telling_new,
    windows_left,
)
from gripscale.questions.compare.ladder import chosen
from gripscale.questions.cut_off.curve import continuation_doubts
from gripscale.questions.result import Result
from gripscale.report.again import case_title
from gripscale.report.elements import Card, Section
from gripscale.report.failures import explained, failures_in, first_of


class Comparison(Result):
    """The models side by side over the inputs of a case, under one load or over one input."""

    kind = "comparison"
    ladder: SolvedLadder | None = None
    """The models with all samples; None of a result that was loaded from a file."""
    others: Sequence[Comparison] = ()
    """Comparisons of the same case over a varied input, which its page has, too."""

    @property
    def axis(self) -> str:
        """Name of the varied input; empty under one load."""
        return varied(self.data)

    @property
    def file(self) -> str:
        return f"over_{self.axis}.nc" if self.axis else "comparison.nc"

    @property
    def lines(self) -> Sequence[str]:
        data = self.data
        if not self.axis:
            lead, *basis = answer_lines(data)
            return (lead, *(f"  {line}" for line in page.large_strain_lines(data)), *basis)
        names = [name for name in reversed(SYMBOLS) if is_estimated(data, name)]
        ranges = [f"{SYMBOLS[n]} = {least_to_most(data[believed(data, n)])}" for n in names]
        text = ", ".join(ranges) or "none"
        return (f"Answer: {text} over the {self.axis.replace('_', ' ')}",)

    @property
    def findings(self) -> Sequence[Finding]:
        doubts = from_json(str(self.data.attrs.get(FRICTION_DOUBTS, "")))
        if self.axis:
            return (*self._failed, *doubts, *comparison_notices(self.data))
        return tuple(ranked([*self._failed, *doubts, *answer_notices(self.data)]))

    @property
    def _failed(self) -> Iterator[Finding]:
        """Models with samples that did not converge; the answer may stand without them."""
        for where, solved in view.points(by_label(self.data)):
            for failure in failures_in(solved, "status"):
                text = f"{where}: {explained(failure)}"
                yield Finding(Severity.WARNING, text, topic=Topic.SOLUTION)

    @property
    def failure(self) -> str:
        """Which models failed; empty if the answer stands without them."""
        if bool(self.data.answer_contact_fraction.notnull().all()):
            return ""
        failed = failures_in(self.data, "status")
        return first_of(failed, self.data.status.size, "models with all their samples")

    @property
    def title(self) -> str:
        return f"Models side by side: {case_title(self.data.attrs)}"

    def cards(self) -> Iterator[Card]:
        if not self.axis:
            yield from answer_cards(self.data)

    def parts(self) -> Iterator[str | Table]:
        if self.axis:
            yield from (page.axis_table(self.data, self.axis, name) for name in SYMBOLS)
        else:
            yield page.comparison_table(self.data)
        yield from page.temperature_only(self.data)

    def table(self) -> Table:
        """Return the models, one a row; over a varied input the friction of each."""
        if self.axis:
            return page.axis_table(self.data, self.axis, "friction")
        return page.comparison_table(self.data)

    def pictures(self) -> Iterator[Picture]:
        yield from comparison_pictures(self.data)

    def chapters(self) -> Iterator[Section]:
        for other in self.others:
            name = f"over-{other.axis.replace('_', '-')}"
            yield Section(name, f"Over {other.axis.replace('_', ' ')}", other.elements())


def compare(
    case: Case,
    *,
    vary: Mapping[str, Any] | None = None,
    seeds: int = 3,
    tolerance: float = 0.05,
    models: Sequence[str] = (),
    measured: MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    accuracy: float = 0.1,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_stage: OnStage | None = None,
) -> Comparison:
    """Put the models side by side over the inputs of a case.

    The result is over `model`, and what is varied; without a measured profile it has only the chain
    and its own waves at once. A sample that did not converge counts in no mean, and its model says
    so. Raises `InputError` or `FileError` if an input cannot be used by a model, a result cannot be
    written, the case refuses extrapolation and a wave excites the rubber beyond the measured band,
    or other than one input of numbers is varied.

        >>> gs.compare(case, models=["theory"]).to_dataset().model.values.tolist()
        ['persson']

    Parameters
    ----------
    case : Case
        The case.
    vary : mapping, optional
        One input of numbers with its values, as for `gripscale.questions.Study`.
    seeds : int
        Random phases drawn of each surface.
    tolerance : float
        Estimated relative error of each direct contact.
    models : sequence of str
        Names and groups of the models wanted, see `LADDER`; by default all.
    measured : MeasuredFriction, optional
        Friction measured elsewhere; that of the case by default.
    factors : sequence of Factor
        Factors of the answer known from elsewhere; under one load only.
    accuracy : float
        Half width of the 90 % interval wanted, relative: windows are solved at finite strain until
        their factor is known to a third of it, or of what the rest of the estimate leaves open.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    on_stage : callable, optional
        Called with the `SolvedLadder` as it stands, while more samples are solved.
    """
    doubtful: list[Finding] = []
    curve = None if vary is not None else continued_curve(case, case.load, folder)
    if curve is not None:
        doubtful = list(continuation_doubts(curve))
    factors = [*continuation_factors(case, curve), *factors]
    setups, axis, rubbers = comparison_setups(case, vary, seeds, tolerance)
    wanted = chosen(models)
    answering = [m for m in wanted if m.name == DIRECT] if vary is None else []
    asked, *stages = [answering, wanted] if answering and answering != wanted else [wanted]
    with bench_in(folder, workers, client, on_task) as bench:
        while True:
            design, members = ladder_design(setups, asked, axis)
            if not members and not stages:
                raise InputError(
                    f"no model of {', '.join(models)} applies to this case; windows and maps "
                    "need measured profiles, klueppel_heinrich the parameters of [compare]"
                )
            if members:
                each = list(setups.values())
                numbers = partial(sample_numbers, conditions=each[0].conditions)
                samples = solve_design(design, bench, numbers)
                ladder = SolvedLadder(
                    case, each, members, samples, axis, measured or case.friction, factors, rubbers
                )
                if on_stage is not None:
                    on_stage(ladder)
                bench = telling_new(bench)
            if stages:
                asked = stages.pop(0)
            elif windows_left(ladder, accuracy):
                setups = {
                    label: replace(setup, windows=setup.windows + 1)
                    for label, setup in setups.items()
                }
            else:
                break
    data = ladder.data
    if doubts := friction_doubts(ladder.measured, case.load.speed):
        data = data.assign_attrs({FRICTION_DOUBTS: to_json(doubts)})
    if doubtful:
        data = data.assign_attrs({INPUT_DOUBTS: to_json([*input_doubts_of(data), *doubtful])})
    if vary is None:
        data = data.assign(measured_at_load(case, ladder.measured))
    result = Comparison(data)
    result.ladder = ladder
    return result
