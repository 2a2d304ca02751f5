"""The search for the admissible compound with the most friction.

    maximise sum_k W_k ln mu_k(r)    within the polytope of admissible r (`compound_limits`)

The objective is smooth in r, its gradient comes from one adjoint solution a contact
(`goal_friction`), and all limits are linear: sequential quadratic programming (scipy's SLSQP; D.
Kraft, DFVLR-FB 88-28 (1988)) stays admissible and takes some ten to twenty gradients. Its end is
judged by the linear programme

    gap = max g . (s - r)  over all admissible s,    g the gradient at r:

no admissible change gains more than `gap` in ln mu to first order.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from gripscale.analysis.compound_limits import (
    AdmissibleChanges,
    CompoundLimits,
    PointLimit,
    rubber_at,
)
from gripscale.analysis.goal_friction import CompoundGoal, GoalFriction
from gripscale.case.read import CaseFile
from gripscale.core.arrays import Array
from gripscale.core.errors import InputError
from gripscale.core.parallel import worker_count
from gripscale.core.units import ZERO_CELSIUS
from gripscale.experiment.inputs import case_rubber, surface_of
from gripscale.rubber import Rubber

PRECISION = 1e-5
"""Change of ln mu at which the search ends."""
MOST_STEPS = 40
ROLLING = ZERO_CELSIUS + 60.0
"""Temperature of the loss factor that stands for rolling resistance [K]."""
FREQUENCY = 10.0
"""Its frequency [Hz]."""
DOWNWARD = 4
"""Levels below today's, down to the least that the limits admit."""
UPWARD = (1.15, 1.3)
"""Levels above today's."""
NEAR_LEAST = 1.01
"""Lowest level over the least: at the least itself a single change is left."""


@dataclass(frozen=True)
class DesignProblem:
    """Goals, limits and today's compound."""

    friction: GoalFriction
    limits: CompoundLimits
    rolling: PointLimit
    """The loss factor that stands for rolling resistance; its upper end is today's."""

    @property
    def rubber(self) -> Rubber:
        """Today's compound."""
        return self.friction.rubber

    def admissible(self, level: float = math.inf) -> AdmissibleChanges:
        """Return the changes with a rolling loss factor of at most `level` times today's."""
        rolling = PointLimit(
            "loss_factor", 0.0, level, self.rolling.frequency, self.rolling.temperature
        )
        return AdmissibleChanges.of(self.rubber, self.limits, [rolling])

    def rolling_loss_factor(self, rubber: Rubber) -> float:
        """Return tan(delta) of a compound at the rolling condition [-]."""
        body = rubber_at(rubber, self.rolling.temperature)
        return float(body.loss_factor(2.0 * math.pi * self.rolling.frequency))

    def rolling_ratio(self, rubber: Rubber) -> float:
        """Return tan(delta) of a compound at the rolling condition over today's [-]."""
        return self.rolling_loss_factor(rubber) / self.rolling_loss_factor(self.rubber)

    def default_levels(self) -> list[float]:
        """Return levels in the order they are solved: today's, then down, then up."""
        least = NEAR_LEAST * self.admissible().least_loss_factor(self.rolling)
        return [1.0, *np.linspace(1.0, least, DOWNWARD + 1)[1:].tolist(), *UPWARD]


@dataclass(frozen=True)
class Optimum:
    """The best admissible change at one level."""

    ratio: Array
    """Moduli over today's [-], E_inf first."""
    log_friction: float
    """Weighted mean of ln mu on the grid of the search [-]."""
    gap: float
    """What any admissible change could still gain in ln mu, to first order [-]."""


def best_change(friction: GoalFriction, admissible: AdmissibleChanges, start: Array) -> Optimum:
    """Return the admissible change with the largest friction, sought from `start`.

    Raises `InputError` if no change is admissible.
    """
    from scipy.optimize import minimize

    matrix, most = admissible.rows
    if admissible.best(np.zeros(start.size)) is None:
        raise InputError(
            "the limits must leave an admissible change; got limits on the moduli that "
            "contradict one another within the largest factors"
        )

    def negative(ratio: Array) -> tuple[float, Array]:
        value, slope = friction.log_friction(ratio)
        return -value, -slope

    settings: dict[str, Any] = {
        "jac": True,
        "method": "SLSQP",
        "bounds": [admissible.bounds] * start.size,
        "constraints": {
            "type": "ineq",
            "fun": lambda ratio: most - matrix @ ratio,
            "jac": lambda ratio: -matrix,
        },
        "options": {"ftol": PRECISION, "maxiter": MOST_STEPS},
    }
    solved = minimize(negative, start, **settings)
    ratio = np.clip(np.asarray(solved.x, dtype=float), *admissible.bounds)
    value, slope = friction.log_friction(ratio)
    corner = admissible.best(slope)
    gap = math.nan if corner is None else float(slope @ (corner - ratio))
    return Optimum(ratio, value, gap)


def default_goal(file: CaseFile) -> CompoundGoal:
    """Return the goal of a case: its load, and its temperature before the contact."""
    load = file.case.load
    return CompoundGoal(load.speed, load.pressure, file.case.conditions.temperature)


def design_problem(
    file: CaseFile,
    goals: Sequence[CompoundGoal] = (),
    limits: CompoundLimits | None = None,
    workers: int | None = None,
) -> DesignProblem:
    """Return the problem that a case, goals and limits make; arguments as `design_compound`."""
    rubber = case_rubber(file)
    wanted = list(goals) or [default_goal(file)]
    roads = {goal.road: surface_of(goal.road, file) for goal in wanted}
    friction = GoalFriction.of(rubber, wanted, roads, worker_count(workers))
    rolling = PointLimit(
        "loss_factor", 0.0, 1.0, FREQUENCY, None if rubber.shift is None else ROLLING
    )
    return DesignProblem(friction, limits or CompoundLimits(), rolling)
