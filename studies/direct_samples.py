"""Lines of a case solved one by one at small strain, without what is not known of the rubber.

Alternatives of the rubber, its series and its softening are left out: a truth that was solved with
the same rubber has their errors, too.
"""

from __future__ import annotations

import xarray as xr

import gripscale as gs
from gripscale.experiment.design import Design, Point, solve_design
from gripscale.experiment.solve import Bench
from gripscale.experiment.task import Task
from gripscale.half_space.model import JUDGED_TO, DirectContact
from gripscale.questions import Factor, LogNormalValue
from gripscale.questions.answer.samples import sample_numbers
from gripscale.surface.surface import each_measured

SMALL_STRAIN = Factor("finite_strain", "none", LogNormalValue(1.0, 0.0), LogNormalValue(1.0, 0.0))
"""In place of the factor of large strain, where a truth is at small strain, too."""


def direct_samples(case: gs.Case) -> xr.Dataset:
    """Return the direct contact of each line of a case over `sample`."""
    direct = DirectContact(tolerance=JUDGED_TO, conditions=case.conditions)
    lines = each_measured(case.surface)
    points = [
        Point((at,), name, Task(case.rubber, line, case.load, direct))
        for at, (name, line) in enumerate(lines)
    ]
    subjects = {"subject": ("sample", [name for name, _ in lines])}
    return solve_design(
        Design({"sample": len(points)}, points, subjects), Bench(None), sample_numbers
    )
