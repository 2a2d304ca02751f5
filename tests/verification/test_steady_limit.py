"""Sliding in time ends in the steady state, which is found in quite another way."""

from itertools import pairwise

import numpy as np
import pytest

from tests.verification.transient_cases import CASES, SLOW

MESH = {"columns": 96, "rows": 14}


def last_moment_errors(case, passages=5, **mesh):
    """Relative error of friction and error of the contact fraction after some passages."""
    steady, run = case.steady(**mesh), case.run(case.stage(passages), **mesh)
    assert steady.converged
    assert run.converged
    friction = float(run.friction[-1] / steady.friction - 1.0)
    return friction, float(run.contact_fraction[-1] - steady.contact_fraction)


QUICK = [0, 3, 5, 7]
"""Of the cases: from the smallest slope to the steepest, and one with two relaxation times."""


@pytest.mark.parametrize(
    "case",
    [
        pytest.param(case, marks=() if i in QUICK else pytest.mark.verification)
        for i, case in enumerate(CASES)
    ],
    ids=str,
)
def test_the_steady_state_is_the_limit(case):
    friction, area = last_moment_errors(case, **MESH)
    # Memory between columns is linear here and a Fourier series there: (k h)^2-sized differences.
    assert abs(friction) < 0.005
    assert abs(area) < 0.005


@pytest.mark.verification
def test_the_difference_from_the_steady_state_is_of_second_order():
    """Worst of the eight cases: a quarter at half the spacing; (k h)^2 = 0.24 % on 128 columns."""
    worst = {
        columns: np.abs([last_moment_errors(case, columns=columns, rows=rows) for case in CASES])
        for columns, rows in ((32, 8), (64, 12), (128, 20))
    }
    friction = [errors[:, 0].max() for errors in worst.values()]
    for coarse, fine in pairwise(friction):
        assert coarse / fine == pytest.approx(4.0, rel=0.2)
    assert friction[-1] < 0.0024
    assert worst[128][:, 1].max() < 0.001


@pytest.mark.parametrize("passages", [2, 5])
def test_long_relaxation_times_agree_at_the_load_time(passages):
    """A relaxation time of 50 passages is at rest in the mean state, as `load_time` says.

    The slow network also remembers where along the wave each point was when the load came on: a
    disturbance that goes round with the rubber and decays with its relaxation time. Friction at
    one moment is off by it (1 % here); its mean over a passage is not.
    """
    stage = SLOW.stage(passages)
    steady = SLOW.steady(load_time=stage.duration, **MESH)
    run = SLOW.run(stage, **MESH)
    friction, _, _ = run.cycle()["friction"]
    assert friction == pytest.approx(steady.friction, rel=0.005)
    assert run.contact_fraction[-1] == pytest.approx(steady.contact_fraction, abs=0.005)
