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
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
import scipy.optimize
import scipy.stats
from numpy.typing import NDArray

from gripscale.analysis.calibration_law import (
    Optimum,
    Points,
    Problem,
    best,
    family_of,
    free_limits,
    refined,
)
from gripscale.analysis.measured_comparison import rms
from gripscale.core import checks
from gripscale.core.errors import InputError

Array = NDArray[np.float64]

LEVEL = 0.9
"""Share of measurements like this one whose interval holds the true value."""
REACH = 2.0
"""How much further each step of a search for an end goes."""
FINE = 1e-3
"""Relative accuracy of the distance to an end."""
LESS = 1e-6
"""Relative decrease of the sum of squares beyond which another minimum has been met."""
CURVE = 25
"""Values of a parameter at which its profile is kept."""


class BetterMinimumFound(Exception):
    """A profile has met a smaller sum of squares than the fit."""

    def __init__(self, theta: Array) -> None:
        super().__init__()
        self.theta = theta


@dataclass(frozen=True)
class Profile:
    """The profile of one parameter, in the numbers the search works with.

    Parameters
    ----------
    problem, optimum
        What is fitted, and its least sum of squares.
    index : int
        Which free parameter.
    """

    problem: Problem
    optimum: Optimum
    index: int

    @property
    def centre(self) -> float:
        """Where the sum of squares is least."""
        return float(self.optimum.theta[self.index])

    def excess(self, scaled: float, start: Array | None = None) -> tuple[float, Array]:
        """Return E at a value, and what the others are there.

        Raises `BetterMinimumFound` where E is below zero.
        """
        held = self.problem.holding(self.index, scaled)
        others = np.delete(self.optimum.theta, self.index) if start is None else start
        optimum = refined(held, others)
        apart = optimum.sum_of_squares - self.optimum.sum_of_squares
        if apart < -LESS * self.optimum.sum_of_squares - 1e-12:
            raise BetterMinimumFound(np.insert(optimum.theta, self.index, scaled))
        return max(apart, 0.0), optimum.theta

    def end(self, way: int, threshold: float) -> float:
        """Return where E reaches `threshold` below (`way` -1) or above (1) the centre.

        Infinite where it does not before the limit of the search, or only because another
        parameter is held back by its own.
        """
        limit = free_limits(self.problem, self.index)[(way + 1) // 2]
        near, others = self.centre, np.delete(self.optimum.theta, self.index)
        below = 0.0
        if way * (limit - near) <= 0.0:
            return way * math.inf
        step = self._first_step(threshold)
        while True:
            far = near + way * step
            far = limit if way * (far - limit) >= 0.0 else far
            excess, met = self.excess(far, others)
            if excess >= threshold:
                return self._crossing({near: (below, others), far: (excess, met)}, threshold)
            if far == limit:
                return way * math.inf
            near, below, others, step = far, excess, met, REACH * step

    def curve(self, low: float, high: float) -> tuple[Array, Array]:
        """Return values from `low` to `high` and E there, each from its neighbour's others.

        NaN where another parameter is held back by its own limit.
        """
        values = np.linspace(low, high, CURVE)
        excess = np.empty(CURVE)
        middle = int(np.argmin(np.abs(values - self.centre)))
        for way in (range(middle, CURVE), range(middle - 1, -1, -1)):
            others = None
            for at in way:
                rise, others = self.excess(float(values[at]), others)
                held_back = self.problem.holding(self.index, values[at]).at_limit(others)
                excess[at] = math.nan if held_back else rise
        return values, excess

    def _first_step(self, threshold: float) -> float:
        """Return how far the end would be on a parabola, within reason."""
        errors = scaled_errors(self.optimum.jacobian)
        low, high = free_limits(self.problem, self.index)
        return float(np.clip(errors[self.index] * math.sqrt(threshold), 1e-6, 0.02 * (high - low)))

    def _crossing(self, solved: dict[float, tuple[float, Array]], threshold: float) -> float:
        """Return where E crosses the threshold between two values, before and behind it.

        By its root, nearly a straight line; `solved` holds E and the others at the two values.
        """
        near, far = solved
        start = solved[near][1]

        def above(scaled: float) -> float:
            if scaled not in solved:
                solved[scaled] = self.excess(scaled, start)
            return math.sqrt(solved[scaled][0]) - math.sqrt(threshold)

        fine = FINE * abs(far - self.centre)
        end = float(scipy.optimize.brentq(above, near, far, xtol=fine, rtol=1e-9))
        above(end)
        if self.problem.holding(self.index, end).at_limit(solved[end][1]):
            return math.copysign(math.inf, far - near)
        return end


def threshold_of(optimum: Optimum, *, spread_known: bool) -> float:
    """Return the excess that ends an interval, with spreads known or taken from the residuals."""
    if spread_known:
        return float(scipy.stats.chi2.ppf(LEVEL, 1))
    points, free = optimum.jacobian.shape
    ratio = float(scipy.stats.f.ppf(LEVEL, 1, points - free))
    return ratio * optimum.sum_of_squares / float(points - free)


def scaled_errors(jacobian: Array) -> Array:
    """Return the standard errors of the numbers for residuals of unit spread, shape (free,)."""
    return np.asarray(np.sqrt(np.diag(covariance(jacobian))))


def covariance(jacobian: Array) -> Array:
    """Return (J^T J)^-1; directions without any influence count as hardly having one."""
    _, sizes, rows = np.linalg.svd(jacobian, full_matrices=False)
    least = np.finfo(float).eps * max(float(sizes.max()), np.finfo(float).tiny)
    scaled = rows / np.maximum(sizes, least)[:, None]
    return np.asarray(scaled.T @ scaled)


def settled(
    problem: Problem, optimum: Optimum, find: Callable[[Optimum], list[tuple[float, float]]]
) -> tuple[Optimum, list[tuple[float, float]]]:
    """Return the optimum and what `find` makes of it, begun again where a better one is met."""
    while True:
        try:
            return optimum, find(optimum)
        except BetterMinimumFound as better:
            optimum = refined(problem, better.theta)


# What a law says of points it was not fitted to: one temperature or decade of speed left out.

WAYS = ("temperature", "speed")
"""What can be left out: a temperature to the kelvin, or a decade of speed."""


@dataclass(frozen=True)
class HeldOut:
    """One group of points left out: the errors of the law fitted to the others.

    All in friction [-]; NaN where the others cannot predict it.
    """

    value: float
    """Temperature [K], or lower end of the decade of speed [m/s]."""
    points: int
    """How many were left out."""
    rms_inside: float
    """Root mean square residual of the points that were fitted."""
    rms_outside: float
    """Root mean square error at those that were left out."""
    rms_outside_in_spread: float
    """The same over the spread; NaN where none is stated."""
    why_not: str = ""
    """Why the others cannot predict it; empty where they can."""


def held_out(
    points: Points, groups: Array, kind: str, fixed: Mapping[str, float]
) -> tuple[HeldOut, ...]:
    """Return what each group of points is predicted to be by the others.

    Parameters
    ----------
    points : Points
        All of them.
    groups : array, shape (points,)
        The value by which each belongs to a group.
    kind, fixed
        Of the law, as for `family_of`.

    Raises
    ------
    InputError
        If there is only one group.
    """
    values = np.unique(groups)
    if values.size < 2:
        raise InputError(
            f"hold_out needs at least two groups to leave one of them out; got {values.size}"
        )
    wanted = {parameter.name for parameter in family_of(kind, points, fixed).free}
    return tuple(
        _without(points, groups == value, float(value), kind, fixed, wanted) for value in values
    )


def groups_of(way: str, speed: Array, temperature: Array) -> Array:
    """Return the group of each point: its temperature to the kelvin, or its decade of speed.

    Raises `InputError` if `way` is none of `WAYS`, or a temperature is not known.
    """
    if checks.one_of("hold_out", way, WAYS) == "speed":
        return np.asarray(10.0 ** np.floor(np.log10(speed) + 1e-9))
    if np.isnan(temperature).any():
        raise InputError(
            "hold_out = temperature needs the temperature of every point; got "
            f"{np.isnan(temperature).sum()} without one"
        )
    return np.asarray(np.round(temperature))


def _without(
    points: Points,
    left_out: NDArray[np.bool_],
    value: float,
    kind: str,
    fixed: Mapping[str, float],
    wanted: set[str],
) -> HeldOut:
    count, rest = int(left_out.sum()), points.only(~left_out)
    try:
        family = family_of(kind, rest, fixed)
    except InputError as error:
        return HeldOut(value, count, math.nan, math.nan, math.nan, str(error))
    missing = wanted - {parameter.name for parameter in family.free}
    if missing:
        why = f"the other points do not determine {', '.join(sorted(missing))}"
        return HeldOut(value, count, math.nan, math.nan, math.nan, why)
    theta = best(Problem(rest, family)).theta
    inside, outside = (
        _apart(Problem(some, family), theta) for some in (rest, points.only(left_out))
    )
    spread = points.spread
    relative = np.full(count, np.nan) if spread is None else outside / spread[left_out]
    return HeldOut(value, count, float(rms(inside)), float(rms(outside)), float(rms(relative)))


def _apart(problem: Problem, theta: Array) -> Array:
    return problem.friction(theta) - problem.points.difference
