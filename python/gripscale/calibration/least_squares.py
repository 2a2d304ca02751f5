"""Weighted least squares of a law: the best parameters, and the best with one of them held.

    S(theta) = sum_i ((mu_i - mu_hysteresis,i - tau_f(v_i, T_i; theta) A_r,i/(A_0 p_i)) / s_i)^2

with the spreads s_i, or one where none is stated.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
import scipy.optimize
from numpy.typing import NDArray

from gripscale.calibration.parameters import Family, Parameter
from gripscale.calibration.points import Points

Array = NDArray[np.float64]

BEST_STARTS = 3
"""Starts, of all that are tried, from which the search goes on to its end."""
TOLERANCE = 1e-8
AT_LIMIT = 1e-3
"""Share of the range of a parameter within which it is at a limit."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """The least sum of squares that was found."""

    theta: Array
    """Numbers of the free parameters, as the search works with them."""
    sum_of_squares: float
    jacobian: Array
    """Of the residuals by them, shape (points, free parameters)."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A law to be fitted to points."""

    points: Points
    family: Family

    def friction(self, theta: Array) -> Array:
        """Return the friction of the area term at the points [-]."""
        law = self.family.law(theta)
        return self.points.leverage * law.stress(self.points.speed, self.points.temperature)

    def residuals(self, theta: Array) -> Array:
        """Return modelled less measured friction over the spread, shape (points,)."""
        apart = self.friction(theta) - self.points.difference
        return apart if self.points.spread is None else apart / self.points.spread

    def at_limit(self, theta: Array) -> bool:
        """Return whether a parameter has gone as far as it is sought; zero itself is no limit."""
        pairs = zip(self.family.free, theta, strict=True)
        return any(
            abs(x - end) < AT_LIMIT * (one.limits[1] - one.limits[0])
            for one, x in pairs
            for end, value in zip(one.limits, (one.low, one.high), strict=True)
            if value != 0.0
        )

    def holding(self, place: int, scaled: float) -> Problem:
        """Return the problem with the free parameter at `place` held."""
        one = self.family.free[place]
        free = self.family.free[:place] + self.family.free[place + 1 :]
        held = {**self.family.held, one.name: one.value(scaled)}
        return replace(self, family=replace(self.family, free=free, held=held))


def best(problem: Problem) -> Optimum:
    """Return the least sum of squares over a grid of starts."""
    starts = sorted(map(tuple, _starts(problem)), key=lambda one: _cost(problem, np.array(one)))
    found = [refined(problem, np.array(one)) for one in starts[:BEST_STARTS]]
    return min(found, key=lambda one: one.sum_of_squares)


def refined(problem: Problem, start: Array) -> Optimum:
    """Return the least sum of squares near `start`."""
    if not problem.family.free:
        residuals = problem.residuals(start)
        return Optimum(start, float(residuals @ residuals), np.empty((residuals.size, 0)))
    low, high = _limits(problem.family.free)
    inside = np.clip(start, low, high)
    found = scipy.optimize.least_squares(
        problem.residuals,
        inside,
        bounds=(low, high),
        xtol=TOLERANCE,
        ftol=TOLERANCE,
        gtol=TOLERANCE,
    )
    return Optimum(found.x, 2.0 * float(found.cost), np.asarray(found.jac))


def _starts(problem: Problem) -> list[Array]:
    """Return every combination of starts; the stress, which is a factor, the best for each."""
    free = problem.family.free
    grid = [[one.scaled(value) for value in one.starts] for one in free]
    return [_with_best_stress(problem, np.array(theta)) for theta in product(*grid)]


def _with_best_stress(problem: Problem, theta: Array) -> Array:
    names = [one.name for one in problem.family.free]
    if "stress_0" not in names:
        return theta
    at = names.index("stress_0")
    weight = 1.0 if problem.points.spread is None else 1.0 / problem.points.spread
    shape, wanted = problem.friction(theta) * weight, problem.points.difference * weight
    square = float(shape @ shape)
    factor = float(shape @ wanted) / square if square > 0.0 else 0.0
    if factor > 0.0:
        theta[at] = np.clip(theta[at] + np.log(factor), *free_limits(problem, at))
    return theta


def free_limits(problem: Problem, place: int) -> tuple[float, float]:
    """Return between which numbers a free parameter is sought."""
    return problem.family.free[place].limits


def _limits(free: tuple[Parameter, ...]) -> tuple[Array, Array]:
    low, high = zip(*(one.limits for one in free), strict=True)
    return np.array(low), np.array(high)


def _cost(problem: Problem, theta: Array) -> float:
    residuals = problem.residuals(theta)
    return float(residuals @ residuals)
