"""Profile likelihood: how far a parameter can go while all others do their best to follow.

    E(x) = min over the others of S(x, others) - S_min

An interval holds every x with E(x) below a threshold: chi^2_1 where the spreads are known, and
F_(1, n - k) times S_min/(n - k) where the scatter of the residuals stands for them. Unlike the
standard error it follows a curved valley, and finds an end that is not there.

Source: S. M. Murphy & A. W. van der Vaart, J. Am. Stat. Assoc. 95 (2000) 449,
doi:10.1080/01621459.2000.10474219; D. M. Bates & D. G. Watts, Nonlinear Regression Analysis and
its Applications (1988), sec. 6.1, doi:10.1002/9780470316757.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import scipy

from gripscale.core import Array, InputError, checks
from gripscale.questions.calibration import calibration_law as fit
from gripscale.questions.calibration.calibration_law import CalibrationProblem, FittedLaw
from gripscale.questions.calibration.measured_comparison import rms

_REACH = 2.0  # how much further each step of a search for an end goes
_FINE = 1e-3  # relative accuracy of the distance to an end
LESS = 1e-6  # relative decrease of the sum of squares beyond which another minimum has been met


class BetterMinimumFound(Exception):
    """A profile has met a smaller sum of squares than the fit."""

    def __init__(self, theta: Array) -> None:
        super().__init__()
        self.theta = theta


@dataclass(frozen=True)
class LikelihoodProfile:
    """The profile of one parameter, in the numbers the search works with."""

    optimum: FittedLaw
    index: int  # of the free parameter

    @property
    def centre(self) -> float:
        """Where the sum of squares is least."""
        return float(self.optimum.theta[self.index])

    @property
    def limits(self) -> tuple[float, float]:
        """Limits of the search."""
        return self.optimum.problem.free[self.index].limits

    def excess(self, scaled: float, start: Array | None = None) -> tuple[float, Array]:
        """Return E at a value and the others there; raise `BetterMinimumFound` if E < 0."""
        held = self.optimum.problem.holding(self.index, scaled)
        others = np.delete(self.optimum.theta, self.index) if start is None else start
        optimum = fit.refined(held, others)
        apart = optimum.sum_of_squares - self.optimum.sum_of_squares
        if apart < -LESS * self.optimum.sum_of_squares - 1e-12:
            raise BetterMinimumFound(np.insert(optimum.theta, self.index, scaled))
        return max(apart, 0.0), optimum.theta

    def held_back(self, scaled: float, others: Array) -> bool:
        """Return whether one of the others at a value is at a limit of its own."""
        return self.optimum.problem.holding(self.index, scaled).at_limit(others)

    def end(self, way: int) -> float:
        """Return where E reaches its threshold below (`way` -1) or above (1) the centre.

        Infinite where it does not before the limit of the search, or only because another
        parameter is held back by its own. Between two values before and behind it the root of E,
        nearly a straight line, is followed.
        """
        threshold, (low, high) = self.optimum.threshold, self.limits
        limit, near = (high if way > 0 else low), self.centre
        if way * (limit - near) <= 0.0:
            return way * math.inf
        # how far the end would be on a parabola, within reason
        error = np.sqrt(np.diag(self.optimum.covariance))[self.index]
        step = float(np.clip(error * math.sqrt(threshold), 1e-6, 0.02 * (high - low)))
        solved = {near: (0.0, np.delete(self.optimum.theta, self.index))}
        while True:
            far, start = near + way * step, solved[near][1]
            far = limit if way * (far - limit) >= 0.0 else far
            solved[far] = self.excess(far, start)
            if solved[far][0] >= threshold:
                break
            if far == limit:
                return way * math.inf
            near, step = far, _REACH * step

        def above(scaled: float) -> float:
            if scaled not in solved:
                solved[scaled] = self.excess(scaled, start)
            return math.sqrt(solved[scaled][0]) - math.sqrt(threshold)

        fine = _FINE * abs(far - self.centre)
        end = float(scipy.optimize.brentq(above, near, far, xtol=fine, rtol=1e-9))
        above(end)
        return way * math.inf if self.held_back(end, solved[end][1]) else end


def intervals(problem: CalibrationProblem) -> tuple[FittedLaw, tuple[tuple[float, float], ...]]:
    """Return the optimum and both ends of the interval of each free parameter.

    Begun again where a profile meets a better optimum.
    """
    optimum = fit.best(problem)
    while True:
        profiles = [LikelihoodProfile(optimum, at) for at in range(len(problem.free))]
        try:
            return optimum, tuple((profile.end(-1), profile.end(1)) for profile in profiles)
        except BetterMinimumFound as better:
            optimum = fit.refined(problem, better.theta)


# What can be left out: a temperature to the kelvin, or a decade of speed.
WAYS = ("temperature", "speed")


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
        unknown = float(value), count, math.nan, math.nan, math.nan
        try:
            problem = fit.problem_of(kind, rest, fixed)
        except InputError as error:
            rows.append((*unknown, str(error)))
            continue
        if missing := wanted - {parameter.name for parameter in problem.free}:
            why = f"the other points do not determine {', '.join(sorted(missing))}"
            rows.append((*unknown, why))
            continue
        theta = fit.best(problem).theta
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
    if checks.one_of("hold_out", way, WAYS) == "speed":
        return np.asarray(10.0 ** np.floor(np.log10(speed) + 1e-9))
    if np.isnan(temperature).any():
        raise InputError(
            "hold_out = temperature needs the temperature of every point; got "
            f"{np.isnan(temperature).sum()} without one"
        )
    return np.asarray(np.round(temperature))
