"""The search for the admissible compound with the most friction.

    maximise sum_k W_k ln mu_k(r)    within the polytope of admissible r (`compound_limits`)

Steps to the best corner of the polytope find the optimum where the limits decide (M. Frank & P.
Wolfe, Nav. Res. Logist. Q. 3 (1956) 95), sequential quadratic programming elsewhere (scipy's SLSQP;
D. Kraft, DFVLR-FB 88-28 (1988)).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from gripscale.case import Case
from gripscale.core import Array, InputError, worker_count
from gripscale.questions.design import compound_limits
from gripscale.questions.design.compound_limits import AdmissibleChanges, CompoundLimits, PointLimit
from gripscale.questions.design.goal_friction import CompoundGoal, GoalFriction
from gripscale.questions.vary.inputs import surface_of
from gripscale.rubber import Rubber
from gripscale.surface import Surface

LEAST_GAP = 1e-4  # gap at which the search ends [-]
MOST_CORNERS = 8
SHORTEST_STEP = 0.05
_ROUNDING = 1e-6  # violation of a limit that is none
PRECISION = 1e-5  # change of ln mu at which quadratic programming ends
MOST_STEPS = 100
MOST_HALVINGS = 6
GIVEN_AWAY = 1e-3  # part of ln mu that a design gives away to stay near today's compound
LARGEST_FACTOR, PER_DECADE = "largest factor on a modulus", "largest change per decade"
ROLLING_LEVEL = "rolling resistance"  # what is limited, beside ranges of moduli
WIDER = 1.1  # factor on a limit whose worth is asked for
DOWNWARD = 4  # levels below today's, down to the least that the limits admit
UPWARD = (1.15, 1.3)  # levels above today's
_LEVEL_STEP = 1e-6  # relative width of the interval at which the search for the least level ends
NEAR_LEAST = 1.01  # lowest level over the least: at the least itself a single change is left


@dataclass(frozen=True)
class DesignProblem:
    """Goals, limits and today's compound."""

    friction: GoalFriction
    limits: CompoundLimits
    rolling: tuple[PointLimit, ...]  # `rolling_band`
    roads: Mapping[str, Surface] = field(default_factory=dict)  # of the goals, by their names

    @property
    def rubber(self) -> Rubber:
        """Today's compound."""
        return self.friction.rubber

    @property
    def unchanged(self) -> Array:
        """Ratios of today's moduli over today's [-]: where each search begins."""
        return np.ones(1 + self.rubber.moduli.size)

    def admissible(self, level: float = math.inf) -> AdmissibleChanges:
        """Return the changes with a rolling resistance of at most `level` times today's."""
        rolling = [replace(point, high=level) for point in self.rolling]
        return AdmissibleChanges.of(self.rubber, self.limits, rolling)

    def least_level(self) -> float:
        """Return the least rolling resistance over today's [-] that the limits admit.

        The interval that holds it is halved. Raises `InputError` if no change is admissible.
        """
        if not self.admissible().possible:
            raise InputError(
                "the limits must leave an admissible change; got limits on the moduli that "
                "contradict one another within the largest factors"
            )
        low, high = 0.0, 1.0
        while not self.admissible(high).possible:
            low, high = high, 2.0 * high
        while high - low > _LEVEL_STEP * high:
            level = 0.5 * (low + high)
            low, high = (low, level) if self.admissible(level).possible else (level, high)
        return high

    def worth_of_limits(self, level: float, slope: Array) -> dict[str, float]:
        """Return what a tenth more room gives in ln mu [-], by what is limited, to first order.

        `slope` is the gradient at the optimum of the level. A range of moduli gets wider at both
        ends.
        """
        limits, narrow = self.limits, self.admissible(level)
        larger = replace(limits, largest_factor=WIDER * limits.largest_factor)
        steeper = replace(limits, factor_per_decade=WIDER * limits.factor_per_decade)
        wider = {
            LARGEST_FACTOR: replace(narrow, limits=larger),
            PER_DECADE: replace(narrow, limits=steeper),
        }
        for i, point in enumerate(narrow.points):
            room = replace(point, low=point.low / WIDER, high=point.high * WIDER)
            ranges = (*narrow.points[:i], room, *narrow.points[i + 1 :])
            wider[str(point)] = replace(narrow, points=ranges)
        wider[ROLLING_LEVEL] = self.admissible(WIDER * level)
        least = _most(narrow, slope)
        return {name: _most(admissible, slope) - least for name, admissible in wider.items()}

    def default_levels(self) -> list[float]:
        """Return today's level, some down to the least that is admissible, and some above."""
        least = NEAR_LEAST * self.least_level()
        return [1.0, *np.linspace(1.0, least, DOWNWARD + 1)[1:].tolist(), *UPWARD]


def _most(admissible: AdmissibleChanges, slope: Array) -> float:
    """Return the largest slope . r of the admissible changes, NaN without one."""
    corner = admissible.best(slope)
    return math.nan if corner is None else float(slope @ corner)


@dataclass(frozen=True)
class CompoundOptimum:
    """The best admissible change at one level.

    The gap is max g . (s - r) over all admissible s, with g the gradient of ln mu at r.
    """

    ratio: Array  # moduli over today's [-], E_inf first
    log_friction: float  # weighted mean of ln mu on the grid of the search [-]
    slope: Array  # its gradient by the ratios [-]
    gap: float  # what any admissible change could still gain in ln mu, to first order [-]


def best_change(
    friction: GoalFriction, admissible: AdmissibleChanges, start: Array
) -> CompoundOptimum:
    """Return the admissible change with the largest friction, sought from `start`."""
    optimum = _corner_steps(friction, admissible, start)
    if optimum.gap <= LEAST_GAP:
        return optimum

    def negative(ratio: Array) -> tuple[float, Array]:
        value, slope = friction.log_friction(ratio)
        return -value, -slope

    inside = _descent(negative, optimum.ratio, admissible, *admissible.rows)
    further = _corner_steps(friction, admissible, inside)
    return max(optimum, further, key=lambda end: end.log_friction)


def nearest_design(
    friction: GoalFriction, admissible: AdmissibleChanges, optimum: CompoundOptimum
) -> CompoundOptimum:
    """Return the change with the least sum of ln(r_i)^2 and almost the friction of the optimum.

    Friction falls faster than to first order away from the optimum: the step is halved until it
    does not give away more than `GIVEN_AWAY`, which counts in its gap.
    """
    matrix, most = admissible.rows
    matrix = np.vstack([matrix, -optimum.slope])
    most = np.append(most, GIVEN_AWAY - float(optimum.slope @ optimum.ratio))

    def distance(ratio: Array) -> tuple[float, Array]:
        logarithm = np.log(ratio)
        return float(logarithm @ logarithm), 2.0 * logarithm / ratio

    ratio = _descent(distance, optimum.ratio, admissible, matrix, most)
    if admissible.violation(ratio) > _ROUNDING:
        return optimum
    for _ in range(MOST_HALVINGS):
        value, slope = friction.log_friction(ratio)
        if value >= optimum.log_friction - GIVEN_AWAY - PRECISION:
            return CompoundOptimum(ratio, value, slope, optimum.log_friction - value + optimum.gap)
        ratio = 0.5 * (ratio + optimum.ratio)
    return optimum


Objective = Callable[[Array], tuple[float, Array]]


def _descent(function: Objective, start: Array, limits: AdmissibleChanges, *rows: Array) -> Array:
    """Return where SLSQP ends on a function with its gradient, where matrix . r <= most."""
    from scipy.optimize import minimize

    matrix, most = rows
    settings: dict[str, Any] = {
        "bounds": [limits.bounds] * matrix.shape[1],
        "constraints": {
            "type": "ineq", "fun": lambda r: most - matrix @ r, "jac": lambda _: -matrix
        },
        "options": {"ftol": PRECISION, "maxiter": MOST_STEPS},
    }  # fmt: skip
    solved = minimize(function, start, jac=True, method="SLSQP", **settings)
    return np.asarray(np.clip(solved.x, *limits.bounds), dtype=float)


def _corner_steps(
    friction: GoalFriction, admissible: AdmissibleChanges, start: Array
) -> CompoundOptimum:
    """Return the end of steps to the best corner of the linear programme, shorter where it fails.

    The start may be outside the polytope; the first step then goes the whole way.
    """
    ratio = start
    value, slope = friction.log_friction(ratio)
    outside = admissible.violation(ratio) > _ROUNDING
    step, gap = 1.0, math.inf
    for _ in range(MOST_CORNERS):
        corner = admissible.best(slope)
        assert corner is not None
        gap = float(slope @ (corner - ratio))
        if gap < LEAST_GAP and not outside:
            break
        following = ratio + (1.0 if outside else step) * (corner - ratio)
        raised, turned = friction.log_friction(following)
        if raised > value or outside:
            ratio, value, slope, step = following, raised, turned, 1.0
            outside = False
        elif step < SHORTEST_STEP:
            break
        else:
            step *= 0.25
    return CompoundOptimum(ratio, value, slope, gap)


def default_goal(case: Case) -> CompoundGoal:
    """Return the goal of a case: its load, and its temperature before the contact."""
    temperature = None if case.conditions is None else case.conditions.temperature
    return CompoundGoal(case.load.speed, case.load.pressure, temperature)


def design_problem(
    case: Case,
    goals: Sequence[CompoundGoal] = (),
    limits: CompoundLimits | None = None,
    workers: int | None = None,
    surfaces: Mapping[str, Any] | None = None,
) -> DesignProblem:
    """Return the problem that a case, goals and limits make; arguments as `gripscale.design`."""
    rubber = case.rubber
    if not rubber.moduli.size:
        raise InputError("a design needs a rubber that relaxes; got an elastic one")
    wanted = list(goals) or [default_goal(case)]
    named = {goal.road: (surfaces or {}).get(goal.road, goal.road) for goal in wanted}
    roads = {name: surface_of(road, case) for name, road in named.items()}
    band = compound_limits.rolling_band(rubber)
    friction = GoalFriction.of(rubber, wanted, roads, worker_count(workers), case.load.thickness)
    return DesignProblem(friction, limits or CompoundLimits(), band, roads)
