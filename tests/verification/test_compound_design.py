"""The design of a compound on the shipped road: 2,000 random admissible changes, none better.

All of them are judged to first order at the optimum, where the gradient is known: over a concave
ln mu the tangent plane is an upper bound, and the largest value of it over all admissible changes
is the stated gap. What the first order is worth is measured by solving two hundred of them: a
hundred different ones that it finds best, and others at random.
"""

import numpy as np
import pytest

from gripscale.case_file import read_case
from gripscale.questions.design.compound_limits import changed
from gripscale.questions.design.compound_search import best_change, design_problem, nearest_design
from gripscale.questions.design.goal_friction import DESIGN_TOLERANCE
from tests.questions.design.test_search import log_friction, mixtures
from tests.samples import EXAMPLES

TRIED, SOLVED = 2000, 100


@pytest.mark.verification
def test_no_admissible_change_of_the_shipped_rubber_is_better():
    problem = design_problem(read_case(EXAMPLES / "road_and_tread" / "case.toml"))
    friction, limits = problem.friction, problem.admissible(1.0)
    today, slope_today = friction.log_friction(np.ones(1 + problem.rubber.moduli.size))
    optimum = best_change(friction, limits, np.ones(slope_today.size))
    design = nearest_design(friction, limits, optimum)
    assert limits.violation(design.ratio) < 1e-6
    assert optimum.log_friction - today > np.log(1.4)
    assert optimum.log_friction - design.log_friction < 2e-3

    tried = np.array(mixtures(limits, TRIED, slope_today))
    assert max(limits.violation(ratio) for ratio in tried) < 1e-6
    tangent = optimum.log_friction + (tried - optimum.ratio) @ optimum.slope
    assert tangent.max() < optimum.log_friction + 1e-4  # the gap at which the search ends

    # corners that differ by less than this in first order are one
    _, first = np.unique(np.round(tangent, 7), return_index=True)
    best = first[::-1][:SOLVED]
    others = np.setdiff1d(np.arange(TRIED), best)
    random = np.random.default_rng(0).choice(others, SOLVED, replace=False)
    chosen = np.concatenate([best, random])
    solved = np.array([log_friction(friction, tried[i]) for i in chosen])
    gains = np.expm1(np.append(solved, optimum.log_friction) - today)
    print(f"best {gains[:-1].max():+.1%}, median {np.median(gains):+.1%}, optimum {gains[-1]:+.1%}")
    # one of them may be the optimum itself, started from another contact
    assert solved.max() < optimum.log_friction + 1e-5
    # ln mu is all but concave: nowhere above its tangent by more than a small part of the gain
    assert (solved - tangent[chosen]).max() < 0.02
    assert np.median(solved[SOLVED:]) < optimum.log_friction


@pytest.mark.verification
def test_the_promised_friction_is_that_of_finer_contacts():
    problem = design_problem(read_case(EXAMPLES / "road_and_tread" / "case.toml"))
    friction, limits = problem.friction, problem.admissible(1.0)
    start = np.ones(1 + problem.rubber.moduli.size)
    design = nearest_design(friction, limits, best_change(friction, limits, start))
    rubber = changed(problem.rubber, design.ratio)
    promised, finer = (
        friction.averaged(
            [
                contact.friction_from_dissipation
                for contact in friction.contacts(rubber, tolerance=tolerance)
            ]
        )
        for tolerance in (DESIGN_TOLERANCE, 0.02)
    )
    assert finer == pytest.approx(promised, rel=0.01)
