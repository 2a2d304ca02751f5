"""How far curves lie apart that should be one: friction at several temperatures over a_T v.

The curves have points at abscissas of their own. At each point of one, another is interpolated by
the polynomial through its six nearest points, in the logarithms of both. Its error is taken as

    e(x) = 4 (x - a)(b - x)/(b - a)^2 max |P_6 - P_4|

between the neighbours a and b, with the difference to the polynomial through four points at the
middle of this interval and the two beside it: that of the coarser one, and no accident of a change
of sign. At a point the curves share it is nothing. Only points where it is at most `TRUSTED` count,
and between points further apart than `WIDEST` it counts as infinite: friction of a series of one
relaxation time a decade may ripple by the decade, which coarser points do not show. So curves that
are one are found to lie less than 1e-3 apart, however coarse their points.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
Curve = tuple[Array, Array]

TRUSTED = 4e-4
"""Relative error of the interpolation up to which two curves are compared."""
NEAREST, FEWER = 6, 4
"""Points of the interpolation, and of the one that tells its error."""
PER_DECADE = 6
"""Points of a curve in a power of ten of its abscissa, at least, to be interpolated."""
WIDEST = math.log(10.0) / PER_DECADE
SAME = 1e-9
"""Difference of two logarithms that is rounding."""


@dataclass(frozen=True)
class Collapse:
    """How far curves lie apart where they overlap."""

    distance: float
    """Largest, relative to the curve that has a point there [-]; NaN if nothing can be compared."""
    interpolation_error: float
    """Largest estimated error of what was compared [-]."""
    points: int
    """Compared."""
    overlapping: int
    """Points at which two curves overlap, those between too coarse points included."""


def collapse(curves: Sequence[tuple[ArrayLike, ArrayLike]]) -> Collapse:
    """Return how far curves lie apart.

    Parameters
    ----------
    curves : sequence of (x, y)
        Abscissas and values, arrays of the same shape; what is not above zero and finite is left
        out.
    """
    usable = [_logarithms(x, y) for x, y in curves]
    found = [one for pair in permutations(usable, 2) for one in _apart(*pair)]
    counted = [(distance, error) for distance, error in found if error <= TRUSTED]
    if not counted:
        return Collapse(math.nan, math.nan, 0, len(found))
    distances, errors = zip(*counted, strict=True)
    return Collapse(max(distances), max(errors), len(counted), len(found))


def _logarithms(x: ArrayLike, y: ArrayLike) -> Curve:
    """Return the logarithms of a curve, its abscissas rising."""
    both = np.array([np.ravel(x), np.ravel(y)], dtype=float)
    with np.errstate(invalid="ignore"):
        logs = np.log(both[:, ((both > 0.0) & np.isfinite(both)).all(axis=0)])
    abscissas, values = logs[:, np.argsort(logs[0])]
    return abscissas, values


def _apart(one: Curve, other: Curve) -> Iterator[tuple[float, float]]:
    """Yield distance and error of the interpolation at the points of `one` along `other`."""
    (x, y), (nodes, values) = one, other
    inside = np.zeros(x.size, dtype=bool)
    if nodes.size:
        inside = (x >= nodes[0] - SAME) & (x <= nodes[-1] + SAME)
    for here, value in zip(x[inside], y[inside], strict=True):
        apart = abs(math.expm1(_interpolated(here, nodes, values, NEAREST) - value))
        yield apart, math.expm1(_error(here, nodes, values))


def _error(x: float, nodes: Array, values: Array) -> float:
    """Return e(x); infinite where points are too few or too far apart to tell."""
    if np.abs(nodes - x).min() <= SAME:
        return 0.0
    if nodes.size < NEAREST:
        return math.inf
    at = int(np.searchsorted(nodes, x)) - 1
    low, high = nodes[at : at + 2]
    if high - low > WIDEST + SAME:
        return math.inf
    middles = (nodes[1:] + nodes[:-1])[max(at - 1, 0) : at + 2] / 2.0
    apart = max(
        abs(_interpolated(m, nodes, values, NEAREST) - _interpolated(m, nodes, values, FEWER))
        for m in middles
    )
    return float(4.0 * (x - low) * (high - x) / (high - low) ** 2 * apart)


def _interpolated(x: float, abscissas: Array, values: Array, count: int) -> float:
    """Return the polynomial through the nearest points at `x` (Lagrange's form)."""
    nearest = np.argsort(np.abs(abscissas - x), kind="stable")[:count]
    u = abscissas[nearest]
    weights = [
        math.prod((x - u[m]) / (u[k] - u[m]) for m in range(u.size) if m != k)
        for k in range(u.size)
    ]
    return float(np.dot(weights, values[nearest]))
