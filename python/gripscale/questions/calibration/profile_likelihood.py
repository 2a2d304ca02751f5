"""Profile likelihood: how far a parameter can go while all others do their best to follow.

    E(x) = min over the others of S(x, others) - S_min

An interval holds every x with E(x) below a threshold (S. M. Murphy & A. W. van der Vaart, J. Am.
Stat. Assoc. 95 (2000) 449, doi:10.1080/01621459.2000.10474219): docs/derivations.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np
import scipy

from gripscale.core import Array, InputError, checks
from gripscale.questions.calibration import calibration_law as fit
from gripscale.questions.calibration.calibration_law import CalibrationProblem
from gripscale.questions.calibration.measured_comparison import rms

LIKELIHOOD_LEVEL = 0.9  # share of measurements like this one whose interval holds the true value
BEST_STARTS = 3  # starts, of all that are tried, from which the search goes on to its end
_REACH = 2.0  # how much further each step of a search for an end goes
_FINE = 1e-3  # relative accuracy of the distance to an end
LESS = 1e-6  # relative decrease of the sum of squares beyond which another minimum has been met


class BetterMinimumFound(Exception):
    """A profile has met a smaller sum of squares than the fit."""

    def __init__(self, theta: Array) -> None:
        super().__init__()
        self.theta = theta


@dataclass(frozen=True, eq=False)
class FittedLaw:
    """The least sum of squares that was found."""

    problem: CalibrationProblem
    theta: Array  # numbers of the free parameters, as the search works with them
    sum_of_squares: float
    jacobian: Array  # of the residuals by them, shape (points, free parameters)

    @property
    def freedom(self) -> int:
        """Degrees of freedom: points less parameters."""
        return self.problem.points.speed.size - len(self.problem.free)

    @property
    def spread_known(self) -> bool:
        """Whether the spread was stated, and not taken from the residuals."""
        return self.problem.points.spread is not None

    @property
    def scatter(self) -> float:
        """Root of S over the degrees of freedom, in units of the spread if it is stated [-]."""
        return math.sqrt(self.sum_of_squares / self.freedom)

    @property
    def unit(self) -> float:
        """Sum of squares that one standard error adds."""
        return 1.0 if self.spread_known else self.scatter**2

    @property
    def quantile(self) -> float:
        """Half width of an interval at `LIKELIHOOD_LEVEL` over a standard error."""
        tail = 0.5 * (1.0 + LIKELIHOOD_LEVEL)
        if self.spread_known:
            return float(scipy.special.ndtri(tail))
        return float(scipy.special.stdtrit(self.freedom, tail))

    @property
    def covariance(self) -> Array:
        """(J^T J)^-1; directions without any influence count as hardly having one."""
        _, sizes, rows = np.linalg.svd(self.jacobian, full_matrices=False)
        least = np.finfo(float).eps * max(float(sizes.max()), np.finfo(float).tiny)
        scaled = rows / np.maximum(sizes, least)[:, None]
        return np.asarray(scaled.T @ scaled)

    @property
    def threshold(self) -> float:
        """Excess that ends an interval, with spreads stated or taken from the residuals."""
        if self.spread_known:
            return float(scipy.special.chdtri(1, 1.0 - LIKELIHOOD_LEVEL))
        ratio = float(scipy.special.fdtri(1, self.freedom, LIKELIHOOD_LEVEL))
        return ratio * self.sum_of_squares / float(self.freedom)

    def excess(self, at: int, scaled: float, start: Array | None = None) -> tuple[float, Array]:
        """Return E where free parameter `at` has a value, and the others there.

        Raises `BetterMinimumFound` if E < 0.
        """
        others = np.delete(self.theta, at) if start is None else start
        optimum = refined(self.problem.holding(at, scaled), others)
        apart = optimum.sum_of_squares - self.sum_of_squares
        if apart < -LESS * self.sum_of_squares - 1e-12:
            raise BetterMinimumFound(np.insert(optimum.theta, at, scaled))
        return max(apart, 0.0), optimum.theta

    def end(self, at: int, way: int) -> float:
        """Return where E reaches its threshold below (`way` -1) or above (1) free parameter `at`.

        Infinite where it does not before the limit of the search, or only because another
        parameter is held back by its own. Between two values before and behind it the root of E,
        nearly a straight line, is followed.
        """
        threshold, (low, high) = self.threshold, self.problem.free[at].limits
        centre = near = float(self.theta[at])
        limit = high if way > 0 else low
        if way * (limit - near) <= 0.0:
            return way * math.inf
        # how far the end would be on a parabola, within reason
        error = np.sqrt(np.diag(self.covariance))[at]
        step = float(np.clip(error * math.sqrt(threshold), 1e-6, 0.02 * (high - low)))
        solved = {near: (0.0, np.delete(self.theta, at))}
        while True:
            far, start = near + way * step, solved[near][1]
            far = limit if way * (far - limit) >= 0.0 else far
            solved[far] = self.excess(at, far, start)
            if solved[far][0] >= threshold:
                break
            if far == limit:
                return way * math.inf
            near, step = far, _REACH * step

        def above(scaled: float) -> float:
            if scaled not in solved:
                solved[scaled] = self.excess(at, scaled, start)
            return math.sqrt(solved[scaled][0]) - math.sqrt(threshold)

        fine = _FINE * abs(far - centre)
        end = float(scipy.optimize.brentq(above, near, far, xtol=fine, rtol=1e-9))
        above(end)
        held_back = self.problem.holding(at, end).at_limit(solved[end][1])
        return way * math.inf if held_back else end


def best(problem: CalibrationProblem) -> FittedLaw:
    """Return the least sum of squares over a grid of starts."""
    grid = product(*([each.scaled(value) for value in each.starts] for each in problem.free))
    starts = [problem.with_best_stress(np.array(theta)) for theta in grid]
    starts.sort(key=problem.sum_of_squares)
    optima = [refined(problem, start) for start in starts[:BEST_STARTS]]
    return min(optima, key=lambda optimum: optimum.sum_of_squares)


def refined(problem: CalibrationProblem, start: Array) -> FittedLaw:
    """Return the least sum of squares near `start`."""
    if not problem.free:
        none = np.empty((problem.points.speed.size, 0))
        return FittedLaw(problem, start, problem.sum_of_squares(start), none)
    low, high = np.array([parameter.limits for parameter in problem.free]).T
    solution = scipy.optimize.least_squares(
        problem.residuals, np.clip(start, low, high), bounds=(low, high)
    )
    return FittedLaw(problem, solution.x, 2.0 * float(solution.cost), np.asarray(solution.jac))


def intervals(problem: CalibrationProblem) -> tuple[FittedLaw, tuple[tuple[float, float], ...]]:
    """Return the optimum and both ends of the interval of each free parameter."""
    optimum = best(problem)
    while True:
        try:
            ends = ((optimum.end(at, -1), optimum.end(at, 1)) for at in range(len(problem.free)))
            return optimum, tuple(ends)
        except BetterMinimumFound as better:
            optimum = refined(problem, better.theta)


# What is known of each group of points that is left out, over `left_out`.
_LEFT_OUT = {
    "left_out": "temperature [K] or decade [m/s]",
    "points": "measured points left out",
    "rms_inside": "rms residual of the points that were fitted",
    "rms_outside": "rms error at the points left out",
    "rms_outside_in_spread": "the same, over the spread",
    "why_not": "why the other points cannot predict them, empty where they can",
}


def held_out(
    points: fit.Points, groups: Array, kind: str, fixed: Mapping[str, float]
) -> dict[str, tuple[str, list[Any], str]]:
    """Return how well each group of points is predicted by the others, as columns of a Dataset.

    `groups` holds a value for each point; `kind` and `fixed` are of the law, as for `problem_of`.
    Errors are in friction [-]; NaN where the others cannot predict it, or no spread is stated.
    """
    values = np.unique(groups)
    if values.size < 2:
        raise InputError(
            f"hold_out needs at least two groups to leave one of them out; got {values.size}"
        )
    wanted = {parameter.name for parameter in fit.problem_of(kind, points, fixed).free}
    rows: list[tuple[Any, ...]] = []
    for value in values:
        chosen = groups == value
        count, rest, some = int(chosen.sum()), points.only(~chosen), points.only(chosen)
        try:
            problem = fit.problem_of(kind, rest, fixed)
            if missing := wanted - {parameter.name for parameter in problem.free}:
                names = ", ".join(sorted(missing))
                raise InputError(f"the other points do not determine {names}")
        except InputError as error:
            rows.append((float(value), count, math.nan, math.nan, math.nan, str(error)))
            continue
        theta = best(problem).theta
        inside, outside = (
            replace(problem, points=part).friction(theta) - part.difference for part in (rest, some)
        )
        relative = np.full(count, np.nan) if some.spread is None else outside / some.spread
        errors = (float(rms(each)) for each in (inside, outside, relative))
        rows.append((float(value), count, *errors, ""))
    return {
        name: ("left_out", [*column], text)
        for (name, text), column in zip(_LEFT_OUT.items(), zip(*rows, strict=True), strict=True)
    }


def groups_of(way: str, speed: Array, temperature: Array) -> Array:
    """Return the group of each point: its temperature to the kelvin, or its decade of speed."""
    if checks.one_of("hold_out", way, ("temperature", "speed")) == "speed":
        return np.asarray(10.0 ** np.floor(np.log10(speed) + 1e-9))
    if np.isnan(temperature).any():
        raise InputError(
            "hold_out = temperature needs the temperature of every point; got "
            f"{np.isnan(temperature).sum()} without one"
        )
    return np.asarray(np.round(temperature))
