"""How the answer varies: friction and contact area over one or two inputs of a case.

result = gs.vary(case, speed=[0.01, 0.1, 1.0], temperature=["0 C", "20 C"])
result.data.answer_friction
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from gripscale.case import Case
from gripscale.core.finding import Finding
from gripscale.experiment.solve import OnTask
from gripscale.half_space.model import JUDGED_TO
from gripscale.io.table import Table
from gripscale.model import STATUS, Model
from gripscale.questions import view
from gripscale.questions.result import Result
from gripscale.questions.vary import page
from gripscale.questions.vary.study import Study
from gripscale.report.elements import Page
from gripscale.report.failures import failures_in, first_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MOST_PRINTED = 200  # predictions in the terminal; a page has all of them


class Variation(Result):
    """Friction and contact area of a case over one or two of its inputs."""

    kind = "study"

    @property
    def noun(self) -> str:
        """What one of its predictions is called."""
        return "prediction"

    @property
    def lines(self) -> Sequence[str]:
        return tuple(page.study_lines(self.data))

    @property
    def findings(self) -> Sequence[Finding]:
        return tuple(page.study_findings(self.data))

    @property
    def failure(self) -> str:
        failed = failures_in(self.data, STATUS)
        return first_of(failed, self.data[STATUS].size, f"{self.noun}s")

    def parts(self) -> Iterator[str | Table]:
        yield view.first_rows(page.study_table(self.data), MOST_PRINTED)

    def table(self) -> Table:
        return page.study_table(self.data)

    def figures(self) -> Iterator[tuple[str, Figure]]:
        from gripscale.questions.vary.charts import study_pictures

        yield from ((picture.name, picture.figure) for picture in study_pictures(self.data))

    def page_content(self) -> Page:
        return page.study_page(self.data)


def vary(
    case: Case,
    *,
    model: Model | str | None = None,
    tolerance: float = JUDGED_TO,
    folder: str | Path | None = None,
    workers: int | None = None,
    client: Any = None,
    on_task: OnTask | None = None,
    **axes: Any,
) -> Variation:
    """Return friction and contact area of a case over one or two of its inputs.

    The result is per wave and in total, over the varied axes; a speed of zero is rubber at rest. A
    prediction that did not converge has NaN totals and says why in `prediction_status`. Raises
    `InputError` or `FileError` for an input that cannot be used, or a result that cannot be
    written.

        >>> gs.vary(case, speed=["0.36 km/h", 0.3]).to_dataset().total_friction.values.round(3)
        array([0.037, 0.039])

    Parameters
    ----------
    case : Case
        What is not varied is as in the case.
    model, tolerance
        As for `gripscale.questions.Study`.
    folder : path, optional
        Keeps each prediction as soon as it is there: what was interrupted resumes.
    workers, client, on_task
        As for `gripscale.experiment.Bench`.
    **axes
        One or two inputs with their values, such as `speed=[0.1, 1.0]` [m/s] or
        `temperature="0 C,20 C"`; see `gripscale.questions.Study` for all.
    """
    study = Study(case, axes, model=model, tolerance=tolerance)
    data = study.run(folder, workers=workers, client=client, on_task=on_task)
    return Variation(data)
