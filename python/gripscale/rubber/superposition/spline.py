"""Smooth curves through scattered points: cubic B-splines with penalised second differences.

Source: P. H. C. Eilers & B. D. Marx, Stat. Sci. 11 (1996) 89, doi:10.1214/ss/1038425655. The weight
of the penalty is that of least generalised cross-validation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_DEGREE = 3
_PENALTIES = tuple(10.0 ** np.arange(-2.0, 5.0))
"""Tried, over the mean trust of a row."""
_RIDGE = 1e-9
"""Penalty of the coefficients themselves, over the same: one row determines no straight line."""


@dataclass(frozen=True)
class Basis:
    """B-splines on evenly spaced knots that reach from below `low` to above `high`."""

    knots: Array

    @classmethod
    def over(cls, low: float, high: float, spacing: float) -> Basis:
        """Return the basis over an interval, its knots at multiples of `spacing`."""
        first, last = np.floor(low / spacing), np.ceil(high / spacing)
        if last - first < 1.0:
            last = first + 1.0
        return cls(spacing * np.arange(first - _DEGREE, last + _DEGREE + 1.0))

    def at(self, x: Array, derivative: bool = False) -> Array:
        """Return the value, or the slope, of each function at `x`, shape (rows, functions)."""
        from scipy.interpolate import BSpline

        splines = BSpline(self.knots, np.eye(len(self.knots) - _DEGREE - 1), _DEGREE)
        return np.asarray(splines(x, nu=int(derivative), extrapolate=True))

    def penalty(self) -> Array:
        """Return second differences of the coefficients, shape (functions - 2, functions)."""
        return np.diff(np.eye(len(self.knots) - _DEGREE - 1), n=2, axis=0)


@dataclass(frozen=True)
class Smooth:
    """Coefficients of a fitted curve, its penalty weight and its effective number of freedoms."""

    coefficients: Array
    matrix: Array
    """Of the normal equations, with the penalty."""
    weight: float
    freedoms: float


def smooth(
    functions: Array, penalty: Array, values: Array, trust: Array, weight: float | None = None
) -> Smooth:
    """Return the curve through `values` of shape (rows,), each counted `trust` times.

    `weight` is that of the penalty, the best one if not given.
    """
    normal = functions.T @ (trust[:, None] * functions)
    right = functions.T @ (trust * values)
    best: Smooth | None = None
    least = np.inf
    unit = float(trust.mean())
    ridge = _RIDGE * unit * np.eye(len(normal))
    for tried in [unit * one for one in _PENALTIES] if weight is None else [weight]:
        matrix = np.asarray(normal + tried * penalty.T @ penalty + ridge, dtype=np.float64)
        both = np.column_stack([right, normal])
        solved = np.asarray(np.linalg.solve(matrix, both), dtype=np.float64)
        freedoms = float(np.trace(solved[:, 1:]))
        error = values - functions @ solved[:, 0]
        left = max(float(trust.sum()) - freedoms, 1e-6)
        score = float(trust @ error**2) / left**2
        if score < least:
            least, best = score, Smooth(solved[:, 0], matrix, float(tried), freedoms)
    assert best is not None
    return best
