"""How the models compare: the answer beside the chain and the theories.

result = gs.compare(case, models=["waves", "measured"])
result.data.total_friction
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale import model
from gripscale.case import Case
from gripscale.charts.draw import Picture
from gripscale.core import InputError
from gripscale.core.finding import Finding, Severity, Topic, from_json, ranked, to_json
from gripscale.experiment import measured_friction
from gripscale.experiment.design import solve_design
from gripscale.experiment.solve import OnTask, bench_in
from gripscale.io.table import Column, Table, digits, fixed, least_to_most, percent, significant
from gripscale.model import INPUT_DOUBTS, input_doubts_of
from gripscale.questions import view
from gripscale.questions.answer import findings as of_answer
from gripscale.questions.answer import variables
from gripscale.questions.answer.direct_contact import continuation_factors, continued_curve
from gripscale.questions.answer.estimate import DIRECT, Factor, large_strain_answer
from gripscale.questions.answer.intervals import LEVEL
from gripscale.questions.answer.page import answer_cards, answer_lines
from gripscale.questions.answer.reliance import estimated_names, is_measured, no_answer
from gripscale.questions.answer.samples import sample_numbers
from gripscale.questions.answer.variables import HEADINGS, SYMBOLS, answer_number, has_answer
from gripscale.questions.calibration.question import residual_table
from gripscale.questions.chain.findings import comparison_notices
from gripscale.questions.compare import charts
from gripscale.questions.compare import comparison as ladders
from gripscale.questions.compare.ladder import chosen
from gripscale.questions.cut_off.curve import continuation_doubts
from gripscale.questions.inputs.record import signed_percent
from gripscale.questions.result import Result
from gripscale.report.elements import Card, Page, Section, case_title
from gripscale.report.failures import explained, failures_in, first_of
from gripscale.rubber.extrapolation import WORTH_SAYING

TINY = 0.05  # per cent below which a spread or an error is as good as none
_NOTE = (
    "×: factor on the model before; for theories, on the direct contact. Exponents: "
    "d ln/d ln of the smallest wavelength that counts, over its last octave. Beyond band (*): "
    "share of the friction at frequencies beyond those of the master curve, and how far they go."
)


def comparison_table(data: xr.Dataset) -> Table:
    """Return area and friction of each model of the ladder, with all that qualifies them.

    Spread and error are relative to the number, the factor is from the model before. `data` has no
    axis but `model`.
    """
    beyond = data[model.FRICTION_OUTSIDE_BAND].values
    marks = [" *" if share > WORTH_SAYING else "" for share in beyond]
    columns = [Column("model", data.label.values, marks=marks)]
    for name, symbol in SYMBOLS.items():
        value, group = data[f"total_{name}"].values, HEADINGS[name]
        columns.append(Column(f"total_{name}", value, symbol, group=group))
        if name == "friction":
            lost = data.total_friction_from_dissipation.values
            columns.append(Column("friction_from_dissipation", lost, "μ", "losses", group=group))
            if (both := model.with_adhesive(data)) is not None:
                column = Column("with_area_term", both.values, "μ", "+ area term", group=group)
                columns.append(column)
        for part in ("spread", "error"):
            share = data[f"{name}_{part}"].values / np.where(value == 0.0, np.nan, value)
            key = f"{name}_{part}"
            columns.append(Column(key, share, part, "%", 0.01, format=_two_digits, group=group))
        columns.append(Column(f"{name}_factor", data[f"{name}_factor"].values, "×", group=group))
    pairs = zip(data.converged_samples.values, data.samples.values, strict=True)
    samples = [str(n) if k == n else f"{k}/{n}" for k, n in pairs]
    columns.append(Column("samples", samples, "n", words=False))
    for name, symbol in zip(model.CUT_OFF_EXPONENTS, SYMBOLS.values(), strict=True):
        values = data[name].values if name in data else np.full(len(samples), np.nan)
        columns.append(Column(name, values, symbol, group="exponents", format=fixed(2)))
    far = Column("friction_outside_band", beyond, "μ", "beyond", group="band", format=percent)
    columns.append(far)
    for end in ("below", "above"):
        decades = data[f"total_decades_{end}_band"].values
        about = {"unit": "decades", "heading": end, "format": digits(2)}
        columns.append(far.of(decades, name=f"decades_{end}_band", **about))
    strong = np.flatnonzero(data.model.values == DIRECT).tolist()
    bad = charts.flawed(data)
    return Table("ladder", columns, "The ladder of models", [_NOTE], bad=bad, strong=strong)


def _two_digits(value: float) -> str:
    return "0" if value < TINY else significant(value, 2)


def axis_table(data: xr.Dataset, axis: str, name: str) -> Table:
    """Return `contact_fraction` or `friction` of each model over the axis that was varied."""
    data = data.transpose(axis, ...)
    failed, beyond = charts.flawed(data), data[model.FRICTION_OUTSIDE_BAND].values > WORTH_SAYING
    words, unit = axis.replace("_", " "), view.shown_unit(data[axis])
    look = unit.unit, unit.divisor, unit.zero, "{:.3g}".format
    columns = [Column(axis, data[axis].values, words, *look)]
    if variables.is_estimated(data, name) and is_measured(data):
        texts = [str(answer_number(data.isel({axis: i}), name)) for i in range(data.sizes[axis])]
        columns.append(Column("answer", texts, "answer (90 %)", words=False))
    for at, member in enumerate(data.model.values.tolist()):
        flags = zip(failed[:, at], beyond[:, at], strict=True)
        marks = [("!" if bad else "") + ("*" if far else "") for bad, far in flags]
        values, heading = data[f"total_{name}"].values[:, at], member.replace("_", " ")
        columns.append(Column(member, values, heading, marks=marks, bad=failed[:, at]))
    caption = f"{HEADINGS[name].capitalize()} {SYMBOLS[name]} over {words}"
    return Table(f"over-{axis}-{name}", columns, caption)


# Which models of a comparison have an effect.
_MODELS_WITH = {
    "softening": "Softening: in the chains, the direct contacts and Persson's theory.",
    "heat": "Heat: in the chains and the direct contacts.",
}


def temperature_only(data: xr.Dataset) -> Iterator[str]:
    """Yield which models leave effects out, where strain or heat change the rubber."""
    asked = json.loads(data.attrs.get("conditions", "null")) or {}
    if asked.get("water") is not None:
        yield "Water: in the direct contacts of maps. All other models are dry."
    effects = [text for name, text in _MODELS_WITH.items() if asked.get(name) is not None]
    if effects:
        yield " ".join([*effects, "Else only the temperature before the contact counts."])


def with_half_widths(answer: xr.Dataset) -> str:
    """Return area and friction of an answer with the half widths of their intervals."""
    texts = []
    for symbol, name in (("A_r/A_0", "contact_fraction"), ("mu", "friction")):
        number = answer_number(answer, name)
        width = 0.5 * (number.high - number.low) / (number.value or math.nan)
        spread = f" ± {100.0 * width:.2g} %" if math.isfinite(width) else ""
        texts.append(f"{symbol} = {significant(number.value)}{spread}")
    return ", ".join(texts)


def large_strain_lines(data: xr.Dataset) -> Iterator[str]:
    """Yield what the answer becomes with large strain solved, where it was."""
    large = large_strain_answer(data)
    if large is None or not has_answer(large):
        return
    texts = []
    for name in estimated_names(large):
        number = answer_number(large, name)
        change = signed_percent(number.value / answer_number(data, name).value - 1.0)
        texts.append(f"{SYMBOLS[name]} = {number}, {change}")
    yield f"With large strain solved on windows: {'; '.join(texts)}."


class Comparison(Result):
    """The models side by side over the inputs of a case, under one load or over one input."""

    kind = "comparison"
    ladder: ladders.SolvedLadder | None = None
    """The models with all samples; None of a result that was loaded from a file."""
    at_measured: xr.Dataset | None = None
    """What models say at measured speeds, temperatures and pressures, as `residuals`."""
    others: Sequence[Comparison] = ()
    """Comparisons of the same case over a varied input, which its page has, too."""

    @property
    def axis(self) -> str:
        """Name of the varied input; empty under one load."""
        return charts.varied(self.data)

    @property
    def file(self) -> str:
        return f"over_{self.axis}.nc" if self.axis else "comparison.nc"

    @property
    def lines(self) -> Sequence[str]:
        data = self.data
        if not self.axis:
            lead, *basis = answer_lines(data)
            return (lead, *(f"  {line}" for line in large_strain_lines(data)), *basis)
        ranges = [
            f"{SYMBOLS[name]} = {least_to_most(data[f'answer_{name}'])}"
            for name in reversed(SYMBOLS)
            if variables.is_estimated(data, name)
        ]
        return (f"Answer: {', '.join(ranges) or 'none'} over the {self.axis.replace('_', ' ')}",)

    @property
    def findings(self) -> Sequence[Finding]:
        doubts = from_json(str(self.data.attrs.get(measured_friction.FRICTION_DOUBTS, "")))
        failed = [  # the answer may stand without them
            Finding(Severity.WARNING, f"{where}: {explained(failure)}", topic=Topic.SOLUTION)
            for where, solved in view.points(charts.by_label(self.data))
            for failure in failures_in(solved, "status")
        ]
        if self.axis:
            return (*failed, *doubts, *comparison_notices(self.data))
        of_others = [finding for other in self.others for finding in other.findings]
        notices = of_answer.answer_notices(self.data)
        return tuple(ranked([*failed, *doubts, *notices, *of_others]))

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
            yield from (axis_table(self.data, self.axis, name) for name in SYMBOLS)
        else:
            yield comparison_table(self.data)
        yield from temperature_only(self.data)
        if self.at_measured is not None:
            yield residual_table(self.at_measured)
        if not self.axis and has_answer(self.data):  # the same in every version: scripts read it
            doubt = "; not to be relied on" if no_answer(self.data) else ""
            yield f"Best estimate ({100.0 * LEVEL:.0f} %): {with_half_widths(self.data)}{doubt}"

    def table(self) -> Table:
        """Return the models, one a row; over a varied input the friction of each."""
        if self.axis:
            return axis_table(self.data, self.axis, "friction")
        return comparison_table(self.data)

    def pictures(self) -> Iterator[Picture]:
        yield from charts.comparison_pictures(self.data)
        if self.at_measured is not None:
            labels = dict(zip(self.data.model.values, self.data.label.values, strict=True))
            yield Picture(
                "at_measured",
                charts.at_measured_figure(self.at_measured, labels),
                "Measured friction with its spread, and what each model says at the same points.",
                "A panel for each measured series with a curve for each model.",
            )

    def page_content(self) -> Page:
        page = super().page_content()
        alerts = () if self.axis else of_answer.no_answer_notices(self.data)
        return replace(page, notices=[*alerts, *page.notices])

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
    measured: measured_friction.MeasuredFriction | None = None,
    factors: Sequence[Factor] = (),
    accuracy: float = 0.1,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_stage: ladders.OnStage | None = None,
) -> Comparison:
    """Put the models side by side over the inputs of a case.

    The result is over `model`, and what is varied. A sample that did not converge counts in no
    mean, and its model says so. Raises `InputError` or `FileError` if an input cannot be used by a
    model, a result cannot be written, the case refuses extrapolation that a wave needs, or other
    than one input of numbers is varied.

        >>> gs.compare(case, models=["theory"]).to_dataset().model.values.tolist()
        ['persson']

    Parameters
    ----------
    case : Case
        The case.
    vary : mapping, optional
        One input of numbers with its values, as for `gripscale.questions.Study`.
    seeds : int
        Random phases drawn of the sine waves.
    tolerance : float
        Estimated relative error of each direct contact.
    models : sequence of str
        Names and groups of the models wanted, see `LADDER`; by default all.
    measured : MeasuredFriction, optional
        Friction measured elsewhere; that of the case by default.
    factors : sequence of Factor
        Factors of the answer known from elsewhere; under one load only.
    accuracy : float
        Half width of the 90 % interval wanted, relative; windows are solved until their factor is
        known to a third of it, or of what the rest of the estimate leaves open.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    on_stage : callable, optional
        Called with the `SolvedLadder` as it stands, while more samples are solved.
    """
    curve = None if vary is not None else continued_curve(case, case.load, folder)
    doubtful = [] if curve is None else list(continuation_doubts(curve))
    factors = [*continuation_factors(case, curve), *factors]
    setups, axis, rubbers = ladders.comparison_setups(case, vary, seeds, tolerance)
    wanted = chosen(models)
    answering = [m for m in wanted if m.name == DIRECT] if vary is None else []
    asked, *stages = [answering, wanted] if answering and answering != wanted else [wanted]
    with bench_in(folder, workers, client, on_task) as bench:
        while True:
            design, members = ladders.ladder_design(setups, asked, axis)
            if not members and not stages:
                raise InputError(
                    f"no model of {', '.join(models)} applies to this case; windows and maps "
                    "need measured profiles, klueppel_heinrich the parameters of [compare]"
                )
            if members:
                each = list(setups.values())
                numbers = partial(sample_numbers, conditions=each[0].conditions)
                samples = solve_design(design, bench, numbers)
                friction = measured or case.friction
                ladder = ladders.SolvedLadder(
                    case, each, members, samples, axis, friction, factors, rubbers
                )
                if on_stage is not None:
                    on_stage(ladder)
                bench = ladders.telling_new(bench)
            if stages:
                asked = stages.pop(0)
            elif ladders.windows_left(ladder, accuracy):
                more = ladder.setups[0].windows + 1
                setups = {label: replace(setup, windows=more) for label, setup in setups.items()}
            else:
                break
    data = ladder.data
    if doubts := measured_friction.friction_doubts(ladder.measured, case.load.speed):
        data = data.assign_attrs({measured_friction.FRICTION_DOUBTS: to_json(doubts)})
    if doubtful:
        data = data.assign_attrs({INPUT_DOUBTS: to_json([*input_doubts_of(data), *doubtful])})
    if vary is None:
        data = data.assign(of_answer.measured_at_load(case, ladder.measured))
    result = Comparison(data)
    result.ladder = ladder
    return result
