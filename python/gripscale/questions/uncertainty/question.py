"""How uncertain is the answer: the interval with the errors of the inputs, and what makes it.

result = gs.uncertainty(case, samples=200)
result.friction_interval
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from gripscale.case import Case
from gripscale.charts.draw import Picture
from gripscale.core.finding import Finding, Severity, Topic
from gripscale.experiment.solve import OnTask
from gripscale.io.table import Column, Table, percent
from gripscale.questions import view
from gripscale.questions.answer.answer import NumbersWithIntervals
from gripscale.questions.answer.estimate import DIRECT
from gripscale.questions.answer.page import answer_cards, answer_lines
from gripscale.questions.answer.reliance import is_measured, is_moving
from gripscale.questions.answer.variables import SYMBOLS, has_answer, of_hysteresis
from gripscale.questions.uncertainty.charts import axis_of, uncertainty_pictures
from gripscale.questions.uncertainty.propagation import (
    LEVELS,
    PROPAGATED_QUANTITIES,
    OnAnswer,
    Plan,
    propagate,
)
from gripscale.questions.uncertainty.sampled_answer import next_measurements
from gripscale.questions.uncertainty.sources import SOURCES, STATED
from gripscale.questions.uncertainty.variance_shares import SIGNIFICANCE
from gripscale.report.elements import Card
from gripscale.report.failures import explained, failures_in

# Share of the samples of a model without an answer up to which the others stand for all.
MOST_FAILED = 0.25


class SampledAnswer(NumbersWithIntervals):
    """The answer of a case with the errors of its inputs, and the parts of its interval."""

    kind = "uncertainty"

    @property
    def lines(self) -> Sequence[str]:
        held = _interval_sentence(self.data)
        if axis_of(self.data):
            return (held,)
        first, *below = answer_lines(self.data)
        return (first, f"  {held}", *below)

    @property
    def failure(self) -> str:
        """Samples without an answer, where the others do not stand for all of them."""
        data = self.data
        too_many = bool((data.failed > MOST_FAILED * data.sizes["sample"]).any())
        of_case = bool(failures_in(data, "status_case"))
        return _without_answer(data) if of_case or too_many else ""

    @property
    def findings(self) -> Sequence[Finding]:
        text = "" if self.failure else _without_answer(self.data)
        return (Finding(Severity.WARNING, text, topic=Topic.SOLUTION),) if text else ()

    def cards(self) -> Iterator[Card]:
        if not axis_of(self.data):
            yield from answer_cards(self.data)

    def parts(self) -> Iterator[str | Table]:
        data = self.data
        if axis := axis_of(data):
            columns = view.number_columns(data, view.answers(data))
            yield view.table(data, columns, "answers", f"Answer by {axis}")
        yield from self._part_tables()
        yield self._quantile_table()
        yield from (f"Not sampled: {each}." for each in json.loads(data.attrs["left_out"]))

    def table(self) -> Table:
        """Return what the interval of the answer is made of."""
        return next(self._part_tables())

    def _part_tables(self) -> Iterator[Table]:
        """Yield what the interval is made of at each load; of one load what to measure next."""
        for label, part in view.points(self.data):
            if has_answer(part) and part.sizes["part"]:
                where = f" ({label})" if label else ""
                yield _part_table(part, f"What matters most to the answer{where}")
                if not label and is_moving(part) and (table := next_measurements(part)):
                    yield table

    def _quantile_table(self) -> Table:
        rows = []
        for model in self.data.model.values:
            for label, part in view.points(self.data.sel(model=model)):
                title = f"{model}{f', {label}' if label else ''}"
                rows += [(title, part, name) for name in PROPAGATED_QUANTITIES]
        quantiles = np.array([part[f"{name}_quantile"].values for _, part, name in rows])
        columns = [
            Column("model", [title for title, _, _ in rows]),
            Column("quantity", [SYMBOLS[name] for _, _, name in rows]),
            Column("case", [float(part[f"{name}_case"]) for _, part, name in rows], "the case"),
            *(
                Column(f"quantile_{level:g}", quantiles[:, at], f"{level:.0%}")
                for at, level in enumerate(LEVELS)
            ),
            Column("failed", [int(part.failed) for _, part, _ in rows], format="{:.0f}".format),
        ]
        title = "Quantiles of the samples, without the factors of the answer"
        return Table("quantiles", columns, title, keys=2)

    def pictures(self) -> Iterator[Picture]:
        yield from uncertainty_pictures(self.data)


def _interval_sentence(data: xr.Dataset) -> str:
    count = data.sizes["sample"]
    if not is_measured(data):
        return (
            f"interval: {count} samples of the chain with the errors of the inputs; no measured "
            "surface judges it"
        )
    if DIRECT not in data.model.values:
        return (
            "interval: that of `gripscale run`, without errors of the inputs: the direct contact "
            "was not sampled (model: direct or both)"
        )
    text = f"interval: with the errors of the inputs, from {count} samples"
    # what only a case can state
    missing = [SOURCES[name].label for name in STATED if name not in data.source]
    return f"{text}, but for {', '.join(missing)}" if missing else text


def _part_table(part: xr.Dataset, title: str) -> Table:
    names = list(PROPAGATED_QUANTITIES) if is_moving(part) else ["contact_fraction"]
    ranked = np.argsort(-part[f"answer_{names[0]}_part_error"].values, kind="stable")
    part = part.isel(part=ranked)
    labels = part.part_label.values.tolist()
    columns = [Column("part", labels, "not known")]
    for name in names:
        sigma = part[f"answer_{name}_part_error"].values
        share = sigma**2 / float(part[f"answer_{of_hysteresis(part, name)}_uncertainty"]) ** 2
        of_sum = of_hysteresis(part, name) != name
        group = f"{SYMBOLS[name]} of hysteresis" if of_sum else SYMBOLS[name]
        columns += [
            Column(f"{name}_error", sigma, "±", group=group, format=percent),
            Column(f"{name}_share", share, "share", group=group, format="{:.0%}".format),
        ]
    notes = ["±: standard error of the logarithm; share: its square over that of the interval."]
    # NaN where no samples know the error of a share
    error = part[f"answer_{names[0]}_part_share_error"].values
    if unseen := [labels[k] for k in np.flatnonzero(columns[2].values < SIGNIFICANCE * error)]:
        count = part.sizes["sample"]
        notes.append(f"No significant effect with {count} samples: {', '.join(unseen)}.")
    return Table("parts", columns, title, notes)


def _without_answer(data: xr.Dataset) -> str:
    """Return how many samples have no answer, and why the first; empty if all have one."""
    failed, of_case = failures_in(data, "status"), failures_in(data, "status_case")
    texts = [f"the case itself has no answer: {explained(failure)}" for failure in of_case[:1]]
    if failed:
        count = f"{len(failed)} of {data.status.size} samples have no answer and count in no"
        texts.insert(0, f"{count} quantile; the first: {explained(failed[0])}")
    return "; ".join(texts)


def uncertainty(
    case: Case,
    *,
    samples: int | None = None,
    seed: int | None = None,
    models: Sequence[str] | None = None,
    without: Sequence[str] | None = None,
    ranges: Mapping[str, Any] | None = None,
    block_length: float | None = None,
    vary: Mapping[str, Any] | None = None,
    tolerance: float | None = None,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    on_answer: OnAnswer | None = None,
) -> SampledAnswer:
    """Return the answer of a case with the errors of its inputs, from samples of all at once.

    Raises `InputError` or `FileError` if an argument or a file cannot be used, or a result cannot
    be written.

        >>> gs.uncertainty(case, samples=10, without=["profile"]).to_dataset().sizes["sample"]
        10

    Parameters
    ----------
    case : Case
        What it states about its uncertainty holds where an argument is left out.
    samples : int, optional
        Samples, 10 to 100 000; 200 by default.
    seed : int, optional
        Seed of the random numbers.
    models : sequence of str, optional
        "chain", "direct" or both; "direct" where profiles were measured by default.
    without : sequence of str, optional
        Sources that are taken to be known.
    ranges : mapping, optional
        What is known of a source, in place of its default.
    block_length : float, optional
        Length of the blocks of profiles that are drawn [m]. For these three see
        `gripscale.questions.Uncertainty`.
    vary : mapping, optional
        Speeds or pressures; the same samples at each.
    tolerance : float, optional
        Estimated relative error of each direct contact; about a tenth by default.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    on_answer : callable, optional
        Called with the answer without the errors of the inputs, before any sample is solved.

    Returns
    -------
    SampledAnswer
        The answer of the case (`answer_friction`, `answer_contact_fraction`, ..., as of `gripscale
        run`) with its interval and what that is made of. Over `model`, what is varied, and
        `sample`: `friction`, `contact_fraction` and `status`, with what was drawn as coordinates of
        `sample`; `_case` of the case itself; `_quantile` over `quantile`; `_grid_error` of each
        sample of the direct contact; `failed` samples, which count in no quantile; `_share` of each
        `source` in the variance (`gripscale.questions.shares`). The folder gets `uncertainty.nc`,
        and the predictions in `predictions`.
    """
    plan = Plan.of(
        case,
        samples=samples,
        seed=seed,
        models=models,
        without=without,
        ranges=ranges,
        block_length=block_length,
        vary=vary,
        tolerance=tolerance,
    )
    data = propagate(
        plan, folder, workers=workers, client=client, on_task=on_task, on_answer=on_answer
    )
    return SampledAnswer(data)
