"""What a run can afford to know of its chain: the direct contact of the measured profiles."""

from __future__ import annotations

import time

from gripscale.case.results import CaseResults
from gripscale.comparison.ladder import DIRECT, LADDER, each_measured
from gripscale.comparison.sample import Sample, sample_of
from gripscale.comparison.solved import SolvedRung
from gripscale.rough.model import DirectContact

JUDGED_TO = 0.1
"""Estimated relative error of the contact that every run judges its chain by."""


def judged(results: CaseResults) -> SolvedRung | None:
    """Return the direct contact of the measured profiles, at the speed of the case.

    None if no profile was measured. Solved to an estimated relative error of `JUDGED_TO`.
    """
    rung = next(one for one in LADDER if one.name == DIRECT)
    model = DirectContact(tolerance=JUDGED_TO, conditions=results.conditions)
    rubber, load = results.rubber.rubber, results.load
    samples: list[Sample] = []
    for name, surface in each_measured(results.surface):
        clock = time.perf_counter()
        answer = model.predict(rubber, surface, load)
        answer.attrs["seconds"] = time.perf_counter() - clock
        samples.append(sample_of(answer, name))
    return SolvedRung(rung, samples) if samples else None
