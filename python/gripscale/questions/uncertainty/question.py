"""How uncertain is the answer: the interval with the errors of the inputs, and what makes it.

result = gs.uncertainty(case, samples=200)
result.friction_interval
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gripscale.case import Case
from gripscale.core.finding import Finding
from gripscale.experiment.solve import OnTask
from gripscale.io.table import Table
from gripscale.questions.answer.answer import NumbersWithIntervals
from gripscale.questions.answer.page import answer_lines
from gripscale.questions.uncertainty import page
from gripscale.questions.uncertainty.charts import axis_of, uncertainty_pictures
from gripscale.questions.uncertainty.propagation import OnAnswer, Plan, propagate
from gripscale.questions.uncertainty.sampling import Uncertainty, stated_options
from gripscale.report.elements import Page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class SampledAnswer(NumbersWithIntervals):
    """The answer of a case with the errors of its inputs, and the parts of its interval."""

    kind = "uncertainty"

    @property
    def lines(self) -> Sequence[str]:
        held = page.interval_sentence(self.data)
        if axis_of(self.data):
            return (held,)
        first, *below = answer_lines(self.data)
        return (first, f"  {held}", *below)

    @property
    def findings(self) -> Sequence[Finding]:
        return tuple(page.page_notices(self.data))

    @property
    def failure(self) -> str:
        return str(page.sampling_failure(self.data)) if page.too_many_failed(self.data) else ""

    def parts(self) -> Iterator[str | Table]:
        if axis_of(self.data):
            yield page.answer_table(self.data)
        yield from page.part_tables(self.data)
        yield page.quantile_table(self.data)
        yield from page.share_parts(self.data)
        yield from page.left_out_sentences(self.data)
        yield from map(str, filter(None, [page.sampling_failure(self.data)]))

    def table(self) -> Table:
        return next(page.part_tables(self.data))

    def figures(self) -> Iterator[tuple[str, Figure]]:
        for picture in uncertainty_pictures(self.data):
            yield picture.name, picture.figure

    def page_content(self) -> Page:
        return page.uncertainty_page(self.data)


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
        Sources that are taken to be known, see `gripscale.questions.Uncertainty`.
    ranges : mapping, optional
        What is known of a source, in place of its default, see `gripscale.questions.Uncertainty`.
    block_length : float, optional
        Length of the blocks of profiles that are drawn [m].
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
    choice = Uncertainty.of_case(
        stated_options(case), without=without, ranges=ranges, block_length=block_length
    )
    plan = Plan.of(
        case, choice, samples=samples, seed=seed, models=models, vary=vary, tolerance=tolerance
    )
    data = propagate(
        plan, folder, workers=workers, client=client, on_task=on_task, on_answer=on_answer
    )
    return SampledAnswer(data)
