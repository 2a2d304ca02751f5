"""What a law says of points it was not fitted to: one temperature or decade of speed left out."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gripscale import checks
from gripscale.calibration.least_squares import Problem, best
from gripscale.calibration.parameters import family_of
from gripscale.calibration.points import Points
from gripscale.errors import InputError
from gripscale.measured.differences import rms

Array = NDArray[np.float64]

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
    wanted = {one.name for one in family_of(kind, points, fixed).free}
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
    missing = wanted - {one.name for one in family.free}
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
